//! Meshes of the generators, known by their nodes, with another number of elements.

use super::{BarMesh, Diagonals, Mesh, TriangleMesh};
use std::f64::consts::TAU;

/// Nodes agree to this part of the size of a mesh: rounding of a mesh that was turned and moved.
const SAME: f64 = 1e-9;

/// A mesh that may have come from a generator.
pub trait Generated: Sized {
    /// The mesh of the same generator with elements that are smaller by about this factor: the outline of a disc comes
    /// nearer to its circle. None if the mesh did not come from a generator, was refined or has other groups.
    fn resized(&self, factor: f64) -> Option<Self>;
}

impl Generated for BarMesh {
    fn resized(&self, factor: f64) -> Option<Self> {
        let (elements, points) = (self.element_count(), self.points());
        let [start, end] = [points.first()?[0], points.last()?[0]];
        let bar = |elements| Self::uniform_bar(end - start, elements).ok();
        let moved = |mesh: Self| mesh.placed(&[start], 0.0).ok();
        same(self, &bar(elements).and_then(moved)?).then(|| bar(finer(elements, factor)).and_then(moved))?
    }
}

impl Generated for TriangleMesh {
    fn resized(&self, factor: f64) -> Option<Self> {
        rectangle(self, factor).or_else(|| disc(self, factor))
    }
}

/// The rectangle, which may be turned and moved.
fn rectangle(mesh: &TriangleMesh, factor: f64) -> Option<TriangleMesh> {
    let [nx, ny] = ["bottom", "left"].map(|side| mesh.facet_groups().get(side).map_or(0, Vec::len));
    let count = (nx + 1) * (ny + 1);
    if nx == 0 || ny == 0 || mesh.node_count() < count {
        return None;
    }
    let (origin, along, up) = (mesh.points()[0], mesh.points()[nx], mesh.points()[(nx + 1) * ny]);
    let [width, height] = [along, up].map(|end| (end[0] - origin[0]).hypot(end[1] - origin[1]));
    let turned = (along[1] - origin[1]).atan2(along[0] - origin[0]).to_degrees();
    let make = |[nx, ny]: [usize; 2], diagonals| {
        TriangleMesh::rectangle_cut(width, height, nx, ny, diagonals).ok()?.placed(&origin, turned).ok()
    };
    let (_, diagonals) = Diagonals::NAMES
        .into_iter()
        .find(|(_, diagonals)| make([nx, ny], *diagonals).is_some_and(|again| same(mesh, &again)))?;
    make([nx, ny].map(|cells| finer(cells, factor)), diagonals)
}

/// The disc, which may be turned and moved.
fn disc(mesh: &TriangleMesh, factor: f64) -> Option<TriangleMesh> {
    // 6 rings² elements.
    let rings = (mesh.element_count() as f64 / 6.0).sqrt().round() as usize;
    let lowest = mesh.points().get((3 * rings * rings.checked_sub(1)?) + 1)?;
    let centre = mesh.points()[0];
    let [x, y] = [lowest[0] - centre[0], lowest[1] - centre[1]];
    let turned = (x.atan2(-y).rem_euclid(TAU)).to_degrees();
    let make = |rings| TriangleMesh::disc(x.hypot(y), rings).ok()?.placed(&centre, turned).ok();
    same(mesh, &make(rings)?).then(|| make(finer(rings, factor)))?
}

fn finer(count: usize, factor: f64) -> usize {
    ((count as f64 * factor).round() as usize).max(1)
}

/// Whether two meshes have the same elements and groups, and nodes at the same places to rounding.
fn same<const D: usize, const N: usize>(a: &Mesh<D, N>, b: &Mesh<D, N>) -> bool {
    let near = |p: &[f64; D], q: &[f64; D]| (0..D).all(|c| (p[c] - q[c]).abs() <= SAME * a.size());
    a.cells() == b.cells()
        && a.facet_groups() == b.facet_groups()
        && a.element_groups() == b.element_groups()
        && a.node_count() == b.node_count()
        && a.points().iter().zip(b.points()).all(|(p, q)| near(p, q))
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
            let placed = |mesh: TriangleMesh| mesh.placed(&[x, y], turned).unwrap();
            let cut = |n: usize| TriangleMesh::rectangle_cut(width, height, n * nx, n * ny, Diagonals::NAMES[kind].1);
            let rectangle = placed(cut(1).unwrap());
            prop_assert!(same(&rectangle.resized(3.0).unwrap(), &placed(cut(3).unwrap())));
            let disc = |rings| placed(TriangleMesh::disc(width, rings).unwrap());
            prop_assert!(same(&disc(rings).resized(2.0).unwrap(), &disc(2 * rings)));
            let bar = |n| BarMesh::uniform_bar(width, n).unwrap().placed(&[x], 0.0).unwrap();
            prop_assert!(same(&bar(nx).resized(5.0).unwrap(), &bar(5 * nx)));
            prop_assert!(rectangle.refined().unwrap().resized(2.0).is_none());
            prop_assert!(disc(rings).refined_where(|e| e.index() == 0).unwrap().resized(2.0).is_none());
        }
    }
}
