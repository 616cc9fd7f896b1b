//! The motion of the auxiliary solution at the contact nodes over the next step, before the contact forces are known.

use super::Fields;
use super::blocks::Blocks;
use super::lanes::Nodal;
use super::pairs::{Moduli, Pair, Pairs};
use super::surface::SurfaceForces;
use super::sweeps::subtract_stiffness;
use crate::simd::{Registers, Task, run_task};
use percute_core::contact::{ContactNode, Frame};
use percute_core::dynamics::Dynamics;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// The motion of a contact node against its obstacle over the next step.
#[derive(Clone, Copy, Debug)]
pub(in crate::reconstruction::corrected) struct Approach<const D: usize> {
    /// Gap now (m).
    pub(in crate::reconstruction::corrected) gap_now: f64,
    /// Gap at the next instant without a contact force (m).
    pub(in crate::reconstruction::corrected) gap: f64,
    /// Displacement along the plane now, and at the next instant without a contact force (m).
    pub(in crate::reconstruction::corrected) along: [[f64; D]; 2],
    /// Displacement that a unit force adds until then (m/N).
    pub(in crate::reconstruction::corrected) mobility: f64,
}

/// The motion of a contact node over the next step without a contact force.
#[derive(Clone, Copy, Debug)]
pub(in crate::reconstruction::corrected) struct FreeMotion<const D: usize> {
    /// Displacement now and at the next instant (m).
    pub(in crate::reconstruction::corrected) displacements: [[f64; D]; 2],
    /// Displacement that a unit force adds until then (m/N).
    pub(in crate::reconstruction::corrected) mobility: f64,
}

impl<const D: usize> Approach<D> {
    /// That of a node to its obstacle or to the node that it faces, from the motions of all contact nodes.
    pub(in crate::reconstruction::corrected) fn new<const N: usize>(
        problem: &Problem<D, N>,
        at: usize,
        free: &[FreeMotion<D>],
    ) -> Self {
        let contact = &problem.surface().nodes()[at];
        let FreeMotion { mut displacements, mut mobility } = free[at];
        if let Some(opposite) = contact.opposite {
            let other = &free[opposite];
            let both = displacements.as_flattened_mut().iter_mut().zip(other.displacements.as_flattened());
            both.for_each(|(own, other)| *own -= other);
            mobility += other.mobility;
        }
        let frame = problem.obstacles()[contact.obstacle].flat_frame();
        let [gap_now, gap] = displacements.map(|place| problem.surface().gap(at, &place));
        Self { gap_now, gap, along: displacements.map(|place| frame.split(&place).1), mobility }
    }

    /// The same under a force (N) beside that of the obstacle.
    pub(in crate::reconstruction::corrected) fn under(mut self, frame: &Frame<D>, force: &[f64; D]) -> Self {
        let (normal, along) = frame.split(force);
        self.gap += self.mobility * normal;
        (0..D).for_each(|c| self.along[1][c] += self.mobility * along[c]);
        self
    }
}

/// The data of the level before its pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct BeforePass<'a, const D: usize> {
    pub(super) laws: &'a [Moduli],
    pub(super) surface: &'a SurfaceForces,
    pub(super) fields: &'a Fields,
    /// F_n (N); empty without loads.
    pub(super) external: &'a [[f64; D]],
    /// The step that the displacement of the fields has still to make (s).
    pub(super) due: f64,
}

/// The elements with a contact node. They go through the first sweep twice: here and in the pass.
#[derive(Debug)]
pub(super) struct NearElements<const D: usize> {
    /// Pairs of elements, their nodes numbered as in `nodes`.
    pairs: Vec<Pair>,
    /// Their nodes in the mesh, ascending.
    nodes: Vec<u32>,
    displacement: Vec<Nodal>,
    forces: Vec<Nodal>,
    free: Vec<FreeMotion<D>>,
}

impl<const D: usize> NearElements<D> {
    pub(super) fn new<const N: usize>(problem: &Problem<D, N>, blocks: &Blocks, all: &Pairs) -> Self {
        let mut touches = vec![false; problem.mesh().node_count()];
        problem.surface().nodes().iter().for_each(|contact| touches[contact.node.index()] = true);
        let mut pairs = Vec::new();
        for block in 0..blocks.count() {
            let first = blocks.nodes(block).start as u32;
            let global = all.block(block).iter().map(|pair| Pair { nodes: pair.nodes.map(|n| n + first), ..*pair });
            pairs.extend(global.filter(|pair| pair.nodes.iter().any(|n| touches[*n as usize])));
        }
        let mut nodes: Vec<u32> = pairs.iter().flat_map(|pair| pair.nodes).collect();
        nodes.sort_unstable();
        nodes.dedup();
        for pair in &mut pairs {
            pair.nodes = pair.nodes.map(|n| nodes.partition_point(|known| *known < n) as u32);
        }
        let count = nodes.len();
        let (displacement, forces) = (vec![Nodal::ZERO; count], vec![Nodal::ZERO; count]);
        Self { pairs, nodes, displacement, forces, free: Vec::with_capacity(problem.surface().nodes().len()) }
    }

    /// The motions of all contact nodes until t_{n+1}, corrections left out.
    pub(super) fn motions<const N: usize>(
        &mut self,
        dynamics: &Dynamics<'_, D, N>,
        (times, n): (&TimeGrid, usize),
        before: &BeforePass<'_, D>,
    ) -> &[FreeMotion<D>] {
        let (problem, BeforePass { laws, surface, fields, external, due }) = (dynamics.problem(), *before);
        let each = self.nodes.iter().zip(&mut self.displacement).zip(&mut self.forces);
        for ((node, displacement), force) in each {
            let i = *node as usize;
            let (u, v) = (&fields.displacement[i].0, &fields.half_step[i].0);
            displacement.0 = std::array::from_fn(|k| u[k] + v[k] * due);
            *force = external.get(i).map_or(Nodal::ZERO, Nodal::all_but_contact);
        }
        run_task(Sweep { laws, pairs: &self.pairs, displacement: &self.displacement, forces: &mut self.forces });
        let (step, length) = (times.step(n), times.velocity_step(n));
        let moving = |contact: &ContactNode| {
            let node = contact.node.index();
            let own = self.nodes.partition_point(|known| (*known as usize) < node);
            let (now, velocity) = (self.displacement[own].of::<D>(0), fields.half_step[node].of::<D>(0));
            let mut force: [f64; D] = self.forces[own].of(0);
            surface.supports_of(node as u32).for_each(|(c, needed)| force[c] = needed);
            let mobility = step * length * dynamics.inverse_mass()[node];
            let next: [f64; D] = std::array::from_fn(|c| now[c] + step * velocity[c] + mobility * force[c]);
            FreeMotion { displacements: [now, next], mobility }
        };
        self.free.clear();
        self.free.extend(problem.surface().nodes().iter().map(moving));
        &self.free
    }
}

/// The sweep over the near elements.
struct Sweep<'a> {
    laws: &'a [Moduli],
    pairs: &'a [Pair],
    displacement: &'a [Nodal],
    forces: &'a mut [Nodal],
}

impl Task for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        subtract_stiffness(r, self.laws, self.pairs, self.displacement, self.forces);
    }
}
