//! The stress of hats: equilibrium, invariance, and the energy of a hat against the exact radial field.

use super::*;
use crate::concentrated::{HATS, place};
use percute_core::material::Elastic;

const FREE: [[bool; 2]; 2] = [[false; 2]; 2];

fn law() -> Elastic {
    Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap()
}

/// A fan of equal elements of this radius around the origin, over an angle.
fn fan(angle: f64, elements: usize, radius: f64) -> Vec<[f64; 2]> {
    let at = |k: usize| angle * k as f64 / elements as f64;
    (0..=elements).map(|k| [radius * at(k).cos(), radius * at(k).sin()]).collect()
}

fn elements<'a>(fan: &[[f64; 2]], law: &'a Elastic) -> Vec<StarElement<'a, Elastic>> {
    fan.windows(2).map(|pair| StarElement { ends: [pair[0], pair[1]], law }).collect()
}

/// Rounding: the system has some hundred rows in each layer.
#[test]
fn every_sub_triangle_is_in_equilibrium() {
    for (angle, count) in [(1.0, 1), (1.5, 2), (std::f64::consts::PI, 3), (4.7, 5)] {
        let law = law();
        let made = StarStress::new(&elements(&fan(angle, count, 0.7), &law), &[0, 1], FREE);
        let StarResiduals { resultants, stress } = made.residuals;
        let largest = [resultants, stress.divergence, stress.edges, stress.inner].into_iter().fold(0.0, f64::max);
        assert!(largest < 1e-12, "{angle}: {:?}", made.residuals);
    }
}

/// 1 − 2ν of almost incompressible bodies.
const COMPRESSIBILITIES: [f64; 5] = [2e-5, 2e-6, 2e-7, 2e-8, 2e-9];

/// Energies of unit hats, with their residuals, in plane strain with this 1 − 2ν.
fn in_plane_strain(fan: &[[f64; 2]], compressibility: f64) -> StarStress {
    let law = Elastic::plane_strain(70e9, 0.5 * (1.0 - compressibility), 2700.0, 1.0).unwrap();
    StarStress::new(&elements(fan, &law), &[0, 1], FREE)
}

/// An almost incompressible body has the energies of one that is a little more compressible.
#[test]
fn incompressible_stars() {
    let square = vec![[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [-1.0, 0.0]];
    for fan in [square, fan(std::f64::consts::FRAC_PI_2, 1, 0.7), fan(4.7, 5, 0.7)] {
        let expected = in_plane_strain(&fan, 2e-4).energy;
        for compressibility in COMPRESSIBILITIES {
            let made = in_plane_strain(&fan, compressibility);
            assert!(made.residuals.balanced(), "{compressibility:e}: {:?}", made.residuals);
            for hat in 0..4 * HATS {
                // The energy is linear in 1 − 2ν: measured are 1.4e-4.
                let part = made.energy.at(hat, hat) / expected.at(hat, hat);
                assert!((part - 1.0).abs() < 2e-4, "{compressibility:e}, {hat}: {part}");
            }
        }
    }
}

/// The energies of needles are those of a stress, or they do not balance and show it.
#[test]
fn needles_balance_or_show() {
    let mut balanced = 0;
    for aspect in [1.0, 1e1, 1e2, 1e3, 1e4] {
        let upper = [[0.0, 1.0], [-aspect, 0.0]];
        for fan in [vec![[aspect, 0.0], [aspect, 1.0], upper[0], upper[1]], vec![[aspect, 0.0], upper[0]]] {
            for compressibility in [0.4, 0.02, 2e-4, 2e-6, 2e-8] {
                let made = in_plane_strain(&fan, compressibility);
                if made.residuals.balanced() {
                    balanced += 1;
                    let form = DMatrix::from_fn(4 * HATS, 4 * HATS, |i, j| 70e9 * made.energy.at(i, j));
                    let least = form.symmetric_eigenvalues().min();
                    assert!(least > 0.0, "{aspect:e} {compressibility:e}: {least}");
                }
            }
        }
    }
    // Ten of cells as long as wide, eight of cells 10 times as long, four of cells 100 times as long.
    assert!(balanced >= 22, "{balanced}");
}

/// Each residual of a star shows a force that is wrong on one side of one sub-triangle: it is in no equilibrium, and no
/// stress balances it.
#[test]
fn a_wrong_force_shows() {
    let law = law();
    let elements = elements(&fan(2.0, 3, 0.7), &law);
    let tractions: Vec<_> = EdgeTraction::narrow_hats().map(|hat| (0, hat)).collect();
    let scale = 1.0 / law.compliance::<2>().0;
    let widths = radii((1..=HATS).map(|halvings| 0.5_f64.powi(halvings as i32)));
    let solved = solve(&elements, scale, (&widths, |piece| forces(piece, &tractions)), FREE);
    for (ring, edge) in [(0, 3), (4, 8), (10, 2)] {
        let mut broken = solved.clone();
        broken.states[ring].force.row_mut(4 * edge).add_scalar_mut(1e-6);
        let StarResiduals { resultants, stress } = gather(&broken, elements.len()).1;
        let all = [resultants, stress.divergence, stress.edges, stress.inner];
        assert!(all.iter().all(|r| *r > 1e-9), "{ring} {edge}: {all:?}");
    }
    // A wrong traction on an arc, and on the arc of the outline.
    for ring in [0, 7] {
        let mut broken = solved.clone();
        broken.states[ring].outer.row_mut(5).add_scalar_mut(1e-6);
        assert!(gather(&broken, elements.len()).1.resultants > 1e-8);
    }
}

/// Far from the ends of a hat, the stress of a force at the tip of a wedge is radial. With ψ from the bisector to the
/// force and α the angle of the wedge, a hat of half the width costs more energy by P²/E ln 2
/// [cos²ψ/(α + sin α) + sin²ψ/(α − sin α)]. Quadratic stresses on few triangles are off by some percent, the less the
/// more triangles there are.
#[test]
fn octaves_cost_the_energy_of_the_radial_field() {
    use std::f64::consts::{FRAC_PI_2, LN_2, PI};
    for (angle, counts) in [(PI, [3, 8]), (FRAC_PI_2, [2, 6])] {
        for psi in [0.0, 0.25 * PI, FRAC_PI_2] {
            let exact =
                LN_2 * (f64::cos(psi).powi(2) / (angle + angle.sin()) + f64::sin(psi).powi(2) / (angle - angle.sin()));
            let [coarse, fine]: [f64; 2] = counts.map(|count| octave(angle, count, psi) / exact - 1.0);
            assert!(fine.abs() < 0.05 && coarse.abs() < 0.15, "{angle} {psi}: {coarse} {fine}");
        }
    }
}

/// E/P² times the energy of hats of 1/256 of both edges less that of hats of 1/128.
fn octave(angle: f64, count: usize, psi: f64) -> f64 {
    let law = law();
    let made = StarStress::new(&elements(&fan(angle, count, 1.0), &law), &[0, 1], FREE);
    let (sin, cos) = (0.5 * angle + psi).sin_cos();
    let energy = |halvings: usize| {
        let hats = [0, 1].map(|edge| [(place(edge, halvings, 0), 0.5 * cos), (place(edge, halvings, 1), 0.5 * sin)]);
        let row = |&(i, p): &(usize, f64)| {
            hats.as_flattened().iter().map(|&(j, q)| p * made.energy.at(i, j) * q).sum::<f64>()
        };
        0.5 * 70e9 * hats.as_flattened().iter().map(row).sum::<f64>()
    };
    energy(8) - energy(7)
}

/// Half of a symmetric star on its plane of symmetry has half of the energy.
#[test]
fn a_supported_half_is_half_of_the_whole() {
    use std::f64::consts::PI;
    let law = law();
    for (start, count) in [(0.0, 2), (0.3, 1), (0.25 * PI, 3)] {
        let at = |k: usize| {
            let angle = start + (PI - 2.0 * start) * k as f64 / (2 * count) as f64;
            [0.7 * angle.cos(), 0.7 * angle.sin()]
        };
        let mut points: Vec<_> = (0..=2 * count).map(at).collect();
        // The plane of symmetry: x = 0, at rounding above.
        points[count][0] = 0.0;
        let whole = StarStress::new(&elements(&points, &law), &[0, 1], FREE);
        let half = StarStress::new(&elements(&points[..=count], &law), &[0], [[false; 2], [true, false]]);
        let StarResiduals { resultants, stress } = half.residuals;
        assert!([resultants, stress.divergence, stress.edges, stress.inner].iter().all(|r| *r < 1e-12));
        for halvings in [1, 4, 10] {
            let energy = |hats: &[(usize, f64)], made: &StarStress| -> f64 {
                let row = |&(i, p): &(usize, f64)| hats.iter().map(|&(j, q)| p * made.energy.at(i, j) * q).sum::<f64>();
                hats.iter().map(row).sum()
            };
            let force = |edge: usize, x: f64| [(place(edge, halvings, 0), x), (place(edge, halvings, 1), 1.0)];
            let both = [force(0, 0.2), force(1, -0.2)].concat();
            let (half, whole) = (energy(&force(0, 0.2), &half), energy(&both, &whole));
            assert!((2.0 * half / whole - 1.0).abs() < 1e-9, "{start} {count} {halvings}: {half} {whole}");
        }
    }
}

/// A part of another thickness carries its share of the force: two layers of half the thickness are one.
#[test]
fn energy_is_that_of_forces_over_thickness() {
    let [thin, thick] = [0.25, 0.5].map(|t| Elastic::plane_stress(70e9, 0.3, 2700.0, t).unwrap());
    let points = fan(2.0, 3, 0.7);
    let [thin, thick] = [&thin, &thick].map(|law| StarStress::new(&elements(&points, law), &[0, 1], FREE).energy);
    for (i, j) in [(0, 0), (5, 20), (39, 38)] {
        assert!((thin.at(i, j) - 2.0 * thick.at(i, j)).abs() < 1e-9 * thin.at(0, 0).abs());
    }
}

/// Any traction that is linear between break points has its stress: the sum of two hats has the sum of their stresses.
/// In a coarser cut, without rings inside the last break, the energy is larger by little.
#[test]
fn tractions_between_breaks_have_their_stress() {
    let law = law();
    let elements = elements(&fan(2.0, 3, 0.7), &law);
    let (a, b) = (EdgeTraction::hat(1), EdgeTraction::hat(3));
    let sum = |places: [f64; 3]| {
        let value = |place: f64| {
            [a, b]
                .iter()
                .zip([0.3, 0.7])
                .map(|(hat, share)| share * hat.0[0][1] * (1.0 - place / hat.0[1][0]).max(0.0))
                .sum()
        };
        EdgeTraction(places.map(|place| [place, value(place)]))
    };
    let both = sum([0.0, 0.125, 0.5]);
    // A narrow hat beside it makes the rings those of all hats.
    let [[_, top], [width, _]] = EdgeTraction::hat(HATS).0;
    let made =
        StarStress::of(&elements, &[(1, both), (1, EdgeTraction([[0.0, top], [width, 0.0], [width, 0.0]]))], FREE);
    let hats = StarStress::new(&elements, &[1], FREE);
    for component in 0..2 {
        let parts = [(place(0, 1, component), 0.3), (place(0, 3, component), 0.7)];
        let row = |&(i, p): &(usize, f64)| parts.iter().map(|&(j, q)| p * hats.energy.at(i, j) * q).sum::<f64>();
        let expected: f64 = parts.iter().map(row).sum();
        assert!((made.energy.at(component, component) / expected - 1.0).abs() < 1e-12);
        let coarse = StarStress::of(&elements, &[(1, both)], FREE).energy.at(component, component);
        assert!(coarse > expected && coarse < 1.02 * expected, "{coarse} {expected}");
    }
    // Breaks of no common ratio, a jump, and nothing at the node.
    let patch = EdgeTraction([[0.1, 0.0], [0.3, 2.0], [0.55, 3.0], [0.55, 1.0], [0.8, -0.5]]);
    let StarResiduals { resultants, stress } = StarStress::of(&elements, &[(0, patch), (1, patch)], FREE).residuals;
    assert!([resultants, stress.divergence, stress.edges, stress.inner].iter().all(|r| *r < 1e-12), "{resultants}");
}

/// A linear displacement does no work on loads that balance and have no first moment: the products with a constant
/// stress sum to 0 over the star.
#[test]
fn products_are_those_of_virtual_work() {
    let law = law();
    let elements = elements(&fan(2.5, 3, 0.7), &law);
    let made = StarStress::new(&elements, &[0, 1], FREE);
    for stress in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, -2.0, 1.5]] {
        let (mut sum, mut largest) = (nalgebra::RowDVector::zeros(4 * HATS), 0.0_f64);
        for (element, product) in elements.iter().zip(&made.products) {
            let corners = [[0.0; 2], element.ends[0], element.ends[1]];
            let mut loads = nalgebra::DVector::zeros(LOADS);
            for k in 0..3 {
                let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                let normal = [b[1] - a[1], a[0] - b[0]];
                for p in 0..2 {
                    loads[4 * k + 2 * p] = stress[0] * normal[0] + stress[2] * normal[1];
                    loads[4 * k + 2 * p + 1] = stress[2] * normal[0] + stress[1] * normal[1];
                }
            }
            let products = loads.transpose() * product;
            largest = largest.max(products.amax());
            sum += products;
        }
        assert!(sum.amax() < 1e-12 * largest, "{}", sum.amax() / largest);
    }
}
