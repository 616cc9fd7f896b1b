//! What a plan follows from.

use super::{Branch, MOST};
use crate::message::whole_percent;
use percute_core::contact_results::ContactResults;
use percute_core::ids::NodeId;
use percute_core::mesh::Mesh;
use percute_estimator::{Estimate, Separation};

/// The elements of a run, their parts of the squared mean error, and its sources.
#[derive(Clone, Debug)]
pub struct Basis {
    /// The dimension of the elements.
    pub(super) dimension: usize,
    /// h of each element: the root of its area, or its length (m).
    pub(super) size: Vec<f64>,
    /// e_E² of each element (J).
    pub(super) squared: Vec<f64>,
    /// Whether an element has a node that has touched.
    pub(super) touches: Vec<bool>,
    /// Nodes that have touched.
    pub(super) nodes: Vec<NodeId>,
    /// The sources of the squared mean error.
    pub(super) sources: Separation,
    /// Elements times steps.
    pub(super) element_steps: f64,
}

impl Basis {
    /// Of an estimated run; none without sources, or without an error.
    #[must_use]
    pub fn new(mesh: &Mesh, estimate: &Estimate, contact: &ContactResults) -> Option<Self> {
        let sources = estimate.sources.clone()?;
        let squared: Vec<f64> = estimate.by_element.iter().map(|e| e * e).collect();
        let total = sources.mean.total();
        if estimate.error.is_zero() || !(total > 0.0 && total.is_finite()) || squared.iter().all(|e| *e <= 0.0) {
            return None;
        }
        let touched = contact.nodes.iter().zip(&contact.summary).filter(|(_, summary)| summary.first_touch.is_some());
        let mut nodes: Vec<NodeId> = touched.map(|(place, _)| place.node).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut touches = vec![false; mesh.element_count()];
        for node in &nodes {
            mesh.elements_around(*node).iter().for_each(|element| touches[element.index()] = true);
        }
        let element_steps = mesh.element_count() as f64 * estimate.steps as f64;
        Some(Self { dimension: mesh.dimension(), size: sizes(mesh), squared, touches, nodes, sources, element_steps })
    }

    /// How elements are made smaller, by the largest source.
    #[must_use]
    pub fn branch(&self) -> Branch {
        let mean = &self.sources.mean;
        match MOST * mean.total() {
            half if mean.surface > half => Branch::Graded,
            half if mean.mesh > half => Branch::Map,
            _ => Branch::Uniform,
        }
    }

    /// The size of each element (m).
    #[must_use]
    pub fn size(&self) -> &[f64] {
        &self.size
    }

    /// Nodes that have touched.
    #[must_use]
    pub fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    /// Whether each element has a node that has touched.
    #[must_use]
    pub fn touches(&self) -> &[bool] {
        &self.touches
    }

    /// Elements times steps of the run.
    #[must_use]
    pub fn element_steps(&self) -> f64 {
        self.element_steps
    }

    /// Parts of the sources in the squared mean error: surface, front, dispersion, mesh.
    #[must_use]
    pub fn shares(&self) -> [f64; 4] {
        let mean = &self.sources.mean;
        [mean.surface, mean.front, mean.dispersion, mean.mesh].map(|part| part / mean.total())
    }

    /// The sources of the squared mean error.
    #[must_use]
    pub fn sources(&self) -> &Separation {
        &self.sources
    }
}

/// Parts of the sources in words.
pub(crate) fn shares_told(shares: &[f64; 4]) -> String {
    let names = ["surface", "front", "dispersion", "mesh"];
    let each = names.iter().zip(shares).map(|(name, part)| format!("{name} {}", whole_percent(*part)));
    each.collect::<Vec<_>>().join(", ")
}

/// h of each element: the root of its area, or its length (m).
pub(crate) fn sizes(mesh: &Mesh) -> Vec<f64> {
    mesh.volumes().into_iter().map(|volume| volume.powf(1.0 / mesh.dimension() as f64)).collect()
}
