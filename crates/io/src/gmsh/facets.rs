//! Lines as parts of the boundary of triangles, points as ends of bars.

use super::error::{Fault, GmshCause};
use super::groups::Sorted;
use super::nodes::{Kept, Nodes};
use super::raw::Raw;
use percute_core::simplex::Shape;
use std::collections::{BTreeMap, HashMap};

/// The boundary groups of the file.
pub(super) struct Boundary<const D: usize> {
    /// Facets of each group that lie on the boundary, by their nodes.
    pub(super) groups: BTreeMap<String, Vec<[usize; D]>>,
    /// Number of facets of each group that lie inside.
    pub(super) inner: BTreeMap<String, usize>,
}

/// Finds the facets of the physical groups; `cells` are the elements of the mesh.
pub(super) fn boundary<const D: usize, const N: usize>(
    raw: &Raw,
    nodes: &Nodes,
    kept: &Kept,
    cells: &[[usize; N]],
    facets: &Sorted<D>,
    shape: Shape,
) -> Result<Boundary<D>, Fault> {
    let located: Vec<_> = nodes.located(&facets.elements)?.into_iter().map(|facet| kept.facet(facet)).collect();
    let around = owners(cells, located.iter().flatten());
    let owners_of = |facet: &Option<[usize; D]>| facet.and_then(|f| around.get(&sorted(f)).copied()).unwrap_or(0);
    let counts: Vec<usize> = located.iter().map(owners_of).collect();
    let required = |at: usize| match shape {
        Shape::Bar => named(facets, at),
        Shape::Triangle => true,
    };
    if let Some(at) = (0..counts.len()).find(|&at| counts[at] == 0 && required(at)) {
        return Err(lone(raw, facets, at));
    }
    let none = [0; D];
    let mut inner = BTreeMap::new();
    let mut groups = BTreeMap::new();
    for (name, members) in raw.named(D - 1, &facets.members, |at| at) {
        let (inside, outside): (Vec<_>, Vec<_>) = members.into_iter().partition(|&at| counts[at] > 1);
        if !inside.is_empty() {
            inner.insert(name.clone(), inside.len());
        }
        groups.insert(name, outside.into_iter().map(|at| located[at].unwrap_or(none)).collect());
    }
    Ok(Boundary { groups, inner })
}

/// Number of elements with each facet, for the facets of these nodes.
fn owners<'a, const D: usize, const N: usize>(
    cells: &[[usize; N]],
    facets: impl Iterator<Item = &'a [usize; D]>,
) -> HashMap<[usize; D], usize> {
    let most = cells.iter().flatten().max().map_or(0, |most| most + 1);
    let (mut marked, mut around) = (vec![false; most], HashMap::new());
    for facet in facets {
        facet.iter().for_each(|&node| marked[node] = true);
        around.insert(sorted(*facet), 0);
    }
    for cell in cells {
        for opposite in 0..N {
            let facet: [usize; D] = std::array::from_fn(|i| cell[(opposite + 1 + i) % N]);
            if facet.iter().all(|&node| marked[node]) {
                around.entry(sorted(facet)).and_modify(|count| *count += 1);
            }
        }
    }
    around
}

fn sorted<const D: usize>(mut nodes: [usize; D]) -> [usize; D] {
    nodes.sort_unstable();
    nodes
}

fn named<const D: usize>(facets: &Sorted<D>, at: usize) -> bool {
    facets.members.values().any(|members| members.contains(&at))
}

fn lone<const D: usize>(raw: &Raw, facets: &Sorted<D>, at: usize) -> Fault {
    let element = &facets.elements[at];
    let with = facets.members.iter().filter(|(_, members)| members.contains(&at));
    let groups: Vec<_> = with.map(|(&tag, _)| raw.name(D - 1, tag)).collect();
    let (tag, nodes) = (element.tag, element.nodes.to_vec());
    GmshCause::Lone { dimension: D, element: tag, nodes, groups }.at(element.at)
}
