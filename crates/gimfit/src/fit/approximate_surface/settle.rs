//! Breakpoints that the lines of the data can hold.

/// Moves breakpoints apart and inwards until every control point sees data lines of its own: as many
/// lines between two breakpoints as there are steps between them, at least, and about half a degree
/// more before the first and after the last of an open direction. As many breakpoints as an
/// interpolant has come to stand in the middle of the lines that their functions see. `second` bounds
/// where any point of the second line, and of the last but one, stands.
pub(super) fn settle(
    breaks: &mut [f64],
    lines: &[f64],
    second: [f64; 2],
    degree: usize,
    closed: bool,
) {
    let (count, points) = (breaks.len(), lines.len());
    if count == 0 || points < 2 {
        return;
    }
    if closed {
        breaks.iter_mut().for_each(|t| *t = t.rem_euclid(1.0));
        breaks.sort_by(f64::total_cmp);
    }
    // Lines counted from 0, with shares between them.
    let number = |t: f64| -> f64 {
        let after = lines.partition_point(|&line| line <= t);
        let (from, to) = match (after.checked_sub(1), lines.get(after)) {
            (Some(before), Some(&to)) => (lines[before], to),
            (Some(before), None) => (lines[before], lines[0] + 1.0),
            (None, _) => (lines[points - 1] - 1.0, lines[0]),
        };
        let share = if to > from { (t - from) / (to - from) } else { 0.0 };
        after as f64 - 1.0 + share.clamp(0.0, 1.0)
    };
    let place = |f: f64| -> f64 {
        let below = f.floor();
        let at = |index: f64| -> f64 {
            let lap = index.div_euclid(points as f64);
            lines[index.rem_euclid(points as f64) as usize] + lap
        };
        if f >= (points - 1) as f64 && !closed {
            return lines[points - 1];
        }
        at(below) + (f - below) * (at(below + 1.0) - at(below))
    };
    let places: Vec<f64> = breaks.iter().map(|&t| number(t)).collect();
    let (low, high) = if closed {
        (places[0], places[0] + points as f64 - 1.0)
    } else {
        let margin = 0.5 * (degree + 1) as f64;
        let [after, before] = second.map(number);
        let (low, high) = (margin, (points - 1) as f64 - margin);
        // Room for all breakpoints comes first.
        let room = |from: f64, to: f64| to - from >= (count - 1) as f64;
        let far = (low.max(after), high.min(before));
        if room(far.0, far.1) { far } else { (low, high) }
    };
    let mut moved = places.clone();
    let mut least = low;
    for f in &mut moved {
        *f = f.max(least);
        least = *f + 1.0;
    }
    let mut most = high;
    for f in moved.iter_mut().rev() {
        *f = f.min(most);
        most = *f - 1.0;
    }
    for ((t, before), f) in breaks.iter_mut().zip(places).zip(moved) {
        if f != before {
            *t = place(f);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settled_breakpoints_have_lines_between_them() {
        let lines: Vec<f64> = (0..11).map(|i| f64::from(i * i) / 100.0).collect();
        let second = [lines[1], lines[9]];
        let mut breaks = vec![0.001, 0.002, 0.5, 0.501, 0.999];
        settle(&mut breaks, &lines, second, 3, false);
        assert!(
            breaks.windows(2).all(|pair| {
                lines.iter().filter(|&&t| pair[0] <= t && t <= pair[1]).count() >= 1
            })
        );
        assert!(breaks[0] >= lines[2] - 1e-15 && breaks[4] <= lines[8] + 1e-15);
        // As many as an interpolant has: averages over three lines, nearly.
        let mut dense: Vec<f64> = vec![0.5; 7];
        settle(&mut dense, &lines, second, 3, false);
        for (i, t) in dense.iter().enumerate() {
            assert!((t - lines[i + 2]).abs() < 1e-12, "{dense:?}");
        }
        // Round a closed direction they stay within a period.
        let around: Vec<f64> = (0..10).map(|i| f64::from(i) / 10.0).collect();
        let mut breaks = vec![0.30, 0.31, 0.32, 0.33, 0.34];
        settle(&mut breaks, &around, [0.0, 1.0], 3, true);
        assert!(breaks.windows(2).all(|pair| pair[1] - pair[0] > 0.099));
        assert!(breaks[4] - breaks[0] <= 0.9 + 1e-12);
    }
}
