//! Numbers for people to read.

use percute_core::message::{rounded, trimmed};

/// A fraction in per cent.
#[must_use]
pub fn percent(fraction: f64) -> String {
    format!("{} %", rounded(100.0 * fraction, 3))
}

/// The same of a number that may be negative.
#[must_use]
pub fn signed_percent(fraction: f64) -> String {
    format!("{}{}", if fraction < 0.0 { "−" } else { "" }, percent(fraction.abs()))
}

/// Things by their numbers, five at most, such as `node 3` or `nodes 3, 7 and 12 more`.
#[must_use]
pub fn numbered(thing: &str, numbers: &[usize]) -> String {
    const MOST: usize = 5;
    let shown = numbers.iter().take(MOST).map(usize::to_string).collect::<Vec<_>>().join(", ");
    let more = if numbers.len() > MOST { format!(" and {} more", numbers.len() - MOST) } else { String::new() };
    format!("{thing}{} {shown}{more}", if numbers.len() == 1 { "" } else { "s" })
}

/// A factor, such as `2.5 times` or `1e6 times`.
#[must_use]
pub fn times(factor: f64) -> String {
    format!("{} times", trimmed(factor, 4))
}

/// A fraction in whole per cent.
#[must_use]
pub fn whole_percent(fraction: f64) -> String {
    // Adding zero leaves no sign before a zero.
    format!("{:.0} %", (100.0 * fraction).round() + 0.0)
}

/// A change in whole per cent, with its sign; zero has none.
#[must_use]
pub fn change(fraction: f64) -> String {
    let shown = whole_percent(fraction);
    if shown.starts_with(['-', '0', 'N']) { shown.replace('-', "−") } else { format!("+{shown}") }
}

/// Components in brackets, of a bar the number alone.
#[must_use]
pub fn vector(components: &[f64], digits: usize) -> String {
    let shown = components.iter().map(|&x| trimmed(x, digits)).collect::<Vec<_>>().join(", ");
    if components.len() == 1 { shown } else { format!("({shown})") }
}

/// A size in the unit that suits it.
#[must_use]
pub fn bytes(count: u64) -> String {
    let units = ["bytes", "kB", "MB", "GB", "TB", "PB", "EB"];
    let exponent = (0..units.len()).rev().find(|&i| count >= 1000_u64.pow(i as u32)).unwrap_or(0);
    if exponent == 0 {
        return format!("{count} bytes");
    }
    format!("{} {}", rounded(count as f64 / 1000.0_f64.powi(exponent as i32), 3), units[exponent])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_have_no_sign_before_zero_and_no_wrong_plural() {
        assert_eq!(percent(0.0751), "7.51 %");
        assert_eq!([0.614, -0.004, -0.25, f64::NAN].map(whole_percent), ["61 %", "0 %", "-25 %", "NaN %"]);
        assert_eq!([0.066, -0.004, 0.002, -0.22].map(change), ["+7 %", "0 %", "0 %", "−22 %"]);
        assert_eq!([1e6, 0.25, 2.0].map(times), ["1e6 times", "0.25 times", "2 times"]);
        assert_eq!([vector(&[0.0, -400.0], 4), vector(&[0.5], 4)], ["(0, -400)", "0.5"]);
        assert_eq!(numbered("node", &[0]), "node 0");
        assert_eq!(numbered("node", &[1, 2]), "nodes 1, 2");
        assert_eq!(numbered("node", &(0..7).collect::<Vec<_>>()), "nodes 0, 1, 2, 3, 4 and 2 more");
    }

    #[test]
    fn sizes_have_three_digits() {
        let shown = [0, 999, 1000, 1_234_567, 56_700_000_000, u64::MAX].map(bytes);
        assert_eq!(shown, ["0 bytes", "999 bytes", "1.00 kB", "1.23 MB", "56.7 GB", "18.4 EB"]);
    }
}
