//! Probes against exact fields, and quantities that do not converge for a reason.

use percute_core::contact::Obstacle;
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{AnyProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use percute_exact::BarImpact;
use percute_workflow::effort::Long;
use percute_workflow::quantity::{Probe, Quantity, probes};
use percute_workflow::report::{Report, Subject};
use percute_workflow::run::{Analysis, Storage, run};
use percute_workflow::verify::{Verification, prepare, verify};

const BAR: BarImpact = BarImpact { length: 0.1, young: 70e9, density: 2700.0, section: 1e-4, speed: 10.0, gap: 1e-5 };

/// The largest value of each probe in so many steps of this part of the critical one.
fn largest(problem: &AnyProblem, (courant, steps): (f64, usize), texts: &[&str]) -> Vec<f64> {
    let times = TimeGrid::uniform(courant * critical_time_step(problem) * steps as f64, steps).unwrap();
    let of = |text: &&str| format!("probe:{text}").parse::<Quantity>().unwrap().sink(problem).unwrap().unwrap();
    let mut sinks: Vec<_> = texts.iter().map(of).collect();
    simulate(problem, &times, &mut sinks, &mut Unobserved).unwrap();
    sinks.iter().map(|sink| sink.largest().unwrap()).collect()
}

/// At the critical step, central differences on a uniform bar carry a front without dispersion. The bar strikes in the
/// middle of its run of 100 steps, and the front reaches all probes: the stress is ρcv, to the rounding of so many
/// steps.
#[test]
fn the_stress_of_a_bar_is_that_of_the_exact_impact() {
    let mesh = Mesh::uniform_bar(BAR.length, 50).unwrap();
    let law = Elastic::bar(BAR.young, BAR.density, BAR.section).unwrap();
    // A node comes to rest on the wall at the end of a step.
    let step = BAR.length / 50.0 / BAR.wave_speed();
    let wall = Obstacle::plane([-2.0 * BAR.speed * step], [1.0], 0.0, None).unwrap();
    let builder = Problem::<1>::builder(mesh).material(law).initial_velocity(Initial::Uniform([-BAR.speed]));
    let problem = builder.obstacle(wall).build().unwrap().into();
    let impact = BarImpact { gap: 2.0 * BAR.speed * step, ..BAR };
    let plateau = -impact.normal_force(0.03, impact.impact_time() + 0.05 / BAR.wave_speed()) / BAR.section;
    assert!(plateau > 1e8);
    // Within an element and at a node.
    let stresses = ["0.031:stress", "0.031:von_mises", "0.05:stress", "0.05:velocity", "0.031:pressure"];
    let found = largest(&problem, (1.0 - 1e-12, 60), &stresses);
    let exact = [plateau, plateau, plateau, BAR.speed, plateau / 3.0];
    for (text, (found, exact)) in stresses.iter().zip(found.iter().zip(exact)) {
        assert!((found / exact - 1.0).abs() < 1e-9, "{text}: {found} against {exact}");
    }
}

/// A block with a linear displacement, let go: until the waves of its sides come, the stress is Hooke's.
#[test]
fn the_stress_of_a_block_is_hookes() {
    let (young, poisson, [xx, yy, xy]) = (70e9, 0.3, [1e-4, -3e-4, 2e-4]);
    let mesh = Mesh::rectangle(0.05, 0.04, 10, 8).unwrap();
    let linear = |x: &[f64; 2]| [xx * x[0] + 2.0 * xy * x[1], yy * x[1]];
    let displacement = mesh.points_in::<2>().iter().map(linear).collect();
    let law = Elastic::plane_stress(young, poisson, 2700.0, 1.0).unwrap();
    let problem = Problem::<2>::builder(mesh)
        .material(law)
        .initial_displacement(Initial::Nodal(displacement))
        .build()
        .unwrap()
        .into();
    let factor = young / (1.0 - poisson * poisson);
    let stress = [factor * (xx + poisson * yy), factor * (yy + poisson * xx), young / (1.0 + poisson) * xy];
    let [a, b, c] = stress;
    let von_mises = (a * a - a * b + b * b + 3.0 * c * c).sqrt();
    let fields = [
        ("stress_xx", a.abs()),
        ("stress_yy", b.abs()),
        ("stress_xy", c.abs()),
        ("von_mises", von_mises),
        ("pressure", (a + b).abs() / 3.0),
    ];
    // At a node, on an edge, and within an element.
    for place in ["0.025,0.02", "0.0225,0.02", "0.0263,0.0212"] {
        for (field, exact) in fields {
            let found = largest(&problem, (0.5, 2), &[&format!("{place}:{field}")])[0];
            assert!((found / exact - 1.0).abs() < 1e-12, "{place} {field}: {found} against {exact}");
        }
        let [x, y]: [f64; 2] = place.split(',').map(|x| x.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap();
        let [u, v] = linear(&[x, y]);
        let found = largest(&problem, (0.5, 2), &[&format!("{place}:displacement")])[0];
        assert!((found / u.hypot(v) - 1.0).abs() < 1e-12, "{place}: {found}");
    }
}

/// A body with this outline that falls on a plane (m/s), verified with probes.
fn verified(mesh: &Mesh, (speed, degrees): (f64, f64), texts: &[&str], levels: usize) -> Verification {
    let mesh = mesh.placed(&[0.0, 0.0], degrees).unwrap();
    let law = Elastic::plane_strain(70e9, 0.3, 2700.0, 1.0).unwrap();
    let low = mesh.points_in::<2>().iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
    let build = |gap: f64| {
        let plane = Obstacle::plane([0.0, low - gap], [0.0, 1.0], 0.0, None).unwrap();
        let builder = Problem::<2>::builder(mesh.clone()).material(law);
        builder.initial_velocity(Initial::Uniform([0.0, -speed])).obstacle(plane).build().map(AnyProblem::from).unwrap()
    };
    let step = 0.9 * critical_time_step(&build(1.0));
    let problem = build(1.3 * speed * step);
    let times = TimeGrid::with_step(1.2e-5, step).unwrap();
    let texts: Vec<String> = texts.iter().map(|text| (*text).to_string()).collect();
    let probes: Vec<Probe> = probes(&texts, problem.mesh(), "--probe").unwrap();
    let options = Options { threads: Some(1), ..Options::default() };
    let prepared = prepare(&problem, &times, &options, (levels, Long::asked(false, "--long"))).unwrap();
    verify(&prepared, options, &probes, &mut Unobserved, &mut |_| ()).unwrap()
}

fn warning(verification: &Verification, quantity: &str) -> Option<String> {
    let found = verification.convergence.iter().find(|each| each.quantity == quantity);
    found.unwrap_or_else(|| panic!("there is no {quantity}")).warning.clone()
}

/// A slow block on its corner: one node carries the force. Flat, it has the whole edge.
#[test]
fn the_force_of_a_sharp_corner_is_named() {
    let block = Mesh::rectangle(0.02, 0.01, 8, 4).unwrap();
    let told = warning(&verified(&block, (4.0, 10.0), &[], 2), "averaged_peak_force").unwrap();
    for words in ["The averaged peak force falls by", "one node carries the force", "round the corner"] {
        assert!(told.contains(words), "{told}");
    }
    assert_eq!(warning(&verified(&block, (4.0, 0.0), &[], 2), "averaged_peak_force"), None);
}

/// An L: its stress grows at the re-entrant corner without limit, and beside it the corner is named as long as it is
/// nearer than two elements.
#[test]
fn the_stress_at_a_re_entrant_corner_is_named() {
    let cells = 8;
    let ell = Mesh::rectangle(0.02, 0.02, cells, cells).unwrap();
    let inside = |cell: &&[percute_core::ids::NodeId; 3]| {
        let middle = |c: usize| cell.iter().map(|node| ell.points_in::<2>()[node.index()][c]).sum::<f64>() / 3.0;
        middle(0) < 0.01 || middle(1) < 0.01
    };
    let cells: Vec<[usize; 3]> =
        ell.nodes_of::<3>().iter().filter(inside).map(|cell| cell.map(|node| node.index())).collect();
    let mut numbers = vec![None; ell.node_count()];
    let mut points = Vec::new();
    let mut number = |node: usize| {
        *numbers[node].get_or_insert_with(|| {
            points.push(ell.points_in::<2>()[node]);
            points.len() - 1
        })
    };
    let cells: Vec<[usize; 3]> = cells.into_iter().map(|cell| cell.map(&mut number)).collect();
    let ell = Mesh::new(points, &cells, &[].into(), &[].into()).unwrap();
    let texts = ["0.01,0.01:von_mises", "0.0099,0.0099:von_mises", "0.01,0.01:displacement"];
    let found = verified(&ell, (10.0, 0.0), &texts, 2);
    let at = warning(&found, texts[0]).unwrap();
    for words in
        ["The von Mises stress at (0.01, 0.01) grows by", "the corner at (0.01, 0.01) is re-entrant", "no limit"]
    {
        assert!(at.contains(words), "{at}");
    }
    let near = warning(&found, texts[1]).unwrap();
    assert!(near.contains("1.41e-4 m from the probe"), "{near}");
    // The displacement has a limit there, however its differences fall.
    assert!(warning(&found, texts[2]).is_none_or(|told| !told.contains("re-entrant")));
    assert_eq!(found.levels[2].probes.iter().map(|probe| &probe.name[..]).collect::<Vec<_>>(), texts);
}

/// The value of a quantity is that of the report.
#[test]
fn contact_quantities_are_those_of_the_report() {
    let law = Elastic::bar(BAR.young, BAR.density, BAR.section).unwrap();
    let wall = Obstacle::plane([-BAR.gap], [1.0], 0.0, None).unwrap();
    let builder = Problem::<1>::builder(Mesh::uniform_bar(BAR.length, 20).unwrap()).material(law);
    let problem = builder.initial_velocity(Initial::Uniform([-BAR.speed])).obstacle(wall).build().unwrap().into();
    let critical_step = critical_time_step(&problem);
    let times = TimeGrid::with_step(1.1 * BAR.release_time(), 0.9 * critical_step).unwrap();
    let (analysis, storage) = (Analysis::default(), Storage { file: None, memory: None, open: None });
    let results = run(&problem, &times, &analysis, storage, &mut Unobserved).unwrap().results;
    let (name, held, checked, unended) = ("", None, None, None);
    let subject = Subject { name, problem: &problem, times: &times, critical_step, held, checked, unended };
    let report = Report::new(&subject, Options::default(), results.findings(), 0.0);
    let value = |text: &str| text.parse::<Quantity>().unwrap().value(&report, None);
    let momentum = BAR.density * BAR.section * BAR.length * BAR.speed;
    // Momentum is conserved to rounding.
    let rebound = value("rebound").unwrap();
    assert!((value("impulse").unwrap() / (momentum * (1.0 + rebound / BAR.speed)) - 1.0).abs() < 1e-12);
    assert_eq!(value("peak_force"), report.contact.as_ref().and_then(|contact| Some(contact.averaged_peak?.force)));
    // The mean over the struck element reaches ρScv; behind the front it oscillates by some per cent at 0.9 Δt_c.
    assert!((value("peak_force").unwrap() / BAR.contact_force(BAR.impact_time()) - 1.0).abs() < 0.1);
    assert_eq!(value("probe:0.05:stress"), None);
}
