//! Symbols and numbers in running text, such as Δt_c, J^½ and 1.5e-6: one reader, and a writer each for HTML and SVG.

/// The kind of a piece of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Plain,
    Symbol,
    Sub,
    Sup,
    Code,
}

/// Cuts a text into pieces: `code`, letters with an index (e_ref, Δt_c), powers (J^½, 10^-3), numbers (1.5e-6, -3).
fn pieces(text: &str) -> Vec<(Kind, String)> {
    let letters: Vec<char> = text.chars().collect();
    let (mut all, mut plain, mut at) = (Vec::new(), String::new(), 0);
    while at < letters.len() {
        let readers = [code, indexed, power, exponential, minus];
        let Some((found, next)) = readers.iter().find_map(|read| read(&letters, at)) else {
            plain.push(letters[at]);
            at += 1;
            continue;
        };
        if !plain.is_empty() {
            all.push((Kind::Plain, std::mem::take(&mut plain)));
        }
        all.extend(found);
        at = next;
    }
    if !plain.is_empty() {
        all.push((Kind::Plain, plain));
    }
    all
}

/// Pieces, and the place after them.
type Found = Option<(Vec<(Kind, String)>, usize)>;

fn code(letters: &[char], at: usize) -> Found {
    let rest = letters[at..].strip_prefix(&['`'])?;
    let length = rest.iter().position(|&c| c == '`').filter(|&length| length > 0)?;
    Some((vec![(Kind::Code, rest[..length].iter().collect())], at + length + 2))
}

/// A single letter with an index; words with an underscore are names of keys.
fn indexed(letters: &[char], at: usize) -> Found {
    let alone = at == 0 || !(letters[at - 1].is_alphanumeric() || letters[at - 1] == '_') || letters[at - 1] == 'Δ';
    if !alone || !letters[at].is_alphabetic() || letters.get(at + 1) != Some(&'_') {
        return None;
    }
    let index: String = letters[at + 2..].iter().take_while(|c| c.is_alphanumeric()).collect();
    let next = at + 2 + index.chars().count();
    let ends = letters.get(next) != Some(&'_');
    (ends && !index.is_empty()).then(|| (vec![(Kind::Symbol, letters[at].to_string()), (Kind::Sub, index)], next))
}

fn power(letters: &[char], at: usize) -> Found {
    if letters[at] != '^' {
        return None;
    }
    let of_power = |c: &&char| c.is_numeric() || **c == '-' || **c == '−';
    let power: String = letters[at + 1..].iter().take_while(of_power).collect();
    let next = at + 1 + power.chars().count();
    (!power.is_empty()).then(|| (vec![(Kind::Sup, power.replace('-', "−"))], next))
}

/// A number with an exponent, as a multiple of a power of ten; letters around it make it a name.
fn exponential(letters: &[char], at: usize) -> Found {
    let of_word = |c: &char| c.is_alphanumeric() || "._".contains(*c);
    let digits = |from: usize| letters[from..].iter().take_while(|c| c.is_ascii_digit()).count();
    let whole = digits(at);
    if whole == 0 || (at > 0 && of_word(&letters[at - 1])) {
        return None;
    }
    let part = if letters.get(at + whole) == Some(&'.') { 1 + digits(at + whole + 1) } else { 0 };
    let sign = at + whole + part + 1;
    let power = sign + usize::from(letters.get(sign) == Some(&'-'));
    if letters.get(sign - 1) != Some(&'e') || power >= letters.len() || digits(power) == 0 {
        return None;
    }
    let next = power + digits(power);
    if letters.get(next).is_some_and(|c| c.is_alphanumeric() || *c == '_') {
        return None;
    }
    let mantissa: String = letters[at..sign - 1].iter().collect();
    let base = if mantissa == "1" { "10".to_string() } else { format!("{mantissa}×10") };
    let power: String = letters[sign..next].iter().collect();
    Some((vec![(Kind::Plain, base), (Kind::Sup, power.replace('-', "−"))], next))
}

/// The sign of a negative number.
fn minus(letters: &[char], at: usize) -> Found {
    let begins = at == 0 || " \u{a0}([≤".contains(letters[at - 1]);
    let number = letters[at] == '-' && letters.get(at + 1).is_some_and(char::is_ascii_digit);
    (begins && number).then(|| (vec![(Kind::Plain, "−".to_string())], at + 1))
}

/// A text without the characters that mean something in HTML and SVG. Control characters are in no document.
pub(crate) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            '\n' | '\t' => safe.push(letter),
            letter if letter.is_control() => safe.push('\u{fffd}'),
            letter => safe.push(letter),
        }
    }
    safe
}

/// A text in which a number stays in a line with the Δ of the symbol that follows.
fn joined(text: &str) -> String {
    match text.strip_suffix(" Δ") {
        Some(before) if before.ends_with(|c: char| c.is_ascii_digit()) => format!("{before}\u{a0}Δ"),
        _ => text.to_string(),
    }
}

/// A text as HTML. A number and its `%` or symbol stay in a line.
pub(crate) fn html(text: &str) -> String {
    let tag = |(kind, text): (Kind, String)| {
        let text = escaped(&text);
        match kind {
            Kind::Plain => joined(&text.replace(" %", "\u{a0}%")),
            Kind::Symbol => format!("<i>{text}</i>"),
            Kind::Sub => format!("<sub>{text}</sub>"),
            Kind::Sup => format!("<sup>{text}</sup>"),
            Kind::Code => format!("<code>{text}</code>"),
        }
    };
    pieces(text).into_iter().map(tag).collect()
}

/// A text inside the element `text` of an SVG, in a font of this size (pixels).
pub(crate) fn svg(text: &str, size: f64) -> String {
    let (mut all, mut shift) = (String::new(), 0.0);
    for (kind, text) in pieces(text) {
        let text = escaped(&text);
        let level = match kind {
            Kind::Sub => 0.22 * size,
            Kind::Sup => -0.36 * size,
            _ => 0.0,
        };
        let mut marks = String::new();
        if level != shift {
            marks += &format!(" dy=\"{:.1}\"", level - shift);
        }
        if matches!(kind, Kind::Sub | Kind::Sup) {
            marks += &format!(" font-size=\"{:.1}\"", 0.72 * size);
        }
        if kind == Kind::Symbol {
            marks += " font-style=\"italic\"";
        }
        shift = level;
        all += &if marks.is_empty() { text } else { format!("<tspan{marks}>{text}</tspan>") };
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_have_indices_and_powers() {
        assert_eq!(html("0.9 Δt_c and e_ref"), "0.9\u{a0}Δ<i>t</i><sub>c</sub> and <i>e</i><sub>ref</sub>");
        assert_eq!(html("166.8 J^½, 2·10^-3"), "166.8 J<sup>½</sup>, 2·10<sup>−3</sup>");
        assert_eq!(html("F_DA, a^b, x_"), "<i>F</i><sub>DA</sub>, a^b, x_");
    }

    #[test]
    fn numbers_have_signs_and_powers_of_ten() {
        assert_eq!(html("1.1e-14, 1e9 (-3, -2.5e8)"), "1.1×10<sup>−14</sup>, 10<sup>9</sup> (−3, −2.5×10<sup>8</sup>)");
        assert_eq!(html("by -22 %."), "by −22\u{a0}%.");
        for name in ["mesh1e5", "1e5x", "v1.2e3", "1e", "1.5e-", "a-2", "--3", "2-1", "`1e-3`"] {
            assert!(!html(name).contains('×') && !html(name).contains('−') && !html(name).contains("<sup>"), "{name}");
        }
    }

    #[test]
    fn names_of_keys_stay_as_they_are() {
        assert_eq!(html("star_compatibility, `e_ref <`"), "star_compatibility, <code>e_ref &lt;</code>");
        assert_eq!(html("a_b_c my_e_x `"), "a_b_c my_e_x `");
    }

    #[test]
    fn what_follows_an_index_is_on_the_line_again() {
        let text = svg("e_E (J^½)", 10.0);
        assert!(
            text.starts_with("<tspan font-style=\"italic\">e</tspan><tspan dy=\"2.2\" font-size=\"7.2\">E</tspan>"),
            "{text}"
        );
        assert!(text.ends_with("<tspan dy=\"3.6\">)</tspan>"), "{text}");
    }

    #[test]
    fn nothing_means_anything() {
        assert_eq!(escaped("<script>&\"'\u{0}"), "&lt;script&gt;&amp;&quot;&#39;\u{fffd}");
        assert_eq!(svg("<a>", 13.0), "&lt;a&gt;");
    }
}
