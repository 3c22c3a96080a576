//! `gimfit info`: what a file holds.

use crate::arguments::InfoArguments;
use crate::explain::explain;
use crate::{Ending, input, output};
use anyhow::anyhow;
use gimfit::PointsView;
use gimfit::points::Extent;
use gimfit_io::document::{
    AnyDocument, Document, Geometry, RunData, SurfaceDocument, SurfaceKind, TriangleDocument,
    TriangleKind, is_document, parse_any_document,
};
use gimfit_io::grids::{GridOptions, PointGrid, read_grid_from, says_grid};
use gimfit_io::points::{PointTable, input_name, read_input, read_points_from};
use std::fmt::Write;

pub(crate) fn run(arguments: &InfoArguments) -> anyhow::Result<Ending> {
    let path = &arguments.input.points;
    let name = input_name(path);
    let bytes = read_input(path)?;
    let facts = if is_document(&bytes) {
        match parse_any_document(&bytes, &name)? {
            AnyDocument::Surface(document) => of_surface(&document, name),
            AnyDocument::Triangle(document) => of_triangle(&document, name),
            AnyDocument::Curve(document) => of_document(&document, name),
            _ => return Err(anyhow!("{name} holds a geometry that info does not know")),
        }
    } else {
        let ending = path.extension().map(|ending| ending.to_string_lossy().into_owned());
        match grid(&bytes, &name, ending.as_deref(), arguments)? {
            Some(grid) => of_grid(&grid)?,
            None => {
                let options = input::options(&arguments.input);
                of_points(&read_points_from(&bytes, &name, ending.as_deref(), &options)?)?
            }
        }
    };
    if arguments.json {
        output::data(&facts.json())?;
    } else {
        output::text(&facts.text())?;
    }
    Ok(Ending::Done)
}

/// The grid of a file that is to be one, or says so of itself and can be read as one.
fn grid(
    bytes: &[u8],
    name: &str,
    ending: Option<&str>,
    arguments: &InfoArguments,
) -> anyhow::Result<Option<PointGrid>> {
    let input = &arguments.input;
    let chosen = input.abscissa.is_some() || input.part.is_some() || input.format.is_some();
    if !arguments.grid && (chosen || !says_grid(bytes, ending)) {
        return Ok(None);
    }
    let options = GridOptions {
        shape: arguments.shape,
        columns: (!input.columns.is_empty()).then(|| input.columns.clone()),
        delimiter: input.delimiter,
        decimal: input.decimal,
        keep_holes: true,
        ..GridOptions::default()
    };
    match read_grid_from(bytes, name, ending, &options) {
        Ok(grid) => Ok(Some(grid)),
        Err(error) if arguments.grid => Err(error.into()),
        Err(_) => Ok(None),
    }
}

fn of_grid(grid: &PointGrid) -> anyhow::Result<Facts> {
    let mut facts = Facts(Vec::new());
    let (dimension, columns) = (grid.dimension(), grid.columns);
    facts.add("file", grid.source.clone());
    facts.add("holds", "grid");
    facts.add("read_as", grid.format.to_string());
    if let Some(title) = &grid.title {
        facts.add("title", title.clone());
    }
    facts.add("rows", grid.rows);
    facts.add("columns", columns);
    facts.add("dimension", dimension);
    facts.add("coordinates", grid.column_names.clone());
    let missing = grid.holes().count();
    facts.add("missing_cells", missing);
    if let Some((row, column)) = grid.holes().next() {
        facts.add("first_missing", grid.point_name(row, column));
    }
    let whole = |point: &&[f64]| point.iter().all(|x| !x.is_nan());
    let present: Vec<f64> =
        grid.coordinates.chunks_exact(dimension).filter(whole).flatten().copied().collect();
    if !present.is_empty() {
        let extent = Extent::of(PointsView::new(dimension, &present)?)?;
        facts.add("lower_corner", extent.lower.clone());
        facts.add("upper_corner", extent.upper.clone());
        facts.add("extent", extent.diagonal());
    }
    let point =
        |i: usize, j: usize| &grid.coordinates[(i * columns + j) * dimension..][..dimension];
    let cells = |i: usize| (0..columns).map(move |j| (i, j));
    let between_rows =
        (1..grid.rows).flat_map(cells).map(|(i, j)| distance(point(i - 1, j), point(i, j)));
    add_spacing(&mut facts, ["shortest_step_u", "longest_step_u"], between_rows);
    let between_columns = (0..grid.rows)
        .flat_map(cells)
        .filter(|(_, j)| *j > 0)
        .map(|(i, j)| distance(point(i, j - 1), point(i, j)));
    add_spacing(&mut facts, ["shortest_step_v", "longest_step_v"], between_columns);
    for (name, abscissae) in
        [("row_abscissae", &grid.row_abscissae), ("column_abscissae", &grid.column_abscissae)]
    {
        if let Some([first, .., last]) = abscissae.as_deref() {
            facts.add(name, vec![*first, *last]);
        }
    }
    if !grid.notes.is_empty() {
        facts.add("notes", grid.notes.clone());
    }
    Ok(facts)
}

/// The shortest and the longest of the steps between neighbours that are both there.
fn add_spacing(facts: &mut Facts, names: [&'static str; 2], steps: impl Iterator<Item = f64>) {
    let ends = steps
        .filter(|step| !step.is_nan())
        .fold((f64::INFINITY, -1.0_f64), |ends, step| (ends.0.min(step), ends.1.max(step)));
    if ends.1 >= 0.0 {
        facts.add(names[0], ends.0);
        facts.add(names[1], ends.1);
    }
}

/// The residuals of a run; of local PIA, which counts some points only, those of the others beside.
fn add_residuals(facts: &mut Facts, run: &RunData) {
    if let Some(local) = &run.local {
        facts.add("points_iterated", local.points);
    }
    facts.add("largest_residual", run.max_residual);
    facts.add("rms_residual", run.rms_residual);
    if let Some(local) = &run.local {
        facts.add("residuals_are", "of the points iterated; deviations of all points");
        facts.add("outside_residual", local.outside_max_residual);
    }
}

/// Names and values, shown as lines or as JSON.
struct Facts(Vec<(&'static str, serde_json::Value)>);

impl Facts {
    fn add(&mut self, name: &'static str, value: impl Into<serde_json::Value>) {
        self.0.push((name, value.into()));
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for (name, value) in &self.0 {
            let shown = match value {
                serde_json::Value::String(words) => words.clone(),
                serde_json::Value::Array(list) => {
                    let items: Vec<String> = list
                        .iter()
                        .map(|item| item.as_str().map_or_else(|| item.to_string(), str::to_owned))
                        .collect();
                    items.join(if *name == "notes" { "\n                   " } else { ", " })
                }
                other => other.to_string(),
            };
            let _ = writeln!(text, "{:<18} {shown}", name.replace('_', " "));
        }
        text
    }

    fn json(&self) -> String {
        let map: serde_json::Map<String, serde_json::Value> =
            self.0.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
        serde_json::Value::Object(map).to_string() + "\n"
    }
}

fn of_points(table: &PointTable) -> anyhow::Result<Facts> {
    let mut facts = Facts(Vec::new());
    let view = PointsView::new(table.dimension(), &table.coordinates)
        .map_err(|error| explain(error, table))?;
    let extent = Extent::of(view).map_err(|error| explain(error, table))?;
    facts.add("file", table.source.clone());
    facts.add("holds", "points");
    facts.add("read_as", table.format.to_string());
    if let Some(title) = &table.title {
        facts.add("title", title.clone());
    }
    facts.add("points", table.rows());
    facts.add("dimension", table.dimension());
    facts.add("columns", table.column_names.clone());
    if let Some(name) = &table.abscissa_name {
        facts.add("abscissa", name.clone());
    }
    facts.add("lower_corner", extent.lower.clone());
    facts.add("upper_corner", extent.upper.clone());
    facts.add("extent", extent.diagonal());
    let last = view.len() - 1;
    let steps = (1..view.len()).map(|j| distance(view.point(j - 1), view.point(j)));
    let (shortest, longest, repeated) =
        steps.fold((f64::INFINITY, 0.0_f64, 0_usize), |(least, most, zeros), step| {
            let least = if step > 0.0 { step.min(least) } else { least };
            (least, most.max(step), zeros + usize::from(step == 0.0))
        });
    facts.add("repeated_points", repeated);
    if longest > 0.0 {
        facts.add("shortest_step", shortest);
        facts.add("longest_step", longest);
        facts.add("gap_last_to_first", distance(view.point(last), view.point(0)));
    }
    if !table.notes.is_empty() {
        facts.add("notes", table.notes.clone());
    }
    Ok(facts)
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum: f64, (x, y)| sum.hypot(x - y))
}

fn of_surface(document: &SurfaceDocument, name: String) -> Facts {
    let mut facts = Facts(Vec::new());
    facts.add("file", name);
    facts.add("holds", format!("gimfit document, version {}", document.version));
    if let Some(SurfaceKind::Surface(surface)) = &document.geometry {
        let closed = match surface.periodic {
            [false, false] => "open surface",
            [true, false] => "surface closed in u",
            [false, true] => "surface closed in v",
            [true, true] => "surface closed in u and v",
        };
        facts.add("geometry", closed);
        facts.add("degrees", surface.degrees.to_vec());
        facts.add("dimension", surface.dimension);
        facts.add("knots", surface.knots.each_ref().map(Vec::len).to_vec());
        if let Ok(surface) = surface.surface() {
            facts.add("control_points", surface.control_net().shape().to_vec());
            for (name, (start, end)) in ["domain_u", "domain_v"].into_iter().zip(surface.domain()) {
                facts.add(name, vec![start, end]);
            }
        }
    }
    if let Some(blending) = &document.blending {
        facts.add("bases", blending.bases.to_vec());
    }
    if let Some(report) = &document.report {
        if let Some(source) = &report.source {
            facts.add("fitted_to", source.clone());
        }
        facts.add("points", report.points.to_vec());
        facts.add("method", report.run.method.clone());
        facts.add("parameters", report.parameterizations.to_vec());
        facts.add("knot_placement", report.knot_placements.to_vec());
        facts.add("iterations", report.run.iterations);
        facts.add("ended_by", report.run.termination.clone());
        add_residuals(&mut facts, &report.run);
        facts.add("largest_deviation", report.max_deviation);
        facts.add("extent", report.run.extent);
    }
    if let Some(sequence) = &document.sequence {
        let kept: Vec<usize> = sequence.iter().map(|kept| kept.entry.iteration).collect();
        facts.add("kept_iterations", kept);
    }
    facts
}

fn of_triangle(document: &TriangleDocument, name: String) -> Facts {
    let mut facts = Facts(Vec::new());
    facts.add("file", name);
    facts.add("holds", format!("gimfit document, version {}", document.version));
    if let Some(TriangleKind::Triangle(triangle)) = &document.geometry {
        facts.add("geometry", "triangular patch");
        facts.add("degree", triangle.degree);
        facts.add("dimension", triangle.dimension);
        let count = triangle.control_points.values.len() / triangle.dimension.max(1);
        facts.add("control_points", count);
    }
    if let Some(report) = &document.report {
        if let Some(source) = &report.source {
            facts.add("fitted_to", source.clone());
        }
        facts.add("points", report.points);
        facts.add("method", report.run.method.clone());
        facts.add("iterations", report.run.iterations);
        facts.add("ended_by", report.run.termination.clone());
        add_residuals(&mut facts, &report.run);
        facts.add("largest_deviation", report.max_deviation);
        facts.add("extent", report.run.extent);
    }
    if let Some(sequence) = &document.sequence {
        let kept: Vec<usize> = sequence.iter().map(|kept| kept.iteration).collect();
        facts.add("kept_iterations", kept);
    }
    facts
}

fn of_document(document: &Document, name: String) -> Facts {
    let mut facts = Facts(Vec::new());
    facts.add("file", name);
    facts.add("holds", format!("gimfit document, version {}", document.version));
    if let Some(Geometry::Curve(curve)) = &document.geometry {
        let count = curve.control_points.values.len() / curve.dimension.max(1);
        facts.add("geometry", if curve.periodic { "closed curve" } else { "open curve" });
        facts.add("degree", curve.degree);
        facts.add("dimension", curve.dimension);
        facts.add("control_points", count);
        facts.add("knots", curve.knots.len());
        if let Ok(curve) = curve.curve() {
            let (start, end) = curve.domain();
            facts.add("domain", vec![start, end]);
        }
    }
    if let Some(blending) = &document.blending {
        facts.add("basis", blending.basis.clone());
    }
    if let Some(report) = &document.report {
        if let Some(source) = &report.source {
            facts.add("fitted_to", source.clone());
        }
        facts.add("points", report.points);
        facts.add("method", report.run.method.clone());
        facts.add("parameters", report.parameterization.clone());
        facts.add("knot_placement", report.knot_placement.clone());
        facts.add("iterations", report.run.iterations);
        facts.add("ended_by", report.run.termination.clone());
        add_residuals(&mut facts, &report.run);
        facts.add("largest_deviation", report.max_deviation);
        facts.add("extent", report.run.extent);
    }
    if let Some(sequence) = &document.sequence {
        let kept: Vec<usize> = sequence.iter().map(|kept| kept.iteration).collect();
        facts.add("kept_iterations", kept);
    }
    facts
}
