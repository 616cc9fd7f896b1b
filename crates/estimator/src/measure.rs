//! η of one element (§4.2), exact in space.

use crate::concentrated::HatStress;
use crate::element::Element;
use crate::inertia::{Inertia, arms, mass_product};
use crate::kinematic::ElementMotion;
use crate::options::Acceleration;
use crate::residual::{Residuals, worse};
use crate::stress::{Loading, StressMap, facet_node, facet_position};
use crate::time_level::{Side, Velocities};
use crate::traction::{Equilibrated, Equilibration};
use percute_core::ids::ElementId;
use percute_core::material::{Elastic, Law};
use percute_core::problem::Problem;

/// The part of one element in η and d at one sample (J), contact apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ElementError {
    pub(crate) kinetic: f64,
    pub(crate) elastic: f64,
    pub(crate) reference: f64,
}

impl ElementError {
    #[inline]
    pub(crate) fn total(&self) -> f64 {
        self.kinetic + self.elastic
    }

    #[inline]
    pub(crate) fn add(&mut self, other: &Self) {
        self.kinetic += other.kinetic;
        self.elastic += other.elastic;
        self.reference += other.reference;
    }
}

/// The dynamically admissible fields of an element at one sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Balanced<const D: usize, const N: usize> {
    /// Tractions and Γ_DA − f_d.
    pub(crate) loading: Loading<D, N>,
    /// Largest component of f_d and of ρã at the nodes (N/m³). Γ_DA − f_d is made of them, and where
    /// they cancel, as in a fall, it does not show how large the terms of the balance are.
    terms: f64,
    /// Their work on the shape function of each node.
    forces: [NodalForce<D>; N],
}

/// The forces on one node of an element (N per unit of section or thickness).
#[derive(Clone, Copy, Debug)]
struct NodalForce<const D: usize> {
    /// Tractions.
    outer: [f64; D],
    /// Γ_DA − f_d.
    inner: [f64; D],
}

impl<const D: usize, const N: usize> Balanced<D, N> {
    /// Half way between two instants, \[57\]–\[58\].
    pub(crate) fn middle(a: &Self, b: &Self) -> Self {
        let mut middle = *a;
        for k in 0..N {
            for c in 0..D {
                for p in 0..D {
                    let (x, y) = (a.loading.traction[k][p][c], b.loading.traction[k][p][c]);
                    middle.loading.traction[k][p][c] = 0.5 * (x + y);
                }
                let mean = |x: f64, y: f64| 0.5 * (x + y);
                middle.loading.volume[k][c] = mean(a.loading.volume[k][c], b.loading.volume[k][c]);
                middle.forces[k].outer[c] = mean(a.forces[k].outer[c], b.forces[k].outer[c]);
                middle.forces[k].inner[c] = mean(a.forces[k].inner[c], b.forces[k].inner[c]);
            }
        }
        middle
    }
}

/// Elastic energy (J per unit of section or thickness) of the stress of hats beside that of the stress that balances a
/// loading. Young's inequality bounds the products of several nodes.
fn hat_energy<const D: usize, const N: usize>(loading: &Loading<D, N>, hats: &[HatStress<'_>]) -> f64 {
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
    element: &'a Element<D, N>,
    id: ElementId,
    law: &'a Elastic,
    /// Places of the nodes from the centroid (m).
    arms: [[f64; D]; N],
    /// 1 over the largest of them (1/m).
    inverse_reach: f64,
    inertia: Inertia<D, N>,
    stress: StressMap,
    start: [[f64; D]; N],
}

impl<'a, const D: usize, const N: usize> ElementMeasure<'a, D, N> {
    pub(crate) fn new(
        problem: &'a Problem<D, N>,
        element: &'a Element<D, N>,
        id: ElementId,
        choice: Acceleration,
    ) -> Self {
        let points = problem.mesh().cell_points(id);
        let law = problem.material(id);
        let arms = arms(&points);
        let reach = arms.iter().flatten().fold(0.0_f64, |m, a| m.max(a.abs()));
        Self {
            element,
            id,
            law,
            arms,
            inverse_reach: 1.0 / reach,
            inertia: Inertia::new(choice, &arms),
            stress: StressMap::new(problem.mesh().simplex(), &points, law),
            start: element.gather(problem.initial_velocity()),
        }
    }

    /// Tractions and Γ_DA − f_d at t_n. `contact` gives the contact node at each local node.
    #[inline(always)]
    pub(crate) fn balanced(
        &self,
        equilibration: &Equilibration<'_, D, N>,
        level: &Equilibrated<D>,
        contact: &[Option<usize>; N],
        side: Side,
    ) -> Balanced<D, N> {
        // Outward moments of each facet at its nodes: entering moments with the other sign.
        let mut moments = [[[0.0; D]; D]; N];
        let mut acceleration = self.element.gather(&level.forces().acceleration);
        for i in 0..N {
            let (entry, exit) = equilibration.moments_around(level, self.element, i, contact[i], side);
            for (facet, moment) in equilibration.crossing[i].into_iter().zip([entry.map(|f| -f), *exit]) {
                if let Some(k) = facet {
                    moments[k][facet_position::<N>(k, i)] = moment;
                }
            }
            if let (Some(at), Side::Before, Some(before)) = (contact[i], side, &level.forces().before) {
                acceleration[i] = before.acceleration[at];
            }
        }
        let body = level.forces().level.body_force.get(self.id.index()).copied().unwrap_or([0.0; D]);
        let terms = acceleration.iter().flatten().fold(0.0_f64, |m, a| m.max(self.law.density() * a.abs()));
        let terms = body.iter().fold(terms, |m, f| m.max(f.abs()));
        let lumping = level.forces().level.lumping_difference.as_ref().map(|field| self.element.gather(field));
        let mut volume = self.inertia.apply(&acceleration, lumping.as_ref());
        for value in &mut volume {
            (0..D).for_each(|c| value[c] = self.law.density() * value[c] - body[c]);
        }
        let loading = Loading { traction: self.tractions(&moments), volume };
        Balanced { forces: self.nodal_forces(&loading), terms, loading }
    }

    /// ∫Γ_DA/ρ dt at the nodes (m/s) \[13\].
    #[inline]
    pub(crate) fn increment(&self, velocities: &Velocities<D>) -> [[f64; D]; N] {
        let nodes = &self.element.nodes;
        let lumping = velocities.lumping_increment.as_ref().map(|increment| increment.gather(nodes));
        self.inertia.apply(&velocities.increment.gather(nodes), lumping.as_ref())
    }

    /// The error at one sample, with ∫Γ_DA/ρ dt there.
    pub(crate) fn error(
        &self,
        balanced: &Balanced<D, N>,
        increment: &[[f64; D]; N],
        motion: &ElementMotion<D, N>,
        hats: &[HatStress<'_>],
    ) -> ElementError {
        let mass = N as f64 * self.element.nodal_mass;
        let (mut dynamic, mut misfit) = (self.start, [[0.0; D]; N]);
        for i in 0..N {
            for c in 0..D {
                dynamic[i][c] += increment[i][c];
                misfit[i][c] = dynamic[i][c] - motion.velocity()[i][c];
            }
        }
        let kinetic = 0.5 * mass_product(mass, &misfit, &misfit);

        // σ_DA − σ_CA balances the loading less the tractions of the constant σ_CA.
        let stress = self.law.stress(&self.element.gradient(motion.displacement()));
        let mut difference = balanced.loading;
        self.subtract_tractions(&stress, &mut difference);
        let elastic = self.law.extent() * (self.stress.energy(&difference) + hat_energy(&difference, hats));
        // |a + b|² = |a − b|² + 4 a·b.
        let products = mass_product(mass, &dynamic, motion.velocity()) + self.work(balanced, motion.displacement());
        ElementError { kinetic, elastic, reference: 2.0 * (kinetic + elastic) + 4.0 * products }
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

    /// The slope of the energy of the stress in the tractions of a loading.
    #[inline]
    pub(crate) fn traction_slope(&self, loading: &Loading<D, N>) -> [[[f64; D]; D]; N] {
        self.stress.traction_slope(loading)
    }

    /// |e|F̂ at the nodes of each facet, from its outward moments there.
    #[inline]
    pub(crate) fn tractions(&self, moments: &[[[f64; D]; D]; N]) -> [[[f64; D]; D]; N] {
        let mut traction = [[[0.0; D]; D]; N];
        for k in 0..N {
            for c in 0..D {
                let sum: f64 = moments[k].iter().map(|b| b[c]).sum();
                for p in 0..D {
                    traction[k][p][c] = D as f64 / self.law.extent() * ((D + 1) as f64 * moments[k][p][c] - sum);
                }
            }
        }
        traction
    }

    /// Takes the tractions of a constant stress off a loading.
    #[inline]
    pub(crate) fn subtract_tractions(&self, stress: &[[f64; D]; D], loading: &mut Loading<D, N>) {
        for k in 0..N {
            let pull = self.element.internal_force(k, stress);
            for c in 0..D {
                let traction = -(D as f64) * pull[c] / self.law.extent();
                (0..D).for_each(|p| loading.traction[k][p][c] -= traction);
            }
        }
    }

    /// Means of σ_DA and of Γ_DA/ρ over the element, on the side `After`.
    pub(crate) fn means(
        &self,
        equilibration: &Equilibration<'_, D, N>,
        level: &Equilibrated<D>,
    ) -> ([[f64; D]; D], [f64; D]) {
        let balanced = self.balanced(equilibration, level, &[None; N], Side::After);
        let lumping = level.forces().level.lumping_difference.as_ref().map(|field| self.element.gather(field));
        let inertia = self.inertia.apply(&self.element.gather(&level.forces().acceleration), lumping.as_ref());
        let acceleration = std::array::from_fn(|c| inertia.iter().map(|a| a[c]).sum::<f64>() / N as f64);
        (self.stress.mean(&balanced.loading), acceleration)
    }

    /// ∫σ_DA : ε(u) as the work of the loading that σ_DA balances (J).
    #[inline]
    fn work(&self, balanced: &Balanced<D, N>, u: &[[f64; D]; N]) -> f64 {
        let mut work = 0.0;
        // The loading balances: a translation does no work and is left out.
        for (force, u_i) in balanced.forces.iter().zip(u) {
            for c in 0..D {
                work += (force.outer[c] - force.inner[c]) * (u_i[c] - u[0][c]);
            }
        }
        self.law.extent() * work
    }

    /// Residuals of the pointwise equilibrium of σ_DA; `scale` is the largest nodal force in the
    /// mesh (N).
    pub(crate) fn check_stress(&self, balanced: &Balanced<D, N>, scale: f64, residuals: &mut Residuals) {
        let stress = self.stress.residuals(&balanced.loading, self.floor(balanced, scale));
        residuals.divergence = worse(residuals.divergence, stress.divergence);
        residuals.edge_tractions = worse(residuals.edge_tractions, stress.edges);
        residuals.inner_tractions = worse(residuals.inner_tractions, stress.inner);
    }

    /// Residual of the balance of the element as a whole.
    pub(crate) fn check_resultants(&self, balanced: &Balanced<D, N>, scale: f64, residuals: &mut Residuals) {
        let resultant = self.resultant_residual(balanced, self.floor(balanced, scale));
        residuals.element_resultants = worse(residuals.element_resultants, resultant);
    }

    /// The smallest force that counts, per unit of section or thickness: 1e-12 of the largest in
    /// the mesh, or the force of f_d or of the lumped inertia at a node.
    fn floor(&self, balanced: &Balanced<D, N>, scale: f64) -> f64 {
        (1e-12 * scale).max(balanced.terms * self.element.volume / N as f64) / self.law.extent()
    }

    /// Resultant of tractions less Γ_DA − f_d, and their moments about the centroid, one in each coordinate plane.
    fn resultant_residual(&self, balanced: &Balanced<D, N>, floor: f64) -> f64 {
        let (mut resultant, mut moments) = ([0.0; D], [[0.0; D]; D]);
        // Tractions one by one: at a node between a fixed edge and elements at rest two of them cancel.
        let mut scale = balanced.loading.traction.iter().flatten().flatten().fold(0.0_f64, |m, t| m.max(t.abs()));
        scale = floor.max(scale / (D * (D + 1)) as f64);
        for (force, arm) in balanced.forces.iter().zip(&self.arms) {
            for c in 0..D {
                resultant[c] += force.outer[c] - force.inner[c];
                scale = scale.max(force.outer[c].abs()).max(force.inner[c].abs());
            }
            let net = |c: usize| force.outer[c] - force.inner[c];
            for b in 1..D {
                (0..b).for_each(|a| moments[a][b] += arm[a] * net(b) - arm[b] * net(a));
            }
        }
        let moment = moments.iter().flatten().fold(0.0, |m, x| worse(m, x.abs()));
        let miss = resultant.iter().fold(moment * self.inverse_reach, |m, f| worse(m, f.abs()));
        miss / scale.max(f64::MIN_POSITIVE)
    }

    /// Work of the tractions, and of Γ_DA − f_d, on the shape function of each node.
    #[inline]
    fn nodal_forces(&self, loading: &Loading<D, N>) -> [NodalForce<D>; N] {
        let volume = self.element.volume / self.law.extent() / ((D + 1) * (D + 2)) as f64;
        let Loading { traction, volume: load } = loading;
        let mut forces = [NodalForce { outer: [0.0; D], inner: [0.0; D] }; N];
        for c in 0..D {
            let total: f64 = load.iter().map(|g| g[c]).sum();
            for k in 0..N {
                forces[k].inner[c] = volume * (load[k][c] + total);
                let sum: f64 = traction[k].iter().map(|t| t[c]).sum();
                for p in 0..D {
                    forces[facet_node::<N>(k, p)].outer[c] += (traction[k][p][c] + sum) / (D * (D + 1)) as f64;
                }
            }
        }
        forces
    }
}
