//! Guards: places between the data where the surface has strayed, and is given weight to return.

use super::attempt::Attempt;
use super::cells::Place;
use super::problem::Problem;
use crate::collocation::NetRows;
use crate::knots::KnotVector;
use crate::projection::MovingSurface;

/// A place between the data where the surface is watched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Guard {
    pub(super) cell: [usize; 2],
    /// Where between the lines of the cell.
    pub(super) share: [f64; 2],
    pub(super) weight: f64,
    /// How far the surface strays there, over what is allowed.
    pub(super) ratio: f64,
}

/// Places looked at along a side of a cell.
const SITES: usize = 4;
/// The same in a cell in which the surface has strayed.
const CLOSE_SITES: usize = 8;

impl Attempt {
    /// Looks closely at all cells, and sets guards where the surface strays.
    pub(super) fn look_between(
        &mut self,
        problem: &Problem<'_>,
        knots: [&KnotVector; 2],
        net: &[f64],
        surface: &mut MovingSurface<'_>,
    ) {
        let cells = &problem.cells;
        let d = problem.dimension();
        let limit = problem.allowance;
        let mut found: Vec<(Guard, Vec<f64>)> = Vec::new();
        let mut nearest = vec![0.0; d];
        let mut look = |cell: [usize; 2], share: [f64; 2], point: &[f64]| {
            let strayed = cells.distance(cell, share, point, &mut nearest);
            if strayed <= limit {
                return;
            }
            let strayed = cells.distance_nearby(cell, share, point, &mut nearest);
            if strayed <= limit {
                return;
            }
            let guard = Guard { cell, share, weight: 0.0, ratio: strayed / limit };
            match found.last_mut() {
                Some((last, target)) if last.cell == cell => {
                    if last.ratio < guard.ratio {
                        *last = guard;
                        target.copy_from_slice(&nearest);
                    }
                }
                _ => found.push((guard, nearest.clone())),
            }
        };
        if problem.kept {
            self.visit_lattice(problem, knots, net, &mut look);
        } else {
            let mut point = vec![0.0; d];
            for Place { cell, share } in cells.places(SITES) {
                surface.point(self.place(problem, cell, share), &mut point);
                look(cell, share, &point);
            }
            // Where it has strayed before, more closely.
            let mut cells: Vec<[usize; 2]> = self.guards.iter().map(|guard| guard.cell).collect();
            cells.sort_unstable();
            cells.dedup();
            for cell in cells {
                for site in 0..CLOSE_SITES * CLOSE_SITES {
                    let share = [site / CLOSE_SITES, site % CLOSE_SITES]
                        .map(|at| (at as f64 + 0.5) / CLOSE_SITES as f64);
                    surface.point(self.place(problem, cell, share), &mut point);
                    look(cell, share, &point);
                }
            }
        }
        for (guard, target) in found {
            self.worst = self.worst.max(guard.ratio);
            let known = |old: &Guard| old.cell == guard.cell && old.share == guard.share;
            if !self.guards.iter().any(known) {
                self.guards.push(guard);
                self.guard_targets.extend(target);
            }
        }
    }

    /// Visits cell, shares of its sides and point of the surface, for places between the lines whose
    /// parameters stay.
    fn visit_lattice(
        &self,
        problem: &Problem<'_>,
        knots: [&KnotVector; 2],
        net: &[f64],
        mut visit: impl FnMut([usize; 2], [f64; 2], &[f64]),
    ) {
        let cells = &problem.cells;
        let inside = MovingSurface::new(knots, &[], problem.dimension());
        let places = cells.lines_of_places(SITES);
        let lines = [0, 1].map(|k| -> Vec<f64> {
            let at = |&(cell, share): &(usize, f64)| {
                let (mut cells, mut shares) = ([0, 0], [0.0, 0.0]);
                (cells[k], shares[k]) = (cell, share);
                inside.inside(self.place(problem, cells, shares))[k]
            };
            places[k].iter().map(at).collect()
        });
        let rows = NetRows::of_lines([&lines[0], &lines[1]], knots);
        let line = lines[1].len().max(1);
        rows.visit(net, problem.dimension(), |k, point| {
            let [(i, s), (j, t)] = [places[0][k / line], places[1][k % line]];
            visit([i, j], [s, t], point);
        });
    }
}
