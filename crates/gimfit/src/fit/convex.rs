//! Fits that keep the turns of a planar data polygon.

use super::intervals::Intervals;
use super::method::{ChosenRule, choose};
use super::{Convexity, CurveOptions, IterationWeight, Method};
use crate::Error;
use crate::collocation::{
    BandedCollocation, CollocationMatrix, CollocationOperator, ControlLayout,
};
use crate::geometry::{Curve, KnotInsertion, bend_signs};
use crate::iteration::UpdateRule;
use crate::iteration::update::{ClosestConvex, ConvexityPreserving, Pia, Preconditioned, Staged};
use crate::knots::KnotVector;
use crate::parameters::Parameters;
use crate::points::{Points, PointsView};
use crate::report::ShapeReport;
use crate::shape::{Shape, Turn, turn};

/// A shape to keep, and how.
pub(super) struct Keeping {
    shape: Shape,
    convexity: Convexity,
    insertion: Option<KnotInsertion>,
}

/// What the interpolant looks like.
enum Interpolant {
    /// Its control polygon has the shape.
    Kept,
    /// The curve has it, and its control polygon after inserting knots.
    KeptWith(KnotInsertion),
    /// Neither.
    Lost,
}

impl Keeping {
    /// Takes the shape of the data.
    pub(super) fn new(
        convexity: Convexity,
        data: PointsView<'_>,
        closed: bool,
        degree: usize,
    ) -> Result<Self, Error> {
        if data.dimension() != 2 {
            return Err(Error::Incompatible {
                what: "keeping convexity",
                with: "points of this dimension",
                why: "only polygons in the plane turn left or right; take two of the coordinates",
            });
        }
        let count = data.len();
        let next = |j: usize| if j + 1 < count { j + 1 } else { 0 };
        let pairs = if closed { count } else { count - 1 };
        if let Some(first) = (0..pairs).find(|&j| data.point(j) == data.point(next(j))) {
            return Err(Error::RepeatedPoints { first, second: next(first), others: 0 });
        }
        let shape = Shape::of(data.coordinates(), closed, degree);
        Ok(Self { shape, convexity, insertion: None })
    }

    /// Prepares the rule. `threshold` stands in for the paper's D where none was chosen; `gradual`
    /// steps of plain PIA come first where fits of the way are wanted.
    pub(super) fn choose<'a>(
        &mut self,
        problem: &Interpolating<'_>,
        options: &CurveOptions,
        operator: &'a BandedCollocation,
        threshold: f64,
        gradual: usize,
    ) -> Result<ChosenRule<'a>, Error> {
        match self.convexity {
            Convexity::Published { .. } => self.published(options, operator, threshold),
            Convexity::Closest => self.closest(problem, options, operator, threshold, gradual),
        }
    }

    fn published<'a>(
        &self,
        options: &CurveOptions,
        operator: &'a BandedCollocation,
        threshold: f64,
    ) -> Result<ChosenRule<'a>, Error> {
        let method = match options.method {
            Method::Auto => Method::Pia,
            Method::Chebyshev | Method::Anderson { .. } => {
                return Err(Error::Incompatible {
                    what: "the published way to keep convexity",
                    with: "a method that builds on its own earlier steps",
                    why: "chebyshev and anderson take whole steps for granted; choose another",
                });
            }
            method => method,
        };
        let mut chosen = choose(method, &options.weight, operator, 2, 0)?;
        if options.method == Method::Auto {
            chosen.choices.push("method: plain PIA, as published with the guard".into());
        }
        chosen.choices.push(
            "convexity: Algorithm 1 of Lin, Wang and Dong (2004): each step is cut until the \
             control polygon turns as the data do"
                .into(),
        );
        chosen.rule =
            Box::new(ConvexityPreserving::new(chosen.rule, self.shape.clone(), threshold));
        Ok(chosen)
    }

    fn closest<'a>(
        &mut self,
        problem: &Interpolating<'_>,
        options: &CurveOptions,
        operator: &'a BandedCollocation,
        threshold: f64,
        gradual: usize,
    ) -> Result<ChosenRule<'a>, Error> {
        if options.method != Method::Auto || options.weight != IterationWeight::Auto {
            return Err(Error::Incompatible {
                what: "the closest convex fit",
                with: "a method or weight of your choice",
                why: "it has its own steps; leave the method to it, or keep convexity in the \
                      published way",
            });
        }
        let mut choices = Vec::new();
        let (name, rule): (_, Box<dyn UpdateRule + 'a>) =
            match self.interpolant(problem, operator)? {
                Interpolant::KeptWith(insertion) => {
                    let added = insertion.knots().control_points() - problem.knots.control_points();
                    choices.push(match added {
                    0 => "convexity: the interpolant turns as the data do, its control polygon in \
                          the same order"
                        .to_owned(),
                    1 => "convexity: the interpolant turns as the data do, its control polygon \
                          after inserting 1 knot"
                        .to_owned(),
                    _ => format!(
                        "convexity: the interpolant turns as the data do, its control polygon \
                         after inserting {added} knots"
                    ),
                });
                    self.insertion = Some(insertion);
                    ("preconditioned", Box::new(Preconditioned::new(operator, None)?))
                }
                kept => {
                    choices.push(match kept {
                    Interpolant::Kept => {
                        "convexity: the control polygon of the interpolant turns as the data do"
                            .into()
                    }
                    _ => "convexity: the interpolant does not turn as the data do; the least sum \
                          of squared residuals among the control polygons that do"
                        .to_owned(),
                });
                    ("closest-convex", Box::new(ClosestConvex::new(operator, self.shape.clone())?))
                }
            };
        let rule = if gradual > 0 {
            choices.push(format!(
                "method: plain PIA up to step {gradual}, cut where the shape asks for it, because \
                 fits of the way are kept"
            ));
            let guarded = ConvexityPreserving::new(Pia, self.shape.clone(), threshold);
            Box::new(Staged::new(guarded, gradual, rule))
        } else {
            rule
        };
        Ok(ChosenRule { rule, name, choices, smallest_eigenvalue: None })
    }

    fn interpolant(
        &self,
        problem: &Interpolating<'_>,
        operator: &BandedCollocation,
    ) -> Result<Interpolant, Error> {
        let factors = operator.factor(None)?;
        let mut control = problem.data.coordinates().to_vec();
        factors.solve_in_place(&mut control, 2);
        let mut rest = vec![0.0; control.len()];
        operator.difference_vectors(problem.data.coordinates(), &control, 2, &mut rest);
        factors.solve_in_place(&mut rest, 2);
        control.iter_mut().zip(&rest).for_each(|(p, delta)| *p += delta);
        if self.shape.is_kept_by(&control) {
            return Ok(Interpolant::Kept);
        }
        if control.iter().any(|x| !x.is_finite()) {
            return Ok(Interpolant::Lost);
        }
        let stored = Points::new(2, problem.layout.expand(control, 2))?;
        let curve = Curve::new(problem.knots.clone(), stored)?;
        let intervals = Intervals::of(&self.shape, problem.parameters);
        if !intervals.bend_as_asked(&curve) {
            return Ok(Interpolant::Lost);
        }
        let Some(insertion) = intervals.insertion(&curve) else { return Ok(Interpolant::Lost) };
        let finer = insertion.apply(curve.control_points().coordinates(), 2);
        let free = 2 * (curve.free_control_points() + insertion.count());
        if self.shape.turns_no_further(&finer[..free]) {
            Ok(Interpolant::KeptWith(insertion))
        } else {
            Ok(Interpolant::Lost)
        }
    }

    /// The knots of the curve returned.
    pub(super) fn knots(&self, knots: KnotVector) -> KnotVector {
        self.insertion.as_ref().map_or(knots, |insertion| insertion.knots().clone())
    }

    /// Stored control points over those knots.
    pub(super) fn refine(&self, stored: Vec<f64>) -> Vec<f64> {
        match &self.insertion {
            Some(insertion) => insertion.apply(&stored, 2),
            None => stored,
        }
    }

    /// The account, from the control points that moved and the curve of the end.
    pub(super) fn report(&self, control: &[f64], curve: &Curve) -> ShapeReport {
        let free = curve.free_control_points();
        let stored = &curve.control_points().coordinates()[..2 * free];
        let drawn = if self.insertion.is_some() { stored } else { control };
        let turns = turns(drawn, self.shape.is_closed());
        ShapeReport {
            left: self.shape.count(Turn::Left),
            right: self.shape.count(Turn::Right),
            straight: self.shape.count(Turn::Straight),
            control_left: turns.iter().filter(|&&turn| turn == Turn::Left).count(),
            control_right: turns.iter().filter(|&&turn| turn == Turn::Right).count(),
            inserted_knots: self.insertion.as_ref().map_or(0, KnotInsertion::count),
            // Inserted knots were chosen so that the polygon turns as asked, for a curve that bends
            // as asked.
            kept: self.insertion.is_some()
                || self.shape.is_kept_by(control)
                    && (self.shape.is_assured_by(control) || bends_no_more(&self.shape, curve)),
        }
    }
}

/// The turns of a polygon, exactly, without legs of no length.
fn turns(polygon: &[f64], closed: bool) -> Vec<Turn> {
    let mut points: Vec<[f64; 2]> = polygon.chunks_exact(2).map(|p| [p[0], p[1]]).collect();
    points.dedup();
    if closed {
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        points.extend_from_within(..points.len().min(2));
    }
    points.windows(3).map(|p| turn(p[0], p[1], p[2])).collect()
}

/// Whether a curve changes the side to which it bends no more often than a shape does.
fn bends_no_more(shape: &Shape, curve: &Curve) -> bool {
    let (start, end) = curve.domain();
    let size = curve.control_points().coordinates().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut bends = Vec::new();
    bend_signs(curve, start, end, size, &mut bends);
    bends.retain(|&bend| bend != Turn::Straight);
    bends.dedup();
    let round = shape.is_closed() && bends.first() != bends.last();
    let changes = bends.len().saturating_sub(1) + usize::from(round);
    let allowed = shape.changes_of_side();
    let sides = [Turn::Left, Turn::Right].map(|turn| shape.count(turn) > 0);
    let allows = |bend: &Turn| sides[usize::from(*bend == Turn::Right)];
    changes <= allowed && (sides == [false; 2] || bends.iter().all(allows))
}

/// What an interpolating curve is made of, but for its control points.
pub(super) struct Interpolating<'a> {
    pub(super) data: PointsView<'a>,
    pub(super) parameters: &'a Parameters,
    pub(super) knots: &'a KnotVector,
    pub(super) layout: ControlLayout,
}
