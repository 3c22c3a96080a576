//! Work on large arrays, split over threads so that the result is the same for any number of them.

use rayon::prelude::*;

/// Numbers below which handing work over costs more than it saves.
const ENOUGH: usize = 1 << 16;

/// Into how many bands work on this many numbers is split: 1, or the number of threads at hand.
pub(crate) fn bands(numbers: usize) -> usize {
    if numbers < ENOUGH { 1 } else { rayon::current_num_threads().max(1) }
}

/// Calls `each` once for every band of whole items of `length` numbers, with the number of the
/// band's first item, its items, and a part of `scratch` as long as that of any other band. What
/// `each` makes of an item must not depend on the others, nor on what it finds in the scratch.
pub(crate) fn for_each_band(
    bands: usize,
    items: &mut [f64],
    length: usize,
    scratch: &mut [f64],
    each: impl Fn(usize, &mut [f64], &mut [f64]) + Sync,
) {
    if bands <= 1 {
        each(0, items, scratch);
        return;
    }
    let per_band = items.len().div_ceil(length).div_ceil(bands).max(1);
    if scratch.is_empty() {
        items
            .par_chunks_mut(per_band * length)
            .enumerate()
            .for_each(|(band, items)| each(band * per_band, items, &mut []));
        return;
    }
    let own = (scratch.len() / bands).max(1);
    items
        .par_chunks_mut(per_band * length)
        .zip(scratch.par_chunks_mut(own))
        .enumerate()
        .for_each(|(band, (items, scratch))| each(band * per_band, items, scratch));
}

/// Calls `each` for every row with the number of the row, its parts in two arrays, which hold
/// `lengths` numbers a row, and a part of `scratch`, as [`for_each_band`].
pub(crate) fn for_each_row(
    bands: usize,
    arrays: [&mut [f64]; 2],
    lengths: [usize; 2],
    scratch: &mut [f64],
    each: impl Fn(usize, [&mut [f64]; 2], &mut [f64]) + Sync,
) {
    let [a, b] = arrays;
    let rows = a.len().checked_div(lengths[0]).unwrap_or(0);
    let per_band = rows.div_ceil(bands.max(1)).max(1);
    let own = (scratch.len() / bands.max(1)).max(1);
    let band = |first: usize, a: &mut [f64], b: &mut [f64], scratch: &mut [f64]| {
        let parts = a.chunks_exact_mut(lengths[0]).zip(b.chunks_exact_mut(lengths[1]));
        parts.enumerate().for_each(|(row, (a, b))| each(first + row, [a, b], scratch));
    };
    if bands <= 1 {
        band(0, a, b, scratch);
        return;
    }
    a.par_chunks_mut(per_band * lengths[0])
        .zip(b.par_chunks_mut(per_band * lengths[1]))
        .zip(scratch.par_chunks_mut(own))
        .enumerate()
        .for_each(|(k, ((a, b), scratch))| band(k * per_band, a, b, scratch));
}
