//! What a line that is no TOML was meant to be.

const ARITHMETIC: &str = "write the number itself, as in 70e9 for 70·10⁹: nothing is calculated here";
const COMMA: &str = "a comma belongs between two entries, as in [0.0, 1.0]";
const LIST: &str = "a list has square brackets, as in [0.0, 1.0]";

/// What to do about a line, unless its mistake is not among the common ones; `told` are the words of the parser.
pub(super) fn advice(line: &str, told: &str) -> Option<&'static str> {
    if line.contains("\"\"\"") || line.contains("'''") {
        return None;
    }
    let (line, open) = bare(line);
    let line = line.trim();
    if told.contains("duplicate") {
        if line.starts_with('[') {
            return Some("this table is given twice; if several are allowed, use double brackets, as in [[material]]");
        }
        return Some("this key is given twice in its table; leave one out");
    }
    if line.contains(['“', '”', '„', '‟', '‘', '’', '‚', '«', '»', '″']) {
        return Some("put texts in straight quotes, as in \"stress\"");
    }
    if open {
        return Some("the closing quote is missing");
    }
    if line.contains("//") || line.contains("/*") {
        return Some("comments begin with #");
    }
    if line.ends_with(';') {
        return Some("no semicolon belongs at the end of a line");
    }
    let inner = line.trim_start_matches(['[', ' ']);
    let of_list = inner.starts_with(|c: char| c.is_ascii_digit() || "+-.\"(".contains(c));
    if line.starts_with('[') && !of_list && line.matches('[').count() > line.matches(']').count() {
        return Some("a header ends with as many ] as it begins with [");
    }
    match line.split_once('=') {
        Some((_, value)) if value.trim().is_empty() => Some("the value after = is missing"),
        Some((_, value)) => about_value(value.trim(), 0),
        // One of several lines of a list.
        None if of_list => about_value(line, 1),
        None if line.contains(':') => Some("write key = value, with = instead of :"),
        None => Some("write key = value, or a [table]"),
    }
}

/// A line without its comment and without what stands in its quotes, and whether a quote is left open.
fn bare(line: &str) -> (String, bool) {
    let (mut bare, mut quote, mut escaped) = (String::new(), None, false);
    for c in line.chars() {
        match quote {
            Some(_) if escaped => escaped = false,
            Some('"') if c == '\\' => escaped = true,
            Some(end) if c == end => {
                bare.push('"');
                quote = None;
            }
            Some(_) => {}
            None if c == '#' => break,
            None if c == '"' || c == '\'' => {
                bare.push('"');
                quote = Some(c);
            }
            None => bare.push(c),
        }
    }
    (bare, quote.is_some())
}

/// What to do about a value, `depth` square brackets deep.
fn about_value(value: &str, mut depth: usize) -> Option<&'static str> {
    if value.starts_with('(') {
        return Some(if value.contains(',') { LIST } else { ARITHMETIC });
    }
    let number = value.split_once(',').map(|(first, _)| first.trim());
    if depth == 0 && number.is_some_and(|first| first.parse::<f64>().is_ok()) {
        return Some(if value.contains('.') { LIST } else { "a number has a decimal point, not a comma" });
    }
    let mut rest = value;
    while !rest.is_empty() {
        let length = rest.find(['[', ']', '{', '}', ',', '=']).unwrap_or(rest.len());
        let (entry, after) = rest.split_at(length);
        let mark = after.chars().next();
        let found = match mark {
            // A key inside braces.
            Some('=') => entry.trim().contains(char::is_whitespace).then_some(COMMA),
            _ => about_entry(entry.trim(), depth > 0),
        };
        if found.is_some() {
            return found;
        }
        match mark {
            Some('[') => depth += 1,
            Some(']') => depth = depth.saturating_sub(1),
            _ => {}
        }
        rest = after.get(1..).unwrap_or_default();
    }
    None
}

/// What to do about one number or text, in a list or not.
fn about_entry(entry: &str, in_list: bool) -> Option<&'static str> {
    if entry.starts_with('(') {
        return Some(if in_list { LIST } else { ARITHMETIC });
    }
    if entry.starts_with('"') {
        return entry.trim_matches('"').contains(char::is_whitespace).then_some(COMMA);
    }
    let number = entry.find(|c: char| !"+-0123456789.eE_".contains(c)).map_or(entry, |end| &entry[..end]);
    if number.contains(|c: char| c.is_ascii_digit()) && !number.starts_with(['e', 'E']) {
        return about_number(number, entry[number.len()..].trim_start(), in_list);
    }
    if !entry.starts_with(|c: char| c.is_alphabetic()) || ["true", "false", "inf", "nan"].contains(&entry) {
        return None;
    }
    match entry {
        "True" | "TRUE" | "yes" | "on" => Some("write true"),
        "False" | "FALSE" | "no" | "off" => Some("write false"),
        _ if entry.contains(['(', '*', '/', '^']) => Some(ARITHMETIC),
        _ => Some("put texts in quotes, as in plane = \"stress\""),
    }
}

/// What to do about a number and the `rest` behind it.
fn about_number(number: &str, rest: &str, in_list: bool) -> Option<&'static str> {
    if rest.starts_with(['*', '/', '^', '(', '×', '·']) {
        return Some(ARITHMETIC);
    }
    let next = rest.chars().next();
    if next.is_some_and(|c| c.is_alphabetic() || c == '%' || c == '°') {
        return Some("give the number without a unit; all are SI units (Pa, m, kg/m³, m/s, s)");
    }
    if in_list && next.is_some_and(|c| "+-.;".contains(c) || c.is_ascii_digit()) {
        return Some(COMMA);
    }
    if next.is_some_and(|c| c.is_ascii_digit()) {
        return Some("a number has no spaces: write 70e9 or 70_000_000_000");
    }
    let number = number.trim_start_matches(['+', '-']);
    let mantissa = number.split(['e', 'E']).next().unwrap_or_default();
    let exponent = number[mantissa.len()..].get(1..).unwrap_or_default().trim_start_matches(['+', '-']);
    if mantissa.contains(['+', '-']) || exponent.contains(['+', '-']) || next.is_some_and(|c| "+-".contains(c)) {
        return Some(ARITHMETIC);
    }
    if mantissa.starts_with('.') || mantissa.ends_with('.') {
        return Some("a number has a digit on both sides of its point, as in 0.5 and 1.0");
    }
    let zero = mantissa.strip_prefix('0').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    zero.then_some("a number does not begin with a zero, unless its point follows: write 70e9, not 070e9")
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
            ("velocity = [400 m/s, 0.0]", "without a unit"),
            ("friction = 20%  # rough", "without a unit"),
            ("poisson = 0,3", "decimal point"),
            ("normal = 0.0, 1.0", "square brackets"),
            ("plane = stress", "in quotes"),
            ("enabled = True", "write true"),
            ("[[obstacle]", "as many ]"),
            ("courant = .9", "both sides"),
            ("courant = -.9", "both sides"),
            ("courant = 1.", "both sides"),
            ("courant = 1.e-3", "both sides"),
            ("normal = [0., 1.]", "both sides"),
            ("young = 70*10^9", "the number itself"),
            ("young = 70e9*2", "the number itself"),
            ("young = 7e10/2", "the number itself"),
            ("young = 69e9+1e9", "the number itself"),
            ("normal = [sqrt(2), 0.0]", "the number itself"),
            ("young = 70 000 000 000", "no spaces"),
            ("young = 70e9 // Pa", "begin with #"),
            ("plane = \"stress\" // thin", "begin with #"),
            ("young =", "is missing"),
            ("young =  # Pa", "is missing"),
            ("young = 70e9;", "semicolon"),
            ("young = 070e9", "begin with a zero"),
            ("normal = (0.0, 1.0)", "square brackets"),
            ("points = [(0.0, 1.0)]", "square brackets"),
            ("normal = [0.0 1.0]", "comma"),
            ("normal = [0.0 -1.0]", "comma"),
            ("    [0.0 1.0],", "comma"),
            ("    [[0.0 1.0],", "comma"),
            ("components = [\"x\" \"y\"]", "comma"),
            ("rectangle = { width = 0.05 height = 0.04 }", "comma"),
            ("rectangle = { width = .05, height = 0.04 }", "both sides"),
            ("plane = \"stress", "closing quote"),
            ("plane = \"stress  # thin", "closing quote"),
            ("plane = “stress”", "straight quotes"),
        ] {
            assert!(advice(line, "").is_some_and(|told| told.contains(word)), "{line}: {:?}", advice(line, ""));
        }
    }

    #[test]
    fn nothing_is_said_of_what_is_right() {
        for line in [
            "points = [[0.0, 1.0]",
            "young = 7.0e+10",
            "young = 70_000_000_000 # // “Pa”; .9",
            "value = [-1e6, +0.5, 0, 0.0e-3]",
            "name = \"a // b; 1. “c” # d\"",
            "name = 'C:\\new'",
            "velocity = { time = [0.0, 1e-4], value = [inf, nan] }",
            "    [0.0, 1.0],",
            "flags = [true, false]",
        ] {
            assert_eq!(advice(line, ""), None, "{line}");
        }
    }
}
