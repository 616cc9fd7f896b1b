use super::*;
use crate::element::elements;
use crate::stress::{EnergyForms, TriangleStress};
use percute_core::material::Elastic;
use percute_core::problem::Problem;
use percute_testkit::{Random, random_rectangle};

/// Random tractions and Γ_DA on an element that balance: at each node, the moment on the edge that ends there makes the
/// forces those of a random mean stress.
fn random_balance(measure: &ElementMeasure<'_, 2, 3>, random: &mut Random) -> Balanced<2, 3> {
    let mut vector = || [(); 2].map(|()| random.between(-1.0, 1.0));
    let mut fields = NodalBalance {
        moments: [(); 3].map(|()| [vector(), vector()]),
        acceleration: [(); 3].map(|()| vector()),
        skew: None,
        body_force: vector(),
        displacement: None,
    };
    let ([xx, xy], [_, yy]) = (vector(), vector());
    let (unbalanced, extent) = (measure.balanced(&fields), measure.law.extent());
    for i in 0..3 {
        let wanted = measure.element.internal_force(i, &[[xx, xy], [xy, yy]]);
        for c in 0..2 {
            let force = unbalanced.forces[i].outer[c] - unbalanced.forces[i].inner[c];
            fields.moments[(i + 1) % 3][1][c] += wanted[c] - extent * force;
        }
    }
    measure.balanced(&fields)
}

/// η of elements of a body that is not of unit thickness is the energy of the difference of the fields, and d twice
/// that of their sum. The stress that balances a loading and the tractions of σ_CA is made in another way.
#[test]
fn errors_are_energies_of_differences_and_sums() {
    let law = Elastic::plane_strain(3.0, 0.3, 2.0, 0.25).unwrap();
    let problem = Problem::<2>::builder(random_rectangle(1.0, 0.8, 3, 1).unwrap()).material(law).build().unwrap();
    let mut random = Random::new(7);
    for (e, element) in elements(&problem).iter().enumerate() {
        let (id, points) = (ElementId::new(e), problem.mesh().corners::<2, 3>(ElementId::new(e)));
        let measure = ElementMeasure::new(&problem, element, id, Acceleration::Closest);
        let balanced = random_balance(&measure, &mut random);
        assert!(measure.resultant_residual(&balanced, 0.0) < 1e-13);
        let mut nodal = || [(); 3].map(|()| [(); 2].map(|()| random.between(-1.0, 1.0)));
        let (increment, displacement, velocity) = (nodal(), nodal(), nodal());
        let motion = ElementMotion::any(displacement, velocity);
        let mut forms = EnergyForms::new(problem.mesh().kind());
        let [lane, ..] = forms.prepare(&problem, std::iter::once((id, points)));
        let stress = measure.stress(&forms.of(&problem, id, &points, lane), &balanced);
        let found = measure.error(&stress, &increment, &motion, None);
        // Tractions of σ_CA come off for η and on for d.
        let other = TriangleStress::new(&points, problem.material(id));
        let energy = |sign: f64| {
            let [sigma, _] = measure.stress_and_strain(&element.gradient(motion.displacement()));
            let mut loading = balanced.loading;
            measure.subtract_tractions(&sigma.map(|row| row.map(|x| sign * x)), &mut loading);
            let v: [[f64; 2]; 3] =
                std::array::from_fn(|i| std::array::from_fn(|c| increment[i][c] - sign * velocity[i][c]));
            let elastic = other.energy(&loading) * measure.law.extent();
            [elastic, 0.5 * mass_product(3.0 * element.nodal_mass, &v, &v)]
        };
        let ([elastic, kinetic], [sum, moving]) = (energy(1.0), energy(-1.0));
        // Rounding of some hundred terms.
        for (a, b) in [(found.elastic, elastic), (found.kinetic, kinetic), (found.reference, 2.0 * (sum + moving))] {
            assert!((a - b).abs() < 1e-12 * b.abs().max(elastic + kinetic), "element {e}: {a} for {b}");
        }
    }
}
