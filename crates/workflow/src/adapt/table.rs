//! An adaptation in lines of 80 columns.

use super::iteration::{Iteration, Measure, Reason};
use super::toward::judged;
use super::{Adaptation, Next};
use crate::message::{counted, percent, short, trimmed};
use crate::plan::shares_told;
use crate::quantity::{Judgement, Quantity};
use crate::report::Report;
use percute_core::units::Units;
use serde::Serialize;

/// The next run, before it starts.
#[must_use]
pub fn announced(next: &Next) -> String {
    let Next { run, elements, steps, predicted, work, needed, branch } = next;
    let (elements, steps) = (counted(*elements, "element"), counted(*steps, "step"));
    let how = branch.map_or_else(|| "as given".to_string(), |branch| branch.to_string());
    let expected = predicted.map_or_else(String::new, |error| format!(", {} expected", percent(error)));
    let target = needed.filter(|needed| needed.element_steps > MUCH * work.element_steps);
    let target = target.map_or_else(String::new, |needed| format!("; the target needs about {}", needed.told()));
    format!("run {run} ({how}): {elements}, {steps}, {}{expected}{target}", work.told())
}

/// The work of the target is told if it is more than so many times that of the next run.
const MUCH: f64 = 1.5;

/// The runs and how they ended.
#[must_use]
pub fn table(adaptation: &Adaptation) -> String {
    let columns = if adaptation.wish.on.is_some() { ["value", "change"] } else { ["expected", "trust"] };
    let head = ["run", "mesh", "elements", "steps", "smallest", "largest", "error", columns[0], columns[1]];
    let mut lines = vec![row(&head.map(str::to_string))];
    let runs = &adaptation.iterations;
    lines.extend((0..runs.len()).map(|run| row(&cells(&runs[..=run]))));
    if adaptation.iterations.is_empty() {
        lines.clear();
    } else {
        lines.push(sources(&adaptation.iterations));
    }
    lines.push(conclusion(adaptation));
    lines.join("\n") + "\n"
}

/// How the runs ended.
#[must_use]
pub fn conclusion(adaptation: &Adaptation) -> String {
    let wish = &adaptation.wish;
    let on = wish.on.as_ref().map_or_else(|| measure(wish.measure).to_string(), Quantity::told);
    let target = format!("{} ({on})", percent(wish.target));
    let Some(best) = &adaptation.best else {
        return match adaptation.refused {
            Some(work) => format!("The first mesh has {}, above the limit of {}.", work.told(), short(wish.limit, 2)),
            None => "Interrupted before the first run was done.".to_string(),
        };
    };
    let Iteration { error, elements, .. } = adaptation.iterations[best.run];
    let found = match &wish.on {
        None => percent(error),
        Some(quantity) => of_quantity(quantity, adaptation),
    };
    let reached = format!("run {} has {found} on {}", best.run, counted(elements, "element"));
    let needed = adaptation.needed.map(|needed| format!(" The target needs about {}.", needed.told()));
    let next = adaptation.refused.map(|work| format!(" The next mesh has {}.", work.told()));
    let needed = needed.unwrap_or_default() + &next.unwrap_or_default();
    let Some(reason) = &adaptation.reason else { return format!("Target {target} not reached yet: {reached}.") };
    match reason {
        Reason::Reached if untouched(&best.report) => {
            format!("Target {target} reached: {reached}. But nothing touched: is the end late enough?")
        }
        Reason::Reached => format!("Target {target} reached: {reached}."),
        Reason::Limit => format!(
            "Target {target} not reached within the limit of {} elements times steps: {reached}.{needed}{} Continue \
             with a larger limit.",
            short(wish.limit, 2),
            adaptation
                .reachable
                .map_or_else(String::new, |error| format!(" The limit allows about {}.", percent(error)))
        ),
        Reason::Runs => format!("Target {target} not reached in {}: {reached}.{needed}", counted(wish.runs, "run")),
        Reason::SameMesh => format!("Target {target} not reached: {reached}, and the next mesh is the same."),
        Reason::NotTrusted => {
            let reasons = adaptation.iterations.last().map_or_else(String::new, |last| last.reasons.join("; "));
            format!("Target {target} not reached: {reached}. The estimate of the last run is not trusted: {reasons}.")
        }
        Reason::NoLimit(why) => format!("Target {target} not reached: {reached}. {why}"),
        Reason::NoSources => {
            format!("Target {target} not reached: {reached}, and the sources of the error are unknown.")
        }
        Reason::Failed(why) => format!("Target {target} not reached: {reached}. The next run failed: {why}"),
        Reason::Interrupted => format!("Interrupted; target {target} not reached: {reached}."),
    }
}

/// Whether nothing has touched although it may.
fn untouched(report: &Report) -> bool {
    report.contact.as_ref().is_some_and(|contact| contact.first_touch.is_none())
}

/// The value of the quantity of the target, its last change, and its order.
fn of_quantity(quantity: &Quantity, adaptation: &Adaptation) -> String {
    let (runs, judgement) = (&adaptation.iterations, judged(&adaptation.iterations));
    let value = runs.last().and_then(|run| run.quantity).map_or_else(String::new, |value| trimmed(value, 4));
    let units = adaptation.best.as_ref().map_or(Units { per_metre: false }, |best| best.problem.units());
    let changed = judgement.change.map_or_else(String::new, |part| format!(", {} from the run before", change(part)));
    let order = judgement.order.map_or_else(String::new, |order| format!(", differences like h^{order:.1}"));
    format!("{value} {}{changed}{order},", quantity.unit(units))
}

fn measure(measure: Measure) -> &'static str {
    Measure::NAMES.into_iter().find(|(_, known)| *known == measure).map_or("", |(name, _)| name)
}

/// The row of the last of these runs.
fn cells(runs: &[Iteration]) -> [String; 9] {
    let (run, blank) = (runs.len() - 1, || "–".to_string());
    let Iteration { branch, elements, steps, sizes, error, predicted, quantity, trust, .. } = &runs[run];
    let [smallest, largest] = sizes.map(|size| short(1e3 * size, 3));
    let [first, second] = match quantity {
        None => [predicted.map_or_else(blank, percent), trust.to_string()],
        Some(value) => [trimmed(*value, 4), judged(runs).change.map_or_else(blank, change)],
    };
    [
        run.to_string(),
        branch.map_or_else(|| "given".to_string(), |branch| branch.to_string()),
        elements.to_string(),
        steps.to_string(),
        smallest,
        largest,
        percent(*error),
        first,
        second,
    ]
}

/// The change from mesh to mesh, with its sign.
fn change(part: f64) -> String {
    if part < 0.0 { format!("−{}", percent(-part)) } else { format!("+{}", percent(part)) }
}

fn row(cells: &[String; 9]) -> String {
    let widths = [3, 8, 9, 8, 9, 9, 8, 9, 8];
    let line: String = cells.iter().zip(widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
    line.trim_end().to_string()
}

/// The sources of the first run and of the last one.
fn sources(iterations: &[Iteration]) -> String {
    let told = |iteration: &Iteration| iteration.sources.as_ref().map(shares_told);
    let first = iterations.first().and_then(told).unwrap_or_else(|| "unknown".to_string());
    let last = iterations.last().and_then(told).filter(|_| iterations.len() > 1);
    let last = last.map_or_else(String::new, |last| format!("\n                  last run: {last}"));
    format!("Sizes in mm. Sources of the squared mean error, first run: {first}{last}")
}

/// An adaptation as a document.
#[derive(Serialize)]
struct Document<'a> {
    target: f64,
    measure: Measure,
    on: Option<String>,
    limit: f64,
    reached: bool,
    reason: Option<&'a Reason>,
    conclusion: String,
    needed: Option<super::Needed>,
    refused: Option<super::Needed>,
    reachable: Option<f64>,
    warnings: &'a [String],
    best: Option<usize>,
    /// End and step of the best run (s).
    end: Option<f64>,
    step: Option<f64>,
    iterations: &'a [Iteration],
    /// How the quantity of the target changes.
    convergence: Option<Judgement>,
}

impl Adaptation {
    /// The runs and their end as a JSON document.
    ///
    /// # Errors
    /// None that is known; whatever the serialiser reports.
    pub fn to_json(&self) -> Result<String, std::io::Error> {
        let document = Document {
            target: self.wish.target,
            measure: self.wish.measure,
            on: self.wish.on.as_ref().map(ToString::to_string),
            limit: self.wish.limit,
            reached: self.reason == Some(Reason::Reached),
            reason: self.reason.as_ref(),
            conclusion: conclusion(self),
            needed: self.needed,
            refused: self.refused,
            reachable: self.reachable,
            warnings: &self.warnings,
            best: self.best.as_ref().map(|best| best.run),
            end: self.best.as_ref().map(|best| best.times.end()),
            step: self.best.as_ref().map(|best| best.times.longest_step()),
            iterations: &self.iterations,
            convergence: self.wish.on.as_ref().map(|_| judged(&self.iterations)),
        };
        serde_json::to_string(&document).map_err(std::io::Error::from)
    }
}
