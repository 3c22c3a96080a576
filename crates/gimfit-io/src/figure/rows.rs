//! Points in a flat slice, one after the other.

/// Points of one dimension in row-major order; a point cut short at the end
/// is left out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows<'a> {
    flat: &'a [f64],
    dimension: usize,
}

impl<'a> Rows<'a> {
    pub(crate) fn new(flat: &'a [f64], dimension: usize) -> Self {
        // Points without coordinates are no points.
        let flat = if dimension == 0 { &[] } else { flat };
        Self { flat, dimension: dimension.max(1) }
    }

    pub(crate) fn len(&self) -> usize {
        self.flat.len() / self.dimension
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &'a [f64]> + use<'a> {
        self.flat.chunks_exact(self.dimension)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_shapes_have_no_broken_points() {
        assert_eq!(Rows::new(&[1.0, 2.0, 3.0], 2).len(), 1);
        assert_eq!(Rows::new(&[1.0, 2.0, 3.0], 2).iter().count(), 1);
        assert_eq!(Rows::new(&[1.0], 0).len(), 0);
        assert_eq!(Rows::new(&[1.0], usize::MAX).len(), 0);
    }
}
