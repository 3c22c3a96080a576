//! `gimfit edit`: single points of a curve moved, inserted and removed.

mod list;

use super::plan::{Shape, shape, shape_inputs};
use super::{Job, explain_fit, print};
use crate::Ending;
use crate::arguments::{BasisChoice, InputArguments, KnotRule, MethodChoice, RuleOrFile};
use crate::arguments::{ShapeArguments, WritingArguments};
use crate::explain::explain;
use crate::family::has_place;
use crate::finish::{Finish, Run, Sought};
use crate::outputs::Wanted;
use crate::report_text::time;
use crate::signal::{self, Stage};
use crate::values;
use anyhow::{anyhow, ensure};
use clap::Args;
use gimfit::{CurveOptions, EditReport, EditableCurve, Error, PointsView};
use gimfit_io::document::Seconds;
use list::{Edit, Edits, Kind};
use std::time::Instant;

#[derive(Debug, Args)]
#[command(
    after_help = "Edits are done one after another in the order given, each on the curve that the \
one before left. Points count from 1. A point keeps its parameter when it moves; an inserted one \
divides the gap between its neighbours as the chords do (in half where parameters are uniform or \
given). Knots are averaged ones.

Exit status: 0 done; 1 a residual was not reached (the curve is written all the same); 2 wrong usage \
or input, nothing written, or a file that could not be written; 130 interrupted, nothing written.

Examples:
  gimfit edit track.csv --move 120=3.5,-2.25 -o track.json
  gimfit edit outline.csv --closed --move 1=0.5,0 -o outline.svg
  gimfit edit track.csv --remove 17 --insert 40=1,2,0.5 --move 41=1.5,2,0.5 -o edited.csv"
)]
pub(crate) struct EditArguments {
    #[command(flatten)]
    input: InputArguments,

    #[command(flatten)]
    edits: Edits,

    #[command(flatten)]
    shape: ShapeArguments,

    /// Largest residual to keep, in the unit of the points [default: 1e-12 of the extent, or what
    /// rounding allows]
    #[arg(
        long,
        value_name = "T",
        value_parser = values::number,
        allow_negative_numbers = true,
        help_heading = "Iteration"
    )]
    residual: Option<f64>,

    #[command(flatten)]
    writing: WritingArguments,

    /// Samples written to .csv files instead of control points
    #[arg(long, value_name = "N", value_parser = values::samples, help_heading = "Writing")]
    samples: Option<usize>,
}

pub(crate) fn run(arguments: &EditArguments) -> anyhow::Result<Ending> {
    let EditArguments { input, edits, shape: form, residual, writing, samples } = arguments;
    for output in &writing.output {
        ensure!(
            !has_place(output),
            "-o {}: gimfit edit writes the curve after all edits and keeps none on the way; name one \
             file",
            output.display()
        );
    }
    let wanted = Wanted::new(writing, &[], samples.is_some());
    wanted.check(&shape_inputs(input, form))?;
    ensure!(samples.is_none_or(|n| n >= 2), "--samples must be at least 2");
    ensure!(!edits.0.is_empty(), "nothing to do: give at least one --move, --insert or --remove");
    ensure!(residual.is_none_or(|r| r > 0.0), "--residual must be more than 0");
    ensure_local(form)?;
    signal::listen()?;
    let clock = Instant::now();
    let Shape { mut table, options, .. } = shape(input, form)?;
    let read = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    let view = PointsView::new(table.dimension(), &table.coordinates)
        .map_err(|error| explain(error, &table))?;
    let options = CurveOptions { residual: *residual, ..options };
    let mut curve = EditableCurve::new(view, &options)
        .map_err(|error| explain_fit(error, &table, input, form))?;
    let mut done = Vec::new();
    for edit in &edits.0 {
        let clock = Instant::now();
        let report = apply(&mut curve, edit)?;
        done.push(line(edit, &report, curve.len(), clock.elapsed().as_secs_f64()));
    }
    let fit = curve.fit()?;
    let fitted = clock.elapsed().as_secs_f64();
    signal::enter(Stage::Writing);

    table.notes.push("points are numbered as the edits left them".into());
    table.coordinates = curve.points()?.into_coordinates();
    (table.row_lines, table.row_positions) = (None, None);
    let mut job =
        Job::new(&table, &fit, None, *samples, Seconds { read, fit: fitted, write: None });
    job.edits = done;
    let run = &fit.report.run;
    let finish = Finish {
        wanted,
        method: MethodChoice::Auto,
        convex: None,
        run: Run::of(run, Sought::Residual),
    };
    finish.finish(&mut job, print::report)
}

/// Refuses what has no knots that follow from parameters nearby.
fn ensure_local(form: &ShapeArguments) -> anyhow::Result<()> {
    let why = "gimfit edit is for curves of B-splines over averaged knots";
    let averaged = matches!(form.knots, None | Some(RuleOrFile::Rule(KnotRule::Averaged)));
    ensure!(averaged, "--knots: {why}");
    ensure!(form.basis == BasisChoice::BSpline, "--basis: {why}");
    ensure!(form.rational_weights.is_none(), "--rational-weights: {why}, without weights");
    Ok(())
}

fn apply(curve: &mut EditableCurve, edit: &Edit) -> anyhow::Result<EditReport> {
    let Edit { kind, number, point, text } = edit;
    let most = curve.len() + usize::from(*kind == Kind::Insert);
    ensure!(
        *number <= most,
        "{text}: there {} when this edit's turn comes{}",
        if curve.len() == 1 { "is 1 point".into() } else { format!("are {} points", curve.len()) },
        if *kind == Kind::Insert {
            format!("; a point at {most} goes to the end")
        } else {
            String::new()
        }
    );
    ensure!(
        *kind == Kind::Remove || point.len() == curve.dimension(),
        "{text}: {} given, but the points have {}",
        if point.len() == 1 {
            "1 number is".into()
        } else {
            format!("{} numbers are", point.len())
        },
        curve.dimension()
    );
    let index = number - 1;
    let result = match kind {
        Kind::Move => curve.move_point(index, point),
        Kind::Insert => curve.insert_point(index, point),
        Kind::Remove => curve.remove_point(index),
    };
    result.map_err(|error| match error {
        Error::MeetsNeighbour { neighbour } => anyhow!(
            "{text}: the point would coincide with its neighbour, point {}; give it another place, \
             or use --parameters uniform",
            neighbour + 1
        ),
        Error::ParametersCollide { .. } => anyhow!(
            "{text}: the point lies too close to a neighbour, against the length of the whole curve, \
             to have a parameter of its own; give it another place, or use --parameters uniform"
        ),
        Error::TooFewPoints { points, degree, needed } => anyhow!(
            "{text}: {points} points would be left, too few for degree {degree}, which needs \
             {needed}; lower it with --degree"
        ),
        other => anyhow!("{text}: {other}"),
    })
}

/// What an edit did.
fn line(edit: &Edit, report: &EditReport, count: usize, seconds: f64) -> String {
    let what = match edit.kind {
        Kind::Move => "moved",
        Kind::Insert => "inserted",
        Kind::Remove => "removed",
    };
    let within = if report.bound.is_finite() {
        format!("at most {:.1e} from a fit of all points", report.bound)
    } else {
        "no bound on the way to a fit of all points".into()
    };
    format!(
        "{what} {}: control points {} to {} of {count} touched, residual {:.1e}, {within}, {}",
        edit.number,
        report.window.start + 1,
        // Those of a closed curve go on past the last.
        (report.window.end - 1) % count + 1,
        report.max_residual,
        time(seconds)
    )
}
