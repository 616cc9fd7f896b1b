//! How much memory a run will take, before it begins.

use percute_core::contact_results::{ContactSteps, Resultant};
use percute_core::dynamics::Balance;
use percute_core::ids::{ElementId, FacetId, NodeId};
use percute_core::mesh::Facet;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// How many bytes the contact results of all nodes at all instants take, which an estimate file asks for.
pub(super) fn of_contact<const D: usize, const N: usize>(problem: &Problem<D, N>, times: &TimeGrid) -> u64 {
    let rows = (problem.surface().nodes().len() as u64).saturating_mul(times.step_count() as u64 + 1);
    rows.saturating_mul(ContactSteps::<D>::BYTES as u64)
}

/// About how many bytes problem and simulation take, most of it in proportion to the mesh.
pub(super) fn of_run<const D: usize, const N: usize>(problem: &Problem<D, N>, times: &TimeGrid) -> u64 {
    let mesh = problem.mesh();
    let vector = size_of::<[f64; D]>();
    // Coordinates, initial fields, mass and its inverse; u, v, a and the force of the integrator.
    let node = 8 * vector + 2 * size_of::<f64>() + 2 * size_of::<u32>();
    // Nodes, facets and place in the stars; the element of the stiffness.
    let element = N
        * (size_of::<NodeId>() + size_of::<FacetId>() + size_of::<ElementId>() + size_of::<Option<FacetId>>())
        + size_of::<u16>()
        + (N + 1) * size_of::<u32>()
        + D * vector;
    // With what is supported of it.
    let facet = size_of::<Facet<D>>() + D;
    let instant = size_of::<f64>()
        + size_of::<Balance>()
        + size_of::<f64>()
        + (1 + problem.obstacles().len()) * size_of::<Resultant<D>>();
    let total = [
        (mesh.node_count(), node),
        (mesh.element_count(), element),
        (mesh.facets().len(), facet),
        (times.step_count() + 1, instant),
    ];
    total.iter().map(|&(count, size)| (count as u64).saturating_mul(size as u64)).sum()
}
