//! Meshes of the generators, known by their nodes, with another number of elements.

use super::{Diagonals, Mesh};
use crate::cell::CellKind;
use crate::ids::NodeId;
use std::f64::consts::TAU;

/// Nodes agree to this part of the size of a mesh: rounding of a mesh that was turned and moved.
const SAME: f64 = 1e-9;

impl Mesh {
    /// The mesh of the same generator with elements that are smaller by about this factor: the outline of a disc comes
    /// nearer to its circle. None if the mesh did not come from a generator, was refined or has other groups.
    #[must_use]
    pub fn resized(&self, factor: f64) -> Option<Self> {
        match self.kind {
            CellKind::Bar => bar(self, factor),
            CellKind::Triangle => rectangle(self, factor).or_else(|| disc(self, factor)),
            CellKind::Tetrahedron => None,
        }
    }
}

/// The bar, which may be moved.
fn bar(mesh: &Mesh, factor: f64) -> Option<Mesh> {
    let (elements, points) = (mesh.element_count(), mesh.points());
    let [start, end] = [*points.first()?, *points.last()?];
    let make = |elements| Mesh::uniform_bar(end - start, elements).ok()?.placed(&[start, 0.0, 0.0], 0.0).ok();
    same(mesh, &make(elements)?).then(|| make(finer(elements, factor)))?
}

/// The rectangle, which may be turned and moved.
fn rectangle(mesh: &Mesh, factor: f64) -> Option<Mesh> {
    let [nx, ny] = ["bottom", "left"].map(|side| mesh.face_groups().get(side).map_or(0, Vec::len));
    let count = (nx + 1) * (ny + 1);
    if nx == 0 || ny == 0 || mesh.node_count() < count {
        return None;
    }
    let [origin, along, up] = [0, nx, (nx + 1) * ny].map(|node| mesh.point(NodeId::new(node)));
    let [width, height] = [along, up].map(|end| (end[0] - origin[0]).hypot(end[1] - origin[1]));
    let turned = (along[1] - origin[1]).atan2(along[0] - origin[0]).to_degrees();
    let make = |[nx, ny]: [usize; 2], diagonals| {
        Mesh::rectangle_cut(width, height, nx, ny, diagonals).ok()?.placed(&origin, turned).ok()
    };
    let (_, diagonals) = Diagonals::NAMES
        .into_iter()
        .find(|(_, diagonals)| make([nx, ny], *diagonals).is_some_and(|again| same(mesh, &again)))?;
    make([nx, ny].map(|cells| finer(cells, factor)), diagonals)
}

/// The disc, which may be turned and moved.
fn disc(mesh: &Mesh, factor: f64) -> Option<Mesh> {
    // 6 rings² elements.
    let rings = (mesh.element_count() as f64 / 6.0).sqrt().round() as usize;
    let [centre, lowest] = [0, (3 * rings * rings.checked_sub(1)?) + 1]
        .map(|node| (node < mesh.node_count()).then(|| mesh.point(NodeId::new(node))));
    let (centre, lowest) = (centre?, lowest?);
    let [x, y] = [lowest[0] - centre[0], lowest[1] - centre[1]];
    let turned = (x.atan2(-y).rem_euclid(TAU)).to_degrees();
    let make = |rings| Mesh::disc(x.hypot(y), rings).ok()?.placed(&centre, turned).ok();
    same(mesh, &make(rings)?).then(|| make(finer(rings, factor)))?
}

fn finer(count: usize, factor: f64) -> usize {
    ((count as f64 * factor).round() as usize).max(1)
}

/// Whether two meshes have the same elements and groups, and nodes at the same places to rounding.
fn same(a: &Mesh, b: &Mesh) -> bool {
    a.cell_rows() == b.cell_rows()
        && a.face_groups() == b.face_groups()
        && a.element_groups() == b.element_groups()
        && a.points().len() == b.points().len()
        && a.points().iter().zip(b.points()).all(|(p, q)| (p - q).abs() <= SAME * a.size())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A finer mesh of a generator that was turned and moved is that of the generator, turned and moved; a mesh
        /// that was refined comes from none.
        #[test]
        fn meshes_of_generators_are_known(
            [width, height, x, y] in [0.01..3.0_f64, 0.01..3.0, -1.0..1.0, -1.0..1.0],
            (nx, ny, rings, kind) in (2..7_usize, 2..7_usize, 1..6_usize, 0..3_usize),
            turned in -180.0..180.0_f64,
        ) {
            let placed = |mesh: Mesh| mesh.placed(&[x, y, 0.0], turned).unwrap();
            let cut = |n: usize| Mesh::rectangle_cut(width, height, n * nx, n * ny, Diagonals::NAMES[kind].1);
            let rectangle = placed(cut(1).unwrap());
            prop_assert!(same(&rectangle.resized(3.0).unwrap(), &placed(cut(3).unwrap())));
            let disc = |rings| placed(Mesh::disc(width, rings).unwrap());
            prop_assert!(same(&disc(rings).resized(2.0).unwrap(), &disc(2 * rings)));
            let bar = |n| Mesh::uniform_bar(width, n).unwrap().placed(&[x, 0.0, 0.0], 0.0).unwrap();
            prop_assert!(same(&bar(nx).resized(5.0).unwrap(), &bar(5 * nx)));
            prop_assert!(rectangle.refined().unwrap().resized(2.0).is_none());
            prop_assert!(disc(rings).refined_where(|e| e.index() == 0).unwrap().resized(2.0).is_none());
        }
    }
}
