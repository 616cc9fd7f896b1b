//! One pass over the mesh for a step: blocks of nodes and elements go through all sweeps while they are in a cache.
//!
//! A sweep over a pair of blocks needs the nodes that the sweep before it has finished, so each of the three sweeps is one pair of
//! blocks behind the one before.

use super::blocks::Blocks;
use super::cells::{Cells, NodalLumping};
use super::surface::SurfaceForces;
use super::weights::LevelWeights;
use super::{AuxiliaryLevel, Fields, LUMPED, MOTIONS, NodalLanes};
use std::ops::Range;

/// The data of the pass at t_n.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass<'a, const D: usize, const N: usize> {
    pub(super) cells: &'a Cells<D, N>,
    pub(super) blocks: &'a Blocks,
    pub(super) surface: &'a SurfaceForces<D, N>,
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

impl<const D: usize, const N: usize> Pass<'_, D, N> {
    /// Makes u_n, ã_n, v_n and v_{n+½} of all motions from u_{n−1} and v_{n−½}.
    #[inline(always)]
    pub(super) fn run(&self, fields: &mut Fields<D>, level: &mut AuxiliaryLevel<'_, D>) -> Kinetic {
        let (pairs, mut kinetic) = (self.blocks.pairs(), Kinetic::default());
        for k in 0..pairs + 2 {
            if k < pairs {
                self.accelerate(k, fields, level);
            }
            if (1..=pairs).contains(&k) {
                self.correct_once(k - 1, fields, level);
            }
            if k >= 2 {
                self.correct_twice(k - 2, fields);
                self.advance(self.blocks.finished(k - 2), fields, &mut kinetic);
            }
        }
        kinetic
    }

    /// u_n, F_n − Ku_n and ã_n.
    #[inline(always)]
    fn accelerate(&self, pair: usize, fields: &mut Fields<D>, level: &mut AuxiliaryLevel<'_, D>) {
        self.displace(self.blocks.begun(pair), fields, level);
        for elements in self.blocks.pair(pair) {
            self.cells.subtract_stiffness(elements, &fields.displacement, &mut fields.rate);
        }
        let range = self.blocks.finished(pair);
        self.surface.apply(&range, self.mass, &mut fields.rate, level.force);
        let rates = fields.rate[range.clone()].iter_mut().zip(&self.inverse_mass[range.clone()]);
        for (rate, inverse) in rates {
            *rate = NodalLanes(rate.0.map(|lanes| lanes.map(|f| f * inverse)));
        }
        fields.internal[range.clone()].fill(NodalLanes::ZERO);
        fields.once[range.clone()].fill(NodalLumping::ZERO);
        fields.twice[range].fill(NodalLumping::ZERO);
    }

    #[inline(always)]
    fn displace(&self, range: Range<usize>, fields: &mut Fields<D>, level: &mut AuxiliaryLevel<'_, D>) {
        let moving = fields.displacement[range.clone()].iter_mut().zip(&fields.half_step[range.clone()]);
        for ((u, v), out) in moving.zip(&mut level.displacement[range.clone()]) {
            let (mut value, velocity) = (u.0, v.0);
            for c in 0..D {
                (0..MOTIONS).for_each(|l| value[c][l] += self.due * velocity[c][l]);
                out[c] = value[c][0];
            }
            u.0 = value;
        }
        if fields.external.is_empty() {
            fields.rate[range].fill(NodalLanes::ZERO);
            return;
        }
        for (force, external) in fields.rate[range.clone()].iter_mut().zip(&fields.external[range]) {
            // No load acts on the contact difference.
            *force = NodalLanes(external.map(|f| [f, f, f, 0.0]));
        }
    }

    /// −Kã and M⁻¹(M − M_c)ã.
    #[inline(always)]
    fn correct_once(&self, pair: usize, fields: &mut Fields<D>, level: &mut AuxiliaryLevel<'_, D>) {
        for elements in self.blocks.pair(pair) {
            self.cells.subtract_both(elements, &fields.rate, &mut fields.internal, &mut fields.once);
        }
        let range = self.blocks.finished(pair);
        for (once, inverse) in fields.once[range.clone()].iter_mut().zip(&self.inverse_mass[range.clone()]) {
            *once = NodalLumping(once.0.map(|lanes| lanes.map(|f| f * inverse)));
        }
        for (node, c) in self.surface.prescribed(&range) {
            fields.internal[node].0[c] = [0.0; MOTIONS];
            fields.once[node].0[c] = [0.0; LUMPED];
        }
        if let Some(out) = &mut level.lumping_difference {
            for (out, once) in out[range.clone()].iter_mut().zip(&fields.once[range]) {
                *out = once.0.map(|lanes| lanes[0]);
            }
        }
    }

    /// (M − M_c)M⁻¹(M − M_c)ã.
    #[inline(always)]
    fn correct_twice(&self, pair: usize, fields: &mut Fields<D>) {
        for elements in self.blocks.pair(pair) {
            self.cells.add_lumping(elements, &fields.once, &mut fields.twice);
        }
        for (node, c) in self.surface.prescribed(&self.blocks.finished(pair)) {
            fields.twice[node].0[c] = [0.0; LUMPED];
        }
    }

    /// v_n and v_{n+½} under the corrected acceleration.
    #[inline(always)]
    fn advance(&self, range: Range<usize>, fields: &mut Fields<D>, kinetic: &mut Kinetic) {
        let LevelWeights { time: [after, before], mass: [half, damping] } = self.weights;
        let [mut simulated, mut auxiliary] = [kinetic.simulated, kinetic.auxiliary];
        for i in range {
            let (mass, inverse) = (self.mass[i], self.inverse_mass[i]);
            let (internal, once, twice) = (fields.internal[i].0, fields.once[i].0, fields.twice[i].0);
            let (mut rate, mut velocity) = (fields.rate[i].0, fields.half_step[i].0);
            let mut squares = [0.0; 2];
            for c in 0..D {
                let mut lumped = [0.0; MOTIONS];
                (0..LUMPED).for_each(|l| lumped[l] = half[l] * once[c][l] + damping[l] * (inverse * twice[c][l]));
                let plain = rate[c];
                for l in 0..MOTIONS {
                    let force = inverse * internal[c][l];
                    let first = plain[l] + (before[l] * force + lumped[l]);
                    let next = plain[l] + (after[l] * force + lumped[l]);
                    rate[c][l] = velocity[c][l] + self.back * first;
                    velocity[c][l] += self.forward * next;
                }
                squares[0] += self.simulated[i][c] * self.simulated[i][c];
                squares[1] += velocity[c][0] * velocity[c][0];
            }
            simulated += mass * squares[0];
            auxiliary += mass * squares[1];
            (fields.rate[i].0, fields.half_step[i].0) = (rate, velocity);
        }
        *kinetic = Kinetic { simulated, auxiliary };
    }
}
