//! The one loop behind every fit, and the published rules that run through it. Nothing here knows
//! what kind of geometry its control points carry.

mod driver;
mod observer;
mod random;
mod state;
mod stopping;
mod trace;
pub mod update;

pub use driver::{Outcome, run};
pub use observer::{Flow, NoObserver, Observer, Snapshot};
pub use state::{IterationState, ROUNDING};
pub use stopping::{Stopping, Termination};
pub use trace::{HistoryEntry, MAX_ENTRIES, Trace};
pub use update::{Step, UpdateCounts, UpdateRule};
