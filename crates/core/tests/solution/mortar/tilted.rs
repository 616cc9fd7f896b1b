//! A block that strikes a plate with a corner.

use super::setup::steps;
use crate::run::{aluminium, run};
use percute_core::mesh::TriangleMesh;
use percute_core::problem::{Between, Contact, Initial, TriangleProblem};

/// A block of 6 × 6 cells that is turned by an angle (degrees), 20 µm above a plate of 9 × 5.
fn tilted(degrees: f64, speed: f64) -> TriangleProblem {
    let plate = TriangleMesh::rectangle(0.04, 0.02, 9, 5).unwrap();
    let turned = TriangleMesh::rectangle(0.02, 0.02, 6, 6).unwrap().placed(&[0.0; 2], degrees).unwrap();
    let low = turned.points().iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
    let block = turned.placed(&[0.012, 0.020_02 - low], 0.0).unwrap();
    let velocity = [vec![[0.0; 2]; plate.node_count()], vec![[0.0, -speed]; block.node_count()]].concat();
    TriangleProblem::builder(TriangleMesh::joined(&[("plate", &plate), ("block", &block)]).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Nodal(velocity))
        .automatic_contact()
        .contact(Contact::new::<2>(Between::All, 0.0, None).unwrap())
        .build()
        .unwrap()
}

/// Forces without friction stand on the face along which the corner slides: they give no energy, and do not push the
/// bodies apart along the plate.
#[test]
fn a_corner_that_slides_gains_no_energy() {
    for degrees in [3.0, 10.0, -10.0, 30.0] {
        let problem = tilted(degrees, 20.0);
        let normal = problem.surface().sliding()[0].frame().normal();
        let run = run(&problem, &steps(&problem, 60e-6));
        let balance = &run.simulation.balance;
        let gained = balance.work_of_contact / balance.initial;
        println!("{degrees}°: contact work {gained:.4} of the initial energy");
        assert!(gained < 0.005, "{degrees}°: {gained}");
        assert!(normal[0].abs() < 1e-12, "{degrees}°: {normal:?}");
    }
}
