//! The origin of a history that percute has stored but not simulated.

use super::nodal::nodal;
use crate::error::FileCause;
use crate::read::Part;
use crate::write::{Texts, numbers, unit};
use hdf5::Group;

const PROGRAM: &str = "simulated_by";
const DERIVED: &str = "derived";
const START: &str = "initial_displacement";

/// What another program simulated, beside the steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Elsewhere {
    /// The program; empty if unknown.
    pub program: String,
    /// Names of the parts that were derived.
    pub derived: Vec<String>,
    /// u₀ of the problem (m), in rows, from which step 0 may differ.
    pub initial_displacement: Vec<f64>,
}

impl Elsewhere {
    /// The names of the derived parts, as they are stored.
    pub(super) fn derived(&self) -> String {
        self.derived.join(" ")
    }

    pub(super) fn write(&self, ours: &Group, texts: &mut Texts, dimension: usize) -> Result<(), FileCause> {
        texts.add(ours, PROGRAM, &self.program)?;
        texts.add(ours, DERIVED, &self.derived())?;
        let start = &self.initial_displacement;
        unit(&numbers(ours, START, &[start.len() / dimension, dimension], start)?, "m")
    }

    /// Reads it; none of a history that its writer has simulated.
    pub(super) fn read(ours: &Part<'_>, shape: [usize; 2]) -> Result<Option<Self>, FileCause> {
        let Some(program) = ours.optional_text(PROGRAM)? else { return Ok(None) };
        let derived = ours.optional_text(DERIVED)?.unwrap_or_default();
        let initial_displacement = nodal(ours, START, shape)?;
        Ok(Some(Self {
            program,
            derived: derived.split_whitespace().map(str::to_string).collect(),
            initial_displacement,
        }))
    }
}
