//! Surfaces of which one ends on an edge of the other one.

use super::setup::{Blocks, HEIGHT, steel};
use crate::solution::run::run;
use percute_core::dynamics::critical_time_step;
use percute_core::material::Elastic;
use percute_core::time::TimeGrid;

/// The end of a stiff block slides from edge to edge of a soft one. Contact without friction gives no energy but 1.2 to
/// 1.8 % of that of the approach, with short steps as well: there were 7, 65 and 660 % where the number of conditions
/// on an edge changed when half of it was covered.
#[test]
fn an_end_that_slides_over_edges_gives_no_energy() {
    let speed = 20.0;
    let plastic = Elastic::plane_stress(3e9, 0.35, 1200.0, 1.0).unwrap();
    let blocks = Blocks {
        cells: [[10, 5], [13, 5]],
        aside: -0.02,
        materials: [steel(), plastic],
        velocities: [[100.0, -speed], [0.0; 2]],
        friction: 0.0,
        ..Blocks::oblique()
    };
    let problem = blocks.problem();
    let approach = 0.5 * 7800.0 * 0.04 * HEIGHT * speed * speed;
    for part in [0.9, 0.3, 0.1] {
        let times = TimeGrid::with_step(60e-6, part * critical_time_step(&problem)).unwrap();
        let work = run(&problem, &times).simulation.balance.work_of_contact;
        assert!(work.abs() < 2e-2 * approach, "steps of {part}: {work} of {approach} J");
    }
}
