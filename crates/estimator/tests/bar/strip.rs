//! A strip of triangles with ν = 0 against the bar.

use crate::common::bar_in_mode;
use percute_core::dynamics::simulate;
use percute_core::history::History;
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{Acceleration, Estimate, Estimator, Options, Reconstruction};
use percute_exact::{BarEnds, BarMode};
use std::f64::consts::PI;

const MODE: BarMode = BarMode {
    ends: BarEnds::FixedFixed,
    number: 3,
    length: 2.0,
    young: 12.0,
    density: 3.0,
    section: 0.5,
    amplitude: 0.7,
    phase: 0.0,
};

fn bar(elements: usize) -> Problem<1> {
    bar_in_mode(&MODE, elements, &["start", "end"])
}

/// The same bar as a strip of `rows` rows of cells of height hy = aspect·hx.
fn strip(elements: usize, rows: usize, aspect: f64) -> Problem<2> {
    let height = aspect * MODE.length / elements as f64 * rows as f64;
    let mesh = Mesh::rectangle(MODE.length, height, elements, rows).unwrap();
    let displacement = mesh.points_in::<2>().iter().map(|p| [MODE.displacement(p[0], 0.0), 0.0]).collect();
    let law = Elastic::plane_stress(MODE.young, 0.0, MODE.density, MODE.section / height).unwrap();
    let mut builder = Problem::<2>::builder(mesh).material(law).initial_displacement(Initial::Nodal(displacement));
    for group in ["left", "right"] {
        builder = builder.support(Support { group: group.into(), components: [true, false, false], velocity: None });
    }
    builder.build().unwrap()
}

/// History and estimate over two periods in steps of 0.05 h/c: thin cells have a short critical step.
fn run<const D: usize>(problem: &Problem<D>, elements: usize, acceleration: Acceleration) -> (History, Estimate) {
    let times = TimeGrid::with_step(4.0 * PI / MODE.angular_frequency(), 0.05 * MODE.length / elements as f64 / 2.0);
    let times = times.unwrap();
    let estimator = Estimator::new(
        problem,
        &times,
        Options { reconstruction: Reconstruction::Consistent, acceleration: Some(acceleration), ..Options::default() },
    )
    .unwrap();
    let mut sink = (History::new(&times), estimator);
    simulate(problem, &times, &mut sink, &mut Unobserved).unwrap();
    (sink.0, sink.1.finish().unwrap())
}

/// What the strip has of Σe_E² in its inner rows and columns, scaled to its whole section.
fn inner(estimate: &Estimate, elements: usize, rows: usize) -> f64 {
    let row = |j: usize| &estimate.by_element[2 * j * elements..2 * (j + 1) * elements];
    let sum: f64 = (1..rows - 1).flat_map(|j| &row(j)[4..2 * elements - 4]).map(|e| e * e).sum();
    sum * rows as f64 / (rows - 2) as f64
}

/// With its ends held along x, the strip moves exactly as the bar: with ν = 0 and u_y = 0 both
/// triangles of a cell have the strain of the bar's element, and at every node but the corners, which
/// are held, mass and force are the same parts of the bar's.
#[test]
fn the_strip_moves_as_the_bar() {
    let elements = 20;
    let (line, _) = run(&bar(elements), elements, Acceleration::Closest);
    let (flat, _) = run(&strip(elements, 3, 0.7), elements, Acceleration::Closest);
    for n in 0..line.len() {
        let (one, two) = (line.step(n).unwrap().displacement, flat.step(n).unwrap().displacement::<2>());
        for (node, u) in two.iter().enumerate() {
            // Rounding of some hundred steps.
            let miss = (u[0] - one[node % (elements + 1)]).abs().max(u[1].abs());
            assert!(miss < 1e-12 * MODE.amplitude, "step {n}, node {node}: {u:?}");
        }
    }
}

/// The kinetic part. In a triangle with legs hx and hy, ã has the nodal values (0, δ, δ) along x but for
/// a constant. With w = hy²/(hx² + hy²), Γ_DA/ρ − ã is 3tr (`closest`), 3tr − d (`rigid`), 3tr + 3d
/// (`weak`), where tr, the rotation in ã, and d, the rest of ã less its mean, have nodal squares
/// δ²w/6 and δ²(2/3 − w/6). Over a triangle such a field integrates to |E|/12 of its nodal squares:
/// |E|δ² times w/8, w/9 + 1/18 and 1/2. After integration in time δ is hx ∂v/∂x, of which
/// ½∫ρδ² is E_0 (kh)² sin²ωt. (The bar has 0, 1/12 and 1/3: only `closest` is the same in a thin strip.)
#[test]
fn kinetic_parts() {
    let elements = 40;
    let kh2 = (MODE.wave_number() * MODE.length / elements as f64).powi(2);
    for aspect in [1.0, 0.25] {
        let w = aspect * aspect / (1.0 + aspect * aspect);
        let factors = [w / 8.0, w / 9.0 + 1.0 / 18.0, 0.5];
        let choices = [Acceleration::Closest, Acceleration::Rigid, Acceleration::Weak];
        for (choice, factor) in choices.into_iter().zip(factors) {
            let (_, estimate) = run(&strip(elements, 3, aspect), elements, choice);
            let largest = estimate.over_time.iter().fold(0.0_f64, |m, s| m.max(s.parts.kinetic));
            let measured = largest / (MODE.energy() * kh2);
            // Differences of a sine over an element, and ω_h: (kh)²(1/12 + 1/12), 0.92 % measured.
            assert!((measured / factor - 1.0).abs() < 0.25 * kh2, "{choice}, {aspect}: {measured} for {factor}");
        }
    }
}

/// The elastic part in thin cells, hy ≪ hx, away from the sides. Let Δ be the jump of σ_h between two
/// cells, X and Y the coordinates in the lower triangle over hx and hy (0 ≤ Y ≤ X ≤ 1).
/// The star of an inner node gives, by hand, the bar's traction on upright edges, and on the level edge
/// and the diagonal a linear traction along x besides, with moments ±hyΔ/12. With these, in a section X,
/// the force of σ_DA − σ_CA is P = Δ(3X²/2 − X) hy, its moment M = Δ(X³/2 − X²/4) hy², its shear
/// force zero. In the limit only σ_xx costs energy, and least if linear in Y (a beam):
/// ∫∫σ_xx² = Δ²/16 + Δ²/16, a mean of Δ²/4 over the triangle. The bar has Δ²/12.
///
/// So e_E² is 3 times the bar's, and somewhat more, for the quadratic macro-element does not
/// hold that beam (its σ_xx has a term 1/X): 4 % more error is known of it, 8 % in energy.
/// The distance to the limit is of order (hy/hx)².
#[test]
fn elastic_part_in_thin_cells() {
    let (elements, rows) = (40, 5);
    let (_, line) = run(&bar(elements), elements, Acceleration::Closest);
    let own: f64 = line.by_element[2..elements - 2].iter().map(|e| e * e).sum();
    let [coarse, middle, fine] = [0.25, 0.125, 0.0625].map(|aspect| {
        let (_, estimate) = run(&strip(elements, rows, aspect), elements, Acceleration::Closest);
        inner(&estimate, elements, rows) / own
    });
    let order = ((coarse - middle) / (middle - fine)).log2();
    // The next order is (hy/hx)⁴: (1/4)² of the first difference at most.
    assert!((order - 2.0).abs() < 0.1, "order {order}: {coarse}, {middle}, {fine}");
    let limit = fine - (middle - fine) / 3.0;
    assert!(limit > 3.0 && limit < 3.0 * 1.08, "limit {limit}: {coarse}, {middle}, {fine}");
}
