//! Preconditioned PIA on a grid: `P <- P + M_u^-1 R M_v^-T`, the rule of
//! [`Preconditioned`](super::Preconditioned) for the columns, then for the rows.
//!
//! The columns are met in blocks that stay in the cache while they are swept forward and backward,
//! the rows in groups side by side, so that no chain of dependent operations stands in the way.
//! Blocks and groups are shared out among threads; each number is computed the same way by any.

use super::{Step, UpdateRule};
use crate::Error;
use crate::collocation::{CollocationMatrix, Factorization};
use crate::{memory, threads};

/// Numbers of a block of columns: half a megabyte.
const BLOCK: usize = 1 << 16;
/// Numbers side by side in a block, at least: a line of the cache.
const NARROWEST: usize = 8;
/// Rows of the grid that are swept side by side.
const GROUP: usize = 8;

/// Preconditioned PIA in both directions at once.
#[derive(Debug, Clone)]
pub struct NetPreconditioned {
    u: Factorization,
    v: Factorization,
    /// A block of columns for each thread.
    blocks: Vec<f64>,
    /// A group of rows for each thread.
    groups: Vec<f64>,
}

impl NetPreconditioned {
    /// Factors the whole bands of both directions, or those within a half bandwidth.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub fn new(
        u: &dyn CollocationMatrix,
        v: &dyn CollocationMatrix,
        half_bandwidth: Option<usize>,
    ) -> Result<Self, Error> {
        let (u, v) = (u.factor(half_bandwidth)?, v.factor(half_bandwidth)?);
        Ok(Self { u, v, blocks: Vec::new(), groups: Vec::new() })
    }

    /// Solves for the columns, a block for each thread at a time: taken out, swept, put back.
    fn columns(&mut self, vectors: &mut [f64], line: usize, bands: usize) {
        let Self { u, blocks, .. } = self;
        let rows = u.size();
        let widest = (BLOCK / rows / NARROWEST * NARROWEST).max(NARROWEST);
        let share = line.div_ceil(bands).next_multiple_of(NARROWEST);
        let width = widest.min(share).min(line);
        blocks.resize(bands * rows * width, 0.0);
        for start in (0..line).step_by(bands * width) {
            let given: &[f64] = vectors;
            let own = |block: usize| width.min(line.saturating_sub(start + block * width));
            threads::for_each_band(bands, blocks, rows * width, &mut [], |block, place, _| {
                let own = own(block);
                if own == 0 {
                    return;
                }
                let place = &mut place[..rows * own];
                let from = start + block * width;
                for (to, row) in place.chunks_exact_mut(own).zip(given.chunks_exact(line)) {
                    to.copy_from_slice(&row[from..from + own]);
                }
                u.solve_in_place(place, own);
            });
            let solved: &[f64] = blocks;
            threads::for_each_band(bands, vectors, line, &mut [], |first, vectors, _| {
                for (k, row) in vectors.chunks_exact_mut(line).enumerate() {
                    for block in 0..bands {
                        let (own, from) = (own(block), start + block * width);
                        if own > 0 {
                            let at = block * rows * width + (first + k) * own;
                            row[from..from + own].copy_from_slice(&solved[at..at + own]);
                        }
                    }
                }
            });
        }
    }

    /// Solves for the rows, in groups side by side.
    fn rows(&mut self, vectors: &mut [f64], line: usize, dimension: usize, bands: usize) {
        let Self { v, groups, .. } = self;
        let group = GROUP.min(vectors.len() / line);
        if groups.len() != bands * group * line {
            *groups = memory::zeros(bands * group * line);
        }
        threads::for_each_band(bands, vectors, group * line, groups, |_, vectors, side| {
            for rows in vectors.chunks_mut(group * line) {
                let count = rows.len() / line;
                let side = &mut side[..rows.len()];
                match dimension {
                    1 => swept::<1>(v, rows, side, line, count),
                    2 => swept::<2>(v, rows, side, line, count),
                    3 => swept::<3>(v, rows, side, line, count),
                    _ => swept_wide(v, rows, side, line, count, dimension),
                }
            }
        });
    }
}

/// Solves for a group of rows of points of dimension `D`, side by side.
fn swept<const D: usize>(
    v: &Factorization,
    rows: &mut [f64],
    side: &mut [f64],
    line: usize,
    count: usize,
) {
    for (r, row) in rows.chunks_exact(line).enumerate() {
        let (points, _) = row.as_chunks::<D>();
        for (point, place) in points.iter().zip(side.chunks_exact_mut(count * D)) {
            place[r * D..][..D].copy_from_slice(point);
        }
    }
    v.solve_in_place(side, count * D);
    for (r, row) in rows.chunks_exact_mut(line).enumerate() {
        let (points, _) = row.as_chunks_mut::<D>();
        for (point, place) in points.iter_mut().zip(side.chunks_exact(count * D)) {
            point.copy_from_slice(&place[r * D..][..D]);
        }
    }
}

/// As [`swept`] for any dimension.
fn swept_wide(
    v: &Factorization,
    rows: &mut [f64],
    side: &mut [f64],
    line: usize,
    count: usize,
    dimension: usize,
) {
    let wide = count * dimension;
    for (r, row) in rows.chunks_exact(line).enumerate() {
        for (point, place) in row.chunks_exact(dimension).zip(side.chunks_exact_mut(wide)) {
            place[r * dimension..][..dimension].copy_from_slice(point);
        }
    }
    v.solve_in_place(side, wide);
    for (r, row) in rows.chunks_exact_mut(line).enumerate() {
        for (point, place) in row.chunks_exact_mut(dimension).zip(side.chunks_exact(wide)) {
            point.copy_from_slice(&place[r * dimension..][..dimension]);
        }
    }
}

impl UpdateRule for NetPreconditioned {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let line = self.v.size() * step.dimension;
        let bands = threads::bands(vectors.len());
        self.columns(vectors, line, bands);
        self.rows(vectors, line, step.dimension, bands);
    }
}
