//! The meshes of the block: structured, shuffled, unstructured.

use crate::Failure;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_testkit::{Random, random_rectangle};
use std::str::FromStr;

/// Width and height of the block (m).
const SIDES: [f64; 2] = [0.05, 0.04];

/// Seed of permutations and of random points.
const SEED: u64 = 13;

/// Kind and numbering of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Cells in rows, each cut into two triangles.
    Structured,
    /// The same triangles, with nodes and elements numbered at random.
    Shuffled,
    /// A Delaunay triangulation of about as many triangles, with nodes and elements numbered as the mesher gave them.
    Delaunay,
}

impl Order {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Structured, Self::Shuffled, Self::Delaunay];

    /// The name on the command line and in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Structured => "structured",
            Self::Shuffled => "shuffled",
            Self::Delaunay => "delaunay",
        }
    }

    /// A mesh of the block with `nx` × `ny` cells of two triangles, or about as many.
    ///
    /// # Errors
    /// No cells, or no triangulation without small angles.
    pub fn mesh(self, [nx, ny]: [usize; 2]) -> Result<Mesh, Failure> {
        let [width, height] = SIDES;
        match self {
            Self::Structured => Ok(Mesh::rectangle(width, height, nx, ny)?),
            Self::Shuffled => shuffled(&Mesh::rectangle(width, height, nx, ny)?),
            Self::Delaunay => Ok(random_rectangle(width, height, nx, SEED)?),
        }
    }
}

impl FromStr for Order {
    type Err = Failure;

    fn from_str(name: &str) -> Result<Self, Failure> {
        let found = Self::ALL.into_iter().find(|order| order.name() == name);
        found.ok_or_else(|| format!("\"{name}\" is no order; choose structured, shuffled or delaunay").into())
    }
}

/// The mesh with nodes and elements in random order.
fn shuffled(mesh: &Mesh) -> Result<Mesh, Failure> {
    let mut random = Random::new(SEED);
    let new_node = random.permutation(mesh.node_count());
    let mut points = vec![[0.0; 2]; mesh.node_count()];
    for (point, &new) in mesh.points_in::<2>().iter().zip(&new_node) {
        points[new] = *point;
    }
    let elements = random.permutation(mesh.element_count());
    let cells: Vec<_> = elements.iter().map(|&e| mesh.nodes_of::<3>()[e].map(|node| new_node[node.index()])).collect();
    Ok(Mesh::new(points, &cells, &FaceGroups::new(), &ElementGroups::new())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back() {
        for order in Order::ALL {
            assert_eq!(order.name().parse::<Order>().unwrap(), order);
        }
        assert!("random".parse::<Order>().is_err());
    }

    /// The shuffled mesh has the triangles of the structured one, by their centroids.
    #[test]
    fn shuffling_keeps_the_triangles() {
        let centroids = |order: Order| {
            let mesh = order.mesh([5, 4]).unwrap();
            let places = mesh.nodes_of::<3>().iter().map(|cell| {
                let sum = |c: usize| cell.iter().map(|n| mesh.points_in::<2>()[n.index()][c]).sum::<f64>();
                // Micrometres: neighbouring centroids are 3 mm apart.
                [0, 1].map(|c| (sum(c) / 3.0 * 1e6).round() as i64)
            });
            places.collect::<Vec<_>>()
        };
        let (mut plain, mut mixed) = (centroids(Order::Structured), centroids(Order::Shuffled));
        assert_ne!(plain, mixed);
        plain.sort_unstable();
        mixed.sort_unstable();
        assert_eq!(plain, mixed);
    }
}
