//! The contact patch test: surfaces of any nodes hand on a uniform pressure.

use super::setup::{Blocks, GAP, HEIGHT, steps};
use crate::solution::run::{difference, largest, run};
use percute_core::load::{Profile, Table, Traction};
use percute_core::material::{Elastic, Law};
use percute_core::problem::Initial;
use std::f64::consts::FRAC_PI_6;

const PRESSURE: f64 = 70e6;
const STEPS: f64 = 60.0;
/// Angles (rad), and gaps of the undeformed blocks (m).
const CASES: [(f64, f64); 3] = [(0.0, GAP), (FRAC_PI_6, GAP), (FRAC_PI_6, 0.0)];

/// Two blocks under a uniform pressure, from the displacement of its static state, turned by `angle` (rad): nothing
/// moves in 60 steps.
fn stays_at_rest(material: Elastic, strains: [f64; 2], angle: f64, gap: f64) {
    let blocks = Blocks { materials: [material; 2], velocities: [[0.0; 2]; 2], gap, ..Blocks::oblique() };
    let (sin, cos) = angle.sin_cos();
    let turned = |v: [f64; 2]| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
    let straight = blocks.mesh();
    let displacement: Vec<[f64; 2]> = straight
        .points_in::<2>()
        .iter()
        .map(|&[x, y]| {
            // The upper block has come down by the gap.
            let gap = if y > HEIGHT + 0.5 * GAP { gap } else { 0.0 };
            turned([strains[0] * x, strains[1] * (y - gap) - gap])
        })
        .collect();
    let pull = |group: &str, sign: f64| Traction {
        group: group.to_string(),
        value: Table::constant(turned([0.0, sign * PRESSURE])),
        profile: Profile::UNIFORM,
    };
    let problem = blocks
        .bodies(straight.mapped(|&x| turned(x)).unwrap(), turned)
        .interface(blocks.interface())
        .traction(pull("upper.top", -1.0))
        .traction(pull("lower.bottom", 1.0))
        .initial_displacement(Initial::Nodal(displacement.clone()))
        .build()
        .unwrap();
    let step = steps(&problem, 1e-5).step(0);
    let run = run(&problem, &steps(&problem, STEPS * step));
    let surface = problem.surface();
    let areas = surface.tributary_areas();
    for n in 0..=run.last() {
        let now = run.history.step(n).unwrap();
        // Rounding of K u, 60 times.
        assert!(difference(now.displacement(), &displacement) <= 1e-12 * largest(&displacement), "step {n}");
        assert!(now.touching.iter().all(|touches| *touches), "step {n}");
        for (at, force) in now.reaction().iter().enumerate() {
            let frame = surface.obstacles()[surface.nodes()[at].obstacle].flat_frame();
            let (normal, along) = frame.split(force);
            let expected = PRESSURE * areas[at];
            assert!((normal - expected).abs() <= 1e-10 * expected, "step {n}, {at}: {normal} {expected}");
            assert!(along[0].hypot(along[1]) <= 1e-10 * expected, "step {n}, {at}: {along:?}");
        }
    }
}

#[test]
fn a_uniform_pressure_passes_in_plane_stress() {
    let (young, poisson) = (70e9, 0.3);
    let strain = PRESSURE / young;
    for (angle, gap) in CASES {
        let material = Elastic::plane_stress(young, poisson, 2700.0, 1.0).unwrap();
        stays_at_rest(material, [poisson * strain, -strain], angle, gap);
    }
}

#[test]
fn a_uniform_pressure_passes_in_plane_strain() {
    let (young, poisson) = (70e9, 0.3);
    let strain = PRESSURE / young;
    let material = Elastic::plane_strain(young, poisson, 2700.0, 0.5).unwrap();
    assert_eq!(material.extent(), 0.5);
    for (angle, gap) in CASES {
        stays_at_rest(material, [poisson * (1.0 + poisson) * strain, -(1.0 - poisson * poisson) * strain], angle, gap);
    }
}
