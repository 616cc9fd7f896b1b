//! The gaps of a non-matching interface before the run.

use crate::contact::{ContactSurface, Coupling, NonMatchingSurfaces, Side};

/// A non-matching interface, with the displacements of all nodes of the mesh (m).
pub(super) struct Gaps<'a, const D: usize> {
    pub(super) surface: &'a ContactSurface<D>,
    pub(super) non_matching: &'a NonMatchingSurfaces<D>,
    pub(super) displacement: &'a [[f64; D]],
}

impl<const D: usize> Gaps<'_, D> {
    /// The least distance (m), at places of nodes of one surface where the other one is, and that node, as its position
    /// in the contact surface.
    pub(super) fn least(&self) -> Option<(f64, usize)> {
        let coupling = self.coupling();
        let (slave, master) = (self.non_matching.slave(), self.non_matching.master());
        // η on an edge, at a place between those of its nodes, and the node that is there.
        let on = |side: &Side, first: usize, [low, high]: [f64; 2], xi: f64| {
            let eta = [first, first + 1].map(|k| self.eta(side, k));
            let part = (xi - low) / (high - low);
            let node = if xi == low { Some(first) } else { (xi == high).then_some(first + 1) };
            ((1.0 - part) * eta[0] + part * eta[1], node.map(|k| side.position(k)))
        };
        let mut least: Option<(f64, usize)> = None;
        for segment in coupling.segments() {
            let (own, other) = (slave.edges()[segment.slave], master.edges()[segment.master]);
            let places = coupling.places(slave.part_of_edge(segment.slave));
            for xi in segment.ends {
                let (up, of_slave) = on(slave, own, slave.ends(own), xi);
                let (down, of_master) = on(master, other, [places[other], places[other + 1]], xi);
                let Some(at) = of_slave.or(of_master) else { continue };
                if least.is_none_or(|(gap, _)| up - down < gap) {
                    least = Some((up - down, at));
                }
            }
        }
        least
    }

    /// Of surfaces that do not face each other yet, how far (m) the slave is behind the master, and its deepest node as
    /// a position in the contact surface.
    pub(super) fn behind(&self) -> Option<(f64, usize)> {
        if !self.coupling().segments().is_empty() {
            return None;
        }
        let (slave, master) = (self.non_matching.slave(), self.non_matching.master());
        let nodes = (0..slave.len()).map(|k| (self.eta(slave, k), slave.position(k)));
        let (low, at) = nodes.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let high = (0..master.len()).map(|k| self.eta(master, k)).max_by(f64::total_cmp)?;
        Some((high - low, at))
    }

    fn coupling(&self) -> Coupling {
        self.non_matching.coupling(self.surface, self.displacement)
    }

    /// η of a node of a side (m).
    fn eta(&self, side: &Side, k: usize) -> f64 {
        self.non_matching.eta(self.surface, side, k, self.displacement)
    }
}
