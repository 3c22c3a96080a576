//! The figure as a whole.

use super::panel_surface::{self, Main};
use super::{SurfaceFigure, family, panel_map};
use crate::figure::layout::{
    MAIN_HEIGHT, MAIN_WIDTH, WHOLE_WIDTH, WIDE_ASPECT, WIDE_HEIGHT, place, whole, whole_width,
    wrapped_caption,
};
use crate::figure::notes::Notes;
use crate::figure::svg::Svg;
use crate::figure::{legend, panel_history, panel_shape};

/// A box that would fill a panel wider than this gets the whole width, with
/// the other panels under it.
const WIDE_SCENE: f64 = 900.0;

/// Draws the whole figure.
pub(super) fn surface_figure(figure: &SurfaceFigure<'_>) -> String {
    let mut notes = Notes::default();
    let main = Main::of(figure, &mut notes);
    let (main_width, main_height, under) = main_size(&main);
    let width = whole_width(main_width, under);
    let (caption, top) = wrapped_caption(figure.caption, width);
    let rows = |entries| legend::rows(entries, main_width);
    let legend_rows = rows(panel_surface::legend(figure, 1.0)).len();
    let mut layout = place(main_width, main_height, under, top, legend_rows, width);

    let mut svg = Svg::default();
    let entries = panel_surface::draw(&mut svg, layout.main, figure, &main, &mut notes);
    legend::draw(&mut svg, layout.main, &rows(entries));
    panel_map::draw(&mut svg, layout.error, figure, &mut notes);
    let histories = panel_history::Histories {
        residuals: figure.history,
        normal: &[],
        names: panel_history::CONVERGENCE,
    };
    panel_history::draw(&mut svg, layout.history, histories, figure.extent, &mut notes);
    if let Some(step) = figure.stages {
        notes.add(format!(
            "history up to step {step} that of the columns as curves, then that of the rows of what they gave"
        ));
    }
    let sides = (layout.main.x, layout.error.right().max(layout.main.right()), layout.bottom);
    family::draw(&mut svg, sides, figure, &main, &mut notes);
    layout.bottom += family::height(figure);
    let body = svg.finish();
    whole(figure.title, &layout, &caption, &notes, &body)
}

/// Width and height of the main panel, and whether the others go under it.
fn main_size(main: &Main) -> (f64, f64, bool) {
    // Plain minimum and maximum: a clamp would pass on what is no number.
    let within = |value: f64, (low, high): (f64, f64)| value.max(low).min(high).round();
    match main {
        Main::Plane(shown) => {
            let aspect = panel_shape::aspect(shown);
            if aspect > WIDE_ASPECT {
                let inset = 2.0 * panel_shape::INSET;
                let height = (WHOLE_WIDTH - inset) / aspect + inset;
                (WHOLE_WIDTH, within(height, WIDE_HEIGHT), true)
            } else {
                (within(aspect * MAIN_HEIGHT, MAIN_WIDTH), MAIN_HEIGHT, false)
            }
        }
        Main::Space(scene) => {
            let width = scene.width_for(MAIN_HEIGHT);
            if width > WIDE_SCENE {
                let height = scene.height_for(WHOLE_WIDTH);
                (WHOLE_WIDTH, within(height, (WIDE_HEIGHT.0, MAIN_HEIGHT)), true)
            } else {
                (within(width, MAIN_WIDTH), MAIN_HEIGHT, false)
            }
        }
        Main::Nothing => (MAIN_WIDTH.1, MAIN_HEIGHT, false),
    }
}
