//! Time per element of all that precedes the first step.

#![allow(missing_docs, clippy::expect_used)]

mod common;

use common::each_case;
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use percute_benches::{Motion, problem, steps};
use percute_core::dynamics::{Dynamics, critical_time_step};
use percute_core::ids::NodeId;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_estimator::{Estimator, Options, Reconstruction};
use std::hint::black_box;

fn setup(criterion: &mut Criterion) {
    each_case(criterion, |group, name, case| {
        group.bench_function(format!("mesh/{name}"), |b| {
            let (points, cells) = (case.problem.mesh().points_in::<2>(), case.problem.mesh().nodes_of::<3>());
            let cells: Vec<_> = cells.iter().map(|cell| cell.map(NodeId::index)).collect();
            let make = || Mesh::new(points.to_vec(), &cells, &FaceGroups::new(), &ElementGroups::new());
            b.iter(|| make().expect("a valid mesh"));
        });
        group.bench_function(format!("problem/{name}"), |b| {
            let mesh = || case.problem.mesh().clone();
            let make = |mesh| problem(mesh, Motion::Impact, case.gap).expect("a valid problem");
            b.iter_batched(mesh, make, BatchSize::PerIteration);
        });
        group.bench_function(format!("critical step/{name}"), |b| {
            // A problem keeps its critical step.
            b.iter_batched_ref(
                || case.problem.clone(),
                |problem| critical_time_step(black_box(&*problem)),
                BatchSize::PerIteration,
            );
        });
        let times = || steps(case.step, 1000).expect("steps");
        group.bench_function(format!("dynamics/{name}"), |b| {
            let times = times();
            b.iter(|| Dynamics::new(&case.problem, &times));
        });
        for &reconstruction in Reconstruction::ALL {
            let options = Options { reconstruction, threads: Some(1), ..Options::default() };
            group.bench_function(format!("estimator {reconstruction}/{name}"), |b| {
                let times = times();
                b.iter(|| Estimator::new(&case.problem, &times, options).expect("valid options"));
            });
        }
    });
}

criterion_group!(benches, setup);
criterion_main!(benches);
