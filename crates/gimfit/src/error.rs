//! What can be wrong with a request: one variant per broken precondition.
//!
//! Points are named by their position in the caller's array, counted from 0.

/// A broken precondition. Running out of iterations is not an error but a
/// [`Termination`](crate::Termination) in the report.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No points at all: `fit_curve::<&[[f64; 2]]>(&[], ..)`.
    #[error("there are no points; a curve needs at least degree + 1 = {needed}")]
    NoPoints {
        /// Points needed.
        needed: usize,
    },
    /// Fewer points than `degree + 1`: three points and degree 3.
    #[error(
        "{points} distinct points are too few for degree {degree}, which needs at least {needed}; lower the degree or add points"
    )]
    TooFewPoints {
        /// Points left after duplicates and a repeated closing point are taken out.
        points: usize,
        /// The degree asked for.
        degree: usize,
        /// Points needed.
        needed: usize,
    },
    /// Fewer rows or columns of a grid than `degree + 1`.
    #[error("{count} {what} are too few for degree {degree} across them, which needs {needed}")]
    TooFewLines {
        /// `rows` or `columns`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// The degree asked for.
        degree: usize,
        /// How many are needed.
        needed: usize,
    },
    /// Neighbouring rows or columns of a grid that coincide, so that they would share a parameter.
    #[error(
        "{what}s {first} and {second} coincide, or nearly so against the whole grid; remove one of them"
    )]
    RepeatedLines {
        /// `row` or `column`.
        what: &'static str,
        /// Position of the first, from 0.
        first: usize,
        /// Position of the second.
        second: usize,
    },
    /// An array whose length is no multiple of the dimension, or dimension 0.
    #[error("{length} coordinates are no whole number of points of dimension {dimension}")]
    Shape {
        /// Length of the flat array.
        length: usize,
        /// Dimension of a point.
        dimension: usize,
    },
    /// NaN or an infinity in the data.
    #[error(
        "coordinate {coordinate} of point {point} is {value:?}; every coordinate must be finite"
    )]
    NotFinite {
        /// Position of the point, from 0.
        point: usize,
        /// Position of the coordinate, from 0.
        coordinate: usize,
        /// The value met.
        value: f64,
    },
    /// Coordinates so far apart that their differences overflow.
    #[error("coordinate {coordinate} spans more than the range of doubles; scale the data down")]
    ExtentOverflow {
        /// Position of the coordinate, from 0.
        coordinate: usize,
    },
    /// All points are the same point.
    #[error("all {points} points are equal; there is no curve to fit")]
    AllPointsEqual {
        /// Number of points.
        points: usize,
    },
    /// Neighbours that coincide, so that they would share one parameter.
    #[error(
        "point {second} repeats point {first} ({others} further repetitions); choose a policy for duplicates: drop or merge"
    )]
    RepeatedPoints {
        /// Position of the first of the pair.
        first: usize,
        /// Position of its repetition.
        second: usize,
        /// How many more there are.
        others: usize,
    },
    /// A point moved or inserted onto its neighbour.
    ///
    /// ```
    /// # use gimfit::{CurveOptions, EditableCurve, Error};
    /// let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0]];
    /// let mut curve = EditableCurve::new(&points, &CurveOptions::default())?;
    /// let error = curve.move_point(1, &[3.0, 3.0]).unwrap_err();
    /// assert_eq!(error, Error::MeetsNeighbour { neighbour: 2 });
    /// # Ok::<(), Error>(())
    /// ```
    #[error(
        "the point would coincide with its neighbour, point {neighbour}; give it another place, or remove one of the two"
    )]
    MeetsNeighbour {
        /// Position of the neighbour, from 0, before the edit.
        neighbour: usize,
    },
    /// Neighbours so close, against the whole length, that doubles cannot hold two parameters.
    #[error(
        "points {first} and {second} lie too close together, against the length of the whole curve, to have distinct parameters; drop one of them, or use uniform parameters"
    )]
    ParametersCollide {
        /// Position of the first of the pair.
        first: usize,
        /// Position of the second.
        second: usize,
    },
    /// Given parameters that do not increase strictly.
    #[error(
        "parameter {value:?} of point {index} does not exceed its predecessor {previous:?}; parameters must increase strictly"
    )]
    ParametersNotIncreasing {
        /// Position of the offending parameter.
        index: usize,
        /// Its value.
        value: f64,
        /// The value before.
        previous: f64,
    },
    /// A number of parameters, knots or weights that does not fit the data.
    #[error("{given} {what} given, {expected} expected: {why}")]
    WrongCount {
        /// What was counted.
        what: &'static str,
        /// How many were given.
        given: usize,
        /// How many are needed.
        expected: usize,
        /// The rule behind the number.
        why: &'static str,
    },
    /// A value outside its range: a weight of 2.5, degree 0, a negative residual.
    #[error("{what} is {}; {rule}", plain(*value))]
    OutOfRange {
        /// The option or list entry, such as `iteration weight 7`.
        what: String,
        /// The value met.
        value: f64,
        /// What is allowed.
        rule: &'static str,
    },
    /// Knots that fall, are not finite, or repeat more often than the degree allows.
    #[error("knot {index} ({value:?}) {problem}")]
    BadKnot {
        /// Position in the knot vector.
        index: usize,
        /// Its value.
        value: f64,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// The knots leave a data point without its basis function
    /// (the conditions of Schoenberg and Whitney, 1953).
    #[error(
        "the knots do not fit the parameters: basis function {point} vanishes at parameter {parameter:?} of point {point} (Schoenberg-Whitney condition); averaged knots always fit"
    )]
    SchoenbergWhitney {
        /// Position of the point.
        point: usize,
        /// Its parameter.
        parameter: f64,
    },
    /// A collocation matrix that is singular in doubles although every diagonal entry is positive.
    #[error(
        "no curve of this degree over these knots passes through the {points} points: their collocation matrix is singular in doubles; change the degree or the knots (knots at the data suit closed curves of odd degree), or use uniform or centripetal parameters"
    )]
    Singular {
        /// Number of points.
        points: usize,
    },
    /// Numbers on the way to the curve left the range of doubles.
    #[error(
        "the fit leaves the range of doubles: parameters lie too close together, or coordinates too far apart, for this degree; use uniform or centripetal parameters, or scale the data"
    )]
    LeavesDoubles,
    /// Barycentric coordinates outside the triangle of a patch.
    #[error(
        "(u, v) = ({u:?}, {v:?}) lies outside the triangle: u, v and 1 - u - v must not be negative"
    )]
    OutsideTriangle {
        /// The first barycentric coordinate.
        u: f64,
        /// The second.
        v: f64,
    },
    /// A basis that does not blend: a function that is negative or no number, or functions that do
    /// not add up to one.
    #[error(
        "the functions of the basis {basis} do not blend at parameter {parameter:?}: {problem}; they must be nonnegative and add up to 1"
    )]
    NoBlending {
        /// Name of the basis.
        basis: String,
        /// The parameter where it shows.
        parameter: f64,
        /// What is wrong there.
        problem: String,
    },
    /// A dense collocation matrix that is singular in doubles.
    #[error(
        "no control points of the basis {basis} make it pass through the {points} points: their collocation matrix is singular in doubles"
    )]
    SingularBasis {
        /// Name of the basis.
        basis: String,
        /// Number of points.
        points: usize,
    },
    /// Constraints of a least squares fit that no control points meet together.
    #[error(
        "no curve over these knots meets these constraints together (points counted from 0): {constraints}; take one of them out, or use more control points"
    )]
    ConstraintsConflict {
        /// Their positions in the order they were added, from 0.
        positions: Vec<usize>,
        /// Their names; points are counted from 0.
        constraints: String,
    },
    /// Choices that exclude each other.
    #[error("{what} cannot be used with {with}: {why}")]
    Incompatible {
        /// The one choice.
        what: &'static str,
        /// The other.
        with: &'static str,
        /// The reason, and what to do.
        why: &'static str,
    },
    /// A fit of the way that was not kept.
    ///
    /// ```
    /// # use gimfit::{CurveOptions, Error, fit_curve};
    /// let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0]];
    /// let options = CurveOptions { keep: vec![0, 2], ..Default::default() };
    /// let error = fit_curve(&points, &options)?.member(1).unwrap_err();
    /// assert_eq!(error, Error::NotKept { iteration: 1, kept: vec![0, 2] });
    /// # Ok::<(), Error>(())
    /// ```
    #[error("no fit of iteration {iteration} was kept; kept are those of {kept:?}")]
    NotKept {
        /// The iteration asked for.
        iteration: usize,
        /// Those kept.
        kept: Vec<usize>,
    },
    /// A parameter outside the curve's domain.
    #[error("parameter {parameter:?} lies outside the domain [{start:?}, {end:?}]")]
    OutsideDomain {
        /// The parameter asked for.
        parameter: f64,
        /// Start of the domain.
        start: f64,
        /// End of the domain.
        end: f64,
    },
}

impl Error {
    /// The same error where points stand for whole rows or columns of a grid.
    pub(crate) fn in_lines(self, what: &'static str) -> Self {
        match self {
            Self::RepeatedPoints { first, second, .. }
            | Self::ParametersCollide { first, second } => {
                Self::RepeatedLines { what, first, second }
            }
            other => other,
        }
    }

    /// The same error with positions of points looked up in `kept`: from points that are left to
    /// the caller's numbering.
    pub(crate) fn renumbered(self, kept: &[usize]) -> Self {
        let old = |index: usize| kept.get(index).copied().unwrap_or(index);
        match self {
            Self::RepeatedPoints { first, second, others } => {
                Self::RepeatedPoints { first: old(first), second: old(second), others }
            }
            Self::ParametersCollide { first, second } => {
                Self::ParametersCollide { first: old(first), second: old(second) }
            }
            Self::ParametersNotIncreasing { index, value, previous } => {
                Self::ParametersNotIncreasing { index: old(index), value, previous }
            }
            Self::SchoenbergWhitney { point, parameter } => {
                Self::SchoenbergWhitney { point: old(point), parameter }
            }
            other => other,
        }
    }
}

/// A value as short as it can be told: whole numbers without a point.
fn plain(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}
