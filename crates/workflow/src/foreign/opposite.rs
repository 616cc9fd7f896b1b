//! The forces on two surfaces that slide are those of the same multipliers.

use super::balance::norm;
use percute_core::contact::{ContactSurface, Side, SlidingSurfaces};

/// Sums of forces on two surfaces that slide, against those of their multipliers: the largest of all instants.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Opposite {
    /// The force on the slave beyond that of the multipliers (N): nodes that face nothing have none.
    lost: f64,
    /// The force on the master beyond the opposite one (N).
    one_sided: f64,
    /// The sum of the sizes of all forces (N).
    size: f64,
}

impl Opposite {
    /// Takes in an instant, with the forces on the nodes and those of the multipliers (N).
    pub(super) fn take<const D: usize>(
        &mut self,
        sliding: &SlidingSurfaces<D>,
        reaction: &[[f64; D]],
        forces: &[[f64; D]],
    ) {
        let [slave, master] = [sliding.slave(), sliding.master()];
        let total = |of: &[[f64; D]], side: &Side| -> [f64; D] {
            let forces = &of[side.position(0)..side.position(side.len())];
            std::array::from_fn(|c| forces.iter().map(|force| force[c]).sum())
        };
        let (multipliers, on_slave, on_master) =
            (total(forces, slave), total(reaction, slave), total(reaction, master));
        let size: f64 = sliding.positions().map(|at| norm(&reaction[at])).sum();
        let lost = norm(&std::array::from_fn::<_, D, _>(|c| on_slave[c] - multipliers[c]));
        let one_sided = norm(&std::array::from_fn::<_, D, _>(|c| on_master[c] + multipliers[c]));
        self.lost = self.lost.max(lost);
        self.one_sided = self.one_sided.max(one_sided);
        self.size = self.size.max(size);
    }

    /// The larger of both differences, over the sum of the sizes.
    pub(super) fn share(&self) -> f64 {
        super::ratio(self.lost.max(self.one_sided), self.size)
    }

    /// What is wrong with the forces on these surfaces.
    pub(super) fn cause<const D: usize>(&self, surface: &ContactSurface<D>, sliding: &SlidingSurfaces<D>) -> String {
        let [slave, master] = groups(surface, sliding);
        if self.lost >= self.one_sided {
            return format!(
                "contact forces act on nodes of {slave} that do not face {master}: is the order of the rows that of \
                 `contact_nodes`?"
            );
        }
        format!(
            "the contact forces on {slave} and on {master} are not opposite: give the force on each node of both surfaces, \
             as it acts on that node"
        )
    }
}

/// The names of slave and master, for messages.
pub(super) fn groups<const D: usize>(surface: &ContactSurface<D>, sliding: &SlidingSurfaces<D>) -> [String; 2] {
    [sliding.slave(), sliding.master()].map(|side| {
        let obstacle = surface.nodes()[side.position(0)].obstacle;
        format!("\"{}\"", surface.obstacles()[obstacle].group().unwrap_or_default())
    })
}
