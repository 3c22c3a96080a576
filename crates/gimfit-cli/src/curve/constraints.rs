//! What a least squares curve shall meet, from a file: one line each.

use anyhow::{Context, anyhow, bail, ensure};
use gimfit::{Constraints, CurveEnd};
use std::path::Path;

const KINDS: &str = "through ROW, tangent ROW X Y.., normal ROW X Y.., derivative ROW ORDER X Y.., \
                     control NUMBER X Y.., straight first|last COUNT X Y.., planar first|last COUNT X Y.. \
                     and mirror COORDINATE VALUE";

/// What stands before a remark.
fn words(line: &str) -> Vec<&str> {
    let line = line.split('#').next().unwrap_or_default();
    let separated = |c: char| c.is_whitespace() || c == ',';
    line.split(separated).filter(|word| !word.is_empty()).collect()
}

/// The lines that hold constraints, numbered from 1.
fn lines(text: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    let each = text.lines().enumerate().map(|(at, line)| (at + 1, words(line)));
    each.filter(|(_, words)| !words.is_empty())
}

/// What contradicts what, by the lines of the file; `positions` count constraints.
pub(super) fn conflict(path: &Path, positions: &[usize]) -> anyhow::Error {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let known: Vec<(usize, Vec<&str>)> = lines(&text).collect();
    let named = positions.iter().filter_map(|&position| known.get(position));
    let named: Vec<String> =
        named.map(|(at, words)| format!("line {at} ({})", words.join(" "))).collect();
    anyhow!(
        "--constraints {}: no curve over these knots meets these together: {}; take one of them out, \
         or use more control points",
        path.display(),
        named.join(", ")
    )
}

/// Reads constraints on curves through `rows` points. Rows and control points count from 1.
pub(super) fn read(path: &Path, rows: usize) -> anyhow::Result<Constraints> {
    let name = path.display();
    let text = std::fs::read_to_string(path).with_context(|| format!("--constraints {name}"))?;
    let mut constraints = Constraints::new();
    for (number, words) in lines(&text) {
        let (kind, words) = (words[0], &words[1..]);
        constraints = one(constraints, kind, words, rows)
            .map_err(|error| anyhow!("--constraints {name}, line {number}: {error}"))?;
    }
    ensure!(
        !constraints.is_empty(),
        "--constraints {name}: no constraint in it; lines are {KINDS}"
    );
    Ok(constraints)
}

fn one(list: Constraints, kind: &str, words: &[&str], rows: usize) -> anyhow::Result<Constraints> {
    ensure!(
        KINDS.contains(&format!("{kind} ")),
        "there is no constraint {kind:?}; lines are {KINDS}"
    );
    let count = |place: usize, what: &str| -> anyhow::Result<usize> {
        let word = words.get(place).ok_or_else(|| anyhow!("{kind} needs a {what}"))?;
        let number = word.parse::<usize>().ok().filter(|n| *n > 0);
        number.ok_or_else(|| anyhow!("{word:?} is no {what}: a whole number from 1 was expected"))
    };
    let vector = |from: usize| -> anyhow::Result<Vec<f64>> {
        let words = words.get(from..).unwrap_or_default();
        ensure!(!words.is_empty(), "{kind} needs the coordinates of a vector");
        let each = words.iter().map(|word| {
            let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
            number.ok_or_else(|| anyhow!("{word:?} is no number"))
        });
        each.collect()
    };
    let row = || -> anyhow::Result<usize> {
        let row = count(0, "row of a point")?;
        ensure!(row <= rows, "row {row} was named, and there are {rows} points");
        Ok(row - 1)
    };
    Ok(match kind {
        "through" => {
            ensure!(words.len() <= 1, "through takes one row; write a line for each");
            list.through(row()?)
        }
        "tangent" => list.tangent(row()?, &vector(1)?),
        "normal" => list.normal(row()?, &vector(1)?),
        "derivative" => list.derivative(row()?, count(1, "order")?, &vector(2)?),
        "control" => list.pinned(count(0, "number of a control point")? - 1, &vector(1)?),
        "straight" | "planar" => {
            let end = match words.first() {
                Some(&"first") => CurveEnd::First,
                Some(&"last") => CurveEnd::Last,
                _ => bail!("{kind} needs the end: first or last"),
            };
            let (control_points, vector) = (count(1, "number of control points")?, vector(2)?);
            match kind {
                "straight" => list.straight_end(end, control_points, &vector),
                _ => list.planar_end(end, control_points, &vector),
            }
        }
        "mirror" => {
            ensure!(words.len() <= 2, "mirror takes a coordinate, from 1, and a value");
            list.mirrored(count(0, "number of a coordinate")? - 1, vector(1)?[0])
        }
        _ => bail!("there is no constraint {kind:?}; lines are {KINDS}"),
    })
}
