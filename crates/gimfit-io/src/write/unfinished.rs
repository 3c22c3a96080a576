//! Temporary files that a program ended half-way must take along.
//!
//! A program that ends by itself never gets to remove what it was writing, so the names of all
//! unfinished files are kept here.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::NamedTempFile;

static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn list() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of names is sound even if whoever changed it last did not end well.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the temporary files of all writing under way, for a program that is about to end. Any
/// thread that then begins or finishes a file waits for that end.
pub fn remove_unfinished() {
    let list = list();
    for path in list.iter() {
        // The program ends all the same, and nobody is left to tell.
        let _ = fs::remove_file(path);
    }
    std::mem::forget(list);
}

/// A temporary file whose name is on the list until it is finished or dropped.
#[derive(Debug)]
pub(super) struct Unfinished(Option<NamedTempFile>);

impl Unfinished {
    /// Takes a file that `create` makes; no interrupt comes between its making and its listing.
    pub(super) fn new(create: impl FnOnce() -> io::Result<NamedTempFile>) -> io::Result<Self> {
        let mut list = list();
        let file = create()?;
        list.push(file.path().to_path_buf());
        Ok(Self(Some(file)))
    }

    /// Gives the file its name.
    pub(super) fn finish(mut self, target: &Path) -> io::Result<()> {
        let mut list = list();
        let Some(file) = self.0.take() else { return Ok(()) };
        list.retain(|path| path != file.path());
        file.persist(target).map(drop).map_err(|failed| failed.error)
    }
}

impl io::Write for Unfinished {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.as_mut().map_or(Ok(0), |file| file.as_file_mut().write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.as_mut().map_or(Ok(()), |file| file.as_file_mut().flush())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if let Some(file) = self.0.take() {
            let mut list = list();
            list.retain(|path| path != file.path());
            drop(file);
        }
    }
}
