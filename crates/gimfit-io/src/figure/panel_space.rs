//! The main panel of a spatial curve: an orthographic view into a box whose
//! three far sides carry the axes.

use super::decimate::Px;
use super::extent;
use super::layers::{self, Layers, Looks};
use super::notes::Notes;
use super::plot::Rect;
use super::range::InUnits;
use super::rows::Rows;
use super::scale::{Interval, Scale, equal_scales};
use super::svg::Svg;
use super::ticks::{self, Direction};
use super::view::View;
use super::{CurveFigure, message, style, text};

/// Room around the box for labels.
const AROUND: f64 = 50.0;
/// Above the box there are none.
const ABOVE: f64 = 8.0;

/// A side of the box is never thinner than this part of the longest side.
pub(crate) const THINNEST: f64 = 0.12;

/// The box of a curve and how it is seen.
pub(crate) struct Scene {
    view: View,
    sides: [Interval; 3],
    /// What the box covers across and upward.
    cover: [Interval; 2],
}

impl Scene {
    /// The scene of `figure`, or `None` without any point.
    pub(super) fn of(figure: &CurveFigure<'_>, notes: &mut Notes) -> Option<Self> {
        let shown = extent::of_coordinates(figure, 0..3, notes);
        let [Some(x), Some(y), Some(z)] = shown.as_slice() else {
            return None;
        };
        let shown = [*x, *y, *z];
        let longest = shown.iter().map(Interval::span).fold(0.0, f64::max);
        let sides = shown.map(|values| {
            let missing = (THINNEST * longest - values.span()).max(0.0);
            extent::padded(values.grown(0.5 * missing))
        });
        Self::seen(View::of(figure.data(), &sides), sides)
    }

    /// The box with these `sides`, seen as in `view`; `None` if it has none.
    pub(crate) fn seen(view: View, sides: [Interval; 3]) -> Option<Self> {
        let corners = (0..8).map(|number| view.project(&corner(&sides, number)));
        let (us, vs): (Vec<f64>, Vec<f64>) = corners.unzip();
        let cover = [Interval::around(us.into_iter())?, Interval::around(vs.into_iter())?];
        Some(Self { view, sides, cover })
    }

    /// Width of a panel `height` high that the box fills.
    pub(crate) fn width_for(&self, height: f64) -> f64 {
        let [across, upward] = self.cover.map(|interval| interval.opened().span());
        (height - AROUND - ABOVE) * across / upward + 2.0 * AROUND
    }

    /// Height of a panel `width` wide that the box fills.
    pub(crate) fn height_for(&self, width: f64) -> f64 {
        let [across, upward] = self.cover.map(|interval| interval.opened().span());
        (width - 2.0 * AROUND) * upward / across + AROUND + ABOVE
    }
}

/// Draws the panel into `area`.
pub(super) fn draw(
    svg: &mut Svg,
    area: Rect,
    figure: &InUnits<'_>,
    scene: Option<Scene>,
    notes: &mut Notes,
) -> Looks {
    let Some(scene) = scene else {
        message(svg, area, "no points to draw");
        return Looks::default();
    };
    let stage = Stage::new(area, &scene);
    let names = [0, 1, 2].map(|k| figure.coordinate_name(k));
    stage.draw_box(svg, &names, [0, 1, 2].map(|k| figure.unit(k)), true, notes);
    let places = |rows: Rows<'_>| rows.iter().map(|p| stage.place(p)).collect::<Vec<_>>();
    let layers = Layers {
        data: places(figure.data()),
        control: places(figure.control()),
        closed: figure.closed,
        curve: places(figure.curve()),
        pieces: Vec::new(),
        earlier: layers::earlier_drawn(figure.sequence.len())
            .into_iter()
            .map(|k| places(Rows::new(figure.sequence[k].curve.points, 3)))
            .collect(),
    };
    layers.draw(svg, area, "space", 1.0, notes)
}

/// A view fitted into the panel.
pub(crate) struct Stage {
    pub(crate) view: View,
    sides: [Interval; 3],
    across: Scale,
    upward: Scale,
}

impl Stage {
    pub(crate) fn new(area: Rect, scene: &Scene) -> Self {
        let within = Rect {
            x: area.x + AROUND,
            y: area.y + ABOVE,
            width: area.width - 2.0 * AROUND,
            height: area.height - AROUND - ABOVE,
        };
        Self::filling(within, scene)
    }

    /// The same view without room for axes.
    pub(crate) fn filling(area: Rect, scene: &Scene) -> Self {
        let [x, y] = scene.cover;
        let (across, upward) = equal_scales(x, y, area.across(), area.upward(), 0.0);
        Self { view: scene.view, sides: scene.sides, across, upward }
    }

    pub(crate) fn place(&self, point: &[f64]) -> Px {
        let (u, v) = self.view.project(point);
        (self.across.at(u), self.upward.at(v))
    }

    /// The value of coordinate `k` on the near or the far side of the box.
    fn side(&self, k: usize, near: bool) -> f64 {
        if self.view.sees_high_side(k) == near { self.sides[k].high } else { self.sides[k].low }
    }

    /// Draws axes named `names`, in units of ten to the power of `units`, and
    /// the edges of the far sides. Offsets of labels are written `beside` the
    /// names, or else in the notes.
    pub(crate) fn draw_box(
        &self,
        svg: &mut Svg,
        names: &[String; 3],
        units: [i32; 3],
        beside: bool,
        notes: &mut Notes,
    ) {
        for k in 0..3 {
            let common = self.draw_axis(svg, k, (&names[k], units[k]), beside);
            match common {
                Some(_) if beside => notes.offset_of_labels(),
                Some(common) => notes.add(format!("labels of the {} axis {common}", names[k])),
                None => {}
            }
        }
        // Edges of the three far sides, each once or twice.
        for k in 0..3 {
            for (a, b) in [(false, false), (false, true), (true, false)] {
                let (from, to) = self.edge(k, a, b);
                svg.line(from, to, style::FRAME, 0.9);
            }
        }
    }

    /// The edge along coordinate `k` on the near or far sides of the next two
    /// coordinates.
    fn edge(&self, k: usize, near_next: bool, near_last: bool) -> (Px, Px) {
        let mut point = [0.0; 3];
        point[(k + 1) % 3] = self.side((k + 1) % 3, near_next);
        point[(k + 2) % 3] = self.side((k + 2) % 3, near_last);
        point[k] = self.sides[k].low;
        let from = self.place(&point);
        point[k] = self.sides[k].high;
        (from, self.place(&point))
    }

    /// Whether the labelled edge along `k` lies on the near side of the next
    /// two coordinates: the outer edge of the floor, or the one at the left.
    fn labelled_edge(&self, k: usize) -> (bool, bool) {
        match k {
            0 => (true, false),
            1 => (false, true),
            _ => {
                let left = self.edge(2, false, true).0.0 < self.edge(2, true, false).0.0;
                if left { (false, true) } else { (true, false) }
            }
        }
    }

    /// Draws grid, labels and name, with its unit; returns what all labels
    /// have in common if that is an offset.
    fn draw_axis(
        &self,
        svg: &mut Svg,
        k: usize,
        (name, unit): (&str, i32),
        beside: bool,
    ) -> Option<String> {
        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
        let (near_next, near_last) = self.labelled_edge(k);
        let (from, to) = self.edge(k, near_next, near_last);
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let direction = if k == 2 { Direction::Upward } else { Direction::Across };
        let values = self.sides[k].opened();
        let ticks = ticks::linear_ticks(values, length, direction, unit);
        let mut widest = 0.0_f64;
        let outward = self.outward(from, to);
        for (value, label) in &ticks.marks {
            let mut point = [0.0; 3];
            point[k] = *value;
            point[next] = self.side(next, near_next);
            point[last] = self.side(last, near_last);
            let at = self.place(&point);
            // From the labelled edge over both far sides that meet it.
            let mut path = vec![at];
            for m in [next, last] {
                point[m] = self.side(m, false);
                path.push(self.place(&point));
            }
            // The far side of the coordinate whose near side has the edge.
            if near_next {
                point[last] = self.side(last, true);
            } else {
                point[next] = self.side(next, true);
            }
            path.push(self.place(&point));
            for pair in path.windows(2) {
                if pair[0] != pair[1] {
                    svg.line(pair[0], pair[1], style::GRID, 1.0);
                }
            }
            label_beside(svg, at, outward, 7.0, style::LABEL_SIZE, label);
            widest = widest.max(text::width(label, style::LABEL_SIZE));
        }
        let middle = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
        let away = 17.0 + widest * outward.0.abs() + style::LABEL_SIZE * outward.1.abs();
        let name = if ticks.common.is_empty() || (ticks.has_offset && !beside) {
            name.to_owned()
        } else {
            format!("{name}  ({})", ticks.common)
        };
        label_beside(svg, middle, outward, away, style::LABEL_SIZE + 1.0, &name);
        ticks.has_offset.then_some(ticks.common)
    }

    /// The direction from the box to the outside, across the edge.
    fn outward(&self, from: Px, to: Px) -> Px {
        let centre = self.place(&self.sides.map(|side| side.centre()));
        let along = (to.0 - from.0, to.1 - from.1);
        let length = along.0.hypot(along.1).max(1.0e-9);
        let normal = (-along.1 / length, along.0 / length);
        let middle = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
        let toward = (middle.0 - centre.0) * normal.0 + (middle.1 - centre.1) * normal.1;
        if toward < 0.0 { (-normal.0, -normal.1) } else { normal }
    }
}

/// Corner number 0 to 7 of a box.
fn corner(sides: &[Interval; 3], number: usize) -> [f64; 3] {
    let mut point = [0.0; 3];
    for k in 0..3 {
        point[k] = if number >> k & 1 == 0 { sides[k].low } else { sides[k].high };
    }
    point
}

/// A label that starts `away` from `at` in direction `outward`.
fn label_beside(svg: &mut Svg, at: Px, outward: Px, away: f64, size: f64, content: &str) {
    let anchor = if outward.0 > 0.35 {
        "start"
    } else if outward.0 < -0.35 {
        "end"
    } else {
        "middle"
    };
    // Half the height of the letters goes to the side that faces the edge.
    let place =
        (at.0 + away * outward.0, at.1 + away * outward.1 + 0.36 * size + 0.4 * size * outward.1);
    svg.label(place, size, style::INK_SOFT, anchor, content);
}
