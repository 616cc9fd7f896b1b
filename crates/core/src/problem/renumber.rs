//! The same problem under other numbers of nodes and elements.

use super::{BodyLoad, FaceLoad, Model, PrescribedComponent, Problem};
use crate::mesh::Numbering;

impl<const D: usize> Problem<D> {
    /// The problem on the renumbered mesh. The nodes of the contact surface keep their order, so that rows of reactions
    /// and touching status are those of either problem.
    #[must_use]
    pub fn renumbered(&self, numbering: &Numbering) -> Self {
        let (mesh, new) = self.mesh.renumbered(numbering);
        let (nodes, elements) = (numbering.nodes(), numbering.elements());
        let nodal = |field: &[[f64; D]]| nodes.iter().map(|node| field[node.index()]).collect();

        let mut supported = vec![[false; D]; self.supported.len()];
        new.face.iter().zip(&self.supported).for_each(|(&face, held)| supported[face as usize] = *held);
        let renamed = |p: &PrescribedComponent| PrescribedComponent { node: new.node(p.node), ..*p };
        let mut prescribed: Vec<_> = self.prescribed.iter().map(renamed).collect();
        prescribed.sort_unstable_by_key(|p| (p.node, p.component));
        let face_load = |load: &FaceLoad<D>| {
            let nodes = &self.mesh.face_nodes::<D>(load.face);
            FaceLoad { face: new.face(load.face), profile: new.along(nodes, load.profile), ..*load }
        };
        let mut face_loads: Vec<_> = self.face_loads.iter().map(face_load).collect();
        face_loads.sort_unstable_by_key(|load| (load.table, load.face));
        let body_load = |load: &BodyLoad| {
            let mut nodal_volume: Vec<_> = load.nodal_volume.iter().map(|&(node, v)| (new.node(node), v)).collect();
            nodal_volume.sort_unstable_by_key(|(node, _)| *node);
            BodyLoad { value: load.value.clone(), nodal_volume }
        };
        let body_forces = |_: &Vec<u16>| elements.iter().map(|e| self.element_body_loads[e.index()].clone()).collect();
        let model = Model {
            stated: self.stated.clone(),
            materials: self.materials.clone(),
            element_material: elements.iter().map(|e| self.element_material[e.index()]).collect(),
            mass: nodes.iter().map(|node| self.mass[node.index()]).collect(),
            prescribed,
            motions: self.motions.clone(),
            traction_tables: self.traction_tables.clone(),
            body_loads: self.body_loads.iter().map(body_load).collect(),
            element_body_loads: self.element_body_loads.first().map_or_else(Vec::new, body_forces),
            contacts: self.contacts.clone(),
            moved_planes: self.moved_planes.clone(),
            critical_step: self.critical_step.clone(),
            mesh: mesh.into(),
        };
        Self {
            model,
            initial_displacement: nodal(&self.initial_displacement),
            initial_velocity: nodal(&self.initial_velocity),
            supported,
            face_loads,
            surface: self.surface.renumbered(&self.mesh, &new),
        }
    }
}
