//! η of one element (§4.2), exact in space, at one level or at some levels side by side.

use crate::concentrated::HatStress;
use crate::element::Element;
use crate::inertia::{Inertia, arms, mass_product};
use crate::kinematic::ElementMotion;
use crate::lanes::{FieldLanes, LANES, Lanes, Value};
use crate::options::Acceleration;
use crate::residual::{Residuals, worse};
use crate::stress::{EnergyForm, Loading, StressMap, facet_node, hooke};
use crate::time_level::{Side, Velocities};
use crate::traction::{EquilibratedLevel, EquilibratedLevels, Equilibration};
use percute_core::ids::ElementId;
use percute_core::material::{Elastic, Law};
use percute_core::problem::Problem;

/// The part of one element in η and d at one sample (J), contact apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ElementError<T = f64> {
    pub(crate) kinetic: T,
    pub(crate) elastic: T,
    pub(crate) reference: T,
}

impl<T: Value> ElementError<T> {
    #[inline(always)]
    pub(crate) fn total(&self) -> T {
        self.kinetic + self.elastic
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, other: &Self) {
        self.kinetic += other.kinetic;
        self.elastic += other.elastic;
        self.reference += other.reference;
    }
}

impl ElementError<Lanes> {
    /// No error.
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self { kinetic: Lanes::ZERO, elastic: Lanes::ZERO, reference: Lanes::ZERO }
    }

    /// At one level.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> ElementError {
        let Self { kinetic, elastic, reference } = self;
        ElementError { kinetic: kinetic.0[lane], elastic: elastic.0[lane], reference: reference.0[lane] }
    }

    /// At these levels, 0 at the others.
    #[inline(always)]
    pub(crate) fn only(&self, wanted: &[bool; LANES]) -> Self {
        let Self { kinetic, elastic, reference } = self;
        let [kinetic, elastic, reference] = [kinetic, elastic, reference].map(|number| number.only(wanted));
        Self { kinetic, elastic, reference }
    }
}

/// The fields of an element that tractions and Γ_DA are made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodalBalance<const D: usize, const N: usize, T = f64> {
    /// Outward moments of each facet at its nodes (N).
    pub(crate) moments: [[[T; D]; D]; N],
    /// ã at the nodes (m/s²).
    pub(crate) acceleration: [[T; D]; N],
    /// The lumping difference at the nodes, which `mixed` has (m/s²).
    pub(crate) lumping_difference: Option<[[T; D]; N]>,
    /// f_d (N/m³).
    pub(crate) body_force: [T; D],
}

/// The fields of the nodes of a block of elements at some levels, of which tractions and Γ_DA are made.
#[derive(Clone, Debug, Default)]
pub(crate) struct BalanceFields<const D: usize> {
    displacement: FieldLanes<D>,
    acceleration: FieldLanes<D>,
    lumping_difference: FieldLanes<D>,
    mixed: bool,
    has_body_force: bool,
}

impl<const D: usize> BalanceFields<D> {
    /// Takes the fields of these nodes.
    #[inline(always)]
    pub(crate) fn gather(&mut self, nodes: &[u32], levels: &EquilibratedLevels<D>) {
        let forces = levels.forces();
        self.mixed = forces.iter().any(|f| f.level.lumping_difference.is_some());
        self.has_body_force = forces.iter().any(|f| !f.level.body_force.is_empty());
        self.acceleration.gather(nodes, forces.iter().map(|f| Some(&f.acceleration[..])));
        if self.mixed {
            self.lumping_difference.gather(nodes, forces.iter().map(|f| f.level.lumping_difference.as_deref()));
        }
    }

    /// Takes the displacements that are equilibrated too.
    #[inline(always)]
    pub(crate) fn gather_displacement(&mut self, nodes: &[u32], levels: &EquilibratedLevels<D>) {
        self.displacement.gather(nodes, levels.forces().iter().map(|f| Some(&f.level.displacement[..])));
    }

    /// The displacement that is equilibrated (m), at the nodes with these places.
    #[inline(always)]
    pub(crate) fn displacement<const N: usize>(&self, local: &[u32; N]) -> [[Lanes; D]; N] {
        self.displacement.of(local)
    }

    /// Whether there is a lumping difference.
    #[inline(always)]
    pub(crate) fn is_mixed(&self) -> bool {
        self.mixed
    }

    /// The fields of an element without contact node, whose nodes have these places.
    #[inline(always)]
    pub(crate) fn nodal_balance<const N: usize>(
        &self,
        equilibration: &Equilibration<'_, D, N>,
        levels: &EquilibratedLevels<D>,
        id: ElementId,
        local: &[u32; N],
    ) -> NodalBalance<D, N, Lanes> {
        let (moments, links) = (levels.moments(), &equilibration.elements[id.index()].links);
        let around = |i: usize| [moments[links[i] as usize], moments[links[i] as usize + 1]];
        NodalBalance {
            moments: outward(around),
            acceleration: self.acceleration.of(local),
            lumping_difference: self.mixed.then(|| self.lumping_difference.of(local)),
            body_force: if self.has_body_force { levels.body_force(id) } else { [Lanes::ZERO; D] },
        }
    }
}

/// The dynamically admissible fields of an element at one sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Balanced<const D: usize, const N: usize, T = f64> {
    /// Tractions and Γ_DA − f_d.
    pub(crate) loading: Loading<D, N, T>,
    /// Largest component of f_d and of ρã at the nodes (N/m³). Γ_DA − f_d is made of them, and where
    /// they cancel, as in a fall, it does not show how large the terms of the balance are.
    terms: T,
    /// Their work on the shape function of each node.
    forces: [NodalForce<D, T>; N],
}

/// The forces on one node of an element (N per unit of section or thickness).
#[derive(Clone, Copy, Debug)]
struct NodalForce<const D: usize, T> {
    /// Tractions.
    outer: [T; D],
    /// Γ_DA − f_d.
    inner: [T; D],
}

impl<const D: usize, const N: usize, T: Value> Balanced<D, N, T> {
    /// Half way between two instants, \[57\]–\[58\].
    #[inline(always)]
    pub(crate) fn middle(a: &Self, b: &Self) -> Self {
        Self::combine(a, b, |x, y| (x + y) * 0.5)
    }

    /// The fields that `number` makes of those of two.
    #[inline(always)]
    pub(crate) fn combine<A: Value, B: Value>(
        a: &Balanced<D, N, A>,
        b: &Balanced<D, N, B>,
        number: impl Fn(A, B) -> T,
    ) -> Self {
        let zero = NodalForce { outer: [T::ZERO; D], inner: [T::ZERO; D] };
        let mut forces = [zero; N];
        let mut loading = Loading { traction: [[[T::ZERO; D]; D]; N], volume: [[T::ZERO; D]; N] };
        for k in 0..N {
            for c in 0..D {
                for p in 0..D {
                    loading.traction[k][p][c] = number(a.loading.traction[k][p][c], b.loading.traction[k][p][c]);
                }
                loading.volume[k][c] = number(a.loading.volume[k][c], b.loading.volume[k][c]);
                forces[k].outer[c] = number(a.forces[k].outer[c], b.forces[k].outer[c]);
                forces[k].inner[c] = number(a.forces[k].inner[c], b.forces[k].inner[c]);
            }
        }
        Self { loading, terms: number(a.terms, b.terms), forces }
    }
}

/// Elastic energy (J per unit of section or thickness) of the stress of hats beside that of the stress that balances a
/// loading. Young's inequality bounds the products of several nodes.
pub(crate) fn hat_energy<const D: usize, const N: usize>(loading: &Loading<D, N>, hats: &[HatStress<'_>]) -> f64 {
    hats.iter().map(|hat| hat_product(loading, hat) + hats.len() as f64 * hat.energy()).sum()
}

/// ∫σ:K⁻¹τ (J per unit of section or thickness) of the stress σ that balances a loading and the stress τ of hats.
fn hat_product<const D: usize, const N: usize>(loading: &Loading<D, N>, hat: &HatStress<'_>) -> f64 {
    let loads = loading.traction.iter().flatten().flatten().chain(loading.volume.iter().flatten());
    hat.products().iter().zip(loads).map(|(c, d)| c * d).sum()
}

/// The maps of one element, constant in time.
#[derive(Clone, Debug)]
pub(crate) struct ElementMeasure<'a, const D: usize, const N: usize> {
    problem: &'a Problem<D, N>,
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
    #[inline(always)]
    pub(crate) fn new(
        problem: &'a Problem<D, N>,
        element: &'a Element<D, N>,
        id: ElementId,
        choice: Acceleration,
    ) -> Self {
        let arms = arms(&problem.mesh().cell_points(id));
        let reach = arms.iter().flatten().fold(0.0_f64, |m, a| m.max(a.abs()));
        Self {
            problem,
            element,
            id,
            law: problem.material(id),
            arms,
            inverse_reach: 1.0 / reach,
            inertia: Inertia::new(choice, &arms),
            start: element.gather(problem.initial_velocity()),
        }
    }

    /// The stress that balances a loading.
    fn stress_map(&self) -> StressMap {
        StressMap::new(self.problem.mesh().simplex(), &self.problem.mesh().cell_points(self.id), self.law)
    }

    /// The fields of one level that tractions and Γ_DA are made of. `contact` gives the contact node at each local node.
    pub(crate) fn nodal_balance(
        &self,
        equilibration: &Equilibration<'_, D, N>,
        level: &EquilibratedLevel<'_, D>,
        contact: &[Option<usize>; N],
        side: Side,
    ) -> NodalBalance<D, N> {
        let forces = level.forces();
        let mut acceleration = self.element.gather(&forces.acceleration);
        for i in 0..N {
            if let (Some(at), Side::Before, Some(before)) = (contact[i], side, &forces.before) {
                acceleration[i] = before.acceleration[at];
            }
        }
        let around = |i: usize| equilibration.moments_around(level, self.element, i, contact[i], side);
        NodalBalance {
            moments: outward(around),
            acceleration,
            lumping_difference: forces.level.lumping_difference.as_ref().map(|field| self.element.gather(field)),
            body_force: forces.level.body_force.get(self.id.index()).copied().unwrap_or([0.0; D]),
        }
    }

    /// Tractions and Γ_DA − f_d.
    #[inline(always)]
    pub(crate) fn balanced<T: Value>(&self, fields: &NodalBalance<D, N, T>) -> Balanced<D, N, T> {
        let NodalBalance { moments, acceleration, lumping_difference, body_force } = fields;
        let density = self.law.density();
        let mut terms = T::ZERO;
        for a in acceleration.as_flattened() {
            terms = terms.max(a.abs() * density);
        }
        for f in body_force {
            terms = terms.max(f.abs());
        }
        let mut volume = self.inertia.apply(acceleration, lumping_difference.as_ref());
        for value in &mut volume {
            for c in 0..D {
                value[c] = value[c] * density - body_force[c];
            }
        }
        let loading = Loading { traction: self.tractions(moments), volume };
        Balanced { forces: self.nodal_forces(&loading), terms, loading }
    }

    /// ∫Γ_DA/ρ dt at the nodes (m/s) \[13\], at one level.
    #[inline]
    pub(crate) fn increment(&self, velocities: &Velocities<D>) -> [[f64; D]; N] {
        let nodes = &self.element.nodes;
        let lumping = velocities.lumping_increment.as_ref().map(|increment| increment.gather(nodes));
        self.increment_of(&velocities.increment.gather(nodes), lumping.as_ref())
    }

    /// The same from ∫ã dt and that of the lumping difference at the nodes.
    #[inline(always)]
    pub(crate) fn increment_of<T: Value>(
        &self,
        increment: &[[T; D]; N],
        lumping_increment: Option<&[[T; D]; N]>,
    ) -> [[T; D]; N] {
        self.inertia.apply(increment, lumping_increment)
    }

    /// The error at one sample, with ∫Γ_DA/ρ dt there; `beside` gives the energy of other stresses beside that which
    /// balances a loading.
    #[inline(always)]
    pub(crate) fn error<T: Value>(
        &self,
        form: &EnergyForm<'_>,
        balanced: &Balanced<D, N, T>,
        increment: &[[T; D]; N],
        motion: &ElementMotion<D, N, T>,
        beside: impl FnOnce(&Loading<D, N, T>) -> T,
    ) -> ElementError<T> {
        let mass = N as f64 * self.element.nodal_mass;
        let (mut dynamic, mut misfit) = (*increment, [[T::ZERO; D]; N]);
        for i in 0..N {
            for c in 0..D {
                dynamic[i][c] += T::constant(self.start[i][c]);
                misfit[i][c] = dynamic[i][c] - motion.velocity()[i][c];
            }
        }
        let kinetic = mass_product(mass, &misfit, &misfit) * 0.5;

        // σ_DA − σ_CA balances the loading less the tractions of the constant σ_CA.
        let stress = hooke(self.law, &self.element.gradient(motion.displacement()));
        let mut difference = balanced.loading;
        self.subtract_tractions(&stress, &mut difference);
        let elastic = (form.energy(&difference) + beside(&difference)) * self.law.extent();
        // |a + b|² = |a − b|² + 4 a·b.
        let products = mass_product(mass, &dynamic, motion.velocity()) + self.work(balanced, motion.displacement());
        ElementError { kinetic, elastic, reference: (kinetic + elastic) * 2.0 + products * 4.0 }
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
                strain[a][b] = -hat_product(&loading, hats) * self.law.extent() / self.element.volume;
            }
        }
        self.law.stress(&strain)
    }

    /// |e|F̂ at the nodes of each facet, from its outward moments there.
    #[inline(always)]
    pub(crate) fn tractions<T: Value>(&self, moments: &[[[T; D]; D]; N]) -> [[[T; D]; D]; N] {
        let mut traction = [[[T::ZERO; D]; D]; N];
        for k in 0..N {
            for c in 0..D {
                let mut sum = T::ZERO;
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

    /// Means of σ_DA and of Γ_DA/ρ over the element, on the side `After`.
    pub(crate) fn means(
        &self,
        equilibration: &Equilibration<'_, D, N>,
        level: &EquilibratedLevel<'_, D>,
    ) -> ([[f64; D]; D], [f64; D]) {
        let fields = self.nodal_balance(equilibration, level, &[None; N], Side::After);
        let inertia = self.inertia.apply(&fields.acceleration, fields.lumping_difference.as_ref());
        let acceleration = std::array::from_fn(|c| inertia.iter().map(|a| a[c]).sum::<f64>() / N as f64);
        (self.stress_map().mean(&self.balanced(&fields).loading), acceleration)
    }

    /// ∫σ_DA : ε(u) as the work of the loading that σ_DA balances (J).
    #[inline(always)]
    fn work<T: Value>(&self, balanced: &Balanced<D, N, T>, u: &[[T; D]; N]) -> T {
        let mut work = T::ZERO;
        // The loading balances: a translation does no work and is left out.
        for (force, u_i) in balanced.forces.iter().zip(u) {
            for c in 0..D {
                work += (force.outer[c] - force.inner[c]) * (u_i[c] - u[0][c]);
            }
        }
        work * self.law.extent()
    }

    /// Residuals of the pointwise equilibrium of σ_DA; `scale` is the largest nodal force in the
    /// mesh (N).
    pub(crate) fn check_stress(&self, balanced: &Balanced<D, N>, scale: f64, residuals: &mut Residuals) {
        let stress = self.stress_map().residuals(&balanced.loading, self.floor(balanced, scale));
        residuals.divergence = worse(residuals.divergence, stress.divergence);
        residuals.edge_tractions = worse(residuals.edge_tractions, stress.edges);
        residuals.inner_tractions = worse(residuals.inner_tractions, stress.inner);
    }

    /// The smallest force that counts, per unit of section or thickness: 1e-12 of the largest in
    /// the mesh, or the force of f_d or of the lumped inertia at a node.
    #[inline(always)]
    fn floor<T: Value>(&self, balanced: &Balanced<D, N, T>, scale: T) -> T {
        (scale * 1e-12).max(balanced.terms * (self.element.volume / N as f64)) * (1.0 / self.law.extent())
    }

    /// Residual of the balance of the element as a whole: resultant of tractions less Γ_DA − f_d, and their moments about the
    /// centroid, one in each coordinate plane.
    #[inline(always)]
    pub(crate) fn resultant_residual<T: Value>(&self, balanced: &Balanced<D, N, T>, scale: T) -> T {
        let floor = self.floor(balanced, scale);
        let (mut resultant, mut moments) = ([T::ZERO; D], [[T::ZERO; D]; D]);
        // Tractions one by one: at a node between a fixed edge and elements at rest two of them cancel.
        let mut scale = T::ZERO;
        for t in balanced.loading.traction.as_flattened().as_flattened() {
            scale = scale.max(t.abs());
        }
        scale = floor.max(scale * (1.0 / (D * (D + 1)) as f64));
        for (force, arm) in balanced.forces.iter().zip(&self.arms) {
            for c in 0..D {
                resultant[c] += force.outer[c] - force.inner[c];
                scale = scale.max(force.outer[c].abs()).max(force.inner[c].abs());
            }
            let net = |c: usize| force.outer[c] - force.inner[c];
            for b in 1..D {
                for a in 0..b {
                    moments[a][b] += net(b) * arm[a] - net(a) * arm[b];
                }
            }
        }
        let mut miss = T::ZERO;
        for moment in moments.as_flattened() {
            miss = miss.worse((*moment * self.inverse_reach).abs());
        }
        for force in &resultant {
            miss = miss.worse(force.abs());
        }
        miss / scale.max(T::constant(f64::MIN_POSITIVE))
    }

    /// Work of the tractions, and of Γ_DA − f_d, on the shape function of each node.
    #[inline(always)]
    fn nodal_forces<T: Value>(&self, loading: &Loading<D, N, T>) -> [NodalForce<D, T>; N] {
        let volume = self.element.volume / self.law.extent() / ((D + 1) * (D + 2)) as f64;
        let Loading { traction, volume: load } = loading;
        let mut forces = [NodalForce { outer: [T::ZERO; D], inner: [T::ZERO; D] }; N];
        for c in 0..D {
            let mut total = T::ZERO;
            for g in load {
                total += g[c];
            }
            for k in 0..N {
                forces[k].inner[c] = (load[k][c] + total) * volume;
                let mut sum = T::ZERO;
                for t in &traction[k] {
                    sum += t[c];
                }
                for p in 0..D {
                    forces[facet_node::<N>(k, p)].outer[c] += (traction[k][p][c] + sum) * (1.0 / (D * (D + 1)) as f64);
                }
            }
        }
        forces
    }
}

/// Outward moments of each facet at its nodes, from those by which the star of each node enters and leaves the element:
/// entering moments have the other sign.
#[inline(always)]
pub(crate) fn outward<T: Value, const D: usize, const N: usize>(
    around: impl Fn(usize) -> [[T; D]; 2],
) -> [[[T; D]; D]; N] {
    let mut moments = [[[T::ZERO; D]; D]; N];
    for k in 0..N {
        for p in 0..D {
            let [entry, exit] = around(facet_node::<N>(k, p));
            for c in 0..D {
                moments[k][p][c] = if enters::<D>(k, p) { -entry[c] } else { exit[c] };
            }
        }
    }
    moments
}

/// Whether the star of the p-th node of facet k enters the element by it.
const fn enters<const D: usize>(k: usize, p: usize) -> bool {
    if D == 1 { k == 1 } else { p == 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::{BarMesh, TriangleMesh};
    use percute_core::simplex::Simplex;

    fn check<const D: usize, const N: usize>(simplex: &dyn Simplex<D, N>) {
        for (i, facets) in simplex.facets_around().iter().enumerate() {
            for (exit, facet) in facets.iter().enumerate() {
                let Some(k) = *facet else { continue };
                let p = (0..D).find(|&p| facet_node::<N>(k, p) == i).unwrap();
                assert_eq!(enters::<D>(k, p), exit == 0, "node {i}, facet {k}");
            }
        }
    }

    #[test]
    fn stars_enter_elements_as_the_mesh_says() {
        check(BarMesh::uniform_bar(1.0, 2).unwrap().simplex());
        check(TriangleMesh::rectangle(1.0, 1.0, 1, 1).unwrap().simplex());
    }
}
