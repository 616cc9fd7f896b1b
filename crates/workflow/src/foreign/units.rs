//! Quantities in other units, or simply wrong: factors of the terms of the balance, and the start.

use super::attempt::{Attempt, FALL};
use super::complete::Derived;
use super::limits::BALANCE;
use super::measure::Evidence;
use super::quantity::{ScaledQuantity, agree, of_unit, should};
use super::residual::{INERTIA, LOAD, REACTION, STIFFNESS};
use crate::message::times;
use percute_core::material::{Elastic, Law};
use percute_core::problem::AnyProblem;

/// What has the unit of length.
const ALL_LENGTHS: &str = "all lengths (mesh, planes, displacements and `initial_velocity`)";
/// Densities (kg/m³) and wave speeds (m/s) of solids: foam and rubber to tungsten and diamond.
const SOLID: [[f64; 2]; 2] = [[50.0, 25e3], [20.0, 2e4]];

/// What factors are read with.
#[derive(Clone, Copy)]
struct Context {
    /// Velocity of the first step over v₀.
    speed: Option<f64>,
    /// Without given contact forces, another modulus has the same effect as another mass.
    open: bool,
    dimension: usize,
    /// The factor of the displacements that brings the nodes under force onto their plane.
    path: Option<f64>,
    /// The thickness of a plane body (m), if it is the same everywhere.
    thickness: Option<f64>,
    /// Whether all materials have the density and the wave speed of solids: their units are those of SI.
    solid: bool,
}

impl Context {
    fn of(problem: &AnyProblem, evidence: &Evidence<'_>, open: bool) -> Self {
        let extent = problem.materials().first().map(Law::extent);
        let d = problem.dimension();
        let same = |extent: &f64| d == 2 && problem.materials().iter().all(|other| other.extent() == *extent);
        let path = evidence.contact.paths().first().copied();
        let solid = problem.materials().iter().all(is_solid);
        Self { speed: evidence.ends.speed, open, dimension: d, path, thickness: extent.filter(same), solid }
    }
}

/// Factors of one term that leave the least residual.
pub(super) fn one_term(problem: &AnyProblem, evidence: &Evidence<'_>, derived: &[Derived]) -> Vec<Attempt> {
    let mut residual = evidence.residual.clone();
    let silent = evidence.silent();
    if silent {
        residual.leave_the_surface_open();
    }
    let open = silent || derived.contains(&Derived::Reaction);
    let context = Context::of(problem, evidence, open);
    let before = residual.norm([1.0; 4]);
    let one = |term: usize| {
        let factors = residual.fit(&[term])?;
        // A factor of 1 is no cause.
        ((factors[term] - 1.0).abs() > 0.5 * BALANCE).then(|| (factors[term], residual.norm(factors)))
    };
    let named = [
        one(REACTION).map(|(factor, left)| (force(factor, context), left)),
        one(INERTIA).filter(|(factor, _)| *factor > 0.0).map(|(factor, left)| (mass(factor, context), left)),
        one(STIFFNESS).filter(|(factor, _)| *factor > 0.0 && !open).map(|(factor, left)| (young(factor), left)),
        one(LOAD).map(|(factor, left)| (load(factor, context), left)),
    ];
    named.into_iter().flatten().map(|(text, left)| Attempt { text, before, left }).collect()
}

/// Factors of two terms, over the stiffness: lengths in another unit, or another modulus and another density.
pub(super) fn two_terms(problem: &AnyProblem, evidence: &Evidence<'_>) -> Option<Attempt> {
    let residual = &evidence.residual;
    let factors = residual.fit(&[INERTIA, REACTION])?;
    let (of_m, of_r) = (factors[INERTIA], factors[REACTION]);
    let text = match (of_m > 0.0 && of_r > 0.0, evidence.ends.speed) {
        (false, _) => return None,
        // The mass of a plane body grows by the square of lengths, the stiffness does not.
        (true, Some(speed)) if agree(of_m * of_r * of_r, 1.0) && problem.dimension() == 2 && agree(speed, of_r) => {
            format!("mesh and displacements {}", should(1.0 / of_r, ScaledQuantity::Length))
        }
        (true, Some(speed)) if agree(of_m * of_r * of_r, 1.0) && problem.dimension() == 2 && agree(speed, 1.0) => {
            format!("{ALL_LENGTHS} {}", should(1.0 / of_r, ScaledQuantity::Length))
        }
        (true, Some(speed))
            if agree(of_m, of_r * of_r) && problem.dimension() == 1 && agree(speed, 1.0) && of_unit(of_r) =>
        {
            format!("the mesh {}", should(of_r, ScaledQuantity::Length))
        }
        _ if residual_is_of_materials(problem, of_m, of_r) => format!(
            "`young` and `density` are not those of the history: `young` {}, and `density` {}",
            should(1.0 / of_r, ScaledQuantity::Modulus),
            should(of_m / of_r, ScaledQuantity::Density)
        ),
        _ => return None,
    };
    Some(Attempt { text, before: residual.norm([1.0; 4]), left: residual.norm(factors) })
}

/// Whether both factors are no rounding, and no loads tell otherwise.
fn residual_is_of_materials(problem: &AnyProblem, of_m: f64, of_r: f64) -> bool {
    !problem.is_loaded() && [of_m / of_r, of_r].into_iter().all(|factor| (factor - 1.0).abs() > BALANCE)
}

/// A displacement in another unit, by the velocity at the start and by the place of contact.
pub(super) fn displacements(evidence: &Evidence<'_>) -> Option<String> {
    let speed = evidence.ends.speed.filter(|speed| speed.is_finite() && (speed - 1.0).abs() > BALANCE)?;
    // Without any contact force, those of the first step change the velocity.
    let paths = evidence.contact.paths();
    let silent = !evidence.contact.forced.contains(&true);
    if (agree(speed, -1.0) && !paths.iter().any(|path| agree(*path, 1.0))) || (speed < -0.5 && silent) {
        return Some(displaced(-1.0));
    }
    // The displacements as they are must miss the planes.
    let fits = |path: &f64| agree(path * speed, 1.0) && (path * speed - 1.0).abs() <= FALL * (path - 1.0).abs();
    let whole = paths.iter().all(fits);
    let hint = ScaledQuantity::Length.hint(1.0 / speed);
    // Missing forces of the first step change the velocity, too.
    let whole = whole && (!hint.is_empty() || !silent);
    match () {
        () if !paths.is_empty() && whole => Some(displaced(speed)),
        () if paths.is_empty() && !hint.is_empty() => Some(format!(
            "`initial_velocity`, or the unit of the displacements or of `time`, is not that of the history: it starts \
             with {} the stated velocity",
            times(speed)
        )),
        () => None,
    }
}

/// A factor of the contact forces.
fn force(factor: f64, context: Context) -> String {
    if of_displacements(factor, context.speed) {
        return displaced(factor);
    }
    if agree(factor, -1.0) {
        return "the sign of the contact forces is wrong: they are the forces of the planes on the body".to_string();
    }
    let half = agree(factor, 2.0) || agree(factor, 0.5);
    let per_metre = context.thickness.is_some_and(|thickness| thickness != 1.0 && agree(factor, thickness));
    let hint = match () {
        () if per_metre => " (given per metre of thickness?)",
        () if half => " (symmetry or thickness)",
        () => "",
    };
    let other = if context.thickness.is_some() && !half && factor > 0.0 {
        format!(", or `thickness` {}{}", times(1.0 / factor), ScaledQuantity::Length.hint(1.0 / factor))
    } else {
        String::new()
    };
    format!("the contact forces {}{hint}{other}", should(factor, ScaledQuantity::Force))
}

/// The factor that the steps need.
pub(super) fn steps(factor: f64) -> String {
    format!("the steps should be {} as long{}", times(factor), ScaledQuantity::Time.hint(factor))
}

/// A factor of the displacements.
pub(super) fn displaced(factor: f64) -> String {
    if agree(factor, -1.0) {
        return "the sign of the displacements is wrong".to_string();
    }
    format!("the displacements {}", should(1.0 / factor, ScaledQuantity::Length))
}

fn load(factor: f64, context: Context) -> String {
    if of_displacements(factor, context.speed) {
        return displaced(factor);
    }
    format!("the loads {}", should(factor, ScaledQuantity::Force))
}

/// Whether forces need the factor that the displacements have by the start.
fn of_displacements(factor: f64, speed: Option<f64>) -> bool {
    speed.is_some_and(|speed| agree(speed, factor) && (speed - 1.0).abs() > BALANCE)
}

fn young(factor: f64) -> String {
    format!("`young` is not that of the history: it {}", should(factor, ScaledQuantity::Modulus))
}

/// Another mass, or other times: the velocity at the start tells which. Without given contact forces, another modulus
/// has the same effect as another mass.
fn mass(factor: f64, context: Context) -> String {
    let Context { speed, open, .. } = context;
    let scale = factor.sqrt();
    if let Some(text) = mesh(scale, context) {
        return text;
    }
    let time = steps(1.0 / scale);
    let density = format!("it {}", should(factor, ScaledQuantity::Density));
    let modulus = format!("`young` {}", should(1.0 / factor, ScaledQuantity::Modulus));
    let plain = |text: String, certain: bool| match lengths(scale, context).or_else(|| mesh_alone(scale, context)) {
        None => text,
        Some(lengths) if certain => format!("{lengths}. Or {text}"),
        Some(lengths) => format!("{text}. Or {lengths}"),
    };
    let [of_time, of_density] = speed.map_or([1.0; 2], |speed| [(speed * scale - 1.0).abs(), (speed - 1.0).abs()]);
    match () {
        // A factor of time that no unit has comes from lengths.
        () if of_time <= FALL * of_density => {
            plain(format!("`time` is not that of the history: {time}"), !time.contains("given in"))
        }
        () if of_density <= FALL * of_time && open => {
            let both = if agree(factor, 1e6) { " (`young` given in MPa and `density` in t/mm³?)" } else { "" };
            let text = format!(
                "`density` or `young` is not that of the history: the density {}, or {modulus}{both}",
                should(factor, ScaledQuantity::Density)
            );
            plain(text, context.solid)
        }
        () if of_density <= FALL * of_time => {
            plain(format!("`density` is not that of the history: {density}"), context.solid)
        }
        () => format!(
            "`density` or `time` is not that of the history: the density {}, or {time}",
            should(factor, ScaledQuantity::Density)
        ),
    }
}

/// A mesh and planes in another unit than the displacements, by the way to the plane.
fn mesh(scale: f64, context: Context) -> Option<String> {
    let far = context.path.is_some_and(|path| agree(path * scale, 1.0));
    (of_unit(scale) && far).then(|| format!("mesh and planes {}", should(scale, ScaledQuantity::Length)))
}

/// A mesh in another unit than all the rest: in the balance of a plane body, only the mass depends on its lengths.
fn mesh_alone(scale: f64, context: Context) -> Option<String> {
    let only = context.dimension == 2 && context.speed.is_some_and(|speed| agree(speed, 1.0));
    (of_unit(scale) && only).then(|| format!("the mesh {}", should(scale, ScaledQuantity::Length)))
}

/// All lengths in another unit, or all but v₀, which have the effect of another mass where no contact force is given.
/// In a bar they always have.
fn lengths(scale: f64, context: Context) -> Option<String> {
    if !of_unit(scale) || !(context.open || context.dimension == 1) {
        return None;
    }
    let speed = context.speed.unwrap_or(1.0);
    let which = match () {
        () if agree(speed, 1.0) => ALL_LENGTHS,
        () if agree(speed * scale, 1.0) => "mesh, planes and displacements",
        () => return None,
    };
    Some(format!("{which} {}", should(scale, ScaledQuantity::Length)))
}

/// Whether a material has the density and the wave speed of a solid.
fn is_solid(material: &Elastic) -> bool {
    let (density, speed) = (material.density(), (material.young() / material.density()).sqrt());
    let [densities, speeds] = SOLID.map(|[least, most]| least..=most);
    densities.contains(&density) && speeds.contains(&speed)
}
