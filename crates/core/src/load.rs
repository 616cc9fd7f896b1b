//! Supports, tractions and body forces, as the user states them.

use crate::border::{Vector, cut, padded};
use thiserror::Error;

/// Why a table was refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum TableError {
    /// No values, or not as many as instants.
    #[error("`time` has {times} entries and `value` has {values}; they must be equally many, and at least one")]
    Lengths { times: usize, values: usize },
    /// Instants out of order.
    #[error("`time` entry {index} is {time} s, not after the one before it; instants must increase")]
    Order { index: usize, time: f64 },
    /// NaN or infinity.
    #[error("entry {index} of the table holds the number {value}; all numbers must be finite")]
    NotFinite {
        index: usize,
        /// The number: an instant (s), or part of a value.
        value: f64,
    },
}

/// A vector that is piecewise linear in time and constant outside its table.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    time: Vec<f64>,
    value: Vec<Vector>,
}

impl Table {
    /// A table of instants (s) and values.
    ///
    /// # Errors
    /// Lengths that differ, instants that do not increase, values that are not finite.
    pub fn new<const C: usize>(time: Vec<f64>, value: Vec<[f64; C]>) -> Result<Self, TableError> {
        if time.is_empty() || time.len() != value.len() {
            return Err(TableError::Lengths { times: time.len(), values: value.len() });
        }
        for (index, (t, v)) in time.iter().zip(&value).enumerate() {
            if let Some(&value) = v.iter().chain([t]).find(|x| !x.is_finite()) {
                return Err(TableError::NotFinite { index, value });
            }
            if index > 0 && *t <= time[index - 1] {
                return Err(TableError::Order { index, time: *t });
            }
        }
        Ok(Self { time, value: value.iter().map(padded).collect() })
    }

    /// The same value at all times.
    #[must_use]
    pub fn constant<const C: usize>(value: [f64; C]) -> Self {
        Self { time: vec![0.0], value: vec![padded(&value)] }
    }

    /// Its instants (s).
    #[must_use]
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Its values at them.
    #[must_use]
    pub fn value(&self) -> &[Vector] {
        &self.value
    }

    /// Whether it has the same value at all times.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.value.iter().all(|value| *value == self.value[0])
    }

    /// The value at an instant.
    #[must_use]
    pub fn at(&self, t: f64) -> Vector {
        let after = self.time.partition_point(|&x| x <= t);
        if after == 0 || after == self.time.len() {
            return self.value[after.saturating_sub(1)];
        }
        let (t0, t1) = (self.time[after - 1], self.time[after]);
        let s = (t - t0) / (t1 - t0);
        let mut value = [0.0; 3];
        for c in 0..3 {
            value[c] = (1.0 - s) * self.value[after - 1][c] + s * self.value[after][c];
        }
        value
    }

    /// Whether every entry is finite; [`Table::constant`] does not check.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.value.iter().flatten().all(|x| x.is_finite())
    }

    /// One component as a table of its own.
    #[must_use]
    pub fn component(&self, c: usize) -> Self {
        Self { time: self.time.clone(), value: self.value.iter().map(|v| [v[c], 0.0, 0.0]).collect() }
    }

    /// Which components are ever different from zero.
    #[must_use]
    pub fn acting_components(&self) -> [bool; 3] {
        std::array::from_fn(|c| self.value.iter().any(|v| v[c] != 0.0))
    }

    /// How far straight lines between the values at `instants` miss the table: the largest
    /// difference over the largest value between the first and the last of them, in any component.
    #[must_use]
    pub fn resampling_error(&self, instants: &[f64]) -> f64 {
        let sampled: Vec<_> = instants.iter().map(|&t| self.at(t)).collect();
        let end = instants.last().copied().unwrap_or(0.0);
        let within = self.time.iter().zip(&self.value).filter(|(t, _)| (0.0..=end).contains(*t)).map(|(_, v)| v);
        let values = sampled.iter().chain(within).flatten();
        let largest = values.fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut error: f64 = 0.0;
        for (t, value) in self.time.iter().zip(&self.value) {
            let after = instants.partition_point(|x| x <= t);
            if after == 0 || after == instants.len() {
                continue;
            }
            let s = (t - instants[after - 1]) / (instants[after] - instants[after - 1]);
            for c in 0..3 {
                let line = (1.0 - s) * sampled[after - 1][c] + s * sampled[after][c];
                error = error.max((line - value[c]).abs());
            }
        }
        if largest > 0.0 { error / largest } else { 0.0 }
    }
}

/// Components of the motion prescribed on a group of faces, ∂₁Ω (eq. \[4\]).
#[derive(Clone, Debug)]
pub struct Support {
    /// Group of faces.
    pub group: String,
    /// Which components, in global axes.
    pub components: [bool; 3],
    /// Their velocity v_d(t) (m/s); `None` keeps them fixed.
    pub velocity: Option<Table>,
}

/// A scalar factor that varies linearly in space: `value + gradient · x`.
#[derive(Clone, Copy, Debug)]
pub struct Profile {
    /// Value at the origin.
    pub value: f64,
    /// Gradient (1/m).
    pub gradient: Vector,
}

impl Profile {
    /// 1 everywhere.
    pub const UNIFORM: Self = Self { value: 1.0, gradient: [0.0; 3] };

    /// The factor at a point.
    #[must_use]
    pub fn at<const D: usize>(&self, point: &[f64; D]) -> f64 {
        self.value + cut::<D>(&self.gradient).iter().zip(point).map(|(g, x)| g * x).sum::<f64>()
    }
}

/// A traction F_d on a group of faces, ∂₂Ω: a table in time (Pa) times a profile in space.
#[derive(Clone, Debug)]
pub struct Traction {
    /// Group of faces.
    pub group: String,
    /// Force per area (Pa), in global axes.
    pub value: Table,
    /// Linear variation along the faces.
    pub profile: Profile,
}

/// A body force f_d on a group of elements, or on all.
#[derive(Clone, Debug)]
pub struct BodyForce {
    /// Group of elements; `None` means all.
    pub group: Option<String>,
    /// Force per volume (N/m³), in global axes.
    pub value: Table,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_interpolate_and_hold_their_ends() {
        let table = Table::new(vec![1.0, 2.0, 4.0], vec![[0.0], [10.0], [-10.0]]).unwrap();
        assert_eq!([0.0, 1.5, 2.0, 3.0, 9.0].map(|t| table.at(t)[0]), [0.0, 5.0, 10.0, 0.0, -10.0]);
    }

    #[test]
    fn resampling_error_is_the_clipped_corner() {
        let table = Table::new(vec![0.0, 1.0, 2.0], vec![[0.0], [1.0], [0.0]]).unwrap();
        assert_eq!(table.resampling_error(&[0.0, 1.0, 2.0]), 0.0);
        // The line from (0.5, 0.5) to (1.5, 0.5) misses the peak by half its height.
        assert_eq!(table.resampling_error(&[0.0, 0.5, 1.5, 2.0]), 0.5);
    }

    #[test]
    fn bad_tables_are_refused() {
        assert!(matches!(Table::new(vec![0.0], vec![[1.0], [2.0]]), Err(TableError::Lengths { .. })));
        assert!(matches!(Table::new::<1>(vec![], vec![]), Err(TableError::Lengths { .. })));
        assert!(matches!(Table::new(vec![0.0, 0.0], vec![[1.0], [2.0]]), Err(TableError::Order { index: 1, .. })));
        assert!(matches!(Table::new(vec![0.0], vec![[f64::NAN]]), Err(TableError::NotFinite { .. })));
    }
}
