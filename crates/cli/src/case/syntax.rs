//! What a line that is no TOML was meant to be.

/// What to do about a line, unless its mistake is not among the common ones; `told` are the words of the parser.
pub(super) fn advice(line: &str, told: &str) -> Option<&'static str> {
    let line = line.split('#').next().unwrap_or_default().trim();
    if told.contains("duplicate") {
        if line.starts_with('[') {
            return Some("this table is given twice; of several, each begins with two brackets, as in [[material]]");
        }
        return Some("this key is given twice in its table; leave one out");
    }
    if line.starts_with('[') && line.matches('[').count() > line.matches(']').count() {
        return Some("a header ends with as many ] as it begins with [");
    }
    let Some((_, value)) = line.split_once('=') else {
        let colon = line.contains(':');
        return Some(if colon { "write key = value, with = instead of :" } else { "write key = value, or a [table]" });
    };
    let value = value.trim();
    let number = value.find(|c: char| !"+-0123456789.eE_".contains(c)).map_or(value, |end| &value[..end]);
    let rest = &value[number.len()..];
    let numeric = number.contains(|c: char| c.is_ascii_digit());
    if numeric && rest.starts_with(',') {
        return Some("a number has a decimal point, not a comma");
    }
    if numeric && rest.trim_start().starts_with(|c: char| c.is_alphabetic() || c == '%' || c == '°') {
        return Some("give the number without a unit; all are SI units (Pa, m, kg/m³, m/s, s)");
    }
    value.starts_with(|c: char| c.is_alphabetic()).then_some("put texts in quotes, as in plane = \"stress\"")
}

#[cfg(test)]
mod tests {
    use super::advice;

    #[test]
    fn common_slips_are_recognised() {
        for (line, word) in [
            ("young: 70e9", "instead of :"),
            ("young", "key = value"),
            ("young = 70 GPa", "without a unit"),
            ("friction = 20%  # rough", "without a unit"),
            ("poisson = 0,3", "decimal point"),
            ("plane = stress", "in quotes"),
            ("[[obstacle]", "as many ]"),
        ] {
            assert!(advice(line, "").is_some_and(|told| told.contains(word)), "{line}");
        }
        assert_eq!(advice("points = [[0.0, 1.0]", ""), None);
    }
}
