//! The summary of a run: at most 32 lines of 80 columns.

use super::{ADMISSIBLE, InterfaceRebound, NearestNode, ProblemSummary, Rebound, Report, SOURCES, meaning};
use crate::foreign::Consistency;
use crate::message::{counted, percent, printable, short, trimmed, whole_percent};
use percute_core::contact::contact_name;
use percute_core::dynamics::Balance;
use percute_core::units::Units;
use percute_estimator::Sampling;

/// Nature of the error, in a line.
const MEASURE: &str = "An estimate, not a strict bound, of the errors of space, time, mass and contact.";

/// The summary of a run.
#[must_use]
pub fn summary(report: &Report) -> String {
    let verdict = format!("verdict   trust {}: {}", report.verdict.trust, report.verdict.text.join(" "));
    layout(&lines(report)) + &meaning::lines(&verdict) + MEASURE + "\n" + &layout(&[("result", result(report))])
}

/// Columns of the screen, and of the names.
const SCREEN: usize = 80;
const NAMES: usize = 10;

/// Names and values in two columns.
pub(crate) fn layout(lines: &[(&str, String)]) -> String {
    lines.iter().map(|(name, value)| wrapped(&format!("{name:<NAMES$}{value}"))).collect()
}

/// A line as lines that fit the screen. It breaks at a space, and only a word that is longer than a line within it.
fn wrapped(line: &str) -> String {
    let (mut all, mut rest) = (String::new(), line.trim_end().to_string());
    while let Some((end, _)) = rest.char_indices().nth(SCREEN) {
        let space = rest[..=end].rfind(' ').filter(|at| !rest[..*at].chars().skip(NAMES).all(|c| c == ' '));
        let tail = rest.split_off(space.unwrap_or(end));
        all += rest.trim_end();
        all.push('\n');
        rest = format!("{:NAMES$}{}", "", tail.trim_start());
    }
    all + &rest + "\n"
}

fn lines(report: &Report) -> Vec<(&'static str, String)> {
    let mut lines: Vec<_> = nothing_touched(report).map(|line| ("CONTACT", line)).into_iter().collect();
    lines.extend(what_was_run(report));
    lines.extend(error(report));
    lines.extend(sources(report).map(|line| ("sources", line)));
    lines.extend(worst_elements(report));
    lines.extend(balance(report));
    lines.push(("residual", residual(report)));
    lines.extend(report.consistency.as_ref().map(|found| ("history", consistency(found))));
    lines.extend(impulse_ratio(report).map(|line| ("impulse", line)));
    lines.extend(contact(report).map(|line| ("contact", line)));
    let label = |rebound: &Rebound| if rebound.is_rebound() { "rebound" } else { "motion" };
    lines.extend(report.rebound.as_ref().map(|rebound| (label(rebound), returned(rebound, size(report)))));
    lines.extend(impacts(report));
    lines.extend(warnings(report));
    lines
}

/// That nothing touched, and the gap that is left.
fn nothing_touched(report: &Report) -> Option<String> {
    let NearestNode { gap, touch, .. } = report.contact.as_ref()?.nearest?;
    let when = touch
        .map_or("no node approaches".to_string(), |time| format!("a gap would first close at {} s", trimmed(time, 4)));
    Some(format!("NOTHING TOUCHED: the least gap left is {} m; {when}", short(gap, 3)))
}

/// Elements, nodes and size of a body.
pub(crate) fn body(problem: &ProblemSummary) -> String {
    let size = problem.upper_corner.iter().zip(&problem.lower_corner).map(|(u, l)| trimmed(u - l, 4));
    let size = size.collect::<Vec<_>>().join(" x ");
    format!("{}, {size} m", counts(problem.dimension, problem.elements, problem.nodes))
}

/// Elements and nodes.
pub(crate) fn counts(dimension: usize, elements: usize, nodes: usize) -> String {
    let kinds = [["bar element", "bar elements"], ["triangle", "triangles"], ["tetrahedron", "tetrahedra"]];
    let kind = kinds[dimension - 1][usize::from(elements != 1)];
    format!("{elements} {kind}, {}", counted(nodes, "node"))
}

/// The longest step beside the critical one (s).
pub(crate) fn step(step: f64, critical: f64) -> String {
    format!("step {step:.4e} s, critical {critical:.4e} s, ratio {}", trimmed(step / critical, 4))
}

fn what_was_run(report: &Report) -> Vec<(&'static str, String)> {
    let label = if report.held.is_some() { "history" } else { "case" };
    let (version, seconds) = (report.versions.percute, short(report.seconds.unwrap_or(f64::NAN), 3));
    let options = &report.options;
    let mut lines = vec![(label, format!("{} (percute {version}, {seconds} s)", report.case))];
    let program = report.simulated_by.as_ref();
    lines.extend(program.map(|name| ("", format!("simulated by {}", printable(name)))));
    lines.extend([
        ("body", body(&report.problem)),
        ("time", time(report)),
        ("", step(report.time_step, report.critical_time_step)),
        (
            "options",
            format!(
                "reconstruction {}, acceleration {}, samples at {}",
                options.reconstruction,
                options.acceleration(report.problem.dimension),
                sampled(options.every)
            ),
        ),
    ]);
    let supplied = [("velocities", report.supplied.velocity), ("accelerations", report.supplied.acceleration)];
    let supplied: Vec<_> = supplied.iter().filter(|(_, supplied)| *supplied).map(|(name, _)| *name).collect();
    if !supplied.is_empty() {
        lines.push(("supplied", format!("{} of the history itself", supplied.join(" and "))));
    }
    if !report.derived.is_empty() {
        let derived = report.derived.iter().map(|derived| derived.name()).collect::<Vec<_>>().join(" and ");
        lines.push(("derived", format!("{derived}: follows from the rest of the history")));
    }
    lines
}

/// The steps at which the error is sampled.
fn sampled(every: Sampling) -> String {
    match every {
        Sampling::Auto => "steps chosen by auto".to_string(),
        Sampling::Every(1) => "each step".to_string(),
        Sampling::Every(k) => format!("one step in {k}"),
    }
}

/// How far the run or the history went.
fn time(report: &Report) -> String {
    let Report { steps, steps_planned: planned, .. } = *report;
    let end = trimmed(report.end, 5);
    let simulated = report.balance_over_time.steps();
    if report.interrupted && simulated > steps {
        return format!("INTERRUPTED at step {simulated} of {planned}, error until t = {end} s;");
    }
    match report.held.map(|instants| instants.saturating_sub(1)) {
        _ if !report.interrupted => format!("{end} s in {};", counted(steps, "step")),
        Some(held) if held == steps => {
            format!("INCOMPLETE history of {steps} of {}, t = {end} s;", counted(planned, "step"))
        }
        Some(held) if held < planned => {
            format!("INTERRUPTED at step {steps} of {held} ({planned} planned), t = {end} s;")
        }
        _ => format!("INTERRUPTED at step {steps} of {planned}, t = {end} s;"),
    }
}

fn error(report: &Report) -> Vec<(&'static str, String)> {
    let (e, units) = (&report.error, report.problem.units());
    let [norm, joule] = ["J^½", "J"].map(|unit| units.of(unit));
    let measure = |name: &str, value: f64, relative: f64| {
        format!("{name:<5}{:>8} {norm}  {:>7}", short(value, 4), percent(relative))
    };
    let (energy, [stress, velocity]) =
        (short(e.energy, 4), [e.relative_stress_mean, e.relative_velocity_mean].map(percent));
    vec![
        ("error", measure("sup", e.sup, e.relative_sup) + &format!(" of √{energy} {joule}")),
        ("", measure("mean", e.mean_from_touch, e.relative_mean) + &format!("; stress {stress}, velocity {velocity}")),
    ]
}

/// The sources of the error.
fn sources(report: &Report) -> Option<String> {
    let mean = &report.sources.as_ref()?.mean;
    let total = mean.total();
    let shares = SOURCES.map(|(name, source)| format!("{name} {}", whole_percent(source(mean) / total))).join(", ");
    (total > 0.0).then(|| format!("{shares} of mean²"))
}

/// The error in one line, the last one, for `tail -n 1`.
fn result(report: &Report) -> String {
    let e = &report.error;
    if !report.problem.obstacles.is_empty() && report.impulse_ratio.is_none() && e.sup == 0.0 {
        return "no contact and no error: see the warnings".to_string();
    }
    let (sup, time) = (short(e.sup, 4), trimmed(report.time_of_sup, 5));
    let [at_most, mean] = [e.relative_sup, e.relative_mean].map(percent);
    let norm = report.problem.units().of("J^½");
    let touched = report.contact.as_ref().is_none_or(|contact| contact.nearest.is_none());
    let nothing = if touched { "" } else { "nothing touched: " };
    format!("{nothing}sup {at_most} ({sup} {norm} at {time} s), mean {mean}")
}

fn worst_elements(report: &Report) -> Vec<(&'static str, String)> {
    let norm = report.problem.units().of("J^½");
    let line = |(i, worst): (usize, &super::WorstElement)| {
        let centroid = worst.centroid.iter().map(|&x| short(x, 3)).collect::<Vec<_>>().join(", ");
        let value = format!("element {:<8} {:>10} {norm}  at ({centroid}) m", worst.element, short(worst.error, 4));
        (if i == 0 { "worst" } else { "" }, value)
    };
    // The document and the picture have more.
    report.worst_elements.iter().take(2).enumerate().map(line).collect()
}

fn balance(report: &Report) -> Vec<(&'static str, String)> {
    let (b, joule) = (&report.balance, report.problem.units().of("J"));
    let [loads, supports, contact, friction] =
        [b.work_of_loads, b.work_of_supports, b.work_of_contact, b.friction].map(|x| short(x, 4));
    vec![
        ("energy", energy(b, report.problem.units())),
        ("work", format!("loads {loads}, supports {supports}, contact {contact}, friction {friction} {joule}")),
        ("drift", drift(b)),
    ]
}

/// Energies at the start and now.
pub(crate) fn energy(balance: &Balance, units: Units) -> String {
    let [initial, kinetic, strain] = [balance.initial, balance.kinetic, balance.strain].map(|x| short(x, 4));
    let plastic = balance.plastic_work;
    let plastic = if plastic > 0.0 { format!(", plastic work {}", short(plastic, 4)) } else { String::new() };
    format!("initial {initial}, now kinetic {kinetic}, strain {strain}{plastic} {}", units.of("J"))
}

/// Drifts of the two balances.
pub(crate) fn drift(balance: &Balance) -> String {
    format!("energy {}, impulse {}", percent(balance.energy_drift), percent(balance.impulse_drift))
}

fn residual(report: &Report) -> String {
    let worst = &report.largest_residual;
    let verdict = if worst.admissible { "admissible" } else { "NOT ADMISSIBLE" };
    format!("largest {} ({}), {verdict}: the limit is {ADMISSIBLE:.0e}", short(worst.value, 2), worst.name)
}

/// The figures of a history of another program that say most.
fn consistency(found: &Consistency) -> String {
    let [balance, start, energy] = [found.balance, found.initial_velocity, found.energy].map(percent);
    format!("of another program: balance off by {balance}, start {start}, energy {energy}")
}

/// Nothing where all is kept.
fn impulse_ratio(report: &Report) -> Option<String> {
    let Some(kept) = report.impulse_ratio.map(percent) else { return Some("no contact".to_string()) };
    (kept != percent(1.0)).then(|| format!("the admissible contact force has {kept} of the contact impulse"))
}

/// When it began, and its largest force and pressure, averaged over the time in which a wave crosses the struck
/// element; nothing without planes, nor without contact, which is said already.
fn contact(report: &Report) -> Option<String> {
    let contact = report.contact.as_ref()?;
    let (first, peak) = (trimmed(contact.first_touch?, 4), contact.averaged_peak?);
    let ([force, pressure], time) = ([peak.force, peak.pressure].map(|x| short(x, 4)), trimmed(peak.time, 4));
    let newton = report.problem.units().of("N");
    Some(format!("from {first} s, averaged peak {force} {newton} at {time} s, {pressure} Pa"))
}

/// The largest side of the mesh (m).
fn size(report: &Report) -> f64 {
    let sides = report.problem.upper_corner.iter().zip(&report.problem.lower_corner).map(|(u, l)| u - l);
    sides.fold(0.0, f64::max)
}

/// Velocities before and after contact, along the normal, of a body of this size (m).
fn returned(rebound: &Rebound, size: f64) -> String {
    let before = trimmed(rebound.normal_before, 4);
    let time = in_contact(rebound.time_in_contact, rebound.span);
    match (rebound.normal_after, rebound.restitution) {
        (Some(after), Some(restitution)) => {
            let (speed, restitution) = (after.abs(), trimmed(restitution, 3));
            let after = trimmed(after, 4);
            // Less than a thousandth of the velocity after contact is rounding, or not worth a word.
            let turning = rebound.angular_velocity_after.filter(|spin| spin.abs() * size > 1e-3 * speed);
            let turning = turning.map_or(String::new(), |spin| format!(", turning at {} rad/s", short(spin, 3)));
            format!("from {before} to {after} m/s, restitution {restitution}, {time}{turning}")
        }
        (Some(after), None) => {
            let (after, reason) = (trimmed(after, 4), rebound.no_restitution.unwrap_or_default());
            format!("from {before} to {after} m/s, {time}; no restitution: {reason}")
        }
        _ => {
            let span = trimmed(rebound.span, 4);
            format!("contact has not ended after {span} s; it began with {before} m/s")
        }
    }
}

/// How long contact lasts, and within which time if it has breaks.
fn in_contact(time: f64, span: f64) -> String {
    let (time, within) = (trimmed(time, 4), trimmed(span, 4));
    if time == within { format!("{time} s in contact") } else { format!("{time} s in contact within {within} s") }
}

/// The rebound at each interface: two at most, and how many more.
fn impacts(report: &Report) -> Vec<(&'static str, String)> {
    let interfaces = report.impacts.as_ref().map_or(&[][..], |impacts| &impacts.interfaces);
    let line = |interface: &InterfaceRebound| {
        let name = contact_name(interface.groups.each_ref().map(String::as_str));
        let time = in_contact(interface.time_in_contact, interface.span);
        let [before, after] = [interface.normal_before, interface.normal_after].map(|v| v.map(|v| trimmed(v, 4)));
        let told = match (before, after, interface.restitution) {
            (Some(before), Some(after), Some(restitution)) => {
                let restitution = trimmed(restitution, 3);
                format!("from {before} to {after} m/s, restitution {restitution}, {time}")
            }
            _ => format!("no restitution: {}", interface.no_restitution.unwrap_or_default()),
        };
        ("rebound", format!("{name}: {told}"))
    };
    let most = if interfaces.len() > 2 { 1 } else { 2 };
    let more = (interfaces.len() > most).then(|| ("", format!("and {} more interfaces", interfaces.len() - most)));
    interfaces.iter().take(most).map(line).chain(more).collect()
}

/// One line each if there are two at most; else the first and how many more.
fn warnings(report: &Report) -> Vec<(&'static str, String)> {
    let all = &report.warnings;
    let mut lines: Vec<_> =
        all.iter().take(if all.len() > 2 { 1 } else { 2 }).map(|w| ("WARNING", w.brief.clone())).collect();
    if all.len() > 2 {
        let names = all.iter().skip(1).map(|w| w.name).collect::<Vec<_>>().join(", ");
        lines.push(("WARNINGS", format!("and {}: {names}", all.len() - 1)));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_wrapped_and_nothing_is_cut() {
        let words =
            "INCOMPLETE: its run goes on or was killed; after a kill, `percute recover beam.vtkhdf` closes the file";
        let shown = layout(&[("holds", words.to_string()), ("case", "x".repeat(200)), ("", "y".repeat(70))]);
        assert!(shown.lines().all(|line| line.chars().count() <= 80), "{shown}");
        let together = |text: &str| text.split_whitespace().collect::<String>();
        let all = format!("holds{words}case{}{}", "x".repeat(200), "y".repeat(70));
        assert_eq!(together(&shown), together(&all));
        assert_eq!(shown.lines().count(), 2 + 3 + 1);
        assert!(shown.lines().nth(1).is_some_and(|line| line.starts_with("          recover")), "{shown}");
    }
}
