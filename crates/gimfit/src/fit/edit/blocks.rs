//! The points of a curve that is edited, in blocks, so that an edit moves no more than a block.

use std::ops::Range;

/// Rows of numbers: of each data point its parameter, the row sum of the inverse that goes with it,
/// its coordinates and those of its control point.
#[derive(Debug, Clone)]
pub(super) struct Blocks {
    dimension: usize,
    blocks: Vec<Vec<f64>>,
    /// Points in each block, side by side so that a position is found quickly.
    sizes: Vec<u32>,
    /// Largest row sum of each block.
    tops: Vec<f64>,
    len: usize,
}

/// Points in a block of a new curve.
const USUAL: usize = 512;
/// A block of this many is split.
const MOST: usize = 2 * USUAL;
/// A block of fewer looks for a neighbour to join.
const FEW: usize = USUAL / 4;

/// Where a row holds its row sum.
pub(super) const ROW_SUM: usize = 1;

impl Blocks {
    /// Takes all rows of a curve.
    pub(super) fn new(dimension: usize, rows: &[f64]) -> Self {
        let stride = 2 * dimension + 2;
        let blocks: Vec<Vec<f64>> = rows.chunks(USUAL * stride).map(<[f64]>::to_vec).collect();
        let mut all = Self {
            dimension,
            sizes: blocks.iter().map(|block| (block.len() / stride) as u32).collect(),
            tops: vec![0.0; blocks.len()],
            blocks,
            len: rows.len() / stride,
        };
        (0..all.blocks.len()).for_each(|b| all.measure(b));
        all
    }

    /// Numbers in a row.
    pub(super) fn stride(&self) -> usize {
        2 * self.dimension + 2
    }

    pub(super) fn dimension(&self) -> usize {
        self.dimension
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Largest row sum of all.
    pub(super) fn largest_row_sum(&self) -> f64 {
        self.tops.iter().fold(0.0, |most, &top| f64::max(most, top))
    }

    /// The block of a row, and its place there; the last block takes a row past the end.
    fn find(&self, index: usize) -> (usize, usize) {
        let mut before = 0;
        for (b, &size) in self.sizes.iter().enumerate() {
            if index < before + size as usize {
                return (b, index - before);
            }
            before += size as usize;
        }
        let last = self.sizes.len() - 1;
        (last, index + self.sizes[last] as usize - before)
    }

    pub(super) fn row(&self, index: usize) -> &[f64] {
        let (b, at) = self.find(index);
        &self.blocks[b][at * self.stride()..][..self.stride()]
    }

    /// Rows one after another.
    pub(super) fn rows(&self, range: Range<usize>) -> impl Iterator<Item = &[f64]> {
        let (b, at) = self.find(range.start);
        let stride = self.stride();
        let first = self.blocks[b][at * stride..].chunks_exact(stride);
        let rest = self.blocks[b + 1..].iter().flat_map(move |block| block.chunks_exact(stride));
        first.chain(rest).take(range.len())
    }

    /// Position of the last point whose parameter does not exceed `t`; 0 if there is none.
    pub(super) fn at_parameter(&self, t: f64) -> usize {
        let stride = self.stride();
        let b = self.blocks.partition_point(|block| block[0] <= t).saturating_sub(1);
        let before: usize = self.sizes[..b].iter().map(|&size| size as usize).sum();
        let (mut low, mut high) = (0, self.sizes[b] as usize);
        while low < high {
            let middle = usize::midpoint(low, high);
            if self.blocks[b][middle * stride] <= t {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        before + low.saturating_sub(1)
    }

    /// Writes rows over those from `index` on.
    pub(super) fn write(&mut self, index: usize, rows: &[f64]) {
        let stride = self.stride();
        let (mut b, mut at) = self.find(index);
        let mut rest = rows;
        while !rest.is_empty() {
            let block = &mut self.blocks[b][at * stride..];
            let (now, later) = rest.split_at(rest.len().min(block.len()));
            block[..now.len()].copy_from_slice(now);
            self.measure(b);
            (b, at, rest) = (b + 1, 0, later);
        }
    }

    pub(super) fn insert(&mut self, index: usize, row: &[f64]) {
        let stride = self.stride();
        let (b, at) = self.find(index);
        let at = at * stride;
        self.blocks[b].splice(at..at, row.iter().copied());
        self.len += 1;
        self.count(b);
        if self.sizes[b] as usize >= MOST {
            let half = self.blocks[b].len() / stride / 2 * stride;
            let tail = self.blocks[b].split_off(half);
            self.blocks.insert(b + 1, tail);
            self.sizes.insert(b + 1, 0);
            self.tops.insert(b + 1, 0.0);
            self.count(b + 1);
            self.count(b);
        }
    }

    pub(super) fn remove(&mut self, index: usize) {
        let stride = self.stride();
        let (b, at) = self.find(index);
        self.blocks[b].drain(at * stride..(at + 1) * stride);
        self.len -= 1;
        self.count(b);
        let b = b.min(self.blocks.len().saturating_sub(2));
        if self.blocks.len() > 1
            && self.sizes[b].min(self.sizes[b + 1]) < FEW as u32
            && self.sizes[b] + self.sizes[b + 1] < MOST as u32
        {
            let tail = self.blocks.remove(b + 1);
            self.sizes.remove(b + 1);
            self.tops.remove(b + 1);
            self.blocks[b].extend(tail);
            self.count(b);
        }
    }

    fn count(&mut self, b: usize) {
        self.sizes[b] = (self.blocks[b].len() / self.stride()) as u32;
        self.measure(b);
    }

    fn measure(&mut self, b: usize) {
        let rows = self.blocks[b].chunks_exact(self.stride());
        self.tops[b] = rows.fold(0.0, |most, row| f64::max(most, row[ROW_SUM]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of four numbers that all tell the parameter.
    fn row(t: f64) -> [f64; 4] {
        [t, t, 0.0, 0.0]
    }

    #[test]
    fn blocks_hold_what_a_plain_list_does() {
        let mut plain: Vec<f64> = (0..3000).map(f64::from).collect();
        let all: Vec<f64> = plain.iter().flat_map(|&t| row(t)).collect();
        let mut blocks = Blocks::new(1, &all);
        let mut seed = 1_u64;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            (seed >> 33) as usize % below
        };
        for step in 0..9000 {
            // Grows first, in one place and then everywhere, then shrinks to a few rows.
            if step < 3000 && random(4) > 0 {
                let at = if step < 1500 { 700 + random(30) } else { random(plain.len() + 1) };
                plain.insert(at, f64::from(step));
                blocks.insert(at, &row(f64::from(step)));
            } else if plain.len() > 3 {
                let at = random(plain.len());
                plain.remove(at);
                blocks.remove(at);
            }
            if step % 400 == 0 {
                let held: Vec<f64> = blocks.rows(0..blocks.len()).map(|row| row[0]).collect();
                assert_eq!(held, plain);
                assert!(blocks.sizes.iter().all(|&size| 0 < size && size < MOST as u32));
                let at = random(plain.len());
                assert_eq!(blocks.row(at)[0], plain[at]);
                let largest = plain.iter().fold(0.0, |most: f64, &t| most.max(t));
                assert_eq!(blocks.largest_row_sum(), largest);
            }
        }
        assert_eq!((blocks.len(), blocks.blocks.len()), (3, 1));
    }

    #[test]
    fn a_parameter_finds_the_point_before_it() {
        let all: Vec<f64> = (0..2000).flat_map(|t| row(f64::from(t))).collect();
        let mut blocks = Blocks::new(1, &all);
        for (t, index) in [(-1.0, 0), (0.0, 0), (511.5, 511), (512.0, 512), (1999.0, 1999)] {
            assert_eq!(blocks.at_parameter(t), index);
        }
        let over: Vec<f64> = (500..600).flat_map(|t| row(f64::from(t) + 0.25)).collect();
        blocks.write(500, &over);
        assert_eq!(blocks.at_parameter(540.2), 539);
        assert_eq!(blocks.row(599)[0], 599.25);
    }
}
