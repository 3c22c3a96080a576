//! How wide a text is, and cutting or breaking it to a width.

/// Advance widths of the characters from U+0020 to U+007E in DejaVu Sans, in
/// 1/2048 of the font size.
const ASCII_ADVANCES: [u16; 95] = [
    651, 821, 942, 1716, 1303, 1946, 1597, 563, 799, 799, 1024, 1716, 651, 739, 651, 690, 1303,
    1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 690, 690, 1716, 1716, 1716, 1087, 2048,
    1401, 1405, 1430, 1577, 1294, 1178, 1587, 1540, 604, 604, 1343, 1141, 1767, 1532, 1612, 1235,
    1612, 1423, 1300, 1251, 1499, 1401, 2025, 1403, 1251, 1403, 799, 690, 799, 1716, 1024, 1024,
    1255, 1300, 1126, 1300, 1260, 721, 1300, 1298, 569, 569, 1186, 569, 1995, 1298, 1253, 1300,
    1300, 842, 1067, 803, 1298, 1212, 1675, 1212, 1212, 1075, 1303, 690, 1303, 1716,
];

/// Size of raised digits relative to the text they stand in.
pub(crate) const RAISED_SCALE: f64 = 0.7;

/// Width of `text` set in `size`; never too small by much, since characters
/// that the table lacks count as wide.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(advance).sum::<f64>() * size
}

fn advance(c: char) -> f64 {
    if let Some(plain) = plain_of_superscript(c) {
        return RAISED_SCALE * advance(plain);
    }
    let index = u32::from(c).wrapping_sub(0x20) as usize;
    match ASCII_ADVANCES.get(index) {
        Some(&units) => f64::from(units) / 2048.0,
        None if c == '−' || c == '×' => 1716.0 / 2048.0,
        None if c == '\u{a0}' => 651.0 / 2048.0,
        // Latin, Greek and Cyrillic letters seldom exceed 0.8 of the size;
        // ideographs fill the whole square.
        None if u32::from(c) < 0x2000 => 0.8,
        None => 1.0,
    }
}

fn plain_of_superscript(c: char) -> Option<char> {
    Some(match c {
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴' => '4',
        '⁵' => '5',
        '⁶' => '6',
        '⁷' => '7',
        '⁸' => '8',
        '⁹' => '9',
        '⁻' => '−',
        _ => return None,
    })
}

/// Splits `text` into runs that are wholly superscript (given as the plain
/// characters, marked `true`) or wholly not.
pub(crate) fn superscript_runs(text: &str) -> Vec<(String, bool)> {
    let mut runs: Vec<(String, bool)> = Vec::new();
    for c in text.chars() {
        let plain = plain_of_superscript(c);
        let is_raised = plain.is_some();
        let c = plain.unwrap_or(c);
        match runs.last_mut() {
            Some((run, raised)) if *raised == is_raised => run.push(c),
            _ => runs.push((c.to_string(), is_raised)),
        }
    }
    runs
}

/// `10` with `exponent` in superscript.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let mut out = String::from("10");
    if exponent < 0 {
        out.push('⁻');
    }
    for digit in exponent.unsigned_abs().to_string().bytes() {
        out.push(DIGITS[usize::from(digit - b'0') % 10]);
    }
    out
}

/// `count` with a thin gap between groups of three digits.
pub(crate) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut out = String::new();
    for (k, c) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            out.push('\u{a0}');
        }
        out.push(c);
    }
    out
}

/// `25th`, `31st`, `2nd`, `13th`.
pub(crate) fn ordinal(number: usize) -> String {
    let ending = match (number % 10, number % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{}{ending}", grouped(number))
}

/// `text` cut with an ellipsis if it is wider than `room`.
pub(crate) fn fit(text: &str, size: f64, room: f64) -> String {
    let mut used = 0.0;
    let mut kept = String::new();
    for c in text.chars() {
        used += advance(c) * size;
        if used > room {
            while kept.ends_with(' ') || width(&kept, size) + size > room {
                if kept.pop().is_none() {
                    break;
                }
            }
            kept.push('…');
            return kept;
        }
        kept.push(c);
    }
    kept
}

/// Breaks `text` at spaces into at most `most` lines no wider than `room`;
/// what does not fit is cut with an ellipsis.
pub(crate) fn wrap(text: &str, size: f64, room: f64, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        // The last line takes all that is left, and is cut once it is full.
        let last = lines.len() + 1 >= most;
        if line.is_empty() {
            line.push_str(word);
        } else if last || width(&line, size) + width(word, size) + 0.32 * size <= room {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(fit(&line, size, room));
            line = word.to_owned();
        }
        if last && width(&line, size) > room {
            break;
        }
    }
    if !line.is_empty() {
        lines.push(fit(&line, size, room));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_and_ordinals_read_well() {
        assert_eq!(power_of_ten(-12), "10⁻¹²");
        assert_eq!(power_of_ten(0), "10⁰");
        assert_eq!(ordinal(25), "25th");
        assert_eq!(ordinal(31), "31st");
        assert_eq!(ordinal(112), "112th");
        assert_eq!(grouped(1_234_567), "1\u{a0}234\u{a0}567");
        assert_eq!(grouped(4000), "4000");
    }

    #[test]
    fn cut_text_fits() {
        let long = "wide words ".repeat(10_000);
        for room in [0.0, 5.0, 50.0, 300.0] {
            let cut = fit(&long, 12.0, room);
            assert!(cut == "…" || width(&cut, 12.0) <= room, "{cut}");
        }
        assert_eq!(fit("short", 12.0, 100.0), "short");
    }

    #[test]
    fn wrapped_lines_fit_and_stay_few() {
        let lines = wrap(&"some words in a row ".repeat(50), 10.0, 200.0, 3);
        assert_eq!(lines.len(), 3);
        assert!(lines.iter().all(|line| width(line, 10.0) <= 200.0));
        assert!(lines[2].ends_with('…'));
        assert!(wrap("", 10.0, 200.0, 3).is_empty());
        assert_eq!(wrap("one two", 10.0, 200.0, 1), ["one two"]);
    }
}
