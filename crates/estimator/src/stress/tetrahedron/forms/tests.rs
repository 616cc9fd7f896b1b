//! The energy of the fluctuation of tetrahedra, and its slope.

use super::*;
use crate::stress::face_node;
use crate::stress::tetrahedron::tests::{
    balanced, constant_energy, energy, forces_of, law, loading, symmetric, tetrahedron, with_forces,
};
use percute_core::material::Elastic;
use percute_testkit::Random;

fn form(points: &[[f64; 3]; 4], law: &Elastic) -> TetrahedronForm {
    let mut forms = TetrahedronForms::new();
    let [lane, ..] = forms.prepare([(*points, law)].into_iter());
    forms.of(lane).clone()
}

/// The energies of the mean and of the fluctuation are that of the whole stress, in each lane, so that no energy is
/// below that of the mean.
#[test]
fn mean_and_fluctuation_make_the_whole_energy() {
    let (mut random, law) = (Random::new(1), law());
    let mut forms = TetrahedronForms::new();
    for count in [1, 3, LANES] {
        for height in [1.0, 0.1, 10.0] {
            let tetrahedra: Vec<_> = (0..count).map(|_| tetrahedron(&mut random, height)).collect();
            let lanes = forms.prepare(tetrahedra.iter().map(|points| (*points, &law)));
            for (points, lane) in tetrahedra.iter().zip(lanes) {
                let (loading, mean) = balanced(points, &mut random);
                let found = forms.of(lane).fluctuation(&loading).energy() + constant_energy(points, &mean);
                let expected = energy(points, &law, &loading);
                assert!((found - expected).abs() < 1e-11 * expected, "{height}: {found} for {expected}");
            }
        }
    }
}

/// The tractions of a constant stress, or of any forces on the nodes, add nothing to the fluctuation.
#[test]
fn forces_on_the_nodes_do_not_matter() {
    let (mut random, law) = (Random::new(2), law());
    let points = tetrahedron(&mut random, 1.0);
    let (form, loading) = (form(&points, &law), loading(&mut random));
    let [free, strained] = [symmetric(&mut random) * 0.0, symmetric(&mut random)]
        .map(|mean| form.fluctuation(&with_forces(&points, loading, &forces_of(&points, &mean))).energy());
    assert!((free - strained).abs() < 1e-12 * free, "{free} {strained}");
}

/// The loading after the nodes have other numbers.
fn renumbered(loading: &Loading<3, 4>, order: [usize; 4]) -> Loading<3, 4> {
    let traction = std::array::from_fn(|k| {
        std::array::from_fn(|p| {
            let (face, node) = (order[k], order[face_node::<4>(k, p)]);
            loading.traction[face][(node + 3 - face) % 4]
        })
    });
    Loading { traction, volume: order.map(|i| loading.volume[i]) }
}

/// Even permutations, a turn, and a mirror with an odd permutation leave the energy as it is.
#[test]
fn energy_does_not_depend_on_numbers_and_axes() {
    let (mut random, law) = (Random::new(3), law());
    let points = tetrahedron(&mut random, 0.6);
    let loading = loading(&mut random);
    let expected = form(&points, &law).fluctuation(&loading).energy();
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, 1.1, -2.0).into_inner();
    let mirror = Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, 1.0, -1.0));
    let even = [[0, 1, 2, 3], [1, 2, 0, 3], [1, 0, 3, 2], [3, 2, 1, 0], [0, 2, 3, 1], [3, 0, 2, 1]];
    let odd = [[1, 0, 2, 3], [0, 1, 3, 2], [1, 2, 3, 0], [3, 1, 2, 0]];
    let maps = [Matrix3::identity(), turn].into_iter().flat_map(|map| even.map(|order| (map, order)));
    for (map, order) in maps.chain(odd.map(|order| (mirror, order))).chain(odd.map(|order| (mirror * turn, order))) {
        let apply = |v: &[f64; 3]| -> [f64; 3] { (map * nalgebra::Vector3::from(*v)).into() };
        let other = renumbered(&loading, order);
        let other =
            Loading { traction: other.traction.map(|t| t.map(|v| apply(&v))), volume: other.volume.map(|v| apply(&v)) };
        let found = form(&order.map(|i| apply(&points[i])), &law).fluctuation(&other).energy();
        assert!((found - expected).abs() < 1e-12 * expected, "{order:?}: {found} {expected}");
    }
}

/// A quadratic form: central differences are its slopes.
#[test]
fn slopes_are_those_of_the_energy() {
    let (mut random, law) = (Random::new(4), law());
    let points = tetrahedron(&mut random, 0.6);
    let (form, loading) = (form(&points, &law), loading(&mut random));
    let coordinates = form.fluctuation(&loading);
    let slopes = form.fluctuation_slope(&coordinates);
    for (k, p, c) in (0..36).map(|i| (i / 9, i / 3 % 3, i % 3)) {
        let energy = |step: f64| {
            let mut other = loading;
            // Tractions of moments b are 3(4b_p − Σb).
            (0..3).for_each(|q| other.traction[k][q][c] += step * if p == q { 9.0 } else { -3.0 });
            form.fluctuation(&other).energy()
        };
        let (slope, expected) = (slopes[k][p][c], 0.5 * (energy(1.0) - energy(-1.0)));
        assert!((slope - expected).abs() < 1e-11 * energy(1.0), "{slope} {expected}");
    }
}

/// Levels side by side have the bits of each alone.
#[test]
fn lanes_are_apart() {
    let (mut random, law) = (Random::new(5), law());
    let form = form(&tetrahedron(&mut random, 1.0), &law);
    let each: [Loading<3, 4>; LANES] = std::array::from_fn(|_| loading(&mut random));
    let traction = std::array::from_fn(|k| {
        std::array::from_fn(|p| std::array::from_fn(|c| Lanes::at_levels(|lane| each[lane].traction[k][p][c])))
    });
    let volume = std::array::from_fn(|i| std::array::from_fn(|c| Lanes::at_levels(|lane| each[lane].volume[i][c])));
    let fluctuation = form.fluctuation(&Loading { traction, volume });
    let (energy, slope) = (fluctuation.energy(), form.fluctuation_slope(&fluctuation));
    for (lane, alone) in each.iter().enumerate() {
        let fluctuation = form.fluctuation(alone);
        assert_eq!(energy.0[lane], fluctuation.energy());
        assert_eq!(slope.map(|s| s.map(|s| s.map(|s| s.0[lane]))), form.fluctuation_slope(&fluctuation));
    }
}

/// Tetrahedra of one law that differ by the rounding of their place share a form, others do not.
#[test]
fn shapes_are_shared() {
    let laws = [0.3, 0.4].map(|ratio| Elastic::solid(2.0, ratio, 1.0).unwrap());
    let mut forms = TetrahedronForms::new();
    let at = |x: f64, stretch: f64, law: usize| {
        ([[x, 0.7, 0.1], [x + 0.1, 0.7, 0.1], [x, 0.7 + 0.1 * stretch, 0.1], [x, 0.7, 0.3]], &laws[law])
    };
    let all = [at(0.0, 1.0, 0), at(0.3, 1.0, 0), at(0.6, 1.0 + 1e-9, 0), at(0.0, 1.0, 1), at(0.6, 1.0, 1)];
    let lanes = forms.prepare(all.into_iter());
    assert_eq!((&lanes[..5], forms.shapes.len()), (&[0, 0, 1, 2, 2][..], 3));
}

/// Slivers and needles, also almost incompressible, have the energy of the stress itself: some of their pivots are
/// rounding.
#[test]
fn needles() {
    let mut random = Random::new(6);
    for ratio in [0.3, 0.49, 0.499_999_9] {
        let law = Elastic::solid(2.0, ratio, 1.0).unwrap();
        for height in [1e2, 1e1, 1e-1, 1e-2, 1e-3] {
            let points = tetrahedron(&mut random, height);
            let loading = with_forces(&points, loading(&mut random), &[[0.0; 3]; 4]);
            let (found, expected) =
                (form(&points, &law).fluctuation(&loading).energy(), energy(&points, &law, &loading));
            // Measured are at most 7e-13.
            assert!((found - expected).abs() < 1e-11 * expected, "{ratio} {height:e}: {found} for {expected}");
        }
    }
}
