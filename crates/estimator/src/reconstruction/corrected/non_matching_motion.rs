//! The motion of the nodes of a slave to their master over a step, under the forces of all of them.

use super::auxiliary::{Approach, FreeFlight, Mobility};
use super::non_matching::mobility;
use percute_core::contact::{Coupling, NonMatchingSurfaces, Side};

/// The motion of the auxiliary solution on a non-matching interface, over the next step. Forces move nodes as lumped
/// masses: those of a slave are on many nodes at once, and the corrections under them are left out.
#[derive(Debug)]
pub(super) struct AuxiliaryInterfaceMotion<'a, const D: usize> {
    non_matching: &'a NonMatchingSurfaces<D>,
    coupling: &'a Coupling,
    /// That of the nodes of slave and master, at the next instant under `forces`.
    motions: [Vec<FreeFlight<D>>; 2],
    /// The forces R_k of the nodes of the slave (N).
    forces: Vec<[f64; D]>,
    /// The node of the slave that was asked for last: its force may have changed since.
    asked: usize,
}

impl<'a, const D: usize> AuxiliaryInterfaceMotion<'a, D> {
    /// From the motions of all contact nodes without a contact force, and the forces on them (N): R_k on slaves.
    pub(super) fn new(
        (non_matching, coupling): (&'a NonMatchingSurfaces<D>, &'a Coupling),
        free: &[FreeFlight<D>],
        forces: &[[f64; D]],
    ) -> Self {
        let of = |side: &Side| (0..side.len()).map(|k| free[side.position(k)]).collect();
        let mut made = Self {
            non_matching,
            coupling,
            motions: [of(non_matching.slave()), of(non_matching.master())],
            forces: vec![[0.0; D]; coupling.len()],
            asked: 0,
        };
        (0..coupling.len()).for_each(|k| made.take_in(k, forces[non_matching.slave().position(k)]));
        made
    }

    /// The motion of a node of the slave, by its position in the contact surface, under these forces of the others.
    pub(super) fn approach(&mut self, at: usize, forces: &[[f64; D]]) -> Approach<D> {
        let (slave, master) = (self.non_matching.slave(), self.non_matching.master());
        self.take_in(self.asked, forces[slave.position(self.asked)]);
        let k = at - slave.position(0);
        self.asked = k;
        let Self { non_matching, coupling, motions: [own, other], forces, .. } = &*self;
        let weight = coupling.weight(k);
        let mobility =
            mobility(coupling, k, |node| own[node].mobility, |node| other[node].mobility) / (weight * weight);
        let [now, mut next] = [0, 1].map(|instant| -> [f64; D] {
            std::array::from_fn(|c| {
                let value = |motion: &FreeFlight<D>| motion.displacements[instant][c];
                coupling.difference(k, |node| value(&own[node]), |node| value(&other[node])) / weight
            })
        });
        (0..D).for_each(|c| next[c] -= mobility * forces[k][c]);
        let undeformed = coupling.difference(k, |node| slave.eta()[node], |node| master.eta()[node]) / weight;
        let parts = [now, next].map(|place| non_matching.frame().split(&place));
        let [gap_now, gap] = parts.map(|(normal, _)| undeformed + normal);
        let along = parts.map(|(_, along)| along);
        Approach { gap_now, gap, along, mobility: Mobility::of_mass(mobility), far: [None; 2] }
    }

    /// Puts a force (N) in the place of that of a node of the slave: D_ki R_k/w_k on the slave, −M_kj R_k/w_k on the
    /// master.
    fn take_in(&mut self, k: usize, force: [f64; D]) {
        let Self { coupling, motions: [own, other], forces, .. } = self;
        if !coupling.is_active(k) {
            return;
        }
        let multiplier: [f64; D] = std::array::from_fn(|c| (force[c] - forces[k][c]) / coupling.weight(k));
        forces[k] = force;
        let push = |motion: &mut FreeFlight<D>, value: f64| {
            (0..D).for_each(|c| motion.displacements[1][c] += motion.mobility * value * multiplier[c]);
        };
        for (at, value) in coupling.slave_row(k).into_iter().enumerate().filter(|(_, value)| *value != 0.0) {
            push(&mut own[k + at - 1], value);
        }
        let (first, row) = coupling.master_row(k);
        row.iter().zip(&mut other[first..]).for_each(|(value, motion)| push(motion, -value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::contact::Interface;
    use percute_core::material::Elastic;
    use percute_core::mesh::Mesh;
    use percute_core::problem::Problem;
    use percute_testkit::Random;

    /// A narrow block that sticks out of a wide one, with other nodes.
    fn blocks() -> Problem<2> {
        let block = |width: f64, cells: usize, place: [f64; 2]| {
            let mesh = Mesh::rectangle(width, 0.2, cells, 2).unwrap();
            mesh.mapped(|p| [p[0] + place[0], p[1] + place[1]]).unwrap()
        };
        let both = [("upper", &block(0.2, 3, [0.13, 0.21])), ("lower", &block(0.3, 5, [0.0; 2]))];
        Problem::<2>::builder(Mesh::joined(&both).unwrap())
            .material(Elastic::plane_strain(70e9, 0.3, 2700.0, 0.7).unwrap())
            .interface(Interface::non_matching(2, "upper.bottom", "lower.top", 0.4).unwrap())
            .build()
            .unwrap()
    }

    /// The gaps under all forces are those of the mesh whose nodes the nodal forces Dᵀλ and −Mᵀλ have moved. Along the
    /// normal only: other motions change D and M.
    #[test]
    fn gaps_are_those_of_the_moved_mesh() {
        let (problem, mut random) = (blocks(), Random::new(7));
        let (surface, non_matching) = (problem.surface(), &problem.surface().non_matching()[0]);
        let coupling = non_matching.coupling_at(&[0.0]);
        let active: Vec<usize> = (0..coupling.len()).filter(|&k| coupling.is_active(k)).collect();
        assert!(active.len() > 2);
        let mut any =
            |low: f64, high: f64| -> Vec<f64> { surface.nodes().iter().map(|_| random.between(low, high)).collect() };
        let [now, next, mobility, push] = [any(-1e-3, 1e-3), any(-1e-3, 1e-3), any(1e-9, 2e-9), any(0.0, 1e5)];
        let normal = *non_matching.frame().normal();
        let across = |value: f64| normal.map(|n| value * n);
        let motion = |at: usize| FreeFlight { displacements: [now[at], next[at]].map(across), mobility: mobility[at] };
        let free: Vec<FreeFlight<2>> = (0..surface.nodes().len()).map(motion).collect();
        let (slave, master) = (non_matching.slave(), non_matching.master());
        let mut forces = vec![[0.0; 2]; free.len()];
        active.iter().for_each(|&k| forces[slave.position(k)] = across(push[k]));

        let mut moved = vec![[0.0; 2]; problem.mesh().node_count()];
        let mut move_node = |at: usize, force: f64| {
            let node = surface.nodes()[at].node.index();
            (0..2).for_each(|c| moved[node][c] += mobility[at] * force * normal[c]);
        };
        for (at, from) in next.iter().enumerate() {
            move_node(at, from / mobility[at]);
        }
        for &k in &active {
            let multiplier = push[k] / coupling.weight(k);
            for (before, value) in coupling.slave_row(k).into_iter().enumerate().filter(|(_, value)| *value != 0.0) {
                move_node(slave.position(k + before - 1), multiplier * value);
            }
            let (first, row) = coupling.master_row(k);
            row.iter().enumerate().for_each(|(j, value)| move_node(master.position(first + j), -multiplier * value));
        }
        let gaps = surface.gaps(&moved);

        let mut non_matching_motion = AuxiliaryInterfaceMotion::new((non_matching, &coupling), &free, &forces);
        for &k in &active {
            let at = slave.position(k);
            let approach = non_matching_motion.approach(at, &forces);
            let under_all = approach.gap + approach.mobility.between(&normal, &normal) * push[k];
            // Rounding of some ten terms of 1e-3.
            assert!((under_all - gaps[at]).abs() < 1e-15, "{k}: {under_all} {}", gaps[at]);
            assert!(approach.along.as_flattened().iter().all(|along| along.abs() < 1e-18));
        }
        // A force that has changed since the last question moves the others, and not its own node.
        let [one, other] = [active[0], active[1]].map(|k| slave.position(k));
        let before = [one, other].map(|at| non_matching_motion.approach(at, &forces).gap);
        non_matching_motion.approach(one, &forces);
        forces[one] = [0.0; 2];
        let after = [one, other].map(|at| non_matching_motion.approach(at, &forces).gap);
        assert!((after[0] - before[0]).abs() < 1e-15 && (after[1] - before[1]).abs() > 1e-7, "{before:?} {after:?}");
    }
}
