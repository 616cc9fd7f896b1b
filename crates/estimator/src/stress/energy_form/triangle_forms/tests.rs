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

/// A loading whose tractions put no force on any node: the stress that balances it has no mean.
fn fluctuating(points: &[[f64; 2]; 3], random: &mut Random) -> Loading<2, 3> {
    let mut loading = loading(|| random.between(-1.0, 1.0));
    let area = 0.5
        * ((points[1][0] - points[0][0]) * (points[2][1] - points[0][1])
            - (points[2][0] - points[0][0]) * (points[1][1] - points[0][1]));
    for c in 0..2 {
        let sum: f64 = loading.volume.iter().map(|g| g[c]).sum();
        let moment = |t: &[[f64; 2]; 2], p: usize| (2.0 * t[p][c] + t[1 - p][c]) / 6.0;
        // Edge k adds the same to its moments at both of its nodes, so that those around each node cancel the volume
        // load.
        let missing: [f64; 3] = std::array::from_fn(|i| {
            let (before, after) = (&loading.traction[(i + 1) % 3], &loading.traction[(i + 2) % 3]);
            (loading.volume[i][c] + sum) * area / 12.0 - moment(before, 1) - moment(after, 0)
        });
        for k in 0..3 {
            let more = 0.5 * (missing[(k + 1) % 3] + missing[(k + 2) % 3] - missing[k]);
            // A constant traction has twice its moment at each node.
            (0..2).for_each(|p| loading.traction[k][p][c] += 2.0 * more);
        }
    }
    loading
}

/// Each lane has the energy of the fluctuation of its triangle alone, and its slopes.
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
            let loading = fluctuating(points, &mut random);
            let mean = stress.mean(&loading);
            // Rounding of some hundred terms of size 1.
            assert!(mean.iter().all(|x| x.abs() < 1e-12), "{mean:?}");
            let coordinates = form.fluctuation(&loading);
            let (found, expected) = (coordinates.energy(), stress.energy(&loading));
            assert!((found - expected).abs() < 1e-12 * expected, "{found} for {expected}");
            // A quadratic form: central differences are its slopes.
            let slopes = form.fluctuation_slope(&coordinates);
            for (k, p, c) in (0..12).map(|i| (i / 4, i / 2 % 2, i % 2)) {
                let energy = |step: f64| {
                    let mut other = loading;
                    // Tractions of moments b are 2(3b_p − Σb).
                    (0..2).for_each(|q| other.traction[k][q][c] += step * if p == q { 4.0 } else { -2.0 });
                    form.fluctuation(&other).energy()
                };
                let (slope, expected) = (slopes[k][p][c], 0.5 * (energy(1.0) - energy(-1.0)));
                assert!((slope - expected).abs() < 1e-11 * found.max(1.0), "{slope} {expected}");
            }
        }
    }
}

/// The mean and the fluctuation of a stress have separate energies.
#[test]
fn constant_stresses_do_not_matter() {
    let mut random = Random::new(4);
    let law = Elastic::plane_stress(2.0, 0.3, 1.0, 0.5).unwrap();
    let points = triangles(&mut random, 1)[0];
    let mut forms = TriangleForms::new();
    forms.prepare([(points, &law)].into_iter());
    let (form, stress) = (forms.of(0, &points), TriangleStress::new(&points, &law));
    let loading = fluctuating(&points, &mut random);
    let [xx, yy, xy] = [(); 3].map(|()| random.between(-1.0, 1.0));
    let (mut with_mean, mut alone) = (loading, Loading { traction: [[[0.0; 2]; 2]; 3], volume: [[0.0; 2]; 3] });
    for k in 0..3 {
        let (from, to) = (points[(k + 1) % 3], points[(k + 2) % 3]);
        let normal = [to[1] - from[1], from[0] - to[0]];
        for p in 0..2 {
            let pull = [xx * normal[0] + xy * normal[1], xy * normal[0] + yy * normal[1]];
            (0..2).for_each(|c| with_mean.traction[k][p][c] += pull[c]);
            alone.traction[k][p] = pull;
        }
    }
    let (both, expected) = (stress.energy(&with_mean), stress.energy(&alone) + form.fluctuation(&with_mean).energy());
    assert!((both - expected).abs() < 1e-12 * both, "{both} {expected}");
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
    let fluctuation = form.fluctuation(&all);
    let (energy, slope) = (fluctuation.energy(), form.fluctuation_slope(&fluctuation));
    for lane in 0..LANES {
        let of = |vector: &[Lanes; 2]| vector.map(|v| v.0[lane]);
        let alone = Loading { traction: all.traction.map(|t| t.map(|v| of(&v))), volume: all.volume.map(|v| of(&v)) };
        let fluctuation = form.fluctuation(&alone);
        assert_eq!(energy.0[lane], fluctuation.energy());
        let expected = form.fluctuation_slope(&fluctuation);
        for (a, b) in slope.as_flattened().iter().zip(expected.as_flattened()) {
            assert_eq!(of(a), *b);
        }
    }
}

/// Triangles of one law that differ by the rounding of their place share a form, others do not.
#[test]
fn shapes_are_shared() {
    let laws = [0.3, 0.4].map(|ratio| Elastic::plane_stress(2.0, ratio, 1.0, 0.5).unwrap());
    let mut forms = TriangleForms::new();
    let at = |x: f64, stretch: f64, law: usize| ([[x, 0.7], [x + 0.1, 0.7], [x, 0.7 + 0.1 * stretch]], &laws[law]);
    let all = [at(0.0, 1.0, 0), at(0.3, 1.0, 0), at(0.6, 1.0 + 1e-9, 0), at(0.0, 1.0, 1), at(0.6, 1.0, 1)];
    let lanes = forms.prepare(all.into_iter());
    assert_eq!((&lanes[..5], forms.shapes.len()), (&[0, 0, 1, 2, 2][..], 3));
}

/// Needles, also almost incompressible, have the energy of the form that is not factored: some of their pivots are
/// rounding. Measured are at most 8e-12.
#[test]
fn needles() {
    let mut random = Random::new(5);
    for ratio in [0.3, 0.49, 0.499_999_9] {
        let law = Elastic::plane_strain(2.0, ratio, 1.0, 1.0).unwrap();
        for aspect in [1e1, 1e2, 1e3, 3e3, 1e4, 1e5, 1e6] {
            let points = [[0.0, 0.0], [aspect, 0.1], [0.4 * aspect, 1.0]];
            let mut forms = TriangleForms::new();
            forms.prepare([(points, &law)].into_iter());
            let loading = fluctuating(&points, &mut random);
            let found = forms.of(0, &points).fluctuation(&loading).energy();
            let expected = TriangleStress::new(&points, &law).energy(&loading);
            assert!((found - expected).abs() < 1e-10 * expected, "{ratio} {aspect:e}: {found} for {expected}");
        }
    }
}
