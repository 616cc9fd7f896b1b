//! η of one element (§4.2), exact in space, at one level or at some levels side by side.

mod admissible_stress;
mod balanced;
mod block_fields;
mod element_error;
mod equilibrium;

use crate::components::subtract;
use crate::concentrated::HatStress;
use crate::deformation::Deformation;
use crate::element::Element;
use crate::inertia::{Inertia, arms, mass_product};
use crate::kinematic::ElementMotion;
use crate::options::Acceleration;
use crate::plastic::PlasticPart;
use crate::stress::{FluctuationForm, LOADS, Loading, StressMap, face_node};
use crate::time_level::{Side, Velocities};
use crate::traction::{EquilibratedLevel, Equilibration};
pub(crate) use admissible_stress::AdmissibleStress;
use balanced::NodalForce;
pub(crate) use balanced::{Balanced, NodalBalance, outward};
pub(crate) use block_fields::{BalanceFields, BalanceNode, at_places};
pub(crate) use element_error::ElementError;
use percute_core::cell::cell;
use percute_core::ids::ElementId;
use percute_core::material::{Elastic, Law, LinearLaw, PointLaw};
use percute_core::problem::Problem;
use percute_core::simd::lanes::Value;

/// Elastic energy (J per unit of section or thickness) of the stress of hats beside that of the stress that balances a
/// loading. Young's inequality bounds the products of several nodes.
pub(crate) fn hat_energy<const D: usize, const N: usize>(loading: &Loading<D, N>, hats: &[HatStress<'_>]) -> f64 {
    hats.iter().map(|hat| work(loading, &hat.products()) + hats.len() as f64 * hat.energy()).sum()
}

/// ∫σ:K⁻¹τ of the stress σ that balances a loading, from that of each unit load.
pub(crate) fn work<const D: usize, const N: usize>(loading: &Loading<D, N>, products: &[f64; LOADS]) -> f64 {
    let loads = loading.traction.iter().flatten().flatten().chain(loading.volume.iter().flatten());
    products.iter().zip(loads).map(|(c, d)| c * d).sum()
}

/// The maps of one element, constant in time.
#[derive(Clone, Debug)]
pub(crate) struct ElementMeasure<'a, const D: usize, const N: usize> {
    problem: &'a Problem<D>,
    element: &'a Element<D, N>,
    id: ElementId,
    law: &'a Elastic,
    /// Places of the nodes from the centroid (m).
    arms: [[f64; D]; N],
    /// 1 over the largest of them (1/m).
    inverse_reach: f64,
    inertia: Inertia<D, N>,
    start: [[f64; D]; N],
}

impl<'a, const D: usize, const N: usize> ElementMeasure<'a, D, N> {
    pub(crate) fn new(
        problem: &'a Problem<D>,
        element: &'a Element<D, N>,
        id: ElementId,
        choice: Acceleration,
    ) -> Self {
        let start = element.gather(problem.initial_velocity());
        Self::with((problem, element, id), choice, &problem.mesh().corners::<D, N>(id), start)
    }

    /// The maps of an element whose nodes are at hand.
    #[inline(always)]
    pub(crate) fn of_nodes(
        of: (&'a Problem<D>, &'a Element<D, N>, ElementId),
        choice: Acceleration,
        nodes: &[&BalanceNode<D>; N],
    ) -> Self {
        let mut start = [[0.0; D]; N];
        for i in 0..N {
            start[i] = nodes[i].start;
        }
        Self::with(of, choice, &BalanceNode::points(nodes), start)
    }

    /// From the places of the nodes (m) and their initial velocities (m/s).
    #[inline(always)]
    fn with(
        (problem, element, id): (&'a Problem<D>, &'a Element<D, N>, ElementId),
        choice: Acceleration,
        points: &[[f64; D]; N],
        start: [[f64; D]; N],
    ) -> Self {
        let (arms, law) = (arms(points), problem.material(id));
        let mut reach: f64 = 0.0;
        for arm in arms.as_flattened() {
            reach = Value::max(reach, arm.abs());
        }
        Self {
            problem,
            element,
            id,
            law,
            arms,
            inverse_reach: 1.0 / reach,
            inertia: if law.is_finite() { Inertia::new(choice, &arms).turning() } else { Inertia::new(choice, &arms) },
            start,
        }
    }

    /// The stress that balances a loading.
    fn stress_map(&self) -> StressMap {
        StressMap::new(cell(), &self.problem.mesh().corners::<D, N>(self.id), self.law)
    }

    /// The fields of one level that tractions and Γ_DA are made of. `contact` gives the contact node at each local
    /// node.
    pub(crate) fn nodal_balance(
        &self,
        equilibration: &Equilibration<'_, D, N>,
        level: &EquilibratedLevel<'_, D>,
        contact: &[Option<usize>; N],
        side: Side,
    ) -> NodalBalance<D, N> {
        let forces = level.forces();
        let around = |i: usize| equilibration.moments_around(level, self.element, i, contact[i], side);
        NodalBalance {
            moments: outward(&self.element.links, around),
            acceleration: self.acceleration(level, contact, side),
            skew: forces.level.skew().map(|field| self.element.gather(field)),
            body_force: forces.level.body_force.get(self.id.index()).copied().unwrap_or([0.0; D]),
            displacement: self.law.is_finite().then(|| self.element.gather(&forces.level.displacement)),
        }
    }

    /// ã at the nodes at a level (m/s²); `contact` gives the contact node at each local node.
    pub(crate) fn acceleration(
        &self,
        level: &EquilibratedLevel<'_, D>,
        contact: &[Option<usize>; N],
        side: Side,
    ) -> [[f64; D]; N] {
        let forces = level.forces();
        let mut acceleration = self.element.gather(&forces.acceleration);
        for i in 0..N {
            if let (Some(at), Side::Before, Some(before)) = (contact[i], side, &forces.before) {
                acceleration[i] = before.acceleration[at];
            }
        }
        acceleration
    }

    /// Tractions and Γ_DA − f_d.
    #[inline(always)]
    pub(crate) fn balanced<T: Value>(&self, fields: &NodalBalance<D, N, T>) -> Balanced<D, N, T> {
        let NodalBalance { moments, acceleration, skew, body_force, displacement } = fields;
        let density = self.law.density();
        let mut terms = acceleration[0][0].zero();
        for a in acceleration.as_flattened() {
            terms = terms.max(a.abs() * density);
        }
        for f in body_force {
            terms = terms.max(f.abs());
        }
        let mut volume = self.inertia.apply(acceleration, skew.as_ref());
        for value in &mut volume {
            for c in 0..D {
                value[c] = value[c] * density - body_force[c];
            }
        }
        let mut loading = Loading { traction: self.tractions(moments), volume };
        if let Some(displacement) = displacement {
            let deformation = Deformation::new(&self.element.gradient(displacement));
            loading.traction.iter_mut().flatten().for_each(|vector| deformation.pull_back(vector));
            loading.volume.iter_mut().for_each(|vector| deformation.pull_back(vector));
        }
        Balanced { forces: self.nodal_forces(&loading), terms, loading }
    }

    /// ∫Γ_DA/ρ dt at the nodes (m/s) \[13\], at one level.
    #[inline]
    pub(crate) fn increment(&self, velocities: &Velocities<D>) -> [[f64; D]; N] {
        let nodes = &self.element.nodes;
        let skew = velocities.skew_increment.as_ref().map(|increment| increment.gather(nodes));
        self.increment_of(&velocities.increment.gather(nodes), skew.as_ref())
    }

    /// The same from ∫ã dt, or those of a_c and o₂, at the nodes.
    #[inline(always)]
    pub(crate) fn increment_of<T: Value>(
        &self,
        increment: &[[T; D]; N],
        skew_increment: Option<&[[T; D]; N]>,
    ) -> [[T; D]; N] {
        self.inertia.apply(increment, skew_increment)
    }

    /// σ_DA. Its mean is that of the tractions and of Γ_DA − f_d as forces on the nodes.
    #[inline(always)]
    pub(crate) fn stress<T: Value>(
        &self,
        form: &impl FluctuationForm,
        balanced: &Balanced<D, N, T>,
    ) -> AdmissibleStress<D, N, T> {
        let mut mean = [[balanced.terms.zero(); D]; D];
        let factor = 0.5 * self.law.extent() / self.element.volume;
        for (force, arm) in balanced.forces.iter().zip(&self.arms) {
            for a in 0..D {
                let force = force.outer[a] - force.inner[a];
                for b in 0..D {
                    mean[a][b] += force * (factor * arm[b]);
                }
            }
        }
        for a in 0..D {
            for b in 0..=a {
                let both = mean[a][b] + mean[b][a];
                (mean[a][b], mean[b][a]) = (both, both);
            }
        }
        AdmissibleStress { mean, fluctuation: form.fluctuation(&balanced.loading) }
    }

    /// The error at one sample, with ∫Γ_DA/ρ dt there and the plastic part of a material that yields.
    #[inline(always)]
    pub(crate) fn error<T: Value>(
        &self,
        stress: &AdmissibleStress<D, N, T>,
        increment: &[[T; D]; N],
        motion: &ElementMotion<D, N, T>,
        plastic: Option<&PlasticPart<D, T>>,
    ) -> ElementError<T> {
        let beside = increment[0][0].zero();
        self.error_of((&stress.mean, stress.fluctuation.energy()), increment, motion, (beside, plastic))
    }

    /// The same, from the mean of σ_DA and the energies of its fluctuation and of other stresses `beside` it (J per
    /// unit of section or thickness).
    #[inline(always)]
    pub(crate) fn error_of<T: Value>(
        &self,
        (admissible, fluctuation): (&[[T; D]; D], T),
        increment: &[[T; D]; N],
        motion: &ElementMotion<D, N, T>,
        (beside, plastic): (T, Option<&PlasticPart<D, T>>),
    ) -> ElementError<T> {
        let mass = N as f64 * self.element.nodal_mass;
        let (mut dynamic, mut misfit) = (*increment, *increment);
        for i in 0..N {
            for c in 0..D {
                dynamic[i][c] += beside.fill(self.start[i][c]);
                misfit[i][c] = dynamic[i][c] - motion.velocity()[i][c];
            }
        }
        let kinetic = mass_product(mass, &misfit, &misfit) * 0.5;

        // σ_CA is constant.
        let gradient = self.elastic_gradient(motion, plastic);
        let [stress, strain] = self.stress_and_strain(&gradient);
        let (mut mean, mut work) = (stress, beside.zero());
        for a in 0..D {
            for b in 0..D {
                work += admissible[a][b] * strain[a][b];
                mean[a][b] = admissible[a][b] - stress[a][b];
            }
        }
        let (mut misfit, mut rest) = (self.strain(&mean), fluctuation + beside);
        if self.law.is_finite() {
            let metric = self.law.stress_metric(&gradient);
            misfit = metric.strain(&mean);
            rest = rest * metric.mean();
            work = product(admissible, &metric.strain(&stress));
        }
        let elastic = product(&mean, &misfit) * (0.5 * self.element.volume) + rest * self.law.extent();
        // |a + b|² = |a − b|² + 4 a·b.
        let products = mass_product(mass, &dynamic, motion.velocity()) + work * self.element.volume;
        let plastic = plastic.map_or(beside.zero(), |part| part.energy);
        ElementError { kinetic, elastic, plastic, reference: (kinetic + elastic + plastic) * 2.0 + products * 4.0 }
    }

    /// ∂u_CA/∂x less ε* of a material that yields.
    #[inline(always)]
    pub(crate) fn elastic_gradient<T: Value>(
        &self,
        motion: &ElementMotion<D, N, T>,
        plastic: Option<&PlasticPart<D, T>>,
    ) -> [[T; D]; D] {
        let mut gradient = self.element.gradient(motion.displacement());
        if let Some(part) = plastic {
            subtract(&mut gradient, &part.eigenstrain);
        }
        gradient
    }

    /// The law and the volume (m³), where the material yields.
    pub(crate) fn yielding(&self) -> Option<(&'a Elastic, f64)> {
        self.law.hardening().map(|_| (self.law, self.element.volume))
    }

    /// The stress at a displacement gradient that an admissible one is compared with, σ or S, and K⁻¹ of it with small
    /// kinematics, for which ∂u/∂x does as well.
    #[inline(always)]
    pub(crate) fn stress_and_strain<T: Value>(&self, gradient: &[[T; D]; D]) -> [[[T; D]; D]; 2] {
        let (stress, _) = self.law.respond(gradient, &mut []);
        if !self.law.is_finite() {
            return [stress, *gradient];
        }
        [Deformation::new(gradient).second_stress(&stress), *gradient]
    }

    /// K⁻¹ of a symmetric stress.
    #[inline(always)]
    pub(crate) fn strain<T: Value>(&self, stress: &[[T; D]; D]) -> [[T; D]; D] {
        let (alpha, beta) = self.law.compliance::<D>();
        let (mut strain, mut trace) = (*stress, stress[0][0].zero());
        for a in 0..D {
            trace += stress[a][a];
            for b in 0..D {
                strain[a][b] = stress[a][b] * alpha;
            }
        }
        for a in 0..D {
            strain[a][a] -= trace * beta;
        }
        strain
    }

    /// Places of the nodes from the centroid (m).
    #[inline(always)]
    pub(crate) fn arms(&self) -> &[[f64; D]; N] {
        &self.arms
    }

    /// The loading of the stress beside which other stresses stand: that of σ_DA less the tractions of the constant
    /// σ_CA.
    pub(crate) fn difference(
        &self,
        loading: &Loading<D, N>,
        motion: &ElementMotion<D, N>,
        plastic: Option<&PlasticPart<D>>,
    ) -> Loading<D, N> {
        let [stress, _] = self.stress_and_strain(&self.elastic_gradient(motion, plastic));
        let mut difference = *loading;
        self.subtract_tractions(&stress, &mut difference);
        difference
    }

    /// Mean over the element of the stress of hats (Pa).
    pub(crate) fn mean_of_hats(&self, hats: &HatStress<'_>) -> [[f64; D]; D] {
        // The products with constant stresses: the mean strain, because this map is symmetric.
        let mut strain = [[0.0; D]; D];
        for a in 0..D {
            for b in 0..D {
                let mut unit = [[0.0; D]; D];
                unit[a][b] += 0.5;
                unit[b][a] += 0.5;
                let mut loading = Loading { traction: [[[0.0; D]; D]; N], volume: [[0.0; D]; N] };
                self.subtract_tractions(&unit, &mut loading);
                strain[a][b] = -work(&loading, &hats.products()) * self.law.extent() / self.element.volume;
            }
        }
        let ((lambda, shear), mut stress) = (self.law.moduli(), strain);
        let trace = (0..D).map(|a| strain[a][a]).sum::<f64>();
        for a in 0..D {
            (0..D).for_each(|b| stress[a][b] = shear * (strain[a][b] + strain[b][a]));
            stress[a][a] += lambda * trace;
        }
        stress
    }

    /// |e|F̂ at the nodes of each face, from its outward moments there.
    #[inline(always)]
    pub(crate) fn tractions<T: Value>(&self, moments: &[[[T; D]; D]; N]) -> [[[T; D]; D]; N] {
        let mut traction = *moments;
        for k in 0..N {
            for c in 0..D {
                let mut sum = moments[0][0][0].zero();
                for b in &moments[k] {
                    sum += b[c];
                }
                for p in 0..D {
                    traction[k][p][c] = (moments[k][p][c] * (D + 1) as f64 - sum) * (D as f64 / self.law.extent());
                }
            }
        }
        traction
    }

    /// Takes the tractions of a constant stress off a loading.
    #[inline(always)]
    pub(crate) fn subtract_tractions<T: Value>(&self, stress: &[[T; D]; D], loading: &mut Loading<D, N, T>) {
        for k in 0..N {
            let pull = self.element.internal_force(k, stress);
            for c in 0..D {
                // Outward tractions are −D times it.
                let traction = pull[c] * (D as f64 / self.law.extent());
                for p in 0..D {
                    loading.traction[k][p][c] += traction;
                }
            }
        }
    }

    /// The gradient of a nodal field.
    pub(crate) fn gradient(&self, field: &[[f64; D]]) -> [[f64; D]; D] {
        self.element.gradient(&self.element.gather(field))
    }

    /// Means of σ_DA and of Γ_DA/ρ over the element, on the side `After`.
    pub(crate) fn means(
        &self,
        equilibration: &Equilibration<'_, D, N>,
        level: &EquilibratedLevel<'_, D>,
    ) -> ([[f64; D]; D], [f64; D]) {
        let fields = self.nodal_balance(equilibration, level, &[None; N], Side::After);
        let inertia = self.inertia.apply(&fields.acceleration, fields.skew.as_ref());
        let acceleration = std::array::from_fn(|c| inertia.iter().map(|a| a[c]).sum::<f64>() / N as f64);
        let stress = self.stress_map().mean(&self.balanced(&fields).loading);
        let gradient = self.gradient(&level.forces().level.displacement);
        (self.law.per_present_area(&stress, &gradient), acceleration)
    }

    /// Work of the tractions, and of Γ_DA − f_d, on the shape function of each node.
    #[inline(always)]
    fn nodal_forces<T: Value>(&self, loading: &Loading<D, N, T>) -> [NodalForce<D, T>; N] {
        let volume = self.element.volume / self.law.extent() / ((D + 1) * (D + 2)) as f64;
        let Loading { traction, volume: load } = loading;
        let zero = load[0][0].zero();
        let mut forces = [NodalForce { outer: [zero; D], inner: [zero; D] }; N];
        for c in 0..D {
            let mut total = zero;
            for g in load {
                total += g[c];
            }
            for k in 0..N {
                forces[k].inner[c] = (load[k][c] + total) * volume;
                let mut sum = zero;
                for t in &traction[k] {
                    sum += t[c];
                }
                for p in 0..D {
                    forces[face_node::<N>(k, p)].outer[c] += (traction[k][p][c] + sum) * (1.0 / (D * (D + 1)) as f64);
                }
            }
        }
        forces
    }
}

/// The sum of products of entries.
#[inline(always)]
fn product<T: Value, const D: usize>(a: &[[T; D]; D], b: &[[T; D]; D]) -> T {
    let mut sum = a[0][0].zero();
    for i in 0..D {
        for j in 0..D {
            sum += a[i][j] * b[i][j];
        }
    }
    sum
}

#[cfg(test)]
mod tests;
