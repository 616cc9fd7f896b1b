//! The numbers of the solver and those of the user.
//!
//! Simulation and estimate work on the problem in a local order
//! ([`Mesh::local_numbering`](percute_core::mesh::Mesh::local_numbering)). Histories, estimates, contact results and
//! messages have the numbers of the problem that was stated. Nothing is copied if its order is local already.

use crate::failure::Failure;
use percute_core::contact_results::ContactResults;
use percute_core::dynamics::SimulationError;
use percute_core::history::{Checkpoint, SinkError, Step, StepError, StepSource};
use percute_core::ids::NodeId;
use percute_core::mesh::Numbering;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::reference::ReferenceError;
use percute_estimator::{ElementMap, Estimate, EstimateError, RunError};

/// Takes steps in the numbers of the problem that was stated.
pub type TakeStep<'s> = dyn FnMut(&Step<'_>) -> Result<(), SinkError> + Send + 's;

/// A problem in the order in which it is solved.
pub(crate) struct Ordered<'p> {
    stated: &'p AnyProblem,
    local: Option<(AnyProblem, Numbering)>,
}

impl<'p> Ordered<'p> {
    /// Orders a problem, unless its order is local.
    pub(crate) fn new(stated: &'p AnyProblem) -> Self {
        let local = stated.mesh().local_numbering().map(|numbering| (stated.renumbered(&numbering), numbering));
        Self { stated, local }
    }

    /// The problem to be solved.
    pub(crate) fn problem(&self) -> &AnyProblem {
        self.local.as_ref().map_or(self.stated, |(problem, _)| problem)
    }

    /// The problem that was stated.
    pub(crate) fn stated_problem(&self) -> &'p AnyProblem {
        self.stated
    }

    fn numbering(&self) -> Option<&Numbering> {
        self.local.as_ref().map(|(_, numbering)| numbering)
    }

    /// The steps of a history in the order of the problem to be solved.
    pub(crate) fn source<'s>(&'s self, source: &'s dyn StepSource) -> OrderedSource<'s> {
        OrderedSource { source, numbering: self.numbering(), dimension: self.stated.dimension() }
    }

    /// A step in the numbers of the user.
    pub(crate) fn stated_step<'s>(&self, step: &Step<'s>, fields: &'s mut Fields) -> Step<'s> {
        let Some(numbering) = self.numbering() else { return *step };
        let nodal = |new: &[f64], old: &mut Vec<f64>| numbering.restore_nodal(new, old);
        fields.reordered(step, nodal, |new| numbering.restore_elemental(new))
    }

    /// A checkpoint in the numbers of the user.
    pub(crate) fn stated(&self, checkpoint: Checkpoint) -> Checkpoint {
        let Checkpoint { displacement, half_step, mut internal, .. } = checkpoint;
        if let Some(numbering) = self.numbering() {
            internal = numbering.restore_elemental(&internal);
        }
        Checkpoint { displacement: self.nodal(displacement), half_step: self.nodal(half_step), internal, ..checkpoint }
    }

    /// A checkpoint in the numbers of the problem to be solved.
    pub(crate) fn local(&self, mut checkpoint: Checkpoint) -> Checkpoint {
        let Some(numbering) = self.numbering() else { return checkpoint };
        for field in [&mut checkpoint.displacement, &mut checkpoint.half_step] {
            let mut local = Vec::new();
            numbering.order_nodal(field, &mut local);
            *field = local;
        }
        checkpoint.internal = numbering.order_elemental(&checkpoint.internal);
        checkpoint
    }

    /// A nodal field in the numbers of the user.
    pub(crate) fn nodal(&self, field: Vec<f64>) -> Vec<f64> {
        let Some(numbering) = self.numbering() else { return field };
        let mut restored = Vec::new();
        numbering.restore_nodal(&field, &mut restored);
        restored
    }

    /// An estimate in the numbers of the user.
    pub(crate) fn estimate(&self, mut estimate: Estimate) -> Estimate {
        let Some(numbering) = self.numbering() else { return estimate };
        estimate.by_element = numbering.restore_elemental(&estimate.by_element);
        for map in &mut estimate.maps {
            let ElementMap { kinetic, elastic, dissipation, contact, accumulated, .. } = map;
            for part in [kinetic, elastic, dissipation, contact, accumulated] {
                *part = numbering.restore_elemental(part);
            }
            let Some(fields) = &mut map.fields else { continue };
            for field in [&mut fields.displacement, &mut fields.velocity] {
                let mut restored = Vec::new();
                numbering.restore_nodal(field, &mut restored);
                *field = restored;
            }
            for stress in [&mut fields.stress, &mut fields.compatible_stress] {
                *stress = numbering.restore_elemental(stress);
            }
            fields.acceleration = numbering.restore_elemental(&fields.acceleration);
        }
        estimate
    }

    /// Contact results with the numbers of the user; their order is that of the contact surface, the same for both.
    pub(crate) fn contact(&self, mut results: ContactResults) -> ContactResults {
        results.nodes.iter_mut().for_each(|point| point.node = NodeId::new(self.node(point.node.index())));
        results
    }

    /// A failure that names the nodes and elements of the user.
    pub(crate) fn failure(&self, failure: Failure) -> Failure {
        match failure {
            Failure::Run(RunError::Simulation(error)) => Failure::Run(RunError::Simulation(self.simulation(error))),
            Failure::Run(RunError::Estimate(error)) => Failure::Run(RunError::Estimate(self.estimation(error))),
            Failure::Run(RunError::Source(cause)) => Failure::Run(RunError::Source(self.refused(cause))),
            Failure::Reference(ReferenceError::NotNested { fine }) => {
                let fine = self.numbering().map_or(fine, |numbering| numbering.elements()[fine].index());
                Failure::Reference(ReferenceError::NotNested { fine })
            }
            Failure::Reference(ReferenceError::Outside { node }) => {
                Failure::Reference(ReferenceError::Outside { node: self.node(node) })
            }
            other => other,
        }
    }

    /// What a sink refused, with the nodes of the user.
    pub(crate) fn refused(&self, mut cause: SinkError) -> SinkError {
        if let Some(error) = cause.downcast_mut::<StepError>() {
            self.step(error);
        }
        cause
    }

    fn simulation(&self, mut error: SimulationError) -> SimulationError {
        if let SimulationError::Unstable { node, .. }
        | SimulationError::Missed { node, .. }
        | SimulationError::StartsTooNear { node, .. } = &mut error
        {
            *node = self.node(*node);
        }
        if let SimulationError::InsideOut { element, .. } = &mut error {
            *element = self.numbering().map_or(*element, |numbering| numbering.elements()[*element].index());
        }
        error
    }

    fn estimation(&self, mut error: EstimateError) -> EstimateError {
        match &mut error {
            EstimateError::Start { node }
            | EstimateError::StartVelocity { node }
            | EstimateError::StartsTouching { node, .. }
            | EstimateError::StartsTooNear { node, .. } => *node = self.node(*node),
            EstimateError::Step(error) => self.step(error),
            _ => {}
        }
        error
    }

    /// Reactions are in the order of the contact surface, the other fields in that of the nodes.
    fn step(&self, error: &mut StepError) {
        if let StepError::NotFinite { field, position, .. } = error
            && *field != "reaction"
        {
            *position = if *field == "internal" { self.element(*position) } else { self.node(*position) };
        }
    }

    /// An element by the number of the user.
    pub(crate) fn element(&self, new: usize) -> usize {
        self.numbering().map_or(new, |numbering| numbering.elements()[new].index())
    }

    /// A node by the number of the user.
    pub(crate) fn node(&self, new: usize) -> usize {
        self.numbering().map_or(new, |numbering| numbering.nodes()[new].index())
    }
}

/// The nodal fields of a step in another order; their memory is used again.
#[derive(Debug, Default)]
pub(crate) struct Fields {
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    internal: Vec<f64>,
}

impl Fields {
    /// A step whose nodal fields `order` has reordered, and those of elements `elemental`.
    fn reordered<'s>(
        &'s mut self,
        step: &Step<'s>,
        order: impl Fn(&[f64], &mut Vec<f64>),
        elemental: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Step<'s> {
        let Self { displacement, velocity, acceleration, internal } = self;
        order(step.displacement, displacement);
        if !step.internal.is_empty() {
            *internal = elemental(step.internal);
        }
        let given = |field: Option<&[f64]>, to: &'s mut Vec<f64>| {
            field.map(|field| {
                order(field, to);
                &to[..]
            })
        };
        Step {
            displacement,
            internal: if step.internal.is_empty() { &[] } else { internal },
            velocity: given(step.velocity, velocity),
            acceleration: given(step.acceleration, acceleration),
            ..*step
        }
    }
}

/// A history in the order of the problem that is solved.
pub(crate) struct OrderedSource<'s> {
    source: &'s dyn StepSource,
    numbering: Option<&'s Numbering>,
    dimension: usize,
}

impl StepSource for OrderedSource<'_> {
    fn times(&self) -> &TimeGrid {
        self.source.times()
    }

    fn count(&self) -> usize {
        self.source.count()
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        let Some(numbering) = self.numbering else { return self.source.replay(take) };
        let mut fields = Fields::default();
        let fits = |field: &[f64]| field.len() == self.dimension * numbering.nodes().len();
        self.source.replay(&mut |step| {
            if fits(step.displacement) && step.velocity.is_none_or(fits) && step.acceleration.is_none_or(fits) {
                let nodal = |old: &[f64], new: &mut Vec<f64>| numbering.order_nodal(old, new);
                take(&fields.reordered(step, nodal, |old| numbering.order_elemental(old)))
            } else {
                // It is refused for its length.
                take(step)
            }
        })
    }
}
