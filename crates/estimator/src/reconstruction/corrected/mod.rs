//! The full reaction as a density on all candidate faces of its node, balanced by an auxiliary solution with less
//! dispersion, with tractions of least energy.

mod auxiliary;
mod concentration;
mod impulse_smoothing;
mod moment_correction;
mod non_matching;
mod non_matching_motion;
mod present_stars;
mod split;
mod traction_minimisation;

use super::{BalancedFields, ReconstructionMethod, SimulatedStep, StepDensities, SurfaceSteps, friction};
use crate::acceleration::accelerate;
use crate::concentrated::TractionShape;
use crate::contact_density::{Densities, FacePressures, LevelDensities, NormalMisfit, OffContact, driving_forces};
use crate::difference::Difference;
use crate::element::Element;
use crate::error::EstimateError;
use crate::kinematic::ContactMotion;
use crate::nodal_field::FieldPool;
use crate::options::{Ablation, Acceleration, Options};
use crate::plastic::eigenstrains;
use crate::pool::Pool;
use crate::residual::worse;
use crate::smoothing::{SmoothedStrains, Smoothing};
use crate::time_level::{ForcesKnown, KnownInertia, MotionKnown, SplitFields, SurfaceStep};
use crate::traction::{EquilibratedLevels, Equilibration, Then};
use auxiliary::{Auxiliary, AuxiliaryLevel, Shares, SimulatedLevel, SplitLevel};
pub(crate) use concentration::Concentration;
use concentration::{AuxiliaryForces, Faced, Known};
use impulse_smoothing::{ImpulseSmoothing, Stopped};
use moment_correction::MomentCorrection;
use non_matching::NonMatchingForces;
use non_matching_motion::AuxiliaryInterfaceMotion;
use percute_core::cell::CellKind;
use percute_core::contact::{ContactNode, Coupling};
use percute_core::dynamics::Dynamics;
use percute_core::history::{State, Step};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use present_stars::PresentStars;
use split::skew_acceleration;
use std::borrow::Cow;
use std::sync::Arc;
use traction_minimisation::{SolidMinimisation, TractionMinimisation};

/// The strain of a star from which on its node has no contact of its own: at a corner of rubber with 25 %, such
/// contacts gave a seventh of the energy.
const STRAINED: f64 = 0.1;

/// The reconstruction that drops no reaction, except at nodes with a contact of their own.
#[derive(Debug)]
pub(super) struct Corrected<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    /// Tributary area (m²) of each node of the contact surface.
    tributary: Vec<f64>,
    concentration: Option<Concentration<D>>,
    auxiliary_forces: AuxiliaryForces<D>,
    moment_correction: Option<MomentCorrection<D>>,
    impulse_smoothing: Option<ImpulseSmoothing<D>>,
    non_matching: NonMatchingForces<'p, D>,
    auxiliary: Option<Auxiliary<'p, D, N>>,
    /// ΣF²k and ΣF² over the nodes at the last level (N²).
    halvings: [f64; 2],
    smoothing: Arc<Smoothing>,
    strains: Pool<SmoothedStrains>,
    /// Whether the mass term is split.
    splits: bool,
    minimises: bool,
    minimisation: Option<TractionMinimisation>,
    solid_minimisation: Option<SolidMinimisation>,
    /// Weight of the work of normal forces off contact.
    normal_work: f64,
}

/// Whether tractions of nodes are concentrated.
fn concentrates<const D: usize>(problem: &Problem<D>, options: &Options) -> bool {
    let possible = match problem.mesh().kind() {
        CellKind::Bar | CellKind::Tetrahedron => false,
        CellKind::Triangle => true,
    };
    possible && options.ablation != Ablation::Concentration
}

impl<'p, const D: usize, const N: usize> Corrected<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D>, times: &'p TimeGrid, options: &Options) -> Self {
        let keeps = |part: Ablation| options.ablation != part;
        let shares = if keeps(Ablation::Correction) { Shares::ALL } else { Shares::NONE };
        let smoothing = Arc::new(Smoothing::new(problem));
        let auxiliary = || Auxiliary::new(problem, times, Arc::clone(&smoothing), shares);
        Self {
            problem,
            times,
            tributary: problem.surface().tributary_areas(),
            concentration: concentrates(problem, options).then(|| Concentration::new(problem)),
            auxiliary_forces: AuxiliaryForces::new(problem),
            moment_correction: keeps(Ablation::Moment).then(|| MomentCorrection::new(problem)),
            impulse_smoothing: keeps(Ablation::ImpulseSmoothing).then(|| ImpulseSmoothing::new(problem)),
            non_matching: NonMatchingForces::new(problem),
            auxiliary: keeps(Ablation::AuxiliarySolution).then(auxiliary),
            smoothing,
            strains: Pool::new(),
            halvings: [0.0; 2],
            splits: options.acceleration(D) == Acceleration::Split,
            minimises: keeps(Ablation::LeastEnergy),
            minimisation: None,
            solid_minimisation: None,
            normal_work: match options.ablation {
                Ablation::NormalWork => 0.0,
                Ablation::DoubledWork => 2.0,
                _ => 1.0,
            },
        }
    }

    /// About how much memory it takes (bytes), known before it is made.
    pub(super) fn memory(problem: &Problem<D>, options: &Options) -> usize {
        let mesh = problem.mesh();
        let of_stars = || Concentration::new(problem).memory(problem);
        let concentration = concentrates(problem, options).then(of_stars).unwrap_or(0);
        TractionMinimisation::memory(mesh.kind(), mesh.element_count())
            .saturating_add(Auxiliary::<D, N>::memory(mesh.node_count(), mesh.element_count()))
            .saturating_add(concentration)
    }

    /// Replaces the forces (N) at nodes that touch alone, from the foreseen motions of all contact nodes in the step n.
    fn replace_own(
        &mut self,
        (n, auxiliary): (usize, &mut Auxiliary<'p, D, N>),
        stopped: &[Option<Stopped>],
        around: &SurfaceInstant<'_, D>,
        [contact, arresting]: [&mut [[f64; D]]; 2],
    ) {
        let (problem, surface, length) = (self.problem, self.problem.surface(), self.times.step(n));
        let Some(concentration) = &self.concentration else { return };
        let Some(foreseen) = auxiliary.foresee(n, around.present.as_ref()) else {
            return self.auxiliary_forces.release_all();
        };
        let time = |at: usize| {
            let own = || self.impulse_smoothing.as_ref().map_or(length, |smoothing| smoothing.time(at));
            stopped.get(at).copied().flatten().map_or_else(own, |stopped| stopped.time)
        };
        let steps = |at: usize| length / time(at);
        let unturned = |at: usize, vector: &[f64; D]| around.unturned(at, vector);
        let strained = |at: usize| around.present.as_ref().is_some_and(|stars| stars.strain(at) > STRAINED);
        let (gap, steps, unturned, strained) = (around.gap, &steps, &unturned, &strained);
        let mut known = Known { problem, concentration, gap, steps, strained, unturned, contact, arresting };
        self.auxiliary_forces.replace(
            &mut known,
            |at| foreseen.free_gap(at),
            |at, forces| foreseen.approach(at, concentration.far_nodes(at), forces),
        );
        for (non_matching, coupling) in surface.non_matching().iter().zip(around.couplings) {
            let mut nodes = Vec::new();
            for at in non_matching.positions().filter(|&at| surface.nodes()[at].free) {
                match around.faced[at] {
                    Some(faced) => nodes.push((at, faced)),
                    None => self.auxiliary_forces.release(at),
                }
            }
            let mut motion = AuxiliaryInterfaceMotion::new((non_matching, coupling), foreseen.free(), known.contact);
            self.auxiliary_forces.replace_in_turn(nodes, &mut known, |at, forces| motion.approach(at, forces));
        }
    }

    /// The fields of the simulation, where there is no auxiliary solution.
    fn balance_simulation(
        &self,
        dynamics: &Dynamics<'_, D>,
        state: &State<'_>,
        [contact, sudden]: [Vec<[f64; D]>; 2],
        around: &SurfaceInstant<'_, D>,
        pool: &FieldPool<D>,
    ) -> BalancedFields<D> {
        let (problem, step, inverse_mass) = (self.problem, state.step(), dynamics.inverse_mass());
        let (displacement, mut force) = (pool.copy(step.displacement()), pool.take());
        state.write_force_without_contact(problem.surface(), &mut force);
        let densities = self.level([&contact, &sudden], around);
        let pull = driving_forces(problem, &densities.acting);
        let mut acceleration = force;
        accelerate(problem, inverse_mass, &mut acceleration, &pull);
        let split = self.splits.then(|| SplitFields {
            lumped: pool.copy(&acceleration),
            skew: pool.copy(&skew_acceleration::<D, N>(problem, inverse_mass, &acceleration, &displacement)),
        });
        let (inertia, densities) = (KnownInertia::Acceleration(acceleration), Some(densities));
        let plastic = eigenstrains(problem, step.internal);
        BalancedFields { displacement, inertia, contact, densities, split, smoothed: false, plastic }
    }

    fn around<'a>(&self, gap: &'a [f64], couplings: &'a [Arc<Coupling>]) -> SurfaceInstant<'a, D> {
        let surface = self.problem.surface();
        let stands = |at: usize| surface.non_matching_of(at).is_none().then_some(Faced::WHOLE);
        let mut faced: Vec<_> = (0..surface.nodes().len()).map(stands).collect();
        if let Some(concentration) = &self.concentration {
            self.non_matching.add_faced(concentration, couplings, &mut faced);
        }
        SurfaceInstant { gap, couplings, faced, own: Vec::new(), present: None }
    }

    /// The densities of an instant: of the forces of F_DA, and of the reactions of which the normal work is measured.
    fn level(&self, [acting, sudden]: [&[[f64; D]]; 2], around: &SurfaceInstant<'_, D>) -> LevelDensities<D> {
        LevelDensities { acting: self.at(acting, around), sudden: self.at(sudden, around) }
    }

    /// The densities of a level: those that were kept, or those of its forces and reactions without non-matching
    /// interfaces.
    fn kept<'a>(&self, step: &'a SurfaceStep<D>) -> Cow<'a, LevelDensities<D>> {
        let made = || Cow::Owned(self.level([&step.force, &step.reaction], &self.around(&step.gap, &[])));
        step.densities.as_ref().map_or_else(made, Cow::Borrowed)
    }

    /// Densities at one instant: R_k/ℓ_k at the nodes, whether they touch or are about to, linear along each
    /// face, corrected so that they have the moment of the reactions too. Their resultant is that of the reactions,
    /// and where those are in the cone, so is every mean of two of them.
    fn at(&self, reaction: &[[f64; D]], around: &SurfaceInstant<'_, D>) -> Densities<D> {
        let (problem, surface) = (self.problem, self.problem.surface());
        // Reactions of the integrator are in the cone; those of a foreign history need not be.
        let held = |(contact, force): (&ContactNode, &[f64; D])| {
            problem.obstacles()[contact.obstacle].project_into_cone(force)
        };
        let (nodes, concentration) = (problem.surface().nodes(), self.concentration.as_ref());
        let mut reaction: Vec<[f64; D]> = nodes.iter().zip(reaction).map(held).collect();
        let mut shapes: Vec<Option<TractionShape>> = Vec::with_capacity(nodes.len());
        for (at, force) in reaction.iter().enumerate() {
            // The traction on the other one of two nodes that touch is the same, reversed.
            let facing = nodes[at].partner.filter(|_| !surface.leads(at));
            shapes.push(concentration.and_then(|concentration| match facing {
                Some(first) => Some(concentration.facing(problem, [first, at], shapes[first].as_ref()?)),
                None => {
                    let own = around.own.get(at).copied().flatten();
                    let forces = [force, &around.pulled(at, force)];
                    concentration.shape(problem, at, around.faced[at].as_ref()?, forces, around.gap, own)
                }
            }));
        }
        let shaped = |at: usize| concentration.zip(shapes[at].as_ref());
        if let Some(correction) = &self.moment_correction {
            let moved = around.displacement();
            let centroid = |at: usize| {
                let concentration = concentration.filter(|_| shapes[at].is_some() || !moved.is_empty())?;
                Some(concentration.centroid(problem, at, shapes[at].as_ref(), moved))
            };
            correction.apply(&mut reaction, moved, &centroid);
            self.non_matching.correct_moments(around.couplings, &centroid, &mut reaction);
            for (at, contact) in nodes.iter().enumerate() {
                if let Some(first) = contact.partner.filter(|&first| first < at) {
                    reaction[at] = reaction[first].map(|f| -f);
                }
            }
        }
        let density = |f: usize, k: usize| match shaped(k) {
            _ if surface.non_matching_of(k).is_some() => [0.0; D],
            Some((concentration, shape)) => concentration.wide(k, f, shape, &reaction[k]),
            None => reaction[k].map(|r| r / self.tributary[k]),
        };
        let (mut hats, mut shares) = (Vec::new(), 0.0);
        for (k, force) in reaction.iter().enumerate() {
            if let Some((concentration, shape)) = shaped(k) {
                let pulled = around.pulled(k, force);
                let own: Vec<_> = concentration.hats(k, shape, [force, &pulled]).collect();
                shares = worse(shares, concentration.share_residual(k, shape, force, &own));
                hats.extend(own);
            }
        }
        let made = Densities::with_hats(problem, |f, face| face.nodes.map(|k| density(f, k)), hats);
        let non_matching = self.non_matching.densities(&shaped, around.couplings, &reaction);
        made.with_shares(shares).with_non_matching(problem, self.non_matching.faces(), non_matching)
    }
}

/// The nodes of the contact surface at an instant.
struct SurfaceInstant<'a, const D: usize> {
    /// Gaps of the simulation (m).
    gap: &'a [f64],
    /// Those of non-matching interfaces.
    couplings: &'a [Arc<Coupling>],
    /// What each node faces, if its traction may be hats.
    faced: Vec<Option<Faced>>,
    /// The shapes of the tractions of auxiliary contact forces, where they are known.
    own: Vec<Option<TractionShape>>,
    /// The deformation of a body that turns.
    present: Option<PresentStars<'a, D>>,
}

impl<const D: usize> SurfaceInstant<'_, D> {
    /// A force on a node, pulled back to its star in the undeformed body.
    fn pulled(&self, at: usize, force: &[f64; D]) -> [f64; D] {
        self.present.as_ref().map_or(*force, |present| present.pull_back(at, force))
    }

    /// A vector at a node, turned back with its star. The compliance of an auxiliary contact is that of the undeformed
    /// star for it: one that changed with the strain would give energy.
    fn unturned(&self, at: usize, vector: &[f64; D]) -> [f64; D] {
        self.present.as_ref().map_or(*vector, |present| present.turn_back(at, vector))
    }

    /// Displacements of the simulation (m), of a body that turns.
    fn displacement(&self) -> &[[f64; D]] {
        self.present.as_ref().map_or(&[], |present| present.displacement)
    }
}

impl<const D: usize, const N: usize> ReconstructionMethod<D, N> for Corrected<'_, D, N> {
    fn prepare(&mut self, elements: &[Element<D, N>]) {
        if let Some(auxiliary) = &mut self.auxiliary {
            auxiliary.prepare(elements);
        }
        if self.minimises {
            self.minimisation = TractionMinimisation::new(self.problem, elements);
            let is_solid = self.problem.mesh().kind() == CellKind::Tetrahedron;
            self.solid_minimisation = is_solid.then(|| SolidMinimisation::new(self.problem));
        }
    }

    fn check(&self, step: &Step<'_>) -> Result<(), EstimateError> {
        if !self.auxiliary.as_ref().is_some_and(Auxiliary::is_unstable) {
            return Ok(());
        }
        if self.problem.is_finite() {
            return Err(EstimateError::FiniteAuxiliarySolution { step: step.index, time: step.time });
        }
        let longest_step = self.times.longest_step();
        Err(EstimateError::AuxiliarySolution { step: step.index, time: step.time, longest_step })
    }

    /// The balance is that of the auxiliary solution, which then goes on to the next step.
    fn advance(
        &mut self,
        dynamics: &Dynamics<'_, D>,
        simulated: &SimulatedStep<'_, D>,
        pool: &FieldPool<D>,
    ) -> BalancedFields<D> {
        let (state, step, problem) = (simulated.state, simulated.state.step(), self.problem);
        let surface = problem.surface();
        let couplings: Vec<Arc<Coupling>> = surface
            .non_matching()
            .iter()
            .map(|non_matching| Arc::new(non_matching.coupling(surface, step.displacement())))
            .collect();
        let mut arresting = self.non_matching.of(self.times, state);
        let acceleration = |node| state.acceleration_of(node);
        let stopped = self.non_matching.stopped(&couplings, acceleration);
        let mut contact = match &mut self.impulse_smoothing {
            Some(smoothing) => {
                smoothing.approach(problem, state.half_step(), &arresting);
                smoothing.advance(problem, self.times, step.index, &arresting, acceleration, &stopped)
            }
            None => arresting.clone(),
        };
        [&mut arresting, &mut contact].into_iter().for_each(|forces| self.non_matching.gather(&couplings, forces));
        let gap = surface.gaps(step.displacement());
        let mut around = self.around(&gap, &couplings);
        if problem.is_finite() {
            let balanced = self.auxiliary.as_ref().and_then(Auxiliary::displacement).unwrap_or(step.displacement());
            around.present = Some(PresentStars::new(problem, step.displacement(), balanced));
        }
        let Some(mut auxiliary) = self.auxiliary.take() else {
            return self.balance_simulation(dynamics, state, [contact, arresting], &around, pool);
        };
        auxiliary.begin(dynamics, step.index);
        self.replace_own((step.index, &mut auxiliary), &stopped, &around, [&mut contact, &mut arresting]);
        around.own = self.auxiliary_forces.shapes();
        let densities = self.level([&contact, &arresting], &around);
        self.halvings = halvings(&contact, &densities.acting);
        let pull = driving_forces(problem, &densities.acting);
        // The pass fills all of them.
        let (mut displacement, mut acceleration) = (pool.take(), pool.take());
        let mut split = self.splits.then(|| SplitFields { lumped: pool.take(), skew: pool.take() });
        let fields = split.as_mut().map(|split| SplitLevel { lumped: &mut split.lumped, skew: &mut split.skew });
        let level = AuxiliaryLevel { displacement: &mut displacement, acceleration: &mut acceleration, split: fields };
        let (velocity, strain, reaction) = (simulated.velocity, state.strain(), step.reaction());
        let simulated = SimulatedLevel { velocity, strain, reaction };
        auxiliary.advance(dynamics, step.index, &simulated, &pull, level);
        let (smoothed, plastic) = (auxiliary.smooths(), auxiliary.eigenstrains().cloned());
        self.auxiliary = Some(auxiliary);
        let (inertia, densities) = (KnownInertia::Acceleration(acceleration), Some(densities));
        BalancedFields { displacement, inertia, contact, densities, split, smoothed, plastic }
    }

    fn differ(&mut self, simulated: [&[[f64; D]]; 2]) {
        if let Some(auxiliary) = &mut self.auxiliary {
            auxiliary.differ(simulated, self.halvings);
        }
    }

    fn densities(&self, steps: &SurfaceSteps<'_, D>) -> StepDensities<D> {
        let [start, end] = [steps.now, steps.next].map(|step| self.kept(step).acting.clone());
        StepDensities { start, end }
    }

    fn off_contact(&self, steps: &SurfaceSteps<'_, D>, densities: &StepDensities<D>) -> Option<OffContact<D>> {
        let kept = [steps.now, steps.next].map(|step| self.kept(step));
        let sudden = kept.each_ref().map(|level| &level.sudden);
        Some(OffContact::new(self.problem, [&densities.start, &densities.end], sudden))
    }

    fn friction(
        &self,
        problem: &Problem<D>,
        length: f64,
        now: &ForcesKnown<D>,
        next: &MotionKnown<D>,
        density: &Densities<D>,
    ) -> Vec<[f64; 2]> {
        let mut friction = friction::friction(problem, length, now, next, density);
        let of = (problem, &**self.non_matching.faces());
        friction::add_non_matching(of, length, now, next, density, &mut friction);
        friction
    }

    fn concentration(&self) -> Option<&Concentration<D>> {
        self.concentration.as_ref()
    }

    fn isolated_contact_nodes(&self) -> usize {
        self.auxiliary_forces.count()
    }

    fn auxiliary_contact_energy(&self) -> f64 {
        self.auxiliary.as_ref().map_or(0.0, Auxiliary::contact_energy)
    }

    fn differences(&self) -> Option<&[Difference]> {
        self.auxiliary.as_ref().and_then(Auxiliary::differences)
    }

    fn normal_misfit(&self, pressures: &FacePressures<D>, tracks: &[ContactMotion]) -> NormalMisfit {
        pressures.misfit(self.problem, self.times, tracks, self.normal_work)
    }

    fn weight_of_work(&self) -> f64 {
        self.normal_work
    }

    fn equilibrate(
        &self,
        equilibration: &Equilibration<'_, D, N>,
        choice: Acceleration,
        forces: Vec<ForcesKnown<D>>,
        levels: &mut EquilibratedLevels<D>,
        then: Then<'_, D>,
    ) -> f64 {
        let smoothed = forces.iter().any(|forces| forces.level.smoothed);
        self.strains.lend(SmoothedStrains::default, |strains| {
            if smoothed {
                equilibration.fill_strains(&self.smoothing, &forces, strains);
            }
            let strains = smoothed.then_some((&*strains, &*self.smoothing));
            let of = (self.problem, equilibration, choice);
            if let Some(minimisation) = &self.solid_minimisation {
                return minimisation.equilibrate(of, (forces, strains), levels, then);
            }
            let Some(minimisation) = &self.minimisation else {
                return equilibration.solve(forces, levels, strains, then);
            };
            minimisation.equilibrate(of, (forces, strains), levels, self.concentration.as_ref(), then)
        })
    }
}

/// ΣF²k and ΣF² over the nodes, with the contact force F and the halvings k of its hats.
fn halvings<const D: usize>(contact: &[[f64; D]], density: &Densities<D>) -> [f64; 2] {
    let size = |force: &[f64; D]| force.iter().map(|f| f * f).sum::<f64>().sqrt();
    let narrow = density.hats().iter().map(|hat| size(&hat.resultant) * size(&contact[hat.node]) * hat.halvings as f64);
    [narrow.sum(), contact.iter().flatten().map(|f| f * f).sum()]
}
