//! The energy of the stress of an element as a quadratic form of its loads, for some elements side by side.
//!
//! The form of a triangle follows from its shape and its law. It takes more memory than all other data of an element, so it
//! is made anew for each window of levels, for [`LANES`] triangles at once, and triangles of the same shape share it.

use super::Loading;
use super::bar::BarStress;
use super::reference::{ALL, FREE, LOADS, PAIRS, Reference};
use super::triangle::{pull_back, push_forward, reference_compliance};
use crate::lanes::{LANES, Lanes, Value};
use nalgebra::Matrix2;
use percute_core::ids::ElementId;
use percute_core::material::LinearLaw;
use percute_core::problem::Problem;
use percute_core::simplex::Shape;

/// Loads whose products with all others are summed side by side, so that no sum waits for another.
const ROWS: usize = 6;

/// Edges that differ by less, relative to the smallest height, belong to triangles of the same shape: rounding of coordinates.
const SAME: f64 = 1e-13;

/// The forms of triangles side by side.
type FormLanes = [[Lanes; LOADS]; LOADS];

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
    pub(crate) fn new(shape: Shape) -> Self {
        match shape {
            Shape::Bar => Self::Bars,
            Shape::Triangle => Self::Triangles(TriangleForms::new()),
        }
    }

    /// Makes the forms of at most [`LANES`] elements, unless they are there, and gives their lanes.
    pub(crate) fn prepare<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        elements: impl Iterator<Item = ElementId> + Clone,
    ) -> [usize; LANES] {
        match self {
            Self::Bars => [0; LANES],
            Self::Triangles(forms) => {
                forms.prepare(elements.map(|id| (corners(&problem.mesh().cell_points(id)), problem.material(id))))
            }
        }
    }

    /// The form of an element in a lane.
    #[inline(always)]
    pub(crate) fn of<const D: usize, const N: usize>(
        &self,
        problem: &Problem<D, N>,
        id: ElementId,
        lane: usize,
    ) -> EnergyForm<'_> {
        let points = problem.mesh().cell_points(id);
        match self {
            Self::Bars => {
                EnergyForm::Bar(BarStress::new(problem.mesh().simplex().signed_volume(&points), problem.material(id)))
            }
            Self::Triangles(forms) => EnergyForm::Triangle(forms.of(lane, &corners(&points))),
        }
    }
}

impl EnergyForm<'_> {
    /// ½∫σ : K⁻¹ σ (J per unit of section or thickness) of the stress that balances a loading.
    #[inline(always)]
    pub(crate) fn energy<T: Value, const D: usize, const N: usize>(&self, loading: &Loading<D, N, T>) -> T {
        match self {
            Self::Bar(map) => map.energy(loading),
            Self::Triangle(form) => form.energy(loading),
        }
    }

    /// The slope of [`EnergyForm::energy`] in the tractions; in 1D, where nothing is to be chosen, zero.
    #[inline(always)]
    pub(crate) fn traction_slope<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> [[[T; D]; D]; N] {
        match self {
            Self::Bar(_) => [[[T::ZERO; D]; D]; N],
            Self::Triangle(form) => form.traction_slope(loading),
        }
    }
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
    fn is_like(&self, other: &Self) -> bool {
        let height = self.map.determinant().abs() / self.map.amax();
        self.compliance == other.compliance && (self.map - other.map).amax() <= SAME * height
    }
}

/// The forms of the last shapes that were asked for.
#[derive(Clone, Debug)]
pub(crate) struct TriangleForms {
    shapes: Vec<TriangleShape>,
    forms: Box<FormLanes>,
}

/// The form of one triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleForm<'a> {
    /// B⁻¹, which takes tractions to the reference triangle.
    inverse: Matrix2<f64>,
    /// J = 2|E|.
    jacobian: f64,
    forms: &'a FormLanes,
    lane: usize,
}

impl TriangleForms {
    pub(crate) fn new() -> Self {
        Self { shapes: Vec::with_capacity(LANES), forms: Box::new([[Lanes::ZERO; LOADS]; LOADS]) }
    }

    /// Makes the forms of at most [`LANES`] triangles, unless they are there, and gives their lanes.
    pub(crate) fn prepare<'l, L: LinearLaw + 'l>(
        &mut self,
        triangles: impl Iterator<Item = ([[f64; 2]; 3], &'l L)> + Clone,
    ) -> [usize; LANES] {
        let shapes = triangles.map(|(points, law)| TriangleShape {
            map: Matrix2::from_fn(|c, k| points[k + 1][c] - points[0][c]),
            compliance: law.compliance::<2>(),
        });
        if shapes.clone().any(|shape| self.find(&shape).is_none()) {
            self.shapes.clear();
            for shape in shapes.clone() {
                if self.find(&shape).is_none() {
                    self.shapes.push(shape);
                }
            }
            make(&self.shapes, &mut self.forms);
        }
        let mut lanes = [0; LANES];
        lanes.iter_mut().zip(shapes).for_each(|(lane, shape)| *lane = self.find(&shape).unwrap_or(0));
        lanes
    }

    fn find(&self, shape: &TriangleShape) -> Option<usize> {
        self.shapes.iter().position(|other| other.is_like(shape))
    }

    /// The form of a triangle in a lane.
    #[inline(always)]
    pub(crate) fn of(&self, lane: usize, points: &[[f64; 2]; 3]) -> TriangleForm<'_> {
        let edge = |k: usize, c: usize| points[k][c] - points[0][c];
        let (b11, b12, b21, b22) = (edge(1, 0), edge(2, 0), edge(1, 1), edge(2, 1));
        let jacobian = b11 * b22 - b12 * b21;
        let inverse = Matrix2::new(b22, -b12, -b21, b11) / jacobian;
        TriangleForm { inverse, jacobian, forms: &self.forms, lane }
    }
}

impl TriangleForm<'_> {
    /// The products of some rows of the form with loads.
    #[inline(always)]
    fn rows<T: Value>(&self, first: usize, columns: std::ops::Range<usize>, loads: &[T; LOADS]) -> [T; ROWS] {
        let mut sums = [T::ZERO; ROWS];
        for j in columns {
            let (load, column) = (loads[j], &self.forms[j]);
            for (r, sum) in sums.iter_mut().enumerate() {
                *sum += load * column[first + r].0[self.lane];
            }
        }
        sums
    }

    /// ½∫σ : K⁻¹ σ (J per unit of thickness) of the stress that balances a loading.
    #[inline(always)]
    pub(crate) fn energy<T: Value, const D: usize, const N: usize>(&self, loading: &Loading<D, N, T>) -> T {
        let loads = pull_back(&self.inverse, self.jacobian, loading);
        let mut energy = T::ZERO;
        for first in (0..LOADS).step_by(ROWS) {
            // The form is symmetric: what lies left of a block counts twice.
            let left = self.rows(first, 0..first, &loads);
            let own = self.rows(first, first..first + ROWS, &loads);
            for r in 0..ROWS {
                energy += loads[first + r] * (left[r] + left[r] + own[r]);
            }
        }
        energy
    }

    /// The slope of [`TriangleForm::energy`] in the tractions.
    #[inline(always)]
    pub(crate) fn traction_slope<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> [[[T; D]; D]; N] {
        let loads = pull_back(&self.inverse, self.jacobian, loading);
        let (one, two) = (self.rows(0, 0..LOADS, &loads), self.rows(ROWS, 0..LOADS, &loads));
        let product = |k: usize| if k < ROWS { one[k] } else { two[k - ROWS] };
        push_forward(&self.inverse, |k| product(k) + product(k))
    }
}

/// Makes the forms of these shapes: the energy of loads and free stresses, less the part that the free stresses can save.
fn make(shapes: &[TriangleShape], forms: &mut FormLanes) {
    let Some(first) = shapes.first() else { return };
    let shape = |lane: usize| shapes.get(lane).unwrap_or(first);
    let reference = Reference::get();
    let own = std::array::from_fn::<_, LANES, _>(|lane| {
        let shape = shape(lane);
        (reference_compliance(&shape.map, shape.compliance), 0.5 / shape.map.determinant())
    });
    let weights = PAIRS.map(|(a, b)| Lanes::at_levels(|lane| own[lane].1 * own[lane].0[a][b]));
    let mut all = [[Lanes::ZERO; ALL]; ALL];
    for i in 0..ALL {
        for j in 0..=i {
            let mut sum = Lanes::ZERO;
            for (weight, gram) in weights.iter().zip(&reference.gram) {
                sum += *weight * gram[i][j];
            }
            (all[i][j], all[j][i]) = (sum, sum);
        }
    }
    let inverse = inverse(&std::array::from_fn(|i| std::array::from_fn(|j| all[LOADS + i][LOADS + j])));
    for j in 0..LOADS {
        let free: [Lanes; FREE] = std::array::from_fn(|i| {
            let [a, b, c] = std::array::from_fn(|k| inverse[i][k] * all[LOADS + k][j]);
            a + b + c
        });
        for i in 0..LOADS {
            let [a, b, c] = std::array::from_fn(|k| all[i][LOADS + k] * free[k]);
            forms[j][i] = all[i][j] - (a + b + c);
        }
    }
}

/// Inverses of symmetric matrices.
#[inline(always)]
fn inverse(m: &[[Lanes; FREE]; FREE]) -> [[Lanes; FREE]; FREE] {
    let minor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::TriangleStress;
    use percute_core::material::Elastic;
    use percute_testkit::Random;

    fn triangles(random: &mut Random, count: usize) -> Vec<[[f64; 2]; 3]> {
        let mut point = |x: f64, y: f64| [x + random.between(-0.2, 0.2), y + random.between(-0.2, 0.2)];
        (0..count).map(|_| [point(0.0, 0.0), point(1.0, 0.0), point(0.0, 0.3)]).collect()
    }

    fn loading<T: Value>(mut number: impl FnMut() -> T) -> Loading<2, 3, T> {
        let traction = [(); 3].map(|()| [(); 2].map(|()| [(); 2].map(|()| number())));
        Loading { traction, volume: [(); 3].map(|()| [(); 2].map(|()| number())) }
    }

    /// Each lane has the energy and the slopes of the stress of its triangle alone.
    #[test]
    fn forms_are_those_of_the_stress() {
        let mut random = Random::new(1);
        let law = Elastic::plane_strain(2.0, 0.3, 1.0, 0.5).unwrap();
        let mut forms = TriangleForms::new();
        for count in [1, 3, LANES] {
            let triangles = triangles(&mut random, count);
            let lanes = forms.prepare(triangles.iter().map(|points| (*points, &law)));
            for (points, lane) in triangles.iter().zip(lanes) {
                let (form, stress) = (forms.of(lane, points), TriangleStress::new(points, &law));
                let loading = loading(|| random.between(-1.0, 1.0));
                let (found, expected) = (form.energy(&loading), stress.energy(&loading));
                // Rounding of some hundred terms.
                assert!((found - expected).abs() < 1e-12 * expected, "{found} for {expected}");
                let (found, expected) = (form.traction_slope(&loading), stress.traction_slope(&loading));
                let largest = expected.iter().flatten().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
                for (a, b) in found.iter().flatten().flatten().zip(expected.iter().flatten().flatten()) {
                    assert!((a - b).abs() < 1e-12 * largest, "{a} for {b}");
                }
            }
        }
    }

    /// Levels side by side have the bits of each alone.
    #[test]
    fn lanes_are_apart() {
        let mut random = Random::new(2);
        let law = Elastic::plane_stress(2.0, 0.3, 1.0, 0.5).unwrap();
        let (points, mut forms) = (triangles(&mut random, 1)[0], TriangleForms::new());
        forms.prepare([(points, &law)].into_iter());
        let form = forms.of(0, &points);
        let all = loading(|| Lanes::at_levels(|_| random.between(-1.0, 1.0)));
        let (energy, slope) = (form.energy(&all), form.traction_slope(&all));
        for lane in 0..LANES {
            let of = |vector: &[Lanes; 2]| vector.map(|v| v.0[lane]);
            let alone =
                Loading { traction: all.traction.map(|t| t.map(|v| of(&v))), volume: all.volume.map(|v| of(&v)) };
            assert_eq!(energy.0[lane], form.energy(&alone));
            let expected = form.traction_slope(&alone);
            for (a, b) in slope.iter().flatten().zip(expected.iter().flatten()) {
                assert_eq!(of(a), *b);
            }
        }
    }

    /// Triangles that differ by the rounding of their place share a form, others do not.
    #[test]
    fn shapes_are_shared() {
        let law = Elastic::plane_stress(2.0, 0.3, 1.0, 0.5).unwrap();
        let mut forms = TriangleForms::new();
        let at = |x: f64, stretch: f64| ([[x, 0.7], [x + 0.1, 0.7], [x, 0.7 + 0.1 * stretch]], &law);
        let lanes = forms.prepare([at(0.0, 1.0), at(0.3, 1.0), at(0.6, 1.0 + 1e-9)].into_iter());
        assert_eq!((lanes[0], lanes[1], forms.shapes.len()), (0, 0, 2));
    }
}
