//! What one core of the machine can do, for the roofline of `benches/roofline.py`.
//!
//! `machine` answers `triad BYTES`, a line of standard input, with nanoseconds per byte of a + s b over arrays that
//! have this size together, and `peak` with the most floating-point operations per nanosecond, of the instruction set
//! of the build and of the widest one.

#![allow(clippy::print_stdout, reason = "the answers are its purpose")]

use percute_benches::{Failure, wall};
use pulp::{Arch, NullaryFnOnce};
use std::hint::black_box;
use std::io::{BufRead, Write};

/// The best of so many repetitions counts.
const REPETITIONS: usize = 9;

/// Bytes that a triad moves for each index: two numbers are read, one is written, and its line is read before.
const MOVED: usize = 4 * size_of::<f64>();

/// Independent chains of products and sums: enough to hide the latency of both.
const CHAINS: usize = 12;

/// Rounds of a repetition of the peak.
const ROUNDS: usize = 2_000_000;

fn main() -> Result<(), Failure> {
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        match *line.split_whitespace().collect::<Vec<_>>().as_slice() {
            ["triad", bytes] => println!("{:e}", triad(bytes.parse()?)),
            ["peak"] => println!("{:e} {:e}", best(peaks), best(|| Arch::new().dispatch(Peaks))),
            _ => return Err(format!("unknown line: {line}").into()),
        }
        std::io::stdout().flush()?;
    }
    Ok(())
}

/// The largest of some values.
fn best(mut measure: impl FnMut() -> f64) -> f64 {
    (0..REPETITIONS).map(|_| measure()).fold(0.0, f64::max)
}

/// Nanoseconds per byte moved.
fn triad(bytes: usize) -> f64 {
    let count = (bytes / (3 * size_of::<f64>())).max(64);
    let (mut a, b, c) = (vec![0.0; count], vec![1.0; count], vec![2.0; count]);
    let sweeps = (1 << 28) / (MOVED * count) + 1;
    let rate = best(|| {
        let start = wall();
        for _ in 0..sweeps {
            let (a, b, c) = (black_box(&mut a), black_box(&b), black_box(&c));
            Arch::new().dispatch(
                #[inline(always)]
                || sweep(a, b, c),
            );
        }
        (MOVED * count * sweeps) as f64 / (wall() - start).as_nanos() as f64
    });
    1.0 / rate
}

#[inline(always)]
fn sweep(a: &mut [f64], b: &[f64], c: &[f64]) {
    for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
        *a = b + 3.0 * c;
    }
}

/// Operations per nanosecond with the vectors that suit best.
#[inline(always)]
fn peaks() -> f64 {
    peak::<2>().max(peak::<4>()).max(peak::<8>())
}

/// The same, to be compiled anew for each instruction set: closures without data are not.
struct Peaks;

impl NullaryFnOnce for Peaks {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        peaks()
    }
}

/// Products and sums apart, as the code has them, in vectors of `W` numbers.
#[inline(always)]
fn peak<const W: usize>() -> f64 {
    let (factor, term) = (black_box([0.999_999; W]), black_box([1e-6; W]));
    let mut sums = black_box([[1.0; W]; CHAINS]);
    let start = wall();
    for _ in 0..ROUNDS {
        sums = all(
            sums,
            #[inline(always)]
            |sum| each(sum, factor, term),
        );
    }
    black_box(&sums);
    (2 * W * CHAINS * ROUNDS) as f64 / (wall() - start).as_nanos() as f64
}

#[inline(always)]
fn each<const W: usize>(mut sum: [f64; W], factor: [f64; W], term: [f64; W]) -> [f64; W] {
    for l in 0..W {
        sum[l] = sum[l] * factor[l] + term[l];
    }
    sum
}

/// All chains one after the other: a loop over them stays a loop, and keeps them in memory.
#[inline(always)]
fn all<T: Copy>(x: [T; CHAINS], f: impl Fn(T) -> T) -> [T; CHAINS] {
    [f(x[0]), f(x[1]), f(x[2]), f(x[3]), f(x[4]), f(x[5]), f(x[6]), f(x[7]), f(x[8]), f(x[9]), f(x[10]), f(x[11])]
}
