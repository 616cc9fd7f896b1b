//! Bodies between which contact is found.

use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Between, Builder, Contact, Initial, Problem};

/// A name, a mesh and a velocity (m/s).
pub(crate) type Body<'a> = (&'a str, Mesh, [f64; 2]);

/// Bodies of aluminium with contact between all, without friction.
pub(crate) fn problem(bodies: &[Body<'_>]) -> Builder<2> {
    let meshes: Vec<(&str, &Mesh)> = bodies.iter().map(|(name, mesh, _)| (*name, mesh)).collect();
    let velocity = bodies.iter().flat_map(|(_, mesh, velocity)| vec![*velocity; mesh.node_count()]).collect();
    Problem::<2>::builder(Mesh::joined(&meshes).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Nodal(velocity))
        .automatic_contact()
        .contact(Contact::new(2, Between::All, 0.0, None).unwrap())
}
