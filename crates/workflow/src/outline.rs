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
pub(crate) struct LastOutline {
    nodes: Vec<usize>,
    dimension: usize,
    time: f64,
    displacement: Vec<f64>,
}

impl LastOutline {
    /// That of a mesh; a bar has no outline.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let faces = mesh.boundary();
        let nodes = faces.into_iter().flat_map(|face| mesh.face(face).nodes);
        let mut nodes: Vec<usize> = nodes.map(|node| node.index()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        if mesh.dimension() == 1 {
            nodes.clear();
        }
        Self { nodes, dimension: mesh.dimension(), time: 0.0, displacement: Vec::new() }
    }

    /// The outline, with nodes as `number` calls them; none of a bar or before the first step.
    pub(crate) fn finish(self, number: impl Fn(usize) -> usize) -> Option<Outline> {
        let mut rows: Vec<_> =
            self.nodes.into_iter().map(number).zip(self.displacement.chunks_exact(self.dimension)).collect();
        rows.sort_unstable_by_key(|(node, _)| *node);
        let (node, displacement): (Vec<_>, Vec<_>) = rows.into_iter().map(|(node, u)| (node, u.to_vec())).unzip();
        (!node.is_empty()).then_some(Outline { time: self.time, node, displacement })
    }
}

impl StateSink for LastOutline {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let step = state.step();
        self.time = step.time;
        self.displacement.clear();
        let row = |&node: &usize| &step.displacement[self.dimension * node..self.dimension * (node + 1)];
        self.displacement.extend(self.nodes.iter().flat_map(row));
        Ok(())
    }
}
