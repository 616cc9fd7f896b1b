//! Strain, stress and energies of the elements.

use percute_core::contact::Obstacle;
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::element_state::{ElementState, kinetic_energy};
use percute_core::history::{SinkError, State, StateSink};
use percute_core::ids::ElementId;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::random_rectangle;

/// Displacement gradient and translation (m) of a linear field: the translation is 10⁵ times the strained length.
const GRADIENT: [[f64; 2]; 2] = [[2e-4, -5e-4], [3e-4, -1e-4]];
const TRANSLATION: [f64; 2] = [3.0, -2.0];

/// Strains of a translated body lose the digits of the displacements: 3 m in 2e-16 over 2e-3 m of an element, over
/// 1e-4.
const ROUNDING: f64 = 1e-8;

fn linear(mesh: &Mesh) -> Vec<[f64; 2]> {
    let moved = |p: &[f64; 2]| std::array::from_fn(|a| TRANSLATION[a] + GRADIENT[a][0] * p[0] + GRADIENT[a][1] * p[1]);
    mesh.points_in::<2>().iter().map(moved).collect()
}

fn elements<const D: usize>(problem: &Problem<D>) -> impl Iterator<Item = ElementId> {
    (0..problem.mesh().element_count()).map(ElementId::new)
}

/// Isotropic elasticity in three dimensions, with ε_zz = 0 in plane strain, and −ν/(1 − ν)(ε_xx + ε_yy) in plane
/// stress.
fn in_space(young: f64, poisson: f64, strain: bool) -> [[f64; 3]; 3] {
    let [[xx, a], [b, yy]] = GRADIENT;
    let zz = if strain { 0.0 } else { -poisson / (1.0 - poisson) * (xx + yy) };
    let shear = young / (2.0 * (1.0 + poisson));
    let lambda = 2.0 * shear * poisson / (1.0 - 2.0 * poisson);
    let normal = |e: f64| 2.0 * shear * e + lambda * (xx + yy + zz);
    let xy = shear * (a + b);
    [[normal(xx), xy, 0.0], [xy, normal(yy), 0.0], [0.0, 0.0, normal(zz)]]
}

/// √(3/2 s:s) and −⅓ tr σ.
fn invariants(stress: &[[f64; 3]; 3]) -> (f64, f64) {
    let pressure = -(stress[0][0] + stress[1][1] + stress[2][2]) / 3.0;
    let deviator = |a: usize, b: usize| stress[a][b] + if a == b { pressure } else { 0.0 };
    let sum: f64 = (0..9).map(|k| deviator(k / 3, k % 3).powi(2)).sum();
    ((1.5 * sum).sqrt(), pressure)
}

#[test]
fn a_linear_field_has_the_stress_of_three_dimensions() {
    let mesh = random_rectangle(0.05, 0.04, 6, 2).unwrap();
    let (young, poisson) = (70e9, 0.3);
    let laws = [Elastic::plane_stress(young, poisson, 2700.0, 0.5), Elastic::plane_strain(young, poisson, 2700.0, 0.5)];
    for (law, strain) in laws.into_iter().zip([false, true]) {
        let problem = Problem::<2>::builder(mesh.clone()).material(law.unwrap()).build().unwrap();
        let expected = in_space(young, poisson, strain);
        let (von_mises, pressure) = invariants(&expected);
        let tolerance = ROUNDING * von_mises;
        for element in elements(&problem) {
            let state = ElementState::new(&problem, element, linear(&mesh).as_flattened(), &[]);
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                assert!((state.stress[a][b] - expected[a][b]).abs() < tolerance, "{element:?}: {state:?}");
                let symmetric = 0.5 * (GRADIENT[a][b] + GRADIENT[b][a]);
                assert!((state.strain[a][b] - symmetric).abs() < ROUNDING * 5e-4, "{element:?}: {state:?}");
            }
            assert!((state.stress_across - expected[2][2]).abs() < tolerance);
            assert!(
                (state.von_mises() - von_mises).abs() < tolerance && (state.pressure() - pressure).abs() < tolerance
            );
            // ½ σ:ε: ε_zz or σ_zz is 0.
            let product: f64 = (0..4).map(|k| state.stress[k / 2][k % 2] * state.strain[k / 2][k % 2]).sum();
            let energy = 0.5 * product * problem.volume(element);
            assert!((state.strain_energy - energy).abs() < 1e-12 * energy);
        }
    }
}

#[test]
fn a_bar_has_stress_along_it_alone() {
    let problem = Problem::<1>::builder(Mesh::uniform_bar(0.3, 3).unwrap());
    let problem = problem.material(Elastic::bar(2e11, 7800.0, 1e-4).unwrap()).build().unwrap();
    let displacement: Vec<f64> = problem.mesh().points_in::<1>().iter().map(|p| -1e-3 * p[0]).collect();
    for element in elements(&problem) {
        let state = ElementState::new(&problem, element, &displacement, &[]);
        assert!((state.stress[0][0] + 2e8).abs() < 1e-6);
        assert!((state.von_mises() - 2e8).abs() < 1e-6 && (state.pressure() - 2e8 / 3.0).abs() < 1e-6);
        assert!((state.strain_energy - 0.5 * 2e8 * 1e-3 * 1e-5).abs() < 1e-12);
    }
}

/// Motion at the last instant.
#[derive(Default)]
struct Last {
    displacement: Vec<f64>,
    velocity: Vec<f64>,
}

impl StateSink for Last {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        (self.displacement, self.velocity) = (state.step().displacement.to_vec(), state.velocity());
        Ok(())
    }
}

/// Sums over the elements are the energies of the balance, with two materials, in an impact.
#[test]
fn energies_of_the_elements_sum_to_those_of_the_balance() {
    let mesh = random_rectangle(0.05, 0.04, 8, 3).unwrap();
    let half: Vec<usize> = (0..mesh.element_count()).filter(|e| e % 2 == 0).collect();
    let other: Vec<usize> = (0..mesh.element_count()).filter(|e| e % 2 == 1).collect();
    let cells: Vec<[usize; 3]> = mesh.nodes_of::<3>().iter().map(|nodes| nodes.map(|n| n.index())).collect();
    let bottom: Vec<[usize; 2]> =
        mesh.face_groups()["bottom"].iter().map(|face| mesh.face_nodes::<2>(*face).map(|n| n.index())).collect();
    let edges = [("bottom".to_string(), bottom)].into();
    let groups = [("soft".to_string(), half), ("hard".to_string(), other)].into();
    let mesh = Mesh::new(mesh.points_in::<2>().to_vec(), &cells, &edges, &groups).unwrap();
    let problem = Problem::<2>::builder(mesh)
        .material_of("soft", Elastic::plane_strain(3e9, 0.4, 1200.0, 0.1).unwrap())
        .material_of("hard", Elastic::plane_strain(70e9, 0.3, 2700.0, 0.1).unwrap())
        .initial_velocity(Initial::Uniform([40.0, -30.0]))
        .obstacle(Obstacle::plane([0.0, -1e-5], [0.02, 1.0], 0.3, Some("bottom".to_string())).unwrap())
        .build()
        .unwrap();
    let times = TimeGrid::uniform(0.8 * critical_time_step(&problem) * 120.0, 120).unwrap();
    let mut last = Last::default();
    let balance = simulate(&problem, &times, &mut last, &mut Unobserved).unwrap().balance;
    let strain: f64 =
        elements(&problem).map(|e| ElementState::new(&problem, e, &last.displacement, &[]).strain_energy).sum();
    let kinetic: f64 = elements(&problem).map(|e| kinetic_energy(&problem, e, &last.velocity)).sum();
    assert!(balance.strain > 1e-3 * balance.kinetic, "there was no impact");
    assert!((strain - balance.strain).abs() < 1e-12 * balance.strain, "{strain} against {}", balance.strain);
    assert!((kinetic - balance.kinetic).abs() < 1e-12 * balance.kinetic, "{kinetic} against {}", balance.kinetic);
}
