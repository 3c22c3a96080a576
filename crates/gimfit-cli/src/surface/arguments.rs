//! What can be typed after `gimfit surface`. Choices for the two directions are given as one, for
//! both, or as two with a comma between: u (rows), then v (columns).

use super::approximation::SurfaceApproximationArguments;
use super::edit::GridMove;
use crate::arguments::{BasisChoice, IterationArguments, KnotRule, RuleOrFile, WritingArguments};
use clap::{Args, ValueEnum};
use gimfit_io::grids::{GridFormatChoice, parse_shape};
use gimfit_io::points::{ColumnChoice, DecimalMark, Delimiter, UnknownChoice};
use std::path::PathBuf;
use std::str::FromStr;

#[derive(Debug, Args)]
#[command(
    after_help = "Exit status: 0 done; 1 a residual was not reached (the best fit is written \
all the same); 2 wrong usage or input, nothing written; 130 interrupted before there was a fit.

Examples:
  gimfit surface heights.csv -o heights.svg
  gimfit surface hull.csv --degree 3,2 --parameters centripetal -o hull.json -o hull.png
  gimfit surface torus.csv --closed both --method pia --keep 0,3,15 -o torus.json
  gimfit surface peaks.csv --knots at-data --per-direction
  gimfit surface heights.csv --move 8,5=4,7,120.5 -o edited.json
  gimfit surface hull.csv --tolerance 0.01 -o hull.json
  gimfit surface hull.csv --method least-squares --control-points 12x20 -o hull.json"
)]
pub(crate) struct SurfaceArguments {
    #[command(flatten)]
    pub(crate) grid: GridArguments,

    /// Only to say why there is none
    #[arg(
        long,
        hide = true,
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "",
        value_name = "WAY"
    )]
    pub(crate) convex: Option<String>,

    #[command(flatten)]
    pub(crate) approximation: SurfaceApproximationArguments,

    #[command(flatten)]
    pub(crate) iteration: IterationArguments,

    /// Run the columns to their limit, then the rows, instead of both in every step, with the
    /// iterations allowed in each; --weight may then give two with a comma between, and a file one
    /// number per row for u, one per column for v
    #[arg(long, help_heading = "Iteration")]
    pub(crate) per_direction: bool,

    /// With a method of least squares: start open directions at the first and end them at the last row
    /// or column
    #[arg(long, help_heading = "Least squares")]
    pub(crate) hold_ends: bool,

    /// Seed of random-columns and random-rows; the same seed draws the same [default: 0]
    #[arg(long, value_name = "N", help_heading = "Least squares")]
    pub(crate) seed: Option<u64>,

    /// Move a point of the grid after the fit, such as 8,5=1,2,0.5: only control points nearby move.
    /// May be given several times
    #[arg(
        long = "move",
        value_name = "ROW,COLUMN=X,Y,...",
        value_parser = GridMove::read,
        help_heading = "Edits"
    )]
    pub(crate) moves: Vec<GridMove>,

    #[command(flatten)]
    pub(crate) writing: WritingArguments,

    /// Samples in u and v written to .csv files instead of control points, such as 100x80
    #[arg(long, value_name = "MxN", value_parser = parse_shape, help_heading = "Writing")]
    pub(crate) samples: Option<(usize, usize)>,
}

/// A grid, and what decides its collocation matrices: the same for a fit and a diagnosis.
#[derive(Debug, Args)]
pub(crate) struct GridArguments {
    /// File of points in rows and columns: lines of row,column,x,y,z or u,v,x,y,z, a matrix of
    /// heights, an ESRI ASCII grid, NumPy .npy; - for standard input
    #[arg(value_name = "GRID")]
    pub(crate) file: PathBuf,

    /// Rows and columns of a file that does not tell them, such as 20x30
    #[arg(long, value_name = "MxN", value_parser = parse_shape, help_heading = "Reading")]
    pub(crate) shape: Option<(usize, usize)>,

    /// Columns of the file to take as coordinates, by name or by number from 1
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = "Reading")]
    pub(crate) columns: Vec<ColumnChoice>,

    /// The two columns of the file that number, or parametrize, rows and columns of the grid
    #[arg(long, value_name = "ROW,COLUMN", value_delimiter = ',', help_heading = "Reading")]
    pub(crate) index_columns: Vec<ColumnChoice>,

    /// Whether the first row and column of a matrix are abscissae rather than heights
    #[arg(long, value_name = "yes|no", value_parser = yes_or_no, help_heading = "Reading")]
    pub(crate) axes: Option<bool>,

    /// Format of the file, where its ending and its content mislead: lines, matrix, esri, npy
    #[arg(long, value_name = "FORMAT", help_heading = "Reading")]
    pub(crate) format: Option<GridFormatChoice>,

    /// What separates the cells of a text file (comma, semicolon, tab, blanks)
    #[arg(long, value_name = "SEPARATOR", help_heading = "Reading")]
    pub(crate) delimiter: Option<Delimiter>,

    /// Decimal mark of a text file: point or comma
    #[arg(long, value_name = "MARK", help_heading = "Reading")]
    pub(crate) decimal: Option<DecimalMark>,

    /// Degree, or degrees in u and v [default: 3; with other bases than b-spline one less than the
    /// rows and columns]
    #[arg(long, value_name = "P[,Q]", help_heading = "Surface")]
    pub(crate) degree: Option<Pair<usize>>,

    /// Basis, or bases in u and v: b-spline, bernstein, wang-ball (not totally positive), said-ball,
    /// dp. All but b-spline take one function per row and column, up to 26, and uniform parameters
    /// by default
    #[arg(
        long,
        default_value = "b-spline",
        value_name = "BASIS[,BASIS]",
        help_heading = "Surface"
    )]
    pub(crate) basis: Pair<BasisChoice>,

    /// Direction in which the surface closes smoothly
    #[arg(
        long,
        value_enum,
        default_value = "none",
        value_name = "DIRECTION",
        help_heading = "Surface"
    )]
    pub(crate) closed: ClosedChoice,

    /// Parameters: chord (lengths averaged over the grid), centripetal, uniform, axes (the
    /// abscissae of the file), or a file of numbers, one per row or column and for a closed
    /// direction one more [default: chord]
    #[arg(long, value_name = "RULE|FILE[,RULE|FILE]", help_heading = "Surface")]
    pub(crate) parameters: Option<Pair<RuleOrFile<GridParameterRule>>>,

    /// Knots: averaged, not-a-knot (odd degrees), at-data (odd degrees; tied ends), uniform, or a
    /// file of numbers [default: averaged]
    #[arg(long, value_name = "RULE|FILE[,RULE|FILE]", help_heading = "Surface")]
    pub(crate) knots: Option<Pair<RuleOrFile<KnotRule>>>,

    /// File of positive weights, one per point, row by row, that make the surface rational (NURBS); only their
    /// ratios count
    #[arg(long, value_name = "FILE", help_heading = "Surface")]
    pub(crate) rational_weights: Option<PathBuf>,
}

fn yes_or_no(text: &str) -> Result<bool, UnknownChoice> {
    match text {
        "yes" => Ok(true),
        "no" => Ok(false),
        _ => Err(UnknownChoice { given: text.into(), wanted: "yes or no" }),
    }
}

/// Directions that close.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ClosedChoice {
    None,
    U,
    V,
    Both,
}

impl ClosedChoice {
    /// For u and for v.
    pub(crate) fn each(self) -> [bool; 2] {
        [matches!(self, Self::U | Self::Both), matches!(self, Self::V | Self::Both)]
    }
}

/// Rules for the parameters of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum GridParameterRule {
    Chord,
    Centripetal,
    Uniform,
    Axes,
}

/// A choice for u and one for v.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pair<T>(pub(crate) [T; 2]);

impl<T: OneChoice> FromStr for Pair<T> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let each: Result<Vec<T>, String> = text.split(',').map(|one| T::read(one.trim())).collect();
        match each?.as_slice() {
            [both] => Ok(Self([both.clone(), both.clone()])),
            [u, v] => Ok(Self([u.clone(), v.clone()])),
            _ => Err("give one value for both directions, or two with a comma between".into()),
        }
    }
}

/// What can stand in a [`Pair`].
pub(crate) trait OneChoice: Clone {
    fn read(text: &str) -> Result<Self, String>;
}

impl OneChoice for usize {
    fn read(text: &str) -> Result<Self, String> {
        text.parse().map_err(|_| format!("\"{text}\" is not a whole number"))
    }
}

impl<R: ValueEnum> OneChoice for RuleOrFile<R> {
    /// A word that is no rule is a file.
    fn read(text: &str) -> Result<Self, String> {
        if text.is_empty() {
            return Err(format!("a rule is missing; the rules are {}", Self::names().join(", ")));
        }
        text.parse().map_err(|never| match never {})
    }
}

impl OneChoice for BasisChoice {
    fn read(text: &str) -> Result<Self, String> {
        Self::from_str(text, false).map_err(|_| {
            let values = Self::value_variants().iter().filter_map(ValueEnum::to_possible_value);
            let known: Vec<String> = values.map(|value| value.get_name().to_owned()).collect();
            format!("\"{text}\" is no basis; the bases are {}", known.join(", "))
        })
    }
}
