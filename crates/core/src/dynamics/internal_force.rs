//! Internal forces of the P1 elements, ∫σ_h ∇φ_i.

use crate::ids::{ElementId, NodeId};
use crate::material::{Elastic, Law, LinearLaw};
use crate::problem::Problem;

/// One element, in the 48 bytes (in 2D) that its internal forces need: the sweep over a large
/// mesh waits for memory, so nothing else is stored.
#[derive(Clone, Copy, Debug)]
struct Cell<const D: usize, const N: usize> {
    nodes: [NodeId; N],
    material: u32,
    /// √|E| ∇φ_i of all nodes but the first; the gradients sum to zero.
    gradients: [[f64; D]; D],
}

/// The stiffness of a problem, applied element by element. Its scaled gradients are valid for linear laws only.
#[derive(Clone, Debug)]
pub struct Stiffness<const D: usize, const N: usize, L: LinearLaw = Elastic> {
    cells: Vec<Cell<D, N>>,
    laws: Vec<L>,
}

impl<const D: usize, const N: usize> Stiffness<D, N> {
    /// Prepares the elements of a problem.
    #[must_use]
    pub fn new(problem: &Problem<D, N>) -> Self {
        let cell = |(e, nodes): (usize, &[NodeId; N])| {
            let element = ElementId::new(e);
            let root = problem.volume(element).sqrt();
            let geometry = problem.mesh().cell_geometry(element);
            let mut gradients = [[0.0; D]; D];
            for i in 1..N {
                gradients[i - 1] = geometry.gradients[i].map(|g| root * g);
            }
            Cell { nodes: *nodes, material: u32::from(problem.element_material()[e]), gradients }
        };
        Self {
            cells: problem.mesh().cells().iter().enumerate().map(cell).collect(),
            laws: problem.materials().to_vec(),
        }
    }
}

impl<const D: usize, const N: usize, L: LinearLaw> Stiffness<D, N, L> {
    /// Subtracts K u from `force` (N) and returns the strain energy ½ u·K u (J).
    pub fn subtract_internal_forces(&self, displacement: &[[f64; D]], force: &mut [[f64; D]]) -> f64 {
        let mut energy = 0.0;
        for cell in &self.cells {
            // √|E| ∇u, from differences with the first node: a translation leaves no rounding.
            let first = displacement[cell.nodes[0].index()];
            let mut gradient = [[0.0; D]; D];
            for i in 1..N {
                let value = displacement[cell.nodes[i].index()];
                for a in 0..D {
                    for b in 0..D {
                        gradient[a][b] += (value[a] - first[a]) * cell.gradients[i - 1][b];
                    }
                }
            }
            let stress = self.laws[cell.material as usize].stress(&gradient);
            let mut sum = [0.0; D];
            for i in 1..N {
                let slot = &mut force[cell.nodes[i].index()];
                for a in 0..D {
                    let mut f = 0.0;
                    for b in 0..D {
                        f += stress[a][b] * cell.gradients[i - 1][b];
                    }
                    slot[a] -= f;
                    sum[a] += f;
                }
            }
            let slot = &mut force[cell.nodes[0].index()];
            for a in 0..D {
                slot[a] += sum[a];
                for b in 0..D {
                    energy += stress[a][b] * gradient[a][b];
                }
            }
        }
        0.5 * energy
    }

    /// Largest ω² of any element alone with its lumped mass (1/s²): a bound on that of the mesh.
    #[must_use]
    pub(super) fn element_bound(&self, problem: &Problem<D, N>) -> f64 {
        let mut largest: f64 = 0.0;
        for (e, cell) in self.cells.iter().enumerate() {
            let element = ElementId::new(e);
            let share = problem.material(element).density() * problem.volume(element) / N as f64;
            largest = largest.max(self.element_eigenvalue(cell) / share);
        }
        largest
    }

    /// Largest eigenvalue of one element's stiffness matrix (N/m).
    fn element_eigenvalue(&self, cell: &Cell<D, N>) -> f64 {
        let law = &self.laws[cell.material as usize];
        let mut all = [[0.0; D]; N];
        for i in 1..N {
            all[i] = cell.gradients[i - 1];
            (0..D).for_each(|b| all[0][b] -= all[i][b]);
        }
        let force = |j: usize, c: usize, i: usize, a: usize| -> f64 {
            let mut gradient = [[0.0; D]; D];
            gradient[c] = all[j];
            (0..D).map(|b| law.tangent(&[[0.0; D]; D], &gradient)[a][b] * all[i][b]).sum()
        };
        let stiffness = nalgebra::DMatrix::from_fn(N * D, N * D, |r, s| force(s / D, s % D, r / D, r % D));
        stiffness.symmetric_eigenvalues().max()
    }
}
