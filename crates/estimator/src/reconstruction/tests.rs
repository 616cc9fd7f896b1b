//! The cone and the contact zone: densities that break them show.

use super::*;
use crate::contact_density::nodal_forces;
use crate::options::Reconstruction::{self, Consistent, Corrected, Published};
use crate::residual::Residuals;
use percute_core::contact::Obstacle;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;

/// Four edges along the bottom of a block, μ = 0.2.
fn problem() -> Problem<2> {
    Problem::<2>::builder(Mesh::rectangle(0.04, 0.02, 4, 2).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .obstacle(Obstacle::plane([0.0, -1e-4], [0.0, 1.0], 0.2, None).unwrap())
        .build()
        .unwrap()
}

/// Nodes 0 to 3 of five touch, pressed and pulled along the plane up to the cone.
fn surface() -> SurfaceStep<2> {
    let reaction = vec![[20.0, 100.0], [-40.0, 200.0], [30.0, 150.0], [0.0, 120.0], [0.0, 0.0]];
    SurfaceStep {
        force: reaction.clone(),
        densities: None,
        reaction,
        touching: vec![true, true, true, true, false],
        gap: vec![0.0; 5],
    }
}

fn residuals(densities: &StepDensities<2>) -> Residuals {
    let (mut residuals, step) = (Residuals::default(), surface());
    check(&problem(), &alone(&step, &step), densities, false, &mut residuals);
    residuals
}

/// The densities that a reconstruction makes of these steps.
fn made(choice: Reconstruction, problem: &Problem<2>, steps: &SurfaceSteps<'_, 2>) -> StepDensities<2> {
    let times = TimeGrid::uniform(1.0, 1).unwrap();
    new::<2, 3>(problem, &times, &Options { reconstruction: choice, ..Options::default() }).densities(steps)
}

/// One step without any other.
fn alone<'a>(now: &'a SurfaceStep<2>, next: &'a SurfaceStep<2>) -> SurfaceSteps<'a, 2> {
    SurfaceSteps { before: None, now, next, after: None }
}

/// One step where nothing changes.
fn steady(step: &SurfaceStep<2>) -> SurfaceSteps<'_, 2> {
    SurfaceSteps { before: Some(step), now: step, next: step, after: Some(step) }
}

fn both() -> [StepDensities<2>; 2] {
    [Consistent, Published].map(|choice| made(choice, &problem(), &steady(&surface())))
}

#[test]
fn both_reconstructions_are_admissible() {
    for interval in both() {
        assert!(interval.start[0][0][1] > 0.0);
        // Rounding of the projection.
        assert!(residuals(&interval).largest() < 1e-15);
    }
}

/// 1 % more friction than the cone allows, or a pull; off contact nothing changes.
#[test]
fn forces_outside_the_cone_show() {
    for interval in both() {
        for end in 0..2 {
            for push in [[0.202e6, 1e6], [0.0, -1.0]] {
                let mut wrong = interval.clone();
                [&mut wrong.start, &mut wrong.end][end].values_mut()[0][0] = push;
                let found = residuals(&wrong);
                assert!(found.cone > 1e-6, "{found:?}");
                assert_eq!(found.force_off_contact, 0.0);
            }
        }
    }
}

/// A force on the last edge, of which one node does not touch, within the cone.
#[test]
fn forces_off_contact_show() {
    for interval in both() {
        for end in 0..2 {
            let mut wrong = interval.clone();
            [&mut wrong.start, &mut wrong.end][end].values_mut()[3][0] = [0.0, 1.0];
            let found = residuals(&wrong);
            assert!(found.force_off_contact > 1e-6, "{found:?}");
            assert!(found.cone < 1e-15);
        }
    }
}

/// Touching now but not at the end of the step is not contact throughout.
#[test]
fn forces_beside_a_release_show() {
    let [consistent, _] = both();
    let mut released = surface();
    released.touching[3] = false;
    let mut found = Residuals::default();
    check(&problem(), &alone(&surface(), &released), &consistent, false, &mut found);
    assert!(found.force_off_contact > 1e-6);
}

#[test]
fn nan_shows() {
    let none = Densities::none(&problem());
    let mut interval = StepDensities { start: none.clone(), end: none };
    interval.start.values_mut()[0][0] = [f64::NAN, f64::NAN];
    assert!(residuals(&interval).largest().is_nan());
}

/// A node that touches alone has no edge that touches: no force in either reconstruction (method, §4).
#[test]
fn a_node_that_touches_alone_gets_no_force() {
    let problem = problem();
    let mut step = surface();
    step.touching = vec![false, true, false, false, false];
    for choice in [Consistent, Published] {
        let interval = made(choice, &problem, &steady(&step));
        for density in interval.start.iter().chain(interval.end.iter()).flatten() {
            assert_eq!(*density, [0.0; 2]);
        }
    }
}

/// A phase of one step, off before and after: no force in either reconstruction.
#[test]
fn a_phase_of_one_step_gets_no_force() {
    let problem = problem();
    let off = SurfaceStep {
        reaction: vec![[0.0; 2]; 5],
        force: vec![[0.0; 2]; 5],
        densities: None,
        touching: vec![false; 5],
        gap: vec![0.0; 5],
    };
    let steps = [&off, &surface(), &off];
    for choice in [Consistent, Published] {
        for (before, now, next, after) in [(None, 0, 1, Some(steps[2])), (Some(steps[0]), 1, 2, None)] {
            let around = SurfaceSteps { before, now: steps[now], next: steps[next], after };
            let interval = made(choice, &problem, &around);
            assert!(interval.start.iter().chain(interval.end.iter()).flatten().all(|f| *f == [0.0; 2]));
        }
    }
}

/// All five nodes touch and are pressed.
fn pressed() -> SurfaceStep<2> {
    SurfaceStep {
        reaction: vec![[0.0, 100.0]; 5],
        force: vec![[0.0, 100.0]; 5],
        densities: None,
        touching: vec![true; 5],
        gap: vec![0.0; 5],
    }
}

/// Whether there is force at any place, at the beginning and at the end of a step.
fn acts(interval: &StepDensities<2>) -> [bool; 2] {
    [&interval.start, &interval.end].map(|d| d.iter().flatten().any(|f| f[1] > 0.0))
}

/// Touching from t_1 to t_4, the force of the paper is there at t_2 and t_3 only, [45]–[48]; with a phase
/// that is still open at the last step it stays to the end. `consistent` has all of it.
#[test]
fn force_begins_and_ends_with_contact() {
    let problem = problem();
    let off = || SurfaceStep {
        reaction: vec![[0.0; 2]; 5],
        force: vec![[0.0; 2]; 5],
        densities: None,
        touching: vec![false; 5],
        gap: vec![0.0; 5],
    };
    let steps = [off(), pressed(), pressed(), pressed(), pressed(), off()];
    let interval = |choice, n: usize, last: usize| {
        let before = n.checked_sub(1).map(|m| &steps[m]);
        let after = steps[..=last].get(n + 2);
        acts(&made(choice, &problem, &SurfaceSteps { before, now: &steps[n], next: &steps[n + 1], after }))
    };
    let all = |choice, last: usize| (0..last).map(|n| interval(choice, n, last)).collect::<Vec<_>>();
    let (none, both) = ([false, false], [true, true]);
    assert_eq!(all(Published, 5), [none, [false, true], both, [true, false], none]);
    assert_eq!(all(Published, 4), [none, [false, true], both, both]);
    assert_eq!(all(Published, 2), [none, [false, true]]);
    assert_eq!(all(Consistent, 5), [none, both, both, both, none]);
}

/// In the reconstruction of the paper a node beside one that arrives or leaves loses its force; the corner, which
/// has a neighbour on one side only, keeps it.
#[test]
fn the_border_of_contact_has_no_force() {
    let problem = problem();
    let (now, mut before) = (pressed(), pressed());
    before.touching[3] = false;
    let around = SurfaceSteps { before: Some(&before), now: &now, next: &now, after: Some(&now) };
    let interval = made(Published, &problem, &around);
    let forces = nodal_forces(&problem, &interval.start);
    assert_eq!(
        interval.start.iter().map(|e| e.map(|f| f[1] > 0.0)).collect::<Vec<_>>(),
        [[true, true], [true, false], [false, false], [false, false]]
    );
    assert!(forces[0][1] > 0.0);
    // A density is the reaction over the tributary length: half an edge of 10 mm at the corner.
    assert!((interval.start[0][0][1] - 100.0 / 0.005).abs() < 1e-9);
}

/// Where the cone cuts nothing off, `consistent` has the nodal forces of the simulation: made from a density,
/// they give it back.
#[test]
fn consistent_is_statically_equivalent() {
    let problem = problem();
    // Pressure and friction below 0.2 of it, continuous along the five nodes.
    let nodal = [[1e3, 6e3], [-1e3, 9e3], [2e3, 1.1e4], [1e3, 7e3], [0.0, 5e3]];
    let given: Vec<_> = problem.surface().faces().iter().map(|f| f.nodes.map(|k| nodal[k])).collect();
    let mut step = pressed();
    step.force = nodal_forces(&problem, &Densities::new(&problem, |f, _| given[f]));
    let interval = made(Consistent, &problem, &alone(&step, &step));
    for (made, given) in interval.start.iter().flatten().flatten().zip(given.iter().flatten().flatten()) {
        // Rounding of a tridiagonal solve with five unknowns of order 1e4.
        assert!((made - given).abs() < 1e-10, "{made} against {given}");
    }
}

/// Two edges, 1 m wide each, that meet at their lowest point; each rises by `slope` (rad). Left and right
/// end, then the middle, as positions in the surface.
fn kinked(slope: f64) -> (Problem<2>, [usize; 3]) {
    let rise = slope.tan();
    let points = vec![[-1.0, rise], [0.0, 0.0], [1.0, rise], [0.0, 2.0]];
    let mesh = Mesh::new(points, &[[0, 1, 3], [1, 2, 3]], &Default::default(), &Default::default()).unwrap();
    let problem = Problem::<2>::builder(mesh)
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .obstacle(Obstacle::plane([0.0, -1e-4], [0.0, 1.0], 0.2, None).unwrap())
        .build()
        .unwrap();
    let at = |node: usize| problem.surface().nodes().iter().position(|c| c.node.index() == node).unwrap();
    let places = [at(0), at(2), at(1)];
    (problem, places)
}

/// The densities of the paper at the ends of the left and of the right edge, outer node first; the right end has
/// just arrived if `arriving`. All reactions are 1 N.
fn published_forces(slope: f64, arriving: bool) -> [[f64; 2]; 2] {
    let (problem, [left, right, middle]) = kinked(slope);
    let now = SurfaceStep {
        reaction: vec![[0.0, 1.0]; 3],
        force: vec![[0.0, 1.0]; 3],
        densities: None,
        touching: vec![true; 3],
        gap: vec![0.0; 3],
    };
    let mut before = now.clone();
    before.touching[right] = !arriving;
    let around = SurfaceSteps { before: Some(&before), now: &now, next: &now, after: Some(&now) };
    let density = made(Published, &problem, &around).start;
    [left, right].map(|outer| {
        let f = problem.surface().faces().iter().position(|f| f.nodes.contains(&outer)).unwrap();
        [outer, middle].map(|node| {
            let p = problem.surface().faces()[f].nodes.iter().position(|&n| n == node).unwrap();
            density[f][p][1]
        })
    })
}

/// Edges that meet at 44° are neighbours: their middle node has the halves of both as its tributary
/// length, and loses its force, on both, if the node at either far end does not keep its own.
#[test]
fn edges_that_meet_smoothly_are_neighbours() {
    let slope = 22.0_f64.to_radians();
    // 1 N over half an edge at the ends, over two halves in the middle; rounding of a few operations.
    let (end, middle) = (2.0 * slope.cos(), slope.cos());
    for (arriving, expected) in [(false, [[end, middle]; 2]), (true, [[end, 0.0], [0.0, 0.0]])] {
        for (made, wanted) in published_forces(slope, arriving).iter().flatten().zip(expected.iter().flatten()) {
            assert!((made - wanted).abs() <= 1e-14 * wanted, "{made} instead of {wanted}");
        }
    }
}

/// At 46° each edge is on its own: its half is the tributary length, and what happens at the far end of the
/// other does not matter.
#[test]
fn edges_that_meet_at_a_corner_are_not() {
    let slope = 23.0_f64.to_radians();
    let alone = 2.0 * slope.cos();
    for (arriving, expected) in [(false, [[alone; 2]; 2]), (true, [[alone; 2], [0.0; 2]])] {
        for (made, wanted) in published_forces(slope, arriving).iter().flatten().zip(expected.iter().flatten()) {
            assert!((made - wanted).abs() <= 1e-14 * wanted, "{made} instead of {wanted}");
        }
    }
}

/// `corrected` drops nothing: its resultant is that of the reactions, off contact too, and one instant has one value.
#[test]
fn no_reaction_is_dropped() {
    let problem = problem();
    let mut step = surface();
    // The last node brakes: it has a reaction before it touches.
    step.force[4] = [1.0, 50.0];
    let first = made(Corrected, &problem, &alone(&surface(), &step));
    let second = made(Corrected, &problem, &alone(&step, &surface()));
    assert_eq!(first.end, second.start);
    let kept = nodal_forces(&problem, &first.end);
    for c in 0..2 {
        let sum = |forces: &[[f64; 2]]| forces.iter().map(|f| f[c]).sum::<f64>();
        // Rounding of a dozen terms.
        assert!((sum(&kept) - sum(&step.force)).abs() < 1e-12 * 600.0);
    }
    assert!(residuals(&first).cone < 1e-14 && first.end[3][1][1] > 0.0);
    // A reaction out of the cone, as a foreign history may have, is projected.
    step.force[0] = [0.0, -10.0];
    let cut = made(Corrected, &problem, &alone(&step, &step));
    assert_eq!(cut.start[0][0], [0.0; 2]);
}
