//! What can be typed, as clap reads it. Values that mean one of several things, such as a rule or a
//! file, are told apart here.

use crate::choose::{ChooseArguments, ChooseGridArguments};
use crate::curve::edit::EditArguments;
use crate::curve::{ApproximationArguments, LeastSquaresArguments};
use crate::diagnose::{DiagnoseArguments, DiagnoseGridArguments};
use crate::evaluate::SampleCount;
use crate::routes::{GRID_CHOICES, GRID_DIAGNOSIS};
use crate::surface::SurfaceArguments;
use crate::triangle::TriangleArguments;
use crate::values;
use clap::{Args, Parser, Subcommand, ValueEnum};
use gimfit::Duplicates;
use gimfit_io::grids::parse_shape;
use gimfit_io::points::{ColumnChoice, DecimalMark, Delimiter, FormatChoice, PartChoice};
use std::convert::Infallible;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::str::FromStr;

/// Fits smooth B-spline curves to measured points by geometric iteration: control points start at
/// the data and move by the difference between the data and the curve until the curve passes
/// through them.
#[derive(Debug, Parser)]
#[command(name = "gimfit", version, propagate_version = true, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Fit a curve through the points of a file
    Curve(Box<CurveArguments>),
    /// Move, insert and remove single points of a fitted curve, without a fit of all points
    Edit(Box<EditArguments>),
    /// Fit a surface through the points of a grid
    Surface(Box<SurfaceArguments>),
    /// Fit a triangular patch through a triangular array of points
    Triangle(Box<TriangleArguments>),
    /// Tell how a fit would go, before any run: spectrum, steps of each method, what is to blame
    Diagnose(Box<DiagnoseArguments>),
    /// Tell how a fit of a grid would go, before any run
    #[command(name = GRID_DIAGNOSIS, override_usage = "gimfit diagnose --grid [OPTIONS] <GRID>", hide = true)]
    DiagnoseGrid(Box<DiagnoseGridArguments>),
    /// List fits from few control points to many, each with its error, to choose from
    Choose(Box<ChooseArguments>),
    /// List fits of a grid from few control points to many
    #[command(name = GRID_CHOICES, override_usage = "gimfit choose --grid [OPTIONS] <GRID>", hide = true)]
    ChooseGrid(Box<ChooseGridArguments>),
    /// Sample a fitted curve, surface or triangular patch
    Evaluate(EvaluateArguments),
    /// Find the nearest points of a fitted curve or surface
    Project(Box<ProjectArguments>),
    /// Tell what a file holds
    Info(InfoArguments),
    /// Recompute published tables and show them beside the paper
    Reproduce(ReproduceArguments),
    /// Print a completion script for a shell
    Completions(CompletionsArguments),
    /// Write the manual pages
    Manual(ManualArguments),
}

/// How points are read.
#[derive(Debug, Args)]
pub(crate) struct InputArguments {
    /// File of points: CSV, TSV, plain text, XYZ, airfoil .dat, GPX, NumPy .npy; - for standard
    /// input
    #[arg(value_name = "POINTS")]
    pub(crate) points: PathBuf,

    /// Columns to take as coordinates, by name or by number from 1, such as x,y or 2,3
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = "Reading")]
    pub(crate) columns: Vec<ColumnChoice>,

    /// Column that holds the parameter of each point, by name or number
    #[arg(long, value_name = "COLUMN", help_heading = "Reading")]
    pub(crate) abscissa: Option<ColumnChoice>,

    /// What separates the cells of a text file, where it cannot be told from the content
    /// (comma, semicolon, tab, blanks)
    #[arg(long, value_name = "SEPARATOR", help_heading = "Reading")]
    pub(crate) delimiter: Option<Delimiter>,

    /// Decimal mark of a text file, where it cannot be told from the content: point or comma
    #[arg(long, value_name = "MARK", help_heading = "Reading")]
    pub(crate) decimal: Option<DecimalMark>,

    /// Format of the file, where its ending and its content mislead: text, csv, tsv, xyz, airfoil,
    /// gpx, npy
    #[arg(long, value_name = "FORMAT", help_heading = "Reading")]
    pub(crate) format: Option<FormatChoice>,

    /// Which piece of a file in several pieces, by number from 1, or all of them one after another
    #[arg(long, value_name = "N|all", help_heading = "Reading")]
    pub(crate) part: Option<PartChoice>,

    /// Leave out rows without a value in a column that is read (an empty cell, NaN, NA, N/A, null),
    /// rather than refuse the file
    #[arg(long, help_heading = "Reading")]
    pub(crate) skip_missing: bool,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Exit status: 0 done; 1 a residual was not reached, or the run was interrupted \
(the best fit is written all the same); 2 wrong usage or input, nothing written, or a file that \
could not be written; 130 interrupted while reading, or twice, nothing half-written is left.

Files take their names when all of them are complete.

Examples:
  gimfit curve airfoil.dat -o airfoil.svg
  gimfit curve coast.csv --closed -o coast.json -o coast.png
  gimfit curve track.gpx --columns east,north,up --method pia --keep 0,2,4,15,30 -o track.svg
  gimfit curve outline.csv --closed --convex -o outline.svg
  gimfit curve signal.csv --abscissa x -o signal.json
  gimfit curve scan.xyz --tolerance 0.05 -o scan.json
  gimfit curve scan.xyz --method least-squares --control-points 40 -o scan.json"
)]
pub(crate) struct CurveArguments {
    #[command(flatten)]
    pub(crate) input: InputArguments,

    #[command(flatten)]
    pub(crate) shape: ShapeArguments,

    /// Keep the turns of a planar data polygon, one by one: closest (the interpolant where it turns
    /// as the data do, otherwise the closest fit that does) or published (Lin, Wang and Dong 2004;
    /// may stall). Bare --convex is closest
    #[arg(
        long,
        value_enum,
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "closest",
        value_name = "WAY",
        help_heading = "Curve"
    )]
    pub(crate) convex: Option<ConvexChoice>,

    /// With --convex=published: bisect steps until no control point moves farther than this, in the
    /// unit of the points [default: 1e-12 of the extent, or what rounding allows]
    #[arg(
        long,
        value_name = "D",
        requires = "convex",
        value_parser = values::number,
        allow_negative_numbers = true,
        help_heading = "Curve"
    )]
    pub(crate) convex_threshold: Option<f64>,

    #[command(flatten)]
    pub(crate) approximation: ApproximationArguments,

    #[command(flatten)]
    pub(crate) least_squares: LeastSquaresArguments,

    #[command(flatten)]
    pub(crate) iteration: IterationArguments,

    #[command(flatten)]
    pub(crate) writing: WritingArguments,

    /// Samples written to .csv files instead of control points
    #[arg(long, value_name = "N", value_parser = values::samples, help_heading = "Writing")]
    pub(crate) samples: Option<usize>,
}

/// What decides the collocation matrix of a curve: the same for a fit and a diagnosis.
#[derive(Debug, Args)]
pub(crate) struct ShapeArguments {
    /// Degree of the curve [default: 3; with another basis than b-spline, and with bezier knots, one
    /// less than the points]
    #[arg(long, value_name = "P", help_heading = "Curve")]
    pub(crate) degree: Option<usize>,

    /// Basis of the curve. All but b-spline take one function per point, up to 26 points, and
    /// uniform parameters by default
    #[arg(
        long,
        value_enum,
        default_value = "b-spline",
        value_name = "BASIS",
        help_heading = "Curve"
    )]
    pub(crate) basis: BasisChoice,

    /// Close the curve smoothly; the first point may be repeated at the end or not
    #[arg(long, help_heading = "Curve")]
    pub(crate) closed: bool,

    /// Parameters of the points: chord, centripetal, uniform, chord-ratio (closed quadratic curves)
    /// or a file of numbers [default: chord; uniform for values of dimension 1]
    #[arg(long, value_name = "RULE|FILE", help_heading = "Curve")]
    pub(crate) parameters: Option<RuleOrFile<ParameterRule>>,

    /// Period of a closed curve over an abscissa, or over parameters from a file, where the point
    /// at which it closes is not listed
    #[arg(
        long,
        value_name = "T",
        requires = "closed",
        value_parser = values::number,
        allow_negative_numbers = true,
        help_heading = "Curve"
    )]
    pub(crate) period: Option<f64>,

    /// Knots: averaged, not-a-knot (odd degrees), at-data (odd degrees; tied ends), uniform, bezier
    /// (none inside, degree one less than the points), or a file of numbers [default: averaged]
    #[arg(long, value_name = "RULE|FILE", help_heading = "Curve")]
    pub(crate) knots: Option<RuleOrFile<KnotRule>>,

    /// File of positive weights, one per point, that make the curve rational (NURBS); only their
    /// ratios count
    #[arg(long, value_name = "FILE", help_heading = "Curve")]
    pub(crate) rational_weights: Option<PathBuf>,

    /// What to do with points that repeat their predecessor
    #[arg(
        long,
        value_enum,
        default_value = "error",
        value_name = "POLICY",
        help_heading = "Curve"
    )]
    pub(crate) duplicates: DuplicatesChoice,

    /// Sort the points by their abscissa first
    #[arg(long, requires = "abscissa", help_heading = "Curve")]
    pub(crate) sort: bool,
}

/// The rule that runs and when it stops, for curves and surfaces.
#[derive(Debug, Args)]
pub(crate) struct IterationArguments {
    /// Rule that moves the control points
    #[arg(
        long,
        value_enum,
        default_value = "auto",
        value_name = "METHOD",
        help_heading = "Iteration"
    )]
    pub(crate) method: MethodChoice,

    /// Weight for weighted and sor: auto (the best one), a number between 0 and 2, or for weighted
    /// lemma2 (converges where eigenvalues are complex) or a file of one number per point, of a grid
    /// row by row. For lspia, column-sums and sor-lspia auto or a number; for lspia, column-sums,
    /// mlspia and nesterov published
    #[arg(
        long,
        default_value = "auto",
        value_name = "W|auto|published|lemma2|FILE",
        allow_negative_numbers = true,
        help_heading = "Iteration"
    )]
    pub(crate) weight: String,

    /// Half bandwidth kept by the preconditioned method [default: the whole band]
    #[arg(long, value_name = "Q", help_heading = "Iteration")]
    pub(crate) bandwidth: Option<usize>,

    /// Steps remembered by the anderson method [default: 10; on dense bases 40; at
    /// most the points, on dense bases twice as many]
    #[arg(long, value_name = "Q", help_heading = "Iteration")]
    pub(crate) memory: Option<usize>,

    /// Where the geometric method looks for the first foot points: near the parameters assigned
    /// (last), or on the whole curve or surface (global) [default: last]
    #[arg(long, value_enum, value_name = "START", help_heading = "Iteration")]
    pub(crate) foot_points: Option<FootPointStart>,

    /// Smallest eigenvalue of the collocation matrix, between 0 and 1, with which the geometric method
    /// goes on moving foot points [default: 1e-3, or a tenth of that at the parameters assigned]
    #[arg(
        long,
        value_name = "ALPHA",
        value_parser = values::number,
        allow_negative_numbers = true,
        help_heading = "Iteration"
    )]
    pub(crate) least_eigenvalue: Option<f64>,

    /// Points whose control points move, counted from 1; the others stay where they start. Of a curve
    /// such as 10-20,35; of a grid rows and columns in turns, such as 3-10,5-20 for a window, or
    /// 3-10,5-20,7,8 for the same and one point
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = values::positions, help_heading = "Iteration")]
    pub(crate) only: Vec<RangeInclusive<usize>>,

    /// Most iterations
    #[arg(long, default_value_t = 1000, value_name = "N", help_heading = "Iteration")]
    pub(crate) iterations: usize,

    /// Largest residual to reach, in the unit of the points; 0 runs all iterations [default: 1e-12
    /// of the extent, or what rounding allows]
    #[arg(
        long,
        value_name = "T",
        value_parser = values::number,
        allow_negative_numbers = true,
        help_heading = "Iteration"
    )]
    pub(crate) residual: Option<f64>,

    /// Iterations whose fits are kept, such as 0,2,4,15,30
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = "Iteration")]
    pub(crate) keep: Vec<usize>,
}

impl IterationArguments {
    /// The method as typed.
    pub(crate) fn method_name(&self) -> String {
        let value = self.method.to_possible_value();
        value.map(|value| value.get_name().to_owned()).unwrap_or_default()
    }
}

/// What is written and printed, for curves and surfaces.
#[derive(Debug, Args)]
pub(crate) struct WritingArguments {
    /// File to write; by its ending a document (.json), control points or samples (.csv), or a
    /// picture (.svg, .png). May be given several times; - writes the document to standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    pub(crate) output: Vec<PathBuf>,

    /// File for the report: .json, otherwise text; - for text on standard output
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    pub(crate) report: Option<PathBuf>,

    /// Print nothing but errors and warnings
    #[arg(long, short, help_heading = "Writing")]
    pub(crate) quiet: bool,

    /// Print the document instead of the report, without the geometry
    #[arg(long, help_heading = "Writing")]
    pub(crate) json: bool,

    /// With --json: print geometry, parameters and kept fits too
    #[arg(long, requires = "json", help_heading = "Writing")]
    pub(crate) geometry: bool,
}

/// A named rule, or a file that gives the numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum RuleOrFile<R> {
    Rule(R),
    File(PathBuf),
}

impl<R: ValueEnum> RuleOrFile<R> {
    /// The names of all rules.
    pub(crate) fn names() -> Vec<String> {
        let values = R::value_variants().iter().filter_map(ValueEnum::to_possible_value);
        values.map(|value| value.get_name().to_owned()).collect()
    }
}

impl<R: ValueEnum> FromStr for RuleOrFile<R> {
    type Err = Infallible;

    /// A rule's name is that rule; write ./chord for a file called so.
    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(R::from_str(text, false).map_or_else(|_| Self::File(text.into()), Self::Rule))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ParameterRule {
    Chord,
    Centripetal,
    Uniform,
    ChordRatio,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum KnotRule {
    Averaged,
    NotAKnot,
    AtData,
    Uniform,
    Bezier,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum BasisChoice {
    BSpline,
    /// Bezier curves and surfaces
    Bernstein,
    /// Not totally positive
    WangBall,
    SaidBall,
    /// Of Delgado and Pena
    Dp,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum DuplicatesChoice {
    /// Refuse the data, naming the rows
    Error,
    /// Keep the first of each run
    Drop,
    /// Replace each run by its mean
    Merge,
}

/// Ways to keep the turns of the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ConvexChoice {
    /// The interpolant if it turns as the data do, otherwise the closest fit that does
    Closest,
    /// Steps of the method, cut so that no turn changes
    Published,
}

impl From<DuplicatesChoice> for Duplicates {
    fn from(choice: DuplicatesChoice) -> Self {
        match choice {
            DuplicatesChoice::Error => Self::Error,
            DuplicatesChoice::Drop => Self::Drop,
            DuplicatesChoice::Merge => Self::Merge,
        }
    }
}

/// Where the first foot points are looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FootPointStart {
    /// From the parameters assigned
    Last,
    /// On the whole curve or surface
    Global,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodChoice {
    /// Rounding level quickly on any spacing
    Auto,
    /// Plain progressive-iterative approximation
    Pia,
    /// Difference vectors times a weight
    Weighted,
    /// Difference vectors over the diagonal
    Jacobi,
    /// Each control point sees those moved before
    GaussSeidel,
    /// Gauss-Seidel, over-relaxed
    Sor,
    /// Three-term recurrence
    Chebyshev,
    /// Combines the last few steps so that they leave least
    Anderson,
    /// Preconditioned by the band
    Preconditioned,
    /// Plain steps from the foot points of the data, in place of fixed parameters
    Geometric,
    /// Plain, of the points of --only alone
    Local,
    /// Plain, but points that are done no longer move
    Adaptive,
    /// Least squares, quickly, whatever the data; with --control-points or a file of knots, as all
    /// that follow
    LeastSquares,
    /// Least squares: transposed matrix times difference vectors, times a weight
    Lspia,
    /// Least squares: LSPIA with reciprocal column sums as weights
    ColumnSums,
    /// Least squares: each control point sees those moved before
    GsLspia,
    /// Least squares: the same, over-relaxed
    SorLspia,
    /// Least squares: heavy ball, LSPIA with memory
    Mlspia,
    /// Least squares: Nesterov's acceleration, with restarts
    Nesterov,
    /// Least squares: three-term recurrence
    ChebyshevLspia,
    /// Least squares: steps from the last two gradients
    Salspia,
    /// Least squares: single control points in random order
    RandomColumns,
    /// Least squares: single data points in random order
    RandomRows,
    /// Near least squares: means over the data points of each control point
    Epia,
    /// Least squares: conjugate gradients
    Cgls,
    /// Least squares: conjugate gradients, preconditioned by the diagonal
    Pcg,
}

#[derive(Debug, Args)]
#[command(after_help = "Exit status: 0 done; 2 wrong usage or input, or a file that could not be \
written; 130 interrupted, nothing half-written is left.")]
#[command(group(clap::ArgGroup::new("where").required(true).args(["samples", "at"])))]
pub(crate) struct EvaluateArguments {
    /// Document of a fitted curve, surface or triangular patch (.json); - for standard input
    #[arg(value_name = "FILE")]
    pub(crate) document: PathBuf,

    /// Number of samples at equal steps of the parameter, ends included; for a surface one in u and
    /// one in v, such as 100x80; of a triangular patch along each edge
    #[arg(long, value_name = "N|MxN", value_parser = values::sample_count)]
    pub(crate) samples: Option<SampleCount>,

    /// File of parameters to evaluate at, for a surface or a triangular patch of pairs u,v; - for
    /// standard input. Where the shape is closed they may lie beyond the domain
    #[arg(long, value_name = "FILE")]
    pub(crate) at: Option<PathBuf>,

    /// Derivatives to add, up to this order; for a surface all partial ones
    #[arg(long, default_value_t = 0, value_name = "K", value_parser = values::derivatives)]
    pub(crate) derivatives: usize,

    /// Evaluate the fit kept at this iteration instead of the final one
    #[arg(long, value_name = "N")]
    pub(crate) iteration: Option<usize>,

    /// File to write, .csv or .json; - for CSV on standard output [default: -]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(after_help = "Exit status: 0 done; 2 wrong usage or input, or a file that could not be \
written; 130 interrupted, nothing half-written is left.

Examples:
  gimfit project fit.json measured.csv
  gimfit project fit.json measured.csv --columns x,y -o feet.csv")]
pub(crate) struct ProjectArguments {
    /// Document of a fitted curve or surface (.json); - for standard input
    #[arg(value_name = "FIT")]
    pub(crate) document: PathBuf,

    #[command(flatten)]
    pub(crate) input: InputArguments,

    /// Project onto the fit kept at this iteration instead of the final one
    #[arg(long, value_name = "N")]
    pub(crate) iteration: Option<usize>,

    /// File for the foot points, .csv or .json; - for CSV on standard output in place of the report
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    pub(crate) output: Option<PathBuf>,

    /// Print the report as JSON
    #[arg(long, help_heading = "Writing")]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArguments {
    #[command(flatten)]
    pub(crate) input: InputArguments,

    /// Read the file as a grid, as gimfit surface does; without it, files that say they are grids
    /// are told by themselves
    #[arg(long, conflicts_with_all = ["abscissa", "part"], help_heading = "Reading")]
    pub(crate) grid: bool,

    /// Rows and columns of a grid that does not tell them, such as 20x30
    #[arg(
        long,
        value_name = "MxN",
        requires = "grid",
        value_parser = parse_shape,
        help_heading = "Reading"
    )]
    pub(crate) shape: Option<(usize, usize)>,

    /// Print as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ReproduceArguments {
    /// Tables to recompute, such as wang2007; all if none is named
    #[arg(value_name = "TABLE")]
    pub(crate) tables: Vec<String>,

    /// List the tables
    #[arg(long)]
    pub(crate) list: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompletionsArguments {
    /// Shell
    #[arg(value_enum)]
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct ManualArguments {
    /// Folder for the pages, one per command
    #[arg(value_name = "FOLDER")]
    pub(crate) folder: PathBuf,
}
