//! The critical time step against eigenvalues known in closed form or by a dense solver.

use crate::solution::run::{aluminium, fixed};
use nalgebra::DMatrix;
use percute_core::dynamics::{critical_time_step, element_time_step};
use percute_core::kernel::InternalForces;
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_core::problem::Problem;
use percute_testkit::{disc, random_rectangle};
use std::f64::consts::PI;

/// 2/ω_max with ω_max from the dense matrix M^−½ K M^−½ on the free components.
fn dense_time_step<const D: usize>(problem: &Problem<D>) -> f64 {
    let count = D * problem.mesh().node_count();
    let stiffness = InternalForces::linear(problem);
    let mut matrix = DMatrix::zeros(count, count);
    for column in 0..count {
        let mut unit = vec![[0.0; D]; count / D];
        unit[column / D][column % D] = 1.0;
        let mut force = vec![[0.0; D]; count / D];
        stiffness.subtract_from_rows(unit.as_flattened(), force.as_flattened_mut());
        for row in 0..count {
            let masses = problem.mass()[row / D] * problem.mass()[column / D];
            matrix[(row, column)] = -force[row / D][row % D] / masses.sqrt();
        }
    }
    for p in problem.prescribed() {
        let index = D * p.node.index() + p.component;
        matrix.row_mut(index).fill(0.0);
        matrix.column_mut(index).fill(0.0);
    }
    2.0 / matrix.symmetric_eigenvalues().max().sqrt()
}

/// Lanczos against the dense solver to 1e-6, and the element-wise step never above either: a bound
/// that holds exactly, up to rounding of 1e-12.
fn check<const D: usize>(problem: &Problem<D>, what: &str) {
    let (critical, dense, element) =
        (critical_time_step(problem), dense_time_step(problem), element_time_step(problem));
    assert!((critical / dense - 1.0).abs() < 1e-6, "{what}: {critical} against {dense}");
    assert!(
        critical >= element * (1.0 - 1e-12) && dense >= element * (1.0 - 1e-12),
        "{what}: {critical} below {element}"
    );
}

/// A uniform chain with half masses at its free ends has the modes cos(jπi/n) and, with fixed ends,
/// sines; ω_j = (2c/h) sin(j'π/2n) with j' = n, n − ½, n − 1 for the highest of the three \[33\].
#[test]
fn uniform_bars_have_the_steps_of_their_modes() {
    for elements in [1, 2, 3, 10, 57, 400] {
        for (supports, lost) in [(&[][..], 0.0), (&["start"][..], 0.5), (&["start", "end"][..], 1.0)] {
            if elements == 1 && lost == 1.0 {
                continue; // Nothing can move.
            }
            let mesh = Mesh::uniform_bar(0.1, elements).unwrap();
            let mut builder = Problem::<1>::builder(mesh).material(Elastic::bar(70e9, 2700.0, 0.02).unwrap());
            for group in supports {
                builder = builder.support(Support {
                    group: group.to_string(),
                    components: [true, false, false],
                    velocity: None,
                });
            }
            let n = elements as f64;
            let h_over_c = 0.1 / n / (70e9_f64 / 2700.0).sqrt();
            let expected = h_over_c / ((n - lost) * PI / (2.0 * n)).sin();
            let found = critical_time_step(&builder.build().unwrap());
            // Below 320 unknowns, and where the element-wise bound is sharp, the iteration ends: its
            // precision is 1e-9 on ω², half of it on the step. Else it stops early, on the safe side,
            // within the 1e-3 on ω² that it documents.
            let short = if elements > 320 && lost > 0.0 { 5e-4 } else { 1e-9 };
            let ratio = found / expected;
            assert!(ratio > 1.0 - short && ratio < 1.0 + 1e-9, "{elements}, {supports:?}: {found} against {expected}");
        }
    }
}

#[test]
fn rectangles_and_discs_match_the_dense_solver() {
    let meshes = [
        ("structured", Mesh::rectangle(1.0, 0.7, 7, 5).unwrap()),
        ("unstructured", random_rectangle(1.0, 0.7, 7, 3).unwrap()),
        ("slender", random_rectangle(5.0, 0.4, 24, 1).unwrap()),
    ];
    for (what, mesh) in meshes {
        let free = Problem::<2>::builder(mesh).material(aluminium());
        check(&free.clone().build().unwrap(), what);
        check(&free.clone().support(fixed("left", [true, true])).build().unwrap(), what);
        check(&free.support(fixed("left", [true, false])).support(fixed("top", [false, true])).build().unwrap(), what);
    }
    let round = Problem::<2>::builder(disc(0.02, 0.005).unwrap());
    check(&round.material(Elastic::plane_strain(70e9, 0.45, 2700.0, 0.1).unwrap()).build().unwrap(), "disc");
}

/// Two materials: the stiffer and lighter part sets the step.
#[test]
fn mixed_materials_match_the_dense_solver() {
    let base = Mesh::rectangle(1.0, 1.0, 5, 5).unwrap();
    let cells: Vec<_> = base.nodes_of::<3>().iter().map(|c| c.map(|n| n.index())).collect();
    let groups =
        ElementGroups::from([("soft".to_string(), (0..20).collect()), ("hard".to_string(), (20..50).collect())]);
    let mesh = Mesh::new(base.points_in::<2>().to_vec(), &cells, &FaceGroups::new(), &groups).unwrap();
    let problem = Problem::<2>::builder(mesh)
        .material_of("soft", Elastic::plane_stress(3e9, 0.4, 1200.0, 1.0).unwrap())
        .material_of("hard", Elastic::plane_stress(400e9, 0.2, 3900.0, 1.0).unwrap())
        .build()
        .unwrap();
    check(&problem, "two materials");
}
