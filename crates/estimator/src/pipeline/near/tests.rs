//! Residuals of the motion at contact rise when it is changed.

use super::*;
use crate::increment::Increment;
use crate::kinematic::NodalTrajectory;
use crate::nodal_field::FieldPool;
use crate::options::{Acceleration, Options};
use crate::pipeline::fixture::{SHOWS, impact};
use crate::pipeline::maps::Maps;
use crate::reconstruction;
use crate::request::Request;
use crate::time_level::Velocities;
use crate::traction::Equilibration;
use percute_core::dynamics::Evaluation;
use percute_core::history::Step;

/// Runs one element at contact through a single step at whose end its nodes touch, with the normal
/// motion in `track` for all of them.
fn checked(track: &ContactMotion) -> Residuals {
    let (problem, times) = impact();
    let equilibration = Equilibration::<2, 3>::new(&problem);
    let tracks = vec![track.clone(); problem.surface().nodes().len()];
    let shared = SharedData {
        problem: &problem,
        times: &times,
        equilibration: &equilibration,
        choice: Acceleration::Closest,
        maps: &Maps::new(Request::default(), &problem).unwrap(),
    };
    let reconstruction = reconstruction::new(&problem, &times, &Options::default());
    let (fastest, non_matching) = (1.0, &NonMatchingMisfit::new(&problem, 1));
    let context =
        ContactSampling { shared: &shared, reconstruction: &*reconstruction, fastest, tracks: &tracks, non_matching };
    let mut near = near_elements(&problem).remove(0);
    let sampler = ElementSampler::new(&shared, near.element);
    let surface = problem.surface().nodes().len();
    let step = Step {
        index: 0,
        time: 0.0,
        displacement: problem.initial_displacement().as_flattened(),
        reaction: &vec![0.0; 2 * surface],
        touching: &vec![false; surface],
        internal: &[],
        velocity: None,
        acceleration: None,
    };
    let mut evaluation = Evaluation::new(&problem, &times);
    let pool = FieldPool::new(problem.mesh().node_count());
    let (_, motion) =
        NodalTrajectory::new(&problem, &pool).advance(&problem, &times, &evaluation.advance(&step).unwrap());
    let velocities = Velocities { motion, increment: Increment::zero(&pool), skew_increment: None };
    let mut stop = near.at(&sampler, &velocities, 0.0);
    near.settle(&context, &mut stop, 2);
    let touching = near.contact.map(|at| [at.is_some(), false]);
    near.check_contact(&context, &stop.velocities, &touching, 2);
    near.residuals
}

/// A track with this normal velocity (m/s) and gap (m) at the end of the first step.
fn track(velocity: f64, gap: f64) -> ContactMotion {
    // The undeformed gap of the fixture's flat bottom.
    let (problem, _) = impact();
    ContactMotion::altered(problem.surface().nodes()[0].undeformed_gap, 2, [velocity, gap])
}

#[test]
fn at_rest_on_the_plane_nothing_shows() {
    assert!(checked(&track(0.0, 0.0)).largest() < 1e-15);
}

/// 1 m/s through the plane while touching, where sliding is at 400 m/s.
#[test]
fn a_normal_velocity_in_contact_shows() {
    let found = checked(&track(1.0, 0.0));
    assert!(found.normal_velocity > SHOWS, "{found:?}");
    assert!(Residuals { normal_velocity: 0.0, ..found }.largest() < 1e-10, "{found:?}");
}

/// 1 mm behind the plane.
#[test]
fn penetration_shows() {
    let found = checked(&track(0.0, -1e-3));
    assert!(found.penetration_at_instants > SHOWS, "{found:?}");
    assert!(Residuals { penetration_at_instants: 0.0, ..found }.largest() < 1e-12, "{found:?}");
}
