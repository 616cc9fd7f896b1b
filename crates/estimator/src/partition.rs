//! Pieces of the partition of a non-matching interface.

use percute_core::contact::{Coupling, NonMatchingSurfaces};

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
    non_matching: &'a NonMatchingSurfaces<D>,
    coupling: &'a Coupling,
) -> impl Iterator<Item = Piece> + 'a {
    let hat = |ends: [f64; 2], from: f64, to: f64| ends.map(|end| ((end - from) / (to - from)).clamp(0.0, 1.0));
    coupling.segments().iter().map(move |segment| {
        let (first, other) =
            (non_matching.slave().edges()[segment.slave], non_matching.master().edges()[segment.master]);
        let part = non_matching.slave().part_of_edge(segment.slave);
        let (xi, places) = (non_matching.slave().xi(), coupling.places(part));
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

/// A place on an edge of the slave, from 0 to 1, at which a density has a break.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Break {
    pub(crate) edge: usize,
    pub(crate) place: f64,
}

impl Piece {
    /// Its parts between the breaks inside of it. Those within rounding of its ends are none.
    pub(crate) fn cut(self, breaks: &[Break]) -> impl Iterator<Item = Self> {
        const NEAR: f64 = 1e-12;
        let [start, end] = self.on_slave;
        let inside = |at: &Break| at.edge == self.slave[0] && start + NEAR < at.place && at.place < end - NEAR;
        let mut places: Vec<f64> = breaks.iter().filter(|at| inside(at)).map(|at| at.place).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|next, last| *next < *last + NEAR);
        places.push(end);
        places.into_iter().scan(start, move |from, to| {
            let ends = [std::mem::replace(from, to), to];
            let parts = ends.map(|place| (place - start) / (end - start));
            let at = |values: [f64; 2]| parts.map(|part| values[0] + part * (values[1] - values[0]));
            let length = self.length * (parts[1] - parts[0]);
            Some(Self { length, ends: at(self.ends), on_slave: ends, on_master: at(self.on_master), ..self })
        })
    }

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
