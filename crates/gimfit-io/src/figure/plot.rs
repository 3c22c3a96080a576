//! A framed rectangle with axes, the base of every panel but the spatial one.

use super::svg::Svg;
use super::{style, text};

/// A rectangle of the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rect {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Rect {
    pub(crate) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.height
    }

    /// Left and right end.
    pub(crate) fn across(&self) -> (f64, f64) {
        (self.x, self.right())
    }

    /// Lower and upper end, in the sense of growing values.
    pub(crate) fn upward(&self) -> (f64, f64) {
        (self.bottom(), self.y)
    }
}

/// One axis as it is drawn: positions in the picture, labels, name.
#[derive(Clone, Debug, Default)]
pub(crate) struct Axis {
    /// Position and label; an empty label draws the grid line alone.
    pub(crate) marks: Vec<(f64, String)>,
    pub(crate) name: String,
    /// Whether the labels need something added to be the values.
    pub(crate) has_offset: bool,
}

impl Axis {
    /// An axis with the ticks of `scale`, whose values are in units of ten to
    /// the power of `unit`, named `name` and, in brackets, what all labels have
    /// in common.
    pub(crate) fn linear(
        scale: &super::scale::Scale,
        direction: super::ticks::Direction,
        name: &str,
        unit: i32,
    ) -> Self {
        let ticks = super::ticks::linear_ticks(scale.values(), scale.length(), direction, unit);
        Self::with_ticks(scale, ticks, name)
    }

    /// As [`Axis::linear`], with labels at whole numbers only.
    pub(crate) fn whole(
        scale: &super::scale::Scale,
        direction: super::ticks::Direction,
        name: &str,
    ) -> Self {
        let ticks = super::ticks::whole_ticks(scale.values(), scale.length(), direction);
        Self::with_ticks(scale, ticks, name)
    }

    fn with_ticks(scale: &super::scale::Scale, ticks: super::ticks::Ticks, name: &str) -> Self {
        let name = match (name.is_empty(), ticks.common.is_empty()) {
            (_, true) => name.to_owned(),
            (true, false) => ticks.common.clone(),
            (false, false) => format!("{name}  ({})", ticks.common),
        };
        let marks =
            ticks.marks.into_iter().map(|(value, label)| (scale.at(value), label)).collect();
        Self { marks, name, has_offset: ticks.has_offset }
    }
}

impl Axis {
    /// An axis with the decades of `log`.
    pub(crate) fn logarithmic(log: &super::log_axis::LogScale, name: &str) -> Self {
        Self { marks: log.marks(17.0), name: name.to_owned(), has_offset: false }
    }
}

/// Draws grid, frame, labels and names; the content comes on top of it.
pub(crate) fn draw_axes(svg: &mut Svg, area: Rect, x: &Axis, y: &Axis) {
    for (at, _) in &x.marks {
        svg.line((*at, area.y), (*at, area.bottom()), style::GRID, 1.0);
    }
    for (at, _) in &y.marks {
        svg.line((area.x, *at), (area.right(), *at), style::GRID, 1.0);
    }
    svg.tag("rect")
        .number("x", area.x)
        .number("y", area.y)
        .number("width", area.width)
        .number("height", area.height)
        .attribute("fill", "none")
        .attribute("stroke", style::FRAME)
        .end();
    let size = style::LABEL_SIZE;
    for (at, label) in x.marks.iter().filter(|mark| !mark.1.is_empty()) {
        let place = (*at, area.bottom() + 16.0);
        svg.label(place, size, style::INK_SOFT, "middle", label);
    }
    for (at, label) in y.marks.iter().filter(|mark| !mark.1.is_empty()) {
        let place = (area.x - 7.0, at + 0.36 * size);
        svg.label(place, size, style::INK_SOFT, "end", label);
    }
    if !x.name.is_empty() {
        let place = (area.x + 0.5 * area.width, area.bottom() + 35.0);
        let name = text::fit(&x.name, size + 0.5, area.width);
        svg.label(place, size + 0.5, style::INK, "middle", &name);
    }
    upright_name(svg, area, &y.name);
}

/// The name of the axis at the left, read from below.
fn upright_name(svg: &mut Svg, area: Rect, name: &str) {
    if name.is_empty() {
        return;
    }
    let size = style::LABEL_SIZE + 0.5;
    let place = (area.x - 60.0, area.y + 0.5 * area.height);
    svg.tag("g")
        .attribute("transform", &format!("translate({:.2} {:.2}) rotate(-90)", place.0, place.1))
        .open();
    let name = text::fit(name, size, area.height + 20.0);
    svg.label((0.0, 0.0), size, style::INK, "middle", &name);
    svg.close("g");
}

/// Heading at the left above a panel.
pub(crate) fn heading(svg: &mut Svg, area: Rect, content: &str) {
    let place = (area.x, area.y - 10.0);
    let content = text::fit(content, style::HEADING_SIZE, area.width);
    svg.label(place, style::HEADING_SIZE, style::INK, "start", &content);
}

/// A group whose content is cut at the edges of `area`, grown by `margin`;
/// `id` must be the only one of its name in the figure. Close with `g`.
pub(crate) fn open_clipped(svg: &mut Svg, area: Rect, margin: f64, id: &str) {
    svg.tag("clipPath").attribute("id", id).open();
    svg.tag("rect")
        .number("x", area.x - margin)
        .number("y", area.y - margin)
        .number("width", area.width + 2.0 * margin)
        .number("height", area.height + 2.0 * margin)
        .end();
    svg.close("clipPath");
    svg.tag("g").attribute("clip-path", &format!("url(#{id})")).open();
}
