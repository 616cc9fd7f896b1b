//! The mesh of a plan by bisection of the first mesh.

use crate::failure::Failure;
use crate::plan::{Basis, Branch, Plan, PlannedSizes, sizes};
use percute_core::ids::ElementId;
use percute_core::mesh::{Bisection, Mesh};
use std::sync::Arc;

/// An element is cut if its size is above so many times the wanted one: from the first, with which sizes differ least
/// from the wanted ones, until the mesh has the planned error.
const TOLERANCES: [f64; 5] = [2.0, 1.68, 1.41, 1.19, 1.05];
/// Elements of one size are cut alike, although their sizes differ by rounding.
const ROUNDING: f64 = 1e-9;
/// How often elements are cut with one tolerance at most: 2^40 is more than the numbers of elements.
const ROUNDS: usize = 40;
/// The squared error of a mesh may exceed the planned one by this part.
const ABOVE: f64 = 1.02;

/// Cuts the first mesh, so that elements also become larger than those of the run, until it has `most` elements at
/// most. Returns the mesh and the mean error that is expected on it, over that of the run.
pub(super) fn bisected(
    first: &Bisection,
    run: &Mesh,
    (basis, plan): (&Basis, &Plan),
    most: usize,
) -> Result<(Arc<Mesh>, f64), Failure> {
    let (wanted, mut bisection) = (PlannedSizes::new(run, basis, plan), first.clone());
    let mut predicted = f64::INFINITY;
    for tolerance in TOLERANCES {
        for _ in 0..ROUNDS {
            let chosen = wanted.too_large(bisection.mesh(), (1.0 + ROUNDING) * tolerance);
            if !chosen.contains(&true) || chosen.len() > most {
                break;
            }
            let cut = bisection.cut(|e| chosen[e.index()]);
            cut.map_err(|error| Failure::Argument(format!("the mesh cannot be refined: {error}")))?;
        }
        predicted = expected(&wanted, bisection.mesh(), basis, plan);
        if predicted * predicted <= ABOVE * plan.predicted * plan.predicted {
            break;
        }
    }
    Ok((bisection.mesh().clone(), predicted))
}

/// The mean error that is expected on a mesh, over that of the run.
pub(super) fn expected(wanted: &PlannedSizes<'_>, mesh: &Mesh, basis: &Basis, plan: &Plan) -> f64 {
    let count = basis.size().len();
    let (mut volume, mut parts, mut least) = (vec![0.0; count], vec![0.0; count], vec![f64::INFINITY; count]);
    let size = sizes(mesh);
    for (e, h) in size.iter().enumerate() {
        let old = wanted.element_of(mesh, ElementId::new(e)).index();
        volume[old] += h.powi(mesh.dimension() as i32);
        parts[old] += 1.0;
        least[old] = least[old].min(*h);
    }
    let graded = |old: usize| plan.branch == Branch::Graded && basis.touches()[old];
    let ratio = |old: usize| match parts[old] {
        // A larger element covers it.
        0.0 => 1.0,
        parts if graded(old) => {
            (volume[old] / parts).powf(1.0 / mesh.dimension() as f64).min(least[old]) / basis.size()[old]
        }
        parts => (volume[old] / parts).powf(1.0 / mesh.dimension() as f64) / basis.size()[old],
    };
    let ratio: Vec<f64> = (0..count).map(ratio).collect();
    plan.predicted_on(basis, &ratio, size.into_iter().fold(f64::INFINITY, f64::min))
}
