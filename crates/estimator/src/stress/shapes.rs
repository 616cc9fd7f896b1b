//! Shapes of elements, which congruent elements share.

use nalgebra::{Const, DimMin, SMatrix};
use percute_core::material::LinearLaw;
use percute_core::simd::lanes::LANES;

/// Edges that differ by less, relative to the smallest height, belong to elements of the same shape: rounding of
/// coordinates.
const SAME: f64 = 1e-13;

/// A simplex up to translation, and its law.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementShape<const D: usize> {
    /// Columns: the edges from node 0 to the others (m).
    pub(super) map: SMatrix<f64, D, D>,
    pub(super) compliance: (f64, f64),
}

/// The last shapes that were asked for, at most [`LANES`].
#[derive(Clone, Debug)]
pub(super) struct KnownShapes<const D: usize>(Vec<ElementShape<D>>);

impl<const D: usize> ElementShape<D>
where
    Const<D>: DimMin<Const<D>, Output = Const<D>>,
{
    #[inline(always)]
    pub(super) fn new<const N: usize>(points: &[[f64; D]; N], law: &impl LinearLaw) -> Self {
        Self { map: SMatrix::from_fn(|c, k| points[k + 1][c] - points[0][c]), compliance: law.compliance::<D>() }
    }

    #[inline(always)]
    fn is_like(&self, other: &Self) -> bool {
        let largest = self.map.amax();
        let height = self.map.determinant().abs() / (1..D).fold(1.0, |product, _| product * largest);
        self.compliance == other.compliance && (self.map - other.map).amax() <= SAME * height
    }
}

impl<const D: usize> KnownShapes<D>
where
    Const<D>: DimMin<Const<D>, Output = Const<D>>,
{
    pub(super) fn new() -> Self {
        Self(Vec::with_capacity(LANES))
    }

    /// The places of at most [`LANES`] shapes. Where some are new, the list becomes theirs, and `make` is called with
    /// it.
    #[inline(always)]
    pub(super) fn prepare(
        &mut self,
        shapes: impl Iterator<Item = ElementShape<D>> + Clone,
        make: impl FnOnce(&[ElementShape<D>]),
    ) -> [usize; LANES] {
        let mut lanes = [0; LANES];
        if self.find_all(shapes.clone(), &mut lanes) {
            return lanes;
        }
        self.0.clear();
        for shape in shapes.clone() {
            if self.find(&shape).is_none() {
                self.0.push(shape);
            }
        }
        make(&self.0);
        self.find_all(shapes, &mut lanes);
        lanes
    }

    /// Fills in the lanes of all shapes if there are forms of all.
    #[inline(always)]
    fn find_all(&self, shapes: impl Iterator<Item = ElementShape<D>>, lanes: &mut [usize; LANES]) -> bool {
        for (lane, shape) in lanes.iter_mut().zip(shapes) {
            match self.find(&shape) {
                Some(found) => *lane = found,
                None => return false,
            }
        }
        true
    }

    #[inline(always)]
    fn find(&self, shape: &ElementShape<D>) -> Option<usize> {
        self.0.iter().position(|other| other.is_like(shape))
    }

    /// How many there are.
    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }
}
