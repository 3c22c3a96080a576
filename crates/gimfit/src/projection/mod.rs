//! Foot points: the nearest points of a curve, looked for near a known parameter.

mod foot_point;

pub use foot_point::{FootPoint, largest_deviation, local_foot_point};
