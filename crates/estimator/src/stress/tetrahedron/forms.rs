//! The forms of tetrahedra, made side by side.

use super::modes::{FACE_LOADS, FLUCTUATION_LOADS, MODES, START, gram};
use super::reference::{PAIRS, reference_compliance};
use crate::stress::elimination::eliminate;
use crate::stress::shapes::{ElementShape, KnownShapes};
use crate::stress::{Fluctuation, Loading};
use nalgebra::Matrix3;
use percute_core::material::LinearLaw;
use percute_core::simd::dispatch;
use percute_core::simd::lanes::{LANES, Lanes, Value};

/// Columns of L whose products with loads are summed side by side: those of a face, or of two nodes.
const COLUMNS: usize = 6;
/// Groups of so many columns; the first four are those of the faces.
const GROUPS: usize = FLUCTUATION_LOADS / COLUMNS;
/// Square blocks of L on and below the diagonal.
const BLOCKS: usize = GROUPS * (GROUPS + 1) / 2;

/// The factor while it is made.
type LowerLanes = [[Lanes; MODES]; MODES];

/// The form of one tetrahedron.
#[derive(Clone, Debug)]
pub(crate) struct TetrahedronForm {
    /// B⁻¹, which takes tractions to the reference tetrahedron.
    inverse: [[f64; 3]; 3],
    /// J = 6|E|.
    jacobian: f64,
    /// The blocks of L, group by group of columns; above the diagonal, 0. One lane of many is read at a time, so that
    /// each has its own.
    factor: [[[f64; COLUMNS]; COLUMNS]; BLOCKS],
}

/// The forms of the last shapes that were asked for.
#[derive(Clone, Debug)]
pub(crate) struct TetrahedronForms {
    shapes: KnownShapes<3>,
    forms: Vec<TetrahedronForm>,
    lower: Box<LowerLanes>,
}

impl TetrahedronForms {
    pub(crate) fn new() -> Self {
        Self {
            shapes: KnownShapes::new(),
            forms: Vec::with_capacity(LANES),
            lower: Box::new([[Lanes::ZERO; MODES]; MODES]),
        }
    }

    /// Makes the forms of at most [`LANES`] tetrahedra, unless they are there, and gives their lanes.
    #[inline(always)]
    pub(crate) fn prepare<'l, L: LinearLaw + 'l>(
        &mut self,
        tetrahedra: impl Iterator<Item = ([[f64; 3]; 4], &'l L)> + Clone,
    ) -> [usize; LANES] {
        let shapes = tetrahedra.map(|(points, law)| ElementShape::new(&points, law));
        self.shapes.prepare(shapes, |shapes| make(shapes, &mut self.lower, &mut self.forms))
    }

    /// The form in a lane.
    #[inline(always)]
    pub(crate) fn of(&self, lane: usize) -> &TetrahedronForm {
        &self.forms[lane]
    }
}

/// The block on the diagonal of a group of columns; those below follow it.
const fn diagonal(group: usize) -> usize {
    group * GROUPS - group * group.saturating_sub(1) / 2
}

/// Leaves the loops of a tetrahedron out of the code for other elements.
#[inline(always)]
const fn in_space<const D: usize, const N: usize>() {
    if D != 3 || N != 4 {
        unreachable!()
    }
}

impl TetrahedronForm {
    #[inline(always)]
    pub(crate) fn fluctuation<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> Fluctuation<D, N, T> {
        in_space::<D, N>();
        let loads = self.pull_back(loading);
        let mut fluctuation = Fluctuation::filled(loads[0].zero());
        for group in 0..GROUPS {
            let sums = self.columns(group, &loads);
            for j in 0..COLUMNS {
                let (k, r) = place(group, j / 3);
                fluctuation.coordinates[k][r][j % 3] = sums[j];
            }
        }
        fluctuation
    }

    /// The products of a group of columns of L with loads.
    #[inline(always)]
    fn columns<T: Value>(&self, group: usize, loads: &[T; FLUCTUATION_LOADS]) -> [T; COLUMNS] {
        let mut sums = [loads[0].zero(); COLUMNS];
        let blocks = &self.factor[diagonal(group)..diagonal(group) + GROUPS - group];
        for (row, load) in blocks.as_flattened().iter().zip(&loads[COLUMNS * group..]) {
            for j in 0..COLUMNS {
                sums[j] += *load * row[j];
            }
        }
        sums
    }

    /// The slope of the energy in the moments on each face.
    #[inline(always)]
    pub(crate) fn fluctuation_slope<T: Value, const D: usize, const N: usize>(
        &self,
        fluctuation: &Fluctuation<D, N, T>,
    ) -> [[[T; D]; D]; N] {
        in_space::<D, N>();
        let zero = fluctuation.coordinates[0][0][0].zero();
        let mut slopes = [[[zero; D]; D]; N];
        for k in 0..FACE_LOADS / COLUMNS {
            let mut sums = [zero; COLUMNS];
            for group in 0..=k {
                let block = &self.factor[diagonal(group) + k - group];
                for j in 0..COLUMNS {
                    let coordinate = fluctuation.coordinates[group][j / 3][j % 3];
                    for i in 0..COLUMNS {
                        sums[i] += coordinate * block[i][j];
                    }
                }
            }
            for c in 0..3 {
                // The energy is the sum of squares of the coordinates, and differences of tractions are 12 times those
                // of moments.
                let [x, y, z] = [self.inverse[0][c] * 24.0, self.inverse[1][c] * 24.0, self.inverse[2][c] * 24.0];
                let second = sums[0] * x + sums[1] * y + sums[2] * z;
                let third = sums[3] * x + sums[4] * y + sums[5] * z;
                slopes[k][0][c] = -(second + third);
                (slopes[k][1][c], slopes[k][2][c]) = (second, third);
            }
        }
        slopes
    }

    /// The loads of the fluctuation on the reference tetrahedron.
    #[inline(always)]
    fn pull_back<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> [T; FLUCTUATION_LOADS] {
        let mut loads = [loading.volume[0][0].zero(); FLUCTUATION_LOADS];
        for (k, ends) in loading.traction.iter().enumerate() {
            for r in 1..3 {
                let vector = [ends[r][0] - ends[0][0], ends[r][1] - ends[0][1], ends[r][2] - ends[0][2]];
                for c in 0..3 {
                    loads[6 * k + 3 * (r - 1) + c] = dot(&self.inverse[c], &vector);
                }
            }
        }
        for (i, volume) in loading.volume.iter().enumerate() {
            for c in 0..3 {
                let vector = [volume[0], volume[1], volume[2]];
                loads[FACE_LOADS + 3 * i + c] = dot(&self.inverse[c], &vector) * self.jacobian;
            }
        }
        loads
    }
}

/// The product of a row of a matrix with a vector.
#[inline(always)]
fn dot<T: Value>(row: &[f64; 3], vector: &[T; 3]) -> T {
    vector[0] * row[0] + vector[1] * row[1] + vector[2] * row[2]
}

/// The face or node, and the place there, of a half of a group of columns.
const fn place(group: usize, half: usize) -> (usize, usize) {
    if group < 4 { (group, half) } else { (2 * (group - 4) + half, 2) }
}

/// The weights of the products of stresses in the energy of these shapes, times a factor.
#[inline(always)]
pub(super) fn energy_weights(shapes: &[ElementShape<3>; LANES], factor: f64) -> [Lanes; PAIRS.len()] {
    let (mut map, mut alpha, mut beta) = ([[Lanes::ZERO; 3]; 3], Lanes::ZERO, Lanes::ZERO);
    for lane in 0..LANES {
        let shape = &shapes[lane];
        let scale = factor / shape.map.determinant();
        (alpha.0[lane], beta.0[lane]) = (scale * shape.compliance.0, scale * shape.compliance.1);
        for c in 0..3 {
            for k in 0..3 {
                map[c][k].0[lane] = shape.map[(c, k)];
            }
        }
    }
    reference_compliance(&map, (alpha, beta))
}

/// Makes the forms of these shapes; apart, so that the loops over elements stay small.
#[inline(never)]
fn make(shapes: &[ElementShape<3>], lower: &mut LowerLanes, forms: &mut Vec<TetrahedronForm>) {
    let Some(first) = shapes.first() else { return };
    let all = std::array::from_fn(|lane| *shapes.get(lane).unwrap_or(first));
    dispatch(
        #[inline(always)]
        || factor(&all, lower),
    );
    forms.clear();
    forms.extend(shapes.iter().enumerate().map(|(lane, shape)| form(shape, lower, lane)));
}

/// Makes the factors of these shapes. The free stresses come first: the rest of the factor is then that of the energy
/// that they cannot save.
#[inline(always)]
fn factor(shapes: &[ElementShape<3>; LANES], lower: &mut LowerLanes) {
    let (gram, weights) = (gram(), energy_weights(shapes, 0.5));
    eliminate::<MODES, MODES>(
        #[inline(always)]
        |i, j| gram.entry(i, j, &weights),
        lower,
    );
}

/// The form of a shape from its lane.
fn form(shape: &ElementShape<3>, lower: &LowerLanes, lane: usize) -> TetrahedronForm {
    // Elements are not degenerate.
    let inverse = shape.map.try_inverse().unwrap_or_else(Matrix3::zeros);
    let mut factor = [[[0.0; COLUMNS]; COLUMNS]; BLOCKS];
    for group in 0..GROUPS {
        let first = COLUMNS * group;
        let rows = factor[diagonal(group)..].as_flattened_mut();
        for (i, row) in (first..FLUCTUATION_LOADS).zip(rows) {
            for j in 0..COLUMNS.min(i + 1 - first) {
                row[j] = lower[START + i][START + first + j].0[lane];
            }
        }
    }
    let inverse = std::array::from_fn(|c| std::array::from_fn(|b| inverse[(c, b)]));
    TetrahedronForm { inverse, jacobian: shape.map.determinant(), factor }
}

#[cfg(test)]
mod tests;
