//! Where a curve bends as its data turn, and the knots that make its control polygon show it.

use crate::geometry::{Curve, KnotInsertion, bend_signs};
use crate::parameters::Parameters;
use crate::points::Points;
use crate::shape::{Shape, Turn, turn};

/// Rounds of knot insertion, each of which halves spans.
const MOST_ROUNDS: usize = 20;
/// Knots inserted per control point at most, and how many at least are allowed.
const MOST_INSERTED: usize = 8;
const ALWAYS_ALLOWED: usize = 200;

/// The curve between neighbouring data points that have a side to keep.
pub(super) struct Intervals {
    list: Vec<Interval>,
    closed: bool,
}

#[derive(Clone, Copy)]
struct Interval {
    from: f64,
    to: f64,
    sides: [Turn; 2],
}

impl Interval {
    /// Whether a curve that bends in this order keeps the sides of both ends.
    fn allows_bends(&self, bends: &[Turn]) -> bool {
        let [first, last] = self.sides;
        if first == last { bends.iter().all(|&bend| bend == first) } else { bends == self.sides }
    }

    /// The same for the corners of its control polygon, whose change of side may come in the
    /// interval before or after.
    fn allows_turns(&self, turns: &[Turn]) -> bool {
        let [first, last] = self.sides;
        match turns {
            [] => true,
            [only] => *only == first || *only == last,
            [a, b] => first != last && [*a, *b] == [first, last],
            _ => false,
        }
    }
}

impl Intervals {
    pub(super) fn of(shape: &Shape, parameters: &Parameters) -> Self {
        let t = parameters.values();
        let sided: Vec<usize> =
            (0..t.len()).filter(|&j| shape.side_at(j) != Turn::Straight).collect();
        let mut list: Vec<Interval> = sided
            .windows(2)
            .map(|pair| Interval {
                from: t[pair[0]],
                to: t[pair[1]],
                sides: [shape.side_at(pair[0]), shape.side_at(pair[1])],
            })
            .collect();
        let period = parameters.period();
        if let (Some(period), Some(&first), Some(&last)) = (period, sided.first(), sided.last()) {
            list.push(Interval {
                from: t[last],
                to: t[first] + period,
                sides: [shape.side_at(last), shape.side_at(first)],
            });
        }
        Self { list, closed: period.is_some() }
    }

    /// Whether a curve bends everywhere as its data turn.
    pub(super) fn bend_as_asked(&self, curve: &Curve) -> bool {
        let size =
            curve.control_points().coordinates().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let mut signs = Vec::new();
        self.list.iter().all(|interval| {
            signs.clear();
            bend_signs(curve, interval.from, interval.to, size, &mut signs);
            interval.allows_bends(&signs)
        })
    }

    /// Knots after whose insertion the control polygon turns as the data do; `None` if many do not
    /// suffice.
    pub(super) fn insertion(&self, curve: &Curve) -> Option<KnotInsertion> {
        let most = ALWAYS_ALLOWED + MOST_INSERTED * curve.control_points().len();
        let mut added: Vec<f64> = Vec::new();
        for _ in 0..MOST_ROUNDS {
            let insertion = KnotInsertion::new(curve.knots(), &added).ok()?;
            let control = insertion.apply(curve.control_points().coordinates(), 2);
            let finer =
                Curve::new(insertion.knots().clone(), Points::new(2, control).ok()?).ok()?;
            let spans = self.spans_at_fault(&finer);
            if spans.is_empty() {
                return Some(insertion);
            }
            let knots = finer.knots().values();
            let before = added.len();
            for span in spans {
                let middle = 0.5 * (knots[span] + knots[span + 1]);
                if knots[span] < middle && middle < knots[span + 1] {
                    added.push(middle);
                }
            }
            if added.len() == before || added.len() > most {
                return None;
            }
        }
        None
    }

    /// The spans over which the control polygon, without legs of no length, turns as it should not.
    fn spans_at_fault(&self, curve: &Curve) -> Vec<usize> {
        let free = curve.free_control_points();
        let point = |i: usize| {
            let p = curve.control_points().point(i % free);
            [p[0], p[1]]
        };
        let mut distinct: Vec<usize> = (0..free)
            .filter(|&i| i == 0 && !self.closed || point(i) != point((i + free - 1) % free))
            .collect();
        if self.closed {
            distinct.extend(distinct.iter().take(2).map(|i| i + free).collect::<Vec<_>>());
        }
        let greville = curve.knots().greville_abscissae();
        let (start, end) = curve.domain();
        let mut faults = Vec::new();
        // Turns met in each interval: in order, none twice in a row.
        let mut met: Vec<Vec<Turn>> = vec![Vec::new(); self.list.len()];
        let mut corners: Vec<(f64, Turn, [usize; 3])> = Vec::new();
        for corner in distinct.windows(3) {
            let corner = [corner[0], corner[1], corner[2]];
            let [a, b, c] = corner.map(point);
            let turn = turn(a, b, c);
            if turn != Turn::Straight {
                corners.push((self.place(greville[corner[1] % free], end - start), turn, corner));
            }
        }
        // The control points of a closed curve may start anywhere among the intervals.
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let corners: Vec<(usize, Turn, [usize; 3])> = corners
            .into_iter()
            .map(|(t, turn, corner)| (self.interval_of(t), turn, corner))
            .collect();
        for &(interval, turn, _) in &corners {
            if met[interval].last() != Some(&turn) {
                met[interval].push(turn);
            }
        }
        for &(interval, turn, corner) in &corners {
            let [first, last] = self.list[interval].sides;
            let wrong = (first == last && turn != first)
                || (first != last && !self.list[interval].allows_turns(&met[interval]));
            if wrong {
                faults.extend(spans_of(curve, corner[0], corner[2]));
            }
        }
        faults.sort_unstable();
        faults.dedup();
        faults
    }

    /// A parameter of a closed curve brought to the lap of the intervals.
    fn place(&self, t: f64, period: f64) -> f64 {
        let first = self.list.first().map_or(t, |interval| interval.from);
        if self.closed { first + (t - first).rem_euclid(period) } else { t }
    }

    /// The interval that holds a parameter; before the first it is the first, and so on.
    fn interval_of(&self, t: f64) -> usize {
        self.list.partition_point(|interval| interval.to <= t).min(self.list.len() - 1)
    }
}

/// The spans of positive length, inside the domain, that control points `first ..= last` have a
/// part in.
fn spans_of(curve: &Curve, first: usize, last: usize) -> Vec<usize> {
    let (knots, degree) = (curve.knots().values(), curve.degree());
    let free = curve.free_control_points();
    let domain = degree..curve.knots().control_points();
    (first..=last + degree)
        .map(|span| {
            let wraps = curve.is_periodic() && !domain.contains(&span);
            if wraps { (span + free - degree) % free + degree } else { span }
        })
        .filter(|span| domain.contains(span) && knots[*span] < knots[*span + 1])
        .collect()
}
