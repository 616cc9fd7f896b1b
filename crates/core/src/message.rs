//! Values and names in messages.

/// A number in at most four digits.
pub(crate) fn short(x: f64) -> String {
    let rounded = format!("{x:.3e}").parse().unwrap_or(x);
    if rounded == 0.0 || (1e-3..1e5).contains(&f64::abs(rounded)) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// A vector as users write it: a number for a bar. No sign before a zero.
pub(crate) fn vector(components: &[f64]) -> String {
    let shown = components.iter().map(|x| (x + 0.0).to_string()).collect::<Vec<_>>().join(", ");
    if components.len() == 1 { shown } else { format!("[{shown}]") }
}

/// Name of a component.
pub(crate) fn axis(component: usize) -> char {
    ['x', 'y', 'z'][component]
}

/// A facet by its nodes.
pub(crate) fn facet(nodes: &[usize]) -> String {
    match nodes {
        [node] => format!("end at node {node}"),
        [first, second] => format!("edge of nodes {first} and {second}"),
        _ => format!("facet of nodes {nodes:?}"),
    }
}

/// Numbers, separated by commas.
pub(crate) fn numbers(numbers: &[usize]) -> String {
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// Names in quotation marks, separated by commas.
pub(crate) fn quoted(names: &[String]) -> String {
    names.iter().map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ")
}

pub(crate) fn named(names: &[String]) -> String {
    if names.is_empty() { "none".to_string() } else { quoted(names) }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, 1.0 / 3.0, 5091.75, 7.85e-9, 69_999_999_999.0, -400.0, f64::INFINITY].map(short);
        assert_eq!(shown, ["0", "0.3333", "5092", "7.85e-9", "7e10", "-400", "inf"]);
    }
}
