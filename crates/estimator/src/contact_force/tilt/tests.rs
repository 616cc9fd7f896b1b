use super::Tilt;
use crate::contact_force::{Reading, nodal_forces};
use crate::options::ContactForce;
use percute_core::material::Elastic;
use percute_core::mesh::TriangleMesh;
use percute_core::obstacle::Plane;
use percute_core::problem::{Problem, TriangleProblem};
use percute_testkit::Random;

/// Two blocks beside each other, with edges of unequal lengths, on a plane turned by an angle (rad); μ = 0.4.
fn blocks(angle: f64) -> TriangleProblem {
    let (sin, cos) = angle.sin_cos();
    let turn = |p: [f64; 2]| [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]];
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    for start in [0.0, 7.0] {
        let first = points.len();
        for x in [0.0, 0.5, 2.0, 2.8, 4.5] {
            points.extend([[start + x, 0.0], [start + x, 1.0]].map(turn));
        }
        for a in (first..first + 8).step_by(2) {
            cells.extend([[a, a + 2, a + 1], [a + 2, a + 3, a + 1]]);
        }
    }
    let mesh = TriangleMesh::new(points, &cells, &Default::default(), &Default::default()).unwrap();
    let plane = Plane::new(turn([0.0, -1e-3]), turn([0.0, 1.0]), 0.4, None).unwrap();
    Problem::builder(mesh).material(Elastic::plane_stress(1.0, 0.3, 1.0, 1.0).unwrap()).obstacle(plane).build().unwrap()
}

/// Resultant and moment of nodal forces on each of the two blocks; the five nodes of one follow each other.
fn balance(problem: &TriangleProblem, forces: &[[f64; 2]]) -> [[f64; 3]; 2] {
    let mut sums = [[0.0; 3]; 2];
    for (contact, f) in problem.surface().nodes().iter().zip(forces) {
        let node = contact.node.index();
        let [x, y] = problem.mesh().points()[node];
        let sum = &mut sums[node / 10];
        (sum[0], sum[1], sum[2]) = (sum[0] + f[0], sum[1] + f[1], sum[2] + x * f[1] - y * f[0]);
    }
    sums
}

/// The nodal forces that `whole` makes of reactions.
fn made(problem: &TriangleProblem, reaction: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let Reading::Whole(whole) = Reading::new(ContactForce::Whole, problem) else { panic!("another reading") };
    nodal_forces(problem, &whole.densities(problem, reaction))
}

/// Reactions in the cone, between 1 and `range` in the direction of the normal.
fn reactions(problem: &TriangleProblem, random: &mut Random, range: f64) -> Vec<[f64; 2]> {
    let normal = *problem.obstacles()[0].normal();
    let one = |_| {
        let (n, t) = (random.between(1.0, range), random.between(-0.4, 0.4));
        [n * (normal[0] - t * normal[1]), n * (normal[1] + t * normal[0])]
    };
    problem.surface().nodes().iter().map(one).collect()
}

/// Each block gets the resultant and the moment of its own reactions, whatever the angle.
#[test]
fn resultant_and_moment_are_those_of_the_reactions() {
    for seed in 0..20_u32 {
        let problem = blocks(0.3 * f64::from(seed));
        let reaction = reactions(&problem, &mut Random::new(seed.into()), 1.5);
        let (given, found) = (balance(&problem, &reaction), balance(&problem, &made(&problem, &reaction)));
        for (given, found) in given.iter().zip(&found) {
            // Rounding of sums of five terms of up to 1.5·12.
            assert!(given.iter().zip(found).all(|(a, b)| (a - b).abs() < 1e-12), "{seed}: {found:?} for {given:?}");
        }
    }
}

/// Where all is carried by the end of a block, the density cannot act there: the resultant stays, the force stays in
/// the cone, and what is missing of the moment is less than without the tilt.
#[test]
fn what_cannot_be_had_is_had_in_part() {
    let problem = blocks(0.0);
    let mut reaction = vec![[0.0, 0.0]; 10];
    let left = problem.surface().nodes().iter().position(|c| c.node.index() == 0).unwrap();
    let beside = problem.surface().nodes().iter().position(|c| c.node.index() == 2).unwrap();
    (reaction[left], reaction[beside]) = ([0.3, 1.0], [0.0, 0.1]);
    let Reading::Whole(whole) = Reading::new(ContactForce::Whole, &problem) else { panic!("another reading") };
    let densities = whole.densities(&problem, &reaction);
    assert!(densities.iter().flatten().all(|f| f[1] >= 0.0 && f[0].abs() <= 0.4 * f[1] + 1e-15));
    let [found, other] = balance(&problem, &nodal_forces(&problem, &densities));
    let [given, _] = balance(&problem, &reaction);
    assert_eq!(other, [0.0; 3]);
    assert!((0..2).all(|c| (found[c] - given[c]).abs() < 1e-15), "{found:?} for {given:?}");
    // Without the tilt the first node's part acts at a third of its edge of 0.5 m, the second's at (0.5·⅓·… + 1.5·⅙…)/ℓ.
    let centroid = (0.5 / 6.0 * (2.0 * 0.5) + 1.5 / 6.0 * (2.0 * 0.5 + 2.0)) / 1.0;
    let untilted = 1.0 * 0.5 / 3.0 + 0.1 * centroid - given[2];
    assert!(found[2] - given[2] > 0.0 && found[2] - given[2] < untilted, "{} of {untilted}", found[2] - given[2]);
}

/// One node alone has one density, and nothing is done to it.
#[test]
fn a_node_alone_is_left_as_it_is() {
    let problem = blocks(0.2);
    for k in 0..10 {
        let mut reaction = vec![[0.0; 2]; 10];
        reaction[k] = problem.obstacles()[0].normal().map(|n| 2.0 * n);
        assert!(Tilt::new(&problem).factors(&reaction).iter().all(|f| *f == 1.0));
    }
}
