//! The one place that prints. Results go to standard output, everything else to standard error.
//!
//! Text may hold names from files, and a name may hold what a terminal takes for a command, so text
//! is printed with its control characters made visible. Data are for programs and go out as they
//! are.

#![allow(clippy::print_stderr)]

use anyhow::Context;
use std::borrow::Cow;
use std::io::{self, BufWriter, Write};

/// Writes text for a person to standard output.
pub(crate) fn text(text: &str) -> anyhow::Result<()> {
    data(&printable(text))
}

/// Writes data for a program to standard output.
pub(crate) fn data(data: &str) -> anyhow::Result<()> {
    stream(|out| out.write_all(data.as_bytes()))
}

/// Lets `content` write data to standard output piece by piece.
pub(crate) fn stream(content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> anyhow::Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    content(&mut out).and_then(|()| out.flush()).context("cannot write to standard output")
}

/// Writes a remark to standard error; a closed one is no reason to fail.
pub(crate) fn remark(text: &str) {
    let _ = io::stderr().lock().write_all(printable(text).as_bytes());
}

/// Prints an error and its causes in one line.
pub(crate) fn error(error: &anyhow::Error) {
    remark(&format!("error: {error:#}\n"));
}

/// Prints what clap says of the arguments, and ends the program. Arguments that hold commands for
/// the terminal cost it its colours, which are such commands too, and are left out with them.
pub(crate) fn usage(error: &clap::Error) -> ! {
    if std::env::args_os().all(|argument| !argument.to_string_lossy().contains(is_command)) {
        error.exit();
    }
    remark(&error.render().to_string());
    std::process::exit(error.exit_code());
}

/// Text with all control characters but line ends and tabs made visible.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(is_command) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_command(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Whether a terminal may take a character for a command, or the start of one.
fn is_command(c: char) -> bool {
    c.is_control() && !matches!(c, '\n' | '\t')
}

/// Whether the reader of our output closed it.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<io::Error>())
        .any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_of_terminals_are_shown_and_not_sent() {
        assert_eq!(printable("a\u{1b}[31m\tb\r\u{9b}\n"), "a\\u{1b}[31m\tb\\r\\u{9b}\n");
        assert!(matches!(printable("é\n"), Cow::Borrowed("é\n")));
    }
}
