//! The integrator for bars and plane bodies, compiled with this crate. Builds with little optimisation share such
//! instances: crates that call it need not compile it anew. Optimised builds do not share them, so they are left out
//! there.

use crate::dynamics::{critical_time_step, replay, simulate_threaded};

#[used]
static INSTANCES: fn() -> [*const (); 6] = || {
    [
        simulate_threaded::<1, 2> as *const (),
        simulate_threaded::<2, 3> as *const (),
        replay::<1, 2> as *const (),
        replay::<2, 3> as *const (),
        critical_time_step::<1, 2> as *const (),
        critical_time_step::<2, 3> as *const (),
    ]
};
