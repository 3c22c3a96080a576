//! Smallest eigenvalues of bases that are no B-splines, at equal steps from end to end: how slow
//! PIA is on each. The Bernstein basis has the largest of all normalised totally positive bases of
//! its space (Delgado and Pena 2007), in closed form; the others were recomputed independently of
//! this library.

use super::measure::smallest_eigenvalue;
use super::table::{Entry, Part, Source, Table};
use gimfit::Error;
use gimfit::basis::{Bernstein, BlendingBasis, Dp, SaidBall, WangBall};
use gimfit::collocation::DenseCollocation;
use gimfit::fit::triangular_collocation;
use gimfit::parameters::Parameters;

/// A name, values, and how to make the basis of a degree.
type Row =
    (&'static str, [(&'static str, usize); 5], fn(usize) -> Result<Box<dyn BlendingBasis>, Error>);

const DEGREES: [usize; 5] = [3, 4, 5, 8, 10];

/// Values and the significant digits they are known to, for each of the degrees.
const SAID_BALL: [(&str, usize); 5] =
    [("0.1481", 4), ("0.0818", 3), ("0.0197", 3), ("1.43e-3", 3), ("1.80e-4", 3)];
const WANG_BALL: [(&str, usize); 5] =
    [("0.1481", 4), ("0.0545", 3), ("0.0131", 3), ("3.15e-4", 3), ("2.11e-5", 3)];
const DP: [(&str, usize); 5] =
    [("0.0741", 3), ("0.0208", 3), ("2.93e-3", 3), ("1.95e-5", 3), ("5.2e-7", 2)];

pub(super) fn recompute() -> anyhow::Result<Table> {
    let mut bernstein = Vec::new();
    for degree in DEGREES {
        let law: f64 = (1..=degree).map(|k| k as f64 / degree as f64).product();
        let found = of(&Bernstein::new(degree)?)?;
        let reference = (format!("{degree}!/{degree}^{degree} = {law:.6e}"), law);
        bernstein.push(Entry::known(format!("n={degree}"), reference, 1e-9, found));
    }
    let mut parts = vec![Part::Entries {
        heading: "Bernstein basis of degree n: lambda_min at i/n".into(),
        source: Source::Theory,
        entries: bernstein,
    }];
    let mut triangular = Vec::new();
    for degree in [2, 3, 4, 6] {
        let law: f64 = (1..=degree).map(|k| k as f64 / degree as f64).product();
        let found = smallest_eigenvalue(&triangular_collocation(degree)?)?;
        let reference = (format!("{degree}!/{degree}^{degree} = {law:.6e}"), law);
        triangular.push(Entry::known(format!("n={degree}"), reference, 1e-9, found));
    }
    parts.push(Part::Entries {
        heading: "Bernstein basis of a triangle (Chen and Wang 2011): lambda_min at (i, j, k)/n"
            .into(),
        source: Source::Theory,
        entries: triangular,
    });
    let others: [Row; 3] = [
        ("Said-Ball basis", SAID_BALL, |n| Ok(Box::new(SaidBall::new(n)?))),
        ("Wang-Ball basis, which is not totally positive", WANG_BALL, |n| {
            Ok(Box::new(WangBall::new(n)?))
        }),
        ("DP basis of Delgado and Pena", DP, |n| Ok(Box::new(Dp::new(n)?))),
    ];
    for (name, references, make) in others {
        let mut entries = Vec::new();
        for (degree, (printed, digits)) in DEGREES.into_iter().zip(references) {
            let found = of(&make(degree)?)?;
            entries.push(Entry::printed(format!("n={degree}"), printed, digits, found, 0.0));
        }
        let heading = format!("{name}: lambda_min at i/n");
        parts.push(Part::Entries { heading, source: Source::Independent, entries });
    }
    Ok(Table { title: "bases beyond B-splines", parts })
}

fn of(basis: &dyn BlendingBasis) -> anyhow::Result<f64> {
    let last = basis.functions() - 1;
    let steps = Parameters::open((0..=last).map(|j| j as f64 / last as f64).collect())?;
    Ok(smallest_eigenvalue(&DenseCollocation::new(basis, &steps)?)?)
}
