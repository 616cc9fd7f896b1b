//! The conditions of contact at a step: at planes and of pairs those of the nodes, of non-matching interfaces those of
//! the multipliers of the slave, with weighted gaps and motions.

use super::balance::Balance;
use super::window::{Window, rows_of};
use percute_core::border::Vector;
use percute_core::contact::AnyContactConfiguration;

/// The conditions of the step after an instant, by their positions in the contact surface.
#[derive(Clone, Debug)]
pub(super) struct Conditions<'p> {
    /// With D and M of the step.
    configuration: AnyContactConfiguration<'p>,
}

impl<'p> Conditions<'p> {
    /// Of the step after `window.now`.
    pub(super) fn of(balance: &Balance<'p>, window: Window<'_>) -> Self {
        let problem = balance.problem();
        // Elsewhere nothing depends on the place.
        let configuration = if problem.non_matching_count() == 0 {
            problem.configuration(&[])
        } else {
            problem.configuration(&rows_of(&balance.predicted(window.before, window.now), problem.dimension()))
        };
        Self { configuration }
    }

    /// Whether there is one at a node of the surface.
    pub(super) fn holds(&self, at: usize) -> bool {
        self.configuration.has_condition(at)
    }

    /// The forces that they are about (N), from those on the nodes.
    pub(super) fn forces(&self, reaction: &[f64]) -> Vec<f64> {
        self.configuration.forces(reaction)
    }

    /// The gap of one (m) with these displacements of all nodes; infinite where there is none.
    pub(super) fn gap(&self, at: usize, displacement: &[f64]) -> f64 {
        if self.holds(at) { self.configuration.gap(at, displacement) } else { f64::INFINITY }
    }

    /// How far one gives way (m) under the forces of all (N): its gap plus this is 0 where it is closed.
    pub(super) fn give(&self, at: usize, forces: &[f64]) -> f64 {
        self.configuration.give(at, forces)
    }

    /// The smallest of its gaps (m) with these.
    pub(super) fn nearest(&self, at: usize, displacements: &[Vec<f64>]) -> f64 {
        displacements.iter().map(|displacement| self.gap(at, displacement)).fold(f64::INFINITY, f64::min)
    }

    /// A nodal field against what the node faces.
    pub(super) fn relative(&self, at: usize, field: &[f64]) -> Vector {
        self.configuration.relative(at, field)
    }

    /// Gives masters the status that follows from that of their slaves.
    pub(super) fn settle_masters(&self, touching: &mut [bool]) {
        self.configuration.settle_masters(touching);
    }
}
