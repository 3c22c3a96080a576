//! What is written where, checked before any work is done.

use anyhow::{bail, ensure};
use gimfit_io::write::same_file;
use std::path::Path;

/// What an output holds, by the ending of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// JSON.
    Json,
    /// A table.
    Csv,
    /// A picture of lines.
    Svg,
    /// A picture of pixels.
    Png,
    /// No file.
    StandardOutput,
}

/// Whether a path stands for standard input or output.
pub(crate) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// What to write into `path`; `None` if its ending says nothing.
pub(crate) fn kind(path: &Path) -> Option<Kind> {
    if is_standard(path) {
        return Some(Kind::StandardOutput);
    }
    let ending = path.extension()?.to_string_lossy().to_ascii_lowercase();
    Some(match ending.as_str() {
        "json" => Kind::Json,
        "csv" => Kind::Csv,
        "svg" => Kind::Svg,
        "png" => Kind::Png,
        _ => return None,
    })
}

/// What to write into `path`, one of `endings` or standard output.
pub(crate) fn known_kind(path: &Path, endings: &[(Kind, &str)]) -> anyhow::Result<Kind> {
    match kind(path) {
        Some(Kind::StandardOutput) => Ok(Kind::StandardOutput),
        Some(kind) if endings.iter().any(|(known, _)| *known == kind) => Ok(kind),
        _ => {
            let endings: Vec<&str> = endings.iter().map(|(_, ending)| *ending).collect();
            bail!(
                "cannot tell from its ending what to write into {}; use {}, or - for standard \
                 output",
                path.display(),
                endings.join(", ")
            )
        }
    }
}

/// Refuses files that cannot be written, that are written twice, or that are read: `inputs` are
/// the files to read.
pub(crate) fn check(outputs: &[&Path], inputs: &[&Path]) -> anyhow::Result<()> {
    let files: Vec<&Path> = outputs.iter().copied().filter(|path| !is_standard(path)).collect();
    for (index, path) in files.iter().enumerate() {
        let name = path.display();
        ensure!(!path.is_dir(), "cannot write {name}: it is a folder");
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        ensure!(folder.is_dir(), "cannot write {name}: there is no folder {}", folder.display());
        for other in &files[..index] {
            ensure!(
                path != other && !same_file(path, other),
                "{} and {name} are one file, given twice as an output",
                other.display()
            );
        }
        for input in inputs {
            let input = if is_standard(input) { Path::new(STANDARD_INPUT) } else { input };
            ensure!(
                !same_file(path, input),
                "cannot write {name}: it is the file to be read; choose another name"
            );
        }
    }
    Ok(())
}

/// Under this name systems show which file standard input comes from; where they do not, no file
/// has it.
const STANDARD_INPUT: &str = "/dev/stdin";
