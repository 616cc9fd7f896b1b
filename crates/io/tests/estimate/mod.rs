//! Estimate files: what was estimated is in them, bit by bit.

use percute_core::contact::Obstacle;
use percute_core::contact_results::ContactResults;
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{AnyProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{Estimate, Estimator, Options, Request};
use percute_io::estimate_file::{EstimateContents, EstimateFile, open, write};
use percute_io::{Case, FileCause, FileError, Kind, Overwrite, history, kind};
use std::path::Path;

mod contact;

const STATEMENT: &str = "[material]\nyoung = 7e10\n";
const REPORT: &str = "{\"sup\": 195.1, \"unit\": \"J^½\"}";

fn block() -> AnyProblem {
    Problem::<2>::builder(Mesh::rectangle(0.05, 0.04, 5, 4).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Uniform([400.0, -400.0]))
        .obstacle(Obstacle::plane([0.0, -2e-4], [0.0, 1.0], 0.2, None).unwrap())
        .build()
        .unwrap()
        .into()
}

fn estimated(problem: &AnyProblem, count: usize, fields: bool) -> Estimate {
    let times = TimeGrid::uniform(0.9 * critical_time_step(problem) * 20.0, 20).unwrap();
    let request = Request { fields, ..Request::evenly(&times, count, 1) };
    let mut estimator = Estimator::new(problem, &times, Options::default()).unwrap().keeping(&request).unwrap();
    simulate(problem, &times, &mut estimator, &mut Unobserved).unwrap();
    estimator.finish().unwrap()
}

fn written(path: &Path, problem: &AnyProblem, estimate: &Estimate) -> Result<EstimateFile, FileError> {
    with_contact(path, problem, estimate, None)
}

fn with_contact(
    path: &Path,
    problem: &AnyProblem,
    estimate: &Estimate,
    contact: Option<&ContactResults>,
) -> Result<EstimateFile, FileError> {
    let case = Some(&Case { name: "block.toml".to_string(), text: "# a case".to_string() });
    let contents = EstimateContents { problem, estimate, contact, statement: STATEMENT, case, report: REPORT };
    write(path, Overwrite::Refuse, &contents)?;
    open(path)
}

/// The numbers of a data set, and its shape.
fn stored(path: &Path, name: &str) -> (Vec<usize>, Vec<u64>) {
    let set = hdf5::File::open(path).unwrap().dataset(name).unwrap();
    (set.shape(), set.read_raw::<f64>().unwrap().into_iter().map(f64::to_bits).collect())
}

fn bits(values: impl IntoIterator<Item = f64>) -> Vec<u64> {
    values.into_iter().map(f64::to_bits).collect()
}

#[test]
fn what_was_estimated_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("error.vtkhdf");
    let problem = block();
    let estimate = estimated(&problem, 4, true);
    let file = written(&path, &problem, &estimate).unwrap();
    assert_eq!(kind(&path).unwrap(), Kind::Estimate);
    assert_eq!((file.statement.as_str(), file.report.as_str()), (STATEMENT, REPORT));
    assert_eq!(file.case.unwrap().name, "block.toml");
    assert_eq!((file.dimension, file.nodes, file.elements, file.fields), (2, 30, 40, true));
    assert_eq!(file.over_time, estimate.over_time);
    assert_eq!(file.by_element, estimate.by_element);
    assert_eq!(file.instants, estimate.maps.iter().map(|map| map.time).collect::<Vec<_>>());
    assert_eq!((file.instants.len(), file.bytes), (4, path.metadata().unwrap().len()));

    let maps = &estimate.maps;
    let cell = |name: &str, take: &dyn Fn(usize) -> Vec<f64>| {
        let expected = bits((0..4).flat_map(take));
        assert_eq!(stored(&path, &format!("VTKHDF/CellData/{name}")), (vec![160], expected), "{name}");
    };
    cell("kinetic", &|k| maps[k].kinetic.clone());
    cell("elastic", &|k| maps[k].elastic.clone());
    cell("contact", &|k| maps[k].contact.clone());
    cell("total", &|k| maps[k].total());
    cell("accumulated", &|k| maps[k].error(estimate.end));
    let (shape, values) = stored(&path, "VTKHDF/CellData/accumulated");
    assert_eq!((shape, &values[120..]), (vec![160], &bits(estimate.by_element.clone())[..]));

    let of = |k: usize| maps[k].fields.as_ref().unwrap();
    let stress = bits((0..4).flat_map(|k| of(k).stress.clone()));
    assert_eq!(stored(&path, "VTKHDF/CellData/admissible_stress"), (vec![160, 4], stress));
    let stress = bits((0..4).flat_map(|k| of(k).compatible_stress.clone()));
    assert_eq!(stored(&path, "VTKHDF/CellData/compatible_stress"), (vec![160, 4], stress));
    let space = |v: &[f64]| v.as_chunks::<2>().0.iter().flat_map(|v| [v[0], v[1], 0.0]).collect::<Vec<_>>();
    let velocity = bits((0..4).flat_map(|k| space(&of(k).velocity)));
    assert_eq!(stored(&path, "VTKHDF/PointData/admissible_velocity"), (vec![120, 3], velocity));
    let displacement = bits((0..4).flat_map(|k| space(&of(k).displacement)));
    assert_eq!(stored(&path, "VTKHDF/PointData/admissible_displacement"), (vec![120, 3], displacement));
    let acceleration = bits((0..4).flat_map(|k| space(&of(k).acceleration)));
    assert_eq!(stored(&path, "VTKHDF/CellData/admissible_acceleration"), (vec![160, 3], acceleration));
    for (name, value) in estimate.residuals.entries() {
        assert_eq!(stored(&path, &format!("percute/residuals/{name}")), (vec![], bits([value])));
    }
    let measures = hdf5::File::open(&path).unwrap().group("percute/measures").unwrap();
    let measure = |name: &str| measures.attr(name).unwrap().read_scalar::<f64>().unwrap();
    assert_eq!((measure("sup"), measure("mean")), (estimate.error.sup, estimate.error.mean));
    assert_eq!((measure("end"), measure("impulse_ratio")), (estimate.end, estimate.impulse_ratio.unwrap()));
}

/// Without maps there are no instants, and the file is a grid with e_E.
#[test]
fn without_maps_and_fields() {
    let folder = tempfile::tempdir().unwrap();
    let bar = Problem::<1>::builder(Mesh::uniform_bar(0.1, 20).unwrap())
        .material(Elastic::bar(70e9, 2700.0, 0.02).unwrap())
        .initial_velocity(Initial::Uniform([-20.0]))
        .obstacle(Obstacle::plane([-1e-5], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap()
        .into();
    for count in [0, 3] {
        let path = folder.path().join(format!("{count}.vtkhdf"));
        let file = written(&path, &bar, &estimated(&bar, count, false)).unwrap();
        assert_eq!((file.dimension, file.nodes, file.elements), (1, 21, 20));
        assert_eq!((file.instants.len(), file.fields), (count, false));
        assert_eq!(hdf5::File::open(&path).unwrap().link_exists("VTKHDF/Steps"), count > 0);
    }
}

#[test]
fn refusals() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("error.vtkhdf");
    let problem = block();
    let estimate = estimated(&problem, 2, false);
    written(&path, &problem, &estimate).unwrap();
    let error = written(&path, &problem, &estimate).unwrap_err();
    assert!(matches!(error.cause, FileCause::Exists), "{error}");
    let (contact, case) = (None, None);
    let contents =
        EstimateContents { problem: &problem, estimate: &estimate, contact, statement: STATEMENT, case, report: "" };
    write(&path, Overwrite::Replace, &contents).unwrap();
    assert_eq!((open(&path).unwrap().case, open(&path).unwrap().report.as_str()), (None, ""));

    let error = history::open(&path).unwrap_err();
    assert!(error.to_string().ends_with("this is an estimate, but a history is needed here"), "{error}");
    let mut other = estimate.clone();
    other.by_element.pop();
    let error = written(&folder.path().join("b"), &problem, &other).unwrap_err();
    assert!(error.to_string().contains("has 40 elements, but 39 are needed"), "{error}");

    let file = hdf5::File::open_rw(&path).unwrap();
    file.unlink("percute/over_time/elastic").unwrap();
    file.new_dataset::<f64>().shape([3]).create("percute/over_time/elastic").unwrap();
    drop(file);
    let error = open(&path).unwrap_err();
    let (FileCause::Hollow { name, .. } | FileCause::Shape { name, .. }) = &error.cause else { panic!("{error}") };
    assert_eq!(name, "percute/over_time/elastic");
}
