//! On surfaces with the same nodes, densities and friction are those of pairs.

use super::*;
use crate::contact_density::{Densities, FaceDensity, face_power};
use percute_core::contact::{Interface, Side};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;
use percute_testkit::Random;

/// Two blocks, one above the other, with the same nodes on both sides of their interface.
fn blocks(interface: Interface) -> Problem<2> {
    let block = |y: f64| Mesh::rectangle(0.3, 0.2, 3, 2).unwrap().mapped(|p| [p[0], p[1] + y]).unwrap();
    let mesh = Mesh::joined(&[("upper", &block(0.201)), ("lower", &block(0.0))]).unwrap();
    Problem::<2>::builder(mesh)
        .material(Elastic::plane_strain(70e9, 0.3, 2700.0, 0.7).unwrap())
        .interface(interface)
        .build()
        .unwrap()
}

#[test]
fn on_matching_surfaces_they_are_those_of_pairs() {
    let pairs = blocks(Interface::matching(2, "upper.bottom", "lower.top", 0.4).unwrap());
    let slides = blocks(Interface::non_matching(2, "upper.bottom", "lower.top", 0.4).unwrap());
    let (surface, faces) = (slides.surface(), NonMatchingFaces::all(&slides));
    let (non_matching, mut random) = (&surface.non_matching()[0], Random::new(5));
    let nodes = slides.mesh().node_count();
    let velocity: Vec<[f64; 2]> = (0..nodes).map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0)]).collect();
    // Tractions (Pa) at places along the interface, on the upper block.
    let traction: Vec<[f64; 2]> = (0..4).map(|_| [random.between(-0.3, 0.3), random.between(1.0, 2.0)]).collect();
    let at = |problem: &Problem<2>, at: usize| {
        let upper = problem.surface().point(at)[1] > 0.2005;
        let value = traction[(problem.surface().point(at)[0] / 0.1).round() as usize];
        if upper { value } else { value.map(|f| -f) }
    };
    let expected = Densities::new(&pairs, |_, face| face.nodes.map(|k| at(&pairs, k)));

    let coupling = Arc::new(non_matching.coupling_at(&[0.0]));
    let on_slave = |node: usize| at(&slides, non_matching.slave().position(node));
    let density =
        NonMatchingDensity::new(&coupling, |node| on_slave(node).map(|f| 0.7 * coupling.weight(node) * f), Vec::new());
    let faces: Arc<[NonMatchingFaces]> = faces.into();
    let none = Densities::new(&slides, |_, _| [[0.0; 2]; 2]);
    let found = none.with_non_matching(&slides, &faces, vec![density.clone()]);
    let along_side = |side: &Side| -> Vec<f64> {
        let node = |k: usize| surface.nodes()[side.position(k)].node.index();
        (0..side.len()).map(|k| along(&velocity[node(k)], non_matching.tangent())).collect()
    };
    let mut power = vec![0.0; surface.faces().len()];
    let slip = [non_matching.slave(), non_matching.master()].map(along_side);
    density.friction_power(non_matching, &slip, |piece, part| {
        faces[0].of(piece).into_iter().for_each(|face| power[face] += 0.5 * part);
    });
    let [cone, opposite] = found.non_matching_residuals(&slides);
    assert!(cone <= 1e-12 && opposite <= 1e-12, "{cone} {opposite}");
    for (f, face) in slides.surface().faces().iter().enumerate() {
        let same = |other: &percute_core::contact::ContactFace<2>| other.face == face.face;
        let other = pairs.surface().faces().iter().position(same).unwrap();
        for (a, b) in found[f].iter().flatten().zip(expected[other].iter().flatten()) {
            assert!((a - b).abs() <= 1e-12, "{f}: {:?} {:?}", found[f], expected[other]);
        }
        let relative = pairs.surface().faces()[other].nodes.map(|k| pairs.surface().against_obstacle(k, &velocity));
        let one = FaceDensity { wide: &expected.wide()[other], hats: [&[][..]; 1] };
        let expected = face_power(&pairs, other, &relative, &[&one]);
        assert!((power[f] / expected - 1.0).abs() <= 1e-12, "{f}: {} {expected}", power[f]);
    }
    // What is linear needs no stress beside that of linear tractions.
    assert!(density.residual((&slides, non_matching), &faces[0]).iter().all(|(_, stress)| stress.root() <= 1e-12));
}
