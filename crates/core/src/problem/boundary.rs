//! Supports and loads, from named groups to faces, nodes and elements.

use super::{BodyLoad, Cause, Conditions, FaceLoad, GroupOf, HeldBy, InputError, PrescribedComponent};
use crate::ids::{ElementId, FaceId, NodeId};
use crate::load::{BodyForce, Profile, Support, Table, Traction};
use crate::mesh::Mesh;
use crate::message::axis;
use std::collections::BTreeMap;

/// The members of a group of faces.
pub(super) fn face_group<'m>(mesh: &'m Mesh, name: &str) -> Result<&'m [FaceId], Cause> {
    group(mesh.face_groups(), name, GroupOf::faces(mesh.kind()), mesh.element_groups(), GroupOf::Elements)
}

/// The members of a group of elements.
pub(super) fn element_group<'m>(mesh: &'m Mesh, name: &str) -> Result<&'m [ElementId], Cause> {
    group(mesh.element_groups(), name, GroupOf::Elements, mesh.face_groups(), GroupOf::faces(mesh.kind()))
}

fn group<'m, Id, Other>(
    groups: &'m BTreeMap<String, Vec<Id>>,
    name: &str,
    of: GroupOf,
    others: &BTreeMap<String, Vec<Other>>,
    found: GroupOf,
) -> Result<&'m [Id], Cause> {
    let (known, name) = (|| groups.keys().cloned().collect(), name.to_string());
    match groups.get(&name) {
        None if others.contains_key(&name) => Err(Cause::OtherGroup { name, found, of, known: known() }),
        None => Err(Cause::UnknownGroup { name, of, known: known() }),
        Some(members) if members.is_empty() => Err(Cause::EmptyGroup { name, of }),
        Some(members) => Ok(members),
    }
}

/// The first support or traction on each face, which then cannot touch a plane.
pub(super) fn held(mesh: &Mesh, stated: &Conditions) -> Vec<Option<HeldBy>> {
    let mut held = vec![None; mesh.faces().len()];
    let supports = stated.supports.iter().enumerate().map(|(i, s)| (HeldBy::Support(i), &s.group));
    let tractions = stated.tractions.iter().enumerate().map(|(i, t)| (HeldBy::Traction(i), &t.group));
    for (by, group) in supports.chain(tractions) {
        for face in mesh.face_groups().get(group).into_iter().flatten() {
            held[face.index()].get_or_insert(by);
        }
    }
    held
}

/// Refuses numbers that are not finite.
fn finite<'v>(numbers: impl IntoIterator<Item = &'v f64>) -> Result<(), Cause> {
    numbers.into_iter().find(|x| !x.is_finite()).map_or(Ok(()), |&value| Err(Cause::NotFinite { value }))
}

/// Supported faces, prescribed components of nodes, and velocity tables.
pub(super) struct Supports<const D: usize> {
    pub(super) faces: Vec<[bool; D]>,
    pub(super) prescribed: Vec<PrescribedComponent>,
    pub(super) motions: Vec<Table>,
}

impl<const D: usize> Supports<D> {
    /// Which components of each node are prescribed.
    pub(super) fn fixed(&self, nodes: usize) -> Vec<[bool; D]> {
        let mut fixed = vec![[false; D]; nodes];
        self.prescribed.iter().for_each(|p| fixed[p.node.index()][p.component] = true);
        fixed
    }
}

/// Resolves the supports; two may overlap only if they prescribe the same motion.
pub(super) fn supports<const D: usize>(mesh: &Mesh, supports: &[Support]) -> Result<Supports<D>, InputError> {
    let mut faces = vec![[false; D]; mesh.faces().len()];
    let mut motions: Vec<Table> = Vec::new();
    let mut by_node: BTreeMap<(NodeId, usize), (usize, Option<usize>)> = BTreeMap::new();
    for (index, support) in supports.iter().enumerate() {
        let fail = |cause: Cause, key| cause.at("support", Some(index), key);
        let members = face_group(mesh, &support.group).map_err(|c| fail(c, "group"))?;
        if !support.components[..D].contains(&true) {
            return Err(fail(Cause::NoComponent, "components"));
        }
        let velocities = support.velocity.iter().flat_map(|table| table.value().iter().flatten());
        finite(velocities).map_err(|cause| fail(cause, "velocity"))?;
        for component in (0..D).filter(|&c| support.components[c]) {
            let motion = support.velocity.as_ref().map(|table| motion_index(&mut motions, table.component(component)));
            for face in members {
                faces[face.index()][component] = true;
                for node in mesh.face_nodes::<D>(*face) {
                    let (first, earlier) = *by_node.entry((node, component)).or_insert((index, motion));
                    if earlier != motion {
                        let (node, component) = (node.index(), axis(component));
                        return Err(fail(Cause::ConflictingSupports { node, component, first: first + 1 }, "velocity"));
                    }
                }
            }
        }
    }
    let prescribed = by_node
        .into_iter()
        .map(|((node, component), (_, motion))| PrescribedComponent { node, component, motion })
        .collect();
    Ok(Supports { faces, prescribed, motions })
}

/// Position of a motion among those known, added if it is new.
fn motion_index(motions: &mut Vec<Table>, motion: Table) -> usize {
    motions.iter().position(|known| *known == motion).unwrap_or_else(|| {
        motions.push(motion);
        motions.len() - 1
    })
}

/// Tractions face by face.
pub(super) fn tractions<const D: usize>(
    mesh: &Mesh,
    tractions: &[Traction],
    supported: &[[bool; D]],
) -> Result<Vec<FaceLoad<D>>, InputError> {
    let mut loads = Vec::new();
    for (table, traction) in tractions.iter().enumerate() {
        let fail = |cause: Cause, key| cause.at("traction", Some(table), key);
        let members = face_group(mesh, &traction.group).map_err(|c| fail(c, "group"))?;
        finite(traction.value.value().iter().flatten()).map_err(|cause| fail(cause, "value"))?;
        let acts = traction.value.acting_components();
        for &face in members {
            if let Some(c) = (0..D).find(|&c| acts[c] && supported[face.index()][c]) {
                let nodes = mesh.face_nodes::<D>(face).map(NodeId::index).to_vec();
                return Err(fail(Cause::LoadedSupport { component: axis(c), nodes }, "group"));
            }
            let profile = profile_on::<D>(mesh, face, &traction.profile);
            finite(&profile).map_err(|cause| fail(cause, "profile"))?;
            loads.push(FaceLoad { face, profile, table });
        }
    }
    Ok(loads)
}

/// The factor of a traction at each node of a face.
pub(super) fn profile_on<const D: usize>(mesh: &Mesh, face: FaceId, profile: &Profile) -> [f64; D] {
    mesh.face_nodes::<D>(face).map(|node| profile.at(&mesh.points_in::<D>()[node.index()]))
}

/// Body forces with the volume at each node on which they act, and the list of each element.
#[allow(clippy::type_complexity)]
pub(super) fn body_forces(
    mesh: &Mesh,
    forces: &[BodyForce],
    volume: impl Fn(ElementId) -> f64,
) -> Result<(Vec<BodyLoad>, Vec<Vec<u16>>), InputError> {
    let mut loads = Vec::new();
    let mut by_element = vec![Vec::new(); if forces.is_empty() { 0 } else { mesh.element_count() }];
    for (index, force) in forces.iter().enumerate() {
        let fail = |cause: Cause, key| cause.at("body_force", Some(index), key);
        finite(force.value.value().iter().flatten()).map_err(|cause| fail(cause, "value"))?;
        let members: Vec<ElementId> = match &force.group {
            Some(name) => element_group(mesh, name).map_err(|c| fail(c, "group"))?.to_vec(),
            None => (0..mesh.element_count()).map(ElementId::new).collect(),
        };
        let mut nodal = vec![0.0; mesh.node_count()];
        for element in members {
            by_element[element.index()].push(index as u16);
            let nodes = mesh.cell(element);
            nodes.iter().for_each(|node| nodal[node.index()] += volume(element) / nodes.len() as f64);
        }
        let felt = nodal.into_iter().enumerate().filter(|&(_, v)| v > 0.0).map(|(i, v)| (NodeId::new(i), v));
        loads.push(BodyLoad { value: force.value.clone(), nodal_volume: felt.collect() });
    }
    Ok((loads, by_element))
}
