//! Large arrays, asked for in huge pages.
//!
//! Fresh memory in pages of 4 KiB costs more to touch for the first time than a fit needs to
//! compute: the arrays of a million points are tens of megabytes, and the kernel maps about one
//! gigabyte a second page by page. Advice to use huge pages makes that ten times faster where the
//! system leaves the choice to programs; elsewhere it does nothing.

/// From this size on, advice is worth a system call.
const LARGE: usize = 4 << 20;

/// An empty array with room for `length` numbers.
pub(crate) fn with_capacity<T: Copy>(length: usize) -> Vec<T> {
    let array = Vec::with_capacity(length);
    advise(&array);
    array
}

/// `length` zeros.
pub(crate) fn zeros(length: usize) -> Vec<f64> {
    let mut array = with_capacity(length);
    array.resize(length, 0.0);
    array
}

#[cfg(target_os = "linux")]
#[allow(unsafe_code)]
fn advise<T>(array: &Vec<T>) {
    const HUGE_PAGE: usize = 2 << 20;
    let bytes = array.capacity() * size_of::<T>();
    if bytes < LARGE {
        return;
    }
    let start = (array.as_ptr() as usize).next_multiple_of(HUGE_PAGE);
    let end = (array.as_ptr() as usize + bytes) / HUGE_PAGE * HUGE_PAGE;
    if start < end {
        // SAFETY: the range lies inside the allocation of `array`, which nothing else owns, and is
        // aligned to pages. MADV_HUGEPAGE changes how it is backed, never what it holds; a refusal
        // leaves everything as it was, so the result is of no interest.
        unsafe {
            libc::madvise(start as *mut libc::c_void, end - start, libc::MADV_HUGEPAGE);
        }
    }
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_: &Vec<T>) {
    let _ = LARGE;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advised_arrays_hold_what_plain_ones_do() {
        for length in [0, 1, 1000, 3_000_000] {
            let values: Vec<f64> = (0..length).map(|i| f64::from(i) * 0.5).collect();
            assert_eq!(zeros(values.len()), vec![0.0; values.len()]);
            assert!(with_capacity::<i32>(values.len()).capacity() >= values.len());
        }
    }
}
