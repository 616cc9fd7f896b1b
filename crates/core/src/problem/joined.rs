//! Contacts that share nodes: one surface of a body that several others may touch, as a block on two blocks.
//!
//! They are solved together, as one interface between the common surface and those of the others.

use super::alignment::{outward, unit};
use super::bodies::{Contact, Found, ONE_DIRECTION};
use super::sides::Bodies;
use super::{Cause, InputError, Place};
use crate::contact::dot;
use crate::ids::{FaceId, NodeId};
use crate::mesh::Mesh;
use std::collections::BTreeMap;

/// Contact of two surfaces, as it is stated or found.
pub(super) struct Proposal<'a> {
    pub(super) contact: &'a Contact,
    pub(super) place: Place,
    pub(super) source: Source<'a>,
    /// The faces of both sides.
    pub(super) faces: [Vec<FaceId>; 2],
}

/// Where a proposal is from.
#[derive(Clone, Copy)]
pub(super) enum Source<'a> {
    Groups(&'a [String; 2]),
    Found(&'a Found),
}

impl Source<'_> {
    pub(super) fn faces(&self, mesh: &Mesh) -> [Vec<FaceId>; 2] {
        match self {
            Self::Groups(groups) => {
                groups.each_ref().map(|group| mesh.face_groups().get(group).cloned().unwrap_or_default())
            }
            Self::Found(found) => found.seeing.clone(),
        }
    }
}

/// A contact, and which of its sides, 0 or 1, is part of the common surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Member {
    pub(super) contact: usize,
    pub(super) common: usize,
}

/// Puts contacts that share nodes together; the others stay alone, in the order of their first ones. Surfaces that
/// share nodes otherwise are left for the error that nodes in two contacts have.
pub(super) fn joined<const D: usize>(
    bodies: &Bodies<'_, D>,
    proposals: &[Proposal<'_>],
) -> Result<Vec<Vec<Member>>, InputError> {
    let mut made: Vec<Vec<Member>> = Vec::new();
    let mut owner: BTreeMap<NodeId, Member> = BTreeMap::new();
    for (contact, proposal) in proposals.iter().enumerate() {
        made.push(vec![Member { contact, common: 0 }]);
        for (common, faces) in proposal.faces.iter().enumerate() {
            for node in faces.iter().flat_map(|face| bodies.mesh.face_nodes::<D>(*face)) {
                let one = Member { contact, common };
                let other = *owner.entry(node).or_insert(one);
                if other.contact != contact && join(bodies, proposals, &mut made, [other, one]) {
                    check(&proposals[other.contact], proposal, node)?;
                }
            }
        }
    }
    made.retain(|members| !members.is_empty());
    Ok(made)
}

/// Puts two contacts with a common node together; false if they cannot be or are already.
fn join<const D: usize>(
    bodies: &Bodies<'_, D>,
    proposals: &[Proposal<'_>],
    made: &mut [Vec<Member>],
    pair: [Member; 2],
) -> bool {
    let place = |one: Member| made.iter().position(|members| members.iter().any(|other| other.contact == one.contact));
    let [Some(first), Some(second)] = pair.map(place) else { return false };
    // A contact that is alone may have its common surface on either side.
    let agrees = |at: usize, one: Member| made[at].len() == 1 || made[at].contains(&one);
    if first == second || !agrees(first, pair[0]) || !agrees(second, pair[1]) {
        return false;
    }
    // Two contacts of the same bodies are one too many.
    let body = |one: &Member| proposals[one.contact].faces[1 - one.common].first().map(|&face| bodies.body_of(face));
    let others = |at: usize, one: Member| -> Vec<Option<NodeId>> {
        if made[at].len() == 1 { vec![body(&one)] } else { made[at].iter().map(body).collect() }
    };
    let there = others(second, pair[1]);
    if others(first, pair[0]).iter().any(|body| there.contains(body)) {
        return false;
    }
    if !one_direction(bodies.mesh, pair.map(|one| (&proposals[one.contact], one.common))) {
        return false;
    }
    for (at, one) in [first, second].into_iter().zip(pair) {
        if let [alone] = &mut made[at][..] {
            *alone = one;
        }
    }
    let more = std::mem::take(&mut made[second]);
    made[first].extend(more);
    true
}

/// Whether two surfaces that share a node are one. Of those that are found, the search has decided it: it looks along
/// the directions in which bodies meet, and the mean normal of edges beside a corner may be far from them.
fn one_direction(mesh: &Mesh, pair: [(&Proposal<'_>, usize); 2]) -> bool {
    if let [Source::Found(first), Source::Found(second)] = pair.map(|(proposal, _)| proposal.source) {
        return first.shared == second.shared;
    }
    let [a, b] = pair.map(|(proposal, common)| unit(&outward(mesh, &proposal.faces[common])));
    dot(&a, &b) >= ONE_DIRECTION
}

/// What contacts that are solved together must have in common.
fn check(first: &Proposal<'_>, second: &Proposal<'_>, node: NodeId) -> Result<(), InputError> {
    let fail = |cause| Err(InputError { place: second.place, cause });
    if first.contact.friction() != second.contact.friction() {
        return fail(Cause::FrictionsDiffer {
            node: node.index(),
            friction: [first, second].map(|one| one.contact.friction()),
        });
    }
    if [first, second].iter().any(|one| one.contact.matching == Some(true)) {
        return fail(Cause::SharedPairs { node: node.index() });
    }
    Ok(())
}

/// "a", "a and b" or "a, b and c", of different names.
pub(super) fn listed(names: &[&str]) -> String {
    let mut different: Vec<&str> = Vec::new();
    for name in names {
        if !different.contains(name) {
            different.push(name);
        }
    }
    match different.split_last() {
        Some((last, [])) => (*last).to_string(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}
