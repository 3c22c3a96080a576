//! What the tests of the program share: a folder of their own, a run of the program in it, and
//! small independent oracles.

#![allow(dead_code)] // Each test file takes what it needs.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use tempfile::TempDir;

/// How a run ended and what it printed.
#[derive(Debug)]
pub(crate) struct Ran {
    /// Exit status; `None` if a signal ended it.
    pub(crate) code: Option<i32>,
    /// Standard output.
    pub(crate) out: String,
    /// Standard error.
    pub(crate) errors: String,
}

impl Ran {
    /// Expects an exit status.
    #[track_caller]
    pub(crate) fn code(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "out: {}\nerrors: {}", self.out, self.errors);
        assert!(!self.errors.contains("panicked"), "{}", self.errors);
        self
    }

    /// Expects every one of these in the error message.
    #[track_caller]
    pub(crate) fn says(self, parts: &[&str]) -> Self {
        for part in parts {
            assert!(self.errors.contains(part), "no {part:?} in {:?}", self.errors);
        }
        self
    }

    /// Standard output as JSON.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap()
    }
}

/// A folder for one test.
#[derive(Debug)]
pub(crate) struct Place(TempDir);

impl Place {
    /// An empty folder.
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// A folder that holds one file.
    pub(crate) fn with(name: &str, content: impl AsRef<[u8]>) -> Self {
        let place = Self::new();
        place.write(name, content);
        place
    }

    /// The path of a file in it.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    /// Reads a file of text.
    #[track_caller]
    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// Reads a document.
    #[track_caller]
    pub(crate) fn document(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).unwrap()
    }

    /// Whether there is such a file.
    pub(crate) fn holds(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    /// Names of all that it holds, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(self.0.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// The program, started in this folder; arguments stand in one line without quotation marks.
    pub(crate) fn command(&self, line: &str) -> std::process::Command {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_gimfit"));
        command.current_dir(self.0.path()).args(line.split_whitespace());
        command.stdin(Stdio::null());
        command
    }

    /// Runs the program in this folder.
    pub(crate) fn run(&self, line: &str) -> Ran {
        ran(self.command(line).output().unwrap())
    }

    /// Runs it with something on standard input.
    pub(crate) fn run_with_input(&self, line: &str, input: impl Into<Vec<u8>>) -> Ran {
        let mut command = assert_cmd::Command::from_std(self.command(line));
        ran(command.write_stdin(input).output().unwrap())
    }

    /// Fits a file and returns the document.
    #[track_caller]
    pub(crate) fn fit(&self, line: &str) -> Value {
        self.run(&format!("curve {line} -q -o fitted-by-test.json")).code(0);
        let document = self.document("fitted-by-test.json");
        fs::remove_file(self.path("fitted-by-test.json")).unwrap();
        document
    }
}

/// Takes an output over.
pub(crate) fn ran(output: std::process::Output) -> Ran {
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Ran { code: output.status.code(), out: text(output.stdout), errors: text(output.stderr) }
}

/// A file of the repository's test data.
pub(crate) fn testdata(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata").join(name)
}

/// Points of a smooth open curve, as CSV without header.
pub(crate) fn wave(count: usize) -> String {
    (0..count)
        .map(|i| {
            let a = i as f64 * 0.3 + 0.05 * (i as f64 * 1.7).sin();
            format!("{a:?},{:?}\n", a.sin())
        })
        .collect()
}

/// The numbers of a JSON array.
#[track_caller]
pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// The points of a JSON array of arrays.
#[track_caller]
pub(crate) fn points(value: &Value) -> Vec<Vec<f64>> {
    value.as_array().unwrap().iter().map(numbers).collect()
}

/// The points of a CSV text without header.
#[track_caller]
pub(crate) fn table(text: &str) -> Vec<Vec<f64>> {
    text.lines().map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// Largest distance between two lists of points of equal length.
#[track_caller]
pub(crate) fn largest_distance(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| {
        assert_eq!(a.len(), b.len());
        most.max(a.iter().zip(b).fold(0.0, |sum: f64, (x, y)| sum.hypot(x - y)))
    })
}

/// The B-spline function `i` of degree `p` by the recursion of Cox and de Boor, with the last
/// span of the domain closed on the right.
fn basis(knots: &[f64], i: usize, p: usize, t: f64, end: f64) -> f64 {
    if p == 0 {
        let inside = knots[i] <= t && t < knots[i + 1];
        let last = t == end && knots[i] < end && knots[i + 1] == end;
        return f64::from(u8::from(inside || last));
    }
    let share = |from: f64, to: f64, x: f64, value: f64| {
        if to > from { x / (to - from) * value } else { 0.0 }
    };
    let (a, b) = (knots[i], knots[i + p]);
    let (c, d) = (knots[i + 1], knots[i + p + 1]);
    share(a, b, t - a, basis(knots, i, p - 1, t, end))
        + share(c, d, d - t, basis(knots, i + 1, p - 1, t, end))
}

/// A point of the curve of a document, from nothing but its knots and control points.
#[track_caller]
pub(crate) fn de_boor(geometry: &Value, t: f64) -> Vec<f64> {
    let degree = geometry["degree"].as_u64().unwrap() as usize;
    let (knots, control) = (numbers(&geometry["knots"]), points(&geometry["control_points"]));
    assert_eq!(knots.len(), control.len() + degree + 1);
    let end = knots[knots.len() - 1 - degree];
    // At the end of a periodic domain the recursion takes the span to its right, which is there.
    let end = if knots[knots.len() - 1] > end { f64::INFINITY } else { end };
    let mut point = vec![0.0; control[0].len()];
    for (i, weights) in control.iter().enumerate() {
        let n = basis(&knots, i, degree, t, end);
        point.iter_mut().zip(weights).for_each(|(x, w)| *x += n * w);
    }
    point
}

/// Fails on a number that is not finite, which JSON writes as null, in the parts that always hold
/// numbers.
#[track_caller]
pub(crate) fn all_finite(document: &Value) {
    let geometry = &document["geometry"];
    points(&geometry["control_points"]);
    numbers(&geometry["knots"]);
    numbers(&document["parameters"]);
    let report = &document["report"];
    for name in ["max_residual", "rms_residual", "max_deviation", "extent", "spacing_ratio"] {
        assert!(report[name].is_f64(), "{name}: {}", report[name]);
    }
}
