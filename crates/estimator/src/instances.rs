//! The estimator for bars and plane bodies, compiled with this crate. Builds with little optimisation share such
//! instances: crates that call it need not compile it anew. Optimised builds do not share them, so they are left out
//! there.

use crate::reference::Comparison;
use crate::{estimate, memory};

#[used]
static INSTANCES: fn() -> [*const (); 10] = || {
    [
        estimate::<1, 2> as *const (),
        estimate::<2, 3> as *const (),
        memory::<1, 2> as *const (),
        memory::<2, 3> as *const (),
        Comparison::<1, 2>::new as *const (),
        Comparison::<2, 3>::new as *const (),
        Comparison::<1, 2>::add as *const (),
        Comparison::<2, 3>::add as *const (),
        Comparison::<1, 2>::finish as *const (),
        Comparison::<2, 3>::finish as *const (),
    ]
};
