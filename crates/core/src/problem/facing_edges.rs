//! Edges that are found and that face the other surface of their interface.

use super::alignment::{FOUND, outward, unit};
use crate::border::Vector;
use crate::contact::dot;
use crate::ids::FaceId;
use crate::mesh::Mesh;

/// Cosines that differ by less are those of edges alike.
const ALIKE: f64 = 1e-9;

/// Chooses the faces of two sides that can belong to one interface.
pub(super) struct FacingEdges<'m> {
    pub(super) mesh: &'m Mesh,
    /// The faces of both sides that are nearest to the other side when the bodies meet.
    pub(super) nearest: [Vec<FaceId>; 2],
    /// The direction across which the line of symmetry of two halves stands: normals are those of the whole ones.
    pub(super) across: Option<usize>,
}

impl FacingEdges<'_> {
    /// The faces without those that face away from the mean normal of their own side or towards that of the other one:
    /// the normal of an interface is one of these two. The worst ones leave first, because the mean changes. Long edges
    /// beside a corner may so push out the ones that meet. Then those leave first that face least what these face. None
    /// if no faces of the two sides face each other.
    pub(super) fn of(&self, sides: &[Vec<FaceId>; 2]) -> Option<[Vec<FaceId>; 2]> {
        let found = self.leave(sides.clone(), |side, face, normals| self.cosine(side, face, normals));
        let nearest = [0, 1].map(|side| {
            let there = self.nearest[side].iter().filter(|face| sides[side].contains(face));
            there.copied().collect::<Vec<_>>()
        });
        let meet = |found: &[Vec<FaceId>; 2]| {
            [0, 1].iter().all(|&side| nearest[side].iter().all(|face| found[side].contains(face)))
        };
        if nearest.iter().any(Vec::is_empty) || found.as_ref().is_some_and(meet) {
            return found;
        }
        let normals = self.normals(&nearest);
        let around = self.leave(sides.clone(), |side, face, _| match nearest[side].contains(&face) {
            true => f64::INFINITY,
            false => self.cosine(side, face, &normals),
        });
        around.or(found)
    }

    /// Takes the faces of least rank out until all others face both mean normals. The rank depends on the side, the
    /// face and these normals; faces of infinite rank stay.
    fn leave(
        &self,
        mut sides: [Vec<FaceId>; 2],
        rank: impl Fn(usize, FaceId, &[Vector; 2]) -> f64,
    ) -> Option<[Vec<FaceId>; 2]> {
        loop {
            let normals = self.normals(&sides);
            let faces = |side: usize| sides[side].iter().all(|&face| self.cosine(side, face, &normals) >= FOUND);
            if faces(0) && faces(1) {
                return Some(sides);
            }
            let ranks = [0, 1].map(|side| {
                let ranks = sides[side].iter().map(|&face| rank(side, face, &normals));
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
    fn normals(&self, sides: &[Vec<FaceId>; 2]) -> [Vector; 2] {
        sides.each_ref().map(|faces| {
            let mut sum = outward(self.mesh, faces);
            self.across.into_iter().for_each(|c| sum[c] = 0.0);
            unit(&sum)
        })
    }

    /// How well a face of a side faces the other side: the least cosine with its own normal and against the other one.
    fn cosine(&self, side: usize, face: FaceId, normals: &[Vector; 2]) -> f64 {
        let normal = self.mesh.face_normal(face).0;
        dot(&normal, &normals[side]).min(-dot(&normal, &normals[1 - side]))
    }
}
