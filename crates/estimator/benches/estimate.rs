//! Time per element and step of the estimate, less that of the integrator in the same iteration: with every step
//! sampled, and between samples. criterion prints elements per second; its inverse is the time per element and step.

#![allow(missing_docs, clippy::expect_used)]

mod common;

use common::each_case;
use criterion::{Criterion, criterion_group, criterion_main};
use percute_benches::{Block, estimated, simulated, wall};
use percute_estimator::{Options, Reconstruction, Sampling};
use std::time::Duration;

/// Steps of one iteration: full windows.
const STEPS: usize = 32;

/// The estimate alone, per step.
fn alone(case: &Block, iterations: u64, options: Options) -> Duration {
    let mut time = Duration::ZERO;
    for _ in 0..iterations {
        let both = estimated(case, STEPS, options, wall).expect("an estimate").0;
        let integrator = simulated(case, STEPS, options.threads, wall).expect("a stable run").0;
        // criterion refuses no time at all.
        time += both.saturating_sub(integrator).max(Duration::from_nanos(1)) / STEPS as u32;
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
                        b.iter_custom(|count| alone(case, count, options));
                    });
                }
            }
        }
    });
}

criterion_group!(benches, estimate);
criterion_main!(benches);
