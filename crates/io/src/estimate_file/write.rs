//! Writes an estimate, completely or not at all.

use super::contact;
use super::sums::{seal_names, seal_numbers, seal_text};
use crate::create::{Overwrite, Unnamed};
use crate::error::{FileCause, FileError};
use crate::kind::Kind;
use crate::library::refused;
use crate::mesh::{bytes_of_bodies, in_space, write_bodies, write_grid, write_groups};
use crate::steps::{give_steps, note_steps, write_steps};
use crate::write::{Case, Texts, attribute, group, numbers, ours, statement, unit};
use hdf5::Group;
use percute_core::contact_results::{ContactResults, ContactSteps};
use percute_core::problem::AnyProblem;
use percute_estimator::{AdmissibleFields, ElementMap, Estimate, Sample};
use std::path::Path;

/// Overhead of the library beside the arrays and for each group of the mesh (bytes), with a margin.
const LIBRARY: u64 = 32_000;
const PER_GROUP: u64 = 450;

/// The contents of a new estimate file.
#[derive(Clone, Copy, Debug)]
pub struct EstimateContents<'a> {
    /// The problem.
    pub problem: &'a AnyProblem,
    /// Its estimate.
    pub estimate: &'a Estimate,
    /// Contact results with all nodes at all instants; left out without these.
    pub contact: Option<&'a ContactResults>,
    /// The problem in the language of the case files.
    pub statement: &'a str,
    /// The case file as given.
    pub case: Option<&'a Case>,
    /// The document that `--json` prints.
    pub report: &'a str,
}

/// Writes an estimate of a problem: its maps as VTKHDF, the errors over time, the residuals, the contact results, and
/// the report.
///
/// # Errors
/// As for the creation of a history; an estimate of another mesh.
pub fn write(path: impl AsRef<Path>, overwrite: Overwrite, contents: &EstimateContents<'_>) -> Result<(), FileError> {
    let path = path.as_ref();
    let written = contents.check().and_then(|()| {
        let (unnamed, ()) = Unnamed::new(path, overwrite, contents.bytes(), |file, texts| contents.fill(file, texts))?;
        unnamed.reserve()?;
        unnamed.sync()?;
        unnamed.put().map(drop)
    });
    written.map_err(|cause| cause.at(path))
}

/// The numbers of one field in a map.
type Take<'a> = Box<dyn Fn(&ElementMap) -> Vec<f64> + 'a>;
/// Name, unit, numbers for each node or element, and their source.
type WrittenField<'a> = (&'static str, &'static str, usize, Take<'a>);

impl EstimateContents<'_> {
    fn check(&self) -> Result<(), FileCause> {
        let (given, needed) = (self.problem.mesh().element_count(), self.estimate.by_element.len());
        if given != needed {
            return Err(FileCause::Problem { what: "elements", given, needed });
        }
        let Some((contact, _)) = self.contact() else { return Ok(()) };
        let (given, needed) = (self.problem.contact_nodes().len(), contact.nodes.len());
        if given != needed {
            return Err(FileCause::Problem { what: "contact nodes", given, needed });
        }
        let (given, needed) = (contact.instants.len(), self.estimate.steps + 1);
        // A stop leaves the last steps out of the estimate alone.
        if given >= needed { Ok(()) } else { Err(FileCause::Problem { what: "instants", given, needed }) }
    }

    fn has_fields(&self) -> bool {
        !self.estimate.maps.is_empty() && self.estimate.maps.iter().all(|map| map.fields.is_some())
    }

    /// Contact results, if there are planes and all results are stored.
    fn contact(&self) -> Option<(&ContactResults, &ContactSteps)> {
        let results = self.contact.filter(|results| !results.obstacles.is_empty())?;
        Some((results, results.steps.as_ref()?))
    }

    fn bytes(&self) -> u64 {
        let mesh = self.problem.mesh();
        let (nodes, cells, instants) = (mesh.node_count(), mesh.element_count(), self.estimate.maps.len());
        let d = mesh.dimension();
        let fields = if self.has_fields() { 48 * nodes + (16 * d * d + 24) * cells } else { 0 };
        let grid = 24 * nodes + 8 * (d + 1) * cells + 8 * (cells + 1) + 9 * cells;
        let texts =
            self.statement.len() + self.report.len() + self.case.map_or(0, |case| case.name.len() + case.text.len());
        let faces: usize = mesh.face_groups().values().map(|members| 8 * d * members.len()).sum();
        let elements: usize = mesh.element_groups().values().map(|members| 8 * members.len()).sum();
        let groups = (mesh.face_groups().len() + mesh.element_groups().len()) as u64;
        let contact = self.contact().map_or(0, |(results, _)| contact::bytes(results, instants, nodes));
        let arrays = grid + faces + elements + texts + contact + 48 * self.estimate.over_time.len();
        let maps = instants as u64 * (40 * cells + fields + 136) as u64;
        maps + arrays as u64 + LIBRARY + PER_GROUP * groups + bytes_of_bodies(mesh, instants)
    }

    fn fill(&self, file: &Group, texts: &mut Texts) -> Result<(), FileCause> {
        let mesh = self.problem.mesh();
        let vtk = write_grid(file, mesh)?;
        self.maps(&vtk)?;
        let ours = ours(file, Kind::Estimate, mesh.dimension())?;
        statement(&ours, texts, self.statement, self.case)?;
        texts.add(&ours, "report", self.report)?;
        write_groups(&ours, mesh)?;
        self.over_time(&ours)?;
        self.measures(&ours)?;
        if let Some((results, steps)) = self.contact() {
            contact::write(&ours, results, steps, self.problem.units())?;
        }
        let residuals = group(&ours, "residuals")?;
        for (name, value) in self.estimate.residuals.entries() {
            numbers(&residuals, name, &[], &[value])?;
        }
        self.seal(file, &ours)
    }

    /// Adds the checksums of all data sets, and of the names in the groups of percute.
    fn seal(&self, file: &Group, ours: &Group) -> Result<(), FileCause> {
        seal_numbers(file)?;
        seal_names(ours)?;
        let case = self.case.map(|case| [("case", &case.text), ("case_name", &case.name)]);
        let case = case.iter().flatten().map(|(name, text)| (*name, text.as_str()));
        let mut texts = [("problem", self.statement), ("report", self.report)].into_iter().chain(case);
        texts.try_for_each(|(name, text)| seal_text(ours, name, text))
    }

    /// Fields over the instants of the maps, and e_E, which is constant.
    fn maps(&self, vtk: &Group) -> Result<(), FileCause> {
        let maps = &self.estimate.maps;
        let mesh = self.problem.mesh();
        let (nodes, cells) = (mesh.node_count(), mesh.element_count());
        let data = group(vtk, "CellData")?;
        unit(&numbers(&data, "by_element", &[cells], &self.estimate.by_element)?, self.problem.units().of("J^(1/2)"))?;
        let bodies = write_bodies(&data, mesh)?;
        if maps.is_empty() {
            return Ok(());
        }
        let mut cell_offsets: Vec<_> = std::iter::once(("by_element", 0)).chain(bodies).collect();
        self.fields(&data, cells, self.cell_fields(), &mut cell_offsets)?;
        let mut point_offsets = Vec::new();
        if self.has_fields() || self.contact().is_some() {
            let data = group(vtk, "PointData")?;
            if self.has_fields() {
                self.fields(&data, nodes, point_fields(mesh.dimension()), &mut point_offsets)?;
            }
            if let Some(contact) = self.contact() {
                let steps: Vec<usize> = maps.iter().map(|map| map.step).collect();
                let names = contact::write_fields(&data, contact, (nodes, self.problem.units()), &steps)?;
                point_offsets.extend(names.into_iter().map(|name| (name, nodes)));
            }
        }
        let instants: Vec<f64> = maps.iter().map(|map| map.time).collect();
        write_steps(vtk, &instants, &point_offsets, &cell_offsets)?;
        give_steps(vtk, &instants).and_then(|()| note_steps(vtk, instants.len())).map_err(|error| refused(&error))
    }

    fn fields(
        &self,
        data: &Group,
        rows: usize,
        fields: Vec<WrittenField<'_>>,
        offsets: &mut Vec<(&'static str, usize)>,
    ) -> Result<(), FileCause> {
        for (name, of, components, take) in fields {
            let values: Vec<f64> = self.estimate.maps.iter().flat_map(&take).collect();
            let count = rows * self.estimate.maps.len();
            let shape = if components == 1 { vec![count] } else { vec![count, components] };
            unit(&numbers(data, name, &shape, &values)?, self.problem.units().of(of))?;
            offsets.push((name, rows));
        }
        Ok(())
    }

    fn cell_fields(&self) -> Vec<WrittenField<'_>> {
        let end = self.estimate.end;
        let mut fields: Vec<WrittenField<'_>> = vec![
            ("kinetic", "J", 1, Box::new(|map| map.kinetic.clone())),
            ("elastic", "J", 1, Box::new(|map| map.elastic.clone())),
            ("dissipation", "J", 1, Box::new(|map| map.dissipation.clone())),
            ("contact", "J", 1, Box::new(|map| map.contact.clone())),
            ("total", "J", 1, Box::new(ElementMap::total)),
            ("accumulated", "J^(1/2)", 1, Box::new(move |map| map.error(end))),
        ];
        if self.has_fields() {
            let d = self.problem.dimension();
            fields.push(("admissible_stress", "Pa", d * d, of_fields(|f| f.stress.clone())));
            fields.push(("compatible_stress", "Pa", d * d, of_fields(|f| f.compatible_stress.clone())));
            fields.push(("admissible_acceleration", "m/s2", 3, of_fields(move |f| in_space(&f.acceleration, d))));
        }
        fields
    }

    fn over_time(&self, ours: &Group) -> Result<(), FileCause> {
        let group = group(ours, "over_time")?;
        let column = |take: fn(&Sample) -> f64| -> Vec<f64> { self.estimate.over_time.iter().map(take).collect() };
        let columns = [
            ("time", "s", column(|s| s.time)),
            ("kinetic", "J", column(|s| s.parts.kinetic)),
            ("elastic", "J", column(|s| s.parts.elastic)),
            ("dissipation", "J", column(|s| s.parts.dissipation)),
            ("contact", "J", column(|s| s.parts.contact)),
            ("total", "J", column(|s| s.parts.total())),
            ("reference", "J", column(|s| s.reference)),
        ];
        let units = self.problem.units();
        columns
            .iter()
            .try_for_each(|(name, of, values)| unit(&numbers(&group, name, &[values.len()], values)?, units.of(of)))
    }

    fn measures(&self, ours: &Group) -> Result<(), FileCause> {
        let group = group(ours, "measures")?;
        let Estimate { error: e, time_of_sup, end, impulse_ratio, supplied, steps, .. } = self.estimate;
        for (name, value) in e.entries() {
            attribute(&group, name, value)?;
        }
        for (name, value) in
            [("time_of_sup", Some(*time_of_sup)), ("end", Some(*end)), ("impulse_ratio", *impulse_ratio)]
        {
            if let Some(value) = value {
                attribute(&group, name, value)?;
            }
        }
        attribute(&group, "steps", *steps as i64)?;
        attribute(&group, "velocity_supplied", u8::from(supplied.velocity))?;
        attribute(&group, "acceleration_supplied", u8::from(supplied.acceleration))
    }
}

fn point_fields(d: usize) -> Vec<WrittenField<'static>> {
    vec![
        ("admissible_displacement", "m", 3, of_fields(move |f| in_space(&f.displacement, d))),
        ("admissible_velocity", "m/s", 3, of_fields(move |f| in_space(&f.velocity, d))),
    ]
}

fn of_fields(take: impl Fn(&AdmissibleFields) -> Vec<f64> + 'static) -> Take<'static> {
    Box::new(move |map| map.fields.as_ref().map(&take).unwrap_or_default())
}
