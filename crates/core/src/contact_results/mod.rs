//! Contact results: force, gap, sliding and friction at each node of the contact surface, and their resultants.
//!
//! The scheme fixes the instant of each quantity. The reaction R_n determines a_n and the velocity v_{n+½} of the step
//! from t_n to t_{n+1}, at whose end the node is on the obstacle. Force, density, status and sliding velocity at t_n
//! are therefore those of R_n and of this step: a node is in contact at t_n if and only if it touches at t_{n+1}. Gap
//! and position are those of u_n. At the last t_n before the first touch the node has both a force and a gap.

mod averaged;
mod facing;
mod nearest;
mod recorder;
mod resultant;
mod summary;

pub use averaged::{AveragedPeak, stopping_times};
pub use nearest::Nearest;
pub use recorder::{ContactMemoryError, ContactRecorder};
pub use resultant::Resultant;
pub use summary::NodeSummary;

use crate::border::Vector;
use crate::contact::Status;
use crate::ids::NodeId;

/// Contact results of a run or a history, up to its last step.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactResults {
    /// Of the body.
    pub dimension: usize,
    /// t_n (s).
    pub instants: Vec<f64>,
    /// The nodes of the contact surface, in its order.
    pub nodes: Vec<ContactPoint>,
    /// One summary for each of them.
    pub summary: Vec<NodeSummary>,
    /// Resultants of all obstacles at each instant. Of two bodies that touch, they are those of the forces on the first
    /// one.
    pub total: Vec<Resultant>,
    /// Resultants of each obstacle at each instant: each plane, and each side of each interface.
    pub obstacles: Vec<Vec<Resultant>>,
    /// The farthest that two nodes of different bodies in contact were moved along their interface, over the length of
    /// their shortest edge; 0 without such nodes.
    pub slip: f64,
    /// The deepest that a node of a non-matching interface was inside the other body at its own place, along the
    /// normal, over the length of its shortest edge: its gap is a mean. 0 without such nodes.
    pub penetration: f64,
    /// Whether a node of a slave that has touched is at the end of its master: it faces nothing, or is a corner that
    /// faces so little of its edge that its gap is a mean, or that is beyond the end by less than 1e-3 of its edge.
    pub at_surface_end: bool,
    /// The largest inclination (rad) of surfaces of two bodies to the normal of their contact where forces act, or of a
    /// side on which a corner of the slave acts: forces have the direction of the normal.
    pub inclination: f64,
    /// The largest force, averaged over the time in which a wave crosses the struck element; none without force.
    pub averaged_peak: Option<AveragedPeak>,
    /// The gap that is left where nothing has touched; none without contact surface, or after any touch or force.
    pub nearest: Option<Nearest>,
    /// All nodes at all instants, if requested.
    pub steps: Option<ContactSteps>,
}

/// A node of the contact surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// The node.
    pub node: NodeId,
    /// The obstacle that it may touch.
    pub obstacle: usize,
    /// Its place in the undeformed mesh (m).
    pub point: Vector,
    /// Unit normal there, from the obstacle to the body.
    pub normal: Vector,
    /// ℓ_k: its share of the candidate faces, with thickness or section (m²), eq. \[45\]; on a body that turns that of
    /// all of its faces.
    pub area: f64,
}

/// All contact nodes at all instants, node by node and instant after instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactSteps {
    /// R_n (N), global axes. Over ℓ_k it is the density (Pa), eq. \[45\].
    pub force: Vec<f64>,
    /// Gap at t_n (m), eq. \[3\]; infinite at a node that faces nothing.
    pub gap: Vec<f64>,
    /// Tangential part of (u_{n+1} − u_n)/Δt_n (m/s), global axes, at the last instant that of the last step; 0 at a
    /// free node.
    pub sliding_velocity: Vec<f64>,
    /// Status under R_n.
    pub status: Vec<Status>,
    /// Energy dissipated by friction up to t_n (J).
    pub friction_energy: Vec<f64>,
    /// ℓ_k at t_n (m²) on a body that turns: of the undeformed faces, in proportion to how far they face the obstacle.
    /// Empty where it is always [`ContactPoint::area`].
    pub area: Vec<f64>,
}

impl ContactSteps {
    /// Bytes of one node at one instant, without its area.
    #[must_use]
    pub const fn bytes(dimension: usize) -> usize {
        (2 * dimension + 2) * size_of::<f64>() + size_of::<Status>()
    }

    /// Reserves memory for this many rows.
    fn reserve(&mut self, rows: usize, dimension: usize) -> Result<(), std::collections::TryReserveError> {
        self.force.try_reserve_exact(rows * dimension)?;
        self.gap.try_reserve_exact(rows)?;
        self.sliding_velocity.try_reserve_exact(rows * dimension)?;
        self.status.try_reserve_exact(rows)?;
        self.friction_energy.try_reserve_exact(rows)
    }
}

impl ContactResults {
    /// ℓ_k of a contact node at an instant (m²), by their numbers.
    #[must_use]
    pub fn area(&self, instant: usize, at: usize) -> f64 {
        let of_step = self.steps.as_ref().and_then(|steps| steps.area.get(instant * self.nodes.len() + at));
        of_step.copied().unwrap_or(self.nodes[at].area)
    }

    /// The instant at which the sum of all normal forces is largest. None without any force.
    #[must_use]
    pub fn peak(&self) -> Option<usize> {
        let forces = self.total.iter().map(|r| r.normal_force).enumerate();
        // The first of equal ones.
        let peak = forces.fold((0, 0.0), |best, (n, f)| if f > best.1 { (n, f) } else { best });
        (peak.1 > 0.0).then_some(peak.0)
    }

    /// The first instant at which any node touches (s).
    #[must_use]
    pub fn first_touch(&self) -> Option<f64> {
        self.summary.iter().filter_map(|s| s.first_touch).min_by(f64::total_cmp)
    }
}
