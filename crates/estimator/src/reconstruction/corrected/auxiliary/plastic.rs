//! The plastic strain of the auxiliary solution.
//!
//! Each element has the law of its own strain. The forces of the auxiliary solution are those of the smoothed elastic
//! strains, K_s u less B̄ᵀK̄ε* of the plastic ones, with the same means. Without flow nothing changes.

use super::internal_forces::add_internal_forces;
use super::lanes::Nodal;
use crate::components::{components, tensor};
use crate::element::Element;
use crate::parallel::by_pieces;
use crate::plastic::EigenStrains;
use crate::smoothing::{Smoothed, SmoothedStrains, Smoothing};
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::{PointLaw, Tensor, VonMises};
use percute_core::problem::Problem;
use std::array::from_fn;

/// The plastic strains of all elements.
#[derive(Debug)]
pub(super) struct PlasticStrains<const D: usize, const N: usize> {
    laws: Vec<VonMises>,
    elements: Vec<Element<D, N>>,
    /// Internal variables; of bars the first two.
    internal: Vec<[f64; 4]>,
    eigen: EigenStrains,
    strains: SmoothedStrains<f64>,
    stresses: Vec<Tensor<D>>,
    /// Whether any element has yielded.
    yielded: bool,
}

impl<const D: usize, const N: usize> PlasticStrains<D, N> {
    /// Those of a problem in which a material yields.
    pub(super) fn new(problem: &Problem<D>, elements: &[Element<D, N>]) -> Option<Self> {
        problem.yields().then(|| Self {
            laws: problem.yielding_laws(),
            elements: elements.to_vec(),
            internal: vec![[0.0; 4]; elements.len()],
            eigen: vec![[0.0; 3]; elements.len()],
            strains: SmoothedStrains::default(),
            stresses: vec![[[0.0; D]; D]; elements.len()],
            yielded: false,
        })
    }

    /// ε* of all elements.
    pub(super) fn eigenstrains(&self) -> &EigenStrains {
        &self.eigen
    }

    /// Goes on to the displacements u + `due` v, and adds the forces of the plastic strains there (N) to `external`.
    pub(super) fn advance(
        &mut self,
        (problem, smoothing): (&Problem<D>, &Smoothing),
        (displacement, half_step, due): (&[Nodal], &[Nodal], f64),
        smooths: bool,
        external: &mut [[f64; D]],
    ) {
        let Self { laws, elements, internal, eigen, strains, stresses, yielded } = self;
        let (count, materials) = (VonMises::count(D), problem.element_material());
        let elements = &elements[..];
        let place = |node: NodeId| -> [f64; D] {
            let (u, v): ([f64; D], [f64; D]) = (displacement[node.index()].of(0), half_step[node.index()].of(0));
            from_fn(|c| u[c] + due * v[c])
        };
        by_pieces((&mut internal[..], &mut eigen[..], elements), &|first, (internal, eigen, elements)| {
            let points = internal.iter_mut().zip(eigen).zip(elements).zip(&materials[first..]);
            for (((variables, eigen), element), law) in points {
                let (variables, law) = (&mut variables[..count], &laws[usize::from(*law)]);
                law.advance(&element.gradient(&element.nodes.map(place)), variables);
                *eigen = components(&law.eigenstrain::<f64, D>(variables));
            }
        });
        *yielded = *yielded || eigen.as_flattened().iter().any(|x| *x != 0.0);
        if !*yielded {
            return;
        }
        let of = Smoothed { problem, smoothing, elements };
        if smooths {
            strains.fill_strains(of, eigen);
        }
        by_pieces(&mut stresses[..], &|first, stresses| {
            for (k, stress) in stresses.iter_mut().enumerate() {
                let id = ElementId::new(first + k);
                let strain = if smooths { strains.of(0.0, of, id) } else { tensor(eigen[first + k]) };
                *stress = problem.material(id).respond(&strain, &mut []).0;
            }
        });
        add_internal_forces((problem.mesh(), elements), stresses, 1.0, external);
    }
}
