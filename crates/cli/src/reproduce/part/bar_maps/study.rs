//! Impacts of a bar over number of elements, step and gap: the estimate beside the true error.

use percute_core::dynamics::simulate;
use percute_core::history::{SinkError, Step, StepSink};
use percute_core::material::Elastic;
use percute_core::mesh::BarMesh;
use percute_core::observer::Observer;
use percute_core::obstacle::Plane;
use percute_core::problem::{BarProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Recorder, bar_impact_error};
use percute_estimator::{Acceleration, ContactForce, ErrorMeasures, Estimator, Options};
use percute_exact::BarImpact;

/// The bar of the paper's §7.1.4, but for the gap, which the paper does not tell.
pub(crate) const BAR: BarImpact =
    BarImpact { length: 0.1, young: 70e9, density: 2700.0, section: 0.02, speed: 400.0, gap: 0.0 };
/// A run ends this many times L/c after the impact: contact lasts 2, the rest is rebound.
pub(crate) const AFTER_IMPACT: f64 = 2.5;

pub(crate) type Failure = Box<dyn std::error::Error + Send + Sync>;

/// One run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setting {
    /// Number of elements N_s.
    pub(crate) elements: usize,
    /// α = Δt/Δt_c.
    pub(crate) ratio: f64,
    /// Gap in steps, gap/(v₀Δt): a whole number and the fraction of a step at which the impact falls.
    pub(crate) gap: f64,
    /// T − t_c in L/c.
    pub(crate) after_impact: f64,
}

/// A reading of the contact force with a choice of Γ_DA.
pub(crate) type Choice = (ContactForce, Acceleration);

/// All of them, reading by reading.
pub(crate) fn choices() -> Vec<Choice> {
    ContactForce::ALL
        .iter()
        .flat_map(|&reading| Acceleration::ALL.iter().map(move |&option| (reading, option)))
        .collect()
}

/// What a run gave.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Outcome {
    /// Sup and mean of the true error over time (J^½), eq. \[60\].
    pub(crate) exact: [f64; 2],
    /// The estimates, in the order of the choices.
    pub(crate) estimates: Vec<ErrorMeasures>,
}

impl Outcome {
    /// e_RdC/e_Ex, sup and mean, of a choice.
    pub(crate) fn effectivity(&self, choice: usize) -> [f64; 2] {
        let error = &self.estimates[choice];
        [error.sup / self.exact[0], error.mean / self.exact[1]]
    }
}

/// Several estimates beside one run.
struct Estimators<'p>(Vec<Estimator<'p, 1, 2>>);

impl StepSink<1> for Estimators<'_> {
    fn push(&mut self, step: &Step<'_, 1>) -> Result<(), SinkError> {
        self.0.iter_mut().try_for_each(|estimator| estimator.push(step))
    }
}

impl Setting {
    fn exact(&self) -> BarImpact {
        BarImpact { gap: self.gap * self.step() * BAR.speed, ..BAR }
    }

    /// Δt (s); on the uniform bar Δt_c is h/c exactly, eq. \[33\].
    fn step(&self) -> f64 {
        self.ratio * BAR.length / self.elements as f64 / BAR.wave_speed()
    }

    fn problem(&self) -> Result<BarProblem, Failure> {
        Ok(Problem::builder(BarMesh::uniform_bar(BAR.length, self.elements)?)
            .material(Elastic::bar(BAR.young, BAR.density, BAR.section)?)
            .initial_velocity(Initial::Uniform([-BAR.speed]))
            .obstacle(Plane::new([-self.exact().gap], [1.0], 0.0, None)?)
            .build()?)
    }

    /// Simulates, estimates with each choice on the thread that calls, and compares.
    pub(crate) fn run(&self, choices: &[Choice], observer: &mut dyn Observer) -> Result<Outcome, Failure> {
        let (problem, exact) = (self.problem()?, self.exact());
        let end = exact.impact_time() + self.after_impact * BAR.length / BAR.wave_speed();
        let count = (end / self.step() - 1e-6).ceil();
        let times = TimeGrid::uniform(count * self.step(), count as usize)?;
        let estimator = |&(contact_force, acceleration): &Choice| {
            let options = Options { contact_force, acceleration, threads: Some(1), ..Options::default() };
            Estimator::new(&problem, &times, options)
        };
        let estimators = Estimators(choices.iter().map(estimator).collect::<Result<_, _>>()?);
        let mut sink = (Recorder::new(&problem, &times), estimators);
        simulate(&problem, &times, &mut sink, observer)?;
        let (recorder, estimators) = sink;
        let truth = bar_impact_error(&problem, &recorder.finish(), &exact)?;
        let estimates = estimators.0.into_iter().map(|e| Ok(e.finish()?.error)).collect::<Result<_, Failure>>()?;
        Ok(Outcome { exact: [truth.sup, truth.mean], estimates })
    }
}
