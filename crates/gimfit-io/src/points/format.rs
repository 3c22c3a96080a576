//! Which reader takes a file.

use super::airfoil::{self, Likelihood};
use super::error::{Problem, ReadError};
use super::options::{FormatChoice, PartChoice, ReadOptions};
use super::table::PointTable;
use super::{decode, gpx, npy, text};

/// Reads `bytes` with the reader that the options, the ending of the name or
/// the content call for.
pub(super) fn read(
    bytes: &[u8],
    source: &str,
    extension: Option<&str>,
    options: &ReadOptions,
) -> Result<PointTable, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::file(source, Problem::Empty));
    }
    let extension = extension.unwrap_or("").trim_start_matches('.').to_ascii_lowercase();
    let mut notes = Vec::new();
    let format = match options.format {
        Some(format) => format,
        None => find(bytes, &extension, &mut notes),
    };
    let mut table = match format {
        FormatChoice::Npy => {
            refuse_part(source, options)?;
            note_text_options(options, &mut notes);
            npy::read(bytes, source, options, notes)?
        }
        FormatChoice::Gpx => {
            let text = decode::text(bytes, source, false, &mut notes)?;
            note_text_options(options, &mut notes);
            gpx::read(&text, source, options, notes)?
        }
        _ => {
            refuse_part(source, options)?;
            read_text(bytes, source, &extension, options, notes)?
        }
    };
    if options.skip_missing {
        table.leave_out_missing();
        if table.rows() == 0 {
            let problem = Problem::NoRows("every row lacks a value".to_owned());
            return Err(ReadError::file(source, problem));
        }
    }
    Ok(table)
}

fn read_text(
    bytes: &[u8],
    source: &str,
    extension: &str,
    options: &ReadOptions,
    mut notes: Vec<String>,
) -> Result<PointTable, ReadError> {
    let likelihood = match (options.format, extension) {
        (Some(FormatChoice::Airfoil), _) => Some(Likelihood::Certain),
        (Some(_), _) | (None, "csv" | "tsv" | "xyz") => None,
        // A separator or a decimal mark asked for means a table.
        _ if options.delimiter.is_some() || options.decimal.is_some() => None,
        (None, "dat") => Some(Likelihood::Likely),
        (None, _) => Some(Likelihood::Possible),
    };
    let titled = matches!(likelihood, Some(Likelihood::Certain | Likelihood::Likely));
    let text = decode::text(bytes, source, titled, &mut notes)?;
    if options.format.is_none() && is_markup(text.as_bytes()) {
        let problem = Problem::Malformed(
            "the content is XML or HTML without a gpx element, not points; export the points as \
             CSV or GPX first"
                .to_owned(),
        );
        return Err(ReadError::file(source, problem));
    }
    if options.format.is_none() && is_json(text.as_bytes()) {
        let problem = Problem::Malformed(
            "the content is JSON, not points; export the points as CSV first, or give a document \
             of gimfit to gimfit evaluate"
                .to_owned(),
        );
        return Err(ReadError::file(source, problem));
    }
    if let Some(likelihood) = likelihood
        && let Some(table) = airfoil::read(&text, source, likelihood, options, &notes)?
    {
        return Ok(table);
    }
    text::read(&text, source, extension, options, notes)
}

/// The format by the content where that is certain, else by the ending.
fn find(bytes: &[u8], extension: &str, notes: &mut Vec<String>) -> FormatChoice {
    let by_name = match extension {
        "npy" => Some(FormatChoice::Npy),
        "gpx" => Some(FormatChoice::Gpx),
        "csv" | "tsv" | "txt" | "dat" | "xyz" => Some(FormatChoice::Text),
        _ => None,
    };
    let by_content = if bytes.starts_with(npy::MAGIC) {
        Some((FormatChoice::Npy, "a NumPy array"))
    } else if is_markup(bytes) && names_gpx(bytes) {
        Some((FormatChoice::Gpx, "GPX"))
    } else {
        None
    };
    match (by_content, by_name) {
        (Some((format, what)), Some(named)) if format != named => {
            notes.push(format!(
                "The name ends in .{extension}, but the content is {what} and is read as such."
            ));
            format
        }
        (Some((format, _)), _) => format,
        (None, named) => named.unwrap_or(FormatChoice::Text),
    }
}

/// Whether the content starts as XML or HTML does.
pub(crate) fn is_markup(bytes: &[u8]) -> bool {
    let body = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let start = body.trim_ascii_start();
    start.first() == Some(&b'<')
        && start.get(1).is_some_and(|b| b.is_ascii_alphabetic() || matches!(b, b'?' | b'!'))
}

/// Whether the content opens as a JSON list or object does. The name of a column in brackets is
/// neither.
fn is_json(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let next = start.get(1..).unwrap_or_default().trim_ascii_start().first();
    match (start.first(), next) {
        (Some(b'['), Some(next)) => matches!(next, b'[' | b'{' | b']' | b'"' | b'-' | b'0'..=b'9'),
        (Some(b'{'), Some(next)) => matches!(next, b'"' | b'}'),
        _ => false,
    }
}

fn names_gpx(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(1 << 14)];
    memchr::memmem::find(start, b"<gpx").is_some() || memchr::memmem::find(start, b":gpx").is_some()
}

fn refuse_part(source: &str, options: &ReadOptions) -> Result<(), ReadError> {
    match options.part {
        Some(PartChoice::Number(number)) if number != 1 => {
            let problem = Problem::Parts(format!(
                "part {number} is asked for, but a file of this format is one piece; leave the \
                 choice of a part out"
            ));
            Err(ReadError::file(source, problem))
        }
        _ => Ok(()),
    }
}

/// Notes that options for text have no meaning in this format.
pub(crate) fn note_text_options(options: &ReadOptions, notes: &mut Vec<String>) {
    if options.delimiter.is_some() || options.decimal.is_some() {
        notes.push(
            "The separator and the decimal mark asked for have no meaning in this format and were \
             not used."
                .to_owned(),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::super::table::PointFormat;
    use super::*;

    fn read_as(bytes: &[u8], extension: Option<&str>) -> Result<PointTable, ReadError> {
        read(bytes, "f", extension, &ReadOptions::default())
    }

    const GPX: &[u8] = b"<gpx><trk><trkseg><trkpt lat='1' lon='2'/></trkseg></trk></gpx>";

    #[test]
    fn the_content_decides_where_it_is_certain() {
        let table = read_as(GPX, None).unwrap();
        assert_eq!(table.format, PointFormat::Gpx);
        let table = read_as(GPX, Some(".csv")).unwrap();
        assert_eq!(table.format, PointFormat::Gpx);
        assert!(table.notes[0].contains("ends in .csv"), "{:?}", table.notes);
    }

    #[test]
    fn markup_that_is_not_gpx_is_refused() {
        let error = read_as(b"<!DOCTYPE html><html></html>", None).unwrap_err();
        assert!(error.to_string().contains("without a gpx element"), "{error}");
    }

    #[test]
    fn json_is_refused_and_a_name_in_brackets_is_not() {
        for text in ["[1,2]", " [[1,2],[3,4]]\n", "[\n{\"x\":1}]", "{\"x\": [1,2]}", "{}", "[]"] {
            for extension in ["json", "csv", ""] {
                let error = read_as(text.as_bytes(), Some(extension)).unwrap_err();
                assert!(error.to_string().contains("is JSON"), "{text}: {error}");
            }
        }
        let table = read_as(b"[m],[s]\n1,2\n3,4\n", Some("csv")).unwrap();
        assert_eq!(table.column_names, ["[m]", "[s]"]);
    }

    #[test]
    fn a_part_is_refused_where_there_is_one_piece() {
        let options = ReadOptions { part: Some(PartChoice::Number(2)), ..ReadOptions::default() };
        assert!(read(b"1,2\n", "f", None, &options).is_err());
        let options = ReadOptions { part: Some(PartChoice::All), ..ReadOptions::default() };
        assert!(read(b"1,2\n", "f", None, &options).is_ok());
    }

    #[test]
    fn an_empty_file_is_said_to_be_empty() {
        assert_eq!(read_as(b"", None).unwrap_err().to_string(), "f: the file is empty");
    }
}
