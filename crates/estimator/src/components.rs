//! Symmetric tensors in the plane as their components xx, yy and xy. In a bar all three are the only entry.
//!
//! Those of a solid are two records of three: xx, zz and xz, as in the plane of its first and last axis, then yy, xy
//! and yz.

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

/// Records of a symmetric tensor in space.
pub(crate) const SPACE_RECORDS: usize = 2;

/// The components of a symmetric tensor in space.
pub(crate) type SpaceComponents<T> = [[T; COMPONENTS]; SPACE_RECORDS];

/// The components of a symmetric tensor in space.
#[inline(always)]
pub(crate) fn space_components<T: Copy, const D: usize>(tensor: &[[T; D]; D]) -> SpaceComponents<T> {
    // The axis in the middle.
    let m = D / 2;
    [components(tensor), [tensor[m][m], tensor[0][m], tensor[m][D - 1]]]
}

/// The symmetric tensor in space with these components.
#[inline(always)]
pub(crate) fn space_tensor<T: Copy, const D: usize>([plane, [y, xy, yz]]: SpaceComponents<T>) -> [[T; D]; D] {
    let (m, mut tensor) = (D / 2, tensor::<T, D>(plane));
    tensor[m][m] = y;
    (tensor[0][m], tensor[m][0], tensor[m][D - 1], tensor[D - 1][m]) = (xy, xy, yz, yz);
    tensor
}

/// Subtracts a tensor from another one.
#[inline(always)]
pub(crate) fn subtract<T: Value, const D: usize>(from: &mut [[T; D]; D], tensor: &[[T; D]; D]) {
    for a in 0..D {
        (0..D).for_each(|b| from[a][b] -= tensor[a][b]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each component has a place of its own.
    #[test]
    fn components_in_space() {
        let tensor = [[1.0, 2.0, 3.0], [2.0, 4.0, 5.0], [3.0, 5.0, 6.0]];
        assert_eq!(space_components(&tensor), [[1.0, 6.0, 3.0], [4.0, 2.0, 5.0]]);
        assert_eq!(space_tensor::<_, 3>(space_components(&tensor)), tensor);
    }
}
