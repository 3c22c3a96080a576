//! Reading a document back, checked.

use super::{Document, Geometry, SurfaceDocument, SurfaceKind, TriangleDocument, TriangleKind};
use crate::points::{ReadError, input_name, read_input};
use std::path::Path;

/// A document that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum DocumentError {
    /// The file cannot be opened or read.
    #[error(transparent)]
    Unreadable(ReadError),
    /// It is not JSON, or not of this shape.
    #[error("{name}, line {line}, column {column}: {problem}")]
    Malformed {
        /// The file.
        name: String,
        /// Line of the trouble, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong.
        problem: String,
    },
    /// JSON of another program or of a later version.
    #[error("{name} is no gimfit document of version 1: {problem}")]
    Foreign {
        /// The file.
        name: String,
        /// What it says it is.
        problem: String,
    },
    /// A surface where a curve was wanted.
    #[error("{name} holds a surface, and this is for curves")]
    Surface {
        /// The file.
        name: String,
    },
    /// A triangular patch where a curve was wanted.
    #[error(
        "{name} holds a triangular patch, and this is for curves; gimfit triangle writes samples of a patch with --samples"
    )]
    Triangle {
        /// The file.
        name: String,
    },
    /// The geometry breaks a precondition.
    #[error("{name}: {reason}")]
    Geometry {
        /// The file.
        name: String,
        /// What is wrong with it.
        reason: gimfit::Error,
    },
}

/// Whether bytes look like a JSON document rather than points.
#[must_use]
pub fn is_document(bytes: &[u8]) -> bool {
    bytes.trim_ascii_start().first() == Some(&b'{')
}

/// Reads a document and checks that its geometry can be evaluated; the path `-` means standard
/// input.
///
/// # Errors
/// [`DocumentError`], naming the file and the place.
pub fn read_document(path: &Path) -> Result<Document, DocumentError> {
    let bytes = read_input(path).map_err(DocumentError::Unreadable)?;
    parse_document(&bytes, &input_name(path))
}

/// As [`read_document`], from memory.
///
/// # Errors
/// [`DocumentError`].
pub fn parse_document(bytes: &[u8], name: &str) -> Result<Document, DocumentError> {
    match kind(bytes) {
        Kind::Curve => {}
        Kind::Surface => return Err(DocumentError::Surface { name: name.into() }),
        Kind::Triangle => return Err(DocumentError::Triangle { name: name.into() }),
    }
    let document: Document = parse(bytes, name)?;
    if let Some(Geometry::Curve(curve)) = &document.geometry {
        let geometry = |reason| DocumentError::Geometry { name: name.into(), reason };
        let points = curve.curve().map_err(geometry)?.control_points().len();
        if let Some(blending) = &document.blending {
            blending.check(points, curve.dimension).map_err(geometry)?;
        }
        for fit in document.sequence.iter().flatten() {
            curve.curve_with(&fit.control_points).map_err(geometry)?;
        }
    }
    Ok(document)
}

/// A document of either kind.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum AnyDocument {
    /// Of a curve, or without a geometry and of a curve's report.
    Curve(Box<Document>),
    /// Of a surface.
    Surface(Box<SurfaceDocument>),
    /// Of a triangular patch.
    Triangle(Box<TriangleDocument>),
}

/// Reads a document of whatever kind it is, and checks that its geometry can be evaluated.
///
/// # Errors
/// [`DocumentError`].
pub fn parse_any_document(bytes: &[u8], name: &str) -> Result<AnyDocument, DocumentError> {
    match kind(bytes) {
        Kind::Curve => Ok(AnyDocument::Curve(Box::new(parse_document(bytes, name)?))),
        Kind::Surface => parse_surface(bytes, name),
        Kind::Triangle => parse_triangle(bytes, name),
    }
}

fn parse_triangle(bytes: &[u8], name: &str) -> Result<AnyDocument, DocumentError> {
    let document: TriangleDocument = parse(bytes, name)?;
    if let Some(TriangleKind::Triangle(triangle)) = &document.geometry {
        let geometry = |reason| DocumentError::Geometry { name: name.into(), reason };
        triangle.patch().map_err(geometry)?;
        for fit in document.sequence.iter().flatten() {
            triangle.patch_with(&fit.control_points).map_err(geometry)?;
        }
    }
    Ok(AnyDocument::Triangle(Box::new(document)))
}

fn parse_surface(bytes: &[u8], name: &str) -> Result<AnyDocument, DocumentError> {
    let document: SurfaceDocument = parse(bytes, name)?;
    if let Some(SurfaceKind::Surface(surface)) = &document.geometry {
        let geometry = |reason| DocumentError::Geometry { name: name.into(), reason };
        let points = surface.surface().map_err(geometry)?.control_net().points().len();
        if let Some(blending) = &document.blending {
            blending.check(points, surface.dimension).map_err(geometry)?;
        }
        for fit in document.sequence.iter().flatten() {
            surface.surface_with(&fit.control_points).map_err(geometry)?;
        }
    }
    Ok(AnyDocument::Surface(Box::new(document)))
}

/// What a document says that it holds, or reports of.
enum Kind {
    Curve,
    Surface,
    Triangle,
}

fn kind(bytes: &[u8]) -> Kind {
    #[derive(serde::Deserialize)]
    struct Probe {
        geometry: Option<Typed>,
        report: Option<Report>,
    }
    #[derive(serde::Deserialize)]
    struct Typed {
        r#type: String,
    }
    #[derive(serde::Deserialize)]
    struct Report {
        degrees: Option<serde::de::IgnoredAny>,
        triangle_degree: Option<serde::de::IgnoredAny>,
    }
    let Ok(probe) = serde_json::from_slice::<Probe>(bytes) else { return Kind::Curve };
    match (probe.geometry, probe.report) {
        (Some(typed), _) if typed.r#type == "surface" => Kind::Surface,
        (Some(typed), _) if typed.r#type == "triangle" => Kind::Triangle,
        (None, Some(report)) if report.degrees.is_some() => Kind::Surface,
        (None, Some(report)) if report.triangle_degree.is_some() => Kind::Triangle,
        _ => Kind::Curve,
    }
}

fn parse<T: serde::de::DeserializeOwned>(bytes: &[u8], name: &str) -> Result<T, DocumentError> {
    if !is_document(bytes) {
        let problem = "it is not JSON; gimfit curve POINTS -o FILE.json writes one".to_owned();
        return Err(DocumentError::Foreign { name: name.into(), problem });
    }
    let parsed = serde_json::from_slice(bytes);
    if let Some(problem) = foreign(bytes) {
        return Err(DocumentError::Foreign { name: name.into(), problem });
    }
    parsed.map_err(|error| DocumentError::Malformed {
        name: name.into(),
        line: error.line(),
        column: error.column(),
        problem: without_place(&error.to_string()),
    })
}

/// What JSON that is not ours says of itself.
fn foreign(bytes: &[u8]) -> Option<String> {
    #[derive(serde::Deserialize)]
    struct Head {
        format: Option<serde_json::Value>,
        version: Option<serde_json::Value>,
    }
    let head: Head = serde_json::from_slice(bytes).ok()?;
    match (head.format.as_ref().and_then(|f| f.as_str()), head.version) {
        (Some("gimfit"), Some(version)) if version == 1 => None,
        (Some("gimfit"), Some(version)) => Some(format!("its version is {version}")),
        (Some("gimfit"), None) => Some("it has no \"version\"".into()),
        (Some(other), _) => Some(format!("its format is \"{other}\"")),
        (None, _) => Some("it has no \"format\": \"gimfit\"".into()),
    }
}

/// The message of the JSON reader without the place, which stands in front already.
fn without_place(message: &str) -> String {
    message.rsplit_once(" at line ").map_or(message, |(what, _)| what).to_owned()
}
