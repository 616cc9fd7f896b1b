//! Numbers for people to read.

/// A number with `digits` significant digits, in the exponential form where that is shorter.
pub(crate) fn short(value: f64, digits: usize) -> String {
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
pub(crate) fn trimmed(value: f64, digits: usize) -> String {
    let shown = short(value, digits);
    let (mantissa, exponent) = shown.split_once('e').map_or((shown.as_str(), None), |(m, e)| (m, Some(e)));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    exponent.map_or_else(|| mantissa.to_string(), |e| format!("{mantissa}e{e}"))
}

/// A fraction in per cent.
pub(crate) fn percent(fraction: f64) -> String {
    format!("{} %", short(100.0 * fraction, 3))
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
}
