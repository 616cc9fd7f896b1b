//! Von Mises plasticity with linear hardening, small strains.
//!
//! With the stress σ, the back stress X = ⅔ C ε_p and R = H_i p, the elastic range is f = q(s − X) − σ_y − R ≤ 0,
//! q(x) = √(3/2 x:x), and Ė_p = ṗ n with n = 3/2 (s − X)/q. C and H_i share the hardening modulus H.
//!
//! Internal variables of a point: ε_p in the plane, as xx, yy and xy, and p. Of a bar: ε_p and p.

use super::elastic::{Elastic, Hypothesis};
use super::hyperelastic::Response;
use super::{Law, LinearLaw, MOST_VARIABLES, PointLaw, Tensor};
use crate::simd::lanes::Value;

/// A point flows where f is above this part of its yield stress σ_y + R: more than the rounding of f, so that the same
/// strain once more changes nothing.
const FLOWS: f64 = 1e-12;
/// Newton steps of plane stress. 1/q is nearly linear in the multiplier: the fifth changes the last digit at most.
const STEPS: usize = 5;
/// Newton steps for σ_zz of the inverse law.
const ACROSS: usize = 8;

/// The law of a material that may yield; one without hardening never does.
#[derive(Clone, Copy, Debug)]
pub struct VonMises {
    hypothesis: Hypothesis,
    young: f64,
    poisson: f64,
    lambda: f64,
    shear: f64,
    yield_stress: f64,
    isotropic: f64,
    kinematic: f64,
    elastic: Elastic,
}

/// Symmetric tensor with its four components xx, yy, zz and xy. Of a bar the first one only.
#[derive(Clone, Copy, Debug)]
pub struct FourComponents<V>(pub [V; 4]);

impl<V: Value> FourComponents<V> {
    /// a:b.
    #[inline(always)]
    pub fn product(&self, other: &Self) -> V {
        let (a, b) = (&self.0, &other.0);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] * 2.0
    }

    #[inline(always)]
    fn map(self, other: &Self, number: impl Fn(V, V) -> V) -> Self {
        let (a, b) = (&self.0, &other.0);
        Self([number(a[0], b[0]), number(a[1], b[1]), number(a[2], b[2]), number(a[3], b[3])])
    }

    /// a − b.
    #[inline(always)]
    #[must_use]
    pub fn minus(self, other: &Self) -> Self {
        self.map(
            other,
            #[inline(always)]
            |a, b| a - b,
        )
    }

    /// a + s b.
    #[inline(always)]
    fn plus(self, factor: V, other: &Self) -> Self {
        self.map(
            other,
            #[inline(always)]
            |a, b| a + b * factor,
        )
    }

    /// √(3/2 a:a) of a deviator.
    #[inline(always)]
    fn equivalent(&self) -> V {
        (self.product(self) * 1.5).sqrt()
    }
}

/// The forces on the flow of a point.
#[derive(Clone, Copy, Debug)]
pub struct FlowForces {
    /// σ − X (Pa).
    driving: FourComponents<f64>,
    /// σ_y + R (Pa).
    resistance: f64,
}

impl FlowForces {
    /// φ(Ė_p) − Σ·Ė_p of a flow under these forces (J/m³), Fenchel: not negative where they are admissible, and 0 only
    /// where the flow obeys the flow rule under them. The flow is that from internal variables to others.
    #[must_use]
    pub fn misfit<const D: usize>(&self, before: &[f64], after: &[f64]) -> f64 {
        let [(old, p), (new, q)] = [before, after].map(VonMises::plastic_strain::<f64, D>);
        (q - p) * self.resistance - self.driving.product(&new.minus(&old))
    }
}

/// The state of a point.
#[derive(Clone, Copy, Debug)]
pub struct PlasticState<V, const D: usize> {
    /// σ in the plane (Pa).
    pub stress: [[V; D]; D],
    /// σ_zz (Pa).
    pub stress_across: V,
    /// ½ σ:(ε − ε_p) (J/m³).
    pub elastic_energy: V,
    /// ε_p.
    pub plastic_strain: FourComponents<V>,
    /// p.
    pub equivalent: V,
}

impl VonMises {
    /// The law of a material.
    #[must_use]
    pub fn new(elastic: &Elastic) -> Self {
        let (lambda, shear) = elastic.moduli();
        let (yield_stress, isotropic, kinematic) = match (elastic.hardening(), elastic.yield_stress()) {
            (Some(hardening), Some(yield_stress)) => {
                let kinematic = hardening.modulus() * hardening.kinematic();
                (yield_stress, hardening.modulus() - kinematic, kinematic)
            }
            // Times p = 0 it is still a number.
            _ => (f64::MAX, 0.0, 0.0),
        };
        let (hypothesis, young, poisson) = (elastic.hypothesis(), elastic.young(), elastic.poisson());
        let elastic = *elastic;
        Self { hypothesis, young, poisson, lambda, shear, yield_stress, isotropic, kinematic, elastic }
    }

    /// How much longer than in an elastic body an impact at this speed (m/s) takes to stop a depth of the material:
    /// ρcv over the stress of the impact: ρcv up to the yield speed v_y, ρcv_y + ρc_p(v − v_y) beyond. v_y and the
    /// speed c_p of plastic waves are those of a plane wave in plane strain, and of a bar otherwise.
    #[must_use]
    pub fn slowing(&self, speed: f64) -> f64 {
        if !self.yields() {
            return 1.0;
        }
        let (hardening, density) = (self.isotropic + self.kinematic, self.elastic.density());
        let modulus = self.lambda + 2.0 * self.shear;
        let (plastic, first) = match self.hypothesis {
            Hypothesis::PlaneStrain => {
                let plastic = modulus - 4.0 * self.shear * self.shear / (3.0 * self.shear + hardening);
                (plastic, self.yield_stress * (1.0 - self.poisson) / (1.0 - 2.0 * self.poisson))
            }
            _ => (self.young * hardening / (self.young + hardening), self.yield_stress),
        };
        let wave = (density * modulus).sqrt();
        let beyond = speed - first / wave;
        if beyond > 0.0 { wave * speed / (first + (density * plastic).sqrt() * beyond) } else { 1.0 }
    }

    /// Internal variables of a point of a body with this dimension.
    #[must_use]
    #[inline(always)]
    pub const fn count(dimension: usize) -> usize {
        if dimension == 1 { 2 } else { 4 }
    }

    /// Whether it ever yields.
    #[must_use]
    pub fn yields(&self) -> bool {
        self.yield_stress < f64::MAX
    }

    /// Plastic strain of the internal variables of a point, and p.
    #[inline(always)]
    pub fn plastic_strain<V: Value, const D: usize>(internal: &[V]) -> (FourComponents<V>, V) {
        let zero = internal[0].zero();
        if D == 1 {
            return (FourComponents([internal[0], zero, zero, zero]), internal[1]);
        }
        let zz = -(internal[0] + internal[1]);
        (FourComponents([internal[0], internal[1], zz, internal[2]]), internal[3])
    }

    /// Adds Δp n to them; of n the component zz is that which has no trace.
    #[inline(always)]
    fn flow<V: Value, const D: usize>(internal: &mut [V], step: V, direction: &FourComponents<V>) {
        let [xx, yy, _, xy] = direction.0;
        internal[0] += step * xx;
        if D == 1 {
            internal[1] += step;
        } else {
            internal[1] += step * yy;
            internal[2] += step * xy;
            internal[3] += step;
        }
    }

    /// The strain in the plane that has the stress K ε* in the plane which a plastic strain takes off:
    /// σ = K(ε − ε*). In plane strain ε_p + ν ε_p,zz 1, else ε_p.
    #[inline(always)]
    pub fn eigenstrain<V: Value, const D: usize>(&self, internal: &[V]) -> [[V; D]; D] {
        let (FourComponents([xx, yy, zz, xy]), _) = Self::plastic_strain::<V, D>(internal);
        let mut strain = [[xy; D]; D];
        if D == 1 {
            strain[0][0] = xx;
            return strain;
        }
        let across = if self.hypothesis == Hypothesis::PlaneStrain { self.poisson } else { 0.0 };
        (strain[0][0], strain[1][1]) = (xx + zz * across, yy + zz * across);
        strain
    }

    /// σ_zz of a stress in the plane (Pa), with the plastic strain of a point: ν (σ_xx + σ_yy) − E ε_p,zz in plane
    /// strain.
    #[inline(always)]
    fn stress_across<V: Value, const D: usize>(&self, stress: &[[V; D]; D], plastic: &FourComponents<V>) -> V {
        if D == 1 || self.hypothesis != Hypothesis::PlaneStrain {
            return stress[0][0].zero();
        }
        (stress[0][0] + stress[1][1]) * self.poisson - plastic.0[2] * self.young
    }

    /// Four components of a stress in the plane.
    #[inline(always)]
    fn in_space<V: Value, const D: usize>(stress: &[[V; D]; D], across: V) -> FourComponents<V> {
        let zero = across.zero();
        if D == 1 {
            return FourComponents([stress[0][0], zero, zero, zero]);
        }
        FourComponents([stress[0][0], stress[1][1], across, stress[0][1]])
    }

    /// ξ = s − X of a stress, and q: of a bar σ − C ε_p and its size.
    #[inline(always)]
    fn relative<V: Value, const D: usize>(
        &self,
        stress: &FourComponents<V>,
        plastic: &FourComponents<V>,
    ) -> (FourComponents<V>, V) {
        if D == 1 {
            let mut xi = *stress;
            xi.0[0] -= plastic.0[0] * self.kinematic;
            return (xi, xi.0[0].abs());
        }
        let mean = (stress.0[0] + stress.0[1] + stress.0[2]) * (1.0 / 3.0);
        let mut xi = stress.plus(mean.fill(-self.kinematic / 1.5), plastic);
        (0..3).for_each(|c| xi.0[c] -= mean);
        let q = xi.equivalent();
        (xi, q)
    }

    /// n of ξ and q: 3/2 ξ/q, of a bar ξ/q.
    #[inline(always)]
    fn direction<V: Value, const D: usize>(xi: &FourComponents<V>, q: V) -> FourComponents<V> {
        let factor = q.fill(if D == 1 { 1.0 } else { 1.5 }) / q.max(q.fill(f64::MIN_POSITIVE));
        FourComponents(xi.0.map(
            #[inline(always)]
            |x| x * factor,
        ))
    }

    /// σ_y + R (Pa).
    #[inline(always)]
    fn range<V: Value>(&self, p: V) -> V {
        p * self.isotropic + p.fill(self.yield_stress)
    }

    /// σ in the plane of a displacement gradient and internal variables (Pa).
    #[inline(always)]
    fn elastic_stress<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], internal: &[V]) -> [[V; D]; D] {
        let eigen = self.eigenstrain::<V, D>(internal);
        let (mut trace, mut stress) = (gradient[0][0] - eigen[0][0], *gradient);
        if D == 2 {
            trace += gradient[1][1] - eigen[1][1];
        }
        for a in 0..D {
            for b in 0..D {
                stress[a][b] = (gradient[a][b] + gradient[b][a]) * self.shear - eigen[a][b] * (2.0 * self.shear);
            }
            stress[a][a] += trace * self.lambda;
        }
        stress
    }

    /// Takes the internal variables to the strain of a displacement gradient: the return to the elastic range along
    /// its normal.
    #[inline(always)]
    pub fn advance<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], internal: &mut [V]) {
        let trial = self.elastic_stress(gradient, internal);
        let (plastic, p) = Self::plastic_strain::<V, D>(internal);
        let stress = Self::in_space(&trial, self.stress_across(&trial, &plastic));
        let (xi, q) = self.relative::<V, D>(&stress, &plastic);
        let range = self.range(p);
        let excess = (q - range) / range;
        if !excess.any(|excess| excess > FLOWS) {
            return;
        }
        let excess = q.zero().replaced_where(excess, |excess| excess > FLOWS, |excess| excess) * range;
        if D == 2 && self.hypothesis == Hypothesis::PlaneStress {
            return self.return_in_plane(&xi, excess, range, internal);
        }
        let stiffness = if D == 1 { self.young } else { 3.0 * self.shear };
        let step = excess * (1.0 / (stiffness + self.isotropic + self.kinematic));
        Self::flow::<V, D>(internal, step, &Self::direction::<V, D>(&xi, q));
    }

    /// The return in plane stress (Simo and Taylor 1986): sum and difference of the stresses fall by factors of their
    /// own, 1/(1 + k γ), until q is σ_y + R.
    #[inline(always)]
    fn return_in_plane<V: Value>(&self, xi: &FourComponents<V>, excess: V, range: V, internal: &mut [V]) {
        let back = self.kinematic / 1.5;
        let slopes = [self.young / (3.0 * (1.0 - self.poisson)) + back, 2.0 * self.shear + back];
        let [xx, yy, _, xy] = xi.0;
        // Of the relative stress in the plane, η = ξ + tr ξ 1, the sum is three times that of ξ.
        let (sum, difference) = ((xx + yy) * 3.0, xx - yy);
        let squares = [sum * sum * 0.25, difference * difference * 0.75 + xy * xy * 3.0];
        let one = range.fill(1.0);
        let mut gamma = range.zero();
        let (mut factors, mut q) = ([one; 2], range);
        for step in 0..=STEPS {
            let f = [0, 1].map(
                #[inline(always)]
                |k| one / (one + gamma * slopes[k]),
            );
            let parts = [0, 1].map(
                #[inline(always)]
                |k| squares[k] * f[k] * f[k],
            );
            factors = f;
            q = (parts[0] + parts[1]).sqrt().max(one * f64::MIN_POSITIVE);
            if step == STEPS {
                break;
            }
            // g = range/q − (1 − ⅔ H_i γ), nearly linear in γ.
            let ratio = range / q;
            let slope = ratio * (parts[0] * f[0] * slopes[0] + parts[1] * f[1] * slopes[1]) / (q * q);
            let g = ratio - one + gamma * (self.isotropic / 1.5);
            // A point without relative stress has no slope: its step is not a number, which the larger of both ignores.
            gamma = one.zero().max(gamma - g / (slope + one * (self.isotropic / 1.5)));
        }
        let gamma = one.zero().replaced_where(excess, |excess| excess > 0.0, |_| 1.0) * gamma;
        let (sum, difference) = (sum * factors[0] * (1.0 / 6.0), difference * factors[1] * 0.5);
        internal[0] += gamma * (sum + difference);
        internal[1] += gamma * (sum - difference);
        internal[2] += gamma * xy * factors[1];
        internal[3] += gamma * q * (1.0 / 1.5);
    }

    /// The inverse law: takes the internal variables to the nearest ones, along the normal, whose elastic range has a
    /// stress in the plane (Pa). In plane strain σ_zz is free: it makes the sum of the energies of the flow and of its
    /// distance from the elastic one least. Gives the forces on the flow.
    #[must_use]
    pub fn admit<const D: usize>(&self, stress: &Tensor<D>, internal: &mut [f64]) -> FlowForces {
        let (plastic, p) = Self::plastic_strain::<f64, D>(internal);
        let (range, hardening) = (self.range(p), self.isotropic + self.kinematic);
        let elastic = self.stress_across(stress, &plastic);
        let at = |across: f64| {
            let (xi, q) = self.relative::<f64, D>(&Self::in_space(stress, across), &plastic);
            (Self::direction::<f64, D>(&xi, q), q, (q - range).max(0.0))
        };
        let mut across = elastic;
        if D == 2 && self.hypothesis == Hypothesis::PlaneStrain {
            for _ in 0..ACROSS {
                let (FourComponents([_, _, zz, _]), q, excess) = at(across);
                if excess == 0.0 {
                    break;
                }
                let slope = (across - elastic) / self.young + excess / hardening * zz;
                let (flat, normal) = (excess / q, zz * zz);
                across -= slope / (1.0 / self.young + (normal + flat * (1.0 - normal)) / hardening);
            }
        }
        let (normal, _, excess) = at(across);
        if excess > 0.0 {
            Self::flow::<f64, D>(internal, excess / hardening, &normal);
        }
        self.flow_forces::<D>(&Self::in_space(stress, across), internal)
    }

    /// The forces on the flow of a point in a state.
    #[must_use]
    pub fn forces<const D: usize>(&self, state: &PlasticState<f64, D>, internal: &[f64]) -> FlowForces {
        self.flow_forces::<D>(&Self::in_space(&state.stress, state.stress_across), internal)
    }

    /// σ − X and R of a stress and internal variables.
    fn flow_forces<const D: usize>(&self, stress: &FourComponents<f64>, internal: &[f64]) -> FlowForces {
        let (plastic, p) = Self::plastic_strain::<f64, D>(internal);
        let back = if D == 1 { -self.kinematic } else { -self.kinematic / 1.5 };
        FlowForces { driving: stress.plus(back, &plastic), resistance: self.range(p) }
    }

    /// ½ of the square of the distance of the forces X and R of two points (J/m³): ⅓ C |Δε_p|² + ½ H_i Δp².
    #[must_use]
    pub fn hardening_distance<const D: usize>(&self, a: &[f64], b: &[f64]) -> f64 {
        let difference: [f64; MOST_VARIABLES] =
            std::array::from_fn(|k| if k < Self::count(D) { a[k] - b[k] } else { 0.0 });
        self.plastic_energies::<f64, D>(&difference)[0]
    }

    /// The state of a point with these internal variables.
    #[inline(always)]
    pub fn state<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], internal: &[V]) -> PlasticState<V, D> {
        let stress = self.elastic_stress(gradient, internal);
        let (plastic_strain, equivalent) = Self::plastic_strain::<V, D>(internal);
        let eigen = self.eigenstrain::<V, D>(internal);
        let mut elastic_energy = stress[0][0].zero();
        for a in 0..D {
            (0..D).for_each(|b| elastic_energy += stress[a][b] * (gradient[a][b] - eigen[a][b]) * 0.5);
        }
        if D == 2 && self.hypothesis == Hypothesis::PlaneStrain {
            elastic_energy += plastic_strain.0[2] * plastic_strain.0[2] * (0.5 * self.young);
        }
        let stress_across = self.stress_across(&stress, &plastic_strain);
        PlasticState { stress, stress_across, elastic_energy, plastic_strain, equivalent }
    }

    /// Stored energy of hardening and dissipated energy of a point at these internal variables (J/m³):
    /// ½ H_i p² + ⅓ C ε_p:ε_p and σ_y p.
    #[inline(always)]
    pub fn plastic_energies<V: Value, const D: usize>(&self, internal: &[V]) -> [V; 2] {
        let (plastic, p) = Self::plastic_strain::<V, D>(internal);
        let back = if D == 1 { 0.5 * self.kinematic } else { self.kinematic / 3.0 };
        [p * p * (0.5 * self.isotropic) + plastic.product(&plastic) * back, p * self.yield_stress]
    }
}

impl PointLaw for VonMises {
    #[inline(always)]
    fn variables<const D: usize>() -> usize {
        Self::count(D)
    }

    /// The energy is the elastic one, that stored by hardening and the dissipated one.
    #[inline(always)]
    fn respond<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], internal: &mut [V]) -> Response<V, D> {
        self.advance(gradient, internal);
        let state = self.state(gradient, internal);
        let [stored, dissipated] = self.plastic_energies::<V, D>(internal);
        (state.stress, state.elastic_energy + stored + dissipated)
    }

    /// That of the elastic law: plastic flow makes no point stiffer.
    #[inline(always)]
    fn stiffness_bound<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], root: &[[V; D]; D]) -> V {
        self.elastic.stiffness_bound(gradient, root)
    }

    #[inline(always)]
    fn stiffness_excess<V: Value, const D: usize>(
        &self,
        gradient: &[[V; D]; D],
        square: &[[V; D]; D],
        limit: f64,
    ) -> V {
        self.elastic.stiffness_excess(gradient, square, limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Hardening;
    use percute_testkit::Random;

    /// Bar, plane strain and plane stress with isotropic, kinematic and mixed hardening, E = 1 and σ_y = 0.004.
    fn laws<const D: usize>() -> Vec<VonMises> {
        let elastic = match D {
            1 => vec![Elastic::bar(1.0, 1.0, 1.0).unwrap()],
            _ => [Elastic::plane_strain, Elastic::plane_stress].map(|of| of(1.0, 0.3, 1.0, 1.0).unwrap()).to_vec(),
        };
        let with = |elastic: &Elastic, tangent: f64, kinematic: f64| {
            let hardening = Hardening::of_tangent(1.0, tangent, kinematic).unwrap();
            VonMises::new(&elastic.with_yield_stress(0.004).unwrap().with_hardening(hardening).unwrap())
        };
        let shares = [(0.02, 0.0), (0.1, 1.0), (0.3, 0.4)];
        elastic.iter().flat_map(|law| shares.map(|(tangent, share)| with(law, tangent, share))).collect()
    }

    fn random<const D: usize>(random: &mut Random, size: f64) -> Tensor<D> {
        std::array::from_fn(|_| std::array::from_fn(|_| random.between(-size, size)))
    }

    /// f and n at a state, and σ.
    fn yields<const D: usize>(law: &VonMises, gradient: &Tensor<D>, internal: &[f64]) -> (f64, FourComponents<f64>) {
        let state = law.state::<f64, D>(gradient, internal);
        let stress = VonMises::in_space(&state.stress, state.stress_across);
        let (xi, q) = law.relative::<f64, D>(&stress, &state.plastic_strain);
        (q / law.range(state.equivalent) - 1.0, VonMises::direction::<f64, D>(&xi, q))
    }

    /// After each increment, up to some times the yield strain, the stress is in the elastic range, on its border where
    /// the point flowed, and the flow is along the normal there. 1e-12 is the width of the border; the Newton steps of
    /// plane stress leave less than 1e-11 of increments of ten yield strains.
    fn returns<const D: usize>() {
        let mut numbers = Random::new(11);
        for law in laws::<D>() {
            for size in [0.001, 0.01, 0.04] {
                let mut internal = vec![0.0; VonMises::count(D)];
                for _ in 0..200 {
                    let gradient = random::<D>(&mut numbers, size);
                    let before = internal.clone();
                    law.advance(&gradient, &mut internal);
                    let (excess, normal) = yields(&law, &gradient, &internal);
                    let (old, p) = VonMises::plastic_strain::<f64, D>(&before);
                    let (new, after) = VonMises::plastic_strain::<f64, D>(&internal);
                    assert!(excess < 1e-11 && after >= p, "{law:?}: {excess}");
                    if after > p {
                        assert!(excess > -1e-11, "{law:?}: {excess}");
                        for (flow, normal) in new.minus(&old).0.iter().zip(normal.0) {
                            assert!((flow - (after - p) * normal).abs() < 1e-11 * size, "{law:?}");
                        }
                    }
                    let again = internal.clone();
                    law.advance(&gradient, &mut internal);
                    assert_eq!(internal, again, "{law:?}: the same strain once more");
                }
            }
        }
    }

    #[test]
    fn stresses_return_to_the_elastic_range() {
        returns::<1>();
        returns::<2>();
    }

    /// The energy of a point grows by the work of its stress: the trapezoidal rule over a path of n increments is wrong
    /// by order 2 in 1/n, more or less where the path begins to flow within an increment.
    fn work<const D: usize>() {
        let mut numbers = Random::new(12);
        for law in laws::<D>() {
            let ends = [0, 1, 2].map(|_| random::<D>(&mut numbers, 0.02));
            let off = |n: usize| {
                let (mut internal, mut done, mut energy) = (vec![0.0; VonMises::count(D)], 0.0, 0.0);
                let (mut last, mut stress) = ([[0.0; D]; D], [[0.0; D]; D]);
                for k in 1..=3 * n {
                    let (leg, part) = ((k - 1) / n, ((k - 1) % n + 1) as f64 / n as f64);
                    let from = if leg == 0 { [[0.0; D]; D] } else { ends[leg - 1] };
                    let now: Tensor<D> = std::array::from_fn(|a| {
                        std::array::from_fn(|b| from[a][b] + part * (ends[leg][a][b] - from[a][b]))
                    });
                    let (next, total) = law.respond(&now, &mut internal);
                    for a in 0..D {
                        for b in 0..D {
                            done += 0.5 * (stress[a][b] + next[a][b]) * (now[a][b] - last[a][b]);
                        }
                    }
                    (last, stress, energy) = (now, next, total);
                }
                (energy - done) / energy
            };
            let (coarse, fine) = (off(400), off(3200));
            assert!(coarse.abs() < 1e-4 && fine.abs() < 1e-6, "{law:?}: {coarse} {fine}");
        }
    }

    #[test]
    fn energies_are_the_work() {
        work::<1>();
        work::<2>();
    }

    /// A tensile test beyond yield: the stress grows with the tangent, in a bar and in a sheet that is free across.
    #[test]
    fn a_bar_follows_its_curve() {
        let elastic = Elastic::bar(200e9, 1.0, 1.0).unwrap().with_yield_stress(400e6).unwrap();
        for share in [0.0, 0.5, 1.0] {
            let law = elastic.with_hardening(Hardening::of_tangent(200e9, 10e9, share).unwrap()).unwrap();
            let mut internal = [0.0; 2];
            let stress = |strain: f64, internal: &mut [f64]| VonMises::new(&law).respond(&[[strain]], internal).0[0][0];
            // 400 MPa at 0.2 %, then 10 GPa; back by twice the yield stress, by kinematic hardening, or by twice the
            // highest stress, by isotropic hardening, it is elastic.
            assert!((stress(0.012, &mut internal) / 500e6 - 1.0).abs() < 1e-12);
            let back = (1.0 - share) * 1000e6 + share * 800e6;
            let strain = 0.012 - 0.999 * back / 200e9;
            assert!((stress(strain, &mut internal) - (500e6 - 0.999 * back)).abs() < 1e-3);
            assert!(internal[1] == internal[0] && (internal[0] / 0.0095 - 1.0).abs() < 1e-12, "{internal:?}");
            stress(0.012 - 1.001 * back / 200e9, &mut internal);
            assert!(internal[1] > internal[0]);
        }
    }
}
