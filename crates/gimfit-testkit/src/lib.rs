//! Slow, obvious oracles that judge gimfit, and generators for its tests. Nothing here comes from
//! the library it judges: every formula is written again, in its textbook form.

pub mod adaptive;
pub mod anderson;
pub mod blending;
pub mod convexity;
pub mod dense;
pub mod generate;
pub mod geometric;
pub mod least_squares;
pub mod nearest;
pub mod textbook;
