//! A run that goes on from a checkpoint gives the bits of one that was not interrupted.

use crate::solution::run::aluminium;
use percute_core::contact::Obstacle;
use percute_core::dynamics::{Simulation, replay, resume, simulate};
use percute_core::history::{Checkpoint, History, SinkError, State, StateSink, Step, StepSource};
use percute_core::load::{BodyForce, Support, Table};
use percute_core::material::Hardening;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;

/// Steps of the runs below.
const STEPS: usize = 60;

/// Number, displacement, reaction and touching status of a step.
type KeptStep = (usize, Vec<f64>, Vec<f64>, Vec<bool>);

/// Keeps each step as it comes, and the checkpoint of each.
#[derive(Default)]
struct Kept {
    steps: Vec<KeptStep>,
    checkpoints: Vec<Checkpoint>,
}

impl StateSink for Kept {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let step = state.step();
        self.steps.push((step.index, step.displacement.to_vec(), step.reaction.to_vec(), step.touching.to_vec()));
        self.checkpoints.push(state.checkpoint().ok_or("the integrator has the sums of the balance")?);
        Ok(())
    }
}

fn goes_on_from_every_step<const D: usize>(problem: &Problem<D>, times: &TimeGrid) {
    let mut whole = Kept::default();
    let all: Simulation = simulate(problem, times, &mut whole, &mut Unobserved).unwrap();
    assert!(whole.steps.iter().any(|(_, _, reaction, _)| reaction.iter().any(|r| *r != 0.0)), "no contact");
    for checkpoint in &whole.checkpoints {
        let (mut rest, after) = (Kept::default(), checkpoint.step + 1);
        let done = resume(problem, times, None, checkpoint, &mut rest, &mut Unobserved).unwrap();
        assert!(rest.steps[..] == whole.steps[after..], "steps from {after} on");
        assert!(rest.checkpoints[..] == whole.checkpoints[after..], "checkpoints from {after} on");
        assert_eq!(done.balance_over_time[..], all.balance_over_time[after..], "from {after} on");
        assert_eq!((done.balance, done.steps, done.interrupted), (all.balance, STEPS, false), "from {after} on");
    }
}

/// Friction, moving supports, body forces and steps of different lengths.
#[test]
fn a_block_goes_on_from_every_step() {
    let mesh = Mesh::rectangle(0.03, 0.02, 6, 4).unwrap();
    let step = 4e-7;
    let problem = Problem::<2>::builder(mesh)
        .material(aluminium())
        .initial_velocity(Initial::Uniform([60.0, -400.0]))
        .support(Support {
            group: "top".into(),
            components: [false, true, false],
            velocity: Some(Table::new(vec![0.0, 40.0 * step], vec![[0.0, -400.0], [0.0, 300.0]]).unwrap()),
        })
        .body_force(BodyForce { group: None, value: Table::constant([1e9, -9.81]) })
        .obstacle(Obstacle::plane([0.0, -10_000.0 * step * 0.5], [0.0, 1.0], 0.3, None).unwrap())
        .build()
        .unwrap();
    let instants = (0..=STEPS).map(|n| step * (n as f64 + if n > 20 { 0.1 * (n - 20) as f64 } else { 0.0 })).collect();
    goes_on_from_every_step(&problem, &TimeGrid::from_instants(instants).unwrap());
}

#[test]
fn a_bar_goes_on_from_every_step() {
    let step = 1.6e-6;
    let problem = Problem::<1>::builder(Mesh::uniform_bar(0.1, 10).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform([-5.0]))
        .obstacle(Obstacle::plane([-5.0 * 6.4 * step], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap();
    goes_on_from_every_step(&problem, &TimeGrid::uniform(STEPS as f64 * step, STEPS).unwrap());
}

/// The steps of a history have no sums of the balance.
#[test]
fn a_replayed_step_is_no_checkpoint() {
    struct Without;
    impl StateSink for Without {
        fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
            assert!(state.checkpoint().is_none());
            Ok(())
        }
    }
    let problem = Problem::<1>::builder(Mesh::uniform_bar(0.1, 4).unwrap()).material(aluminium()).build().unwrap();
    let times = TimeGrid::uniform(1e-5, 10).unwrap();
    let mut history = History::new(&times);
    simulate(&problem, &times, &mut history, &mut Unobserved).unwrap();
    replay(&problem, &history, &mut Without).unwrap();
}

/// Two blocks that slide along each other: D and M follow from the fields alone.
#[test]
fn blocks_that_slide_go_on_from_every_step() {
    let problem =
        crate::solution::mortar::setup::Blocks { aside: 0.003, ..crate::solution::mortar::setup::Blocks::oblique() }
            .problem();
    let step = 0.9 * percute_core::dynamics::critical_time_step(&problem);
    goes_on_from_every_step(&problem, &TimeGrid::uniform(STEPS as f64 * step, STEPS).unwrap());
}

/// Internal variables are part of a checkpoint: the flow goes on where it was.
#[test]
fn a_block_that_yields_goes_on_from_every_step() {
    let hardening = Hardening::of_tangent(70e9, 3e9, 0.5).unwrap();
    let law = aluminium().with_yield_stress(200e6).unwrap().with_hardening(hardening).unwrap();
    let step = 4e-7;
    let problem = Problem::<2>::builder(Mesh::rectangle(0.03, 0.02, 6, 4).unwrap())
        .material(law)
        .initial_velocity(Initial::Uniform([20.0, -100.0]))
        .obstacle(Obstacle::plane([0.0, -50.0 * step], [0.0, 1.0], 0.3, None).unwrap())
        .build()
        .unwrap();
    let times = TimeGrid::uniform(STEPS as f64 * step, STEPS).unwrap();
    goes_on_from_every_step(&problem, &times);
    // A replay integrates the same internal variables, with or without those of the steps.
    let mut history = History::new(&times);
    simulate(&problem, &times, &mut history, &mut Unobserved).unwrap();
    let mut again = InternalVariables::default();
    let bare = WithoutInternal(&history);
    replay(&problem, &bare, &mut again).unwrap();
    assert!(again.0 == history.internal() && again.0.iter().any(|x| *x != 0.0));
}

/// Keeps internal variables.
#[derive(Default)]
struct InternalVariables(Vec<f64>);

impl StateSink for InternalVariables {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.0.extend_from_slice(state.step().internal);
        Ok(())
    }
}

/// A history without internal variables.
struct WithoutInternal<'h>(&'h History);

impl StepSource for WithoutInternal<'_> {
    fn times(&self) -> &TimeGrid {
        self.0.times()
    }

    fn count(&self) -> usize {
        self.0.count()
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        self.0.replay(&mut |step| take(&Step { internal: &[], ..*step }))
    }
}
