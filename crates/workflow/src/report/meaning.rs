//! The meaning of the error, in words: for the summary, the JSON document and Python.

/// Nature of the error, for all reconstructions, and the source of the evidence on it.
const MEASURE: &str = "An estimate, not a strict bound: it contains the errors of space, time, mass and contact \
                       (docs/verification.md).";

/// Meaning of the error. The [`Verdict`](super::Verdict) has its effectivity index in cases like the one at hand.
#[must_use]
pub fn meaning() -> &'static str {
    MEASURE
}

/// A text in lines of at most 80 columns.
pub(super) fn lines(text: &str) -> String {
    let (mut lines, mut width) = (String::new(), 0);
    for word in text.split(' ') {
        let length = word.chars().count();
        let fits = width > 0 && width + 1 + length <= 80;
        if width > 0 {
            lines.push(if fits { ' ' } else { '\n' });
        }
        lines.push_str(word);
        width = if fits { width + 1 + length } else { length };
    }
    lines + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_keeps_its_words_in_lines_of_80_columns() {
        let lines = lines(MEASURE);
        assert!((2..=3).contains(&lines.lines().count()), "{lines}");
        assert!(lines.lines().all(|line| line.chars().count() <= 80), "{lines}");
        assert_eq!(lines.trim_end().replace('\n', " "), MEASURE);
    }
}
