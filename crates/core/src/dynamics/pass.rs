//! One pass over the mesh for each step: motion of the nodes, internal forces, and the sums of the balance.
//!
//! A strip is handled chunk by chunk: the nodes that a chunk needs are moved just before its elements are swept, and
//! nodes are summed up as soon as their last element is done, while the first caches still hold them.

use super::node_update::{NodeMotion, Nodes, StripSums};
use crate::kernel::Kernel;
use crate::simd::{Registers, Task, run_task};
use std::ops::Range;

/// What is the same for all strips of a pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass<'a, K, const D: usize> {
    pub(super) kernel: &'a K,
    pub(super) mass: &'a [f64],
    pub(super) inverse_mass: &'a [f64],
    /// Nodes that are not summed up, ascending: forces from outside the pass act on them.
    pub(super) apart: &'a [u32],
    /// F_n of all nodes (N), empty if there is none.
    pub(super) external: &'a [[f64; D]],
    pub(super) motion: NodeMotion<'a, D>,
    /// ½Δt_{n−1} (s).
    pub(super) back: f64,
    /// Whether strips are worked on at the same time, by the threads of the pool of the caller.
    pub(super) parallel: bool,
}

/// Fields on consecutive nodes from `start` on, internal variables of consecutive elements from `internal_start` on,
/// and the sums of consecutive strips of one parity.
pub(super) struct Fields<'a, const D: usize> {
    pub(super) start: usize,
    pub(super) displacement: &'a mut [[f64; D]],
    pub(super) velocity: &'a mut [[f64; D]],
    pub(super) force: &'a mut [[f64; D]],
    pub(super) internal_start: usize,
    pub(super) internal: &'a mut [f64],
    pub(super) sums: &'a mut [StripSums<D>],
}

impl<'a, const D: usize> Fields<'a, D> {
    /// Cuts before a node, an internal variable and a sum.
    fn split(self, node: usize, variable: usize, sum: usize) -> (Self, Self) {
        let at = node - self.start;
        let (displacement, velocity) = (self.displacement.split_at_mut(at), self.velocity.split_at_mut(at));
        let (force, sums) = (self.force.split_at_mut(at), self.sums.split_at_mut(sum));
        let internal = self.internal.split_at_mut(variable - self.internal_start);
        let part = |start, displacement, velocity, force, internal_start, internal, sums| Fields {
            start,
            displacement,
            velocity,
            force,
            internal_start,
            internal,
            sums,
        };
        (
            part(self.start, displacement.0, velocity.0, force.0, self.internal_start, internal.0, sums.0),
            part(node, displacement.1, velocity.1, force.1, variable, internal.1, sums.1),
        )
    }

    fn narrow(self, nodes: Range<usize>, variables: Range<usize>) -> Fields<'a, D> {
        let range = nodes.start - self.start..nodes.end - self.start;
        Fields {
            start: nodes.start,
            displacement: &mut self.displacement[range.clone()],
            velocity: &mut self.velocity[range.clone()],
            force: &mut self.force[range],
            internal_start: variables.start,
            internal: &mut self.internal[variables.start - self.internal_start..variables.end - self.internal_start],
            sums: self.sums,
        }
    }
}

impl<K: Kernel<D>, const D: usize> Pass<'_, K, D> {
    /// Moves all nodes, computes F_n − K u_n, and sums up nodes and elements; `fields` has one sum for each strip,
    /// those of even strips first.
    pub(super) fn run(&self, fields: Fields<'_, D>) -> StripSums<D> {
        let strips = self.kernel.strips().count();
        let even = strips.div_ceil(2);
        let Fields { start, displacement, velocity, force, internal_start, internal, sums } = fields;
        let (first, second) = sums.split_at_mut(even);
        let even_fields = Fields {
            start,
            displacement: &mut *displacement,
            velocity: &mut *velocity,
            force: &mut *force,
            internal_start,
            internal: &mut *internal,
            sums: &mut *first,
        };
        self.phase(0, 0..even, even_fields);
        let odd_fields = Fields { start, displacement, velocity, force, internal_start, internal, sums: &mut *second };
        self.phase(1, 0..strips - even, odd_fields);
        let mut total = StripSums::ZERO;
        first.iter().chain(second.iter()).for_each(|sums| total.add_all(sums));
        total
    }

    /// The strips 2 k + parity for all k of a range.
    fn phase(&self, parity: usize, range: Range<usize>, fields: Fields<'_, D>) {
        let strips = self.kernel.strips();
        let variables =
            |elements: Range<usize>| self.kernel.variables() * elements.start..self.kernel.variables() * elements.end;
        match range.len() {
            0 => (),
            1 => {
                let strip = 2 * range.start + parity;
                let fields = fields.narrow(strips.nodes(strip), variables(strips.elements(strip)));
                run_task(StripPass { pass: self, strip, fields });
            }
            count => {
                let middle = range.start + count / 2;
                let strip = 2 * middle + parity;
                let variable = variables(strips.elements(strip)).start;
                let (left, right) = fields.split(strips.nodes(strip).start, variable, count / 2);
                let first = || self.phase(parity, range.start..middle, left);
                let second = || self.phase(parity, middle..range.end, right);
                if self.parallel {
                    rayon::join(first, second);
                } else {
                    first();
                    second();
                }
            }
        }
    }
}

/// The pass over one strip.
struct StripPass<'a, K, const D: usize> {
    pass: &'a Pass<'a, K, D>,
    strip: usize,
    fields: Fields<'a, D>,
}

impl<K: Kernel<D>, const D: usize> Task for StripPass<'_, K, D> {
    type Output = ();

    #[inline(always)]
    fn run<L: Registers>(self, lanes: L) {
        let Self { pass, strip, mut fields } = self;
        let (kernel, start) = (pass.kernel, fields.start);
        let strips = kernel.strips();
        let own = strips.own_nodes(strip);
        let (own, all) = (own.start - start..own.end - start, 0..strips.nodes(strip).len());
        // Even strips come first: they move all of their nodes, and odd strips complete all of theirs.
        let (mut moved, mut completed) = if strip % 2 == 0 { (all, own) } else { (own, all) };
        let mut passed = pass.apart.partition_point(|&node| (node as usize) < start + completed.start);
        let mut sums = StripSums::ZERO;
        for (reach, chunk) in kernel.chunks(strip) {
            let reached = (reach.reached as usize).clamp(moved.start, moved.end);
            pass.advance(lanes, moved.start..reached, &mut fields, &mut sums);
            moved.start = reached;
            let (u, force, internal) = (&*fields.displacement, &mut *fields.force, &mut *fields.internal);
            kernel.sweep(lanes, &chunk, u, internal, force, &mut sums.strain);
            if matches!(pass.motion, NodeMotion::Combine(_)) {
                continue;
            }
            let left = (reach.left as usize).clamp(completed.start, completed.end);
            pass.sum_up(lanes, completed.start..left, &mut fields, &mut passed, &mut sums);
            completed.start = left;
        }
        fields.sums[0] = sums;
    }
}

impl<K: Kernel<D>, const D: usize> Pass<'_, K, D> {
    /// Moves nodes, counted in the strip, and begins their forces anew.
    #[inline(always)]
    fn advance<L: Registers>(
        &self,
        lanes: L,
        nodes: Range<usize>,
        fields: &mut Fields<'_, D>,
        sums: &mut StripSums<D>,
    ) {
        if nodes.is_empty() {
            return;
        }
        let global = fields.start + nodes.start..fields.start + nodes.end;
        let nodes = Nodes {
            displacement: &mut fields.displacement[nodes.clone()],
            velocity: &mut fields.velocity[nodes.clone()],
            force: &mut fields.force[nodes],
            mass: &self.mass[global.clone()],
            inverse_mass: &self.inverse_mass[global.clone()],
        };
        nodes.advance(lanes, &self.motion, global.clone(), sums);
        if !self.external.is_empty() {
            let start = global.start - fields.start;
            fields.force[start..start + global.len()].copy_from_slice(&self.external[global]);
        }
    }

    /// Sums up nodes, counted in the strip, but for those apart. Of these, `passed` have lower numbers.
    #[inline(always)]
    fn sum_up<L: Registers>(
        &self,
        lanes: L,
        nodes: Range<usize>,
        fields: &mut Fields<'_, D>,
        passed: &mut usize,
        sums: &mut StripSums<D>,
    ) {
        let mut from = nodes.start;
        while from < nodes.end {
            let next = self.apart.get(*passed).map_or(nodes.end, |&node| node as usize - fields.start);
            let run = from..next.min(nodes.end);
            *passed += usize::from(next < nodes.end);
            from = run.end + 1;
            let global = fields.start + run.start..fields.start + run.end;
            let nodes = Nodes {
                displacement: &mut [],
                velocity: &mut fields.velocity[run.clone()],
                force: &mut fields.force[run],
                mass: &self.mass[global.clone()],
                inverse_mass: &self.inverse_mass[global],
            };
            nodes.sum_up(lanes, self.back, sums);
        }
    }
}
