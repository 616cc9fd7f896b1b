//! Values and names in messages.

/// A number with `digits` significant digits, in the exponential form where that is shorter. No sign before a zero.
#[must_use]
pub fn rounded(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return (value + 0.0).to_string();
    }
    let exponential = format!("{value:.*e}", digits.saturating_sub(1));
    let exponent = exponential.split('e').nth(1).and_then(|e| e.parse::<i32>().ok()).unwrap_or(0);
    if (-3..digits as i32 + 2).contains(&exponent) {
        return format!("{value:.*}", usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0));
    }
    exponential
}

/// The same without zeros at the end of a decimal fraction.
#[must_use]
pub fn trimmed(value: f64, digits: usize) -> String {
    let shown = rounded(value, digits);
    let (mantissa, exponent) = shown.split_once('e').map_or((shown.as_str(), None), |(m, e)| (m, Some(e)));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    exponent.map_or_else(|| mantissa.to_string(), |e| format!("{mantissa}e{e}"))
}

/// A number of things, such as `1 step` or `2 steps`.
#[must_use]
pub fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// A number in at most four digits.
pub(crate) fn short(x: f64) -> String {
    let rounded = format!("{x:.3e}").parse().unwrap_or(x);
    if rounded == 0.0 || (1e-3..1e5).contains(&f64::abs(rounded)) {
        (rounded + 0.0).to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// A vector as users write it, in nine digits: a number for a bar. Components that are rounding are zero.
pub(crate) fn vector(components: &[f64]) -> String {
    let largest = components.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let clean = |x: f64| if x.abs() < 1e-12 * largest { 0.0 } else { x };
    let shown = components.iter().map(|&x| trimmed(clean(x), 9)).collect::<Vec<_>>().join(", ");
    if components.len() == 1 { shown } else { format!("[{shown}]") }
}

/// Name of a component.
pub(crate) fn axis(component: usize) -> char {
    ['x', 'y', 'z'][component]
}

/// A face by its nodes.
pub(crate) fn face(nodes: &[usize]) -> String {
    match nodes {
        [node] => format!("end at node {node}"),
        [first, second] => format!("edge of nodes {first} and {second}"),
        _ => format!("face of nodes {nodes:?}"),
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
    use super::{counted, rounded, short, trimmed, vector};

    #[test]
    fn numbers_are_short() {
        let shown =
            [0.0, -0.0, 1.0 / 3.0, 5091.75, 26_487.0, 4e5, 7.85e-9, 69_999_999_999.0, -400.0, f64::INFINITY].map(short);
        assert_eq!(shown, ["0", "0", "0.3333", "5092", "26490", "4e5", "7.85e-9", "7e10", "-400", "inf"]);
    }

    #[test]
    fn four_digits_are_four_digits() {
        let shown = [0.0, 196.123_4, 2613.6, 65_432.1, 1.023e-5, 0.012_345, -9.999_96e7].map(|x| rounded(x, 4));
        assert_eq!(shown, ["0", "196.1", "2614", "65432", "1.023e-5", "0.01235", "-1.000e8"]);
        assert_eq!(rounded(f64::NAN, 4), "NaN");
        assert_eq!([0.05, 1.3e-5, 2500.0, 0.0].map(|x| trimmed(x, 4)), ["0.05", "1.3e-5", "2500", "0"]);
        assert_eq!([0, 1, 2].map(|n| counted(n, "step")), ["0 steps", "1 step", "2 steps"]);
    }

    #[test]
    fn vectors_show_no_rounding() {
        assert_eq!(vector(&[-0.015, -1.355_252e-20]), "[-0.015, 0]");
        assert_eq!(vector(&[-0.014_999_999_999_999_998, 0.995_037_190_209_989_1]), "[-0.015, 0.99503719]");
        assert_eq!(vector(&[-0.0]), "0");
    }
}
