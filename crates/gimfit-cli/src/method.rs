//! Methods and their weights, as the arguments of curves and surfaces give them.

use crate::arguments::{FootPointStart, IterationArguments, MethodChoice};
use crate::{input, values};
use anyhow::{anyhow, bail, ensure};
use gimfit::{IterationWeight, Method};
use std::ops::{Range, RangeInclusive};
use std::path::Path;

/// The method of `--method`, `--bandwidth`, `--memory` and `--foot-points`.
pub(crate) fn method(arguments: &IterationArguments, of_triangle: bool) -> anyhow::Result<Method> {
    let IterationArguments { method: choice, bandwidth, memory, foot_points, .. } = *arguments;
    check_owners(arguments)?;
    ensure!(
        arguments.only.is_empty() || !of_triangle,
        "--only is for curves and grids: of a triangle all points take part"
    );
    ensure!(
        !of_triangle || choice != MethodChoice::Local,
        "--method local is for curves and grids: of a triangle all points take part"
    );
    Ok(match choice {
        MethodChoice::Auto => Method::Auto,
        MethodChoice::Pia => Method::Pia,
        MethodChoice::Weighted => Method::Weighted,
        MethodChoice::Jacobi => Method::Jacobi,
        MethodChoice::GaussSeidel => Method::GaussSeidel,
        MethodChoice::Sor => Method::Sor,
        MethodChoice::Chebyshev => Method::Chebyshev,
        MethodChoice::Anderson => Method::Anderson { memory },
        MethodChoice::Geometric => {
            Method::Geometric { global_start: foot_points == Some(FootPointStart::Global) }
        }
        MethodChoice::Preconditioned => Method::Preconditioned { half_bandwidth: bandwidth },
        MethodChoice::Local => Method::Local,
        MethodChoice::Adaptive => Method::Adaptive,
        MethodChoice::LeastSquares
        | MethodChoice::Lspia
        | MethodChoice::ColumnSums
        | MethodChoice::GsLspia
        | MethodChoice::SorLspia
        | MethodChoice::Mlspia
        | MethodChoice::Nesterov
        | MethodChoice::ChebyshevLspia
        | MethodChoice::Salspia
        | MethodChoice::RandomColumns
        | MethodChoice::RandomRows
        | MethodChoice::Epia
        | MethodChoice::Cgls
        | MethodChoice::Pcg => bail!(
            "--method {} is for curves and grids with fewer control points than points",
            arguments.method_name()
        ),
    })
}

/// Refuses what belongs to other methods.
pub(crate) fn check_owners(arguments: &IterationArguments) -> anyhow::Result<()> {
    let IterationArguments { method: choice, bandwidth, memory, foot_points, .. } = *arguments;
    ensure!(
        foot_points.is_none() || choice == MethodChoice::Geometric,
        "--foot-points belongs to --method geometric"
    );
    let alpha = arguments.least_eigenvalue;
    ensure!(
        alpha.is_none() || choice == MethodChoice::Geometric,
        "--least-eigenvalue belongs to --method geometric"
    );
    ensure!(
        alpha.is_none_or(|alpha| alpha > 0.0 && alpha < 1.0),
        "--least-eigenvalue must lie between 0 and 1, as the eigenvalues do"
    );
    ensure!(
        memory.is_none() || choice == MethodChoice::Anderson,
        "--memory belongs to --method anderson"
    );
    ensure!(
        bandwidth.is_none() || choice == MethodChoice::Preconditioned,
        "--bandwidth belongs to --method preconditioned"
    );
    Ok(())
}

/// The points of `--only`, from 0, of a file of `points` points.
pub(crate) fn only(
    arguments: &IterationArguments,
    points: usize,
    source: &str,
) -> anyhow::Result<Option<Vec<usize>>> {
    let ranges = &arguments.only;
    if ranges.is_empty() {
        ensure!(
            arguments.method != MethodChoice::Local,
            "--method local needs --only, the points whose control points are to move"
        );
        return Ok(None);
    }
    if let Some(beyond) = ranges.iter().map(RangeInclusive::end).find(|&&last| last > points) {
        bail!("{source}: --only names point {beyond}, but there are {points} points");
    }
    Ok(Some(ranges.iter().flat_map(|range| range.start() - 1..*range.end()).collect()))
}

/// The windows of `--only`, from 0, of a grid of a shape: rows and columns in turns.
pub(crate) fn only_windows(
    arguments: &IterationArguments,
    shape: [usize; 2],
    source: &str,
) -> anyhow::Result<Option<Vec<[Range<usize>; 2]>>> {
    let ranges = &arguments.only;
    if ranges.is_empty() {
        ensure!(
            arguments.method != MethodChoice::Local,
            "--method local needs --only, the points whose control points are to move"
        );
        return Ok(None);
    }
    ensure!(
        ranges.len().is_multiple_of(2),
        "--only takes rows and columns of a grid in turns, such as 3-10,5-20 for a window, or \
         3-10,5-20,7,8 for the same and a point; the last rows come without columns"
    );
    let windows = ranges.chunks_exact(2).map(|pair| {
        for (k, range) in pair.iter().enumerate() {
            let (what, count) = (["row", "column"][k], shape[k]);
            ensure!(
                *range.end() <= count,
                "{source}: --only names {what} {}, but there are {count} {what}s",
                range.end()
            );
        }
        Ok([pair[0].start() - 1..*pair[0].end(), pair[1].start() - 1..*pair[1].end()])
    });
    windows.collect::<anyhow::Result<_>>().map(Some)
}

/// The weight of `--weight`: auto, lemma2, a number, or a file.
pub(crate) fn weight(text: &str) -> anyhow::Result<IterationWeight> {
    match text {
        "published" => bail!(
            "--weight published belongs to methods of least squares: lspia, column-sums, mlspia, \
             nesterov"
        ),
        "auto" => return Ok(IterationWeight::Auto),
        "lemma2" => return Ok(IterationWeight::Lemma2),
        _ => {}
    }
    if let Some(path) = weight_file(text) {
        let words = ["auto".into(), "lemma2".into(), "a number".into()];
        return Ok(IterationWeight::PerPoint(input::numbers(path, "--weight", &words)?));
    }
    let omega = values::number(text).map_err(|error| anyhow!("--weight {text}: {error}"))?;
    Ok(IterationWeight::Same(omega))
}

/// The file of weights that `--weight` names, if it is none of its words.
pub(crate) fn weight_file(text: &str) -> Option<&Path> {
    (!matches!(text, "auto" | "lemma2" | "published") && text.parse::<f64>().is_err())
        .then(|| Path::new(text))
}

/// Most numbers in kept fits: 8 GB.
const MOST_KEPT: u128 = 1_000_000_000;

/// Refuses more kept fits than memory holds; a fit takes `numbers` coordinates.
pub(crate) fn ensure_kept_fits_fit(
    keep: &[usize],
    iterations: usize,
    numbers: usize,
    source: &str,
) -> anyhow::Result<()> {
    let mut kept = keep.to_vec();
    kept.retain(|iteration| *iteration <= iterations);
    kept.sort_unstable();
    kept.dedup();
    let wanted = kept.len() as u128 * numbers as u128;
    ensure!(
        wanted <= MOST_KEPT,
        "{source}: --keep asks for {} fits of {numbers} coordinates, {wanted} numbers; at most \
         {MOST_KEPT} are kept: list fewer iterations",
        kept.len()
    );
    Ok(())
}
