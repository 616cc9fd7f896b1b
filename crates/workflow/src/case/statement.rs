//! A problem written down in the language of the case files, and read again: the same problem, bit
//! by bit. Mesh, initial fields and instants are arrays, which a text would only make longer; they
//! are kept beside it.

use super::source::{CaseError, Source};
use super::table::Table;
use super::text::{Writer, list, quoted, vector};
use super::{AXES, estimate, parsed, problem};
use percute_core::border::Vector;
use percute_core::contact::{AnyObstacle, Interface};
use percute_core::load::{BodyForce, Profile, Support, Table as InTime, Traction};
use percute_core::material::{Elastic, Hypothesis, Law};
use percute_core::mesh::Mesh;
use percute_core::problem::{AnyProblem, Statement};
use percute_estimator::{Options, Sampling};
use std::sync::Arc;
use thiserror::Error;

/// Tables of a case file that a statement does not have.
const BESIDE: [&str; 5] = ["mesh", "body", "initial", "time", "output"];

/// A problem that the language of the case files has no words for.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum NotRepresentable {
    /// A law for a body of another dimension.
    #[error(
        "material {index} is a law for {law}, but the mesh has {dimension} dimension(s): a case file gives a bar \
         `section` and a plane body `plane`; make it with Elastic::bar (1), plane_stress, plane_strain (2) or solid \
         (3)",
        law = law_name(*.hypothesis)
    )]
    Law {
        /// Which material, from 1.
        index: usize,
        hypothesis: Hypothesis,
        dimension: usize,
    },
}

fn law_name(hypothesis: Hypothesis) -> &'static str {
    match hypothesis {
        Hypothesis::Bar => "a bar",
        Hypothesis::PlaneStress | Hypothesis::PlaneStrain => "a plane body",
        Hypothesis::Solid => "a solid",
    }
}

/// Writes down a problem: the tables `[[material]]`, `[[obstacle]]`, `[[contact]]`, `[[support]]`, `[[traction]]`,
/// `[[body_force]]` and, with options, `[estimate]`. Mesh, initial fields and instants are left out.
/// [`problem_from`] makes the same problem of it, bit by bit.
///
/// # Errors
/// A problem that the language cannot say.
pub fn statement(problem: &AnyProblem, options: Option<&Options>) -> Result<String, NotRepresentable> {
    let (stated, mut text) = (problem.conditions(), Writer::default());
    let d = problem.dimension();
    for (i, (group, law)) in stated.materials.iter().enumerate() {
        material(&mut text, i, (group.as_deref(), law), d)?;
    }
    for one in problem.obstacles() {
        if let Some(plane) = one.as_plane() {
            obstacle(&mut text, &one, &plane.map(|vector| vector[..d].to_vec()));
        }
    }
    stated.interfaces.iter().for_each(|one| interface(&mut text, one));
    stated.supports.iter().for_each(|one| support(&mut text, one, d));
    stated.tractions.iter().for_each(|one| traction(&mut text, one, d));
    stated.body_forces.iter().for_each(|one| body_force(&mut text, one, d));
    if let Some(options) = options {
        text.table("[estimate]");
        text.key("reconstruction", quoted(&options.reconstruction.to_string()));
        if let Some(acceleration) = options.acceleration {
            text.key("acceleration", quoted(&acceleration.to_string()));
        }
        let every = match options.every {
            Sampling::Auto => quoted(&Sampling::Auto.to_string()),
            // Integers of TOML have 63 bits; no run has that many steps.
            Sampling::Every(steps) => i64::try_from(steps).unwrap_or(i64::MAX).to_string(),
        };
        text.key("every", every);
    }
    Ok(text.finish())
}

/// Reads what [`statement`] wrote, on a mesh and with initial displacement (m) and velocity (m/s) at
/// the nodes, in rows. The options are the defaults where the text has none.
///
/// # Errors
/// The first thing that is wrong; `[mesh]`, `[initial]`, `[time]` and `[output]`, which are no part of a statement.
pub fn problem_from(
    source: &Source,
    mesh: &Arc<Mesh>,
    initial_displacement: Vec<f64>,
    initial_velocity: Vec<f64>,
) -> Result<(AnyProblem, Options), CaseError> {
    let document = parsed(source)?;
    let root = Table::root(source, document.get_ref());
    for name in BESIDE {
        root.refuse(name, "is not part of a statement: mesh, initial fields, instants and files are given separately")?;
    }
    root.only_but(&[&BESIDE[..], &["gravity"]].concat())?;
    let options = estimate::read(&root)?;
    let stated = Statement {
        planes_to_be_moved: true,
        displacement: initial_displacement,
        velocity: initial_velocity,
        ..problem::stated(&root, mesh)?
    };
    Ok((problem::build(&root, mesh, &stated)?, options))
}

fn material(
    text: &mut Writer,
    index: usize,
    (group, law): (Option<&str>, &Elastic),
    dimension: usize,
) -> Result<(), NotRepresentable> {
    let hypothesis = law.hypothesis();
    let of_law = match hypothesis {
        Hypothesis::Bar => 1,
        Hypothesis::PlaneStress | Hypothesis::PlaneStrain => 2,
        Hypothesis::Solid => 3,
    };
    if of_law != dimension {
        return Err(NotRepresentable::Law { index: index + 1, hypothesis, dimension });
    }
    text.table("[[material]]");
    text.group(group);
    text.number("young", law.young());
    text.number("density", law.density());
    if let Some(yield_stress) = law.yield_stress() {
        text.number("yield_stress", yield_stress);
    }
    if let Some(hardening) = law.hardening() {
        text.number("hardening", hardening.modulus());
        text.number("kinematic", hardening.kinematic());
    }
    let (kinematics, finite) = law.kinematics().names();
    if let Some(finite) = finite {
        text.key("kinematics", quoted(kinematics));
        text.key("law", quoted(finite));
    }
    let plane = match hypothesis {
        Hypothesis::Bar => {
            text.number("section", law.extent());
            return Ok(());
        }
        Hypothesis::Solid => {
            text.number("poisson", law.poisson());
            return Ok(());
        }
        Hypothesis::PlaneStress => "stress",
        Hypothesis::PlaneStrain => "strain",
    };
    text.number("poisson", law.poisson());
    text.key("plane", quoted(plane));
    text.number("thickness", law.extent());
    Ok(())
}

fn obstacle(text: &mut Writer, obstacle: &AnyObstacle, [point, direction]: &[Vec<f64>; 2]) {
    text.table("[[obstacle]]");
    text.key("point", vector(point));
    // As it was given: a unit normal made unit again may differ in the last bit.
    text.key("normal", vector(direction));
    text.number("friction", obstacle.law().friction());
    text.group(obstacle.group());
}

fn interface(text: &mut Writer, interface: &Interface) {
    text.table("[[contact]]");
    let [first, second] = interface.groups().map(quoted);
    text.key("groups", format!("[{first}, {second}]"));
    text.number("friction", interface.law().friction());
    // Groups whose nodes face each other are pairs.
    if !interface.is_matching() {
        text.key("matching", "false");
    }
}

fn support(text: &mut Writer, support: &Support, d: usize) {
    let axes: Vec<usize> = (0..d).filter(|&c| support.components[c]).collect();
    text.table("[[support]]");
    text.group(Some(&support.group));
    text.key("components", list(axes.iter().map(|&c| quoted(AXES[c]))));
    let Some(table) = &support.velocity else { return };
    // Of other components the language does not speak, nor do they matter.
    let named = |all: &Vector| axes.iter().map(|&c| all[c]).collect::<Vec<_>>();
    let value = list(table.value().iter().map(|all| vector(&named(all))));
    text.key("velocity", format!("{{ time = {}, value = {value} }}", numbers(table.time())));
}

fn traction(text: &mut Writer, traction: &Traction, d: usize) {
    text.table("[[traction]]");
    text.group(Some(&traction.group));
    in_time(text, &traction.value, d);
    let Profile { value, gradient } = &traction.profile;
    text.key("profile", format!("{{ value = {value:?}, gradient = {} }}", vector(&gradient[..d])));
}

fn body_force(text: &mut Writer, force: &BodyForce, d: usize) {
    text.table("[[body_force]]");
    text.group(force.group.as_deref());
    in_time(text, &force.value, d);
}

fn in_time(text: &mut Writer, table: &InTime, d: usize) {
    text.key("time", numbers(table.time()));
    text.key("value", list(table.value().iter().map(|v| vector(&v[..d]))));
}

fn numbers(all: &[f64]) -> String {
    list(all.iter().map(|x| format!("{x:?}")))
}
