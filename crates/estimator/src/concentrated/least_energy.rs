//! The tractions between sub-triangles that make the energy least.

use super::cut_star::{CutStar, SideOf};
use super::star_stress::tractions;
use crate::stress::TriangleStress;
use nalgebra::{DMatrix, Dyn, LU};

/// Traction loads of a sub-triangle: |e|F̂ at both nodes of three facets, two components each.
pub(super) const TRACTIONS: usize = 12;

/// A row or column of the system.
#[derive(Clone, Copy, Debug)]
struct Slot {
    layer: usize,
    at: usize,
    sign: f64,
}

/// The conditions of least energy: symmetric, and tridiagonal in layers.
pub(super) struct System {
    /// The slots of the loads of each sub-triangle; none where they are given.
    slots: Vec<[Option<Slot>; TRACTIONS]>,
    diagonal: Vec<DMatrix<f64>>,
    /// Rows of a layer, columns of the layer before.
    lower: Vec<DMatrix<f64>>,
    right: Vec<DMatrix<f64>>,
}

impl System {
    /// The system of a star. The energy of each element has its weight; `supported` are the components on the first and the
    /// last edge whose tractions are unknown, `loads` the given loads of each sub-triangle.
    pub(super) fn new(
        star: &CutStar,
        maps: &[TriangleStress],
        weights: &[f64],
        supported: [[bool; 2]; 2],
        loads: &[DMatrix<f64>],
    ) -> Self {
        let layers = star.triangles.iter().map(|t| t.layer + 1).max().unwrap_or(0);
        let mut unknowns = vec![0; layers];
        let mut slots = vec![[None; TRACTIONS]; star.triangles.len()];
        for sides in &star.inner {
            let layer = sides.iter().map(|side| star.triangles[side.triangle].layer).min().unwrap_or(0);
            number(sides, layer, &mut unknowns[layer], &mut slots);
        }
        for (sides, supported) in star.ends.iter().zip(&supported) {
            for side in sides {
                let layer = star.triangles[side.triangle].layer;
                support(side, supported, layer, &mut unknowns[layer], &mut slots[side.triangle]);
            }
        }
        // The star as a whole is in equilibrium: conditions of the first sub-triangle, a large one, follow from the others.
        let first = conditions(star, &supported);
        let mut rows = unknowns.clone();
        star.triangles.iter().for_each(|triangle| rows[triangle.layer] += 3);
        rows[0] -= 3 - first.len();
        let columns = loads[0].ncols();
        let mut system = Self {
            slots,
            diagonal: rows.iter().map(|&n| DMatrix::zeros(n, n)).collect(),
            lower: (0..layers).map(|l| DMatrix::zeros(rows[l], if l == 0 { 0 } else { rows[l - 1] })).collect(),
            right: rows.iter().map(|&n| DMatrix::zeros(n, columns)).collect(),
        };
        let mut next = unknowns;
        for (at, (triangle, map)) in star.triangles.iter().zip(maps).enumerate() {
            system.add_energy(at, &(form(map) * weights[triangle.element]), &loads[at]);
            let kept = if at == 0 { &first[..] } else { &[0, 1, 2] };
            let resultants = resultants(&triangle.corners).select_rows(kept);
            system.add_conditions(at, (triangle.layer, next[triangle.layer]), &resultants, &loads[at]);
            next[triangle.layer] += kept.len();
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

    /// Adds the conditions of a sub-triangle as rows of a layer, from one place on.
    fn add_conditions(
        &mut self,
        triangle: usize,
        (layer, first): (usize, usize),
        resultants: &DMatrix<f64>,
        loads: &DMatrix<f64>,
    ) {
        let slots = self.slots[triangle];
        let given = resultants * loads;
        for k in 0..resultants.nrows() {
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
    pub(super) fn solve(mut self, loads: &mut [DMatrix<f64>]) {
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

/// Numbers the tractions of the supported components on a piece of an edge of the outline.
fn support(
    side: &SideOf,
    supported: &[bool; 2],
    layer: usize,
    next: &mut usize,
    slots: &mut [Option<Slot>; TRACTIONS],
) {
    for c in (0..2).filter(|&c| supported[c]) {
        for p in 0..2 {
            slots[4 * side.corner + 2 * p + c] = Some(Slot { layer, at: *next, sign: 1.0 });
            *next += 1;
        }
    }
}

/// The conditions of one sub-triangle that do not follow from those of all others: two forces (0, 1) and the moment (2).
/// Those that follow are the rigid motions of the star on which no support does work.
fn conditions(star: &CutStar, supported: &[[bool; 2]; 2]) -> Vec<usize> {
    let mut needed = [false; 3];
    for (sides, supported) in star.ends.iter().zip(supported) {
        let corners = &star.triangles[sides[0].triangle].corners;
        let [a, b] = [1, 2].map(|k| corners[(sides[0].corner + k) % 3]);
        let way = [(b[0] - a[0]).abs(), (b[1] - a[1]).abs()];
        for c in (0..2).filter(|&c| supported[c]) {
            needed[c] = true;
            // A turn about the node moves an edge along x by its extent in y. Coordinates are known to rounding.
            needed[2] |= way[1 - c] > 1e-12 * way[c];
        }
    }
    (0..3).filter(|&k| needed[k]).collect()
}

/// The matrix of ∫τ:K⁻¹τ in the traction loads of a sub-triangle.
pub(super) fn form(map: &TriangleStress) -> DMatrix<f64> {
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
pub(super) fn resultants(corners: &[[f64; 2]; 3]) -> DMatrix<f64> {
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
