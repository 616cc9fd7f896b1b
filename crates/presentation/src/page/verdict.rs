//! The verdict and the numbers that come first.

use super::Contents;
use super::html::{number, share, together};
use crate::document::Document;
use crate::scale::quantity;
use crate::typeset::{escaped, html};
use percute_workflow::message::{counted, short, trimmed};

/// The title of the page, its author, and the programs.
pub(super) fn head(contents: &Contents<'_>) -> String {
    let Contents { document, about, .. } = contents;
    let text = |path: &str| escaped(document.text(path));
    let mut line = format!(
        "percute {} on {} {}",
        text("versions.percute"),
        text("versions.architecture"),
        text("versions.system")
    );
    if let Some(elements) = document.at("problem.elements").as_u64() {
        let kind = if document.number("problem.dimension") == Some(1.0) { "bar element" } else { "triangle" };
        line += &format!(" · {}", counted(elements as usize, kind));
    }
    // The steps of percute need no check.
    if document.is_foreign() {
        let stated = document.at("simulated_by").as_str();
        let program = about.program.as_deref().or(stated).unwrap_or("another program");
        line = format!("simulated by {}, estimated by {line}", escaped(program));
    }
    let mut title = format!("Error of the simulation {}", document.name()).trim_end().to_string();
    if let Some(given) = &about.title {
        line = format!("{} · {line}", escaped(&title));
        title.clone_from(given);
    }
    let author = about.author.as_ref().map_or_else(String::new, |author| format!("<p>{}</p>\n", escaped(author)));
    format!(
        "<h1>{}</h1>\n{author}<p class=\"faint\">{line}</p>\n{}",
        escaped(&title),
        if document.flag("interrupted") { interrupted(document) } else { String::new() }
    )
}

fn interrupted(document: &Document) -> String {
    let [steps, planned] = ["steps", "steps_planned"].map(|path| number(document.number(path)));
    let end = document.number("end").map_or_else(String::new, |end| html(&format!(", t = {}", quantity(end, "s", 4))));
    let simulated = document.list("balance_over_time.time").len().saturating_sub(1);
    let (at, of) = match document.number("steps") {
        Some(estimated) if simulated as f64 > estimated => (
            format!("step {simulated} of {planned}"),
            format!("the error is that of the first {steps} steps{end}, all other numbers are those of all steps done"),
        ),
        _ => (format!("step {steps} of {planned}{end}"), "all numbers are those of the steps until then".to_string()),
    };
    format!("<div class=\"verdict warning\"><p><b>Interrupted</b> at {at}: {of}.</p></div>\n")
}

/// Verdict, warnings, tiles.
pub(super) fn section(document: &Document) -> String {
    let warning = |warning: &serde_json::Value| {
        let [name, message] = ["name", "message"].map(|key| html(warning[key].as_str().unwrap_or_default()));
        format!("<div class=\"verdict warning\"><p><b>Warning</b> (<code>{name}</code>): {message}</p></div>\n")
    };
    let warnings: String = document.list("warnings").iter().map(warning).collect();
    format!("<section>\n{}{}{warnings}{}</section>\n", tiles(document), verdict(document), meaning(document))
}

/// The sentences of the verdict; documents of earlier versions have none.
fn verdict(document: &Document) -> String {
    let sentences = document.list("verdict.text").iter().filter_map(serde_json::Value::as_str);
    let sentences: String = sentences.map(|sentence| format!("<p>{}</p>\n", html(sentence))).collect();
    if sentences.is_empty() {
        return String::new();
    }
    let trust = document.text("verdict.trust");
    let known = ["high", "limited", "low"].into_iter().find(|known| *known == trust).unwrap_or("");
    format!(
        "<div class=\"verdict {known}\"><p><b class=\"trust\">Trust: {}</b></p>\n{sentences}</div>\n",
        escaped(trust)
    )
}

fn meaning(document: &Document) -> String {
    let text = document.text("meaning");
    if text.is_empty() { String::new() } else { format!("<p class=\"faint\">{}</p>\n", html(text)) }
}

fn tiles(document: &Document) -> String {
    let value = |path: &str| document.number(path);
    let si = |unit: &str, value: f64| together(&quantity(value, unit, 4));
    let error = |name: &str, absolute: &str| {
        let relative = share(Some(value(&format!("error.relative_{name}"))?));
        let [error, norm] = [value(&format!("error.{absolute}"))?, value("error.energy")?.sqrt()];
        Some((relative, format!("{} of {} {}", short(error, 4), short(norm, 4), document.unit("J^½"))))
    };
    let step = || {
        let (step, critical) = (value("time_step")?, value("critical_time_step")?);
        Some((trimmed(step / critical, 3), format!("longest Δt = {}", si("s", step))))
    };
    let force = || {
        let (force, time) = (value("contact.averaged_peak.force")?, value("contact.averaged_peak.time")?);
        Some((si(document.unit("N"), force), format!("at {}", si("s", time))))
    };
    let residual = || {
        let at_most = value("largest_residual.value")?;
        let good = if document.flag("largest_residual.admissible") { "admissible" } else { "NOT admissible" };
        Some((short(at_most, 2), format!("{good}; the limit is 1e-10")))
    };
    let drift = || Some((share(Some(value("balance.energy_drift")?)), "of the largest energy".to_string()));
    let rebound = || {
        let restitution = value("rebound.restitution")?;
        Some((trimmed(restitution, 4), "rebound over approach velocity".to_string()))
    };
    let time = value("time_of_sup").map_or(String::new(), |time| format!(", at {}", si("s", time)));
    let all = [
        ("Largest error e_sup", error("sup", "sup").map(|(big, small)| (big, small + &time))),
        ("Mean error from the touch", error("mean", "mean_from_touch")),
        ("Step over Δt_c", step()),
        ("Averaged peak contact force", force()),
        ("Restitution", rebound()),
        ("Drift of the energy", drift()),
        ("Largest residual", residual()),
    ];
    let tile = |(name, found): (&str, Option<(String, String)>)| {
        let (big, small) = found?;
        Some(format!("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>\n", html(name), html(&big), html(&small)))
    };
    let tiles: Vec<_> = all.into_iter().filter_map(tile).collect();
    // Six fit into a row, of seven four.
    let class = if tiles.len() > 6 { "tiles many" } else { "tiles" };
    format!("<dl class=\"{class}\">\n{}</dl>\n", tiles.concat())
}
