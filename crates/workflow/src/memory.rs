//! How much memory a run will take, before it begins.

use crate::message::bytes;
use percute_core::contact_results::{ContactSteps, Resultant};
use percute_core::dynamics::Balance;
use percute_core::ids::{ElementId, FaceId, NodeId};
use percute_core::memory::can_be_had;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;

/// Beside the prediction.
const MARGIN: u64 = 16 << 20;

/// How many bytes a history takes in memory.
#[must_use]
pub fn of_history(problem: &AnyProblem, times: &TimeGrid) -> u64 {
    let (nodes, contact) = (problem.mesh().node_count(), problem.contact_nodes().len());
    let internal = problem.variables() * problem.mesh().element_count();
    let numbers = (nodes + contact) * problem.dimension() + internal;
    let instant = numbers * size_of::<f64>() + contact * size_of::<bool>();
    (times.step_count() as u64 + 1).saturating_mul(instant as u64)
}

/// Bytes of memory that this machine has free, where it tells.
#[must_use]
pub fn available() -> Option<u64> {
    let told = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = told.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix(" kB")?.parse::<u64>().ok()?.checked_mul(1024)
}

/// What to say if more memory is needed than is free.
#[must_use]
pub fn scarce(needed: u64, free: Option<u64>, in_memory: bool) -> Option<String> {
    let free = free.filter(|free| needed > *free)?;
    let (needed, free) = (bytes(needed), bytes(free));
    let file = if in_memory { ", or store the history in a file, whole or in part (`every`)" } else { "" };
    Some(format!(
        "the run needs about {needed} of memory, but {free} are free: use a coarser mesh, fewer steps, fewer samples \
         of the error (`every`) or a larger machine{file}"
    ))
}

/// What to say if so much memory cannot be had.
#[must_use]
pub fn refusal(needed: u64) -> Option<String> {
    // The prediction is good to a tenth; threads and the library need some, too.
    if can_be_had(needed.saturating_add(needed / 10).saturating_add(MARGIN)) {
        return None;
    }
    let needed = bytes(needed);
    Some(format!(
        "the run needs about {needed} of memory, which is not available: use a coarser mesh, fewer steps, fewer \
         samples of the error (`every`), or a larger machine or limit (`ulimit -v`)"
    ))
}

/// How many bytes the contact results of all nodes at all instants take, which an estimate file asks for.
pub(crate) fn of_contact(problem: &AnyProblem, times: &TimeGrid) -> u64 {
    let rows = (problem.contact_nodes().len() as u64).saturating_mul(times.step_count() as u64 + 1);
    rows.saturating_mul(ContactSteps::bytes(problem.dimension()) as u64)
}

/// About how many bytes problem and simulation take, most of it in proportion to the mesh.
#[must_use]
pub fn of_run(problem: &AnyProblem, times: &TimeGrid) -> u64 {
    let mesh = problem.mesh();
    let (d, n) = (mesh.dimension(), mesh.nodes_of_element());
    let vector = d * size_of::<f64>();
    // Coordinates, initial fields, mass and its inverse; u, v, a and the force of the integrator.
    let node = 8 * vector + 2 * size_of::<f64>() + 2 * size_of::<u32>();
    // Nodes, faces and place in the stars; the element of the stiffness.
    let element = n
        * (size_of::<NodeId>() + size_of::<FaceId>() + size_of::<ElementId>() + size_of::<Option<FaceId>>())
        + size_of::<u16>()
        + (n + 1) * size_of::<u32>()
        + d * vector;
    // With what is supported of it.
    let face = d * size_of::<NodeId>() + 2 * size_of::<ElementId>() + d;
    let instant = size_of::<f64>()
        + size_of::<Balance>()
        + size_of::<f64>()
        + (1 + problem.obstacle_count()) * size_of::<Resultant>();
    // The problem in a local order, beside that of the user: all but the vectors of the integrator, and old numbers.
    let ordered = if mesh.local_numbering().is_none() {
        [0; 3]
    } else {
        [node - 5 * vector + size_of::<NodeId>(), element - d * vector + size_of::<ElementId>(), face]
    };
    let total = [
        (mesh.node_count(), ordered[0]),
        (mesh.element_count(), ordered[1]),
        (mesh.face_count(), ordered[2]),
        (mesh.node_count(), node),
        (mesh.element_count(), element),
        (mesh.face_count(), face),
        (times.step_count() + 1, instant),
    ];
    total.iter().map(|&(count, size)| (count as u64).saturating_mul(size as u64)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_there_is_is_told() {
        assert_eq!(scarce(1000, Some(1000), true), None);
        assert_eq!(scarce(1001, None, true), None);
        let told = scarce(8_000_000_000, Some(1_000_000_000), true).unwrap();
        assert!(told.contains("8.00 GB") && told.contains("1.00 GB") && told.contains("in a file"), "{told}");
        assert!(scarce(1001, Some(1000), false).is_some_and(|told| !told.contains("in a file")));
        assert_eq!(refusal(1000), None);
        assert!(refusal(1 << 60).is_some_and(|told| told.contains("coarser mesh")));
    }
}
