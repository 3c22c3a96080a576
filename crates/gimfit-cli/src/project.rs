//! `gimfit project`: the nearest point of a fitted curve or surface for each point of a file.

use crate::arguments::ProjectArguments;
use crate::explain::explain;
use crate::report_text::Lines;
use crate::shape::{self, Shape};
use crate::targets::{self, Kind, is_standard};
use crate::{Ending, input, output, signal};
use anyhow::{bail, ensure};
use gimfit::PointsView;
use gimfit::projection::{CurveProjector, SurfaceProjector};
use gimfit_io::points::{PointTable, input_name};
use gimfit_io::table::write_feet;
use gimfit_io::write::write_file;
use std::io::{self, Write};
use std::path::Path;

/// A foot point on a curve (one parameter) or a surface (two).
struct Foot {
    parameters: Vec<f64>,
    point: Vec<f64>,
    distance: f64,
}

/// What is told of all distances.
struct Summary {
    largest: f64,
    /// Row of the largest.
    at: usize,
    rms: f64,
    mean: f64,
}

pub(crate) fn run(arguments: &ProjectArguments) -> anyhow::Result<Ending> {
    let kind = check(arguments)?;
    signal::listen()?;
    let fitted = shape::read(&arguments.document, arguments.iteration)?;
    let table = input::points(&arguments.input)?;
    let document = input_name(&arguments.document);
    let (what, dimension) = match &fitted.shape {
        Shape::Curve(curve) => ("curve", curve.dimension()),
        Shape::Surface(surface) => ("surface", surface.dimension()),
        Shape::Triangle(_) => bail!(
            "{document} holds a triangular patch; points are projected onto curves and surfaces"
        ),
    };
    ensure!(
        table.dimension() == dimension,
        "{}: points of dimension {} ({}), but the {what} of {document} has dimension {dimension}; \
         choose columns with --columns",
        table.source,
        table.dimension(),
        table.column_names.join(", ")
    );
    let feet = feet(&fitted.shape, &table)?;
    ensure!(!feet.is_empty(), "{}: there are no points", table.source);
    let summary = Summary::of(&feet);
    let names =
        if fitted.names.len() == dimension { fitted.names } else { table.column_names.clone() };
    let csv = |out: &mut dyn Write| -> io::Result<()> {
        let labels: &[&str] = if what == "curve" { &["t"] } else { &["u", "v"] };
        let rows = feet
            .iter()
            .map(|foot| foot.parameters.iter().chain(&foot.point).copied().chain([foot.distance]));
        write_feet(out, labels, &names, rows)
    };
    match (kind, &arguments.output) {
        (Some(Kind::StandardOutput), _) => {
            output::stream(csv)?;
            return Ok(Ending::Done);
        }
        (Some(Kind::Json), Some(path)) => write_file(path, |out| json(&feet, what, out))?,
        (Some(_), Some(path)) => write_file(path, csv)?,
        _ => {}
    }
    if arguments.json {
        output::data(&(summary.json(&table) + "\n"))?;
    } else {
        output::text(&report(&summary, &table, &document, what, arguments))?;
    }
    Ok(Ending::Done)
}

/// Refuses what cannot work before any work is done; tells what to write, if anything.
fn check(arguments: &ProjectArguments) -> anyhow::Result<Option<Kind>> {
    let inputs = [("FIT", arguments.document.as_path()), ("POINTS", &arguments.input.points)];
    input::check_standard_input(&inputs)?;
    let Some(path) = &arguments.output else { return Ok(None) };
    ensure!(
        !(arguments.json && is_standard(path)),
        "--json and -o - both write to standard output; use one of them"
    );
    let paths: Vec<&Path> = inputs.iter().map(|(_, path)| *path).collect();
    targets::check(&[path.as_path()], &paths)?;
    targets::known_kind(path, &[(Kind::Csv, ".csv"), (Kind::Json, ".json")]).map(Some)
}

fn feet(shape: &Shape, table: &PointTable) -> anyhow::Result<Vec<Foot>> {
    let explained = |error| explain(error, table);
    let view = PointsView::new(table.dimension(), &table.coordinates).map_err(explained)?;
    Ok(match shape {
        Shape::Curve(curve) => CurveProjector::new(curve)
            .project_all(view)
            .map_err(explained)?
            .into_iter()
            .map(|foot| Foot {
                parameters: vec![foot.parameter],
                point: foot.point,
                distance: foot.distance,
            })
            .collect(),
        Shape::Surface(surface) => SurfaceProjector::new(surface)
            .project_all(view)
            .map_err(explained)?
            .into_iter()
            .map(|foot| Foot {
                parameters: foot.parameters.to_vec(),
                point: foot.point,
                distance: foot.distance,
            })
            .collect(),
        // Refused before.
        Shape::Triangle(_) => Vec::new(),
    })
}

impl Summary {
    fn of(feet: &[Foot]) -> Self {
        let distance = |row: usize| feet[row].distance;
        let at =
            (0..feet.len()).fold(0, |a, row| if distance(row) > distance(a) { row } else { a });
        let largest = distance(at);
        // Over the largest, so that no square leaves the range of doubles.
        let share = |row: usize| if largest > 0.0 { distance(row) / largest } else { 0.0 };
        let count = feet.len() as f64;
        let squares: f64 = (0..feet.len()).map(|row| share(row) * share(row)).sum();
        let sum: f64 = (0..feet.len()).map(share).sum();
        Self { largest, at, rms: largest * (squares / count).sqrt(), mean: largest * (sum / count) }
    }

    fn json(&self, table: &PointTable) -> String {
        serde_json::json!({
            "points": table.rows(),
            "largest_distance": self.largest,
            "largest_distance_index": self.at,
            "rms_distance": self.rms,
            "mean_distance": self.mean,
        })
        .to_string()
    }
}

fn report(
    summary: &Summary,
    table: &PointTable,
    document: &str,
    what: &str,
    arguments: &ProjectArguments,
) -> String {
    let mut lines = Lines::new(&table.source, table.title.as_deref());
    lines.add(
        "read",
        &format!(
            "{} points of dimension {} ({}) as {}",
            table.rows(),
            table.dimension(),
            table.column_names.join(", "),
            table.format
        ),
    );
    lines.add_all("", &table.notes);
    let kept = arguments.iteration.map(|n| format!(", iteration {n}")).unwrap_or_default();
    lines.add("onto", &format!("the {what} of {document}{kept}"));
    lines.add(
        "distance",
        &format!(
            "largest {:.3e} at {}, rms {:.3e}, mean {:.3e}",
            summary.largest,
            table.row_name(summary.at),
            summary.rms,
            summary.mean
        ),
    );
    if let Some(path) = &arguments.output {
        lines.add("wrote", &format!("{}: {} foot points", path.display(), table.rows()));
    }
    lines.finish()
}

/// All foot points in one line.
fn json(feet: &[Foot], what: &str, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"{\"format\":\"gimfit-feet\",\"version\":1,\"feet\":[")?;
    for (row, foot) in feet.iter().enumerate() {
        if row > 0 {
            out.write_all(b",")?;
        }
        let mut value = serde_json::json!({ "point": foot.point, "distance": foot.distance });
        if what == "curve" {
            value["parameter"] = foot.parameters[0].into();
        } else {
            value["parameters"] = foot.parameters.clone().into();
        }
        serde_json::to_writer(&mut *out, &value)?;
    }
    out.write_all(b"]}\n")
}
