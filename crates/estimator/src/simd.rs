//! The instruction set of the hot loops, chosen when the program runs.
//!
//! A binary is compiled for the oldest processor that it must run on. Its loops over lanes then use registers of two numbers. On a
//! newer processor, [`dispatch`] runs a copy of the loops that was compiled for registers of four or eight. Products and sums are
//! never fused, so the bits are those of the portable copy. This file is the only one of the crate that knows instruction sets.

use pulp::{Arch, NullaryFnOnce};

/// Runs a task with the widest registers of this processor. The task and all functions of its loops must be `#[inline(always)]`:
/// other functions keep the instructions of the oldest processor.
///
/// ```ignore
/// dispatch(#[inline(always)] || sweep(cells, values));
/// ```
#[inline]
pub(crate) fn dispatch<R>(task: impl FnOnce() -> R) -> R {
    if cfg!(feature = "portable") { task() } else { Arch::new().dispatch(Task(task)) }
}

/// A task that is compiled anew for each instruction set.
struct Task<F>(F);

impl<R, F: FnOnce() -> R> NullaryFnOnce for Task<F> {
    type Output = R;

    #[inline(always)]
    fn call(self) -> R {
        (self.0)()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[inline(always)]
    fn sweep(values: &[[f64; 8]], to: &mut [[f64; 8]]) {
        for (to, value) in to.iter_mut().zip(values) {
            let (sum, value) = (*to, *value);
            *to = std::array::from_fn(|l| sum[l] / 3.0 + value[l] * value[l]);
        }
    }

    /// A fused product and sum would change the last bit of some of the thousand numbers.
    #[test]
    fn the_bits_are_those_of_the_portable_copy() {
        let values: Vec<[f64; 8]> = (0..128).map(|i| std::array::from_fn(|l| ((8 * i + l) as f64).sin())).collect();
        let (mut plain, mut wide) = (values.clone(), values.clone());
        sweep(&values, &mut plain);
        dispatch(
            #[inline(always)]
            || sweep(&values, &mut wide),
        );
        assert_eq!(plain, wide);
    }
}
