//! The block of the paper's §7.2 against a plane: aluminium, 50 × 40 mm, v = (400, −400) m/s.

use crate::reproduce::ReproduceError;
use percute_core::dynamics::critical_time_step;
use percute_core::material::Elastic;
use percute_core::mesh::TriangleMesh;
use percute_core::obstacle::Plane;
use percute_core::problem::{Initial, Problem, TriangleProblem};
use percute_core::time::TimeGrid;

/// Width and height (m), v₀ (m/s), Young's modulus (Pa), ν, ρ (kg/m³): §7.2.1.
const SIZE: [f64; 2] = [0.05, 0.04];
const VELOCITY: [f64; 2] = [400.0, -400.0];
const YOUNG: f64 = 70e9;
const POISSON: f64 = 0.3;
const DENSITY: f64 = 2700.0;

/// What the paper says of an impact, and what it leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block {
    /// Squares along x and y, each cut in two.
    pub(super) cells: [usize; 2],
    /// μ.
    pub(super) friction: f64,
    /// Δt/Δt_c.
    pub(super) courant: f64,
    /// Plane strain instead of plane stress.
    pub(super) strain: bool,
    /// Distance from the plane.
    pub(super) gap: Gap,
    /// The run ends with the first step past this instant (s).
    pub(super) past: f64,
}

/// The distance of a block from the plane at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Gap {
    /// As many steps until the impact: times Δt|v_y|.
    Steps(f64),
    /// Whole steps and a fraction of one, as near as that is to a length (m): so the impact falls on the same place inside
    /// a step, whatever the step is.
    Near { metres: f64, fraction: f64 },
}

/// A problem with its instants.
pub(super) struct Impact {
    pub(super) problem: TriangleProblem,
    pub(super) times: TimeGrid,
    /// When a rigid block would arrive at the plane (s).
    pub(super) arrival: f64,
}

impl Block {
    /// The assumptions of table 1 on a mesh: plane stress, a gap of 1.3 steps, the first step past 12 µs.
    pub(super) fn new(cells: [usize; 2]) -> Self {
        Self { cells, friction: 0.2, courant: 0.9, strain: false, gap: Gap::Steps(1.3), past: 12e-6 }
    }

    /// The problem and its steps.
    pub(super) fn impact(&self) -> Result<Impact, ReproduceError> {
        // Contact does not enter the critical step: any gap will do to find it.
        let critical = critical_time_step(&self.problem(1.0)?);
        let step = self.courant * critical;
        let travel = step * VELOCITY[1].abs();
        let steps = match self.gap {
            Gap::Steps(steps) => steps,
            Gap::Near { metres, fraction } => (metres / travel - fraction).round().max(1.0) + fraction,
        };
        let gap = steps * travel;
        let count = (self.past / step).floor() + 1.0;
        let times = TimeGrid::uniform(step * count, count as usize)?;
        let arrival = steps * step;
        Ok(Impact { problem: self.problem(gap)?, times, arrival })
    }

    fn problem(&self, gap: f64) -> Result<TriangleProblem, ReproduceError> {
        let material = if self.strain { Elastic::plane_strain } else { Elastic::plane_stress };
        let problem = Problem::builder(TriangleMesh::rectangle(SIZE[0], SIZE[1], self.cells[0], self.cells[1])?)
            .material(material(YOUNG, POISSON, DENSITY, 1.0)?)
            .initial_velocity(Initial::Uniform(VELOCITY))
            .obstacle(Plane::new([0.0, -gap], [0.0, 1.0], self.friction, None)?)
            .build()?;
        Ok(problem)
    }

    /// The mesh in words.
    pub(super) fn mesh(&self) -> String {
        mesh_name(self.cells)
    }
}

/// A mesh of squares cut in two, in words.
pub(super) fn mesh_name([nx, ny]: [usize; 2]) -> String {
    format!("{nx}×{ny}")
}
