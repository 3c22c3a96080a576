//! Bytes from a file or from standard input.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use super::error::{Problem, ReadError};

/// The most bytes read from one input. A curve needs far fewer; without a
/// limit an endless stream would fill the memory.
const LIMIT: u64 = 4 << 30;

/// How messages name the input at `path`.
pub(crate) fn source_name(path: &Path) -> String {
    if is_standard_input(path) { "standard input".to_owned() } else { path.display().to_string() }
}

/// The ending of the file's name, without its dot.
pub(crate) fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_owned())
}

/// All bytes of the input at `path`.
pub(crate) fn read_bytes(path: &Path, source: &str) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    let read = if is_standard_input(path) {
        std::io::stdin().lock().take(LIMIT + 1).read_to_end(&mut bytes)
    } else {
        File::open(path).and_then(|file| file.take(LIMIT + 1).read_to_end(&mut bytes))
    };
    match read {
        Ok(_) if bytes.len() as u64 > LIMIT => {
            Err(ReadError::file(source, Problem::TooLong { limit: LIMIT }))
        }
        Ok(_) => Ok(bytes),
        Err(error) if error.kind() == ErrorKind::NotFound => {
            Err(ReadError::file(source, Problem::NotFound))
        }
        Err(error) => Err(ReadError::file(source, Problem::Unreadable(error))),
    }
}

fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_file_is_named() {
        let path = Path::new("no-such-folder/points.csv");
        let error = read_bytes(path, &source_name(path)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "no-such-folder/points.csv: there is no such file; check the path"
        );
    }

    #[test]
    fn a_folder_is_unreadable() {
        let folder = tempfile::tempdir().unwrap();
        let error = read_bytes(folder.path(), "folder").unwrap_err();
        assert!(matches!(error.problem(), Problem::Unreadable(_)));
    }

    #[test]
    fn a_dash_is_standard_input() {
        assert_eq!(source_name(Path::new("-")), "standard input");
    }
}
