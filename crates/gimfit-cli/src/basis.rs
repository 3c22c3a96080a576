//! Bases other than B-splines, as the arguments of curves and surfaces name them.

use crate::arguments::BasisChoice;
use anyhow::{bail, ensure};
use gimfit::Method;
use gimfit::basis::{Bernstein, BlendingBasis, Dp, SaidBall, WangBall};
use gimfit::knots::MAX_DEGREE;
use std::sync::Arc;

/// The basis with one function for each of `points`, which are called `what`; none for B-splines.
pub(crate) fn basis(
    choice: BasisChoice,
    points: usize,
    what: &str,
    source: &str,
) -> anyhow::Result<Option<Arc<dyn BlendingBasis>>> {
    if choice == BasisChoice::BSpline {
        return Ok(None);
    }
    ensure!(
        points >= 2,
        "{source}: a curve of a basis needs at least 2 {what}, and there are {points}"
    );
    let degree = points - 1;
    Ok(Some(match choice {
        BasisChoice::Bernstein => Arc::new(Bernstein::new(degree)?),
        BasisChoice::WangBall => Arc::new(WangBall::new(degree)?),
        BasisChoice::SaidBall => Arc::new(SaidBall::new(degree)?),
        BasisChoice::Dp => Arc::new(Dp::new(degree)?),
        BasisChoice::BSpline => return Ok(None),
    }))
}

/// Refuses a fit over a basis of more functions than documents hold in Bezier form.
pub(crate) fn ensure_document_holds(points: usize, what: &str, source: &str) -> anyhow::Result<()> {
    ensure!(
        points <= MAX_DEGREE + 1,
        "{source}: {points} {what} ask for a basis of degree {}, and documents hold degrees up to \
         {MAX_DEGREE}; use --basis b-spline",
        points.saturating_sub(1)
    );
    Ok(())
}

/// Refuses an option that belongs to B-splines, if it was given.
pub(crate) fn only_b_splines(option: &str, given: bool, why: &str) -> anyhow::Result<()> {
    if given {
        bail!("{option} belongs to --basis b-spline: {why}");
    }
    Ok(())
}

/// Refuses foot points on bases other than B-splines; a Bezier curve is one of them.
pub(crate) fn ensure_no_foot_points(method: Method) -> anyhow::Result<()> {
    ensure!(
        !matches!(method, Method::Geometric { .. }),
        "--method geometric moves foot points on B-splines, those of one piece among them: in place of \
         --basis bernstein use --knots bezier"
    );
    Ok(())
}

/// How a basis is called in reports.
pub(crate) fn described(basis: &dyn BlendingBasis) -> String {
    let positive = if basis.is_totally_positive() { "" } else { " (not totally positive)" };
    format!("{}{positive}", basis.name())
}
