//! Fields of the elements from the motion of the nodes.

use crate::bridge::Watch;
use crate::problem::ProblemData;
use crate::{bridge, errors};
use numpy::{IntoPyArray, PyArrayDyn, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use percute_core::border::vectors;
use percute_core::element_state::{
    ElementState, displacement_gradient, first_piola_stress, kinetic_energy, principal_stretches, principal_values,
};
use percute_core::ids::ElementId;
use percute_core::problem::AnyProblem;
use pyo3::prelude::*;

/// Numbers of one element, from the rows of all nodes at an instant and the internal variables of all elements.
type Numbers = fn(&AnyProblem, ElementId, [&[f64]; 2], &mut Vec<f64>);

/// A quantity of each element at instants: (instants, elements), of one with components (instants, elements,
/// dimension), of a tensor (instants, elements, dimension, dimension). `nodal` are velocities (m/s) for
/// `kinetic_energy` and displacements (m) for the others, (instants, nodes, dimension); `internal` are the internal
/// variables of materials that yield, (instants, elements, variables).
#[pyfunction]
#[pyo3(signature = (problem, quantity, nodal, internal=None))]
pub(crate) fn element_field<'py>(
    py: Python<'py>,
    problem: &ProblemData,
    quantity: &str,
    nodal: PyReadonlyArray3<'py, f64>,
    internal: Option<PyReadonlyArray3<'py, f64>>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let problem = &problem.problem;
    let shape = nodal.shape().to_vec();
    let (numbers, order) = quantity_of(quantity).ok_or_else(|| errors::input(py, "no such quantity"))?;
    let (nodes, elements) = (problem.mesh().node_count(), problem.mesh().element_count());
    let dimension = problem.dimension();
    if (shape[1], shape[2]) != (nodes, dimension) {
        return Err(errors::input(
            py,
            format!(
                "the field has the shape {shape:?}; it must be (instants, {nodes}, \
                {dimension})"
            ),
        ));
    }
    let (problem, rows) = (problem.clone(), nodal.as_slice()?.to_vec());
    let internal = internal.map_or_else(|| Ok(Vec::new()), |internal| internal.as_slice().map(<[f64]>::to_vec))?;
    let needed = shape[0] * elements * problem.variables();
    if internal.len() != needed {
        let told = format!("{needed} internal variables are needed, and {} are given", internal.len());
        return Err(errors::input(py, told));
    }
    let work = move |watch: Watch| over_time(&problem, [&rows, &internal], numbers, watch);
    let values = bridge::blocking(py, None, work)?;
    let shape = [&[shape[0], elements], &[dimension; 2][..order]].concat();
    let array = values.into_pyarray(py).reshape(shape)?;
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// The numbers of all elements at all instants, until `watch` asks for a stop.
fn over_time(problem: &AnyProblem, [rows, internal]: [&[f64]; 2], numbers: Numbers, watch: Watch) -> Vec<f64> {
    let (mut values, count) = (Vec::new(), problem.variables() * problem.mesh().element_count());
    for (k, instant) in rows.chunks_exact(problem.dimension() * problem.mesh().node_count()).enumerate() {
        if watch.0.stopped() {
            break;
        }
        let elements = (0..problem.mesh().element_count()).map(ElementId::new);
        let internal = internal.get(k * count..(k + 1) * count).unwrap_or_default();
        elements.for_each(|element| numbers(problem, element, [instant, internal], &mut values));
    }
    values
}

/// The numbers of a quantity, and the order of its tensor.
fn quantity_of(quantity: &str) -> Option<(Numbers, usize)> {
    Some(match quantity {
        "strain" => (|p, e, at, to| to.extend(tensor(p, &state(p, e, at).strain)), 2),
        "stress" => (|p, e, at, to| to.extend(tensor(p, &state(p, e, at).stress)), 2),
        "first_piola" => (|p, e, [u, internal], to| to.extend(tensor(p, &first_piola_stress(p, e, u, internal))), 2),
        "principal_stretches" => (|p, e, [u, _], to| to.extend(stretches(p, e, u)), 1),
        "stress_across" => (|p, e, at, to| to.push(state(p, e, at).stress_across), 0),
        "von_mises" => (|p, e, at, to| to.push(state(p, e, at).von_mises()), 0),
        "pressure" => (|p, e, at, to| to.push(state(p, e, at).pressure()), 0),
        "strain_energy" => (|p, e, at, to| to.push(state(p, e, at).strain_energy), 0),
        "plastic_strain" => (|p, e, at, to| to.extend(tensor(p, &plastic_strain(&state(p, e, at)))), 2),
        "equivalent_plastic_strain" => (|p, e, at, to| to.push(state(p, e, at).equivalent_plastic_strain), 0),
        "plastic_work" => (|p, e, at, to| to.push(state(p, e, at).plastic_work), 0),
        "kinetic_energy" => (|p, e, [v, _], to| to.push(kinetic_energy(p, e, v)), 0),
        _ => return None,
    })
}

/// The principal stretches, the larger first: of a solid the roots of the eigenvalues of FᵀF.
fn stretches(problem: &AnyProblem, element: ElementId, displacement: &[f64]) -> Vec<f64> {
    let AnyProblem::D3(solid) = problem else {
        return principal_stretches(problem, element, displacement)[..problem.dimension()].to_vec();
    };
    let gradient = displacement_gradient::<3>(solid.mesh(), element, vectors(displacement));
    let right: [[f64; 3]; 3] = std::array::from_fn(|a| {
        std::array::from_fn(|b| {
            let products: f64 = (0..3).map(|c| gradient[c][a] * gradient[c][b]).sum();
            f64::from(u8::from(a == b)) + gradient[a][b] + gradient[b][a] + products
        })
    });
    principal_values(&right).into_iter().rev().map(f64::sqrt).collect()
}

fn state(problem: &AnyProblem, element: ElementId, [displacement, internal]: [&[f64]; 2]) -> ElementState {
    ElementState::new(problem, element, displacement, internal)
}

/// ε_p as a tensor.
fn plastic_strain(state: &ElementState) -> [[f64; 3]; 3] {
    let [xx, yy, zz, xy] = state.plastic_strain;
    [[xx, xy, 0.0], [xy, yy, 0.0], [0.0, 0.0, zz]]
}

/// The components of a tensor in the dimension of a problem.
fn tensor(problem: &AnyProblem, tensor: &[[f64; 3]; 3]) -> impl Iterator<Item = f64> {
    let dimension = problem.dimension();
    tensor.iter().take(dimension).flat_map(move |row| row.iter().take(dimension)).copied()
}
