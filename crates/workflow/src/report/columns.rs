//! Records over time as one array for each of their numbers.

use percute_core::dynamics::Balance;
use percute_estimator::{Sample, Sources};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// A number of a record, with its name.
pub type Named<R> = (&'static str, fn(&R) -> f64);

/// The parts of η over time.
pub const PARTS: [Named<Sample>; 7] = [
    ("time", |s| s.time),
    ("kinetic", |s| s.parts.kinetic),
    ("elastic", |s| s.parts.elastic),
    ("dissipation", |s| s.parts.dissipation),
    ("contact", |s| s.parts.contact),
    ("total", |s| s.parts.total()),
    ("reference", |s| s.reference),
];

/// The sources of η over time.
pub const SOURCES: [Named<Sources>; 4] =
    [("surface", |s| s.surface), ("front", |s| s.front), ("dispersion", |s| s.dispersion), ("mesh", |s| s.mesh)];

/// Energies and works.
pub const ENERGIES: [Named<Balance>; 7] = [
    ("kinetic", |b| b.kinetic),
    ("strain", |b| b.strain),
    ("plastic_work", |b| b.plastic_work),
    ("work_of_loads", |b| b.work_of_loads),
    ("work_of_supports", |b| b.work_of_supports),
    ("work_of_contact", |b| b.work_of_contact),
    ("friction", |b| b.friction),
];

/// Energies and works at the instants (s).
#[derive(Clone, Debug, Serialize)]
pub struct EnergiesOverTime {
    time: Vec<f64>,
    #[serde(flatten)]
    energies: Columns<Balance, 7>,
}

impl EnergiesOverTime {
    /// Those of the instants that were reached.
    pub(super) fn new(instants: &[f64], balances: &[Balance]) -> Self {
        let time = instants.iter().take(balances.len()).copied().collect();
        Self { time, energies: Columns::new(balances.to_vec(), ENERGIES) }
    }

    /// Number of steps between them.
    pub(super) fn steps(&self) -> usize {
        self.time.len().saturating_sub(1)
    }
}

/// Records, of which the named numbers are serialised, each as an array.
#[derive(Clone, Debug)]
pub struct Columns<R, const C: usize> {
    records: Vec<R>,
    numbers: [Named<R>; C],
}

/// One number of all records.
struct Column<'a, R>(&'a [R], fn(&R) -> f64);

impl<R, const C: usize> Columns<R, C> {
    pub(super) fn new(records: Vec<R>, numbers: [Named<R>; C]) -> Self {
        Self { records, numbers }
    }
}

impl<R, const C: usize> Serialize for Columns<R, C> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(C))?;
        for (name, number) in self.numbers {
            map.serialize_entry(name, &Column(&self.records, number))?;
        }
        map.end()
    }
}

impl<R> Serialize for Column<'_, R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(self.1))
    }
}
