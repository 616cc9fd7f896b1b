//! From contacts as users state them to pairs of surfaces.

use super::bodies::{Between, Contact, Found, Start, Wanted, find, outlines};
use super::facing_edges::FacingEdges;
use super::joined::{Member, Proposal, Source, joined, listed};
use super::sides::Bodies;
use super::{Cause, InputError, Place};
use crate::contact::{Interface, ObstacleError, RELATIONS};
use crate::ids::{FaceId, NodeId};
use crate::material::Law;
use crate::mesh::Mesh;
use std::collections::BTreeSet;

/// Bodies slide by less than this part of the shortest edge if pairs of nodes shall stay pairs.
const SLIDES: f64 = 0.1;

/// Pairs of surfaces.
#[derive(Default)]
pub(super) struct Surfaces {
    /// The interfaces, and where they are stated.
    pub(super) choices: Vec<(Choice, Place)>,
    /// Groups of faces that the mesh does not have, as many as the choices may need.
    pub(super) groups: Vec<(String, Vec<FaceId>)>,
}

/// An interface, and another one if the nodes of the first one do not face each other in pairs.
pub(super) struct Choice {
    pub(super) first: Interface,
    pub(super) otherwise: Option<Interface>,
}

/// The contacts of a problem as they are stated.
pub(super) struct Stated<'a> {
    pub(super) contacts: &'a [Contact],
    /// Whether all bodies may touch each other, and not only those of which contact is stated.
    pub(super) automatic: bool,
}

/// The pairs of surfaces of all contacts, beside the faces that may touch planes.
pub(super) fn surfaces<const D: usize>(
    bodies: &Bodies<'_, D>,
    stated: &Stated<'_>,
    start: &Start<'_, D>,
    facing_planes: &BTreeSet<FaceId>,
) -> Result<Surfaces, InputError> {
    let Stated { contacts, automatic } = stated;
    let mut made = Surfaces::default();
    // A mistake in what is stated comes before one of what is found.
    for (index, contact) in contacts.iter().enumerate() {
        let Between::Groups(groups) = &contact.between else { continue };
        let place = Place { table: "contact", index: Some(index), key: contact.key() };
        let fail = |cause| InputError { place, cause };
        let choice = of_groups(bodies.mesh, contact, groups).map_err(|cause| fail(cause.into()))?;
        bodies.sides(choice.otherwise.as_ref().unwrap_or(&choice.first)).map_err(fail)?;
    }
    let by_groups = contacts.iter().all(|contact| matches!(contact.between, Between::Groups(_)));
    let pairs =
        if by_groups && !automatic { Pairs::default() } else { Pairs::new(bodies, stated, start, facing_planes)? };
    let mut proposals = Vec::new();
    for (index, contact) in contacts.iter().enumerate() {
        let place = Place { table: "contact", index: Some(index), key: contact.key() };
        let source = match &contact.between {
            Between::Groups(groups) => Source::Groups(groups),
            Between::Bodies(_) => {
                let Some(found) = pairs.of_contact(Some(index)).next() else { continue };
                Source::Found(found)
            }
            Between::All => continue,
        };
        proposals.push(Proposal { contact, place, source, faces: source.faces(bodies.mesh) });
    }
    let default = contacts.iter().position(|contact| contact.between == Between::All);
    let place = Place { table: "contact", index: default, key: "" };
    for found in pairs.of_contact(None) {
        let Some(contact) = default.map(|index| &contacts[index]).or((D == 1).then_some(&Contact::FRICTIONLESS)) else {
            let bodies = found.pair.map(|body| pairs.names[body].clone());
            return Err(Cause::NoFriction { bodies }.at("contact", None, "friction"));
        };
        let source = Source::Found(found);
        proposals.push(Proposal { contact, place, source, faces: source.faces(bodies.mesh) });
    }
    for members in joined(bodies, &proposals)? {
        let place = proposals[members[0].contact].place;
        let choice = made.of_members(bodies.mesh, (&proposals, &members), &pairs.names);
        if let Some(choice) = choice.map_err(|cause| InputError { place, cause })? {
            made.choices.push((choice, place));
        }
    }
    Ok(made)
}

/// The interface of two groups.
fn of_groups(mesh: &Mesh, contact: &Contact, groups: &[String; 2]) -> Result<Choice, ObstacleError> {
    let (dimension, groups) = (mesh.dimension(), groups.each_ref().map(String::as_str));
    let otherwise = contact.matching.is_none().then(|| contact.interface(dimension, groups, false)).transpose()?;
    Ok(Choice { first: contact.interface(dimension, groups, contact.matching != Some(false))?, otherwise })
}

impl Surfaces {
    /// The interface of contacts that are solved together. Bodies that are not named may have none: what is left of
    /// their edges beside those of other contacts cannot meet.
    fn of_members(
        &mut self,
        mesh: &Mesh,
        (proposals, members): (&[Proposal<'_>], &[Member]),
        names: &[String],
    ) -> Result<Option<Choice>, Cause> {
        let Proposal { contact, source, .. } = &proposals[members[0].contact];
        match source {
            _ if members.len() > 1 => Ok(Some(self.of_several(mesh, (proposals, members), names)?)),
            Source::Groups(groups) => Ok(Some(of_groups(mesh, contact, groups)?)),
            Source::Found(found) => match self.of_found(mesh, contact, (names, found))? {
                None if matches!(contact.between, Between::Bodies(_)) => {
                    Err(Cause::NothingSees { bodies: found.pair.map(|body| names[body].clone()) })
                }
                choice => Ok(choice),
            },
        }
    }

    /// The interface of two surfaces that are found, if they have edges that face each other.
    fn of_found(
        &mut self,
        mesh: &Mesh,
        contact: &Contact,
        (names, found): (&[String], &Found),
    ) -> Result<Option<Choice>, ObstacleError> {
        let shortest =
            found.seeing.iter().flatten().map(|&face| mesh.face_normal(face).1).fold(f64::INFINITY, f64::min);
        let stays = found.slide <= SLIDES * shortest;
        let mut make = |matching: bool| {
            let groups = self.groups_of(mesh, names, found, matching);
            groups
                .map(|groups| contact.interface(mesh.dimension(), groups.each_ref().map(String::as_str), matching))
                .transpose()
        };
        let (first, otherwise) = match contact.matching.or((!stays).then_some(false)) {
            Some(matching) => (make(matching)?, None),
            None => (make(true)?, make(false)?),
        };
        Ok(first.map(|first| Choice { first, otherwise }))
    }

    /// The names of both surfaces, if they face each other: those of groups of the mesh, if there are such, else of new
    /// ones.
    fn groups_of(&mut self, mesh: &Mesh, names: &[String], found: &Found, matching: bool) -> Option<[String; 2]> {
        let relation = RELATIONS[usize::from(!matching)];
        let mut sides = found.seeing.clone();
        if !matching {
            sides.iter_mut().zip(&found.beside).for_each(|(side, beside)| side.extend(beside));
            sides.iter_mut().for_each(|side| side.sort_unstable());
        }
        let nearest = [0, 1].map(|side| found.nearest.iter().map(|nearest| nearest[side]).collect());
        let mut sides = FacingEdges { mesh, nearest, across: found.across }.of(&sides)?;
        Some([0, 1].map(|side| {
            let faces = std::mem::take(&mut sides[side]);
            let [own, other] = [side, 1 - side].map(|k| &names[found.pair[k]]);
            self.group(mesh, format!("{own} {relation} {other}"), faces)
        }))
    }

    /// The interface between a common surface and those of several bodies.
    fn of_several(
        &mut self,
        mesh: &Mesh,
        (proposals, members): (&[Proposal<'_>], &[Member]),
        names: &[String],
    ) -> Result<Choice, ObstacleError> {
        let faces = faces_of_several(mesh, proposals, members);
        let mut make = |is_common: bool| {
            let (mut own, mut others) = (Vec::new(), Vec::new());
            for Member { contact, common } in members {
                let side = if is_common { *common } else { 1 - common };
                match proposals[*contact].source {
                    Source::Groups(groups) => own.push(groups[side].as_str()),
                    Source::Found(found) => {
                        own.push(names[found.pair[side]].as_str());
                        others.push(names[found.pair[1 - side]].as_str());
                    }
                }
            }
            let relation =
                if others.is_empty() { String::new() } else { format!(" {} {}", RELATIONS[1], listed(&others)) };
            self.group(mesh, listed(&own) + &relation, faces[usize::from(!is_common)].clone())
        };
        // The sides stay in the order of the first contact.
        let groups = if members[0].common == 0 { [make(true), make(false)] } else { [make(false), make(true)] };
        let contact = proposals[members[0].contact].contact;
        let first = contact.interface(mesh.dimension(), groups.each_ref().map(String::as_str), false)?;
        Ok(Choice { first, otherwise: None })
    }

    /// The name of a group of these faces: one of the mesh, or a new one.
    fn group(&mut self, mesh: &Mesh, name: String, faces: Vec<FaceId>) -> String {
        if let Some((name, _)) = mesh.face_groups().iter().find(|(_, group)| **group == faces) {
            return name.clone();
        }
        self.groups.push((name.clone(), faces));
        name
    }
}

/// The faces of the common surface of several contacts, and those of the others. All those that the user named stay.
fn faces_of_several(mesh: &Mesh, proposals: &[Proposal<'_>], members: &[Member]) -> [Vec<FaceId>; 2] {
    let mut sides = [BTreeSet::new(), BTreeSet::new()];
    let mut nearest = [Vec::new(), Vec::new()];
    let (mut named, mut across) = (false, None);
    for Member { contact, common } in members {
        let Proposal { faces, source, .. } = &proposals[*contact];
        for (side, all) in [*common, 1 - common].into_iter().zip(&mut sides) {
            all.extend(&faces[side]);
            match source {
                Source::Groups(_) => named = true,
                Source::Found(found) => {
                    across = across.or(found.across);
                    all.extend(&found.beside[side]);
                }
            }
        }
        if let Source::Found(Found { nearest: Some(faces), .. }) = source {
            nearest[0].push(faces[*common]);
            nearest[1].push(faces[1 - common]);
        }
    }
    let sides = sides.map(|side| side.into_iter().collect());
    if named {
        return sides;
    }
    // If there are none, the check of the interface has a message.
    FacingEdges { mesh, nearest, across }.of(&sides).unwrap_or(sides)
}

/// The pairs of bodies whose surfaces were looked for.
#[derive(Default)]
struct Pairs {
    names: Vec<String>,
    found: Vec<Found>,
    /// The contact that names the bodies of each.
    contact: Vec<Option<usize>>,
}

impl Pairs {
    /// Those that a contact names, or no one.
    fn of_contact(&self, contact: Option<usize>) -> impl Iterator<Item = &Found> {
        self.found.iter().zip(&self.contact).filter(move |(_, of)| **of == contact).map(|(found, _)| found)
    }

    fn new<const D: usize>(
        bodies: &Bodies<'_, D>,
        stated: &Stated<'_>,
        start: &Start<'_, D>,
        facing_planes: &BTreeSet<FaceId>,
    ) -> Result<Self, InputError> {
        let (mesh, names, of_node) = (bodies.mesh, bodies.mesh.part_names(), bodies.mesh.part_numbers());
        let (mut wanted, mut contact): (Vec<Wanted>, Vec<Option<usize>>) = (Vec::new(), Vec::new());
        let (mut known, mut taken, mut default) = (BTreeSet::new(), BTreeSet::new(), None);
        for (index, one) in stated.contacts.iter().enumerate() {
            match &one.between {
                Between::Groups(groups) => {
                    let faces =
                        groups.each_ref().map(|group| mesh.face_groups().get(group).map_or(&[][..], Vec::as_slice));
                    let nodes = faces.map(|all| all.iter().flat_map(|face| mesh.face_nodes::<D>(*face)));
                    let nodes: [Vec<NodeId>; 2] = nodes.map(Iterator::collect);
                    if let [Some(a), Some(b)] = nodes.each_ref().map(|nodes| nodes.first()) {
                        known.insert(ordered([a, b].map(|node| of_node[node.index()])));
                    }
                    taken.extend(nodes.into_iter().flatten());
                }
                Between::Bodies(pair) => {
                    let fail = |cause: Cause| cause.at("contact", Some(index), "bodies");
                    let pair = self::pair(&names, pair).map_err(fail)?;
                    if wanted.iter().any(|earlier: &Wanted| ordered(earlier.pair) == ordered(pair)) {
                        return Err(fail(Cause::SamePair { bodies: pair.map(|body| names[body].clone()) }));
                    }
                    known.insert(ordered(pair));
                    wanted.push(named(pair, one));
                    contact.push(Some(index));
                }
                Between::All if default.is_some() => return Err(Cause::TwoDefaults.at("contact", Some(index), "")),
                Between::All => default = Some(index),
            }
        }
        if stated.automatic || default.is_some() {
            let all = (0..names.len()).flat_map(|a| (a + 1..names.len()).map(move |b| [a, b]));
            let common = default.map(|index| &stated.contacts[index]);
            let rest: Vec<[usize; 2]> = all.filter(|pair| !known.contains(pair)).collect();
            contact.extend(rest.iter().map(|_| None));
            wanted.extend(rest.into_iter().map(|pair| unnamed::<D>(pair, common)));
        }
        let law = |face| (bodies.law)(face);
        let free = |face: FaceId| bodies.held[face.index()].is_none();
        let outlines =
            outlines(mesh, names.clone(), start, free, |face| law(face).wave_speed(), |face| bodies.line_of(face));
        let held = |node: NodeId| {
            let held = &bodies.fixed[node.index()];
            [held[0], held.get(1).copied().unwrap_or(false)]
        };
        let found = find(&outlines, &wanted, held, &taken, facing_planes).map_err(|(at, cause)| match contact[at] {
            Some(index) => cause.at("contact", Some(index), "bodies"),
            None => cause.at("contact", default, ""),
        })?;
        let contact = found.iter().map(|found| contact[found.wanted]).collect();
        Ok(Self { names, found, contact })
    }
}

/// A pair that is not named, with the contact of all such pairs.
fn unnamed<const D: usize>(pair: [usize; 2], contact: Option<&Contact>) -> Wanted {
    let friction = contact.map_or(0.0, Contact::friction);
    let slides = D > 1 && contact.is_none_or(|contact| contact.matching != Some(true));
    Wanted { pair, named: false, friction, slides }
}

/// A pair that a contact names.
fn named(pair: [usize; 2], contact: &Contact) -> Wanted {
    Wanted { pair, named: true, friction: contact.friction(), slides: contact.matching != Some(true) }
}

fn ordered([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// The numbers of two different bodies.
fn pair(names: &[String], [first, second]: &[String; 2]) -> Result<[usize; 2], Cause> {
    let number = |name: &String| {
        let unknown = || Cause::UnknownBody { name: name.clone(), known: names.to_vec() };
        names.iter().position(|known| known == name).ok_or_else(unknown)
    };
    let pair = [number(first)?, number(second)?];
    if pair[0] == pair[1] { Err(Cause::OneBody { name: first.clone() }) } else { Ok(pair) }
}
