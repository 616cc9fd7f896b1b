//! Bodies that meet with a corner, which no surface faces yet at the start.

use crate::found::{Body, problem};
use crate::solution::run::{Run, run};
use percute_core::dynamics::critical_time_step;
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

fn block(width: f64, cells: [usize; 2]) -> Mesh {
    Mesh::rectangle(width, 0.02, cells[0], cells[1]).unwrap()
}

/// The impulse on the second body (N s) and the energy gained, over that at the start.
fn strike(problem: &Problem<2>, end: f64) -> ([f64; 2], f64) {
    let run = run(problem, &TimeGrid::with_step(end, 0.8 * critical_time_step(problem)).unwrap());
    let (last, start) = (run.last(), kinetic(&run, 0));
    let impulse = momentum(&run, last - 1, 1, 0);
    let opposite = momentum(&run, last - 1, 0, 0);
    for c in 0..2 {
        assert!((impulse[c] + opposite[c]).abs() < 1e-10 * impulse[0].hypot(impulse[1]), "{impulse:?} {opposite:?}");
    }
    (impulse, (kinetic(&run, last - 1) + run.strain_energy(last)) / start - 1.0)
}

fn kinetic(run: &Run<'_, 2>, n: usize) -> f64 {
    let velocity = run.half_velocity(n);
    velocity.iter().zip(run.problem.mass()).map(|(v, m)| 0.5 * m * (v[0] * v[0] + v[1] * v[1])).sum()
}

/// The momentum of a body at a step less that at another one (N s).
fn momentum(run: &Run<'_, 2>, n: usize, body: usize, from: usize) -> [f64; 2] {
    let numbers = run.problem.mesh().part_numbers();
    let [now, before] = [n, from].map(|n| run.half_velocity(n));
    let mut change = [0.0; 2];
    for i in (0..numbers.len()).filter(|&i| numbers[i] == body) {
        (0..2).for_each(|c| change[c] += run.problem.mass()[i] * (now[i][c] - before[i][c]));
    }
    change
}

/// A tilted block comes from beside with its corner down. Along the normal of its underside, which leans, the block
/// below is in part behind it.
#[test]
fn a_corner_from_beside_is_pushed_along_the_normal_of_the_face_that_it_strikes() {
    let tilted = block(0.03, [6, 4]).placed(&[0.03, 0.024], 25.0).unwrap();
    let bodies: [Body<'_>; 2] = [("below", block(0.02, [4, 4]), [0.0; 2]), ("tilted", tilted, [-40.0, -10.0])];
    let problem = problem(&bodies).build().unwrap();
    let non_matching = &problem.surface().non_matching()[0];
    assert!(non_matching.frame().normal()[1].abs() > 1.0 - 1e-12, "{:?}", non_matching.frame().normal());
    let (impulse, gained) = strike(&problem, 4.5e-4);
    assert!(impulse[1] > 1.0 && impulse[0].abs() < 1e-9 * impulse[1], "{impulse:?}");
    assert!(gained < 1e-3, "{gained}");
    // The corner is the lowest node of the second body: it does not enter the upper side of the first one.
    let run = run(&problem, &TimeGrid::with_step(4.5e-4, 0.8 * critical_time_step(&problem)).unwrap());
    let place = |u: &[[f64; 2]], i: usize| [0, 1].map(|c| problem.mesh().points_in::<2>()[i][c] + u[i][c]);
    let corner = 25;
    for n in 0..=run.last() {
        let u = run.history.step(n).unwrap().displacement();
        let ([x, y], top) = (place(u, corner), [20, 21, 22, 23, 24].map(|i| place(u, i)));
        let Some(ends) = top.windows(2).find(|ends| ends[0][0] <= x && x <= ends[1][0]) else { continue };
        let part = (x - ends[0][0]) / (ends[1][0] - ends[0][0]);
        let gap = y - ends[0][1] - part * (ends[1][1] - ends[0][1]);
        // Gaps are means over edges: a thousandth of an edge of 5 mm.
        assert!(gap > -5e-6, "step {n}: {gap}");
    }
}

/// The corner of a block strikes a disc. Forces along the normal of its side would push the disc away below it.
#[test]
fn a_corner_that_strikes_a_curve_is_pushed_along_the_normal_of_the_curve() {
    let turned = block(0.03, [6, 4]).placed(&[0.0; 2], -25.0).unwrap();
    let corner = turned.points_in::<2>().iter().copied().max_by(|a, b| a[0].total_cmp(&b[0])).unwrap();
    let disc = Mesh::disc(0.014, 5).unwrap();
    let disc = disc.placed(&[corner[0] + 0.0142, corner[1] - 0.0005], 0.0).unwrap();
    let bodies: [Body<'_>; 2] = [("block", turned, [0.0; 2]), ("disc", disc, [-20.0, 0.0])];
    let problem = problem(&bodies).build().unwrap();
    let (impulse, gained) = strike(&problem, 5e-5);
    let degrees = impulse[1].atan2(impulse[0]).to_degrees();
    assert!(impulse[0] > 1.0 && degrees.abs() < 12.0, "{impulse:?}: {degrees}°");
    assert!(gained < 0.1, "{gained}");
}
