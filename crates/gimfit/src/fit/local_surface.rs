//! Local PIA on grids: the chosen points, the matrix of their control points, and what becomes of the
//! others.
//!
//! Where the chosen points are all crossings of some rows R with some columns C, as those of a window
//! are, their matrix is `(A_u)_RR (x) (A_v)_CC`, two bands again. Otherwise it is met row by row.

use super::method::{ChosenRule, anderson, choose_adaptive, weighted};
use super::net::{Setting, Stages, one_weight, run_net, tensor};
use super::solve::{Solved, Task, solve};
use super::surface_method::{Directions, JACOBI_DIVERGES, smallest_rational_eigenvalue};
use super::{IterationWeight, Method, SurfaceOptions, SurfaceWeight};
use crate::Error;
use crate::collocation::{
    BandedCollocation, ChosenCollocation, CollocationOperator, HeldCollocation, LocalCollocation,
    NetWeights, largest_jacobi_eigenvalue, smallest_eigenvalue_of,
};
use crate::iteration::update::{AdaptiveRows, Chebyshev, GaussSeidel, Jacobi, Pia, Staged};
use crate::iteration::{Observer, UpdateRule};
use crate::points::GridView;
use crate::report::LocalReport;
use std::ops::Range;

/// Chosen points of a grid.
pub(super) struct ChosenNet {
    /// Rows and columns that hold one.
    lines: [Vec<usize>; 2],
    /// Their positions, row by row.
    points: Vec<usize>,
    /// The matrices of these rows and columns.
    u: BandedCollocation,
    v: BandedCollocation,
    rational: Option<NetWeights>,
    /// The matrix of the points, unless they are all crossings.
    scattered: Option<ChosenCollocation>,
}

impl ChosenNet {
    /// What the options choose of a grid of the shape `given`, of which `shape` is fitted.
    pub(super) fn of(
        options: &SurfaceOptions,
        given: [usize; 2],
        shape: [usize; 2],
        [u, v]: [&BandedCollocation; 2],
        rational: Option<&NetWeights>,
    ) -> Result<Option<Self>, Error> {
        let refused = |with, why| Err(Error::Incompatible { what: "local PIA", with, why });
        let Some(windows) = &options.local else {
            if options.method == Method::Local {
                return refused(
                    "no choice of points",
                    "name windows of the points whose control points are to move",
                );
            }
            return Ok(None);
        };
        if matches!(options.method, Method::Geometric { .. }) {
            return refused(
                "geometric interpolation",
                "foot points move on the whole surface; use another method",
            );
        }
        let chosen = mask(windows, given, shape)?;
        let line = shape[1];
        let rows = (0..shape[0]).filter(|i| chosen[i * line..][..line].contains(&true));
        let columns = (0..line).filter(|j| (0..shape[0]).any(|i| chosen[i * line + j]));
        let lines: [Vec<usize>; 2] = [rows.collect(), columns.collect()];
        let points: Vec<usize> = (0..chosen.len()).filter(|&k| chosen[k]).collect();
        if points.is_empty() {
            return refused("an empty choice of points", "name at least one point");
        }
        let crossings = lines[0].len() * lines[1].len();
        let scattered =
            (crossings != points.len()).then(|| ChosenCollocation::new(u, v, rational, &points));
        if scattered.is_some() && options.per_direction {
            return refused(
                "one direction after the other",
                "the chosen points are not all crossings of some rows with some columns; choose one \
                 window, or run both directions at once",
            );
        }
        let crossed: Vec<usize> =
            lines[0].iter().flat_map(|i| lines[1].iter().map(move |j| i * line + j)).collect();
        Ok(Some(Self {
            u: u.restricted(&lines[0]),
            v: v.restricted(&lines[1]),
            rational: rational.map(|net| net.at(&crossed)),
            lines,
            points,
            scattered,
        }))
    }

    /// Runs the rule among the chosen points. `whole` is the setting of all points, and so are the
    /// control points and difference vectors returned.
    pub(super) fn run(
        &self,
        whole: &Setting<'_>,
        observer: &mut dyn Observer,
    ) -> Result<(Solved, Option<Stages>), Error> {
        let dimension = whole.view.dimension();
        let data = whole.view.points().coordinates();
        let operator = tensor(whole.directions, dimension);
        let gather = |from: &[f64]| -> Vec<f64> {
            self.points.iter().flat_map(|&k| &from[k * dimension..][..dimension]).copied().collect()
        };
        // All control points at the data, but for these.
        let put = |moved: &[f64]| {
            let mut all = data.to_vec();
            for (&k, point) in self.points.iter().zip(moved.chunks_exact(dimension)) {
                all[k * dimension..][..dimension].copy_from_slice(point);
            }
            all
        };
        let mut vectors = vec![0.0; data.len()];
        let held = put(&vec![0.0; self.points.len() * dimension]);
        operator.difference_vectors(data, &held, dimension, &mut vectors);
        let (target, start) = (gather(&vectors), gather(data));

        let expand = |control: Vec<f64>| (whole.expand)(put(&control));
        let options = SurfaceOptions {
            method: if whole.options.method == Method::Local {
                Method::Pia
            } else {
                whole.options.method
            },
            weight: self.weight(&whole.options.weight, whole.view.shape())?,
            ..whole.options.clone()
        };
        let shape = match self.scattered {
            None => self.lines.each_ref().map(Vec::len),
            Some(_) => [1, self.points.len()],
        };
        let part = Setting {
            view: GridView::new(shape, dimension, &start)?,
            directions: self.directions(),
            options: &options,
            expand: &expand,
            target: Some(&target),
            size: whole.size,
            stopping: whole.stopping,
        };
        let (mut solved, stages) = match &self.scattered {
            None => run_net(&part, observer)?,
            Some(matrix) => (self.run_scattered(matrix, &part, &target, observer)?, None),
        };
        solved.control = put(&solved.control);
        solved.norms.max_index = self.points[solved.norms.max_index];
        let seen = LocalCollocation::new(&*operator, &self.points);
        let outside = seen.outside(data, &solved.control, dimension, &mut vectors);
        solved.vectors = vectors;
        let run = &mut solved.run;
        run.local = Some(LocalReport {
            chosen: self.points.clone(),
            outside_max_residual: whole.size.scale.undo(outside.max),
            outside_max_residual_index: outside.max_index,
        });
        if whole.options.method == Method::Local {
            run.method = "local";
        }
        run.choices.push(self.choice(whole.view.points().len()));
        Ok((solved, stages))
    }

    fn directions(&self) -> Directions<'_> {
        Directions { u: &self.u, v: &self.v, rational: self.rational.as_ref() }
    }

    /// The weights of the chosen points, or of their rows and columns.
    fn weight(&self, weight: &SurfaceWeight, shape: [usize; 2]) -> Result<SurfaceWeight, Error> {
        let gather = |weight: &IterationWeight, chosen: &[usize], count, why| match weight {
            IterationWeight::PerPoint(all) if all.len() == count => {
                Ok(IterationWeight::PerPoint(chosen.iter().map(|&k| all[k]).collect()))
            }
            IterationWeight::PerPoint(all) => Err(Error::WrongCount {
                what: "iteration weights",
                given: all.len(),
                expected: count,
                why,
            }),
            other => Ok(other.clone()),
        };
        Ok(match weight {
            SurfaceWeight::Both(both) => SurfaceWeight::Both(gather(
                both,
                &self.points,
                shape[0] * shape[1],
                "one per data point",
            )?),
            SurfaceWeight::PerDirection([u, v]) => SurfaceWeight::PerDirection([
                gather(u, &self.lines[0], shape[0], "one per row of points")?,
                gather(v, &self.lines[1], shape[1], "one per column of points")?,
            ]),
        })
    }

    /// The sentence for the report.
    fn choice(&self, count: usize) -> String {
        let matrix = if self.scattered.is_some() {
            "not all crossings of some rows with some columns, on a matrix of their own, row by row"
                .into()
        } else {
            let [rows, columns] = self.lines.each_ref().map(Vec::len);
            format!("all crossings of {rows} rows with {columns} columns, on the bands of these")
        };
        format!(
            "points: {} of {count} iterate, {matrix}; the others keep their control points, and \
             their residuals count for nothing",
            self.points.len()
        )
    }

    /// Runs a rule on a matrix without a band.
    fn run_scattered(
        &self,
        matrix: &ChosenCollocation,
        part: &Setting<'_>,
        target: &[f64],
        observer: &mut dyn Observer,
    ) -> Result<Solved, Error> {
        let mut chosen = self.choose_scattered(matrix, part)?;
        let operator = HeldCollocation::new(Box::new(matrix.clone()), target);
        let task = Task {
            operator: &operator,
            data: part.view.points().coordinates(),
            dimension: part.view.dimension(),
            size: part.size,
            stopping: part.stopping,
            keep: &part.options.keep,
            expand: part.expand,
            foot_points: None,
        };
        solve(&task, &mut chosen, observer)
    }

    fn choose_scattered<'a>(
        &self,
        matrix: &'a ChosenCollocation,
        part: &Setting<'_>,
    ) -> Result<ChosenRule<'a>, Error> {
        let options = part.options;
        let weight = one_weight(options)?;
        let (count, dimension) = (matrix.points(), part.view.dimension());
        super::method::check_weight(options.method, weight, count)?;
        let refused = |what, why| {
            Err(Error::Incompatible {
                what,
                with: "chosen points that are not all crossings of some rows with some columns",
                why,
            })
        };
        // That of the matrix of all crossings: no smaller one was ever met in a part of it.
        let smallest = || -> Result<f64, Error> {
            let Directions { u, v, rational } = self.directions();
            match rational {
                Some(net) => smallest_rational_eigenvalue(u, v, net),
                None => Ok(smallest_eigenvalue_of(u)?.for_weights()
                    * smallest_eigenvalue_of(v)?.for_weights()),
            }
        };
        let mut choices = Vec::new();
        let (name, rule): (_, Box<dyn UpdateRule + 'a>) = match options.method {
            Method::Auto => {
                choices.push(
                    "method: Anderson-accelerated PIA, because the chosen points are not all \
                     crossings of some rows with some columns, so that their matrix has no narrow \
                     band"
                        .into(),
                );
                let rule = anderson(None, (count, false), dimension, &mut choices)?;
                match options.keep.iter().copied().max().unwrap_or(0).min(options.iterations) {
                    0 => ("anderson", Box::new(rule)),
                    gradual => ("auto", Box::new(Staged::new(Pia, gradual, rule))),
                }
            }
            Method::Anderson { memory } => {
                ("anderson", Box::new(anderson(memory, (count, false), dimension, &mut choices)?))
            }
            Method::Pia | Method::Local => ("pia", Box::new(Pia)),
            Method::Adaptive => {
                let rows = AdaptiveRows::Curve(matrix);
                return choose_adaptive(rows, weight, count, part.stopping.residual);
            }
            Method::Weighted => ("weighted", weighted(weight, &[matrix], smallest, &mut choices)?),
            Method::Jacobi => {
                let largest = largest_jacobi_eigenvalue(matrix);
                if largest > JACOBI_DIVERGES {
                    return refused(
                        "jacobi",
                        "its largest eigenvalue passes 2, so that the run would diverge; use \
                         gauss-seidel",
                    );
                }
                ("jacobi", Box::new(Jacobi::new(matrix)))
            }
            Method::GaussSeidel => ("gauss-seidel", Box::new(GaussSeidel::new(matrix))),
            Method::Chebyshev => {
                let least = smallest()?;
                choices.push(format!("interval of eigenvalues: [{least:.4e}, 1]"));
                ("chebyshev", Box::new(Chebyshev::new(least, 1.0, count * dimension)))
            }
            Method::Sor => {
                return refused(
                    "sor",
                    "over-relaxation is known for one direction only; choose one window and run per \
                     direction, or use gauss-seidel",
                );
            }
            Method::Preconditioned { .. } => {
                return refused(
                    "preconditioned",
                    "their matrix has no narrow band; choose one window, or use auto",
                );
            }
            Method::Geometric { .. } => return Err(super::method::NO_FOOT_POINTS),
        };
        Ok(ChosenRule { rule, name, choices, smallest_eigenvalue: None })
    }
}

/// Which points fitted are chosen. A closing row or column that was taken out stands for the first.
fn mask(
    windows: &[[Range<usize>; 2]],
    given: [usize; 2],
    shape: [usize; 2],
) -> Result<Vec<bool>, Error> {
    let mut chosen = vec![false; shape[0] * shape[1]];
    for window in windows {
        for k in 0..2 {
            if window[k].end > given[k] && !window[k].is_empty() {
                return Err(Error::OutOfRange {
                    what: ["row", "column"][k].to_owned() + " of a point to move",
                    value: (window[k].end - 1) as f64,
                    rule: "it counts from 0 and must be less than the number of rows, or columns",
                });
            }
        }
        let [rows, columns] = window;
        let fitted = |k: usize, line: usize| if line < shape[k] { line } else { 0 };
        for i in rows.clone() {
            let row = &mut chosen[fitted(0, i) * shape[1]..][..shape[1]];
            let whole = columns.start.min(shape[1])..columns.end.min(shape[1]);
            row[whole.start..whole.end.max(whole.start)].fill(true);
            if columns.end > shape[1] && !columns.is_empty() {
                row[0] = true;
            }
        }
    }
    Ok(chosen)
}
