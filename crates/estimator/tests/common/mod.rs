//! Problems that several tests share.

pub(crate) mod beside;
pub(crate) mod corner;
pub(crate) mod finer;

use percute_core::contact::Obstacle;
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_exact::BarMode;

/// The block of §7.2 of the paper: aluminium, 50 × 40 mm, μ = 0.2, plane stress, v = (400, −400)
/// m/s, at `gap` (m) from a plane below it.
pub(crate) fn block(cells: [usize; 2], gap: f64) -> Problem<2> {
    Problem::<2>::builder(Mesh::rectangle(0.05, 0.04, cells[0], cells[1]).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Uniform([400.0, -400.0]))
        .obstacle(Obstacle::plane([0.0, -gap], [0.0, 1.0], 0.2, None).unwrap())
        .build()
        .unwrap()
}

/// A bar of equal elements let go from its mode, with these ends fixed.
pub(crate) fn bar_in_mode(mode: &BarMode, elements: usize, fixed: &[&str]) -> Problem<1> {
    let mesh = Mesh::uniform_bar(mode.length, elements).unwrap();
    let displacement = mesh.points_in::<1>().iter().map(|p| [mode.displacement(p[0], 0.0)]).collect();
    let mut builder = Problem::<1>::builder(mesh)
        .material(Elastic::bar(mode.young, mode.density, mode.section).unwrap())
        .initial_displacement(Initial::Nodal(displacement));
    for group in fixed {
        builder =
            builder.support(Support { group: group.to_string(), components: [true, false, false], velocity: None });
    }
    builder.build().unwrap()
}

/// The four meshes of the paper's table 1.
pub(crate) const MESHES: [[usize; 2]; 4] = [[5, 4], [10, 8], [20, 16], [40, 32]];

/// Asserts a ≈ b within a relative tolerance.
#[track_caller]
pub(crate) fn assert_close(value: f64, expected: f64, tolerance: f64, what: &str) {
    let miss = (value - expected).abs();
    assert!(
        miss <= tolerance * expected.abs(),
        "{what}: {value} instead of {expected}, off by {:.2e}",
        miss / expected
    );
}
