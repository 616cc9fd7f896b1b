//! A body that fits into the corner of two planes.

use percute_core::contact::Obstacle;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_testkit::rotated;

/// A parallelogram of aluminium, 50 mm along the floor and 40 mm along the wall, which open by an angle (degrees). It
/// is 0.1 mm away from the floor and 0.3 mm from the wall.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub(crate) opening: f64,
    pub(crate) velocity: [f64; 2],
    pub(crate) friction: [f64; 2],
    pub(crate) cells: [usize; 2],
    /// All is turned by this angle (rad).
    pub(crate) turn: f64,
    pub(crate) wall_first: bool,
}

impl Corner {
    pub(crate) fn of(opening: f64, velocity: [f64; 2], friction: [f64; 2], cells: [usize; 2]) -> Self {
        Self { opening, velocity, friction, cells, turn: 0.0, wall_first: false }
    }

    pub(crate) fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.turn.sin_cos();
        [cos * x - sin * y, sin * x + cos * y]
    }

    pub(crate) fn problem(&self) -> Problem<2> {
        self.at_distance(3e-4)
    }

    /// With this gap to the wall (m).
    pub(crate) fn at_distance(&self, distance: f64) -> Problem<2> {
        let (sin, cos) = self.opening.to_radians().sin_cos();
        // At a right angle cos is 6e-17: the planes are exactly orthogonal only if it is 0.
        let cos = if self.opening == 90.0 { 0.0 } else { cos };
        let mesh = Mesh::rectangle(0.05, 0.04, self.cells[0], self.cells[1]).unwrap();
        let mesh = mesh.mapped(|[x, y]| [x + y * cos, y * sin]).unwrap();
        let plane = |normal: [f64; 2], gap: f64, friction: f64, group: &str| {
            let normal = self.turned(normal);
            Obstacle::plane(normal.map(|n| -gap * n), normal, friction, Some(group.to_string())).unwrap()
        };
        let floor = plane([0.0, 1.0], 1e-4, self.friction[0], "bottom");
        let wall = plane([sin, -cos], distance, self.friction[1], "left");
        let planes = if self.wall_first { [wall, floor] } else { [floor, wall] };
        let builder = Problem::<2>::builder(rotated(&mesh, self.turn).unwrap())
            .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
            .initial_velocity(Initial::Uniform(self.turned(self.velocity)));
        planes.into_iter().fold(builder, |builder, plane| builder.obstacle(plane)).build().unwrap()
    }
}

/// A rectangle that is turned against the floor, whose wall leans back by 30°.
pub(crate) fn open_corner(tilt: f64, speed: f64, cells: [usize; 2]) -> Problem<2> {
    let mesh = Mesh::rectangle(0.05, 0.04, cells[0], cells[1]).unwrap();
    let plane = |angle: f64, gap: f64, group: &str| {
        let normal = [(angle - tilt).cos(), (angle - tilt).sin()];
        Obstacle::plane(normal.map(|n| -gap * n), normal, 0.2, Some(group.to_string())).unwrap()
    };
    Problem::<2>::builder(mesh)
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Uniform([-speed, -speed]))
        .obstacle(plane(90.0_f64.to_radians(), 5e-7 * speed, "bottom"))
        .obstacle(plane(30.0_f64.to_radians(), 7.5e-7 * speed, "left"))
        .build()
        .unwrap()
}
