//! Compares recomputed numbers with their references and lays the result out in columns.

use std::fmt::Write;

/// Where reference values come from; heads their column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// Printed in the publication.
    Paper,
    /// Known in closed form.
    Theory,
    /// Computed by other means than this library, with more digits.
    Independent,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    Agrees,
    /// Both values are what rounding errors leave; their digits mean nothing.
    RoundingLevel,
    /// The paper prints something else than its own method gives.
    Misprint,
    /// Near the recomputed value, but the method does not give the digits printed.
    NotMet,
    Disagrees,
}

/// A reference value and the recomputed one.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    label: String,
    reference: String,
    recomputed: String,
    difference: f64,
    verdict: Verdict,
    remark: Option<&'static str>,
}

/// Rounding errors of the recomputation, in units of the largest coordinate.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Below this share of the largest coordinate, residuals are made of rounding errors.
pub(super) const ROUNDING_LEVEL: f64 = 64.0 * f64::EPSILON;

impl Entry {
    /// Compares with a number printed to `digits` significant digits: the recomputed one must round
    /// to it. `scale` is the largest coordinate, in which rounding errors are measured: they alone
    /// decide where the exact value lies midway between two printable ones.
    pub(super) fn printed(
        label: String,
        printed: &str,
        digits: usize,
        recomputed: f64,
        scale: f64,
    ) -> Self {
        let reference = number(printed);
        let unit = 10f64.powi(decimal_exponent(reference) + 1 - digits as i32);
        let allowed = 0.5 * unit + ROUNDING * scale;
        Self::within(label, printed.into(), reference, allowed, (recomputed, digits + 4))
    }

    /// Compares with a value known better than doubles: a relative difference is allowed.
    pub(super) fn known(
        label: String,
        reference: (String, f64),
        relative: f64,
        recomputed: f64,
    ) -> Self {
        let (text, value) = reference;
        Self::within(label, text, value, relative * value.abs(), (recomputed, 12))
    }

    /// Compares a count: it is the same or it is not.
    pub(super) fn counted(label: String, reference: (String, f64), recomputed: f64) -> Self {
        let (text, value) = reference;
        let mut entry = Self::within(label, text, value, 0.0, (recomputed, 1));
        entry.recomputed = format!("{recomputed}");
        entry
    }

    /// Compares with an upper bound.
    pub(super) fn bounded(label: String, bound: (&str, f64), recomputed: f64) -> Self {
        let (text, value) = bound;
        let mut entry =
            Self::within(label, format!("<= {text}"), value, f64::INFINITY, (recomputed, 6));
        if recomputed.is_nan() || recomputed > value {
            entry.verdict = Verdict::Disagrees;
        }
        entry
    }

    fn within(
        label: String,
        reference: String,
        value: f64,
        allowed: f64,
        (recomputed, digits): (f64, usize),
    ) -> Self {
        let difference = recomputed - value;
        let agrees = difference.abs() <= allowed;
        Self {
            label,
            reference,
            recomputed: significant(recomputed, digits),
            difference,
            verdict: if agrees { Verdict::Agrees } else { Verdict::Disagrees },
            remark: None,
        }
    }

    /// A reason why the paper prints this entry wrongly, if one is known.
    pub(super) fn misprint(mut self, reason: Option<&'static str>) -> Self {
        if reason.is_some() && self.verdict == Verdict::Disagrees {
            self.verdict = Verdict::Misprint;
            self.remark = reason;
        }
        self
    }

    /// Says that nothing is known to be wrong with what is printed, and that it cannot be met all
    /// the same.
    pub(super) fn cannot_be_met(mut self) -> Self {
        if self.verdict == Verdict::Disagrees {
            self.verdict = Verdict::NotMet;
        }
        self
    }

    /// Judges an entry made of rounding errors: both values must be as small as those are.
    pub(super) fn at_rounding_level(mut self, scale: f64) -> Self {
        let level = ROUNDING_LEVEL * scale;
        let small = |text: &str| number(text).abs() <= level;
        self.verdict = if small(&self.reference) && small(&self.recomputed) {
            Verdict::RoundingLevel
        } else {
            Verdict::Disagrees
        };
        self
    }
}

/// One block of a table.
#[derive(Debug, Clone)]
pub(super) enum Part {
    /// Measured values without a reference, or a remark.
    Text(String),
    /// Values beside their references.
    Entries { heading: String, source: Source, entries: Vec<Entry> },
}

/// A reproduced table.
#[derive(Debug, Clone)]
pub(super) struct Table {
    /// What it is and where it was published.
    pub(super) title: &'static str,
    pub(super) parts: Vec<Part>,
}

impl Table {
    /// Whether no entry disagrees.
    pub(super) fn agrees(&self) -> bool {
        let entries = |part: &Part| match part {
            Part::Text(_) => true,
            Part::Entries { entries, .. } => count(entries, Verdict::Disagrees) == 0,
        };
        self.parts.iter().all(entries)
    }

    /// All parts in columns.
    pub(super) fn text(&self, name: &str) -> String {
        let mut text = format!("{name}: {}\n", self.title);
        for part in &self.parts {
            text.push('\n');
            match part {
                Part::Text(block) => text.push_str(block),
                Part::Entries { heading, source, entries } => {
                    text.push_str(heading);
                    text.push('\n');
                    columns(&mut text, *source, entries);
                }
            }
        }
        text
    }

    /// How many entries agree: a line for each source of references.
    pub(super) fn summary(&self, name: &str) -> String {
        let mut text = String::new();
        for (source, what) in [
            (Source::Paper, ["entry", "entries"]),
            (Source::Theory, ["value of theory", "values of theory"]),
            (
                Source::Independent,
                ["value recomputed independently", "values recomputed independently"],
            ),
        ] {
            let entries: Vec<Entry> = self
                .parts
                .iter()
                .filter_map(|part| match part {
                    Part::Entries { source: its, entries, .. } if *its == source => Some(entries),
                    _ => None,
                })
                .flatten()
                .cloned()
                .collect();
            if entries.is_empty() {
                continue;
            }
            let mut sum = format!(
                "{}, {} agree",
                counted(entries.len(), what),
                count(&entries, Verdict::Agrees)
            );
            let rounded = count(&entries, Verdict::RoundingLevel);
            if rounded > 0 {
                sum += &format!(", {rounded} at rounding level");
            }
            if source == Source::Paper {
                let misprints = counted(count(&entries, Verdict::Misprint), MISPRINTS);
                let not_met = count(&entries, Verdict::NotMet);
                if not_met > 0 {
                    sum += &format!(", {not_met} cannot be met");
                }
                sum += &format!(", {misprints} in the paper");
            }
            sum += &format!(", {} disagree", count(&entries, Verdict::Disagrees));
            text += &format!("{name}: {sum}\n");
        }
        text
    }
}

const MISPRINTS: [&str; 2] = ["misprint", "misprints"];

fn counted(count: usize, [one, many]: [&str; 2]) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

fn count(entries: &[Entry], verdict: Verdict) -> usize {
    entries.iter().filter(|entry| entry.verdict == verdict).count()
}

fn columns(text: &mut String, source: Source, entries: &[Entry]) {
    let reference = match source {
        Source::Paper => "paper",
        Source::Theory => "theory",
        Source::Independent => "independent",
    };
    let header = ["", reference, "recomputed", "difference", "verdict"].map(String::from);
    let rows: Vec<[String; 5]> = std::iter::once(header)
        .chain(entries.iter().map(|entry| {
            [
                entry.label.clone(),
                entry.reference.clone(),
                entry.recomputed.clone(),
                if entry.difference == 0.0 {
                    "0".into()
                } else {
                    format!("{:+.1e}", entry.difference)
                },
                match entry.verdict {
                    Verdict::Agrees => "agrees",
                    Verdict::RoundingLevel => "rounding level",
                    Verdict::Misprint => "misprint",
                    Verdict::NotMet => "cannot be met",
                    Verdict::Disagrees => "DISAGREES",
                }
                .into(),
            ]
        }))
        .collect();
    let width = |column: usize| rows.iter().map(|row| row[column].len()).max().unwrap_or(0);
    let widths: [usize; 4] = std::array::from_fn(width);
    for [label, reference, recomputed, difference, verdict] in &rows {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "  {label:<0$}  {reference:>1$}  {recomputed:>2$}  {difference:>3$}  {verdict}",
            widths[0], widths[1], widths[2], widths[3]
        );
    }
    for entry in entries {
        if let Some(remark) = entry.remark {
            let _ = writeln!(text, "  {}: {remark}", entry.label);
        }
    }
}

/// A number of this table; one that cannot be read agrees with nothing.
fn number(text: &str) -> f64 {
    text.parse().unwrap_or(f64::NAN)
}

/// Exponent of the leading decimal digit.
fn decimal_exponent(value: f64) -> i32 {
    if value == 0.0 || !value.is_finite() { 0 } else { value.abs().log10().floor() as i32 }
}

/// A number with this many significant digits, in exponential form where zeros would lead or trail.
pub(super) fn significant(value: f64, digits: usize) -> String {
    let exponent = decimal_exponent(value);
    let decimals = digits as i32 - 1 - exponent;
    if value == 0.0 {
        "0".into()
    } else if (-3..6).contains(&exponent) && decimals >= 0 {
        format!("{value:.*}", decimals as usize)
    } else {
        format!("{value:.*e}", digits - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(text: &str, recomputed: f64) -> Entry {
        Entry::printed("entry".into(), text, 5, recomputed, 1.0)
    }

    #[test]
    fn an_entry_agrees_if_it_rounds_to_what_is_printed() {
        assert_eq!(printed("4.0156", 4.015_625).verdict, Verdict::Agrees);
        assert_eq!(printed("4.0156", 4.015_66).verdict, Verdict::Disagrees);
        // Trailing zeros are dropped: 4 stands for 4.0000.
        assert_eq!(printed("4", 4.000_049).verdict, Verdict::Agrees);
        assert_eq!(printed("4", 4.000_051).verdict, Verdict::Disagrees);
        // Midway, whatever rounding did.
        assert_eq!(printed("4.7188", 4.718_75 - 1e-16).verdict, Verdict::Agrees);
        assert_eq!(printed("what", 1.0).verdict, Verdict::Disagrees);
    }

    #[test]
    fn only_a_known_reason_excuses_an_entry() {
        let wrong = printed("1.17e-2", 0.117);
        assert_eq!(wrong.clone().misprint(None).verdict, Verdict::Disagrees);
        let entry = wrong.misprint(Some("the exponent must be -1"));
        let table = Table {
            title: "",
            parts: vec![Part::Entries {
                heading: String::new(),
                source: Source::Paper,
                entries: vec![entry, printed("2", 2.0)],
            }],
        };
        assert!(table.agrees() && table.text("").contains("exponent must be"));
        let summary = "name: 2 entries, 1 agree, 1 misprint in the paper, 0 disagree\n";
        assert_eq!(table.summary("name"), summary);
    }

    #[test]
    fn rounding_level_asks_both_values_to_be_tiny() {
        let judge = |value| printed("8.0e-15", value).at_rounding_level(1.0).verdict;
        assert_eq!(judge(3e-15), Verdict::RoundingLevel);
        assert_eq!(judge(3e-13), Verdict::Disagrees);
    }

    #[test]
    fn bounds_are_one_sided() {
        let judge = |value| Entry::bounded(String::new(), ("1/2", 0.5), value).verdict;
        assert_eq!((judge(0.1), judge(0.51)), (Verdict::Agrees, Verdict::Disagrees));
        assert_eq!(judge(f64::NAN), Verdict::Disagrees);
    }

    #[test]
    fn significant_digits() {
        assert_eq!(significant(5.375, 6), "5.37500");
        assert_eq!(significant(-7.8903e-5, 5), "-7.8903e-5");
        assert_eq!(significant(0.0, 5), "0");
    }
}
