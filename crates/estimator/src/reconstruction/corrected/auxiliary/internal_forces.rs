//! Internal forces of the stresses of elements, summed node by node: the same bits for any number of threads.

use crate::element::Element;
use crate::parallel::by_pieces;
use percute_core::ids::NodeId;
use percute_core::material::Tensor;
use percute_core::mesh::Mesh;

/// Adds those of these stresses (Pa) times a factor to `forces` (N).
pub(super) fn add_internal_forces<const D: usize, const N: usize>(
    (mesh, elements): (&Mesh, &[Element<D, N>]),
    stresses: &[Tensor<D>],
    factor: f64,
    forces: &mut [[f64; D]],
) {
    let stars = mesh.stars();
    by_pieces(forces, &|first, forces| {
        for (k, force) in forces.iter_mut().enumerate() {
            let node = NodeId::new(first + k);
            for element in stars.star(node).elements {
                let own = &elements[element.index()];
                let internal = own.internal_force(corner(own, node), &stresses[element.index()]);
                (0..D).for_each(|c| force[c] += factor * internal[c]);
            }
        }
    });
}

/// The local number of a node of an element.
pub(super) fn corner<const D: usize, const N: usize>(element: &Element<D, N>, node: NodeId) -> usize {
    element.nodes.iter().position(|own| *own == node).unwrap_or(0)
}
