//! Data points, control polygon and curves, once their places are known.

use super::decimate::{MOST_POINTS, Px, every_nth, thin_polyline};
use super::legend::{Entry, Sample};
use super::notes::Notes;
use super::plot::{self, Rect};
use super::style;
use super::svg::{Path, Svg};
use super::{CurveFigure, text};

/// Most earlier curves that are drawn; more cannot be told apart.
const MOST_EARLIER: usize = 8;

/// Places of all that one panel shows of a fit.
#[derive(Default)]
pub(super) struct Layers {
    /// Data points.
    pub(super) data: Vec<Px>,
    /// Vertices of the control polygon.
    pub(super) control: Vec<Px>,
    /// Whether the polygon is closed.
    pub(super) closed: bool,
    /// The fitted curve, densely sampled.
    pub(super) curve: Vec<Px>,
    /// The fitted curve as Bezier pieces; used instead of the samples.
    pub(super) pieces: Vec<[Px; 4]>,
    /// Curves of earlier iterations, the oldest first.
    pub(super) earlier: Vec<Vec<Px>>,
}

/// Which of `count` earlier curves are drawn: all, or the first, the last and
/// some evenly between them.
pub(super) fn earlier_drawn(count: usize) -> Vec<usize> {
    if count <= MOST_EARLIER {
        return (0..count).collect();
    }
    (0..MOST_EARLIER)
        .map(|k| k * (count - 1) / (MOST_EARLIER - 1))
        .collect()
}

/// Entries of the legend, in the order in which the eye looks for them.
pub(super) fn legend(figure: &CurveFigure<'_>) -> Vec<Entry> {
    let (points, controls) = (figure.data().len(), figure.control().len());
    let mut entries = vec![
        Entry {
            sample: Sample::Line(style::CURVE.to_owned(), 2.0),
            name: "fitted curve".to_owned(),
        },
        Entry {
            sample: Sample::Dot(data_colour(points).to_owned(), dot_radius(points).max(1.8)),
            name: format!("data points ({})", text::grouped(points)),
        },
        Entry {
            sample: Sample::Polygon(style::CONTROL.to_owned()),
            name: format!("control polygon ({})", text::grouped(controls)),
        },
    ];
    let drawn = earlier_drawn(figure.sequence.len());
    for (k, &index) in drawn.iter().enumerate() {
        entries.push(Entry {
            sample: Sample::Line(style::ramp(k, drawn.len()), 1.2),
            name: format!("iteration {}", figure.sequence[index].iteration),
        });
    }
    entries
}

/// Data points so many that they would hide the curve lie under it, paler.
fn many(points: usize) -> bool {
    points > 600
}

fn data_colour(points: usize) -> &'static str {
    if many(points) {
        style::DATA_MANY
    } else {
        style::DATA
    }
}

fn dot_radius(points: usize) -> f64 {
    match points {
        0..=60 => 2.5,
        61..=250 => 1.8,
        251..=600 => 1.4,
        _ => 1.8,
    }
}

fn square_side(controls: usize) -> f64 {
    match controls {
        0..=60 => 6.0,
        61..=150 => 4.6,
        151..=500 => 3.4,
        _ => 2.4,
    }
}

impl Layers {
    /// Draws all layers into `area`. `share` is the part of the picture's
    /// budget of points that this panel may use.
    pub(super) fn draw(&self, svg: &mut Svg, area: Rect, id: &str, share: f64, notes: &mut Notes) {
        let most = ((MOST_POINTS as f64 * share) as usize).max(64);
        plot::open_clipped(svg, area, 0.0, id);
        if many(self.data.len()) {
            self.draw_data(svg, most, notes);
        }
        let count = self.earlier.len();
        for (k, curve) in self.earlier.iter().enumerate() {
            draw_polyline(svg, curve, most, &style::ramp(k, count), 1.1);
        }
        self.draw_control(svg, most, notes);
        self.draw_curve(svg, most, notes);
        if !many(self.data.len()) {
            self.draw_data(svg, most, notes);
        }
        svg.close("g");
    }

    fn draw_data(&self, svg: &mut Svg, most: usize, notes: &mut Notes) {
        let thinned = every_nth(&self.data, most);
        notes.stride("data point", thinned.stride);
        let mut path = Path::default();
        for p in thinned.points.iter().filter(|p| shown(p)) {
            path.dot(*p);
        }
        if path.is_empty() {
            return;
        }
        svg.tag("path")
            .attribute("d", path.data())
            .attribute("fill", "none")
            .attribute("stroke", data_colour(self.data.len()))
            .number("stroke-width", 2.0 * dot_radius(self.data.len()))
            .attribute("stroke-linecap", "round")
            .end();
    }

    fn draw_control(&self, svg: &mut Svg, most: usize, notes: &mut Notes) {
        let mut polygon = self.control.clone();
        if self.closed {
            polygon.extend(self.control.first());
        }
        draw_polyline(svg, &polygon, most, style::CONTROL, 0.8);
        let squares = every_nth(&self.control, most);
        notes.stride("control point", squares.stride);
        let mut path = Path::default();
        for p in squares.points.iter().filter(|p| shown(p)) {
            path.square(*p, square_side(self.control.len()));
        }
        if path.is_empty() {
            return;
        }
        svg.tag("path")
            .attribute("d", path.data())
            .attribute("fill", "none")
            .attribute("stroke", style::CONTROL)
            .number("stroke-width", 0.8)
            .end();
    }

    fn draw_curve(&self, svg: &mut Svg, most: usize, notes: &mut Notes) {
        let width = if many(self.data.len()) { 1.4 } else { 1.9 };
        if !self.pieces.is_empty() && self.pieces.len() <= most {
            let path = path_of_pieces(&self.pieces);
            stroke(svg, &path, style::CURVE, width);
            return;
        }
        let ends = self
            .pieces
            .iter()
            .map(|piece| piece[0])
            .chain(self.pieces.last().map(|piece| piece[3]));
        let samples: Vec<Px> = if self.curve.is_empty() {
            ends.collect()
        } else {
            self.curve.clone()
        };
        let stride = draw_polyline(svg, &samples, most, style::CURVE, width);
        notes.stride("sample of the curve", stride);
    }
}

/// Whether `p` is a place; far outside counts as none, to save bytes.
fn shown(p: &Px) -> bool {
    const FAR: f64 = 5000.0;
    p.0.abs() < FAR && p.1.abs() < FAR
}

fn draw_polyline(svg: &mut Svg, points: &[Px], most: usize, colour: &str, width: f64) -> usize {
    let thinned = thin_polyline(points, most);
    stroke(svg, &polyline(&thinned.points), colour, width);
    thinned.stride
}

/// A path through `points`, interrupted where there is none.
pub(super) fn polyline(points: &[Px]) -> Path {
    let mut path = Path::default();
    let mut pen_down = false;
    for &p in points {
        if p.0.is_nan() || p.1.is_nan() {
            pen_down = false;
        } else if pen_down {
            path.line_to(p);
        } else {
            path.move_to(p);
            pen_down = true;
        }
    }
    path
}

fn path_of_pieces(pieces: &[[Px; 4]]) -> Path {
    let mut path = Path::default();
    let mut at: Option<Px> = None;
    for piece in pieces {
        if piece.iter().any(|p| p.0.is_nan() || p.1.is_nan()) {
            at = None;
            continue;
        }
        if at != Some(piece[0]) {
            path.move_to(piece[0]);
        }
        path.cubic_to(piece[1], piece[2], piece[3]);
        at = Some(piece[3]);
    }
    path
}

/// Strokes `path` with round joins.
pub(super) fn stroke(svg: &mut Svg, path: &Path, colour: &str, width: f64) {
    if path.is_empty() {
        return;
    }
    svg.tag("path")
        .attribute("d", path.data())
        .attribute("fill", "none")
        .attribute("stroke", colour)
        .number("stroke-width", width)
        .attribute("stroke-linejoin", "round")
        .end();
}

/// Tells in `notes` if not all of `count` earlier curves are drawn.
pub(super) fn note_earlier(count: usize, notes: &mut Notes) {
    if count > MOST_EARLIER {
        notes.add(format!("{MOST_EARLIER} of {count} kept iterations drawn"));
    }
}

