//! Tributary areas of the nodes of a body that turns, at an instant.

use crate::contact::dot;
use crate::element_state::displacement_gradient;
use crate::problem::Problem;

/// The area of each node (m²): of its undeformed faces, each times the cosine of its angle to the obstacle with these
/// displacements (m). A face that turns away counts less and less. All of the faces of a node that face nothing.
pub(super) fn areas<const D: usize>(problem: &Problem<D>, displacement: &[[f64; D]]) -> Vec<f64> {
    let (mesh, surface) = (problem.mesh(), problem.surface());
    let mut facing = vec![0.0; surface.nodes().len()];
    for face in surface.faces() {
        let gradient = displacement_gradient(mesh, mesh.face(face.face).owner, displacement);
        let normal = cofactor_times(&gradient, &mesh.normal_in::<D>(face.face).0);
        let length = dot(&normal, &normal).sqrt();
        for &at in &face.nodes {
            let frame = surface.frame(at, &displacement[surface.nodes()[at].node.index()]);
            facing[at] += face.area / D as f64 * (-dot(&normal, frame.normal()) / length).max(0.0);
        }
    }
    let or_all = |(facing, all): (f64, f64)| if facing > 1e-9 * all { facing } else { all };
    facing.into_iter().zip(surface.tributary_areas()).map(or_all).collect()
}

/// cof F N, F = 1 + H: the direction of a normal after the motion, by Nanson's formula.
fn cofactor_times<const D: usize>(gradient: &[[f64; D]; D], normal: &[f64; D]) -> [f64; D] {
    let mut turned = *normal;
    if D == 2 {
        turned[0] += gradient[1][1] * normal[0] - gradient[1][0] * normal[1];
        turned[1] += gradient[0][0] * normal[1] - gradient[0][1] * normal[0];
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Obstacle;
    use crate::material::{Elastic, HyperelasticLaw, Kinematics};
    use crate::mesh::Mesh;
    use crate::problem::Initial;
    use std::collections::BTreeMap;

    fn placed(mesh: Mesh, kinematics: Kinematics, displacement: &[[f64; 2]]) -> Problem<2> {
        let material = Elastic::plane_strain(1.0, 0.3, 1.0, 2.0).unwrap().with_kinematics(kinematics).unwrap();
        let plane = Obstacle::plane([0.0, -3.0], [0.2, 1.0], 0.0, None).unwrap();
        let builder = Problem::builder(mesh).material(material).obstacle(plane);
        builder.initial_displacement(Initial::Nodal(displacement.to_vec())).build().unwrap()
    }

    /// The nodes of a block that has turned have the areas on the plane of one that was meshed so. Areas have the
    /// rounding of lengths near 1.
    #[test]
    fn areas_are_those_of_the_projected_faces() {
        let block = || Mesh::rectangle(1.0, 0.7, 5, 3).unwrap();
        let cells: Vec<_> = block().nodes_of::<3>().iter().map(|cell| cell.map(|node| node.index())).collect();
        for angle in [0.0, 0.4, 1.3, 2.2, 4.0_f64] {
            let (sine, cosine) = angle.sin_cos();
            let places: Vec<_> =
                block().points_in::<2>().iter().map(|[x, y]| [cosine * x - sine * y, sine * x + cosine * y]).collect();
            let moved: Vec<_> =
                places.iter().zip(block().points_in::<2>()).map(|(x, p)| [x[0] - p[0], x[1] - p[1]]).collect();
            let turning = placed(block(), Kinematics::Finite(HyperelasticLaw::NeoHookean), &moved);
            let still = vec![[0.0; 2]; places.len()];
            let fixed = placed(
                Mesh::new(places, &cells, &Default::default(), &Default::default()).unwrap(),
                Kinematics::Small,
                &still,
            );
            let all: f64 = turning.surface().tributary_areas().iter().sum();
            assert!((all - 2.0 * 2.0 * 1.7).abs() < 1e-14, "{all}: thickness 2, and the four sides");
            let nodes = turning.surface().nodes().iter().map(|contact| contact.node);
            let found: BTreeMap<_, _> = nodes.zip(areas(&turning, &moved)).collect();
            let (plane, mesh, mut expected) =
                ([0.2 / 1.04_f64.sqrt(), 1.0 / 1.04_f64.sqrt()], fixed.mesh(), BTreeMap::new());
            for face in fixed.surface().faces() {
                let nodes = mesh.face_nodes::<2>(face.face);
                let [a, b] = nodes.map(|node| mesh.points_in::<2>()[node.index()]);
                let along = (b[0] - a[0]) * plane[1] - (b[1] - a[1]) * plane[0];
                nodes.iter().for_each(|node| *expected.entry(*node).or_insert(0.0) += 2.0 * 0.5 * along.abs());
            }
            assert!(expected.len() > 5);
            for (node, area) in &expected {
                assert!((found[node] - area).abs() < 1e-14, "node {node:?} at {angle}: {} for {area}", found[node]);
            }
        }
    }
}
