//! A block that strikes a plate with a corner.

use super::setup::steps;
use crate::solution::run::{aluminium, run};
use percute_core::border::{cut, vectors};
use percute_core::contact_results::ContactRecorder;
use percute_core::history::StepSource;
use percute_core::mesh::Mesh;
use percute_core::problem::{Between, Contact, Initial, Problem};

/// A block of 6 × 6 cells that is turned by an angle (degrees), 20 µm above a plate of 9 × 5.
fn tilted(degrees: f64, speed: f64) -> Problem<2> {
    let plate = Mesh::rectangle(0.04, 0.02, 9, 5).unwrap();
    let turned = Mesh::rectangle(0.02, 0.02, 6, 6).unwrap().placed(&[0.0; 2], degrees).unwrap();
    let low = turned.points_in::<2>().iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
    let block = turned.placed(&[0.012, 0.020_02 - low], 0.0).unwrap();
    let velocity = [vec![[0.0; 2]; plate.node_count()], vec![[0.0, -speed]; block.node_count()]].concat();
    Problem::<2>::builder(Mesh::joined(&[("plate", &plate), ("block", &block)]).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Nodal(velocity))
        .automatic_contact()
        .contact(Contact::new(2, Between::All, 0.0, None).unwrap())
        .build()
        .unwrap()
}

/// Forces without friction stand on the face along which the corner slides: they give no energy, and do not push the
/// bodies apart along the plate.
#[test]
fn a_corner_that_slides_gains_no_energy() {
    for degrees in [3.0, 10.0, -10.0, 30.0] {
        let problem = tilted(degrees, 20.0);
        let normal = problem.surface().non_matching()[0].frame().normal();
        let run = run(&problem, &steps(&problem, 60e-6));
        let balance = &run.simulation.balance;
        let gained = balance.work_of_contact / balance.initial;
        println!("{degrees}°: contact work {gained:.4} of the initial energy");
        assert!(gained < 0.005, "{degrees}°: {gained}");
        assert!(normal[0].abs() < 1e-12, "{degrees}°: {normal:?}");
    }
}

/// Forces of the multipliers have both signs: nodes beside the contact are pulled. The normal forces on both sides have
/// the same sum all the same.
#[test]
fn both_sides_have_the_same_normal_force() {
    let problem = tilted(28.0, 200.0);
    let run = run(&problem, &steps(&problem, 20e-6));
    let results = ContactRecorder::new(&problem, run.history.times()).keeping_steps().unwrap().replay(&run.history);
    let results = results.unwrap();
    let normals = [0, 1].map(|side| *problem.obstacles()[side].flat_frame().normal());
    let across = |side: usize, force: &[f64; 2]| force[0] * normals[side][0] + force[1] * normals[side][1];
    let (mut peak, mut pulled) = (0.0_f64, 0.0_f64);
    for n in 0..results.instants.len() {
        let sides = [0, 1].map(|side| results.obstacles[side][n]);
        let size = sides[0].normal_force;
        peak = peak.max(size);
        for (k, side) in sides.iter().enumerate() {
            // Sums of some ten forces.
            let apart = [side.normal_force - size, side.normal_force - across(k, &cut(&side.force))];
            assert!(apart.iter().all(|apart| apart.abs() <= 1e-12 * size.abs()), "step {n}: {apart:?}");
        }
        let count = problem.surface().nodes().len();
        let forces = vectors(&results.steps.as_ref().unwrap().force);
        for (at, force) in forces[n * count..][..count].iter().enumerate() {
            pulled = pulled.min(across(problem.surface().nodes()[at].obstacle, force));
        }
    }
    assert!(peak > 0.0 && pulled < -0.02 * peak, "{pulled} of {peak}");
}
