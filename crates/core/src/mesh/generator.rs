//! Uniform bars and rectangles.

use super::{BarMesh, ElementGroups, FacetGroups, MeshError, TriangleMesh};

/// A length that must be positive and finite.
fn positive(name: &'static str, value: f64) -> Result<(), MeshError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(MeshError::Generator { name, value, allowed: "a positive length in metres" })
}

/// A number of elements that must not be zero, nor exceed what memory can hold.
fn count(name: &'static str, value: usize) -> Result<(), MeshError> {
    if (1..=20_000_000).contains(&value) {
        return Ok(());
    }
    Err(MeshError::Generator { name, value: value as f64, allowed: "a number of elements from 1 to 20 000 000" })
}

impl BarMesh {
    /// A bar from 0 to `length` (m) in `elements` equal elements; its end points are the groups
    /// `start` (at 0) and `end`.
    ///
    /// # Errors
    /// A length that is not positive, or no elements.
    pub fn uniform_bar(length: f64, elements: usize) -> Result<Self, MeshError> {
        positive("length", length)?;
        count("elements", elements)?;
        let points = (0..=elements).map(|i| [length * i as f64 / elements as f64]).collect();
        let cells: Vec<_> = (0..elements).map(|e| [e, e + 1]).collect();
        let groups = FacetGroups::from([("start".to_string(), vec![[0]]), ("end".to_string(), vec![[elements]])]);
        Self::new(points, &cells, &groups, &ElementGroups::new())
    }
}

impl TriangleMesh {
    /// The rectangle [0, width] × [0, height] (m) in nx × ny cells, each cut from its lower left
    /// to its upper right corner; its sides are the groups `left`, `right`, `bottom`, `top`.
    ///
    /// # Errors
    /// A length that is not positive, or no cells.
    pub fn rectangle(width: f64, height: f64, nx: usize, ny: usize) -> Result<Self, MeshError> {
        positive("width", width)?;
        positive("height", height)?;
        count("nx", nx)?;
        count("ny", ny)?;
        count("nx * ny", nx.saturating_mul(ny))?;
        let id = |i: usize, j: usize| j * (nx + 1) + i;
        let mut points = Vec::with_capacity((nx + 1) * (ny + 1));
        for j in 0..=ny {
            for i in 0..=nx {
                points.push([width * i as f64 / nx as f64, height * j as f64 / ny as f64]);
            }
        }
        let mut cells = Vec::with_capacity(2 * nx * ny);
        for j in 0..ny {
            for i in 0..nx {
                cells.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
                cells.push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
            }
        }
        let groups = FacetGroups::from([
            ("bottom".to_string(), (0..nx).map(|i| [id(i, 0), id(i + 1, 0)]).collect()),
            ("top".to_string(), (0..nx).map(|i| [id(i, ny), id(i + 1, ny)]).collect()),
            ("left".to_string(), (0..ny).map(|j| [id(0, j), id(0, j + 1)]).collect()),
            ("right".to_string(), (0..ny).map(|j| [id(nx, j), id(nx, j + 1)]).collect()),
        ]);
        Self::new(points, &cells, &groups, &ElementGroups::new())
    }
}
