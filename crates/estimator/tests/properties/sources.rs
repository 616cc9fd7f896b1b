//! The sources of the error add up, and are what they are said to be.

use crate::properties::bodies::{aluminium, bouncing_bar, plane_below, steps, thrown};
use crate::properties::estimating::{estimate, history};
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_estimator::{Ablation, Estimate, Options, Reconstruction, Sampling, Separation};
use percute_testkit::random_rectangle;

fn block(tilt: f64) -> Problem<2> {
    let mesh = random_rectangle(0.05, 0.04, 6, 1).unwrap();
    let plane = plane_below(&mesh, tilt, 2e-4, 0.2, None);
    thrown(mesh, [400.0, -400.0], plane).build().unwrap()
}

fn separation(estimate: &Estimate) -> &Separation {
    estimate.sources.as_ref().unwrap()
}

fn check(what: &str, estimate: &Estimate) {
    let sources = separation(estimate);
    assert_eq!(sources.over_time.len(), estimate.over_time.len(), "{what}");
    let square = estimate.error.sup * estimate.error.sup;
    for (sources, sample) in sources.over_time.iter().zip(&estimate.over_time) {
        // Sums of the same numbers in another order.
        assert!((sources.total() - sample.parts.total()).abs() <= 1e-13 * square, "{what}, t = {}", sample.time);
    }
    assert!((sources.at_sup.total() - square).abs() <= 1e-13 * square, "{what}");
    let square = estimate.error.mean * estimate.error.mean;
    assert!((sources.mean.total() - square).abs() <= 1e-13 * square, "{what}");
}

#[test]
fn they_add_up_to_the_error() {
    let bar = bouncing_bar(Mesh::uniform_bar(0.1, 20).unwrap());
    let of_bar = history(&bar, &steps(&bar, 0.9, 200));
    for every in [1, 4] {
        let options = Options { every: Sampling::Every(every), threads: Some(1), ..Options::default() };
        check("bar", &estimate(&bar, &of_bar, options));
        for tilt in [0.0, 0.2] {
            let problem = block(tilt);
            let of_block = history(&problem, &steps(&problem, 0.9, 61));
            let estimate = estimate(&problem, &of_block, options);
            check("block", &estimate);
            assert!(separation(&estimate).mean.front > 0.0);
        }
    }
}

/// The other reconstructions balance the simulation itself: there is no second motion to compare it with.
#[test]
fn they_need_an_auxiliary_solution() {
    let problem = block(0.0);
    let history = history(&problem, &steps(&problem, 0.9, 31));
    for reconstruction in [Reconstruction::Consistent, Reconstruction::Published] {
        assert_eq!(estimate(&problem, &history, Options { reconstruction, ..Options::default() }).sources, None);
    }
    let options = Options { ablation: Ablation::AuxiliarySolution, ..Options::default() };
    assert_eq!(estimate(&problem, &history, options).sources, None);
}

/// Without contact, nothing comes from the surface.
#[test]
fn a_free_body_has_neither_surface_nor_front() {
    let mesh = Mesh::rectangle(1.0, 1.0, 6, 6).unwrap();
    let velocity = mesh.points_in::<2>().iter().map(|[x, y]| [(3.0 * x).cos() * (3.0 * y).sin(), x * y]).collect();
    let problem =
        Problem::<2>::builder(mesh).material(aluminium()).initial_velocity(Initial::Nodal(velocity)).build().unwrap();
    let estimate = estimate(&problem, &history(&problem, &steps(&problem, 0.9, 40)), Options::default());
    check("free", &estimate);
    let Separation { mean, at_sup, .. } = *separation(&estimate);
    assert_eq!([mean.surface, mean.front, at_sup.surface, at_sup.front], [0.0; 4]);
    assert!(mean.dispersion > 0.0 && mean.mesh > 0.0);
}

/// An auxiliary solution that takes the steps of the simulation differs by its contact forces alone.
#[test]
fn dispersion_is_that_of_equal_forces() {
    let (block, bar) = (block(0.2), bouncing_bar(Mesh::uniform_bar(0.1, 20).unwrap()));
    let options = Options { ablation: Ablation::Correction, ..Options::default() };
    let of_block = estimate(&block, &history(&block, &steps(&block, 0.4, 121)), options);
    let of_bar = estimate(&bar, &history(&bar, &steps(&bar, 0.3, 200)), options);
    for (sources, square) in [(separation(&of_block), of_block.error.sup), (separation(&of_bar), of_bar.error.sup)] {
        for at in &sources.over_time {
            assert!(at.dispersion.abs() <= 1e-12 * square * square, "{at:?}");
        }
        // Both forces differ, by the moment correction and smoothed impulses.
        assert!(sources.mean.surface.abs() > 1e-4 * sources.mean.total());
    }
}
