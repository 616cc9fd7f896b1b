//! Symmetric tensors in the plane as their components xx, yy and xy. In a bar all three are the only entry.

use percute_core::simd::lanes::Value;

/// How many there are.
pub(crate) const COMPONENTS: usize = 3;

/// The components of a symmetric tensor.
#[inline(always)]
pub(crate) fn components<T: Copy, const D: usize>(tensor: &[[T; D]; D]) -> [T; COMPONENTS] {
    [tensor[0][0], tensor[D - 1][D - 1], tensor[0][D - 1]]
}

/// The symmetric tensor with these components.
#[inline(always)]
pub(crate) fn tensor<T: Copy, const D: usize>([x, y, xy]: [T; COMPONENTS]) -> [[T; D]; D] {
    let mut tensor = [[xy; D]; D];
    (tensor[0][0], tensor[D - 1][D - 1]) = (x, y);
    tensor
}

/// Subtracts a tensor from another one.
#[inline(always)]
pub(crate) fn subtract<T: Value, const D: usize>(from: &mut [[T; D]; D], tensor: &[[T; D]; D]) {
    for a in 0..D {
        (0..D).for_each(|b| from[a][b] -= tensor[a][b]);
    }
}
