//! How the control points that move become the control points that are stored.

use crate::memory;

/// A square iteration moves one control point per data point; a curve may store more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ControlLayout {
    /// Stored as they move.
    Free,
    /// The first and the last are stored `1 + per_end` times: the tied ends of Lin, Wang and Dong
    /// (2004).
    Tied {
        /// Copies added at each end.
        per_end: usize,
    },
    /// Stored from another start, with the first `degree` repeated at the end.
    Periodic {
        /// Stored position of the control point that belongs to data point 0.
        shift: usize,
        /// How many are repeated.
        degree: usize,
    },
}

impl ControlLayout {
    /// The stored array of shape (n, dimension) for the moving one of shape (m, dimension).
    #[must_use]
    pub fn expand(&self, moving: Vec<f64>, dimension: usize) -> Vec<f64> {
        let count = moving.len() / dimension;
        match *self {
            Self::Free => moving,
            Self::Tied { per_end } => {
                let mut stored = memory::with_capacity((count + 2 * per_end) * dimension);
                let (first, last) = (&moving[..dimension], &moving[(count - 1) * dimension..]);
                (0..per_end).for_each(|_| stored.extend_from_slice(first));
                stored.extend_from_slice(&moving);
                (0..per_end).for_each(|_| stored.extend_from_slice(last));
                stored
            }
            Self::Periodic { shift, degree } => {
                let mut stored = memory::with_capacity((count + degree) * dimension);
                let start = (count - shift % count) % count * dimension;
                stored.extend_from_slice(&moving[start..]);
                stored.extend_from_slice(&moving[..start]);
                stored.extend_from_within(..degree * dimension);
                stored
            }
        }
    }
}

impl ControlLayout {
    /// The moving array of the stored one: the way back of [`ControlLayout::expand`].
    #[must_use]
    pub(crate) fn collect(&self, stored: &[f64], dimension: usize) -> Vec<f64> {
        let held = stored.len() / dimension;
        let (count, first) = match *self {
            Self::Free => (held, 0),
            Self::Tied { per_end } => (held - 2 * per_end, per_end),
            Self::Periodic { shift, degree } => (held - degree, shift),
        };
        let mut moving = memory::with_capacity(count * dimension);
        for j in 0..count {
            // Only those of a closed curve run past the last.
            let place = if first + j < held { first + j } else { (first + j) % count };
            moving.extend_from_slice(&stored[place * dimension..][..dimension]);
        }
        moving
    }

    /// How many control points are stored for `moving` that move.
    #[must_use]
    pub fn stored(&self, moving: usize) -> usize {
        match *self {
            Self::Free => moving,
            Self::Tied { per_end } => moving + 2 * per_end,
            Self::Periodic { degree, .. } => moving + degree,
        }
    }

    /// The control point that moves the one stored at a place, out of `moving`.
    pub(crate) fn source(&self, place: usize, moving: usize) -> usize {
        match *self {
            Self::Free => place,
            Self::Tied { per_end } => place.saturating_sub(per_end).min(moving - 1),
            Self::Periodic { shift, .. } => (place + moving - shift % moving) % moving,
        }
    }

    /// As [`ControlLayout::expand`], into an array of shape (stored, dimension).
    pub fn expand_into(&self, moving: &[f64], dimension: usize, stored: &mut [f64]) {
        let count = moving.len() / dimension;
        for (place, point) in stored.chunks_exact_mut(dimension).enumerate() {
            let source = self.source(place, count);
            point.copy_from_slice(&moving[source * dimension..][..dimension]);
        }
    }
}

/// [`ControlLayout`]s of the two directions of a net.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NetLayout {
    /// Of the rows, direction u.
    pub u: ControlLayout,
    /// Of the columns, direction v.
    pub v: ControlLayout,
    /// Points that move in direction v.
    pub columns: usize,
}

impl NetLayout {
    /// The stored net of shape (n_u, n_v, dimension) for the moving one of shape (m_u, m_v,
    /// dimension).
    #[must_use]
    pub fn expand(&self, moving: Vec<f64>, dimension: usize) -> Vec<f64> {
        let line = self.columns * dimension;
        let tall = self.u.expand(moving, line);
        if self.v == ControlLayout::Free {
            return tall;
        }
        tall.chunks_exact(line).flat_map(|row| self.v.expand(row.to_vec(), dimension)).collect()
    }

    /// The moving net of the stored one: the way back of [`NetLayout::expand`].
    #[must_use]
    pub(crate) fn collect(&self, stored: &[f64], dimension: usize) -> Vec<f64> {
        let line = self.v.stored(self.columns) * dimension;
        let wide: Vec<f64> =
            stored.chunks_exact(line).flat_map(|row| self.v.collect(row, dimension)).collect();
        self.u.collect(&wide, self.columns * dimension)
    }

    /// As [`NetLayout::expand`], into an array of shape (n_u, n_v, dimension).
    pub fn expand_into(&self, moving: &[f64], dimension: usize, stored: &mut [f64]) {
        let line = self.columns * dimension;
        let rows = moving.len() / line;
        let stored_line = self.v.stored(self.columns) * dimension;
        for (place, row) in stored.chunks_exact_mut(stored_line).enumerate() {
            let source = self.u.source(place, rows);
            self.v.expand_into(&moving[source * line..][..line], dimension, row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tied_ends_repeat_and_periodic_ones_rotate() {
        let moving = vec![1.0, 2.0, 3.0, 4.0];
        let tied = ControlLayout::Tied { per_end: 1 };
        assert_eq!(tied.expand(moving.clone(), 1), [1.0, 1.0, 2.0, 3.0, 4.0, 4.0]);
        let periodic = ControlLayout::Periodic { shift: 1, degree: 3 };
        assert_eq!(periodic.expand(moving.clone(), 1), [4.0, 1.0, 2.0, 3.0, 4.0, 1.0, 2.0]);
        assert_eq!(ControlLayout::Free.expand(moving.clone(), 1), moving);
    }

    #[test]
    fn both_ways_to_expand_agree() {
        let layouts = [
            ControlLayout::Free,
            ControlLayout::Tied { per_end: 2 },
            ControlLayout::Periodic { shift: 1, degree: 3 },
            ControlLayout::Periodic { shift: 7, degree: 2 },
        ];
        let moving: Vec<f64> = (0..5 * 4 * 2).map(f64::from).collect();
        for u in layouts {
            let mut stored = vec![f64::NAN; u.stored(5) * 8];
            u.expand_into(&moving, 8, &mut stored);
            assert_eq!(stored, u.expand(moving.clone(), 8));
            assert_eq!(u.collect(&stored, 8), moving);
            for v in layouts {
                let net = NetLayout { u, v, columns: 4 };
                let mut stored = vec![f64::NAN; u.stored(5) * v.stored(4) * 2];
                net.expand_into(&moving, 2, &mut stored);
                assert_eq!(stored, net.expand(moving.clone(), 2));
                assert_eq!(net.collect(&stored, 2), moving);
            }
        }
    }
}
