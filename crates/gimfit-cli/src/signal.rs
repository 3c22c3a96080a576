//! Interrupts: a fit that is under way stops and is written; before and after, the program ends.
//! Either way no temporary file stays behind.

use gimfit_io::write::remove_unfinished;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};

static STAGE: AtomicU8 = AtomicU8::new(Stage::Reading as u8);
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// What an interrupt meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// No fit yet, or the result can be had again soon: the program ends.
    Reading = 0,
    /// The iteration stops, and its fit is written.
    Fitting = 1,
    /// Files are finished first.
    Writing = 2,
}

/// Status of a program ended by an interrupt, as shells have it.
const INTERRUPTED_STATUS: i32 = 130;

/// Listens to interrupts from now on.
pub(crate) fn listen() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        let again = INTERRUPTED.swap(true, Ordering::SeqCst);
        if again || STAGE.load(Ordering::SeqCst) == Stage::Reading as u8 {
            remove_unfinished();
            std::process::exit(INTERRUPTED_STATUS);
        }
    })?;
    Ok(())
}

/// Tells what the program is at.
pub(crate) fn enter(stage: Stage) {
    STAGE.store(stage as u8, Ordering::SeqCst);
}

/// Whether an interrupt came.
pub(crate) fn interrupted() -> bool {
    INTERRUPTED.load(Ordering::SeqCst)
}
