//! The update formula of the scheme.

use crate::time::TimeGrid;

/// v_{n+½} = v_{n−½} + h_n a_n and u_{n+1} = u_n + Δt_n v_{n+½}, eq. \[28\], \[31\].
pub fn advance<const D: usize>(
    times: &TimeGrid,
    n: usize,
    velocity: &mut [[f64; D]],
    displacement: &mut [[f64; D]],
    acceleration: impl IntoIterator<Item = [f64; D]>,
) {
    let (h, dt) = (times.velocity_step(n), times.step(n));
    for ((v, u), a) in velocity.iter_mut().zip(displacement).zip(acceleration) {
        add(v, h, &a);
        add(u, dt, v);
    }
}

/// v_{n+½} = v_{n−½} + h_n a_n alone.
pub(super) fn advance_velocity<const D: usize>(
    times: &TimeGrid,
    n: usize,
    velocity: &mut [[f64; D]],
    acceleration: impl IntoIterator<Item = [f64; D]>,
) {
    let h = times.velocity_step(n);
    velocity.iter_mut().zip(acceleration).for_each(|(v, a)| add(v, h, &a));
}

#[inline]
fn add<const D: usize>(value: &mut [f64; D], step: f64, rate: &[f64; D]) {
    (0..D).for_each(|c| value[c] += step * rate[c]);
}
