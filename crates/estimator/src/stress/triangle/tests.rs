//! The three equations of the stress of a triangle, each broken alone.

use super::*;

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

/// The divergence theorem: ∫σ_ab = ∮t_a x_b − ∫(div σ)_a x_b, whatever stress balances the loading. Quadratic
/// in space along the edges and in the element, so that Simpson's rule and the middles of the sides are exact.
#[test]
fn the_mean_follows_from_boundary_and_volume() {
    // Tractions that are linear along the edges and volume loads that are linear, both at will, and
    // then a correction that balances them.
    let mut loads = loading();
    let field = [[0.7, -1.1], [-0.2, 0.4], [1.3, 0.6]];
    (0..3).for_each(|i| (0..2).for_each(|c| loads.volume[i][c] += field[i][c]));
    let law = Elastic::plane_stress(2.0, 0.3, 1.0, 1.0).unwrap();
    let area = 0.5 * map().jacobian;
    let mean = |f: &dyn Fn(usize) -> f64| (0..3).map(f).sum::<f64>() / 3.0;
    let centroid = map().centroid();
    // Resultant and moment of what was added go to the edges: constant tractions |e|F, and a shear flow.
    let added: [f64; 2] = std::array::from_fn(|c| area * mean(&|i| field[i][c]));
    let arm = |p: [f64; 2]| [p[0] - centroid[0], p[1] - centroid[1]];
    let middle = |values: [f64; 3], i: usize| 0.5 * (values[i] + values[(i + 1) % 3]);
    let product = |a: [f64; 3], b: [f64; 3]| area * mean(&|i| middle(a, i) * middle(b, i));
    let column = |c: usize| field.map(|f| f[c]);
    let place = |c: usize| POINTS.map(|p| arm(p)[c]);
    let moment = product(place(0), column(1)) - product(place(1), column(0));
    for k in 0..3 {
        let [a, b] = [POINTS[(k + 1) % 3], POINTS[(k + 2) % 3]];
        for p in 0..2 {
            for c in 0..2 {
                // Equal resultants on the three edges have no moment about the centroid; a unit shear
                // flow turns by twice the area.
                loads.traction[k][p][c] += added[c] / 3.0 + moment / (2.0 * area) * (b[c] - a[c]);
            }
        }
    }
    let balanced = TriangleStress::new(&POINTS, &law);
    let found = balanced.residuals(&loads, 0.0);
    assert!(found.divergence < ROUNDING && found.edges < ROUNDING, "{found:?}");

    let boundary = |a: usize, b: usize| {
        let edge = |k: usize| {
            let [from, to] = [POINTS[(k + 1) % 3][b], POINTS[(k + 2) % 3][b]];
            let [s, e] = loads.traction[k].map(|t| t[a]);
            // Simpson's rule; |e| is in the traction.
            (s * from + (s + e) * (from + to) + e * to) / 6.0
        };
        (0..3).map(edge).sum::<f64>()
    };
    let volume = |a: usize, b: usize| product(loads.volume.map(|g| g[a]), POINTS.map(|p| p[b]));
    let found = balanced.mean(&loads);
    for (value, (a, b)) in found.into_iter().zip([(0, 0), (1, 1), (0, 1)]) {
        let expected = (boundary(a, b) - volume(a, b)) / area;
        assert!((value - expected).abs() < 1e-13, "({a}, {b}): {value} instead of {expected}");
    }
}
