//! Conjugate gradients over the modes of a solid, for eight instants side by side.
//!
//! The preconditioner has the block of each face and of each ring. A product with the energy goes from the modes to the
//! moments on all links, through the forms of the elements, and back. Sums are those of blocks, in order: they do not
//! depend on the number of threads. Each instant has steps of its own.

use super::face_modes::{FaceModes, Vector, Wrench};
use super::rings::{COMPONENTS, Rings};
use super::{FaceBlock, Forms, RingBlock};
use crate::blocks::BLOCK;
use crate::element::Element;
use percute_core::ids::{FaceId, NodeId};
use percute_core::mesh::{Mesh, Strips};
use percute_core::observer::StopFlag;
use percute_core::simd::lanes::{Lanes, Value};
use percute_core::simd::{Registers, Task, Wide, dispatch, run_task};
use rayon::prelude::*;
use std::ops::Range;

/// Steps: e is then within 0.5 % of its least value, on slivers within 4 %.
const STEPS: usize = 10;

/// Moments or slopes on the links of all stars.
pub(super) type OnLinks = Vec<Vector<Lanes>>;

/// The coefficients of the modes of faces and rings.
#[derive(Clone, Debug)]
pub(super) struct SolidModes {
    pub(super) faces: Vec<Vector<Lanes>>,
    pub(super) rings: Vec<[Lanes; COMPONENTS]>,
}

/// The fields of a descent.
#[derive(Clone, Debug)]
pub(super) struct DescentRoom {
    /// Slopes of the energy in the moments.
    pub(super) slopes: OnLinks,
    /// Moments of the direction.
    moments: OnLinks,
    /// Wrenches through faces, or slopes in these.
    wrenches: Vec<Wrench<Lanes>>,
    residual: SolidModes,
    direction: SolidModes,
}

/// The data of a descent.
#[derive(Clone, Copy)]
pub(super) struct Descent<'a, const D: usize, const N: usize> {
    pub(super) mesh: &'a Mesh,
    pub(super) elements: &'a [Element<D, N>],
    pub(super) strips: &'a Strips,
    pub(super) modes: &'a [FaceModes],
    pub(super) rings: &'a Rings,
    pub(super) forms: &'a Forms,
    pub(super) blocks: (&'a [FaceBlock], &'a [RingBlock]),
}

impl DescentRoom {
    pub(super) fn new(links: usize, faces: usize, rings: usize) -> Self {
        let zero = [Lanes::ZERO; 3];
        let modes = SolidModes { faces: vec![zero; faces], rings: vec![[Lanes::ZERO; COMPONENTS]; rings] };
        Self {
            slopes: vec![zero; links],
            moments: vec![zero; links],
            wrenches: vec![[zero; 2]; faces],
            residual: modes.clone(),
            direction: modes,
        }
    }
}

/// Sums of blocks, in order.
fn total(sums: Vec<Lanes>) -> Lanes {
    sums.into_iter().fold(Lanes::ZERO, |sum, part| sum + part)
}

/// a/b where b > 0, else 0: nothing is left to gain.
fn ratio(a: Lanes, b: Lanes) -> Lanes {
    Lanes::at_levels(|k| if b.0[k] > 0.0 { a.0[k] / b.0[k] } else { 0.0 })
}

impl<const D: usize, const N: usize> Descent<'_, D, N> {
    /// Changes moments so that the energy is less, from its slopes in them; spoils the slopes.
    pub(super) fn descend(&self, room: &mut DescentRoom, moments: &mut [[Lanes; D]], stop: &StopFlag) {
        for modes in [&mut room.residual, &mut room.direction] {
            modes.faces.fill([Lanes::ZERO; 3]);
            modes.rings.fill([Lanes::ZERO; COMPONENTS]);
        }
        let mut product = self.reduce(room, Lanes::constant(1.0));
        self.turn(room, Lanes::ZERO);
        for _ in 0..STEPS {
            if stop.is_up() {
                return;
            }
            self.spread(room);
            let curvature = self.through_forms(room);
            let length = ratio(product, curvature);
            add_moments(moments, &room.moments, length);
            let next = self.reduce(room, length);
            self.turn(room, ratio(next, product));
            product = next;
        }
    }

    /// Takes so many times the slopes in the modes off the residual, and gives its product with the preconditioned one.
    fn reduce(&self, room: &mut DescentRoom, length: Lanes) -> Lanes {
        let DescentRoom { slopes, wrenches, residual, .. } = room;
        let (face_blocks, ring_blocks) = self.blocks;
        let slopes = &slopes[..];
        let faces = wrenches.par_chunks_mut(BLOCK).zip(residual.faces.par_chunks_mut(BLOCK)).enumerate();
        let of_faces: Vec<Lanes> = faces
            .map(|(block, (wrenches, residual))| {
                dispatch(
                    #[inline(always)]
                    || {
                        let mut sum = Lanes::ZERO;
                        for (k, (wrench, own)) in wrenches.iter_mut().zip(residual).enumerate() {
                            let f = block * BLOCK + k;
                            let (slope, modes) = self.modes[f].slopes(&self.on_face(f, slopes));
                            *wrench = slope;
                            if self.modes[f].is_free {
                                (0..3).for_each(|i| own[i] -= modes[i] * length);
                                sum += quadratic(&face_blocks[f], own);
                            }
                        }
                        sum
                    },
                )
            })
            .collect();
        let wrenches = &wrenches[..];
        let of_rings: Vec<Lanes> = residual
            .rings
            .par_chunks_mut(BLOCK)
            .enumerate()
            .map(|(block, residual)| {
                dispatch(
                    #[inline(always)]
                    || {
                        let mut sum = Lanes::ZERO;
                        for (k, own) in residual.iter_mut().enumerate() {
                            let ring = block * BLOCK + k;
                            let slope = self.slope_of_ring(ring, wrenches);
                            for c in 0..COMPONENTS {
                                own[c] -= slope[c] * length;
                            }
                            sum += quadratic(&ring_blocks[ring], own);
                        }
                        sum
                    },
                )
            })
            .collect();
        total(of_faces) + total(of_rings)
    }

    /// The slopes of the energy in the wrench of a ring.
    #[inline(always)]
    fn slope_of_ring(&self, ring: usize, wrenches: &[Wrench<Lanes>]) -> [Lanes; COMPONENTS] {
        let (known, mut slope) = (self.rings.ring(ring), [Lanes::ZERO; COMPONENTS]);
        for face in self.rings.faces(ring) {
            let at = face.face as usize;
            let [force, couple] = self.modes[at].slope_at_edge(face.edge, known.length, &wrenches[at]);
            for c in 0..3 {
                slope[c] += force[c] * face.sign;
                slope[3 + c] += couple[c] * face.sign;
            }
        }
        for c in 0..COMPONENTS {
            if !known.goes[c] {
                slope[c] = Lanes::ZERO;
            }
        }
        slope
    }

    /// The direction becomes the preconditioned residual and so many times itself.
    fn turn(&self, room: &mut DescentRoom, factor: Lanes) {
        let DescentRoom { residual, direction, .. } = room;
        let (face_blocks, ring_blocks) = self.blocks;
        let faces = direction.faces.par_chunks_mut(BLOCK).zip(residual.faces.par_chunks(BLOCK));
        faces.zip(face_blocks.par_chunks(BLOCK)).for_each(|((to, from), blocks)| turn_all(to, from, blocks, factor));
        let rings = direction.rings.par_chunks_mut(BLOCK).zip(residual.rings.par_chunks(BLOCK));
        rings.zip(ring_blocks.par_chunks(BLOCK)).for_each(|((to, from), blocks)| turn_all(to, from, blocks, factor));
    }

    /// The moments of the direction on all links.
    fn spread(&self, room: &mut DescentRoom) {
        let DescentRoom { moments, wrenches, direction, .. } = room;
        wrenches.par_chunks_mut(BLOCK).enumerate().for_each(|(block, wrenches)| {
            dispatch(
                #[inline(always)]
                || {
                    for (k, wrench) in wrenches.iter_mut().enumerate() {
                        let f = block * BLOCK + k;
                        *wrench = [[Lanes::ZERO; 3]; 2];
                        for (edge, ring, sign) in self.rings.around(f) {
                            let own = &direction.rings[ring];
                            let signed = |c: usize| own[c] * sign;
                            let own = [[signed(0), signed(1), signed(2)], [signed(3), signed(4), signed(5)]];
                            self.modes[f].add_wrench(edge, self.rings.ring(ring).length, &own, wrench);
                        }
                        wrench[1] = self.modes[f].relax(&wrench[1]);
                    }
                },
            );
        });
        let (stars, nodes) = (self.mesh.stars(), self.mesh.node_count());
        let (mut rest, mut parts) = (&mut moments[..], Vec::new());
        for first in (0..nodes).step_by(BLOCK) {
            let own = first..(first + BLOCK).min(nodes);
            let count = own.clone().map(|node| stars.link_range(NodeId::new(node)).len()).sum();
            let (part, others) = rest.split_at_mut(count);
            parts.push((own, part));
            rest = others;
        }
        let (wrenches, own) = (&wrenches[..], &direction.faces[..]);
        parts.into_par_iter().for_each(|(nodes, moments)| self.moments_of(nodes, (wrenches, own), moments));
    }

    /// The moments on the links of some nodes.
    fn moments_of(
        &self,
        nodes: Range<usize>,
        (wrenches, own): (&[Wrench<Lanes>], &[Vector<Lanes>]),
        moments: &mut [Vector<Lanes>],
    ) {
        dispatch(
            #[inline(always)]
            || {
                let links = nodes.map(NodeId::new).flat_map(|node| {
                    let links = self.mesh.stars().star(node).links.iter().flatten();
                    links.map(move |face| (node, *face))
                });
                for ((node, face), moment) in links.zip(moments) {
                    let f = face.index();
                    let p = self.mesh.face(face).nodes.iter().position(|other| *other == node).unwrap_or(0);
                    *moment = self.modes[f].moment(p, &wrenches[f], &own[f]);
                }
            },
        );
    }

    /// The slopes of a face at its nodes.
    #[inline(always)]
    fn on_face(&self, f: usize, slopes: &[Vector<Lanes>]) -> [Vector<Lanes>; 3] {
        let (stars, face) = (self.mesh.stars(), FaceId::new(f));
        let mut own = [[Lanes::ZERO; 3]; 3];
        for (own, &node) in own.iter_mut().zip(self.mesh.face(face).nodes) {
            *own = slopes[stars.link_range(node).start + stars.star(node).place_of(face)];
        }
        own
    }

    /// The slopes of the energy of the direction in all moments, and twice its energy.
    fn through_forms(&self, room: &mut DescentRoom) -> Lanes {
        let DescentRoom { slopes, moments, .. } = room;
        slopes.par_chunks_mut(BLOCK * BLOCK).for_each(|slopes| slopes.fill([Lanes::ZERO; 3]));
        let mut sums = vec![Lanes::ZERO; self.strips.count()];
        for parity in 0..2 {
            let strips = (parity..self.strips.count()).step_by(2);
            let parts = slopes_of_strips(self.mesh, self.strips, strips.clone(), slopes);
            let found: Vec<Lanes> = parts
                .into_par_iter()
                .map(|(elements, first, slopes)| run_task(ThroughForms { all: self, elements, first, moments, slopes }))
                .collect();
            strips.zip(found).for_each(|(strip, sum)| sums[strip] = sum);
        }
        total(sums)
    }
}

/// Elements, the first link of their nodes, and the slopes from there.
pub(super) type SlopesOfStrip<'s> = (Range<usize>, usize, &'s mut [Vector<Lanes>]);

/// The elements of some strips without a common node.
pub(super) fn slopes_of_strips<'s>(
    mesh: &Mesh,
    all: &Strips,
    strips: impl Iterator<Item = usize>,
    slopes: &'s mut [Vector<Lanes>],
) -> Vec<SlopesOfStrip<'s>> {
    let (mut rest, mut done, mut parts) = (slopes, 0, Vec::new());
    let first = |node: usize| match node {
        _ if node == mesh.node_count() => mesh.stars().link_count(),
        _ => mesh.stars().link_range(NodeId::new(node)).start,
    };
    for strip in strips {
        let nodes = all.nodes(strip);
        let (start, end) = (first(nodes.start), first(nodes.end));
        let (_, others) = rest.split_at_mut(start - done);
        let (own, others) = others.split_at_mut(end - start);
        parts.push((all.elements(strip), start, own));
        (rest, done) = (others, end);
    }
    parts
}

/// xᵀBx of the lower triangle of a symmetric matrix.
#[inline(always)]
fn quadratic<const M: usize>(block: &[[f64; M]; M], x: &[Lanes; M]) -> Lanes {
    let mut sum = Lanes::ZERO;
    for i in 0..M {
        let mut row = Lanes::ZERO;
        for j in 0..M {
            row += x[j] * block[i][j];
        }
        sum += row * x[i];
    }
    sum
}

fn turn_all<const M: usize>(to: &mut [[Lanes; M]], from: &[[Lanes; M]], blocks: &[[[f64; M]; M]], factor: Lanes) {
    dispatch(
        #[inline(always)]
        || {
            for ((to, from), block) in to.iter_mut().zip(from).zip(blocks) {
                for i in 0..M {
                    let mut row = to[i] * factor;
                    for j in 0..M {
                        row += from[j] * block[i][j];
                    }
                    to[i] = row;
                }
            }
        },
    );
}

/// Adds so many times the moments of the direction.
fn add_moments<const D: usize>(to: &mut [[Lanes; D]], from: &[Vector<Lanes>], length: Lanes) {
    to.par_chunks_mut(BLOCK * BLOCK).zip(from.par_chunks(BLOCK * BLOCK)).for_each(|(to, from)| {
        dispatch(
            #[inline(always)]
            || {
                for (to, from) in to.iter_mut().zip(from) {
                    (0..D).for_each(|c| to[c] += from[c] * length);
                }
            },
        );
    });
}

/// The slopes of the energy of some elements.
struct ThroughForms<'a, 'd, 's, const D: usize, const N: usize> {
    all: &'a Descent<'d, D, N>,
    elements: Range<usize>,
    /// The first link of the slopes.
    first: usize,
    moments: &'a [Vector<Lanes>],
    slopes: &'s mut [Vector<Lanes>],
}

impl<const D: usize, const N: usize> Task for ThroughForms<'_, '_, '_, D, N> {
    type Output = Lanes;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> Lanes {
        let Self { all, elements, first, moments, slopes } = self;
        let like = Wide::zeros(registers);
        let mut energy = like;
        for e in elements {
            let element = &all.elements[e];
            let own = super::outward_moments(like, element, moments);
            let product = all.forms.product(like, e, &own);
            for i in 0..own.len() {
                energy += own[i] * product[i];
            }
            super::add_outward(element, &product, first, slopes);
        }
        energy.store()
    }
}
