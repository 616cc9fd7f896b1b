//! One pass over the mesh for each step: motion of the nodes, internal forces, and the sums of the balance.
//!
//! A strip is handled chunk by chunk: the nodes that a chunk needs are moved just before its elements are swept, and
//! nodes are summed up as soon as their last element is done, while the first caches still hold them.

use super::internal_force::{Stiffness, sweep};
use crate::simd::{Lanes, Task, Wide, dispatch};
use std::ops::Range;

/// The motion of the nodes before the forces of an instant are computed.
#[derive(Clone, Copy, Debug)]
pub(super) enum Motion<'a, const D: usize> {
    /// None: the start.
    Start,
    /// v_{n+½} = v_{n−½} + h_n a_n and u_{n+1} = u_n + Δt_n v_{n+½}, eq. \[28\], \[31\].
    Advance {
        /// h_n (s).
        h: f64,
        /// Δt_n (s).
        dt: f64,
    },
    /// The velocity by the scheme with this h_n (s), if it is not known, and a given displacement (m).
    Follow {
        /// h_n (s).
        h: Option<f64>,
        /// u_{n+1} (m).
        displacement: &'a [[f64; D]],
    },
}

/// The sums over the nodes and elements of a strip, in lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sums<const D: usize> {
    /// Twice the strain energy (J).
    strain: Wide,
    /// Twice the kinetic energy (J).
    kinetic: [[f64; D]; 4],
    /// Momentum (kg m/s).
    momentum: [[f64; D]; 4],
}

impl<const D: usize> Sums<D> {
    pub(super) const ZERO: Self = Self { strain: [0.0; 8], kinetic: [[0.0; D]; 4], momentum: [[0.0; D]; 4] };

    /// Strain energy (J).
    pub(super) fn strain(&self) -> f64 {
        0.5 * self.strain.iter().sum::<f64>()
    }

    /// Kinetic energy (J).
    pub(super) fn kinetic(&self) -> f64 {
        0.5 * self.kinetic.iter().flatten().sum::<f64>()
    }

    /// Momentum (kg m/s).
    pub(super) fn momentum(&self) -> [f64; D] {
        std::array::from_fn(|c| self.momentum.iter().map(|lane| lane[c]).sum())
    }

    /// Adds a node of this mass (kg) and its inverse, with v_{n−½} and the force M a_n; `back` is ½Δt_{n−1} (s).
    #[inline(always)]
    pub(super) fn add(&mut self, lane: usize, [mass, inverse]: [f64; 2], back: f64, v: &[f64; D], force: &[f64; D]) {
        for c in 0..D {
            // m v_n.
            let p = mass * v[c] + back * force[c];
            self.momentum[lane][c] += p;
            self.kinetic[lane][c] += p * p * inverse;
        }
    }
}

/// What is the same for all strips of a pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass<'a, const D: usize, const N: usize> {
    pub(super) stiffness: &'a Stiffness<D, N>,
    pub(super) mass: &'a [f64],
    pub(super) inverse_mass: &'a [f64],
    /// Nodes that are not summed up, ascending: forces from outside the pass act on them.
    pub(super) apart: &'a [u32],
    /// F_n of all nodes (N), empty if there is none.
    pub(super) external: &'a [[f64; D]],
    pub(super) motion: Motion<'a, D>,
    /// ½Δt_{n−1} (s).
    pub(super) back: f64,
    /// Whether strips are worked on at the same time, by the threads of the pool of the caller.
    pub(super) parallel: bool,
}

/// Fields on consecutive nodes from `start` on, and the sums of consecutive strips of one parity.
pub(super) struct Fields<'a, const D: usize> {
    pub(super) start: usize,
    pub(super) displacement: &'a mut [[f64; D]],
    pub(super) velocity: &'a mut [[f64; D]],
    pub(super) force: &'a mut [[f64; D]],
    pub(super) sums: &'a mut [Sums<D>],
}

impl<'a, const D: usize> Fields<'a, D> {
    /// Cuts before a node, and before a sum.
    fn split(self, node: usize, sum: usize) -> (Self, Self) {
        let at = node - self.start;
        let (displacement, velocity) = (self.displacement.split_at_mut(at), self.velocity.split_at_mut(at));
        let (force, sums) = (self.force.split_at_mut(at), self.sums.split_at_mut(sum));
        let part = |start, displacement, velocity, force, sums| Fields { start, displacement, velocity, force, sums };
        (
            part(self.start, displacement.0, velocity.0, force.0, sums.0),
            part(node, displacement.1, velocity.1, force.1, sums.1),
        )
    }

    fn narrow(self, nodes: Range<usize>) -> Fields<'a, D> {
        let range = nodes.start - self.start..nodes.end - self.start;
        Fields {
            start: nodes.start,
            displacement: &mut self.displacement[range.clone()],
            velocity: &mut self.velocity[range.clone()],
            force: &mut self.force[range],
            sums: self.sums,
        }
    }
}

impl<const D: usize, const N: usize> Pass<'_, D, N> {
    /// Moves all nodes, computes F_n − K u_n, and sums up nodes and elements; `fields` has one sum for each strip, those of
    /// even strips first.
    pub(super) fn run(&self, fields: Fields<'_, D>) -> Sums<D> {
        let strips = self.stiffness.strips.count();
        let even = strips.div_ceil(2);
        let Fields { start, displacement, velocity, force, sums } = fields;
        let (first, second) = sums.split_at_mut(even);
        let even_fields = Fields {
            start,
            displacement: &mut *displacement,
            velocity: &mut *velocity,
            force: &mut *force,
            sums: &mut *first,
        };
        self.phase(0, 0..even, even_fields);
        let odd_fields = Fields { start, displacement, velocity, force, sums: &mut *second };
        self.phase(1, 0..strips - even, odd_fields);
        let mut total = Sums::ZERO;
        for sums in first.iter().chain(second.iter()) {
            (0..8).for_each(|i| total.strain[i] += sums.strain[i]);
            for lane in 0..4 {
                for c in 0..D {
                    total.kinetic[lane][c] += sums.kinetic[lane][c];
                    total.momentum[lane][c] += sums.momentum[lane][c];
                }
            }
        }
        total
    }

    /// The strips 2 k + parity for all k of a range.
    fn phase(&self, parity: usize, range: Range<usize>, fields: Fields<'_, D>) {
        match range.len() {
            0 => (),
            1 => {
                let strip = 2 * range.start + parity;
                dispatch(StripPass { pass: self, strip, fields: fields.narrow(self.stiffness.strips.nodes(strip)) });
            }
            count => {
                let middle = range.start + count / 2;
                let node = self.stiffness.strips.nodes(2 * middle + parity).start;
                let (left, right) = fields.split(node, count / 2);
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
struct StripPass<'a, const D: usize, const N: usize> {
    pass: &'a Pass<'a, D, N>,
    strip: usize,
    fields: Fields<'a, D>,
}

impl<const D: usize, const N: usize> Task for StripPass<'_, D, N> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { pass, strip, mut fields } = self;
        let (Stiffness { shape, strips, pairs }, start) = (pass.stiffness, fields.start);
        let own = strips.own_nodes(strip);
        let (own, all) = (own.start - start..own.end - start, 0..strips.nodes(strip).len());
        // Even strips come first: they move all of their nodes, and odd strips complete all of theirs.
        let (mut moved, mut completed) = if strip % 2 == 0 { (all, own) } else { (own, all) };
        let mut sums = Sums::ZERO;
        for (chunk, data) in pairs.strip(strip) {
            let reached = (chunk.reached as usize).clamp(moved.start, moved.end);
            pass.advance(moved.start..reached, &mut fields);
            moved.start = reached;
            sweep(lanes, *shape, &data, fields.displacement, fields.force, &mut sums.strain);
            let left = (chunk.left as usize).clamp(completed.start, completed.end);
            pass.sum_up(completed.start..left, &fields, &mut sums);
            completed.start = left;
        }
        fields.sums[0] = sums;
    }
}

impl<const D: usize, const N: usize> Pass<'_, D, N> {
    /// Moves nodes, counted in the strip, and begins their forces anew.
    #[inline(always)]
    fn advance(&self, nodes: Range<usize>, fields: &mut Fields<'_, D>) {
        let global = fields.start + nodes.start..fields.start + nodes.end;
        let (u, v) = (&mut fields.displacement[nodes.clone()], &mut fields.velocity[nodes.clone()]);
        let (force, inverse) = (&mut fields.force[nodes], &self.inverse_mass[global.clone()]);
        match self.motion {
            Motion::Start => (),
            Motion::Advance { h, dt } => {
                for (((u, v), f), inverse) in u.iter_mut().zip(v).zip(force.iter()).zip(inverse) {
                    for c in 0..D {
                        v[c] += h * (inverse * f[c]);
                        u[c] += dt * v[c];
                    }
                }
            }
            Motion::Follow { h, displacement } => {
                if let Some(h) = h {
                    for ((v, f), inverse) in v.iter_mut().zip(force.iter()).zip(inverse) {
                        (0..D).for_each(|c| v[c] += h * (inverse * f[c]));
                    }
                }
                u.copy_from_slice(&displacement[global.clone()]);
            }
        }
        if self.external.is_empty() {
            force.fill([0.0; D]);
        } else {
            force.copy_from_slice(&self.external[global]);
        }
    }

    /// Sums up nodes, counted in the strip, but for those apart.
    #[inline(always)]
    fn sum_up(&self, nodes: Range<usize>, fields: &Fields<'_, D>, sums: &mut Sums<D>) {
        let (mut from, end) = (fields.start + nodes.start, fields.start + nodes.end);
        let mut apart = self.apart[self.apart.partition_point(|&node| (node as usize) < from)..].iter();
        while from < end {
            let until = apart.next().map_or(end, |&node| end.min(node as usize));
            self.sum_up_run(from..until, fields, sums);
            from = until + 1;
        }
    }

    #[inline(always)]
    fn sum_up_run(&self, nodes: Range<usize>, fields: &Fields<'_, D>, sums: &mut Sums<D>) {
        let local = nodes.start - fields.start..nodes.end - fields.start;
        let (v, force) = (fields.velocity[local.clone()].as_chunks::<4>(), fields.force[local].as_chunks::<4>());
        let (mass, inverse) = (self.mass[nodes.clone()].as_chunks::<4>(), self.inverse_mass[nodes].as_chunks::<4>());
        let mut total = *sums;
        for (((v, force), mass), inverse) in v.0.iter().zip(force.0).zip(mass.0).zip(inverse.0) {
            for i in 0..4 {
                total.add(i, [mass[i], inverse[i]], self.back, &v[i], &force[i]);
            }
        }
        for i in 0..v.1.len() {
            total.add(i, [mass.1[i], inverse.1[i]], self.back, &v.1[i], &force.1[i]);
        }
        *sums = total;
    }
}
