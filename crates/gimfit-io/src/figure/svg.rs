//! A small SVG writer: elements, escaped text, rounded numbers, paths.

use super::text;

/// Text of an SVG document as it grows.
#[derive(Default)]
pub(crate) struct Svg {
    body: String,
}

impl Svg {
    /// Begins the tag `name`; close it with one of the methods of [`Tag`].
    pub(crate) fn tag(&mut self, name: &'static str) -> Tag<'_> {
        self.body.push('<');
        self.body.push_str(name);
        Tag { svg: self, name }
    }

    /// Ends an element that was left open by [`Tag::open`].
    pub(crate) fn close(&mut self, name: &str) {
        self.body.push_str("</");
        self.body.push_str(name);
        self.body.push_str(">\n");
    }

    /// A straight line.
    pub(crate) fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: &str, width: f64) {
        self.tag("line")
            .number("x1", from.0)
            .number("y1", from.1)
            .number("x2", to.0)
            .number("y2", to.1)
            .attribute("stroke", colour)
            .number("stroke-width", width)
            .end();
    }

    /// One line of text; `anchor` is `start`, `middle` or `end`.
    pub(crate) fn label(
        &mut self,
        at: (f64, f64),
        size: f64,
        colour: &str,
        anchor: &str,
        content: &str,
    ) {
        self.tag("text")
            .number("x", at.0)
            .number("y", at.1)
            .number("font-size", size)
            .attribute("fill", colour)
            .attribute("text-anchor", anchor)
            .text(size, content);
    }

    /// The text written so far.
    pub(crate) fn finish(self) -> String {
        self.body
    }
}

/// A tag whose attributes are being written.
pub(crate) struct Tag<'a> {
    svg: &'a mut Svg,
    name: &'static str,
}

impl Tag<'_> {
    pub(crate) fn attribute(self, name: &str, value: &str) -> Self {
        let body = &mut self.svg.body;
        body.push(' ');
        body.push_str(name);
        body.push_str("=\"");
        escape_into(body, value);
        body.push('"');
        self
    }

    pub(crate) fn number(self, name: &str, value: f64) -> Self {
        let body = &mut self.svg.body;
        body.push(' ');
        body.push_str(name);
        body.push_str("=\"");
        push_number(body, value);
        body.push('"');
        self
    }

    /// Ends the tag as an element without content.
    pub(crate) fn end(self) {
        self.svg.body.push_str("/>\n");
    }

    /// Ends the tag; the content follows, then [`Svg::close`].
    pub(crate) fn open(self) {
        self.svg.body.push_str(">\n");
    }

    /// Ends the tag with plain text as its content.
    pub(crate) fn plain(self, content: &str) {
        let body = &mut self.svg.body;
        body.push('>');
        escape_into(body, content);
        self.svg.close(self.name);
    }

    /// Ends the tag with text in which superscript digits are set as raised
    /// digits: few fonts besides the embedded one hold all of them.
    fn text(self, size: f64, content: &str) {
        let body = &mut self.svg.body;
        body.push('>');
        let raise = 0.36 * size;
        let mut raised = false;
        for (run, is_raised) in text::superscript_runs(content) {
            // Each shift of the baseline lasts, so the next run undoes it.
            if is_raised || raised {
                body.push_str("<tspan dy=\"");
                push_number(body, if is_raised { -raise } else { raise });
                if is_raised {
                    body.push_str("\" font-size=\"");
                    push_number(body, text::RAISED_SCALE * size);
                }
                body.push_str("\">");
                escape_into(body, &run);
                body.push_str("</tspan>");
            } else {
                escape_into(body, &run);
            }
            raised = is_raised;
        }
        self.svg.close(self.name);
    }
}

/// The `d` attribute of a path.
#[derive(Default)]
pub(crate) struct Path {
    data: String,
    /// Where the last outline in tenths began, in tenths.
    at: Option<(i64, i64)>,
}

impl Path {
    fn command(&mut self, letter: char, numbers: &[f64]) {
        self.data.push(letter);
        for (k, &number) in numbers.iter().enumerate() {
            if k > 0 {
                self.data.push(' ');
            }
            push_number(&mut self.data, number);
        }
    }

    pub(crate) fn move_to(&mut self, p: (f64, f64)) {
        self.command('M', &[p.0, p.1]);
    }

    pub(crate) fn line_to(&mut self, p: (f64, f64)) {
        self.command('L', &[p.0, p.1]);
    }

    pub(crate) fn cubic_to(&mut self, a: (f64, f64), b: (f64, f64), p: (f64, f64)) {
        self.command('C', &[a.0, a.1, b.0, b.1, p.0, p.1]);
    }

    /// A dot: a line too short to see, which round caps make a disc.
    pub(crate) fn dot(&mut self, p: (f64, f64)) {
        self.move_to(p);
        self.data.push_str("h.01");
    }

    /// A square with the centre `p`.
    pub(crate) fn square(&mut self, p: (f64, f64), side: f64) {
        self.move_to((p.0 - 0.5 * side, p.1 - 0.5 * side));
        self.command('h', &[side]);
        self.command('v', &[side]);
        self.command('h', &[-side]);
        self.data.push('z');
    }

    /// A closed polygon in whole tenths, told from the start of the one before:
    /// for thousands of small ones. Of a path that holds nothing else.
    pub(crate) fn polygon_in_tenths(&mut self, corners: &[(f64, f64)]) {
        self.steps_in_tenths(corners);
        self.data.push('z');
    }

    /// Lines through `points` in whole tenths; a point that is no number ends
    /// one line before the next. Of a path that holds nothing else.
    pub(crate) fn lines_in_tenths(&mut self, points: &[(f64, f64)]) {
        for line in points.split(|p| p.0.is_nan() || p.1.is_nan()) {
            if line.len() > 1
                && let Some(end) = self.steps_in_tenths(line)
            {
                self.at = Some(end);
            }
        }
    }

    /// Steps from corner to corner; returns the last.
    fn steps_in_tenths(&mut self, corners: &[(f64, f64)]) -> Option<(i64, i64)> {
        // Far outside any picture, yet within what every viewer can hold.
        let tenths = |value: f64| (10.0 * value.clamp(-1.0e6, 1.0e6)).round() as i64;
        let mut corners = corners.iter().map(|p| (tenths(p.0), tenths(p.1)));
        let start = corners.next()?;
        let mut at = self.at.unwrap_or_default();
        // Pairs after `m` are steps; at the start of a path it means a place all the same.
        self.data.push('m');
        self.at = Some(start);
        let mut first = true;
        for p in std::iter::once(start).chain(corners) {
            let step = (p.0 - at.0, p.1 - at.1);
            if !first && step == (0, 0) {
                continue;
            }
            push_tenths(&mut self.data, step.0, !first);
            push_tenths(&mut self.data, step.1, true);
            (at, first) = (p, false);
        }
        Some(at)
    }

    /// A stroke from `p` to the right.
    pub(crate) fn level(&mut self, p: (f64, f64), length: f64) {
        self.move_to(p);
        self.command('h', &[length]);
    }

    /// An upright stroke at `x`.
    pub(crate) fn upright(&mut self, x: f64, from: f64, to: f64) {
        self.move_to((x, from));
        self.command('V', &[to]);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    pub(crate) fn data(&self) -> &str {
        &self.data
    }
}

/// Appends a number of tenths, after a space where one is needed.
fn push_tenths(out: &mut String, tenths: i64, spaced: bool) {
    if tenths < 0 {
        out.push('-');
    } else if spaced {
        out.push(' ');
    }
    let magnitude = tenths.unsigned_abs();
    let (whole, rest) = (magnitude / 10, magnitude % 10);
    if whole > 0 || rest == 0 {
        out.push_str(&whole.to_string());
    }
    if rest > 0 {
        out.push('.');
        out.push(char::from(b'0' + rest as u8));
    }
}

/// Appends `value` rounded to 1/100, without needless zeros.
fn push_number(out: &mut String, value: f64) {
    // Far outside any picture, yet within what every viewer can hold.
    const FAR: f64 = 1.0e6;
    let hundredths =
        if value.is_nan() { 0 } else { (value.clamp(-FAR, FAR) * 100.0).round() as i64 };
    if hundredths < 0 {
        out.push('-');
    }
    let magnitude = hundredths.unsigned_abs();
    out.push_str(&(magnitude / 100).to_string());
    let rest = magnitude % 100;
    if rest > 0 {
        out.push('.');
        out.push(char::from(b'0' + (rest / 10) as u8));
        if rest % 10 > 0 {
            out.push(char::from(b'0' + (rest % 10) as u8));
        }
    }
}

/// Appends `text` so that it is safe as content and within quotes.
///
/// Characters that XML 1.0 forbids even as references become U+FFFD.
fn escape_into(out: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(' '),
            '\u{0}'..='\u{1f}' | '\u{7f}'..='\u{9f}' | '\u{fffe}' | '\u{ffff}' => {
                out.push('\u{fffd}');
            }
            _ => out.push(c),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(value: f64) -> String {
        let mut out = String::new();
        push_number(&mut out, value);
        out
    }

    #[test]
    fn numbers_are_short_and_rounded() {
        assert_eq!(number(1.0), "1");
        assert_eq!(number(-0.001), "0");
        assert_eq!(number(12.345678), "12.35");
        assert_eq!(number(-3.1), "-3.1");
        assert_eq!(number(0.05), "0.05");
        assert_eq!(number(f64::NAN), "0");
        assert_eq!(number(f64::INFINITY), "1000000");
    }

    #[test]
    fn outlines_in_tenths_are_told_from_one_another() {
        let mut path = Path::default();
        path.polygon_in_tenths(&[(10.0, 20.0), (10.5, 20.0), (10.5, 19.44)]);
        path.polygon_in_tenths(&[(9.0, 20.1), (9.0, 20.1), (8.9, 22.0)]);
        assert_eq!(path.data(), "m10 20 .5 0 0-.6zm-1 .1-.1 1.9z");
        let mut path = Path::default();
        let gap = (f64::NAN, 0.0);
        path.lines_in_tenths(&[
            (1.0, 1.0),
            (2.0, 2.0),
            gap,
            (5.0, 5.0),
            gap,
            (3.0, 2.0),
            (3.0, 3.0),
        ]);
        assert_eq!(path.data(), "m1 1 1 1m1 0 0 1");
    }

    #[test]
    fn hostile_text_comes_back_from_a_parser() {
        let hostile = "a<b> & \"c\" 'd' ]]> \u{1}\u{ffff}\u{85} \u{1F600}";
        let mut svg = Svg::default();
        svg.tag("text").attribute("id", hostile).plain(hostile);
        let written = svg.finish();
        let parsed = roxmltree::Document::parse(&written).unwrap();
        let expected = "a<b> & \"c\" 'd' ]]> \u{fffd}\u{fffd}\u{fffd} \u{1F600}";
        assert_eq!(parsed.root_element().text(), Some(expected));
        assert_eq!(parsed.root_element().attribute("id"), Some(expected));
    }

    #[test]
    fn superscripts_are_raised_and_the_baseline_returns() {
        let mut svg = Svg::default();
        svg.label((0.0, 0.0), 10.0, "#000", "start", "10⁻¹² m");
        let written = svg.finish();
        assert!(written.contains("10<tspan dy=\"-3.6\" font-size=\"7\">−12</tspan>"));
        assert!(written.contains("<tspan dy=\"3.6\"> m</tspan>"));
    }
}
