//! A problem on other meshes of its body.

use crate::case::{Source, problem_from, statement};
use crate::failure::Failure;
use percute_core::mesh::{Locator, Mesh};
use percute_core::problem::Problem;

/// A problem as a statement beside its mesh, to be read again on other meshes.
#[derive(Clone, Debug)]
pub struct Restated<const D: usize, const N: usize> {
    problem: Problem<D, N>,
    statement: Source,
}

impl<const D: usize, const N: usize> Restated<D, N> {
    /// States a problem.
    ///
    /// # Errors
    /// A problem that the case language cannot say.
    pub fn new(problem: &Problem<D, N>) -> Result<Self, Failure> {
        Ok(Self {
            problem: problem.clone(),
            statement: Source::new("the problem on another mesh", statement(problem, None)?),
        })
    }

    /// The problem on its own mesh.
    #[must_use]
    pub fn problem(&self) -> &Problem<D, N> {
        &self.problem
    }

    /// The problem on a mesh, with its initial fields as they are linear in the elements of its own mesh.
    ///
    /// # Errors
    /// A mesh that lacks a group of the problem, or on which it is not consistent.
    pub fn on(&self, mesh: Mesh<D, N>) -> Result<Problem<D, N>, Failure> {
        let fields = [self.problem.initial_displacement(), self.problem.initial_velocity()];
        let [displacement, velocity] = fields.map(|field| match field {
            // Rounding must not make a uniform field vary.
            [first, others @ ..] if others.iter().all(|other| other == first) => vec![*first; mesh.node_count()],
            _ => self.values_at_nodes(field, &mesh),
        });
        self.with(mesh, displacement, velocity)
    }

    /// A nodal field at the nodes of a mesh, each in its own body: nodes of two bodies may be at one place.
    fn values_at_nodes(&self, field: &[[f64; D]], mesh: &Mesh<D, N>) -> Vec<[f64; D]> {
        let bodies = Locator::of_bodies(self.problem.mesh());
        let body = Locator::matching(&bodies, mesh);
        let value = |(point, part): (&[f64; D], usize)| bodies[body[part]].values_at(field, &[*point])[0];
        mesh.points().iter().zip(mesh.part_numbers()).map(value).collect()
    }

    /// The problem on a mesh with initial displacement (m) and velocity (m/s) at its nodes.
    ///
    /// # Errors
    /// As [`Restated::on`].
    pub fn with(
        &self,
        mesh: Mesh<D, N>,
        displacement: Vec<[f64; D]>,
        velocity: Vec<[f64; D]>,
    ) -> Result<Problem<D, N>, Failure> {
        let (problem, _) = problem_from(&self.statement, mesh, displacement, velocity)?;
        Ok(problem)
    }
}
