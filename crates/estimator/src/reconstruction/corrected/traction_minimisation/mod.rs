//! Tractions of least energy: changes of those of the star problems that balance as well.
//!
//! The star problems fix most of the tractions by the work of the finite-element stress on each shape function,
//! element by element. Where that stress jumps, at a corner or where contact begins, such tractions can cost
//! three times the energy of the true error. Equilibrium requires less: any change of the tractions
//! that gives no element a resultant or a moment is allowed. The modes of [`modes`] span all of them. Five steps of the
//! Chebyshev iteration of [`chebyshev`] over these modes, for each instant alone, reduce
//! ½∫(σ_DA − σ)K⁻¹(σ_DA − σ), σ the stress of the displacement that is equilibrated. The fields stay exactly admissible after
//! any number of steps.

mod assembly;
mod chebyshev;
mod energy;
mod mode_forms;
mod modes;
mod operator;
mod spectrum;
mod wavefront;

use super::concentration::Concentration;
use crate::blocks::BLOCK;
use crate::element::Element;
use crate::lanes::{LANES, Lanes, Value};
use crate::measure::{BalanceFields, BalanceNode, ElementMeasure};
use crate::options::Acceleration;
use crate::simd::dispatch;
use crate::stress::{EnergyForms, hooke};
use crate::traction::{EquilibratedLevels, Equilibration};
use chebyshev::{Arrays, Steps};
use energy::{moment_slope, product_slope};
use modes::{Modes, ModesPart, Numbers};
use operator::Operator;
use percute_core::ids::{ElementId, NodeId};
use percute_core::mesh::{Mesh, Strips};
use percute_core::problem::Problem;
use percute_core::simplex::Shape;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use wavefront::{Wavefront, Work};

/// The largest eigenvalue is known to 1 to 3 % from below. Above the value that is assumed, the iteration overshoots fast.
const MARGIN: f64 = 1.03;

/// The data that are fixed in time.
#[derive(Debug)]
pub(in crate::reconstruction) struct TractionMinimisation {
    numbers: Numbers,
    operator: Operator,
    strips: Strips,
    wavefront: Wavefront,
    steps: Steps,
    /// Those that are not in use.
    spaces: Mutex<Vec<Workspace>>,
    #[cfg(test)]
    largest_eigenvalue: f64,
}

/// Slopes, change and room to work of a group of instants, for use again.
#[derive(Clone, Debug)]
pub(in crate::reconstruction) struct Workspace {
    /// Slopes of the energy in the modes; [`TractionMinimisation::minimise`] spoils them.
    pub(in crate::reconstruction) slopes: Modes,
    /// Coefficients of the modes.
    pub(in crate::reconstruction) change: Modes,
    nodes: Vec<[Lanes; 3]>,
    edges: [Vec<Lanes>; 2],
}

impl Workspace {
    fn new(numbers: &Numbers) -> Self {
        let modes = Modes::new(numbers);
        let (nodes, edges) = (modes.nodes.clone(), modes.edges.clone());
        Self { slopes: modes.clone(), change: modes, nodes, edges: [edges.clone(), edges] }
    }
}

impl TractionMinimisation {
    /// Prepares all elements. In a bar there is nothing to choose.
    pub(in crate::reconstruction) fn new<const D: usize, const N: usize>(
        problem: &Problem<D, N>,
        elements: &[Element<D, N>],
    ) -> Option<Self> {
        match problem.mesh().simplex().shape() {
            Shape::Bar => return None,
            Shape::Triangle => {}
        }
        let numbers = Numbers::new(problem.mesh());
        let operator = assembly::assemble(problem, elements, &numbers);
        let mut space = Workspace::new(&numbers);
        let largest_eigenvalue = spectrum::largest_eigenvalue(problem.mesh(), &numbers, &operator, &mut space);
        Some(Self {
            strips: Strips::new(problem.mesh().cells()),
            wavefront: Wavefront::new(problem.mesh()),
            numbers,
            operator,
            steps: Steps::new(MARGIN * largest_eigenvalue),
            spaces: Mutex::new(vec![space]),
            #[cfg(test)]
            largest_eigenvalue,
        })
    }

    /// About how much memory it takes (bytes).
    pub(in crate::reconstruction) fn memory(shape: Shape, elements: usize) -> usize {
        match shape {
            Shape::Bar => 0,
            // Slopes and change are three coefficients each, a half of them of nodes; there is room for another half twice.
            Shape::Triangle => elements.saturating_mul(Operator::BYTES + Numbers::BYTES + 21 * size_of::<Lanes>() / 2),
        }
    }

    /// Room for the slopes and the change of a group, with any content; [`TractionMinimisation::leave`] takes it back for use again.
    pub(in crate::reconstruction) fn take(&self) -> Workspace {
        let mut spaces = self.spaces.lock().unwrap_or_else(PoisonError::into_inner);
        spaces.pop().unwrap_or_else(|| Workspace::new(&self.numbers))
    }

    /// Takes room back.
    pub(in crate::reconstruction) fn leave(&self, space: Workspace) {
        self.spaces.lock().unwrap_or_else(PoisonError::into_inner).push(space);
    }

    /// Makes the change that reduces the energy with these slopes.
    pub(in crate::reconstruction) fn minimise(&self, space: &mut Workspace) {
        let Workspace { slopes, change, nodes, edges: [t, v] } = space;
        let mut arrays = Arrays { slopes: slopes.part(), change: change.part(), nodes, edges: [t, v] };
        let work = Work { numbers: &self.numbers, operator: &self.operator, steps: &self.steps };
        self.wavefront.run(work, &mut arrays);
    }

    /// Improves the moments of all levels.
    pub(in crate::reconstruction) fn improve<const D: usize, const N: usize>(
        &self,
        problem: &Problem<D, N>,
        equilibration: &Equilibration<'_, D, N>,
        choice: Acceleration,
        levels: &mut EquilibratedLevels<D>,
        concentration: Option<&Concentration<D>>,
    ) {
        let mut space = self.take();
        space.slopes.clear();
        let slopes = Slopes { problem, equilibration, choice, levels, numbers: &self.numbers };
        for parity in 0..2 {
            self.strips(parity, space.slopes.part())
                .into_par_iter()
                .for_each_init(BalanceFields::default, |fields, strip| slopes.add(fields, strip));
        }
        if let Some(concentration) = concentration {
            for (lane, forces) in levels.forces().iter().enumerate() {
                concentration.each_element(problem, forces.density.hats(), |element, stress| {
                    let slope = product_slope::<D, N>(&stress.products());
                    let slope = slope.map(|slope| Lanes::at_levels(|l| if l == lane { slope } else { 0.0 }));
                    self.numbers.add_slope(problem.mesh(), element.index(), &slope, &mut space.slopes.part());
                });
            }
        }
        self.minimise(&mut space);
        self.add(problem.mesh(), 0..problem.mesh().node_count(), &space.change, levels.moments_mut());
        self.leave(space);
    }

    /// The elements of every other strip, each with the modes of its nodes.
    fn strips<'a>(&self, parity: usize, modes: ModesPart<'a>) -> Vec<(Range<usize>, ModesPart<'a>)> {
        let (mut rest, mut parts) = (modes, Vec::with_capacity(self.strips.count() / 2 + 1));
        for strip in (parity..self.strips.count()).step_by(2) {
            let nodes = self.strips.nodes(strip);
            let (_, part) = rest.split(&self.numbers, NodeId::new(nodes.start));
            let (part, others) = part.split(&self.numbers, NodeId::new(nodes.end));
            parts.push((self.strips.elements(strip), part));
            rest = others;
        }
        parts
    }

    /// Adds the change to the moments on the links of the stars of some nodes.
    fn add<const D: usize, const N: usize>(
        &self,
        mesh: &Mesh<D, N>,
        nodes: Range<usize>,
        change: &Modes,
        moments: &mut [[Lanes; D]],
    ) {
        let first = |node: usize| mesh.stars().link_range(NodeId::new(node)).start;
        if nodes.len() > 2 * BLOCK {
            let middle = nodes.start.midpoint(nodes.end);
            let (left, right) = moments.split_at_mut(first(middle) - first(nodes.start));
            rayon::join(
                || self.add(mesh, nodes.start..middle, change, left),
                || self.add(mesh, middle..nodes.end, change, right),
            );
            return;
        }
        dispatch(
            #[inline(always)]
            || {
                let mut rest = moments;
                for node in nodes.map(NodeId::new) {
                    let (own, others) = rest.split_at_mut(mesh.stars().link_range(node).len());
                    self.numbers.add_change(mesh, node, change, own);
                    rest = others;
                }
            },
        );
    }
}

/// The slopes of the energy of some levels in the modes.
#[derive(Clone, Copy, Debug)]
struct Slopes<'a, const D: usize, const N: usize> {
    problem: &'a Problem<D, N>,
    equilibration: &'a Equilibration<'a, D, N>,
    choice: Acceleration,
    levels: &'a EquilibratedLevels<D>,
    numbers: &'a Numbers,
}

impl<const D: usize, const N: usize> Slopes<'_, D, N> {
    /// Adds those of some elements.
    fn add(&self, fields: &mut BalanceFields<D>, (elements, mut to): (Range<usize>, ModesPart<'_>)) {
        for block in elements.start / BLOCK..elements.end.div_ceil(BLOCK) {
            let own = self.equilibration.blocks.elements(block);
            let range = own.start.max(elements.start)..own.end.min(elements.end);
            dispatch(
                #[inline(always)]
                || self.add_block(fields, block, range, &mut to),
            );
        }
    }

    /// Adds those of some elements of a block.
    #[inline(always)]
    fn add_block(&self, fields: &mut BalanceFields<D>, block: usize, range: Range<usize>, to: &mut ModesPart<'_>) {
        let (problem, equilibration, levels) = (self.problem, self.equilibration, self.levels);
        let first = equilibration.blocks.elements(block).start;
        let block = equilibration.blocks.block(block);
        fields.gather(problem, block.nodes, levels);
        fields.gather_displacement(block.nodes, levels);
        let mut forms = EnergyForms::new(problem.mesh().simplex().shape());
        for start in range.clone().step_by(LANES) {
            let group = start..(start + LANES).min(range.end);
            fields.gather_moments(&equilibration.elements[group.clone()], levels);
            let nodes_of = |e: usize| fields.nodes(&block.local[e - first]);
            let points = group.clone().map(|e| (ElementId::new(e), BalanceNode::points(&nodes_of(e))));
            let lanes = forms.prepare(problem, points);
            for (e, lane) in group.zip(lanes) {
                let (id, nodes, element) = (ElementId::new(e), nodes_of(e), &equilibration.elements[e]);
                let form = forms.of(problem, id, &BalanceNode::points(&nodes), lane);
                let measure = ElementMeasure::of_nodes((problem, element, id), self.choice, &nodes);
                let balance = fields.nodal_balance(e - start, levels, id, &nodes);
                let stress = hooke(problem.material(id), &element.gradient(&BalanceNode::displacements(&nodes)));
                let slope = moment_slope(&measure, &form, &balance, &stress);
                self.numbers.add_slope(problem.mesh(), e, &slope, to);
            }
        }
    }
}

#[cfg(test)]
mod tests;
