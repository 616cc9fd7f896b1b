//! Tractions of least energy: changes of those of the star problems that balance as well.
//!
//! The star problems fix most of the tractions by the work of the finite-element stress on each shape function,
//! element by element. Where that stress jumps, at a corner or where contact begins, such tractions can cost
//! three times the energy of the true error. Equilibrium requires less: any change of the tractions
//! that gives no element a resultant or a moment is allowed. The modes of [`basis`] span all of them. A few steps of
//! conjugate gradients over these modes, for each instant alone, reduce
//! ½∫(σ_DA − σ)K⁻¹(σ_DA − σ), σ the stress of the displacement that is equilibrated. The fields stay exactly admissible after
//! any number of steps.

mod basis;
mod descent;
mod energy;

use super::concentration::Concentration;
use crate::blocks::BLOCK;
use crate::element::Element;
use crate::measure::{BalanceFields, ElementMeasure};
use crate::options::Acceleration;
use crate::simd::dispatch;
use crate::stress::{EnergyForms, hooke};
use crate::traction::{EquilibratedLevels, Equilibration};
use basis::Basis;
use energy::{Form, MOMENTS, moment_form, moment_slope, product_slope};
use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use percute_core::simplex::Shape;
use rayon::prelude::*;

/// Steps of conjugate gradients: they bring 95 % of the possible gain (a test checks it). On the plane impacts of docs/verification.md, 20 steps instead lower the largest error by 1 to 2 %.
const STEPS: usize = 5;

/// Instants worked on together: each form is read once for all of them, and their numbers lie side by side.
/// None of them depends on which others it is with.
pub(super) const LANES: usize = 8;

/// A number at each of these instants.
pub(super) type Lanes = [f64; LANES];

/// The data that are fixed in time.
#[derive(Debug)]
pub(in crate::reconstruction) struct TractionMinimisation<const D: usize> {
    basis: Basis<D>,
    forms: Vec<Form>,
}

impl<const D: usize> TractionMinimisation<D> {
    /// Prepares all elements. In a bar there is nothing to choose.
    pub(in crate::reconstruction) fn new<const N: usize>(
        problem: &Problem<D, N>,
        elements: &[Element<D, N>],
    ) -> Option<Self> {
        match problem.mesh().simplex().shape() {
            Shape::Bar => return None,
            Shape::Triangle => {}
        }
        let mut energies = EnergyForms::new(problem.mesh().simplex().shape());
        let mut forms: Vec<Form> = Vec::with_capacity(elements.len());
        for start in (0..elements.len()).step_by(LANES) {
            let group = start..(start + LANES).min(elements.len());
            let lanes = energies.prepare(problem, group.clone().map(ElementId::new));
            for (e, lane) in group.zip(lanes) {
                let id = ElementId::new(e);
                // Energy does not depend on Γ_DA here: any choice will do.
                let measure = ElementMeasure::new(problem, &elements[e], id, Acceleration::Closest);
                forms.push(moment_form(&measure, &energies.of(problem, id, lane)));
            }
        }
        Some(Self { basis: Basis::new(problem, &forms), forms })
    }

    /// About how much memory it takes (bytes), with so many levels in a window and so many threads.
    pub(in crate::reconstruction) fn memory(shape: Shape, elements: usize, levels: usize, threads: usize) -> usize {
        match shape {
            Shape::Bar => return 0,
            Shape::Triangle => {}
        }
        // Forms, and in a triangulation three edges and half a node of its basis for two elements.
        let fixed = size_of::<Form>() + 3 * size_of::<basis::ElementEdge>() + 600;
        // Slopes of each level; of each chunk at work, three arrays of moments and four of modes.
        let chunk = size_of::<Lanes>() * (3 * 6 + 4 * 3);
        let chunks = levels.div_ceil(LANES).min(threads);
        elements.saturating_mul(fixed + levels * size_of::<[f64; MOMENTS]>() + chunks * chunk)
    }

    /// Improves the moments of all levels.
    pub(in crate::reconstruction) fn improve<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        equilibration: &Equilibration<'_, D, N>,
        choice: Acceleration,
        levels: &mut EquilibratedLevels<D>,
        concentration: Option<&Concentration<D>>,
    ) {
        let mut slopes = slopes(problem, equilibration, choice, levels);
        if let Some(concentration) = concentration {
            for (lane, forces) in levels.forces().iter().enumerate() {
                concentration.each_element(problem, forces.density.hats(), |element, stress| {
                    let slope = product_slope::<D, N>(&stress.products());
                    let to = &mut slopes[element.index()];
                    to.iter_mut().zip(slope).for_each(|(to, slope)| to[lane] += slope);
                });
            }
        }
        let change = descent::descend(&self.basis, &self.forms, |e| slopes[e], STEPS);
        for lane in 0..levels.len() {
            self.basis.add(&change, lane, levels.moments_mut());
        }
    }
}

/// The slopes of the energy of all elements in the moments on their edges.
fn slopes<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    equilibration: &Equilibration<'_, D, N>,
    choice: Acceleration,
    levels: &EquilibratedLevels<D>,
) -> Vec<[Lanes; MOMENTS]> {
    let mut slopes = vec![[[0.0; LANES]; MOMENTS]; equilibration.elements.len()];
    let block = |fields: &mut BalanceFields<D>, (block, slopes): (usize, &mut [[Lanes; MOMENTS]])| {
        dispatch(
            #[inline(always)]
            || {
                let range = equilibration.blocks.elements(block);
                fields.gather(equilibration.blocks.block(block).nodes, levels);
                fields.gather_displacement(equilibration.blocks.block(block).nodes, levels);
                let mut forms = EnergyForms::new(problem.mesh().simplex().shape());
                for start in range.clone().step_by(LANES) {
                    let group = start..(start + LANES).min(range.end);
                    let lanes = forms.prepare(problem, group.clone().map(ElementId::new));
                    for (e, lane) in group.zip(lanes) {
                        let (id, local) =
                            (ElementId::new(e), &equilibration.blocks.block(block).local[e - range.start]);
                        let element = &equilibration.elements[e];
                        let measure = ElementMeasure::new(problem, element, id, choice);
                        let balance = fields.nodal_balance(equilibration, levels, id, local);
                        let stress = hooke(problem.material(id), &element.gradient(&fields.displacement(local)));
                        let slope = moment_slope(&measure, &forms.of(problem, id, lane), &balance, &stress);
                        slopes[e - range.start] = slope.map(|s| s.0);
                    }
                }
            },
        );
    };
    slopes.par_chunks_mut(BLOCK).enumerate().for_each_init(BalanceFields::default, block);
    slopes
}

#[cfg(test)]
mod tests;
