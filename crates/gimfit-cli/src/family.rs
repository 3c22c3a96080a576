//! Files of each kept fit: output names that hold a place for the iteration.

use anyhow::ensure;
use std::path::{Path, PathBuf};

/// What stands for the iteration in the name of an output.
const PLACES: [&str; 2] = ["{k}", "{iteration}"];

/// Most files written by one run: each is held open until all are complete.
const MOST_FILES: usize = 500;

/// Which fits have files of their own.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Keep<'a> {
    /// Those after these iterations.
    Iterations(&'a [usize]),
    /// All that are found, by their numbers of control points.
    Sizes,
}

/// An output that is one file for each kept fit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Family<'a>(&'a str);

impl<'a> Family<'a> {
    /// The family that a name with a place for the iteration stands for.
    pub(crate) fn of(path: &'a Path) -> Option<Self> {
        let name = path.to_str()?;
        PLACES.iter().any(|place| name.contains(place)).then_some(Self(name))
    }

    /// The file of one kept fit.
    pub(crate) fn file(self, iteration: usize) -> PathBuf {
        let number = iteration.to_string();
        PLACES.iter().fold(self.0.to_owned(), |name, place| name.replace(place, &number)).into()
    }

    /// What is told of the files.
    pub(crate) fn wrote(self, keep: Keep<'_>, members: &[usize]) -> String {
        let numbers: Vec<String> = members.iter().map(ToString::to_string).collect();
        let list = numbers.join(", ");
        match (keep, numbers.len()) {
            (_, 0) => {
                format!("{}: no file, because the run reached none of the fits to keep", self.0)
            }
            (Keep::Iterations(_), 1) => format!("{}: the kept fit of iteration {list}", self.0),
            (Keep::Iterations(_), _) => format!("{}: the kept fits of iterations {list}", self.0),
            (Keep::Sizes, _) => format!("{}: the fits with {list} control points", self.0),
        }
    }
}

/// Whether a name holds a place for the iteration.
pub(crate) fn has_place(path: &Path) -> bool {
    Family::of(path).is_some()
}

/// The files that an output stands for.
pub(crate) fn files(path: &Path, keep: Keep<'_>) -> anyhow::Result<Vec<PathBuf>> {
    let Some(family) = Family::of(path) else { return Ok(vec![path.to_path_buf()]) };
    let Keep::Iterations(keep) = keep else {
        // One of them stands for all, whose numbers the run will tell.
        return Ok(vec![family.file(0)]);
    };
    ensure!(
        !keep.is_empty(),
        "{} is a file for each kept fit; say which with --keep, such as --keep 0,2,4",
        path.display()
    );
    let mut iterations = keep.to_vec();
    iterations.sort_unstable();
    iterations.dedup();
    ensure!(
        iterations.len() <= MOST_FILES,
        "{} would be {} files; at most {MOST_FILES} are written: list fewer iterations with --keep",
        path.display(),
        iterations.len()
    );
    Ok(iterations.into_iter().map(|iteration| family.file(iteration)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_is_filled_and_repeated_iterations_count_once() {
        let name = Path::new("a-{k}/b{iteration}.json");
        let files = files(name, Keep::Iterations(&[4, 0, 4])).unwrap();
        assert_eq!(files, [PathBuf::from("a-0/b0.json"), PathBuf::from("a-4/b4.json")]);
        let none = Keep::Iterations(&[]);
        assert!(super::files(name, none).unwrap_err().to_string().contains("--keep"));
        assert_eq!(super::files(Path::new("k.json"), none).unwrap(), [PathBuf::from("k.json")]);
    }
}
