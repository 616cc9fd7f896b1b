//! The energy of elements as a form of the coefficients of the modes around them, eight elements at once.

use crate::stress::{BasisForm, EDGES, TractionForms};
use nalgebra::Matrix2;
use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use percute_core::simd::lanes::{LANES, Lanes};

/// Coefficients that concern an element: three of each node, then one of each edge.
pub(super) const COEFFICIENTS: usize = 12;

/// ½ cᵀFc is the energy of each element (J).
pub(super) type ModeForm = [[Lanes; COEFFICIENTS]; COEFFICIENTS];

/// Where the coefficient of edge k stands.
pub(super) const fn edge(k: usize) -> usize {
    9 + k
}

/// The forms of eight elements from `first` on; past the last one, that of the last again.
#[inline(always)]
pub(super) fn mode_forms<const D: usize, const N: usize>(
    problem: &Problem<D>,
    forms: &TractionForms,
    first: usize,
) -> ModeForm {
    let mesh = problem.mesh();
    let mut maps = [Matrix2::zeros(); LANES];
    let mut sides = [[Lanes::ZERO; 2]; 3];
    let mut sign = [Lanes::ZERO; 3];
    let mut laws = [problem.material(ElementId::new(first)); LANES];
    for lane in 0..LANES {
        let e = (first + lane).min(mesh.element_count() - 1);
        let (cell, points) = (&mesh.nodes_of::<N>()[e], mesh.corners::<D, N>(ElementId::new(e)));
        maps[lane] = Matrix2::from_fn(|c, k| points[k + 1][c] - points[0][c]);
        laws[lane] = problem.material(ElementId::new(e));
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            (0..2).for_each(|c| sides[k][c].0[lane] = points[b][c] - points[a][c]);
            sign[k].0[lane] = if cell[a] < cell[b] { -1.0 } else { 1.0 };
        }
    }
    of_modes(&forms.form(&maps, &laws), &basis_changes(&maps, &sides, &sign))
}

/// For each edge, the components in the reference frame of the mode of the edge and of a unit couple of opposite
/// moments; for all nodes, those of the unit moments in x and y.
#[inline(always)]
fn basis_changes(maps: &[Matrix2<f64>; LANES], sides: &[[Lanes; 2]; 3], sign: &[Lanes; 3]) -> [[[Lanes; 2]; 2]; 4] {
    let of_map = |r: usize, c: usize| Lanes::at_levels(|l| maps[l][(r, c)]);
    let [[a, b], [c, d]] = [0, 1].map(|r| [0, 1].map(|c| of_map(r, c)));
    let scale = Lanes::constant(1.0) / (a * d - b * c);
    let inverse = [[scale * d, -scale * b], [-scale * c, scale * a]];
    let mut changes = [[[Lanes::ZERO; 2]; 2]; 4];
    for k in 0..3 {
        let [x, y] = sides[k];
        let square = Lanes::constant(1.0) / (x * x + y * y);
        let lever = [-(square * y), square * x];
        let along = sign[k] * Lanes::at_levels(|l| square.0[l].sqrt());
        for c in 0..2 {
            changes[k][0][c] = along * EDGES[k][c];
            changes[k][1][c] = inverse[c][0] * lever[0] + inverse[c][1] * lever[1];
        }
    }
    for i in 0..2 {
        (0..2).for_each(|c| changes[3][i][c] = inverse[c][i]);
    }
    changes
}

/// The form in modes of a form in the basis.
#[inline(always)]
fn of_modes(form: &BasisForm, changes: &[[[Lanes; 2]; 2]; 4]) -> ModeForm {
    let entry = |i: usize, j: usize| if i >= j { form[i][j] } else { form[j][i] };
    // In order: mode and couple of each edge, then the moments around each node.
    let mut turned = [[Lanes::ZERO; COEFFICIENTS]; COEFFICIENTS];
    for a in 0..6 {
        for b in 0..=a {
            for i in 0..2 {
                let [left, right] = changes[a.min(3)][i];
                let half = [0, 1].map(|j| left * entry(2 * a, 2 * b + j) + right * entry(2 * a + 1, 2 * b + j));
                for j in 0..2 {
                    let [left, right] = changes[b.min(3)][j];
                    let sum = half[0] * left + half[1] * right;
                    (turned[2 * a + i][2 * b + j], turned[2 * b + j][2 * a + i]) = (sum, sum);
                }
            }
        }
    }
    with_couples(&turned)
}

/// Puts nodes first, and gives each node the couples of its two edges: + by the edge that ends there, − by the other.
#[inline(always)]
fn with_couples(turned: &ModeForm) -> ModeForm {
    let place = |m: usize| match m {
        0..9 if m % 3 < 2 => (6 + 2 * (m / 3) + m % 3, None),
        0..9 => (2 * ((m / 3 + 1) % 3) + 1, Some(2 * ((m / 3 + 2) % 3) + 1)),
        _ => (2 * (m - 9), None),
    };
    let mut rows = [[Lanes::ZERO; COEFFICIENTS]; COEFFICIENTS];
    for m in 0..COEFFICIENTS {
        let (plus, minus) = place(m);
        rows[m] = turned[plus];
        if let Some(minus) = minus {
            rows[m].iter_mut().zip(&turned[minus]).for_each(|(to, from)| *to -= *from);
        }
    }
    let mut form = [[Lanes::ZERO; COEFFICIENTS]; COEFFICIENTS];
    for m in 0..COEFFICIENTS {
        for n in 0..COEFFICIENTS {
            let (plus, minus) = place(n);
            form[m][n] = minus.map_or(rows[m][plus], |minus| rows[m][plus] - rows[m][minus]);
        }
    }
    form
}
