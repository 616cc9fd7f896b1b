//! Results as tables of comma-separated values (RFC 4180): over time, over elements, and over contact nodes.

use crate::failure::Failure;
use crate::outputs::{self, OutputFile};
use crate::report::{ENERGIES, PARTS};
use percute_core::border::Vector;
use percute_core::contact_results::{ContactResults, Resultant};
use percute_core::dynamics::Balance;
use percute_core::ids::ElementId;
use percute_core::mesh::Mesh;
use percute_core::units::Units;
use percute_estimator::Sample;
use percute_io::{Overwrite, write_bytes};
use std::path::{Path, PathBuf};

/// Names of the components.
const AXES: [&str; 3] = ["x", "y", "z"];

/// A table: columns of equal length.
#[derive(Clone, Debug, Default)]
pub struct ResultTable {
    units: Units,
    dimension: usize,
    columns: Vec<(String, Vec<f64>)>,
}

impl ResultTable {
    /// An empty one.
    fn new(units: Units, dimension: usize) -> Self {
        Self { units, dimension, columns: Vec::new() }
    }

    fn add(&mut self, name: &str, unit: &'static str, values: impl IntoIterator<Item = f64>) {
        let unit = self.units.of(unit);
        let header = if unit.is_empty() { name.to_string() } else { format!("{name} ({unit})") };
        self.columns.push((header, values.into_iter().collect()));
    }

    fn vector(&mut self, name: &str, unit: &'static str, values: &[Vector]) {
        (0..self.dimension).for_each(|c| self.add(&format!("{name}_{}", AXES[c]), unit, values.iter().map(|v| v[c])));
    }

    /// Adds its columns to another table, at other rows; empty where there is none.
    fn spread(self, at: &[Option<usize>], to: &mut Self) {
        for (name, values) in self.columns {
            to.columns.push((name, at.iter().map(|row| row.map_or(f64::NAN, |row| values[row])).collect()));
        }
    }

    /// The text: a header with units, then a line for each row. A number that is not known is empty.
    #[must_use]
    pub fn csv(&self) -> String {
        let rows = self.columns.first().map_or(0, |(_, values)| values.len());
        let header = self.columns.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>().join(",");
        let cell = |(name, values): &(String, Vec<f64>), n: usize| match values[n] {
            x if !x.is_finite() => String::new(),
            // Only counts and numbers of things have no unit.
            x if !name.ends_with(')') => format!("{x}"),
            x => format!("{x:?}"),
        };
        let row = |n: usize| self.columns.iter().map(|column| cell(column, n)).collect::<Vec<_>>().join(",");
        std::iter::once(header).chain((0..rows).map(row)).map(|line| line + "\r\n").collect()
    }
}

/// Results that can be tables; those that are not known are left out.
#[derive(Clone, Copy, Debug)]
pub struct TableResults<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Contact results.
    pub contact: Option<&'a ContactResults>,
    /// Units of forces and energies.
    pub units: Units,
    /// Energies and works at each step.
    pub balance: &'a [Balance],
    /// η and its parts at the samples.
    pub error: &'a [Sample],
    /// e_E of each element (J^½), eq. \[20\].
    pub by_element: &'a [f64],
}

impl TableResults<'_> {
    /// An empty table.
    fn table(&self) -> ResultTable {
        ResultTable::new(self.units, self.mesh.dimension())
    }

    /// Forces, energies and error over time: rows at the steps, and at the samples of the error between them.
    #[must_use]
    pub fn over_time(&self) -> ResultTable {
        let steps = self.contact.map_or(&[][..], |contact| &contact.instants);
        let mut rows: Vec<f64> = steps.iter().copied().chain(self.error.iter().map(|sample| sample.time)).collect();
        rows.sort_unstable_by(f64::total_cmp);
        rows.dedup();
        let mut table = self.table();
        table.add("time", "s", rows.iter().copied());
        let place = |times: &[f64], t: f64| times.binary_search_by(|other| other.total_cmp(&t)).ok();
        let at: Vec<Option<usize>> = rows.iter().map(|&t| place(steps, t)).collect();
        self.at_steps().spread(&at, &mut table);
        let mut at = vec![None; rows.len()];
        // Of two samples at an instant the second counts: it is that after the change.
        for (k, sample) in self.error.iter().enumerate() {
            at[place(&rows, sample.time).unwrap_or_default()] = Some(k);
        }
        self.at_samples().spread(&at, &mut table);
        table
    }

    /// Forces and energies.
    fn at_steps(&self) -> ResultTable {
        let mut table = self.table();
        if let Some(contact) = self.contact.filter(|contact| !contact.obstacles.is_empty()) {
            resultants(&mut table, "", &contact.total);
            if contact.obstacles.len() > 1 {
                for (k, plane) in contact.obstacles.iter().enumerate() {
                    resultants(&mut table, &format!("plane_{k}_"), plane);
                }
            }
        }
        if !self.balance.is_empty() {
            ENERGIES.iter().for_each(|(name, of)| table.add(name, "J", self.balance.iter().map(of)));
        }
        table
    }

    /// √η, its parts and d.
    fn at_samples(&self) -> ResultTable {
        let mut table = self.table();
        if !self.error.is_empty() {
            table.add("error", "J^(1/2)", self.error.iter().map(|sample| sample.parts.total().sqrt()));
            for (name, of) in PARTS.into_iter().filter(|(name, _)| *name != "time") {
                let name = if name == "reference" { name.to_string() } else { format!("error_{name}") };
                table.add(&name, "J", self.error.iter().map(of));
            }
        }
        table
    }

    /// Centroid and error of each element.
    #[must_use]
    pub fn elements(&self) -> ResultTable {
        let mut table = self.table();
        let count = self.mesh.element_count();
        table.add("element", "", (0..count).map(|e| e as f64));
        let centroids: Vec<Vector> = (0..count).map(|e| self.mesh.centroid(ElementId::new(e))).collect();
        table.vector("centroid", "m", &centroids);
        table.add("error", "J^(1/2)", self.by_element.iter().copied());
        table
    }

    /// Summary of each node of the contact surface.
    #[must_use]
    pub fn contact_nodes(&self) -> ResultTable {
        let mut table = self.table();
        let Some(contact) = self.contact else { return table };
        let (nodes, summary) = (&contact.nodes, &contact.summary);
        table.add("node", "", nodes.iter().map(|p| p.node.index() as f64));
        table.add("plane", "", nodes.iter().map(|p| p.obstacle as f64));
        table.vector("point", "m", &nodes.iter().map(|p| p.point).collect::<Vec<_>>());
        table.add("area", "m^2", nodes.iter().map(|p| p.area));
        table.add("first_touch", "s", summary.iter().map(|s| s.first_touch.unwrap_or(f64::NAN)));
        table.add("time_in_contact", "s", summary.iter().map(|s| s.time_in_contact));
        table.add("peak_normal_force", "N", summary.iter().map(|s| s.peak_normal_force));
        table.add("time_of_peak", "s", summary.iter().map(|s| s.time_of_peak.unwrap_or(f64::NAN)));
        table.add("peak_pressure", "Pa", summary.iter().map(|s| s.peak_pressure));
        table.vector("impulse", "N s", &summary.iter().map(|s| s.impulse).collect::<Vec<_>>());
        table.add("friction_energy", "J", summary.iter().map(|s| s.friction_energy));
        table
    }
}

fn resultants(table: &mut ResultTable, prefix: &str, over_time: &[Resultant]) {
    let name = |name: &str| format!("{prefix}{name}");
    table.vector(&name("force"), "N", &over_time.iter().map(|r| r.force).collect::<Vec<_>>());
    table.add(&name("normal_force"), "N", over_time.iter().map(|r| r.normal_force));
    table.vector(&name("impulse"), "N s", &over_time.iter().map(|r| r.impulse).collect::<Vec<_>>());
    table.add(&name("contact_area"), "m^2", over_time.iter().map(|r| r.area));
    table.add(&name("nodes_in_contact"), "", over_time.iter().map(|r| r.in_contact as f64));
    table.add(&name("nodes_slipping"), "", over_time.iter().map(|r| r.slipping as f64));
}

/// The place of tables: one file for that over time, or a folder for all.
#[derive(Clone, Debug)]
pub enum Destination {
    /// A file.
    File(PathBuf),
    /// A folder.
    Folder(PathBuf),
}

/// Files of a folder.
const OVER_TIME: &str = "over_time.csv";
const ELEMENTS: &str = "elements.csv";
const CONTACT_NODES: &str = "contact_nodes.csv";

impl Destination {
    /// The place of this name, and whether it can be written; `what` names the option.
    ///
    /// # Errors
    /// A name that ends neither in `.csv` nor is a folder; an existing file, unless `force` replaces it; an input; a
    /// folder that is missing or not writable.
    pub fn check(what: &'static str, path: &Path, inputs: &[(&str, &Path)], force: bool) -> Result<Self, Failure> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let found = match (path.is_dir(), ending.as_deref()) {
            (false, Some("csv")) => Self::File(path.to_path_buf()),
            (true, _) | (false, None) => Self::Folder(path.to_path_buf()),
            (false, Some(_)) => {
                let told = "tables have the ending .csv; give a name that ends in .csv, or a folder";
                return Err(Failure::Argument(format!("{what} {}: {told}", path.display())));
            }
        };
        let files = match &found {
            // A new folder holds no file; it is made when it is needed.
            Self::Folder(folder) if !folder.exists() => vec![folder.clone()],
            Self::Folder(folder) => [OVER_TIME, ELEMENTS, CONTACT_NODES].map(|name| folder.join(name)).to_vec(),
            Self::File(file) => vec![file.clone()],
        };
        let outputs: Vec<_> = files.iter().map(|file| Some(OutputFile { what, file })).collect();
        outputs::check(inputs, &outputs, force)?;
        Ok(found)
    }

    /// Writes the tables of some results; those without rows are left out.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, results: &TableResults<'_>, overwrite: Overwrite) -> Result<(), Failure> {
        let over_time = results.over_time();
        let folder = match self {
            Self::File(file) => return Ok(write_bytes(file, overwrite, over_time.csv().as_bytes())?),
            Self::Folder(folder) => folder,
        };
        std::fs::create_dir_all(folder)?;
        let mut tables = vec![(OVER_TIME, over_time)];
        if !results.by_element.is_empty() {
            tables.push((ELEMENTS, results.elements()));
        }
        if results.contact.is_some_and(|contact| !contact.nodes.is_empty()) {
            tables.push((CONTACT_NODES, results.contact_nodes()));
        }
        for (name, table) in tables {
            write_bytes(folder.join(name), overwrite, table.csv().as_bytes())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_header_with_units_and_empty_cells() {
        let mut table = ResultTable::new(Units::default(), 2);
        table.add("time", "s", [0.0, 1.5e-6]);
        table.vector("force", "N", &[[1.0, -2.0, 0.0], [f64::NAN, 1e16, 0.0]]);
        table.add("nodes", "", [0.0, 12.0]);
        assert_eq!(table.csv(), "time (s),force_x (N),force_y (N),nodes\r\n0.0,1.0,-2.0,0\r\n1.5e-6,,1e16,12\r\n");
    }
}
