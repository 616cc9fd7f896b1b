//! One pass over the mesh for a step: blocks of nodes and elements go through all sweeps while they are in a cache.
//!
//! A sweep over the blocks of a turn needs the nodes that the sweep before it has finished in this turn and the next
//! one, so each of the five sweeps is a turn behind the one before:
//!
//! 1. u_n, its strains and the forces that need no smoothed ones,
//! 2. the forces of smoothed strains, and with them ã_n,
//! 3. −Kã and the lumping difference of ã,
//! 4. the lumping difference of that, and the skew part of the stress of lumping,
//! 5. the lumping difference a third time, v_n and v_{n+½}.

use super::blocks::Blocks;
use super::lanes::{FirstPair, Gradient, Nodal};
use super::pairs::Pairs;
use super::parts::{Part, View};
use super::surface::SurfaceForces;
use super::sweeps::{
    add_lumping, add_skew, subtract_both, subtract_plain_part, subtract_smoothed_part, subtract_stiffness,
};
use super::weights::{BodyWeights, LevelWeights};
use crate::smoothing::Smoothing;
use percute_core::ids::NodeId;
use percute_core::simd::{Registers, Task};
use std::ops::Range;

/// The data of the pass at t_n.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass<'a, const D: usize> {
    pub(super) pairs: &'a Pairs,
    pub(super) smoothing: &'a Smoothing,
    pub(super) blocks: &'a Blocks,
    pub(super) surface: &'a SurfaceForces,
    /// F_n (N); empty without loads.
    pub(super) external: &'a [[f64; D]],
    pub(super) mass: &'a [f64],
    pub(super) inverse_mass: &'a [f64],
    /// u̇_CA (m/s).
    pub(super) simulated: &'a [[f64; D]],
    pub(super) weights: LevelWeights<'a>,
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
        for k in part.turns() {
            if part.sweeps[0].contains(&k) {
                pass.displace(r, k, &mut view);
            }
            if part.done[0].contains(&k) {
                pass.finish_strains(r, k, &mut view);
            }
            pass.accelerate(r, k.wrapping_sub(1), part, &mut view);
            pass.correct_once(r, k.wrapping_sub(2), part, &mut view);
            pass.correct_twice(r, k.wrapping_sub(3), part, &mut view);
            pass.correct_thrice(r, k.wrapping_sub(4), part, &mut view, &mut kinetic);
        }
        kinetic
    }
}

impl<const D: usize> Pass<'_, D> {
    /// Whether strains are smoothed at this level.
    #[inline(always)]
    fn smooths(&self) -> bool {
        self.weights.smooths && self.smoothing.smooths()
    }

    /// The blocks of a turn.
    #[inline(always)]
    fn blocks_of(&self, turn: usize) -> impl Iterator<Item = usize> {
        self.blocks.even(turn).into_iter().chain(self.blocks.odd(turn))
    }

    /// The weights of a node.
    #[inline(always)]
    fn weights_of(&self, node: usize) -> &BodyWeights {
        &self.weights.bodies[self.smoothing.body(NodeId::new(node))]
    }

    /// u_n of the nodes of a turn, and the strains and forces of its even block.
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
        let patches = self.local_patches(view, &nodes);
        view.patches[patches].fill(Gradient::ZERO);
        let forces = &mut view.rate[range];
        if self.external.is_empty() {
            forces.fill(Nodal::ZERO);
        } else {
            let loads = forces.iter_mut().zip(&self.external[nodes]);
            loads.for_each(|(force, external)| *force = Nodal::all_but_contact(external));
        }
        self.strain(r, self.blocks.even(turn), view);
    }

    /// Where the patches of these nodes are.
    #[inline(always)]
    fn local_patches(&self, view: &View<'_, D>, nodes: &Range<usize>) -> Range<usize> {
        let Range { start, end } = self.smoothing.patches(nodes);
        start.saturating_sub(view.start.patch)..end.saturating_sub(view.start.patch)
    }

    #[inline(always)]
    fn strain<R: Registers>(&self, r: R, block: Option<usize>, view: &mut View<'_, D>) {
        let Some(block) = block else { return };
        let nodes = self.blocks.nodes(block);
        let range = view.local(&nodes);
        let (laws, pairs) = (&self.pairs.laws, self.pairs.block(block));
        if !self.smooths() {
            let (x, forces) = (&view.displacement[range.clone()], &mut view.rate[range]);
            return subtract_stiffness(r, &laws.plain, pairs, x, forces);
        }
        let (patches, places) = (self.local_patches(view, &nodes), self.local_places(view, block));
        let (x, forces) = (&view.displacement[range.clone()], &mut view.rate[range]);
        let kept = (&mut view.gradients[places], &mut view.patches[patches]);
        subtract_plain_part(r, laws, (pairs, self.pairs.around(block)), x, forces, kept);
    }

    /// Where the gradients of a block are.
    #[inline(always)]
    fn local_places(&self, view: &View<'_, D>, block: usize) -> Range<usize> {
        let Range { start, end } = self.pairs.places(block..block + 1);
        start - view.start.gradient..end - view.start.gradient
    }

    /// The strains and forces of the odd block of a turn; the sums of patches become means with their weights.
    #[inline(always)]
    fn finish_strains<R: Registers>(&self, r: R, turn: usize, view: &mut View<'_, D>) {
        self.strain(r, self.blocks.odd(turn), view);
        let nodes = self.blocks.finished(turn);
        if self.smooths() {
            let (local, all) = (self.local_patches(view, &nodes), self.smoothing.patches(&nodes));
            for (patch, weight) in view.patches[local].iter_mut().zip(&self.smoothing.weights()[all]) {
                patch.0 = r.store(r.mul(r.load(&patch.0), r.splat(*weight)));
            }
        }
    }

    /// The forces of smoothed strains, and ã_n.
    #[inline(always)]
    fn accelerate<R: Registers>(&self, r: R, turn: usize, part: &Part, view: &mut View<'_, D>) {
        if part.sweeps[1].contains(&turn) && self.smooths() {
            for block in self.blocks_of(turn) {
                let nodes = self.blocks.nodes(block);
                let (range, patches) = (view.local(&nodes), self.local_patches(view, &nodes));
                let own = &view.gradients[self.local_places(view, block)];
                let (gradients, start) = (&view.gradients[..], view.start.gradient);
                let pairs = (self.pairs.block(block), self.pairs.around(block));
                let kept = (own, &view.patches[patches]);
                subtract_smoothed_part(r, &self.pairs.laws, pairs, (gradients, start), kept, &mut view.rate[range]);
            }
        }
        if !part.done[1].contains(&turn) {
            return;
        }
        let nodes = self.blocks.finished(turn);
        let range = view.local(&nodes);
        self.surface.apply(&nodes, &mut view.rate[range.clone()]);
        for (rate, inverse) in view.rate[range.clone()].iter_mut().zip(&self.inverse_mass[nodes]) {
            rate.0 = r.store(r.mul(r.load(&rate.0), r.splat(*inverse)));
        }
        view.internal[range.clone()].fill(Nodal::ZERO);
        view.lumping.iter_mut().for_each(|field| field[range.clone()].fill(FirstPair::ZERO));
        if let Some(split) = &mut view.level.split {
            split.skew[range].fill([0.0; D]);
        }
    }

    /// −Kã and M⁻¹(M − M_c)ã.
    #[inline(always)]
    fn correct_once<R: Registers>(&self, r: R, turn: usize, part: &Part, view: &mut View<'_, D>) {
        if part.sweeps[2].contains(&turn) {
            for block in self.blocks_of(turn) {
                let range = view.local(&self.blocks.nodes(block));
                let (x, forces) = (&view.rate[range.clone()], &mut view.internal[range.clone()]);
                let once = &mut view.lumping[0][range];
                subtract_both(r, &self.pairs.laws.plain, self.pairs.block(block), x, forces, once);
            }
        }
        if !part.done[2].contains(&turn) {
            return;
        }
        let nodes = self.blocks.finished(turn);
        self.finish_lumping(r, 0, &nodes, view);
        let range = view.local(&nodes);
        for (node, c) in self.surface.prescribed(&nodes) {
            view.internal[node - view.start.node].set(c, 0.0);
        }
        let fields = view.rate[range.clone()].iter().zip(&view.lumping[0][range.clone()]);
        let out = view.level.acceleration[range.clone()].iter_mut();
        match &mut view.level.split {
            None => out.zip(fields).for_each(|(out, (rate, _))| *out = rate.of(0)),
            // On a bar nothing turns: o is all that M_c ã lacks.
            Some(split) if D == 1 => {
                let both = split.lumped[range.clone()].iter_mut().zip(&mut split.skew[range]);
                for ((out, (lumped, skew)), (rate, once)) in out.zip(both).zip(fields) {
                    (*out, *lumped, *skew) = (rate.of(0), [0.0; D], once.auxiliary());
                }
            }
            Some(split) => {
                for (((out, lumped), (rate, once)), node) in out.zip(&mut split.lumped[range]).zip(fields).zip(nodes) {
                    let [first, ..] = self.weights_of(node).auxiliary();
                    let (plain, once): ([f64; D], [f64; D]) = (rate.of(0), once.auxiliary());
                    *out = std::array::from_fn(|c| plain[c] + first * once[c]);
                    *lumped = std::array::from_fn(|c| out[c] - first * plain[c]);
                }
            }
        }
    }

    /// The last product with M⁻¹ of one of the lumping differences, which is 0 on prescribed components.
    #[inline(always)]
    fn finish_lumping<R: Registers>(&self, r: R, which: usize, nodes: &Range<usize>, view: &mut View<'_, D>) {
        let range = view.local(nodes);
        for (field, inverse) in view.lumping[which][range].iter_mut().zip(&self.inverse_mass[nodes.clone()]) {
            field.0 = r.store4(r.mul4(r.load4(&field.0), r.splat4(*inverse)));
        }
        for (node, c) in self.surface.prescribed(nodes) {
            view.lumping[which][node - view.start.node].set(c, 0.0);
        }
    }

    /// One more product of the lumping difference with M⁻¹(M − M_c), for the blocks of a turn.
    #[inline(always)]
    fn lump_again<R: Registers>(&self, r: R, which: usize, turn: usize, view: &mut View<'_, D>) {
        for block in self.blocks_of(turn) {
            let range = view.local(&self.blocks.nodes(block));
            let (before, after) = view.lumping.split_at_mut(which);
            let (x, to) = (&before[which - 1][range.clone()], &mut after[0][range]);
            add_lumping(r, self.pairs.block(block), x, to);
        }
    }

    /// The lumping difference once more, and the acceleration of the skew part of the stress of lumping.
    #[inline(always)]
    fn correct_twice<R: Registers>(&self, r: R, turn: usize, part: &Part, view: &mut View<'_, D>) {
        if part.sweeps[3].contains(&turn) {
            self.lump_again(r, 1, turn, view);
            for block in self.blocks_of(turn) {
                let range = view.local(&self.blocks.nodes(block));
                if let Some(split) = view.level.split.as_mut().filter(|_| D == 2) {
                    let (w, to) = (&split.lumped[range.clone()], &mut split.skew[range]);
                    add_skew(&self.pairs.laws, self.pairs.block(block), w, to);
                }
            }
        }
        if !part.done[3].contains(&turn) {
            return;
        }
        let nodes = self.blocks.finished(turn);
        self.finish_lumping(r, 1, &nodes, view);
        if let Some(split) = view.level.split.as_mut().filter(|_| D == 2) {
            let start = view.start.node;
            let local = nodes.start - start..nodes.end - start;
            for (skew, inverse) in split.skew[local].iter_mut().zip(&self.inverse_mass[nodes.clone()]) {
                skew.iter_mut().for_each(|value| *value *= inverse);
            }
            self.surface.prescribed(&nodes).for_each(|(node, c)| split.skew[node - start][c] = 0.0);
        }
    }

    /// The lumping difference a third time, v_n and v_{n+½}.
    #[inline(always)]
    fn correct_thrice<R: Registers>(
        &self,
        r: R,
        turn: usize,
        part: &Part,
        view: &mut View<'_, D>,
        kinetic: &mut Kinetic,
    ) {
        if part.sweeps[4].contains(&turn) {
            self.lump_again(r, 2, turn, view);
        }
        if part.done[4].contains(&turn) {
            let nodes = self.blocks.finished(turn);
            self.finish_lumping(r, 2, &nodes, view);
            self.advance(r, nodes, view, kinetic);
        }
    }

    /// v_n and v_{n+½} under the corrected acceleration.
    #[inline(always)]
    fn advance<R: Registers>(&self, r: R, nodes: Range<usize>, view: &mut View<'_, D>, kinetic: &mut Kinetic) {
        let (after, before) = (r.load(&self.weights.time[0].0), r.load(&self.weights.time[1].0));
        let (back, forward) = (r.splat(self.back), r.splat(self.forward));
        let [mut simulated, mut auxiliary] = [kinetic.simulated, kinetic.auxiliary];
        let square = |v: &[f64; D]| v.iter().map(|v| v * v).sum::<f64>();
        let range = view.local(&nodes);
        let given = self.simulated[nodes.clone()].iter().zip(&self.mass[nodes.clone()]);
        let given = given.zip(&self.inverse_mass[nodes.clone()]).zip(nodes);
        let [once, twice, thrice] = view.lumping.each_ref().map(|field| &field[range.clone()]);
        let corrections = view.internal[range.clone()].iter().zip(once.iter().zip(twice).zip(thrice));
        let motions = view.rate[range.clone()].iter_mut().zip(&mut view.half_step[range]);
        for (((((velocity, mass), inverse), node), (internal, ((once, twice), thrice))), (rate, half_step)) in
            given.zip(corrections).zip(motions)
        {
            let part = |weight: &FirstPair, field: &FirstPair| r.mul4(r.load4(&weight.0), r.load4(&field.0));
            let [first, second, third] = &self.weights_of(node).mass;
            let lumped = r.add4(r.add4(part(first, once), part(second, twice)), part(third, thrice));
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
