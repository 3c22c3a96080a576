//! Random draws that repeat exactly from a seed.

/// A small generator (xorshift64*, Vigna 2016).
#[derive(Debug, Clone)]
pub(super) struct Random {
    seed: u64,
    state: u64,
}

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        // Neighbouring seeds are spread, and none is 0.
        let seed = seed.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        Self { seed, state: seed }
    }

    /// Starts from the seed again.
    pub(super) fn reset(&mut self) {
        self.state = self.seed;
    }

    /// A number in [0, 1).
    fn unit(&mut self) -> f64 {
        self.state ^= self.state >> 12;
        self.state ^= self.state << 25;
        self.state ^= self.state >> 27;
        (self.state.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Draws positions with given weights.
#[derive(Debug, Clone)]
pub(super) struct Draw {
    cumulated: Vec<f64>,
    /// The last position with a weight, to which rounding may lead.
    last: usize,
}

impl Draw {
    /// With weights of which none is negative.
    pub(super) fn new(weights: &[f64]) -> Self {
        let mut total = 0.0;
        let last = weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0);
        let cumulated = weights.iter().map(|weight| {
            total += weight;
            total
        });
        Self { cumulated: cumulated.collect(), last }
    }

    /// A position whose weight is above 0; `None` if there is none.
    pub(super) fn next(&self, random: &mut Random) -> Option<usize> {
        let total = *self.cumulated.last()?;
        let mark = random.unit() * total;
        let position = self.cumulated.partition_point(|&sum| sum <= mark);
        (total > 0.0).then_some(position.min(self.last))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_follow_their_weights_and_repeat() {
        let draw = Draw::new(&[1.0, 0.0, 3.0]);
        let mut random = Random::new(3);
        let mut take = || -> Vec<usize> {
            random.reset();
            (0..4000).filter_map(|_| draw.next(&mut random)).collect()
        };
        let first = take();
        assert_eq!(first, take());
        let count = |position: usize| first.iter().filter(|&&i| i == position).count();
        assert_eq!(count(1), 0);
        assert!((900..1100).contains(&count(0)), "{}", count(0));
        assert_eq!(Draw::new(&[0.0]).next(&mut Random::new(1)), None);
    }
}
