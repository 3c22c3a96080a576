//! The one place that prints. Results go to standard output, everything else to standard error.

#![allow(clippy::print_stderr)]

use std::io::{self, Write};

/// Writes a result to standard output.
pub(crate) fn result(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Writes a remark to standard error; a closed one is no reason to fail.
pub(crate) fn remark(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Prints an error and its causes in one line.
pub(crate) fn error(error: &anyhow::Error) {
    remark(&format!("error: {error:#}\n"));
}

/// Whether the reader of our output closed it.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<io::Error>())
        .any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}
