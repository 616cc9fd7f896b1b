//! Runs, and the quantities that follow from their steps by the scheme alone.

use percute_core::dynamics::{Simulation, simulate};
use percute_core::history::{History, StepSource};
use percute_core::ids::NodeId;
use percute_core::kernel::InternalForces;
use percute_core::load::{BodyForce, Support, Table};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::f64::consts::TAU;

/// A run and all its steps.
pub(crate) struct Run<'p, const D: usize> {
    pub(crate) problem: &'p Problem<D>,
    pub(crate) history: History,
    pub(crate) simulation: Simulation,
}

/// Runs a problem that must not fail.
pub(crate) fn run<'p, const D: usize>(problem: &'p Problem<D>, times: &TimeGrid) -> Run<'p, D> {
    let mut history = History::new(times);
    let simulation = simulate(problem, times, &mut history, &mut Unobserved).unwrap();
    assert_eq!((history.len(), simulation.steps), (times.step_count() + 1, times.step_count()));
    Run { problem, history, simulation }
}

impl<const D: usize> Run<'_, D> {
    /// N.
    pub(crate) fn last(&self) -> usize {
        self.history.len() - 1
    }

    /// t_n (s).
    pub(crate) fn time(&self, n: usize) -> f64 {
        self.history.times().instants()[n]
    }

    /// Δt_n (s).
    pub(crate) fn step(&self, n: usize) -> f64 {
        self.history.times().step(n)
    }

    /// u_n (m).
    pub(crate) fn displacement(&self, n: usize) -> &[[f64; D]] {
        self.history.step(n).unwrap().displacement()
    }

    /// v_{n+½} = (u_{n+1} − u_n)/Δt_n (m/s).
    pub(crate) fn half_velocity(&self, n: usize) -> Vec<[f64; D]> {
        let dt = self.step(n);
        let pairs = self.displacement(n).iter().zip(self.displacement(n + 1));
        pairs.map(|(u, next)| std::array::from_fn(|c| (next[c] - u[c]) / dt)).collect()
    }

    /// ½ u_n·K u_n (J).
    pub(crate) fn strain_energy(&self, n: usize) -> f64 {
        let mut force = vec![[0.0; D]; self.problem.mesh().node_count()];
        InternalForces::linear(self.problem)
            .subtract_from_rows(self.displacement(n).as_flattened(), force.as_flattened_mut())
    }

    /// Σ m v_{n+½} (kg m/s).
    pub(crate) fn momentum(&self, n: usize) -> [f64; D] {
        let velocity = self.half_velocity(n);
        let mut sum = [0.0; D];
        for (v, m) in velocity.iter().zip(self.problem.mass()) {
            (0..D).for_each(|c| sum[c] += m * v[c]);
        }
        sum
    }

    /// The node of each entry of reactions.
    pub(crate) fn contact_nodes(&self) -> Vec<usize> {
        self.problem.surface().nodes().iter().map(|c| c.node.index()).collect()
    }
}

/// Largest difference of two fields in any component.
pub(crate) fn difference<const D: usize>(a: &[[f64; D]], b: &[[f64; D]]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().flatten().zip(b.iter().flatten()).fold(0.0, |m, (x, y)| m.max((x - y).abs()))
}

/// Largest component of a field.
pub(crate) fn largest<const D: usize>(a: &[[f64; D]]) -> f64 {
    a.iter().flatten().fold(0.0, |m, x| m.max(x.abs()))
}

/// The mean order of convergence over meshes each twice as fine as the one before.
pub(crate) fn mean_rate(errors: &[f64]) -> f64 {
    (errors[0] / errors[errors.len() - 1]).log2() / (errors.len() - 1) as f64
}

/// Steps that swing `waves` times between 0.5 and 0.9 of `critical` until `end` at least: from one
/// to the next they change by O(Δt²/end).
pub(crate) fn swinging_steps(critical: f64, end: f64, waves: f64) -> TimeGrid {
    let (mut steps, mut time) = (Vec::new(), 0.0);
    while time < end {
        let step = critical * (0.7 + 0.2 * (TAU * waves * time / end).sin());
        steps.push(step);
        time += step;
    }
    TimeGrid::from_steps(&steps).unwrap()
}

/// The aluminium of the paper's block (§7.2) in plane stress, 1 m thick.
pub(crate) fn aluminium() -> Elastic {
    Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap()
}

/// A fixed support of some components.
pub(crate) fn fixed(group: &str, components: [bool; 2]) -> Support {
    Support { group: group.to_string(), components: [components[0], components[1], false], velocity: None }
}

/// A uniform body force that gives the acceleration `g` (m/s²).
pub(crate) fn gravity<const D: usize>(density: f64, g: [f64; D]) -> BodyForce {
    BodyForce { group: None, value: Table::constant(g.map(|g| density * g)) }
}

/// Rollers on all four sides of a rectangle.
pub(crate) fn on_rollers(mesh: Mesh, material: Elastic) -> percute_core::problem::Builder<2> {
    Problem::<2>::builder(mesh)
        .material(material)
        .support(fixed("left", [true, false]))
        .support(fixed("right", [true, false]))
        .support(fixed("bottom", [false, true]))
        .support(fixed("top", [false, true]))
}

/// Nodes of a group of faces.
pub(crate) fn nodes_of(mesh: &Mesh, group: &str) -> Vec<usize> {
    let faces = mesh.face_groups()[group].iter();
    let mut nodes: Vec<usize> = faces.flat_map(|f| mesh.face_nodes::<2>(*f)).map(NodeId::index).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
