//! The panel of residuals: a coloured cell for each data point.

use super::colour_bar::{self, ErrorScale};
use super::{SurfaceFigure, colours};
use crate::figure::decimate::stride_for;
use crate::figure::notes::Notes;
use crate::figure::plot::{self, Axis, Rect};
use crate::figure::scale::{Interval, Scale};
use crate::figure::svg::{Path, Svg};
use crate::figure::ticks::Direction;
use crate::figure::{message, style, text};

/// Cells along each side; a cell of a larger grid stands for several points.
const MOST_CELLS: usize = 130;

/// Width of the colour bar, its distance from the map, and room for labels.
const BAR: f64 = 12.0;
const BESIDE: f64 = 12.0;
const LABELS: f64 = 42.0;

/// Draws the panel into `area`.
pub(super) fn draw(svg: &mut Svg, area: Rect, figure: &SurfaceFigure<'_>, notes: &mut Notes) {
    plot::heading(svg, area, "Error at each point");
    let Some(errors) = Errors::of(figure) else {
        message(svg, area, "no residuals");
        return;
    };
    let map = Rect { width: area.width - BESIDE - BAR - LABELS, ..area };
    let mut bar = Rect { x: map.right() + BESIDE, width: BAR, ..area };
    let zeros = errors.values.iter().filter(|v| **v <= 0.0).count();
    if zeros > 0 {
        bar.height -= colour_bar::FOR_ZERO;
    }
    // A triangle of points leaves the rest of its square without a number.
    let count = text::grouped(errors.values.iter().filter(|value| !value.is_nan()).count());
    let scale = ErrorScale::of(errors.values, bar.bottom(), bar.y);
    draw_axes(svg, map, &errors);
    let Some(scale) = scale else {
        // Without any number there is nothing that could be 0 either.
        message(svg, map, if zeros > 0 { "all errors are 0" } else { "no residuals" });
        return;
    };
    let step = |error| colours::step((bar.bottom() - scale.at(error).0) / bar.height);
    draw_cells(svg, map, &errors, &step, "errors");
    colour_bar::draw(svg, bar, &scale);
    if zeros > 0 {
        colour_bar::draw_zero(svg, bar);
        notes.add(format!("{} of {count} errors are 0 (pale grey)", text::grouped(zeros)));
    }
    let below = errors.values.iter().filter(|v| **v > 0.0 && scale.at(**v).1).count();
    if below > 0 {
        let (below, bottom) = (text::grouped(below), scale.bottom_label());
        notes.add(format!("{below} of {count} errors below {bottom} in the darkest colour"));
    }
    let [down, across] = errors.block;
    if down > 1 || across > 1 {
        let size = format!("{} × {}", text::grouped(down), text::grouped(across));
        notes.add(format!("each cell of the error map shows the largest of {size} errors"));
    }
}

/// Residuals as whole rows, and how many of them make a cell.
pub(super) struct Errors<'a> {
    rows: usize,
    columns: usize,
    values: &'a [f64],
    block: [usize; 2],
}

impl<'a> Errors<'a> {
    pub(super) fn of(figure: &SurfaceFigure<'a>) -> Option<Self> {
        let [rows, columns] = figure.data_shape;
        let rows = figure.residuals.len().checked_div(columns)?.min(rows);
        let values = figure.residuals.get(..rows * columns)?;
        let block = [rows, columns].map(|count| stride_for(count, MOST_CELLS));
        (rows > 0).then_some(Self { rows, columns, values, block })
    }

    /// The largest number among the errors of a cell.
    fn cell(&self, down: usize, across: usize) -> Option<f64> {
        let range = |k: usize, size: usize, count: usize| k * size..((k + 1) * size).min(count);
        let columns = range(across, self.block[1], self.columns);
        range(down, self.block[0], self.rows)
            .filter_map(|i| self.values.get(i * self.columns..(i + 1) * self.columns))
            .filter_map(|row| row.get(columns.clone()))
            .flatten()
            .copied()
            .filter(|value| !value.is_nan())
            .reduce(f64::max)
    }
}

fn draw_axes(svg: &mut Svg, map: Rect, errors: &Errors<'_>) {
    // Counted from 1, as reports and files have it.
    let ends = |count: usize| Interval { low: 0.5, high: count as f64 + 0.5 };
    let across = Scale::new(ends(errors.columns), map.x, map.right());
    // The first row at the top, as tables and files have it.
    let down = Scale::new(ends(errors.rows), map.y, map.bottom());
    let horizontal = Axis::whole(&across, Direction::Across, "column");
    let upright = Axis::whole(&down, Direction::Upward, "row");
    plot::draw_axes(svg, map, &horizontal, &upright);
    for (at, _) in &horizontal.marks {
        svg.line((*at, map.bottom()), (*at, map.bottom() + 3.0), style::FRAME, 1.0);
    }
    for (at, _) in &upright.marks {
        svg.line((map.x - 3.0, *at), (map.x, *at), style::FRAME, 1.0);
    }
}

/// Draws the cells, each colour at once, as strokes along the rows; `id` must be the only one of
/// its name in the figure.
pub(super) fn draw_cells(
    svg: &mut Svg,
    map: Rect,
    errors: &Errors<'_>,
    step: &dyn Fn(f64) -> usize,
    id: &str,
) {
    let cells = [0, 1].map(|k| [errors.rows, errors.columns][k].div_ceil(errors.block[k]));
    // One path for each colour, and the last one for zeros.
    let mut paths: Vec<Path> = Vec::new();
    paths.resize_with(colours::STEPS + 1, Path::default);
    for i in 0..cells[0] {
        let row: Vec<Option<usize>> = (0..cells[1])
            .map(|j| errors.cell(i, j).map(|v| if v > 0.0 { step(v) } else { colours::STEPS }))
            .collect();
        let mut start = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let step = run.first().copied().flatten();
            if let Some(path) = step.and_then(|step| paths.get_mut(step)) {
                path.level((start as f64, i as f64), run.len() as f64);
            }
            start += run.len();
        }
    }
    let width = map.width * errors.block[1] as f64 / errors.columns as f64;
    let height = map.height * errors.block[0] as f64 / errors.rows as f64;
    // One unit to a cell makes for short numbers.
    let y = map.y + 0.5 * height;
    let transform = format!("translate({:.4} {y:.4}) scale({width:.6} {height:.6})", map.x);
    plot::open_clipped(svg, map, 0.0, id);
    svg.tag("g")
        .attribute("transform", &transform)
        .attribute("shape-rendering", "crispEdges")
        .attribute("fill", "none")
        .open();
    for (step, path) in paths.iter().enumerate().filter(|(_, path)| !path.is_empty()) {
        let colour =
            if step < colours::STEPS { colours::colour(step) } else { colours::ZERO.to_owned() };
        svg.tag("path").attribute("d", path.data()).attribute("stroke", &colour).end();
    }
    svg.close("g");
    svg.close("g");
}
