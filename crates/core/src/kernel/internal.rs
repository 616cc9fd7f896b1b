//! The internal forces of any problem, in rows.

use super::ProblemKernel;
use crate::border::vectors;
use crate::problem::ProblemRef;

/// The internal forces of all elements of a problem, of small strains or a finite law; of materials that yield those
/// of a body that had no strain before.
#[derive(Clone, Debug)]
pub struct InternalForces(OfDimension);

#[derive(Clone, Debug)]
enum OfDimension {
    One(ProblemKernel<1>),
    Two(ProblemKernel<2>),
    Three(ProblemKernel<3>),
}

impl InternalForces {
    /// Prepares the elements of a problem.
    #[must_use]
    pub fn new<'p>(problem: impl Into<ProblemRef<'p>>) -> Self {
        Self(match problem.into() {
            ProblemRef::D1(problem) => OfDimension::One(ProblemKernel::new(problem)),
            ProblemRef::D2(problem) => OfDimension::Two(ProblemKernel::new(problem)),
            ProblemRef::D3(problem) => OfDimension::Three(ProblemKernel::new(problem)),
        })
    }

    /// The same with Hooke's law, whatever the materials are.
    #[must_use]
    pub fn linear<'p>(problem: impl Into<ProblemRef<'p>>) -> Self {
        Self(match problem.into() {
            ProblemRef::D1(problem) => OfDimension::One(ProblemKernel::linear(problem)),
            ProblemRef::D2(problem) => OfDimension::Two(ProblemKernel::linear(problem)),
            ProblemRef::D3(problem) => OfDimension::Three(ProblemKernel::linear(problem)),
        })
    }

    /// Subtracts the internal forces from `force` (N), both in rows, and returns the strain energy (J).
    pub fn subtract_from_rows(&self, displacement: &[f64], force: &mut [f64]) -> f64 {
        match &self.0 {
            OfDimension::One(kernel) => kernel.subtract_from_rest(vectors(displacement), force.as_chunks_mut().0),
            OfDimension::Two(kernel) => kernel.subtract_from_rest(vectors(displacement), force.as_chunks_mut().0),
            OfDimension::Three(kernel) => kernel.subtract_from_rest(vectors(displacement), force.as_chunks_mut().0),
        }
    }
}
