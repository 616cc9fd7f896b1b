//! Stresses that are quadratic on the three triangles around a centroid.

use super::reference::{COEFFICIENTS, at, barycentric_gradients, quadratic_mass};

/// Monomials up to degree 2 about the origin: 1, x, y, x², xy, y².
pub(crate) const MONOMIALS: usize = 6;

/// A stress of a macro-element.
#[derive(Clone, Debug)]
pub(crate) struct PiecewiseStress {
    pub(super) parts: [[[f64; 2]; 3]; 3],
    pub(super) values: [f64; COEFFICIENTS],
}

impl PiecewiseStress {
    /// ∫mτ (11, 22, 12) for each monomial m.
    pub(crate) fn moments(&self) -> [[f64; 3]; MONOMIALS] {
        let mut moments = [[0.0; 3]; MONOMIALS];
        for (sub, triangle) in self.parts.iter().enumerate() {
            let area = area(triangle);
            for (node, row) in quadratic_mass().iter().enumerate() {
                for (m, monomial) in monomials(place(triangle, node)).into_iter().enumerate() {
                    for c in 0..3 {
                        let mean: f64 = (0..6).map(|n| row[n] * self.values[at(sub, n, c)]).sum();
                        moments[m][c] += area * monomial * mean;
                    }
                }
            }
        }
        moments
    }

    /// The coefficients of the monomials in the stress (11, 22, 12) of one part.
    pub(crate) fn polynomials(&self, part: usize) -> [[f64; 3]; MONOMIALS] {
        let triangle = &self.parts[part];
        let gradients = barycentric_gradients(triangle);
        // Barycentric coordinates as 1, x, y.
        let linear: [[f64; 3]; 3] = std::array::from_fn(|i| {
            let [gx, gy] = gradients[i];
            let [x, y] = triangle[(i + 1) % 3];
            [-gx * x - gy * y, gx, gy]
        });
        let mut coefficients = [[0.0; 3]; MONOMIALS];
        for node in 0..6 {
            let (a, b, factor) = if node < 3 { (node, node, 2.0) } else { (node - 3, (node - 2) % 3, 4.0) };
            let mut shape = product(&linear[a], &linear[b]).map(|x| factor * x);
            if node < 3 {
                (0..3).for_each(|k| shape[k] -= linear[node][k]);
            }
            for (sums, shape) in coefficients.iter_mut().zip(shape) {
                (0..3).for_each(|c| sums[c] += shape * self.values[at(part, node, c)]);
            }
        }
        coefficients
    }
}

fn area([a, b, c]: &[[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]))
}

/// A node of a quadratic triangle: a corner, or the middle of a side.
fn place(corners: &[[f64; 2]; 3], m: usize) -> [f64; 2] {
    std::array::from_fn(|c| if m < 3 { corners[m][c] } else { 0.5 * (corners[m - 3][c] + corners[(m - 2) % 3][c]) })
}

fn monomials([x, y]: [f64; 2]) -> [f64; MONOMIALS] {
    [1.0, x, y, x * x, x * y, y * y]
}

/// The product of two linear functions, each given by its coefficients of 1, x and y.
fn product([a, b, c]: &[f64; 3], [d, e, f]: &[f64; 3]) -> [f64; MONOMIALS] {
    [a * d, a * e + b * d, a * f + c * d, b * e, b * f + c * e, c * f]
}
