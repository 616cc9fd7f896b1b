//! Pieces of the partition of two surfaces that slide along each other.

use percute_core::contact::{Coupling, SlidingSurfaces};

/// A part of the partition, on one edge of each surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// The edge of the slave, and its first node.
    pub(crate) slave: [usize; 2],
    /// The edge of the master, and its first node.
    pub(crate) master: [usize; 2],
    /// Its length along the tangent (m).
    pub(crate) length: f64,
    /// ξ of its ends (m), as that of the slave in the undeformed mesh.
    pub(crate) ends: [f64; 2],
    /// The hat of the second node of the edge of the slave at its ends.
    pub(crate) on_slave: [f64; 2],
    /// The same on the master.
    pub(crate) on_master: [f64; 2],
}

/// All pieces, in ascending order of ξ on each part of the slave.
pub(crate) fn pieces<'a, const D: usize>(
    sliding: &'a SlidingSurfaces<D>,
    coupling: &'a Coupling,
) -> impl Iterator<Item = Piece> + 'a {
    let hat = |ends: [f64; 2], from: f64, to: f64| ends.map(|end| ((end - from) / (to - from)).clamp(0.0, 1.0));
    coupling.segments().iter().map(move |segment| {
        let (first, other) = (sliding.slave().edges()[segment.slave], sliding.master().edges()[segment.master]);
        let part = sliding.slave().part_of_edge(segment.slave);
        let (xi, places) = (sliding.slave().xi(), coupling.places(part));
        Piece {
            slave: [segment.slave, first],
            master: [segment.master, other],
            length: segment.ends[1] - segment.ends[0],
            ends: segment.ends,
            on_slave: hat(segment.ends, xi[first], xi[first + 1]),
            on_master: hat(segment.ends, places[other], places[other + 1]),
        }
    })
}

impl Piece {
    /// At its ends, a field on the slave that is linear between nodes.
    #[inline]
    pub(crate) fn slave_values(&self, field: impl Fn(usize) -> f64) -> [f64; 2] {
        between(self.on_slave, field(self.slave[1]), field(self.slave[1] + 1))
    }

    /// The same on the master.
    #[inline]
    pub(crate) fn master_values(&self, field: impl Fn(usize) -> f64) -> [f64; 2] {
        between(self.on_master, field(self.master[1]), field(self.master[1] + 1))
    }

    /// The integral of the product of two fields with these values at its ends, linear between.
    #[inline]
    pub(crate) fn product(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        self.length / 6.0 * (a[0] * (2.0 * b[0] + b[1]) + a[1] * (b[0] + 2.0 * b[1]))
    }
}

fn between(hat: [f64; 2], first: f64, second: f64) -> [f64; 2] {
    hat.map(|hat| first * (1.0 - hat) + second * hat)
}
