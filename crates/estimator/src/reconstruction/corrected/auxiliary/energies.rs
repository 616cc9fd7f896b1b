//! Energies of the differences of the motions: ½x·Kx + ½y·M_c y of a difference of displacements x and of velocities y.

use super::blocks::Blocks;
use super::lanes::{Nodal, place};
use super::pairs::{Pairs, TrianglePair};
use super::parts::{Part, Plan, StartOf, View, for_all};
use super::sweeps::{differences, gradient, stress};
use super::{AuxiliaryLevel, MotionFields};
use crate::difference::Difference;
use crate::element::Element;
use crate::inertia::mass_product;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;
use percute_core::simd::{Registers, Task, run_task};
use std::ops::Range;

/// The energies need the elements with a node that may touch apart.
#[derive(Debug)]
pub(super) struct Energies<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D>,
    near: Vec<(ElementId, Element<D, N>)>,
}

impl<'p, const D: usize, const N: usize> Energies<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D>, elements: &[Element<D, N>]) -> Self {
        let mut touches = vec![false; problem.mesh().node_count()];
        problem.surface().nodes().iter().for_each(|contact| touches[contact.node.index()] = true);
        let near = elements.iter().enumerate().filter(|(_, e)| e.nodes.iter().any(|n| touches[n.index()]));
        Self { problem, near: near.map(|(e, element)| (ElementId::new(e), *element)).collect() }
    }

    /// The energies with these displacements (m) and velocities (m/s) of the simulation. The fields of the motions that
    /// the next pass makes anew are overwritten.
    pub(super) fn measure(
        &self,
        (pairs, blocks, plan): (&Pairs, &Blocks, (&Plan, StartOf<'_>)),
        fields: &mut MotionFields,
        simulated: [&[[f64; D]]; 2],
    ) -> Difference {
        let measure = Measure { pairs, blocks, mass: self.problem.mass(), simulated };
        let work = |part: &Part, view: View<'_, D>| run_task(PartMeasure { measure: &measure, part, view });
        let sums = for_all(plan, View::new(fields, AuxiliaryLevel::none()), &work);
        let [mut squares, mut products] = [[0.0; 8]; 2];
        for sum in &sums {
            (0..8).for_each(|i| squares[i] += sum[0][i]);
            (0..8).for_each(|i| products[i] += sum[1][i]);
        }
        let half = |motion: usize, of: &[f64; 8]| 0.5 * (of[place(motion, 0)] + of[place(motion, 1)]);
        let [energy, halved_elements, halved_step, square] = [0, 1, 2, 3].map(|motion| half(motion, &squares));
        let contact = half(0, &products);
        let dispersion = energy - 2.0 * contact + square;
        let near = self.near(&fields.internal, &fields.rate);
        Difference { energy, near, contact, dispersion, halved_elements, halved_step, halvings: [0.0; 2] }
    }

    /// The energy of the first difference in the elements with a node that may touch (J).
    fn near(&self, x: &[Nodal], y: &[Nodal]) -> f64 {
        let energy = |(id, element): &(ElementId, Element<D, N>)| {
            let gather = |field: &[Nodal]| element.nodes.map(|n| field[n.index()].of::<D>(0));
            let gradient = element.gradient(&gather(x));
            let stress = self.problem.material(*id).stress(&gradient);
            let work: f64 = (0..D).map(|a| (0..D).map(|b| stress[a][b] * gradient[a][b]).sum::<f64>()).sum();
            let velocity = gather(y);
            0.5 * (element.volume * work + mass_product(N as f64 * element.nodal_mass, &velocity, &velocity))
        };
        self.near.iter().map(energy).sum()
    }
}

/// Sums up, number by number, the squares of the differences of the simulation, the halved-elements and halved-step
/// solution from the auxiliary solution and of the contact difference: twice their energies (J). The second sum has the
/// products of the first and the last of these, and others.
#[derive(Clone, Copy)]
struct Measure<'a, const D: usize> {
    pairs: &'a Pairs,
    blocks: &'a Blocks,
    mass: &'a [f64],
    simulated: [&'a [[f64; D]]; 2],
}

/// The sums of one part.
struct PartMeasure<'a, 'v, const D: usize> {
    measure: &'a Measure<'a, D>,
    part: &'a Part,
    view: View<'v, D>,
}

/// The two sums.
struct Sums<R: Registers> {
    squares: R::Eight,
    products: R::Eight,
}

impl<const D: usize> Task for PartMeasure<'_, '_, D> {
    type Output = [[f64; 8]; 2];

    #[inline(always)]
    fn run<R: Registers>(self, r: R) -> Self::Output {
        let Self { measure, part, mut view } = self;
        let mut sums = Sums { squares: r.splat(0.0), products: r.splat(0.0) };
        for turn in part.turns() {
            if part.sweeps[0].contains(&turn) {
                measure.add_nodes(r, measure.blocks.begun(turn), &mut view, &mut sums);
                measure.add_elements(r, measure.blocks.even(turn), &view, &mut sums);
            }
            if part.done[0].contains(&turn) {
                measure.add_elements(r, measure.blocks.odd(turn), &view, &mut sums);
            }
        }
        [r.store(sums.squares), r.store(sums.products)]
    }
}

impl<const D: usize> Measure<'_, D> {
    /// The differences at nodes, and their part of y·My.
    #[inline(always)]
    fn add_nodes<R: Registers>(&self, r: R, nodes: Range<usize>, view: &mut View<'_, D>, sums: &mut Sums<R>) {
        let [displacement, velocity] = self.simulated;
        let range = view.local(&nodes);
        let x = view.internal[range.clone()].iter_mut().zip(&view.displacement[range.clone()]);
        for ((x, u), simulated) in x.zip(&displacement[nodes.clone()]) {
            *x = difference(u, simulated);
        }
        let y = view.rate[range].iter_mut().zip(&velocity[nodes.clone()]);
        for ((y, simulated), mass) in y.zip(&self.mass[nodes]) {
            *y = difference(y, simulated);
            let value = r.load(&y.0);
            let momentum = r.mul(value, r.splat(*mass));
            sums.squares = r.add(sums.squares, r.mul(momentum, value));
            sums.products = r.add(sums.products, r.mul(momentum, r.turn(value)));
        }
    }

    /// x·Kx − y·(M − M_c)y of a block.
    #[inline(always)]
    fn add_elements<R: Registers>(&self, r: R, block: Option<usize>, view: &View<'_, D>, sums: &mut Sums<R>) {
        if let Some(block) = block {
            let range = view.local(&self.blocks.nodes(block));
            let (x, y) = (&view.internal[range.clone()], &view.rate[range]);
            add_elements(r, self.pairs, self.pairs.block(block), [x, y], sums);
        }
    }
}

/// The differences of the simulation, the halved-elements and the halved-step solution from the auxiliary solution, and
/// the contact difference.
#[inline(always)]
fn difference<const D: usize>(motions: &Nodal, simulated: &[f64; D]) -> Nodal {
    let mut difference = *motions;
    for c in 0..D {
        let auxiliary = motions.0[place(0, c)];
        difference.0[place(0, c)] = simulated[c] - auxiliary;
        difference.0[place(1, c)] -= auxiliary;
        difference.0[place(2, c)] -= auxiliary;
    }
    difference
}

/// x·Kx − y·(M − M_c)y of pairs of elements.
#[inline(always)]
fn add_elements<R: Registers>(r: R, all: &Pairs, pairs: &[TrianglePair], [x, y]: [&[Nodal]; 2], sums: &mut Sums<R>) {
    let y = &y[..x.len()];
    let (mut squares, mut products) = (sums.squares, sums.products);
    for pair in pairs {
        let moduli = &all.laws.plain[pair.law as usize];
        let ([a, b, c], [d, e, f]) = (differences(r, pair, x), differences(r, pair, y));
        let [g, h, i, k] = pair.gradients;
        for (gradients, x, y, share) in
            [(&[g, h], [a, b], [d, e], pair.shares[0]), (&[i, k], [b, c], [e, f], pair.shares[1])]
        {
            let gradient = gradient(r, gradients, x);
            let stress = stress(r, moduli, &gradient);
            // Σ|y_i − mean|² = Σ y_i·(y_i − mean), here less the value at node 0.
            let mean = r.mul(r.add(y[0], y[1]), r.splat(1.0 / 3.0));
            let lumped = y.map(
                #[inline(always)]
                |y| r.mul(r.sub(mean, y), r.splat(share)),
            );
            let square = r.add(r.mul(stress[0], gradient[0]), r.mul(stress[1], gradient[1]));
            squares = r.add(squares, r.add(square, r.add(r.mul(lumped[0], y[0]), r.mul(lumped[1], y[1]))));
            let product = r.add(r.mul(stress[0], r.turn(gradient[0])), r.mul(stress[1], r.turn(gradient[1])));
            let lumped = r.add(r.mul(lumped[0], r.turn(y[0])), r.mul(lumped[1], r.turn(y[1])));
            products = r.add(products, r.add(product, lumped));
        }
    }
    *sums = Sums { squares, products };
}
