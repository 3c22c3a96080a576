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
    /// Corners of the control polygon of the curve that turn left. The interpolant that bends as the
    /// data turn may have others than they: it is the curve then that has the turns of the data, and
    /// its control polygon has them in the same order, not one by one.
    pub control_left: usize,
    /// Corners of the control polygon that turn right.
    pub control_right: usize,
    /// Knots inserted so that the control polygon shows the shape of the curve.
    pub inserted_knots: usize,
    /// Whether the control polygon turns as the data polygon does, neither folds back nor winds
    /// round, and the curve has no more inflections than the data.
    pub kept: bool,
}
