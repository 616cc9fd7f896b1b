//! The full reaction as a density on all candidate facets of its node, balanced by an auxiliary solution with less
//! dispersion, with tractions of least energy.

mod auxiliary_solution;
mod compared_motions;
mod concentration;
mod energy_products;
mod impulse_smoothing;
mod lumping_difference;
mod moment_correction;
mod traction_minimisation;

use super::{BalancedFields, ReconstructionMethod, SimulatedStep, StepDensities, SurfaceSteps};
use crate::acceleration::accelerate;
use crate::concentrated::TractionShape;
use crate::contact_density::{Densities, FacetPressures, LevelDensities, NormalMisfit, OffContact, driving_forces};
use crate::difference::Difference;
use crate::element::Element;
use crate::error::EstimateError;
use crate::kinematic::ContactTrack;
use crate::options::{Ablation, Acceleration, Options};
use crate::residual::worse;
use crate::time_level::SurfaceStep;
use crate::traction::{Equilibrated, Equilibration};
use auxiliary_solution::{AuxiliarySolution, Shares};
use compared_motions::{AuxiliaryLevel, ComparedMotions};
pub(crate) use concentration::Concentration;
use concentration::OwnForces;
use impulse_smoothing::ImpulseSmoothing;
use lumping_difference::lumping_difference;
use moment_correction::MomentCorrection;
use percute_core::contact::ContactNode;
use percute_core::dynamics::Dynamics;
use percute_core::history::Step;
use percute_core::problem::Problem;
use percute_core::simplex::Shape;
use percute_core::time::TimeGrid;
use std::borrow::Cow;
use traction_minimisation::TractionMinimisation;

/// The reconstruction that drops no reaction, except at nodes with a contact of their own.
#[derive(Debug)]
pub(super) struct Corrected<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    /// Tributary area (m²) of each node of the contact surface.
    tributary: Vec<f64>,
    concentration: Option<Concentration<D>>,
    own_forces: OwnForces<D>,
    moment_correction: Option<MomentCorrection<D>>,
    impulse_smoothing: Option<ImpulseSmoothing<D>>,
    auxiliary: Option<AuxiliarySolution<D>>,
    compared: Option<ComparedMotions<'p, D, N>>,
    /// Whether the lumping difference is wanted.
    mixed: bool,
    minimises: bool,
    minimisation: Option<TractionMinimisation<D>>,
    /// Weight of the work of normal forces off contact.
    normal_work: f64,
}

impl<'p, const D: usize, const N: usize> Corrected<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, options: &Options) -> Self {
        let keeps = |part: Ablation| options.ablation != part;
        let shares = if keeps(Ablation::Correction) { Shares::ALL } else { Shares::NONE };
        let concentrates = match problem.mesh().simplex().shape() {
            Shape::Bar => false,
            Shape::Triangle => true,
        };
        Self {
            problem,
            times,
            tributary: problem.surface().tributary_areas(),
            concentration: (concentrates && keeps(Ablation::Concentration)).then(|| Concentration::new(problem)),
            own_forces: OwnForces::new(problem),
            moment_correction: keeps(Ablation::Moment).then(|| MomentCorrection::new(problem)),
            impulse_smoothing: keeps(Ablation::ImpulseSmoothing).then(|| ImpulseSmoothing::new(problem)),
            auxiliary: keeps(Ablation::AuxiliarySolution).then(|| AuxiliarySolution::new(problem, shares)),
            compared: None,
            mixed: options.acceleration(D) == Acceleration::Mixed,
            minimises: keeps(Ablation::LeastEnergy),
            minimisation: None,
            normal_work: match options.ablation {
                Ablation::NormalWork => 0.0,
                Ablation::DoubledWork => 2.0,
                _ => 1.0,
            },
        }
    }

    /// The densities of an instant: of the forces of F_DA, and of the reactions of which the normal work is measured.
    fn level(&self, [acting, sudden]: [&[[f64; D]]; 2], gap: &[f64]) -> LevelDensities<D> {
        LevelDensities { acting: self.at(acting, gap), sudden: self.at(sudden, gap) }
    }

    /// The densities of a level: those that were kept, or those of its forces and reactions.
    fn kept<'a>(&self, step: &'a SurfaceStep<D>) -> Cow<'a, LevelDensities<D>> {
        let made = || Cow::Owned(self.level([&step.force, &step.reaction], &step.gap));
        step.densities.as_ref().map_or_else(made, Cow::Borrowed)
    }

    /// Densities at one instant: R_k/ℓ_k at the nodes, whether they touch or are about to, linear along each
    /// facet, corrected so that they have the moment of the reactions too. Their resultant is that of the reactions,
    /// and where those are in the cone, so is every mean of two of them.
    fn at(&self, reaction: &[[f64; D]], gap: &[f64]) -> Densities<D> {
        let problem = self.problem;
        // Reactions of the integrator are in the cone; those of a foreign history need not be.
        let held = |(contact, force): (&ContactNode, &[f64; D])| {
            problem.obstacles()[contact.obstacle].project_into_cone(force)
        };
        let nodes = problem.surface().nodes();
        let mut reaction: Vec<[f64; D]> = nodes.iter().zip(reaction).map(held).collect();
        let concentration = self.concentration.as_ref();
        let shape = |(at, force)| concentration.and_then(|concentration| concentration.shape(problem, at, force, gap));
        let shapes: Vec<Option<TractionShape>> = reaction.iter().enumerate().map(shape).collect();
        let shaped = |at: usize| concentration.zip(shapes[at].as_ref());
        if let Some(correction) = &self.moment_correction {
            let centroid =
                |at: usize| shaped(at).map(|(concentration, shape)| concentration.centroid(problem, at, shape));
            correction.apply(&mut reaction, &centroid);
        }
        let density = |f: usize, k: usize| match shaped(k) {
            Some((concentration, shape)) => concentration.wide(k, f, shape, &reaction[k]),
            None => reaction[k].map(|r| r / self.tributary[k]),
        };
        let (mut hats, mut shares) = (Vec::new(), 0.0);
        for (k, force) in reaction.iter().enumerate() {
            if let Some((concentration, shape)) = shaped(k) {
                let own: Vec<_> = concentration.hats(k, shape, force).collect();
                shares = worse(shares, concentration.share_residual(k, shape, force, &own));
                hats.extend(own);
            }
        }
        Densities::with_hats(problem, |f, facet| facet.nodes.map(|k| density(f, k)), hats).with_shares(shares)
    }
}

impl<const D: usize, const N: usize> ReconstructionMethod<D, N> for Corrected<'_, D, N> {
    fn prepare(&mut self, elements: &[Element<D, N>]) {
        if self.auxiliary.is_some() {
            self.compared = Some(ComparedMotions::new(self.problem, self.times, elements));
        }
        if self.minimises {
            self.minimisation = TractionMinimisation::new(self.problem, elements);
        }
    }

    fn memory(&self, levels: usize, threads: usize) -> usize {
        let mesh = self.problem.mesh();
        let concentration = self.concentration.as_ref().map_or(0, |concentration| concentration.memory(self.problem));
        TractionMinimisation::<D>::memory(mesh.simplex().shape(), mesh.element_count(), levels, threads)
            .saturating_add(concentration)
    }

    fn check(&self, step: &Step<'_, D>) -> Result<(), EstimateError> {
        match &self.auxiliary {
            Some(auxiliary) if auxiliary.is_unstable(self.problem.mass()) => Err(EstimateError::AuxiliarySolution {
                step: step.index,
                time: step.time,
                longest_step: self.times.longest_step(),
            }),
            _ => Ok(()),
        }
    }

    /// The balance is that of the auxiliary solution, which then goes on to the next step.
    fn advance(&mut self, dynamics: &Dynamics<'_, D, N>, simulated: &SimulatedStep<'_, D>) -> BalancedFields<D> {
        let (state, step, problem) = (simulated.state, simulated.state.step(), self.problem);
        let mut contact = match &mut self.impulse_smoothing {
            Some(smoothing) => smoothing.advance(problem, self.times, step.index, step.reaction, &state.acceleration()),
            None => step.reaction.to_vec(),
        };
        let (gap, inverse_mass) = (problem.surface().gaps(step.displacement), dynamics.inverse_mass());
        let Some(mut auxiliary) = self.auxiliary.take() else {
            let (displacement, force) = (step.displacement.to_vec(), state.force_without_contact(problem.surface()));
            let densities = self.level([&contact, step.reaction], &gap);
            let pull = driving_forces(problem, &densities.acting);
            let lumping_difference = self.mixed.then(|| {
                lumping_difference(problem, inverse_mass, &accelerate(problem, inverse_mass, force.clone(), &pull))
            });
            return BalancedFields { displacement, force, contact, densities: Some(densities), lumping_difference };
        };
        auxiliary.watch(simulated, problem.mass());
        let displacement = auxiliary.displacement().to_vec();
        let mut force = vec![[0.0; D]; displacement.len()];
        dynamics.forces_without_contact(step.index, &displacement, &mut force);
        let mut arresting = step.reaction.to_vec();
        if let Some(concentration) = &self.concentration {
            let approach = |at: usize| auxiliary.approach(problem, inverse_mass, self.times, (step.index, at), &force);
            self.own_forces.apply(problem, concentration, &gap, approach, [&mut contact, &mut arresting]);
        }
        let densities = self.level([&contact, &arresting], &gap);
        let pull = driving_forces(problem, &densities.acting);
        let acceleration = accelerate(problem, inverse_mass, force.clone(), &pull);
        let lumping_difference = self.mixed.then(|| lumping_difference(problem, inverse_mass, &acceleration));
        let known = lumping_difference.as_deref();
        auxiliary.accelerate(problem, dynamics, self.times, step.index, &acceleration, known);
        if let Some(compared) = &mut self.compared {
            let (solution, density) = (&auxiliary, &densities.acting);
            let level = AuxiliaryLevel { solution, force: &force, contact: &contact, density, pull: &pull };
            compared.advance(dynamics, simulated, &level);
        }
        auxiliary.advance(self.times, step.index);
        self.auxiliary = Some(auxiliary);
        BalancedFields { displacement, force, contact, densities: Some(densities), lumping_difference }
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

    fn concentration(&self) -> Option<&Concentration<D>> {
        self.concentration.as_ref()
    }

    fn own_contacts(&self) -> usize {
        self.own_forces.count()
    }

    fn differences(&self) -> Option<&[Difference]> {
        self.compared.as_ref().map(ComparedMotions::differences)
    }

    fn normal_misfit(&self, pressures: &FacetPressures<D>, tracks: &[ContactTrack]) -> NormalMisfit {
        pressures.misfit(self.problem, self.times, tracks, self.normal_work)
    }

    fn improve(&self, equilibration: &Equilibration<'_, D, N>, choice: Acceleration, levels: &mut [Equilibrated<D>]) {
        if let Some(minimisation) = &self.minimisation {
            minimisation.improve(self.problem, equilibration, choice, levels, self.concentration.as_ref());
        }
    }
}
