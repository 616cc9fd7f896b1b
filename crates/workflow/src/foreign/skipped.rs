//! Instants between which the solver made further steps.
//!
//! The second difference of u over the distance T of the samples is a mean of the accelerations between them: over k
//! steps of the solver a + w T² a'' to leading order, with w = (1 − 1/k²)/12. Away from the planes M a are forces that
//! the displacements give, and T² a'' is their second difference.

use super::attempt::{FALL, ROUNDING, falls};
use super::balance::Balance;
use super::diagnosis::Diagnosis;
use super::samples::missing;
use super::window::windows;
use percute_core::border::Vector;
use percute_core::history::SinkError;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;

/// w of two steps, 1/16, to that of many, 1/12, a fifth less and more: up to the critical step, terms of higher order
/// add up to 15 %.
const WEIGHTS: [f64; 2] = [0.8 / 16.0, 1.2 / 12.0];
/// Steps beside each other that agree to this, relatively, are equal; instants in single precision are known to less.
const EQUAL: f64 = 1e-2;

/// That the instants are samples, if the residual away from the planes is that of samples.
pub(super) fn skipped(diagnosis: &Diagnosis<'_>) -> Result<Option<String>, SinkError> {
    let given = diagnosis.evidence.given;
    if given[1] {
        return Ok(None);
    }
    let [size, rest, both, curvature] = products(diagnosis)?;
    let (weight, before) = (both / curvature, (rest / size).sqrt());
    let left = before * (1.0 - both * both / (rest * curvature)).max(0.0).sqrt();
    let fits = (WEIGHTS[0]..=WEIGHTS[1]).contains(&weight) && before > ROUNDING && left <= FALL * before;
    Ok(fits.then(|| {
        format!(
            "the instants are samples, not the steps of the solver: give all steps, or give {} too; with the changes \
             of the forces between the instants, the norm of the residual away from the planes falls {}",
            missing(given),
            falls(before, left)
        )
    }))
}

/// The forces at all nodes at an instant (N).
struct Forces {
    /// F − K u.
    given: Vec<Vector>,
    /// M a, if the steps before and after are equal.
    inertia: Option<Vec<Vector>>,
}

/// Nodes of elements that cannot touch a plane: contact forces, which change at once, do not act on these elements.
fn away(problem: &AnyProblem) -> Vec<usize> {
    let mut away = vec![true; problem.mesh().node_count()];
    let mut touches = vec![false; away.len()];
    problem.contact_nodes().iter().for_each(|contact| touches[contact.node.index()] = true);
    for element in problem.mesh().cells() {
        if element.iter().any(|node| touches[node.index()]) {
            element.iter().for_each(|node| away[node.index()] = false);
        }
    }
    (0..away.len()).filter(|&node| away[node]).collect()
}

/// Sums of squares of the terms and of the residual, its scalar product with the second difference of the forces, and
/// the sum of squares of this (N²), away from the planes.
fn products(diagnosis: &Diagnosis<'_>) -> Result<[f64; 4], SinkError> {
    let (problem, grid) = (diagnosis.problem, diagnosis.source.times());
    let (balance, away) = (Balance::new(problem, grid), away(problem));
    let rest = vec![[0.0; 3]; problem.mesh().node_count()];
    let mut held: Vec<Forces> = Vec::new();
    let mut sums = [0.0; 4];
    windows(diagnosis.source, diagnosis.problem.dimension(), &mut |window| {
        let n = window.now.index;
        let motion = balance.motion(window).filter(|_| n > 0 && equal(grid, n));
        let terms = balance.terms(window.now, motion.as_ref().map_or(&rest, |motion| &motion.acceleration));
        let of = |(f, ku): (&Vector, &Vector)| std::array::from_fn(|c| f[c] - ku[c]);
        let given = terms.load.iter().zip(&terms.stiffness).map(of).collect();
        if held.len() == 3 {
            held.remove(0);
        }
        held.push(Forces { given, inertia: motion.map(|_| terms.inertia) });
        let [Forces { given: before, .. }, Forces { given: now, inertia: Some(inertia) }, Forces { given: after, .. }] =
            held.as_slice()
        else {
            return Ok(());
        };
        for (&node, c) in away.iter().flat_map(|node| (0..3).map(move |c| (node, c))) {
            let [inertia, force] = [inertia[node][c], now[node][c]];
            let (rest, curvature) = (inertia - force, before[node][c] - 2.0 * force + after[node][c]);
            let terms = [inertia * inertia + force * force, rest * rest, rest * curvature, curvature * curvature];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        }
        Ok(())
    })?;
    Ok(sums)
}

/// Whether the steps before and after an instant are equal.
fn equal(grid: &TimeGrid, n: usize) -> bool {
    (grid.step(n) / grid.step(n - 1) - 1.0).abs() <= EQUAL
}
