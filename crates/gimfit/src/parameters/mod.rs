//! Where each data point sits on the curve: the parameters, a first guess from the data.

mod assign;

pub use assign::{Parameterization, Parameters, assign_grid_parameters, assign_parameters};
