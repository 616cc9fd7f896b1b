//! Impacts of a bar over number of elements, step and gap: the estimate beside the true error.

use crate::reproduce::ReproduceError;
use percute_core::dynamics::simulate;
use percute_core::material::Elastic;
use percute_core::mesh::BarMesh;
use percute_core::observer::Observer;
use percute_core::obstacle::Plane;
use percute_core::problem::{BarProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Recorder, bar_impact_error};
use percute_estimator::{Acceleration, ErrorMeasures, Estimator, Options, Reconstruction};
use percute_exact::BarImpact;

/// The bar of the paper's §7.1.4, but for the gap, which the paper does not tell.
pub(super) const BAR: BarImpact =
    BarImpact { length: 0.1, young: 70e9, density: 2700.0, section: 0.02, speed: 400.0, gap: 0.0 };
/// Whole steps of flight before the one in which the impact falls: nearer, runs with an early impact are refused.
pub(super) const WHOLE: f64 = 1.0;

/// One run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Setting {
    /// Number of elements N_s.
    pub(in super::super) elements: usize,
    /// α = Δt/Δt_c.
    pub(in super::super) ratio: f64,
    /// The fraction of a step at which the impact falls: the gap is 1 + this times v₀Δt.
    pub(in super::super) fraction: f64,
    /// (T − t_c)/(L/c), rounded up to whole steps. Contact lasts 2.
    pub(in super::super) after_impact: f64,
}

/// A reading of the contact force with a choice of Γ_DA.
pub(super) type Choice = (Reconstruction, Acceleration);

/// All of them, reading by reading.
pub(super) fn choices() -> Vec<Choice> {
    Reconstruction::ALL
        .iter()
        .flat_map(|&reading| Acceleration::ALL.iter().map(move |&option| (reading, option)))
        .collect()
}

/// What a run gave.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct Outcome {
    /// Sup and mean of the true error over time (J^½), eq. \[60\].
    pub(super) exact: [f64; 2],
    /// The estimates, in the order of the choices.
    pub(super) estimates: Vec<ErrorMeasures>,
}

impl Outcome {
    /// e_RdC/e_Ex, sup and mean, of a choice.
    pub(in super::super) fn effectivity(&self, choice: usize) -> [f64; 2] {
        let error = &self.estimates[choice];
        [error.sup / self.exact[0], error.mean / self.exact[1]]
    }
}

impl Setting {
    fn exact(&self) -> BarImpact {
        BarImpact { gap: (WHOLE + self.fraction) * self.step() * BAR.speed, ..BAR }
    }

    /// Δt (s); on the uniform bar Δt_c is h/c exactly, eq. \[33\].
    fn step(&self) -> f64 {
        self.ratio * BAR.length / self.elements as f64 / BAR.wave_speed()
    }

    fn problem(&self) -> Result<BarProblem, ReproduceError> {
        Ok(Problem::builder(BarMesh::uniform_bar(BAR.length, self.elements)?)
            .material(Elastic::bar(BAR.young, BAR.density, BAR.section)?)
            .initial_velocity(Initial::Uniform([-BAR.speed]))
            .obstacle(Plane::new([-self.exact().gap], [1.0], 0.0, None)?)
            .build()?)
    }

    /// Simulates, estimates with each choice on the thread that calls, and compares.
    pub(super) fn run(&self, choices: &[Choice], observer: &mut dyn Observer) -> Result<Outcome, ReproduceError> {
        let options = |&(reconstruction, acceleration): &Choice| Options {
            reconstruction,
            acceleration,
            threads: Some(1),
            ..Options::default()
        };
        self.run_with(&choices.iter().map(options).collect::<Vec<_>>(), observer)
    }

    /// The same with options of any kind.
    pub(in super::super) fn run_with(
        &self,
        options: &[Options],
        observer: &mut dyn Observer,
    ) -> Result<Outcome, ReproduceError> {
        let (problem, exact) = (self.problem()?, self.exact());
        let after = self.after_impact * self.elements as f64 / self.ratio;
        // Where a whole number of steps is due, rounding must not add one.
        let count = (WHOLE + self.fraction + after - 1e-6).ceil();
        let times = TimeGrid::uniform(count * self.step(), count as usize)?;
        let estimator = |options: &Options| Estimator::new(&problem, &times, *options);
        let estimators = options.iter().map(estimator).collect::<Result<Vec<_>, _>>()?;
        let mut sink = (Recorder::new(&problem, &times), estimators);
        simulate(&problem, &times, &mut sink, observer)?;
        let (recorder, estimators) = sink;
        let truth = bar_impact_error(&problem, &recorder.finish(), &exact)?;
        let estimates = estimators.into_iter().map(|e| Ok(e.finish()?.error)).collect::<Result<_, ReproduceError>>()?;
        Ok(Outcome { exact: [truth.sup, truth.mean], estimates })
    }
}
