//! Fits that keep the turns of a planar data polygon.

use super::intervals::Intervals;
use super::method::{ChosenRule, choose};
use super::{Convexity, CurveOptions, IterationWeight, Method};
use crate::Error;
use crate::collocation::{
    BandedCollocation, CollocationMatrix, CollocationOperator, ControlLayout,
};
use crate::geometry::{Curve, KnotInsertion};
use crate::iteration::UpdateRule;
use crate::iteration::update::{ClosestConvex, ConvexityPreserving, Pia, Preconditioned, Staged};
use crate::knots::KnotVector;
use crate::parameters::Parameters;
use crate::points::{Points, PointsView};
use crate::report::ShapeReport;
use crate::shape::{Shape, Turn};

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
        Ok(Self { shape: Shape::of(data.coordinates(), closed), convexity, insertion: None })
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
                        "convexity: the interpolant and its control polygon turn as the data do"
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
        Ok(intervals.insertion(&curve).map_or(Interpolant::Lost, Interpolant::KeptWith))
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

    /// The account, from the control points that moved.
    pub(super) fn report(&self, control: &[f64]) -> ShapeReport {
        ShapeReport {
            left: self.shape.count(Turn::Left),
            right: self.shape.count(Turn::Right),
            straight: self.shape.count(Turn::Straight),
            inserted_knots: self.insertion.as_ref().map_or(0, KnotInsertion::count),
            // Inserted knots were chosen so that the polygon turns as asked.
            kept: self.insertion.is_some() || self.shape.is_kept_by(control),
        }
    }
}

/// What an interpolating curve is made of, but for its control points.
pub(super) struct Interpolating<'a> {
    pub(super) data: PointsView<'a>,
    pub(super) parameters: &'a Parameters,
    pub(super) knots: &'a KnotVector,
    pub(super) layout: ControlLayout,
}
