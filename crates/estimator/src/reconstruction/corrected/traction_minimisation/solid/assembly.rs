//! The blocks of the preconditioner: inverses of the energies of the modes of each face and of each ring.

use super::face_modes::{FaceModes, Wrench};
use super::forms::{Forms, MOMENTS};
use super::rings::{COMPONENTS, RingFace, Rings};
use crate::stress::face_node;
use nalgebra::SMatrix;
use percute_core::ids::{ElementId, FaceId};
use percute_core::mesh::Mesh;
use rayon::prelude::*;

/// Of the modes of a face.
pub(super) type FaceBlock = [[f64; 3]; 3];

/// Of the components of a ring.
pub(super) type RingBlock = [[f64; COMPONENTS]; COMPONENTS];

/// The data that blocks are made of.
#[derive(Clone, Copy)]
pub(super) struct Assembly<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) modes: &'a [FaceModes],
    pub(super) forms: &'a Forms,
}

impl Assembly<'_> {
    pub(super) fn face_blocks(&self) -> Vec<FaceBlock> {
        (0..self.mesh.face_count()).into_par_iter().map(|f| self.face_block(FaceId::new(f))).collect()
    }

    pub(super) fn ring_blocks(&self, rings: &Rings) -> Vec<RingBlock> {
        (0..rings.len()).into_par_iter().map(|ring| self.ring_block(rings, ring)).collect()
    }

    /// For each place of a node in a face, where its moment is among those of an element.
    fn places(&self, element: ElementId, face: FaceId) -> [usize; 3] {
        let (cell, nodes) = (self.mesh.cell(element), self.mesh.face(face).nodes);
        let k = cell.iter().position(|node| !nodes.contains(node)).unwrap_or(0);
        let place = |node| (0..3).find(|&p| cell[face_node::<4>(k, p)] == node).unwrap_or(0);
        [0, 1, 2].map(|q| 9 * k + 3 * place(nodes[q]))
    }

    /// That of a face: the sign of its moments in an element does not matter.
    fn face_block(&self, face: FaceId) -> FaceBlock {
        let modes = &self.modes[face.index()];
        if !modes.is_free {
            return [[0.0; 3]; 3];
        }
        let unit = |t: usize| {
            let own = std::array::from_fn(|i| f64::from(u8::from(i == t)));
            [0, 1, 2].map(|p| modes.moment(p, &[[0.0; 3]; 2], &own))
        };
        let columns = [0, 1, 2].map(unit);
        let known = self.mesh.face(face);
        let mut block = SMatrix::<f64, 3, 3>::zeros();
        for element in [Some(known.owner), known.neighbour].into_iter().flatten() {
            let places = self.places(element, face);
            let column = |t: usize| (0..9).map(move |m| (places[m / 3] + m % 3, m)).map(move |(at, m)| (at, t, m));
            for i in 0..3 {
                for j in 0..3 {
                    for (a, s, m) in column(i) {
                        for (b, t, n) in column(j) {
                            block[(i, j)] += columns[s][m / 3][m % 3]
                                * columns[t][n / 3][n % 3]
                                * self.forms.entry(element.index(), a, b);
                        }
                    }
                }
            }
        }
        inverse(&block, [true; 3])
    }

    fn ring_block(&self, rings: &Rings, ring: usize) -> RingBlock {
        let (known, faces) = (rings.ring(ring), rings.faces(ring));
        let mut elements: Vec<ElementId> = Vec::with_capacity(faces.len() + 1);
        for face in faces {
            let sides = self.mesh.face(FaceId::new(face.face as usize));
            elements.extend([Some(sides.owner), sides.neighbour].into_iter().flatten());
        }
        elements.sort_unstable();
        elements.dedup();
        let mut block = SMatrix::<f64, COMPONENTS, COMPONENTS>::zeros();
        for element in elements {
            self.add_element(element, known.length, faces, &mut block);
        }
        inverse(&block, known.goes)
    }

    /// Adds the energy of the unit wrenches of a ring in an element.
    fn add_element(
        &self,
        element: ElementId,
        length: f64,
        faces: &[RingFace],
        block: &mut SMatrix<f64, COMPONENTS, COMPONENTS>,
    ) {
        let mut moments = [[0.0; MOMENTS]; COMPONENTS];
        let mut used: Vec<usize> = Vec::with_capacity(18);
        for face in faces {
            let (id, modes) = (FaceId::new(face.face as usize), &self.modes[face.face as usize]);
            let sides = self.mesh.face(id);
            if sides.owner != element && sides.neighbour != Some(element) {
                continue;
            }
            let (sign, places) =
                (if sides.owner == element { face.sign } else { -face.sign }, self.places(element, id));
            for (component, moments) in moments.iter_mut().enumerate() {
                let wrench = through(modes, face.edge, length, component);
                for (p, place) in places.into_iter().enumerate() {
                    let moment = modes.moment(p, &wrench, &[0.0; 3]);
                    (0..3).for_each(|c| moments[place + c] += sign * moment[c]);
                }
            }
            used.extend(places.into_iter().flat_map(|place| place..place + 3));
        }
        for i in 0..COMPONENTS {
            for j in 0..COMPONENTS {
                for &a in &used {
                    for &b in &used {
                        block[(i, j)] += moments[i][a] * moments[j][b] * self.forms.entry(element.index(), a, b);
                    }
                }
            }
        }
    }
}

/// A unit component of a wrench about an edge of a face, relaxed.
fn through(modes: &FaceModes, edge: usize, length: f64, component: usize) -> Wrench<f64> {
    let mut unit = [[0.0; 3]; 2];
    unit[component / 3][component % 3] = 1.0;
    let mut wrench = [[0.0; 3]; 2];
    modes.add_wrench(edge, length, &unit, &mut wrench);
    [wrench[0], modes.relax(&wrench[1])]
}

/// The inverse in these rows and columns; 0 in others, and in all where there is none.
fn inverse<const M: usize>(block: &SMatrix<f64, M, M>, of: [bool; M]) -> [[f64; M]; M] {
    let kept = SMatrix::<f64, M, M>::from_fn(|i, j| match (of[i] && of[j], i == j) {
        (true, _) => 0.5 * (block[(i, j)] + block[(j, i)]),
        (false, same) => f64::from(u8::from(same)),
    });
    let inverse = nalgebra::DMatrix::from_fn(M, M, |i, j| kept[(i, j)]).cholesky().map(|factor| factor.inverse());
    std::array::from_fn(|i| {
        std::array::from_fn(
            |j| if of[i] && of[j] { inverse.as_ref().map_or(0.0, |matrix| matrix[(i, j)]) } else { 0.0 },
        )
    })
}
