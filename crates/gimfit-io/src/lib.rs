//! Readers and writers for gimfit, one file per format.

pub mod figure;
pub mod points;
