//! The reference error of an impacting bar, eq. \[60\].

use super::{Motion, ReferenceError, TrueError, TrueErrorSample};
use percute_core::contact::Obstacle;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::{Problem, ProblemRef};
use percute_exact::BarImpact;

/// Data of both bars agree to this, relative: they come from the same few numbers.
const SAME: f64 = 1e-9;

/// The error of a simulated bar impact against the exact solution, at each t_n:
///
/// e² = 1/(2ES) ∫(N_ex − N_h)² + ρS/2 ∫(u̇_ex − u̇_h)²  (J), eq. \[60\],
///
/// with N_h constant and u̇_h linear on each element; an element that holds the wave front is split
/// there, so that the integrals are exact.
///
/// # Errors
/// A simulation of another bar, or a motion of another mesh.
pub fn bar_impact_error<'p>(
    problem: impl Into<ProblemRef<'p>>,
    motion: &Motion,
    exact: &BarImpact,
) -> Result<TrueError, ReferenceError> {
    let Some(problem) = problem.into().typed() else { return Err(ReferenceError::Dimension) };
    if problem.yields() {
        return Err(ReferenceError::ElasticSolution);
    }
    check(problem, exact)?;
    let needed = problem.mesh().node_count();
    for (field, values) in [("displacement", &motion.displacement), ("velocity", &motion.velocity)] {
        if let Some(values) = values.iter().find(|v| v.len() != needed) {
            return Err(ReferenceError::Length { field, given: values.len(), needed });
        }
    }
    let instants = motion.times.iter().zip(&motion.displacement).zip(&motion.velocity);
    let samples = instants.map(|((&time, u), v)| {
        let mut sample = TrueErrorSample { time, ..TrueErrorSample::default() };
        for e in 0..problem.mesh().element_count() {
            add_element(problem, exact, ElementId::new(e), u, v, &mut sample);
        }
        sample
    });
    Ok(TrueError::new(samples.collect()))
}

/// The exact solution must be that of this bar.
fn check(problem: &Problem<1>, exact: &BarImpact) -> Result<(), ReferenceError> {
    let mesh = problem.mesh();
    let low = mesh.points_in::<1>().iter().fold(f64::INFINITY, |m, p| m.min(p[0]));
    let mut pairs = vec![("length", mesh.size(), exact.length), ("start + length", low + mesh.size(), exact.length)];
    for law in problem.materials() {
        pairs.push(("density", law.density(), exact.density));
        pairs.push(("section", law.extent(), exact.section));
        pairs.push(("wave speed", law.wave_speed(), exact.wave_speed()));
    }
    pairs.extend(problem.initial_velocity().iter().map(|v| ("initial velocity", v[0], -exact.speed)));
    for plane in problem.obstacles().iter().filter_map(Obstacle::as_plane) {
        pairs.push(("gap", plane.gap(&[low]), exact.gap));
    }
    match pairs.into_iter().find(|(_, given, exact)| (given - exact).abs() > SAME * exact.abs()) {
        Some((name, given, exact)) => Err(ReferenceError::AnotherBar { name, given, exact }),
        None => Ok(()),
    }
}

/// Adds one element's share of \[60\], piece by piece if the front cuts it.
fn add_element(
    problem: &Problem<1>,
    exact: &BarImpact,
    element: ElementId,
    u: &[f64],
    v: &[f64],
    sample: &mut TrueErrorSample,
) {
    let nodes = problem.mesh().nodes_of::<2>()[element.index()].map(|n| n.index());
    let [x0, x1] = problem.mesh().corners::<1, 2>(element).map(|p| p[0]);
    let ([u0, u1], [v0, v1]) = (nodes.map(|n| u[n]), nodes.map(|n| v[n]));
    let law = problem.material(element);
    let force = law.extent() * law.stress(&[[(u1 - u0) / (x1 - x0)]])[0][0];
    let velocity = |x: f64| v0 + (v1 - v0) * (x - x0) / (x1 - x0);
    let front = exact.front(sample.time).unwrap_or(x0).clamp(x0, x1);
    for (from, to) in [(x0, front), (front, x1)] {
        let (length, middle) = (to - from, 0.5 * (from + to));
        if length <= 0.0 {
            continue;
        }
        let force_error = exact.normal_force(middle, sample.time) - force;
        sample.elastic += 0.5 * length * force_error * force_error / (exact.young * exact.section);
        // Simpson's rule is exact for the square of a linear function.
        let still = exact.velocity(middle, sample.time);
        let square = |x: f64| (still - velocity(x)) * (still - velocity(x));
        let mean = (square(from) + 4.0 * square(middle) + square(to)) / 6.0;
        sample.kinetic += 0.5 * exact.density * exact.section * length * mean;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::material::Elastic;
    use percute_core::mesh::Mesh;
    use percute_core::problem::Initial;

    /// c = 3 m/s, t_c = 0.5 s, ρScv₀ = 1.2 N.
    const BAR: BarImpact = BarImpact { length: 6.0, young: 18.0, density: 2.0, section: 0.1, speed: 2.0, gap: 1.0 };

    fn problem(section: f64) -> Problem<1> {
        Problem::<1>::builder(Mesh::uniform_bar(6.0, 3).unwrap())
            .material(Elastic::bar(18.0, 2.0, section).unwrap())
            .initial_velocity(Initial::Uniform([-2.0]))
            .obstacle(Obstacle::plane([-1.0], [1.0], 0.0, None).unwrap())
            .build()
            .unwrap()
    }

    /// At t = 1.5 the front is at x = 3, in the middle of the second element. A body at rest and
    /// undeformed misses N = −1.2 on [0, 3] and v = −2 on [3, 6]: 1.2²·3/(2·1.8) and ½·0.2·4·3.
    #[test]
    fn an_element_cut_by_the_front_is_split() {
        let zero = vec![0.0; 4];
        let motion =
            Motion { times: vec![1.5], displacement: vec![zero.clone()], velocity: vec![zero], ..Motion::default() };
        let error = bar_impact_error(&problem(0.1), &motion, &BAR).unwrap();
        let sample = error.over_time[0];
        // Rounding of a few products.
        assert!((sample.elastic - 1.2).abs() < 1e-14 && (sample.kinetic - 1.2).abs() < 1e-14, "{sample:?}");
    }

    /// Velocities −2, −2, 1, 1 at t = 0 against −2: ∫ of (3s)² over the second element of length 2
    /// is 6, and 9·2 over the third.
    #[test]
    fn velocities_are_linear() {
        let velocity = vec![-2.0, -2.0, 1.0, 1.0];
        let motion = Motion {
            times: vec![0.0],
            displacement: vec![vec![0.0; 4]],
            velocity: vec![velocity],
            ..Motion::default()
        };
        let error = bar_impact_error(&problem(0.1), &motion, &BAR).unwrap();
        assert!((error.over_time[0].kinetic - 0.5 * 0.2 * 24.0).abs() < 1e-14);
    }

    #[test]
    fn another_bar_is_refused() {
        let motion = Motion {
            times: vec![0.0],
            displacement: vec![vec![0.0; 4]],
            velocity: vec![vec![0.0; 4]],
            ..Motion::default()
        };
        let error = bar_impact_error(&problem(0.2), &motion, &BAR);
        assert!(matches!(error, Err(ReferenceError::AnotherBar { name: "section", .. })), "{error:?}");
        let short = Motion { displacement: vec![vec![0.0; 3]], ..motion };
        assert!(matches!(bar_impact_error(&problem(0.1), &short, &BAR), Err(ReferenceError::Length { .. })));
    }
}
