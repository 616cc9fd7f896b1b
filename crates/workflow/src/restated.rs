//! A problem on other meshes of its body.

use crate::case::{Source, problem_from, statement};
use crate::failure::Failure;
use percute_core::mesh::{Locator, Mesh};
use percute_core::problem::AnyProblem;
use std::sync::Arc;

/// A problem as a statement beside its mesh, to be read again on other meshes.
#[derive(Clone, Debug)]
pub struct Restated {
    problem: AnyProblem,
    statement: Source,
}

impl Restated {
    /// States a problem.
    ///
    /// # Errors
    /// A problem that the case language cannot say.
    pub fn new(problem: &AnyProblem) -> Result<Self, Failure> {
        Ok(Self {
            problem: problem.clone(),
            statement: Source::new("the problem on another mesh", statement(problem, None)?),
        })
    }

    /// The problem on its own mesh.
    #[must_use]
    pub fn problem(&self) -> &AnyProblem {
        &self.problem
    }

    /// The problem on a mesh, with its initial fields as they are linear in the elements of its own mesh.
    ///
    /// # Errors
    /// A mesh that lacks a group of the problem, or on which it is not consistent.
    pub fn on(&self, mesh: &Arc<Mesh>) -> Result<AnyProblem, Failure> {
        let fields = [self.problem.initial_displacement(), self.problem.initial_velocity()];
        let d = mesh.dimension();
        let [displacement, velocity] = fields.map(|field| match field.split_at(d.min(field.len())) {
            // Rounding must not make a uniform field vary.
            (first, others) if others.chunks_exact(d).all(|other| other == first) => first.repeat(mesh.node_count()),
            _ => self.values_at_nodes(field, mesh),
        });
        self.with(mesh, displacement, velocity)
    }

    /// A nodal field at the nodes of a mesh, each in its own body: nodes of two bodies may be at one place.
    fn values_at_nodes(&self, field: &[f64], mesh: &Mesh) -> Vec<f64> {
        let own = self.problem.mesh();
        let bodies = Locator::of_bodies(own);
        let body = own.matching_parts(mesh).unwrap_or_default();
        let nodes = mesh.points().chunks_exact(mesh.dimension()).zip(mesh.part_numbers());
        nodes.flat_map(|(point, part)| bodies[body[part]].values_at(field, point)).collect()
    }

    /// The problem on a mesh with initial displacement (m) and velocity (m/s) at its nodes, in rows.
    ///
    /// # Errors
    /// As [`Restated::on`].
    pub fn with(&self, mesh: &Arc<Mesh>, displacement: Vec<f64>, velocity: Vec<f64>) -> Result<AnyProblem, Failure> {
        let (problem, _) = problem_from(&self.statement, mesh, displacement, velocity)?;
        Ok(problem)
    }
}
