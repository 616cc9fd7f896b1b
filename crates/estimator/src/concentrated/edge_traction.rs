//! Tractions on an edge at a node, linear between break points.

use super::HATS;
use nalgebra::DMatrix;

/// A traction along an edge, from the node of a star (place 0) to the other node (place 1): linear between break
/// points, zero before the first and after the last.
///
/// Each break point is a place and the value there, times the length of the edge: its integral over places is its
/// resultant. Where it jumps, two break points have one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EdgeTraction<const P: usize>(pub(crate) [[f64; 2]; P]);

impl EdgeTraction<2> {
    /// The hat of resultant 1 that falls to zero within the length of the edge over two to this power.
    pub(crate) fn hat(halvings: usize) -> Self {
        let width = 0.5_f64.powi(halvings as i32);
        Self([[0.0, 2.0 / width], [width, 0.0]])
    }

    /// Unit hats of all widths below that of the edge, the widest first.
    pub(crate) fn narrow_hats() -> impl Iterator<Item = Self> {
        (1..=HATS).map(Self::hat)
    }
}

impl<const P: usize> EdgeTraction<P> {
    /// Moments with the shape functions of both nodes, the near one first. Their sum is the resultant; the second is
    /// the moment about the node.
    pub(crate) fn moments(&self) -> [f64; 2] {
        moments(&self.0)
    }

    /// The traction that is linear over the whole edge, with the same moments.
    pub(crate) fn equivalent(&self) -> EdgeTraction<2> {
        let [near, far] = self.moments();
        EdgeTraction([[0.0, 4.0 * near - 2.0 * far], [1.0, 4.0 * far - 2.0 * near]])
    }

    /// Values at both ends of a piece of the edge that has no break points inside.
    pub(crate) fn on(&self, piece: [f64; 2]) -> [f64; 2] {
        on(&self.0, piece)
    }
}

/// [`EdgeTraction::moments`] of any number of break points.
pub(super) fn moments(points: &[[f64; 2]]) -> [f64; 2] {
    let (mut resultant, mut far) = (0.0, 0.0);
    for span in points.windows(2) {
        let [[a, ta], [b, tb]] = [span[0], span[1]];
        resultant += 0.5 * (b - a) * (ta + tb);
        far += (b - a) * (ta * (2.0 * a + b) + tb * (a + 2.0 * b)) / 6.0;
    }
    [resultant - far, far]
}

/// [`EdgeTraction::on`] of any number of break points.
pub(super) fn on(points: &[[f64; 2]], [start, end]: [f64; 2]) -> [f64; 2] {
    let middle = 0.5 * (start + end);
    let span = points.windows(2).find(|span| span[0][0] < middle && middle < span[1][0]);
    let value = |[[a, ta], [b, tb]]: [[f64; 2]; 2], at: f64| ta + (tb - ta) * (at - a) / (b - a);
    span.map_or([0.0; 2], |span| [start, end].map(|at| value([span[0], span[1]], at)))
}

/// A traction on the first (0) or the last edge of a star (1).
pub(super) type OnEdge<const P: usize> = (usize, EdgeTraction<P>);

/// Break points that differ by less are one: rounding of the places. Others differ by 1e-6 of the edge.
const SAME_BREAK: f64 = 1e-9;

/// Radii of rings, from 1 down to the first break point: break points, and rings of one ratio near a half between them.
/// With halves, a ring of no width could be left, in which a stress has no digits.
pub(super) fn radii(places: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut breaks: Vec<f64> = places.collect();
    breaks.retain(|place| *place > 0.0 && *place < 1.0);
    breaks.sort_by(|a, b| b.total_cmp(a));
    let mut radii = vec![1.0];
    for next in breaks {
        let last = radii[radii.len() - 1];
        if next < last * (1.0 - SAME_BREAK) {
            let rings = (last / next).log2().round().max(1.0);
            let ratio = (next / last).powf(1.0 / rings);
            radii.extend((1..rings as i32).map(|k| last * ratio.powi(k)));
            radii.push(next);
        }
    }
    radii
}

/// Forces of balanced tractions on a piece of the first and the last edge: two components at its inner and its outer
/// end.
pub(super) fn forces<const P: usize>(piece: [f64; 2], tractions: &[OnEdge<P>]) -> [DMatrix<f64>; 2] {
    let mut forces = [(); 2].map(|()| DMatrix::zeros(4, 2 * tractions.len()));
    for (k, (edge, traction)) in tractions.iter().enumerate() {
        let (own, linear) = (traction.on(piece), traction.equivalent().on(piece));
        for (end, (own, linear)) in own.into_iter().zip(linear).enumerate() {
            let force = (piece[1] - piece[0]) * (own - linear);
            (0..2).for_each(|c| forces[*edge][(2 * end + c, 2 * k + c)] = force);
        }
    }
    forces
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A trapezoid beside the node, with a jump, and a hat.
    const PATCH: EdgeTraction<5> = EdgeTraction([[0.1, 0.0], [0.3, 2.0], [0.55, 3.0], [0.55, 1.0], [0.8, -0.5]]);

    /// A break that is a power of two but for rounding leaves no ring of no width; exact powers are the radii.
    #[test]
    fn rings_have_a_width() {
        for power in [1, 2, 5, 9] {
            for off in [0.0, 1e-15, 1e-9, -1e-9, 1e-4, 0.3] {
                let place = 0.5_f64.powi(power) * (1.0 - off);
                let radii = radii([place, 0.0, 1.0].into_iter());
                assert_eq!((radii[0], radii[radii.len() - 1]), (1.0, place));
                for pair in radii.windows(2) {
                    let ratio = pair[1] / pair[0];
                    assert!((0.35..0.71).contains(&ratio), "{power} {off:e}: {radii:?}");
                    assert!(off != 0.0 || ratio == 0.5);
                }
            }
        }
    }

    /// Nor do breaks that are equal but for rounding, also at the end of the edge.
    #[test]
    fn equal_breaks_are_one() {
        let radii = radii([1.0 - 1.2e-16, 0.4, 0.4 * (1.0 - 2e-16), 0.1].into_iter());
        assert_eq!(radii, [1.0, 0.4, 0.2, 0.1]);
    }

    /// Σ of the midpoint rule on intervals that have no break inside: of second order.
    fn integral(f: impl Fn(f64) -> f64) -> f64 {
        let count = 20_000;
        (0..count).map(|k| f((f64::from(k) + 0.5) / f64::from(count))).sum::<f64>() / f64::from(count)
    }

    #[test]
    fn moments_are_integrals() {
        fn check<const P: usize>(traction: EdgeTraction<P>) {
            let at = |s: f64| traction.on([s - 1e-5, s + 1e-5]).iter().sum::<f64>() / 2.0;
            let [near, far] = traction.moments();
            // Midpoint rule: values near 2000 on intervals of 5e-5.
            assert!((near - integral(|s| at(s) * (1.0 - s))).abs() < 1e-5, "{near}");
            assert!((far - integral(|s| at(s) * s)).abs() < 1e-5, "{far}");
        }
        check(PATCH);
        (0..=3).for_each(|halvings| check(EdgeTraction::hat(halvings)));
    }

    #[test]
    fn equivalents_have_the_same_moments() {
        for (found, wanted) in [
            (PATCH.equivalent().moments(), PATCH.moments()),
            (EdgeTraction::hat(3).equivalent().moments(), [1.0 - 1.0 / 24.0, 1.0 / 24.0]),
            (EdgeTraction::hat(0).equivalent().moments(), EdgeTraction::hat(0).moments()),
        ] {
            assert!((0..2).all(|k| (found[k] - wanted[k]).abs() < 1e-15), "{found:?} {wanted:?}");
        }
    }

    #[test]
    fn values_are_those_between_breaks() {
        assert_eq!(PATCH.on([0.0, 0.1]), [0.0; 2]);
        assert_eq!(PATCH.on([0.9, 1.0]), [0.0; 2]);
        let [a, b] = PATCH.on([0.55, 0.675]);
        assert!((a - 1.0).abs() < 1e-15 && (b - 0.25).abs() < 1e-15, "{a} {b}");
        let [a, b] = PATCH.on([0.3, 0.55]);
        assert!((a - 2.0).abs() < 1e-15 && (b - 3.0).abs() < 1e-15, "{a} {b}");
    }
}
