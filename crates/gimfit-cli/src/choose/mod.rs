//! `gimfit choose`: fits from few control points to many, each with its error.

mod arguments;
mod ladder;
mod print;

pub(crate) use arguments::{ChooseArguments, ChooseGridArguments};

use crate::arguments::{BasisChoice, WritingArguments};
use crate::explain::explain;
use crate::finish::present;
use crate::outputs::Wanted;
use crate::progress::Progress;
use crate::signal::{self, Stage};
use crate::{Ending, curve, input, output, surface};
use anyhow::{bail, ensure};
use arguments::LadderArguments;
use gimfit::points::Extent;
use gimfit::{
    ApproximationOptions, Corners, GridView, PointsView, SurfaceApproximationOptions,
    curve_choices, surface_choices, usual_distances,
};
use gimfit_io::document::Seconds;
use ladder::{Choice, Ladder};
use std::path::Path;
use std::time::Instant;

pub(crate) fn run(arguments: &ChooseArguments) -> anyhow::Result<Ending> {
    let wanted = Wanted::of_all(&arguments.writing);
    let read: [(&str, &Path); 1] = [("POINTS", &arguments.input.points)];
    check(wanted, &read, &arguments.ladder, &arguments.writing)?;
    let clock = Instant::now();
    let table = input::points(&arguments.input)?;
    let read = clock.elapsed().as_secs_f64();
    let view = PointsView::new(table.dimension(), &table.coordinates)
        .map_err(|error| explain(error, &table))?;
    let options = ApproximationOptions {
        degree: arguments.degree,
        closed: arguments.closed,
        abscissae: table.abscissa.clone(),
        corners: arguments.corners.map_or(Corners::Auto, |choice| choice.0),
        ..ApproximationOptions::within(1.0)
    };
    let distances = distances(&arguments.ladder, view).map_err(|error| explain(error, &table))?;
    let mut progress = Progress::of_search(arguments.writing.quiet, table.dimension());
    let clock = Instant::now();
    let found = curve_choices(view, &distances, &options, &mut progress);
    let seconds = Seconds { read, fit: clock.elapsed().as_secs_f64(), write: None };
    progress.finish();
    signal::enter(Stage::Writing);
    let found = found.map_err(|error| explain(error, &table))?;
    let mut ladder = Ladder {
        source: &table.source,
        title: table.title.as_deref(),
        read: format!("{} points of dimension {}", table.rows(), table.dimension()),
        notes: &table.notes,
        kind: format!("degree {}", options.degree),
        choices: found.iter().map(Choice::of_curve).collect(),
        seconds,
        command: "gimfit curve",
        job: &|k, visit| visit(&mut curve::Job::new(&table, &found[k], None, None, seconds)),
    };
    finish(&mut ladder, wanted, &arguments.ladder)
}

pub(crate) fn run_grid(arguments: &ChooseGridArguments) -> anyhow::Result<Ending> {
    let wanted = Wanted::of_all(&arguments.writing);
    refuse_others(&arguments.grid)?;
    check(wanted, &surface::form_inputs(&arguments.grid), &arguments.ladder, &arguments.writing)?;
    let clock = Instant::now();
    let form = surface::form(&arguments.grid)?;
    let read = clock.elapsed().as_secs_f64();
    let grid = form.grid;
    let explain = |error| surface::explain(error, &grid);
    let view = GridView::new([grid.rows, grid.columns], grid.dimension(), &grid.coordinates)
        .map_err(explain)?;
    let options = SurfaceApproximationOptions {
        degrees: form.options.degrees,
        closed: form.options.closed,
        ..SurfaceApproximationOptions::within(1.0)
    };
    let distances = distances(&arguments.ladder, view.points()).map_err(explain)?;
    let mut progress = Progress::of_search(arguments.writing.quiet, grid.dimension());
    let clock = Instant::now();
    let found = surface_choices(view, &distances, &options, &mut progress);
    let seconds = Seconds { read, fit: clock.elapsed().as_secs_f64(), write: None };
    progress.finish();
    signal::enter(Stage::Writing);
    let found = found.map_err(explain)?;
    let [p, q] = options.degrees;
    let mut ladder = Ladder {
        source: &grid.source,
        title: grid.title.as_deref(),
        read: format!("{} x {} points of dimension {}", grid.rows, grid.columns, grid.dimension()),
        notes: &grid.notes,
        kind: format!("degrees {p} and {q}"),
        choices: found.iter().map(Choice::of_surface).collect(),
        seconds,
        command: "gimfit surface",
        job: &|k, visit| visit(&mut surface::Job::new(&grid, &found[k], None, None, seconds)),
    };
    finish(&mut ladder, wanted, &arguments.ladder)
}

/// What can be checked before anything is read.
fn check(
    wanted: Wanted<'_>,
    inputs: &[(&str, &Path)],
    ladder: &LadderArguments,
    writing: &WritingArguments,
) -> anyhow::Result<()> {
    wanted.check(inputs)?;
    ensure!(
        !writing.geometry,
        "--geometry belongs to the document of one fit: write those of all with -o 'fit-{{k}}.json'"
    );
    if let Some(distance) = ladder.distances.iter().find(|d| !(**d > 0.0 && d.is_finite())) {
        bail!("--distances: {distance} is not a distance above 0");
    }
    signal::listen()
}

/// What decides how a surface passes through all points, which these do not.
fn refuse_others(grid: &surface::GridArguments) -> anyhow::Result<()> {
    let others = [
        ("--basis", grid.basis.0 != [BasisChoice::BSpline; 2]),
        ("--parameters", grid.parameters.is_some()),
        ("--knots", grid.knots.is_some()),
        ("--rational-weights", grid.rational_weights.is_some()),
    ];
    match others.iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((name, _)) => {
            bail!("{name} does not go with gimfit choose, which seeks knots and parameters")
        }
    }
}

/// The distances asked for, or usual ones of this extent.
fn distances(ladder: &LadderArguments, points: PointsView<'_>) -> Result<Vec<f64>, gimfit::Error> {
    if !ladder.distances.is_empty() {
        return Ok(ladder.distances.clone());
    }
    let usual = usual_distances(Extent::of(points)?.diagonal());
    // Points that are all equal have no extent; the fit says what is wrong with them.
    Ok(if usual.is_empty() { vec![1.0] } else { usual })
}

fn finish(
    ladder: &mut Ladder<'_>,
    wanted: Wanted<'_>,
    arguments: &LadderArguments,
) -> anyhow::Result<Ending> {
    let stopped = signal::interrupted();
    ensure!(!ladder.choices.is_empty(), "interrupted before there was a fit");
    present(ladder, wanted, print::report)?;
    let missed = ladder.choices.last().filter(|choice| !choice.met);
    if stopped {
        output::remark("\nwarning: interrupted; closer fits were not tried\n");
        return Ok(Ending::NotMet);
    }
    match missed {
        Some(choice) if !arguments.distances.is_empty() => {
            output::remark(&format!(
                "\nwarning: the distance {} was not kept: the best found is {:.3e}\n",
                print::plain(choice.distance),
                choice.largest
            ));
            Ok(Ending::NotMet)
        }
        _ => Ok(Ending::Done),
    }
}
