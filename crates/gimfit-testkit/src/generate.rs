//! Deterministic generators of test data.

/// A small generator of random numbers (xorshift64*), so that tests repeat exactly.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// Starts from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in [-1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// A normal deviate (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.unit()).cos()
    }
}

/// A random walk of `count` points, each step uneven; no two neighbours coincide.
#[must_use]
pub fn random_walk(seed: u64, count: usize, dimension: usize) -> Vec<Vec<f64>> {
    let mut random = Random::new(seed);
    let mut point = vec![0.0; dimension];
    (0..count)
        .map(|_| {
            let stride = 0.1 + random.unit() * 2.0;
            point.iter_mut().for_each(|x| *x += stride * random.signed());
            point[0] += 0.05;
            point.clone()
        })
        .collect()
}

/// A noisy helix with jittered steps, flat rows of three coordinates: smooth data of any length.
#[must_use]
pub fn helix(count: usize) -> Vec<f64> {
    let mut random = Random::new(7);
    let turns = (count as f64 / 200.0).max(2.0);
    let step = std::f64::consts::TAU * turns / count as f64;
    (0..count)
        .flat_map(|i| {
            let a = step * (i as f64 + 0.3 * (random.unit() - 0.5));
            let radius = 1.0 + 0.2 * (0.37 * a).cos();
            let noise = 0.02 * step;
            [
                radius * a.cos() + noise * random.signed(),
                radius * a.sin() + noise * random.signed(),
                0.05 * a + noise * random.signed(),
            ]
        })
        .collect()
}

/// Points whose steps grow by `ratio` each: the hardest spacing for plain iterations.
#[must_use]
pub fn graded(count: usize, ratio: f64) -> Vec<Vec<f64>> {
    let mut x = 0.0;
    let mut step = 1.0;
    (0..count)
        .map(|i| {
            let point = vec![x, step * if i % 2 == 0 { 0.3 } else { -0.3 }];
            x += step;
            step *= ratio;
            point
        })
        .collect()
}
