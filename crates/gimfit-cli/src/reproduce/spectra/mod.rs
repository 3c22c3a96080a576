//! What decides the speed of the iterations: eigenvalues of collocation matrices, rates, and how
//! far a data point reaches. Closed forms where the spacing is uniform; elsewhere values that were
//! recomputed independently of this library with 25 digits or more.

mod ends;
mod rates;
mod uniform;

use super::table::Table;

pub(super) fn recompute() -> anyhow::Result<Table> {
    let mut parts = uniform::parts()?;
    parts.extend(ends::parts()?);
    parts.push(rates::part()?);
    Ok(Table { title: "theory of uniform B-spline collocation; spectra of other spacings", parts })
}
