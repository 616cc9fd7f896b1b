//! The meaning of the error and its limits, in words: for the summary, the JSON document and Python.

use percute_estimator::Reconstruction;

/// Nature of the error, for all reconstructions.
const MEASURE: &str = "An estimate, not a strict bound: it contains the errors of space, time, mass and contact.";

/// Source of the evidence.
const EVIDENCE: &str = "(`percute reproduce`, docs/verification.md)";

/// Smallest and largest effectivity index of the reconstruction `corrected` in docs/verification.md, on all meshes and at all
/// speeds: bars with steps down to 0.02 of the critical one, and bodies in a first contact. A test compares them with that page. At
/// exactly the critical step the oscillation of a bar after contact grows, and the estimate misses half of it.
const CORRECTED: [f64; 2] = [0.85, 1.7];
/// The same where errors accumulate that the estimate does not contain, and at corners of one element: see the page on speeds.
const CORRECTED_OTHERWISE: [f64; 2] = [0.4, 2.8];
/// Effectivity indices of `consistent` and `published`: the smallest on the finest bars with the smallest steps, and a value that both
/// exceed at a corner or a point. The excess depends on the mesh.
const OTHERS: [f64; 2] = [0.23, 3.0];

/// Meaning of the error, and its effectivity indices in tests. The latter are left out for a reconstruction that is unknown to this
/// version.
#[must_use]
pub fn meaning(reconstruction: Option<Reconstruction>) -> String {
    let evidence = match reconstruction {
        Some(Reconstruction::Corrected) => {
            let ([least, most], [low, high]) = (CORRECTED, CORRECTED_OTHERWISE);
            format!(
                "In tests at 0.4 to 400 m/s with steps of 0.02 to 0.9 Δt_c: {least} to {most} times the true error; {low} to \
                 {high} in thin bent parts, corners of one element and after several contacts"
            )
        }
        Some(reconstruction @ (Reconstruction::Consistent | Reconstruction::Published)) => {
            let [least, most] = OTHERS;
            format!("With `{reconstruction}` it may be far off: in tests {least} to over {most} times the true error")
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
    fn the_meaning_fits_a_few_short_lines() {
        for &reconstruction in Reconstruction::ALL {
            let text = meaning(Some(reconstruction));
            let lines = lines(&text);
            assert!((1..=4).contains(&lines.lines().count()), "{lines}");
            assert!(lines.lines().all(|line| line.chars().count() <= 80), "{lines}");
            assert_eq!(lines.trim_end().replace('\n', " "), text);
            assert!(lines.ends_with(&format!("{EVIDENCE}.\n")), "{lines}");
            // No line resembles another line of the summary.
            assert!(
                ["contact ", "error ", "time ", "work "].iter().all(|label| !lines.contains(&format!("\n{label}")))
            );
        }
    }

    #[test]
    fn only_reconstructions_that_drop_forces_are_called_far_off() {
        let far_off = |reconstruction| meaning(Some(reconstruction)).contains("far off");
        assert!(!far_off(Reconstruction::default()));
        assert!(far_off(Reconstruction::Consistent) && far_off(Reconstruction::Published));
        assert_eq!(meaning(None), MEASURE);
    }
}
