//! The same bits for all numbers of threads and window sizes, beside the run and from a history.

use crate::common::beside::run;
use crate::properties::bodies::{bouncing_bar, gravity, plane_below, steps, thrown};
use crate::properties::estimating::{estimate, estimate_with_maps, history, reactions};
use percute_core::history::Discard;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::{
    Acceleration, AdmissibleFields, ElementMap, Estimate, Options, Reconstruction, Request, Sampling, Separation,
    Supplied,
};
use percute_testkit::{disc, random_rectangle};

/// Every number of the sources of an error.
fn of_sources(Separation { at_sup, mean, halved_elements, halved_step, over_time }: &Separation) -> Vec<f64> {
    let all = [at_sup, mean, halved_elements].into_iter().chain(over_time);
    all.flat_map(|s| [s.surface, s.front, s.dispersion, s.mesh]).chain([*halved_step]).collect()
}

/// Every number of a map.
fn of_map(map: &ElementMap, numbers: &mut Vec<f64>) {
    let ElementMap { step, time, kinetic, elastic, dissipation, contact, accumulated, fields } = map;
    numbers.extend([*step as f64, *time]);
    [kinetic, elastic, dissipation, contact, accumulated].into_iter().for_each(|row| numbers.extend(row));
    let Some(AdmissibleFields { displacement, velocity, stress, compatible_stress, acceleration }) = fields else {
        return;
    };
    let fields = [displacement, velocity, acceleration, stress, compatible_stress];
    fields.into_iter().for_each(|field| numbers.extend(field));
}

/// Every number of an estimate; those of its maps come last.
fn bits(estimate: &Estimate) -> Vec<u64> {
    let Estimate {
        error,
        time_of_sup,
        parts,
        over_time,
        sources,
        by_element,
        maps,
        residuals,
        impulse_ratio,
        isolated_contact_nodes,
        auxiliary_contact_energy,
        surfaces,
        supplied,
        steps,
        end,
    } = estimate;
    assert_eq!(*supplied, Supplied::default());
    let mut numbers: Vec<f64> = error.entries().into_iter().map(|(_, value)| value).collect();
    numbers.extend([
        *time_of_sup,
        parts.kinetic,
        parts.elastic,
        parts.contact,
        impulse_ratio.unwrap_or(-1.0),
        *isolated_contact_nodes as f64,
        *auxiliary_contact_energy,
        *steps as f64,
        *end,
    ]);
    let sample =
        |s: &percute_estimator::Sample| [s.time, s.parts.kinetic, s.parts.elastic, s.parts.contact, s.reference];
    numbers.extend(over_time.iter().flat_map(sample));
    numbers.extend(sources.iter().flat_map(of_sources));
    numbers.extend(by_element);
    numbers.extend(surfaces.iter().flat_map(|s| [s.slide, s.lift, s.rounds as f64, s.stress]));
    numbers.extend(residuals.entries().map(|entry| entry.1));
    maps.iter().for_each(|map| of_map(map, &mut numbers));
    numbers.into_iter().map(f64::to_bits).collect()
}

fn check<const D: usize>(what: &str, problem: &Problem<D>, times: &TimeGrid) {
    let history = history(problem, times);
    assert!(reactions::<D>(&history) > 3, "{what}");
    // Energies and works that the steps tell are those of the run.
    let none = Request::default();
    let (simulation, _) = run(problem, times, Options::default(), &none, &mut Unobserved);
    let (told, _) =
        percute_estimator::estimate(problem, &history, Options::default(), &none, &mut Discard, &mut Unobserved)
            .unwrap();
    assert!(told == simulation && simulation.balance.kinetic > 0.0, "{what}");
    let closest = Reconstruction::ALL.iter().map(|&reconstruction| (reconstruction, Acceleration::Closest));
    for (reconstruction, acceleration) in closest.chain([(Reconstruction::Corrected, Acceleration::Split)]) {
        // At every 16th step, levels of one window have the stress of the same elements checked.
        for every in [1, 3, 16] {
            let (window, threads) = (Some(1_000_000), Some(1));
            let options = Options {
                reconstruction,
                acceleration: Some(acceleration),
                every: Sampling::Every(every),
                window,
                threads,
                ..Options::default()
            };
            // Maps at the start and the end, and at what lies between on one side of a window or the other.
            let request = Request { fields: true, ..Request::evenly(times, 9, every) };
            let expected = bits(&estimate_with_maps(problem, &history, options, &request));
            let alone = bits(&estimate(problem, &history, options));
            assert!(alone == expected[..alone.len()] && alone.len() < expected.len(), "{what}: maps change the rest");
            for threads in [1, 2, 3, 8] {
                for window in [Some(1), Some(3), Some(7), None] {
                    let options = Options { threads: Some(threads), window, ..options };
                    let replayed = bits(&estimate_with_maps(problem, &history, options, &request));
                    assert!(replayed == expected, "{what}, replayed: {options:?}");
                    let (_, beside) = run(problem, times, options, &request, &mut Unobserved);
                    assert!(bits(&beside) == expected, "{what}, beside the run: {options:?}");
                }
            }
        }
    }
}

#[test]
fn bar() {
    let problem = bouncing_bar(Mesh::uniform_bar(0.1, 40).unwrap());
    check("bar", &problem, &steps(&problem, 0.9, 200));
}

/// More elements and nodes than a block of 256, so that several threads have work.
#[test]
fn block() {
    let mesh = random_rectangle(0.05, 0.04, 18, 3).unwrap();
    assert!(mesh.element_count() > 256 && mesh.node_count() > 256);
    let plane = plane_below(&mesh, 0.01, 2e-4, 0.2, None);
    let problem = thrown(mesh, [400.0, -400.0], plane).build().unwrap();
    check("block", &problem, &steps(&problem, 0.9, 23));
}

/// More elements than two parts, so that the work goes from part to part.
#[test]
fn parts() {
    let mesh = Mesh::rectangle(0.05, 0.08, 48, 200).unwrap();
    assert!(mesh.element_count() > 2 * 8192);
    let plane = plane_below(&mesh, 0.01, 1e-5, 0.2, None);
    let problem = thrown(mesh, [400.0, -400.0], plane).build().unwrap();
    let times = steps(&problem, 0.9, 12);
    let history = history(&problem, &times);
    for &reconstruction in Reconstruction::ALL {
        let options = Options { reconstruction, every: Sampling::Every(1), ..Options::default() };
        let of = |threads, window| {
            let options = Options { threads: Some(threads), window: Some(window), ..options };
            bits(&estimate(&problem, &history, options))
        };
        let expected = of(1, 8);
        for (threads, window) in [(2, 8), (3, 5), (1, 1)] {
            assert!(of(threads, window) == expected, "{reconstruction}: {threads} threads, window {window}");
        }
    }
}

#[test]
fn chattering_disc() {
    let mesh = disc(0.02, 0.005).unwrap();
    let plane = plane_below(&mesh, 0.1, 1e-4, 0.3, None);
    let problem = thrown(mesh, [10.0, -100.0], plane).body_force(gravity([0.0, -1e7])).build().unwrap();
    check("disc", &problem, &steps(&problem, 0.4, 130));
}
