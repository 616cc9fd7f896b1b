//! Tractions of least energy: changes of those of the star problems that balance as well.
//!
//! The star problems fix most of the tractions by the work of the finite-element stress on each shape function,
//! element by element. Where that stress jumps, at a corner or where contact begins, such tractions can cost
//! three times the energy of the true error. Equilibrium requires less: any change of the tractions
//! that gives no element a resultant or a moment is allowed. The modes of [`modes`] span all of them. Five steps of the
//! Chebyshev iteration of [`chebyshev`] over these modes, for each instant alone, reduce
//! ½∫(σ_DA − σ)K⁻¹(σ_DA − σ), σ the stress of the displacement that is equilibrated. The fields stay exactly admissible
//! after any number of steps.

mod assembly;
mod chebyshev;
mod energy;
mod mode_forms;
mod modes;
mod operator;
mod present;
mod solid;
mod spectrum;
mod wavefront;

use super::concentration::Concentration;
use crate::blocks::BLOCK;
use crate::deformation::Deformation;
use crate::element::Element;
use crate::measure::{BalanceFields, BalanceNode, ElementMeasure};
use crate::options::Acceleration;
use crate::plastic::{EigenLevels, take_off};
use crate::pool::Pool;
use crate::stress::EnergyForms;
use crate::time_level::ForcesKnown;
use crate::traction::{BalancedStrains, EquilibratedLevels, Equilibration, Then};
use chebyshev::{Arrays, ChebyshevSteps};
use energy::{moment_slope, product_slope};
use modes::{MOMENTS, Modes, ModesPart, Numbers};
use operator::Operator;
use percute_core::cell::CellKind;
use percute_core::ids::{ElementId, NodeId};
use percute_core::mesh::{Mesh, Strips};
use percute_core::observer::StopFlag;
use percute_core::problem::Problem;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{LANES, Lanes, Value};
use percute_core::simd::{Registers, Task, run_task};
use present::PresentPlaces;
use rayon::prelude::*;
pub(in crate::reconstruction) use solid::SolidMinimisation;
use std::ops::Range;
use wavefront::{Wavefront, Work};

/// The largest eigenvalue is known to 1 to 3 % from below. Above the value that is assumed, the iteration overshoots
/// fast.
const MARGIN: f64 = 1.03;

/// The data that are fixed in time.
#[derive(Debug)]
pub(in crate::reconstruction) struct TractionMinimisation {
    numbers: Numbers,
    operator: Operator,
    wavefront: Wavefront,
    steps: ChebyshevSteps,
    spaces: Pool<Workspace>,
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
        let [slopes, change] = [(); 2].map(|()| Modes::new(numbers));
        let edges = [(); 2].map(|()| vec![Lanes::ZERO; numbers.edges()]);
        Self { slopes, change, nodes: vec![[Lanes::ZERO; 3]; numbers.nodes()], edges }
    }
}

impl TractionMinimisation {
    /// Prepares all elements. In a bar there is nothing to choose.
    pub(in crate::reconstruction) fn new<const D: usize, const N: usize>(
        problem: &Problem<D>,
        elements: &[Element<D, N>],
    ) -> Option<Self> {
        match problem.mesh().kind() {
            CellKind::Bar | CellKind::Tetrahedron => return None,
            CellKind::Triangle => {}
        }
        let numbers = Numbers::new(problem.mesh());
        let operator = assembly::assemble(problem, elements, &numbers);
        let (wavefront, spaces) = (Wavefront::new::<N>(problem.mesh()), Pool::new());
        let largest_eigenvalue = spaces.lend(
            || Workspace::new(&numbers),
            |space| spectrum::largest_eigenvalue::<D, N>(problem.mesh(), (&numbers, &operator, &wavefront), space),
        );
        Some(Self {
            numbers,
            operator,
            wavefront,
            steps: ChebyshevSteps::new(MARGIN * largest_eigenvalue),
            spaces,
            #[cfg(test)]
            largest_eigenvalue,
        })
    }

    /// About how much memory it takes (bytes).
    pub(in crate::reconstruction) fn memory(shape: CellKind, elements: usize) -> usize {
        match shape {
            CellKind::Bar => 0,
            CellKind::Tetrahedron => SolidMinimisation::memory(elements),
            // Slopes and change are three coefficients each, a half of them of nodes; there is room for another half
            // twice.
            CellKind::Triangle => {
                elements.saturating_mul(Operator::BYTES + Numbers::BYTES + 21 * size_of::<Lanes>() / 2)
            }
        }
    }

    /// Makes the change that reduces the energy with these slopes, unless it is stopped.
    pub(in crate::reconstruction) fn minimise(&self, space: &mut Workspace, stop: &StopFlag) {
        let Workspace { slopes, change, nodes, edges: [t, v] } = space;
        let mut arrays = Arrays { slopes: slopes.part(), change: change.part(), nodes, edges: [t, v] };
        let work = Work { numbers: &self.numbers, operator: &self.operator, steps: &self.steps, stop };
        self.wavefront.run(work, &mut arrays);
    }

    /// Solves the star problems of levels with these forces, and strains if they are smoothed, and improves their
    /// moments; `then` is given each part of the mesh with the final ones. Returns the largest relative miss of the
    /// star problems.
    pub(in crate::reconstruction) fn equilibrate<const D: usize, const N: usize>(
        &self,
        of @ (problem, equilibration, _): (&Problem<D>, &Equilibration<'_, D, N>, Acceleration),
        forces: (Vec<ForcesKnown<D>>, Option<BalancedStrains<'_>>),
        levels: &mut EquilibratedLevels<D>,
        concentration: Option<&Concentration<D>>,
        then: Then<'_, D>,
    ) -> f64 {
        let new = || Workspace::new(&self.numbers);
        let places = || PresentPlaces::new(problem, &equilibration.elements, &forces.0);
        let present = problem.is_finite().then(places);
        let present = present.as_ref();
        self.spaces.lend(new, |space| {
            let miss = self.add_slopes(of, forces, levels, (concentration, present), &mut space.slopes);
            self.minimise(space, &equilibration.stop);
            for part in equilibration.parts() {
                let (nodes, moments) = equilibration.moments_mut(part, levels);
                self.add(problem.mesh(), nodes, (&space.change, present), moments);
                then(levels, part);
            }
            miss
        })
    }

    /// Solves the star problems and finds the slopes of the energy.
    fn add_slopes<const D: usize, const N: usize>(
        &self,
        (problem, equilibration, choice): (&Problem<D>, &Equilibration<'_, D, N>, Acceleration),
        (forces, strains): (Vec<ForcesKnown<D>>, Option<BalancedStrains<'_>>),
        levels: &mut EquilibratedLevels<D>,
        (concentration, present): (Option<&Concentration<D>>, Option<&PresentPlaces>),
        all: &mut Modes,
    ) -> f64 {
        all.clear();
        let room = Pool::new();
        let miss = equilibration.solve(forces, levels, strains, |levels, part| {
            let slopes = Slopes { problem, equilibration, choice, levels, numbers: &self.numbers, present };
            for parity in 0..2 {
                let strips = part.strips.clone().filter(|strip| strip % 2 == parity);
                self.strips(&equilibration.strips, strips, all.part())
                    .into_par_iter()
                    .for_each(|strip| room.lend(BalanceFields::default, |fields| slopes.add(fields, strip)));
            }
        });
        if let Some(concentration) = concentration {
            for (lane, forces) in levels.forces().iter().enumerate() {
                concentration.each_element(problem, forces.density.hats(), |element, stress| {
                    let mut slope = product_slope::<D, N>(&stress.products());
                    if present.is_some() {
                        let data = &equilibration.elements[element.index()];
                        turn::<_, D>(&mut slope, &data.gradient(&data.gather(&forces.level.displacement)));
                    }
                    let slope = slope.map(|slope| Lanes::at_levels(|l| if l == lane { slope } else { 0.0 }));
                    let slope = (element.index(), &slope);
                    self.numbers.add_slope::<_, D, N>(problem.mesh(), slope, present, &mut all.part());
                });
            }
        }
        miss
    }

    /// The elements of some strips that have no node in common, each with the modes of its nodes.
    fn strips<'a>(
        &self,
        all: &Strips,
        strips: impl Iterator<Item = usize>,
        modes: ModesPart<'a>,
    ) -> Vec<(Range<usize>, ModesPart<'a>)> {
        let (mut rest, mut parts) = (modes, Vec::new());
        for strip in strips {
            let nodes = all.nodes(strip);
            let (_, part) = rest.split(&self.numbers, NodeId::new(nodes.start));
            let (part, others) = part.split(&self.numbers, NodeId::new(nodes.end));
            parts.push((all.elements(strip), part));
            rest = others;
        }
        parts
    }

    /// Adds the change to the moments on the links of the stars of some nodes.
    fn add<const D: usize>(
        &self,
        mesh: &Mesh,
        nodes: Range<usize>,
        change: (&Modes, Option<&PresentPlaces>),
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
        run_task(AddChange { numbers: &self.numbers, mesh, nodes, change, moments });
    }
}

/// The change of the moments on the links of the stars of some nodes.
struct AddChange<'a, const D: usize> {
    numbers: &'a Numbers,
    mesh: &'a Mesh,
    nodes: Range<usize>,
    change: (&'a Modes, Option<&'a PresentPlaces>),
    moments: &'a mut [[Lanes; D]],
}

impl<const D: usize> Task for AddChange<'_, D> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) {
        let Self { numbers, mesh, nodes, change, moments } = self;
        let mut rest = moments;
        for node in nodes.map(NodeId::new) {
            let (own, others) = rest.split_at_mut(mesh.stars().link_range(node).len());
            numbers.add_change::<_, D>(Wide::zeros(registers), mesh, node, change, own);
            rest = others;
        }
    }
}

/// Slopes in the moments of the present body, from those in moments that are pulled back.
#[inline(always)]
fn turn<T: Value, const D: usize>(slope: &mut [T; MOMENTS], gradient: &[[T; D]; D]) {
    let deformation = Deformation::new(gradient);
    for moment in slope.as_chunks_mut::<2>().0 {
        let mut vector = [moment[0]; D];
        (0..D).for_each(|c| vector[c] = moment[c]);
        let vector = deformation.slope(&vector);
        (0..D).for_each(|c| moment[c] = vector[c]);
    }
}

/// The slopes of the energy of some levels in the modes.
#[derive(Clone, Copy, Debug)]
struct Slopes<'a, const D: usize, const N: usize> {
    problem: &'a Problem<D>,
    equilibration: &'a Equilibration<'a, D, N>,
    choice: Acceleration,
    levels: &'a EquilibratedLevels<D>,
    numbers: &'a Numbers,
    present: Option<&'a PresentPlaces>,
}

impl<const D: usize, const N: usize> Slopes<'_, D, N> {
    /// Adds those of some elements.
    fn add(&self, fields: &mut BalanceFields<D>, (elements, mut to): (Range<usize>, ModesPart<'_>)) {
        for block in elements.start / BLOCK..elements.end.div_ceil(BLOCK) {
            let own = self.equilibration.blocks.elements(block);
            let range = own.start.max(elements.start)..own.end.min(elements.end);
            run_task(SlopesOfBlock { all: self, fields, block, range, to: to.reborrow() });
        }
    }

    /// Adds those of some elements of a block.
    #[inline(always)]
    fn add_block<R: Registers>(
        &self,
        like: Wide<R>,
        fields: &mut BalanceFields<D>,
        block: usize,
        range: Range<usize>,
        to: &mut ModesPart<'_>,
    ) {
        let (problem, equilibration, levels) = (self.problem, self.equilibration, self.levels);
        let first = equilibration.blocks.elements(block).start;
        let block = equilibration.blocks.block(block);
        fields.gather(like, problem, block.nodes, levels);
        fields.gather_displacement(like, block.nodes, levels);
        let eigen = EigenLevels::new(levels.forces().iter().map(|forces| forces.level.plastic.as_ref()));
        let mut forms = EnergyForms::new(problem.mesh().kind());
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
                let balance = fields.nodal_balance(like, e - start, levels, (id, &element.links), &nodes);
                let mut gradient = element.gradient(&BalanceNode::displacements(like, &nodes));
                take_off(eigen.as_ref(), &mut gradient, e);
                let [stress, _] = measure.stress_and_strain(&gradient);
                let mut slope = moment_slope(&measure, &form, &balance, &stress);
                if self.present.is_some() {
                    turn::<_, D>(&mut slope, &gradient);
                }
                self.numbers.add_slope::<_, D, N>(problem.mesh(), (e, &slope), self.present, to);
            }
        }
    }
}

/// Some elements of a block whose slopes are wanted.
struct SlopesOfBlock<'b, 'a, const D: usize, const N: usize> {
    all: &'b Slopes<'a, D, N>,
    fields: &'b mut BalanceFields<D>,
    block: usize,
    range: Range<usize>,
    to: ModesPart<'b>,
}

impl<const D: usize, const N: usize> Task for SlopesOfBlock<'_, '_, D, N> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) {
        let Self { all, fields, block, range, mut to } = self;
        all.add_block(Wide::zeros(registers), fields, block, range, &mut to);
    }
}

#[cfg(test)]
mod tests;
