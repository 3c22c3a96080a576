//! The turn of a polygon at a corner, decided exactly.

use robust::{Coord, orient2d};

/// Which way a polygon turns at a corner: the sign of the directional angle of Lin, Wang and Dong
/// (2004), section 1.3.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// To the left, counterclockwise.
    Left,
    /// Not at all: the three points lie on a line.
    Straight,
    /// To the right, clockwise.
    Right,
}

impl Turn {
    /// 1 for a left turn, -1 for a right one, 0 for none.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Straight => 0.0,
            Self::Right => -1.0,
        }
    }

    /// The turn of this sign.
    pub(crate) fn of(value: f64) -> Self {
        if value > 0.0 {
            Self::Left
        } else if value < 0.0 {
            Self::Right
        } else {
            Self::Straight
        }
    }
}

/// The turn at `b` on the way from `a` over `b` to `c`, for coordinates as they are: no rounding
/// decides it (Shewchuk 1997), unless products of their differences leave the range of doubles.
#[must_use]
pub fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Turn {
    Turn::of(cross(a, b, c))
}

/// The turn, where it exceeds what rounding the coordinates to doubles may have made of a straight
/// corner: decimal numbers on a line are seldom so as doubles.
pub(crate) fn turn_beyond_rounding(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Turn {
    let size = [a, b, c].as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let leg = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).abs() + (b[1] - a[1]).abs();
    let area = cross(a, b, c);
    // Each coordinate is off by half a unit in the last place, so each leg by one.
    let noise = f64::EPSILON * size * (leg(a, b) + leg(b, c));
    if area.abs() <= noise { Turn::Straight } else { Turn::of(area) }
}

/// The cross product of the legs `b - a` and `c - b`, with the sign of the exact one.
pub(crate) fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let coord = |[x, y]: [f64; 2]| Coord { x, y };
    orient2d(coord(a), coord(b), coord(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_in_the_last_place_decides() {
        let (a, c) = ([0.5, 0.5], [24.0, 24.0]);
        let up = 12.0 + 2.0 * f64::EPSILON * 4.0;
        assert_eq!(turn(a, [12.0, 12.0], c), Turn::Straight);
        assert_eq!(turn(a, [12.0, up], c), Turn::Right);
        assert_eq!(turn(a, [up, 12.0], c), Turn::Left);
    }
}
