//! The operator of a least squares fit with constraints.

use super::method::whole_band;
use super::{LeastSquaresMethod as Method, LeastSquaresOptions};
use crate::Error;
use crate::collocation::{
    ConstrainedCollocation, LeastSquaresCollocation, Metric, NormalMatrix, independent,
};
use crate::fit::solve::Size;
use crate::iteration::update::Preconditioner;
use crate::knots::KnotVector;

/// What constraints are met over.
pub(super) struct Setting<'a> {
    pub(super) operator: &'a LeastSquaresCollocation,
    pub(super) normal: &'a NormalMatrix,
    pub(super) data: &'a [f64],
    pub(super) dimension: usize,
    pub(super) parameters: &'a [f64],
    pub(super) knots: &'a KnotVector,
    pub(super) size: &'a Size,
}

/// Most rows, one per coordinate of a constraint.
const MOST_ROWS: usize = 4000;

/// The operator that the rule of a method meets, and a start that meets the constraints; `None`
/// without constraints.
pub(super) fn constrained<'a>(
    options: &LeastSquaresOptions,
    setting: &Setting<'a>,
    start: &mut [f64],
) -> Result<Option<ConstrainedCollocation<'a>>, Error> {
    let constraints = &options.constraints;
    if constraints.is_empty() {
        return Ok(None);
    }
    let &Setting { operator, normal, data, dimension, parameters, knots, size } = setting;
    let metric = match options.method {
        // The very factors that precondition the steps.
        Method::Auto if options.keep.is_empty() => match whole_band(normal, &mut Vec::new())? {
            Preconditioner::Factors(factors) => Metric::Factors(factors),
            _ => return Err(TOO_FREE),
        },
        Method::Lspia | Method::Cgls => Metric::Identity,
        Method::ColumnSums => Metric::Reciprocals(normal.reciprocal_sums()),
        Method::Pcg => Metric::Reciprocals(normal.reciprocal_diagonal()),
        Method::Auto => {
            return Err(Error::Incompatible {
                what: "constraints",
                with: "kept fits of the method auto",
                why: "it has no fits of the way with constraints; choose lspia or column-sums",
            });
        }
        _ => {
            return Err(Error::Incompatible {
                what: "constraints",
                with: "this method",
                why: "its steps are not projected; use least-squares, lspia, column-sums, cgls or pcg",
            });
        }
    };
    let columns = operator.stays().len();
    let up = |x: f64| size.scale.up(x);
    let mut rows = constraints.rows(data, dimension, parameters, knots, columns, &up)?;
    // Control points that stay are known.
    for row in &mut rows {
        let (entries, value) = (&mut row.entries, &mut row.value);
        entries.retain(|&(place, weight)| {
            let stays = operator.stays()[place / dimension];
            if stays {
                *value -= weight * start[place];
            }
            !stays && weight != 0.0
        });
    }
    if rows.len() > MOST_ROWS {
        return Err(Error::OutOfRange {
            what: "number of coordinates that are constrained".into(),
            value: rows.len() as f64,
            rule: "at most 4000 can be met exactly beside least squares; to meet all points, interpolate",
        });
    }
    let largest = up(size.extent.largest_coordinate());
    let rows = independent(rows, largest).map_err(|owners| {
        let names: Vec<String> = owners.iter().map(|&owner| constraints.name(owner)).collect();
        Error::ConstraintsConflict { positions: owners, constraints: names.join(", ") }
    })?;
    let operator =
        ConstrainedCollocation::new(operator, rows, metric, dimension).ok_or(TOO_FREE)?;
    operator.make_feasible(start, dimension);
    Ok(Some(operator))
}

const TOO_FREE: Error = Error::Incompatible {
    what: "constraints",
    with: "data that leave control points free",
    why: "the normal matrix is singular in doubles; use fewer control points, or --method lspia",
};
