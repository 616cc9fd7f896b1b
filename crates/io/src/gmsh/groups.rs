//! Elements in the order of their tags, and the physical groups they belong to.

use super::error::{Fault, GmshCause};
use super::header::Version;
use super::raw::{Element, Raw};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Elements by increasing tags, each once.
pub(super) struct Sorted<const N: usize> {
    pub(super) elements: Vec<Element<N>>,
    /// Tags of omitted elements. An earlier element with the same nodes is in the groups of both.
    pub(super) doubled: Vec<u64>,
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
        let doubled = once(&mut elements, &mut members);
        Ok(Sorted { elements, doubled, members })
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

/// Version 2.2 lists an element of several groups once for each group, under different tags. These are merged.
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
            // Gmsh does not list an element twice in one group: this is reported.
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

/// Keeps the first of all elements on the same nodes, for the groups of all; gives the tags of the others.
fn once<const N: usize>(elements: &mut Vec<Element<N>>, members: &mut BTreeMap<i64, Vec<usize>>) -> Vec<u64> {
    let mut keys: Vec<_> = elements.iter().map(|element| element.nodes).zip(0..).collect();
    keys.iter_mut().for_each(|(nodes, _): &mut ([u64; N], usize)| nodes.sort_unstable());
    keys.sort_unstable();
    let mut first: Vec<usize> = (0..elements.len()).collect();
    for pair in keys.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        first[pair[1].1] = first[pair[0].1];
    }
    let doubled: Vec<u64> = (0..first.len()).filter(|&at| first[at] != at).map(|at| elements[at].tag).collect();
    if doubled.is_empty() {
        return doubled;
    }
    let (mut kept, mut numbers) = (Vec::with_capacity(elements.len()), Vec::with_capacity(elements.len()));
    for (at, &of) in first.iter().enumerate() {
        numbers.push(if of == at { kept.len() } else { numbers[of] });
        if of == at {
            kept.push(elements[at]);
        }
    }
    *elements = kept;
    for all in members.values_mut() {
        all.iter_mut().for_each(|at| *at = numbers[*at]);
        all.sort_unstable();
        all.dedup();
    }
    doubled
}
