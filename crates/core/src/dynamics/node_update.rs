//! Motion of consecutive nodes, and their part in the balance.

use crate::simd::{Eight, Registers};
use std::ops::Range;

/// The motion of the nodes before the forces of an instant are computed.
#[derive(Clone, Copy, Debug)]
pub(super) enum NodeMotion<'a, const D: usize> {
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
    /// u ← a M⁻¹f + b v + c u with these factors: a step of Lanczos. The kinetic energy is ½ u·M u instead, and there
    /// is no momentum.
    Combine([f64; 3]),
}

/// Whether eight numbers hold whole nodes. Those of a solid do not: its nodes are worked on one after the other.
const fn fits(dimension: usize) -> bool {
    8 % dimension == 0
}

/// The lane of a component of the i-th node of a run.
#[inline(always)]
const fn lane<const D: usize>(i: usize, c: usize) -> usize {
    if fits(D) { (D * i + c) % 8 } else { D * (i % (8 / D)) + c }
}

/// The sums over the nodes and elements of a strip, in lanes: component c of node i of a run has lane D i + c, modulo
/// 8, or modulo D (8/D).
#[derive(Clone, Copy, Debug)]
pub(super) struct StripSums<const D: usize> {
    /// Twice the strain energy (J).
    pub(super) strain: Eight,
    /// Twice the kinetic energy (J).
    kinetic: Eight,
    /// Momentum (kg m/s).
    momentum: Eight,
}

impl<const D: usize> StripSums<D> {
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
            let (p, lane) = (mass * v[c] + back * force[c], lane::<D>(i, c));
            self.momentum[lane] += p;
            self.kinetic[lane] += p * p * inverse;
        }
    }

    pub(super) fn add_all(&mut self, other: &Self) {
        for i in 0..8 {
            self.strain[i] += other.strain[i];
            self.kinetic[i] += other.kinetic[i];
            self.momentum[i] += other.momentum[i];
        }
    }
}

/// A number of each node for eight components.
#[inline(always)]
fn of_nodes<L: Registers, const D: usize>(l: L, nodes: &[f64]) -> L::Eight {
    match (nodes.first_chunk(), nodes.first_chunk()) {
        (Some(eight), _) if D == 1 => l.load(eight),
        (_, Some(four)) => l.repeat(four),
        _ => l.splat(0.0),
    }
}

/// Fields of consecutive nodes.
pub(super) struct Nodes<'a, const D: usize> {
    pub(super) displacement: &'a mut [[f64; D]],
    pub(super) velocity: &'a mut [[f64; D]],
    pub(super) force: &'a mut [[f64; D]],
    pub(super) mass: &'a [f64],
    pub(super) inverse_mass: &'a [f64],
}

/// The numbers of all nodes in eights, but for the last few nodes.
macro_rules! eights {
    ($field:expr, $rest:expr) => {
        $field[..$rest.start].as_flattened().as_chunks::<8>().0.iter()
    };
    (mut $field:expr, $rest:expr) => {
        $field[..$rest.start].as_flattened_mut().as_chunks_mut::<8>().0.iter_mut()
    };
}

impl<const D: usize> Nodes<'_, D> {
    /// The last nodes, which do not fill eight numbers.
    #[inline(always)]
    fn rest(&self) -> Range<usize> {
        let eights = if fits(D) { self.velocity.len() - self.velocity.len() % (8 / D) } else { 0 };
        eights..self.velocity.len()
    }

    /// Moves the nodes, with these numbers, and sets their forces to zero.
    #[inline(always)]
    pub(super) fn advance<L: Registers>(
        self,
        l: L,
        motion: &NodeMotion<'_, D>,
        numbers: Range<usize>,
        sums: &mut StripSums<D>,
    ) {
        match *motion {
            NodeMotion::Start => self.force.fill([0.0; D]),
            NodeMotion::Advance { h, dt } => self.step(l, h, dt),
            NodeMotion::Follow { h, displacement } => {
                self.displacement.copy_from_slice(&displacement[numbers]);
                match h {
                    // The displacement stays.
                    Some(h) => self.step(l, h, 0.0),
                    None => self.force.fill([0.0; D]),
                }
            }
            NodeMotion::Combine(factors) => self.combine(l, factors, sums),
        }
    }

    /// v += h M⁻¹f, u += Δt v, f = 0.
    #[inline(always)]
    fn step<L: Registers>(self, l: L, h: f64, dt: f64) {
        let rest = self.rest();
        let (factor, length, none) = (l.splat(h), l.splat(dt), l.store(l.splat(0.0)));
        let fields = eights!(mut self.displacement, rest)
            .zip(eights!(mut self.velocity, rest))
            .zip(eights!(mut self.force, rest));
        for (((u, v), force), inverse) in fields.zip(self.inverse_mass.chunks_exact(8 / D)) {
            let acceleration = l.mul(of_nodes::<L, D>(l, inverse), l.load(force));
            let velocity = l.add(l.load(v), l.mul(factor, acceleration));
            *u = l.store(l.add(l.load(u), l.mul(length, velocity)));
            *v = l.store(velocity);
            *force = none;
        }
        for i in rest {
            for c in 0..D {
                self.velocity[i][c] += h * (self.inverse_mass[i] * self.force[i][c]);
                self.displacement[i][c] += dt * self.velocity[i][c];
                self.force[i][c] = 0.0;
            }
        }
    }

    /// u ← a M⁻¹f + b v + c u and f = 0; adds twice the kinetic energy of u.
    #[inline(always)]
    fn combine<L: Registers>(self, l: L, [a, b, c]: [f64; 3], sums: &mut StripSums<D>) {
        let rest = self.rest();
        let (of_force, of_v, of_u, none) = (l.splat(a), l.splat(b), l.splat(c), l.store(l.splat(0.0)));
        let mut kinetic = l.load(&sums.kinetic);
        let fields =
            eights!(mut self.displacement, rest).zip(eights!(self.velocity, rest)).zip(eights!(mut self.force, rest));
        let masses = self.mass.chunks_exact(8 / D).zip(self.inverse_mass.chunks_exact(8 / D));
        for (((u, v), force), (mass, inverse)) in fields.zip(masses) {
            let acceleration = l.mul(of_nodes::<L, D>(l, inverse), l.load(force));
            let others = l.add(l.mul(of_v, l.load(v)), l.mul(of_u, l.load(u)));
            let sum = l.add(l.mul(of_force, acceleration), others);
            kinetic = l.add(kinetic, l.mul(l.mul(sum, sum), of_nodes::<L, D>(l, mass)));
            *u = l.store(sum);
            *force = none;
        }
        sums.kinetic = l.store(kinetic);
        for i in rest {
            for k in 0..D {
                let acceleration = self.inverse_mass[i] * self.force[i][k];
                let sum = a * acceleration + (b * self.velocity[i][k] + c * self.displacement[i][k]);
                sums.kinetic[lane::<D>(i, k)] += sum * sum * self.mass[i];
                self.displacement[i][k] = sum;
                self.force[i][k] = 0.0;
            }
        }
    }

    /// Adds momentum and kinetic energy of v_n = v_{n−½} + `back` a_n.
    #[inline(always)]
    pub(super) fn sum_up<L: Registers>(self, l: L, back: f64, sums: &mut StripSums<D>) {
        let rest = self.rest();
        let (factor, mut momentum, mut kinetic) = (l.splat(back), l.load(&sums.momentum), l.load(&sums.kinetic));
        let masses = self.mass.chunks_exact(8 / D).zip(self.inverse_mass.chunks_exact(8 / D));
        for ((v, force), (mass, inverse)) in eights!(self.velocity, rest).zip(eights!(self.force, rest)).zip(masses) {
            // m v_n.
            let p = l.add(l.mul(of_nodes::<L, D>(l, mass), l.load(v)), l.mul(factor, l.load(force)));
            momentum = l.add(momentum, p);
            kinetic = l.add(kinetic, l.mul(l.mul(p, p), of_nodes::<L, D>(l, inverse)));
        }
        (sums.momentum, sums.kinetic) = (l.store(momentum), l.store(kinetic));
        for i in rest {
            let masses = [self.mass[i], self.inverse_mass[i]];
            sums.add(i, masses, back, &self.velocity[i], &self.force[i]);
        }
    }
}
