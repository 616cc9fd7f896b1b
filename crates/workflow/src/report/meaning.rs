//! What the error means and what it does not, in words: for the summary, the document and Python.

use percute_estimator::Reconstruction;

/// What it is, whatever the reading.
const MEASURE: &str =
    "A measure of admissible misfit, not a strict bound: errors of space, time, mass and contact together.";

/// Where the evidence is.
const EVIDENCE: &str = "(`percute reproduce`, docs/verification.md)";

/// Smallest and largest estimate over true error of the reading `corrected` in docs/verification.md: bars with steps down to 0.02 of the
/// critical one, and bodies that touch with an edge or along a curve, on all meshes. A test holds them to that page. At exactly
/// the critical step a bar that has left the plane swings more and more, and half of that is not seen.
const CORRECTED: [f64; 2] = [0.85, 1.8];
/// The largest where a corner touches first: the block tilted by 10°, all meshes.
const CORRECTED_AT_A_CORNER: f64 = 2.3;
/// The part of the wave speed below which effectivities at corners and curves grow like 1/√v.
const SLOW: f64 = 100.0;
/// The same of `consistent` and of `published` on the finest bars with the smallest steps, and what either passes at a corner or at a
/// point; how far depends on the mesh.
const OTHERS: [f64; 2] = [0.23, 3.0];

/// What the error means, and how far from the truth it was where that is known: nothing of the latter for a reading of
/// which this version does not know.
#[must_use]
pub fn meaning(reading: Option<Reconstruction>) -> String {
    let evidence = match reading {
        Some(Reconstruction::Corrected) => {
            let [least, most] = CORRECTED;
            format!(
                "In tests at 0.02 to 0.9 Δt_c {least} to {most} times the true error, to {CORRECTED_AT_A_CORNER} if a corner is first; \
                 far more where a corner or a curve touches slower than c/{SLOW}"
            )
        }
        Some(reading @ (Reconstruction::Consistent | Reconstruction::Published)) => {
            let [least, most] = OTHERS;
            format!("With `{reading}` it may lie far off: in tests {least} to over {most} times the true error")
        }
        None => return MEASURE.to_string(),
    };
    format!("{MEASURE} {evidence} {EVIDENCE}.")
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
    fn a_few_short_lines_say_all_of_it() {
        for &reading in Reconstruction::ALL {
            let text = meaning(Some(reading));
            let lines = lines(&text);
            assert!((1..=4).contains(&lines.lines().count()), "{lines}");
            assert!(lines.lines().all(|line| line.chars().count() <= 80), "{lines}");
            assert_eq!(lines.trim_end().replace('\n', " "), text);
            assert!(lines.ends_with(&format!("{EVIDENCE}.\n")), "{lines}");
            // None looks like another line of the summary.
            assert!(
                ["contact ", "error ", "time ", "work "].iter().all(|label| !lines.contains(&format!("\n{label}")))
            );
        }
    }

    #[test]
    fn only_readings_that_drop_forces_are_called_far_off() {
        let far_off = |reading| meaning(Some(reading)).contains("far off");
        assert!(!far_off(Reconstruction::default()));
        assert!(far_off(Reconstruction::Consistent) && far_off(Reconstruction::Published));
        assert_eq!(meaning(None), MEASURE);
    }
}
