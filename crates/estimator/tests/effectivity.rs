//! Effectivity in 2D: the estimated error over the true one, against a finer run.

use crate::common::{MESHES, assert_close, block};
use percute_core::contact::Obstacle;
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Comparison, Motion};
use percute_estimator::{Ablation, Acceleration, ErrorMeasures, Estimator, Options, Reconstruction};

/// Gap (m) and the least T (s): a run takes steps of exactly 0.9 Δt_c and ends with the first at or
/// past it. (13 µs in equal, slightly shorter steps would give 1.74 instead of 1.80 for the first.)
const GAP: f64 = 0.2e-3;
const END: f64 = 13e-6;
/// Number of steps on the four meshes.
const STEPS: [usize; 4] = [12, 23, 45, 89];

/// An effectivity for each of the four meshes.
type Row = [f64; 4];
/// e_sup/e_ref and e_mean/e_ref of a computation independent of this program: plane stress,
/// μ = 0.2, v = (400, −400) m/s, against 160×128 cells, Γ_DA `closest`.
const INDEPENDENT: [(Reconstruction, Row, Row); 2] = [
    (Reconstruction::Consistent, [1.50, 1.26, 1.18, 1.16], [1.51, 1.26, 1.20, 1.23]),
    (Reconstruction::Published, [1.80, 1.78, 2.02, 2.52], [1.83, 1.65, 1.78, 2.08]),
];

/// Steps of exactly 0.9 Δt_c that reach an instant.
fn grid(problem: &Problem<2>, reach: f64) -> TimeGrid {
    let step = 0.9 * critical_time_step(problem);
    let count = (reach / step).ceil();
    TimeGrid::uniform(count * step, count as usize).unwrap()
}

/// Motion and estimates of one run, in the order of [`INDEPENDENT`].
fn run(problem: &Problem<2>, times: &TimeGrid) -> (Motion, [ErrorMeasures; 2]) {
    let estimator = |which: usize| {
        let options = Options { reconstruction: INDEPENDENT[which].0, ..Options::default() };
        Estimator::new(problem, times, options).unwrap()
    };
    let mut sink = (Motion::default(), (estimator(0), estimator(1)));
    simulate(problem, times, &mut sink, &mut Unobserved).unwrap();
    let (motion, (consistent, published)) = sink;
    (motion, [consistent, published].map(|e| e.finish().unwrap().error))
}

/// All sixteen in one test: they share the reference.
#[test]
fn effectivities_against_a_fine_mesh() {
    let problems = MESHES.map(|cells| block(cells, GAP));
    let grids: Vec<_> = problems.iter().map(|problem| grid(problem, END)).collect();
    let runs: Vec<_> = problems.iter().zip(&grids).map(|(problem, times)| run(problem, times)).collect();

    let fine = block([160, 128], GAP);
    let end = grids.iter().map(TimeGrid::end).fold(0.0, f64::max);
    let times = grid(&fine, end);
    let mut comparison = Comparison::new(&fine);
    for (problem, (motion, _)) in problems.iter().zip(&runs) {
        comparison.add(problem, motion).unwrap();
    }
    simulate(&fine, &times, &mut comparison, &mut Unobserved).unwrap();
    let exact = comparison.finish().unwrap();

    for (k, cells) in MESHES.into_iter().enumerate() {
        assert_eq!(grids[k].step_count(), STEPS[k], "steps on {cells:?}");
        for (which, (reconstruction, sup, mean)) in INDEPENDENT.iter().enumerate() {
            let error = &runs[k].1[which];
            // 3 %: the values are rounded to 0.01, 0.9 % of the smallest, and both programs have a
            // critical step of their own, good to 1e-3, which moves the instants of impact.
            assert_close(error.sup / exact[k].sup, sup[k], 0.03, &format!("{reconstruction}, sup, {cells:?}"));
            assert_close(error.mean / exact[k].mean, mean[k], 0.03, &format!("{reconstruction}, mean, {cells:?}"));
        }
    }
}

/// A run is no error to itself, and the reference must reach its end.
#[test]
fn a_run_against_itself() {
    let problem = block([5, 4], GAP);
    let times = grid(&problem, END);
    let motion = run(&problem, &times).0;
    let mut comparison = Comparison::new(&problem);
    comparison.add(&problem, &motion).unwrap();
    simulate(&problem, &times, &mut comparison, &mut Unobserved).unwrap();
    let error = comparison.finish().unwrap().remove(0);
    // Rounding of the transfer, 1e-16 of the fields, against the 2 900 J^½ of the flight.
    assert!(error.sup < 1e-11, "{}", error.sup);

    let short = TimeGrid::uniform(0.5 * times.end(), times.step_count()).unwrap();
    let mut comparison = Comparison::new(&problem);
    comparison.add(&problem, &motion).unwrap();
    simulate(&problem, &short, &mut comparison, &mut Unobserved).unwrap();
    assert!(comparison.finish().is_err());
}

/// An impact on which the default is held to what docs/verification.md says of it.
struct Impact {
    name: &'static str,
    /// Angle by which the plane is turned clockwise under the block (°).
    tilt: f64,
    /// v₀ (m/s), gap (m) and the least T (s).
    velocity: [f64; 2],
    gap: f64,
    end: f64,
    friction: f64,
    plane_strain: bool,
    /// A disc of radius 20 mm on a polygon instead of the block.
    disc: bool,
    /// What e/e_ref must lie between.
    range: [f64; 2],
}

impl Impact {
    fn problem(&self, level: usize) -> Problem<2> {
        let mesh = if self.disc {
            (0..level).fold(Mesh::disc(0.02, 5).unwrap(), |mesh, _| mesh.refined().unwrap())
        } else {
            Mesh::rectangle(0.05, 0.04, 5 << level, 4 << level).unwrap()
        };
        let (sin, cos) = self.tilt.to_radians().sin_cos();
        let lowest =
            mesh.points_in::<2>().iter().map(|p| p[0] * sin + p[1] * cos).fold(f64::INFINITY, f64::min) - self.gap;
        let plane = Obstacle::plane([sin * lowest, cos * lowest], [sin, cos], self.friction, None).unwrap();
        let law = if self.plane_strain { Elastic::plane_strain } else { Elastic::plane_stress };
        Problem::<2>::builder(mesh)
            .material(law(70e9, 0.3, 2700.0, 1.0).unwrap())
            .initial_velocity(Initial::Uniform(self.velocity))
            .obstacle(plane)
            .build()
            .unwrap()
    }

    /// e_sup/e_ref and e_mean/e_ref on a mesh, with two choices of options, against that of which each cell is cut into
    /// 16.
    fn effectivities(&self, level: usize, options: [Options; 2]) -> [[f64; 2]; 2] {
        let (problem, fine) = (self.problem(level), self.problem(level + 2));
        let times = grid(&problem, self.end);
        let [first, second] = options.map(|options| Estimator::new(&problem, &times, options).unwrap());
        let mut sink = (Motion::default(), (first, second));
        simulate(&problem, &times, &mut sink, &mut Unobserved).unwrap();
        let (motion, (closest, default)) = sink;
        let estimates = [closest, default].map(|e| e.finish().unwrap());
        assert!(estimates.iter().all(|e| e.residuals.largest() <= 1e-11), "{}", self.name);
        let times = grid(&fine, times.end());
        let mut comparison = Comparison::new(&fine);
        comparison.add(&problem, &motion).unwrap();
        simulate(&fine, &times, &mut comparison, &mut Unobserved).unwrap();
        let exact = comparison.finish().unwrap().remove(0);
        estimates.map(|estimate| [estimate.error.sup / exact.sup, estimate.error.mean / exact.mean])
    }
}

const FLAT: Impact = Impact {
    name: "flat",
    tilt: 0.0,
    velocity: [400.0, -400.0],
    gap: GAP,
    end: END,
    friction: 0.2,
    plane_strain: false,
    disc: false,
    range: [0.9, 1.5],
};

/// The ranges that the default was built to meet: 0.9 to 1.5 on flat impacts, to 1.7 on tilted and curved bodies;
/// measured are 1.0 to 1.2 and 1.1 to 1.6. It must not grow with the refinement either; 2 % are left to the instants of
/// impact, which lie elsewhere in the steps, and 10 % where the zone of contact grows from a corner or a point.
#[test]
fn the_default_is_near_the_true_error() {
    let corner = Impact {
        name: "corner",
        tilt: 10.0,
        velocity: [0.0, -400.0],
        gap: 0.12e-3,
        end: 16e-6,
        range: [0.9, 1.7],
        ..FLAT
    };
    let disc = Impact { name: "disc", velocity: [0.0, -100.0], gap: 0.1e-3, disc: true, ..corner };
    let impacts = [
        (FLAT, 0.02),
        (Impact { name: "flat, normal", velocity: [0.0, -400.0], friction: 0.0, ..FLAT }, 0.02),
        (Impact { name: "flat, plane strain, sticking", friction: 0.5, plane_strain: true, ..FLAT }, 0.02),
        (Impact { name: "tilted by 3°", tilt: 3.0, end: 16e-6, range: [0.9, 1.7], ..FLAT }, 0.1),
        (Impact { tilt: 10.0, ..corner }, 0.1),
        (Impact { name: "slow corner", velocity: [0.0, -4.0], gap: 0.12e-5, ..corner }, 0.1),
        (Impact { tilt: 0.0, ..disc }, 0.1),
        (Impact { name: "slow disc", tilt: 0.0, velocity: [0.0, -4.0], gap: 0.4e-5, ..disc }, 0.1),
    ];
    let closest = Options { acceleration: Some(Acceleration::Closest), ..Options::default() };
    for (impact, growth) in impacts {
        let [coarse, fine] = [1, 2].map(|level| impact.effectivities(level, [closest, Options::default()]));
        for (coarse, fine) in coarse.as_flattened().iter().zip(fine.as_flattened()) {
            let told = format!("{}: {coarse} and {fine}", impact.name);
            assert!([coarse, fine].iter().all(|x| (impact.range[0]..=impact.range[1]).contains(*x)), "{told}");
            assert!(*fine <= (1.0 + growth) * coarse, "{told}");
        }
        // Measured: −16 to +1 %; friction that holds the bottom and corners turn the elements most.
        for [closest, default] in [coarse, fine] {
            let change = closest.iter().zip(default).map(|(a, b)| b / a - 1.0);
            let told = format!("{}: {closest:?} and {default:?}", impact.name);
            assert!(change.into_iter().all(|x| (-0.2..0.02).contains(&x)), "{told}");
        }
    }
}

/// Where every touching edge lies in the plane, tractions are as wide as their edges: the estimate is the same with and
/// without narrower ones. A slow corner is where they matter.
#[test]
fn flat_impacts_do_not_concentrate() {
    let options = [Ablation::None, Ablation::Concentration].map(|ablation| Options { ablation, ..Options::default() });
    let [with, without] = FLAT.effectivities(1, options);
    assert_eq!(with, without);
    let corner = Impact { tilt: 10.0, velocity: [0.0, -4.0], gap: 0.12e-5, end: 16e-6, ..FLAT };
    let [with, without] = corner.effectivities(1, options);
    assert!(without[0] > 4.0 * with[0] && without[1] > 4.0 * with[1], "{with:?} {without:?}");
}
