use super::MomentCorrection;
use crate::contact_density::nodal_forces;
use crate::options::Options;
use crate::reconstruction::corrected::Corrected;
use percute_core::contact::Obstacle;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_testkit::Random;

/// Two blocks beside each other, with edges of unequal lengths, on a plane turned by an angle (rad); μ = 0.4.
fn blocks(angle: f64) -> Problem<2> {
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
    let mesh = Mesh::new(points, &cells, &Default::default(), &Default::default()).unwrap();
    let plane = Obstacle::plane(turn([0.0, -1e-3]), turn([0.0, 1.0]), 0.4, None).unwrap();
    Problem::<2>::builder(mesh)
        .material(Elastic::plane_stress(1.0, 0.3, 1.0, 1.0).unwrap())
        .obstacle(plane)
        .build()
        .unwrap()
}

/// Resultant and moment of nodal forces on each of the two blocks; the five nodes of one follow each other.
fn balance(problem: &Problem<2>, forces: &[[f64; 2]]) -> [[f64; 3]; 2] {
    let mut sums = [[0.0; 3]; 2];
    for (contact, f) in problem.surface().nodes().iter().zip(forces) {
        let node = contact.node.index();
        let [x, y] = problem.mesh().points_in::<2>()[node];
        let sum = &mut sums[node / 10];
        (sum[0], sum[1], sum[2]) = (sum[0] + f[0], sum[1] + f[1], sum[2] + x * f[1] - y * f[0]);
    }
    sums
}

/// The nodal forces that `corrected` makes of reactions.
fn made(problem: &Problem<2>, reaction: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let times = TimeGrid::uniform(1.0, 1).unwrap();
    let (corrected, gap) = (Corrected::<2, 3>::new(problem, &times, &Options::default()), vec![0.0; reaction.len()]);
    nodal_forces(problem, &corrected.at(reaction, &corrected.around(&gap, &[])))
}

/// Reactions in the cone: normal parts up to `range` times each other, friction up to a part of what the cone allows.
fn reactions(problem: &Problem<2>, random: &mut Random, range: f64, part: f64) -> Vec<[f64; 2]> {
    let one = |_| {
        let n = random.between(1.0, range);
        in_frame(problem, n, 0.4 * n * random.between(-part, part))
    };
    problem.surface().nodes().iter().map(one).collect()
}

/// A force with a normal part and one along the plane.
fn in_frame(problem: &Problem<2>, n: f64, t: f64) -> [f64; 2] {
    let normal = *problem.obstacles()[0].flat_frame().normal();
    [n * normal[0] + t * normal[1], n * normal[1] - t * normal[0]]
}

/// Whether forces press and their friction is within the cone, to the last bits.
fn admissible(problem: &Problem<2>, forces: &[[f64; 2]]) -> bool {
    let normal = *problem.obstacles()[0].flat_frame().normal();
    forces.iter().all(|f| {
        let (n, t) = (f[0] * normal[0] + f[1] * normal[1], f[0] * normal[1] - f[1] * normal[0]);
        n >= 0.0 && t.abs() <= 0.4 * n + 1e-14
    })
}

/// Each block gets the resultant and the moment of its own reactions, whatever the angle and the friction: none, some,
/// or as much as the cone allows, on all nodes or on the first two alone.
#[test]
fn resultant_and_moment_are_those_of_the_reactions() {
    for seed in 0..40_u32 {
        let problem = blocks(0.3 * f64::from(seed));
        let part = [0.0, 0.3, 1.0, 1e-17][seed as usize % 4];
        let mut reaction = reactions(&problem, &mut Random::new(seed.into()), 1.5, part);
        if seed >= 20 {
            let first = |at: usize| problem.surface().nodes()[at].node.index() < 4;
            (0..10).filter(|&at| !first(at)).for_each(|at| reaction[at] = [0.0; 2]);
        }
        let mut corrected = reaction.clone();
        MomentCorrection::new(&problem).apply(&mut corrected, &[], &|_| None);
        assert!(admissible(&problem, &corrected), "{seed}: {corrected:?}");
        let (given, found) = (balance(&problem, &reaction), balance(&problem, &made(&problem, &reaction)));
        for (given, found) in given.iter().zip(&found) {
            // Rounding of sums of five terms of up to 1.5·12.
            assert!(given.iter().zip(found).all(|(a, b)| (a - b).abs() < 1e-12), "{seed}: {found:?} for {given:?}");
        }
    }
}

/// The same reactions in another frame are corrected alike, with friction that is nothing but rounding, too.
#[test]
fn no_frame_is_special() {
    let numbers = [[3.0, 0.1], [1.0, -1e-17], [2.0, 0.8], [0.0, 0.0], [1.5, 1e-17]];
    let corrected = |angle: f64| -> Vec<[f64; 2]> {
        let problem = blocks(angle);
        let mut forces: Vec<[f64; 2]> = problem
            .surface()
            .nodes()
            .iter()
            .map(|contact| {
                let [n, t] = numbers[contact.node.index() % 10 / 2];
                in_frame(&problem, n, t)
            })
            .collect();
        MomentCorrection::new(&problem).apply(&mut forces, &[], &|_| None);
        let normal = *problem.obstacles()[0].flat_frame().normal();
        let own = |f: &[f64; 2]| [f[0] * normal[0] + f[1] * normal[1], f[0] * normal[1] - f[1] * normal[0]];
        let mut all: Vec<(usize, [f64; 2])> =
            problem.surface().nodes().iter().map(|c| c.node.index()).zip(forces.iter().map(own)).collect();
        all.sort_by_key(|(node, _)| *node);
        all.into_iter().map(|(_, f)| f).collect()
    };
    let flat = corrected(0.0);
    assert!((flat[0][0] - 3.0).abs() > 0.1, "nothing was corrected: {flat:?}");
    for angle in [0.5, 2.0, 4.0] {
        for (a, b) in flat.iter().zip(&corrected(angle)) {
            // Rounding of coordinates of 12 over edges of 0.5.
            assert!((0..2).all(|c| (a[c] - b[c]).abs() < 1e-13), "{angle}: {b:?} for {a:?}");
        }
    }
}

/// Where nearly all is carried by the end of a block, the density cannot act there: the end takes what it can, and what
/// is missing of the moment is what a hat over the first edge must miss.
#[test]
fn what_cannot_be_had_is_had_in_part() {
    let problem = blocks(0.0);
    let mut reaction = vec![[0.0, 0.0]; 10];
    let at = |node: usize| problem.surface().nodes().iter().position(|c| c.node.index() == node).unwrap();
    (reaction[at(0)], reaction[at(2)]) = ([0.3, 1.0], [0.0, 0.1]);
    let mut corrected = reaction.clone();
    MomentCorrection::new(&problem).apply(&mut corrected, &[], &|_| None);
    assert!(admissible(&problem, &corrected));
    // All on the first node, friction too.
    assert!((0..2).all(|c| (corrected[at(0)][c] - [0.3, 1.1][c]).abs() < 1e-15), "{corrected:?}");
    assert_eq!(corrected[at(2)], [0.0; 2]);
    let [found, other] = balance(&problem, &made(&problem, &reaction));
    let [given, _] = balance(&problem, &reaction);
    assert_eq!(other, [0.0; 3]);
    assert!((0..2).all(|c| (found[c] - given[c]).abs() < 1e-15), "{found:?} for {given:?}");
    // The first hat acts at a third of its edge of 0.5 m; given is 0.1 N at 0.5 m.
    assert!((found[2] - 1.1 * 0.5 / 3.0).abs() < 1e-15 && (given[2] - 0.05).abs() < 1e-15, "{found:?}, {given:?}");
}

/// One node alone has one density, and nothing is done to it.
#[test]
fn a_node_alone_is_left_as_it_is() {
    let problem = blocks(0.2);
    for k in 0..10 {
        let mut reaction = vec![[0.0; 2]; 10];
        reaction[k] = in_frame(&problem, 2.0, 0.3);
        let mut corrected = reaction.clone();
        MomentCorrection::new(&problem).apply(&mut corrected, &[], &|_| None);
        assert_eq!(corrected, reaction);
    }
}
