//! How contact nodes move under contact forces.

use super::patch::{AccelerationParts, Factors, PARTS, Patch, PatchOperator, RINGS};
use std::collections::BTreeSet;

/// The parts of the accelerations of a node under unit forces on another one (1/kg): by component of the acceleration,
/// part and component of the force.
type Compliance<const D: usize> = [AccelerationParts<D>; D];

/// The pairs of a patch around each of its nodes.
#[derive(Debug)]
pub(super) struct Neighbours {
    starts: Vec<u32>,
    pairs: Vec<u32>,
}

impl Neighbours {
    pub(super) fn new(patch: &Patch) -> Self {
        let mut around: Vec<(u32, u32)> =
            patch.pairs.iter().zip(0..).flat_map(|(pair, p)| pair.nodes.map(|node| (node, p))).collect();
        around.sort_unstable();
        around.dedup();
        let first = |node: usize| around.partition_point(|(other, _)| (*other as usize) < node) as u32;
        let starts = (0..=patch.nodes.len()).map(first).collect();
        Self { starts, pairs: around.into_iter().map(|(_, pair)| pair).collect() }
    }

    /// The part of a patch that moves under a force at a place.
    fn around(&self, patch: &Patch, place: u32) -> Patch {
        let mut nodes = BTreeSet::from([place]);
        let mut pairs = BTreeSet::new();
        for _ in 0..RINGS {
            let of = |&node: &u32| self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize;
            pairs.extend(nodes.iter().flat_map(|node| &self.pairs[of(node)]));
            nodes.extend(pairs.iter().flat_map(|pair| patch.pairs[*pair as usize].nodes));
        }
        patch.part(pairs.into_iter())
    }
}

/// How a contact node moves against its obstacle under unit forces, its own and those of others. G = A M⁻¹ of the
/// corrected acceleration A ã is symmetric: the accelerations of others under a force here are those here under
/// forces there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Response<const D: usize> {
    /// Under a force of its own, with the opposite one on the node that it faces.
    own: Compliance<D>,
    /// Under a force on another contact node, by its position in the contact surface.
    others: Vec<(u32, Compliance<D>)>,
}

impl<const D: usize> Response<D> {
    /// That of a node, `facing` has it and the one that it faces, if there is one: place in the patch and position in
    /// the contact surface. `contacts` has the places and positions of all contact nodes whose forces count, ascending.
    pub(super) fn new(
        (patch, neighbours): (&Patch, &Neighbours),
        operator: PatchOperator<'_>,
        facing: &[(u32, u32)],
        contacts: &[(u32, u32)],
    ) -> Self {
        let mut made = Self { own: [[[0.0; D]; PARTS]; D], others: Vec::new() };
        for (&(place, _), sign) in facing.iter().zip([1.0, -1.0]) {
            let mut part = neighbours.around(patch, place);
            let moved: Vec<Compliance<D>> = part.under_unit_forces(part.place(place), operator);
            for (&node, compliance) in part.nodes.iter().zip(&moved) {
                let first = contacts.partition_point(|(contact, _)| *contact < node);
                for &(_, at) in contacts[first..].iter().take_while(|(contact, _)| *contact == node) {
                    let own = facing.iter().zip([1.0, -1.0]).find(|((_, other), _)| *other == at);
                    let (to, sign) = match own {
                        Some((_, other)) => (&mut made.own, sign * other),
                        None => (made.other(at), sign),
                    };
                    let sums = to.as_flattened_mut().as_flattened_mut().iter_mut();
                    sums.zip(compliance.as_flattened().as_flattened()).for_each(|(to, from)| *to += sign * from);
                }
            }
        }
        made.others.retain(|(_, compliance)| compliance.as_flattened().as_flattened().iter().any(|x| *x != 0.0));
        made
    }

    fn other(&mut self, at: u32) -> &mut Compliance<D> {
        let place = self.others.partition_point(|(other, _)| *other < at);
        if self.others.get(place).is_none_or(|(other, _)| *other != at) {
            self.others.insert(place, (at, [[[0.0; D]; PARTS]; D]));
        }
        &mut self.others[place].1
    }

    /// The acceleration under unit forces of its own, by component of the acceleration and of the force (1/kg).
    pub(super) fn own(&self, factors: &Factors) -> [[f64; D]; D] {
        self.own.map(|parts| factors.sum(&parts))
    }

    /// The acceleration under unit forces on another contact node, with the opposite ones on the node that it faces.
    pub(super) fn of(&self, factors: &Factors, by: usize, partner: Option<usize>) -> [[f64; D]; D] {
        let find = |at: usize| {
            let found = self.others.binary_search_by_key(&(at as u32), |(other, _)| *other);
            found.map_or([[0.0; D]; D], |k| self.others[k].1.map(|parts| factors.sum(&parts)))
        };
        let (direct, facing) = (find(by), partner.map_or([[0.0; D]; D], find));
        std::array::from_fn(|c| std::array::from_fn(|d| direct[c][d] - facing[c][d]))
    }

    /// The acceleration under the forces (N) of all other contact nodes.
    pub(super) fn under(&self, factors: &Factors, force: impl Fn(usize) -> [f64; D]) -> [f64; D] {
        let mut moved = [0.0; D];
        let forces = self.others.iter().map(|(at, compliance)| (force(*at as usize), compliance));
        for (force, compliance) in forces.filter(|(force, _)| *force != [0.0; D]) {
            for (moved, parts) in moved.iter_mut().zip(compliance) {
                *moved += dot(&factors.sum(parts), &force);
            }
        }
        moved
    }
}

pub(super) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
