//! Edges that are found and that face the other surface of their interface.

use super::alignment::{FOUND, outward, unit};
use crate::contact::dot;
use crate::ids::FacetId;
use crate::mesh::Mesh;

/// Cosines that differ by less are those of edges alike.
const ALIKE: f64 = 1e-9;

/// The facets of both sides without those that face away from the mean normal of their own side or towards that of the
/// other one. The normal of an interface is one of these two. The worst ones leave first, because the mean changes.
/// That of halves is of the whole ones, whose line of symmetry stands `across` a direction.
pub(super) fn facing_each_other<const D: usize, const N: usize>(
    mesh: &Mesh<D, N>,
    mut sides: [Vec<FacetId>; 2],
    across: Option<usize>,
) -> [Vec<FacetId>; 2] {
    loop {
        let outward = sides.each_ref().map(|facets| {
            let mut sum = outward(mesh, facets);
            across.into_iter().for_each(|c| sum[c] = 0.0);
            unit(&sum)
        });
        let cosine = |side: usize, facet: FacetId| {
            let normal = mesh.facet_normal(facet).0;
            dot(&normal, &outward[side]).min(-dot(&normal, &outward[1 - side]))
        };
        let cosines = [0, 1].map(|side| sides[side].iter().map(|&facet| cosine(side, facet)).collect::<Vec<_>>());
        let worst = cosines.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        if worst >= FOUND {
            return sides;
        }
        let rest = [0, 1].map(|side| {
            let stays = |&(_, cosine): &(&FacetId, &f64)| *cosine > worst + ALIKE;
            sides[side].iter().zip(&cosines[side]).filter(stays).map(|(&facet, _)| facet).collect::<Vec<_>>()
        });
        if rest.iter().any(Vec::is_empty) {
            // The check of the interface has a message for this.
            return sides;
        }
        sides = rest;
    }
}
