//! Sampling as sparse as keeps the mean, on meshes so fine that not all steps are samples.

use crate::properties::bodies::{plane_below, steps, thrown};
use crate::properties::estimating::{estimate, estimate_with_maps, history};
use percute_core::history::History;
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::{Estimate, Options, Reconstruction, Request, Sampling};

/// A block of so many columns that strikes a plane.
fn block(columns: usize, tilt: f64) -> Problem<2> {
    let mesh = Mesh::rectangle(0.05, 0.04, columns, columns * 4 / 5).unwrap();
    let plane = plane_below(&mesh, tilt, 2e-4, 0.2, None);
    thrown(mesh, [400.0, -400.0], plane).build().unwrap()
}

/// A flat and a tilted block, with so many steps that every second and every third is a sample.
fn cases() -> [(Problem<2>, usize); 2] {
    [(block(50, 0.0), 90), (block(55, 0.05), 130)]
}

fn all(options: Options) -> Options {
    Options { every: Sampling::Every(1), ..options }
}

/// The instants of all samples at levels.
fn sampled(estimate: &Estimate, times: &TimeGrid) -> Vec<usize> {
    let mut steps: Vec<usize> =
        estimate.over_time.iter().filter_map(|s| times.instants().iter().position(|t| *t == s.time)).collect();
    steps.dedup();
    steps
}

#[test]
fn sup_and_mean_are_within_a_hundredth_of_those_of_all_steps() {
    for (problem, count) in cases() {
        let times = steps(&problem, 0.9, count);
        let history = history(&problem, &times);
        for &reconstruction in Reconstruction::ALL {
            let options = Options { reconstruction, ..Options::default() };
            assert_eq!(options.every, Sampling::Auto);
            let (sparse, dense) = (estimate(&problem, &history, options), estimate(&problem, &history, all(options)));
            let samples = sampled(&sparse, &times).len();
            assert!(samples > 32 && samples < count, "{reconstruction}: {samples} samples in {count} steps");
            for (name, a, b) in [
                ("sup", sparse.error.sup, dense.error.sup),
                ("mean", sparse.error.mean, dense.error.mean),
                ("d", sparse.error.reference_mean, dense.error.reference_mean),
            ] {
                assert!((a / b - 1.0).abs() < 0.01, "{reconstruction}, {count}: {name} {a} instead of {b}");
            }
        }
    }
}

#[test]
fn sums_agree() {
    let (problem, count) = cases().into_iter().nth(1).unwrap();
    let times = steps(&problem, 0.9, count);
    let history = history(&problem, &times);
    for &reconstruction in Reconstruction::ALL {
        let options = Options { reconstruction, ..Options::default() };
        let request = Request { fields: false, ..Request::evenly(&times, 3, 1) };
        let estimate = estimate_with_maps(&problem, &history, options, &request);
        let square = estimate.error.mean * estimate.error.mean;
        let sum: f64 = estimate.by_element.iter().map(|e| e * e).sum();
        assert!((sum - square).abs() <= 1e-12 * square, "{reconstruction}: {sum} for {square}");
        assert_eq!(estimate.maps[2].error(estimate.end), estimate.by_element);
        if let Some(sources) = estimate.sources {
            assert!((sources.mean.total() - square).abs() <= 1e-12 * square);
            assert_eq!(sources.over_time.len(), estimate.over_time.len());
        }
    }
}

/// The numbers of an estimate.
fn bits(estimate: &Estimate) -> Vec<u64> {
    let (error, sources) = (&estimate.error, estimate.sources.as_ref());
    let mut numbers = vec![error.sup, error.mean, error.reference_sup, error.reference_mean, estimate.time_of_sup];
    numbers.extend(&estimate.by_element);
    numbers.extend(estimate.over_time.iter().flat_map(|s| [s.time, s.parts.total(), s.reference]));
    numbers.extend(sources.iter().flat_map(|s| &s.over_time).flat_map(|s| [s.surface, s.front, s.dispersion, s.mesh]));
    numbers.iter().map(|x| x.to_bits()).collect()
}

#[test]
fn threads_and_windows_do_not_change_bits() {
    let (problem, count) = cases().into_iter().next().unwrap();
    let times = steps(&problem, 0.9, count);
    let history = history(&problem, &times);
    let one = bits(&estimate(&problem, &history, Options { threads: Some(1), ..Options::default() }));
    for (threads, window) in [(1, 1), (2, 3), (3, 7), (8, 8)] {
        let options = Options { threads: Some(threads), window: Some(window), ..Options::default() };
        assert!(one == bits(&estimate(&problem, &history, options)), "{threads} threads, window {window}");
    }
}

/// A run that ends early has the samples of the whole one, and its end; maps are kept at any step and sample it.
#[test]
fn an_early_end_and_requests_are_sampled() {
    let (problem, count) = cases().into_iter().next().unwrap();
    let times = steps(&problem, 0.9, count);
    let complete = history(&problem, &times);
    let whole = sampled(&estimate(&problem, &complete, Options::default()), &times);
    let last = (60..count).find(|n| !whole.contains(n)).unwrap();
    let mut early = History::new(&times);
    (0..=last).for_each(|n| early.push(&complete.step(n).unwrap()).unwrap());
    let cut = estimate(&problem, &early, Options::default());
    let expected: Vec<usize> = whole.iter().copied().filter(|&n| n < last).chain([last]).collect();
    assert_eq!(sampled(&cut, &times), expected);
    assert!(
        cut.sources.unwrap().over_time.last().unwrap().dispersion != 0.0,
        "the end is compared with the simulation"
    );

    let request = Request { steps: vec![last], fields: false };
    let with_map = estimate_with_maps(&problem, &complete, Options::default(), &request);
    assert_eq!(with_map.maps[0].step, last);
    assert!(with_map.maps[0].kinetic.iter().sum::<f64>() > 0.0);
    let mut with: Vec<usize> = whole.clone();
    with.push(last);
    with.sort_unstable();
    assert_eq!(sampled(&with_map, &times), with);
}

/// A level before a change is compared with the simulation although it was none of the samples when its turn came.
#[test]
fn differences_are_those_of_all_steps() {
    let (problem, count) = cases().into_iter().nth(1).unwrap();
    let times = steps(&problem, 0.9, count);
    let history = history(&problem, &times);
    let of = |options: Options| {
        let found = estimate(&problem, &history, options);
        let sources = found.sources.unwrap().over_time;
        found.over_time.iter().map(|s| s.time).zip(sources).collect::<Vec<_>>()
    };
    let (sparse, dense) = (of(Options::default()), of(all(Options::default())));
    assert!(sparse.len() < dense.len());
    for (time, sources) in sparse {
        let (_, expected) = dense.iter().find(|(t, _)| *t == time).unwrap();
        // Near elements wait for their nodes in the same way: the same numbers.
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * expected.total().max(1e-9);
        assert!(close(sources.dispersion, expected.dispersion) && close(sources.front, expected.front), "{time}");
    }
}
