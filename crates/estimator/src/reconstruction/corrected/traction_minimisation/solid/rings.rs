//! Rings: a wrench that goes around an edge of the mesh, through all faces there.
//!
//! It enters each element around the edge by one face and leaves it by the other: no element has a resultant or a
//! moment. All faces around the edge must be able to take it: those inside the body, and those of supports at the two
//! ends of the ring. On a plane of symmetry a face takes the force across it and the couples along it.

use super::face_modes::{EDGES, FaceModes};
use percute_core::ids::{FaceId, NodeId};
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;

/// No ring.
pub(super) const NONE: u32 = u32::MAX;

/// The components of a wrench: a force and a couple.
pub(super) const COMPONENTS: usize = 6;

/// A ring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    /// The length of its edge (m), the unit of couples.
    pub(super) length: f64,
    /// Which components go through all faces.
    pub(super) goes: [bool; COMPONENTS],
    /// Where its faces begin.
    first: u32,
}

/// A face of a ring.
#[derive(Clone, Copy, Debug)]
pub(super) struct RingFace {
    pub(super) face: u32,
    /// The edge of the face.
    pub(super) edge: usize,
    /// Whether the wrench leaves the owner of the face by it, 1, or enters, −1.
    pub(super) sign: f64,
}

/// All rings of a body.
#[derive(Clone, Debug, Default)]
pub(super) struct Rings {
    rings: Vec<Ring>,
    faces: Vec<RingFace>,
    /// For each edge of each face its ring, or none.
    of_face: Vec<[u32; 3]>,
    /// The signs there.
    signs: Vec<[f64; 3]>,
}

/// The components in which the moments of a face are unknown.
pub(super) fn unknown<const D: usize>(problem: &Problem<D>, face: FaceId) -> [bool; D] {
    if problem.mesh().face(face).neighbour.is_some() { [true; D] } else { problem.supported(face) }
}

/// Which components of a wrench go through a face.
fn goes_through<const D: usize>(problem: &Problem<D>, face: FaceId) -> [bool; COMPONENTS] {
    let unknown = unknown(problem, face);
    if unknown == [true; D] {
        return [true; COMPONENTS];
    }
    let mut goes = [false; COMPONENTS];
    if let Some(across) = (0..D).find(|&c| unknown[c]).filter(|_| unknown.iter().filter(|c| **c).count() == 1)
        && problem.mesh().stands_across(face, across)
    {
        (0..D).for_each(|c| (goes[c], goes[D + c]) = (c == across, c != across));
    }
    goes
}

impl Rings {
    pub(super) fn new<const D: usize>(problem: &Problem<D>, modes: &[FaceModes]) -> Self {
        let mesh = problem.mesh();
        let mut edges: Vec<([NodeId; 2], u32, usize)> = Vec::with_capacity(3 * mesh.face_count());
        for f in 0..mesh.face_count() {
            let nodes = mesh.face(FaceId::new(f)).nodes;
            for (t, [p, q]) in EDGES.into_iter().enumerate() {
                let ends = [nodes[p].min(nodes[q]), nodes[p].max(nodes[q])];
                edges.push((ends, f as u32, t));
            }
        }
        edges.sort_unstable();
        let none = mesh.face_count();
        let mut made = Self { of_face: vec![[NONE; 3]; none], signs: vec![[0.0; 3]; none], ..Self::default() };
        for around in edges.chunk_by(|a, b| a.0 == b.0) {
            let mut goes = [true; COMPONENTS];
            for (_, f, _) in around {
                let through = goes_through(problem, FaceId::new(*f as usize));
                goes.iter_mut().zip(through).for_each(|(goes, through)| *goes &= through);
            }
            if goes.contains(&true) {
                made.add::<D>(mesh, modes, around, goes);
            }
        }
        made
    }

    fn add<const D: usize>(
        &mut self,
        mesh: &Mesh,
        modes: &[FaceModes],
        around: &[([NodeId; 2], u32, usize)],
        goes: [bool; COMPONENTS],
    ) {
        let ring = self.rings.len() as u32;
        let (_, f, t) = around[0];
        self.rings.push(Ring { length: modes[f as usize].length(t), goes, first: self.faces.len() as u32 });
        for &(ends, face, edge) in around {
            let sign = if leaves_owner::<D>(mesh, ends, FaceId::new(face as usize), edge) { 1.0 } else { -1.0 };
            self.faces.push(RingFace { face, edge, sign });
            (self.of_face[face as usize][edge], self.signs[face as usize][edge]) = (ring, sign);
        }
    }

    /// Number of rings.
    pub(super) fn len(&self) -> usize {
        self.rings.len()
    }

    /// A ring.
    #[inline(always)]
    pub(super) fn ring(&self, ring: usize) -> &Ring {
        &self.rings[ring]
    }

    /// The faces of a ring.
    #[inline(always)]
    pub(super) fn faces(&self, ring: usize) -> &[RingFace] {
        let end = self.rings.get(ring + 1).map_or(self.faces.len(), |next| next.first as usize);
        &self.faces[self.rings[ring].first as usize..end]
    }

    /// The rings around the edges of a face, with their signs.
    #[inline(always)]
    pub(super) fn around(&self, face: usize) -> impl Iterator<Item = (usize, usize, f64)> {
        let all = self.of_face[face].into_iter().zip(self.signs[face]).enumerate();
        all.filter(|(_, (ring, _))| *ring != NONE).map(|(edge, (ring, sign))| (edge, ring as usize, sign))
    }
}

/// Whether a turn about an edge, from its first end to the second, leaves the owner of a face by it.
fn leaves_owner<const D: usize>(mesh: &Mesh, ends: [NodeId; 2], face: FaceId, edge: usize) -> bool {
    let known = mesh.face(face);
    let cell = mesh.cell(known.owner);
    let far = cell.iter().find(|node| !known.nodes.contains(node)).copied().unwrap_or(cell[0]);
    let from = mesh.point(ends[0]);
    let side = |node: NodeId| -> [f64; 3] { std::array::from_fn(|c| mesh.point(node)[c] - from[c]) };
    let normal: [f64; 3] = super::face_modes::cross(&side(ends[1]), &side(far));
    normal.iter().zip(side(known.nodes[edge])).map(|(a, b)| a * b).sum::<f64>() > 0.0
}
