//! Bodies and what acts on them.

use percute_core::border::Vector;
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::ids::ElementId;
use percute_core::load::{BodyForce, Support, Table};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Builder, Initial, Problem};
use percute_core::time::TimeGrid;
use std::f64::consts::TAU;

/// The aluminium of the paper's block (§7.2) in plane stress, 1 m thick.
pub(crate) fn aluminium() -> Elastic {
    Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap()
}

/// The plane with the normal turned by `tilt` (rad) from e_y, `gap` (m) from the nearest node.
pub(crate) fn plane_below(mesh: &Mesh, tilt: f64, gap: f64, friction: f64, group: Option<&str>) -> Obstacle<2> {
    let normal = [-tilt.sin(), tilt.cos()];
    let height = |p: &[f64; 2]| p[0] * normal[0] + p[1] * normal[1];
    let lowest = mesh.points_in::<2>().iter().map(height).fold(f64::INFINITY, f64::min);
    Obstacle::plane(normal.map(|n| (lowest - gap) * n), normal, friction, group.map(String::from)).unwrap()
}

/// A body of aluminium with a velocity and a plane.
pub(crate) fn thrown(mesh: Mesh, velocity: [f64; 2], plane: Obstacle<2>) -> Builder<2> {
    Problem::<2>::builder(mesh).material(aluminium()).initial_velocity(Initial::Uniform(velocity)).obstacle(plane)
}

/// A bar of aluminium that a body force presses on a plane at its start again and again.
pub(crate) fn bouncing_bar(mesh: Mesh) -> Problem<1> {
    Problem::<1>::builder(mesh)
        .material(Elastic::bar(70e9, 2700.0, 0.02).unwrap())
        .initial_velocity(Initial::Uniform([-20.0]))
        .body_force(gravity([-2e6]))
        .obstacle(Obstacle::plane([-1e-5], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap()
}

/// `count` equal steps of a fraction of the critical one.
pub(crate) fn steps<const D: usize>(problem: &Problem<D>, courant: f64, count: usize) -> TimeGrid {
    TimeGrid::uniform(courant * critical_time_step(problem) * count as f64, count).unwrap()
}

/// Steps that swing `waves` times between 0.5 and 0.9 of the critical one.
pub(crate) fn swinging<const D: usize>(problem: &Problem<D>, count: usize, waves: f64) -> TimeGrid {
    let critical = critical_time_step(problem);
    let step = |n: usize| critical * (0.7 + 0.2 * (TAU * waves * n as f64 / count as f64).sin());
    TimeGrid::from_steps(&(0..count).map(step).collect::<Vec<_>>()).unwrap()
}

/// A fixed support of some components.
pub(crate) fn fixed<const D: usize>(group: &str, components: [bool; D]) -> Support {
    let components = std::array::from_fn(|c| components.get(c).copied().unwrap_or(false));
    Support { group: group.to_string(), components, velocity: None }
}

/// A uniform body force that gives aluminium the acceleration `g` (m/s²).
pub(crate) fn gravity<const D: usize>(g: [f64; D]) -> BodyForce {
    BodyForce { group: None, value: Table::constant(g.map(|g| 2700.0 * g)) }
}

/// The same mesh with the elements whose centroid satisfies a condition in the group `first`, the
/// others in `second`.
pub(crate) fn in_two_groups(mesh: &Mesh, first: impl Fn(Vector) -> bool) -> Mesh {
    let cells: Vec<_> = mesh.cell_rows().iter().map(|node| node.index()).collect();
    let nodes = |f: &percute_core::ids::FaceId| mesh.face(*f).nodes.iter().map(|node| node.index());
    let faces = mesh.face_groups().iter();
    let faces = faces.map(|(name, f)| (name.clone(), f.iter().flat_map(nodes).collect())).collect();
    let (one, other) = mesh.elements().partition::<Vec<_>, _>(|&e| first(mesh.centroid(e)));
    let numbers = |of: Vec<ElementId>| of.into_iter().map(ElementId::index).collect();
    let groups = [("first".to_string(), numbers(one)), ("second".to_string(), numbers(other))].into();
    Mesh::from_rows(mesh.dimension(), mesh.points(), &cells, (&faces, &groups)).unwrap()
}
