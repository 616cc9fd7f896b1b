//! Axes: from values to places, and where the marks are.

use percute_workflow::message::trimmed;

/// An axis of a chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    label: String,
    log: bool,
    low: Option<f64>,
    high: Option<f64>,
    marks: Option<Vec<f64>>,
}

impl Axis {
    /// An axis with equal steps; its label has name and unit.
    #[must_use]
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// An axis with equal ratios.
    #[must_use]
    pub fn log(label: impl Into<String>) -> Self {
        Self { log: true, ..Self::linear(label) }
    }

    /// That begins at this value instead of where the data do.
    #[must_use]
    pub fn from(self, low: f64) -> Self {
        Self { low: Some(low), ..self }
    }

    /// That ends at this value instead of where the data do.
    #[must_use]
    pub fn to(self, high: f64) -> Self {
        Self { high: Some(high), ..self }
    }

    /// With marks at these values.
    #[must_use]
    pub fn marks(self, marks: &[f64]) -> Self {
        let mut marks = marks.to_vec();
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        Self { marks: Some(marks), ..self }
    }

    /// Name and unit.
    pub(super) fn label(&self) -> &str {
        &self.label
    }

    /// The scale of this axis for some values; `rounded` lets it end at marks. About `count` marks are wanted.
    pub(super) fn scale(&self, values: impl Iterator<Item = f64>, rounded: bool, count: usize) -> Scale {
        let drawn = |value: &f64| value.is_finite() && (!self.log || *value > 0.0);
        let ends = values.filter(drawn).fold(None, |ends: Option<(f64, f64)>, value| {
            Some(ends.map_or((value, value), |(low, high)| (low.min(value), high.max(value))))
        });
        let (low, high) = ends.unwrap_or(if self.log { (1.0, 10.0) } else { (0.0, 1.0) });
        let (mut low, mut high) = (self.low.unwrap_or(low), self.high.unwrap_or(high));
        if high <= low {
            // A scale needs some length.
            let room = if self.log { 1.0 } else { low.abs().max(1.0) };
            (low, high) = if self.log { (low / 2.0, low * 2.0) } else { (low - room, low + room) };
        }
        let step = step((high - low) / count as f64);
        if rounded && !self.log {
            low = self.low.unwrap_or((low / step + 1e-9).floor() * step);
            high = self.high.unwrap_or((high / step - 1e-9).ceil() * step);
        } else if rounded {
            let room = (0.06 * (high.ln() - low.ln())).exp();
            (low, high) = (self.low.unwrap_or(low / room), self.high.unwrap_or(high * room));
        }
        let marks = self.marks.clone().unwrap_or_else(|| {
            if self.log && high / low > 3.0 { decades(low, high) } else { multiples(low, high, step) }
        });
        Scale { low, high, log: self.log, marks }
    }
}

/// From values to places between 0 and 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    log: bool,
    marks: Vec<f64>,
}

impl Scale {
    /// Where a value is: 0 at the low end, 1 at the high one.
    pub(super) fn place(&self, value: f64) -> f64 {
        if self.log {
            (value.ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// The value at a place.
    pub(super) fn value(&self, place: f64) -> f64 {
        if self.log {
            (self.low.ln() + place * (self.high.ln() - self.low.ln())).exp()
        } else {
            self.low + place * (self.high - self.low)
        }
    }

    /// Marks within the scale, with their text.
    pub(super) fn marks(&self) -> impl Iterator<Item = (f64, String)> + '_ {
        let inside = |mark: &&f64| (-1e-9..=1.0 + 1e-9).contains(&self.place(**mark));
        self.marks.iter().filter(inside).map(|&mark| (mark, text(mark)))
    }
}

/// A value at an axis.
pub(super) fn text(value: f64) -> String {
    // What is left of zero after adding up steps.
    if value.abs() < 1e-12 { "0".to_string() } else { trimmed(value, 6).replace('-', "−") }
}

/// The next of 1, 2, 5, 10 … times a power of ten.
fn step(at_least: f64) -> f64 {
    let power = 10_f64.powf(at_least.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= at_least * (1.0 - 1e-9)).unwrap_or(10.0);
    factor * power
}

fn multiples(low: f64, high: f64, step: f64) -> Vec<f64> {
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    (0..=(last - first).max(0.0) as usize).map(|k| (first + k as f64) * step).collect()
}

/// Powers of ten, with multiples of them where there are few.
fn decades(low: f64, high: f64) -> Vec<f64> {
    let factors: &[f64] = match high.ln() - low.ln() {
        span if span < 3.0 => &[1.0, 2.0, 3.0, 5.0, 7.0],
        span if span < 6.0 => &[1.0, 2.0, 5.0],
        _ => &[1.0],
    };
    let powers = (low.log10().floor() as i32).max(-308)..=(high.log10().ceil() as i32).min(308);
    powers.flat_map(|power| factors.iter().map(move |factor| factor * 10_f64.powi(power))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marks(axis: Axis, values: &[f64], rounded: bool) -> Vec<String> {
        axis.scale(values.iter().copied(), rounded, 5).marks().map(|(_, text)| text).collect()
    }

    #[test]
    fn marks_are_round_numbers() {
        assert_eq!(marks(Axis::linear("x"), &[0.3, 9.7], true), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(marks(Axis::linear("x"), &[0.3, 9.7], false), ["2", "4", "6", "8"]);
        assert_eq!(marks(Axis::log("x"), &[0.1, 1.0], false), ["0.1", "0.2", "0.3", "0.5", "0.7", "1"]);
        assert_eq!(marks(Axis::log("x"), &[1.0, 1e4], false), ["1", "10", "100", "1000", "10000"]);
        assert_eq!(marks(Axis::linear("x").marks(&[0.7, 1.8, 9.0]), &[0.0, 2.0], false), ["0.7", "1.8"]);
    }

    #[test]
    fn any_values_make_a_scale() {
        for values in [&[][..], &[f64::NAN], &[0.0], &[-3.0, -3.0], &[1e-200, 1e200]] {
            for axis in [Axis::linear("x"), Axis::log("x")] {
                let scale = axis.scale(values.iter().copied(), true, 5);
                assert!(scale.place(scale.low).abs() < 1e-12 && (scale.place(scale.high) - 1.0).abs() < 1e-12);
                assert!(scale.marks().count() < 700, "{axis:?} {values:?}");
            }
        }
    }
}
