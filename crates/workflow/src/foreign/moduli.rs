//! Poisson's ratio and the hypothesis of a plane body, from the parts of the stiffness.

use super::attempt::Attempt;
use super::balance::Balance;
use super::diagnosis::Diagnosis;
use super::limits::BALANCE;
use super::residual::{fit, norm};
use super::window::{vectors_of, windows};
use crate::message::trimmed;
use percute_core::history::SinkError;
use percute_core::kernel::InternalForces;
use percute_core::material::{Elastic, Hypothesis, Law, LinearLaw};
use percute_core::problem::{AnyProblem, Statement};

/// The terms M a, K_λ u, K_G u, and the forces: K = K_λ + K_G, of λ and of the shear modulus G.
const OF_LAMBDA: usize = 1;
const OF_SHEAR: usize = 2;
type Products = [[f64; 4]; 4];

/// Other moduli of a plane body of one material with small strains, whose forces are linear in the moduli.
pub(super) fn attempt(diagnosis: &Diagnosis<'_>) -> Result<Vec<Attempt>, SinkError> {
    if diagnosis.problem.is_finite() {
        return Ok(Vec::new());
    }
    let [material] = diagnosis.problem.materials() else { return Ok(Vec::new()) };
    let Some(sheared) = sheared(diagnosis.problem, material) else { return Ok(Vec::new()) };
    let products = products(diagnosis, &sheared)?;
    let before = norm(&products, [1.0; 4]);
    let other = other_hypothesis(material);
    let mut told = Vec::new();
    if let Some((name, lambda)) = other {
        let mut factors = [1.0; 4];
        factors[OF_LAMBDA] = lambda / material.moduli().0;
        told.push((format!("`plane` is \"{name}\" in the history"), factors));
    }
    if let Some((text, factors)) = fit(&products, &[OF_LAMBDA, OF_SHEAR]).and_then(|f| Some((fitted(material, f)?, f)))
    {
        told.push((text, factors));
    }
    Ok(told.into_iter().map(|(text, factors)| Attempt { text, before, left: norm(&products, factors) }).collect())
}

/// The body with the same shear modulus and without λ: ν = 0. None for a bar.
fn sheared(problem: &AnyProblem, material: &Elastic) -> Option<AnyProblem> {
    let (young, density) = (2.0 * material.moduli().1, material.density());
    let without = match material.hypothesis() {
        Hypothesis::Bar => return None,
        Hypothesis::Solid => Elastic::solid(young, 0.0, density),
        _ => Elastic::plane_stress(young, 0.0, density, material.extent()),
    };
    let without = without.ok()?;
    let stated = Statement { materials: vec![(None, without)], ..Statement::default() };
    AnyProblem::new(problem.mesh(), &stated).ok()
}

/// The name of the other hypothesis, and its λ (Pa).
fn other_hypothesis(material: &Elastic) -> Option<(&'static str, f64)> {
    let (young, poisson, density, extent) =
        (material.young(), material.poisson(), material.density(), material.extent());
    let (name, other) = match material.hypothesis() {
        Hypothesis::Bar | Hypothesis::Solid => return None,
        Hypothesis::PlaneStress => ("strain", Elastic::plane_strain(young, poisson, density, extent)),
        Hypothesis::PlaneStrain => ("stress", Elastic::plane_stress(young, poisson, density, extent)),
    };
    other.ok().filter(|_| poisson != 0.0).map(|other| (name, other.moduli().0))
}

/// The material with moduli of these factors, if there is one.
fn fitted(material: &Elastic, factors: [f64; 4]) -> Option<String> {
    let (lambda, shear) = material.moduli();
    let (lambda, shear) = (factors[OF_LAMBDA] * lambda, factors[OF_SHEAR] * shear);
    let poisson = match material.hypothesis() {
        Hypothesis::PlaneStrain | Hypothesis::Solid => lambda / (2.0 * (lambda + shear)),
        Hypothesis::PlaneStress | Hypothesis::Bar => lambda / (lambda + 2.0 * shear),
    };
    let young = 2.0 * shear * (1.0 + poisson);
    if !(shear > 0.0 && poisson > -1.0 && poisson < 0.5) {
        return None;
    }
    let (told, same) = (trimmed(poisson, 3), (young / material.young() - 1.0).abs() <= BALANCE);
    Some(if same {
        format!("`poisson` is {told} in the history, not {}", trimmed(material.poisson(), 3))
    } else {
        format!("`poisson` is {told} in the history, and `young` {} Pa", trimmed(young, 3))
    })
}

/// Scalar products of the terms with their signs (N²), where they do not follow from the balance.
fn products(diagnosis: &Diagnosis<'_>, sheared: &AnyProblem) -> Result<Products, SinkError> {
    let balance = Balance::new(diagnosis.problem, diagnosis.source.times());
    let stiffness = InternalForces::linear(sheared);
    let (problem, residual) = (diagnosis.problem, &diagnosis.evidence.residual);
    let mut products = Products::default();
    windows(diagnosis.source, diagnosis.problem.dimension(), &mut |window| {
        let now = window.now;
        let derived = if now.index > 0 { balance.motion(window).map(|motion| motion.acceleration) } else { None };
        let Some(used) = now.acceleration.as_ref().or(derived.as_ref()) else { return Ok(()) };
        let terms = balance.terms(now, used);
        let mut shear = vec![0.0; now.step().displacement.len()];
        stiffness.subtract_from_rows(now.step().displacement, &mut shear);
        let mut shear = vectors_of(&shear, problem.dimension());
        let mut force = terms.load.clone();
        for (contact, reaction) in problem.contact_nodes().iter().zip(&now.reaction) {
            (0..3).for_each(|c| force[contact.node.index()][c] += reaction[c]);
        }
        for p in diagnosis.problem.prescribed() {
            (shear[p.node.index()][p.component], force[p.node.index()][p.component]) = (0.0, 0.0);
        }
        for node in (0..force.len()).filter(|&node| !residual.is_open(node)) {
            for c in 0..3 {
                let of_shear = -shear[node][c];
                let of_lambda = terms.stiffness[node][c] - of_shear;
                let signed = [terms.inertia[node][c], of_lambda, of_shear, -force[node][c]];
                let rows = products.iter_mut().zip(signed);
                rows.for_each(|(row, a)| row.iter_mut().zip(signed).for_each(|(sum, b)| *sum += a * b));
            }
        }
        Ok(())
    })?;
    Ok(products)
}
