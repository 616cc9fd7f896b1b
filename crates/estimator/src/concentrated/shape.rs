//! The shape of the traction of one node: its share and its width on each candidate edge.

use super::star_stress::Symmetric;
use super::{EdgeTraction, HATS, StarFrame, place};
use percute_core::simd::dispatch;
use std::array::from_fn;
use std::ops::Deref;
use std::sync::LazyLock;

/// Weight of the distance of the shares from the tributary ones. From 0.1 to 1, results change by 6 % at most.
const TRIBUTARY: f64 = 0.3;

/// Costs that differ by less than this part are the same: far above the rounding of gaps.
const TIE: f64 = 1e-9;

/// A hat on one edge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Hat {
    /// Its share of the resultant, between 0 and 1.
    pub(crate) share: f64,
    /// Its width is the length of the edge over two to this power.
    pub(crate) halvings: usize,
}

impl Hat {
    /// Part of the resultant that its linear equivalent has at the far node of the edge.
    pub(crate) fn far(&self) -> f64 {
        far(self.halvings)
    }
}

/// A number for each number of halvings.
type ByHalvings = [f64; HATS + 1];

/// [`Hat::far`] by halvings.
static FAR: LazyLock<ByHalvings> = LazyLock::new(|| from_fn(|halvings| EdgeTraction::hat(halvings).moments()[1]));

fn far(halvings: usize) -> f64 {
    FAR[halvings]
}

/// A hat on each candidate edge of a node, of which there are one or two; their shares sum to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TractionShape {
    hats: [Hat; 2],
    edges: usize,
}

impl Deref for TractionShape {
    type Target = [Hat];

    fn deref(&self) -> &[Hat] {
        &self.hats[..self.edges]
    }
}

impl TractionShape {
    /// The same hats in another order of the edges.
    pub(crate) fn reordered(&self, edges: [usize; 2]) -> Self {
        if self.edges == 1 { *self } else { Self { hats: edges.map(|edge| self.hats[edge]), edges: 2 } }
    }

    fn of_one(halvings: usize) -> Self {
        Self { hats: [Hat { share: 1.0, halvings }, Hat::default()], edges: 1 }
    }

    fn of_two(shares: [f64; 2], halvings: [usize; 2]) -> Self {
        Self { hats: [0, 1].map(|e| Hat { share: shares[e], halvings: halvings[e] }), edges: 2 }
    }
}

/// A star under the tractions of its node: one at a rigid obstacle, two where nodes of two bodies touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoadedStar<'a> {
    /// The form ∫τ:K⁻¹τ.
    pub(crate) energy: &'a Symmetric,
    /// The axes of the form.
    pub(crate) frame: StarFrame,
    /// The position of each edge of the node among the edges of the star.
    pub(crate) edges: [usize; 2],
}

impl LoadedStar<'_> {
    /// ∫τ:K⁻¹τ of two hats, edge and halvings of each, under forces along two directions.
    fn product(&self, hats: [(usize, usize); 2], directions: [[f64; 2]; 2]) -> f64 {
        let [(e, a), (f, b)] = hats.map(|(edge, halvings)| (self.edges[edge], halvings));
        let [along, force] = directions.map(|direction| self.frame.own(direction));
        let of = |c: usize, d: usize| along[c] * force[d] * self.energy.at(place(e, a, c), place(f, b, d));
        of(0, 0) + of(0, 1) + of(1, 0) + of(1, 1)
    }

    /// Adds the products of narrow hats of the first and of the second edge under forces along one direction, by the
    /// halvings of both, in either order.
    fn add_cross(&self, direction: [f64; 2], cross: &mut [[ByHalvings; HATS + 1]; 2]) {
        let force = self.frame.own(direction);
        let weight = |c: usize, d: usize| force[c] * force[d];
        let ordered = self.edges[0] < self.edges[1];
        let [first, last] = if ordered { self.edges } else { [self.edges[1], self.edges[0]] };
        let start = place(first, 1, 0);
        for k in 1..=HATS {
            let [along, across] =
                [0, 1].map(|component| &self.energy.row(place(last, k, component))[start..][..2 * HATS]);
            for j in 1..=HATS {
                let [plain, one, other, turned] =
                    [along[2 * j - 2], across[2 * j - 2], along[2 * j - 1], across[2 * j - 1]];
                let sum = |one: f64, other: f64| {
                    weight(0, 0) * plain + weight(0, 1) * one + weight(1, 0) * other + weight(1, 1) * turned
                };
                let ((a, b), [forth, back]) = if ordered { ((j, k), [0, 1]) } else { ((k, j), [1, 0]) };
                cross[forth][a][b] += sum(one, other);
                cross[back][a][b] += sum(other, one);
            }
        }
    }
}

/// The cost of shapes for the forces of one direction on a node.
#[derive(Clone, Debug)]
pub(crate) struct ShapeCosts<'a> {
    /// Gap at the far end less that at the node, each at least 0 (m), edge by edge.
    gaps: [f64; 2],
    /// Tributary shares.
    tributary: [f64; 2],
    /// Number of edges.
    edges: usize,
    /// The force over its normal part.
    direction: [f64; 2],
    stars: Vec<LoadedStar<'a>>,
    /// ∫τ:K⁻¹τ of each hat under a unit normal force (m/N), edge by edge.
    own: [ByHalvings; 2],
    /// Products of the hats of the first and of the second edge, by their halvings. In the other order they differ by
    /// rounding.
    cross: [[ByHalvings; HATS + 1]; 2],
    /// 2 times the cost of a share that differs from the tributary one by 1, under a unit normal force.
    penalty: f64,
}

impl<'a> ShapeCosts<'a> {
    /// `direction` is the force over its normal part, `compliance` 1 over plane modulus and thickness (m/N), the sum of
    /// those of all stars.
    pub(crate) fn new(
        direction: [f64; 2],
        compliance: f64,
        gaps: &[f64],
        tributary: &[f64],
        stars: Vec<LoadedStar<'a>>,
    ) -> Self {
        let (mut own, mut cross) = ([[0.0; HATS + 1]; 2], [[[0.0; HATS + 1]; HATS + 1]; 2]);
        for star in &stars {
            for (edge, own) in own.iter_mut().enumerate().take(gaps.len()) {
                (1..=HATS).for_each(|k| own[k] += star.product([(edge, k); 2], [direction; 2]));
            }
            if gaps.len() > 1 {
                star.add_cross(direction, &mut cross);
            }
        }
        let square: f64 = direction.iter().map(|d| d * d).sum();
        let of_edges = |numbers: &[f64]| from_fn(|edge| numbers.get(edge).copied().unwrap_or(0.0));
        Self {
            gaps: of_edges(gaps),
            tributary: of_edges(tributary),
            edges: gaps.len(),
            direction,
            stars,
            own,
            cross,
            penalty: 2.0 * TRIBUTARY * square * compliance,
        }
    }

    /// The shape of least gap energy and stress energy under a normal force (N). On an axis of symmetry two mirrored
    /// shapes may cost the same: rounding must not choose between them, and the best symmetric one is taken. Hats have
    /// so many halvings at least on each edge.
    pub(crate) fn shape(&self, normal: f64, least: [usize; 2]) -> TractionShape {
        let halvings = least[0]..=HATS;
        if self.edges == 1 {
            return self.cheapest(halvings.map(TractionShape::of_one), normal).1;
        }
        let pair = |halvings: [usize; 2]| {
            let share = self.share(halvings, normal);
            TractionShape::of_two([share, 1.0 - share], halvings)
        };
        let (cost, [first, second]) = dispatch(
            #[inline(always)]
            || self.cheapest_pair(normal, least),
        );
        let alike = least[0] == least[1] && first != second;
        let tied = alike && self.cost(&pair([second, first]), normal) <= (1.0 + TIE) * cost;
        if tied { self.cheapest(halvings.map(|k| pair([k, k])), normal).1 } else { pair([first, second]) }
    }

    /// The halvings of the cheapest two hats, the first of those that cost the same, and the cost over the normal force
    /// (m).
    #[inline(always)]
    fn cheapest_pair(&self, normal: f64, least: [usize; 2]) -> (f64, [usize; 2]) {
        let far = &*FAR;
        let mut best: Option<(f64, [usize; 2])> = None;
        for a in least[0]..=HATS {
            // One loop without a branch.
            let mut costs = [0.0; HATS + 1];
            for b in 0..=HATS {
                costs[b] = self.cost_of_pair([a, b], far, normal);
            }
            for b in least[1]..=HATS {
                if best.is_none_or(|(cost, _)| costs[b].total_cmp(&cost).is_lt()) {
                    best = Some((costs[b], [a, b]));
                }
            }
        }
        best.unwrap_or((0.0, [0; 2]))
    }

    /// [`cost`](Self::cost) of two hats with the best share.
    #[inline(always)]
    fn cost_of_pair(&self, [a, b]: [usize; 2], far: &ByHalvings, normal: f64) -> f64 {
        let share = self.share_at([a, b], [far[a], far[b]], normal);
        let (other, [t, u], [g, h]) = (1.0 - share, self.tributary, self.gaps);
        let aside = (share - t) * (share - t) + (other - u) * (other - u);
        let (both, [forth, back]) = (share * other, [self.cross[0][a][b], self.cross[1][a][b]]);
        let stress = (share * share * self.own[0][a] + both * forth) + (both * back + other * other * self.own[1][b]);
        share * g * far[a] + other * h * far[b] + 0.5 * normal * (stress + self.penalty * aside)
    }

    /// The cheapest of some shapes, with its cost over the normal force (m).
    fn cheapest(&self, shapes: impl Iterator<Item = TractionShape>, normal: f64) -> (f64, TractionShape) {
        let ranked = shapes.map(|shape| (self.cost(&shape, normal), shape));
        ranked.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, TractionShape::of_one(0)))
    }

    /// The best share of the first of two hats: the cost is quadratic in it.
    fn share(&self, [a, b]: [usize; 2], normal: f64) -> f64 {
        self.share_at([a, b], [far(a), far(b)], normal)
    }

    #[inline(always)]
    fn share_at(&self, [a, b]: [usize; 2], far: [f64; 2], normal: f64) -> f64 {
        let [own, cross, other] = [self.own[0][a], self.cross[0][a][b], self.own[1][b]];
        let way = self.gaps[0] * far[0] - self.gaps[1] * far[1];
        let curvature = own - 2.0 * cross + other + 2.0 * self.penalty;
        ((other - cross + 2.0 * self.penalty * self.tributary[0] - way / normal) / curvature).clamp(0.0, 1.0)
    }

    /// The cost over the normal force (m).
    fn cost(&self, shape: &TractionShape, normal: f64) -> f64 {
        let aside: f64 = shape.iter().zip(self.tributary).map(|(hat, share)| (hat.share - share).powi(2)).sum();
        self.gap(shape) + 0.5 * normal * (self.stress(shape) + self.penalty * aside)
    }

    /// Mean gap under a shape (m).
    fn gap(&self, shape: &TractionShape) -> f64 {
        shape.iter().zip(self.gaps).map(|(hat, gap)| hat.share * gap * hat.far()).sum()
    }

    /// ∫τ:K⁻¹τ under a unit normal force (m/N).
    fn stress(&self, shape: &TractionShape) -> f64 {
        let product = |(e, a): (usize, &Hat)| {
            let of = |f: usize, b: usize| match [e, f] {
                [0, 1] => self.cross[0][a.halvings][b],
                [1, 0] => self.cross[1][b][a.halvings],
                _ => self.own[e][b],
            };
            let row = |(f, b): (usize, &Hat)| a.share * b.share * of(f, b.halvings);
            shape.iter().enumerate().map(row).sum::<f64>()
        };
        shape.iter().enumerate().map(product).sum()
    }

    /// By how much the node is closer to its plane, of this normal, than the mean of its traction, with the local
    /// compliance (m): from 0 on, which is at the narrowest traction.
    pub(crate) fn approach(&self, shape: &TractionShape, plane: [f64; 2], normal: f64) -> f64 {
        self.gap(shape) + self.beyond_edges(shape, plane, normal)
    }

    /// The same without the mean gap of the edges, where this is that of the motion.
    pub(crate) fn beyond_edges(&self, shape: &TractionShape, plane: [f64; 2], normal: f64) -> f64 {
        let least = self.gaps[..self.edges].iter().fold(f64::INFINITY, |least, gap| least.min(gap.max(0.0)));
        normal * self.local(shape, plane, self.direction) - least * far(HATS)
    }

    /// Local compliance (m/N): displacement of a traction along a direction under a unit force along another one,
    /// beyond that of its linear equivalent.
    pub(crate) fn local(&self, shape: &TractionShape, along: [f64; 2], force: [f64; 2]) -> f64 {
        let narrow = || shape.iter().enumerate().filter(|(_, hat)| hat.halvings > 0);
        let pair = |(e, a): (usize, &Hat), (f, b): (usize, &Hat)| {
            let hats = [(e, a.halvings), (f, b.halvings)];
            a.share * b.share * self.stars.iter().map(|star| star.product(hats, [along, force])).sum::<f64>()
        };
        narrow().map(|a| narrow().map(|b| pair(a, b)).sum::<f64>()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::star_stress::{StarElement, StarStress};
    use super::*;
    use percute_core::material::Elastic;

    const YOUNG: f64 = 70e9;

    /// A square corner of three elements, turned so that it stands on the plane by this angle.
    fn corner(tilt: f64) -> (Symmetric, [f64; 2]) {
        let law = Elastic::plane_stress(YOUNG, 0.3, 2700.0, 1.0).unwrap();
        let at = |k: usize| {
            let angle = tilt + 0.25 * std::f64::consts::PI * k as f64;
            [1e-3 * angle.cos(), 1e-3 * angle.sin()]
        };
        let elements = [0, 1].map(|k| StarElement { ends: [at(k), at(k + 1)], law: &law });
        let made = StarStress::new(&elements, &[0, 1], [[false; 2]; 2]);
        (made.energy, [at(0)[1], at(2)[1]])
    }

    fn costs<'a>(energy: &'a Symmetric, gaps: &[f64; 2]) -> ShapeCosts<'a> {
        let star = LoadedStar { energy, frame: StarFrame([1.0, 0.0]), edges: [0, 1] };
        ShapeCosts::new([0.0, 1.0], 1.0 / YOUNG, gaps, &[0.5, 0.5], vec![star])
    }

    /// A flat zone keeps the tributary shares; beside an inclined side the force moves to the flat edge.
    #[test]
    fn flat_edges_keep_their_density() {
        let (energy, _) = corner(0.0);
        let wide = Hat { share: 0.5, halvings: 0 };
        assert_eq!(costs(&energy, &[0.0, 0.0]).shape(1e5, [0; 2])[..], [wide, wide]);
        let shape = costs(&energy, &[0.0, 1e-3]).shape(1e3, [0; 2]);
        assert!(shape[0].share > 0.999 && shape[0].halvings == 0, "{shape:?}");
    }

    /// The best width is proportional to the force, a* ≈ 4.3 c₁ N/(E slope): halved with it, until the narrowest.
    #[test]
    fn width_follows_the_force() {
        let (energy, gaps) = corner(10_f64.to_radians());
        let width = |force: f64| {
            let shape = costs(&energy, &gaps).shape(force, [0; 2]);
            assert!((shape[0].share + shape[1].share - 1.0).abs() < 1e-15);
            shape[0].halvings
        };
        let widths: Vec<usize> = (0..10).map(|k| width(6.4e6 * 0.5_f64.powi(k))).collect();
        assert!(widths[9] > widths[0] + 6, "{widths:?}");
        assert!(widths.windows(2).all(|pair| pair[1] >= pair[0] && pair[1] - pair[0] <= 2));
    }

    /// The closed form of the shares against a search, and the cost of the best shape against all others.
    #[test]
    fn the_best_shape_is_best() {
        let (energy, gaps) = corner(0.3);
        let costs = costs(&energy, &gaps);
        for force in [1e2, 1e4, 1e6] {
            let best = costs.cost(&costs.shape(force, [0; 2]), force);
            for a in 0..=HATS {
                for b in 0..=HATS {
                    let shape = |share: f64| TractionShape::of_two([share, 1.0 - share], [a, b]);
                    let least = (0..=100).map(|k| costs.cost(&shape(0.01 * f64::from(k)), force));
                    let least = least.fold(f64::INFINITY, f64::min);
                    assert!(best <= least * (1.0 + 1e-12), "{a} {b}");
                    let closed = costs.cost(&shape(costs.share([a, b], force)), force);
                    assert!(closed <= least * (1.0 + 1e-12), "{a} {b} {closed} {least}");
                }
            }
        }
    }

    /// Products that are made together are those of two hats, bit by bit, in either order of the edges.
    #[test]
    fn products_are_those_of_two_hats() {
        let (energy, gaps) = corner(0.3);
        let direction = [0.2, 1.0];
        for edges in [[0, 1], [1, 0]] {
            let star = LoadedStar { energy: &energy, frame: StarFrame([0.8, 0.6]), edges };
            let costs = ShapeCosts::new(direction, 1.0 / YOUNG, &gaps, &[0.5, 0.5], vec![star]);
            let product = |hats| star.product(hats, [direction; 2]);
            for a in 1..=HATS {
                assert_eq!([costs.own[0][a], costs.own[1][a]], [0, 1].map(|edge| product([(edge, a); 2])));
                for b in 1..=HATS {
                    assert_eq!(costs.cross[0][a][b], product([(0, a), (1, b)]), "{edges:?} {a} {b}");
                    assert_eq!(costs.cross[1][a][b], product([(1, b), (0, a)]), "{edges:?} {a} {b}");
                }
            }
        }
    }

    /// Hats within a part of an edge are the best of those that are halved often enough.
    #[test]
    fn hats_may_be_within_a_part_of_an_edge() {
        let (energy, gaps) = corner(0.3);
        let costs = costs(&energy, &gaps);
        for force in [1e2, 1e5, 1e8] {
            for least in [[1, 0], [0, 3], [2, 5], [HATS, HATS]] {
                let shape = costs.shape(force, least);
                assert!(shape.iter().zip(least).all(|(hat, least)| hat.halvings >= least), "{shape:?}");
                let pairs = (least[0]..=HATS).flat_map(|a| (least[1]..=HATS).map(move |b| [a, b]));
                let cost = |pair| {
                    let share = costs.share(pair, force);
                    costs.cost(&TractionShape::of_two([share, 1.0 - share], pair), force)
                };
                let best = pairs.map(cost).fold(f64::INFINITY, f64::min);
                assert!(costs.cost(&shape, force) <= best * (1.0 + TIE), "{force} {least:?}");
            }
        }
    }

    /// Rounding of the gaps does not choose between a shape and its mirror image.
    #[test]
    fn symmetric_nodes_have_symmetric_shapes() {
        let (energy, _) = corner(0.25 * std::f64::consts::PI);
        for k in 0..60 {
            let gap = 1e-7 * 1.2_f64.powi(k);
            for gaps in [[gap, gap], [gap * (1.0 + 1e-13), gap], [gap, gap * (1.0 + 1e-13)]] {
                let shape = costs(&energy, &gaps).shape(1e4, [0; 2]);
                assert_eq!(shape[0].halvings, shape[1].halvings, "{gap}");
                assert!((shape[0].share - 0.5).abs() < 1e-9, "{gap}");
            }
        }
    }
}
