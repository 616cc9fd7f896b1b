//! A consistent mass matrix in the place of the lumped one.

use super::attempt::Attempt;
use super::balance::Balance;
use super::diagnosis::Diagnosis;
use super::measure::nodal;
use super::window::windows;
use percute_core::border::Vector;
use percute_core::history::SinkError;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::AnyProblem;

/// The inertia of the consistent mass matrix.
pub(super) fn consistent(diagnosis: &Diagnosis<'_>) -> Result<Attempt, SinkError> {
    let (problem, evidence) = (diagnosis.problem, diagnosis.evidence);
    let balance = Balance::new(problem, diagnosis.source.times());
    let [mut lumped, mut other] = [evidence.residual.clone(), evidence.residual.emptied()];
    if evidence.silent() {
        lumped.leave_the_surface_open();
        other.leave_the_surface_open();
    }
    windows(diagnosis.source, problem.dimension(), &mut |window| {
        let now = window.now;
        let derived = if now.index > 0 { balance.motion(window).map(|motion| motion.acceleration) } else { None };
        let Some(used) = now.acceleration.as_ref().or(derived.as_ref()) else { return Ok(()) };
        let mut terms = balance.terms(now, used);
        terms.inertia = inertia(problem, used);
        other.add(&terms, &nodal(problem, &now.reaction), now.index, now.time);
        Ok(())
    })?;
    let text =
        "the accelerations fit a consistent mass matrix, but percute lumps the mass, each element in equal shares \
                at its nodes: run the other program with a lumped mass"
            .to_string();
    Ok(Attempt { text, before: lumped.norm([1.0; 4]), left: other.norm([1.0; 4]) })
}

/// M_c a (N) of linear elements: m/(N(N+1)) times the sum over the nodes, with that of the node itself twice. It is 0
/// at prescribed components.
fn inertia(problem: &AnyProblem, acceleration: &[Vector]) -> Vec<Vector> {
    let mut inertia = vec![[0.0; 3]; acceleration.len()];
    let n = problem.mesh().nodes_of_element();
    for (e, nodes) in problem.mesh().cells().enumerate() {
        let id = ElementId::new(e);
        let share = problem.material(id).density() * problem.volume(id) / (n * (n + 1)) as f64;
        for c in 0..3 {
            let sum: f64 = nodes.iter().map(|node| acceleration[node.index()][c]).sum();
            nodes.iter().for_each(|n| inertia[n.index()][c] += share * (sum + acceleration[n.index()][c]));
        }
    }
    problem.prescribed().iter().for_each(|p| inertia[p.node.index()][p.component] = 0.0);
    inertia
}
