//! Wall and processor time of repeated runs.

use rustix::time::{ClockId, clock_gettime};
use std::time::Instant;

/// How often and how long a run is repeated.
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    /// Stop once this many seconds are spent.
    pub seconds: f64,
    /// But repeat at least this often.
    pub least: usize,
    /// And at most this often.
    pub most: usize,
}

/// Seconds of every repetition.
#[derive(Debug, Clone, Default)]
pub struct Times {
    /// Wall time.
    pub wall: Vec<f64>,
    /// Processor time of all threads of the process.
    pub processor: Vec<f64>,
}

impl Times {
    /// Times one run; what it returns is not dropped inside.
    pub fn record<R>(&mut self, run: impl FnOnce() -> R) -> R {
        let (processor, wall) = (processor_seconds(), Instant::now());
        let result = run();
        self.wall.push(wall.elapsed().as_secs_f64());
        self.processor.push(processor_seconds() - processor);
        result
    }
}

/// Repeats `run` on what `prepare` makes; only `run` is timed, and its result is dropped outside.
pub fn repeat<T, R>(
    budget: Budget,
    mut prepare: impl FnMut() -> T,
    mut run: impl FnMut(T) -> R,
) -> Times {
    let mut times = Times::default();
    let start = Instant::now();
    while times.wall.len() < budget.most
        && (times.wall.len() < budget.least || start.elapsed().as_secs_f64() < budget.seconds)
    {
        let input = prepare();
        drop(times.record(|| run(input)));
    }
    times
}

/// The middle value, or the mean of the two in the middle; NaN of none.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let half = sorted.len() / 2;
    match sorted.len() {
        0 => f64::NAN,
        count if count % 2 == 1 => sorted[half],
        _ => 0.5 * (sorted[half - 1] + sorted[half]),
    }
}

fn processor_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 3.0, 2.0]), 2.5);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn runs_are_counted() {
        let budget = Budget { seconds: 0.0, least: 3, most: 10 };
        let mut calls = 0;
        let times = repeat(budget, || 1, |one| calls += one);
        assert_eq!((calls, times.wall.len(), times.processor.len()), (3, 3, 3));
    }
}
