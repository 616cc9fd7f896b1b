//! The elements, in the bytes that sweeps over the motions need, and the sweeps over some of them.

use super::{LUMPED, MOTIONS, NodalLanes};
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;
use std::ops::Range;

/// One element.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell<const D: usize, const N: usize> {
    pub(super) nodes: [u32; N],
    law: u32,
    /// √V ∇φ_i of all nodes but the first, V the volume (m³); the gradients sum to zero.
    gradients: [[f64; D]; D],
    /// m/(D+2), m the mass of the element (kg).
    pub(super) share: f64,
}

/// λ and G of σ = λ tr ε 1 + 2G ε (Pa).
#[derive(Clone, Copy, Debug)]
struct Moduli {
    lambda: f64,
    shear: f64,
}

/// A tensor of each motion.
pub(super) type LaneTensor<const D: usize> = [[[f64; MOTIONS]; D]; D];

/// All elements.
#[derive(Clone, Debug)]
pub(super) struct Cells<const D: usize, const N: usize> {
    pub(super) cells: Vec<Cell<D, N>>,
    laws: Vec<Moduli>,
}

impl<const D: usize, const N: usize> Cells<D, N> {
    pub(super) fn new(problem: &Problem<D, N>) -> Self {
        let cell = |(e, nodes): (usize, &[percute_core::ids::NodeId; N])| {
            let id = ElementId::new(e);
            let (volume, all) = (problem.volume(id), problem.mesh().cell_geometry(id).gradients);
            let root = volume.sqrt();
            Cell {
                nodes: nodes.map(|n| n.index() as u32),
                law: u32::from(problem.element_material()[e]),
                gradients: std::array::from_fn(|i| all[i + 1].map(|g| root * g)),
                share: problem.material(id).density() * volume / (D + 2) as f64,
            }
        };
        let cells = problem.mesh().cells().iter().enumerate().map(cell).collect();
        Self { cells, laws: problem.materials().iter().map(Moduli::new::<D>).collect() }
    }

    /// Subtracts K x from `forces` (N), element by element.
    #[inline(always)]
    pub(super) fn subtract_stiffness(&self, elements: Range<usize>, x: &[NodalLanes<D>], forces: &mut [NodalLanes<D>]) {
        for cell in &self.cells[elements] {
            let values = cell.nodes.map(|n| x[n as usize].0);
            let stress = self.stress(cell, &self.gradient(cell, &values));
            cell.subtract(&stress, forces);
        }
    }

    /// The same of one element, whose forces go to its own nodes in their order.
    pub(super) fn subtract_element(
        &self,
        cell: &Cell<D, N>,
        values: &[[[f64; MOTIONS]; D]; N],
        forces: &mut [NodalLanes<D>],
    ) {
        let stress = self.stress(cell, &self.gradient(cell, values));
        let own = Cell { nodes: std::array::from_fn(|i| i as u32), ..*cell };
        own.subtract(&stress, forces);
    }

    /// The same, and adds (M − M_c) x of the first motions (N).
    #[inline(always)]
    pub(super) fn subtract_both(
        &self,
        elements: Range<usize>,
        x: &[NodalLanes<D>],
        forces: &mut [NodalLanes<D>],
        lumping: &mut [NodalLumping<D>],
    ) {
        for cell in &self.cells[elements] {
            let values = cell.nodes.map(|n| x[n as usize].0);
            let lumped = values.map(|value| value.map(first));
            cell.add_lumping(&lumped, lumping);
            let stress = self.stress(cell, &self.gradient(cell, &values));
            cell.subtract(&stress, forces);
        }
    }

    /// Adds (M − M_c) x (N) for x the first field and the sums the second.
    #[inline(always)]
    pub(super) fn add_lumping(&self, elements: Range<usize>, x: &[NodalLumping<D>], sums: &mut [NodalLumping<D>]) {
        for cell in &self.cells[elements] {
            let values = cell.nodes.map(|n| x[n as usize].0);
            cell.add_lumping(&values, sums);
        }
    }

    /// √V ∂x_a/∂x_b, from differences with the first node: a translation leaves no rounding.
    #[inline(always)]
    pub(super) fn gradient(&self, cell: &Cell<D, N>, values: &[[[f64; MOTIONS]; D]; N]) -> LaneTensor<D> {
        let mut gradient = [[[0.0; MOTIONS]; D]; D];
        for i in 1..N {
            for a in 0..D {
                let mut difference = [0.0; MOTIONS];
                (0..MOTIONS).for_each(|l| difference[l] = values[i][a][l] - values[0][a][l]);
                for b in 0..D {
                    (0..MOTIONS).for_each(|l| gradient[a][b][l] += difference[l] * cell.gradients[i - 1][b]);
                }
            }
        }
        gradient
    }

    /// √V σ.
    #[inline(always)]
    pub(super) fn stress(&self, cell: &Cell<D, N>, gradient: &LaneTensor<D>) -> LaneTensor<D> {
        let Moduli { lambda, shear } = self.laws[cell.law as usize];
        let mut stress = [[[0.0; MOTIONS]; D]; D];
        let mut trace = [0.0; MOTIONS];
        for a in 0..D {
            (0..MOTIONS).for_each(|l| trace[l] += gradient[a][a][l]);
        }
        for a in 0..D {
            for b in a..D {
                let mut value = [0.0; MOTIONS];
                (0..MOTIONS).for_each(|l| value[l] = shear * (gradient[a][b][l] + gradient[b][a][l]));
                if a == b {
                    (0..MOTIONS).for_each(|l| value[l] += lambda * trace[l]);
                }
                stress[a][b] = value;
                stress[b][a] = value;
            }
        }
        stress
    }
}

/// The values of the motions whose mass is corrected, and later (M⁻¹(M − M_c)) of them.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct NodalLumping<const D: usize>(pub(super) [[f64; LUMPED]; D]);

impl<const D: usize> NodalLumping<D> {
    pub(super) const ZERO: Self = Self([[0.0; LUMPED]; D]);
}

#[inline(always)]
fn first(lanes: [f64; MOTIONS]) -> [f64; LUMPED] {
    std::array::from_fn(|l| lanes[l])
}

impl<const D: usize, const N: usize> Cell<D, N> {
    #[inline(always)]
    fn subtract(&self, stress: &LaneTensor<D>, forces: &mut [NodalLanes<D>]) {
        let mut sum = [[0.0; MOTIONS]; D];
        for i in 1..N {
            let slot = &mut forces[self.nodes[i] as usize];
            let mut value = slot.0;
            for a in 0..D {
                let mut force = [0.0; MOTIONS];
                for b in 0..D {
                    (0..MOTIONS).for_each(|l| force[l] += stress[a][b][l] * self.gradients[i - 1][b]);
                }
                (0..MOTIONS).for_each(|l| value[a][l] -= force[l]);
                (0..MOTIONS).for_each(|l| sum[a][l] += force[l]);
            }
            slot.0 = value;
        }
        let slot = &mut forces[self.nodes[0] as usize];
        let mut value = slot.0;
        for a in 0..D {
            (0..MOTIONS).for_each(|l| value[a][l] += sum[a][l]);
        }
        slot.0 = value;
    }

    /// An element gives m/(D+2) times the distance to the mean of its nodes.
    #[inline(always)]
    fn add_lumping(&self, values: &[[[f64; LUMPED]; D]; N], sums: &mut [NodalLumping<D>]) {
        let mut mean = [[0.0; LUMPED]; D];
        for value in values {
            for c in 0..D {
                (0..LUMPED).for_each(|l| mean[c][l] += value[c][l]);
            }
        }
        for c in 0..D {
            (0..LUMPED).for_each(|l| mean[c][l] *= 1.0 / N as f64);
        }
        for (n, value) in self.nodes.iter().zip(values) {
            let slot = &mut sums[*n as usize];
            let mut sum = slot.0;
            for c in 0..D {
                (0..LUMPED).for_each(|l| sum[c][l] += self.share * (value[c][l] - mean[c][l]));
            }
            slot.0 = sum;
        }
    }
}

impl Moduli {
    /// Those of a law, from its stress under unit gradients.
    fn new<const D: usize>(law: &impl Law) -> Self {
        let stress = |a: usize, b: usize| {
            let mut gradient = [[0.0; D]; D];
            gradient[a][b] = 1.0;
            law.stress(&gradient)
        };
        match D {
            1 => Self { lambda: 0.0, shear: 0.5 * stress(0, 0)[0][0] },
            _ => Self { lambda: stress(0, 0)[1][1], shear: stress(0, 1)[0][1] },
        }
    }
}
