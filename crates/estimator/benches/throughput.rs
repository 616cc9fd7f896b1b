//! Time per element and step of the integrator and of the full estimate, beside one product K·u in
//! compressed sparse rows: all on one thread, in one run. Divide by the number of elements (criterion
//! prints elements per second) to get nanoseconds per element and step.

#![allow(missing_docs, clippy::expect_used)]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use percute_core::contact::Obstacle;
use percute_core::dynamics::{Dynamics, critical_time_step, simulate};
use percute_core::history::{SinkError, State, StateSink};
use percute_core::material::{Elastic, Law};
use percute_core::mesh::TriangleMesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem, TriangleProblem};
use percute_core::time::TimeGrid;
use percute_estimator::{Estimator, Options, Reconstruction};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Cells along x and y: 640, 40 960 and 655 360 elements.
const SIZES: [(usize, usize); 3] = [(20, 16), (160, 128), (640, 512)];

/// Steps that the estimate takes at a time.
const STEPS: u64 = 32;

/// A block that flies towards a plane.
fn block(nx: usize, ny: usize, gap: f64) -> TriangleProblem {
    let mesh = TriangleMesh::rectangle(0.05, 0.04, nx, ny).expect("a valid rectangle");
    Problem::builder(mesh)
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).expect("a valid material"))
        .initial_velocity(Initial::Uniform([400.0, -400.0]))
        .obstacle(Obstacle::plane([0.0, -gap], [0.0, 1.0], 0.2, None).expect("a valid plane"))
        .build()
        .expect("a valid problem")
}

/// K in compressed sparse rows, from its columns: each column touches the nodes around one node.
struct Csr {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Csr {
    fn assemble(problem: &TriangleProblem) -> Self {
        let nodes = problem.mesh().node_count();
        let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); 2 * nodes];
        for (e, cell) in problem.mesh().cells().iter().enumerate() {
            let id = percute_core::ids::ElementId::new(e);
            let (volume, gradients) = (problem.volume(id), problem.mesh().cell_geometry(id).gradients);
            for (j, column) in cell.iter().enumerate() {
                for c in 0..2 {
                    let mut gradient = [[0.0; 2]; 2];
                    gradient[c] = gradients[j];
                    let stress = problem.material(id).stress(&gradient);
                    for (i, row) in cell.iter().enumerate() {
                        for a in 0..2 {
                            let value: f64 = (0..2).map(|b| volume * stress[a][b] * gradients[i][b]).sum();
                            let place = (2 * column.index() + c) as u32;
                            let entries = &mut rows[2 * row.index() + a];
                            match entries.iter_mut().find(|(k, _)| *k == place) {
                                Some((_, sum)) => *sum += value,
                                None => entries.push((place, value)),
                            }
                        }
                    }
                }
            }
        }
        let mut csr = Self { starts: vec![0], columns: Vec::new(), values: Vec::new() };
        for mut row in rows {
            row.sort_unstable_by_key(|(column, _)| *column);
            csr.columns.extend(row.iter().map(|(column, _)| *column));
            csr.values.extend(row.iter().map(|(_, value)| *value));
            csr.starts.push(csr.columns.len());
        }
        csr
    }

    fn multiply(&self, x: &[f64], y: &mut [f64]) {
        for (row, y) in self.starts.windows(2).zip(y) {
            let entries = self.columns[row[0]..row[1]].iter().zip(&self.values[row[0]..row[1]]);
            *y = entries.map(|(&column, value)| value * x[column as usize]).sum();
        }
    }
}

/// Hands states on and notes when the first came: what is set up before it does not count.
struct Timed<S> {
    inner: S,
    first: Option<Instant>,
}

impl<S: StateSink<2>> StateSink<2> for Timed<S> {
    fn accept(&mut self, state: &State<'_, 2>) -> Result<(), SinkError> {
        self.first.get_or_insert_with(Instant::now);
        self.inner.accept(state)
    }
}

fn steps(dt: f64, count: u64) -> TimeGrid {
    TimeGrid::uniform(dt * count as f64, count as usize).expect("a valid time grid")
}

fn integrator(problem: &TriangleProblem, dt: f64, count: u64) -> Duration {
    let mut sink = Timed { inner: percute_core::history::Discard, first: None };
    simulate(problem, &steps(dt, count), &mut sink, &mut Unobserved).expect("a stable run");
    sink.first.map_or(Duration::ZERO, |first| first.elapsed())
}

/// Simulation and estimate, every = 1, on one thread.
fn estimate(problem: &TriangleProblem, dt: f64, count: u64, reconstruction: Reconstruction) -> Duration {
    let times = steps(dt, count);
    let options = Options { reconstruction, threads: Some(1), ..Options::default() };
    let estimator = Estimator::new(problem, &times, options).expect("valid options");
    let mut sink = Timed { inner: estimator, first: None };
    simulate(problem, &times, &mut sink, &mut Unobserved).expect("a stable run");
    black_box(sink.inner.finish().expect("a whole history"));
    sink.first.map_or(Duration::ZERO, |first| first.elapsed())
}

fn throughput(criterion: &mut Criterion) {
    for (nx, ny) in SIZES {
        let dt = 0.9 * critical_time_step(&block(nx, ny, 1e-3));
        // Touches in the second step, so that contact is at work.
        let problem = block(nx, ny, 1.5 * dt * 400.0);
        let elements = problem.mesh().element_count();
        let mut group = criterion.benchmark_group("per element and step");
        group.throughput(Throughput::Elements(elements as u64)).sample_size(10);

        let csr = Csr::assemble(&problem);
        let x: Vec<f64> = (0..2 * problem.mesh().node_count()).map(|i| (i as f64).sin()).collect();
        let mut y = vec![0.0; x.len()];
        group.bench_function(BenchmarkId::new("CSR product K·u", elements), |b| {
            b.iter(|| csr.multiply(black_box(&x), black_box(&mut y)));
        });
        let times = steps(dt, 1);
        let dynamics = Dynamics::new(&problem, &times);
        let u: Vec<[f64; 2]> = x.chunks_exact(2).map(|v| [v[0], v[1]]).collect();
        let mut force = vec![[0.0; 2]; u.len()];
        group.bench_function(BenchmarkId::new("internal forces", elements), |b| {
            b.iter(|| dynamics.forces(0, black_box(&u), black_box(&mut force)));
        });
        group.bench_function(BenchmarkId::new("integrator", elements), |b| {
            b.iter_custom(|count| integrator(&problem, dt, count));
        });
        for &reconstruction in Reconstruction::ALL {
            group.bench_function(
                BenchmarkId::new(format!("integrator and estimate, {reconstruction}"), elements),
                |b| {
                    // Full windows of steps: the maps of the elements are made once for each.
                    b.iter_custom(|count| estimate(&problem, dt, STEPS * count, reconstruction) / STEPS as u32);
                },
            );
        }
        group.finish();
    }
}

criterion_group!(benches, throughput);
criterion_main!(benches);
