//! Small models, of which a step has little work: 200 elements, and 272 that are graded towards a corner.

use crate::block::{COURANT, material};
use crate::{Block, Failure};
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};

/// Cells along x and y of a block of 50 × 40 mm.
const CELLS: [usize; 2] = [10, 10];

/// How often the elements at the corner are bisected.
const GRADINGS: usize = 6;

/// How a small block strikes its plane, with friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Small {
    /// With its bottom, at 400 m/s.
    Flat,
    /// With a corner, turned by 10°, at 4 m/s.
    Corner,
    /// The same, with smaller and smaller elements at the corner.
    Graded,
}

impl Small {
    /// All of them, with their names and a number of steps that is some full windows.
    pub const ALL: [(Self, &'static str, usize); 3] =
        [(Self::Flat, "flat", 80), (Self::Corner, "corner", 800), (Self::Graded, "graded corner", 800)];

    /// Angle of the plane (°), speed towards it (m/s) and distance (m).
    fn impact(self) -> [f64; 3] {
        if self == Self::Flat { [0.0, 400.0, 1e-4] } else { [10.0, 4.0, 1e-6] }
    }

    fn mesh(self) -> Result<Mesh, Failure> {
        let mut mesh = Mesh::rectangle(0.05, 0.04, CELLS[0], CELLS[1])?;
        for _ in 0..if self == Self::Graded { GRADINGS } else { 0 } {
            let at_corner =
                |e: usize| mesh.nodes_of::<3>()[e].iter().any(|n| mesh.points_in::<2>()[n.index()] == [0.0; 2]);
            mesh = mesh.refined_where(|e| at_corner(e.index()))?;
        }
        Ok(mesh)
    }
}

/// The block.
///
/// # Errors
/// None with these numbers.
pub fn small(kind: Small) -> Result<Block, Failure> {
    let [angle, speed, gap] = kind.impact();
    let normal = [angle.to_radians().sin(), angle.to_radians().cos()];
    let builder = Problem::<2>::builder(kind.mesh()?)
        .material(material()?)
        .initial_velocity(Initial::Uniform(normal.map(|n| -speed * n)))
        // The corner of the block is the origin.
        .obstacle(Obstacle::plane(normal.map(|n| -gap * n), normal, 0.2, None)?);
    let given = builder.build()?;
    let step = COURANT * critical_time_step(&given);
    let problem = given.mesh().local_numbering().map_or_else(|| given.clone(), |order| given.renumbered(&order));
    Ok(Block { problem, step, gap })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{simulated, wall};

    /// Contact is part of every measurement: the plane stops the nodes that would fly through it.
    #[test]
    fn the_plane_stops_small_blocks() {
        for (kind, name, steps) in Small::ALL {
            let block = small(kind).unwrap();
            assert_eq!(block.elements(), if kind == Small::Graded { 272 } else { 200 }, "{name}");
            let [angle, speed, gap] = kind.impact();
            let (sin, cos) = angle.to_radians().sin_cos();
            let (_, displacement) = simulated(&block, steps, Some(1), wall).unwrap();
            let points = block.problem.mesh().points_in::<2>().iter().zip(displacement.chunks_exact(2));
            let lowest = points.map(|(p, u)| sin * (p[0] + u[0]) + cos * (p[1] + u[1])).fold(f64::INFINITY, f64::min);
            assert!(speed * block.step * steps as f64 > 2.0 * gap, "{name}");
            // Rounding of places.
            assert!(lowest > -gap - 1e-12, "{name}: {lowest}");
        }
    }
}
