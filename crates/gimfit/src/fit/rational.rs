//! Rational weights that the caller gives: which of them belong to the points fitted.

use crate::Error;
use crate::basis::check_weights;

/// The weights of the points fitted: those given, without those of points left out. They may be
/// given for all `given` points or for the fitted ones alone.
pub(super) fn fitted_weights(
    weights: Option<&[f64]>,
    given: usize,
    fitted: usize,
    kept: impl Fn(usize) -> usize,
) -> Result<Option<Vec<f64>>, Error> {
    let Some(weights) = weights else { return Ok(None) };
    if weights.len() == fitted {
        check_weights(weights, fitted)?;
        return Ok(Some(weights.to_vec()));
    }
    check_weights(weights, given)?;
    Ok(Some((0..fitted).map(|j| weights[kept(j)]).collect()))
}

/// Weights that are a product `u_i v_j`, but for rounding: then each direction is a rational curve.
pub(super) fn separate(weights: &[f64], columns: usize) -> Option<[Vec<f64>; 2]> {
    let first = &weights[..columns];
    let of_rows: Vec<f64> = weights.chunks_exact(columns).map(|row| row[0] / first[0]).collect();
    let products = of_rows.iter().flat_map(|u| first.iter().map(move |v| u * v));
    let same = weights.iter().zip(products).all(|(w, p)| (w - p).abs() <= 4.0 * f64::EPSILON * w);
    same.then(|| [of_rows, first.to_vec()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_told_from_other_weights() {
        let [u, v] = separate(&[1.0, 2.0, 3.0, 6.0], 2).unwrap();
        assert_eq!((u, v), (vec![1.0, 3.0], vec![1.0, 2.0]));
        assert!(separate(&[1.0, 2.0, 3.0, 6.1], 2).is_none());
    }

    #[test]
    fn weights_go_with_their_points() {
        let kept = [0, 2, 3];
        let weights = fitted_weights(Some(&[1.0, 2.0, 3.0, 4.0]), 4, 3, |j| kept[j]).unwrap();
        assert_eq!(weights, Some(vec![1.0, 3.0, 4.0]));
        assert!(fitted_weights(Some(&[1.0]), 4, 3, |j| kept[j]).is_err());
    }
}
