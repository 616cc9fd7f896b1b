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
    /// u ← a M⁻¹f + b v + c u with these factors: a step of Lanczos. The kinetic energy is ½ u·M u instead, and there is no
    /// momentum.
    Combine([f64; 3]),
}

/// The sums over the nodes and elements of a strip, in lanes: component c of node i of a run has lane D i + c, modulo 8.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sums<const D: usize> {
    /// Twice the strain energy (J).
    strain: Wide,
    /// Twice the kinetic energy (J).
    kinetic: Wide,
    /// Momentum (kg m/s).
    momentum: Wide,
}

impl<const D: usize> Sums<D> {
    pub(super) const ZERO: Self = Self { strain: [0.0; 8], kinetic: [0.0; 8], momentum: [0.0; 8] };

    /// Strain energy (J).
    pub(super) fn strain(&self) -> f64 {
        0.5 * self.strain.iter().sum::<f64>()
    }

    /// Kinetic energy (J).
    pub(super) fn kinetic(&self) -> f64 {
        0.5 * self.kinetic.iter().sum::<f64>()
    }

    /// Momentum (kg m/s).
    pub(super) fn momentum(&self) -> [f64; D] {
        std::array::from_fn(|c| self.momentum[c..].iter().step_by(D).sum())
    }

    /// Adds the i-th node of a run, of this mass (kg) and its inverse, with v_{n−½} and the force M a_n; `back` is
    /// ½Δt_{n−1} (s).
    #[inline(always)]
    pub(super) fn add(&mut self, i: usize, [mass, inverse]: [f64; 2], back: f64, v: &[f64; D], force: &[f64; D]) {
        for c in 0..D {
            // m v_n.
            let (p, lane) = (mass * v[c] + back * force[c], (D * i + c) % 8);
            self.momentum[lane] += p;
            self.kinetic[lane] += p * p * inverse;
        }
    }

    fn add_all(&mut self, other: &Self) {
        for i in 0..8 {
            self.strain[i] += other.strain[i];
            self.kinetic[i] += other.kinetic[i];
            self.momentum[i] += other.momentum[i];
        }
    }
}

/// A number of each node for eight components.
#[inline(always)]
fn of_nodes<L: Lanes, const D: usize>(l: L, nodes: &[f64]) -> L::Wide {
    match (nodes.first_chunk(), nodes.first_chunk()) {
        (Some(eight), _) if D == 1 => l.load(eight),
        (_, Some(four)) => l.repeat(four),
        _ => l.splat(0.0),
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
        first.iter().chain(second.iter()).for_each(|sums| total.add_all(sums));
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
            pass.advance(lanes, moved.start..reached, &mut fields, &mut sums);
            moved.start = reached;
            sweep(lanes, *shape, &data, fields.displacement, fields.force, &mut sums.strain);
            if matches!(pass.motion, Motion::Combine(_)) {
                continue;
            }
            let left = (chunk.left as usize).clamp(completed.start, completed.end);
            pass.sum_up(lanes, completed.start..left, &fields, &mut sums);
            completed.start = left;
        }
        fields.sums[0] = sums;
    }
}

impl<const D: usize, const N: usize> Pass<'_, D, N> {
    /// Moves nodes, counted in the strip, and begins their forces anew.
    #[inline(always)]
    fn advance<L: Lanes>(&self, lanes: L, nodes: Range<usize>, fields: &mut Fields<'_, D>, sums: &mut Sums<D>) {
        let global = fields.start + nodes.start..fields.start + nodes.end;
        let (u, v) = (&mut fields.displacement[nodes.clone()], &mut fields.velocity[nodes.clone()]);
        let (force, inverse) = (&mut fields.force[nodes], &self.inverse_mass[global.clone()]);
        match self.motion {
            Motion::Start => (),
            Motion::Advance { h, dt } => {
                accelerate(lanes, h, inverse, force, v);
                let (u, v) = (u.as_flattened_mut().as_chunks_mut::<8>(), v.as_flattened().as_chunks::<8>());
                let length = lanes.splat(dt);
                for (u, v) in u.0.iter_mut().zip(v.0) {
                    *u = lanes.store(lanes.add(lanes.load(u), lanes.mul(length, lanes.load(v))));
                }
                for (u, v) in u.1.iter_mut().zip(v.1) {
                    *u += dt * v;
                }
            }
            Motion::Follow { h, displacement } => {
                if let Some(h) = h {
                    accelerate(lanes, h, inverse, force, v);
                }
                u.copy_from_slice(&displacement[global.clone()]);
            }
            Motion::Combine(factors) => {
                combine(lanes, factors, [&self.mass[global.clone()], inverse], force, (u, v), sums)
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
    fn sum_up<L: Lanes>(&self, lanes: L, nodes: Range<usize>, fields: &Fields<'_, D>, sums: &mut Sums<D>) {
        let (mut from, end) = (fields.start + nodes.start, fields.start + nodes.end);
        let mut apart = self.apart[self.apart.partition_point(|&node| (node as usize) < from)..].iter();
        while from < end {
            let until = apart.next().map_or(end, |&node| end.min(node as usize));
            self.sum_up_run(lanes, from..until, fields, sums);
            from = until + 1;
        }
    }

    #[inline(always)]
    fn sum_up_run<L: Lanes>(&self, l: L, nodes: Range<usize>, fields: &Fields<'_, D>, sums: &mut Sums<D>) {
        let local = nodes.start - fields.start..nodes.end - fields.start;
        let (v, force) = (&fields.velocity[local.clone()], &fields.force[local]);
        let (mass, inverse) = (&self.mass[nodes.clone()], &self.inverse_mass[nodes]);
        let (eights, forces) = (v.as_flattened().as_chunks::<8>().0, force.as_flattened().as_chunks::<8>().0);
        let (masses, inverses) = (mass.chunks_exact(8 / D), inverse.chunks_exact(8 / D));
        let (back, mut momentum, mut kinetic) = (l.splat(self.back), l.load(&sums.momentum), l.load(&sums.kinetic));
        for (((v, force), mass), inverse) in eights.iter().zip(forces).zip(masses).zip(inverses) {
            // m v_n.
            let p = l.add(l.mul(of_nodes::<L, D>(l, mass), l.load(v)), l.mul(back, l.load(force)));
            momentum = l.add(momentum, p);
            kinetic = l.add(kinetic, l.mul(l.mul(p, p), of_nodes::<L, D>(l, inverse)));
        }
        (sums.momentum, sums.kinetic) = (l.store(momentum), l.store(kinetic));
        for i in v.len() - v.len() % (8 / D)..v.len() {
            sums.add(i, [mass[i], inverse[i]], self.back, &v[i], &force[i]);
        }
    }
}

/// v += h M⁻¹ f.
#[inline(always)]
fn accelerate<L: Lanes, const D: usize>(l: L, h: f64, inverse: &[f64], force: &[[f64; D]], v: &mut [[f64; D]]) {
    let whole = v.len() - v.len() % (8 / D);
    let length = l.splat(h);
    let eights = v.as_flattened_mut().as_chunks_mut::<8>().0.iter_mut();
    for ((v, force), inverse) in eights.zip(force.as_flattened().as_chunks::<8>().0).zip(inverse.chunks_exact(8 / D)) {
        let acceleration = l.mul(of_nodes::<L, D>(l, inverse), l.load(force));
        *v = l.store(l.add(l.load(v), l.mul(length, acceleration)));
    }
    for i in whole..v.len() {
        (0..D).for_each(|c| v[i][c] += h * (inverse[i] * force[i][c]));
    }
}

/// u ← a M⁻¹f + b v + c u, and twice its kinetic energy.
#[inline(always)]
fn combine<L: Lanes, const D: usize>(
    l: L,
    factors: [f64; 3],
    [mass, inverse]: [&[f64]; 2],
    force: &[[f64; D]],
    (u, v): (&mut [[f64; D]], &[[f64; D]]),
    sums: &mut Sums<D>,
) {
    let whole = v.len() - v.len() % (8 / D);
    let [a, b, c] = factors;
    let (of_force, of_v, of_u) = (l.splat(a), l.splat(b), l.splat(c));
    let mut kinetic = l.load(&sums.kinetic);
    let eights = u.as_flattened_mut().as_chunks_mut::<8>().0.iter_mut();
    let fields = force.as_flattened().as_chunks::<8>().0.iter().zip(v.as_flattened().as_chunks::<8>().0);
    let masses = mass.chunks_exact(8 / D).zip(inverse.chunks_exact(8 / D));
    for ((u, (force, v)), (mass, inverse)) in eights.zip(fields).zip(masses) {
        let acceleration = l.mul(of_nodes::<L, D>(l, inverse), l.load(force));
        let others = l.add(l.mul(of_v, l.load(v)), l.mul(of_u, l.load(u)));
        let sum = l.add(l.mul(of_force, acceleration), others);
        kinetic = l.add(kinetic, l.mul(l.mul(sum, sum), of_nodes::<L, D>(l, mass)));
        *u = l.store(sum);
    }
    sums.kinetic = l.store(kinetic);
    for i in whole..v.len() {
        for k in 0..D {
            let sum = a * (inverse[i] * force[i][k]) + (b * v[i][k] + c * u[i][k]);
            sums.kinetic[(D * i + k) % 8] += sum * sum * mass[i];
            u[i][k] = sum;
        }
    }
}
