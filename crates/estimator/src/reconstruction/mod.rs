//! Reconstructions: from the steps of a simulation to contact tractions F_DA (§6.2.1) and to the fields that are
//! balanced.
//!
//! A density lives on the candidate faces, linear on each and linear in time inside each step. A
//! [`ReconstructionMethod`] makes it, and decides on all that goes with it. [`new`] is the one place where a choice
//! becomes its reconstruction.

mod admissibility;
mod consistent;
mod corrected;
mod friction;
mod published;

use crate::contact_density::{Densities, FacePressures, LevelDensities, NormalMisfit, OffContact};
use crate::difference::Difference;
use crate::element::Element;
use crate::error::EstimateError;
use crate::kinematic::ContactMotion;
use crate::nodal_field::{FieldPool, NodalField};
use crate::options::{Acceleration, Options, Reconstruction};
use crate::plastic::{EigenStrains, eigenstrains};
use crate::time_level::{ForcesKnown, KnownInertia, MotionKnown, SplitFields, SurfaceStep};
use crate::traction::{EquilibratedLevels, Equilibration, Then};
pub(crate) use admissibility::check;
use consistent::Consistent;
pub(crate) use corrected::Concentration;
use corrected::Corrected;
use percute_core::dynamics::Dynamics;
use percute_core::history::{State, Step};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use published::Published;
use std::fmt::Debug;

/// The contact surface around one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceSteps<'a, const D: usize> {
    /// Before the step; `None` at t_0.
    pub(crate) before: Option<&'a SurfaceStep<D>>,
    /// At its beginning.
    pub(crate) now: &'a SurfaceStep<D>,
    /// At its end.
    pub(crate) next: &'a SurfaceStep<D>,
    /// After the step; `None` if it is the last.
    pub(crate) after: Option<&'a SurfaceStep<D>>,
}

/// F_DA at the beginning and the end of one step.
#[derive(Clone, Debug)]
pub(crate) struct StepDensities<const D: usize> {
    pub(crate) start: Densities<D>,
    pub(crate) end: Densities<D>,
}

/// A step of the simulation with the fields that follow from it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SimulatedStep<'a, const D: usize> {
    pub(crate) state: &'a State<'a>,
    /// u̇_CA at the nodes (m/s).
    pub(crate) velocity: &'a [[f64; D]],
}

/// The fields that are balanced at t_n.
#[derive(Clone, Debug)]
pub(crate) struct BalancedFields<const D: usize> {
    /// The displacement whose stress is equilibrated (m).
    pub(crate) displacement: NodalField<D>,
    pub(crate) inertia: KnownInertia<D>,
    /// The forces of which densities are made (N).
    pub(crate) contact: Vec<[f64; D]>,
    /// Their densities, where they depend on no other instant.
    pub(crate) densities: Option<LevelDensities<D>>,
    /// The other fields of a split mass term.
    pub(crate) split: Option<SplitFields<D>>,
    /// Whether the stress is that of smoothed strains.
    pub(crate) smoothed: bool,
    /// ε* of the stress, where a material yields.
    pub(crate) plastic: Option<EigenStrains>,
}

/// A way to build dynamically admissible fields.
pub(crate) trait ReconstructionMethod<const D: usize, const N: usize>: Debug + Send + Sync {
    /// Prepares the maps of the elements.
    fn prepare(&mut self, _elements: &[Element<D, N>]) {}

    /// Whether it can go on with a step.
    ///
    /// # Errors
    /// A reason that lies in the steps so far.
    fn check(&self, _step: &Step<'_>) -> Result<(), EstimateError> {
        Ok(())
    }

    /// Takes in a step and returns the fields that are balanced there: those of the simulation, unless the
    /// reconstruction has its own.
    fn advance(
        &mut self,
        dynamics: &Dynamics<'_, D>,
        simulated: &SimulatedStep<'_, D>,
        pool: &FieldPool<D>,
    ) -> BalancedFields<D> {
        let (state, step) = (simulated.state, simulated.state.step());
        let (displacement, contact, mut force) =
            (pool.copy(step.displacement()), step.reaction().to_vec(), pool.take());
        state.write_force_without_contact(dynamics.problem().surface(), &mut force);
        let inertia = KnownInertia::Forces(force);
        let plastic = eigenstrains(dynamics.problem(), step.internal);
        BalancedFields { displacement, inertia, contact, densities: None, split: None, smoothed: false, plastic }
    }

    /// Measures the difference of the simulation and the auxiliary solution at the level that `advance` has taken in
    /// last, from the displacement (m) and u̇_CA (m/s) of the simulation. At most once for a level; the others have a
    /// difference of 0.
    fn differ(&mut self, _simulated: [&[[f64; D]]; 2]) {}

    /// F_DA over a step.
    fn densities(&self, steps: &SurfaceSteps<'_, D>) -> StepDensities<D>;

    /// The densities of a step where they may act on nodes that do not touch; `None` if they never do.
    fn off_contact(&self, _steps: &SurfaceSteps<'_, D>, _densities: &StepDensities<D>) -> Option<OffContact<D>> {
        None
    }

    /// Nodes at which the balanced fields have had a contact of their own.
    fn isolated_contact_nodes(&self) -> usize {
        0
    }

    /// The largest energy that contact forces have given to the balanced fields, over the largest of the simulation.
    fn auxiliary_contact_energy(&self) -> f64 {
        0.0
    }

    /// The part of the contact law that such densities miss, for the motion in the tracks.
    fn normal_misfit(&self, _pressures: &FacePressures<D>, _tracks: &[ContactMotion]) -> NormalMisfit {
        NormalMisfit::default()
    }

    /// The weight of the work of normal forces that such densities miss.
    fn weight_of_work(&self) -> f64 {
        1.0
    }

    /// The friction part of η on each candidate face (J), up to the middle and the end of the step from `now` to
    /// `next`; `length` is that of the step (s), `density` F_DA at its end.
    fn friction(
        &self,
        problem: &Problem<D>,
        length: f64,
        now: &ForcesKnown<D>,
        next: &MotionKnown<D>,
        density: &Densities<D>,
    ) -> Vec<[f64; 2]> {
        friction::friction(problem, length, now, next, density)
    }

    /// The stress of narrow tractions; `None` if there are none.
    fn concentration(&self) -> Option<&Concentration<D>> {
        None
    }

    /// The differences of the simulation and the auxiliary solution by level; `None` without one.
    fn differences(&self) -> Option<&[Difference]> {
        None
    }

    /// Finds equilibrated tractions of levels with these forces, and gives `then` each part of the mesh when those of
    /// its elements are final. Returns the largest relative miss of the star problems. `levels` gives its memory.
    fn equilibrate(
        &self,
        equilibration: &Equilibration<'_, D, N>,
        _choice: Acceleration,
        forces: Vec<ForcesKnown<D>>,
        levels: &mut EquilibratedLevels<D>,
        then: Then<'_, D>,
    ) -> f64 {
        equilibration.solve(forces, levels, None, then)
    }
}

/// About how much memory the reconstruction takes (bytes) that the options name.
pub(crate) fn memory<const D: usize, const N: usize>(problem: &Problem<D>, options: &Options) -> usize {
    match options.reconstruction {
        Reconstruction::Published | Reconstruction::Consistent => 0,
        Reconstruction::Corrected => Corrected::<D, N>::memory(problem, options),
    }
}

/// The reconstruction that the options name.
pub(crate) fn new<'p, const D: usize, const N: usize>(
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    options: &Options,
) -> Box<dyn ReconstructionMethod<D, N> + 'p> {
    match options.reconstruction {
        Reconstruction::Published => Box::new(Published::new(problem)),
        Reconstruction::Consistent => Box::new(Consistent::new(problem)),
        Reconstruction::Corrected => Box::new(Corrected::new(problem, times, options)),
    }
}

#[cfg(test)]
mod tests;
