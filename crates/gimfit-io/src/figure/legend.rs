//! Legends: rows of samples with their names, above a panel.

use super::plot::Rect;
use super::svg::{Path, Svg};
use super::{style, text};

/// What a legend entry shows before its name.
#[derive(Clone, Debug)]
pub(crate) enum Sample {
    /// A line of a colour and a width.
    Line(String, f64),
    /// A dashed line of a colour and a width.
    Dashes(String, f64),
    /// A dotted line of a colour and a width.
    Dots(String, f64),
    /// A filled dot of a colour and a radius.
    Dot(String, f64),
    /// A thin line with a hollow square.
    Polygon(String),
}

/// One entry.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) sample: Sample,
    pub(crate) name: String,
}

const SAMPLE_WIDTH: f64 = 24.0;
const GAP: f64 = 16.0;
pub(crate) const ROW_HEIGHT: f64 = 19.0;

fn entry_width(entry: &Entry) -> f64 {
    let sample = match entry.sample {
        Sample::Dot(..) => 9.0,
        _ => SAMPLE_WIDTH,
    };
    sample + 6.0 + text::width(&entry.name, style::LABEL_SIZE)
}

/// Splits `entries` into rows no wider than `room`.
pub(crate) fn rows(entries: Vec<Entry>, room: f64) -> Vec<Vec<Entry>> {
    let mut rows: Vec<Vec<Entry>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in entries {
        let wide = entry_width(&entry);
        match rows.last_mut() {
            Some(row) if used + GAP + wide <= room => {
                row.push(entry);
                used += GAP + wide;
            }
            _ => {
                rows.push(vec![entry]);
                used = wide;
            }
        }
    }
    rows
}

/// Draws `rows` so that the last one stands just above `area`.
pub(crate) fn draw(svg: &mut Svg, area: Rect, rows: &[Vec<Entry>]) {
    for (above, row) in rows.iter().rev().enumerate() {
        let y = area.y - 14.0 - ROW_HEIGHT * above as f64;
        draw_row(svg, area.x + 1.0, y, row);
    }
}

/// Draws one row that ends at the right end of `area`, beside its heading.
pub(crate) fn draw_right(svg: &mut Svg, area: Rect, row: &[Entry]) {
    let wide: f64 = row.iter().map(entry_width).sum();
    let gaps = GAP * row.len().saturating_sub(1) as f64;
    draw_row(svg, area.right() - wide - gaps, area.y - 14.0, row);
}

fn draw_row(svg: &mut Svg, mut x: f64, y: f64, row: &[Entry]) {
    for entry in row {
        let wide = entry_width(entry);
        draw_sample(svg, x, y, &entry.sample);
        let text_at = x + wide - text::width(&entry.name, style::LABEL_SIZE);
        svg.label((text_at, y + 4.0), style::LABEL_SIZE, style::INK, "start", &entry.name);
        x += wide + GAP;
    }
}

fn draw_sample(svg: &mut Svg, x: f64, y: f64, sample: &Sample) {
    let end = x + SAMPLE_WIDTH;
    match sample {
        Sample::Line(colour, width) => svg.line((x, y), (end, y), colour, *width),
        Sample::Dashes(colour, width) => broken_line(svg, x, y, colour, *width, "5 3"),
        Sample::Dots(colour, width) => broken_line(svg, x, y, colour, *width, "2 3"),
        Sample::Dot(colour, radius) => svg
            .tag("circle")
            .number("cx", x + 4.5)
            .number("cy", y)
            .number("r", *radius)
            .attribute("fill", colour)
            .end(),
        Sample::Polygon(colour) => {
            svg.line((x, y), (end, y), colour, 0.8);
            let mut square = Path::default();
            square.square((0.5 * (x + end), y), 6.0);
            svg.tag("path")
                .attribute("d", square.data())
                .attribute("fill", style::BACKGROUND)
                .attribute("stroke", colour)
                .end();
        }
    }
}

fn broken_line(svg: &mut Svg, x: f64, y: f64, colour: &str, width: f64, pattern: &str) {
    let end = x + SAMPLE_WIDTH;
    svg.tag("path")
        .attribute("d", &format!("M{x:.2} {y:.2}H{end:.2}"))
        .attribute("stroke", colour)
        .number("stroke-width", width)
        .attribute("stroke-dasharray", pattern)
        .end();
}
