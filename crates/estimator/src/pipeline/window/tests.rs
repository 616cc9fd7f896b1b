//! Residuals of the parallel part rise when its fields are changed.

use super::*;
use crate::options::Reconstruction;
use crate::pipeline::fixture::{SHOWS, impact, prepared};
use crate::request::Request;

/// The levels of a run with σ_h and fluxes, nothing changed yet.
fn window<'p>(problem: &'p Problem<2, 3>, times: &'p TimeGrid) -> (Window<'p, 2, 3>, Preparation<'p, 2, 3>) {
    let mut preparation = prepared(problem, times, Reconstruction::Consistent);
    let mut window = Window::new(problem, times, &Options::default(), Maps::new(Request::default(), problem).unwrap());
    while let Some(level) = preparation.next_ready(true) {
        window.levels.push(level);
    }
    window.stresses(0);
    (window, preparation)
}

/// All residuals of the window.
fn residuals(window: &mut Window<'_, 2, 3>, preparation: &Preparation<'_, 2, 3>) -> Residuals {
    window.far_elements(0);
    let context = Context {
        problem: window.problem,
        times: window.times,
        equilibration: &window.equilibration,
        choice: window.choice,
        normal_work: 1.0,
        tracks: preparation.tracks(),
        maps: &window.maps,
    };
    window.near.iter_mut().for_each(|near| near.advance(&context, &window.levels));
    let mut residuals = window.residuals;
    window.near.iter().for_each(|near| residuals.merge(&near.residuals));
    residuals
}

/// A level in the middle of the contact, and an element at contact and one away from it.
fn places(window: &Window<'_, 2, 3>) -> (usize, [usize; 2]) {
    let place = |near: bool| window.is_near.iter().position(|n| *n == near).unwrap();
    (window.levels.len() / 2, [place(true), place(false)])
}

#[test]
fn nothing_changed_nothing_shows() {
    let (problem, times) = impact();
    let (mut window, preparation) = window(&problem, &times);
    window.stars(0);
    assert!(residuals(&mut window, &preparation).largest() < 1e-12);
}

/// 1 % on the stress of one element, or on ã at one node, and its stars are out of balance.
#[test]
fn stars_out_of_balance_show() {
    let (problem, times) = impact();
    for change in 0..2 {
        let (mut window, _) = window(&problem, &times);
        let (level, [_, far]) = places(&window);
        let node = window.equilibration.elements[far].nodes[0].index();
        if change == 0 {
            window.levels[level].stress[far].iter_mut().flatten().for_each(|s| *s *= 1.01);
        } else {
            window.levels[level].acceleration[node].iter_mut().for_each(|a| *a *= 1.01);
        }
        window.stars(0);
        assert!(window.residuals.star_compatibility > SHOWS, "{:?}", window.residuals);
    }
}

/// The same at a contact node on the side before, where the stars are solved once more.
#[test]
fn stars_out_of_balance_before_a_change_show() {
    let (problem, times) = impact();
    let (mut window, _) = window(&problem, &times);
    let (level, _) = places(&window);
    window.levels[level].acceleration_before[1].iter_mut().for_each(|a| *a *= 1.01);
    window.stars(0);
    assert!(window.residuals.star_compatibility > SHOWS, "{:?}", window.residuals);
}

/// 1 % on one flux after the stars were solved: the element has no resultant any more. (Nor then a
/// stress, but the stars stay as they are.)
#[test]
fn wrong_fluxes_show_in_the_resultants() {
    let (problem, times) = impact();
    for k in 0..2 {
        let (mut window, preparation) = window(&problem, &times);
        window.stars(0);
        let (level, elements) = places(&window);
        let link = window.equilibration.elements[elements[k]].links[2] as usize;
        window.levels[level].flux[link].iter_mut().for_each(|f| *f *= 1.01);
        let found = residuals(&mut window, &preparation);
        assert!(found.element_resultants > SHOWS, "{found:?}");
        assert!(found.star_compatibility < 1e-12 && found.normal_velocity < 1e-12, "{found:?}");
    }
}

/// 1 % on ã after the stars were solved changes Γ_DA, not the tractions.
#[test]
fn a_wrong_acceleration_shows_in_the_resultants() {
    let (problem, times) = impact();
    let (mut window, preparation) = window(&problem, &times);
    window.stars(0);
    let (level, [_, far]) = places(&window);
    let node = window.equilibration.elements[far].nodes[1].index();
    window.levels[level].acceleration[node].iter_mut().for_each(|a| *a *= 1.01);
    let found = residuals(&mut window, &preparation);
    assert!(found.element_resultants > SHOWS && found.star_compatibility < 1e-12, "{found:?}");
}

/// A u̇_CA or u_CA at t = 0 that is 1 % off in an element at contact.
#[test]
fn wrong_initial_conditions_show() {
    let (problem, times) = impact();
    for change in 0..2 {
        let (mut window, preparation) = window(&problem, &times);
        window.stars(0);
        let (_, [near, _]) = places(&window);
        let node = window.equilibration.elements[near].nodes[0].index();
        let knot = &mut window.levels[0].knot;
        if change == 0 {
            knot.velocity[node][0] *= 1.01;
        } else {
            knot.displacement[node][0] += 0.01 * problem.mesh().size();
        }
        let found = residuals(&mut window, &preparation);
        assert!(found.initial_conditions > SHOWS, "{found:?}");
        let rest = Residuals { initial_conditions: 0.0, ..found };
        assert!(rest.largest() < 1e-12, "{found:?}");
    }
}
