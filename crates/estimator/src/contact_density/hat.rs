//! Hats: tractions of a node on one of its edges that fall to zero within a part of the edge.

use crate::concentrated::EdgeTraction;
use crate::numbers::Reader;

/// A hat that is narrower than its edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NarrowHat<const D: usize> {
    /// Its node, by the position in the contact surface.
    pub(crate) node: usize,
    /// The first slot of its node in the contact surface: those of a node at two planes have one star.
    pub(crate) star: usize,
    /// Its edge, by the position among the candidate faces.
    pub(crate) face: usize,
    /// Position of the node in the face.
    pub(crate) end: usize,
    /// Position of the edge among the candidate edges of the star.
    pub(crate) edge: usize,
    /// Its width is the length of the edge over two to this power.
    pub(crate) halvings: usize,
    /// Its resultant (N).
    pub(crate) resultant: [f64; D],
    /// The same pulled back to the undeformed star, by the mean F of its elements: F̄⁻¹ of it.
    pub(crate) pulled: [f64; D],
}

impl<const D: usize> NarrowHat<D> {
    /// Appends it to numbers.
    pub(crate) fn append(&self, numbers: &mut Vec<f64>) {
        let counts = [self.node, self.star, self.face, self.end, self.edge, self.halvings];
        numbers.extend(counts.map(|count| count as f64));
        numbers.extend_from_slice(&self.resultant);
        numbers.extend_from_slice(&self.pulled);
    }

    /// A hat that was appended.
    pub(crate) fn read(numbers: &mut Reader<'_>) -> Self {
        let [node, star, face, end, edge, halvings] = [(); 6].map(|()| numbers.count());
        Self { node, star, face, end, edge, halvings, resultant: numbers.take(), pulled: numbers.take() }
    }

    /// Half of each of two tractions: both shapes, superposed. Sorted by stars, if they are.
    pub(crate) fn mean(start: &[Self], end: &[Self]) -> Vec<Self> {
        let half = |f: f64| 0.5 * f;
        let half = |hat: &Self| Self { resultant: hat.resultant.map(half), pulled: hat.pulled.map(half), ..*hat };
        let mut both: Vec<Self> = start.iter().chain(end).map(half).collect();
        both.sort_by_key(|hat| hat.star);
        both
    }

    /// Its width over the length of the edge.
    pub(crate) fn width(&self) -> f64 {
        0.5_f64.powi(self.halvings as i32)
    }

    /// Nodal values (N) of the linear traction with the same resultant and moment, at its node and at the other.
    pub(crate) fn equivalent(&self) -> [[f64; D]; 2] {
        let linear = EdgeTraction::hat(self.halvings).equivalent();
        linear.0.map(|[_, value]| self.resultant.map(|r| value * r))
    }

    /// Values of a field that is linear along the edge where the hat has its node and where it ends.
    fn ends(&self, nodal: &[f64; D]) -> [f64; 2] {
        let (near, far) = (nodal[self.end], nodal[1 - self.end]);
        [near, near + self.width() * (far - near)]
    }

    /// Mean of the positive part of a field, weighted by the hat.
    pub(crate) fn mean_positive(&self, nodal: &[f64; D]) -> f64 {
        let [a, b] = self.ends(nodal);
        mean_positive(a, b)
    }

    /// Mean of the absolute value of a field, weighted by the hat.
    pub(crate) fn mean_absolute(&self, nodal: &[f64; D]) -> f64 {
        2.0 * self.mean_positive(nodal) - self.mean_of(nodal)
    }

    /// Mean of a field, weighted by the hat.
    pub(crate) fn mean_of(&self, nodal: &[f64; D]) -> f64 {
        let [a, b] = self.ends(nodal);
        (2.0 * a + b) / 3.0
    }
}

/// ∫₀¹ 2(1 − s) max(a(1 − s) + bs, 0) ds.
fn mean_positive(a: f64, b: f64) -> f64 {
    if a <= 0.0 && b <= 0.0 {
        return 0.0;
    }
    if a >= 0.0 && b >= 0.0 {
        return (2.0 * a + b) / 3.0;
    }
    // Up to the zero, a triangle on the side of a; the rest follows from the mean.
    let zero = a / (a - b);
    let before = a * zero * (1.0 - zero / 3.0);
    if a > 0.0 { before } else { (2.0 * a + b) / 3.0 - before }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the midpoint rule, which converges with the square of the interval.
    #[test]
    fn positive_parts() {
        let count = 20_000;
        for (a, b) in [(1.0, 2.0), (1.0, -2.0), (-1.0, 2.0), (-0.1, 3.0), (-1.0, -2.0), (0.0, 1.0), (1.0, 0.0)] {
            let value = |k: usize| {
                let s = (k as f64 + 0.5) / count as f64;
                2.0 * (1.0 - s) * (a * (1.0 - s) + b * s).max(0.0)
            };
            let expected = (0..count).map(value).sum::<f64>() / count as f64;
            assert!((mean_positive(a, b) - expected).abs() < 1e-8, "{a} {b}");
        }
    }

    #[test]
    fn the_equivalent_has_resultant_and_moment() {
        let hat = NarrowHat {
            node: 0,
            star: 0,
            face: 0,
            end: 1,
            edge: 0,
            halvings: 3,
            resultant: [2.0, -1.0],
            pulled: [2.0, -1.0],
        };
        let [near, far] = hat.equivalent();
        for c in 0..2 {
            assert!((0.5 * (near[c] + far[c]) - hat.resultant[c]).abs() < 1e-15);
            // The centroid of a triangle of width ⅛ is at ⅓ of it.
            assert!((near[c] / 6.0 + far[c] / 3.0 - hat.resultant[c] / 24.0).abs() < 1e-15);
        }
    }
}
