//! The measure of all ratios: one product K·u in compressed sparse rows.

use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;

/// K in compressed sparse rows, as a sparse library stores it: 32-bit columns, rows in order.
#[derive(Clone, Debug)]
pub struct Csr {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Csr {
    /// Assembles K (N/m).
    #[must_use]
    pub fn assemble(problem: &Problem<2>) -> Self {
        let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); 2 * problem.mesh().node_count()];
        for (e, cell) in problem.mesh().nodes_of::<3>().iter().enumerate() {
            let matrix = element_matrix(problem, ElementId::new(e));
            for (i, row) in cell.iter().enumerate() {
                for (j, column) in cell.iter().enumerate() {
                    for (a, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        let place = (2 * column.index() + c) as u32;
                        add(&mut rows[2 * row.index() + a], place, matrix[2 * i + a][2 * j + c]);
                    }
                }
            }
        }
        let mut csr = Self { starts: vec![0], columns: Vec::new(), values: Vec::new() };
        for mut row in rows {
            row.sort_unstable_by_key(|(column, _)| *column);
            csr.columns.extend(row.iter().map(|(column, _)| *column));
            csr.values.extend(row.iter().map(|(_, value)| *value));
            csr.starts.push(csr.columns.len());
        }
        csr
    }

    /// y = K x. Never inlined: every ratio refers to it, so its code must not depend on the caller.
    #[inline(never)]
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        for (row, y) in self.starts.windows(2).zip(y) {
            let mut sum = 0.0;
            // An iterator's `sum` takes half as long again as this loop, which is as fast as SciPy's.
            for (&column, value) in self.columns[row[0]..row[1]].iter().zip(&self.values[row[0]..row[1]]) {
                sum += value * x[column as usize];
            }
            *y = sum;
        }
    }
}

/// The stiffness matrix of an element (N/m): its columns are the forces of unit displacements.
fn element_matrix(problem: &Problem<2>, element: ElementId) -> [[f64; 6]; 6] {
    let (volume, gradients) = (problem.volume(element), problem.mesh().geometry::<2, 3>(element).gradients);
    let mut matrix = [[0.0; 6]; 6];
    for j in 0..3 {
        for c in 0..2 {
            let mut gradient = [[0.0; 2]; 2];
            gradient[c] = gradients[j];
            let stress = problem.material(element).stress(&gradient);
            for i in 0..3 {
                for a in 0..2 {
                    matrix[2 * i + a][2 * j + c] = (0..2).map(|b| volume * stress[a][b] * gradients[i][b]).sum();
                }
            }
        }
    }
    matrix
}

fn add(row: &mut Vec<(u32, f64)>, place: u32, value: f64) {
    match row.iter_mut().find(|(k, _)| *k == place) {
        Some((_, sum)) => *sum += value,
        None => row.push((place, value)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Block, Motion, Order, steps};
    use percute_core::dynamics::Dynamics;

    /// The product is that of the element loop: the ratios compare equal work.
    #[test]
    fn the_product_is_the_internal_force() {
        let block = Block::new([6, 5], Order::Delaunay, Motion::Free).unwrap();
        let times = steps(block.step, 1).unwrap();
        let u: Vec<f64> = (0..2 * block.problem.mesh().node_count()).map(|i| (i as f64).sin()).collect();
        let mut product = vec![0.0; u.len()];
        Csr::assemble(&block.problem).multiply(&u, &mut product);
        let nodal: Vec<[f64; 2]> = u.chunks_exact(2).map(|v| [v[0], v[1]]).collect();
        let mut force = vec![[0.0; 2]; nodal.len()];
        Dynamics::new(&block.problem, &times).forces(0, &nodal, &mut force);
        let scale = product.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for (f, k) in force.iter().flatten().zip(&product) {
            // Sums of some ten terms in another order.
            assert!((f + k).abs() < 1e-13 * scale);
        }
    }
}
