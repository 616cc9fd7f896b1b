//! A ring or the core of a cut star, with its inner edges eliminated.

use super::cut_star::Arc;
use super::panel::Panel;
use nalgebra::{DMatrix, Dim, Matrix, Matrix4, StorageMut, U4};

/// A chain of sub-triangles. Similar rings have one layer in common: their forms are equal in forces.
///
/// Displacements and forces have four rows for each edge, two components at either end of it.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    pub(super) panels: Vec<Panel>,
    /// Arcs on one side.
    sectors: usize,
    /// Of the elimination along the chain: pivots, and the rows of the factor beside them.
    pivots: Vec<Pivot>,
    beside: Vec<Matrix4<f64>>,
    /// Displacements of the chain under unit displacements of the arcs, with the other sign.
    response: DMatrix<f64>,
    /// Stiffness of the arcs, the outer ones first.
    pub(super) stiffness: DMatrix<f64>,
}

/// The displacements and forces of a layer under several loads, one in each column.
#[derive(Clone, Debug)]
pub(super) struct LayerState {
    /// Of the edges of the chain.
    pub(super) displacement: DMatrix<f64>,
    /// On the left panel of each edge of the chain.
    pub(super) force: DMatrix<f64>,
    /// On this layer at its outer arcs.
    pub(super) outer: DMatrix<f64>,
}

impl Layer {
    /// `supported` are the components on the first and the last edge that cannot move.
    pub(super) fn new(panels: Vec<Panel>, sectors: usize, supported: &[[bool; 2]; 2]) -> Self {
        let arcs = if panels.iter().any(|panel| panel.triangle.arc == Arc::Inner) { 2 * sectors } else { sectors };
        let edges = panels.len() + 1;
        let mut diagonal = vec![Matrix4::zeros(); edges];
        let mut response = DMatrix::zeros(4 * edges, 4 * arcs);
        let mut stiffness = DMatrix::zeros(4 * arcs, 4 * arcs);
        let mut layer = Self {
            panels,
            sectors,
            pivots: Vec::new(),
            beside: Vec::new(),
            response: DMatrix::zeros(0, 0),
            stiffness: DMatrix::zeros(0, 0),
        };
        for (k, panel) in layer.panels.iter().enumerate() {
            let arc = layer.arc(k);
            diagonal[k] += block(panel, 0, 0);
            diagonal[k + 1] += block(panel, 1, 1);
            response.fixed_view_mut::<4, 4>(4 * k, 4 * arc).copy_from(&block(panel, 0, 2));
            response.fixed_view_mut::<4, 4>(4 * (k + 1), 4 * arc).copy_from(&block(panel, 1, 2));
            stiffness.fixed_view_mut::<4, 4>(4 * arc, 4 * arc).copy_from(&block(panel, 2, 2));
        }
        let last = edges - 1;
        for (k, mut pivot) in diagonal.into_iter().enumerate() {
            if let Some(beside) = layer.beside.last() {
                pivot -= beside.transpose() * beside;
            }
            let held = [(0, supported[0]), (last, supported[1])];
            let held = held.into_iter().filter(|(at, _)| *at == k).flat_map(|(_, of)| [of[0], of[1]]);
            let pivot = Pivot::new(pivot, &held.collect::<Vec<_>>());
            if let Some(panel) = layer.panels.get(k) {
                let mut beside = block(panel, 0, 1);
                pivot.forward(&mut beside);
                layer.beside.push(beside);
            }
            layer.pivots.push(pivot);
        }
        layer.solve(&mut response);
        for (k, panel) in layer.panels.iter().enumerate() {
            for side in 0..2 {
                let moved = block(panel, 2, side) * response.fixed_rows::<4>(4 * (k + side));
                let mut rows = stiffness.fixed_rows_mut::<4>(4 * layer.arc(k));
                rows -= moved;
            }
        }
        Self { response, stiffness, ..layer }
    }

    /// The arc of a panel.
    fn arc(&self, panel: usize) -> usize {
        let triangle = &self.panels[panel].triangle;
        triangle.sector + if triangle.arc == Arc::Inner { self.sectors } else { 0 }
    }

    /// From forces on the edges of the chain to their displacements, with the arcs at rest.
    fn solve(&self, all: &mut DMatrix<f64>) {
        for (k, pivot) in self.pivots.iter().enumerate() {
            pivot.forward(&mut all.fixed_rows_mut::<4>(4 * k));
            if let Some(beside) = self.beside.get(k) {
                let (here, mut next) = all.rows_range_pair_mut(4 * k..4 * k + 4, 4 * k + 4..4 * k + 8);
                next -= beside.transpose() * here;
            }
        }
        for (k, pivot) in self.pivots.iter().enumerate().rev() {
            if let Some(beside) = self.beside.get(k) {
                let (mut here, next) = all.rows_range_pair_mut(4 * k..4 * k + 4, 4 * k + 4..4 * k + 8);
                here -= beside * next;
            }
            pivot.lower.tr_solve_lower_triangular_unchecked_mut(&mut all.fixed_rows_mut::<4>(4 * k));
        }
    }

    /// The forces of given tractions on the first and the last edge, taken to the arcs.
    pub(super) fn at_arcs(&self, given: &[DMatrix<f64>; 2]) -> DMatrix<f64> {
        let last = 4 * self.panels.len();
        -(self.response.rows(0, 4).tr_mul(&given[0]) + self.response.rows(last, 4).tr_mul(&given[1]))
    }

    /// The state under displacements of the arcs and given tractions on the first and the last edge. The forces of
    /// `supported` components are those of the supports.
    pub(super) fn state(
        &self,
        arcs: &DMatrix<f64>,
        given: &[DMatrix<f64>; 2],
        supported: &[[bool; 2]; 2],
    ) -> LayerState {
        let (columns, last) = (arcs.ncols(), self.panels.len());
        let mut displacement = DMatrix::zeros(4 * (last + 1), columns);
        displacement.fixed_rows_mut::<4>(0).copy_from(&given[0]);
        displacement.fixed_rows_mut::<4>(4 * last).copy_from(&given[1]);
        for (k, panel) in self.panels.iter().enumerate() {
            let arc = arcs.fixed_rows::<4>(4 * self.arc(k));
            for side in 0..2 {
                let mut rows = displacement.fixed_rows_mut::<4>(4 * (k + side));
                rows -= block(panel, side, 2) * arc;
            }
        }
        self.solve(&mut displacement);
        let mut force = DMatrix::zeros(4 * (last + 1), columns);
        let mut outer = DMatrix::zeros(4 * self.sectors, columns);
        let on = |k: usize, side: usize| {
            let panel = &self.panels[k];
            block(panel, side, 0) * displacement.fixed_rows::<4>(4 * k)
                + block(panel, side, 1) * displacement.fixed_rows::<4>(4 * (k + 1))
                + block(panel, side, 2) * arcs.fixed_rows::<4>(4 * self.arc(k))
        };
        for (k, panel) in self.panels.iter().enumerate() {
            force.fixed_rows_mut::<4>(4 * k).copy_from(&on(k, 0));
            if panel.triangle.arc == Arc::Outer {
                outer.fixed_rows_mut::<4>(4 * self.arc(k)).copy_from(&on(k, 2));
            }
        }
        force.fixed_rows_mut::<4>(4 * last).copy_from(&-on(last - 1, 1));
        for (end, (at, sign)) in [(0, 1.0), (last, -1.0)].into_iter().enumerate() {
            for row in (0..4).filter(|row| !supported[end][row % 2]) {
                force.row_mut(4 * at + row).copy_from(&(sign * given[end].row(row)));
            }
        }
        LayerState { displacement, force, outer }
    }

    /// The loads of a panel. `inner` are the forces on the next layer at its outer arcs.
    pub(super) fn loads(&self, panel: usize, state: &LayerState, inner: Option<&DMatrix<f64>>) -> DMatrix<f64> {
        let mut loads = DMatrix::zeros(super::panel::LOADS, state.force.ncols());
        loads.fixed_rows_mut::<4>(0).copy_from(&state.force.fixed_rows::<4>(4 * panel));
        loads.fixed_rows_mut::<4>(4).copy_from(&-state.force.fixed_rows::<4>(4 * (panel + 1)));
        let triangle = &self.panels[panel].triangle;
        match inner {
            Some(inner) if triangle.arc == Arc::Inner => {
                loads.fixed_rows_mut::<4>(8).copy_from(&-inner.fixed_rows::<4>(4 * triangle.sector));
            }
            _ => loads.fixed_rows_mut::<4>(8).copy_from(&state.outer.fixed_rows::<4>(4 * triangle.sector)),
        }
        loads
    }
}

/// The stiffness between two sides of a panel.
pub(super) fn block(panel: &Panel, row: usize, column: usize) -> Matrix4<f64> {
    panel.stiffness.fixed_view::<4, 4>(4 * row, 4 * column).into_owned()
}

/// The factor of a pivot, with no displacement of the components that are held.
///
/// In an almost incompressible or slender sub-triangle the pivot is almost singular: products with its inverse would
/// lose twice as many digits as solutions with its factor.
#[derive(Clone, Debug)]
struct Pivot {
    lower: Matrix4<f64>,
    free: [bool; 4],
}

impl Pivot {
    /// `held` are components at both nodes of the edge.
    fn new(mut pivot: Matrix4<f64>, held: &[bool]) -> Self {
        let free = std::array::from_fn(|k| held.get(k % 2).is_none_or(|held| !held));
        for k in (0..4).filter(|&k| !free[k]) {
            pivot.row_mut(k).fill(0.0);
            pivot.column_mut(k).fill(0.0);
            pivot[(k, k)] = 1.0;
        }
        // Forms are definite where the arcs are at rest.
        match pivot.cholesky() {
            Some(factor) => Self { lower: factor.unpack(), free },
            None => Self { lower: Matrix4::identity(), free: [false; 4] },
        }
    }

    /// Solves with the lower factor.
    fn forward<C: Dim, S: StorageMut<f64, U4, C>>(&self, forces: &mut Matrix<f64, U4, C, S>) {
        (0..4).filter(|&k| !self.free[k]).for_each(|k| forces.row_mut(k).fill(0.0));
        self.lower.solve_lower_triangular_unchecked_mut(forces);
    }
}
