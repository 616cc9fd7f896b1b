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

fn solved(fan: &[[f64; 2]], edges: &[usize]) -> Solved {
    let law = law();
    Solved::new([0.0; 2], fan, &vec![&law; fan.len() - 1], edges)
}

/// Rounding: the system has some hundred rows in each layer.
#[test]
fn every_sub_triangle_is_in_equilibrium() {
    let solved = solved(&fan(std::f64::consts::PI, 3, 0.7), &[0, 1]);
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
    for (angle, m) in [(std::f64::consts::PI, 2), (std::f64::consts::PI, 3), (std::f64::consts::PI, 4), (0.5 * std::f64::consts::PI, 1), (0.5 * std::f64::consts::PI, 2), (0.5 * std::f64::consts::PI, 3)] {
        let t = std::time::Instant::now();
        let law = law();
        let fan = fan(angle, m, 1.0);
        let stress = StarStress::new([0.0; 2], &fan, &vec![&law; m], &[0, 1]);
        let dt = t.elapsed();
        let total = stress.energy.iter().fold(DMatrix::zeros(40, 40), |a, b| a + b);
        for direction in [angle / 2.0, 0.0, angle / 2.0 + std::f64::consts::FRAC_PI_2] {
            let (sin, cos) = direction.sin_cos();
            let e = |k: usize| {
                let mut p = nalgebra::DVector::zeros(40);
                for edge in 0..2 { p[2 * (HATS * edge + k - 1)] = 0.5 * cos; p[2 * (HATS * edge + k - 1) + 1] = 0.5 * sin; }
                0.5 * 70e9 * (p.transpose() * &total * &p)[(0, 0)]
            };
            let psi = direction - angle / 2.0;
            let exact = std::f64::consts::LN_2 * (psi.cos().powi(2) / (angle + angle.sin()) + psi.sin().powi(2) / (angle - angle.sin()));
            println!("angle {:.0} m {m} dir {:.0}: e1 {:.4} e2 {:.4} slopes {:.4} {:.4} {:.4} exact {exact:.4}  {dt:?}", angle.to_degrees(), direction.to_degrees(), e(1), e(2), e(4) - e(3), e(8) - e(7), e(10) - e(9));
        }
    }
}
