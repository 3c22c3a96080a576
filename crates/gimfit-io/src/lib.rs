//! Readers and writers for gimfit, one file per format: points in; documents, tables and figures
//! out.

pub mod document;
pub mod figure;
pub mod grids;
pub mod points;
pub mod surface_figure;
pub mod table;
pub mod write;
