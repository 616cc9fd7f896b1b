//! Time per element and step of the estimate, less that of the integrator in the same iteration: with every step
//! sampled, and between samples. criterion prints elements per second; its inverse is the time per element and step. Of
//! small models, it prints the time of a step.

#![allow(missing_docs, clippy::expect_used)]

mod common;

use common::each_case;
use criterion::{Criterion, criterion_group, criterion_main};
use percute_benches::{Block, Small, estimated, simulated, small, wall};
use percute_estimator::{Options, Reconstruction, Sampling};
use std::cell::LazyCell;
use std::time::Duration;

/// Steps of one iteration: full windows.
const STEPS: usize = 32;

/// The estimate alone, per step of so many.
fn alone(case: &Block, steps: usize, iterations: u64, options: Options) -> Duration {
    let mut time = Duration::ZERO;
    for _ in 0..iterations {
        let both = estimated(case, steps, options, wall).expect("an estimate").0;
        let integrator = simulated(case, steps, options.threads, wall).expect("a stable run").0;
        // criterion refuses no time at all.
        time += both.saturating_sub(integrator).max(Duration::from_nanos(1)) / steps as u32;
    }
    time
}

fn estimate(criterion: &mut Criterion) {
    each_case(criterion, |group, name, case| {
        for threads in [1, 2] {
            for &reconstruction in Reconstruction::ALL {
                for (kind, every) in [("sampled", 1), ("between samples", STEPS)] {
                    let options = Options {
                        reconstruction,
                        every: Sampling::Every(every),
                        threads: Some(threads),
                        ..Options::default()
                    };
                    group.bench_function(format!("{reconstruction} {kind}/{threads} threads/{name}"), |b| {
                        b.iter_custom(|count| alone(case, STEPS, count, options));
                    });
                }
            }
        }
    });
}

/// The default estimate of small models, per step.
fn small_models(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("per step");
    group.sample_size(10).warm_up_time(Duration::from_secs(1));
    for (kind, name, steps) in Small::ALL {
        let case = LazyCell::new(move || small(kind).expect("a valid block"));
        for threads in [1, 2] {
            let options = Options { threads: Some(threads), ..Options::default() };
            let name = format!("small models/{threads} threads/{name}");
            group.bench_function(name, |b| b.iter_custom(|count| alone(&case, steps, count, options)));
        }
    }
    group.finish();
}

criterion_group!(benches, estimate, small_models);
criterion_main!(benches);
