//! Where the parts of a figure go, and the figure as a whole.

use super::layers::Looks;
use super::legend;
use super::notes::Notes;
use super::plot::Rect;
use super::range::{InUnits, Scaled};
use super::scale::Interval;
use super::style::{self, AXIS_BELOW, AXIS_LEFT, MARGIN};
use super::svg::Svg;
use super::{
    CurveFigure, layers, panel_coordinates, panel_error, panel_history, panel_shape, panel_space,
    text,
};

/// Width of the frames of the panels beside the main one.
const SIDE_WIDTH: f64 = 330.0;
/// Widths between which the main panel adapts to the curve.
pub(crate) const MAIN_WIDTH: (f64, f64) = (430.0, 700.0);
/// Height of the main panel beside the others.
pub(crate) const MAIN_HEIGHT: f64 = 520.0;
/// A plane curve this many times wider than high gets the whole width, with
/// the other panels under it.
pub(crate) const WIDE_ASPECT: f64 = 2.6;
/// Width of the main panel of such a curve, and its least and greatest height.
pub(crate) const WHOLE_WIDTH: f64 = 1040.0;
pub(crate) const WIDE_HEIGHT: (f64, f64) = (190.0, 420.0);
/// Height of the panels under a main panel.
const UNDER_HEIGHT: f64 = 210.0;
/// Between the axis labels of a panel and the heading of the one below it.
const HEADING: f64 = 34.0;
/// Least height of one of several stacked panels.
const STACKED_HEIGHT: f64 = 92.0;

/// What the main panel shows.
enum Main {
    Plane(Option<[Interval; 2]>),
    Space(Option<panel_space::Scene>),
    Coordinates,
}

/// Frames of the panels, and the size of the whole.
pub(crate) struct Layout {
    pub(crate) main: Rect,
    pub(crate) error: Rect,
    pub(crate) history: Rect,
    pub(crate) width: f64,
    pub(crate) bottom: f64,
}

/// Draws the whole figure.
pub(super) fn curve_figure(figure: &CurveFigure<'_>) -> String {
    let scaled = Scaled::of(figure);
    let sequence = scaled.as_ref().map(|scaled| scaled.sequence(figure)).unwrap_or_default();
    let figure = &InUnits::new(figure, scaled.as_ref(), &sequence);
    let mut notes = Notes::default();
    let main = match figure.dimension {
        2 => Main::Plane(panel_shape::intervals(figure, &mut notes)),
        3 => Main::Space(panel_space::Scene::of(figure, &mut notes)),
        _ => Main::Coordinates,
    };
    layers::note_earlier(figure.sequence.len(), &mut notes);
    let (main_width, main_height, under) = main_size(&main, figure.dimension);
    let width = whole_width(main_width, under);
    let (caption, top) = wrapped_caption(figure.caption, width);
    // Where the marks turn out smaller, the legend takes up no less room.
    let rows = |looks| legend::rows(layers::legend(figure, looks), main_width);
    let legend_rows = rows(Looks::default()).len();
    let layout = place(main_width, main_height, under, top, legend_rows, width);

    let mut svg = Svg::default();
    let looks = match main {
        Main::Plane(shown) => panel_shape::draw(&mut svg, layout.main, figure, shown, &mut notes),
        Main::Space(scene) => panel_space::draw(&mut svg, layout.main, figure, scene, &mut notes),
        Main::Coordinates => panel_coordinates::draw(&mut svg, layout.main, figure, &mut notes),
    };
    legend::draw(&mut svg, layout.main, &rows(looks));
    panel_error::draw(&mut svg, layout.error, figure, &mut notes);
    let histories = panel_history::Histories {
        residuals: figure.history,
        normal: figure.normal_history,
        names: panel_history::CONVERGENCE,
    };
    panel_history::draw(&mut svg, layout.history, histories, figure.extent, &mut notes);
    let body = svg.finish();
    whole(figure.title, &layout, &caption, &notes, &body)
}

/// Width of the picture around a main panel `main_width` wide.
pub(crate) fn whole_width(main_width: f64, under: bool) -> f64 {
    if under {
        2.0 * MARGIN + AXIS_LEFT + main_width
    } else {
        2.0 * (MARGIN + AXIS_LEFT) + main_width + MARGIN + SIDE_WIDTH
    }
}

/// Lines of the caption, and where the heading of the picture ends.
pub(crate) fn wrapped_caption(caption: &str, width: f64) -> (Vec<String>, f64) {
    let caption = text::wrap(caption, style::CAPTION_SIZE, width - 2.0 * MARGIN, 3);
    let top = MARGIN + 22.0 + 17.0 * caption.len() as f64 + 18.0;
    (caption, top)
}

/// Width and height of the main panel, and whether the others go under it.
fn main_size(main: &Main, dimension: usize) -> (f64, f64, bool) {
    match main {
        Main::Plane(Some(shown)) => {
            let aspect = panel_shape::aspect(shown);
            if aspect > WIDE_ASPECT {
                let inset = 2.0 * panel_shape::INSET;
                let height = (WHOLE_WIDTH - inset) / aspect + inset;
                let height = height.clamp(WIDE_HEIGHT.0, WIDE_HEIGHT.1).round();
                (WHOLE_WIDTH, height, true)
            } else {
                let width = (aspect * MAIN_HEIGHT).clamp(MAIN_WIDTH.0, MAIN_WIDTH.1).round();
                (width, MAIN_HEIGHT, false)
            }
        }
        Main::Coordinates => {
            let count = panel_coordinates::drawn(dimension) as f64;
            (MAIN_WIDTH.1, MAIN_HEIGHT.max(STACKED_HEIGHT * count), false)
        }
        Main::Space(Some(scene)) => {
            let width = scene.width_for(MAIN_HEIGHT);
            // NaN-proof: a clamp would pass it on.
            let width = width.max(MAIN_WIDTH.0).min(MAIN_WIDTH.1).round();
            (width, MAIN_HEIGHT, false)
        }
        _ => (MAIN_WIDTH.1, MAIN_HEIGHT, false),
    }
}

/// Places the panels under a heading that ends at `top`.
pub(crate) fn place(
    main_width: f64,
    main_height: f64,
    under: bool,
    top: f64,
    legend_rows: usize,
    width: f64,
) -> Layout {
    let main = Rect {
        x: MARGIN + AXIS_LEFT,
        y: top + 6.0 + legend::ROW_HEIGHT * legend_rows as f64,
        width: main_width,
        height: main_height,
    };
    let (error, history) = if under {
        let half = 0.5 * (main_width - AXIS_LEFT - 0.5 * MARGIN);
        let error = Rect {
            x: main.x,
            y: main.bottom() + AXIS_BELOW + HEADING,
            width: half,
            height: UNDER_HEIGHT,
        };
        let history = Rect { x: main.right() - half, ..error };
        (error, history)
    } else {
        let height = (0.5 * (main_height - AXIS_BELOW - HEADING)).min(300.0);
        let error =
            Rect { x: main.right() + MARGIN + AXIS_LEFT, y: main.y, width: SIDE_WIDTH, height };
        let history = Rect { y: error.bottom() + AXIS_BELOW + HEADING, ..error };
        (error, history)
    };
    Layout { main, error, history, width, bottom: main.bottom().max(history.bottom()) + AXIS_BELOW }
}

/// The document around `body`: its size, background, title, caption, notes.
pub(crate) fn whole(
    title: &str,
    layout: &Layout,
    caption: &[String],
    notes: &Notes,
    body: &str,
) -> String {
    let room = layout.width - 2.0 * MARGIN;
    let remarks = text::wrap(&notes.sentence(), style::NOTE_SIZE, room, 4);
    let height = (layout.bottom + 14.0 * remarks.len() as f64 + 0.7 * MARGIN).ceil();
    let mut svg = Svg::default();
    svg.tag("svg")
        .attribute("xmlns", "http://www.w3.org/2000/svg")
        .number("width", layout.width)
        .number("height", height)
        .attribute("viewBox", &format!("0 0 {} {height}", layout.width))
        .attribute("font-family", style::FONT_FAMILY)
        .attribute("role", "img")
        .open();
    let title = text::fit(title.trim(), style::TITLE_SIZE, room);
    svg.tag("title").plain(&title);
    svg.tag("rect")
        .attribute("width", "100%")
        .attribute("height", "100%")
        .attribute("fill", style::BACKGROUND)
        .end();
    let mut y = MARGIN + 14.0;
    svg.label((MARGIN, y), style::TITLE_SIZE, style::INK, "start", &title);
    y += 7.0;
    for line in caption {
        y += 17.0;
        svg.label((MARGIN, y), style::CAPTION_SIZE, style::INK_SOFT, "start", line);
    }
    let mut out = svg.finish();
    out.push_str(body);
    let mut svg = Svg::default();
    for (k, line) in remarks.iter().enumerate() {
        let at = (MARGIN, layout.bottom + 14.0 * (k as f64 + 1.0));
        svg.label(at, style::NOTE_SIZE, style::INK_SOFT, "start", line);
    }
    svg.close("svg");
    out.push_str(&svg.finish());
    out
}
