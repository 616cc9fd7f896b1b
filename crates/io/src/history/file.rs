//! An open history file.

use super::PLASTIC;
use super::elsewhere::Elsewhere;
use super::rows::FIELDS;
use super::stored_part::ThinnedSteps;
use super::sums::{check_rows, compare, of_flags, of_vectors};
use crate::checksum::Checksum;
use crate::error::{FileCause, FileError};
use crate::mesh::vectors;
use crate::read::{Data, Opened, reading};
use crate::write::{Case, Provenance};
use percute_core::mesh::Mesh;
use percute_core::time::TimeGrid;
use percute_system::is_at;
use std::fs::File;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Detects another file under the same name. The file stays open, so its number is not reused.
#[derive(Debug)]
pub(super) struct Identity(File);

impl Identity {
    pub(super) fn of(path: &Path) -> Result<Self, FileCause> {
        let refused = |source: io::Error| match source.kind() {
            io::ErrorKind::NotFound => FileCause::Missing,
            _ => FileCause::Read { source },
        };
        // A pipe would wait for its writer.
        if !path.metadata().map_err(refused)?.is_file() {
            return Err(FileCause::NotAFile);
        }
        File::open(path).map(Self).map_err(refused)
    }

    fn is_still_at(&self, path: &Path) -> bool {
        is_at(&self.0, path)
    }
}

/// The contents read on opening.
#[derive(Debug)]
pub(super) struct FileContents {
    pub(super) path: PathBuf,
    pub(super) identity: Identity,
    pub(super) bytes: u64,
    pub(super) mesh: Arc<Mesh>,
    pub(super) statement: String,
    pub(super) case: Option<Case>,
    pub(super) provenance: Provenance,
    pub(super) elsewhere: Option<Elsewhere>,
    pub(super) initial_displacement: Vec<f64>,
    pub(super) initial_velocity: Vec<f64>,
    pub(super) times: TimeGrid,
    pub(super) count: usize,
    pub(super) complete: bool,
    pub(super) contact_nodes: Vec<usize>,
    pub(super) supplied: [bool; 2],
    pub(super) supplied_contact: [bool; 2],
    pub(super) stored: [bool; 2],
    /// Internal variables of an element; 0 without any.
    pub(super) plastic: usize,
    pub(super) kept: Option<ThinnedSteps>,
    pub(super) lacks_reactions: bool,
    /// Whether each field at each instant has a checksum.
    pub(super) checksums: bool,
}

/// A history in a file. Steps are read on demand, and the file is open only during reading.
#[derive(Clone, Debug)]
pub struct HistoryFile {
    pub(super) contents: Arc<FileContents>,
}

/// The place of an array in the file, for mapping into memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NativeArray {
    /// `displacement`, `velocity`, `acceleration`, `reaction` (64-bit floating point), `touching` (bytes) or, of files
    /// with checksums, `checksums` (64-bit integers).
    pub name: &'static str,
    /// Its shape: (instants, nodes, 3) for nodal fields, (instants, contact nodes, dimension) for reactions,
    /// (instants, contact nodes) for touching, (instants, fields) for checksums.
    pub shape: Vec<usize>,
    /// Byte offset of its first number; `None` if the array is not contiguous or has other number types.
    pub offset: Option<u64>,
}

impl HistoryFile {
    pub(super) fn new(contents: FileContents) -> Self {
        Self { contents: Arc::new(contents) }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.contents.path
    }

    /// Its size when it was opened (bytes).
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.contents.bytes
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.contents.mesh
    }

    /// 1 for bars, 2 for plane bodies.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.mesh().dimension()
    }

    /// The problem in the language of the case files; mesh, initial fields and times are not in it.
    #[must_use]
    pub fn statement(&self) -> &str {
        &self.contents.statement
    }

    /// The case file as given.
    #[must_use]
    pub fn case(&self) -> Option<&Case> {
        self.contents.case.as_ref()
    }

    /// Its writer.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.contents.provenance
    }

    /// Whether another program than percute has simulated it.
    #[must_use]
    pub fn is_foreign(&self) -> bool {
        !self.provenance().is_percute() || self.contents.elsewhere.is_some()
    }

    /// The other program that has simulated it, if its name is known.
    #[must_use]
    pub fn simulated_by(&self) -> Option<&str> {
        let writer = &self.provenance().program;
        let program = self.contents.elsewhere.as_ref().map_or(writer, |elsewhere| &elsewhere.program);
        Some(program.as_str()).filter(|program| self.is_foreign() && !program.is_empty())
    }

    /// Names of the parts that were derived before it was stored.
    #[must_use]
    pub fn derived(&self) -> &[String] {
        self.contents.elsewhere.as_ref().map_or(&[], |elsewhere| &elsewhere.derived)
    }

    /// Whether its numbers are compared with checksums when they are read. Those of other programs have none.
    #[must_use]
    pub fn has_checksums(&self) -> bool {
        self.contents.checksums
    }

    /// u₀ at the nodes (m): step 0, unless the file has that of the problem.
    #[must_use]
    pub fn initial_displacement(&self) -> &[f64] {
        let FileContents { elsewhere, initial_displacement, .. } = &*self.contents;
        elsewhere.as_ref().map_or(initial_displacement, |elsewhere| &elsewhere.initial_displacement)
    }

    /// v₀ at the nodes (m/s).
    #[must_use]
    pub fn initial_velocity(&self) -> &[f64] {
        &self.contents.initial_velocity
    }

    /// All planned instants of the run (s).
    #[must_use]
    pub fn times(&self) -> &TimeGrid {
        &self.contents.times
    }

    /// Number of whole instants that were in the file when it was opened, at most N + 1.
    #[must_use]
    pub fn count(&self) -> usize {
        self.contents.count
    }

    /// Whether the file is final: the run has ended, or was stopped cleanly.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.contents.complete
    }

    /// Nodes of the rows of reactions and touching status.
    #[must_use]
    pub fn contact_nodes(&self) -> &[usize] {
        &self.contents.contact_nodes
    }

    /// Whether the file has its own velocities and accelerations.
    #[must_use]
    pub fn supplied(&self) -> [bool; 2] {
        self.contents.supplied
    }

    /// Whether the file has contact forces and touching status.
    #[must_use]
    pub fn supplied_contact(&self) -> [bool; 2] {
        self.contents.supplied_contact
    }

    /// u_n at the nodes (m), in rows, step after step.
    ///
    /// # Errors
    /// Steps outside the file, or a file that can no longer be read.
    pub fn displacement(&self, steps: Range<usize>) -> Result<Vec<f64>, FileError> {
        Ok(self.nodal("displacement", steps)?.unwrap_or_default())
    }

    /// v_n at the nodes (m/s), if the file has it.
    ///
    /// # Errors
    /// As for [`HistoryFile::displacement`].
    pub fn velocity(&self, steps: Range<usize>) -> Result<Option<Vec<f64>>, FileError> {
        self.nodal("velocity", steps)
    }

    /// a_n at the nodes (m/s²), if the file has it.
    ///
    /// # Errors
    /// As for [`HistoryFile::displacement`].
    pub fn acceleration(&self, steps: Range<usize>) -> Result<Option<Vec<f64>>, FileError> {
        self.nodal("acceleration", steps)
    }

    fn nodal(&self, name: &str, steps: Range<usize>) -> Result<Option<Vec<f64>>, FileError> {
        let nodes = self.mesh().node_count();
        let rows = nodes * steps.start..nodes * steps.end;
        self.steps(steps.clone(), |opened| {
            let Some(data) = opened.root().group("VTKHDF")?.group("PointData")?.optional(name)? else {
                return Ok(None);
            };
            let values = vectors(&data, &data.float_rows(rows)?, self.dimension())?;
            self.check(opened, name, steps, &values, of_vectors)?;
            Ok(Some(values))
        })
    }

    /// Internal variables of an element: ε_p,xx, ε_p,yy, ε_p,xy and p, of bars ε_p and p; 0 where no material yields.
    #[must_use]
    pub fn variables(&self) -> usize {
        self.contents.plastic
    }

    /// The internal variables of the elements, in rows, step after step.
    ///
    /// # Errors
    /// As for [`HistoryFile::displacement`].
    pub fn plastic(&self, steps: Range<usize>) -> Result<Vec<f64>, FileError> {
        self.steps(steps.clone(), |opened| self.plastic_rows(opened, steps))
    }

    /// The same from the open file.
    pub(super) fn plastic_rows(&self, opened: &Opened, steps: Range<usize>) -> Result<Vec<f64>, FileCause> {
        if self.variables() == 0 {
            return Ok(Vec::new());
        }
        let elements = self.mesh().element_count();
        let data = opened.root().group("VTKHDF")?.group("CellData")?.data(PLASTIC)?;
        let values = data.float_rows(elements * steps.start..elements * steps.end)?;
        self.check(opened, PLASTIC, steps, &values, of_vectors)?;
        Ok(values)
    }

    /// R_n (N) on [`HistoryFile::contact_nodes`], in rows, step after step.
    ///
    /// # Errors
    /// As for [`HistoryFile::displacement`].
    pub fn reaction(&self, steps: Range<usize>) -> Result<Vec<f64>, FileError> {
        self.contact(steps, "reaction", |data, steps| data.float_rows(steps), of_vectors)
    }

    /// Touching status of [`HistoryFile::contact_nodes`], in rows, step after step.
    ///
    /// # Errors
    /// As for [`HistoryFile::displacement`].
    pub fn touching(&self, steps: Range<usize>) -> Result<Vec<bool>, FileError> {
        if !self.supplied_contact()[1] {
            let count = steps.len() * self.contact_nodes().len();
            return self.steps(steps, |_| Ok(vec![false; count]));
        }
        self.contact(steps, "touching", |data, steps| data.flag_rows(steps), of_flags)
    }

    fn contact<T>(
        &self,
        steps: Range<usize>,
        name: &str,
        read: impl FnOnce(&Data<'_>, Range<usize>) -> Result<Vec<T>, FileCause>,
        sum: impl Fn(&[T]) -> Checksum,
    ) -> Result<Vec<T>, FileError> {
        if self.contact_nodes().is_empty() {
            return self.steps(steps, |_| Ok(Vec::new()));
        }
        let rows = steps.clone();
        self.steps(steps, |opened| {
            let values = read(&opened.root().group("percute")?.group("contact")?.data(name)?, rows.clone())?;
            self.check(opened, name, rows, &values, sum)?;
            Ok(values)
        })
    }

    /// Compares numbers with their checksums, if there are any.
    pub(super) fn check<T>(
        &self,
        opened: &Opened,
        field: &str,
        steps: Range<usize>,
        values: &[T],
        sum: impl Fn(&[T]) -> Checksum,
    ) -> Result<(), FileCause> {
        if self.contents.checksums { check_rows(opened, field, steps, values, sum) } else { Ok(()) }
    }

    /// Compares nodal vectors at some instants, read by mapping [`HistoryFile::arrays`], with the rows of `checksums`
    /// there. Displacements have three components each.
    ///
    /// # Errors
    /// The first instant at which they differ.
    pub fn check_mapped(&self, field: &str, steps: &[usize], values: &[f64], sums: &[i64]) -> Result<(), FileError> {
        let rows = values.chunks_exact((values.len() / steps.len().max(1)).max(1));
        let padded = field == FIELDS[0];
        let sum = |row: &[f64]| match padded {
            true => of_vectors(
                &row.as_chunks::<3>().0.iter().flat_map(|v| &v[..self.dimension()]).copied().collect::<Vec<f64>>(),
            ),
            false => of_vectors(row),
        };
        self.compare(field, steps, rows.map(sum), sums)
    }

    /// The same of touching status.
    ///
    /// # Errors
    /// As for [`HistoryFile::check_mapped`].
    pub fn check_mapped_flags(&self, steps: &[usize], values: &[u8], sums: &[i64]) -> Result<(), FileError> {
        let rows = values.chunks_exact((values.len() / steps.len().max(1)).max(1));
        let sum = |row: &[u8]| Checksum::new().indices(row.iter().map(|&touches| touches.into()));
        self.compare("touching", steps, rows.map(sum), sums)
    }

    fn compare(
        &self,
        field: &str,
        steps: &[usize],
        found: impl Iterator<Item = Checksum>,
        sums: &[i64],
    ) -> Result<(), FileError> {
        compare(field, steps.iter().copied(), found, sums).map_err(|cause| cause.at(self.path()))
    }

    fn steps<T>(
        &self,
        steps: Range<usize>,
        read: impl FnOnce(&Opened) -> Result<T, FileCause>,
    ) -> Result<T, FileError> {
        self.again(|opened| {
            if steps.start > steps.end || steps.end > self.count() {
                let step = steps.end.saturating_sub(1);
                let detail = format!("step {step} is not in the file, which holds {} instants", self.count());
                return Err(FileCause::Value { name: super::DISPLACEMENT.to_string(), detail });
            }
            read(opened)
        })
    }

    /// Opens the file again; a replacement is an error.
    pub(super) fn again<T>(&self, read: impl FnOnce(&Opened) -> Result<T, FileCause>) -> Result<T, FileError> {
        let path = self.path();
        reading(path, |opened| {
            if !self.contents.identity.is_still_at(path) {
                return Err(FileCause::Replaced);
            }
            read(opened)
        })
    }

    /// Places of the arrays over time in the file.
    ///
    /// # Errors
    /// A file that can no longer be read.
    pub fn arrays(&self) -> Result<Vec<NativeArray>, FileError> {
        let (instants, nodes) = (self.times().instants().len(), self.mesh().node_count());
        self.again(|opened| {
            let mut arrays = Vec::new();
            if self.has_checksums() {
                let data = opened.root().group("percute")?.data("checksums")?;
                let offset = data.native_offset::<i64>()?;
                arrays.push(NativeArray { name: "checksums", shape: data.shape, offset });
            }
            let fields = opened.root().group("VTKHDF")?.group("PointData")?;
            for name in ["displacement", "velocity", "acceleration"] {
                if let Some(data) = fields.optional(name)? {
                    arrays.push(NativeArray {
                        name,
                        shape: vec![instants, nodes, 3],
                        offset: data.native_offset::<f64>()?,
                    });
                }
            }
            if let Some(contact) = opened.root().group("percute")?.optional_group("contact")? {
                let supplied = ["reaction", "touching"].into_iter().zip(self.supplied_contact());
                for (name, _) in supplied.filter(|(_, supplied)| *supplied) {
                    let data = contact.data(name)?;
                    let offset =
                        if name == "reaction" { data.native_offset::<f64>()? } else { data.native_offset::<u8>()? };
                    arrays.push(NativeArray { name, shape: data.shape, offset });
                }
            }
            Ok(arrays)
        })
    }
}
