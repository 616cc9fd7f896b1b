//! The second derivative of the energy in the moments.

use super::*;
use crate::stress::Loading;
use crate::stress::tetrahedron::forms::TetrahedronForms;
use crate::stress::tetrahedron::tests::{jacobian, law, tetrahedron};
use nalgebra::Vector3;
use percute_testkit::Random;

/// Moments at the nodes of all faces.
type Moments = [[[f64; 3]; 3]; 4];

fn map(points: &[[f64; 3]; 4]) -> Matrix3<f64> {
    Matrix3::from_fn(|c, k| points[k + 1][c] - points[0][c])
}

/// The slope of the energy of the mean stress, from the forces on the nodes.
fn mean_slope(points: &[[f64; 3]; 4], moments: &Moments) -> Moments {
    let arm =
        |i: usize| Vector3::from_fn(|c, _| points[i][c] - 0.25 * points.iter().map(|point| point[c]).sum::<f64>());
    let mut stress = Matrix3::zeros();
    for (k, p) in (0..12).map(|i| (i / 3, i % 3)) {
        let part = Vector3::from(moments[k][p]) * arm(face_node::<4>(k, p)).transpose();
        stress += (part + part.transpose()) * (3.0 / jacobian(points));
    }
    let (alpha, beta) = law().compliance::<3>();
    let strain = stress * alpha - Matrix3::identity() * (beta * stress.trace());
    std::array::from_fn(|k| std::array::from_fn(|p| (strain * arm(face_node::<4>(k, p))).into()))
}

/// The slope of the energy at moments without a volume load is the form times the moments.
#[test]
fn the_form_gives_the_slope() {
    let (mut random, law) = (Random::new(1), law());
    let tetrahedra: [_; LANES] = std::array::from_fn(|_| tetrahedron(&mut random, 0.7));
    let mut moment_forms = MomentForms::new();
    let form = moment_forms.form(&tetrahedra.each_ref().map(map), &[&law; LANES]);
    let mut forms = TetrahedronForms::new();
    let lanes = forms.prepare(tetrahedra.iter().map(|points| (*points, &law)));
    for (lane, points) in tetrahedra.iter().enumerate() {
        let moments: Moments = [(); 4].map(|()| [(); 3].map(|()| [(); 3].map(|()| random.between(-1.0, 1.0))));
        let traction = moments.map(|b| {
            let tractions: [[f64; 3]; 3] =
                std::array::from_fn(|p| std::array::from_fn(|c| 12.0 * b[p][c] - 3.0 * (b[0][c] + b[1][c] + b[2][c])));
            tractions
        });
        let own = forms.of(lanes[lane]);
        let fluctuation = own.fluctuation_slope(&own.fluctuation(&Loading { traction, volume: [[0.0; 3]; 4] }));
        let (mean, map) = (mean_slope(points, &moments), map(points));
        let inverse = map.try_inverse().unwrap();
        let reference: Vec<f64> =
            moments.as_flattened().iter().flat_map(|b| (inverse * Vector3::from(*b)).data.0[0]).collect();
        let entry = |i: usize, j: usize| form[i.max(j)][i.min(j)].0[lane];
        for at in 0..12 {
            // Slopes turn as gradients do.
            let found = inverse.transpose()
                * Vector3::from_fn(|c, _| (0..36).map(|j| entry(3 * at + c, j) * reference[j]).sum());
            for c in 0..3 {
                let expected = fluctuation[at / 3][at % 3][c] + mean[at / 3][at % 3][c];
                // Measured are 3e-14 of the largest.
                assert!((found[c] - expected).abs() < 1e-11 * found.amax(), "{} {expected}", found[c]);
            }
        }
    }
}
