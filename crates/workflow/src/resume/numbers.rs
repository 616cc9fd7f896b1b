//! The first difference between meshes, initial fields, instants and kept steps, in words.

use crate::difference::OF_RUN;
use percute_core::mesh::Mesh;
use percute_core::time::TimeGrid;
use percute_io::history::StoredPart;
use std::collections::BTreeMap;
use std::fmt::{Debug, Display};

/// The first difference between two meshes.
pub(super) fn of_meshes(case: &Mesh, history: &Mesh) -> Option<String> {
    if case.dimension() != history.dimension() {
        return Some(told("[mesh], the dimension", case.dimension(), history.dimension()));
    }
    let counts = [
        ("nodes", case.node_count(), history.node_count()),
        ("elements", case.element_count(), history.element_count()),
    ];
    if let Some((of, one, other)) = counts.into_iter().find(|(_, one, other)| one != other) {
        return Some(told(&format!("[mesh], the number of {of}"), one, other));
    }
    let points = |mesh: &Mesh| of_rows(mesh.points(), mesh.dimension());
    let cells = |mesh: &Mesh| mesh.cells().map(|cell| cell.iter().map(|node| node.index()).collect()).collect();
    let (one, other): (Vec<Vec<usize>>, Vec<Vec<usize>>) = (cells(case), cells(history));
    of_lists("[mesh], node", "m", &points(case), &points(history))
        .or_else(|| of_lists("[mesh], the list of nodes of element", "", &one, &other))
        .or_else(|| of_groups(case.face_groups(), history.face_groups()))
        .or_else(|| of_groups(case.element_groups(), history.element_groups()))
}

/// The rows of a field.
fn of_rows(field: &[f64], dimension: usize) -> Vec<Vec<f64>> {
    field.chunks_exact(dimension).map(<[f64]>::to_vec).collect()
}

/// The first entry in which two lists differ.
fn of_lists<T: PartialEq + Debug>(what: &str, unit: &str, case: &[T], history: &[T]) -> Option<String> {
    let at = case.iter().zip(history).position(|(one, other)| one != other)?;
    let value = |of: &T| format!("{of:?} {unit}").trim_end().to_string();
    Some(told(&format!("{what} {at}"), value(&case[at]), value(&history[at])))
}

/// The first group that only one mesh has, or whose members differ.
fn of_groups<T: PartialEq + Debug + Copy>(
    case: &BTreeMap<String, Vec<T>>,
    history: &BTreeMap<String, Vec<T>>,
) -> Option<String> {
    let (name, one, other) = case
        .keys()
        .chain(history.keys())
        .map(|name| (name, case.get(name), history.get(name)))
        .find(|(_, one, other)| one != other)?;
    let what = format!("[mesh], the group \"{name}\"");
    let value = |of: Option<&Vec<T>>| of.map_or("missing".to_string(), |of| format!("one of {}", of.len()));
    let members = one.zip(other).filter(|(one, other)| one.len() == other.len());
    let first = members.and_then(|(one, other)| of_lists(&format!("{what}, entry"), "", one, other));
    Some(first.unwrap_or_else(|| told(&what, value(one), value(other))))
}

/// The first node at which two initial fields differ.
pub(super) fn of_starts(name: &str, unit: &str, [case, history]: [&[f64]; 2], dimension: usize) -> Option<String> {
    let [case, history] = [case, history].map(|field| of_rows(field, dimension));
    of_lists(&format!("the initial `{name}` of node"), unit, &case, &history)
}

/// The first difference between the instants of two runs.
pub(super) fn of_instants(case: &TimeGrid, history: &TimeGrid) -> Option<String> {
    let [steps, others] = [case, history].map(TimeGrid::step_count);
    let instant = |what, one: f64, other: f64| Some(told(what, format!("{one:?} s"), format!("{other:?} s")));
    match case.instants().iter().zip(history.instants()).position(|(one, other)| one != other) {
        _ if case.end() != history.end() => instant("[time], the end", case.end(), history.end()),
        _ if steps != others => Some(told("[time], the number of steps", steps, others)),
        Some(n) => instant(&format!("[time], instant {n}"), case.instants()[n], history.instants()[n]),
        None => None,
    }
}

/// The first difference between what two histories keep.
pub(super) fn of_kept(case: &StoredPart, history: &StoredPart) -> Option<String> {
    let [one, other] = [case, history].map(|kept| kept.steps.len());
    let part = |kept: &StoredPart| [kept.velocity, kept.acceleration, kept.reaction];
    let kept = |there| if there { "kept" } else { "left out" };
    if one != other {
        return Some(told("[output], the number of instants kept", one, other));
    }
    let fields = ["velocity", "acceleration", "reaction"].into_iter().zip(part(case).into_iter().zip(part(history)));
    let field = fields.into_iter().find(|(_, (one, other))| one != other);
    field
        .map(|(name, (one, other))| told(&format!("[output], `fields`: {name}"), kept(one), kept(other)))
        .or_else(|| of_lists("[output], the step of instant", "", &case.steps, &history.steps))
}

fn told(what: &str, case: impl Display, history: impl Display) -> String {
    OF_RUN.differ(what, &case, &history)
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::Mesh;

    type Change<'c> = &'c dyn Fn(&mut Vec<[f64; 2]>, &mut Vec<[usize; 3]>, &mut BTreeMap<String, Vec<[usize; 2]>>);

    fn square(change: Change<'_>) -> Mesh {
        let points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let (mut points, mut cells) = (points, vec![[0, 1, 2], [0, 2, 3]]);
        let mut groups = BTreeMap::from([("low".to_string(), vec![[0, 1]])]);
        change(&mut points, &mut cells, &mut groups);
        Mesh::new(points, &cells, &groups, &BTreeMap::new()).unwrap()
    }

    #[test]
    fn meshes_differ_in_a_count_a_point_a_cell_or_a_group() {
        let one = square(&|_, _, _| ());
        assert_eq!(of_meshes(&one, &one), None);
        let told = |words: &str, change: Change<'_>| {
            assert_eq!(of_meshes(&square(change), &one).as_deref(), Some(words));
        };
        told("[mesh], the number of nodes is 3 in this case and 4 in the history", &|points, cells, _| {
            points.truncate(3);
            cells.truncate(1);
        });
        told("[mesh], node 2 is [1.0, 1.5] m in this case and [1.0, 1.0] m in the history", &|points, _, _| {
            points[2] = [1.0, 1.5];
        });
        told(
            "[mesh], the list of nodes of element 0 is [0, 1, 3] in this case and [0, 1, 2] in the history",
            &|_, cells, _| {
                *cells = vec![[0, 1, 3], [1, 2, 3]];
            },
        );
        told("[mesh], the group \"low\" is missing in this case and one of 1 in the history", &|_, _, groups| {
            groups.clear();
        });
        let other = of_meshes(&square(&|_, _, groups| groups.get_mut("low").unwrap()[0] = [1, 2]), &one).unwrap();
        assert!(other.starts_with("[mesh], the group \"low\", entry 0 is "), "{other}");
    }

    #[test]
    fn instants_differ_in_their_end_their_number_or_one_of_them() {
        let grid = |steps: &[f64]| TimeGrid::from_steps(steps).unwrap();
        let (one, two) = (grid(&[1.0, 1.0]), |steps: &[f64]| of_instants(&grid(steps), &grid(&[1.0, 1.0])));
        assert_eq!(of_instants(&one, &one), None);
        assert_eq!(two(&[1.0, 2.0]).unwrap(), "[time], the end is 3.0 s in this case and 2.0 s in the history");
        assert_eq!(
            two(&[0.5, 0.5, 1.0]).unwrap(),
            "[time], the number of steps is 3 in this case and 2 in the history"
        );
        assert_eq!(two(&[0.5, 1.5]).unwrap(), "[time], instant 1 is 0.5 s in this case and 1.0 s in the history");
    }

    #[test]
    fn histories_differ_in_a_field_or_an_instant_that_they_keep() {
        let kept = |steps: &[usize], velocity| StoredPart {
            steps: steps.to_vec(),
            velocity,
            acceleration: false,
            reaction: true,
        };
        let told = |one: &StoredPart| of_kept(one, &kept(&[0, 2, 4], false));
        assert_eq!(told(&kept(&[0, 2, 4], false)), None);
        for (one, words) in [
            (kept(&[0, 4], false), "[output], the number of instants kept is 2 in this case and 3 in the history"),
            (kept(&[0, 2, 4], true), "[output], `fields`: velocity is kept in this case and left out in the history"),
            (kept(&[0, 3, 4], false), "[output], the step of instant 1 is 3 in this case and 2 in the history"),
        ] {
            assert_eq!(told(&one).as_deref(), Some(words));
        }
    }
}
