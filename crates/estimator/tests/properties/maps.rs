//! Maps of element contributions and fields, at the instants requested.

use crate::properties::bodies::{aluminium, bouncing_bar, gravity, plane_below, steps, swinging, thrown};
use crate::properties::estimating::{all_choices, estimate_with_maps, history};
use percute_core::border::vectors;
use percute_core::history::History;
use percute_core::load::{Profile, Table, Traction};
use percute_core::material::LinearLaw;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{
    AdmissibleFields, ElementMap, Estimate, EstimateError, Estimator, Options, Reconstruction, Request, RequestError,
    Sampling,
};
use percute_testkit::random_rectangle;

/// A body that turns, strikes and slides, with steps that change.
fn impact() -> (Problem<2>, TimeGrid) {
    let mesh = random_rectangle(0.05, 0.04, 6, 2).unwrap();
    let plane = plane_below(&mesh, 0.03, 3e-4, 0.3, None);
    let problem = thrown(mesh, [100.0, -300.0], plane).body_force(gravity([0.0, -1e6])).build().unwrap();
    let times = swinging(&problem, 60, 3.0);
    (problem, times)
}

fn all_steps(times: &TimeGrid, every: usize) -> Request {
    Request { fields: true, ..Request::evenly(times, usize::MAX, every) }
}

fn fields(map: &ElementMap) -> &AdmissibleFields {
    map.fields.as_ref().unwrap()
}

/// What holds of the maps of any estimate: sums, growth, and the instants asked for.
fn check<const D: usize>(problem: &Problem<D>, times: &TimeGrid) {
    let history = history(problem, times);
    for (k, options) in all_choices().enumerate() {
        let options = Options { every: Sampling::Every(1 + k % 3), ..options };
        let request = all_steps(times, options.every.stride());
        let estimate = estimate_with_maps(problem, &history, options, &request);
        assert_eq!(estimate.maps.iter().map(|m| m.step).collect::<Vec<_>>(), request.steps);
        let mut jumps = 0;
        let mut accumulated = vec![0.0; problem.mesh().element_count()];
        for map in &estimate.maps {
            assert_eq!(map.time, times.instants()[map.step]);
            // The later of two samples at one instant is the side after it.
            let samples: Vec<_> = estimate.over_time.iter().filter(|s| s.time == map.time).collect();
            jumps += samples.len() - 1;
            let parts = samples[samples.len() - 1].parts;
            // The same numbers, added by blocks there and one by one here: rounding of a sum of some
            // hundred terms that are not negative.
            let close = |part: &[f64], sum: f64| (part.iter().sum::<f64>() - sum).abs() <= 1e-13 * sum;
            assert!(close(&map.kinetic, parts.kinetic) && close(&map.elastic, parts.elastic), "{options:?}");
            // Power densities of both signs make up the contact part.
            let contact = (map.contact.iter().sum::<f64>() - parts.contact).abs();
            assert!(contact <= 1e-13 * parts.total(), "{options:?}: {contact}");
            assert!(close(&map.total(), parts.total()), "{options:?}");
            let grows = accumulated.iter().zip(&map.accumulated).all(|(before, now)| before <= now);
            assert!(grows && map.kinetic.iter().chain(&map.elastic).all(|x| *x >= 0.0), "{options:?}");
            accumulated.clone_from(&map.accumulated);
        }
        // The densities of `consistent` jump where the zone changes, those of `published` never.
        if options.every == Sampling::Every(1) {
            assert_eq!(jumps > 0, options.reconstruction == Reconstruction::Consistent, "{options:?}");
        }
        assert!(estimate.maps[0].accumulated.iter().all(|x| *x == 0.0));
        assert_eq!(estimate.maps[estimate.maps.len() - 1].error(estimate.end), estimate.by_element);
    }
}

#[test]
fn elements_add_up_at_every_instant() {
    let (problem, times) = impact();
    check(&problem, &times);
}

#[test]
fn elements_of_a_bar_add_up() {
    let problem = bouncing_bar(Mesh::uniform_bar(0.1, 20).unwrap());
    check(&problem, &steps(&problem, 0.9, 120));
}

/// ∫η_E over the first steps by hand, from maps at all of them and the rule of the whole: with every = 2 there
/// is nothing between the samples.
#[test]
fn accumulated_is_the_integral() {
    let (problem, times) = impact();
    let history = history(&problem, &times);
    let options = Options { every: Sampling::Every(2), threads: Some(1), ..Options::default() };
    let estimate = estimate_with_maps(&problem, &history, options, &all_steps(&times, 2));
    let mut by_hand = vec![0.0; problem.mesh().element_count()];
    // Away from contact both sides of an instant are one.
    let near: Vec<_> = problem.surface().nodes().iter().map(|c| c.node).collect();
    let far = |e: &usize| problem.mesh().nodes_of::<3>()[*e].iter().all(|n| !near.contains(n));
    for pair in estimate.maps.windows(2) {
        let (before, after) = (pair[0].total(), pair[1].total());
        for e in (0..by_hand.len()).filter(far) {
            by_hand[e] += 0.5 * (pair[1].time - pair[0].time) * (before[e] + after[e]);
            // The same operations in the same order.
            assert_eq!(pair[1].accumulated[e], by_hand[e]);
        }
    }
    assert!((0..by_hand.len()).filter(far).count() > 20);
}

/// The mean of σ_DA and σ_CA are those of the estimate: for each element, the elastic part is at least
/// the energy of the mean of σ_DA − σ_CA (Jensen). And the motion is admissible at contact.
#[test]
fn fields_belong_to_their_contributions() {
    let (problem, times) = impact();
    let history = history(&problem, &times);
    for options in all_choices() {
        let estimate = estimate_with_maps(&problem, &history, options, &all_steps(&times, 1));
        let (mut sharpest, mut at_rest) = (0.0_f64, 0);
        for map in &estimate.maps {
            let fields = fields(map);
            for (e, (s, c)) in
                vectors::<4>(&fields.stress).iter().zip(vectors::<4>(&fields.compatible_stress)).enumerate()
            {
                let id = percute_core::ids::ElementId::new(e);
                let difference = [0, 1].map(|a| [0, 1].map(|b| s[2 * a + b] - c[2 * a + b]));
                let least = problem.volume(id) * problem.material(id).complementary_energy(&difference);
                let elastic = map.elastic[e];
                assert!(least <= elastic * (1.0 + 1e-12), "step {}, element {e}: {least} > {elastic}", map.step);
                sharpest = sharpest.max(if elastic > 0.0 { least / elastic } else { 0.0 });
            }
            let touching = history.step(map.step).unwrap().touching;
            for (at, contact) in problem.surface().nodes().iter().enumerate() {
                let (i, plane) = (contact.node.index(), &problem.obstacles()[contact.obstacle]);
                let gap = problem.surface().gap(at, &vectors(&fields.displacement)[i]);
                let speed = plane.flat_frame().split(&vectors(&fields.velocity)[i]).0;
                // The admissible penetration of the method, 1e-12 of the body's size, and 1e-12 of 300 m/s.
                assert!(gap > -2.0 * problem.contact_tolerance(), "step {}: {gap}", map.step);
                assert!(!touching[at] || (gap < 2.0 * problem.contact_tolerance() && speed.abs() < 3e-10));
                at_rest += usize::from(touching[at]);
            }
        }
        // An elastic part of which nearly all is in the mean shows that the bound is no empty one.
        assert!(sharpest > 0.5 && at_rest > 10, "{options:?}: {sharpest}, {at_rest}");
    }
}

/// A body in uniform stress under the tractions of that stress: nothing moves, both stresses are the
/// given one everywhere.
#[test]
fn a_uniform_stress_is_reproduced() {
    let given = [[3e8, -1e8], [-1e8, 5e7]];
    let (young, poisson) = (70e9, 0.3);
    // ε of plane stress, and u = εx.
    let shear = (1.0 + poisson) / young * given[0][1];
    let strain = [
        [(given[0][0] - poisson * given[1][1]) / young, shear],
        [shear, (given[1][1] - poisson * given[0][0]) / young],
    ];
    let mesh = random_rectangle(0.05, 0.04, 5, 3).unwrap();
    let product = |m: [[f64; 2]; 2], x: [f64; 2]| [0, 1].map(|a| m[a][0] * x[0] + m[a][1] * x[1]);
    let displacement: Vec<_> = mesh.points_in::<2>().iter().map(|p| product(strain, *p)).collect();
    let mut builder =
        Problem::<2>::builder(mesh).material(aluminium()).initial_displacement(Initial::Nodal(displacement.clone()));
    for (group, normal) in [("left", [-1.0, 0.0]), ("right", [1.0, 0.0]), ("bottom", [0.0, -1.0]), ("top", [0.0, 1.0])]
    {
        let value = Table::constant(product(given, normal));
        builder = builder.traction(Traction { group: group.to_string(), value, profile: Profile::UNIFORM });
    }
    let problem = builder.build().unwrap();
    let times = steps(&problem, 0.9, 20);
    let history = history(&problem, &times);
    for options in all_choices() {
        let estimate = estimate_with_maps(&problem, &history, options, &all_steps(&times, 1));
        for map in &estimate.maps {
            let fields = fields(map);
            // Rounding of strains, 1e-16 of u/h, over twenty steps of free vibration: 1e-13 of the largest.
            let close = |a: f64, b: f64, scale: f64| (a - b).abs() <= 1e-12 * scale;
            for (s, c) in vectors::<4>(&fields.stress).iter().zip(vectors::<4>(&fields.compatible_stress)) {
                for (k, given) in given.iter().flatten().enumerate() {
                    assert!(close(s[k], *given, 3e8) && close(c[k], *given, 3e8), "{options:?}: {s:?}");
                }
            }
            // The acceleration that the smallest force would give, σ/(ρh), times rounding.
            assert!(fields.acceleration.iter().all(|a| close(*a, 0.0, 3e8 / (2700.0 * 1e-3))));
            let moved = vectors::<2>(&fields.displacement).iter().zip(&displacement);
            assert!(moved.clone().all(|(a, b)| (0..2).all(|c| close(a[c], b[c], 1e-3))), "{options:?}");
        }
    }
}

/// The means of Γ_DA carry the momentum: Σ ρV⟨Γ_DA/ρ⟩ is the resultant of the loads, here a traction that
/// grows and a body force.
#[test]
fn accelerations_balance_the_loads() {
    let mesh = random_rectangle(0.05, 0.04, 5, 4).unwrap();
    let end = 1e-5;
    let value = Table::new(vec![0.0, end], vec![[1e8, 0.0], [3e8, -2e8]]).unwrap();
    let problem = Problem::<2>::builder(mesh)
        .material(aluminium())
        .traction(Traction { group: "top".to_string(), value: value.clone(), profile: Profile::UNIFORM })
        .body_force(gravity([2e6, -1e6]))
        .build()
        .unwrap();
    let times = steps(&problem, 0.8, 12);
    let history = history(&problem, &times);
    for options in all_choices() {
        let estimate = estimate_with_maps(&problem, &history, options, &all_steps(&times, 1));
        for map in &estimate.maps {
            let mass = |e: usize| 2700.0 * problem.volume(percute_core::ids::ElementId::new(e));
            for c in 0..2 {
                let sum: f64 =
                    vectors::<2>(&fields(map).acceleration).iter().enumerate().map(|(e, a)| mass(e) * a[c]).sum();
                let expected = 0.05 * value.at(map.time)[c] + 2700.0 * 0.05 * 0.04 * [2e6, -1e6][c];
                // Inner forces, of the size of the load, cancel in the sum.
                assert!((sum - expected).abs() <= 1e-11 * 0.05 * 3e8, "step {}: {sum} for {expected}", map.step);
            }
        }
    }
}

fn refused(request: &Request, options: Options) -> RequestError {
    let (problem, times) = impact();
    match Estimator::new(&problem, &times, options).unwrap().keeping(request) {
        Err(EstimateError::Request(error)) => error,
        other => panic!("{other:?}"),
    }
}

#[test]
fn impossible_requests_are_refused() {
    let request = |steps: &[usize]| Request { steps: steps.to_vec(), fields: false };
    let (one, three) = (Options::default(), Options { every: Sampling::Every(3), ..Options::default() });
    assert_eq!(refused(&request(&[0, 61]), one), RequestError::Beyond { step: 61, last: 60 });
    assert_eq!(refused(&request(&[0, usize::MAX]), one), RequestError::Beyond { step: usize::MAX, last: 60 });
    assert_eq!(refused(&request(&[0, 7, 5]), one), RequestError::Order { step: 5, before: 7 });
    assert_eq!(refused(&request(&[7, 7]), one), RequestError::Order { step: 7, before: 7 });
    assert_eq!(refused(&request(&[0, 3, 7]), three), RequestError::NotSampled { step: 7, every: 3 });
    // The last step is sampled whatever `every` is.
    let (problem, times) = impact();
    let seven = Options { every: Sampling::Every(7), ..Options::default() };
    assert!(Estimator::new(&problem, &times, seven).unwrap().keeping(&request(&[0, 56, 60])).is_ok());
}

/// More bytes than there are addresses, 2⁴⁷: 9 numbers of each of 1e6 elements at 4e6 steps are 2.9e14.
#[test]
fn more_maps_than_memory_are_refused() {
    let problem = Problem::<1>::builder(Mesh::uniform_bar(1.0, 1_000_000).unwrap())
        .material(percute_core::material::Elastic::bar(1.0, 1.0, 1.0).unwrap())
        .build()
        .unwrap();
    let times = TimeGrid::uniform(1.0, 4_000_000).unwrap();
    let request = Request { steps: (0..=4_000_000).collect(), fields: true };
    let estimator = Estimator::new(&problem, &times, Options { threads: Some(1), ..Options::default() }).unwrap();
    let refused = estimator.keeping(&request).err();
    assert!(
        matches!(refused, Some(EstimateError::Request(RequestError::Memory { steps: 4_000_001, .. }))),
        "{refused:?}"
    );
}

/// The first steps of a history.
fn beginning(complete: &History, times: &TimeGrid, count: usize) -> History {
    let mut history = History::new(times);
    for n in 0..count {
        history.push(&complete.step(n).unwrap()).unwrap();
    }
    history
}

/// An estimate that ends early has the maps that it came to; its last instant is one of them only if it
/// was asked for.
#[test]
fn an_early_end_has_the_maps_so_far() {
    let (problem, times) = impact();
    let complete = history(&problem, &times);
    let options = Options { every: Sampling::Every(4), threads: Some(1), ..Options::default() };
    let steps = |e: &Estimate| e.maps.iter().map(|m| m.step).collect::<Vec<_>>();
    for (count, last) in [(30, 28), (29, 28), (28, 24)] {
        let early = beginning(&complete, &times, count);
        let estimate = estimate_with_maps(&problem, &early, options, &all_steps(&times, 4));
        assert_eq!(steps(&estimate), (0..=last).step_by(4).collect::<Vec<_>>());
        assert!(estimate.maps.iter().all(|map| fields(map).compatible_stress.len() == 4 * map.kinetic.len()));
    }
}

#[test]
fn steps_are_spread_evenly() {
    let times = TimeGrid::uniform(1.0, 100).unwrap();
    let steps = |count, every| Request::evenly(&times, count, every).steps;
    assert_eq!(steps(0, 1), []);
    assert_eq!(steps(1, 7), [100]);
    assert_eq!(steps(2, 7), [0, 100]);
    assert_eq!(steps(5, 1), [0, 25, 50, 75, 100]);
    // 33⅓ and 66⅔ lie nearest to 35 and 70, multiples of 7.
    assert_eq!(steps(4, 7), [0, 35, 70, 100]);
    assert_eq!(steps(1000, 40), [0, 40, 80, 100]);
    assert_eq!(steps(200, 1), (0..=100).collect::<Vec<_>>());
    // Evenly in time, not in steps: half way is at step 1, and nothing is named twice.
    let uneven = TimeGrid::from_steps(&[1.0, 0.25, 0.25, 0.25, 0.25]).unwrap();
    assert_eq!(Request::evenly(&uneven, 3, 1).steps, [0, 1, 5]);
    assert_eq!(Request::evenly(&uneven, 5, 1).steps, [0, 1, 3, 5]);
    let mesh = Mesh::rectangle(1.0, 1.0, 1, 1).unwrap();
    let problem = Problem::<2>::builder(mesh).material(aluminium()).build().unwrap();
    for (count, every) in [(1, 1), (3, 1), (7, 3), (50, 7), (99, 1), (1000, 13)] {
        let request = Request::evenly(&times, count, every);
        let options = Options { every: Sampling::Every(every), ..Options::default() };
        assert!(Estimator::new(&problem, &times, options).unwrap().keeping(&request).is_ok(), "{count}, {every}");
    }
}
