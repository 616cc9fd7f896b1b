//! The block of all measurements.

use crate::{Failure, Order};
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::material::{Elastic, MaterialError};
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use std::sync::Arc;

/// Cells along x and y: 640, 40 960 and 655 360 elements.
pub const SIZES: [[usize; 2]; 3] = [[20, 16], [160, 128], [640, 512]];

/// Speed towards the plane and along it (m/s).
const SPEED: f64 = 400.0;

/// Time step over critical time step.
pub(crate) const COURANT: f64 = 0.9;

/// What the block does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// It flies at an angle towards a plane with friction and touches in the second step.
    Impact,
    /// It vibrates in free flight, from a uniform rate of strain.
    Free,
}

/// A problem and its time step.
#[derive(Clone, Debug)]
pub struct Block {
    /// The problem, numbered for locality as every run numbers it.
    pub problem: Problem<2>,
    /// The step (s).
    pub step: f64,
    /// Distance of the plane from the bottom of the block (m).
    pub gap: f64,
}

/// Aluminium in plane stress, one metre thick.
///
/// # Errors
/// None with these numbers.
pub fn material() -> Result<Elastic, MaterialError> {
    Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0)
}

impl Block {
    /// A block of `nx` × `ny` cells of two triangles.
    ///
    /// # Errors
    /// No cells.
    pub fn new(cells: [usize; 2], order: Order, motion: Motion) -> Result<Self, Failure> {
        let mesh = order.mesh(cells)?;
        let numbering = mesh.local_numbering();
        // The step of a block without a plane: the critical step does not depend on it.
        let free = problem(mesh, Motion::Free, 0.0)?;
        let step = COURANT * critical_time_step(&free);
        let gap = 1.5 * SPEED * step;
        let given = if motion == Motion::Free { free } else { problem(Arc::clone(free.mesh()), motion, gap)? };
        let problem = numbering.map_or_else(|| given.clone(), |numbering| given.renumbered(&numbering));
        Ok(Self { problem, step, gap })
    }

    /// Number of elements.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.problem.mesh().element_count()
    }
}

/// The block on a mesh of it, this far (m) from its plane.
///
/// # Errors
/// A mesh of another body.
pub fn problem(mesh: impl Into<Arc<Mesh>>, motion: Motion, gap: f64) -> Result<Problem<2>, Failure> {
    let mesh = mesh.into();
    // ±SPEED at the sides, so that strain starts at once.
    let spread = |p: &[f64; 2]| [SPEED * (p[0] / 0.025 - 1.0), SPEED * (1.0 - p[1] / 0.02)];
    let velocity = match motion {
        Motion::Impact => Initial::Uniform([SPEED, -SPEED]),
        Motion::Free => Initial::Nodal(mesh.points_in::<2>().iter().map(spread).collect()),
    };
    let mut builder = Problem::<2>::builder(mesh).material(material()?).initial_velocity(velocity);
    if motion == Motion::Impact {
        builder = builder.obstacle(Obstacle::plane([0.0, -gap], [0.0, 1.0], 0.2, None)?);
    }
    Ok(builder.build()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{simulated, wall};

    /// Nothing touches before the second step, and the bottom does in it: contact is part of every measurement.
    #[test]
    fn the_block_touches_in_the_second_step() {
        let block = Block::new([5, 4], Order::Structured, Motion::Impact).unwrap();
        let lowest = |steps| {
            let (_, displacement) = simulated(&block, steps, Some(1), wall).unwrap();
            displacement.chunks_exact(2).map(|u| u[1]).fold(f64::INFINITY, f64::min)
        };
        // Rounding of the step in the sum of instants.
        assert!((lowest(1) + SPEED * block.step).abs() < 1e-12 * block.gap);
        assert!((lowest(2) + SPEED * 2.0 * block.step).abs() < 1e-12 * block.gap);
    }
}
