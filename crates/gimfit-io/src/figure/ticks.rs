//! Round positions on a linear axis and their labels.
//!
//! Labels are made from whole numbers, so that no rounding of the positions
//! ever shows in them.

use super::scale::Interval;
use super::{style, text};

/// Labels of more steps than this from zero share an offset instead.
const MOST_STEPS_FROM_ZERO: f64 = 2.0e4;

/// Labels of more characters share a factor, lest they reach the axis name.
const LONGEST_LABEL: usize = 6;

/// Positions with labels, and what all labels have in common.
#[derive(Clone, Debug)]
pub(crate) struct Ticks {
    /// Position and label, in rising order.
    pub(crate) marks: Vec<(f64, String)>,
    /// Common factor and offset as text, such as `×10⁻³ + 1 000 000 000`;
    /// empty where the labels are the values themselves.
    pub(crate) common: String,
    /// Whether there is an offset.
    pub(crate) has_offset: bool,
}

/// A step of 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy, Debug)]
struct Step {
    multiple: i64,
    exponent: i32,
}

impl Step {
    /// The smallest step that is not below `length`.
    fn at_least(length: f64) -> Self {
        let mut step = Self { multiple: 1, exponent: order(length) - 1 };
        // Four steps reach ten times the start; the rest is for rounding.
        for _ in 0..8 {
            if step.size() >= length {
                break;
            }
            step = step.next();
        }
        step
    }

    fn next(self) -> Self {
        match self.multiple {
            1 => Self { multiple: 2, ..self },
            2 => Self { multiple: 5, ..self },
            _ => Self { multiple: 1, exponent: self.exponent + 1 },
        }
    }

    /// The nearest double; dividing by powers of ten would not give it.
    fn size(self) -> f64 {
        format!("{}e{}", self.multiple, self.exponent).parse().unwrap_or(f64::MAX)
    }
}

/// Which direction labels lie side by side in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Direction {
    /// Beside one another, so their widths count.
    Across,
    /// On top of one another, so their heights count.
    Upward,
}

/// Ticks for `values`, in units of ten to the power of `unit`, on an axis
/// `length` long, as many as fit with room.
pub(crate) fn linear_ticks(
    values: Interval,
    length: f64,
    direction: Direction,
    unit: i32,
) -> Ticks {
    ticks_for(values, length, direction, Labels { whole: false, unit })
}

/// Ticks at whole numbers only.
pub(super) fn whole_ticks(values: Interval, length: f64, direction: Direction) -> Ticks {
    ticks_for(values, length, direction, Labels { whole: true, unit: 0 })
}

/// What labels say of their positions.
#[derive(Clone, Copy, Debug)]
struct Labels {
    /// Whether only whole numbers are labelled.
    whole: bool,
    /// The unit of the positions, as a power of ten.
    unit: i32,
}

fn ticks_for(values: Interval, length: f64, direction: Direction, labels: Labels) -> Ticks {
    let wanted = match direction {
        // Long axes need more labels, but not in proportion.
        Direction::Across => 0.35 * length.sqrt(),
        Direction::Upward => length / 42.0,
    };
    let mut step = Step::at_least(values.span() / wanted.max(1.5));
    let mut ticks = fitting(values, length, direction, labels, &mut step);
    // One label tells no scale: finer steps may still fit.
    for _ in 0..2 {
        if ticks.marks.len() >= 2 {
            break;
        }
        let mut finer = Step::at_least(0.3 * step.size());
        ticks = fitting(values, length, direction, labels, &mut finer);
        step = finer;
    }
    ticks
}

/// Ticks with `step` or the next larger one at which labels stay apart.
fn fitting(
    values: Interval,
    length: f64,
    direction: Direction,
    labels: Labels,
    step: &mut Step,
) -> Ticks {
    if labels.whole && step.exponent < 0 {
        *step = Step { multiple: 1, exponent: 0 };
    }
    let mut ticks = ticks_with(values, *step, labels);
    // Each step is at least twice the last, so few tries leave one label.
    for _ in 0..16 {
        if fits(&ticks, values, length, direction) {
            break;
        }
        *step = step.next();
        ticks = ticks_with(values, *step, labels);
    }
    ticks
}

fn fits(ticks: &Ticks, values: Interval, length: f64, direction: Direction) -> bool {
    let size = style::LABEL_SIZE;
    let per_unit = length / values.span();
    ticks.marks.windows(2).all(|pair| {
        let apart = (pair[1].0 - pair[0].0) * per_unit;
        match direction {
            Direction::Across => {
                let widths = text::width(&pair[0].1, size) + text::width(&pair[1].1, size);
                apart >= 0.5 * widths + size
            }
            Direction::Upward => apart >= 1.6 * size,
        }
    })
}

fn ticks_with(values: Interval, step: Step, labels: Labels) -> Ticks {
    let size = step.size();
    let far = values.low.abs().max(values.high.abs()) / size > MOST_STEPS_FROM_ZERO;
    let (offset, offset_text) =
        if far { offset_near(values, labels.unit) } else { (0.0, String::new()) };
    let first = ((values.low - offset) / size - 1.0e-6).ceil() as i64;
    let last = ((values.high - offset) / size + 1.0e-6).floor() as i64;
    // A broken interval must not make a long loop.
    let last = last.min(first.saturating_add(60));
    let largest = first.unsigned_abs().max(last.unsigned_abs()) * step.multiple as u64;
    let exponent = step.exponent + labels.unit;
    let order = exponent + largest.max(1).ilog10() as i32;
    let longest = decimal(first.min(-1) * step.multiple, exponent);
    let short = (-3..=4).contains(&order) && longest.chars().count() <= LONGEST_LABEL;
    // Counts are read best in full.
    let factor = if short || (labels.whole && order <= 7) { 0 } else { order };
    let marks = (first..=last)
        .map(|k| (offset + k as f64 * size, decimal(k * step.multiple, exponent - factor)))
        .collect();
    let mut common = String::new();
    if factor != 0 {
        common.push('×');
        common.push_str(&text::power_of_ten(factor));
    }
    if !offset_text.is_empty() {
        if !common.is_empty() {
            common.push(' ');
        }
        common.push_str(&offset_text);
    }
    Ticks { marks, common, has_offset: !offset_text.is_empty() }
}

/// A round value near the centre of `values`, and how to say that it is added.
fn offset_near(values: Interval, unit: i32) -> (f64, String) {
    let centre = values.centre();
    // The offset is a multiple of a power of ten above the span, hence of
    // each step too.
    let digits = (order(centre) - order(values.span()) - 1).clamp(0, 17) as usize;
    let scientific = format!("{centre:.digits$e}");
    let offset: f64 = scientific.parse().unwrap_or(centre);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent = exponent.parse().unwrap_or(0) + unit;
    let magnitude = if (-4..15).contains(&exponent) {
        let places = (digits as i32 - exponent).max(0) as usize;
        let digits = format!("{:.places$}", offset.abs());
        grouped(without_end_zeros(&digits))
    } else {
        let mantissa = without_end_zeros(mantissa.trim_start_matches('-'));
        format!("{mantissa}×{}", text::power_of_ten(exponent))
    };
    let sign = if offset < 0.0 { '−' } else { '+' };
    (offset, format!("{sign} {magnitude}"))
}

/// `number` without zeros that end its decimal places.
fn without_end_zeros(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

/// `number` with gaps between groups of three digits before the point.
fn grouped(number: &str) -> String {
    let (whole, rest) = number.split_at(number.find('.').unwrap_or(number.len()));
    match whole.parse::<usize>() {
        Ok(whole) => text::grouped(whole) + rest,
        Err(_) => number.to_owned(),
    }
}

/// The power of ten of the first digit of `value`.
pub(crate) fn order(value: f64) -> i32 {
    if value == 0.0 || !value.is_finite() {
        return 0;
    }
    // The logarithm may round up to the next whole number; the digits do not.
    let digits = format!("{:e}", value.abs());
    digits.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// `number` times ten to the power of `exponent`, written out.
fn decimal(number: i64, exponent: i32) -> String {
    if number == 0 {
        return "0".to_owned();
    }
    let mut digits = number.unsigned_abs().to_string();
    if exponent >= 0 {
        digits.push_str(&"0".repeat(exponent.min(400) as usize));
    } else {
        let places = exponent.unsigned_abs() as usize;
        if digits.len() <= places {
            digits.insert_str(0, &"0".repeat(places + 1 - digits.len()));
        }
        digits.insert(digits.len() - places, '.');
    }
    if number < 0 {
        digits.insert(0, '−');
    }
    digits
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ticks(low: f64, high: f64) -> Ticks {
        linear_ticks(Interval { low, high }, 600.0, Direction::Across, 0)
    }

    fn labels(low: f64, high: f64) -> Vec<String> {
        ticks(low, high).marks.into_iter().map(|m| m.1).collect()
    }

    #[test]
    fn familiar_ranges_get_familiar_labels() {
        assert_eq!(labels(0.0, 1.0), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(-24.3, -13.4), ["−24", "−22", "−20", "−18", "−16", "−14"]);
        assert_eq!(labels(0.0, 250.0), ["0", "50", "100", "150", "200", "250"]);
    }

    #[test]
    fn large_and_small_values_share_a_factor() {
        let large = ticks(0.0, 3.0e8);
        assert_eq!(large.common, "×10⁸");
        assert_eq!(large.marks[1].1, "0.5");
        let small = ticks(-2.0e-7, 2.0e-7);
        assert_eq!(small.common, "×10⁻⁷");
    }

    #[test]
    fn values_far_from_the_origin_share_an_offset() {
        let far = ticks(1.0e9 - 1.0e-3, 1.0e9 + 1.0e-3);
        assert_eq!(far.common, "×10⁻³ + 1\u{a0}000\u{a0}000\u{a0}000");
        assert!(far.has_offset);
        let shown: Vec<_> = far.marks.iter().map(|m| m.1.as_str()).collect();
        assert_eq!(shown, ["−1.0", "−0.5", "0", "0.5", "1.0"]);
    }

    #[test]
    fn labels_of_positions_in_units_say_the_values() {
        let across = Direction::Across;
        let plain = linear_ticks(Interval { low: 0.0, high: 3.0e8 }, 600.0, across, 0);
        let large = linear_ticks(Interval { low: 0.0, high: 3.0e8 }, 600.0, across, 300);
        assert_eq!((plain.marks, large.common.as_str()), (large.marks, "×10³⁰⁸"));
        let far = linear_ticks(Interval { low: 5.0 - 1e-9, high: 5.0 + 1e-9 }, 600.0, across, 300);
        assert_eq!(far.common, "×10²⁹¹ + 5×10³⁰⁰");
    }

    #[test]
    fn whole_axes_have_whole_labels() {
        let values = Interval { low: 0.0, high: 1.0 };
        let few = whole_ticks(values, 300.0, Direction::Across);
        let shown: Vec<_> = few.marks.iter().map(|m| m.1.as_str()).collect();
        assert_eq!(shown, ["0", "1"]);
    }

    #[test]
    fn orders_are_exact_at_powers_of_ten() {
        assert_eq!(order(1000.0), 3);
        assert_eq!(order(999.999_999_999_999_9), 2);
        assert_eq!(order(1.0e-300), -300);
        assert_eq!(order(0.0), 0);
    }

    proptest! {
        /// Ticks rise, lie within the range, have different labels, and each
        /// label times factor plus offset is its position.
        #[test]
        fn ticks_obey_their_laws(
            mantissa in -10.0_f64..10.0,
            power in -280_i32..280,
            relative in -9.0_f64..1.0,
            length in 60.0_f64..1200.0,
            upward: bool,
        ) {
            let low = mantissa * 10.0_f64.powi(power);
            let span = 10.0_f64.powi(power) * 10.0_f64.powf(relative);
            let values = Interval { low, high: low + span }.opened();
            let direction = if upward { Direction::Upward } else { Direction::Across };
            let made = linear_ticks(values, length, direction, 0);
            prop_assert!(made.marks.len() <= 60);
            prop_assert!(length < 200.0 || !made.marks.is_empty());
            prop_assert!(fits(&made, values, length, direction));
            let slack = 1.0e-5 * values.span();
            for pair in made.marks.windows(2) {
                prop_assert!(pair[0].0 < pair[1].0);
                prop_assert!(pair[0].1 != pair[1].1);
            }
            for (at, label) in &made.marks {
                prop_assert!(*at >= values.low - slack && *at <= values.high + slack);
                prop_assert!(label.chars().count() <= 8, "{}", label);
            }
        }
    }
}
