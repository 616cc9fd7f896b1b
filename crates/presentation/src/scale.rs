//! Scales: colours of values, and marks at axes.

use percute_workflow::message::{trimmed, vector};

/// From this ratio of the largest value to the median on, a linear scale shows all but a few elements dark.
const OUTSHONE: f64 = 5.0;
/// Fewer marks than this do not show a scale.
const FEW: usize = 3;
/// A logarithmic scale of colours spans at most this ratio; smaller values have the colour of its lower end.
const SPAN: f64 = 1e4;

/// Seventeen colours of viridis by van der Walt and Smith (public domain), from 0 to 1 at equal distances.
const VIRIDIS: [[u8; 3]; 17] = [
    [68, 1, 84],
    [72, 24, 106],
    [71, 45, 123],
    [66, 64, 134],
    [59, 82, 139],
    [51, 99, 141],
    [44, 114, 142],
    [38, 130, 142],
    [33, 145, 140],
    [31, 160, 136],
    [40, 174, 128],
    [63, 188, 115],
    [94, 201, 98],
    [132, 212, 75],
    [173, 220, 48],
    [216, 226, 25],
    [253, 231, 37],
];

/// The colours of values that are not negative, for other programs that draw them.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourScale {
    /// The values at both ends.
    pub ends: [f64; 2],
    /// Whether colours follow the logarithm of the value.
    pub logarithmic: bool,
    /// Values with marks, and their labels.
    pub marks: Vec<(f64, String)>,
}

/// The colours of values that are not negative, with about `count` marks.
#[must_use]
pub fn colour_scale(values: &[f64], count: usize) -> ColourScale {
    let scale = Scale::of_colours(values);
    let marks = scale.marks(count, values.iter().any(|&value| value < scale.low));
    ColourScale { ends: [scale.low, scale.high], logarithmic: scale.logarithmic, marks }
}

/// The colour of a fraction from 0 to 1, from dark to light; equal steps look equal.
pub(crate) fn viridis(fraction: f64) -> [u8; 3] {
    let place = if fraction.is_finite() { fraction.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64 } else { 0.0 };
    let low = (place.floor() as usize).min(VIRIDIS.len() - 2);
    let part = place - low as f64;
    [0, 1, 2].map(|c| {
        let [a, b] = [VIRIDIS[low][c], VIRIDIS[low + 1][c]].map(f64::from);
        (a + part * (b - a)).round() as u8
    })
}

/// A range of values, linear or logarithmic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) logarithmic: bool,
}

impl Scale {
    /// A linear scale; one without length gets some.
    pub(crate) fn linear(low: f64, high: f64) -> Self {
        let high = if high > low { high } else { low + if low == 0.0 { 1.0 } else { low.abs() } };
        Self { low, high, logarithmic: false }
    }

    /// A logarithmic scale between positive values.
    pub(crate) fn logarithmic(low: f64, high: f64) -> Self {
        if low > 0.0 && high > low {
            Self { low, high, logarithmic: true }
        } else {
            Self::linear(low.min(high), low.max(high))
        }
    }

    /// The scale of colours for values that are not negative: logarithmic where the largest is more than five times the
    /// median. It then begins at the hundredth part of the values, or at 1e-4 of the largest.
    pub(crate) fn of_colours(values: &[f64]) -> Self {
        let mut positive: Vec<f64> = values.iter().copied().filter(|v| v.is_finite() && *v > 0.0).collect();
        positive.sort_by(f64::total_cmp);
        let Some(&most) = positive.last() else { return Self::linear(0.0, 1.0) };
        if most <= OUTSHONE * positive[positive.len() / 2] {
            return Self::linear(0.0, most);
        }
        Self::logarithmic(positive[positive.len() / 100].max(most / SPAN).min(0.5 * most), most)
    }

    /// The place of a value, 0 at the lower and 1 at the upper end.
    pub(crate) fn fraction(&self, value: f64) -> f64 {
        if self.logarithmic {
            return (value.max(f64::MIN_POSITIVE) / self.low).ln() / (self.high / self.low).ln();
        }
        (value - self.low) / (self.high - self.low)
    }

    /// Round values for about `count` marks; none for 0.
    pub(crate) fn ticks(&self, count: usize) -> Vec<f64> {
        if count == 0 {
            return Vec::new();
        }
        // Less than a factor of eight has two powers or parts of them at most.
        if self.logarithmic && self.high > 8.0 * self.low {
            return self.powers(count);
        }
        let rough = (self.high - self.low) / count as f64;
        let power = 10.0_f64.powf(rough.log10().floor());
        let at = |step: f64| -> Vec<f64> {
            let (from, to) = ((self.low / step - 1e-9).ceil() as i64, (self.high / step + 1e-9).floor() as i64);
            (from..=to).map(|k| k as f64 * step).collect()
        };
        let steps = [0.5, 1.0, 2.0, 5.0, 10.0].map(|m| m * power);
        let next = steps.iter().position(|step| *step >= rough * 0.999).unwrap_or(steps.len() - 1);
        let ticks = at(steps[next]);
        // A range that ends just before a mark has too few.
        if ticks.len() < FEW && count > FEW { at(steps[next.saturating_sub(1)]) } else { ticks }
    }

    /// Marks of a scale of colours; with `less`, the lowest one says that smaller values have its colour.
    pub(crate) fn marks(&self, count: usize, less: bool) -> Vec<(f64, String)> {
        /// Distance of the next mark from the lowest one, as a part of the scale between two marks.
        const CLEAR: f64 = 0.35;
        let below = (self.logarithmic && less).then(|| (self.low, format!("≤ {}", tick(rounded(self.low)))));
        let clear = if below.is_some() { CLEAR / count.max(1) as f64 } else { f64::NEG_INFINITY };
        let others = self.ticks(count).into_iter().filter(|&value| self.fraction(value) > clear);
        below.into_iter().chain(others.map(|value| (value, tick(value)))).collect()
    }

    /// Powers of ten, with twice and five times them where these are few.
    fn powers(&self, count: usize) -> Vec<f64> {
        let decades = (self.high / self.low).log10();
        let (from, to) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
        let parts: &[f64] = if decades <= 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let every = (decades / count as f64).ceil().max(1.0) as i32;
        let powers = (from..=to).filter(|k| k % every == 0);
        let all = powers.flat_map(|k| parts.iter().map(move |part| part * 10.0_f64.powi(k)));
        all.filter(|v| (self.low * 0.999..=self.high * 1.001).contains(v)).collect()
    }
}

/// A number at an axis.
pub(crate) fn tick(value: f64) -> String {
    // Left over from zero after multiples of a step.
    if value.abs() < 1e-300 { "0".to_string() } else { trimmed(value, 4) }
}

/// A value with two digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// Components below this part of the largest are left over from zero: sums of thousands of steps and nodes have
/// roundings of 1e-13.
const ROUNDING: f64 = 1e-12;
/// Units that get no prefix.
const PLAIN: [&str; 4] = ["m/s", "kg", "kg/m", ""];

/// A number with its unit, which gets a prefix: 306.5 MN.
pub(crate) fn quantity(value: f64, unit: &str, digits: usize) -> String {
    vector_quantity(&[value], unit, digits)
}

/// The same of components in brackets.
pub(crate) fn vector_quantity(values: &[f64], unit: &str, digits: usize) -> String {
    let most = values.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let (factor, unit) = if PLAIN.contains(&unit) { (1.0, unit.to_string()) } else { prefixed(unit, most) };
    let part = |x: &f64| if x.abs() > ROUNDING * most { x * factor } else { 0.0 };
    let values: Vec<f64> = values.iter().map(part).collect();
    format!("{} {unit}", vector(&values, digits)).trim_end().to_string()
}

/// A factor and a unit that make values up to `most` short: 1e6 and `µs` for microseconds.
pub(crate) fn prefixed(unit: &str, most: f64) -> (f64, String) {
    const PREFIXES: [(&str, f64); 9] = [
        ("n", 1e-9),
        ("µ", 1e-6),
        ("m", 1e-3),
        ("", 1.0),
        ("k", 1e3),
        ("M", 1e6),
        ("G", 1e9),
        ("T", 1e12),
        ("P", 1e15),
    ];
    let most = most.abs() * 1.000_001;
    // Lengths in mm or m, never in km.
    let fits = |(prefix, size): &&(&str, f64)| *size <= most && !(unit == "m" && *size > 1.0 && !prefix.is_empty());
    let (prefix, size) =
        PREFIXES.iter().rev().find(fits).unwrap_or(if most > 0.0 { &PREFIXES[0] } else { &PREFIXES[3] });
    (1.0 / size, format!("{prefix}{unit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bright_element_makes_the_scale_logarithmic() {
        let mut values = vec![1.0; 99];
        values.push(4.9);
        assert_eq!(Scale::of_colours(&values), Scale::linear(0.0, 4.9));
        values[99] = 11.0;
        assert_eq!(Scale::of_colours(&values), Scale { low: 1.0, high: 11.0, logarithmic: true });
        values[0] = 1e-30;
        assert!(Scale::of_colours(&values).low >= 11.0 / SPAN);
        for none in [vec![], vec![0.0; 3], vec![f64::NAN]] {
            assert_eq!(Scale::of_colours(&none), Scale::linear(0.0, 1.0));
        }
    }

    #[test]
    fn colours_run_from_dark_to_light_and_take_anything() {
        let brightness = |c: [u8; 3]| c.map(u32::from).iter().sum::<u32>();
        let steps: Vec<_> = (0..=20).map(|i| brightness(viridis(f64::from(i) / 20.0))).collect();
        assert!(steps.is_sorted(), "{steps:?}");
        assert_eq!([f64::NAN, -1.0].map(viridis), [viridis(0.0); 2]);
        assert_eq!(viridis(7.0), [253, 231, 37]);
    }

    #[test]
    fn the_lowest_mark_tells_of_smaller_values() {
        let mut values = vec![2.04; 90];
        values.extend([30.0; 10]);
        let scale = colour_scale(&values, 5);
        assert_eq!((scale.ends, scale.logarithmic), ([2.04, 30.0], true));
        assert_eq!(scale.marks.iter().map(|mark| mark.1.as_str()).collect::<Vec<_>>(), ["5", "10", "20"]);
        values.push(1e-9);
        values.extend([2.04; 100]);
        assert_eq!(colour_scale(&values, 5).marks[0], (2.04, "≤ 2".to_string()));
        assert!(!colour_scale(&[1.0, 2.0], 5).logarithmic);
    }

    #[test]
    fn marks_are_round_and_inside() {
        assert_eq!(Scale::linear(0.0, 1.3).ticks(5), [0.0, 0.5, 1.0]);
        assert_eq!(Scale::linear(-231.0, 900.0).ticks(5), [-200.0, 0.0, 200.0, 400.0, 600.0, 800.0]);
        assert_eq!(Scale::linear(0.0, 9.0).ticks(2), [0.0, 5.0]);
        assert_eq!(Scale::linear(-2e-4, 2e-4).ticks(4), [-2e-4, -1e-4, 0.0, 1e-4, 2e-4]);
        assert_eq!(Scale::logarithmic(0.5, 30.0).ticks(6), [0.5, 1.0, 2.0, 5.0, 10.0, 20.0]);
        assert_eq!(Scale::logarithmic(1e-3, 1e3).ticks(6).len(), 7);
        assert_eq!(Scale::logarithmic(35.0, 85.0).ticks(5), [40.0, 50.0, 60.0, 70.0, 80.0]);
        assert!(Scale::linear(0.0, 1.0).ticks(0).is_empty());
        let shown: Vec<_> = [0.0, 0.01, -2.0, 5e-5, 1e-9, 250_000.0].map(tick).to_vec();
        assert_eq!(shown, ["0", "0.01", "-2", "5e-5", "1e-9", "250000"]);
    }

    #[test]
    fn units_get_a_prefix() {
        let unit = |unit: &str, most: f64| prefixed(unit, most).1;
        assert_eq!([unit("s", 1.3e-5), unit("Pa", 1.2e10), unit("m", 0.05), unit("m", 4e4)], ["µs", "GPa", "mm", "m"]);
        assert_eq!([unit("J", 0.0), unit("N", 1e-12), unit("J", 1000.0)], ["J", "nN", "kJ"]);
        assert!((prefixed("s", 1.3e-5).0 - 1e6).abs() < 1.0);
        assert_eq!([quantity(-3.0653e8, "N", 4), quantity(1e4, "m/s", 4)], ["-306.5 MN", "10000 m/s"]);
        assert_eq!(vector_quantity(&[-684.689, 3424.4], "N s", 3), "(-0.685, 3.42) kN s");
        assert_eq!(vector_quantity(&[-2.8e-15, 83.8], "N s", 3), "(0, 83.8) N s");
        assert_eq!(vector_quantity(&[1e-9, 83.8], "N s", 3), "(1e-9, 83.8) N s");
    }
}
