//! Half of a symmetric model.

use super::setup::{HEIGHT, steps};
use crate::run::{aluminium, largest, run};
use percute_core::contact::Interface;
use percute_core::load::{Support, Table};
use percute_core::mesh::TriangleMesh;
use percute_core::problem::{Initial, TriangleProblem};
use percute_testkit::{doubled, translated};

/// The right halves of a roof of which the ridge points down, by an angle (°), and of a plate.
fn halves(angle: f64, cells: [usize; 2]) -> [TriangleMesh; 2] {
    let half = |width: f64, cells: usize| TriangleMesh::rectangle(width, HEIGHT, cells, 4).unwrap();
    let slope = angle.to_radians().tan();
    let roof = half(0.02, cells[0]).mapped(|p| [p[0], p[1] + slope * p[0]]).unwrap();
    [translated(&roof, [0.0, HEIGHT + 2e-5]).unwrap(), half(0.03, cells[1])]
}

/// The far sides of the roof may be driven together, up to a speed (m/s) within 5 µs.
fn problem([roof, plate]: &[TriangleMesh; 2], is_half: bool, driven: f64) -> TriangleProblem {
    let mesh = TriangleMesh::joined(&[("roof", roof), ("plate", plate)]).unwrap();
    let velocity = |node: usize| [0.0, if node < roof.node_count() { -20.0 } else { 0.0 }];
    let velocity = Initial::Nodal((0..mesh.node_count()).map(velocity).collect());
    let mut builder = TriangleProblem::builder(mesh)
        .material(aluminium())
        .initial_velocity(velocity)
        .interface(Interface::sliding::<2>("roof.bottom", "plate.top", 0.2).unwrap());
    for group in ["roof.left", "plate.left"].into_iter().filter(|_| is_half) {
        builder = builder.support(Support { group: group.to_string(), components: [true, false], velocity: None });
    }
    let far = if is_half { ["roof.right"].as_slice() } else { &["roof.right", "roof.left"] };
    for (group, sign) in far.iter().zip([-1.0, 1.0]).filter(|_| driven != 0.0) {
        let speeds = [0.0, 1.0, 1.0].map(|part| [sign * part * driven, 0.0]);
        let velocity = Some(Table::new(vec![0.0, 5e-6, 1.0], speeds.to_vec()).unwrap());
        builder = builder.support(Support { group: group.to_string(), components: [true, false], velocity });
    }
    builder.build().unwrap()
}

/// Both bodies widen by Poisson's ratio, each in its own way. Half of the model, held at its middle, moves as the whole
/// one.
#[test]
fn half_of_a_symmetric_model_moves_as_the_whole() {
    for (angle, cells, driven) in [(0.0, [5, 7], 0.0), (3.0, [5, 7], 0.0), (10.0, [6, 5], 0.0), (10.0, [5, 7], 20.0)] {
        let halves = halves(angle, cells);
        let whole = [0, 1].map(|k| doubled(&halves[k]).unwrap());
        let [whole_problem, half_problem] = [problem(&whole, false, driven), problem(&halves, true, driven)];
        let times = steps(&whole_problem, 20e-6);
        let [whole_run, half_run] = [run(&whole_problem, &times), run(&half_problem, &times)];
        // The numbers of each half come first in each body.
        let roof = halves[0].node_count();
        let number = |node: usize| if node < roof { node } else { node - roof + whole[0].node_count() };
        for n in 0..=whole_run.last() {
            let [expected, found] = [whole_run.displacement(n), half_run.displacement(n)];
            let apart = found.iter().enumerate().map(|(node, u)| {
                let expected = expected[number(node)];
                (u[0] - expected[0]).abs().max((u[1] - expected[1]).abs())
            });
            // Rounding that slipping and sticking nodes let grow.
            let apart = apart.fold(0.0, f64::max);
            assert!(apart <= 1e-11 * largest(expected), "{angle}°, step {n}: {apart}");
        }
        let contact = half_run.simulation.balance.work_of_contact;
        assert!(contact.abs() > 0.0, "{contact}");
    }
}
