//! A verification in lines of 80 columns.

use super::criterion::Settled;
use super::levels::{Convergence, Cost, Level, Orders, Verification};
use crate::message::{bytes, counted, percent, short, trimmed};

/// What will be run, before the work starts.
#[must_use]
pub fn announced(cost: &Cost) -> String {
    let level = |(k, work): (usize, &super::levels::Work)| {
        let (elements, steps) = (counted(work.elements, "element"), counted(work.steps, "step"));
        format!("level {k}: {elements}, {steps}\n")
    };
    let levels: String = cost.levels.iter().enumerate().map(level).collect();
    let (times, memory) = (short(cost.times_the_first, 2), bytes(cost.bytes));
    format!("{levels}about {times} times the time of level 0, and {memory} of memory")
}

/// The table and the conclusions.
#[must_use]
pub fn table(verification: &Verification) -> String {
    if verification.levels.is_empty() {
        return "Interrupted before the first mesh was done: there is nothing to compare.\n".to_string();
    }
    let head = ["elements", "steps", "est. mean", "true mean", "index sup", "mean", "peak", "impulse", "rebound"];
    let mut lines = vec![row(&head.map(str::to_string))];
    lines.extend(verification.levels.iter().map(|level| row(&cells(level))));
    if verification.levels.len() > 1 {
        lines.push(row(&changes(verification)));
    }
    lines.push(row(&orders(verification)));
    let [energy, force, impulse] = ["J^½", "N", "N s"].map(|unit| verification.units().of(unit));
    lines.push(format!("Errors in {energy}, averaged peak force in {force}, impulse in {impulse}, rebound in m/s;"));
    lines.push("the true error is that against the finest mesh.".to_string());
    lines.extend(probes(verification));
    lines.extend(verification.convergence.iter().filter_map(|each| each.warning.clone()));
    lines.extend(expected(verification));
    lines.push(conclusion(verification));
    lines.join("\n") + "\n"
}

fn cells(level: &Level) -> [String; 9] {
    let number = |value: Option<f64>| value.map_or_else(|| "–".to_string(), |value| trimmed(value, 4));
    let index = |value: Option<f64>| value.map_or_else(|| "–".to_string(), |value| short(value, 3));
    let effectivity = level.effectivity;
    [
        level.elements.to_string(),
        level.steps.to_string(),
        short(level.estimate.mean, 4),
        number(level.error.map(|e| e.mean)),
        index(effectivity.map(|e| e.sup)),
        index(effectivity.map(|e| e.mean)),
        number(level.averaged_peak_force),
        number(level.impulse),
        number(level.rebound),
    ]
}

/// The changes of the contact quantities from the finest mesh but one to the finest.
fn changes(verification: &Verification) -> [String; 9] {
    let change = |at: usize| verification.convergence.get(at).map_or_else(String::new, changed);
    let mut cells: [String; 9] = Default::default();
    (cells[0], cells[6], cells[7], cells[8]) = ("change".to_string(), change(0), change(1), change(2));
    cells
}

fn orders(verification: &Verification) -> [String; 9] {
    let Orders { estimate, averaged_peak_force, impulse, rebound, .. } = verification.orders;
    let mut cells: [String; 9] = Default::default();
    (cells[0], cells[2]) = ("order".to_string(), power(estimate));
    (cells[6], cells[7], cells[8]) = (power(averaged_peak_force), power(impulse), power(rebound));
    cells
}

/// The values of each probe, in lines of their own.
fn probes(verification: &Verification) -> Vec<String> {
    let mut lines = Vec::new();
    for (at, each) in verification.convergence.iter().skip(3).enumerate() {
        let Convergence { quantity, unit, .. } = each;
        let unit = if unit == "1" { String::new() } else { format!(" in {unit}") };
        lines.push(format!("probe {quantity}{unit}, the largest over time without its sign:"));
        let values = verification.levels.iter().filter_map(|level| level.probes.get(at));
        let values: String = values.map(|probe| format!("{:>11}", trimmed(probe.value, 4))).collect();
        lines.push(values);
        if verification.levels.len() > 1 {
            lines.push(format!("{:>11} change, order {}", changed(each), power(each.order())));
        }
    }
    lines
}

/// A change with its sign, in tenths of a per cent: a column has room for them.
fn changed(convergence: &Convergence) -> String {
    let shown = |change: f64| format!("{:+.1} %", 100.0 * change).replace('-', "−");
    convergence.judgement.change.map_or_else(|| "–".to_string(), shown)
}

fn power(order: Option<f64>) -> String {
    order.map_or_else(|| "–".to_string(), |p| format!("h^{p:.1}"))
}

fn row(cells: &[String; 9]) -> String {
    let widths = [8, 7, 10, 10, 10, 7, 10, 10, 8];
    let line: String = cells.iter().zip(widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
    line.trim_end().to_string()
}

/// The index of the first mesh beside the range that its verdict states. A reference that is not fine enough has an
/// error of its own that the true error lacks: the index is too large.
fn expected(verification: &Verification) -> Option<String> {
    let first = verification.levels.first()?;
    let (index, [low, high]) = (first.effectivity?, first.expected?);
    // The reference is off by about the last move at most, and the index with it.
    let found = match verification.settled {
        Some(Settled { moved, fine_enough: true }) => {
            let inside = |index: f64| (low * (1.0 - moved)..=high * (1.0 + moved)).contains(&index);
            let inside = inside(index.sup) && inside(index.mean);
            if inside { "it is inside this range" } else { "it is outside this range" }
        }
        _ => "the reference is not fine enough to tell",
    };
    Some(format!("The verdict expects an index of {low} to {high} on the first mesh: {found}."))
}

fn conclusion(verification: &Verification) -> String {
    let stopped = if verification.interrupted { "Interrupted: the finest level done is the reference. " } else { "" };
    if verification.levels.iter().all(|level| level.exact) {
        return format!("{stopped}The error is zero to rounding on all meshes.");
    }
    let Some(settled) = verification.settled else {
        return format!(
            "{stopped}From two refinements on, it shows whether the finest mesh is fine enough; with one, the index is \
             too large."
        );
    };
    let moved = format!("With the finest mesh the true error of the first moves by {}", percent(settled.moved));
    let verdict = if settled.fine_enough {
        "the finest is fine enough"
    } else {
        "the finest is not fine enough; take more levels"
    };
    format!("{stopped}{moved}: {verdict} (at most 10 %).")
}
