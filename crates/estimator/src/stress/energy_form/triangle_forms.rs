//! The forms of triangles, side by side.

use crate::stress::elimination::eliminate;
use crate::stress::fluctuation::{FLUCTUATION_LOADS, MODES, START, gram};
use crate::stress::reference::PAIRS;
use crate::stress::shapes::{ElementShape, KnownShapes};
use crate::stress::triangle::reference_compliance;
use crate::stress::{Fluctuation, Loading};
use nalgebra::Matrix2;
use percute_core::material::LinearLaw;
use percute_core::simd::dispatch;
use percute_core::simd::lanes::{LANES, Lanes, Value};

/// Columns whose products with loads are summed side by side: those of the edges, then those of the nodes.
pub(super) const COLUMNS: usize = 6;

/// The factors L of triangles side by side; above the diagonal, 0.
type FactorLanes = [[Lanes; FLUCTUATION_LOADS]; FLUCTUATION_LOADS];

/// The forms of the last shapes that were asked for.
#[derive(Clone, Debug)]
pub(crate) struct TriangleForms {
    shapes: KnownShapes<2>,
    factors: Box<FactorLanes>,
}

/// The map from a triangle to the reference triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReferenceMap {
    /// B⁻¹, which takes tractions to the reference triangle.
    inverse: Matrix2<f64>,
    /// J = 2|E|.
    jacobian: f64,
}

/// The form of one triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleForm<'a> {
    pub(super) map: ReferenceMap,
    factors: &'a FactorLanes,
    lane: usize,
}

impl TriangleForms {
    pub(crate) fn new() -> Self {
        Self { shapes: KnownShapes::new(), factors: Box::new([[Lanes::ZERO; FLUCTUATION_LOADS]; FLUCTUATION_LOADS]) }
    }

    /// Makes the forms of at most [`LANES`] triangles, unless they are there, and gives their lanes.
    #[inline(always)]
    pub(crate) fn prepare<'l, L: LinearLaw + 'l>(
        &mut self,
        triangles: impl Iterator<Item = ([[f64; 2]; 3], &'l L)> + Clone,
    ) -> [usize; LANES] {
        let shapes = triangles.map(|(points, law)| ElementShape::new(&points, law));
        self.shapes.prepare(shapes, |shapes| make(shapes, &mut self.factors))
    }

    /// The form of a triangle in a lane.
    #[inline(always)]
    pub(crate) fn of(&self, lane: usize, points: &[[f64; 2]; 3]) -> TriangleForm<'_> {
        let edge = |k: usize, c: usize| points[k][c] - points[0][c];
        let (b11, b12, b21, b22) = (edge(1, 0), edge(2, 0), edge(1, 1), edge(2, 1));
        let jacobian = b11 * b22 - b12 * b21;
        let inverse = Matrix2::new(b22, -b12, -b21, b11) * (1.0 / jacobian);
        TriangleForm { map: ReferenceMap { inverse, jacobian }, factors: &self.factors, lane }
    }
}

impl TriangleForm<'_> {
    #[inline(always)]
    pub(super) fn fluctuation<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> Fluctuation<D, N, T> {
        let loads = self.map.pull_back(loading);
        coordinates(self.columns::<0, T>(&loads), self.columns::<COLUMNS, T>(&loads))
    }

    /// L, alone.
    pub(super) fn factor(&self) -> [[f64; FLUCTUATION_LOADS]; FLUCTUATION_LOADS] {
        self.factors.each_ref().map(|row| row.each_ref().map(|entry| entry.0[self.lane]))
    }

    /// The products of some columns of L with loads. Above the diagonal L is 0: a loop of fixed length is worth the
    /// products with it.
    #[inline(always)]
    fn columns<const FIRST: usize, T: Value>(&self, loads: &[T; FLUCTUATION_LOADS]) -> [T; COLUMNS] {
        // A lane is below LANES; the compiler does not know.
        let (mut sums, lane) = ([loads[0].zero(); COLUMNS], self.lane % LANES);
        for i in FIRST..FLUCTUATION_LOADS {
            let (load, row) = (loads[i], &self.factors[i]);
            for j in 0..COLUMNS {
                sums[j] += load * row[FIRST + j].0[lane];
            }
        }
        sums
    }

    #[inline(always)]
    pub(super) fn fluctuation_slope<T: Value, const D: usize, const N: usize>(
        &self,
        fluctuation: &Fluctuation<D, N, T>,
    ) -> [[[T; D]; D]; N] {
        let [[xx, xy], [yx, yy]] = [0, 1].map(|c| [self.map.inverse[(0, c)], self.map.inverse[(1, c)]]);
        let zero = fluctuation.coordinates[0][0][0].zero();
        let (mut slopes, lane) = ([[[zero; D]; D]; N], self.lane % LANES);
        for k in 0..N {
            let mut pair = [zero; 2];
            for c in 0..2 {
                let row = &self.factors[2 * k + c];
                for j in 0..COLUMNS {
                    pair[c] += fluctuation.coordinates[j / 2][0][j % 2] * row[j].0[lane];
                }
                // The energy is the sum of squares of the coordinates.
                pair[c] = pair[c] + pair[c];
            }
            let both = [pair[0] * xx + pair[1] * xy, pair[0] * yx + pair[1] * yy];
            // The difference of the tractions at both ends is 6 times that of the moments.
            for c in 0..D {
                let turning = both[c] * 6.0;
                (slopes[k][0][c], slopes[k][1][c]) = (-turning, turning);
            }
        }
        slopes
    }
}

impl ReferenceMap {
    /// The loads of the fluctuation on the reference triangle.
    #[inline(always)]
    pub(super) fn pull_back<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> [T; FLUCTUATION_LOADS] {
        let rows = [[self.inverse[(0, 0)], self.inverse[(0, 1)]], [self.inverse[(1, 0)], self.inverse[(1, 1)]]];
        let Loading { traction: t, volume: g } = loading;
        // One by one: a loop over them would be compiled into one over their components.
        let [a, b] = turned(&rows, difference(&t[0]));
        let [c, d] = turned(&rows, difference(&t[1]));
        let [e, f] = turned(&rows, difference(&t[2]));
        let [p, q] = turned(&rows, [g[0][0], g[0][1]]);
        let [r, s] = turned(&rows, [g[1][0], g[1][1]]);
        let [u, v] = turned(&rows, [g[2][0], g[2][1]]);
        let size = self.jacobian;
        [a, b, c, d, e, f, p * size, q * size, r * size, s * size, u * size, v * size]
    }
}

/// The value at the second end less that at the first.
#[inline(always)]
fn difference<T: Value, const D: usize>(ends: &[[T; D]; D]) -> [T; 2] {
    [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]]
}

/// The product of a matrix with a vector.
#[inline(always)]
fn turned<T: Value>(rows: &[[f64; 2]; 2], v: [T; 2]) -> [T; 2] {
    [v[0] * rows[0][0] + v[1] * rows[0][1], v[0] * rows[1][0] + v[1] * rows[1][1]]
}

/// A fluctuation with these coordinates of edges and nodes.
#[inline(always)]
pub(super) fn coordinates<T: Value, const D: usize, const N: usize>(
    edges: [T; COLUMNS],
    nodes: [T; COLUMNS],
) -> Fluctuation<D, N, T> {
    let mut fluctuation = Fluctuation::filled(edges[0].zero());
    for k in 0..N {
        for c in 0..D {
            fluctuation.coordinates[k][0][c] = edges[2 * k + c];
            fluctuation.coordinates[k][1][c] = nodes[2 * k + c];
        }
    }
    fluctuation
}

/// Makes the factors of these shapes; apart, so that the loops over elements stay small.
#[inline(never)]
fn make(shapes: &[ElementShape<2>], factors: &mut FactorLanes) {
    dispatch(
        #[inline(always)]
        || factor(shapes, factors),
    );
}

/// Makes the factors of these shapes. The free stresses come first: the rest of the factor is then that of the energy
/// that they cannot save.
#[inline(always)]
fn factor(shapes: &[ElementShape<2>], factors: &mut FactorLanes) {
    let Some(first) = shapes.first() else { return };
    let shape = |lane: usize| shapes.get(lane).unwrap_or(first);
    let own = std::array::from_fn::<_, LANES, _>(|lane| {
        let shape = shape(lane);
        (reference_compliance(&shape.map, shape.compliance), 0.5 / shape.map.determinant())
    });
    let weights = PAIRS.map(|(a, b)| Lanes::at_levels(|lane| own[lane].1 * own[lane].0[a][b]));
    let (gram, mut lower) = (gram(), [[Lanes::ZERO; MODES]; MODES]);
    eliminate::<MODES, MODES>(
        #[inline(always)]
        |i, j| gram.entry(i, j, &weights),
        &mut lower,
    );
    for i in 0..FLUCTUATION_LOADS {
        for j in 0..=i {
            factors[i][j] = lower[START + i][START + j];
        }
    }
}

#[cfg(test)]
mod tests;
