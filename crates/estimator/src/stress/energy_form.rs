//! The elastic energy of the stress of an element, for some elements side by side.
//!
//! The law is constant in an element, so the mean of a stress and what is left of it have separate energies. The mean
//! follows from the forces on the nodes. The rest, the *fluctuation*, follows from the differences of the tractions at
//! the two ends of each edge and from Γ_DA − f_d: with these given, the tractions that put no force on any node are
//! unique. The tractions of a constant stress add nothing to the fluctuation.
//!
//! The form of the fluctuation follows from the shape and the law. It is written LLᵀ, so that Lᵀ gives coordinates in
//! which the energy is the sum of squares. Coordinates are linear in the loads: half way between two instants they are
//! the mean. The form takes more memory than all other data of an element, so it is made anew for each window of
//! levels, for [`LANES`] triangles at once, and triangles of the same shape share it. Elements around contact nodes,
//! of which there are few, keep theirs ([`ElementForm`]).

mod element_form;

use super::bar::BarStress;
use super::fluctuation::{MODES, START, gram};
use super::reference::PAIRS;
use super::triangle::reference_compliance;
use super::{Fluctuation, Loading};
pub(crate) use element_form::ElementForm;
use nalgebra::Matrix2;
use percute_core::cell::{CellKind, cell};
use percute_core::ids::ElementId;
use percute_core::material::LinearLaw;
use percute_core::problem::Problem;
use percute_core::simd::dispatch;
use percute_core::simd::lanes::{LANES, Lanes, Value};

/// Numbers that make up a fluctuation of a triangle: two for each edge, then two for each node.
const LOADS: usize = 12;

/// Columns whose products with loads are summed side by side: those of the edges, then those of the nodes.
const COLUMNS: usize = 6;

/// Edges that differ by less, relative to the smallest height, belong to triangles of the same shape: rounding of
/// coordinates.
const SAME: f64 = 1e-13;

/// A pivot that is smaller, relative to its diagonal entry, is the rounding of some terms of this entry.
const ROUNDING: f64 = 1e-15;

/// The factors L of triangles side by side; above the diagonal, 0.
type FactorLanes = [[Lanes; LOADS]; LOADS];

/// The forms of the last elements that were asked for.
#[derive(Clone, Debug)]
pub(crate) enum EnergyForms {
    Bars,
    Triangles(TriangleForms),
}

/// The form of one element.
#[derive(Clone, Copy, Debug)]
pub(crate) enum EnergyForm<'a> {
    Bar(BarStress),
    Triangle(TriangleForm<'a>),
}

impl EnergyForms {
    /// For elements of this shape.
    pub(crate) fn new(shape: CellKind) -> Self {
        match shape {
            CellKind::Bar => Self::Bars,
            CellKind::Triangle => Self::Triangles(TriangleForms::new()),
            CellKind::Tetrahedron => unreachable!("estimates of solids are refused"),
        }
    }

    /// Makes the forms of at most [`LANES`] elements with these nodes (m), unless they are there, and gives their
    /// lanes.
    #[inline(always)]
    pub(crate) fn prepare<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D>,
        elements: impl Iterator<Item = (ElementId, [[f64; D]; N])> + Clone,
    ) -> [usize; LANES] {
        match self {
            Self::Bars => [0; LANES],
            Self::Triangles(forms) => {
                forms.prepare(elements.map(|(id, points)| (corners(&points), problem.material(id))))
            }
        }
    }

    /// The form of an element with these nodes (m), in a lane.
    #[inline(always)]
    pub(crate) fn of<const D: usize, const N: usize>(
        &self,
        problem: &Problem<D>,
        id: ElementId,
        points: &[[f64; D]; N],
        lane: usize,
    ) -> EnergyForm<'_> {
        match self {
            Self::Bars => EnergyForm::Bar(BarStress::new(cell::<D, N>().signed_volume(points), problem.material(id))),
            Self::Triangles(forms) => EnergyForm::Triangle(forms.of(lane, &corners(points))),
        }
    }
}

/// A form by which fluctuations are made.
pub(crate) trait FluctuationForm {
    /// The coordinates of the fluctuation of the stress that balances a loading.
    fn fluctuation<T: Value, const D: usize, const N: usize>(&self, loading: &Loading<D, N, T>)
    -> Fluctuation<D, N, T>;
}

impl FluctuationForm for EnergyForm<'_> {
    #[inline(always)]
    fn fluctuation<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> Fluctuation<D, N, T> {
        match self {
            Self::Bar(map) => map.fluctuation(loading),
            Self::Triangle(form) => form.fluctuation(loading),
        }
    }
}

impl EnergyForm<'_> {
    /// The slope of the energy (J per unit of section or thickness) of a fluctuation in the difference of the tractions
    /// on each edge, that at the second node less that at the first; in 1D, where an edge is a point, zero.
    #[inline(always)]
    pub(crate) fn difference_slope<T: Value, const D: usize, const N: usize>(
        &self,
        fluctuation: &Fluctuation<D, N, T>,
    ) -> [[T; D]; N] {
        match self {
            Self::Bar(_) => [[fluctuation.coordinates[0][0][0].zero(); D]; N],
            Self::Triangle(form) => form.difference_slope(fluctuation),
        }
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

/// The corners of a triangle.
#[inline(always)]
fn corners<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> [[f64; 2]; 3] {
    std::array::from_fn(|i| [points[i][0], points[i][1]])
}

/// A triangle up to translation, and its law.
#[derive(Clone, Copy, Debug)]
struct TriangleShape {
    /// Columns: the edges from node 0 to nodes 1 and 2 (m).
    map: Matrix2<f64>,
    compliance: (f64, f64),
}

impl TriangleShape {
    #[inline(always)]
    fn is_like(&self, other: &Self) -> bool {
        let height = self.map.determinant().abs() / self.map.amax();
        self.compliance == other.compliance && (self.map - other.map).amax() <= SAME * height
    }
}

/// The forms of the last shapes that were asked for.
#[derive(Clone, Debug)]
pub(crate) struct TriangleForms {
    shapes: Vec<TriangleShape>,
    factors: Box<FactorLanes>,
}

/// The map from a triangle to the reference triangle.
#[derive(Clone, Copy, Debug)]
struct ReferenceMap {
    /// B⁻¹, which takes tractions to the reference triangle.
    inverse: Matrix2<f64>,
    /// J = 2|E|.
    jacobian: f64,
}

/// The form of one triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleForm<'a> {
    map: ReferenceMap,
    factors: &'a FactorLanes,
    lane: usize,
}

impl TriangleForms {
    pub(crate) fn new() -> Self {
        Self { shapes: Vec::with_capacity(LANES), factors: Box::new([[Lanes::ZERO; LOADS]; LOADS]) }
    }

    /// Makes the forms of at most [`LANES`] triangles, unless they are there, and gives their lanes.
    #[inline(always)]
    pub(crate) fn prepare<'l, L: LinearLaw + 'l>(
        &mut self,
        triangles: impl Iterator<Item = ([[f64; 2]; 3], &'l L)> + Clone,
    ) -> [usize; LANES] {
        let shapes = triangles.map(|(points, law)| TriangleShape {
            map: Matrix2::from_fn(|c, k| points[k + 1][c] - points[0][c]),
            compliance: law.compliance::<2>(),
        });
        let mut lanes = [0; LANES];
        if self.find_all(shapes.clone(), &mut lanes) {
            return lanes;
        }
        self.shapes.clear();
        for shape in shapes.clone() {
            if self.find(&shape).is_none() {
                self.shapes.push(shape);
            }
        }
        make(&self.shapes, &mut self.factors);
        self.find_all(shapes, &mut lanes);
        lanes
    }

    /// Fills in the lanes of all shapes if there are forms of all.
    #[inline(always)]
    fn find_all(&self, shapes: impl Iterator<Item = TriangleShape>, lanes: &mut [usize; LANES]) -> bool {
        for (lane, shape) in lanes.iter_mut().zip(shapes) {
            match self.find(&shape) {
                Some(found) => *lane = found,
                None => return false,
            }
        }
        true
    }

    #[inline(always)]
    fn find(&self, shape: &TriangleShape) -> Option<usize> {
        self.shapes.iter().position(|other| other.is_like(shape))
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
    fn fluctuation<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> Fluctuation<D, N, T> {
        let loads = self.map.pull_back(loading);
        coordinates(self.columns::<0, T>(&loads), self.columns::<COLUMNS, T>(&loads))
    }

    /// The products of some columns of L with loads. Above the diagonal L is 0: a loop of fixed length is worth the
    /// products with it.
    #[inline(always)]
    fn columns<const FIRST: usize, T: Value>(&self, loads: &[T; LOADS]) -> [T; COLUMNS] {
        // A lane is below LANES; the compiler does not know.
        let (mut sums, lane) = ([loads[0].zero(); COLUMNS], self.lane % LANES);
        for i in FIRST..LOADS {
            let (load, row) = (loads[i], &self.factors[i]);
            for j in 0..COLUMNS {
                sums[j] += load * row[FIRST + j].0[lane];
            }
        }
        sums
    }

    #[inline(always)]
    fn difference_slope<T: Value, const D: usize, const N: usize>(
        &self,
        fluctuation: &Fluctuation<D, N, T>,
    ) -> [[T; D]; N] {
        let [[xx, xy], [yx, yy]] = [0, 1].map(|c| [self.map.inverse[(0, c)], self.map.inverse[(1, c)]]);
        let zero = fluctuation.coordinates[0][0][0].zero();
        let (mut slopes, lane) = ([[zero; D]; N], self.lane % LANES);
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
            (0..D).for_each(|c| slopes[k][c] = both[c]);
        }
        slopes
    }
}

impl ReferenceMap {
    /// The loads of the fluctuation on the reference triangle.
    #[inline(always)]
    fn pull_back<T: Value, const D: usize, const N: usize>(&self, loading: &Loading<D, N, T>) -> [T; LOADS] {
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

/// A fluctuation with these coordinates of edges and nodes.
#[inline(always)]
fn coordinates<T: Value, const D: usize, const N: usize>(
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
fn make(shapes: &[TriangleShape], factors: &mut FactorLanes) {
    dispatch(
        #[inline(always)]
        || factor(shapes, factors),
    );
}

/// Makes the factors of these shapes. The free stresses come first: the rest of the factor is then that of the energy
/// that they cannot save.
#[inline(always)]
fn factor(shapes: &[TriangleShape], factors: &mut FactorLanes) {
    let Some(first) = shapes.first() else { return };
    let shape = |lane: usize| shapes.get(lane).unwrap_or(first);
    let own = std::array::from_fn::<_, LANES, _>(|lane| {
        let shape = shape(lane);
        (reference_compliance(&shape.map, shape.compliance), 0.5 / shape.map.determinant())
    });
    let weights = PAIRS.map(|(a, b)| Lanes::at_levels(|lane| own[lane].1 * own[lane].0[a][b]));
    let gram = gram();
    let (mut lower, mut inverse) = ([[Lanes::ZERO; MODES]; MODES], [Lanes::ZERO; MODES]);
    for i in 0..MODES {
        for j in 0..=i {
            let entry = gram.entry(i, j, &weights);
            let mut rest = entry;
            for k in 0..j {
                rest -= lower[i][k] * lower[j][k];
            }
            if i > j {
                lower[i][j] = rest * inverse[j];
                continue;
            }
            for lane in 0..LANES {
                // In needles that are almost incompressible, nothing but rounding may be left of a pivot: its column is
                // then 0.
                if rest.0[lane] > ROUNDING * entry.0[lane] {
                    lower[i][i].0[lane] = rest.0[lane].sqrt();
                    inverse[i].0[lane] = 1.0 / lower[i][i].0[lane];
                }
            }
        }
    }
    for i in 0..LOADS {
        for j in 0..=i {
            factors[i][j] = lower[START + i][START + j];
        }
    }
}

#[cfg(test)]
mod tests;
