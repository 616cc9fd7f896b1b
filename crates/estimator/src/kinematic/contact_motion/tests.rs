//! Contact phases of one node, at their shortest too, and residuals that rise when the motion is changed.

use super::*;
use crate::scratch_file::ScratchFile;
use std::ops::Deref;

/// Half steps of 1 s.
const HALF: f64 = 1.0;
const TOLERANCE: f64 = 1e-12;

/// A track with its store, its motion at hand at all known instants.
struct Alone {
    track: ContactMotion,
    store: NormalMotions,
}

impl Alone {
    fn new(gap: f64, velocity: f64, touching: bool) -> Self {
        let mut store = NormalMotions::new(1, 0, ScratchFile::default());
        store.extend().unwrap();
        store.write(0, 0, &[[velocity, gap]]).unwrap();
        Self { track: ContactMotion::new(0, (gap, 1.0), true, (gap, velocity), touching), store }
    }

    fn push(&mut self, step: &NormalStep, tolerance: f64) {
        self.store.extend().unwrap();
        self.store.extend().unwrap();
        self.track.push(&mut self.store, step, tolerance).unwrap();
        self.show();
    }

    fn finish(&mut self, tolerance: f64) {
        self.track.finish(&mut self.store, tolerance).unwrap();
        self.show();
    }

    fn show(&mut self) {
        self.track.show(&mut self.store, [0, self.track.known() - 1]).unwrap();
    }
}

impl Deref for Alone {
    type Target = ContactMotion;

    fn deref(&self) -> &ContactMotion {
        &self.track
    }
}

/// A track of a body of size 1 that starts at this gap with this velocity, not touching.
fn track(gap: f64, velocity: f64) -> Alone {
    Alone::new(gap, velocity, false)
}

/// The residuals of a motion from this gap and velocity over half steps of 1 s.
fn recorded(start: (f64, f64), path: Path, arrives: bool) -> Residuals {
    let mut track = track(start.0, start.1).track;
    let (lengths, target) = (vec![HALF; path.len()], path.iter().map(|(v, _)| *v).collect::<Vec<_>>());
    track.record(&FlightWindow { start, lengths: &lengths, target: &target, arrives }, &path);
    residuals(&track)
}

fn step(velocity: [f64; 2], touching: bool) -> NormalStep {
    NormalStep { half: HALF, velocity, touching }
}

fn residuals(track: &ContactMotion) -> Residuals {
    let mut residuals = Residuals::default();
    track.report(&mut residuals);
    residuals
}

/// From gap 4 at −1 to the plane at step 2. The target velocities −1 at all instants cover 3.5 m, half a
/// half step less than 4 because the last is 0: the three free ones become −1 − ½/3.
fn arriving() -> Alone {
    let mut track = track(4.0, -1.0);
    track.push(&step([-1.0, -1.0], false), TOLERANCE);
    track.push(&step([-1.0, -1.0], true), TOLERANCE);
    track
}

#[test]
fn an_arrival_shifts_the_free_instants() {
    let track = arriving();
    assert_eq!((track.known(), track.at(4).0), (5, 0.0));
    for instant in 1..=3 {
        assert!((track.at(instant).0 + 7.0 / 6.0).abs() < 1e-15);
    }
    assert!(residuals(&track).largest() < 1e-15);
}

/// A phase of one step: at rest at its one instant, and free again from there on.
#[test]
fn a_phase_of_one_step() {
    let mut track = arriving();
    track.push(&step([2.0, 3.0], false), TOLERANCE);
    track.finish(TOLERANCE);
    assert_eq!([track.at(4).0, track.at(5).0, track.at(6).0], [0.0, 2.0, 3.0]);
    assert!((track.at(6).1 - 3.5).abs() < 1e-15);
    assert!(residuals(&track).largest() < 1e-15);
}

/// The shortest way between two phases: off at one instant, back at the next. Three instants are free,
/// and what goes up comes down: 2 and 1 and −4 become 7/3, 4/3 and −11/3, which would go through the
/// plane were the last not followed by rest — the sum is zero.
#[test]
fn two_phases_with_one_instant_between() {
    let mut track = arriving();
    track.push(&step([2.0, 1.0], false), TOLERANCE);
    track.push(&step([-4.0, 0.0], true), TOLERANCE);
    for (instant, expected) in [(5, 7.0 / 3.0), (6, 4.0 / 3.0), (7, -11.0 / 3.0), (8, 0.0)] {
        assert!((track.at(instant).0 - expected).abs() < 1e-14, "{:?}", track.at(instant));
    }
    assert!(track.at(8).1.abs() < 1e-15);
    assert!(residuals(&track).largest() < 1e-15);
}

/// The same with a way that leads through the plane first: no velocity but zero is left.
#[test]
fn two_phases_between_which_nothing_can_move() {
    let mut track = arriving();
    track.push(&step([-2.0, -1.0], false), TOLERANCE);
    track.push(&step([3.0, 0.0], true), TOLERANCE);
    for instant in 5..=8 {
        // The tolerance allows a gap of −1e-13 at each instant.
        assert!(track.at(instant).0.abs() < 1e-12 && track.at(instant).1.abs() < 1e-12, "{:?}", track.at(instant));
    }
    assert!(residuals(&track).largest() < 1e-12);
}

/// A window with a single free instant, the shortest there can be: touching at step 1. Gap 1 at −1 is
/// covered with −½ at t_½. Nearer than |v|Δt/4 = ½ nothing admissible exists, and it shows.
#[test]
fn touching_at_step_one() {
    let mut near = track(1.0, -1.0);
    near.push(&step([-5.0, 0.0], true), TOLERANCE);
    assert!((near.at(1).0 + 0.5).abs() < 1e-15 && residuals(&near).largest() < 1e-15);
    let mut too_near = track(0.4, -1.0);
    too_near.push(&step([-5.0, 0.0], true), TOLERANCE);
    assert!(residuals(&too_near).largest() > 1e-3);
}

/// Touching from the start: at rest at once, without a window.
#[test]
fn touching_at_the_start() {
    let mut track = Alone::new(0.0, 0.0, true);
    track.push(&step([-1e-3, 1e-3], true), TOLERANCE);
    track.finish(TOLERANCE);
    assert_eq!((track.known(), track.at(1), track.at(2)), (3, (0.0, 0.0), (0.0, 0.0)));
}

/// A phase that is open at the end leaves no window behind.
#[test]
fn open_at_the_end() {
    let mut track = arriving();
    track.push(&step([0.1, 0.1], true), TOLERANCE);
    track.finish(TOLERANCE);
    assert_eq!((track.known(), track.at(6).0), (7, 0.0));
}

/// 1 % on one velocity of the arrival misses the plane by that much, and nothing else is wrong: the
/// motion stays outside.
#[test]
fn a_missed_onset_shows() {
    // 3.5 + 0.49 m instead of 4.
    let found = recorded((4.0, -1.0), vec![(-1.0, 2.5 + 0.5), (-1.0, 2.0), (-1.49, 0.755), (0.0, 0.01)], true);
    assert!(found.onset > 1e-3);
    assert_eq!(found, Residuals { onset: found.onset, ..Residuals::default() });
}

/// A gap 1 % of the body's size behind the plane.
#[test]
fn penetration_at_an_instant_shows() {
    let found = recorded((1.0, -1.0), vec![(-1.0, -0.01), (1.0, -0.01)], false);
    assert_eq!(found.penetration_at_instants, 0.01);
    // The parabola between the instants is deeper still, by v²h/(2·2) = ¼.
    assert!((found.penetration_between_instants - 0.26).abs() < 1e-15);
}

/// Down to −¼ and back between two instants on the plane.
#[test]
fn penetration_between_instants_shows() {
    let found = recorded((0.0, -1.0), vec![(1.0, 0.0)], false);
    assert_eq!(found, Residuals { penetration_between_instants: 0.25, ..Residuals::default() });
}

/// What is no number must not pass as small.
#[test]
fn nan_shows() {
    assert!(recorded((1.0, 0.0), vec![(f64::NAN, f64::NAN)], false).largest().is_nan());
}
