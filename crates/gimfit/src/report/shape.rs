//! The account of a shape that was to be kept.

/// The turns of the data polygon, and whether the control polygon has them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShapeReport {
    /// Corners of the data polygon that turn left.
    pub left: usize,
    /// Corners that turn right.
    pub right: usize,
    /// Corners that do not turn; each takes the side of its neighbours.
    pub straight: usize,
    /// Knots inserted so that the control polygon shows the shape of the curve.
    pub inserted_knots: usize,
    /// Whether the control polygon turns as the data polygon does; over inserted knots: in the same
    /// order.
    pub kept: bool,
}
