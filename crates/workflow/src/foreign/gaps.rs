//! Gaps of nodes under contact forces: the same everywhere, or growing along the plane, where the plane is at another
//! place.

/// Gaps under a force lie on a line if their standard deviation from it is below their size over this. Contact by a
/// penalty has a deviation of 0.05 (a bar) to 6 times the mean.
const SAME: f64 = 100.0;
/// A slope follows from the gaps of so many nodes at least: a single node that slides into a penalty has a line, too.
const NODES: usize = 3;
/// Larger slopes (rad) are no small mistake of a normal.
const STEEP: f64 = 0.1;

/// The line of gaps over the place along the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    /// Its mean (m) and slope; 0 if they are the same everywhere.
    pub(super) mean: f64,
    pub(super) slope: f64,
    /// The root mean square of its gaps (m), and the standard deviation from it.
    pub(super) size: f64,
    deviation: f64,
}

impl Line {
    /// The part of the gaps that is on the line (m).
    fn common(&self) -> f64 {
        self.size - SAME * self.deviation
    }
}

/// Sums over gaps under forces, weighted with the square of the normal force (N²).
#[derive(Clone, Debug)]
pub(super) struct Gaps {
    /// The weights, gap, gap², undeformed gap times path along the normal, path² (m), and the place along the plane
    /// (m), its square and its product with the gap.
    sums: [f64; 8],
    /// Nodes of the surface that count.
    nodes: Vec<bool>,
}

impl Gaps {
    /// Of a surface with so many nodes.
    pub(super) fn new(nodes: usize) -> Self {
        Self { sums: [0.0; 8], nodes: vec![false; nodes] }
    }

    /// Adds a gap, its place along the plane, and the path along the normal to it (m), of a node of the surface with a
    /// normal force (N).
    pub(super) fn add(&mut self, node: usize, force: f64, [gap, along]: [f64; 2], path: f64) {
        let terms = [1.0, gap, gap * gap, (gap - path) * path, path * path, along, along * along, along * gap];
        self.sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += force * force * term);
        self.nodes[node] |= force > 0.0;
    }

    /// The line nearest to the gaps, without a slope where that is enough.
    fn nearest(&self) -> Option<Line> {
        let [weight, gap, square, _, _, along, along_square, product] = self.sums;
        if weight <= 0.0 {
            return None;
        }
        let (mean, place) = (gap / weight, along / weight);
        let variance = (square / weight - mean * mean).max(0.0);
        let flat = Line { mean, slope: 0.0, size: mean.abs(), deviation: variance.sqrt() };
        let spread = along_square / weight - place * place;
        let slope = (product / weight - mean * place) / spread;
        let many = self.nodes.iter().filter(|counts| **counts).count() >= NODES;
        if flat.common() > 0.0 || !many || slope.is_nan() || slope.abs() > STEEP {
            return Some(flat);
        }
        let linear = slope * slope * spread;
        let (size, deviation) = ((mean * mean + linear).sqrt(), (variance - linear).max(0.0).sqrt());
        Some(Line { mean, slope, size, deviation })
    }

    /// That line, if the gaps are on it.
    pub(super) fn line(&self) -> Option<Line> {
        self.nearest().filter(|line| line.common() > 0.0)
    }

    /// The part of the gaps that is on a line (m), at most 0 if they are on none.
    pub(super) fn common(&self) -> Option<f64> {
        self.nearest().map(|line| line.common())
    }

    /// The factor of the path that brings the nodes onto their plane.
    pub(super) fn path(&self) -> Option<f64> {
        let factor = -self.sums[3] / self.sums[4];
        (factor.is_finite() && factor > 0.0).then_some(factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gaps(of: impl Fn(usize, f64) -> f64) -> Gaps {
        let mut gaps = Gaps::new(5);
        for k in 0..40 {
            let along = 0.01 * (k % 5) as f64 + 1e-4 * (k / 5) as f64;
            gaps.add(k % 5, 1.0 + k as f64, [of(k, along), along], 1e-5);
        }
        gaps
    }

    #[test]
    fn a_moved_and_a_turned_plane_are_found() {
        let moved = gaps(|_, _| 2e-6).line().unwrap();
        assert!((moved.mean - 2e-6).abs() < 1e-18 && moved.slope == 0.0);
        let turned = gaps(|_, along| 2e-6 - 1e-3 * along).line().unwrap();
        // Sums of squares lose half of the digits.
        assert!((turned.slope + 1e-3).abs() < 1e-9, "{turned:?}");
        // A penalty: the gap varies at each node.
        assert!(gaps(|k, along| -1e-6 * (1.0 + (k % 7) as f64) - 1e-5 * along).line().is_none());
        // A slope of 45 degrees is that of a node on its way.
        assert!(gaps(|_, along| -along).line().is_none());
    }
}
