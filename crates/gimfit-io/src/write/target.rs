//! Which file a name means.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Links followed before they are taken for a circle, as systems do.
const MOST_LINKS: usize = 40;

/// The file that a name means once its links are followed, whether the file is there or not.
pub(super) fn resolved(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(target) => path = folder(&path).join(target),
            // No link, or nothing there.
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("its links lead in a circle"))
}

/// The folder that a name lies in.
pub(super) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Whether two names mean one regular file, there already or not yet. Pipes and devices hold
/// nothing that could be lost, so they are the same as nothing.
#[must_use]
pub fn same_file(a: &Path, b: &Path) -> bool {
    identity(a).is_some_and(|a| Some(a) == identity(b))
}

#[derive(PartialEq, Eq)]
enum Identity {
    /// Device and number, which all names of a file share.
    #[cfg(unix)]
    Node(u64, u64),
    /// The one path that no link leads to.
    Path(PathBuf),
}

fn identity(path: &Path) -> Option<Identity> {
    match fs::metadata(path) {
        Ok(metadata) if !metadata.is_file() => None,
        #[cfg(unix)]
        Ok(metadata) => {
            use std::os::unix::fs::MetadataExt;
            Some(Identity::Node(metadata.dev(), metadata.ino()))
        }
        #[cfg(not(unix))]
        Ok(_) => fs::canonicalize(path).ok().map(Identity::Path),
        Err(_) => {
            let path = resolved(path).ok()?;
            let folder = fs::canonicalize(folder(&path)).ok()?;
            Some(Identity::Path(folder.join(path.file_name()?)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_one_file_are_told_from_names_of_two() {
        let place = tempfile::tempdir().unwrap();
        let path = |name: &str| place.path().join(name);
        fs::create_dir(path("sub")).unwrap();
        fs::write(path("a"), "").unwrap();
        fs::write(path("b"), "").unwrap();
        assert!(same_file(&path("a"), &path("sub/../a")));
        assert!(!same_file(&path("a"), &path("b")));
        assert!(same_file(&path("new"), &path("sub/../new")));
        assert!(!same_file(&path("new"), &path("a")));
        assert!(!same_file(&path("sub"), &path("sub")), "a folder is no file");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_even_to_files_that_are_not_there() {
        use std::os::unix::fs::symlink;
        let place = tempfile::tempdir().unwrap();
        let path = |name: &str| place.path().join(name);
        symlink("b", path("a")).unwrap();
        symlink("real", path("b")).unwrap();
        assert_eq!(resolved(&path("a")).unwrap(), path("real"));
        assert!(same_file(&path("a"), &path("real")));
        symlink("circle", path("circle")).unwrap();
        assert!(resolved(&path("circle")).is_err());
        assert!(!same_file(Path::new("/dev/null"), Path::new("/dev/null")));
    }
}
