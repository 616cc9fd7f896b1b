//! Residuals of the parallel part rise when its fields are changed.

use super::*;
use crate::options::Reconstruction;
use crate::pipeline::fixture::{SHOWS, impact, prepared_with};
use crate::request::Request;
use percute_core::simd::lanes::LANES;

/// A run with its levels.
struct Run<'p> {
    window: LevelWindow<'p, 2, 3>,
    preparation: Preparation<'p, 2, 3>,
    levels: Vec<ForcesKnown<2>>,
}

/// Nothing changed yet.
fn run<'p>(problem: &'p Problem<2>, times: &'p TimeGrid) -> Run<'p> {
    run_with(problem, times, &Options { reconstruction: Reconstruction::Consistent, ..Options::default() })
}

/// The same with other options.
fn run_with<'p>(problem: &'p Problem<2>, times: &'p TimeGrid, options: &Options) -> Run<'p> {
    let mut preparation = prepared_with(problem, times, options);
    let maps = Maps::new(Request::default(), problem).unwrap();
    let window = LevelWindow::new(problem, times, options, maps);
    let mut levels = Vec::new();
    while let Some(forces) = preparation.next_ready() {
        levels.push(forces);
    }
    Run { window, preparation, levels }
}

impl Run<'_> {
    /// The levels with their stars solved, which leaves a residual in the window.
    fn solve(&mut self) -> Vec<EquilibratedLevels<2>> {
        let (mut all, mut solved) = (std::mem::take(&mut self.levels).into_iter(), Vec::new());
        loop {
            let some: Vec<_> = all.by_ref().take(LANES).collect();
            if some.is_empty() {
                return solved;
            }
            let mut levels = EquilibratedLevels::default();
            let (equilibration, choice) = (&self.window.equilibration, self.window.choice);
            let reconstruction = self.preparation.reconstruction();
            let miss = reconstruction.equilibrate(equilibration, choice, some, &mut levels, &mut |_, _| ());
            self.window.residuals.star_compatibility = worse(self.window.residuals.star_compatibility, miss);
            solved.push(levels);
        }
    }

    /// All residuals of these levels.
    fn residuals(mut self, levels: Vec<EquilibratedLevels<2>>) -> Residuals {
        for mut some in levels {
            let parts =
                |equilibration: &Equilibration<'_, 2, 3>, levels: &mut EquilibratedLevels<2>, then: Then<'_, 2>| {
                    equilibration.parts().for_each(|part| then(levels, part));
                    0.0
                };
            self.window.sample(&mut some, parts).unwrap();
            self.window.carried = some.keep_last(&self.window.near_links);
            self.window.catch_up(&mut self.preparation).unwrap();
        }
        let mut residuals = self.window.residuals;
        self.window.near.all.iter().for_each(|near| residuals.merge(&near.residuals));
        residuals
    }

    /// A level in the middle of the contact, and an element at contact and one away from it.
    fn places(&self) -> (usize, [usize; 2]) {
        let place = |near: bool| self.window.is_near.iter().position(|n| *n == near).unwrap();
        (self.preparation.count() / 2, [place(true), place(false)])
    }
}

#[test]
fn nothing_changed_nothing_shows() {
    let (problem, times) = impact();
    let mut run = run(&problem, &times);
    let levels = run.solve();
    assert!(run.residuals(levels).largest() < 1e-12);
}

/// 1 % on the displacement or on ã at one node, and its stars are out of balance.
#[test]
fn stars_out_of_balance_show() {
    let (problem, times) = impact();
    for change in 0..2 {
        let mut run = run(&problem, &times);
        let (level, [_, far]) = run.places();
        let node = run.window.equilibration.elements[far].nodes[0].index();
        let forces = &mut run.levels[level];
        let field = [&mut forces.level.displacement, &mut forces.acceleration];
        field[change][node].iter_mut().for_each(|value| *value *= 1.01);
        run.solve();
        assert!(run.window.residuals.star_compatibility > SHOWS, "{:?}", run.window.residuals);
    }
}

/// The same at a contact node on the side before, where the stars are solved once more.
#[test]
fn stars_out_of_balance_before_a_change_show() {
    let (problem, times) = impact();
    let mut run = run(&problem, &times);
    let before = run.levels.iter_mut().find_map(|forces| forces.before.as_mut()).unwrap();
    before.acceleration[1].iter_mut().for_each(|a| *a *= 1.01);
    run.solve();
    assert!(run.window.residuals.star_compatibility > SHOWS, "{:?}", run.window.residuals);
}

/// 1 % on one projected moment after the stars were solved: the element has no resultant any more. (Nor then a
/// stress, but the stars stay as they are.)
#[test]
fn wrong_moments_show_in_the_resultants() {
    let (problem, times) = impact();
    for k in 0..2 {
        let mut run = run(&problem, &times);
        let mut levels = run.solve();
        let (level, elements) = run.places();
        let link = run.window.equilibration.elements[elements[k]].links[2][0].place();
        let moments = &mut levels[level / LANES].all_moments_mut()[link];
        moments.iter_mut().for_each(|b| b.0[level % LANES] *= 1.01);
        let found = run.residuals(levels);
        assert!(found.element_resultants > SHOWS, "{found:?}");
        assert!(found.star_compatibility < 1e-12 && found.normal_velocity < 1e-12, "{found:?}");
    }
}

/// 1 % on ã after the stars were solved changes Γ_DA, not the tractions.
#[test]
fn a_wrong_acceleration_shows_in_the_resultants() {
    let (problem, times) = impact();
    let mut run = run(&problem, &times);
    let mut levels = run.solve();
    let (level, [_, far]) = run.places();
    let node = run.window.equilibration.elements[far].nodes[1].index();
    levels[level / LANES].forces_mut()[level % LANES].acceleration[node].iter_mut().for_each(|a| *a *= 1.01);
    let found = run.residuals(levels);
    assert!(found.element_resultants > SHOWS && found.star_compatibility < 1e-12, "{found:?}");
}

/// With `split`, 1 % on o₂ at one node before the stars are solved puts them out of balance;
/// afterwards it changes Γ_DA, not the tractions.
#[test]
fn a_wrong_skew_shows() {
    let (problem, times) = impact();
    let options = Options { acceleration: Some(Acceleration::Split), ..Options::default() };
    let change = |forces: &mut ForcesKnown<2>, node: usize| {
        let field = &mut forces.level.split.as_mut().unwrap().skew;
        field[node].iter_mut().for_each(|o| *o *= 1.01);
    };
    for early in [None, Some(true), Some(false)] {
        let mut run = run_with(&problem, &times, &options);
        let (level, [_, far]) = run.places();
        let node = run.window.equilibration.elements[far].nodes[1].index();
        if early == Some(true) {
            change(&mut run.levels[level], node);
        }
        let mut levels = run.solve();
        if early == Some(false) {
            change(&mut levels[level / LANES].forces_mut()[level % LANES], node);
        }
        let found = run.residuals(levels);
        assert_eq!(found.star_compatibility > SHOWS, early == Some(true), "{found:?}");
        assert_eq!(found.element_resultants > SHOWS, early == Some(false), "{found:?}");
        assert!(early.is_some() || found.largest() < 1e-12, "{found:?}");
    }
}

/// A u̇_CA or u_CA at t = 0 that is 1 % off in an element at contact.
#[test]
fn wrong_initial_conditions_show() {
    let (problem, times) = impact();
    for change in 0..2 {
        let mut run = run(&problem, &times);
        let mut levels = run.solve();
        let (_, [near, _]) = run.places();
        let node = run.window.equilibration.elements[near].nodes[0].index();
        let [displacement, velocity] = levels[0].forces_mut()[0].now.motion.parts_mut();
        if change == 0 {
            velocity[node][0] *= 1.01;
        } else {
            displacement[node][0] += 0.01 * problem.mesh().size();
        }
        let found = run.residuals(levels);
        assert!(found.initial_conditions > SHOWS, "{found:?}");
        let rest = Residuals { initial_conditions: 0.0, ..found };
        assert!(rest.largest() < 1e-12, "{found:?}");
    }
}

/// Work that is stopped after some parts were sampled takes back what it added.
#[test]
fn a_stopped_window_changes_nothing() {
    let (problem, times) = impact();
    let mut run = run(&problem, &times);
    let mut levels = run.solve();
    let parts = |stopped: bool| {
        move |all: &Equilibration<'_, 2, 3>, levels: &mut EquilibratedLevels<2>, then: Then<'_, 2>| {
            all.parts().for_each(|part| then(levels, part));
            all.stop.set(stopped);
            0.0
        }
    };
    let sums = |window: &LevelWindow<'_, 2, 3>| -> (usize, usize, Vec<f64>) {
        let integrals = window.courses.iter().map(|far| far.course.integral).collect();
        (window.intervals.len(), window.far.levels.len(), integrals)
    };
    assert!(run.window.sample(&mut levels[0], parts(false)).unwrap().is_some());
    run.window.carried = levels[0].keep_last(&run.window.near_links);
    let before = sums(&run.window);
    assert!(before.0 > 0 && before.2.iter().any(|integral| *integral > 0.0));
    assert!(run.window.sample(&mut levels[1], parts(true)).unwrap().is_none());
    assert_eq!(sums(&run.window), before);
    run.window.equilibration.stop.set(false);
    assert!(run.window.sample(&mut levels[1], parts(false)).unwrap().is_some());
    assert_ne!(sums(&run.window), before);
}
