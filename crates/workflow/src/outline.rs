//! The outline of a plane body at the last step, from which pictures draw its deformed shape.

use percute_core::history::{SinkError, State, StateSink};
use percute_core::mesh::Mesh;
use serde::Serialize;

/// Displacements of the boundary of a plane body at an instant.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outline {
    /// The instant (s).
    pub time: f64,
    /// Nodes of the boundary.
    pub node: Vec<usize>,
    /// Their displacements (m).
    pub displacement: Vec<Vec<f64>>,
}

/// Keeps the displacements of the boundary at the last step that it is handed.
#[derive(Clone, Debug)]
pub(crate) struct LastOutline<const D: usize> {
    nodes: Vec<usize>,
    time: f64,
    displacement: Vec<[f64; D]>,
}

impl<const D: usize> LastOutline<D> {
    /// That of a mesh; a bar has no outline.
    pub(crate) fn new<const N: usize>(mesh: &Mesh<D, N>) -> Self {
        let facets = mesh.boundary().flat_map(|facet| mesh.facets()[facet.index()].nodes);
        let mut nodes: Vec<usize> = facets.map(|node| node.index()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        if D == 1 {
            nodes.clear();
        }
        Self { nodes, time: 0.0, displacement: Vec::new() }
    }

    /// The outline, with nodes as `number` calls them; none of a bar or before the first step.
    pub(crate) fn finish(self, number: impl Fn(usize) -> usize) -> Option<Outline> {
        let mut rows: Vec<_> = self.nodes.into_iter().map(number).zip(self.displacement).collect();
        rows.sort_unstable_by_key(|(node, _)| *node);
        let (node, displacement): (Vec<_>, Vec<_>) = rows.into_iter().map(|(node, u)| (node, u.to_vec())).unzip();
        (!node.is_empty()).then_some(Outline { time: self.time, node, displacement })
    }
}

impl<const D: usize> StateSink<D> for LastOutline<D> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        let step = state.step();
        self.time = step.time;
        self.displacement.clear();
        self.displacement.extend(self.nodes.iter().map(|&node| step.displacement[node]));
        Ok(())
    }
}
