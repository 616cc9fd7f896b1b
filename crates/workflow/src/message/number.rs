//! Numbers for people to read.

/// A number with `digits` significant digits, in the exponential form where that is shorter.
#[must_use]
pub fn short(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
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
    let shown = short(value, digits);
    let (mantissa, exponent) = shown.split_once('e').map_or((shown.as_str(), None), |(m, e)| (m, Some(e)));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    exponent.map_or_else(|| mantissa.to_string(), |e| format!("{mantissa}e{e}"))
}

/// A fraction in per cent.
#[must_use]
pub fn percent(fraction: f64) -> String {
    format!("{} %", short(100.0 * fraction, 3))
}

/// A number of things, such as `1 step` or `2 steps`.
#[must_use]
pub fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// A size in the unit that suits it.
#[must_use]
pub fn bytes(count: u64) -> String {
    let units = ["bytes", "kB", "MB", "GB", "TB", "PB", "EB"];
    let exponent = (0..units.len()).rev().find(|&i| count >= 1000_u64.pow(i as u32)).unwrap_or(0);
    if exponent == 0 {
        return format!("{count} bytes");
    }
    format!("{} {}", short(count as f64 / 1000.0_f64.powi(exponent as i32), 3), units[exponent])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_are_four_digits() {
        let shown: Vec<_> =
            [0.0, 196.123_4, 2613.6, 65_432.1, 1.023e-5, 0.012_345, -9.999_96e7].map(|x| short(x, 4)).to_vec();
        assert_eq!(shown, ["0", "196.1", "2614", "65432", "1.023e-5", "0.01235", "-1.000e8"]);
        assert_eq!(short(f64::NAN, 4), "NaN");
        assert_eq!(percent(0.0751), "7.51 %");
        assert_eq!([0.05, 1.3e-5, 2500.0, 0.0].map(|x| trimmed(x, 4)), ["0.05", "1.3e-5", "2500", "0"]);
    }

    #[test]
    fn sizes_have_three_digits() {
        let shown = [0, 999, 1000, 1_234_567, 56_700_000_000, u64::MAX].map(bytes);
        assert_eq!([0, 1, 2].map(|n| counted(n, "step")), ["0 steps", "1 step", "2 steps"]);
        assert_eq!(shown, ["0 bytes", "999 bytes", "1.00 kB", "1.23 MB", "56.7 GB", "18.4 EB"]);
    }
}
