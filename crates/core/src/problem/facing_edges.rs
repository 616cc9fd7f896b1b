//! Edges that are found and that face the other surface of their interface.

use super::alignment::{FOUND, outward, unit};
use crate::border::Vector;
use crate::contact::dot;
use crate::ids::FacetId;
use crate::mesh::Mesh;

/// Cosines that differ by less are those of edges alike.
const ALIKE: f64 = 1e-9;

/// Chooses the facets of two sides that can belong to one interface.
pub(super) struct FacingEdges<'m> {
    pub(super) mesh: &'m Mesh,
    /// The facets of both sides that are nearest to the other side when the bodies meet.
    pub(super) nearest: [Vec<FacetId>; 2],
    /// The direction across which the line of symmetry of two halves stands: normals are those of the whole ones.
    pub(super) across: Option<usize>,
}

impl FacingEdges<'_> {
    /// The facets without those that face away from the mean normal of their own side or towards that of the other one:
    /// the normal of an interface is one of these two. The worst ones leave first, because the mean changes. Long edges
    /// beside a corner may so push out the ones that meet. Then those leave first that face least what these face. None
    /// if no facets of the two sides face each other.
    pub(super) fn of(&self, sides: &[Vec<FacetId>; 2]) -> Option<[Vec<FacetId>; 2]> {
        let found = self.leave(sides.clone(), |side, facet, normals| self.cosine(side, facet, normals));
        let nearest = [0, 1].map(|side| {
            let there = self.nearest[side].iter().filter(|facet| sides[side].contains(facet));
            there.copied().collect::<Vec<_>>()
        });
        let meet = |found: &[Vec<FacetId>; 2]| {
            [0, 1].iter().all(|&side| nearest[side].iter().all(|facet| found[side].contains(facet)))
        };
        if nearest.iter().any(Vec::is_empty) || found.as_ref().is_some_and(meet) {
            return found;
        }
        let normals = self.normals(&nearest);
        let around = self.leave(sides.clone(), |side, facet, _| match nearest[side].contains(&facet) {
            true => f64::INFINITY,
            false => self.cosine(side, facet, &normals),
        });
        around.or(found)
    }

    /// Takes the facets of least rank out until all others face both mean normals. The rank depends on the side, the
    /// facet and these normals; facets of infinite rank stay.
    fn leave(
        &self,
        mut sides: [Vec<FacetId>; 2],
        rank: impl Fn(usize, FacetId, &[Vector; 2]) -> f64,
    ) -> Option<[Vec<FacetId>; 2]> {
        loop {
            let normals = self.normals(&sides);
            let faces = |side: usize| sides[side].iter().all(|&facet| self.cosine(side, facet, &normals) >= FOUND);
            if faces(0) && faces(1) {
                return Some(sides);
            }
            let ranks = [0, 1].map(|side| {
                let ranks = sides[side].iter().map(|&facet| rank(side, facet, &normals));
                ranks.collect::<Vec<f64>>()
            });
            let worst = ranks.iter().flatten().copied().fold(f64::INFINITY, f64::min);
            for (side, ranks) in sides.iter_mut().zip(&ranks) {
                let mut ranks = ranks.iter();
                side.retain(|_| ranks.next().is_some_and(|rank| *rank > worst + ALIKE));
            }
            if sides.iter().any(Vec::is_empty) {
                return None;
            }
        }
    }

    /// The mean outward normals of both sides.
    fn normals(&self, sides: &[Vec<FacetId>; 2]) -> [Vector; 2] {
        sides.each_ref().map(|facets| {
            let mut sum = outward(self.mesh, facets);
            self.across.into_iter().for_each(|c| sum[c] = 0.0);
            unit(&sum)
        })
    }

    /// How well a facet of a side faces the other side: the least cosine with its own normal and against the other one.
    fn cosine(&self, side: usize, facet: FacetId, normals: &[Vector; 2]) -> f64 {
        let normal = self.mesh.facet_normal(facet).0;
        dot(&normal, &normals[side]).min(-dot(&normal, &normals[1 - side]))
    }
}
