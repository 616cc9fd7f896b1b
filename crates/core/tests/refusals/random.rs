//! Contact that is found between bodies at random places is refused only for what is true of them.

use crate::found::{Body, problem};
use percute_core::mesh::Mesh;
use percute_core::problem::Cause;
use percute_testkit::Random;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Whether bodies neither touch nor overlap.
fn apart(bodies: &[Body<'_>], one: &Mesh) -> bool {
    let mut all: Vec<(&str, &Mesh)> = bodies.iter().map(|(name, mesh, _)| (*name, mesh)).collect();
    all.push(("one", one));
    Mesh::joined(&all).is_ok_and(|mesh| mesh.touching_elements().is_empty())
}

/// A disc or a block around the origin: upright with sides of whole half centimetres, or turned.
fn shape(random: &mut Random, upright: bool) -> Mesh {
    if random.between(0.0, 1.0) < 0.2 {
        let mesh = Mesh::disc(random.between(0.004, 0.02), 2 + (random.bits() % 4) as usize).unwrap();
        return mesh.placed(&[0.0; 2], random.between(0.0, 60.0)).unwrap();
    }
    let size = [0, 1].map(|_| random.between(0.005, 0.05));
    let [width, height] = if upright { size.map(|s| (s * 200.0).ceil() / 200.0) } else { size };
    let [nx, ny] = [0, 1].map(|_| 1 + (random.bits() % 7) as usize);
    let mesh = Mesh::rectangle(width, height, nx, ny).unwrap();
    let centred = mesh.placed(&[-0.5 * width, -0.5 * height], 0.0).unwrap();
    centred.placed(&[0.0; 2], if upright { 0.0 } else { random.between(0.0, 360.0) }).unwrap()
}

/// Bodies that come one after another from any direction until they are close to the ones before, and a gap back. Some
/// move on, in about that direction, some pass and some rest.
fn bodies(random: &mut Random, count: usize) -> Vec<Body<'static>> {
    let mut bodies: Vec<Body<'static>> = Vec::new();
    let upright = random.between(0.0, 1.0) < 0.4;
    while bodies.len() < count {
        let mesh = shape(random, upright);
        let mut way = random.between(0.0, TAU);
        let mut aside = random.between(-0.03, 0.03);
        if upright {
            way = (way / FRAC_PI_2).round() * FRAC_PI_2;
            aside = (aside * 200.0).round() / 200.0;
        }
        let (sin, cos) = way.sin_cos();
        let at = |s: f64| mesh.placed(&[s * cos - aside * sin, s * sin + aside * cos], 0.0).unwrap();
        let (mut low, mut high) = (0.0, if bodies.is_empty() { 0.0 } else { 0.3 });
        while high - low > 1e-8 {
            let middle = 0.5 * (low + high);
            if apart(&bodies, &at(middle)) { high = middle } else { low = middle }
        }
        let gap = if bodies.is_empty() { 0.0 } else { 10.0_f64.powf(random.between(-5.0, -1.7)) };
        let speed = if random.between(0.0, 1.0) < 0.3 { 0.0 } else { random.between(0.0, 100.0) };
        let turn = way + random.between(-1.2, 1.2) * if random.between(0.0, 1.0) < 0.3 { 3.0 } else { 1.0 };
        let placed = at(high + gap);
        if bodies.is_empty() || apart(&bodies, &placed) {
            let name = ["a", "b", "c"][bodies.len()];
            bodies.push((name, placed, [-speed * turn.cos(), -speed * turn.sin()]));
        }
    }
    bodies
}

/// How many of so many random cases are refused because bodies are too near, a node could touch two bodies, or surfaces
/// are behind each other; and the messages of all that are refused otherwise.
fn refused(cases: u64, count: usize) -> ([usize; 3], Vec<String>) {
    let (mut refused, mut others) = ([0; 3], Vec::new());
    for seed in 0..cases {
        let Err(error) = problem(&bodies(&mut Random::new(seed), count)).build() else { continue };
        match error.cause {
            Cause::TooNear { .. } => refused[0] += 1,
            Cause::Contested { .. } => refused[1] += 1,
            Cause::BehindSurface { .. } => refused[2] += 1,
            cause => others.push(format!("case {seed} of {count} bodies: {cause}")),
        }
    }
    (refused, others)
}

/// Of these bodies none is inside another one, and all edges are found: only curves with long edges may be too near.
#[test]
fn two_bodies_are_not_refused_falsely() {
    let ([near, contested, behind], others) = refused(600, 2);
    assert_eq!((contested, others), (0, Vec::new()));
    assert!(near <= 30 && behind <= 1, "{near} {behind}");
}

/// Edges that several pairs of bodies want are given to one, or to one interface of all.
#[test]
fn edges_of_three_bodies_are_proposed_to_one_interface_alone() {
    let ([near, contested, behind], others) = refused(600, 3);
    assert_eq!(others, Vec::<String>::new());
    assert!(near <= 60 && contested <= 60 && behind <= 1, "{near} {contested} {behind}");
}
