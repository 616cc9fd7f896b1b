//! The three equations of the stress of a triangle, each broken alone.

use super::*;
use percute_core::material::Elastic;

/// Far above rounding, 1e-14, and far below the 1 % that fields are changed by.
const SHOWS: f64 = 1e-6;
const ROUNDING: f64 = 1e-13;

const POINTS: [[f64; 2]; 3] = [[0.1, 0.2], [1.3, 0.4], [0.3, 0.9]];

fn map() -> TriangleStress {
    TriangleStress::new(&POINTS, &Elastic::plane_stress(2.0, 0.3, 1.0, 1.0).unwrap())
}

/// Tractions of the stress with the given constant value plus a body load that balances a stress
/// growing along x: σ = σ₀ + x σ₁, div σ = the first column of σ₁.
fn loading() -> Loading<2, 3> {
    let stress = |p: [f64; 2]| {
        let x = p[0];
        [[1.0 + 2.0 * x, 0.3 - 0.5 * x], [0.3 - 0.5 * x, -0.7 + x]]
    };
    let traction = std::array::from_fn(|k| {
        let ends = [POINTS[(k + 1) % 3], POINTS[(k + 2) % 3]];
        let normal = edge_normal(ends[0], ends[1]);
        ends.map(|p| std::array::from_fn(|c| stress(p)[c][0] * normal[0] + stress(p)[c][1] * normal[1]))
    });
    Loading { traction, volume: [[2.0, -0.5]; 3] }
}

#[test]
fn a_balanced_loading_leaves_rounding() {
    let found = map().residuals(&loading(), 0.0);
    assert!(found.divergence < ROUNDING && found.edges < ROUNDING && found.inner < ROUNDING, "{found:?}");
}

#[test]
fn a_wrong_load_shows_in_the_divergence_only() {
    let stress = map().stress(&loading());
    let mut wrong = loading();
    wrong.volume[1][0] *= 1.01;
    let found = map().residuals_of(&stress, &wrong, 0.0);
    assert!(found.divergence > SHOWS && found.edges < ROUNDING && found.inner < ROUNDING, "{found:?}");
}

#[test]
fn a_wrong_traction_shows_at_the_edges_only() {
    let stress = map().stress(&loading());
    for k in 0..3 {
        for p in 0..2 {
            let mut wrong = loading();
            wrong.traction[k][p][1] *= 1.01;
            let found = map().residuals_of(&stress, &wrong, 0.0);
            assert!(found.edges > SHOWS && found.divergence < ROUNDING && found.inner < ROUNDING, "{found:?}");
        }
    }
}

/// A constant stress along the outer edge of one sub-triangle has no traction on that edge and no
/// divergence, but jumps at the inner edges.
#[test]
fn a_jump_shows_inside_only() {
    for sub in 0..3 {
        let mut stress = map().stress(&loading());
        let [a, b, _] = corners(sub, &POINTS, [0.0; 2]);
        let t = [b[0] - a[0], b[1] - a[1]];
        for node in 0..6 {
            for (c, value) in [t[0] * t[0], t[1] * t[1], t[0] * t[1]].into_iter().enumerate() {
                stress[at(sub, node, c)] += 0.01 * value;
            }
        }
        let found = map().residuals_of(&stress, &loading(), 0.0);
        assert!(found.inner > SHOWS && found.divergence < ROUNDING && found.edges < ROUNDING, "{found:?}");
    }
}

/// Tractions that do not balance cannot be met by any stress.
#[test]
fn an_unbalanced_loading_shows() {
    let mut wrong = loading();
    wrong.traction[0][0][0] *= 1.01;
    let found = map().residuals(&wrong, 0.0);
    assert!(found.divergence.max(found.edges).max(found.inner) > SHOWS, "{found:?}");
}

#[test]
fn nothing_in_a_body_at_rest_and_nan_shows() {
    let mut rest = Loading { traction: [[[0.0; 2]; 2]; 3], volume: [[0.0; 2]; 3] };
    let found = map().residuals(&rest, 0.0);
    assert_eq!([found.divergence, found.edges, found.inner], [0.0; 3]);
    rest.volume[0][0] = f64::NAN;
    assert!(map().residuals(&rest, 0.0).divergence.is_nan());
}

/// ∫ab of two linear fields: the middles of the sides are exact.
fn product(a: [f64; 3], b: [f64; 3]) -> f64 {
    let middle = |values: [f64; 3], i: usize| 0.5 * (values[i] + values[(i + 1) % 3]);
    0.5 * map().jacobian / 3.0 * (0..3).map(|i| middle(a, i) * middle(b, i)).sum::<f64>()
}

/// The loading above and a linear volume load at will, which tractions balance: a third of its resultant on
/// each edge, which has no moment about the centroid, and a shear flow.
fn at_will() -> Loading<2, 3> {
    let mut loads = loading();
    let field = [[0.7, -1.1], [-0.2, 0.4], [1.3, 0.6]];
    (0..3).for_each(|i| (0..2).for_each(|c| loads.volume[i][c] += field[i][c]));
    let (centroid, column) = (map().centroid(), |c: usize| field.map(|f| f[c]));
    let arm = |c: usize| POINTS.map(|p| p[c] - centroid[c]);
    let moment = product(arm(0), column(1)) - product(arm(1), column(0));
    // A unit shear flow turns by twice the area.
    let flow = moment / map().jacobian;
    for k in 0..3 {
        let [a, b] = [POINTS[(k + 1) % 3], POINTS[(k + 2) % 3]];
        for c in 0..2 {
            let share = product(column(c), [1.0; 3]) / 3.0 + flow * (b[c] - a[c]);
            (0..2).for_each(|p| loads.traction[k][p][c] += share);
        }
    }
    loads
}

/// The divergence theorem: ∫σ_ab = ∮t_a x_b − ∫(div σ)_a x_b, whatever stress balances the loading.
#[test]
fn the_mean_follows_from_boundary_and_volume() {
    let (map, loads) = (map(), at_will());
    let found = map.residuals(&loads, 0.0);
    assert!(found.divergence < ROUNDING && found.edges < ROUNDING, "{found:?}");
    let boundary = |a: usize, b: usize| {
        let edge = |k: usize| {
            let [from, to] = [POINTS[(k + 1) % 3][b], POINTS[(k + 2) % 3][b]];
            let [s, e] = loads.traction[k].map(|t| t[a]);
            // Simpson's rule, exact for the quadratic; |e| is in the traction.
            (s * from + (s + e) * (from + to) + e * to) / 6.0
        };
        (0..3).map(edge).sum::<f64>()
    };
    let volume = |a: usize, b: usize| product(loads.volume.map(|g| g[a]), POINTS.map(|p| p[b]));
    for (value, (a, b)) in map.mean(&loads).into_iter().zip([(0, 0), (1, 1), (0, 1)]) {
        let expected = (boundary(a, b) - volume(a, b)) / (0.5 * map.jacobian);
        // Rounding of sums of order 1.
        assert!((value - expected).abs() < 1e-13, "({a}, {b}): {value} instead of {expected}");
    }
}
