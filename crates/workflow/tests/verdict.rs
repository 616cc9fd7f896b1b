//! Properties that no case of the evidence has lower the trust, and are named; such cases without them keep theirs.

use percute_core::observer::Unobserved;
use percute_workflow::case::{Case, Source, parse};
use percute_workflow::report::{Report, Touches, Trust, Verdict};
use percute_workflow::run::{Analysis, Storage, run};

const ALUMINIUM: &str = "young = 70e9\ndensity = 2700.0\n";
/// A bar of 20 elements of 2 mm, which a wave passes in 0.39 µs each.
const BAR: &str =
    "[mesh]\nbar = { length = 0.04, elements = 20 }\n[material]\nsection = 1e-4\nyoung = 70e9\ndensity = 2700.0\n";

fn verdict(text: &str) -> Verdict {
    let case = parse(Source::new("case.toml", text)).unwrap_or_else(|error| panic!("{error}\n{text}"));
    of(&case)
}

fn of(case: &Case) -> Verdict {
    let (analysis, storage) =
        (Analysis { options: case.options, ..Analysis::default() }, Storage { file: None, memory: None, open: None });
    let results = run(&case.problem, &case.times, &analysis, storage, &mut Unobserved).unwrap().results;
    let (subject, options) = (case.subject(), case.options);
    Report::new(&subject, options, results.findings(), 0.0).verdict
}

/// A block of aluminium over a plane, with cells along both sides, a gap (m), a speed towards the plane (m/s), an end
/// (s), and what else is stated.
fn block(cells: [usize; 2], gap: f64, speed: f64, end: f64, more: &str) -> String {
    let [nx, ny] = cells;
    format!(
        "[mesh]\nrectangle = {{ width = 0.05, height = 0.04, nx = {nx}, ny = {ny} }}\n[material]\n{ALUMINIUM}poisson = \
         0.3\nplane = \"stress\"\n[initial]\nvelocity = [0.0, -{speed}]\n[[obstacle]]\npoint = [0.0, -{gap}]\nnormal \
         = [0.0, 1.0]\nfriction = 0.2\n[time]\nend = {end}\ncourant = 0.9\n{more}"
    )
}

/// The bar with what else is stated, up to 20 µs.
fn bar(more: &str) -> String {
    format!("{BAR}{more}\n[time]\nend = 2e-5\ncourant = 0.9\n")
}

/// Fails unless exactly this is named, and trust is limited by it.
fn names(text: &str, outside_tested_range: &str) {
    let found = verdict(text);
    assert_eq!(found.outside_tested_range, [outside_tested_range], "{found:?}\n{text}");
    assert_eq!(found.trust, Trust::Limited, "{found:?}");
    assert!(found.text[0].contains(&format!("outside the tested range: {outside_tested_range}")), "{found:?}");
}

/// Fails if anything is named.
fn names_nothing(text: &str) {
    let found = verdict(text);
    assert!(found.outside_tested_range.is_empty() && found.trust == Trust::High, "{found:?}\n{text}");
}

#[test]
fn loads_that_jump_are_not_tested() {
    let pulled = |table: &str| bar(&format!("[[traction]]\ngroup = \"end\"\n{table}"));
    names(&pulled("value = 1e8"), "a sudden load");
    names(&pulled("time = [0.0, 5e-6, 5.1e-6]\nvalue = [0.0, 0.0, 1e8]"), "a sudden load");
    // 16 µs are 41 steps of an element.
    names_nothing(&pulled("time = [0.0, 1.6e-5]\nvalue = [0.0, 1e8]"));
    // The jump comes after the end.
    names_nothing(&pulled("time = [0.0, 1.6e-5, 3e-5, 3.01e-5]\nvalue = [0.0, 1e8, 1e8, 0.0]"));
}

#[test]
fn bodies_that_begin_with_a_stress_or_a_jump_are_not_tested() {
    let field = |name: &str, of: &dyn Fn(f64) -> f64| {
        let values: Vec<_> = (0..=20).map(|i| format!("{:e}", of(0.05 * f64::from(i)))).collect();
        bar(&format!("[initial]\n{name} = [{}]", values.join(", ")))
    };
    names(&field("displacement", &|x| 4e-5 * x), "an initial strain");
    names(&field("velocity", &|x| if x < 0.5 { 10.0 } else { 0.0 }), "a velocity jump inside a body");
    names_nothing(&field("velocity", &|x| 10.0 * (std::f64::consts::PI * x).cos()));
    // A bar that is moved as a whole flies.
    let moved = "[initial]\ndisplacement = 0.1\nvelocity = -10.0\n[[obstacle]]\npoint = 0.09999\nnormal = 1.0";
    names_nothing(&bar(moved));
}

#[test]
fn bodies_that_tractions_push_to_their_plane_are_not_tested() {
    let push = "[[traction]]\ngroup = \"top\"\ntime = [0.0, 2e-5]\nvalue = [[0.0, 0.0], [0.0, -1e8]]\n";
    let pushed = "an impact driven by a traction";
    names(&block([10, 8], 0.0, 0.0, 4e-5, push), pushed);
    let at_once = block([10, 8], 0.0, 0.0, 2e-5, "[[traction]]\ngroup = \"top\"\nvalue = [0.0, -1e8]\n");
    assert_eq!(verdict(&at_once).outside_tested_range, ["a sudden load", pushed]);
    // The traction changes the flight by little, or jumps by little of the 140 MPa of the impact.
    names_nothing(&block([10, 8], 1e-5, 10.0, 1.4e-5, push));
    let weak = |stress: f64| format!("[[traction]]\ngroup = \"top\"\nvalue = [0.0, -{stress}]\n");
    names_nothing(&block([10, 8], 1e-5, 10.0, 1.4e-5, &weak(1e7)));
    names(&block([10, 8], 1e-5, 10.0, 1.4e-5, &weak(2e7)), "a sudden load");
    // A body that falls from rest flies to its plane.
    let weight = "[[body_force]]\nvalue = [0.0, -2.7e9]\n";
    names_nothing(&block([10, 8], 2e-5, 0.0, 2e-5, weight));
}

#[test]
fn long_elements_are_not_tested() {
    names(&block([5, 40], 1e-5, 10.0, 1.4e-5, ""), "elements 10 times as long as their shortest edge");
    // √10 = 3.2 is above the limit of 3, √5 below.
    assert_eq!(verdict(&block([10, 24], 1e-5, 10.0, 1.4e-5, "")).outside_tested_range.len(), 1);
    names_nothing(&block([10, 16], 1e-5, 10.0, 1.4e-5, ""));
}

#[test]
fn long_elements_with_little_of_the_error_are_not_named() {
    // A row of thin cells at the top of a block that falls flat: nothing has arrived there.
    let rows = [0.0, 0.005, 0.01, 0.015, 0.02, 0.025, 0.03, 0.035, 0.039, 0.04];
    let points: Vec<_> = rows.iter().flat_map(|y| (0..=10).map(move |i| [0.005 * f64::from(i), *y])).collect();
    let quads = (0..9).flat_map(|row| (0..10).map(move |column| 11 * row + column));
    let cells: Vec<_> = quads.flat_map(|a| [[a, a + 1, a + 12], [a, a + 12, a + 11]]).collect();
    let text = block([1, 1], 1e-5, 10.0, 5e-6, "");
    let (_, after) = text.split_once("[material]").unwrap();
    let found = verdict(&format!("[mesh]\npoints = {points:?}\ncells = {cells:?}\n[material]{after}"));
    assert!(found.outside_tested_range.is_empty(), "{found:?}");
}

#[test]
fn thin_bodies_that_fall_flat_do_not_bend() {
    let text =
        block([40, 4], 1e-5, 10.0, 1e-5, "").replace("width = 0.05, height = 0.04", "width = 0.05, height = 0.005");
    names(&text, "edge contact of a thin body");
    assert_eq!(verdict(&text).effectivity, Some([0.85, 1.6]));
}

#[test]
fn strong_contrasts_are_not_tested() {
    // Impedances are as densities where the wave speed is the same.
    let layers = |ratio: f64| {
        let points: Vec<_> =
            (0..=8).flat_map(|j| (0..=10).map(move |i| [f64::from(i), f64::from(j)].map(|x| 0.005 * x))).collect();
        let quads = (0..8).flat_map(|row| (0..10).map(move |column| 11 * row + column));
        let cells: Vec<_> = quads.flat_map(|a| [[a, a + 1, a + 12], [a, a + 12, a + 11]]).collect();
        let (lower, upper): (Vec<_>, Vec<_>) = ((0..80).collect(), (80..160).collect());
        let text = block([1, 1], 1e-5, 10.0, 1.4e-5, "");
        let (_, after) = text.split_once("[initial]").unwrap();
        let layer = |group: &str, factor: f64| {
            let (young, density) = (70e9 * factor, 2700.0 * factor);
            format!(
                "[[material]]\ngroup = \"{group}\"\nyoung = {young}\ndensity = {density}\npoisson = 0.3\nplane = \
                 \"stress\"\n"
            )
        };
        let groups = format!("[mesh.element_groups]\nlower = {lower:?}\nupper = {upper:?}\n");
        let mesh = format!("[mesh]\npoints = {points:?}\ncells = {cells:?}\n{groups}");
        format!("{mesh}{}{}[initial]{after}", layer("lower", 1.0), layer("upper", ratio))
    };
    names(&layers(100.0), "impedances that differ by a factor of 100");
    names(&layers(0.02), "impedances that differ by a factor of 50");
    names_nothing(&layers(30.0));
}

#[test]
fn bars_of_very_different_elements_are_not_tested() {
    let coarse_behind = |fine: usize| {
        let points =
            (0..fine).map(|i| 0.02 * i as f64 / fine as f64).chain((0..=5).map(|i| 0.02 + 0.004 * f64::from(i)));
        let points: Vec<_> = points.collect();
        let cells: Vec<_> = (1..points.len()).map(|i| [i - 1, i]).collect();
        let mesh = format!("[mesh]\npoints = {points:?}\ncells = {cells:?}\n");
        let rest = bar("[initial]\nvelocity = -10.0\n[[obstacle]]\npoint = -1e-5\nnormal = 1.0");
        mesh + &rest[rest.find("[material]").unwrap()..]
    };
    names(&coarse_behind(50), "elements of a bar that differ by a factor of 10");
    names_nothing(&coarse_behind(25));
}

#[test]
fn a_force_at_the_last_instant_is_contact() {
    // Lands after 1 µs; the step is 0.585 µs, so that the force of the second instant acts in the run that ends there.
    let text = block([10, 8], 1e-5, 10.0, 1e-6, "");
    let found = verdict(&text);
    // Nothing vibrates yet: the error is as large.
    assert_eq!((found.touches, found.trust), (Touches::Edge, Trust::Low), "{found:?}");
    assert_eq!(found.outside_tested_range, ["0 wave passages after the first touch"], "{found:?}");
    assert!(found.at_contact > 0.5, "{found:?}");
    // A run that ends before has no contact.
    assert_eq!(verdict(&block([10, 8], 1e-5, 10.0, 3e-7, "")).touches, Touches::None);
}
