//! Displacements that are tried in other orders and from other origins.

use super::attempt::Attempt;
use super::diagnosis::Diagnosis;
use super::holding::descending;
use super::limits::PLACE;
use super::window::rows_of;
use percute_core::history::SinkError;

/// Of so many nodes with the largest residuals, each two are exchanged.
const WORST: usize = 4;

/// Displacements that are changed at all nodes in the same way.
pub(super) fn places(diagnosis: &Diagnosis<'_>) -> Result<Vec<Attempt>, SinkError> {
    let (ends, size) = (&diagnosis.evidence.ends, diagnosis.problem.mesh().size());
    let d = diagnosis.problem.dimension();
    let less = |field: &[f64], rest: &[f64]| -> Vec<f64> { field.iter().zip(rest).map(|(u, x)| u - x).collect() };
    let mut attempts = Vec::new();
    if ends.places <= PLACE {
        let text = "the displacements are places: subtract those of the nodes, displacement - mesh.points".to_string();
        attempts.push(diagnosis.attempt_inside(text, |u| less(u, diagnosis.problem.mesh().points()))?);
    } else if diagnosis.found.initial_displacement > PLACE && size.is_finite() {
        let text =
            "all displacements have another origin: add the same field to all, so that u_0 is `initial_displacement`";
        attempts.push(diagnosis.attempt_inside(text.to_string(), |u| less(u, &rows_of(&ends.offset, d)))?);
    }
    if d == 2 {
        let text = "the components of the displacements are exchanged: y comes before x".to_string();
        attempts.push(
            diagnosis.attempt_inside(text, |u| u.chunks_exact(d).flat_map(|u| u.iter().rev()).copied().collect())?,
        );
    }
    Ok(attempts)
}

/// Other orders of the nodes: all reversed, counted from another number, or two of those with the largest residuals
/// exchanged.
pub(super) fn orders(diagnosis: &Diagnosis<'_>) -> Result<Vec<Attempt>, SinkError> {
    let (count, d) = (diagnosis.evidence.residual.by_node.len(), diagnosis.problem.dimension());
    let first: Vec<usize> = descending(&diagnosis.evidence.residual.by_node).into_iter().take(WORST).collect();
    let mut told: Vec<(Vec<usize>, String)> = vec![
        ((0..count).rev().collect(), "the displacements are in the opposite order of the nodes".to_string()),
        (
            moved(count, 1),
            "the displacements are those of the nodes before: the row of node 1 is that of node 0".to_string(),
        ),
        (
            moved(count, count - 1),
            "the displacements are those of the nodes after: the row of node 0 is that of node 1".to_string(),
        ),
    ];
    for (k, &a) in first.iter().enumerate() {
        for &b in &first[..k] {
            let mut exchanged: Vec<usize> = (0..count).collect();
            exchanged.swap(a, b);
            told.push((exchanged, format!("the displacements of nodes {} and {} are exchanged", a.min(b), a.max(b))));
        }
    }
    let attempts = told.into_iter().map(|(rows, text)| {
        diagnosis.attempt_inside(text, |field: &[f64]| {
            rows.iter().flat_map(|&row| &field[d * row..d * (row + 1)]).copied().collect()
        })
    });
    attempts.collect()
}

/// Rows that are so many places later.
fn moved(count: usize, by: usize) -> Vec<usize> {
    (0..count).map(|node| (node + by) % count).collect()
}
