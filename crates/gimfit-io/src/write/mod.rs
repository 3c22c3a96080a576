//! Files replaced at once or not at all.

mod target;
mod unfinished;

pub use target::same_file;
pub use unfinished::remove_unfinished;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use unfinished::Unfinished;

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {reason}", path.display())]
pub struct WriteError {
    /// The file as the caller named it.
    pub path: PathBuf,
    /// What the system, or the format, said.
    pub reason: io::Error,
}

/// A file written completely, but not yet under its name; dropped, it leaves the old file as it
/// was.
#[derive(Debug)]
#[must_use = "the file takes its name only when it is kept"]
pub struct Prepared {
    path: PathBuf,
    /// The temporary file and its name to be; `None` for what was written directly.
    file: Option<(Unfinished, PathBuf)>,
}

impl Prepared {
    /// Lets the file take its name.
    ///
    /// # Errors
    /// [`WriteError`] with the file's name.
    pub fn keep(self) -> Result<(), WriteError> {
        let Self { path, file } = self;
        match file {
            Some((file, target)) => {
                file.finish(&target).map_err(|reason| WriteError { path, reason })
            }
            None => Ok(()),
        }
    }
}

/// Writes a file through a temporary neighbour that takes its name when it is complete, so that a
/// run that fails or is interrupted leaves the old file as it was. What is no regular file, such as
/// a pipe or a device, is written directly; a link is followed.
///
/// # Errors
/// [`WriteError`] with the file's name.
pub fn write_file(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    prepare_file(path, content)?.keep()
}

/// As [`write_file`], but the file takes its name only with [`Prepared::keep`]: of several files,
/// none is replaced before all are complete.
///
/// # Errors
/// [`WriteError`] with the file's name.
pub fn prepare_file(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<Prepared, WriteError> {
    let path = path.to_path_buf();
    match prepare(&path, content) {
        Ok(file) => Ok(Prepared { path, file }),
        Err(reason) => Err(WriteError { path, reason }),
    }
}

fn prepare(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<Option<(Unfinished, PathBuf)>> {
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory"));
        }
        Ok(metadata) if !metadata.is_file() => {
            let mut writer = BufWriter::new(File::options().write(true).open(path)?);
            content(&mut writer)?;
            writer.flush()?;
            return Ok(None);
        }
        // A file that may not be written must not be replaced either.
        Ok(_) => drop(File::options().append(true).open(path)?),
        Err(_) => {}
    }
    let target = target::resolved(path)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".gimfit-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any new file: what the umask leaves of this; or as the file it replaces.
        let mode = fs::metadata(&target).map_or(0o666, |old| old.permissions().mode() & 0o777);
        builder.permissions(fs::Permissions::from_mode(mode));
    }
    // The name of the temporary file is no concern of the reader's.
    let create = || {
        builder.tempfile_in(target::folder(&target)).map_err(|error| match error.raw_os_error() {
            Some(code) => io::Error::from_raw_os_error(code),
            None => io::Error::from(error.kind()),
        })
    };
    let mut writer = BufWriter::with_capacity(1 << 18, Unfinished::new(create)?);
    content(&mut writer)?;
    let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
    Ok(Some((file, target)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("old.txt");
        fs::write(&path, "old").unwrap();
        let failed = write_file(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("no more"))
        });
        assert!(failed.unwrap_err().to_string().contains("no more"));
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        write_file(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn files_prepared_together_replace_the_old_ones_together() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a", "b"].map(|name| folder.path().join(name));
        for path in &paths {
            fs::write(path, "old").unwrap();
        }
        let prepared = paths.each_ref().map(|path| prepare_file(path, |out| out.write_all(b"new")));
        assert!(paths.iter().all(|path| fs::read_to_string(path).unwrap() == "old"));
        let [first, second] = prepared.map(Result::unwrap);
        first.keep().unwrap();
        drop(second);
        assert_eq!(fs::read_to_string(&paths[0]).unwrap(), "new");
        assert_eq!(fs::read_to_string(&paths[1]).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_file_that_is_not_there_makes_that_file() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub")).unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("sub/real", &link).unwrap();
        write_file(&link, |out| out.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(folder.path().join("sub/real")).unwrap(), "new");
    }

    #[test]
    fn folders_that_are_missing_or_in_the_way_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        assert!(write_file(folder.path(), |_| Ok(())).is_err());
        assert!(write_file(&folder.path().join("none/x.txt"), |_| Ok(())).is_err());
    }
}
