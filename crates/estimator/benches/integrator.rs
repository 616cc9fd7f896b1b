//! Time per element and step of the integrator and of its internal forces, beside one product K·u in compressed sparse
//! rows: in one run, on one thread. criterion prints elements per second; its inverse is the time per element and step.

#![allow(missing_docs, clippy::expect_used)]

mod common;

use common::each_case;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use percute_benches::{Contact, Csr, processor, simulated, steps, two_blocks, wall};
use percute_core::dynamics::Dynamics;
use std::cell::LazyCell;
use std::hint::black_box;

fn integrator(criterion: &mut Criterion) {
    each_case(criterion, |group, name, case| {
        group.bench_function(format!("product/{name}"), |b| {
            let (csr, x) = (Csr::assemble(&case.problem), displacement(case.problem.mesh().node_count()));
            let mut y = vec![0.0; x.len()];
            b.iter(|| csr.multiply(black_box(&x), black_box(&mut y)));
        });
        group.bench_function(format!("internal forces/{name}"), |b| {
            let times = steps(case.step, 1).expect("a step");
            let dynamics = Dynamics::new(&case.problem, &times);
            let x = displacement(case.problem.mesh().node_count());
            let u: Vec<[f64; 2]> = x.chunks_exact(2).map(|v| [v[0], v[1]]).collect();
            let mut force = vec![[0.0; 2]; u.len()];
            b.iter(|| dynamics.forces(0, black_box(&u), black_box(&mut force)));
        });
        group.bench_function(format!("integrator/{name}"), |b| {
            b.iter_custom(|count| simulated(case, count as usize, Some(1), wall).expect("a stable run").0);
        });
    });
}

/// Processor time of runs of 100 steps, of which all but two have contact: blocks of this height part after some 120.
fn interface(criterion: &mut Criterion) {
    const STEPS: usize = 100;
    let mut group = criterion.benchmark_group("two blocks, per element");
    group.sample_size(10);
    for (contact, name) in Contact::ALL {
        let case = LazyCell::new(|| two_blocks(contact).expect("valid blocks"));
        group.throughput(Throughput::Elements(41_000 * STEPS as u64));
        group.bench_function(name, |b| {
            b.iter_custom(|count| {
                (0..count).map(|_| simulated(&case, STEPS, Some(1), processor).expect("a stable run").0).sum()
            });
        });
    }
    group.finish();
}

/// Some displacement of all nodes.
fn displacement(nodes: usize) -> Vec<f64> {
    (0..2 * nodes).map(|i| (i as f64).sin()).collect()
}

criterion_group!(benches, integrator, interface);
criterion_main!(benches);
