//! Residuals of the sequential part rise when its fields are changed.

use super::*;
use crate::contact_density::Densities;
use crate::nodal_field::FieldPool;
use crate::options::Reconstruction;
use crate::pipeline::fixture::{SHOWS, driven, guided, impact, prepared, prepared_until, sticking};
use crate::time_level::BeforeJump;
use percute_core::dynamics::Evaluation;
use percute_core::problem::Initial;

/// The density before t_n.
fn before(level: &ForcesKnown<2>) -> &Densities<2> {
    level.before.as_ref().map_or(&level.density, |BeforeJump { density, .. }| density)
}

/// u_CA and u̇_CA that start elsewhere.
#[test]
fn wrong_initial_conditions_show() {
    let (problem, times) = driven();
    let mesh = problem.mesh().clone();
    let law = problem.materials()[0];
    let builder = || Problem::<2>::builder(mesh.clone()).material(law);
    let velocity = |v: f64| Initial::Nodal(problem.initial_velocity().iter().map(|x| [x[0], v * x[1]]).collect());
    let faster = builder().initial_velocity(velocity(1.01)).build().unwrap();
    let moved = builder().initial_velocity(velocity(1.0)).initial_displacement(Initial::Uniform([1e-5, 0.0]));
    let moved = moved.build().unwrap();
    let step = percute_core::history::Step {
        index: 0,
        time: 0.0,
        displacement: problem.initial_displacement().as_flattened(),
        reaction: &[],
        touching: &[],
        internal: &[],
        velocity: None,
        acceleration: None,
    };
    for (other, shows) in [(&problem, false), (&faster, true), (&moved, true)] {
        let mut preparation = Preparation::<2, 3>::new(&problem, &times, &Options::default());
        preparation.motion = NodalTrajectory::new(other, &FieldPool::new(other.mesh().node_count()));
        let mut evaluation = Evaluation::new(&problem, &times);
        preparation.push(&evaluation.advance(&step).unwrap()).unwrap();
        let found = preparation.residuals;
        assert_eq!(found.initial_conditions > SHOWS, shows, "{found:?}");
        assert_eq!(Residuals { initial_conditions: 0.0, ..found }, Residuals::default());
    }
}

/// A support whose exact displacement is 1 % longer than that of u_CA.
#[test]
fn a_missed_support_shows() {
    let (problem, times) = driven();
    let mut preparation = prepared(&problem, &times, Reconstruction::Consistent);
    assert!(preparation.residuals.largest() < 1e-13);
    let last = times.step_count();
    let Some(level) = preparation.ready.back() else { panic!("no levels") };
    let mut motion = level.now.motion.clone();
    let [displacement, _] = motion.parts_mut();
    for p in problem.prescribed() {
        displacement[p.node.index()][p.component] *= 1.01;
    }
    // The last step once more: its way is taken off first.
    for (k, p) in problem.prescribed().iter().enumerate() {
        let velocity = |m: usize| problem.prescribed_velocity(p, times.instants()[m]);
        preparation.supports.exact[k] -= 0.5 * times.step(last - 1) * (velocity(last - 1) + velocity(last));
    }
    let miss = preparation.supports.advance(&problem, &times, last, &motion);
    let found = Residuals { supports: worse(preparation.residuals.supports, miss), ..preparation.residuals };
    assert!(found.supports > SHOWS, "{found:?}");
    assert!(Residuals { supports: 0.0, ..found }.largest() < 1e-13, "{found:?}");
}

/// Densities that leave the cone between reconstruction and check.
#[test]
fn every_reconstruction_is_checked_at_every_step() {
    let (problem, times) = impact();
    for &choice in Reconstruction::ALL {
        let preparation = prepared(&problem, &times, choice);
        assert!(preparation.residuals.largest() < 1e-13);
        assert!(preparation.impulse.kept > 0.0);
    }
}

/// ∫[b(−w, F) + w·F] over an edge of the plane y = const, by the rule of the rectangle's middle at so many
/// points that a kink in one of them costs 1e-6 (W).
fn power(length: f64, friction: f64, force: [[f64; 2]; 2], sliding: [f64; 2]) -> f64 {
    let count = 1000;
    let at = |k: usize| {
        let s = (k as f64 + 0.5) / count as f64;
        let line = |a: f64, b: f64| a + s * (b - a);
        let w = line(sliding[0], sliding[1]);
        friction * line(force[0][1], force[1][1]) * w.abs() + line(force[0][0], force[1][0]) * w
    };
    (0..count).map(at).sum::<f64>() * length / count as f64
}

/// The contact part against a sum by hand, step by step, where friction holds the nodes: they turn
/// back, so that w_t changes its sign within edges, and the force is inside the cone.
#[test]
fn the_contact_part_step_by_step() {
    let (problem, times) = sticking();
    for &choice in Reconstruction::ALL {
        let preparation = prepared(&problem, &times, choice);
        let levels = &preparation.ready;
        let (mut turning, mut inside) = (0, 0);
        for (f, face) in problem.surface().faces().iter().enumerate() {
            let mut sum = 0.0;
            for n in 0..times.step_count() {
                let (now, next) = (&levels[n], &levels[n + 1]);
                let mid = next.mid_velocity.as_deref().unwrap();
                let nodes = face.nodes.map(|k| problem.surface().nodes()[k].node.index());
                let mut power = |velocity: &[[f64; 2]], force: [[f64; 2]; 2]| {
                    let sliding = nodes.map(|i| velocity[i][0]);
                    let pressed = force.iter().any(|f| f[1] > 0.0);
                    turning += usize::from(pressed && sliding[0] * sliding[1] < 0.0);
                    inside += usize::from(force.iter().any(|f| f[1] > 0.0 && f[0].abs() < 0.5 * f[1]));
                    power(face.area, 0.9, force, sliding)
                };
                let (start, end) = (now.density[f], before(next)[f]);
                let middle = [0, 1].map(|p| [0, 1].map(|c| 0.5 * (start[p][c] + end[p][c])));
                let [a, m, b] = [
                    power(now.now.motion.velocity(), start),
                    power(mid, middle),
                    power(next.now.motion.velocity(), end),
                ];
                // 2∫: twice the trapezoids of two half steps.
                let half = 0.5 * times.step(n);
                let found = next.friction[f];
                let close = |a: f64, b: f64| (a - b).abs() <= 1e-5 * b.abs();
                assert!(close(found[0], sum + half * (a + m)), "{choice}, step {n}: {} ", found[0]);
                sum += half * (a + m) + half * (m + b);
                assert!(close(found[1], sum), "{choice}, step {n}: {} instead of {sum}", found[1]);
            }
            assert!(sum > 0.0, "{choice}");
        }
        assert!(turning > 3 && inside > 3, "{choice}: {turning}, {inside}");
    }
}

/// Friction cannot move a node along a guide, whatever force acts on it.
#[test]
fn a_guided_node_keeps_its_tangential_motion() {
    let (problem, times) = guided();
    for &choice in Reconstruction::ALL {
        let preparation = prepared(&problem, &times, choice);
        let at = problem.surface().nodes().iter().position(|contact| contact.guided).unwrap();
        let node = problem.surface().nodes()[at].node.index();
        let pulled = |d: &Densities<2>| {
            let force = crate::contact_density::nodal_forces(&problem, d)[at];
            // More than rounding.
            usize::from(force[0].abs() > 1e-9 * force[1] && force[1] > 0.0)
        };
        let count: usize = preparation.ready.iter().map(|level| pulled(before(level)) + pulled(&level.density)).sum();
        // `consistent` pulls at the node on the last interval only, before and after which it is counted.
        assert!(count >= 2, "{choice}: {count}");
        for level in &preparation.ready {
            assert_eq!(level.acceleration[node][0], 0.0, "{choice}");
            assert!(level.before.iter().all(|before| before.acceleration[at][0] == 0.0), "{choice}");
        }
    }
}

/// A phase that is open at the last step goes on: the force of the paper is there at t_N if the node touched
/// at t_{N−1} too, whatever was before.
#[test]
fn an_open_phase_has_its_force_at_the_last_step() {
    let (problem, times) = impact();
    let all = prepared(&problem, &times, Reconstruction::Published);
    let first = all.ready.iter().position(|level| level.level.surface.touching.contains(&true)).unwrap();
    assert!(all.ready[first].level.surface.touching.iter().all(|t| *t), "a flat bottom touches all at once");
    for (last, acts) in [(first, false), (first + 1, true), (first + 2, true)] {
        let ended = prepared_until(&problem, &times, Reconstruction::Published, last);
        let pressed = |d: &Densities<2>| d.iter().flatten().any(|f| f[1] > 0.0);
        let level = ended.ready.back().unwrap();
        assert_eq!((level.level.index, pressed(before(level))), (last, acts));
    }
}
