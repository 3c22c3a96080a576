//! What the benchmarks of gimfit share: data sets, clocks, and the workloads that are also given to
//! other libraries.

pub mod clock;
pub mod data;
pub mod edit;
pub mod edit_surface;
pub mod least_squares;
pub mod memory;
pub mod nearest;
pub mod report;
pub mod surface;
pub mod workload;
