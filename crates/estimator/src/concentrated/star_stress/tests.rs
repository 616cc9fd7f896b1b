//! The stress of hats: equilibrium, invariance, and the energy of a hat against the exact radial field.

use super::*;
use percute_core::material::Elastic;

fn law() -> Elastic {
    Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap()
}

/// A fan of equal elements of this radius around the origin, over an angle.
fn fan(angle: f64, elements: usize, radius: f64) -> Vec<[f64; 2]> {
    let at = |k: usize| angle * k as f64 / elements as f64;
    (0..=elements).map(|k| [radius * at(k).cos(), radius * at(k).sin()]).collect()
}

fn elements<'a>(fan: &[[f64; 2]], law: &'a Elastic) -> Vec<StarElement<'a, Elastic>> {
    let one = |(k, pair): (usize, &[[f64; 2]])| {
        let mut corners = [[0.0; 2], pair[0], pair[1]];
        corners.rotate_right(k % 3);
        StarElement { corners, at: k % 3, law }
    };
    fan.windows(2).enumerate().map(one).collect()
}

/// Rounding: the system has some hundred rows in each layer.
#[test]
fn every_sub_triangle_is_in_equilibrium() {
    let law = law();
    let solved = Solved::new(&elements(&fan(std::f64::consts::PI, 3, 0.7), &law), &[0, 1]);
    let mut worst: f64 = 0.0;
    let mut by = [0.0_f64; 13];
    for (triangle, loads) in solved.star.triangles.iter().zip(&solved.loads) {
        let miss = resultants(&triangle.corners) * loads;
        for column in 0..loads.ncols() {
            let largest = loads.column(column).amax();
            worst = worst.max(miss.column(column).amax() / largest.max(1e-3));
            by[triangle.layer] = by[triangle.layer].max(miss.column(column).amax());
        }
    }
    println!("worst {worst:.2e} {by:?}");
    assert!(worst < 1e-12, "{worst}");
}

#[test]
fn print_octaves() {
    for (angle, m) in [
        (std::f64::consts::PI, 2),
        (std::f64::consts::PI, 3),
        (std::f64::consts::PI, 4),
        (0.5 * std::f64::consts::PI, 1),
        (0.5 * std::f64::consts::PI, 2),
        (0.5 * std::f64::consts::PI, 3),
    ] {
        let t = std::time::Instant::now();
        let law = law();
        let fan = fan(angle, m, 1.0);
        let stress = StarStress::new(&elements(&fan, &law), &[0, 1]);
        let dt = t.elapsed();
        let total = stress.energy.iter().fold(DMatrix::zeros(40, 40), |a, b| a + b);
        for direction in [angle / 2.0, 0.0, angle / 2.0 + std::f64::consts::FRAC_PI_2] {
            let (sin, cos) = direction.sin_cos();
            let e = |k: usize| {
                let mut p = nalgebra::DVector::zeros(40);
                for edge in 0..2 {
                    p[2 * (HATS * edge + k - 1)] = 0.5 * cos;
                    p[2 * (HATS * edge + k - 1) + 1] = 0.5 * sin;
                }
                0.5 * 70e9 * (p.transpose() * &total * &p)[(0, 0)]
            };
            let psi = direction - angle / 2.0;
            let exact = std::f64::consts::LN_2
                * (psi.cos().powi(2) / (angle + angle.sin()) + psi.sin().powi(2) / (angle - angle.sin()));
            println!(
                "angle {:.0} m {m} dir {:.0}: e1 {:.4} e2 {:.4} slopes {:.4} {:.4} {:.4} exact {exact:.4}  {dt:?}",
                angle.to_degrees(),
                direction.to_degrees(),
                e(1),
                e(2),
                e(4) - e(3),
                e(8) - e(7),
                e(10) - e(9)
            );
        }
    }
}

/// A linear displacement does no work on loads that balance and have no first moment, so ∫τ over the star is 0. On one
/// element, ∫σ:K⁻¹τ of a constant σ is K⁻¹σ:∫τ.
#[test]
fn integrals_are_those_of_virtual_work() {
    let law = law();
    let (alpha, beta) = law.compliance::<2>();
    let elements = elements(&fan(2.5, 3, 0.7), &law);
    let made = StarStress::new(&elements, &[0, 1]);
    let sum = made.integral.iter().fold(DMatrix::zeros(3, 4 * HATS), |sum, one| sum + one);
    assert!(sum.amax() < 1e-13, "{}", sum.amax());
    let stress = [3.0, -2.0, 1.5];
    let trace = beta * (stress[0] + stress[1]);
    let strain =
        nalgebra::RowVector3::new(alpha * stress[0] - trace, alpha * stress[1] - trace, 2.0 * alpha * stress[2]);
    for (element, (product, integral)) in elements.iter().zip(made.product.iter().zip(&made.integral)) {
        let mut loads = nalgebra::DVector::zeros(LOADS);
        for k in 0..3 {
            let (a, b) = (element.corners[(k + 1) % 3], element.corners[(k + 2) % 3]);
            let normal = [b[1] - a[1], a[0] - b[0]];
            for p in 0..2 {
                loads[4 * k + 2 * p] = stress[0] * normal[0] + stress[2] * normal[1];
                loads[4 * k + 2 * p + 1] = stress[2] * normal[0] + stress[1] * normal[1];
            }
        }
        let (found, expected) = (loads.transpose() * product, strain * integral);
        assert!((&found - &expected).amax() <= 1e-12 * expected.amax(), "{}", (found - expected).amax());
    }
}
