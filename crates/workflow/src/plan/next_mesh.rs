//! A plan in words, and as a document.

use super::{Basis, Branch, Exponents, Plan, shares_told};
use crate::effort::{Effort, duration};
use crate::message::{counted, percent, short, trimmed};
use percute_core::mesh::Mesh;
use serde::Serialize;

/// The next mesh for a wanted error, by the estimate of a run.
#[derive(Clone, Debug, Serialize)]
pub struct NextMesh {
    /// The relative error of the run.
    pub error: f64,
    /// The wanted one.
    pub target: f64,
    /// How elements are made smaller.
    pub branch: Branch,
    /// The exponents of the error over the size.
    pub exponents: Exponents,
    /// Parts of the sources in the squared mean error: surface, front, dispersion, mesh.
    pub sources: [f64; 4],
    /// Number of elements of the run.
    pub elements: usize,
    /// The smallest and the largest size of elements of the run (m): the root of the area, or the length.
    pub sizes: [f64; 2],
    /// The same that are planned.
    pub planned: [f64; 2],
    /// The relative error expected on the next mesh.
    pub expected: f64,
    /// Elements times steps of the run.
    pub element_steps: f64,
    /// The same on the next mesh.
    pub planned_element_steps: f64,
    /// Elements times steps of a run with the wanted error, and about how long it takes with its estimate (s); none of
    /// a mesh to be graded, whose error falls faster than that of one run tells.
    pub needed: Option<[f64; 2]>,
    /// The plan.
    #[serde(skip)]
    pub plan: Plan,
}

impl NextMesh {
    /// For a target beside the relative error of a run. No element becomes larger than in the run.
    #[must_use]
    pub fn new(mesh: &Mesh, basis: &Basis, effort: &Effort, [error, target]: [f64; 2]) -> Self {
        let wanted = (target / error).min(1.0);
        let plan = Plan::new(basis, wanted, &vec![1.0; mesh.element_count()]);
        let whole = Plan::whole(basis, wanted);
        let bounds = |sizes: &mut dyn Iterator<Item = f64>| {
            sizes.fold([f64::INFINITY, 0.0_f64], |[low, high], h| [low.min(h), high.max(h)])
        };
        Self {
            error,
            target,
            branch: plan.branch,
            exponents: plan.exponents,
            sources: basis.shares(),
            elements: mesh.element_count(),
            sizes: bounds(&mut basis.size.iter().copied()),
            planned: bounds(&mut basis.size.iter().zip(&plan.ratio).map(|(h, r)| h * r)),
            expected: plan.predicted * error,
            element_steps: basis.element_steps,
            planned_element_steps: plan.cost * basis.element_steps,
            needed: whole.map(|whole| [basis.element_steps, effort.run_seconds].map(|work| whole.cost * work)),
            plan,
        }
    }

    /// The plan as a JSON document.
    ///
    /// # Errors
    /// None that is known; whatever the serialiser reports.
    pub fn to_json(&self) -> Result<String, std::io::Error> {
        serde_json::to_string(self).map_err(std::io::Error::from)
    }

    /// The lines of the plan.
    #[must_use]
    pub fn told(&self) -> String {
        let Self { error, target, branch, sources, elements, sizes, planned, expected, .. } = self;
        let (error, target) = (percent(*error), percent(*target));
        let sources = shares_told(sources);
        if self.error <= self.target {
            return format!("The mean error is {error}: the target of {target} is reached.\n");
        }
        let range = |[low, high]: &[f64; 2]| match 1e3 * high < 1e3 * low * 1.001 {
            true => format!("{} mm", trimmed(1e3 * low, 3)),
            false => format!("{} to {} mm", trimmed(1e3 * low, 3), trimmed(1e3 * high, 3)),
        };
        let how = match branch {
            Branch::Uniform => "all elements alike",
            Branch::Graded => "smaller elements towards the contact",
            Branch::Map => "each element by its error",
        };
        let step = if *expected > self.target * 1.001 { ", the next step to the target" } else { "" };
        let mut lines = vec![
            format!("error    {error}, target {target}; sources: {sources}"),
            format!("branch   {branch}: {how}"),
            format!("sizes    {} of {}, planned {}", range(sizes), counted(*elements, "element"), range(planned)),
            format!("expected {} on the planned mesh{step}", percent(*expected)),
            format!(
                "cost     {} elements times steps, planned {}",
                short(self.element_steps, 2),
                short(self.planned_element_steps, 2)
            ),
        ];
        lines.extend(self.needed.map(|[element_steps, seconds]| {
            format!("target   needs about {} elements times steps, {}", short(element_steps, 2), duration(seconds))
        }));
        lines.join("\n") + "\n"
    }
}
