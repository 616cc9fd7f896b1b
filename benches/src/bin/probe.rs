//! Runs of the block for `benches/peers`, one for each line of standard input, so that other programs can be measured in
//! between. Times are processor times, with `--wall` those on the wall.
//!
//! `probe NX NY [--order NAME] [--free] [--estimate NAME] [--every K] [--threads N] [--wall]` answers `mesh FILE` (points and elements),
//! `run STEPS`, `product COUNT` (of K·u), `displacement STEPS FILE` and `parts STEPS FILE` (kinetic and elastic part of each sample); numbers in files are raw, of 8 bytes each.

#![allow(clippy::print_stdout, reason = "the answers are its purpose")]

use percute_benches::{Block, Clock, Csr, Failure, Motion, Order, estimated, processor, simulated, wall};
use percute_estimator::{Options, Reconstruction, Sampling};
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
    let mut request =
        Request { cells, order: Order::Structured, motion: Motion::Impact, options: None, clock: processor };
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
    request.options = request.options.map(|_| options);
    Ok(request)
}

/// The answer to one line: seconds since the first state, or a word when a file is written.
fn answer(block: &Block, csr: &OnceCell<Csr>, request: &Request, line: &str) -> Result<String, Failure> {
    let Request { options, clock, .. } = *request;
    let words: Vec<_> = line.split_whitespace().collect();
    match *words.as_slice() {
        ["run", count] => {
            let count = count.parse()?;
            let time = match options {
                Some(options) => estimated(block, count, options, clock)?.0,
                None => simulated(block, count, clock)?.0,
            };
            Ok(format!("{:e}", time.as_secs_f64()))
        }
        ["product", count] => {
            let csr = csr.get_or_init(|| Csr::assemble(&block.problem));
            let x: Vec<f64> = (0..2 * block.problem.mesh().node_count()).map(|i| (i as f64).sin()).collect();
            let mut y = vec![0.0; x.len()];
            csr.multiply(&x, &mut y);
            let start = clock();
            (0..count.parse::<usize>()?).for_each(|_| csr.multiply(black_box(&x), black_box(&mut y)));
            Ok(format!("{:e}", (clock() - start).as_secs_f64()))
        }
        ["displacement", count, file] => {
            let (_, displacement) = simulated(block, count.parse()?, clock)?;
            std::fs::write(file, bytes(displacement.as_flattened().iter().map(|u| u.to_le_bytes())))?;
            Ok("written".into())
        }
        ["parts", count, file] => {
            let (_, estimate) = estimated(block, count.parse()?, options.ok_or("parts need --estimate")?, clock)?;
            let samples = estimate.over_time.iter().flat_map(|sample| [sample.parts.kinetic, sample.parts.elastic]);
            std::fs::write(file, bytes(samples.map(f64::to_le_bytes)))?;
            Ok("written".into())
        }
        ["mesh", file] => {
            let mesh = block.problem.mesh();
            let nodes = mesh.cells().as_flattened().iter().map(|node| node.index() as f64);
            let points = mesh.points().as_flattened().iter().copied();
            std::fs::write(file, bytes(points.chain(nodes).map(f64::to_le_bytes)))?;
            Ok(mesh.node_count().to_string())
        }
        _ => Err(format!("unknown line: {line}").into()),
    }
}

fn bytes(numbers: impl Iterator<Item = [u8; 8]>) -> Vec<u8> {
    numbers.flatten().collect()
}
