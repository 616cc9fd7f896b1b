//! The tables of effectivities, true errors and runs.

use super::cases::Kind;
use super::study::{Case, ESTIMATED, Found};
use crate::reproduce::table::{Cell, Column, Table};
use percute_estimator::Reconstruction;

/// A case with what was found on each mesh.
pub(super) type Result = (Case, Vec<Option<Found>>);

/// Largest over time, and mean.
pub(super) const MEASURES: [&str; 2] = ["sup", "mean"];

/// Name of the column of a measure on a mesh.
pub(super) fn on_mesh(measure: &str, mesh: usize) -> String {
    format!("{measure}, mesh {}", mesh + 1)
}

/// A column for each measure on each mesh.
fn measured(column: impl Fn(Column) -> Column) -> impl Iterator<Item = Column> {
    MEASURES
        .into_iter()
        .flat_map(|measure| (0..ESTIMATED.len()).map(move |mesh| Column::new(on_mesh(measure, mesh))))
        .map(column)
}

/// The cells of those columns.
fn values(found: &[Option<Found>], value: impl Fn(&Found) -> Option<[f64; 2]>) -> Vec<Cell> {
    let value = |found: &Option<Found>, m: usize| found.as_ref().and_then(&value).map(|pair| pair[m]);
    (0..MEASURES.len())
        .flat_map(|m| found.iter().map(move |found| (found, m)))
        .map(|(f, m)| value(f, m).into())
        .collect()
}

/// e/e_ref of each case and reading.
pub(super) fn effectivities(results: &[Result]) -> Table {
    let columns = ["kind", "case", "contact force"].map(Column::new).into_iter();
    let caption = "Effectivity e/e_ref of the largest error and of the mean, on the four meshes from the coarsest to the finest, each with four \
                   times as many elements as the one before, against the finest reference. Where nothing stands, the body starts too near to \
                   its plane for the steps of that mesh.";
    let mut table = Table::new("effectivity", caption, columns.chain(measured(|column| column.digits(3))).collect());
    for (case, found) in results {
        for (r, reading) in Reconstruction::ALL.iter().enumerate() {
            let words = [case.kind().name().into(), case.name().into(), Cell::from(reading.to_string())];
            table.push(words.into_iter().chain(values(found, |found| Some(found.effectivity(r)))));
        }
    }
    table
}

/// What each case is, and how it touches on the finest mesh.
pub(super) fn cases(results: &[Result]) -> Table {
    let columns = vec![
        Column::new("case"),
        Column::new("elements of mesh 1"),
        Column::new("steps on mesh 1"),
        Column::new("gap").unit("mm").digits(2),
        Column::new("T").unit("µs").digits(3),
        Column::new("touches from").unit("µs").digits(3),
        Column::new("until").unit("µs").digits(3),
        Column::new("most nodes at once"),
        Column::new("nodes at the end"),
    ];
    let caption = "The cases: what is estimated, and how the finest of the four meshes touches the plane.";
    let mut table = Table::new("effectivity-cases", caption, columns);
    for (case, found) in results {
        let (coarse, fine) = (found.first().and_then(Option::as_ref), found.last().and_then(Option::as_ref));
        let during = fine.and_then(|found| found.touch.during);
        table.push([
            case.name().into(),
            coarse.map(|found| found.elements).into(),
            coarse.map(|found| found.steps).into(),
            (1e3 * case.gap).into(),
            (1e6 * case.end).into(),
            during.map(|during| 1e6 * during[0]).into(),
            during.map(|during| 1e6 * during[1]).into(),
            fine.map(|found| found.touch.most).into(),
            Cell::from(fine.map(|found| found.touch.last)),
        ]);
    }
    table
}

/// e_ref against each reference.
pub(super) fn references(results: &[Result]) -> Table {
    let columns = [Column::new("case"), Column::new("elements of the reference")].into_iter();
    let caption = "True error e_ref (J^½) of each mesh against references of more and more elements: how far it still moves is how far the reference \
                   is from the limit.";
    let columns = columns.chain(measured(|column| column.unit("J^½"))).collect();
    let mut table = Table::new("effectivity-references", caption, columns);
    for (case, found) in results {
        let coarsest = found.iter().zip(ESTIMATED).find_map(|(f, level)| f.as_ref().map(|f| f.elements >> (2 * level)));
        for (k, &level) in case.references.iter().enumerate() {
            let words = [case.name().into(), Cell::from(coarsest.map(|elements| elements << (2 * level)))];
            table.push(words.into_iter().chain(values(found, |found| found.exact.get(k).copied())));
        }
    }
    table
}

/// By how much a reference moves the true error on mesh 4 from that of the reference before it, relative: the larger of
/// sup and mean, for each reference but the first.
pub(super) fn moves(found: &[Option<Found>]) -> Vec<f64> {
    let exact = found.last().and_then(Option::as_ref).map_or(&[][..], |found| &found.exact);
    let one =
        |pair: &[[f64; 2]]| (0..MEASURES.len()).map(|m| (pair[1][m] / pair[0][m] - 1.0).abs()).fold(0.0, f64::max);
    exact.windows(2).map(one).collect()
}

/// The range of each kind with each reading, and how it moves under refinement.
pub(super) fn kinds(results: &[Result]) -> Table {
    let columns = vec![
        Column::new("kind"),
        Column::new("contact force"),
        Column::new("measure"),
        Column::new("lowest").digits(3),
        Column::new("highest").digits(3),
        Column::new("lowest, meshes 3 and 4").digits(3),
        Column::new("highest, meshes 3 and 4").digits(3),
        Column::new("largest growth, mesh 2 to 4").unit("ratio").digits(3),
    ];
    let caption = "The effectivities of all cases of a kind: their range on all meshes and on the two finer ones, and by how much \
                   the value on mesh 4 exceeds that on mesh 2 in the case where it does so most (below 1: it falls in all).";
    let mut table = Table::new("effectivity-kinds", caption, columns);
    for kind in Kind::ALL {
        for (r, reading) in Reconstruction::ALL.iter().enumerate() {
            for (m, measure) in MEASURES.into_iter().enumerate() {
                let cases: Vec<Vec<f64>> = of_kind(results, kind, r, m);
                let range = |from: usize| {
                    let values = || cases.iter().flat_map(|values| &values[from..]).copied().filter(|v| v.is_finite());
                    [values().fold(f64::NAN, f64::min), values().fold(f64::NAN, f64::max)]
                };
                let growth = cases.iter().map(|values| values[3] / values[1]).fold(f64::NAN, f64::max);
                let words = [kind.name().into(), reading.to_string().into(), Cell::from(measure)];
                let numbers = range(0).into_iter().chain(range(2)).chain([growth]);
                if !cases.is_empty() {
                    table.push(words.into_iter().chain(numbers.map(Cell::from)));
                }
            }
        }
    }
    table
}

/// The effectivities of each case of a kind on the meshes, NaN where there is none.
fn of_kind(results: &[Result], kind: Kind, reading: usize, measure: usize) -> Vec<Vec<f64>> {
    let value = |found: &Option<Found>| found.as_ref().map_or(f64::NAN, |found| found.effectivity(reading)[measure]);
    let results = results.iter().filter(|(case, _)| case.kind() == kind);
    results.map(|(_, found)| found.iter().map(value).collect()).collect()
}

/// All runs.
pub(super) fn runs(results: &[Result]) -> Table {
    let joule = |name: &str, equation: &str| Column::new(name).unit("J^½").equation(equation);
    let columns = vec![
        Column::new("case"),
        Column::new("contact force"),
        Column::new("elements"),
        Column::new("steps"),
        joule("e sup", "[15]"),
        joule("e mean", "[16]"),
        Column::new("ε sup").equation("[22]"),
        Column::new("ε mean").equation("[22]"),
        Column::new("impulse kept"),
        Column::new("contact part at the sup").unit("%").digits(3),
        joule("e_ref sup", ""),
        joule("e_ref mean", ""),
    ];
    let caption = "All runs: estimate, relative error, the part of the contact impulse that the admissible force keeps, and true error.";
    let mut table = Table::new("effectivity-runs", caption, columns).long();
    for (case, found) in results {
        for (r, reading) in Reconstruction::ALL.iter().enumerate() {
            for found in found.iter().flatten() {
                let e = &found.estimates[r];
                let [sup, mean] = found.exact.last().copied().unwrap_or([f64::NAN; 2]);
                let words =
                    [case.name().into(), reading.to_string().into(), found.elements.into(), Cell::from(found.steps)];
                let errors = [e.sup, e.mean, e.relative_sup, e.relative_mean].map(Cell::from);
                let rest =
                    [Cell::from(found.kept_impulse[r]), (100.0 * found.contact[r]).into(), sup.into(), mean.into()];
                table.push(words.into_iter().chain(errors).chain(rest));
            }
        }
    }
    table
}
