//! Windows at random, against a general solver of quadratic programs.

use super::*;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use percute_core::contact::Obstacle;
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::load::{BodyForce, Table};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::{Random, disc, random_rectangle};

/// 1e-12 of the unit of length of these windows: what a body of size 1 is allowed.
const TOLERANCE: f64 = 1e-12;

/// What a window borrows.
#[derive(Debug)]
struct Drawn {
    start: (f64, f64),
    lengths: Vec<f64>,
    target: Vec<f64>,
    arrives: bool,
}

impl Drawn {
    /// A window of some steps of length about 1 with velocities about 1, mostly inward, so that most
    /// penetrate. It begins with a release or above the plane, far enough away to have a solution.
    fn new(random: &mut Random, most_steps: u64) -> Self {
        let steps = 2 + random.bits() % (most_steps - 1);
        let half: Vec<f64> = (0..steps).map(|_| random.between(0.3, 0.7)).collect();
        let lengths: Vec<f64> = half.iter().flat_map(|h| [*h; 2]).collect();
        let drift = random.between(-0.5, 0.3);
        let target = lengths.iter().map(|_| drift + random.between(-1.0, 1.0)).collect();
        let start = match random.bits() % 2 {
            0 => (0.0, 0.0),
            // Even a velocity of −1 needs no more than 0.35 to turn round.
            _ => (random.between(0.35, 1.0), random.between(-1.0, 0.5)),
        };
        Self { start, lengths, target, arrives: random.bits().is_multiple_of(2) }
    }

    fn window(&self) -> FlightWindow<'_> {
        FlightWindow { start: self.start, lengths: &self.lengths, target: &self.target, arrives: self.arrives }
    }
}

/// Half the weighted square of the distance from the target velocities.
fn objective(window: &FlightWindow<'_>, velocity: &[f64]) -> f64 {
    let square = |k: usize| window.weight(k) * (velocity[k] - window.target[k]).powi(2);
    0.5 * (0..window.free_instants()).map(square).sum::<f64>()
}

/// Minimum with a gap that is not negative at `points` points of every half step only, by an
/// interior-point method.
fn on_a_grid(window: &FlightWindow<'_>, points: usize) -> f64 {
    let free = window.free_instants();
    let mut conditions: Vec<Condition> = Vec::new();
    let last = window.lengths.len() - 1;
    if window.arrives {
        conditions.push(condition(window, &Cut { half_step: last, offset: window.lengths[last] }));
    }
    for (half_step, length) in window.lengths.iter().enumerate() {
        let offsets = (1..=points).map(|p| length * p as f64 / points as f64);
        // The very end of an arrival is the equality above.
        let given = |offset: f64| window.arrives && half_step == last && offset == *length;
        conditions.extend(offsets.filter(|o| !given(*o)).map(|offset| condition(window, &Cut { half_step, offset })));
    }
    let weights: Vec<f64> = (0..free).map(|k| window.weight(k)).collect();
    let quadratic = CscMatrix::new(free, free, (0..=free).collect(), (0..free).collect(), weights.clone());
    let linear: Vec<f64> = (0..free).map(|k| -weights[k] * window.target[k]).collect();
    let rows: Vec<Vec<f64>> = conditions.iter().map(|c| c.row.iter().map(|a| -a).collect()).collect();
    let bounds: Vec<f64> = conditions.iter().map(|c| -c.bound).collect();
    let equal = usize::from(window.arrives);
    let cones = [SupportedConeT::ZeroConeT(equal), SupportedConeT::NonnegativeConeT(rows.len() - equal)];
    let settings = DefaultSettingsBuilder::default().verbose(false).build().unwrap();
    let matrix = CscMatrix::from(&rows);
    let mut solver = DefaultSolver::new(&quadratic, &linear, &matrix, &bounds, &cones, settings).unwrap();
    solver.solve();
    assert_eq!(solver.solution.status, SolverStatus::Solved);
    objective(window, &solver.solution.x)
}

fn penetration(window: &FlightWindow<'_>, path: &Path) -> f64 {
    (-window.deepest(path).1).max(0.0)
}

/// The velocities of a path.
fn velocities(path: &Path) -> Vec<f64> {
    path.iter().map(|p| p.0).collect()
}

/// No half step penetrates between its ends, arrivals arrive, and no admissible motion on a grid of 16
/// points is nearer to the target, nor farther by more than such a grid misses: the gap of a
/// parabola between two points is at least −(step/16)²/8 times its curvature.
#[test]
fn nearest_of_all_that_do_not_penetrate() {
    let mut random = Random::new(1);
    let mut solved = 0;
    for case in 0..400 {
        let drawn = Drawn::new(&mut random, 12);
        let window = drawn.window();
        let path = solve(&window, TOLERANCE);
        assert!(penetration(&window, &path) <= TOLERANCE, "case {case}: {:e}", penetration(&window, &path));
        if window.arrives {
            let (velocity, gap) = path[path.len() - 1];
            // Rounding of sums of some 20 terms of order 1, with multipliers of order 100.
            assert!(velocity == 0.0 && gap.abs() < 1e-12, "case {case}: arrives at {gap:e} with {velocity}");
        }
        if penetration(&window, &window.integrate(&window.shifted())) > TOLERANCE {
            solved += 1;
            let (found, bound) = (objective(&window, &velocities(&path)), on_a_grid(&window, 16));
            // The solver stops at 1e-8.
            assert!(found >= bound - 1e-7 * bound.max(1.0), "case {case}: {found} below {bound}");
            assert!(found <= bound + 5e-3 * bound.max(1.0), "case {case}: {found} above {bound}");
        }
    }
    // Else nothing was tested.
    assert!(solved > 200, "only {solved} windows penetrate");
}

/// Long windows, where many conditions are active at once and their rows are nearly parallel.
#[test]
fn long_windows() {
    let mut random = Random::new(2);
    for case in 0..40 {
        let drawn = Drawn::new(&mut random, 80);
        let window = drawn.window();
        let path = solve(&window, TOLERANCE);
        let depth = penetration(&window, &path);
        assert!(depth <= TOLERANCE, "case {case}, {} half steps: {depth:e}", drawn.lengths.len());
    }
}

/// A body that a body force `g` (N/m³) brings back to a plane of slope `lean`.
fn chattering(mesh: &Mesh, speed: f64, g: f64, lean: f64) -> Problem<2> {
    let lowest = mesh.points_in::<2>().iter().fold(f64::INFINITY, |m, p| m.min(p[1] + lean * p[0]));
    Problem::<2>::builder(mesh.clone())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Uniform([1.0, -speed]))
        .body_force(BodyForce { group: None, value: Table::constant([0.0, -g]) })
        .obstacle(Obstacle::plane([0.0, lowest - 1e-4], [lean, 1.0], 0.2, None).unwrap())
        .build()
        .unwrap()
}

/// Chattering bodies need this: in each of these runs windows penetrate, and none is left to.
#[test]
fn chatter_meets_windows_that_penetrate() {
    let block = random_rectangle(0.05, 0.04, 6, 2).unwrap();
    let disc = disc(0.02, 0.004).unwrap();
    let cases = [
        (&block, 0.9, 10.0, 2.7e9, 0.02),
        (&block, 0.3, 1.0, 1e10, 0.0),
        (&block, 0.9, 300.0, 3e11, 0.1),
        (&disc, 0.3, 300.0, 3e11, 0.1),
    ];
    for (k, (mesh, courant, speed, g, lean)) in cases.into_iter().enumerate() {
        let problem = chattering(mesh, speed, g, lean);
        let end = 250.0 * courant * critical_time_step(&problem);
        let times = TimeGrid::uniform(end, 250).unwrap();
        let before = SHAPED.get();
        let mut estimator = crate::Estimator::new(&problem, &times, crate::Options::default()).unwrap();
        simulate(&problem, &times, &mut estimator, &mut Unobserved).unwrap();
        let estimate = estimator.finish().unwrap();
        assert!(SHAPED.get() > before, "case {k}: no window was solved again");
        // What the method allows.
        assert!(estimate.residuals.penetration_between_instants <= 1e-12, "case {k}");
    }
}

fn window<'a>(start: (f64, f64), lengths: &'a [f64], target: &'a [f64]) -> FlightWindow<'a> {
    FlightWindow { start, lengths, target, arrives: true }
}

/// A step has two half steps, so that tracks never make a window without a free instant; should one
/// come, it is rest, and the way that is missing shows at its end.
#[test]
fn without_free_instants() {
    assert_eq!(solve(&window((0.0, 0.0), &[1.0], &[5.0]), 1e-12), [(0.0, 0.0)]);
    assert_eq!(solve(&window((2.0, -3.0), &[1.0], &[5.0]), 1e-12), [(0.0, 0.5)]);
    // One that cannot but penetrate is left as it is.
    assert_eq!(solve(&window((0.0, -3.0), &[1.0], &[5.0]), 1e-12), [(0.0, -1.5)]);
}

/// Between two contacts with nothing between them but one instant, only rest is left.
#[test]
fn with_one_free_instant() {
    for target in [-3.0, 0.0, 4.0] {
        let path = solve(&window((0.0, 0.0), &[1.0, 1.0], &[target, 0.0]), 1e-12);
        assert_eq!(path, [(0.0, 0.0), (0.0, 0.0)]);
    }
}
