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
    (0..MOST_EARLIER).map(|k| k * (count - 1) / (MOST_EARLIER - 1)).collect()
}

/// Entries of the legend, in the order in which the eye looks for them.
pub(super) fn legend(figure: &CurveFigure<'_>, looks: Looks) -> Vec<Entry> {
    let (points, controls) = (figure.data().len(), figure.control().len());
    let mut entries = vec![
        Entry {
            sample: Sample::Line(style::CURVE.to_owned(), 2.0),
            name: "fitted curve".to_owned(),
        },
        Entry {
            sample: Sample::Dot(looks.data_colour().to_owned(), looks.dot_radius.max(1.8)),
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

/// How marks look, given how close together they lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Looks {
    /// Whether data points would hide the curve; they then lie under it.
    crowded: bool,
    dot_radius: f64,
    /// Side of the squares at control points; none if they would merge.
    square_side: Option<f64>,
}

impl Default for Looks {
    fn default() -> Self {
        Self { crowded: false, dot_radius: 2.4, square_side: Some(6.0) }
    }
}

impl Looks {
    fn of(data: &[Px], control: &[Px]) -> Self {
        let (dots, squares) = (typical_gap(data), typical_gap(control));
        // Where there are many, they are not each looked at.
        let largest_dot = if data.len() > 60 { 1.8 } else { 2.5 };
        let largest_square = if control.len() > 60 { 4.6 } else { 6.0 };
        let crowded = data.len() > 1000 || (data.len() > 40 && dots < 4.0);
        Self {
            crowded,
            dot_radius: if crowded { 2.2 } else { (0.14 * dots).clamp(1.3, largest_dot) },
            square_side: (control.len() <= 20 || (squares > 3.0 && control.len() <= 2000))
                .then(|| (0.36 * squares).clamp(2.6, largest_square)),
        }
    }

    fn data_colour(&self) -> &'static str {
        if self.crowded { style::DATA_MANY } else { style::DATA }
    }
}

/// The median distance between neighbours: a few long jumps do not count.
fn typical_gap(points: &[Px]) -> f64 {
    let mut gaps: Vec<f64> = points
        .windows(2)
        .map(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1))
        .filter(|gap| gap.is_finite())
        .collect();
    if gaps.is_empty() {
        return 100.0;
    }
    let middle = gaps.len() / 2;
    *gaps.select_nth_unstable_by(middle, f64::total_cmp).1
}

impl Layers {
    /// Draws all layers into `area`. `share` is the part of the picture's
    /// budget of points that this panel may use.
    pub(super) fn draw(
        &self,
        svg: &mut Svg,
        area: Rect,
        id: &str,
        share: f64,
        notes: &mut Notes,
    ) -> Looks {
        let looks = Looks::of(&self.data, &self.control);
        let most = ((MOST_POINTS as f64 * share) as usize).max(64);
        plot::open_clipped(svg, area, 0.0, id);
        if looks.crowded {
            self.draw_data(svg, most, looks, notes);
        }
        let count = self.earlier.len();
        for (k, curve) in self.earlier.iter().enumerate() {
            draw_polyline(svg, curve, most, &style::ramp(k, count), 1.1);
        }
        self.draw_control(svg, most, looks, notes);
        self.draw_curve(svg, most, looks, notes);
        if !looks.crowded {
            self.draw_data(svg, most, looks, notes);
        }
        svg.close("g");
        looks
    }

    fn draw_data(&self, svg: &mut Svg, most: usize, looks: Looks, notes: &mut Notes) {
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
            .attribute("stroke", looks.data_colour())
            .number("stroke-width", 2.0 * looks.dot_radius)
            .attribute("stroke-linecap", "round")
            .end();
    }

    fn draw_control(&self, svg: &mut Svg, most: usize, looks: Looks, notes: &mut Notes) {
        let mut polygon = self.control.clone();
        if self.closed {
            polygon.extend(self.control.first());
        }
        let Some(side) = looks.square_side else {
            // A dense polygon is a band; pale, it lets the curve be seen.
            svg.tag("g").number("opacity", 0.4).open();
            let stride = draw_polyline(svg, &polygon, most, style::CONTROL, 1.1);
            svg.close("g");
            notes.stride("control point", stride);
            notes.add("control points too close together to mark each".to_owned());
            return;
        };
        draw_polyline(svg, &polygon, most, style::CONTROL, 0.8);
        let squares = every_nth(&self.control, most);
        notes.stride("control point", squares.stride);
        let mut path = Path::default();
        for p in squares.points.iter().filter(|p| shown(p)) {
            path.square(*p, side);
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

    fn draw_curve(&self, svg: &mut Svg, most: usize, looks: Looks, notes: &mut Notes) {
        let width = if looks.crowded { 1.5 } else { 1.9 };
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
        let samples: Vec<Px> =
            if self.curve.is_empty() { ends.collect() } else { self.curve.clone() };
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
pub(crate) fn polyline(points: &[Px]) -> Path {
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
pub(crate) fn stroke(svg: &mut Svg, path: &Path, colour: &str, width: f64) {
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
