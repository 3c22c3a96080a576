//! The main panel: the surface with its data points and control net.

use super::depth::{DepthMap, Spot};
use super::grid::Grid;
use super::{SurfaceFigure, best_view, facets, lines, marks, room, shades};
use crate::figure::legend::{Entry, Sample};
use crate::figure::notes::Notes;
use crate::figure::panel_shape::INSET;
use crate::figure::panel_space::{Scene, Stage};
use crate::figure::plot::{self, Axis, Rect};
use crate::figure::scale::{Interval, equal_scales};
use crate::figure::svg::Svg;
use crate::figure::ticks::Direction;
use crate::figure::{message, style, text};

/// Most points of each grid that are drawn.
const MOST_OF_MESH: usize = 9000;
const MOST_OF_DATA: usize = 1600;
const MOST_OF_NET: usize = 1600;

/// About as many lines of the surface in each direction.
const ISOLINES: usize = 20;
const ISOLINE: &str = "#2b4a66";

/// Cells of the depth map to each unit of the picture.
const FINENESS: f64 = 2.0;

/// How far behind the surface lines and points still count as on it, for a
/// picture that reaches from -1 to 1. Data points lie off it by their errors.
const SLACK_OF_LINES: f64 = 0.004;
const SLACK_OF_NET: f64 = 0.008;
const SLACK_OF_DATA: f64 = 0.03;

/// What the panel shows.
pub(super) enum Main {
    /// A plane grid between these intervals.
    Plane([Interval; 2]),
    /// A surface in a box.
    Space(Scene),
    /// No point at all.
    Nothing,
}

impl Main {
    pub(super) fn of(figure: &SurfaceFigure<'_>, notes: &mut Notes) -> Self {
        if figure.dimension == 2 {
            return match room::intervals(figure, notes) {
                [Some(x), Some(y), _] => Self::Plane([x, y]),
                _ => Self::Nothing,
            };
        }
        if figure.dimension > 3 {
            let all = text::grouped(figure.dimension);
            notes.add(format!("first 3 of {all} coordinates drawn"));
        }
        let Some(room) = room::Room::of(figure, notes) else {
            return Self::Nothing;
        };
        let mesh = figure.mesh().thinned(best_view::MOST_POINTS, figure.closed);
        let view = best_view::choose(&room, &mesh);
        Scene::seen(view, room.sides).map_or(Self::Nothing, Self::Space)
    }
}

/// A grid whose points have their places in the picture.
pub(super) struct Placed {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) spots: Vec<Spot>,
    /// Each point across, upward and toward the viewer, for the light.
    pub(super) turned: Vec<[f64; 3]>,
}

/// Draws the panel into `area`.
pub(super) fn draw(
    svg: &mut Svg,
    area: Rect,
    figure: &SurfaceFigure<'_>,
    main: Main,
    notes: &mut Notes,
) -> Vec<Entry> {
    let names = figure.axis_names();
    match main {
        Main::Nothing => {
            message(svg, area, "no points to draw");
            legend(figure, 1.9)
        }
        Main::Plane([x, y]) => {
            let (sx, sy) = equal_scales(x, y, area.across(), area.upward(), INSET);
            let horizontal = Axis::linear(&sx, Direction::Across, false, &names[0]);
            let upright = Axis::linear(&sy, Direction::Upward, false, &names[1]);
            notes.offset(&[&horizontal, &upright]);
            plot::draw_axes(svg, area, &horizontal, &upright);
            // Seen from above, the picture itself is the space.
            let place = |p: &[f64; 3]| {
                let at = (sx.at(p[0]), sy.at(p[1]));
                (Spot { at, depth: 0.0 }, [at.0, -at.1, 0.0])
            };
            draw_within(svg, area, figure, &place, notes)
        }
        Main::Space(scene) => {
            let stage = Stage::new(area, scene);
            stage.draw_box(svg, &names, notes);
            let place = |p: &[f64; 3]| {
                // Beyond this, squares of what strays would overflow.
                let turned = stage.view.turned(p).map(|value| value.clamp(-1.0e6, 1.0e6));
                (Spot { at: stage.place(p), depth: turned[2] }, turned)
            };
            draw_within(svg, area, figure, &place, notes)
        }
    }
}

/// Draws what is within the axes; returns the legend.
fn draw_within(
    svg: &mut Svg,
    area: Rect,
    figure: &SurfaceFigure<'_>,
    place: &dyn Fn(&[f64; 3]) -> (Spot, [f64; 3]),
    notes: &mut Notes,
) -> Vec<Entry> {
    let placed = |grid: &Grid| {
        let (spots, turned) = grid.points.iter().map(place).unzip();
        Placed { rows: grid.rows, columns: grid.columns, spots, turned }
    };
    let mesh = figure.mesh().thinned(MOST_OF_MESH, figure.closed);
    let net = figure.net().thinned(MOST_OF_NET, figure.closed);
    let data = figure.data().thinned(MOST_OF_DATA, [false; 2]);
    note_strides(notes, "samples of the surface", &mesh);
    note_strides(notes, "the control net", &net);
    note_strides(notes, "the data points", &data);
    let (mesh, net, data) = (placed(&mesh), placed(&net), placed(&data));
    let mut map = DepthMap::new(area, FINENESS);
    facets::lay(&mesh, &mut map);
    plot::open_clipped(svg, area, 0.0, "surface");
    facets::draw(svg, &mesh, &map);
    let isolines = [mesh.rows, mesh.columns].map(|count| count.div_ceil(ISOLINES));
    svg.tag("g").number("opacity", 0.55).open();
    lines::draw(svg, &mesh, isolines, &map, SLACK_OF_LINES, ISOLINE, 0.5);
    svg.close("g");
    lines::draw(svg, &net, [1, 1], &map, SLACK_OF_NET, style::CONTROL, 0.7);
    marks::draw_squares(svg, &net, &map, SLACK_OF_NET);
    marks::draw_dots(svg, &data, &map, SLACK_OF_DATA);
    svg.close("g");
    if figure.dimension != 2 && !mesh.spots.is_empty() {
        notes.add("points and lines behind the surface not drawn".to_owned());
    }
    legend(figure, marks::dot_radius(&data))
}

fn note_strides(notes: &mut Notes, name: &str, grid: &Grid) {
    let [down, across] = grid.strides;
    let every = |stride: usize, what: &str| match stride {
        1 => format!("every {what}"),
        _ => format!("every {} {what}", text::ordinal(stride)),
    };
    if down > 1 || across > 1 {
        let (row, column) = (every(down, "row"), every(across, "column"));
        notes.add(format!("{row} and {column} of {name} drawn"));
    }
}

/// Entries of the legend, in the order in which the eye looks for them.
pub(super) fn legend(figure: &SurfaceFigure<'_>, dot_radius: f64) -> Vec<Entry> {
    let size = |[rows, columns]: [usize; 2]| {
        format!("{} × {}", text::grouped(rows), text::grouped(columns))
    };
    let (data, net) = (figure.data(), figure.net());
    vec![
        Entry {
            sample: Sample::Line(shades::SAMPLE.to_owned(), 9.0),
            name: "fitted surface".to_owned(),
        },
        Entry {
            sample: Sample::Dot(style::DATA.to_owned(), dot_radius),
            name: format!("data points ({})", size([data.rows(), data.columns()])),
        },
        Entry {
            sample: Sample::Polygon(style::CONTROL.to_owned()),
            name: format!("control net ({})", size([net.rows(), net.columns()])),
        },
    ]
}
