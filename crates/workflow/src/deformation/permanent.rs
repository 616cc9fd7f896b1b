//! The deformation that plastic flow leaves in a body.

use percute_core::element_state::ElementState;
use percute_core::material::{Elastic, Hypothesis};
use percute_core::problem::AnyProblem;

/// Integrals of plastic strains over bodies and materials at an instant.
#[derive(Clone, Debug)]
pub(super) struct FlowSums {
    /// The material of each body, if it is the only one and the body has no support.
    only: Vec<Option<usize>>,
    /// ∫dV and ∫ε_p dV of each body, as xx, yy, zz and xy (m³).
    bodies: Vec<[f64; 5]>,
    /// ∫dV and ∫p dV of each material (m³).
    materials: Vec<[f64; 2]>,
}

impl FlowSums {
    /// Those of a problem with elements of these bodies.
    pub(super) fn new(problem: &AnyProblem, body_of_element: &[usize]) -> Self {
        let (mesh, materials) = (problem.mesh(), problem.element_material());
        let bodies = body_of_element.iter().max().map_or(0, |last| last + 1);
        let mut only: Vec<Option<usize>> = vec![None; bodies];
        let mut several = vec![false; bodies];
        for (&body, &material) in body_of_element.iter().zip(materials) {
            let first = *only[body].get_or_insert(usize::from(material));
            several[body] |= first != usize::from(material);
        }
        let of_node = mesh.part_numbers();
        problem.prescribed().iter().for_each(|support| several[of_node[support.node.index()]] = true);
        only.iter_mut().zip(&several).filter(|(_, several)| **several).for_each(|(only, _)| *only = None);
        Self { only, bodies: vec![[0.0; 5]; bodies], materials: vec![[0.0; 2]; problem.materials().len()] }
    }

    /// Begins an instant.
    pub(super) fn clear(&mut self) {
        self.bodies.fill([0.0; 5]);
        self.materials.fill([0.0; 2]);
    }

    /// Adds the state of an element with this volume (m³) to its body and its material.
    pub(super) fn add(&mut self, [body, material]: [usize; 2], volume: f64, state: &ElementState) {
        let [xx, yy, zz, xy] = state.plastic_strain;
        let terms = [1.0, xx, yy, zz, xy];
        self.bodies[body].iter_mut().zip(terms).for_each(|(sum, term)| *sum += volume * term);
        let sums = &mut self.materials[material];
        (sums[0], sums[1]) = (sums[0] + volume, sums[1] + volume * state.equivalent_plastic_strain);
    }

    /// The mean of p over a material.
    pub(super) fn mean_equivalent_strain(&self, material: usize) -> f64 {
        let [volume, sum] = self.materials[material];
        if volume > 0.0 { sum / volume } else { 0.0 }
    }

    /// The mean strain that a body keeps at rest and free.
    ///
    /// ∫σ_ij dV = ∫x_i t_j dS + ∫x_i (f_j − ρ ü_j) dV is 0 there, and in one material so is the mean of K⁻¹σ, in the
    /// plane. In plane strain ε_p,zz leaves the stress −E ε_p,zz across, and with it the strain ν ε_p,zz in the plane.
    pub(super) fn permanent_strain(&self, body: usize, materials: &[Elastic]) -> Option<Vec<f64>> {
        let (law, [volume, sums @ ..]) = (&materials[self.only[body]?], self.bodies[body]);
        let [xx, yy, zz, xy] = sums.map(|sum| sum / volume);
        let across = law.poisson() * zz;
        let kept = match law.hypothesis() {
            Hypothesis::Bar => vec![xx],
            Hypothesis::PlaneStress => vec![xx, yy, xy],
            Hypothesis::PlaneStrain => vec![xx + across, yy + across, xy],
            // A solid that yields is refused.
            Hypothesis::Solid => return None,
        };
        (volume > 0.0 && sums.iter().any(|sum| *sum != 0.0)).then_some(kept)
    }
}
