//! Forces of non-matching interfaces.
//!
//! The nodal forces of the simulation, Dᵀλ and −Mᵀλ, are those of multipliers of the nodes of the slave. The force of
//! such a node is R_k = w_k λ_k; its density has the same resultant on both surfaces, and the moment of the reactions
//! by a correction over all nodes that act. Where edges of the slave leave the master, the density of a node is hats.

use super::concentration::{Concentration, Faced, Reach};
use super::impulse_smoothing::Stopped;
use super::moment_correction::{CorrectedNode, Group};
use crate::concentrated::TractionShape;
use crate::contact_density::{NonMatchingDensity, NonMatchingFaces, SlaveHat};
use crate::direction::along;
use crate::partition::pieces;
use percute_core::contact::{Coupling, DualShape, NonMatchingSurfaces, Part, Segment, Side};
use percute_core::history::State;
use percute_core::ids::ElementId;
use percute_core::material::{Law, LinearLaw};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::ops::Range;
use std::sync::Arc;

/// The forces of all non-matching interfaces.
#[derive(Debug)]
pub(super) struct NonMatchingForces<'p, const D: usize> {
    problem: &'p Problem<D>,
    faces: Arc<[NonMatchingFaces]>,
    /// Mean impedance ρc over slave and master of each pair of surfaces, times the thickness (kg/(m s)).
    impedance: Vec<[f64; 2]>,
    /// The compliance of both surfaces over that of the slave.
    compliance: Vec<f64>,
    /// Which nodes of the contact surface are on a line of symmetry.
    on_line: Vec<bool>,
}

impl<'p, const D: usize> NonMatchingForces<'p, D> {
    pub(super) fn new(problem: &'p Problem<D>) -> Self {
        let mean = |non_matching: &NonMatchingSurfaces<D>, of: fn(&Problem<D>, ElementId) -> f64| {
            [non_matching.slave(), non_matching.master()]
                .map(|side| mean(problem, side, |element| of(problem, element)))
        };
        let all = problem.surface().non_matching();
        let both = |[slave, master]: [f64; 2]| 1.0 + master / slave;
        Self {
            problem,
            faces: NonMatchingFaces::all(problem).into(),
            impedance: all.iter().map(|non_matching| mean(non_matching, impedance)).collect(),
            compliance: all.iter().map(|non_matching| both(mean(non_matching, compliance))).collect(),
            on_line: problem.on_lines_of_symmetry(),
        }
    }

    /// The forces of the nodes of the contact surface (N) at a step: on slaves R_k, on masters nothing, elsewhere the
    /// reactions.
    pub(super) fn of(&self, times: &TimeGrid, state: &State<'_>) -> Vec<[f64; D]> {
        let (surface, step) = (self.problem.surface(), state.step());
        let mut forces = step.reaction().to_vec();
        for non_matching in surface.non_matching() {
            if non_matching.positions().all(|at| step.reaction::<D>()[at] == [0.0; D]) {
                continue;
            }
            // D and M of the step are those of the place at its end without contact.
            let (length, h) = (times.step(step.index), times.velocity_step(step.index));
            let predicted = |side: &Side, k: usize| {
                let at = side.position(k);
                let node = surface.nodes()[at].node.index();
                let (acceleration, mass) = (state.acceleration_of::<D>(node), self.problem.mass()[node]);
                let place: [f64; D] = std::array::from_fn(|c| {
                    let velocity =
                        state.half_step::<D>()[node][c] + h * (acceleration[c] - step.reaction::<D>()[at][c] / mass);
                    step.displacement::<D>()[node][c] + length * velocity
                });
                along(&place, non_matching.tangent())
            };
            let shifts =
                non_matching.shifts(|k| predicted(non_matching.slave(), k), |k| predicted(non_matching.master(), k));
            let coupling = non_matching.coupling_at(&shifts);
            non_matching.gather(&coupling, step.reaction(), &mut forces);
        }
        forces
    }

    /// What a force of each node of a slave stops, with the coupling at an instant and total accelerations (m/s²), by
    /// the position in the contact surface.
    pub(super) fn stopped(
        &self,
        couplings: &[Arc<Coupling>],
        acceleration: impl Fn(usize) -> [f64; D],
    ) -> Vec<Option<Stopped>> {
        let (surface, mass) = (self.problem.surface(), self.problem.mass());
        let mut stopped = vec![None; if couplings.is_empty() { 0 } else { surface.nodes().len() }];
        for ((non_matching, coupling), [own, other]) in
            surface.non_matching().iter().zip(couplings).zip(&self.impedance)
        {
            let node = |side: &Side, k: usize| surface.nodes()[side.position(k)].node.index();
            let inward = |side: &Side, k: usize| along(&acceleration(node(side, k)), non_matching.frame().normal());
            for k in (0..coupling.len()).filter(|&k| coupling.is_active(k)) {
                let weight = coupling.weight(k);
                let inverse = |side, k| 1.0 / mass[node(side, k)];
                let mobility =
                    mobility(coupling, k, |k| inverse(non_matching.slave(), k), |k| inverse(non_matching.master(), k));
                let moved = weight * weight / mobility;
                let relative =
                    coupling.difference(k, |k| inward(non_matching.slave(), k), |k| inward(non_matching.master(), k));
                stopped[non_matching.slave().position(k)] = Some(Stopped {
                    mass: moved,
                    time: moved * (1.0 / own + 1.0 / other) / weight,
                    acceleration: relative / weight,
                });
            }
        }
        stopped
    }

    /// Moves forces of nodes of a slave that no longer act to the nearest ones of their body that do.
    pub(super) fn gather(&self, couplings: &[Arc<Coupling>], forces: &mut [[f64; D]]) {
        for (non_matching, coupling) in self.problem.surface().non_matching().iter().zip(couplings) {
            for k in (0..coupling.len()).filter(|&k| !coupling.is_active(k)) {
                let at = non_matching.slave().position(k);
                let force = std::mem::replace(&mut forces[at], [0.0; D]);
                let own = non_matching.slave().parts()[non_matching.slave().part_of(k)].nodes.clone();
                let nearest = own.filter(|&k| coupling.is_active(k)).min_by_key(|other| other.abs_diff(k));
                if let Some(nearest) = nearest.filter(|_| force != [0.0; D]) {
                    let to = &mut forces[non_matching.slave().position(nearest)];
                    (0..D).for_each(|c| to[c] += force[c]);
                }
            }
        }
    }

    /// Adds what the nodes of slaves face, if their tractions may be hats, to that of all nodes of the contact surface.
    /// Beside the end of the master, hats are within the part of the edge that it faces.
    pub(super) fn add_faced(
        &self,
        concentration: &Concentration<D>,
        couplings: &[Arc<Coupling>],
        faced: &mut [Option<Faced>],
    ) {
        for ((non_matching, coupling), compliance) in
            self.problem.surface().non_matching().iter().zip(couplings).zip(&self.compliance)
        {
            let slave = non_matching.slave();
            for k in (0..slave.len()).filter(|&k| coupling.is_active(k)) {
                let (at, Some([before, after])) = (slave.position(k), reaches(slave, coupling, k)) else { continue };
                let reach = |far: usize| if slave.node_at(far).is_some_and(|far| far < k) { before } else { after };
                faced[at] = Some(concentration.faced(at, *compliance, reach));
            }
        }
    }

    /// Gives the forces of slaves (N) the moment of their reactions, body by body.
    pub(super) fn correct_moments(
        &self,
        couplings: &[Arc<Coupling>],
        centroid: &dyn Fn(usize) -> Option<[f64; D]>,
        forces: &mut [[f64; D]],
    ) {
        for (non_matching, coupling) in self.problem.surface().non_matching().iter().zip(couplings) {
            self.groups(non_matching, coupling).iter().for_each(|group| group.apply(forces, &[], centroid));
        }
    }

    /// The densities of such forces, with shapes of their tractions.
    pub(super) fn densities<'a>(
        &self,
        shaped: &impl Fn(usize) -> Option<(&'a Concentration<D>, &'a TractionShape)>,
        couplings: &[Arc<Coupling>],
        forces: &[[f64; D]],
    ) -> Vec<NonMatchingDensity<D>> {
        let density = |(non_matching, coupling): (&NonMatchingSurfaces<D>, &Arc<Coupling>)| {
            let slave = non_matching.slave();
            let mut hats = Vec::new();
            for k in 0..slave.len() {
                let at = slave.position(k);
                let Some((concentration, shape)) = shaped(at) else { continue };
                for (far, halvings, resultant) in concentration.shares(at, shape, &forces[at]) {
                    let end = slave.node_at(far).map(|far| usize::from(far < k));
                    hats.extend(end.and_then(|end| SlaveHat::new(slave, (k, end), halvings, resultant)));
                }
            }
            let wide =
                |k: usize| if shaped(slave.position(k)).is_some() { [0.0; D] } else { forces[slave.position(k)] };
            NonMatchingDensity::new(coupling, wide, hats)
        };
        self.problem.surface().non_matching().iter().zip(couplings).map(density).collect()
    }

    /// All nodes of a slave that act, with the centroids of their densities; those of each body by themselves. Bodies
    /// with a line of symmetry that crosses both surfaces are left out.
    fn groups(&self, non_matching: &NonMatchingSurfaces<D>, coupling: &Coupling) -> Vec<Group<D>> {
        let slave = non_matching.slave();
        // ∫χξ, ∫(ψ − χ)ξ and ∫(ψ − χ)η of each node.
        let mut moments = vec![[0.0; 3]; slave.len()];
        for piece in pieces(non_matching, coupling) {
            let [edge, first] = piece.slave;
            let shape = coupling.shape(edge);
            let (dual, density) = (piece.on_slave.map(|s| shape.dual(s)), piece.on_slave.map(|s| shape.density(s)));
            let eta = piece.slave_values(|node| slave.eta()[node]);
            for k in 0..2 {
                let own = density.map(|both| both[k]);
                let apart = [0, 1].map(|end| dual[end][k] - own[end]);
                let sums =
                    [piece.product(own, piece.ends), piece.product(apart, piece.ends), piece.product(apart, eta)];
                moments[first + k].iter_mut().zip(sums).for_each(|(moment, sum)| *moment += sum);
            }
        }
        let node = |(k, moments): (usize, &[f64; 3])| {
            let [centroid, along, across] = moments.map(|moment| moment / coupling.weight(k));
            let at = slave.position(k);
            let node = self.problem.surface().nodes()[at].node.index();
            CorrectedNode { at, node, centroid, lever: [along, across] }
        };
        let crosses = |side: &Side, nodes: Range<usize>| nodes.into_iter().any(|k| self.on_line[side.position(k)]);
        let master = non_matching.master();
        let is_free = |part: &&Part| !(crosses(slave, part.nodes.clone()) && crosses(master, 0..master.len()));
        let of_part = |part: &Part| {
            let acting = part.nodes.clone().filter(|&k| coupling.is_active(k)).map(|k| node((k, &moments[k])));
            Group::new(*non_matching.frame().normal(), *non_matching.tangent(), non_matching.law(), acting.collect())
        };
        slave.parts().iter().filter(is_free).map(of_part).collect()
    }

    pub(super) fn faces(&self) -> &Arc<[NonMatchingFaces]> {
        &self.faces
    }
}

/// A_kk = Σ D_ki²/m_i + Σ M_kj²/m_j (m²/kg), from 1/m of the nodes of slave and master.
pub(super) fn mobility(
    coupling: &Coupling,
    k: usize,
    slave: impl Fn(usize) -> f64,
    master: impl Fn(usize) -> f64,
) -> f64 {
    let acts = coupling.slave_row(k).into_iter().enumerate().filter(|(_, value)| *value != 0.0);
    let own: f64 = acts.map(|(at, value)| value * value * slave(k + at - 1)).sum();
    let (first, row) = coupling.master_row(k);
    let other = row.iter().enumerate().map(|(at, value)| value * value * master(first + at));
    own + other.sum::<f64>()
}

/// The mean over a surface, by length.
fn mean<const D: usize>(problem: &Problem<D>, side: &Side, value: impl Fn(ElementId) -> f64) -> f64 {
    let positions = side.position(0)..side.position(side.len());
    let (mut sum, mut length) = (0.0, 0.0);
    for face in problem.surface().faces().iter().filter(|face| positions.contains(&face.nodes[0])) {
        let owner: ElementId = problem.mesh().face(face.face).owner;
        let own = face.area / problem.material(owner).extent();
        sum += value(owner) * own;
        length += own;
    }
    sum / length
}

/// ρc times the thickness (kg/(m s)).
fn impedance<const D: usize>(problem: &Problem<D>, element: ElementId) -> f64 {
    let law = problem.material(element);
    law.density() * law.wave_speed() * law.extent()
}

/// 1 over plane modulus and thickness (m/N).
fn compliance<const D: usize>(problem: &Problem<D>, element: ElementId) -> f64 {
    let (law, (alpha, beta)) = (problem.material(element), problem.material(element).compliance::<D>());
    (alpha - beta) / law.extent()
}

/// Parts of an edge nearer than this part of its length have nothing between them.
const JOINED: f64 = 1e-12;

/// How far the master faces the edges of a node of the slave, before and after it. None where it does not face one of
/// them from the node on, and where gaps on a part of an edge are not known.
fn reaches(slave: &Side, coupling: &Coupling, node: usize) -> Option<[Reach; 2]> {
    let reach = |edge: usize, end: usize| -> Option<Reach> {
        let first = slave.edges()[edge];
        let (own, segments) = (slave.ends(first), coupling.segments_of(edge));
        let ends = [segments.first()?.ends[0], segments.last()?.ends[1]];
        // A step of the master has two ends at one place, to rounding; a slot is wider.
        let joined = |pair: &[Segment]| pair[1].ends[0] - pair[0].ends[1] <= JOINED * (own[1] - own[0]);
        let meets = |k: usize| (ends[k] - own[k]).abs() <= JOINED * (own[1] - own[0]);
        if !meets(end) || !segments.windows(2).all(joined) {
            return None;
        }
        if meets(1 - end) {
            return Some(Reach::WHOLE);
        }
        let faces = (ends[1] - ends[0]) / (own[1] - own[0]);
        match coupling.shape(edge) {
            DualShape::Both(_) => Some(Reach { faces, known: 1.0 }),
            DualShape::Part(_) => Some(Reach { faces, known: faces }),
            DualShape::None | DualShape::One(_) => None,
        }
    };
    let edge = |first: Option<usize>| first.and_then(|first| slave.edges().binary_search(&first).ok());
    let edges = [edge(node.checked_sub(1)), edge(Some(node))];
    edges.iter().any(Option::is_some).then_some(())?;
    // The node is the second one of the edge before it.
    let [before, after] = [0, 1].map(|k| edges[k].map_or(Some(Reach::WHOLE), |edge| reach(edge, 1 - k)));
    Some([before?, after?])
}
