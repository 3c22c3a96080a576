//! The cells between the points of a grid: bilinear patches, and how far surfaces stray from them.

use crate::fit::approximate::polyline::{Polyline, akima_slopes};

/// The data as a grid of bilinear patches.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells<'a> {
    /// Rows and columns of points.
    pub(super) shape: [usize; 2],
    pub(super) dimension: usize,
    pub(super) closed: [bool; 2],
    /// Row by row.
    pub(super) data: &'a [f64],
    /// Whether distances are differences at the same place, as those of heights are.
    pub(super) in_place: bool,
}

/// A place in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) cell: [usize; 2],
    /// Shares of the sides in u and in v.
    pub(super) share: [f64; 2],
}

impl Cells<'_> {
    /// Rows and columns of cells.
    pub(super) fn count(&self) -> [usize; 2] {
        [0, 1].map(|k| if self.closed[k] { self.shape[k] } else { self.shape[k].saturating_sub(1) })
    }

    /// Positions of the corners of a cell: here, next in v, next in u, opposite.
    pub(super) fn corners(&self, [i, j]: [usize; 2]) -> [usize; 4] {
        let [rows, columns] = self.shape;
        let (below, right) = ((i + 1) % rows, (j + 1) % columns);
        [i * columns + j, i * columns + right, below * columns + j, below * columns + right]
    }

    /// Places all over the grid, as cells with shares of their sides: `samples` along each side, the
    /// last row and column of places included where the grid is open.
    pub(super) fn places(&self, samples: usize) -> impl Iterator<Item = Place> + use<> {
        let [in_u, in_v] = self.lines_of_places(samples);
        in_u.into_iter().flat_map(move |(i, s)| {
            in_v.clone().into_iter().map(move |(j, t)| Place { cell: [i, j], share: [s, t] })
        })
    }

    /// The rows and the columns of [`Cells::places`]: a row or column of cells, and the share of its
    /// height or width.
    pub(super) fn lines_of_places(&self, samples: usize) -> [Vec<(usize, f64)>; 2] {
        [0, 1].map(|k| {
            let count = self.count()[k];
            let mut lines: Vec<(usize, f64)> = (0..count * samples)
                .map(|site| (site / samples, (site % samples) as f64 / samples as f64))
                .collect();
            if !self.closed[k] && count > 0 {
                lines.push((count - 1, 1.0));
            }
            lines
        })
    }

    /// Writes the point of a cell at shares of its sides.
    pub(super) fn blend(&self, cell: [usize; 2], [s, t]: [f64; 2], point: &mut [f64]) {
        let d = self.dimension;
        let weights = [(1.0 - s) * (1.0 - t), (1.0 - s) * t, s * (1.0 - t), s * t];
        point.fill(0.0);
        for (corner, weight) in self.corners(cell).into_iter().zip(weights) {
            let corner = &self.data[corner * d..][..d];
            point.iter_mut().zip(corner).for_each(|(x, q)| *x += weight * q);
        }
    }

    /// Distance of a point from a cell, sought from shares of its sides; `nearest` receives the point
    /// of the cell.
    pub(super) fn distance(
        &self,
        cell: [usize; 2],
        share: [f64; 2],
        point: &[f64],
        nearest: &mut [f64],
    ) -> f64 {
        let square = |from: &[f64], to: &[f64]| -> f64 {
            from.iter().zip(to).map(|(x, y)| (x - y) * (x - y)).sum()
        };
        self.blend(cell, share, nearest);
        let mut least = square(point, nearest);
        if self.in_place {
            return least.sqrt();
        }
        let d = self.dimension;
        let corners = self.corners(cell).map(|corner| &self.data[corner * d..][..d]);
        let [mut s, mut t] = share;
        // Whole Gauss-Newton steps while they help; in between, and at the sides, steps along one side
        // and then the other, which are exact.
        for kind in [2, 0, 1, 2, 0, 1] {
            let (mut g, mut h, mut a, mut b, mut c) = (0.0, 0.0, 0.0, 0.0, 0.0);
            for i in 0..d {
                let [q00, q01, q10, q11] = corners.map(|q| q[i]);
                let left = q00 + s * (q10 - q00);
                let right = q01 + s * (q11 - q01);
                let in_u = (1.0 - t) * (q10 - q00) + t * (q11 - q01);
                let in_v = right - left;
                let gap = point[i] - (left + t * in_v);
                g += gap * in_u;
                h += gap * in_v;
                a += in_u * in_u;
                b += in_u * in_v;
                c += in_v * in_v;
            }
            let determinant = a * c - b * b;
            let step = match kind {
                0 if a > 0.0 => [g / a, 0.0],
                1 if c > 0.0 => [0.0, h / c],
                2 if determinant > 1e-10 * a * c => {
                    [(c * g - b * h) / determinant, (a * h - b * g) / determinant]
                }
                _ => continue,
            };
            let next = [(s + step[0]).clamp(0.0, 1.0), (t + step[1]).clamp(0.0, 1.0)];
            if !(next[0].is_finite() && next[1].is_finite()) || next == [s, t] {
                continue;
            }
            self.blend(cell, next, nearest);
            let there = square(point, nearest);
            if there < least {
                ([s, t], least) = (next, there);
            }
        }
        self.blend(cell, [s, t], nearest);
        least.sqrt()
    }

    /// As [`Cells::distance`], of the cell or a neighbour of it.
    pub(super) fn distance_nearby(
        &self,
        [i, j]: [usize; 2],
        share: [f64; 2],
        point: &[f64],
        nearest: &mut [f64],
    ) -> f64 {
        let mut least = self.distance([i, j], share, point, nearest);
        if self.in_place {
            return least;
        }
        let mut other = vec![0.0; self.dimension];
        let count = self.count();
        let near = |k: usize, at: usize, offset: usize| -> Option<usize> {
            if self.closed[k] {
                return Some((at + count[k] + offset - 1) % count[k]);
            }
            (at + offset).checked_sub(1).filter(|&line| line < count[k])
        };
        for a in 0..3 {
            for b in 0..3 {
                let (Some(row), Some(column)) = (near(0, i, a), near(1, j, b)) else { continue };
                let distance = self.distance([row, column], [0.5, 0.5], point, &mut other);
                if distance < least {
                    least = distance;
                    nearest.copy_from_slice(&other);
                }
            }
        }
        least
    }

    /// How far a local C1 interpolant of the grid strays from the cells, in the middle of sides and
    /// of cells: cubic Hermite in both directions, with modified Akima slopes (Akima 1970) over the
    /// parameters of the lines. What the data themselves explain is no wiggle.
    pub(super) fn natural(&self, lines: [&[f64]; 2]) -> f64 {
        let (d, [rows, columns]) = (self.dimension, self.shape);
        let steps = [0, 1].map(|k| {
            let count = self.count()[k];
            let line = lines[k];
            (0..count)
                .map(|j| line.get(j + 1).map_or(line[0] + 1.0, |next| *next) - line[j])
                .collect::<Vec<f64>>()
        });
        let middles = |data: &[f64], dimension: usize, k: usize| -> Vec<f64> {
            let polyline = Polyline { data, dimension, closed: self.closed[k], over: None };
            if polyline.points() < 3 {
                let legs = polyline.legs();
                return (0..legs)
                    .flat_map(|leg| {
                        let (a, b) = (polyline.point(leg), polyline.point(leg + 1));
                        a.iter().zip(b).map(|(x, y)| 0.5 * (x + y)).collect::<Vec<f64>>()
                    })
                    .collect();
            }
            let slopes = akima_slopes(&polyline, &steps[k]);
            let points = polyline.points();
            (0..polyline.legs())
                .flat_map(|leg| {
                    let (a, b) = (polyline.point(leg), polyline.point(leg + 1));
                    let from = &slopes[leg * dimension..][..dimension];
                    let to = &slopes[(leg + 1) % points * dimension..][..dimension];
                    let eighth = 0.125 * steps[k][leg];
                    (0..dimension)
                        .map(|i| 0.5 * (a[i] + b[i]) + eighth * (from[i] - to[i]))
                        .collect::<Vec<f64>>()
                })
                .collect()
        };
        let in_v: Vec<f64> =
            self.data.chunks_exact(columns * d).flat_map(|row| middles(row, d, 1)).collect();
        let in_u = middles(self.data, columns * d, 0);
        let wide = self.count()[1] * d;
        let in_both = if wide > 0 { middles(&in_v, wide, 0) } else { Vec::new() };
        let mut worst: f64 = 0.0;
        let mut nearest = vec![0.0; d];
        let [cells_u, cells_v] = self.count();
        let mut look = |points: &[f64], line: usize, share: [f64; 2]| {
            for (k, point) in points.chunks_exact(d).enumerate() {
                let cell = [(k / line).min(cells_u - 1), (k % line).min(cells_v - 1)];
                // The last row and column of points belong to the cells before them.
                let share = [
                    if k / line >= cells_u { 1.0 } else { share[0] },
                    if k % line >= cells_v { 1.0 } else { share[1] },
                ];
                worst = worst.max(self.distance(cell, share, point, &mut nearest));
            }
        };
        if rows > 1 && columns > 1 {
            look(&in_v, cells_v, [0.0, 0.5]);
            look(&in_u, columns, [0.5, 0.0]);
            look(&in_both, cells_v, [0.5, 0.5]);
        }
        worst
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_grids_have_no_natural_overshoot_and_a_sphere_its_sagitta() {
        let flat: Vec<f64> = (0..5)
            .flat_map(|i| (0..6).flat_map(move |j| [f64::from(i), f64::from(j), 2.0]))
            .collect();
        let lines =
            [0, 1].map(|k| (0..5 + k).map(|i| i as f64 / (4 + k) as f64).collect::<Vec<_>>());
        let cells =
            Cells { shape: [5, 6], dimension: 3, closed: [false; 2], data: &flat, in_place: false };
        assert!(cells.natural([&lines[0], &lines[1]]) < 1e-14);
        // A cylinder: the sagitta of its polygon.
        let round: Vec<f64> = (0..5)
            .flat_map(|i| {
                (0..16).flat_map(move |j| {
                    let angle = f64::from(j) * std::f64::consts::TAU / 16.0;
                    [angle.cos(), angle.sin(), f64::from(i)]
                })
            })
            .collect();
        let around: Vec<f64> = (0..16).map(|j| f64::from(j) / 16.0).collect();
        let cells = Cells {
            shape: [5, 16],
            dimension: 3,
            closed: [false, true],
            data: &round,
            in_place: false,
        };
        let sagitta = 1.0 - (std::f64::consts::PI / 16.0).cos();
        let strayed = cells.natural([&lines[0], &around]);
        assert!((strayed / sagitta - 1.0).abs() < 0.2, "{strayed} {sagitta}");
    }
}
