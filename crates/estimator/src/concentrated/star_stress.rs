//! The stress of concentrated tractions in the star of a node, of least energy.
//!
//! The traction of a hat less the linear traction with the same resultant and moment balances itself. It is balanced in the
//! whole star, on sub-triangles that carry the macro-element's stress: balanced in one element it would cost many times the
//! energy. Unknown are the linear tractions on the edges between sub-triangles. They minimise the complementary energy under
//! equilibrium of each sub-triangle.

use super::cut_star::{CutStar, SideOf, SubTriangle};
use crate::stress::{LOADS, Loading, PiecewiseStress, TriangleStress, products};
use nalgebra::{DMatrix, Dyn, LU};
use percute_core::material::LinearLaw;

/// Numbers of halvings of the widest hat.
pub(crate) const HATS: usize = 10;

/// Traction loads of a sub-triangle: |e|F̂ at both nodes of three facets, two components each.
const TRACTIONS: usize = 12;

/// A row or column of the system.
#[derive(Clone, Copy, Debug)]
struct Slot {
    layer: usize,
    at: usize,
    sign: f64,
}

/// The energies of the stresses of unit resultants, sorted by (edge, width, component).
#[derive(Clone, Debug)]
pub(crate) struct StarStress {
    /// ∫τ:K⁻¹τ over each element of the star (m/N per unit of thickness).
    pub(crate) energy: Vec<DMatrix<f64>>,
    /// ∫σ:K⁻¹τ, one row for each load of the element, with σ the stress that balances it: tractions, then Γ_DA − f_d.
    pub(crate) product: Vec<DMatrix<f64>>,
    /// ∫τ (m per unit of thickness), rows 11, 22, 12.
    pub(crate) integral: Vec<DMatrix<f64>>,
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
    /// last) that are candidates.
    pub(crate) fn new<L: LinearLaw>(elements: &[StarElement<'_, L>], edges: &[usize]) -> Self {
        let solved = Solved::new(elements, edges);
        let columns = solved.loads[0].ncols();
        let zeros = |rows: usize| vec![DMatrix::zeros(rows, columns); elements.len()];
        let mut made = Self { energy: zeros(columns), product: zeros(LOADS), integral: zeros(3) };
        let units: Vec<_> = elements.iter().map(unit_stresses).collect();
        for ((triangle, map), loads) in solved.star.triangles.iter().zip(&solved.maps).zip(&solved.loads) {
            let element = &elements[triangle.element];
            made.energy[triangle.element] += loads.transpose() * form(map) * loads;
            let stresses: Vec<_> =
                loads.column_iter().map(|column| map.piecewise(&tractions(column.as_slice()))).collect();
            let part = (element.at + triangle.opposite) % 3;
            for (column, stress) in stresses.iter().enumerate() {
                let (product, integral) = products(&units[triangle.element], part, stress, element.law);
                for (row, value) in product.into_iter().enumerate() {
                    made.product[triangle.element][(row, column)] += value;
                }
                for (row, value) in integral.into_iter().enumerate() {
                    made.integral[triangle.element][(row, column)] += value;
                }
            }
        }
        made
    }
}

impl Solved {
    pub(super) fn new<L: LinearLaw>(elements: &[StarElement<'_, L>], edges: &[usize]) -> Self {
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
        let scales: Vec<f64> = elements.iter().map(|element| 1.0 / element.law.compliance::<2>().0).collect();
        System::new(&star, &maps, &scales, &loads).solve(&mut loads);
        Self { star, maps, loads }
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
            for (p, place) in ends.into_iter().enumerate() {
                let traction = (outer - inner) * length * traction(width, place, length);
                for c in 0..2 {
                    let column = 2 * (HATS * position + width - 1) + c;
                    loads[side.triangle][(4 * side.corner + 2 * p + c, column)] += traction;
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
fn tractions(loads: &[f64]) -> Loading<2, 3> {
    let traction = std::array::from_fn(|k| std::array::from_fn(|p| [loads[4 * k + 2 * p], loads[4 * k + 2 * p + 1]]));
    Loading { traction, volume: [[0.0; 2]; 3] }
}

/// The matrix of ∫τ:K⁻¹τ in the traction loads of a sub-triangle.
fn form(map: &TriangleStress) -> DMatrix<f64> {
    let mut form = DMatrix::zeros(TRACTIONS, TRACTIONS);
    for column in 0..TRACTIONS {
        let unit: [f64; TRACTIONS] = std::array::from_fn(|row| f64::from(u8::from(row == column)));
        let slope = map.traction_slope(&tractions(&unit));
        for row in 0..TRACTIONS {
            form[(row, column)] = slope[row / 4][row / 2 % 2][row % 2];
        }
    }
    form
}

/// The resultants of the loads of a sub-triangle: two forces, and the moment about its first corner over its size.
fn resultants(corners: &[[f64; 2]; 3]) -> DMatrix<f64> {
    let size = (0..3).map(|k| (corners[k][0] - corners[(k + 1) % 3][0]).hypot(corners[k][1] - corners[(k + 1) % 3][1]));
    let size = size.fold(0.0, f64::max);
    let mut rows = DMatrix::zeros(3, TRACTIONS);
    for k in 0..3 {
        let node = |p: usize| corners[(k + 1 + p) % 3];
        for p in 0..2 {
            let arm: [f64; 2] =
                std::array::from_fn(|c| (node(p)[c] / 3.0 + node(1 - p)[c] / 6.0 - 0.5 * corners[0][c]) / size);
            let column = 4 * k + 2 * p;
            rows[(0, column)] = 0.5;
            rows[(1, column + 1)] = 0.5;
            rows[(2, column)] = -arm[1];
            rows[(2, column + 1)] = arm[0];
        }
    }
    rows
}

/// The conditions of least energy: symmetric, and tridiagonal in layers.
struct System {
    /// The slots of the loads of each sub-triangle; none where they are given.
    slots: Vec<[Option<Slot>; TRACTIONS]>,
    diagonal: Vec<DMatrix<f64>>,
    /// Rows of a layer, columns of the layer before.
    lower: Vec<DMatrix<f64>>,
    right: Vec<DMatrix<f64>>,
}

impl System {
    fn new(star: &CutStar, maps: &[TriangleStress], scales: &[f64], loads: &[DMatrix<f64>]) -> Self {
        let layers = star.triangles.iter().map(|t| t.layer + 1).max().unwrap_or(0);
        let mut unknowns = vec![0; layers];
        let mut slots = vec![[None; TRACTIONS]; star.triangles.len()];
        for sides in &star.inner {
            let layer = sides.iter().map(|side| star.triangles[side.triangle].layer).min().unwrap_or(0);
            number(sides, layer, &mut unknowns[layer], &mut slots);
        }
        let mut rows = unknowns.clone();
        star.triangles.iter().for_each(|triangle| rows[triangle.layer] += 3);
        // The star as a whole is in equilibrium: the conditions of the first sub-triangle, a large one, follow from the others.
        rows[0] -= 3;
        let columns = loads[0].ncols();
        let mut system = Self {
            slots,
            diagonal: rows.iter().map(|&n| DMatrix::zeros(n, n)).collect(),
            lower: (0..layers).map(|l| DMatrix::zeros(rows[l], if l == 0 { 0 } else { rows[l - 1] })).collect(),
            right: rows.iter().map(|&n| DMatrix::zeros(n, columns)).collect(),
        };
        let mut next = unknowns;
        for (at, (triangle, map)) in star.triangles.iter().zip(maps).enumerate() {
            system.add_energy(at, &(form(map) * scales[triangle.element]), &loads[at]);
            if at > 0 {
                system.add_conditions(
                    at,
                    triangle.layer,
                    next[triangle.layer],
                    &resultants(&triangle.corners),
                    &loads[at],
                );
                next[triangle.layer] += 3;
            }
        }
        system
    }

    fn add(&mut self, row: (usize, usize), column: (usize, usize), value: f64) {
        if row.0 == column.0 {
            self.diagonal[row.0][(row.1, column.1)] += value;
        } else if row.0 == column.0 + 1 {
            self.lower[row.0][(row.1, column.1)] += value;
        }
    }

    fn add_energy(&mut self, triangle: usize, form: &DMatrix<f64>, loads: &DMatrix<f64>) {
        let slots = self.slots[triangle];
        let given = form * loads;
        for (p, row) in slots.iter().enumerate() {
            let Some(row) = row else { continue };
            for (q, column) in slots.iter().enumerate() {
                let Some(column) = column else { continue };
                self.add((row.layer, row.at), (column.layer, column.at), row.sign * column.sign * form[(p, q)]);
            }
            let mut right = self.right[row.layer].row_mut(row.at);
            right -= given.row(p) * row.sign;
        }
    }

    fn add_conditions(
        &mut self,
        triangle: usize,
        layer: usize,
        first: usize,
        resultants: &DMatrix<f64>,
        loads: &DMatrix<f64>,
    ) {
        let slots = self.slots[triangle];
        let given = resultants * loads;
        for k in 0..3 {
            let row = (layer, first + k);
            for (p, slot) in slots.iter().enumerate() {
                let Some(slot) = slot else { continue };
                let column = (slot.layer, slot.at);
                self.add(row, column, slot.sign * resultants[(k, p)]);
                if slot.layer == layer {
                    self.add(column, row, slot.sign * resultants[(k, p)]);
                }
            }
            let mut right = self.right[layer].row_mut(row.1);
            right -= given.row(k);
        }
    }

    /// Block elimination from the far edges to the node, and the loads of all sub-triangles.
    fn solve(mut self, loads: &mut [DMatrix<f64>]) {
        let layers = self.diagonal.len();
        let mut factors: Vec<LU<f64, Dyn, Dyn>> = Vec::with_capacity(layers);
        for layer in 0..layers {
            if layer > 0 {
                let lower = &self.lower[layer];
                let coupled: Vec<usize> =
                    (0..lower.ncols()).filter(|&c| lower.column(c).iter().any(|x| *x != 0.0)).collect();
                let narrow = lower.select_columns(&coupled);
                let mut upper = DMatrix::zeros(lower.ncols(), coupled.len());
                coupled.iter().enumerate().for_each(|(k, &at)| upper[(at, k)] = 1.0);
                // D⁻¹ on the coupled rows and columns alone.
                factors[layer - 1].solve_mut(&mut upper);
                let inverse = upper.select_rows(&coupled);
                self.diagonal[layer] -= &narrow * inverse * narrow.transpose();
                let mut right = self.right[layer - 1].clone();
                factors[layer - 1].solve_mut(&mut right);
                self.right[layer] -= lower * right;
            }
            factors.push(LU::new(self.diagonal[layer].clone()));
        }
        let mut solution: Vec<DMatrix<f64>> = vec![DMatrix::zeros(0, 0); layers];
        for layer in (0..layers).rev() {
            let mut right = self.right[layer].clone();
            if layer + 1 < layers {
                right -= self.lower[layer + 1].transpose() * &solution[layer + 1];
            }
            factors[layer].solve_mut(&mut right);
            solution[layer] = right;
        }
        for (slots, loads) in self.slots.iter().zip(loads) {
            for (p, slot) in slots.iter().enumerate() {
                if let Some(slot) = slot {
                    loads.row_mut(p).copy_from(&(solution[slot.layer].row(slot.at) * slot.sign));
                }
            }
        }
    }
}

/// Numbers the four tractions of an edge. The second side has the other sign and the other order of its nodes.
fn number(sides: &[SideOf; 2], layer: usize, next: &mut usize, slots: &mut [[Option<Slot>; TRACTIONS]]) {
    for p in 0..2 {
        for c in 0..2 {
            for (side, node, sign) in [(&sides[0], p, 1.0), (&sides[1], 1 - p, -1.0)] {
                slots[side.triangle][4 * side.corner + 2 * node + c] = Some(Slot { layer, at: *next, sign });
            }
            *next += 1;
        }
    }
}

#[cfg(test)]
mod tests;
