use super::*;
use crate::contact::Coulomb;
use crate::contact::Frame;
use proptest::prelude::*;

const STEPS: [f64; 2] = [1.25e-3, 1e-3];
const TOLERANCE: f64 = 1e-12;

/// Both constraints of a node of 2 kg, with this velocity (m/s), gaps at t_n (m) and coefficients of friction.
fn pair(angles: [f64; 2], velocity: [f64; 2], gaps: [f64; 2], friction: [f64; 2]) -> [Constraint<2>; 2] {
    [0, 1].map(|at| {
        let normal = [angles[at].cos(), angles[at].sin()];
        let gap = gaps[at] + STEPS[0] * dot(&normal, &velocity);
        Constraint { at, frame: Frame::new(normal), law: Coulomb::new(friction[at]), mass: 2.0, gap, velocity }
    })
}

/// By how much reactions miss the contact laws: lengths (m) and forces over the largest one.
fn misses(pair: &[Constraint<2>; 2], forces: &[[f64; 2]; 2]) -> (f64, f64) {
    let [dt, h] = STEPS;
    let total = [0, 1].map(|c| forces[0][c] + forces[1][c]);
    let after = [0, 1].map(|c| pair[0].velocity[c] + h * total[c] / pair[0].mass);
    let size = forces.as_flattened().iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let (mut length, mut force) = (0.0_f64, 0.0_f64);
    for (one, reaction) in pair.iter().zip(forces) {
        let (normal, change) = (one.frame.normal(), [0, 1].map(|c| after[c] - one.velocity[c]));
        let gap = one.gap + dt * dot(normal, &change);
        let (pressed, friction) = one.frame.split(reaction);
        let (_, sliding) = one.frame.split(&after);
        length = length.max(-gap);
        if pressed > 0.0 {
            length = length.max(gap);
        }
        let excess = one.law.excess(&one.frame, reaction);
        force = force.max(excess[0] / size).max(excess[1] / size);
        // Friction is against the sliding, and at its limit.
        let speed = sliding[0].hypot(sliding[1]);
        if speed * dt > 2.0 * TOLERANCE {
            for c in 0..2 {
                force = force.max((friction[c] + one.law.limit(pressed.max(0.0)) * sliding[c] / speed).abs() / size);
            }
        }
    }
    (length, force)
}

fn states() -> impl Strategy<Value = [Constraint<2>; 2]> {
    // Openings of 15 to 165 degrees, and angles of friction that add up to less.
    let shapes = (0.0..6.3_f64, 15.0..165.0_f64, 0.0..1.0_f64, 0.0..0.97_f64);
    let gap = prop_oneof![Just(0.0), 0.0..2e-3_f64];
    (shapes, [-5.0..5.0_f64, -5.0..5.0], [gap.clone(), gap]).prop_map(
        |((turn, opening, share, sum), velocity, gaps)| {
            let opening = opening.to_radians();
            // A coefficient of friction of a right angle or more does not exist.
            let angles = [share, 1.0 - share].map(|part| (part * sum * opening).min(1.5));
            pair([turn, turn + std::f64::consts::PI - opening], velocity, gaps, angles.map(f64::tan))
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// No gap is closed further, a force acts at closed gaps only, both are in their cones, and friction is against
    /// the sliding; in any order of the planes.
    #[test]
    fn the_laws_of_both_planes_hold(pair in states()) {
        if pair.iter().all(|one| one.gap >= -TOLERANCE) {
            return Ok(());
        }
        let forces = reactions(&pair, STEPS, TOLERANCE);
        let (length, force) = misses(&pair, &forces);
        prop_assert!(length <= 2.0 * TOLERANCE && force <= 1e-9, "{length:e} {force:e} {forces:?}");
        let [first, second] = pair;
        let exchanged = reactions(&[second, first], STEPS, TOLERANCE);
        let size = forces.as_flattened().iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for (a, b) in forces.iter().flatten().zip([exchanged[1], exchanged[0]].iter().flatten()) {
            prop_assert!((a - b).abs() <= 1e-9 * size, "{forces:?} {exchanged:?}");
        }
    }
}

/// Into a right corner: one plane takes what moves into it and leaves friction to the other.
#[test]
fn a_right_corner() {
    let corner = |velocity, friction| {
        let pair = pair([std::f64::consts::FRAC_PI_2, 0.0], velocity, [0.0, 0.0], friction);
        reactions(&pair, STEPS, TOLERANCE)
    };
    let near = |found: [[f64; 2]; 2], expected: [[f64; 2]; 2]| {
        let (found, expected) = (found.as_flattened(), expected.as_flattened());
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} {expected:?}");
    };
    // m/h = 2000. Without friction each stops its own part.
    near(corner([-2.0, -3.0], [0.0, 0.0]), [[0.0, 6000.0], [4000.0, 0.0]]);
    // At rest in the corner both parts could stick: the least friction is none.
    near(corner([-2.0, -3.0], [0.4, 0.4]), [[0.0, 6000.0], [4000.0, 0.0]]);
    // Along the floor away from the wall, only the floor acts.
    near(corner([2.0, -3.0], [0.4, 0.4]), [[-2400.0, 6000.0], [0.0, 0.0]]);
    // Friction on the floor alone could stop it at the wall as well.
    near(corner([-1.0, -3.0], [0.4, 0.4]), [[0.0, 6000.0], [2000.0, 0.0]]);
}

/// A gap that stays open at the other plane leaves the reaction of one plane, bit by bit.
#[test]
fn one_plane_alone() {
    for velocity in [[0.3, -2.0], [-0.3, -2.0], [0.0, -1e-3]] {
        let pair = pair([std::f64::consts::FRAC_PI_2, 0.0], velocity, [0.0, 1.0], [0.3, 0.3]);
        assert_eq!(reactions(&pair, STEPS, TOLERANCE), [pair[0].alone(STEPS), [0.0; 2]]);
    }
}

/// The same node and planes in space, turned, with a velocity along the edge.
fn in_space(plane: &[Constraint<2>; 2], turn: [f64; 2], along: f64) -> ([Constraint<3>; 2], [[f64; 3]; 3]) {
    let [(s, c), (t, d)] = turn.map(f64::sin_cos);
    let axes = [[c, s * d, s * t], [-s, c * d, c * t], [0.0, -t, d]];
    let place = |[x, y]: [f64; 2], z: f64| std::array::from_fn(|k| x * axes[0][k] + y * axes[1][k] + z * axes[2][k]);
    let made = plane.map(|one| Constraint {
        at: one.at,
        frame: Frame::new(place(*one.frame.normal(), 0.0)),
        law: one.law,
        mass: one.mass,
        gap: one.gap,
        velocity: place(one.velocity, along),
    });
    (made, axes)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Without a motion along the edge the reactions are those of the plane of both normals. With one the normal forces
    /// of a node at both planes are the same; forces along the edge are against the motion, and do not reverse it. They
    /// stop it, or both are at the limit. All are in the cones.
    #[test]
    fn planes_of_a_solid(plane in states(), turn in [0.0..6.3_f64, 0.0..6.3], along in -5.0..5.0_f64) {
        if plane.iter().all(|one| one.gap >= -TOLERANCE) {
            return Ok(());
        }
        let [_, h] = STEPS;
        let flat = reactions(&plane, STEPS, TOLERANCE);
        let size = flat.as_flattened().iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let components = |forces: [[f64; 3]; 2], axes: &[[f64; 3]; 3]| forces.map(|f| axes.map(|axis| dot(&f, &axis)));
        let (still, axes) = in_space(&plane, turn, 0.0);
        let found = components(reactions(&still, STEPS, TOLERANCE), &axes);
        for (found, flat) in found.iter().zip(&flat) {
            let expected = [flat[0], flat[1], 0.0];
            prop_assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-9 * size), "{found:?} {flat:?}");
        }
        let (moves, axes) = in_space(&plane, turn, along);
        let forces = reactions(&moves, STEPS, TOLERANCE);
        let size = forces.as_flattened().iter().fold(size, |m, f| m.max(f.abs()));
        let mut limits = true;
        for (one, force) in moves.iter().zip(&forces) {
            let excess = one.law.excess(&one.frame, force);
            prop_assert!(excess.iter().all(|excess| *excess <= 1e-9 * size), "{excess:?}");
            limits &= excess[0] >= -1e-9 * size;
        }
        let pushed: f64 = components(forces, &axes).iter().map(|f| f[2]).sum();
        let after = along + h * pushed / moves[0].mass;
        prop_assert!(pushed * along <= 1e-9 * size && after * along >= -1e-9, "{pushed} {along} {after}");
        prop_assert!(after.abs() <= 1e-9 || limits, "{after}");
    }
}
