//! The quantities of an export.

use super::Request;
use crate::failure::Failure;
use crate::message::hint;
use percute_core::element_state::ElementState;
use percute_core::history::Step;
use percute_core::ids::ElementId;
use percute_core::problem::AnyProblem;
use percute_io::export::{ExportField, FieldPlace, in_space};

/// A quantity of an export, beside the displacement, which each export has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ExportQuantity {
    Displacement,
    Velocity,
    Acceleration,
    Reaction,
    Stress,
    VonMises,
    Pressure,
    PlasticStrain,
    Error,
}

impl ExportQuantity {
    /// In the order of a file.
    const ALL: [Self; 9] = [
        Self::Displacement,
        Self::Velocity,
        Self::Acceleration,
        Self::Reaction,
        Self::Stress,
        Self::VonMises,
        Self::Pressure,
        Self::PlasticStrain,
        Self::Error,
    ];

    fn field(self) -> ExportField {
        let (name, unit, components, place) = match self {
            Self::Displacement => ("displacement", "m", 3, FieldPlace::Nodes),
            Self::Velocity => ("velocity", "m/s", 3, FieldPlace::Nodes),
            Self::Acceleration => ("acceleration", "m/s2", 3, FieldPlace::Nodes),
            Self::Reaction => ("reaction", "N", 3, FieldPlace::Nodes),
            Self::Stress => ("stress", "Pa", 9, FieldPlace::Elements),
            Self::VonMises => ("von_mises", "Pa", 1, FieldPlace::Elements),
            Self::Pressure => ("pressure", "Pa", 1, FieldPlace::Elements),
            Self::PlasticStrain => ("equivalent_plastic_strain", "1", 1, FieldPlace::Elements),
            Self::Error => ("error", "J^(1/2)", 1, FieldPlace::Elements),
        };
        ExportField { name, unit, components, place }
    }
}

/// The rows of the fields of an export.
pub(super) struct ExportRows<'a> {
    pub(super) problem: &'a AnyProblem,
    pub(super) quantities: Vec<ExportQuantity>,
    /// e_E of each element (J^½).
    pub(super) error: Vec<f64>,
}

impl ExportRows<'_> {
    pub(super) fn fields(&self) -> Vec<ExportField> {
        let units = self.problem.units();
        let fields = self.quantities.iter().map(|quantity| quantity.field());
        fields.map(|field| ExportField { unit: units.of(field.unit), ..field }).collect()
    }

    /// Whether steps must have their velocity and acceleration.
    pub(super) fn need_motion(&self) -> bool {
        self.quantities.iter().any(|q| matches!(q, ExportQuantity::Velocity | ExportQuantity::Acceleration))
    }

    /// The rows of all fields at a step.
    pub(super) fn at(&self, step: &Step<'_>) -> Vec<Vec<f64>> {
        let d = self.problem.dimension();
        let of_elements = |q: &ExportQuantity| {
            use ExportQuantity::{PlasticStrain, Pressure, Stress, VonMises};
            matches!(q, Stress | VonMises | Pressure | PlasticStrain)
        };
        let elements = (0..self.problem.mesh().element_count()).map(ElementId::new);
        let states: Vec<ElementState> = match self.quantities.iter().any(of_elements) {
            true => elements.map(|e| ElementState::new(self.problem, e, step.displacement, step.internal)).collect(),
            false => Vec::new(),
        };
        let rows = |quantity: &ExportQuantity| match quantity {
            ExportQuantity::Displacement => in_space(step.displacement, d),
            ExportQuantity::Velocity => in_space(step.velocity.unwrap_or_default(), d),
            ExportQuantity::Acceleration => in_space(step.acceleration.unwrap_or_default(), d),
            ExportQuantity::Reaction => self.reaction(step),
            ExportQuantity::Stress => states.iter().flat_map(tensor).collect(),
            ExportQuantity::VonMises => states.iter().map(ElementState::von_mises).collect(),
            ExportQuantity::Pressure => states.iter().map(ElementState::pressure).collect(),
            ExportQuantity::PlasticStrain => states.iter().map(|state| state.equivalent_plastic_strain).collect(),
            ExportQuantity::Error => self.error.clone(),
        };
        self.quantities.iter().map(rows).collect()
    }

    /// R_n on all nodes; 0 where no plane can be touched.
    fn reaction(&self, step: &Step<'_>) -> Vec<f64> {
        let (mut all, d) = (vec![[0.0; 3]; self.problem.mesh().node_count()], self.problem.dimension());
        for (contact, reaction) in self.problem.contact_nodes().iter().zip(step.reaction.chunks_exact(d)) {
            all[contact.node.index()].iter_mut().zip(reaction).for_each(|(sum, force)| *sum += force);
        }
        all.into_flattened()
    }
}

/// The quantities of a request for a body of which a material `yields`, in the order of [`ExportQuantity::ALL`].
pub(super) fn quantities(request: &Request, yields: bool) -> Result<Vec<ExportQuantity>, Failure> {
    let (estimated, fields) = (request.error.is_some(), request.fields.as_deref());
    let wanted = |quantity: &ExportQuantity| match fields {
        Some(names) => names.iter().any(|name| name == quantity.field().name),
        None => match quantity {
            ExportQuantity::Acceleration | ExportQuantity::Pressure | ExportQuantity::Error => false,
            ExportQuantity::PlasticStrain => yields,
            _ => true,
        },
    };
    let known = ExportQuantity::ALL.map(|quantity| quantity.field().name);
    let unknown = fields.into_iter().flatten().find(|name| !known.contains(&name.as_str()));
    if let Some(name) = unknown {
        let of = request.names.fields;
        let told = format!("{of}: there is no field {name:?}; choose from {}{}", known.join(", "), hint(name, known));
        return Err(Failure::Argument(told));
    }
    let lacks = |quantity: &ExportQuantity| request.lacks.iter().flatten().any(|name| *name == quantity.field().name);
    if let Some(quantity) = ExportQuantity::ALL.iter().find(|q| fields.is_some() && wanted(q) && lacks(q)) {
        let (of, name) = (request.names.fields, quantity.field().name);
        let told = format!(
            "{of}: {name:?} is not in this history, which keeps a part of its run; run again with it among `fields`"
        );
        return Err(Failure::Argument(told));
    }
    let chosen = |quantity: &ExportQuantity| match quantity {
        ExportQuantity::Displacement => true,
        ExportQuantity::Error => estimated,
        other => wanted(other) && !lacks(other),
    };
    if wanted(&ExportQuantity::Error) && !estimated {
        return Err(Failure::Argument(format!(
            "{}: \"error\" needs an estimate of this history; name one",
            request.names.fields
        )));
    }
    Ok(ExportQuantity::ALL.into_iter().filter(chosen).collect())
}

/// σ in three dimensions (Pa), row after row.
fn tensor(state: &ElementState) -> [f64; 9] {
    let mut tensor = state.stress;
    tensor[2][2] = state.stress_across;
    std::array::from_fn(|k| tensor[k / 3][k % 3])
}
