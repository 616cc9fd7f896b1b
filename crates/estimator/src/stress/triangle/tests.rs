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
