//! A non-matching interface.

use super::coupling::Coupling;
use super::side::Side;
use crate::contact::coulomb::Coulomb;
use crate::contact::frame::{Frame, dot};
use crate::contact::surface::ContactSurface;

/// The constant data of a non-matching interface: the slave, whose nodes have the multipliers, the
/// master, and the constant frame.
#[derive(Clone, Debug, PartialEq)]
pub struct NonMatchingSurfaces<const D: usize> {
    sides: [Side; 2],
    frame: Frame<D>,
    tangent: [f64; D],
    law: Coulomb,
    tolerance: f64,
}

/// The tangent of an interface: its normal, turned by a quarter.
pub(crate) fn tangent<const D: usize>(normal: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|c| if c == 0 { normal[D - 1] } else { -normal[D - 1 - c] })
}

impl<const D: usize> NonMatchingSurfaces<D> {
    /// From slave and master, which is of one body, with the unit normal from the master to the slave. Nodes nearer
    /// than `tolerance` (m) along the interface are at one place.
    pub(crate) fn new(sides: [Side; 2], normal: [f64; D], law: Coulomb, tolerance: f64) -> Self {
        Self { sides, frame: Frame::new(normal), tangent: tangent(&normal), law, tolerance }
    }

    /// The slave: its nodes have the multipliers. It may belong to several bodies.
    #[inline]
    #[must_use]
    pub fn slave(&self) -> &Side {
        &self.sides[0]
    }

    /// The master.
    #[inline]
    #[must_use]
    pub fn master(&self) -> &Side {
        &self.sides[1]
    }

    /// The positions of all nodes in the contact surface: first those of the slave.
    pub fn positions(&self) -> impl Iterator<Item = usize> + '_ {
        self.sides.iter().flat_map(|side| (0..side.len()).map(|node| side.position(node)))
    }

    /// The frame: its normal n points from the master to the slave.
    #[inline]
    #[must_use]
    pub fn frame(&self) -> &Frame<D> {
        &self.frame
    }

    /// The unit tangent t, along which ξ grows.
    #[inline]
    #[must_use]
    pub fn tangent(&self) -> &[f64; D] {
        &self.tangent
    }

    /// Nodes nearer than this along the interface are at one place (m).
    pub(in crate::contact) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The law of contact.
    #[inline]
    #[must_use]
    pub fn law(&self) -> Coulomb {
        self.law
    }

    /// How far each part of the slave has moved along the tangent against the master (m), from the tangential
    /// displacements of their nodes: the difference of the means over both surfaces, by length. A part on a line of
    /// symmetry moves as its nodes there do, if they go with it at the start.
    ///
    /// The mean over the bodies, Σmu/Σm, is not better: D and M take linear fields exactly at any shift, so that
    /// momentum, the couple of the normal forces at these places, and a uniform pressure are exact to rounding with
    /// either. It would need all nodes of both bodies at each step, and would move the surfaces where a body turns
    /// about its centre.
    #[must_use]
    pub fn shifts(&self, slave: impl Fn(usize) -> f64, master: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut shifts = Vec::new();
        self.find_shifts(&mut shifts, slave, master);
        shifts
    }

    /// The same in memory at hand.
    pub(super) fn find_shifts(
        &self,
        shifts: &mut Vec<f64>,
        slave: impl Fn(usize) -> f64,
        master: impl Fn(usize) -> f64,
    ) {
        let [own, other] = &self.sides;
        let fixed: f64 = other.parts().iter().map(|part| other.motion_of(part, &master)).sum();
        shifts.clear();
        shifts.extend(own.parts().iter().map(|part| own.motion_of(part, &slave) - fixed));
    }

    /// D, M and the weights where each part of the slave has moved so far against the master (m).
    #[must_use]
    pub fn coupling_at(&self, shifts: &[f64]) -> Coupling {
        let mut coupling = Coupling::default();
        self.update(&mut coupling, shifts);
        coupling
    }

    /// The same with these displacements of all nodes of the mesh (m). Those of the step after t_n are the predicted
    /// ones, u_n + Δt_n (v_{n−½} + h_n M⁻¹(F_n − K u_n)), without contact.
    #[must_use]
    pub fn coupling(&self, surface: &ContactSurface<D>, displacement: &[[f64; D]]) -> Coupling {
        let along = |side: &Side, node| self.along(surface, side, node, displacement);
        self.coupling_at(&self.shifts(|node| along(self.slave(), node), |node| along(self.master(), node)))
    }

    /// The multipliers λ (N/m) of a step, in global axes, from the rows of the slave among the forces on the nodes of
    /// the contact surface (N). `coupling` is that of the predicted displacements.
    #[must_use]
    pub fn multipliers(&self, coupling: &Coupling, reaction: &[[f64; D]]) -> Vec<[f64; D]> {
        let slave = self.slave();
        let component = |c: usize| {
            let force: Vec<f64> = (0..slave.len()).map(|node| reaction[slave.position(node)][c]).collect();
            coupling.multipliers(&force)
        };
        let components: [Vec<f64>; D] = std::array::from_fn(component);
        (0..slave.len()).map(|node| std::array::from_fn(|c| components[c][node])).collect()
    }

    /// Puts the forces of the multipliers, R_k = w_k λ_k on the slave and nothing on the master, in the place of those
    /// on the nodes (N), by their positions in the contact surface. `coupling` is that of the predicted displacements.
    pub fn gather(&self, coupling: &Coupling, reaction: &[[f64; D]], forces: &mut [[f64; D]]) {
        self.positions().for_each(|at| forces[at] = [0.0; D]);
        for (k, multiplier) in self.multipliers(coupling, reaction).iter().enumerate() {
            forces[self.slave().position(k)] = multiplier.map(|value| coupling.weight(k) * value);
        }
    }

    /// The master touches where a node of the slave that touches acts on it.
    pub(super) fn settle_master(&self, coupling: &Coupling, touching: &mut [bool]) {
        let (slave, master) = (self.slave(), self.master());
        (0..master.len()).for_each(|node| touching[master.position(node)] = false);
        for k in 0..coupling.len() {
            if touching[slave.position(k)] {
                coupling.acts_on(k).for_each(|node| touching[master.position(node)] = true);
            }
        }
    }

    /// The place of a node of a side along the normal (m), with these displacements of all nodes of the mesh.
    pub(crate) fn eta(&self, surface: &ContactSurface<D>, side: &Side, node: usize, displacement: &[[f64; D]]) -> f64 {
        let node_of_mesh = surface.nodes()[side.position(node)].node;
        side.eta()[node] + dot(&displacement[node_of_mesh.index()], self.frame.normal())
    }

    /// The tangential component of a field at a node of a side.
    pub(super) fn along(&self, surface: &ContactSurface<D>, side: &Side, node: usize, field: &[[f64; D]]) -> f64 {
        dot(&field[surface.nodes()[side.position(node)].node.index()], &self.tangent)
    }

    pub(super) fn update(&self, coupling: &mut Coupling, shifts: &[f64]) {
        coupling.update(self.sides.each_ref(), shifts, self.tolerance);
    }
}
