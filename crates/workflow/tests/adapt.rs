//! Adaptations: runs on meshes that follow from the estimate before.

use percute_core::ids::ElementId;
use percute_core::mesh::{Locator, Mesh};
use percute_core::observer::{Observer, Progress, Unobserved};
use percute_core::problem::AnyProblem;
use percute_workflow::adapt::{Adaptation, Adapting, Measure, Mesher, Reason, Wish, adapt, table};
use percute_workflow::case::{Case, Source, parse};
use percute_workflow::plan::{Basis, Branch, Plan};
use std::ops::ControlFlow;

/// A case of a plane body with this mesh and, beside material and steps, these tables.
fn plane(mesh: &str, tables: &str) -> Case {
    let material = "young = 70e9\npoisson = 0.3\ndensity = 2700.0\nplane = \"stress\"";
    let text = format!("[mesh]\n{mesh}\n[material]\n{material}\n{tables}\ncourant = 0.9\n");
    parse(Source::new("case", text)).unwrap()
}

/// A block whose corner strikes a plane that is inclined by 10°: 1e-4 m away for 400 m/s.
fn corner(speed: f64) -> Case {
    let [sin, cos] = [0.173_648_177_666_930_33, 0.984_807_753_012_208];
    let gap = 2.5e-7 * speed;
    let tables = format!(
        "[initial]\nvelocity = [{}, {}]\n[[obstacle]]\npoint = [{}, {}]\nnormal = [{sin}, {cos}]\nfriction = 0.2\n\
         [time]\nend = 40e-6",
        -speed * sin,
        -speed * cos,
        -gap * sin,
        -gap * cos
    );
    plane("rectangle = { width = 0.05, height = 0.04, nx = 10, ny = 8 }", &tables)
}

fn adapted(case: &Case, wish: Wish) -> Adaptation {
    let wish = (wish, Mesher::Bisection);
    adapt(&case.problem, &case.times, case.options, wish, &mut Unobserved, &mut |_| ()).unwrap()
}

/// The target is reached on few elements, and each run has the expected error to the part that the prototypes had.
#[test]
fn corners_get_graded_meshes() {
    // With the published relative errors, 6 % at 40 m/s and 11 % at 4 m/s: at most 3 and 4 runs, 350 elements, and
    // 9e5 elements times steps on the last mesh.
    for (speed, target, runs, elements) in [(40.0, 0.23, 3, 350), (4.0, 0.41, 4, 450)] {
        let adaptation = adapted(&corner(speed), Wish::new(target));
        let told = table(&adaptation);
        let last = adaptation.iterations.last().unwrap();
        assert_eq!(adaptation.reason, Some(Reason::Reached), "{told}");
        assert!(adaptation.iterations.len() <= runs && last.elements <= elements, "{told}");
        assert!(last.element_steps < 9e5, "{told}");
        for run in &adaptation.iterations[1..] {
            assert_eq!(run.branch, Some(Branch::Graded));
            // 0.70 to 1.0 on these two; the prototypes had 0.72 to 1.28.
            assert!((0.65..1.28).contains(&(run.error / run.predicted.unwrap())), "{told}");
        }
        // The smallest elements are in the corner, and 4 and more times smaller than the largest.
        let mesh = adaptation.best.as_ref().unwrap().problem.mesh();
        let sizes: Vec<f64> = (0..mesh.element_count()).map(|e| mesh.volume(ElementId::new(e))).collect();
        let smallest = (0..sizes.len()).min_by(|&a, &b| sizes[a].total_cmp(&sizes[b])).unwrap();
        let near = mesh.corners::<2, 3>(ElementId::new(smallest)).iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
        assert!(near < 2e-3, "{near}");
        assert!(last.sizes[1] > 4.0 * last.sizes[0]);
    }
}

/// All meshes are nested in the first one and keep its groups; any number of threads gives the same bits.
#[test]
fn graded_meshes_are_bisections() {
    let case = corner(4.0);
    let wish = Wish { measure: Measure::Sup, ..Wish::new(0.45) };
    let (found, first) = (adapted(&case, wish.clone()), case.problem.mesh());
    let best = found.best.as_ref().unwrap().problem.mesh();
    let locator = Locator::new(first);
    for e in (0..best.element_count()).map(ElementId::new) {
        let parent = locator.element_at(&best.centroid(e)).unwrap();
        // Rounding of barycentric coordinates.
        assert!(best.cell_points(e).iter().all(|p| locator.weights(parent, p).iter().all(|w| *w > -1e-12)));
    }
    let length = |mesh: &Mesh, name: &str| -> f64 {
        mesh.face_groups()[name].iter().map(|face| mesh.normal_in::<2>(*face).1).sum()
    };
    for name in ["left", "right", "bottom", "top"] {
        assert!((length(best, name) - length(first, name)).abs() < 1e-15, "{name}");
    }
    let mut other = case.clone();
    other.options.threads = Some(1);
    assert_eq!(adapted(&other, wish).iterations, found.iterations);
}

/// A front gets a uniform mesh of its generator, with the expected error; far targets are refused after the first run,
/// with the work that they need.
#[test]
fn fronts_get_uniform_meshes() {
    let flat = plane(
        "rectangle = { width = 0.05, height = 0.04, nx = 10, ny = 8, diagonals = \"crossed\" }",
        "[initial]\nvelocity = [0.0, -20.0]\n[[obstacle]]\npoint = [0.0, -1e-5]\nnormal = [0.0, 1.0]\nfriction = 0.2\n\
         [time]\nend = 13e-6",
    );
    let found = adapted(&flat, Wish::new(0.2));
    let (told, mesh) = (table(&found), found.best.as_ref().unwrap().problem.mesh());
    assert_eq!(found.reason, Some(Reason::Reached), "{told}");
    assert!(found.iterations.len() <= 3 && mesh.resized(1.0).is_some(), "{told}");
    for run in &found.iterations[1..] {
        assert_eq!(run.branch, Some(Branch::Uniform));
        // The prototypes had 0.95 to 1.03 at fronts, and 0.89 to 1.28 elsewhere.
        assert!((0.89..1.28).contains(&(run.error / run.predicted.unwrap())), "{told}");
    }
    let far = adapted(&flat, Wish::new(0.005));
    assert_eq!((far.reason.as_ref(), far.iterations.len()), (Some(&Reason::Limit), 1));
    assert!(far.needed.unwrap().element_steps > 1e8 && table(&far).contains("The target needs about"));
    let reachable = far.reachable.unwrap();
    assert!(reachable > 0.005 && reachable < far.iterations[0].error, "{}", table(&far));
    // Of halves, e falls like h^q: 2^(3/q) times the work.
    let best = far.best.as_ref().unwrap();
    let basis = Basis::new(best.problem.mesh(), &best.results.estimate, &best.results.contact).unwrap();
    let (half, quarter) = (Plan::whole(&basis, 0.5).unwrap(), Plan::whole(&basis, 0.25).unwrap());
    assert!((quarter.cost / half.cost / half.cost - 1.0).abs() < 1e-9);
    assert!((half.cost.log2() - 3.0 / half.exponents.far).abs() < 1e-9);
}

/// A bar has exponents and bisections of its own.
#[test]
fn bars_are_adapted() {
    let text = "[mesh]\nbar = { length = 0.1, elements = 16 }\n[material]\nyoung = 70e9\ndensity = 2700.0\n\
                section = 0.02\n[initial]\nvelocity = -4.0\n[[obstacle]]\npoint = -1e-5\nnormal = 1.0\n[time]\n\
                end = 60e-6\ncourant = 0.9\n";
    let case = parse(Source::new("case", text.to_string())).unwrap();
    let wish = (Wish::new(0.08), Mesher::Bisection);
    let found = adapt(&case.problem, &case.times, case.options, wish, &mut Unobserved, &mut |_| ()).unwrap();
    assert_eq!(found.reason, Some(Reason::Reached), "{}", table(&found));
    assert!(found.iterations.len() <= 4, "{}", table(&found));
}

/// Two blocks whose nodes face each other in pairs, the upper one tilted: pairs stay pairs.
#[test]
fn surfaces_in_pairs_stay_so() {
    let body = |name: &str, place: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nrectangle = {{ width = 0.04, height = 0.02, nx = 4, ny = 2 }}\nmaterial = \
             {{ young = 70e9, poisson = 0.3, density = 2700.0, plane = \"stress\" }}\n{place}\n"
        )
    };
    let bodies = body("lower", "") + &body("upper", "origin = [0.0, 0.02001]\nvelocity = [0.0, -2.0]");
    let rest = "[[contact]]\nfriction = 0.2\n[[support]]\ngroup = \"lower.bottom\"\ncomponents = [\"x\", \"y\"]\n\
                [time]\nend = 30e-6\ncourant = 0.9\n";
    let text = bodies + rest;
    let case = parse(Source::new("case", text)).unwrap();
    let pairs = |problem: &AnyProblem| problem.facing_nodes().iter().map(Vec::len).sum::<usize>();
    assert_eq!(pairs(&case.problem), 5);
    let found = adapted(&case, Wish::new(0.25));
    assert_eq!(found.reason, Some(Reason::Reached), "{}", table(&found));
    assert!(pairs(&found.best.as_ref().unwrap().problem) > 5, "{}", table(&found));
}

/// Breaks in the second run.
struct Stops {
    runs: usize,
}

impl Observer for Stops {
    fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        self.runs += usize::from(progress.done == 0);
        if self.runs > 1 && progress.done > 20 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// What is done stays, whatever ends the runs.
#[test]
fn the_best_run_stays() {
    let case = corner(4.0);
    let wish = (Wish::new(0.3), Mesher::Bisection);
    let mut adapting = Adapting::new(&case.problem, &case.times, case.options, wish.clone()).unwrap();
    let mut stops = Stops { runs: 0 };
    while adapting.upcoming().unwrap().is_some() {
        adapting.run(&mut stops).unwrap();
    }
    let stopped = adapting.so_far();
    assert_eq!((stopped.reason.as_ref(), stopped.iterations.len()), (Some(&Reason::Interrupted), 1));
    assert!(table(&stopped).contains("Interrupted; target 30.0 % (mean) not reached: run 0"), "{}", table(&stopped));
    let few = adapted(&case, Wish { runs: 2, ..wish.0.clone() });
    assert_eq!((few.reason.as_ref(), few.iterations.len()), (Some(&Reason::Runs), 2));
    let limited = adapted(&case, Wish { limit: 2e5, ..wish.0 });
    assert_eq!((limited.reason.as_ref(), limited.best.as_ref().map(|best| best.run)), (Some(&Reason::Limit), Some(1)));
    // The run of the best mesh has the bits of the table.
    let best = limited.best.unwrap();
    assert_eq!(best.report.error.relative_mean, limited.iterations[1].error);
}

/// The impulse of a slow corner and the largest displacement of its far side come near to their limits; the force of
/// one node does not, which is said with its reason.
#[test]
fn quantities_come_near_to_their_limits() {
    let case = corner(40.0);
    let on = |text: &str, target: f64| Wish { on: Some(text.parse().unwrap()), ..Wish::new(target) };
    let impulse = adapted(&case, on("impulse", 0.01));
    let told = table(&impulse);
    assert_eq!(impulse.reason, Some(Reason::Reached), "{told}");
    let values: Vec<f64> = impulse.iterations.iter().map(|run| run.quantity.unwrap()).collect();
    let [.., before, last] = values[..] else { panic!("{told}") };
    assert!((last / before - 1.0).abs() <= 0.01 && told.contains("(impulse) reached"), "{told}");
    // 214.4 N s/m on 12992 elements of a mesh that is graded towards the corner, and 0.2 % less on four times fewer.
    assert!((last / 214.4 - 1.0).abs() < 0.02, "{told}");
    let probe = adapted(&case, on("probe:0.05,0.04:displacement", 0.02));
    assert_eq!(probe.reason, Some(Reason::Reached), "{}", table(&probe));
    let force = adapted(&corner(4.0), Wish { runs: 4, ..on("peak_force", 0.001) });
    let Some(Reason::NoLimit(why)) = &force.reason else { panic!("{}", table(&force)) };
    assert!(why.contains("one node carries the force") && force.iterations.len() == 3, "{why}");
    let never = adapt(
        &case.problem,
        &case.times,
        case.options,
        (on("rebound", 0.1), Mesher::Bisection),
        &mut Unobserved,
        &mut |_| (),
    );
    assert!(never.err().unwrap().to_string().contains("the rebound has no value"));
}

#[test]
fn wishes_out_of_range_are_refused() {
    let case = corner(4.0);
    for wish in [
        Wish::new(0.0),
        Wish::new(0.5),
        Wish::new(f64::NAN),
        Wish { limit: f64::INFINITY, ..Wish::new(0.1) },
        Wish { runs: 0, ..Wish::new(0.1) },
    ] {
        assert!(Adapting::new(&case.problem, &case.times, case.options, (wish, Mesher::Bisection)).is_err());
    }
    let mut options = case.options;
    options.reconstruction = percute_estimator::Reconstruction::Consistent;
    let refused =
        Adapting::new(&case.problem, &case.times, options, (Wish::new(0.1), Mesher::Bisection)).err().unwrap();
    assert!(refused.to_string().contains("take \"corrected\""), "{refused}");
}
