//! From arguments to points and options, with all that can be checked before the run.

use crate::arguments::{CurveArguments, KnotRule, MethodChoice, ParameterRule, RuleOrFile};
use crate::input;
use anyhow::{bail, ensure};
use gimfit::{CurveOptions, IterationWeight, KnotPlacement, Method, Parameterization};
use gimfit_io::points::PointTable;
use std::path::Path;

/// What will be run.
pub(super) struct Plan {
    pub(super) table: PointTable,
    pub(super) options: CurveOptions,
}

impl Plan {
    pub(super) fn new(arguments: &CurveArguments) -> anyhow::Result<Self> {
        ensure!(
            !(arguments.input.abscissa.is_some() && arguments.parameters.is_some()),
            "--abscissa and --parameters both give the parameters; use one of them"
        );
        ensure!(
            arguments.bandwidth.is_none() || arguments.method == MethodChoice::Preconditioned,
            "--bandwidth belongs to --method preconditioned"
        );
        let weight = weight(&arguments.weight)?;
        let mut table = input::points(&arguments.input)?;
        if arguments.sort {
            sort_by_abscissa(&mut table);
        }
        let options = CurveOptions {
            degree: arguments.degree,
            closed: arguments.closed,
            parameterization: parameterization(arguments, &mut table)?,
            knot_placement: arguments.knots.as_ref().map(knot_placement).transpose()?,
            method: method(arguments),
            weight,
            iterations: arguments.iterations,
            residual: arguments.residual,
            duplicates: arguments.duplicates.into(),
            keep: arguments.keep.clone(),
        };
        Ok(Self { table, options })
    }
}

fn method(arguments: &CurveArguments) -> Method {
    match arguments.method {
        MethodChoice::Auto => Method::Auto,
        MethodChoice::Pia => Method::Pia,
        MethodChoice::Weighted => Method::Weighted,
        MethodChoice::Jacobi => Method::Jacobi,
        MethodChoice::GaussSeidel => Method::GaussSeidel,
        MethodChoice::Sor => Method::Sor,
        MethodChoice::Chebyshev => Method::Chebyshev,
        MethodChoice::Preconditioned => {
            Method::Preconditioned { half_bandwidth: arguments.bandwidth }
        }
    }
}

fn weight(text: &str) -> anyhow::Result<IterationWeight> {
    if text == "auto" {
        return Ok(IterationWeight::Auto);
    }
    if let Ok(omega) = text.parse() {
        return Ok(IterationWeight::Same(omega));
    }
    Ok(IterationWeight::PerPoint(input::numbers(Path::new(text), "--weight")?))
}

fn parameterization(
    arguments: &CurveArguments,
    table: &mut PointTable,
) -> anyhow::Result<Option<Parameterization>> {
    let mut values = match (&arguments.parameters, table.abscissa.take()) {
        (_, Some(abscissa)) => abscissa,
        (Some(RuleOrFile::File(path)), None) => input::numbers(path, "--parameters")?,
        (Some(RuleOrFile::Rule(rule)), None) => {
            ensure!(
                arguments.period.is_none(),
                "--period goes with --abscissa or with parameters from a file"
            );
            return Ok(Some(match rule {
                ParameterRule::Chord => Parameterization::Chord,
                ParameterRule::Centripetal => Parameterization::Centripetal,
                ParameterRule::Uniform => Parameterization::Uniform,
                ParameterRule::ChordRatio => Parameterization::ChordRatio,
            }));
        }
        (None, None) => {
            ensure!(
                arguments.period.is_none(),
                "--period goes with --abscissa or with parameters from a file"
            );
            return Ok(None);
        }
    };
    if let Some(period) = arguments.period {
        let Some(&first) = values.first() else { bail!("there are no parameters") };
        let closing = first + period;
        let beyond = values.last().is_some_and(|&last| last < closing);
        ensure!(
            period.is_finite() && beyond,
            "--period {period} is too short: the parameters run from {first} to {}",
            values[values.len() - 1]
        );
        values.push(closing);
    } else if arguments.closed && values.len() == table.rows() {
        let dimension = table.dimension();
        let last = table.coordinates.len().saturating_sub(dimension);
        ensure!(
            table.coordinates[..dimension] == table.coordinates[last..],
            "a closed curve needs to know at which parameter it returns to its first point: repeat \
             the first point at the end, with that parameter, or give --period"
        );
    }
    Ok(Some(Parameterization::Given(values)))
}

fn knot_placement(choice: &RuleOrFile<KnotRule>) -> anyhow::Result<KnotPlacement> {
    Ok(match choice {
        RuleOrFile::Rule(KnotRule::Averaged) => KnotPlacement::Averaged,
        RuleOrFile::Rule(KnotRule::NotAKnot) => KnotPlacement::NotAKnot,
        RuleOrFile::Rule(KnotRule::AtData) => KnotPlacement::AtData,
        RuleOrFile::Rule(KnotRule::Uniform) => KnotPlacement::Uniform,
        RuleOrFile::File(path) => KnotPlacement::Given(input::numbers(path, "--knots")?),
    })
}

/// Sorts rows by abscissa; rows of equal abscissa keep their order.
fn sort_by_abscissa(table: &mut PointTable) {
    let Some(abscissa) = &table.abscissa else { return };
    let mut order: Vec<usize> = (0..abscissa.len()).collect();
    order.sort_by(|&a, &b| abscissa[a].total_cmp(&abscissa[b]));
    let moved = order.iter().enumerate().filter(|(new, old)| new != *old).count();
    let dimension = table.dimension();
    table.coordinates = order
        .iter()
        .flat_map(|&row| table.coordinates[row * dimension..][..dimension].to_vec())
        .collect();
    table.abscissa = Some(order.iter().map(|&row| abscissa[row]).collect());
    if let Some(lines) = &mut table.row_lines {
        *lines = order.iter().map(|&row| lines[row]).collect();
    }
    table.notes.push(format!("rows sorted by abscissa; {moved} of {} moved", order.len()));
}
