//! Elements in the order of their tags, and the physical groups they belong to.

use super::error::{Fault, GmshCause};
use super::header::Version;
use super::raw::{Element, Raw};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Elements by increasing tags, each once.
pub(super) struct Sorted<const N: usize> {
    pub(super) elements: Vec<Element<N>>,
    /// Positions among them of the members of each physical group, by its tag.
    pub(super) members: BTreeMap<i64, Vec<usize>>,
}

impl Raw {
    /// Sorts elements of a dimension, and finds their physical groups.
    pub(super) fn sorted<const N: usize>(&self, mut elements: Vec<Element<N>>) -> Result<Sorted<N>, Fault> {
        elements.sort_by_key(|element| element.tag);
        let mut members = BTreeMap::<i64, Vec<usize>>::new();
        if self.version == Version::V22 {
            elements = merged(elements, &mut members);
        } else {
            for (at, element) in elements.iter().enumerate() {
                let groups = self.groups_of.get(&(N as i64 - 1, element.entity));
                groups.into_iter().flatten().for_each(|&group| members.entry(group).or_default().push(at));
            }
        }
        if let Some(pair) = elements.windows(2).find(|pair| pair[0].tag == pair[1].tag) {
            return Err(GmshCause::Twice { what: "element", tag: pair[1].tag }.at(pair[1].at));
        }
        Ok(Sorted { elements, members })
    }

    /// The name of a physical group: its tag if it has none.
    pub(super) fn name(&self, dimension: usize, tag: i64) -> String {
        self.names.get(&(dimension as i64, tag)).cloned().unwrap_or_else(|| tag.to_string())
    }

    /// Named groups of a dimension; those that have a name but no members are empty.
    pub(super) fn named<T>(
        &self,
        dimension: usize,
        members: &BTreeMap<i64, Vec<usize>>,
        of: impl Fn(usize) -> T,
    ) -> BTreeMap<String, Vec<T>> {
        let mut groups = BTreeMap::<String, Vec<T>>::new();
        for name in self.names.range((dimension as i64, i64::MIN)..=(dimension as i64, i64::MAX)) {
            groups.entry(name.1.clone()).or_default();
        }
        for (&tag, all) in members {
            groups.entry(self.name(dimension, tag)).or_default().extend(all.iter().map(|&at| of(at)));
        }
        groups
    }
}

/// Version 2.2 writes an element that is in several groups once for each, under different tags: they become one.
fn merged<const N: usize>(elements: Vec<Element<N>>, members: &mut BTreeMap<i64, Vec<usize>>) -> Vec<Element<N>> {
    let mut groups = BTreeMap::<i64, BTreeSet<i64>>::new();
    elements.iter().for_each(|element| _ = groups.entry(element.entity).or_default().insert(element.group));
    let (mut once, mut seen) = (Vec::with_capacity(elements.len()), HashMap::new());
    for element in elements {
        let mut at = once.len();
        let group = element.group;
        if groups.get(&element.entity).is_some_and(|groups| groups.len() > 1) {
            let mut nodes = element.nodes;
            nodes.sort_unstable();
            let (first, of) = seen.entry((element.entity, nodes)).or_insert_with(|| (at, BTreeSet::new()));
            // Twice in the same group is no doubling but an overlap, which the mesh refuses.
            if of.insert(group) {
                at = *first;
            }
        }
        if at == once.len() {
            once.push(element);
        }
        if group != 0 {
            match members.entry(group) {
                Entry::Vacant(empty) => _ = empty.insert(vec![at]),
                Entry::Occupied(mut some) => some.get_mut().push(at),
            }
        }
    }
    once
}

/// Names in a sentence.
pub(super) fn quoted(names: &[String]) -> String {
    let all: Vec<_> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let what = if names.len() == 1 { "the physical group" } else { "the physical groups" };
    format!("{what} {}", all.join(", "))
}
