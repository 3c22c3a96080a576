//! GPX 1.0 and 1.1: the points of a track, or of a route where there is no
//! track.
//!
//! Kept are longitude and latitude in degrees, the elevation in metres if
//! chosen, the lines of the points and the name of the track. The columns east,
//! north and up give the points in metres about the first one (see
//! `gpx_plane`). Lost, and noted, are waypoints, routes beside tracks, and
//! empty segments; lost are times and extensions. Refused are files of
//! waypoints alone, which have no order along a curve, files of several
//! segments without a choice among them, and points without a position.

use memchr::memchr_iter;
use roxmltree::{Document, Node};

use super::columns::{Offer, select};
use super::error::{Problem, ReadError, counted, list, shortened};
use super::gpx_guard;
use super::gpx_plane::Plane;
use super::number::{Fault, parse};
use super::options::{DecimalMark, PartChoice, ReadOptions};
use super::table::{PointFormat, PointTable};

const LON: usize = 0;
const LAT: usize = 1;
const ELE: usize = 2;
const EAST: usize = 3;
const NORTH: usize = 4;
const UP: usize = 5;
const NAMES: [&str; 6] = ["lon", "lat", "ele", "east", "north", "up"];

/// One segment of a track, or one route.
struct Piece<'a> {
    name: Option<String>,
    points: Vec<Node<'a, 'a>>,
}

struct Point<'a> {
    line: u32,
    lon: f64,
    lat: f64,
    /// The text of the elevation.
    ele: Option<&'a str>,
}

/// Reads the track in `text`.
pub(super) fn read(
    text: &str,
    source: &str,
    options: &ReadOptions,
    mut notes: Vec<String>,
) -> Result<PointTable, ReadError> {
    let malformed = |text: String| ReadError::file(source, Problem::Malformed(text));
    gpx_guard::check(text).map_err(|what| malformed(format!("this is no GPX file: {what}")))?;
    let document = Document::parse(text).map_err(|error| {
        let what = error.to_string();
        let what: String = what.chars().filter(|c| !c.is_control()).take(200).collect();
        let problem = Problem::Malformed(format!("the XML is broken ({what}); export it again"));
        ReadError::line(source, error.pos().row, problem)
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "gpx" {
        return Err(malformed(format!(
            "the XML is not GPX: its outermost element is {}, not gpx",
            shortened(root.tag_name().name())
        )));
    }
    let pieces = pieces(root, source, &mut notes)?;
    let starts: Vec<usize> =
        pieces.iter().filter_map(|piece| Some(piece.points.first()?.range().start)).collect();
    let chosen = choose(&pieces, &lines_at(text, &starts), source, options, &mut notes)?;
    let title = chosen.first().and_then(|piece| piece.name.clone());
    let nodes: Vec<Node<'_, '_>> = chosen.iter().flat_map(|p| p.points.iter().copied()).collect();
    let points = points(&nodes, text, source)?;
    table(&points, title, source, options, notes)
}

fn children<'a>(node: Node<'a, 'a>, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

fn name_of(node: Node<'_, '_>) -> Option<String> {
    let name = node
        .children()
        .find(|child| child.is_element() && child.tag_name().name() == "name")?
        .text()?
        .trim();
    (!name.is_empty()).then(|| name.to_owned())
}

/// The non-empty segments of all tracks, else the non-empty routes.
fn pieces<'a>(
    root: Node<'a, 'a>,
    source: &str,
    notes: &mut Vec<String>,
) -> Result<Vec<Piece<'a>>, ReadError> {
    let mut segments = Vec::new();
    for track in children(root, "trk") {
        for segment in children(track, "trkseg") {
            segments
                .push(Piece { name: name_of(track), points: children(segment, "trkpt").collect() });
        }
    }
    let mut routes: Vec<Piece<'_>> = children(root, "rte")
        .map(|route| Piece { name: name_of(route), points: children(route, "rtept").collect() })
        .collect();
    let total = segments.len();
    segments.retain(|piece| !piece.points.is_empty());
    routes.retain(|piece| !piece.points.is_empty());
    let waypoints = children(root, "wpt").count();
    if segments.is_empty() && routes.is_empty() {
        let why = match waypoints {
            0 => "there is no track and no route".to_owned(),
            _ => format!(
                "there is no track and no route, only {}, which have no order along a curve; put \
                 them in order in a track or in a CSV file first",
                counted(waypoints, "waypoint")
            ),
        };
        return Err(ReadError::file(source, Problem::NoRows(why)));
    }
    if waypoints > 0 {
        notes.push(format!("Waypoints are no part of the curve and were left out ({waypoints})."));
    }
    if total > segments.len() {
        notes.push(format!("Empty track segments were left out ({}).", total - segments.len()));
    }
    if segments.is_empty() {
        notes.push("There is no track; the points are those of the route.".to_owned());
        return Ok(routes);
    }
    if !routes.is_empty() {
        notes.push(format!("Routes beside the track were left out ({}).", routes.len()));
    }
    Ok(segments)
}

/// The pieces to read; `lines` tells where each starts.
fn choose<'p, 'a>(
    pieces: &'p [Piece<'a>],
    lines: &[u32],
    source: &str,
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> Result<&'p [Piece<'a>], ReadError> {
    let parts: Vec<String> = pieces
        .iter()
        .zip(lines)
        .enumerate()
        .map(|(at, (piece, line))| {
            let points = counted(piece.points.len(), "point");
            format!("part {} ({points} from line {line})", at + 1)
        })
        .collect();
    let refuse = |text: String| Err(ReadError::file(source, Problem::Parts(text)));
    match options.part {
        Some(PartChoice::Number(number)) => {
            let Some(at) = number.checked_sub(1).filter(|at| *at < pieces.len()) else {
                return refuse(format!(
                    "there is no part {number}; the parts are {}",
                    list(&parts)
                ));
            };
            if pieces.len() > 1 {
                notes.push(format!("Of {} parts, {} is read.", pieces.len(), parts[at]));
            }
            Ok(&pieces[at..=at])
        }
        Some(PartChoice::All) => {
            if pieces.len() > 1 {
                notes.push(format!(
                    "All parts were joined in the order of the file: {}.",
                    list(&parts)
                ));
            }
            Ok(pieces)
        }
        None if pieces.len() > 1 => refuse(format!(
            "the points lie in {} separate parts: {}; choose one, as with --part 1, or join them \
             with --part all",
            pieces.len(),
            list(&parts)
        )),
        None => Ok(pieces),
    }
}

/// The lines of ascending positions in `text`.
fn lines_at(text: &str, positions: &[usize]) -> Vec<u32> {
    let bytes = text.as_bytes();
    // Files of the oldest Macintosh systems end lines with CR alone.
    let end = if memchr::memchr(b'\n', bytes).is_some() { b'\n' } else { b'\r' };
    let mut line: u32 = 1;
    let mut from = 0;
    positions
        .iter()
        .map(|at| {
            let passed = bytes.get(from..*at).unwrap_or_default();
            let ends = memchr_iter(end, passed).count();
            line = line.saturating_add(u32::try_from(ends).unwrap_or(u32::MAX));
            from = *at;
            line
        })
        .collect()
}

fn names() -> Vec<String> {
    NAMES.iter().map(|name| (*name).to_owned()).collect()
}

fn points<'a>(
    nodes: &[Node<'a, 'a>],
    text: &str,
    source: &str,
) -> Result<Vec<Point<'a>>, ReadError> {
    let positions: Vec<usize> = nodes.iter().map(|node| node.range().start).collect();
    let lines = lines_at(text, &positions);
    let mut out = Vec::with_capacity(nodes.len());
    for (node, line) in nodes.iter().zip(lines) {
        let degrees = |column: usize, most: f64| {
            let Some(cell) = node.attribute(NAMES[column]) else {
                let problem = Problem::Malformed(format!(
                    "the point has no {}; give it one or remove the point",
                    NAMES[column]
                ));
                return Err(ReadError::line(source, line, problem));
            };
            let value = number(cell, column, line, source)?;
            if value.abs() > most {
                let problem = Problem::Malformed(format!(
                    "{} is not between -{most} and {most} degrees; correct or remove the point",
                    shortened(cell)
                ));
                return Err(ReadError::line(source, line, problem).in_column(column, &names()));
            }
            Ok(value)
        };
        out.push(Point {
            line,
            lon: degrees(LON, 360.0)?,
            lat: degrees(LAT, 90.0)?,
            ele: children(*node, "ele").next().and_then(|ele| ele.text()),
        });
    }
    Ok(out)
}

fn number(cell: &str, column: usize, line: u32, source: &str) -> Result<f64, ReadError> {
    parse(cell.trim(), DecimalMark::Point).map_err(|fault| {
        let advice = "correct or remove the point".to_owned();
        let cell = shortened(cell);
        let problem = match fault {
            Fault::Empty => Problem::EmptyCell { advice },
            Fault::NotFinite => Problem::NotFinite { cell },
            Fault::TooLarge => Problem::TooLarge { cell },
            Fault::NotANumber | Fault::Marks => Problem::NotANumber { cell, advice },
        };
        ReadError::line(source, line, problem).in_column(column, &names())
    })
}

fn elevation(point: &Point<'_>, column: usize, source: &str) -> Result<f64, ReadError> {
    match point.ele {
        Some(text) => number(text, column, point.line, source),
        None => {
            let advice = "the point has no elevation, so choose columns without ele and up";
            let problem = Problem::EmptyCell { advice: advice.to_owned() };
            Err(ReadError::line(source, point.line, problem).in_column(column, &names()))
        }
    }
}

fn table(
    points: &[Point<'_>],
    title: Option<String>,
    source: &str,
    options: &ReadOptions,
    mut notes: Vec<String>,
) -> Result<PointTable, ReadError> {
    let names = names();
    let offer = Offer { names: &names, named: true, usual: vec![LON, LAT], why: "" };
    let selection = select(offer, options, source, &mut notes)?;
    let first = points
        .first()
        .ok_or_else(|| ReadError::file(source, Problem::NoRows("the track is empty".to_owned())))?;
    let plane = Plane::at(first.lon, first.lat);
    if options.columns.is_none() {
        let elevated = points.iter().all(|point| point.ele.is_some());
        notes.push(match elevated && selection.abscissa != Some(ELE) {
            true => "The coordinates are in degrees; the elevation in metres was left out (choose \
                     it with --columns lon,lat,ele, or metres with --columns east,north,up)."
                .to_owned(),
            false => "The coordinates are in degrees (choose metres with --columns east,north)."
                .to_owned(),
        });
    }
    if selection.all().any(|at| at >= EAST) {
        notes.push(format!(
            "East, north and up are metres from the first point (lon {}, lat {}) on the plane that \
             touches the WGS84 ellipsoid there.",
            first.lon, first.lat
        ));
    }
    let jump = points.windows(2).find(|pair| (pair[1].lon - pair[0].lon).abs() > 180.0);
    if let (Some(pair), true) = (jump, selection.all().any(|at| at == LON)) {
        notes.push(format!(
            "The longitude jumps from {} to {} on line {}; choose east and north for a curve over \
             the date line.",
            pair[0].lon, pair[1].lon, pair[1].line
        ));
    }
    let (coordinates, abscissa) = selection.gather(points.len(), |row, column| {
        let point = &points[row];
        Ok::<_, ReadError>(match column {
            LON => point.lon,
            LAT => point.lat,
            EAST => plane.east(point.lon),
            NORTH => plane.north(point.lat),
            UP => elevation(point, UP, source)? - elevation(first, UP, source)?,
            _ => elevation(point, ELE, source)?,
        })
    })?;
    Ok(PointTable {
        source: source.to_owned(),
        format: PointFormat::Gpx,
        title,
        column_names: selection.coordinate_names(&names),
        coordinates,
        row_lines: Some(points.iter().map(|point| point.line).collect()),
        row_positions: None,
        rows_left_out: 0,
        notes,
        abscissa,
        abscissa_name: selection.abscissa_name(&names),
    })
}

#[cfg(test)]
#[path = "test_gpx.rs"]
mod tests;
