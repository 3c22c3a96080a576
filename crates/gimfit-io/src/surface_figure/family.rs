//! The kept fits, side by side: each surface as the main panel sees it, and
//! its errors in colours that all of them share.

use super::colour_bar::{self, ErrorScale};
use super::depth::{DepthMap, Spot};
use super::panel_map::Errors;
use super::panel_surface::{Main, Placed};
use super::{Member, SurfaceFigure, colours, facets, panel_map};
use crate::figure::notes::Notes;
use crate::figure::panel_shape::INSET;
use crate::figure::panel_space::Stage;
use crate::figure::plot::{self, Rect};
use crate::figure::scale::equal_scales;
use crate::figure::svg::Svg;
use crate::figure::{style, text};

/// Most fits drawn, and the narrowest and widest each is.
const MOST: usize = 6;
const WIDTH: (f64, f64) = (130.0, 230.0);

/// Heights of a surface, of its name and of its errors.
const SURFACE: f64 = 150.0;
const NAME: f64 = 16.0;
const MAP: f64 = 92.0;

/// Between two fits, and below all of them.
const GAP: f64 = 18.0;
const HEADING: f64 = 40.0;

/// Room at the right for the colours.
const BAR: f64 = 12.0;
const BESIDE: f64 = 70.0;

/// Points of each surface.
const MOST_OF_MESH: usize = 700;

/// Height that the fits take up under the other panels.
pub(super) fn height(figure: &SurfaceFigure<'_>) -> f64 {
    if figure.sequence.is_empty() { 0.0 } else { HEADING + SURFACE + NAME + MAP + GAP }
}

/// Draws the fits below `top`, between `left` and `right`.
pub(super) fn draw(
    svg: &mut Svg,
    (left, right, top): (f64, f64, f64),
    figure: &SurfaceFigure<'_>,
    main: &Main,
    notes: &mut Notes,
) {
    let shown = chosen(figure.sequence);
    if shown.is_empty() {
        return;
    }
    if shown.len() < figure.sequence.len() {
        notes.add(format!("{} of {} kept fits drawn", shown.len(), figure.sequence.len()));
    }
    let area = Rect { x: left, y: top + HEADING, width: right - left, height: SURFACE };
    plot::heading(svg, area, "Kept fits, and the error of each");
    let count = shown.len() as f64;
    let width = ((area.width - BESIDE + GAP) / count - GAP).min(WIDTH.1).max(WIDTH.0);
    let all: Vec<f64> = shown.iter().flat_map(|member| member.residuals).copied().collect();
    let map_top = area.bottom() + NAME;
    let bar = Rect { x: left + count * (width + GAP), y: map_top, width: BAR, height: MAP };
    let scale = ErrorScale::of(&all, bar.bottom(), bar.y);
    for (k, member) in shown.iter().enumerate() {
        let x = left + k as f64 * (width + GAP);
        let panel = Rect { x, width, ..area };
        draw_surface(svg, panel, figure, main, member, k);
        let largest = member.residuals.iter().copied().fold(0.0, f64::max);
        let name = format!("iteration {}: largest {largest:.2e}", text::grouped(member.iteration));
        let name = text::fit(&name, style::LABEL_SIZE, width);
        svg.label((x, area.bottom() + 8.0), style::LABEL_SIZE, style::INK, "start", &name);
        let own = SurfaceFigure { residuals: member.residuals, ..*figure };
        let map = Rect { x, y: map_top, width, height: MAP };
        if let (Some(errors), Some(scale)) = (Errors::of(&own), &scale) {
            let step = |error| colours::step((bar.bottom() - scale.at(error).0) / bar.height);
            panel_map::draw_cells(svg, map, &errors, &step, &format!("errors-{k}"));
        }
        svg.tag("rect")
            .number("x", map.x)
            .number("y", map.y)
            .number("width", map.width)
            .number("height", map.height)
            .attribute("fill", "none")
            .attribute("stroke", style::FRAME)
            .end();
    }
    if let Some(scale) = scale {
        colour_bar::draw(svg, bar, &scale);
    }
}

/// As many fits as there is room for, the first and the last among them.
fn chosen<'a>(sequence: &'a [Member<'a>]) -> Vec<&'a Member<'a>> {
    let count = sequence.len();
    if count <= MOST {
        return sequence.iter().collect();
    }
    (0..MOST).filter_map(|k| sequence.get(k * (count - 1) / (MOST - 1))).collect()
}

/// Draws the facets of one surface.
fn draw_surface(
    svg: &mut Svg,
    area: Rect,
    figure: &SurfaceFigure<'_>,
    main: &Main,
    member: &Member<'_>,
    number: usize,
) {
    let own = SurfaceFigure { mesh_points: member.mesh_points, ..*figure };
    let mesh = own.mesh().thinned(MOST_OF_MESH, figure.closed);
    let (spots, turned) = match main {
        Main::Nothing => return,
        Main::Plane([x, y]) => {
            let (sx, sy) = equal_scales(*x, *y, area.across(), area.upward(), 0.25 * INSET);
            let place = |p: &[f64; 3]| {
                let at = (sx.at(p[0]), sy.at(p[1]));
                (Spot { at, depth: 0.0 }, [at.0, -at.1, 0.0])
            };
            mesh.points.iter().map(place).unzip()
        }
        Main::Space(scene) => {
            let stage = Stage::filling(area, scene);
            let place = |p: &[f64; 3]| {
                let turned = stage.view.turned(p).map(|value| value.clamp(-1.0e6, 1.0e6));
                (Spot { at: stage.place(p), depth: turned[2] }, turned)
            };
            mesh.points.iter().map(place).unzip()
        }
    };
    let placed = Placed { rows: mesh.rows, columns: mesh.columns, spots, turned };
    let mut map = DepthMap::new(area, 2.0);
    facets::lay(&placed, &mut map);
    plot::open_clipped(svg, area, 0.0, &format!("kept-{number}"));
    facets::draw(svg, &placed, &map);
    svg.close("g");
}
