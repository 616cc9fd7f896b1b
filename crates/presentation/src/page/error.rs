//! The error over elements, over time and by its sources.

use super::Contents;
use super::html::{self, Table, figure, number, paragraph, remark, section, share, vector};
use crate::chart::{Line, OverTime};
use crate::document::{Document, numbers};
use crate::picture;
use percute_workflow::message::{change, trimmed};

/// The map, and the worst elements.
pub(super) fn map(contents: &Contents<'_>) -> String {
    let Contents { document, body, .. } = contents;
    let worst = document.list("worst_elements");
    let svg = picture::map(body, document, worst.len());
    let mut caption =
        "Contribution e_E of each element to the mean error [20]; the squares add up to e_mean^2.".to_string();
    caption += " The numbers are the ranks of the worst elements.";
    if body.dimension == 2 {
        caption += " The colours are logarithmic where the largest value is more \
                    than five times the median.";
    }
    if !document.at("outline").is_null() {
        caption += " The line is the outline at the end: the motion as it is, and the deformation times the factor \
             above. Enlarged, it may cross a plane that the body only touches.";
    }
    if body.elements() > picture::MOST_POLYGONS {
        caption += &format!(" Above {} elements, the map is stored as pixels.", picture::MOST_POLYGONS);
    }
    let mean = document.number("error.mean").unwrap_or(f64::NAN);
    let mut table = Table::new(&[
        "#rank",
        "#element",
        &format!("#e_E ({})", document.unit("J^½")),
        "#share of e_mean^2",
        "centroid (m)",
    ]);
    for (k, element) in worst.iter().enumerate() {
        let error = element["error"].as_f64();
        let part = share(error.map(|error| (error / mean).powi(2)));
        let centroid = vector(&numbers(&element["centroid"]));
        let name = element["element"].as_u64().map_or("–".to_string(), |e| e.to_string());
        table.row(&[(k + 1).to_string(), name, number(error), part, centroid]);
    }
    section("Error of the elements", &(figure(&svg, "map of the error of each element", &caption) + &table.html()))
}

/// √η and its parts.
pub(super) fn over_time(document: &Document) -> String {
    let column = |name: &str| document.column(&format!("over_time.{name}"));
    let root = |name: &str| column(name).iter().map(|eta| eta.max(0.0).sqrt()).collect();
    let line = |(name, column): (&'static str, &str)| Line { name, values: root(column) };
    // Elastic materials dissipate nothing.
    let dissipates = column("dissipation").iter().any(|part| *part != 0.0);
    let names: Vec<&'static str> = ["kinetic", "elastic", "dissipation", "contact"]
        .into_iter()
        .filter(|n| dissipates || *n != "dissipation")
        .collect();
    let chart = OverTime {
        time: column("time"),
        quantity: "√η and its parts",
        unit: document.unit("J^½"),
        prefixes: false,
        lines: [("√η", "total")].into_iter().chain(names.iter().map(|name| (*name, *name))).map(line).collect(),
        mark: document.number("time_of_sup").map(|time| (time, "sup")),
    };
    let Some(svg) = chart.draw() else { return String::new() };
    let caption = "√η over time and the roots of its parts [14]: kinetic, the misfit of the law of inertia, elastic, \
                   that of Hooke's law, dissipation, that of plastic flow, and contact, that of the contact law. The \
                   parts of η, not their roots, add up.";
    let figure = figure(&svg, "error over time with its parts", caption);
    let parts: Vec<_> = names.iter().map(|name| (*name, document.number(&format!("parts.{name}")))).collect();
    let total: f64 = parts.iter().filter_map(|(_, part)| *part).sum();
    let mut table = Table::new(&["part of η at the sup", &format!("#{}", document.unit("J")), "#share"]);
    for (name, part) in parts {
        let share = share(part.filter(|_| total > 0.0).map(|part| part / total));
        table.row(&[name.to_string(), number(part), share]);
    }
    section("Error over time", &(figure + &table.html()))
}

/// The reason for negative sources.
const NEGATIVE: &str = "A source may be negative: some of its terms are products of two fields, which need not be \
                        positive. Only the sum of the sources, η, cannot be negative.";

/// The sources of η and what would change it.
pub(super) fn sources(document: &Document) -> String {
    const SOURCES: [(&str, &str); 4] = [
        ("surface", "the contact surface"),
        ("front", "energy that contact takes from arriving nodes"),
        ("dispersion", "dispersion of the waves"),
        ("mesh", "the mesh elsewhere"),
    ];
    let value = |key: &str, name: &str| document.number(&format!("sources.{key}.{name}"));
    let total: f64 = SOURCES.iter().filter_map(|(name, _)| value("mean", name)).sum();
    if document.at("sources").is_null() || total <= 0.0 {
        return String::new();
    }
    let joule = document.unit("J");
    let mut table = Table::new(&[
        "source",
        "~meaning",
        &format!("#mean ({joule})"),
        "#share of e_mean^2",
        "",
        &format!("#at the sup ({joule})"),
        &format!("#mean, halved elements ({joule})"),
    ]);
    for (name, meaning) in SOURCES {
        let mean = value("mean", name);
        let share = mean.unwrap_or(0.0) / total;
        // A negative share has no length.
        let width = 6.0 * share.min(1.0);
        let bar = if share > 0.0 {
            format!("<span class=\"bar\" style=\"width:{width:.1}rem\"></span>")
        } else {
            String::new()
        };
        let cells = [name.to_string(), meaning.to_string(), number(mean), html::share(Some(share))]
            .map(|cell| crate::typeset::html(&cell));
        let others = ["at_sup", "halved_elements"].map(|key| crate::typeset::html(&number(value(key, name))));
        table.marked("", cells.into_iter().chain([bar]).chain(others).collect());
    }
    let of_all = ["mean", "at_sup", "halved_elements"].map(|key| SOURCES.map(|(name, _)| value(key, name)));
    let negative = of_all.iter().flatten().any(|value| value.is_some_and(|value| value < 0.0));
    let signs = if negative { remark(NEGATIVE) } else { String::new() };
    section("Sources of the error", &(table.html() + &signs + &outlook(document)))
}

/// The mean error that a finer mesh, and a shorter step, would have.
fn outlook(document: &Document) -> String {
    let Some(mean) = document.number("error.mean").filter(|mean| *mean > 0.0) else { return String::new() };
    let expected = |key: &str| {
        let expected = document.number(&format!("sources.{key}"))?;
        Some(format!("{} {} ({})", trimmed(expected, 4), document.unit("J^½"), change(expected / mean - 1.0)))
    };
    let (Some(size), Some(step)) = (expected("mean_with_halved_elements"), expected("mean_with_halved_step")) else {
        return String::new();
    };
    paragraph(&format!(
        "Halving element size and step would give a mean error of about {size}; halving the step alone, about {step}."
    ))
}
