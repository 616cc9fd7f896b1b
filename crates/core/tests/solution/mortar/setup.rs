//! Two blocks, one above the other.

use crate::solution::run::aluminium;
use percute_core::contact::Interface;
use percute_core::dynamics::critical_time_step;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Builder, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::translated;

/// Distance between the blocks at the start (m).
pub(crate) const GAP: f64 = 50e-6;
/// Height of a block (m).
pub(crate) const HEIGHT: f64 = 0.025;

pub(crate) fn steel() -> Elastic {
    Elastic::plane_stress(210e9, 0.3, 7800.0, 1.0).unwrap()
}

/// Two blocks with their motion.
#[derive(Clone, Copy)]
pub(crate) struct Blocks {
    /// Cells along and across, of the upper and of the lower one.
    pub(crate) cells: [[usize; 2]; 2],
    /// Widths (m).
    pub(crate) widths: [f64; 2],
    /// How far the upper one is to the right of the lower one (m).
    pub(crate) aside: f64,
    pub(crate) materials: [Elastic; 2],
    /// Distance at the start (m).
    pub(crate) gap: f64,
    /// Velocities (m/s).
    pub(crate) velocities: [[f64; 2]; 2],
    pub(crate) friction: f64,
}

impl Blocks {
    /// 14 × 11 cells on 20 × 16, of aluminium, that meet at an angle.
    pub(crate) fn oblique() -> Self {
        Self {
            cells: [[14, 11], [20, 16]],
            widths: [0.04; 2],
            aside: 0.0,
            materials: [aluminium(); 2],
            gap: GAP,
            velocities: [[8.0, -20.0], [0.0, 20.0]],
            friction: 0.2,
        }
    }

    /// The mesh, of bodies `upper` and `lower`.
    pub(crate) fn mesh(&self) -> Mesh {
        let block = |k: usize, at: [f64; 2]| {
            let mesh = Mesh::rectangle(self.widths[k], HEIGHT, self.cells[k][0], self.cells[k][1]).unwrap();
            translated(&mesh, at).unwrap()
        };
        let (upper, lower) = (block(0, [self.aside, HEIGHT + self.gap]), block(1, [0.0; 2]));
        Mesh::joined(&[("upper", &upper), ("lower", &lower)]).unwrap()
    }

    /// The bodies on a mesh of theirs, moved and turned perhaps; `map` does the same to velocities.
    pub(crate) fn bodies(&self, mesh: Mesh, map: impl Fn([f64; 2]) -> [f64; 2]) -> Builder<2> {
        let upper = (self.cells[0][0] + 1) * (self.cells[0][1] + 1);
        let velocity = (0..mesh.node_count()).map(|node| map(self.velocities[usize::from(node >= upper)])).collect();
        Problem::<2>::builder(mesh)
            .material_of("upper", self.materials[0])
            .material_of("lower", self.materials[1])
            .initial_velocity(Initial::Nodal(velocity))
    }

    pub(crate) fn interface(&self) -> Interface {
        Interface::non_matching(2, "upper.bottom", "lower.top", self.friction).unwrap()
    }

    pub(crate) fn problem(&self) -> Problem<2> {
        self.bodies(self.mesh(), |v| v).interface(self.interface()).build().unwrap()
    }
}

/// Steps of 0.9 of the critical one until `end` (s).
pub(crate) fn steps(problem: &Problem<2>, end: f64) -> TimeGrid {
    TimeGrid::with_step(end, 0.9 * critical_time_step(problem)).unwrap()
}
