//! A look at XML before it is parsed.
//!
//! The parser compares the attributes of a tag with each other and copies the
//! namespaces of each element to its children, so that a small file made for
//! the purpose could take minutes and gigabytes. What no GPX file has is
//! refused here: deep nesting, tags of very many attributes, and namespaces
//! declared over and over.

use memchr::{memchr, memchr_iter, memmem};

const DEEPEST: usize = 64;
const MOST_ATTRIBUTES: usize = 200;

/// Fails with a sentence if `text` would be out of proportion to parse.
pub(super) fn check(text: &str) -> Result<(), &'static str> {
    let bytes = text.as_bytes();
    // The namespaces known at each open element.
    let mut known: Vec<usize> = Vec::new();
    let mut copies = 0_usize;
    let mut at = 0;
    while let Some(found) = memchr(b'<', &bytes[at..]) {
        at += found;
        let rest = &bytes[at..];
        if let Some(end) = skipped(rest) {
            at += end;
            continue;
        }
        // No '<' can stand in a tag, so the tag lies before the next one.
        let until = memchr(b'<', &rest[1..]).map_or(rest.len(), |next| next + 1);
        let tag = &rest[..until];
        at += until;
        if tag.starts_with(b"</") {
            known.pop();
            continue;
        }
        if memchr_iter(b'=', tag).count() > MOST_ATTRIBUTES && attributes(tag) > MOST_ATTRIBUTES {
            return Err("a tag has more than 200 attributes");
        }
        let declared = memmem::find_iter(tag, b"xmlns").count();
        let before = known.last().copied().unwrap_or(0);
        let after = before + declared;
        if declared > 0 {
            copies += after;
            if copies > 64 * 1024 + bytes.len() {
                return Err("it declares namespaces over and over");
            }
        }
        if !ends_itself(tag) {
            known.push(after);
            if known.len() > DEEPEST {
                return Err("its elements are nested more than 64 deep");
            }
        }
    }
    Ok(())
}

/// The length of a comment, CDATA section, declaration or instruction.
fn skipped(rest: &[u8]) -> Option<usize> {
    const KINDS: [(&[u8], &[u8]); 4] =
        [(b"<!--", b"-->"), (b"<![CDATA[", b"]]>"), (b"<?", b"?>"), (b"<!", b">")];
    let (start, end) = KINDS.iter().find(|(start, _)| rest.starts_with(start))?;
    let length = memmem::find(&rest[start.len()..], end)
        .map_or(rest.len(), |found| start.len() + found + end.len());
    Some(length)
}

/// Signs of equality up to the end of the tag, outside quotation marks.
fn attributes(tag: &[u8]) -> usize {
    let mut quote = None;
    let mut count = 0;
    for b in tag {
        match (quote, b) {
            (None, b'"' | b'\'') => quote = Some(*b),
            (Some(open), b) if open == *b => quote = None,
            (None, b'=') => count += 1,
            (None, b'>') => break,
            _ => {}
        }
    }
    count
}

/// Whether the tag is of the kind `<a/>`.
fn ends_itself(tag: &[u8]) -> bool {
    let mut quote = None;
    let mut last = 0;
    for b in tag {
        match (quote, b) {
            (None, b'"' | b'\'') => quote = Some(*b),
            (Some(open), b) if open == *b => quote = None,
            (None, b'>') => return last == b'/',
            _ => {}
        }
        last = *b;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_files_pass() {
        let point = "<trkpt lat=\"1\" lon='2'><e xmlns:a='b>/'/><t>a=b</t><!-- <a><a> --></trkpt>";
        let text = format!("<?xml version='1.0'?><gpx xmlns='x'>{}</gpx>", point.repeat(10_000));
        assert_eq!(check(&text), Ok(()));
        assert_eq!(check(&format!("<a><b>{}</b></a>", "a=b&".repeat(500))), Ok(()));
    }

    #[test]
    fn files_made_to_exhaust_the_parser_are_refused() {
        assert!(check(&"<a>".repeat(100)).is_err());
        let many: String = (0..300).map(|at| format!(" a{at}=''")).collect();
        assert!(check(&format!("<a{many}/>")).is_err());
        let spaces: String = (0..150).map(|at| format!(" xmlns:a{at}='b'")).collect();
        let inner = "<b xmlns:c='d'/>".repeat(10_000);
        assert!(check(&format!("<a{spaces}><a{spaces}>{inner}</a></a>")).is_err());
    }
}
