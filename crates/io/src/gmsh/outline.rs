//! The outline of a plane mesh as a geometry of Gmsh (`.geo`): polygons of straight lines, to be meshed again.

use percute_core::cell::CellKind;
use percute_core::ids::{ElementId, FaceId};
use percute_core::mesh::{Face, Mesh};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Edges that turn by less than the sine of this angle (rad) are one line.
const STRAIGHT: f64 = 1e-9;
/// The group of elements that are in no group: Gmsh writes elements of groups alone.
const REST: &str = "body";

/// An edge between two regions, or of the boundary.
struct Edge {
    nodes: [usize; 2],
    /// The lines of one curve have these regions beside them and are in these groups.
    kind: (BTreeSet<usize>, BTreeSet<String>),
}

/// The polygons of one region: connected elements of the same groups.
struct Region {
    groups: BTreeSet<String>,
    /// Its edges, with the region on their left.
    edges: Vec<[usize; 2]>,
}

/// The outline of a mesh, with the boundaries between its groups of elements; all groups keep their names. Corners keep
/// their places bit by bit, and nodes inside straight lines are left out. None for a bar, and where regions meet in a
/// node alone.
#[must_use]
pub fn outline(mesh: &Mesh) -> Option<String> {
    if mesh.kind() != CellKind::Triangle {
        return None;
    }
    let (region, regions) = regions(mesh);
    let edges = edges(mesh, &region);
    let curves = curves(mesh, &edges);
    let mut text = String::from("SetFactory(\"Built-in\");\n");
    let corners: BTreeSet<usize> = curves.iter().flat_map(|curve| [curve[0], curve[curve.len() - 1]]).collect();
    for node in &corners {
        let [x, y] = place(mesh, *node);
        let _ = writeln!(text, "Point({}) = {{{x:?}, {y:?}, 0}};", node + 1);
    }
    let kinds: BTreeMap<_, _> = edges.iter().map(|edge| (edge.nodes, &edge.kind)).collect();
    let mut of_edge = BTreeMap::new();
    let mut named: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (number, curve) in (1..).zip(&curves) {
        let _ = writeln!(text, "Line({number}) = {{{}, {}}};", curve[0] + 1, curve[curve.len() - 1] + 1);
        for pair in curve.windows(2) {
            of_edge.insert([pair[0], pair[1]], number as i64);
            of_edge.insert([pair[1], pair[0]], -(number as i64));
        }
        let groups = &kinds.get(&sorted([curve[0], curve[1]]))?.1;
        groups.iter().for_each(|name| named.entry(name).or_default().push(number));
    }
    let mut surfaces: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    let mut loops = 0;
    for (number, region) in (1..).zip(&regions) {
        let mut own = Vec::new();
        for nodes in polygons(mesh, region)? {
            loops += 1;
            own.push(loops.to_string());
            let _ = writeln!(text, "Curve Loop({loops}) = {{{}}};", lines(&nodes, &of_edge)?);
        }
        let _ = writeln!(text, "Plane Surface({number}) = {{{}}};", own.join(", "));
        region.groups.iter().for_each(|name| surfaces.entry(name).or_default().push(number));
        if region.groups.is_empty() {
            surfaces.entry(REST).or_default().push(number);
        }
    }
    let list = |numbers: &[usize]| numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    for (name, numbers) in &named {
        let _ = writeln!(text, "Physical Curve(\"{name}\") = {{{}}};", list(numbers));
    }
    for (name, numbers) in &surfaces {
        let _ = writeln!(text, "Physical Surface(\"{name}\") = {{{}}};", list(numbers));
    }
    Some(text)
}

fn place(mesh: &Mesh, node: usize) -> [f64; 2] {
    mesh.points_in()[node]
}

fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// The region of each element, and the regions.
fn regions(mesh: &Mesh) -> (Vec<usize>, Vec<Region>) {
    let mut groups = vec![BTreeSet::new(); mesh.element_count()];
    for (name, members) in mesh.element_groups() {
        members.iter().for_each(|element| _ = groups[element.index()].insert(name.clone()));
    }
    let mut region = vec![usize::MAX; mesh.element_count()];
    let mut found: Vec<Region> = Vec::new();
    for first in 0..mesh.element_count() {
        if region[first] != usize::MAX {
            continue;
        }
        let mut waiting = vec![first];
        region[first] = found.len();
        while let Some(element) = waiting.pop() {
            for &face in mesh.cell_faces(ElementId::new(element)) {
                let other = mesh.face(face).across(ElementId::new(element)).map(ElementId::index);
                if let Some(other) =
                    other.filter(|&other| region[other] == usize::MAX && groups[other] == groups[first])
                {
                    region[other] = found.len();
                    waiting.push(other);
                }
            }
        }
        found.push(Region { groups: groups[first].clone(), edges: Vec::new() });
    }
    for (element, cell) in mesh.cells().enumerate() {
        for (k, &face) in mesh.cell_faces(ElementId::new(element)).iter().enumerate() {
            let other = mesh.face(face).across(ElementId::new(element));
            if other.is_none_or(|other| region[other.index()] != region[element]) {
                found[region[element]].edges.push([1, 2].map(|p| cell[(k + p) % 3].index()));
            }
        }
    }
    (region, found)
}

/// The edges of the boundary and between regions.
fn edges(mesh: &Mesh, region: &[usize]) -> Vec<Edge> {
    let mut names: BTreeMap<FaceId, BTreeSet<String>> = BTreeMap::new();
    for (name, faces) in mesh.face_groups() {
        faces.iter().for_each(|face| _ = names.entry(*face).or_default().insert(name.clone()));
    }
    let edge = |(number, face): (usize, Face<'_>)| {
        let beside = [Some(face.owner), face.neighbour].into_iter().flatten().map(|e| region[e.index()]);
        let beside: BTreeSet<usize> = beside.collect();
        let groups = names.get(&FaceId::new(number)).cloned().unwrap_or_default();
        let nodes = [face.nodes[0].index(), face.nodes[1].index()];
        (face.neighbour.is_none() || beside.len() > 1).then(|| Edge { nodes: sorted(nodes), kind: (beside, groups) })
    };
    mesh.faces().enumerate().filter_map(edge).collect()
}

/// The nodes of each straight curve of edges of one kind.
fn curves(mesh: &Mesh, edges: &[Edge]) -> Vec<Vec<usize>> {
    let mut at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (number, edge) in edges.iter().enumerate() {
        edge.nodes.iter().for_each(|node| at.entry(*node).or_default().push(number));
    }
    let other = |edge: usize, node: usize| edges[edge].nodes[usize::from(edges[edge].nodes[0] == node)];
    let is_corner = |node: usize| {
        let [first, second] = at[&node].as_slice() else { return true };
        let (here, ends) = (place(mesh, node), [other(*first, node), other(*second, node)].map(|end| place(mesh, end)));
        let [u, w] = ends.map(|end| [end[0] - here[0], end[1] - here[1]]);
        let sine = (u[0] * w[1] - u[1] * w[0]) / (u[0].hypot(u[1]) * w[0].hypot(w[1]));
        edges[*first].kind != edges[*second].kind || sine.abs() > STRAIGHT
    };
    let mut used = vec![false; edges.len()];
    let mut curves = Vec::new();
    for (&start, around) in &at {
        for &first in around.iter().filter(|_| is_corner(start)) {
            if used[first] {
                continue;
            }
            let (mut nodes, mut edge) = (vec![start], first);
            loop {
                used[edge] = true;
                let end = other(edge, nodes[nodes.len() - 1]);
                nodes.push(end);
                if is_corner(end) {
                    break;
                }
                edge = at[&end][usize::from(at[&end][0] == edge)];
            }
            curves.push(nodes);
        }
    }
    curves
}

/// The closed polygons of a region, the outer one first; none where it touches itself in a node.
fn polygons(mesh: &Mesh, region: &Region) -> Option<Vec<Vec<usize>>> {
    let mut next: BTreeMap<usize, usize> = BTreeMap::new();
    for [from, to] in &region.edges {
        if next.insert(*from, *to).is_some() {
            return None;
        }
    }
    let mut polygons = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut nodes = vec![start];
        let mut at = start;
        while let Some(to) = next.remove(&at) {
            at = to;
            nodes.push(at);
        }
        let cross = |pair: &[usize]| {
            let [p, q] = [pair[0], pair[1]].map(|node| place(mesh, node));
            p[0] * q[1] - p[1] * q[0]
        };
        polygons.push((nodes.windows(2).map(cross).sum::<f64>(), nodes));
    }
    polygons.sort_by(|a, b| b.0.total_cmp(&a.0));
    Some(polygons.into_iter().map(|(_, nodes)| nodes).collect())
}

/// The numbers of the lines along a closed polygon.
fn lines(nodes: &[usize], of_edge: &BTreeMap<[usize; 2], i64>) -> Option<String> {
    let each = nodes.windows(2).map(|pair| of_edge.get(&[pair[0], pair[1]]).copied());
    let mut numbers = each.collect::<Option<Vec<i64>>>()?;
    numbers.dedup();
    // The polygon may begin inside a line.
    if numbers.len() > 1 && numbers.first() == numbers.last() {
        numbers.pop();
    }
    Some(numbers.iter().map(i64::to_string).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};

    fn count(text: &str, start: &str) -> usize {
        text.lines().filter(|line| line.starts_with(start)).count()
    }

    #[test]
    fn a_rectangle_has_four_lines_with_its_groups() {
        let text = outline(&Mesh::rectangle(0.05, 0.04, 5, 4).unwrap()).unwrap();
        assert_eq!(["Point", "Line", "Curve Loop", "Plane"].map(|start| count(&text, start)), [4, 4, 1, 1]);
        assert_eq!(["Physical Curve", "Physical Surface(\"body\")"].map(|start| count(&text, start)), [4, 1]);
        assert!(text.contains("Point(6) = {0.05, 0.0, 0};"), "{text}");
        assert!(outline(&Mesh::uniform_bar(1.0, 4).unwrap()).is_none());
    }

    /// A frame in two materials: the boundary between them is one line of both, and the hole is a loop of its own or,
    /// where the materials share it, part of both outer ones.
    #[test]
    fn materials_share_their_lines() {
        let whole = Mesh::rectangle(6.0, 5.0, 6, 5).unwrap();
        let middle = |e: usize| {
            let p = whole.corners::<2, 3>(ElementId::new(e));
            [0, 1].map(|c| p.iter().map(|p| p[c]).sum::<f64>() / 3.0)
        };
        let kept = |e: &usize| !((1.0..5.0).contains(&middle(*e)[0]) && (1.0..2.0).contains(&middle(*e)[1]));
        let elements: Vec<usize> = (0..whole.element_count()).filter(kept).collect();
        let cells: Vec<_> = elements.iter().map(|e| whole.nodes_of::<3>()[*e].map(|n| n.index())).collect();
        let upper = (0..cells.len()).filter(|k| middle(elements[*k])[1] > 3.0).collect();
        let groups = ElementGroups::from([("upper".to_string(), upper)]);
        let mesh = Mesh::new(whole.points_in::<2>().to_vec(), &cells, &FaceGroups::new(), &groups).unwrap();
        let text = outline(&mesh).unwrap();
        // The outer corners, both ends of the boundary between the materials, the hole.
        assert_eq!(["Point", "Line", "Curve Loop", "Plane"].map(|start| count(&text, start)), [10, 11, 3, 2]);
        assert!(text.contains("Physical Surface(\"upper\")") && text.contains("Physical Surface(\"body\")"));
        let line = |text: &str, start: &str| text.lines().find(|line| line.starts_with(start)).unwrap().to_string();
        let numbers = |line: &str| line.matches(',').count() + 1;
        assert_eq!(
            ["Curve Loop(1)", "Curve Loop(2)", "Curve Loop(3)"].map(|start| numbers(&line(&text, start))),
            [4, 4, 4]
        );
    }
}
