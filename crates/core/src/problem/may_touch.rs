//! All that may touch: the surfaces of bodies against planes and against each other.

use super::bodies::Start;
use super::contacts::{self, Choice, Stated, Surfaces};
use super::sides::Bodies;
use super::{Cause, InputError, Place, candidates, non_matching, pairs};
use crate::contact::{ContactSurface, Interface, Obstacle, Plane};
use crate::ids::{FaceId, NodeId};
use crate::mesh::Mesh;

/// All contact of a problem.
pub(super) struct AllContact<const D: usize> {
    pub(super) surface: ContactSurface<D>,
    pub(super) interfaces: Vec<Interface>,
    /// Where each interface is stated.
    pub(super) places: Vec<Place>,
    /// Groups of faces of the interfaces that the mesh does not have.
    pub(super) groups: Vec<(String, Vec<FaceId>)>,
}

/// Finds the surfaces that may touch, and makes the contact surface of them.
pub(super) fn all_contact<const D: usize>(
    bodies: Bodies<'_, D>,
    obstacles: Vec<Obstacle<D>>,
    stated: Stated<'_>,
    start: &Start<'_, D>,
) -> Result<AllContact<D>, InputError> {
    let surface = planes(&bodies, obstacles, start.displacement)?;
    // A search over all elements, which planes alone do not need.
    let none = stated.contacts.is_empty() && !stated.automatic;
    let body = if none { Vec::new() } else { bodies.mesh.part_of_nodes() };
    let bodies = Bodies { body, ..bodies };
    let facing_planes = surface.faces().iter().map(|face| face.face).collect();
    let Surfaces { choices, mut groups } = contacts::surfaces(&bodies, &stated, start, &facing_planes)?;
    let with_groups = (!groups.is_empty()).then(|| bodies.mesh.clone().with_face_groups(groups.clone()));
    let Bodies { mesh, law, .. } = bodies;
    let mesh = with_groups.as_ref().unwrap_or(mesh);
    let bodies = Bodies { mesh, law: &|face| law(face), ..bodies };
    let (surface, interfaces) = with_interfaces(surface, &bodies, &choices, start.displacement)?;
    groups.retain(|(name, _)| interfaces.iter().any(|interface| interface.groups().contains(&name.as_str())));
    let places = choices.into_iter().map(|(_, place)| place).collect();
    Ok(AllContact { surface, interfaces, places, groups })
}

/// The planes with the faces that face them.
fn planes<const D: usize>(
    bodies: &Bodies<'_, D>,
    obstacles: Vec<Obstacle<D>>,
    displacement: &[[f64; D]],
) -> Result<ContactSurface<D>, InputError> {
    let mut surface = ContactSurface::default();
    for (index, obstacle) in obstacles.into_iter().enumerate() {
        let Some(plane) = obstacle.as_plane().cloned() else { continue };
        if obstacle.gap_to_place().is_none() {
            in_front(bodies.mesh, &plane, displacement).map_err(|cause| cause.at("obstacle", Some(index), "normal"))?;
        }
        let (held, fixed) = (|f: FaceId| bodies.held[f.index()], |node: NodeId| bodies.fixed[node.index()]);
        let turning = bodies.mesh.boundary().any(|face| (bodies.law)(face).is_finite());
        candidates::add(&mut surface, bodies.mesh, (obstacle, &plane, turning), held, fixed, |f| bodies.area(f))?;
        surface.place(surface.obstacles().len() - 1, displacement);
    }
    Ok(surface)
}

/// Adds the surfaces of different bodies that may touch.
fn with_interfaces<const D: usize>(
    mut surface: ContactSurface<D>,
    bodies: &Bodies<'_, D>,
    choices: &[(Choice, Place)],
    displacement: &[[f64; D]],
) -> Result<(ContactSurface<D>, Vec<Interface>), InputError> {
    let mut used = Vec::new();
    for (choice, place) in choices {
        let added = add_interface(&mut surface, bodies, choice, displacement);
        used.push(added.map_err(|cause| InputError { place: *place, cause })?);
    }
    Ok((surface, used))
}

/// Adds the first one of two ways of contact that the surfaces allow.
fn add_interface<const D: usize>(
    surface: &mut ContactSurface<D>,
    bodies: &Bodies<'_, D>,
    Choice { first, otherwise }: &Choice,
    displacement: &[[f64; D]],
) -> Result<Interface, Cause> {
    let mut add = |interface: &Interface| match interface.is_matching() {
        true => pairs::add(surface, bodies, interface),
        false => non_matching::add(surface, bodies, interface, displacement),
    };
    let slides = |cause: &Cause| {
        use Cause::{EdgesDiffer, HeldPair, NotMatching, SeveralBodies};
        matches!(cause, NotMatching { .. } | EdgesDiffer { .. } | SeveralBodies { .. } | HeldPair { .. })
    };
    match (add(first), otherwise) {
        (Err(cause), Some(other)) if slides(&cause) => add(other).map(|()| other.clone()),
        (added, _) => added.map(|()| first.clone()),
    }
}

/// An obstacle that has the whole body behind it has its normal reversed.
fn in_front<const D: usize>(mesh: &Mesh, plane: &Plane<D>, displacement: &[[f64; D]]) -> Result<(), Cause> {
    let gap = |(x, u): (&[f64; D], &[f64; D])| plane.gap(&std::array::from_fn(|c| x[c] + u[c]));
    let gaps: Vec<f64> = mesh.points_in::<D>().iter().zip(displacement).map(gap).collect();
    let node = (0..gaps.len()).fold(0, |deepest, i| if gaps[i] < gaps[deepest] { i } else { deepest });
    // As for contact: rounding must not put a body that rests on the obstacle behind it.
    let tolerance = 1e-12 * mesh.size();
    if gaps.iter().any(|gap| *gap > tolerance) || gaps[node] >= -tolerance {
        return Ok(());
    }
    let reversed = plane.direction().iter().map(|n| -n).collect();
    Err(Cause::Behind { node, depth: -gaps[node], reversed })
}
