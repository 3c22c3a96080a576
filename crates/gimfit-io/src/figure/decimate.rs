//! Dropping what a picture cannot show, always in the same way.

/// A position in the picture; not a number where there is no point.
pub(crate) type Px = (f64, f64);

/// Most points of one layer of a panel.
pub(super) const MOST_POINTS: usize = 4000;

/// A layer after points were dropped from it.
pub(crate) struct Thinned {
    /// The points kept, in their order.
    pub(crate) points: Vec<Px>,
    /// Every how many-th point was kept; 1 where no more was dropped than the
    /// resolution of the picture hides.
    pub(crate) stride: usize,
}

/// How often to draw a point so that at most `most` of `count` are drawn.
pub(crate) fn stride_for(count: usize, most: usize) -> usize {
    count.div_ceil(most.max(1)).max(1)
}

/// Every so many-th of `points`, at most `most`.
pub(super) fn every_nth(points: &[Px], most: usize) -> Thinned {
    let stride = stride_for(points.len(), most);
    Thinned { points: points.iter().copied().step_by(stride).collect(), stride }
}

/// A polyline that looks the same, with at most about `most` points.
///
/// First go vertices that pixels cannot tell from others; only if too many
/// are left, every so many-th of all points is kept instead.
pub(crate) fn thin_polyline(points: &[Px], most: usize) -> Thinned {
    let whole = |points| Thinned { points, stride: 1 };
    for tolerance in [0.08, 0.3] {
        let straightened = drop_straight(points, tolerance);
        if straightened.len() <= most {
            return whole(straightened);
        }
    }
    let columns = extremes_of_columns(points, column_width(points, most));
    if columns.len() <= most {
        return whole(columns);
    }
    // About a pixel is still hardly seen, and better than a new, false noise.
    for tolerance in [0.8, 1.5] {
        let straightened = drop_straight(points, tolerance);
        if straightened.len() <= most {
            return whole(straightened);
        }
    }
    let mut thinned = every_nth(points, most);
    thinned.points.extend(points.last());
    thinned
}

/// Drops vertices that lie within about `tolerance` of the line between
/// vertices that stay.
///
/// From the last vertex kept, each later one allows a cone of directions that
/// pass it closely; a vertex outside what all cones share ends the line. One
/// pass, whatever the shape.
fn drop_straight(points: &[Px], tolerance: f64) -> Vec<Px> {
    let mut kept: Vec<Px> = Vec::new();
    let mut line: Option<Sleeve> = None;
    for &p in points {
        if p.0.is_nan() || p.1.is_nan() {
            if let Some(line) = line.take() {
                kept.push(line.end);
                kept.push((f64::NAN, f64::NAN));
            }
            continue;
        }
        match &mut line {
            None => {
                kept.push(p);
                line = Some(Sleeve::from(p));
            }
            Some(current) => {
                if !current.takes(p, tolerance) {
                    kept.push(current.end);
                    let mut next = Sleeve::from(current.end);
                    next.takes(p, tolerance);
                    *current = next;
                }
            }
        }
    }
    kept.extend(line.map(|line| line.end));
    kept
}

/// The directions in which a line may go on, and where it ends so far.
struct Sleeve {
    start: Px,
    end: Px,
    reach: f64,
    heading: f64,
    low: f64,
    high: f64,
}

impl Sleeve {
    fn from(start: Px) -> Self {
        Self { start, end: start, reach: 0.0, heading: f64::NAN, low: 0.0, high: 0.0 }
    }

    /// Lets the line end in `p`, unless it would leave a vertex behind.
    fn takes(&mut self, p: Px, tolerance: f64) -> bool {
        let (dx, dy) = (p.0 - self.start.0, p.1 - self.start.1);
        let distance = dx.hypot(dy);
        if distance < self.reach - tolerance {
            return false;
        }
        if distance > tolerance {
            let direction = dy.atan2(dx);
            let open = (tolerance / distance).asin();
            if self.heading.is_nan() {
                self.heading = direction;
                (self.low, self.high) = (-open, open);
            } else {
                let turn = std::f64::consts::PI;
                let off = (direction - self.heading + turn).rem_euclid(2.0 * turn) - turn;
                if off < self.low || off > self.high {
                    return false;
                }
                self.low = self.low.max(off - open);
                self.high = self.high.min(off + open);
            }
        }
        self.reach = self.reach.max(distance);
        self.end = p;
        true
    }
}

/// Width of columns such that a graph over `points` keeps `most` of them.
fn column_width(points: &[Px], most: usize) -> f64 {
    let (low, high) = points
        .iter()
        .filter(|p| !p.0.is_nan())
        .fold((f64::MAX, f64::MIN), |e, p| (e.0.min(p.0), e.1.max(p.0)));
    // Four points a column, and a column cut at each end.
    let columns = most.saturating_sub(8).max(4) as f64 / 4.0;
    ((high - low) / columns).max(0.25)
}

/// First, lowest, highest and last of each run of points that lie in the same
/// column of `width`: the extremes of a graph survive however dense it is.
fn extremes_of_columns(points: &[Px], width: f64) -> Vec<Px> {
    let column = |p: &Px| {
        if p.0.is_nan() || p.1.is_nan() { i64::MIN } else { (p.0 / width).floor() as i64 }
    };
    let mut kept = Vec::new();
    for run in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |a: &&Px, b: &&Px| a.1.total_cmp(&b.1);
        let mut keep: Vec<Px> = [run.first(), run.last()]
            .into_iter()
            .chain([run.iter().min_by(by_height), run.iter().max_by(by_height)])
            .flatten()
            .copied()
            .collect();
        // Order within a column does not show, only that it is the same each time.
        let last = keep.swap_remove(1);
        keep.push(last);
        keep.dedup();
        kept.extend(keep);
    }
    kept
}

/// Smallest and largest value of one of equally long stretches of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bin {
    /// Index of the first value of the stretch.
    pub(super) first: usize,
    /// Number of values in the stretch.
    pub(super) count: usize,
    /// Smallest value.
    pub(super) low: f64,
    /// Largest value.
    pub(super) high: f64,
}

/// At most `most` stretches of `values`, each with its extremes; values that
/// are no numbers count for nothing.
pub(super) fn bins(values: &[f64], most: usize) -> Vec<Bin> {
    let count = stride_for(values.len(), most);
    values
        .chunks(count)
        .enumerate()
        .filter_map(|(k, chunk)| {
            let numbers = || chunk.iter().copied().filter(|v| !v.is_nan());
            let low = numbers().reduce(f64::min)?;
            let high = numbers().reduce(f64::max)?;
            Some(Bin { first: k * count, count: chunk.len(), low, high })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_dense_line_keeps_its_ends() {
        let line: Vec<Px> = (0..100_000).map(|i| (f64::from(i) * 1e-3, 5.0)).collect();
        let thin = thin_polyline(&line, MOST_POINTS);
        assert!(thin.points.len() < 5 && thin.stride == 1);
        assert_eq!(thin.points.first(), line.first());
        assert_eq!(thin.points.last(), line.last());
    }

    #[test]
    fn a_dense_graph_keeps_its_extremes() {
        let mut graph: Vec<Px> =
            (0..1_000_000).map(|i| (f64::from(i) * 7e-4, f64::from(i % 97))).collect();
        graph[567_890].1 = 400.0;
        graph[123_456].1 = -300.0;
        let thin = thin_polyline(&graph, MOST_POINTS);
        assert!(thin.points.len() <= MOST_POINTS && thin.stride == 1);
        assert!(thin.points.contains(&graph[567_890]));
        assert!(thin.points.contains(&graph[123_456]));
    }

    #[test]
    fn a_scribble_stays_small_and_says_so() {
        let scribble: Vec<Px> = (0..200_000_u64)
            .map(|i| ((i * 7919 % 700) as f64, (i * 104_729 % 500) as f64))
            .collect();
        let thin = thin_polyline(&scribble, MOST_POINTS);
        assert!(thin.points.len() <= MOST_POINTS + 1);
        assert_eq!(thin.stride, 50);
    }

    proptest! {
        #[test]
        fn bins_keep_extremes(values in prop::collection::vec(-1e3_f64..1e3, 1..3000), most in 1_usize..900) {
            let made = bins(&values, most);
            prop_assert!(made.len() <= most);
            prop_assert_eq!(made.iter().map(|b| b.count).sum::<usize>(), values.len());
            let low = made.iter().map(|b| b.low).reduce(f64::min);
            let high = made.iter().map(|b| b.high).reduce(f64::max);
            prop_assert_eq!(low, values.iter().copied().reduce(f64::min));
            prop_assert_eq!(high, values.iter().copied().reduce(f64::max));
        }

        #[test]
        fn dropped_vertices_lie_on_what_is_left(
            steps in prop::collection::vec((-0.5_f64..2.0, -1.0_f64..1.0), 2..300),
        ) {
            let mut at = (0.0, 0.0);
            let line: Vec<Px> = steps.iter().map(|s| { at = (at.0 + s.0, at.1 + s.1); at }).collect();
            let kept = drop_straight(&line, 0.1);
            prop_assert_eq!(kept.first(), line.first());
            prop_assert_eq!(kept.last(), line.last());
            for p in &line {
                let nearest = kept.windows(2).map(|s| distance(*p, s[0], s[1])).fold(f64::MAX, f64::min);
                prop_assert!(nearest < 0.25, "{:?} {}", p, nearest);
            }
        }
    }

    /// Distance of `p` from the segment between `a` and `b`.
    fn distance(p: Px, a: Px, b: Px) -> f64 {
        let (ux, uy) = (b.0 - a.0, b.1 - a.1);
        let square = ux * ux + uy * uy;
        let t = if square > 0.0 {
            (((p.0 - a.0) * ux + (p.1 - a.1) * uy) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (p.0 - a.0 - t * ux).hypot(p.1 - a.1 - t * uy)
    }
}
