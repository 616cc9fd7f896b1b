//! Effectivities in 2D: the estimated over the true error, against a run on 160×128 cells.
//!
//! Run with `cargo run --release -p percute-estimator --example effectivity`. For a flat impact and
//! two tilted ones, with both readings of the contact force, it tries the settings that a
//! statement like "tilted by 3°" leaves open: which way, in whose axes the velocity is given, and
//! which edges may touch.

#![allow(clippy::print_stdout)]

use percute_core::dynamics::{SimulationError, critical_time_step, simulate};
use percute_core::material::Elastic;
use percute_core::mesh::TriangleMesh;
use percute_core::observer::Unobserved;
use percute_core::obstacle::Plane;
use percute_core::problem::{Initial, Problem, TriangleProblem};
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Comparison, Motion, Recorder, TrueError};
use percute_estimator::{ContactForce, ErrorMeasures, Estimator, Options};

type Failure = Box<dyn std::error::Error>;
/// Motion and errors, readings `paper` and `sharp`.
type Run = (Motion<2>, [ErrorMeasures; 2]);

const MESHES: [[usize; 2]; 4] = [[5, 4], [10, 8], [20, 16], [40, 32]];
const REFERENCE: [usize; 2] = [160, 128];
const READINGS: [ContactForce; 2] = [ContactForce::Paper, ContactForce::Sharp];

/// One impact of the block of the paper's §7.2: aluminium, 50 × 40 mm, μ = 0.2, plane stress.
#[derive(Clone, Copy)]
struct Case {
    /// Angle by which the plane is turned clockwise under the block (°).
    tilt: f64,
    /// v₀ (m/s).
    velocity: [f64; 2],
    /// Whether v₀ is given along and across the plane, else along the sides of the block.
    in_plane_axes: bool,
    /// Distance of the lowest corner from the plane (m).
    gap: f64,
    /// T (s).
    end: f64,
    /// Whether the run takes steps of exactly 0.9 Δt_c and ends with the first past T.
    whole_steps: bool,
    /// Whether only the bottom may touch, else all free edges that face the plane.
    bottom_only: bool,
}

impl Case {
    fn problem(&self, cells: [usize; 2]) -> Result<TriangleProblem, Failure> {
        let (sin, cos) = self.tilt.to_radians().sin_cos();
        let (normal, tangent) = ([sin, cos], [cos, -sin]);
        let corners = [[0.0, 0.0], [0.05, 0.0], [0.0, 0.04], [0.05, 0.04]];
        let lowest = corners.iter().map(|p| p[0] * sin + p[1] * cos).fold(f64::INFINITY, f64::min) - self.gap;
        let point = normal.map(|n| n * lowest);
        let [along, across] = self.velocity;
        let velocity =
            if self.in_plane_axes { [0, 1].map(|c| along * tangent[c] + across * normal[c]) } else { self.velocity };
        let group = self.bottom_only.then(|| "bottom".to_string());
        let problem = Problem::builder(TriangleMesh::rectangle(0.05, 0.04, cells[0], cells[1])?)
            .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0)?)
            .initial_velocity(Initial::Uniform(velocity))
            .obstacle(Plane::new(point, normal, 0.2, group)?)
            .build()?;
        Ok(problem)
    }

    fn times(&self, problem: &TriangleProblem) -> Result<TimeGrid, Failure> {
        let step = 0.9 * critical_time_step(problem);
        if !self.whole_steps {
            return Ok(TimeGrid::with_step(self.end, step)?);
        }
        let count = (self.end / step).ceil();
        Ok(TimeGrid::uniform(step * count, count as usize)?)
    }

    /// Motion and estimates with both readings on one mesh; nothing if it starts too near.
    fn run(&self, problem: &TriangleProblem, times: &TimeGrid) -> Result<Option<Run>, Failure> {
        let estimator = |contact_force| Estimator::new(problem, times, Options { contact_force, ..Options::default() });
        let mut sink = (Recorder::new(problem, times), (estimator(READINGS[0])?, estimator(READINGS[1])?));
        match simulate(problem, times, &mut sink, &mut Unobserved) {
            Ok(_) => {}
            Err(SimulationError::StartsTooNear { .. }) => return Ok(None),
            Err(other) => return Err(other.into()),
        }
        let (recorder, (paper, sharp)) = sink;
        Ok(Some((recorder.finish(), [paper.finish()?.error, sharp.finish()?.error])))
    }

    /// e_sup/e_ref and e_mean/e_ref of both readings on all meshes.
    fn print(&self) -> Result<(), Failure> {
        let problems = MESHES.iter().map(|&cells| self.problem(cells)).collect::<Result<Vec<_>, _>>()?;
        let mut runs = Vec::new();
        let mut end: f64 = 0.0;
        for problem in &problems {
            let times = self.times(problem)?;
            end = end.max(times.end());
            runs.push(self.run(problem, &times)?);
        }
        let fine = self.problem(REFERENCE)?;
        let step = 0.9 * critical_time_step(&fine);
        let count = (end / step).ceil();
        let times = TimeGrid::uniform(step * count, count as usize)?;
        let mut comparison = Comparison::new(&fine, &times);
        for (problem, run) in problems.iter().zip(&runs) {
            if let Some((motion, _)) = run {
                comparison.add(problem, motion)?;
            }
        }
        simulate(&fine, &times, &mut comparison, &mut Unobserved)?;
        let exact = comparison.finish()?;
        for (which, reading) in READINGS.into_iter().enumerate() {
            print!("  {:<6} sup", reading.to_string());
            ratios(&runs, &exact, |e, x| e[which].sup / x.sup);
            print!("   mean");
            ratios(&runs, &exact, |e, x| e[which].mean / x.mean);
            println!();
        }
        Ok(())
    }
}

/// Prints one ratio for each run; the true errors are those of the runs that exist, in order.
fn ratios(runs: &[Option<Run>], exact: &[TrueError], ratio: impl Fn(&[ErrorMeasures; 2], &TrueError) -> f64) {
    let mut exact = exact.iter();
    for run in runs {
        match run.as_ref().and_then(|(_, errors)| Some(ratio(errors, exact.next()?))) {
            Some(value) => print!(" {value:6.2}"),
            None => print!("      –"),
        }
    }
}

fn main() -> Result<(), Failure> {
    println!("Estimated over true error on 5×4, 10×8, 20×16 and 40×32 cells (–: starts too near to the plane).");
    let flat = Case {
        tilt: 0.0,
        velocity: [400.0, -400.0],
        in_plane_axes: false,
        gap: 0.2e-3,
        end: 13e-6,
        whole_steps: true,
        bottom_only: false,
    };
    for whole_steps in [true, false] {
        println!("flat, {}", if whole_steps { "steps of exactly 0.9 Δt_c past 13 µs" } else { "13 µs in equal steps" });
        Case { whole_steps, ..flat }.print()?;
    }
    for (angle, velocity, gap) in [(3.0, [400.0, -400.0], 0.2e-3), (10.0, [0.0, -400.0], 0.1e-3)] {
        for tilt in [angle, -angle] {
            for in_plane_axes in [true, false] {
                for bottom_only in [false, true] {
                    let axes = if in_plane_axes { "plane" } else { "block" };
                    let edges = if bottom_only { "bottom" } else { "all that face" };
                    println!("plane turned by {tilt}°, v = {velocity:?} in the axes of the {axes}, edges: {edges}");
                    Case { tilt, velocity, in_plane_axes, gap, end: 16e-6, bottom_only, ..flat }.print()?;
                }
            }
        }
    }
    Ok(())
}
