//! Runs of the block for `benches/peers`, one for each line of standard input, so that other programs can be measured
//! in between. Times are processor times, with `--wall` those on the wall.
//!
//! `probe NX NY [--order NAME] [--free] [--estimate NAME] [--every K] [--threads N] [--wall]` answers `mesh FILE`
//! (points and elements), `setup`, `run STEPS`, `product COUNT` (of K·u), `memory STEPS` (predicted, in bytes, of the
//! estimate), `samples STEPS` (number of sampled steps), `displacement STEPS FILE` and `parts STEPS FILE` (kinetic and
//! elastic part of each sample). Numbers in files are raw, of 8 bytes each.

#![allow(clippy::print_stdout, reason = "the answers are its purpose")]

use percute_benches::{Block, Clock, Csr, Failure, Motion, Order, estimated, processor, setup, simulated, steps, wall};
use percute_estimator::{Options, Reconstruction, Sampling, memory};
use std::cell::OnceCell;
use std::hint::black_box;
use std::io::{BufRead, Write};

/// What the command line asks for.
struct Request {
    cells: [usize; 2],
    order: Order,
    motion: Motion,
    /// With an estimate.
    options: Option<Options>,
    threads: Option<usize>,
    clock: Clock,
}

fn main() -> Result<(), Failure> {
    let request = read(std::env::args().skip(1))?;
    let block = Block::new(request.cells, request.order, request.motion)?;
    println!("{} {:e} {:e}", block.elements(), block.step, block.gap);
    let csr = OnceCell::new();
    for line in std::io::stdin().lock().lines() {
        println!("{}", answer(&block, &csr, &request, &line?)?);
        std::io::stdout().flush()?;
    }
    Ok(())
}

fn read(mut arguments: impl Iterator<Item = String>) -> Result<Request, Failure> {
    let mut next = || arguments.next().ok_or("an argument is missing");
    let cells = [next()?.parse()?, next()?.parse()?];
    let mut request = Request {
        cells,
        order: Order::Structured,
        motion: Motion::Impact,
        options: None,
        threads: Some(1),
        clock: processor,
    };
    let mut options = Options { every: Sampling::Every(1), threads: Some(1), ..Options::default() };
    while let Ok(name) = next() {
        match name.as_str() {
            "--order" => request.order = next()?.parse()?,
            "--wall" => request.clock = wall,
            "--free" => request.motion = Motion::Free,
            "--estimate" => {
                options.reconstruction = next()?.parse::<Reconstruction>()?;
                request.options = Some(options);
            }
            "--every" => options.every = next()?.parse()?,
            "--threads" => options.threads = Some(next()?.parse()?),
            other => return Err(format!("unknown argument {other}").into()),
        }
    }
    request.threads = options.threads;
    request.options = request.options.map(|_| options);
    Ok(request)
}

/// The answer to one line: seconds, those of runs since the first state; a number; or a word when a file is written.
fn answer(block: &Block, csr: &OnceCell<Csr>, request: &Request, line: &str) -> Result<String, Failure> {
    let Request { options, threads, clock, .. } = *request;
    let estimate = || options.ok_or("this line needs --estimate");
    let words: Vec<_> = line.split_whitespace().collect();
    match *words.as_slice() {
        ["run", count] => {
            let count = count.parse()?;
            let time = match options {
                Some(options) => estimated(block, count, options, clock)?.0,
                None => simulated(block, count, threads, clock)?.0,
            };
            Ok(format!("{:e}", time.as_secs_f64()))
        }
        ["setup"] => {
            let start = clock();
            setup(request.cells, request.order, block, options)?;
            Ok(format!("{:e}", (clock() - start).as_secs_f64()))
        }
        ["memory", count] => {
            let times = steps(block.step, count.parse()?)?;
            Ok(memory(&block.problem, &times, &estimate()?).to_string())
        }
        ["samples", count] => Ok(samples(block, count.parse()?, estimate()?)?.to_string()),
        ["product", count] => {
            let csr = csr.get_or_init(|| Csr::assemble(&block.problem));
            let x: Vec<f64> = (0..2 * block.problem.mesh().node_count()).map(|i| (i as f64).sin()).collect();
            let mut y = vec![0.0; x.len()];
            csr.multiply(&x, &mut y);
            let start = clock();
            (0..count.parse::<usize>()?).for_each(|_| csr.multiply(black_box(&x), black_box(&mut y)));
            Ok(format!("{:e}", (clock() - start).as_secs_f64()))
        }
        [_, .., file] => write(block, request, &words, file),
        _ => Err(format!("unknown line: {line}").into()),
    }
}

/// The number of steps that an estimate samples.
fn samples(block: &Block, count: usize, options: Options) -> Result<usize, Failure> {
    let (times, (_, estimate)) = (steps(block.step, count)?, estimated(block, count, options, wall)?);
    let sampled = |time: &&f64| estimate.over_time.iter().any(|sample| sample.time == **time);
    Ok(times.instants().iter().filter(sampled).count())
}

/// Answers a line that ends with a file.
fn write(block: &Block, request: &Request, words: &[&str], file: &str) -> Result<String, Failure> {
    let (numbers, answer) = match *words {
        ["displacement", count, _] => {
            let (_, displacement) = simulated(block, count.parse()?, request.threads, request.clock)?;
            (displacement, "written".into())
        }
        ["parts", count, _] => {
            let options = request.options.ok_or("parts need --estimate")?;
            let (_, estimate) = estimated(block, count.parse()?, options, request.clock)?;
            let parts = estimate.over_time.iter().flat_map(|sample| [sample.parts.kinetic, sample.parts.elastic]);
            (parts.collect(), "written".into())
        }
        ["mesh", _] => {
            let mesh = block.problem.mesh();
            let nodes = mesh.cell_rows().iter().map(|node| node.index() as f64);
            (mesh.points().iter().copied().chain(nodes).collect(), mesh.node_count().to_string())
        }
        _ => return Err(format!("unknown line: {}", words.join(" ")).into()),
    };
    let bytes: Vec<u8> = numbers.into_iter().flat_map(f64::to_le_bytes).collect();
    std::fs::write(file, bytes)?;
    Ok(answer)
}
