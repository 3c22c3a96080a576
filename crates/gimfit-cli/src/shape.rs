//! The curve, surface or triangular patch of a document.

use anyhow::{anyhow, bail};
use gimfit::geometry::TriangularPatch;
use gimfit::{Curve, Surface};
use gimfit_io::document::{AnyDocument, Geometry, SurfaceKind, TriangleKind, parse_any_document};
use gimfit_io::points::{input_name, read_input};
use std::path::Path;

/// What was fitted.
pub(crate) enum Shape {
    Curve(Curve),
    Surface(Surface),
    Triangle(TriangularPatch),
}

/// A fitted shape and the names of its coordinates, empty if the document tells none.
pub(crate) struct Fitted {
    pub(crate) shape: Shape,
    pub(crate) names: Vec<String>,
}

/// Reads what a document holds: the final fit, or that kept at an iteration.
pub(crate) fn read(path: &Path, iteration: Option<usize>) -> anyhow::Result<Fitted> {
    let name = input_name(path);
    let (shape, names) = match parse_any_document(&read_input(path)?, &name)? {
        AnyDocument::Curve(document) => {
            let Some(Geometry::Curve(geometry)) = &document.geometry else {
                bail!("{name} holds no curve; write one with gimfit curve POINTS -o FILE.json");
            };
            let sequence = document.sequence.as_deref().unwrap_or_default();
            let curve = match iteration {
                None => geometry.curve()?,
                Some(wanted) => {
                    let kept = kept(sequence, |fit| fit.iteration, wanted, &name)?;
                    geometry.curve_with(&kept.control_points)?
                }
            };
            (Shape::Curve(curve), document.coordinate_names)
        }
        AnyDocument::Surface(document) => {
            let Some(SurfaceKind::Surface(geometry)) = &document.geometry else {
                bail!("{name} holds no surface; write one with gimfit surface GRID -o FILE.json");
            };
            let sequence = document.sequence.as_deref().unwrap_or_default();
            let surface = match iteration {
                None => geometry.surface()?,
                Some(wanted) => {
                    let kept = kept(sequence, |fit| fit.entry.iteration, wanted, &name)?;
                    geometry.surface_with(&kept.control_points)?
                }
            };
            (Shape::Surface(surface), document.coordinate_names)
        }
        AnyDocument::Triangle(document) => {
            let Some(TriangleKind::Triangle(geometry)) = &document.geometry else {
                bail!("{name} holds no patch; write one with gimfit triangle POINTS -o FILE.json");
            };
            let sequence = document.sequence.as_deref().unwrap_or_default();
            let patch = match iteration {
                None => geometry.patch()?,
                Some(wanted) => {
                    let kept = kept(sequence, |fit| fit.iteration, wanted, &name)?;
                    geometry.patch_with(&kept.control_points)?
                }
            };
            (Shape::Triangle(patch), document.coordinate_names)
        }
        _ => bail!("{name} holds a geometry that cannot be evaluated"),
    };
    Ok(Fitted { shape, names: names.unwrap_or_default() })
}

/// The fit kept at an iteration.
fn kept<'a, F>(
    sequence: &'a [F],
    iteration: impl Fn(&F) -> usize,
    wanted: usize,
    name: &str,
) -> anyhow::Result<&'a F> {
    sequence.iter().find(|fit| iteration(fit) == wanted).ok_or_else(|| {
        let known: Vec<String> = sequence.iter().map(|fit| iteration(fit).to_string()).collect();
        let known = if known.is_empty() { "none".into() } else { known.join(", ") };
        anyhow!("{name} keeps no fit of iteration {wanted}; it keeps {known}")
    })
}
