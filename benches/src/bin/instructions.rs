//! One stage of the work, so many times, for a counter of instructions: `instructions STAGE COUNT`.
//!
//! `benches/instructions.py` runs it with two counts; the difference has no start-up and no setup. All stages run on
//! one thread and in the portable instruction set (feature `portable`).

use percute_benches::{Block, Failure, Motion, Order, estimated, problem, simulated, steps, wall};
use percute_core::dynamics::critical_time_step;
use percute_core::mesh::Mesh;
use percute_estimator::{Estimator, Options, Reconstruction, Sampling};
use std::hint::black_box;

/// Cells along x and y of all stages.
const CELLS: [usize; 2] = [20, 16];

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let mut next = || arguments.next().ok_or("two arguments: a stage and how many times");
    let (stage, count) = (next()?, next()?.parse()?);
    let block = Block::new(CELLS, Order::Structured, Motion::Impact)?;
    let sampled = |reconstruction, every| {
        let options = Options { reconstruction, every: Sampling::Every(every), threads: Some(1), ..Options::default() };
        estimated(&block, count, options, wall).map(|_| ())
    };
    match stage.as_str() {
        "integrator" => simulated(&block, count, Some(1), wall).map(|_| ()),
        "consistent" => sampled(Reconstruction::Consistent, 1),
        "corrected" => sampled(Reconstruction::Corrected, 1),
        // Only the first and the last instant are sampled.
        "between" => sampled(Reconstruction::Corrected, 1_000_000),
        "critical-step" => {
            // A problem keeps its critical step.
            (0..count).for_each(|_| _ = black_box(critical_time_step(black_box(&block.problem.clone()))));
            Ok(())
        }
        "setup" => (0..count).try_for_each(|_| setup(&block)),
        other => Err(format!("unknown stage {other}").into()),
    }
}

/// From a mesh to an estimator that waits for the first step; the critical step apart.
fn setup(block: &Block) -> Result<(), Failure> {
    let mesh = Mesh::rectangle(0.05, 0.04, CELLS[0], CELLS[1])?;
    let problem = problem(mesh, Motion::Impact, block.gap)?;
    let times = steps(block.step, 100)?;
    let options = Options { threads: Some(1), ..Options::default() };
    black_box(Estimator::new(&problem, &times, options)?);
    Ok(())
}
