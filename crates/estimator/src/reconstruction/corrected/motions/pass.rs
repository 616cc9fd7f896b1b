//! One pass over the mesh for a step: blocks of nodes and elements go through all sweeps while they are in a cache.
//!
//! A sweep over the blocks of a turn needs the nodes that the sweep before it has finished in this turn and the next
//! one, so each of the three sweeps is a turn behind the one before.

use super::blocks::Blocks;
use super::lanes::{FirstPair, Nodal};
use super::pairs::Pairs;
use super::parts::{Part, View};
use super::surface::SurfaceForces;
use super::sweeps::{add_lumping, subtract_both, subtract_stiffness};
use super::weights::LevelWeights;
use crate::simd::{Registers, Task};
use std::ops::Range;

/// The data of the pass at t_n.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass<'a, const D: usize> {
    pub(super) pairs: &'a Pairs,
    pub(super) blocks: &'a Blocks,
    pub(super) surface: &'a SurfaceForces,
    /// F_n (N); empty without loads.
    pub(super) external: &'a [[f64; D]],
    pub(super) mass: &'a [f64],
    pub(super) inverse_mass: &'a [f64],
    /// u̇_CA (m/s).
    pub(super) simulated: &'a [[f64; D]],
    pub(super) weights: LevelWeights,
    /// Δt_{n−1} (s), 0 at the start.
    pub(super) due: f64,
    /// ½Δt_{n−1} (s), 0 at the start.
    pub(super) back: f64,
    /// h_n (s).
    pub(super) forward: f64,
}

/// Kinetic energies (J).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Kinetic {
    /// That of u̇_CA.
    pub(super) simulated: f64,
    /// That of the auxiliary solution at t_{n+½}.
    pub(super) auxiliary: f64,
}

/// The pass over one part: makes u_n, ã_n, v_n and v_{n+½} of all motions from u_{n−1} and v_{n−½}.
pub(super) struct PartPass<'a, 'v, const D: usize> {
    pub(super) pass: &'a Pass<'a, D>,
    pub(super) part: &'a Part,
    pub(super) view: View<'v, D>,
}

impl<const D: usize> Task for PartPass<'_, '_, D> {
    type Output = Kinetic;

    #[inline(always)]
    fn run<R: Registers>(self, r: R) -> Kinetic {
        let Self { pass, part, mut view } = self;
        let mut kinetic = Kinetic::default();
        for k in part.even.start.min(part.third.start + 2)..part.third_done.end + 2 {
            if part.even.contains(&k) {
                pass.displace(r, k, &mut view);
            }
            if part.odd.contains(&k) {
                pass.accelerate(r, k, &mut view);
            }
            pass.correct_once(r, k.wrapping_sub(1), part, &mut view);
            pass.correct_twice(r, k.wrapping_sub(2), part, &mut view, &mut kinetic);
        }
        kinetic
    }
}

impl<const D: usize> Pass<'_, D> {
    /// u_n of the nodes of a turn, and the forces of its even block.
    #[inline(always)]
    fn displace<R: Registers>(&self, r: R, turn: usize, view: &mut View<'_, D>) {
        let nodes = self.blocks.begun(turn);
        let range = view.local(&nodes);
        let due = r.splat(self.due);
        let moving = view.displacement[range.clone()].iter_mut().zip(&view.half_step[range.clone()]);
        for ((u, v), out) in moving.zip(&mut view.level.displacement[range.clone()]) {
            u.0 = r.store(r.add(r.load(&u.0), r.mul(r.load(&v.0), due)));
            *out = u.of(0);
        }
        let forces = &mut view.rate[range];
        if self.external.is_empty() {
            forces.fill(Nodal::ZERO);
        } else {
            let loads = forces.iter_mut().zip(&self.external[nodes]);
            loads.for_each(|(force, external)| *force = Nodal::all_but_contact(external));
        }
        self.subtract_forces(r, self.blocks.even(turn), view);
    }

    #[inline(always)]
    fn subtract_forces<R: Registers>(&self, r: R, block: Option<usize>, view: &mut View<'_, D>) {
        let Some(block) = block else { return };
        let range = view.local(&self.blocks.nodes(block));
        let (x, forces) = (&view.displacement[range.clone()], &mut view.rate[range]);
        subtract_stiffness(r, &self.pairs.laws, self.pairs.block(block), x, forces);
    }

    /// The forces of the odd block of a turn, and ã_n.
    #[inline(always)]
    fn accelerate<R: Registers>(&self, r: R, turn: usize, view: &mut View<'_, D>) {
        self.subtract_forces(r, self.blocks.odd(turn), view);
        let nodes = self.blocks.finished(turn);
        let range = view.local(&nodes);
        self.surface.apply(&nodes, &mut view.rate[range.clone()], &mut view.level.force[range.clone()]);
        for (rate, inverse) in view.rate[range.clone()].iter_mut().zip(&self.inverse_mass[nodes]) {
            rate.0 = r.store(r.mul(r.load(&rate.0), r.splat(*inverse)));
        }
        view.internal[range.clone()].fill(Nodal::ZERO);
        view.once[range.clone()].fill(FirstPair::ZERO);
        view.twice[range].fill(FirstPair::ZERO);
    }

    /// −Kã and M⁻¹(M − M_c)ã.
    #[inline(always)]
    fn correct_once<R: Registers>(&self, r: R, turn: usize, part: &Part, view: &mut View<'_, D>) {
        if part.second.contains(&turn) {
            for block in self.blocks.even(turn).into_iter().chain(self.blocks.odd(turn)) {
                let range = view.local(&self.blocks.nodes(block));
                let (x, forces) = (&view.rate[range.clone()], &mut view.internal[range.clone()]);
                subtract_both(r, &self.pairs.laws, self.pairs.block(block), x, forces, &mut view.once[range]);
            }
        }
        if !part.second_done.contains(&turn) {
            return;
        }
        let nodes = self.blocks.finished(turn);
        let range = view.local(&nodes);
        for (once, inverse) in view.once[range.clone()].iter_mut().zip(&self.inverse_mass[nodes.clone()]) {
            once.0 = r.store4(r.mul4(r.load4(&once.0), r.splat4(*inverse)));
        }
        for (node, c) in self.surface.prescribed(&nodes) {
            view.internal[node - view.start].set(c, 0.0);
            view.once[node - view.start].set(c, 0.0);
        }
        if let Some(out) = &mut view.level.lumping_difference {
            let sums = out[range.clone()].iter_mut().zip(&view.once[range]);
            sums.for_each(|(out, once)| *out = once.auxiliary());
        }
    }

    /// (M − M_c)M⁻¹(M − M_c)ã, v_n and v_{n+½}.
    #[inline(always)]
    fn correct_twice<R: Registers>(
        &self,
        r: R,
        turn: usize,
        part: &Part,
        view: &mut View<'_, D>,
        kinetic: &mut Kinetic,
    ) {
        if part.third.contains(&turn) {
            for block in self.blocks.even(turn).into_iter().chain(self.blocks.odd(turn)) {
                let range = view.local(&self.blocks.nodes(block));
                add_lumping(r, self.pairs.block(block), &view.once[range.clone()], &mut view.twice[range]);
            }
        }
        if part.third_done.contains(&turn) {
            let nodes = self.blocks.finished(turn);
            for (node, c) in self.surface.prescribed(&nodes) {
                view.twice[node - view.start].set(c, 0.0);
            }
            self.advance(r, nodes, view, kinetic);
        }
    }

    /// v_n and v_{n+½} under the corrected acceleration.
    #[inline(always)]
    fn advance<R: Registers>(&self, r: R, nodes: Range<usize>, view: &mut View<'_, D>, kinetic: &mut Kinetic) {
        let LevelWeights { time, mass: [half, damping] } = &self.weights;
        let (after, before) = (r.load(&time[0].0), r.load(&time[1].0));
        let (half, damping) = (r.load4(&half.0), r.load4(&damping.0));
        let (back, forward) = (r.splat(self.back), r.splat(self.forward));
        let [mut simulated, mut auxiliary] = [kinetic.simulated, kinetic.auxiliary];
        let square = |v: &[f64; D]| v.iter().map(|v| v * v).sum::<f64>();
        let range = view.local(&nodes);
        let given = self.simulated[nodes.clone()].iter().zip(&self.mass[nodes.clone()]);
        let given = given.zip(&self.inverse_mass[nodes]);
        let corrections = view.internal[range.clone()].iter().zip(&view.once[range.clone()]);
        let corrections = corrections.zip(&view.twice[range.clone()]);
        let motions = view.rate[range.clone()].iter_mut().zip(&mut view.half_step[range]);
        for ((((velocity, mass), inverse), ((internal, once), twice)), (rate, half_step)) in
            given.zip(corrections).zip(motions)
        {
            let twice = r.mul4(r.load4(&twice.0), r.splat4(*inverse));
            let lumped = r.add4(r.mul4(half, r.load4(&once.0)), r.mul4(damping, twice));
            let plain = r.load(&rate.0);
            let plain = r.with_first(plain, r.add4(r.first(plain), lumped));
            let force = r.mul(r.load(&internal.0), r.splat(*inverse));
            let start = r.load(&half_step.0);
            rate.0 = r.store(r.add(start, r.mul(r.add(plain, r.mul(before, force)), back)));
            half_step.0 = r.store(r.add(start, r.mul(r.add(plain, r.mul(after, force)), forward)));
            simulated += mass * square(velocity);
            auxiliary += mass * square(&half_step.of(0));
        }
        *kinetic = Kinetic { simulated, auxiliary };
    }
}
