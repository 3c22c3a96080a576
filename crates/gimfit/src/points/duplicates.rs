//! Neighbours that coincide: found, named, and dropped or merged only when asked.

use std::borrow::Cow;

use super::PointsView;
use crate::Error;

/// What to do with a point that repeats its predecessor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Duplicates {
    /// Refuse the data, naming the points.
    #[default]
    Error,
    /// Keep the first of each run.
    Drop,
    /// Replace each run by its mean (differs from [`Duplicates::Drop`] where several values share
    /// one given parameter).
    Merge,
}

/// Points without repeated neighbours.
#[derive(Debug)]
pub(crate) struct Cleaned<'a> {
    pub(crate) coordinates: Cow<'a, [f64]>,
    /// Positions of the points that are left, if any were taken out.
    pub(crate) kept: Option<Vec<usize>>,
}

impl Cleaned<'_> {
    /// From the place of a point that is left to its place among all.
    pub(crate) fn original(&self) -> impl Fn(usize) -> usize + '_ {
        |j| self.kept.as_ref().map_or(j, |kept| kept[j])
    }

    /// Keeps the first `count` points.
    pub(crate) fn truncate(&mut self, count: usize, dimension: usize) {
        match &mut self.coordinates {
            Cow::Borrowed(all) => *all = &all[..count * dimension],
            Cow::Owned(all) => all.truncate(count * dimension),
        }
        if let Some(kept) = &mut self.kept {
            kept.truncate(count);
        }
    }
}

/// Applies the policy to runs of neighbours for which `same(j)` holds between `j - 1` and `j`.
pub(crate) fn clean<'a>(
    points: PointsView<'a>,
    policy: Duplicates,
    same: impl Fn(usize) -> bool,
) -> Result<Cleaned<'a>, Error> {
    let count = points.len();
    let Some(second) = (1..count).find(|&j| same(j)) else {
        return Ok(Cleaned { coordinates: Cow::Borrowed(points.coordinates()), kept: None });
    };
    if policy == Duplicates::Error {
        let others = (second + 1..count).filter(|&j| same(j)).count();
        return Err(Error::RepeatedPoints { first: second - 1, second, others });
    }
    let kept: Vec<usize> = (0..count).filter(|&j| j == 0 || !same(j)).collect();
    let mut coordinates = Vec::with_capacity(kept.len() * points.dimension());
    for (run, &start) in kept.iter().enumerate() {
        let end = match policy {
            Duplicates::Merge => kept.get(run + 1).copied().unwrap_or(count),
            _ => start + 1,
        };
        for i in 0..points.dimension() {
            coordinates.push(mean((start..end).map(|j| points.point(j)[i]), end - start));
        }
    }
    Ok(Cleaned { coordinates: Cow::Owned(coordinates), kept: Some(kept) })
}

/// Mean that returns equal values unchanged and cannot overflow.
fn mean(mut values: impl Iterator<Item = f64>, count: usize) -> f64 {
    let Some(first) = values.next() else { return 0.0 };
    first + values.map(|x| x / count as f64 - first / count as f64).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cleaned(policy: Duplicates) -> Result<(Vec<f64>, Option<Vec<usize>>), Error> {
        let values = [1.0, 4.0, 6.0, 2.0, 2.0];
        let abscissae = [0.0, 1.0, 1.0, 2.0, 3.0];
        let view = PointsView::new(1, &values)?;
        let result = clean(view, policy, |j| abscissae[j] == abscissae[j - 1])?;
        Ok((result.coordinates.into_owned(), result.kept))
    }

    #[test]
    fn repeated_parameters_are_refused_by_default() {
        assert_eq!(
            cleaned(Duplicates::Error),
            Err(Error::RepeatedPoints { first: 1, second: 2, others: 0 })
        );
    }

    #[test]
    fn drop_keeps_the_first_and_merge_takes_the_mean() {
        let kept = Some(vec![0, 1, 3, 4]);
        assert_eq!(cleaned(Duplicates::Drop), Ok((vec![1.0, 4.0, 2.0, 2.0], kept.clone())));
        assert_eq!(cleaned(Duplicates::Merge), Ok((vec![1.0, 5.0, 2.0, 2.0], kept)));
    }
}
