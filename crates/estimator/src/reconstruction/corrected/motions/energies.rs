//! Energies of the differences of the motions: ½x·Kx + ½y·M_c y of a difference of displacements x and of velocities y.

use super::blocks::Blocks;
use super::cells::{Cells, LaneTensor};
use super::{Fields, MOTIONS, NodalLanes};
use crate::difference::Difference;
use crate::element::Element;
use crate::inertia::mass_product;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;
use std::ops::Range;

/// The energies need the elements with a node that may touch apart.
#[derive(Debug)]
pub(super) struct Energies<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    near: Vec<(ElementId, Element<D, N>)>,
}

/// Twice the energies of the differences of the simulation, the half-size and the half-step solution from the auxiliary
/// solution, and of the contact difference; and the product of the first and the last (J).
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    squares: [f64; MOTIONS],
    product: f64,
}

impl<'p, const D: usize, const N: usize> Energies<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, elements: &[Element<D, N>]) -> Self {
        let mut touches = vec![false; problem.mesh().node_count()];
        problem.surface().nodes().iter().for_each(|contact| touches[contact.node.index()] = true);
        let near = elements.iter().enumerate().filter(|(_, e)| e.nodes.iter().any(|n| touches[n.index()]));
        Self { problem, near: near.map(|(e, element)| (ElementId::new(e), *element)).collect() }
    }

    /// The energies with these displacements (m) and velocities (m/s) of the simulation. The fields of the motions that the next
    /// pass makes anew are overwritten.
    #[inline(always)]
    pub(super) fn measure(
        &self,
        cells: &Cells<D, N>,
        blocks: &Blocks,
        mass: &[f64],
        fields: &mut Fields<D>,
        [displacement, velocity]: [&[[f64; D]]; 2],
    ) -> Difference {
        let mut sums = Sums::default();
        for k in 0..blocks.pairs() {
            let range = blocks.begun(k);
            let nodes = range.clone();
            for ((x, u), simulated) in fields.internal[nodes.clone()]
                .iter_mut()
                .zip(&fields.displacement[nodes.clone()])
                .zip(&displacement[nodes.clone()])
            {
                *x = difference(u, simulated);
            }
            for (y, simulated) in fields.rate[nodes.clone()].iter_mut().zip(&velocity[nodes]) {
                *y = difference(y, simulated);
            }
            // An element gives m/((D+1)(D+2)) (Σy_i·z_i + Σy_i·Σz_i); the first sum is of nodes.
            sums.add_nodes(&fields.rate[range.clone()], &mass[range], 1.0 / (D + 2) as f64);
            for elements in blocks.pair(k) {
                sums.add_elements(cells, elements, &fields.internal, &fields.rate);
            }
        }
        let [energy, half_size, half_step, square] = sums.squares.map(|twice| 0.5 * twice);
        let contact = 0.5 * sums.product;
        let dispersion = energy - 2.0 * contact + square;
        let near = self.near(&fields.internal, &fields.rate);
        Difference { energy, near, contact, dispersion, half_size, half_step, halvings: [0.0; 2] }
    }

    /// The energy of the first difference in the elements with a node that may touch (J).
    fn near(&self, x: &[NodalLanes<D>], y: &[NodalLanes<D>]) -> f64 {
        let energy = |(id, element): &(ElementId, Element<D, N>)| {
            let gather = |field: &[NodalLanes<D>]| element.nodes.map(|n| field[n.index()].0.map(|lanes| lanes[0]));
            let gradient = element.gradient(&gather(x));
            let stress = self.problem.material(*id).stress(&gradient);
            let work: f64 = (0..D).map(|a| (0..D).map(|b| stress[a][b] * gradient[a][b]).sum::<f64>()).sum();
            let velocity = gather(y);
            0.5 * (element.volume * work + mass_product(N as f64 * element.nodal_mass, &velocity, &velocity))
        };
        self.near.iter().map(energy).sum()
    }
}

/// What is added up, as lanes: the differences from the auxiliary solution, and the contact difference as it is.
#[inline(always)]
fn difference<const D: usize>(motions: &NodalLanes<D>, simulated: &[f64; D]) -> NodalLanes<D> {
    NodalLanes(std::array::from_fn(|c| {
        let [auxiliary, half_size, half_step, contact] = motions.0[c];
        [simulated[c] - auxiliary, half_size - auxiliary, half_step - auxiliary, contact]
    }))
}

impl Sums {
    #[inline(always)]
    fn add(&mut self, weight: f64, a: &[f64; MOTIONS], b: &[f64; MOTIONS]) {
        (0..MOTIONS).for_each(|l| self.squares[l] += weight * (a[l] * b[l]));
        self.product += weight * (a[0] * b[MOTIONS - 1]);
    }

    #[inline(always)]
    fn add_nodes<const D: usize>(&mut self, y: &[NodalLanes<D>], mass: &[f64], scale: f64) {
        let mut sums = *self;
        for (y, mass) in y.iter().zip(mass) {
            (0..D).for_each(|c| sums.add(scale * mass, &y.0[c], &y.0[c]));
        }
        *self = sums;
    }

    #[inline(always)]
    fn add_elements<const D: usize, const N: usize>(
        &mut self,
        cells: &Cells<D, N>,
        elements: Range<usize>,
        x: &[NodalLanes<D>],
        y: &[NodalLanes<D>],
    ) {
        let mut sums = *self;
        for cell in &cells.cells[elements] {
            let gradient: LaneTensor<D> = cells.gradient(cell, &cell.nodes.map(|n| x[n as usize].0));
            let stress = cells.stress(cell, &gradient);
            let velocity = cell.nodes.map(|n| y[n as usize].0);
            for a in 0..D {
                (0..D).for_each(|b| sums.add(1.0, &stress[a][b], &gradient[a][b]));
                let mut sum = [0.0; MOTIONS];
                for value in &velocity {
                    (0..MOTIONS).for_each(|l| sum[l] += value[a][l]);
                }
                sums.add(cell.share * (1.0 / N as f64), &sum, &sum);
            }
        }
        *self = sums;
    }
}
