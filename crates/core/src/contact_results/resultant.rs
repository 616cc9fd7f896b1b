//! Sums over the nodes of one obstacle, or of all.

use crate::border::Vector;
use crate::contact::Status;

/// Sums over the nodes of one obstacle, or of all, at t_n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resultant {
    /// ΣR_n (N), global axes.
    pub force: Vector,
    /// Sum of the normal components (N).
    pub normal_force: f64,
    /// Impulse given to the body up to t_n (N s): what contact adds to its momentum, from v₀ to v_n.
    pub impulse: Vector,
    /// Area of contact (m²): the shares of the nodes that are not free.
    pub area: f64,
    /// Number of nodes that are not free.
    pub in_contact: usize,
    /// Number of these that slip.
    pub slipping: usize,
    /// Energy dissipated by friction up to t_n (J).
    pub friction_energy: f64,
    /// Centre of pressure (m): the mean place of the nodes at t_n, by normal force; none without a normal force.
    pub centre: Option<Vector>,
}

/// One node at t_n.
pub(super) struct Share {
    pub(super) force: Vector,
    pub(super) normal_force: f64,
    pub(super) area: f64,
    pub(super) status: Status,
    pub(super) friction_energy: f64,
    pub(super) place: Vector,
}

/// Sums of shares.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sum {
    resultant: Resultant,
    /// Σ of normal force times place (N m).
    moment: Vector,
}

impl Sum {
    pub(super) fn new() -> Self {
        let resultant = Resultant {
            force: [0.0; 3],
            normal_force: 0.0,
            impulse: [0.0; 3],
            area: 0.0,
            in_contact: 0,
            slipping: 0,
            friction_energy: 0.0,
            centre: None,
        };
        Self { resultant, moment: [0.0; 3] }
    }

    pub(super) fn add(&mut self, share: &Share) {
        let sum = &mut self.resultant;
        sum.friction_energy += share.friction_energy;
        (0..3).for_each(|c| sum.force[c] += share.force[c]);
        // Nodes beside the contact of non-matching interfaces are pulled: forces of their multipliers have both signs.
        sum.normal_force += share.normal_force;
        (0..3).for_each(|c| self.moment[c] += share.normal_force * share.place[c]);
        if share.status == Status::Free {
            return;
        }
        sum.area += share.area;
        sum.in_contact += 1;
        sum.slipping += usize::from(share.status == Status::Slip);
    }

    /// The resultant at t_n; its impulse goes on from that `before`, `step` seconds ago.
    pub(super) fn finish(self, before: Option<&Resultant>, step: f64) -> Resultant {
        let mut done = self.resultant;
        if let Some(before) = before {
            done.impulse = before.impulse;
            (0..3).for_each(|c| done.impulse[c] += 0.5 * step * (before.force[c] + done.force[c]));
        }
        done.centre =
            (done.in_contact > 0 && done.normal_force > 0.0).then(|| self.moment.map(|m| m / done.normal_force));
        done
    }
}
