//! Whether a reference is a simulation of the same problem: it may differ in mesh, steps and samples only.

use crate::case::{NotRepresentable, statement};
use crate::difference::Sides;
use percute_core::border::Vector;
use percute_core::ids::NodeId;
use percute_core::problem::AnyProblem;
use toml::{Table, Value};

/// Both, and what rounding may do to numbers that were computed for each mesh anew.
const SIDES: Sides = Sides { names: ["the history", "the reference"], same: 1e-9 };
/// Points that are nearer, over the size of the mesh, are one point.
const ONE_POINT: f64 = 1e-9;
/// What follows from the mesh where the contact of two bodies is looked for.
const OF_THE_MESH: [&str; 2] = ["groups", "matching"];

/// The first difference between the problem of a history and that of its reference, in words. Initial fields are
/// compared where they are uniform in each body: others depend on the mesh.
///
/// # Errors
/// A problem that the language of the case files cannot say.
pub(crate) fn difference(history: &AnyProblem, reference: &AnyProblem) -> Result<Option<String>, NotRepresentable> {
    let (one, other) = (stated(history)?, stated(reference)?);
    let fields = || {
        let displacement = [history.initial_displacement(), reference.initial_displacement()];
        let velocity = [history.initial_velocity(), reference.initial_velocity()];
        let first = of_field([history, reference], "displacement", "m", displacement);
        first.or_else(|| of_field([history, reference], "velocity", "m/s", velocity))
    };
    Ok(SIDES.of_documents(&one, &other, false).or_else(fields))
}

/// The statement of a problem without what its mesh determines.
fn stated(problem: &AnyProblem) -> Result<Table, NotRepresentable> {
    let mut stated = statement(problem, None)?.parse::<Table>().unwrap_or_default();
    if let Some(Value::Array(contacts)) = stated.get_mut("contact") {
        for contact in contacts.iter_mut().filter_map(Value::as_table_mut) {
            OF_THE_MESH.iter().for_each(|key| drop(contact.remove(*key)));
        }
        // The number of surfaces between two bodies depends on the mesh, too.
        contacts.dedup();
    }
    Ok(stated)
}

/// The first body in which two uniform fields differ.
fn of_field([one, other]: [&AnyProblem; 2], name: &str, unit: &str, [field, fine]: [&[f64]; 2]) -> Option<String> {
    let largest = field.iter().chain(fine).fold(0.0_f64, |most, x| most.max(x.abs()));
    let (d, of_other) = (one.dimension(), other.dimension());
    if d != of_other {
        return None;
    }
    let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| SIDES.same(*a, *b, largest));
    let row = |field: &[f64], node: usize| field[d * node..d * (node + 1)].to_vec();
    let uniform = |problem: &AnyProblem, field: &[f64]| {
        let part = problem.mesh().part_of_nodes();
        part.iter().zip(field.chunks_exact(d)).all(|(first, value)| same(value, &row(field, first.index())))
    };
    if !uniform(one, field) || !uniform(other, fine) {
        return None;
    }
    let near = ONE_POINT * one.mesh().size();
    let bodies = one.mesh().part_of_nodes().into_iter().enumerate().filter(|(node, first)| first.index() == *node);
    bodies.map(|(node, _)| node).find_map(|node| {
        // Nodes of two bodies may lie at one place.
        let (place, own) = (one.mesh().point(NodeId::new(node)), row(field, node));
        let at = |point: &Vector| point.iter().zip(&place).all(|(a, b)| (a - b).abs() <= near);
        let places = other.mesh().places().zip(fine.chunks_exact(d)).filter(|(point, _)| at(point));
        let values: Vec<&[f64]> = places.map(|(_, value)| value).collect();
        let first = values.first().filter(|_| !values.iter().any(|value| same(value, &own)))?;
        let shown = |value: &[f64]| format!("{value:?} {unit}");
        let what = format!("the initial `{name}` of node {node}");
        Some(SIDES.differ(&what, &shown(&own), &shown(first)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::contact::Obstacle;
    use percute_core::material::Elastic;
    use percute_core::mesh::Mesh;
    use percute_core::problem::{Initial, Problem};

    struct Block {
        young: f64,
        velocity: [f64; 2],
        gap: f64,
        cells: usize,
    }

    const BLOCK: Block = Block { young: 70e9, velocity: [0.0, -10.0], gap: 1e-5, cells: 4 };

    fn problem(block: &Block) -> AnyProblem {
        let mesh = Mesh::rectangle(0.05, 0.04, block.cells, block.cells).unwrap();
        let built = Problem::<2>::builder(mesh)
            .material(Elastic::plane_stress(block.young, 0.3, 2700.0, 1.0).unwrap())
            .initial_velocity(Initial::Uniform(block.velocity))
            .obstacle(Obstacle::plane([0.0, -block.gap], [0.0, 1.0], 0.2, None).unwrap())
            .build();
        built.unwrap().into()
    }

    #[test]
    fn a_reference_differs_in_its_mesh_alone() {
        let told = |block: &Block| difference(&problem(&BLOCK), &problem(block)).unwrap();
        assert_eq!(told(&Block { cells: 8, ..BLOCK }), None);
        // A gap that was computed for each mesh.
        assert_eq!(told(&Block { cells: 8, gap: 0.1 * 1e-4 * (1.0 + 1e-15), ..BLOCK }), None);
        for (block, words) in [
            (
                Block { young: 210e9, cells: 8, ..BLOCK },
                "[[material]] 1, young is 70000000000.0 in the history and 210000000000.0 in the reference",
            ),
            (
                Block { gap: 1.2e-5, cells: 8, ..BLOCK },
                "[[obstacle]] 1, point[1] is -1e-5 in the history and -1.2e-5 in the reference",
            ),
            (
                Block { velocity: [0.0, -20.0], cells: 8, ..BLOCK },
                "the initial `velocity` of node 0 is [0.0, -10.0] m/s in the history and [0.0, -20.0] m/s in the \
                 reference",
            ),
        ] {
            assert_eq!(told(&block).as_deref(), Some(words));
        }
    }

    #[test]
    fn fields_that_vary_depend_on_the_mesh() {
        let varying = |cells: usize, factor: f64| {
            let mesh = Mesh::rectangle(0.05, 0.04, cells, cells).unwrap();
            let velocity = mesh.points_in::<2>().iter().map(|point| [factor * point[0], -10.0]).collect();
            let law = Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap();
            let built = Problem::<2>::builder(mesh).material(law).initial_velocity(Initial::Nodal(velocity)).build();
            AnyProblem::from(built.unwrap())
        };
        assert_eq!(difference(&varying(4, 1.0), &varying(8, 1.01)).unwrap(), None);
    }
}
