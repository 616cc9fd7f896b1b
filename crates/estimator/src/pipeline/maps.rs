//! The maps that were requested, as they fill: nodal motion and element fields when their level is
//! worked on, contributions as elements get there, the motion at contact when it is known.

use crate::blocks::BLOCK;
use crate::components::{COMPONENTS, subtract, tensor};
use crate::element::Element;
use crate::kinematic::{ContactMotion, common, settle};
use crate::map::{AdmissibleFields, ElementMap};
use crate::measure::{ElementError, ElementMeasure};
use crate::options::Acceleration;
use crate::plastic::EigenStrains;
use crate::reconstruction::Concentration;
use crate::request::{Request, RequestError};
use crate::traction::{EquilibratedLevel, EquilibratedLevels, Equilibration};
use percute_core::border::vectors;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;
use rayon::prelude::*;

/// The contribution of one element at one requested step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contribution {
    pub(crate) element: ElementId,
    pub(crate) step: usize,
    pub(crate) error: ElementError,
    /// The contact part (J).
    pub(crate) contact: f64,
    /// ∫η_E dt so far (J s).
    pub(crate) accumulated: f64,
    /// ε* of σ_CA, as xx, yy and xy.
    pub(crate) eigenstrain: [f64; 3],
}

/// The request, and the maps of the steps that have come.
#[derive(Debug)]
pub(crate) struct Maps {
    request: Request,
    made: Vec<ElementMap>,
    /// ε* of σ_CA at each of them, where fields are requested and a material yields.
    eigenstrains: Vec<EigenStrains>,
    /// How many of them have the motion at contact.
    settled: usize,
}

impl Maps {
    /// Makes sure that memory can hold what is requested.
    pub(crate) fn new<const D: usize>(request: Request, problem: &Problem<D>) -> Result<Self, RequestError> {
        let (nodes, elements) = (problem.mesh().node_count(), problem.mesh().element_count());
        let fields = if request.fields { 2 * D * nodes + (2 * D * D + D) * elements } else { 0 };
        let steps = request.steps.len();
        let bytes = (5 * elements + fields).saturating_mul(size_of::<f64>()).saturating_mul(steps);
        match Vec::<u8>::new().try_reserve_exact(bytes) {
            Ok(()) => Ok(Self { request, made: Vec::new(), eigenstrains: Vec::new(), settled: 0 }),
            Err(_) => Err(RequestError::Memory { bytes, steps }),
        }
    }

    /// Whether a step is among those requested.
    #[inline]
    pub(crate) fn want(&self, step: usize) -> bool {
        self.request.steps.binary_search(&step).is_ok()
    }

    /// Begins the maps of these levels, of which the motion and the tractions are known.
    pub(crate) fn begin<const D: usize, const N: usize>(
        &mut self,
        instants: &[f64],
        balance: &Balance<'_, D, N>,
        levels: &EquilibratedLevels<D>,
    ) {
        let zeros = vec![0.0; balance.equilibration.elements.len()];
        for level in (0..levels.len()).map(|k| levels.level(k)) {
            if !self.want(level.index()) {
                continue;
            }
            let fields = self.request.fields.then(|| fields(balance, &level));
            if fields.is_some() && balance.problem.yields() {
                self.eigenstrains.push(vec![[0.0; COMPONENTS]; zeros.len()]);
            }
            self.made.push(ElementMap {
                step: level.index(),
                time: instants[level.index()],
                kinetic: zeros.clone(),
                dissipation: zeros.clone(),
                elastic: zeros.clone(),
                contact: zeros.clone(),
                accumulated: zeros.clone(),
                fields,
            });
        }
    }

    /// Puts the contributions of elements in their places.
    pub(crate) fn put<'c>(&mut self, contributions: impl IntoIterator<Item = &'c Contribution>) {
        for contribution in contributions {
            let e = contribution.element.index();
            if let Ok(k) = self.made.binary_search_by_key(&contribution.step, |map| map.step) {
                let map = &mut self.made[k];
                (map.kinetic[e], map.elastic[e]) = (contribution.error.kinetic, contribution.error.elastic);
                map.dissipation[e] = contribution.error.plastic;
                if let Some(strains) = self.eigenstrains.get_mut(k) {
                    strains[e] = contribution.eigenstrain;
                }
                (map.contact[e], map.accumulated[e]) = (contribution.contact, contribution.accumulated);
            }
        }
    }

    /// Puts the motion at contact into the maps of steps up to this one, at which it is at hand.
    pub(crate) fn settle<const D: usize>(&mut self, problem: &Problem<D>, tracks: &[ContactMotion], last: usize) {
        let count = self.made.partition_point(|map| map.step <= last);
        for map in &mut self.made[self.settled..count] {
            let Some(fields) = &mut map.fields else { continue };
            let nodes = problem.surface().nodes();
            let common = |field: &[[f64; D]]| -> Vec<[f64; D]> {
                (0..nodes.len()).map(|at| common(problem, at, field)).collect()
            };
            let (displacement, velocity) = (common(vectors(&fields.displacement)), common(vectors(&fields.velocity)));
            for (at, (mut displacement, mut velocity)) in displacement.into_iter().zip(velocity).enumerate() {
                if problem.surface().first_entry(at) != at {
                    continue;
                }
                settle((problem, at), [&mut displacement, &mut velocity], tracks, 2 * map.step);
                let i = nodes[at].node.index();
                fields.displacement[D * i..D * (i + 1)].copy_from_slice(&displacement);
                fields.velocity[D * i..D * (i + 1)].copy_from_slice(&velocity);
            }
        }
        self.settled = count;
    }

    /// The maps, once all have the motion at contact.
    pub(crate) fn finish<const D: usize, const N: usize>(
        mut self,
        problem: &Problem<D>,
        elements: &[Element<D, N>],
    ) -> Vec<ElementMap> {
        for (k, map) in self.made.iter_mut().enumerate() {
            let Some(fields) = &mut map.fields else { continue };
            let displacement = vectors::<D>(&fields.displacement);
            let eigenstrains = self.eigenstrains.get(k);
            let compatible = |(e, element): (usize, &Element<D, N>)| {
                let mut gradient = element.gradient(&element.gather(displacement));
                if let Some(strains) = eigenstrains {
                    subtract(&mut gradient, &tensor(strains[e]));
                }
                problem.material(ElementId::new(e)).stress(&gradient).into_iter().flatten()
            };
            fields.compatible_stress = elements.iter().enumerate().flat_map(compatible).collect();
        }
        self.made
    }
}

/// The data of the fields that balance.
pub(super) struct Balance<'a, const D: usize, const N: usize> {
    pub(super) problem: &'a Problem<D>,
    pub(super) equilibration: &'a Equilibration<'a, D, N>,
    pub(super) choice: Acceleration,
    pub(super) concentration: Option<&'a Concentration<D>>,
}

/// The motion of all nodes, normal components at contact still those of the simulation, and the
/// means of σ_DA and Γ_DA/ρ.
fn fields<const D: usize, const N: usize>(
    balance: &Balance<'_, D, N>,
    level: &EquilibratedLevel<'_, D>,
) -> AdmissibleFields {
    let Balance { problem, equilibration, choice, concentration } = *balance;
    let elements = &equilibration.elements;
    let mut means = vec![([[0.0; D]; D], [0.0; D]); elements.len()];
    means.par_chunks_mut(BLOCK).zip(elements.par_chunks(BLOCK)).enumerate().for_each(|(block, (means, elements))| {
        for (k, (mean, element)) in means.iter_mut().zip(elements).enumerate() {
            let measure = ElementMeasure::new(problem, element, ElementId::new(block * BLOCK + k), choice);
            *mean = measure.means(equilibration, level);
        }
    });
    let (mut stress, acceleration): (Vec<_>, Vec<_>) = means.into_iter().unzip();
    if let Some(concentration) = concentration {
        concentration.each_element(problem, level.forces().density.hats(), |element, hats| {
            let measure = ElementMeasure::new(problem, &elements[element.index()], element, choice);
            let gradient = measure.gradient(&level.forces().level.displacement);
            let mean = problem.material(element).per_present_area(&measure.mean_of_hats(hats), &gradient);
            let to = stress[element.index()].iter_mut().flatten().zip(mean.into_iter().flatten());
            to.for_each(|(to, mean)| *to += mean);
        });
    }
    AdmissibleFields {
        displacement: level.forces().now.motion.displacement().as_flattened().to_vec(),
        velocity: level.forces().now.motion.velocity().as_flattened().to_vec(),
        stress: stress.into_flattened().into_flattened(),
        compatible_stress: Vec::new(),
        acceleration: acceleration.into_flattened(),
    }
}
