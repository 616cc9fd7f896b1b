//! The tractions between sub-triangles that make the energy least.
//!
//! They are those of the displacements of all edges under which the tractions of both sides of each inner edge cancel.
//! Each ring is first reduced to its arcs; then the arcs are eliminated from the node to the outline.

use super::cut_star::{Arc, CutStar};
use super::layer::{Layer, LayerState, block};
use super::panel::{LOADS, Panel};
use crate::residual::worse;
use nalgebra::{Cholesky, DMatrix, SMatrix};

/// Sub-triangles with smaller resultants, of loads near 1, are in equilibrium but for rounding.
const BALANCED: f64 = 1e-13;

/// In slender elements, stiffness and rounding are larger. One refinement leaves the square of the error.
const REFINEMENTS: usize = 3;

/// A cut star under several loads.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    pub(super) parts: SubTriangles,
    /// Those of each ring, from the outline to the node, then of the core.
    pub(super) states: Vec<LayerState>,
}

/// The sub-triangles of a cut star.
#[derive(Clone, Debug)]
pub(super) struct SubTriangles {
    /// The triangles at the outline.
    pub(super) outline: Vec<Panel>,
    /// Different rings, then the core.
    pub(super) layers: Vec<Layer>,
    /// Position in `layers` and outer radius of each ring, from the outline to the node, then of the core.
    pub(super) rings: Vec<(usize, f64)>,
}

impl SubTriangles {
    fn layer(&self, ring: usize) -> &Layer {
        &self.layers[self.rings[ring].0]
    }
}

/// The factors of the elimination of arcs, from the node to the outline.
struct Elimination {
    /// Of the inner arcs of each ring, the innermost first: the lower factor, and its solution for the outer arcs.
    rings: Vec<[DMatrix<f64>; 2]>,
    /// Of the outer arcs of the first ring.
    last: DMatrix<f64>,
}

impl Elimination {
    fn new(parts: &SubTriangles, arcs: usize, free: &[usize]) -> Self {
        let stiffness = |ring: usize| &parts.layer(ring).stiffness;
        let core = parts.rings.len() - 1;
        let mut reduced = stiffness(core).clone();
        let mut rings = Vec::with_capacity(core);
        for ring in (0..core).rev() {
            let whole = stiffness(ring);
            let lower = factor(whole.view((arcs, arcs), (arcs, arcs)) + reduced);
            let mut upper = whole.view((arcs, 0), (arcs, arcs)).into_owned();
            lower.solve_lower_triangular_unchecked_mut(&mut upper);
            reduced = whole.view((0, 0), (arcs, arcs)) - upper.tr_mul(&upper);
            rings.push([lower, upper]);
        }
        add_outline(&mut reduced, &parts.outline, free);
        Self { rings, last: factor(reduced) }
    }

    /// The displacements of the arcs of each ring under forces on them; outer arcs first.
    fn solve(&self, mut forces: Vec<DMatrix<f64>>) -> Vec<DMatrix<f64>> {
        let (arcs, core) = (self.last.nrows(), self.rings.len());
        for (k, [lower, upper]) in self.rings.iter().enumerate() {
            let mut inner = forces[core - 1 - k].rows(arcs, arcs) + forces[core - k].rows(0, arcs);
            lower.solve_lower_triangular_unchecked_mut(&mut inner);
            let mut outer = forces[core - 1 - k].rows_mut(0, arcs);
            outer -= upper.tr_mul(&inner);
            forces[core - 1 - k].rows_mut(arcs, arcs).copy_from(&inner);
        }
        let mut displacement = forces[0].rows(0, arcs).into_owned();
        self.last.solve_lower_triangular_unchecked_mut(&mut displacement);
        self.last.tr_solve_lower_triangular_unchecked_mut(&mut displacement);
        for (both, [lower, upper]) in forces.iter_mut().zip(self.rings.iter().rev()) {
            let mut inner = both.rows(arcs, arcs) - upper * &displacement;
            lower.tr_solve_lower_triangular_unchecked_mut(&mut inner);
            both.rows_mut(0, arcs).copy_from(&displacement);
            both.rows_mut(arcs, arcs).copy_from(&inner);
            displacement = inner;
        }
        forces[core] = displacement;
        forces
    }
}

impl Solved {
    /// `given` are the forces of tractions on the pieces of the first and the last edge, ring by ring; `supported` the
    /// components there whose tractions are unknown.
    pub(super) fn new(
        star: &CutStar,
        parts: SubTriangles,
        given: &[[DMatrix<f64>; 2]],
        supported: &[[bool; 2]; 2],
    ) -> Self {
        let elimination = Elimination::new(&parts, 4 * star.sectors(), &free_motions(star, supported));
        let forces = given.iter().enumerate().map(|(ring, given)| parts.layer(ring).at_arcs(given)).collect();
        let displacements = elimination.solve(forces);
        let state = |(ring, (arcs, given)): (usize, (&DMatrix<f64>, &[DMatrix<f64>; 2]))| {
            parts.layer(ring).state(arcs, given, supported)
        };
        let states = displacements.iter().zip(given).enumerate().map(state).collect();
        let mut solved = Self { parts, states };
        for _ in 0..REFINEMENTS {
            if solved.imbalance() < BALANCED {
                break;
            }
            solved.refine(&elimination, supported);
        }
        solved
    }

    /// The largest resultant or moment of a sub-triangle, of loads near 1.
    fn imbalance(&self) -> f64 {
        let mut largest = 0.0;
        self.each(|panel, _, loads| largest = worse(largest, (panel.resultants * loads).amax()));
        largest
    }

    /// Takes the resultants that rounding has left in sub-triangles to their arcs, and balances them in the star.
    fn refine(&mut self, elimination: &Elimination, supported: &[[bool; 2]; 2]) {
        let columns = self.states[0].force.ncols();
        let arcs = |ring: usize| self.parts.layer(ring).stiffness.nrows();
        let mut forces: Vec<_> = (0..self.states.len()).map(|ring| DMatrix::zeros(arcs(ring), columns)).collect();
        let mut taken: Vec<_> = self.states.iter().map(|state| DMatrix::zeros(state.outer.nrows(), columns)).collect();
        self.each(|panel, ring, loads| {
            let triangle = &panel.triangle;
            let side = if triangle.arc == Arc::Outline { 0 } else { 2 };
            let rest = panel.to_side(side) * loads;
            let inner = if triangle.arc == Arc::Inner { 2 * self.parts.outline.len() } else { 0 };
            let mut rows = forces[ring].rows_mut(4 * (triangle.sector + inner), 4);
            rows += &rest;
            if triangle.arc == Arc::Outer {
                let mut rows = taken[ring].rows_mut(4 * triangle.sector, 4);
                rows += &rest;
            }
        });
        let none = [(); 2].map(|()| DMatrix::zeros(4, columns));
        for (ring, displacement) in elimination.solve(forces).iter().enumerate() {
            let change = self.parts.layer(ring).state(displacement, &none, supported);
            let state = &mut self.states[ring];
            state.displacement += change.displacement;
            state.force += change.force;
            state.outer += change.outer - &taken[ring];
        }
    }

    /// Calls `with` for each sub-triangle, the position of its ring, 0 at the outline, and its loads.
    pub(super) fn each(&self, mut with: impl FnMut(&Panel, usize, &DMatrix<f64>)) {
        let outer = &self.states[0].outer;
        for panel in &self.parts.outline {
            let mut loads = DMatrix::zeros(LOADS, outer.ncols());
            loads.rows_mut(0, 8).copy_from(&-outer.rows(4 * panel.triangle.sector, 8));
            with(panel, 0, &loads);
        }
        for (ring, state) in self.states.iter().enumerate() {
            let layer = self.parts.layer(ring);
            let inner = self.states.get(ring + 1).map(|state| &state.outer);
            for (k, panel) in layer.panels.iter().enumerate() {
                with(panel, ring, &layer.loads(k, state, inner));
            }
        }
    }

    /// The work of the forces on one edge of the star, with those on the element at its left (counterclockwise).
    pub(super) fn work(&self, edge: usize) -> DMatrix<f64> {
        let columns = self.states[0].force.ncols();
        let [mut forces, mut displacements] = [(); 2].map(|()| DMatrix::zeros(4 * self.states.len(), columns));
        for (ring, state) in self.states.iter().enumerate() {
            // The core has no diagonals.
            let at = if ring + 1 == self.states.len() { 2 * edge } else { 4 * edge };
            forces.fixed_rows_mut::<4>(4 * ring).copy_from(&state.force.fixed_rows::<4>(4 * at));
            displacements.fixed_rows_mut::<4>(4 * ring).copy_from(&state.displacement.fixed_rows::<4>(4 * at));
        }
        forces.tr_mul(&displacements)
    }
}

/// The lower factor of a definite matrix.
fn factor(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let size = matrix.nrows();
    // Stars that are not degenerate have definite forms; others would show in the residuals.
    Cholesky::new(matrix).map_or_else(|| DMatrix::identity(size, size), Cholesky::unpack)
}

/// Adds the stiffness of the triangles at the outline, which is free. Springs hold the motions of the whole star in
/// which nothing else does work; the loads balance, so that springs carry nothing.
fn add_outline(stiffness: &mut DMatrix<f64>, outline: &[Panel], free: &[usize]) {
    for (k, panel) in outline.iter().enumerate() {
        let mut panel = panel.clone();
        let springs = if k == 0 { free } else { &[] };
        for row in springs.iter().map(|&motion| panel.resultants.row(motion).into_owned()) {
            panel.stiffness += row.transpose() * row * (panel.stiffness.trace() / LOADS as f64);
        }
        let mut moved: SMatrix<f64, 4, 8> = panel.stiffness.fixed_view::<4, 8>(8, 0).into_owned();
        // Definite: the side is free.
        match block(&panel, 2, 2).cholesky() {
            Some(factor) => factor.l_dirty().solve_lower_triangular_unchecked_mut(&mut moved),
            None => moved.fill(0.0),
        }
        let own = panel.stiffness.fixed_view::<8, 8>(0, 0) - moved.transpose() * moved;
        let mut view = stiffness.view_mut((8 * k, 8 * k), (8, 8));
        view += own;
    }
}

/// The rigid motions of the star on which no support does work: along x (0), along y (1), and a turn (2).
fn free_motions(star: &CutStar, supported: &[[bool; 2]; 2]) -> Vec<usize> {
    let mut held = [false; 3];
    for (way, supported) in [star.rays[0], star.rays[star.sectors()]].iter().zip(supported) {
        for c in (0..2).filter(|&c| supported[c]) {
            held[c] = true;
            // A turn about the node moves an edge along x by its extent in y. Coordinates are known to rounding.
            held[2] |= way[1 - c].abs() > 1e-12 * way[c].abs();
        }
    }
    (0..3).filter(|&k| !held[k]).collect()
}
