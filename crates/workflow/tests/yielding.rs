//! Materials with a yield stress: how much of a body yields, first where and when, what it leaves, and how near a body
//! is to yielding that does not.

use crate::deformation::{YOUNG, bar, of_bar, report};
use percute_core::contact::Obstacle;
use percute_core::history::{History, StepSource};
use percute_core::ids::ElementId;
use percute_core::material::{Elastic, Hardening};
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{AnyProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_workflow::deformation::Extreme;
use percute_workflow::report::{Report, Trust};

/// A law that yields at this stress (Pa) with E_t = E/10.
fn plastic(law: Elastic, yield_stress: f64) -> Elastic {
    law.with_yield_stress(yield_stress).unwrap().with_hardening(Hardening::new(YOUNG / 9.0, 0.0).unwrap()).unwrap()
}

/// A block of nx × 4/5 nx cells in plane strain that strikes a plane with its corner (20°) or flat, at 2 m/s.
fn block(nx: usize, tilt: f64, law: impl Fn(Elastic) -> Elastic) -> AnyProblem {
    let mesh = Mesh::rectangle(0.05, 0.04, nx, nx * 4 / 5).unwrap();
    let (sin, cos) = tilt.to_radians().sin_cos();
    let plane = Obstacle::plane([-2e-6 * sin, -2e-6 * cos], [sin, cos], 0.2, None).unwrap();
    let material = law(Elastic::plane_strain(YOUNG, 0.3, 2700.0, 1.0).unwrap());
    let builder = Problem::<2>::builder(mesh).material(material).obstacle(plane);
    builder.initial_velocity(Initial::Uniform([-2.0 * sin, -2.0 * cos])).build().unwrap().into()
}

fn last(report: &Report) -> &str {
    report.verdict.text.last().unwrap()
}

/// The centroid is that of the element in the mesh of the user, whatever the order of the solver.
fn assert_placed(problem: &AnyProblem, extreme: &Extreme) {
    let mesh = problem.mesh();
    assert_eq!(extreme.centroid, mesh.centroid(ElementId::new(extreme.element))[..mesh.dimension()], "{extreme:?}");
}

/// ρcv is 137 MPa; the stress over σ_y is shown with its place, and as elastic if the margin exceeds the error.
#[test]
fn the_margin_to_yielding_is_compared_with_the_error() {
    let mut seen = [0; 2];
    for yield_stress in [165e6, 175e6, 185e6, 200e6, 300e6, 1e9] {
        let problem = bar(10.0, plastic(of_bar(), yield_stress));
        let found = report(&problem, 25);
        let margin = found.verdict.elastic_margin.as_ref().unwrap();
        let overall = found.deformation.yielding.unwrap();
        assert_eq!(
            (overall.share, overall.equivalent_strain, overall.stress_ratio),
            (0.0, Some(0.0), margin.stress_ratio)
        );
        assert_eq!(margin.stress_ratio, margin.von_mises.value / yield_stress);
        // The front of lumped elements overshoots: by 19 % here.
        assert!((137e6..165e6).contains(&margin.von_mises.value), "{margin:?}");
        assert_placed(&problem, &margin.von_mises);
        assert!(!margin.sharp_corner && margin.error >= found.error.relative_sup, "{margin:?}");
        assert_eq!(margin.is_shown, margin.stress_ratio < 1.0 - margin.error);
        seen[usize::from(margin.is_shown)] += 1;
        let told = last(&found);
        let number = format!("in element {} at {:.4}", margin.von_mises.element, margin.von_mises.centroid[0]);
        assert!(
            told.starts_with("The von Mises stress is at most ") && told.contains(&number[..number.len() - 2]),
            "{told}"
        );
        assert_eq!(
            told.contains("does not show that the body stays elastic; refine the mesh"),
            !margin.is_shown,
            "{told}"
        );
        let (range, trust) = (found.verdict.effectivity.unwrap(), found.verdict.trust);
        // The range of bars, and with that of bars that yield.
        let expected = if margin.is_shown { ([0.85, 1.26], Trust::High) } else { ([0.6, 1.6], Trust::Limited) };
        assert_eq!((range, trust), expected);
    }
    assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
}

/// The stress in the corner of a coarse block is below σ_y, of which a finer mesh has more: neither the error nor the
/// stress says how much.
#[test]
fn a_sharp_corner_shows_no_elastic_body() {
    let of = |nx: usize, law: &dyn Fn(Elastic) -> Elastic| {
        let steps = 6 * nx;
        let problem = block(nx, 20.0, law);
        (report(&problem, steps), problem)
    };
    let (stated, problem) = of(5, &|law| law.with_yield_stress(80e6).unwrap());
    let (coarse, _) = of(5, &|law| plastic(law, 80e6));
    for found in [&stated, &coarse] {
        let margin = found.verdict.elastic_margin.as_ref().unwrap();
        assert!(margin.sharp_corner && !margin.is_shown && margin.stress_ratio < 0.9, "{margin:?}");
        assert_placed(&problem, &margin.von_mises);
        assert!(last(found).contains("at a sharp corner grows with each refinement"), "{}", last(found));
    }
    // The law without plasticity stays elastic: its numerical error is that of the tests.
    assert_eq!((stated.verdict.effectivity, coarse.verdict.effectivity), (Some([0.85, 1.6]), Some([0.5, 1.9])));
    // Other reasons may make it low.
    assert_ne!(coarse.verdict.trust, Trust::High);
    let (fine, _) = of(20, &|law| plastic(law, 80e6));
    assert!(fine.deformation.yielding.is_some_and(|found| found.share > 0.0), "{:?}", fine.deformation.yielding);
    assert_eq!(fine.verdict.elastic_margin, None, "the only material yields");
    assert_eq!(fine.verdict.trust == Trust::Low, fine.verdict.text.iter().any(|line| line.starts_with("Do not trust")));
    let round = fine.verdict.text.iter().any(|line| line.contains("but round the sharp corner"));
    assert!(round || fine.verdict.trust == Trust::Low, "{:?}", fine.verdict.text);
    // Flat, at a tenth of the yield stress, in the middle of the block.
    let flat = report(&block(10, 0.0, |law| plastic(law, 600e6)), 60);
    assert!(flat.verdict.elastic_margin.as_ref().is_some_and(|margin| margin.is_shown), "{:?}", flat.verdict);
}

/// The first instant and element are those of the internal variables of all steps.
#[test]
fn the_first_yield_has_its_instant_and_place() {
    let problem = bar(43.6, plastic(of_bar(), 137e6));
    let found = report(&problem, 61);
    let yielding = found.deformation.materials[0].yielding.as_ref().unwrap();
    let times = TimeGrid::uniform(found.end, 61).unwrap();
    let mut history = History::new(&times);
    percute_core::dynamics::simulate(&problem, &times, &mut history, &mut Unobserved).unwrap();
    let (mut first, mut flow) = (None, Vec::new());
    let take = &mut |step: &percute_core::history::Step<'_>| {
        flow = step.internal.chunks_exact(2).map(|variables| variables[1]).collect();
        let most = (0..flow.len()).max_by(|&a, &b| flow[a].total_cmp(&flow[b])).unwrap();
        first = first.or((flow[most] > 0.0).then_some((step.time, most)));
        Ok(())
    };
    history.replay(take).unwrap();
    let place = yielding.first_place.as_ref().unwrap();
    assert_eq!(yielding.first.map(|time| (time, place.element)), first);
    assert_eq!((place.element, &place.centroid[..]), (0, &[1e-3][..]), "the struck element");
    let plastic = yielding.plastic.as_ref().unwrap();
    // Sums of 50 terms.
    let mean = flow.iter().sum::<f64>() / 50.0;
    assert!((plastic.mean_equivalent_strain / mean - 1.0).abs() < 1e-13);
    assert_placed(&problem, &plastic.equivalent_strain);
    // Shortened, in one direction: the mean strain that is left is −p.
    let kept = found.deformation.bodies[0].permanent_strain.as_ref().unwrap();
    assert!((kept[0] / -mean - 1.0).abs() < 1e-13, "{kept:?} {mean}");
    let told = last(&found);
    let words = ["first at ", " s in element 0 at 0.001 m", "would keep a mean strain of −"];
    assert!(words.iter().all(|words| told.contains(words)), "{told}");
}

/// A body with a support keeps what its support leaves, and an elastic one nothing.
#[test]
fn no_strain_is_kept_by_elastic_bodies() {
    let kept = |law: Elastic| report(&bar(10.0, law), 60).deformation.bodies[0].permanent_strain.clone();
    assert_eq!(
        [kept(of_bar()), kept(of_bar().with_yield_stress(1e6).unwrap()), kept(plastic(of_bar(), 1e9))],
        [const { None }; 3]
    );
    assert!(kept(plastic(of_bar(), 1e8)).is_some());
}

/// Half of a bar has another material; the wave crosses a part of it, whose elements yield.
#[test]
fn yielding_is_told() {
    let found = report(&bar(10.0, of_bar().with_yield_stress(100e6).unwrap()), 25);
    let yielding = found.deformation.materials[0].yielding.as_ref().unwrap();
    // ρcv is 137 MPa, behind a front that has crossed 25 · 0.9 of 50 elements.
    assert!((0.3..0.5).contains(&yielding.share), "{yielding:?}");
    assert!(yielding.first.is_some_and(|first| first > 0.0 && first < 8.0 * found.time_step), "{yielding:?}");
    let told = found.verdict.text.last().unwrap();
    assert!(told.contains("above the yield stress of 1.00e8 Pa in") && told.contains("of the body"), "{told}");
    assert_eq!(found.verdict.trust, Trust::High, "the numerical error is that of the linear law");

    let stiff = report(&bar(10.0, of_bar().with_yield_stress(500e6).unwrap()), 25);
    assert_eq!(
        stiff.deformation.materials[0].yielding.as_ref().map(|found| (found.share, found.first)),
        Some((0.0, None))
    );
    let fast = report(&bar(80.0, of_bar()), 25);
    assert!(fast.verdict.text.last().unwrap().contains("of Young's modulus"), "{:?}", fast.verdict.text);
    for quiet in [&stiff, &report(&bar(10.0, of_bar()), 25)] {
        assert!(!quiet.verdict.text.iter().any(|line| line.starts_with("The law is linear")), "{:?}", quiet.verdict);
    }
}

/// A stated yield stress changes nothing but what is told of it.
#[test]
fn the_yield_stress_changes_no_number() {
    let [with, without] = [of_bar().with_yield_stress(1e6).unwrap(), of_bar()].map(|law| report(&bar(10.0, law), 60));
    assert_eq!(with.by_element, without.by_element);
    assert_eq!(with.error, without.error);
    assert_eq!(with.balance, without.balance);
}
