//! Bytes into text.
//!
//! Text is UTF-8, with or without a byte-order mark. Bytes of Latin-1 are
//! accepted, and noted, only where no number can stand: in comments and in the
//! title of an airfoil. UTF-16 and binary content are refused by name.

use std::borrow::Cow;

use memchr::{memchr, memrchr};

use super::error::{Problem, ReadError, list};

/// The text in `bytes`. `titled` says that the first line with content may be
/// a title rather than data.
pub(crate) fn text<'a>(
    bytes: &'a [u8],
    source: &str,
    titled: bool,
    notes: &mut Vec<String>,
) -> Result<Cow<'a, str>, ReadError> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(ReadError::file(source, Problem::Utf16));
    }
    let body = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if body.is_empty() {
        return Err(ReadError::file(source, Problem::Empty));
    }
    if let Some(what) = binary_kind(body) {
        return Err(ReadError::file(source, Problem::Binary(what)));
    }
    if memchr(0, body).is_some() {
        let problem =
            if alternates_with_nul(body) { Problem::Utf16 } else { Problem::Binary("binary data") };
        return Err(ReadError::file(source, problem));
    }
    let ended = strip_end_mark(body, notes);
    match std::str::from_utf8(ended) {
        Ok(text) => Ok(Cow::Borrowed(text)),
        Err(_) if ended.iter().any(|b| is_binary_control(*b)) => {
            Err(ReadError::file(source, Problem::Binary("binary data")))
        }
        Err(_) => {
            with_latin1(ended, bytes.len() - body.len(), source, titled, notes).map(Cow::Owned)
        }
    }
}

/// Old DOS files close with one control-Z.
fn strip_end_mark<'a>(body: &'a [u8], notes: &mut Vec<String>) -> &'a [u8] {
    let end = body.trim_ascii_end();
    match end.strip_suffix(&[0x1a]) {
        Some(rest) => {
            notes.push("The end-of-file mark (control-Z) at the end was left out.".to_owned());
            rest
        }
        None => body,
    }
}

/// What well-known content other than text this is.
fn binary_kind(bytes: &[u8]) -> Option<&'static str> {
    const KINDS: [(&[u8], &str); 9] = [
        (b"PK\x03\x04", "a ZIP archive (a workbook or an .npz file)"),
        (b"\x1f\x8b", "gzip-compressed"),
        (b"BZh", "bzip2-compressed"),
        (b"\xfd7zXZ", "xz-compressed"),
        (b"%PDF-", "a PDF document"),
        (b"\x89PNG", "a PNG image"),
        (b"\x89HDF", "an HDF5 file"),
        (b"\xd0\xcf\x11\xe0", "an old Office document"),
        (b"\x93NUMPY", "a NumPy array"),
    ];
    KINDS.iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, what)| *what)
}

fn alternates_with_nul(bytes: &[u8]) -> bool {
    let sample = &bytes[..bytes.len().min(64)];
    let nul_at =
        |parity: usize| sample.iter().enumerate().all(|(at, b)| (at % 2 == parity) == (*b == 0));
    sample.len() >= 4 && (nul_at(0) || nul_at(1))
}

fn is_binary_control(byte: u8) -> bool {
    matches!(byte, 0x01..=0x08 | 0x0e..=0x19 | 0x1c..=0x1f | 0x7f)
}

/// Text with stray Latin-1 bytes. `skipped` bytes stood before `bytes`.
fn with_latin1(
    bytes: &[u8],
    skipped: usize,
    source: &str,
    titled: bool,
    notes: &mut Vec<String>,
) -> Result<String, ReadError> {
    let mut text = String::with_capacity(bytes.len() + 16);
    let mut lines_changed = Vec::new();
    let mut title_may_follow = titled;
    let mut start = 0;
    let mut number: u32 = 0;
    while start < bytes.len() {
        number = number.saturating_add(1);
        let end = line_end(bytes, start);
        let line = &bytes[start..end];
        match std::str::from_utf8(line) {
            Ok(line) => text.push_str(line),
            Err(error) => {
                let at = error.valid_up_to();
                if !title_may_follow && !in_comment(line, at) {
                    let problem =
                        Problem::NotUtf8 { byte: skipped + start + at + 1, value: line[at] };
                    return Err(ReadError::line(source, number, problem));
                }
                text.extend(line.iter().map(|b| char::from(*b)));
                lines_changed.push(number.to_string());
            }
        }
        if !line.trim_ascii().is_empty() && !in_comment(line, line.len()) {
            title_may_follow = false;
        }
        start = end;
    }
    notes.push(format!(
        "Bytes that are not UTF-8 were read as Latin-1, in the title or in comments of {} {}.",
        if lines_changed.len() == 1 { "line" } else { "lines" },
        list(&lines_changed)
    ));
    Ok(text)
}

/// The position after the line that starts at `start`, its end included.
fn line_end(bytes: &[u8], start: usize) -> usize {
    match memchr::memchr2(b'\n', b'\r', &bytes[start..]) {
        None => bytes.len(),
        Some(at) => {
            let at = start + at;
            let pair = bytes[at] == b'\r' && bytes.get(at + 1) == Some(&b'\n');
            at + if pair { 2 } else { 1 }
        }
    }
}

/// Whether the byte at `at` lies in a comment.
fn in_comment(line: &[u8], at: usize) -> bool {
    let content = line.trim_ascii_start();
    content.starts_with(b"%")
        || content.starts_with(b"!")
        || content.starts_with(b"//")
        || content.starts_with(b"#")
        || (at < line.len() && memrchr(b'#', &line[..at]).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8], titled: bool) -> Result<(String, Vec<String>), ReadError> {
        let mut notes = Vec::new();
        let text = text(bytes, "f", titled, &mut notes)?.into_owned();
        Ok((text, notes))
    }

    #[test]
    fn a_byte_order_mark_is_skipped() {
        assert_eq!(read(b"\xef\xbb\xbf1 2\n", false).unwrap().0, "1 2\n");
        assert!(matches!(read(b"\xef\xbb\xbf", false).unwrap_err().problem(), Problem::Empty));
    }

    #[test]
    fn utf_16_is_named_with_and_without_its_mark() {
        for bytes in [&b"\xff\xfe1\x00,\x00"[..], b"1\x00,\x002\x00", b"\x001\x00,\x002"] {
            assert!(matches!(read(bytes, false).unwrap_err().problem(), Problem::Utf16));
        }
    }

    #[test]
    fn binary_content_is_refused_by_name() {
        let error = read(b"PK\x03\x04abc", false).unwrap_err().to_string();
        assert!(error.contains("ZIP archive"), "{error}");
        let error = read(b"1 2\n\x00\x01\x02", false).unwrap_err().to_string();
        assert!(error.contains("binary data"), "{error}");
        let error = read(b"1 2\n\x02\x9d", false).unwrap_err().to_string();
        assert!(error.contains("binary data"), "{error}");
    }

    #[test]
    fn latin_1_passes_only_where_no_number_stands() {
        let (text, notes) = read(b"Profil f\xfcr\n1 0\n# \xe9\n2 0 # \xe9\n", true).unwrap();
        assert_eq!(text, "Profil f\u{fc}r\n1 0\n# \u{e9}\n2 0 # \u{e9}\n");
        assert!(notes[0].contains("lines 1, 3, 4"), "{notes:?}");
        let error = read(b"\xef\xbb\xbf1,2\r\n\xb12,3\n", true).unwrap_err();
        assert_eq!(
            error.to_string(),
            "f, line 2: byte 9 of the file (0xb1) is not UTF-8; save the file with UTF-8 encoding"
        );
        assert!(read(b"Temp\xe9rature,x\n1,2\n", false).is_err());
    }

    #[test]
    fn the_end_mark_of_old_files_is_left_out_and_noted() {
        let (text, notes) = read(b"1 2\n\x1a", false).unwrap();
        assert_eq!((text.as_str(), notes.len()), ("1 2\n", 1));
    }
}
