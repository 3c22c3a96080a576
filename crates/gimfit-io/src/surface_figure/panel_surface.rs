//! The main panel: the surface with its data points and control net.

use super::depth::{DepthMap, Spot};
use super::grid::{Grid, Point, Source};
use super::lines::Pen;
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
const MOST_OF_MESH: usize = 2700;
const MOST_OF_DATA: usize = 1600;

/// Larger control nets would hide the surface.
const LARGEST_NET: usize = 1600;

/// If fewer than every so many-th row or column of data points can be drawn,
/// none is: those few would tell nothing of all.
const LARGEST_STRIDE: usize = 4;

/// About as many lines of the surface in each direction.
const ISOLINES: usize = 20;
const ISOLINE: Pen = Pen { colour: "#2b4a66", width: 0.5, opacity: 0.55 };

/// The control net, and its parts behind or below the surface.
const NET: Pen = Pen { colour: style::CONTROL, width: 0.8, opacity: 1.0 };
const HIDDEN_NET: Pen = Pen { colour: style::CONTROL, width: 0.6, opacity: 0.3 };

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
    pub(super) turned: Vec<Point>,
}

/// Finds the place of a point, and the point across, upward and toward the
/// viewer.
type Place<'a> = dyn Fn(&Point) -> (Spot, Point) + 'a;

/// Draws the panel into `area`.
pub(super) fn draw(
    svg: &mut Svg,
    area: Rect,
    figure: &SurfaceFigure<'_>,
    main: &Main,
    notes: &mut Notes,
) -> Vec<Entry> {
    let names = figure.axis_names();
    match main {
        Main::Nothing => {
            message(svg, area, "no points to draw");
            Vec::new()
        }
        Main::Plane([x, y]) => {
            let (sx, sy) = equal_scales(*x, *y, area.across(), area.upward(), INSET);
            let horizontal = Axis::linear(&sx, Direction::Across, &names[0], 0);
            let upright = Axis::linear(&sy, Direction::Upward, &names[1], 0);
            notes.offset(&[&horizontal, &upright]);
            plot::draw_axes(svg, area, &horizontal, &upright);
            // Seen from above, the picture itself is the space.
            let place = |p: &Point| {
                let at = (sx.at(p[0]), sy.at(p[1]));
                (Spot { at, depth: 0.0 }, [at.0, -at.1, 0.0])
            };
            draw_within(svg, area, figure, &place, notes)
        }
        Main::Space(scene) => {
            let stage = Stage::new(area, scene);
            stage.draw_box(svg, &names, [0; 3], false, notes);
            let place = |p: &Point| {
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
    place: &Place<'_>,
    notes: &mut Notes,
) -> Vec<Entry> {
    let placed = |grid: &Grid| {
        let (spots, turned) = grid.points.iter().map(place).unzip();
        Placed { rows: grid.rows, columns: grid.columns, spots, turned }
    };
    let mesh = figure.mesh().thinned(MOST_OF_MESH, figure.closed);
    note_strides(notes, "samples of the surface", &mesh);
    let mesh = placed(&mesh);
    let mut map = DepthMap::new(area, FINENESS);
    facets::lay(&mesh, &mut map);
    plot::open_clipped(svg, area, 0.0, "surface");
    facets::draw(svg, &mesh, &map);
    let isolines = [mesh.rows, mesh.columns].map(|count| count.div_ceil(ISOLINES));
    lines::draw_visible(svg, &mesh, isolines, &map, SLACK_OF_LINES, ISOLINE);
    if net_is_drawn(figure) {
        let net = placed(&figure.net().thinned(LARGEST_NET, figure.closed));
        lines::draw_all(svg, &net, HIDDEN_NET);
        lines::draw_visible(svg, &net, [1, 1], &map, SLACK_OF_NET, NET);
        marks::draw_squares(svg, &net, &map, SLACK_OF_NET);
        if figure.dimension != 2 {
            notes.add("control net behind or below the surface drawn pale".to_owned());
        }
    } else {
        let size = size(figure, &figure.net());
        notes.add(format!("{size} control points too close together to be drawn"));
    }
    let mut dot_radius = 1.0;
    if data_is_drawn(figure) {
        let data = figure.data().thinned(MOST_OF_DATA, [false; 2]);
        note_strides(notes, "the data points", &data);
        let data = placed(&data);
        marks::draw_dots(svg, &data, &map, SLACK_OF_DATA);
        dot_radius = marks::dot_radius(&data);
        if figure.dimension != 2 {
            notes.add("data points behind the surface not drawn".to_owned());
        }
    } else {
        let size = size(figure, &figure.data());
        notes.add(format!("{size} data points too close together to be drawn"));
    }
    svg.close("g");
    legend(figure, dot_radius)
}

fn net_is_drawn(figure: &SurfaceFigure<'_>) -> bool {
    let net = figure.net();
    net.rows() * net.columns() <= LARGEST_NET
}

fn data_is_drawn(figure: &SurfaceFigure<'_>) -> bool {
    let strides = figure.data().strides(MOST_OF_DATA);
    strides.into_iter().all(|stride| stride <= LARGEST_STRIDE)
}

/// Rows and columns as text, or how many points a triangle has.
fn size(figure: &SurfaceFigure<'_>, grid: &Source<'_>) -> String {
    if figure.triangle {
        return text::grouped(grid.rows() * (grid.rows() + 1) / 2);
    }
    format!("{} × {}", text::grouped(grid.rows()), text::grouped(grid.columns()))
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
    let mut entries = vec![Entry {
        sample: Sample::Line(shades::SAMPLE.to_owned(), 9.0),
        name: "fitted surface".to_owned(),
    }];
    if data_is_drawn(figure) {
        entries.push(Entry {
            sample: Sample::Dot(style::DATA.to_owned(), dot_radius),
            name: format!("data points ({})", size(figure, &figure.data())),
        });
    }
    if net_is_drawn(figure) {
        entries.push(Entry {
            sample: Sample::Polygon(style::CONTROL.to_owned()),
            name: format!("control net ({})", size(figure, &figure.net())),
        });
    }
    entries
}
