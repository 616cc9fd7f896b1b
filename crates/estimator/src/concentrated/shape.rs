//! The shape of the traction of one node: its share and its width on each candidate edge.

use super::HATS;
use nalgebra::DMatrix;

/// A hat on one edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hat {
    /// Its share of the resultant, between 0 and 1.
    pub(crate) share: f64,
    /// Its width is the length of the edge over two to this power.
    pub(crate) halvings: usize,
}

impl Hat {
    /// Part of the resultant that its linear equivalent has at the far node of the edge.
    pub(crate) fn far(&self) -> f64 {
        0.5_f64.powi(self.halvings as i32) / 3.0
    }
}

/// Weight of the distance of the shares from the tributary ones. From 0.1 to 1, results change by 6 % at most.
const TRIBUTARY: f64 = 0.3;

/// The force of a node with its edges, per unit of thickness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pressed<'a> {
    /// The force (N/m), and its normal part.
    pub(crate) force: [f64; 2],
    pub(crate) normal: f64,
    /// 1 over the plane modulus (1/Pa).
    pub(crate) compliance: f64,
    /// Gap at the far end less that at the node, each at least 0 (m), edge by edge.
    pub(crate) gaps: &'a [f64],
    /// Tributary shares.
    pub(crate) tributary: &'a [f64],
    /// ∫τ:K⁻¹τ over the star.
    pub(crate) energy: &'a DMatrix<f64>,
}

impl Pressed<'_> {
    /// The shape of least gap energy and stress energy.
    pub(crate) fn shape(&self) -> Vec<Hat> {
        // Wide hats have no more gap than narrow ones where no edge leaves the plane.
        if self.gaps.iter().all(|gap| *gap <= 0.0) {
            return self.tributary.iter().map(|&share| Hat { share, halvings: 0 }).collect();
        }
        match self.gaps {
            [_] => self.best((0..=HATS).map(|k| vec![Hat { share: 1.0, halvings: k }])),
            _ => {
                let pairs = (0..=HATS).flat_map(|a| (0..=HATS).map(move |b| [a, b]));
                self.best(pairs.map(|pair| self.shared(pair)))
            }
        }
    }

    fn best(&self, shapes: impl Iterator<Item = Vec<Hat>>) -> Vec<Hat> {
        let ranked = shapes.map(|shape| (self.cost(&shape), shape));
        ranked.min_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(Vec::new, |(_, shape)| shape)
    }

    /// The best shares of two hats: the cost is quadratic in the share of the first.
    fn shared(&self, halvings: [usize; 2]) -> Vec<Hat> {
        let at = |share: f64| vec![Hat { share, halvings: halvings[0] }, Hat { share: 1.0 - share, halvings: halvings[1] }];
        let [none, half, all] = [0.0, 0.5, 1.0].map(|share| self.cost(&at(share)));
        let curvature = 2.0 * (none - 2.0 * half + all);
        let slope = all - none - curvature;
        let share = if curvature > 0.0 { (-0.5 * slope / curvature).clamp(0.0, 1.0) } else { self.tributary[0] };
        at(share)
    }

    fn cost(&self, shape: &[Hat]) -> f64 {
        let square = self.force.iter().map(|f| f * f).sum::<f64>();
        let gap: f64 = shape.iter().zip(self.gaps).map(|(hat, gap)| hat.share * gap * hat.far()).sum();
        let aside: f64 = shape.iter().zip(self.tributary).map(|(hat, share)| (hat.share - share).powi(2)).sum();
        self.normal * gap + 0.5 * self.stress(shape) + TRIBUTARY * square * self.compliance * aside
    }

    /// pᵀAp of the resultants.
    pub(crate) fn stress(&self, shape: &[Hat]) -> f64 {
        let places: Vec<(usize, f64)> = resultants(shape, &self.force).collect();
        let row = |&(i, p): &(usize, f64)| places.iter().map(|&(j, q)| p * self.energy[(i, j)] * q).sum::<f64>();
        places.iter().map(row).sum()
    }
}

/// The resultants of the hats that are narrower than their edges, with their places in the forms of the star.
pub(crate) fn resultants<'a>(shape: &'a [Hat], force: &'a [f64; 2]) -> impl Iterator<Item = (usize, f64)> + 'a {
    let narrow = shape.iter().enumerate().filter(|(_, hat)| hat.halvings > 0);
    narrow.flat_map(move |(edge, hat)| {
        (0..2).map(move |c| (2 * (HATS * edge + hat.halvings - 1) + c, hat.share * force[c]))
    })
}

#[cfg(test)]
mod tests {
    use super::super::star_stress::{StarElement, StarStress};
    use super::*;
    use percute_core::material::Elastic;

    const YOUNG: f64 = 70e9;

    /// A square corner of three elements, turned so that it stands on the plane by this angle.
    fn corner(tilt: f64) -> (DMatrix<f64>, [f64; 2]) {
        let law = Elastic::plane_stress(YOUNG, 0.3, 2700.0, 1.0).unwrap();
        let at = |k: usize| {
            let angle = tilt + 0.25 * std::f64::consts::PI * k as f64;
            [1e-3 * angle.cos(), 1e-3 * angle.sin()]
        };
        let elements = [0, 1].map(|k| StarElement { corners: [[0.0; 2], at(k), at(k + 1)], at: 0, law: &law });
        let made = StarStress::new(&elements, &[0, 1]);
        (made.energy.iter().fold(DMatrix::zeros(4 * HATS, 4 * HATS), |sum, one| sum + one), [at(0)[1], at(2)[1]])
    }

    fn pressed<'a>(force: f64, energy: &'a DMatrix<f64>, gaps: &'a [f64; 2]) -> Pressed<'a> {
        Pressed { force: [0.0, force], normal: force, compliance: 1.0 / YOUNG, gaps, tributary: &[0.5, 0.5], energy }
    }

    /// A flat zone keeps the tributary shares; beside an inclined side the force moves to the flat edge.
    #[test]
    fn flat_edges_keep_their_density() {
        let (energy, _) = corner(0.0);
        let wide = Hat { share: 0.5, halvings: 0 };
        assert_eq!(pressed(1e5, &energy, &[0.0, 0.0]).shape(), [wide, wide]);
        let shape = pressed(1e3, &energy, &[0.0, 1e-3]).shape();
        assert!(shape[0].share > 0.999 && shape[0].halvings == 0, "{shape:?}");
    }

    /// The best width is proportional to the force, a* ≈ 4.3 c₁ N/(E slope): halved with it, until the narrowest.
    #[test]
    fn width_follows_the_force() {
        let (energy, gaps) = corner(10_f64.to_radians());
        let width = |force: f64| {
            let shape = pressed(force, &energy, &gaps).shape();
            println!("{force:e} {shape:?}");
            assert!((shape[0].share + shape[1].share - 1.0).abs() < 1e-15);
            shape[0].halvings
        };
        let widths: Vec<usize> = (0..10).map(|k| width(6.4e6 * 0.5_f64.powi(k))).collect();
        println!("{widths:?}");
        assert!(widths.windows(2).all(|pair| pair[1] >= pair[0] && pair[1] - pair[0] <= 2));
    }
}
