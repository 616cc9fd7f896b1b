//! The stress of concentrated tractions in the star of a node, of least energy.
//!
//! The traction of a hat less the linear traction with the same resultant and moment balances itself. It is balanced in the
//! whole star, on sub-triangles that carry the macro-element's stress: balanced in one element it would cost many times the
//! energy. Unknown are the linear tractions on the edges between sub-triangles. They minimise the complementary energy under
//! equilibrium of each sub-triangle.

use super::cut_star::{CutStar, SubTriangle};
use super::least_energy::{System, TRACTIONS, form, resultants};
use super::{HATS, place};
use crate::residual::worse;
use crate::stress::{LOADS, Loading, PiecewiseStress, StressResiduals, TriangleStress, products};
use nalgebra::DMatrix;
use percute_core::material::LinearLaw;

/// A symmetric matrix: its lower triangle, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Symmetric(Vec<f64>);

impl Symmetric {
    pub(super) fn new(matrix: &DMatrix<f64>) -> Self {
        Self((0..matrix.nrows()).flat_map(|i| (0..=i).map(move |j| matrix[(i, j)])).collect())
    }

    #[inline]
    pub(crate) fn at(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.max(j), i.min(j));
        self.0[i * (i + 1) / 2 + j]
    }
}

/// The stresses of unit resultants over the thickness in one element of a star, in the order of [`place`].
#[derive(Clone, Debug)]
pub(crate) struct ElementForms {
    /// ∫τ:K⁻¹τ (m/N per unit of thickness).
    pub(crate) energy: Symmetric,
    /// ∫σ:K⁻¹τ, one row for each load of the element, with σ the stress that balances it: tractions, then Γ_DA − f_d.
    pub(crate) product: DMatrix<f64>,
    /// ∫τ (m per unit of thickness), rows 11, 22, 12.
    pub(crate) integral: DMatrix<f64>,
}

/// The stresses of unit resultants in a star.
#[derive(Clone, Debug)]
pub(crate) struct StarStress {
    /// In each element.
    pub(crate) elements: Vec<ElementForms>,
    /// ∫τ:K⁻¹τ over the star, of unit resultants (m/N).
    pub(crate) energy: Symmetric,
    /// How far they are from equilibrium, relative to the largest term.
    pub(crate) residuals: StarResiduals,
}

/// Residuals of the stresses of a star.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StarResiduals {
    /// Resultants and moments of sub-triangles.
    pub(crate) resultants: f64,
    /// Divergence, tractions and their continuity inside sub-triangles.
    pub(crate) stress: StressResiduals,
}

/// One element of a star.
pub(crate) struct StarElement<'a, L> {
    /// Its corners, counterclockwise.
    pub(crate) corners: [[f64; 2]; 3],
    /// The corner at the node of the star.
    pub(crate) at: usize,
    /// Its law.
    pub(crate) law: &'a L,
}

/// The loads of each sub-triangle for each unit resultant.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    pub(super) star: CutStar,
    pub(super) maps: Vec<TriangleStress>,
    /// One row for each load, one column for each resultant.
    pub(super) loads: Vec<DMatrix<f64>>,
}

impl StarStress {
    /// The stresses in the star of a node, elements counterclockwise, for hats on the `edges` (0 the first of the star, 1 the
    /// last) that are candidates. The components `supported` on the first and the last edge have unknown tractions.
    pub(crate) fn new<L: LinearLaw>(
        elements: &[StarElement<'_, L>],
        edges: &[usize],
        supported: [[bool; 2]; 2],
    ) -> Self {
        let solved = Solved::new(elements, edges, supported);
        let columns = solved.loads[0].ncols();
        let zeros = |rows: usize| DMatrix::zeros(rows, columns);
        let mut made = vec![(zeros(columns), zeros(LOADS), zeros(3)); elements.len()];
        let units: Vec<_> = elements.iter().map(unit_stresses).collect();
        for ((triangle, map), loads) in solved.star.triangles.iter().zip(&solved.maps).zip(&solved.loads) {
            let (element, (energy, product, integral)) = (&elements[triangle.element], &mut made[triangle.element]);
            *energy += loads.transpose() * form(map) * loads;
            let part = (element.at + triangle.opposite) % 3;
            for (column, load) in loads.column_iter().enumerate() {
                let stress = map.piecewise(&tractions(load.as_slice()));
                let (with_units, sum) = products(&units[triangle.element], part, &stress, element.law);
                product.column_mut(column).iter_mut().zip(with_units).for_each(|(to, value)| *to += value);
                integral.column_mut(column).iter_mut().zip(sum).for_each(|(to, value)| *to += value);
            }
        }
        let energies = made.iter().zip(elements).map(|((energy, ..), element)| energy / element.law.extent());
        let energy = energies.fold(zeros(columns), |sum, energy| sum + energy);
        let forms = |(energy, product, integral)| ElementForms { energy: Symmetric::new(&energy), product, integral };
        Self {
            elements: made.into_iter().map(forms).collect(),
            energy: Symmetric::new(&energy),
            residuals: solved.residuals(),
        }
    }
}

impl Solved {
    pub(super) fn new<L: LinearLaw>(
        elements: &[StarElement<'_, L>],
        edges: &[usize],
        supported: [[bool; 2]; 2],
    ) -> Self {
        let corner = |element: &StarElement<'_, L>, next: usize| element.corners[(element.at + next) % 3];
        let origin = corner(&elements[0], 0);
        let mut fan = vec![corner(&elements[0], 1)];
        fan.extend(elements.iter().map(|element| corner(element, 2)));
        let star = CutStar::new(origin, &fan, HATS);
        let map = |triangle: &SubTriangle| TriangleStress::new(&triangle.corners, elements[triangle.element].law);
        let maps: Vec<TriangleStress> = star.triangles.iter().map(map).collect();
        let mut loads = vec![DMatrix::zeros(TRACTIONS, 2 * HATS * edges.len()); star.triangles.len()];
        for (position, &edge) in edges.iter().enumerate() {
            apply_hats(&star, edge, fan[if edge == 0 { 0 } else { elements.len() }], origin, position, &mut loads);
        }
        // Loads are those of stress times thickness. The modulus makes the system one of numbers near 1.
        let scale = elements[0].law.extent() / elements[0].law.compliance::<2>().0;
        let weights: Vec<f64> = elements.iter().map(|element| scale / element.law.extent()).collect();
        System::new(&star, &maps, &weights, supported, &loads).solve(&mut loads);
        Self { star, maps, loads }
    }

    fn residuals(&self) -> StarResiduals {
        let mut all = StarResiduals::default();
        for ((triangle, map), loads) in self.star.triangles.iter().zip(&self.maps).zip(&self.loads) {
            let miss = resultants(&triangle.corners) * loads;
            for (load, miss) in loads.column_iter().zip(miss.column_iter()) {
                // The traction of a unit hat on its edge is at least 1 over the length of the edge: its loads are near 1.
                let stress = map.residuals(&tractions(load.as_slice()), 1.0);
                all.resultants = worse(all.resultants, miss.amax() / load.amax().max(1.0));
                all.stress.divergence = worse(all.stress.divergence, stress.divergence);
                all.stress.edges = worse(all.stress.edges, stress.edges);
                all.stress.inner = worse(all.stress.inner, stress.inner);
            }
        }
        all
    }
}

/// Adds the tractions of the hats of one edge, less their linear equivalents, to the loads of the sub-triangles there.
fn apply_hats(
    star: &CutStar,
    edge: usize,
    far: [f64; 2],
    origin: [f64; 2],
    position: usize,
    loads: &mut [DMatrix<f64>],
) {
    let length = (far[0] - origin[0]).hypot(far[1] - origin[1]);
    let pieces = &star.ends[edge];
    for (piece, side) in pieces.iter().enumerate() {
        let core = piece + 1 == pieces.len();
        let outer = 0.5_f64.powi(piece as i32);
        let inner = if core { 0.0 } else { 0.5 * outer };
        // Facets of the first edge lead away from the node, those of the last towards it.
        let ends = if edge == 0 { [inner, outer] } else { [outer, inner] };
        for width in 1..=HATS {
            for (p, at) in ends.into_iter().enumerate() {
                let traction = (outer - inner) * length * traction(width, at, length);
                for c in 0..2 {
                    loads[side.triangle][(4 * side.corner + 2 * p + c, place(position, width, c))] += traction;
                }
            }
        }
    }
}

/// The traction of a unit hat less that of its linear equivalent (1/m), at a place along the edge from 0, the node, to 1.
fn traction(width: usize, place: f64, length: f64) -> f64 {
    let narrow = 0.5_f64.powi(width as i32);
    let far = narrow / 3.0;
    let near = 1.0 - far;
    let linear = (1.0 - place) * (4.0 * near - 2.0 * far) + place * (4.0 * far - 2.0 * near);
    let hat = 2.0 / narrow * (1.0 - place / narrow).max(0.0);
    (hat - linear) / length
}

/// The stress of an element for each unit load.
fn unit_stresses<L: LinearLaw>(element: &StarElement<'_, L>) -> Vec<PiecewiseStress> {
    let map = TriangleStress::new(&element.corners, element.law);
    let unit = |load: usize| {
        let at = |k: usize| f64::from(u8::from(k == load));
        let traction = tractions(&std::array::from_fn::<f64, TRACTIONS, _>(at)).traction;
        let volume = std::array::from_fn(|i| std::array::from_fn(|c| at(TRACTIONS + 2 * i + c)));
        map.piecewise(&Loading { traction, volume })
    };
    (0..LOADS).map(unit).collect()
}

/// A loading by these tractions alone.
pub(super) fn tractions(loads: &[f64]) -> Loading<2, 3> {
    let traction = std::array::from_fn(|k| std::array::from_fn(|p| [loads[4 * k + 2 * p], loads[4 * k + 2 * p + 1]]));
    Loading { traction, volume: [[0.0; 2]; 3] }
}

#[cfg(test)]
mod tests;
