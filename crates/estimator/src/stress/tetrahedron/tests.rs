//! The stress of a tetrahedron: its three equations, each broken alone, its mean and its energy.

use super::quadratic::{area_normal, corners, outward_normal, quadratic_mass};
use super::*;
use crate::stress::face_node;
use percute_core::material::Elastic;
use percute_testkit::Random;

/// Far above rounding, 1e-14, and far below the 1 % that fields are changed by.
const SHOWS: f64 = 1e-6;
const ROUNDING: f64 = 1e-12;

pub(super) fn law() -> Elastic {
    Elastic::solid(2.0, 0.3, 1.0).unwrap()
}

/// A random tetrahedron of positive orientation with this height over its first face.
pub(super) fn tetrahedron(random: &mut Random, height: f64) -> [[f64; 3]; 4] {
    let mut near = |[x, y, z]: [f64; 3]| [x, y, z].map(|x| x + height.min(1.0) * random.between(-0.2, 0.2));
    [near([0.0; 3]), near([1.0, 0.0, 0.0]), near([0.0, 1.0, 0.0]), near([0.4, 0.3, height])]
}

pub(super) fn jacobian(points: &[[f64; 3]; 4]) -> f64 {
    Matrix3::from_fn(|c, k| points[k + 1][c] - points[0][c]).determinant()
}

pub(super) fn loading(random: &mut Random) -> Loading<3, 4> {
    let mut vector = || [(); 3].map(|()| random.between(-1.0, 1.0));
    Loading { traction: [(); 4].map(|()| [(); 3].map(|()| vector())), volume: [(); 4].map(|()| vector()) }
}

/// Force of the tractions less that of the volume load at each node.
pub(super) fn forces(points: &[[f64; 3]; 4], loading: &Loading<3, 4>) -> [[f64; 3]; 4] {
    let mut forces = [[0.0; 3]; 4];
    for c in 0..3 {
        for (k, t) in loading.traction.iter().enumerate() {
            (0..3).for_each(|p| forces[face_node::<4>(k, p)][c] += (t[p][c] + t[0][c] + t[1][c] + t[2][c]) / 12.0);
        }
        let sum: f64 = loading.volume.iter().map(|g| g[c]).sum();
        (0..4).for_each(|i| forces[i][c] -= jacobian(points) / 120.0 * (loading.volume[i][c] + sum));
    }
    forces
}

/// Adds moments that are the same at the nodes of a face so that the forces on the nodes become the given ones.
pub(super) fn with_forces(points: &[[f64; 3]; 4], mut loading: Loading<3, 4>, wanted: &[[f64; 3]; 4]) -> Loading<3, 4> {
    let now = forces(points, &loading);
    for c in 0..3 {
        let missing: [f64; 4] = std::array::from_fn(|i| wanted[i][c] - now[i][c]);
        let sum: f64 = missing.iter().sum();
        // A constant traction has three times its moment at each node.
        (0..4).for_each(|k| (0..3).for_each(|p| loading.traction[k][p][c] += 3.0 * (sum / 3.0 - missing[k])));
    }
    loading
}

/// The forces on the nodes of a constant stress.
pub(super) fn forces_of(points: &[[f64; 3]; 4], stress: &Matrix3<f64>) -> [[f64; 3]; 4] {
    std::array::from_fn(|i| {
        let normal = outward_normal(i, points);
        std::array::from_fn(|a| -(0..3).map(|b| stress[(a, b)] * normal[b]).sum::<f64>() / 3.0)
    })
}

pub(super) fn symmetric(random: &mut Random) -> Matrix3<f64> {
    let part = Matrix3::from_fn(|_, _| random.between(-1.0, 1.0));
    part + part.transpose()
}

/// A loading that balances, and the mean of its stress.
pub(super) fn balanced(points: &[[f64; 3]; 4], random: &mut Random) -> (Loading<3, 4>, Matrix3<f64>) {
    let (mean, loading) = (symmetric(random), loading(random));
    (with_forces(points, loading, &forces_of(points, &mean)), mean)
}

/// ½ of τ:K⁻¹τ times the volume, for a constant stress.
pub(super) fn constant_energy(points: &[[f64; 3]; 4], stress: &Matrix3<f64>) -> f64 {
    let (alpha, beta) = law().compliance::<3>();
    jacobian(points) / 12.0 * (alpha * stress.component_mul(stress).sum() - beta * stress.trace().powi(2))
}

/// ½∫σ:K⁻¹σ of the stress as it is, without products of the reference tetrahedron.
pub(super) fn energy(points: &[[f64; 3]; 4], law: &Elastic, loading: &Loading<3, 4>) -> f64 {
    let (values, mass) = (TetrahedronStress::new(points, law).stress(loading).values, quadratic_mass());
    let (alpha, beta) = law.compliance::<3>();
    let full = |sub: usize, m: usize| Matrix3::from_fn(|a, b| values[at(sub, m, component(a, b))]);
    let mut sum = 0.0;
    for (sub, k) in (0..4).flat_map(|sub| (0..100).map(move |k| (sub, k))) {
        let (x, y) = (full(sub, k / 10), full(sub, k % 10));
        sum += mass[k / 10][k % 10] * (alpha * x.component_mul(&y).sum() - beta * x.trace() * y.trace());
    }
    0.5 * jacobian(points) / 24.0 * sum
}

/// Every load that balances has an exact stress, whose mean is that of the forces on the nodes; heights are those of
/// slivers too.
#[test]
fn balanced_loads_have_exact_stresses() {
    let mut random = Random::new(1);
    for height in [1.0, 1.0, 0.3, 3.0, 1e-1, 1e-2, 1e-3, 1e2] {
        for _ in 0..4 {
            let points = tetrahedron(&mut random, height);
            let ((loading, mean), map) = (balanced(&points, &mut random), TetrahedronStress::new(&points, &law()));
            let found = map.residuals(&loading, 0.0);
            assert!(found.divergence < ROUNDING && found.edges < ROUNDING && found.inner < ROUNDING, "{found:?}");
            let largest = map.stress(&loading).values.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
            let stress: [[f64; 3]; 3] = crate::stress::tensor(&map.mean(&loading));
            for (a, b) in (0..9).map(|i| (i / 3, i % 3)) {
                // Rounding of values of the size of the largest.
                assert!((stress[a][b] - mean[(a, b)]).abs() < ROUNDING * largest, "{} {}", stress[a][b], mean[(a, b)]);
            }
        }
    }
}

#[test]
fn a_wrong_load_shows_in_the_divergence_only() {
    let mut random = Random::new(2);
    let points = tetrahedron(&mut random, 1.0);
    let (loading, _) = balanced(&points, &mut random);
    let stress = TetrahedronStress::new(&points, &law()).stress(&loading);
    for i in 0..4 {
        let mut wrong = loading;
        wrong.volume[i][i % 3] *= 1.01;
        let found = stress.residuals(&wrong, 0.0);
        assert!(found.divergence > SHOWS && found.edges < ROUNDING && found.inner < ROUNDING, "{found:?}");
    }
}

#[test]
fn a_wrong_traction_shows_at_the_faces_only() {
    let mut random = Random::new(3);
    let points = tetrahedron(&mut random, 1.0);
    let (loading, _) = balanced(&points, &mut random);
    let stress = TetrahedronStress::new(&points, &law()).stress(&loading);
    for (k, p) in (0..12).map(|i| (i / 3, i % 3)) {
        let mut wrong = loading;
        wrong.traction[k][p][(k + p) % 3] *= 1.01;
        let found = stress.residuals(&wrong, 0.0);
        assert!(found.edges > SHOWS && found.divergence < ROUNDING && found.inner < ROUNDING, "{found:?}");
    }
}

/// A constant stress along the outer face of one sub-tetrahedron has no traction on that face and no divergence, but
/// jumps at the inner faces.
#[test]
fn a_jump_shows_inside_only() {
    let mut random = Random::new(4);
    let points = tetrahedron(&mut random, 1.0);
    let (loading, _) = balanced(&points, &mut random);
    for sub in 0..4 {
        let mut stress = TetrahedronStress::new(&points, &law()).stress(&loading);
        let [a, b, _, _] = corners(sub, &points, [0.0; 3]);
        let t: [f64; 3] = std::array::from_fn(|c| b[c] - a[c]);
        for (node, i) in (0..NODES).flat_map(|node| (0..9).map(move |i| (node, i))).filter(|(_, i)| i / 3 <= i % 3) {
            stress.values[at(sub, node, component(i / 3, i % 3))] += 0.01 * t[i / 3] * t[i % 3];
        }
        let found = stress.residuals(&loading, 0.0);
        assert!(found.inner > SHOWS && found.divergence < ROUNDING && found.edges < ROUNDING, "{found:?}");
    }
}

/// Tractions that do not balance cannot be met by any stress.
#[test]
fn an_unbalanced_loading_shows() {
    let mut random = Random::new(5);
    let points = tetrahedron(&mut random, 1.0);
    let (mut wrong, _) = balanced(&points, &mut random);
    wrong.traction[0][0][0] += 0.01;
    let found = TetrahedronStress::new(&points, &law()).residuals(&wrong, 0.0);
    assert!(found.divergence.max(found.edges).max(found.inner) > SHOWS, "{found:?}");
}

#[test]
fn nothing_in_a_body_at_rest_and_nan_shows() {
    let points = tetrahedron(&mut Random::new(6), 1.0);
    let map = TetrahedronStress::new(&points, &law());
    let mut rest = Loading { traction: [[[0.0; 3]; 3]; 4], volume: [[0.0; 3]; 4] };
    let found = map.residuals(&rest, 0.0);
    assert_eq!([found.divergence, found.edges, found.inner], [0.0; 3]);
    rest.volume[0][0] = f64::NAN;
    assert!(map.residuals(&rest, 0.0).divergence.is_nan());
}

/// The energy of a constant stress is exact: no free stress lowers it.
#[test]
fn constant_stresses_have_their_energy() {
    let mut random = Random::new(7);
    for height in [1.0, 0.1] {
        let points = tetrahedron(&mut random, height);
        let (stress, none) = (symmetric(&mut random), Loading { traction: [[[0.0; 3]; 3]; 4], volume: [[0.0; 3]; 4] });
        let loading = with_forces(&points, none, &forces_of(&points, &stress));
        let (found, exact) = (energy(&points, &law(), &loading), constant_energy(&points, &stress));
        assert!((found - exact).abs() < 1e-12 * exact, "{found} {exact}");
        for k in 0..4 {
            let [a, b, c] = [0, 1, 2].map(|p| points[face_node::<4>(k, p)]);
            let outward = area_normal([a, b, c]).map(|n| if k % 2 == 0 { n } else { -n });
            let pull: f64 = (0..3).map(|c| stress[(0, c)] * outward[c]).sum();
            assert!((loading.traction[k][0][0] - pull).abs() < 1e-13);
        }
    }
}

/// The energy is least: free stresses of any kind add to it.
#[test]
fn free_stresses_only_add_energy() {
    let mut random = Random::new(8);
    let points = tetrahedron(&mut random, 0.5);
    let (loading, _) = balanced(&points, &mut random);
    let mut map = TetrahedronStress::new(&points, &law());
    let loads = map.pull_back(&loading);
    let weights = reference_compliance(&rows(&map.map), law().compliance::<3>());
    let of = |map: &TetrahedronStress| {
        let free = |i: usize| -> f64 { map.free[i].iter().zip(&loads).map(|(a, b)| a * b).sum() };
        let parts: [f64; ALL] = std::array::from_fn(|i| if i < LOADS { loads[i] } else { free(i - LOADS) });
        let stress = ReferenceTetrahedron::get().stress(&parts);
        let products = reference::product(&stress, &stress);
        0.5 / map.jacobian * weights.iter().zip(products).map(|(a, b)| a * b).sum::<f64>()
    };
    let least = of(&map);
    assert!((least - energy(&points, &law(), &loading)).abs() < 1e-12 * least);
    for i in 0..FREE {
        let kept = map.free[i];
        let mut rise = [0.0; 2];
        for (rise, step) in rise.iter_mut().zip([0.1, -0.1]) {
            (0..LOADS).for_each(|j| map.free[i][j] = kept[j] + step * loads[j]);
            *rise = of(&map) - least;
        }
        map.free[i] = kept;
        // At the least energy both are the same.
        assert!(rise[0] > 0.0 && (rise[0] - rise[1]).abs() < 1e-9 * rise[0].max(least), "{rise:?}");
    }
}

/// A prototype in another language, with moments by other rules, has this energy.
#[test]
fn energy_is_that_of_a_prototype() {
    let points = [[0.1, 0.2, -0.1], [1.3, 0.4, 0.1], [0.3, 0.9, 0.2], [0.2, 0.1, 0.8]];
    let raw = |i: usize| (1.0 + 3.7 * i as f64).sin();
    let traction = std::array::from_fn(|k| {
        let moment = |p: usize, c: usize| raw(9 * k + 3 * p + c);
        std::array::from_fn(|p| {
            std::array::from_fn(|c| 12.0 * moment(p, c) - 3.0 * (moment(0, c) + moment(1, c) + moment(2, c)))
        })
    });
    let volume = std::array::from_fn(|i| std::array::from_fn(|c| raw(36 + 3 * i + c)));
    let mean = Matrix3::new(0.5, -0.2, 0.1, -0.2, 0.3, 0.4, 0.1, 0.4, -0.6);
    let loading = with_forces(&points, Loading { traction, volume }, &forces_of(&points, &mean));
    let found = energy(&points, &law(), &loading);
    // Its own rounding is 2e-15.
    assert!((found / 81.114_786_517_000_8 - 1.0).abs() < 1e-13, "{found}");
    assert!((constant_energy(&points, &mean) - 0.044_764).abs() < 1e-15);
}
