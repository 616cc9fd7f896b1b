//! A history file before its run: its size and its parts.

use super::PLASTIC;
use super::checkpoints;
use super::elsewhere::Elsewhere;
use super::native::write_vectors;
use super::rows::{Places, sums_at_an_instant};
use super::stored_part::StoredPart;
use super::sums::fixed_part;
use super::writer::{Begun, Target, Writer};
use crate::create::{Overwrite, Unnamed};
use crate::error::{FileCause, FileError};
use crate::kind::Kind;
use crate::mesh::{bytes_of_bodies, write_bodies, write_grid, write_groups};
use crate::steps::{StepField, write_steps};
use crate::write::{Case, Texts, attribute, group, numbers, offset, ours, room, statement, unit};
use hdf5::Group;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use std::path::Path;

/// Overhead of the library beside the arrays and for each group of the mesh (bytes): measured, rounded up.
const LIBRARY: u64 = 16_700;
const PER_GROUP: u64 = 350;

/// A planned history file.
#[derive(Clone, Debug)]
pub struct Plan<'p> {
    problem: &'p AnyProblem,
    times: &'p TimeGrid,
    statement: String,
    case: Option<Case>,
    supplied: [bool; 2],
    kept: Option<StoredPart>,
    elsewhere: Option<Elsewhere>,
}

impl<'p> Plan<'p> {
    /// A file for the history of a problem over these instants. `statement` is the problem in the
    /// language of the case files; `case` is the case file as given.
    #[must_use]
    pub fn new(problem: &'p AnyProblem, times: &'p TimeGrid, statement: &str, case: Option<&Case>) -> Self {
        let (statement, case) = (statement.to_string(), case.cloned());
        Self { problem, times, statement, case, supplied: [false; 2], kept: None, elsewhere: None }
    }

    /// Whether the steps have their own velocities and accelerations.
    #[must_use]
    pub fn with_supplied(self, velocity: bool, acceleration: bool) -> Self {
        Self { supplied: [velocity, acceleration], ..self }
    }

    /// For a history that another program has simulated.
    #[must_use]
    pub fn simulated_elsewhere(self, elsewhere: Option<Elsewhere>) -> Self {
        Self { elsewhere, ..self }
    }

    /// Steps of a run that may go on; none of a history that is there already.
    fn steps_to_go_on(&self) -> usize {
        if self.elsewhere.is_some() { 0 } else { self.times.step_count() }
    }

    /// Keeps a part of the run only.
    #[must_use]
    pub fn keeping(self, kept: Option<StoredPart>) -> Self {
        let supplied = kept.as_ref().map_or(self.supplied, |kept| [kept.velocity, kept.acceleration]);
        Self { supplied, kept, ..self }
    }

    /// Whether the file has reactions and touching status.
    fn has_contact(&self) -> bool {
        !self.problem.contact_nodes().is_empty() && self.kept.as_ref().is_none_or(|kept| kept.reaction)
    }

    /// Nodes with reactions and touching status in the file.
    fn contact_nodes(&self) -> usize {
        if self.has_contact() { self.problem.contact_nodes().len() } else { 0 }
    }

    /// Whether the file lacks steps or reactions.
    fn is_thinned(&self) -> bool {
        let lacks = |kept: &StoredPart| kept.steps.len() <= self.times.step_count() || !kept.reaction;
        self.kept.as_ref().is_some_and(lacks)
    }

    /// Size of the file (bytes), exact up to a few kB of the HDF5 library.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let mesh = self.problem.mesh();
        let (nodes, cells, instants) = (mesh.node_count() as u64, mesh.element_count() as u64, self.instants() as u64);
        let (d, contact) = (mesh.dimension() as u64, self.contact_nodes() as u64);
        let grid = 24 * nodes + 8 * (d + 1) * cells + 8 * (cells + 1) + cells;
        let steps = 8 * (7 + self.vectors() + sums_at_an_instant(self.internal() > 0) as u64);
        let faces: u64 = mesh.face_groups().values().map(|members| 8 * d * members.len() as u64).sum();
        let elements: u64 = mesh.element_groups().values().map(|members| 8 * members.len() as u64).sum();
        let run = if self.is_thinned() { 8 * (instants + self.times.instants().len() as u64) } else { 0 };
        let groups = PER_GROUP * (mesh.face_groups().len() + mesh.element_groups().len()) as u64;
        let texts = self.statement.len() + self.case.as_ref().map_or(0, |case| case.name.len() + case.text.len());
        let elsewhere = self
            .elsewhere
            .as_ref()
            .map_or(0, |origin| 8 * d * nodes + (origin.program.len() + origin.derived().len()) as u64 + 3 * PER_GROUP);
        let checkpoints =
            checkpoints::size(self.steps_to_go_on(), [mesh.node_count(), mesh.dimension(), self.internal()]);
        let fixed = grid
            + faces
            + elements
            + groups
            + 8 * d * nodes
            + 8 * contact
            + texts as u64
            + elsewhere
            + run
            + checkpoints
            + bytes_of_bodies(mesh, self.instants())
            + LIBRARY;
        instants.saturating_mul(self.row() + steps).saturating_add(fixed)
    }

    /// Size of the fields at an instant (bytes).
    fn row(&self) -> u64 {
        let nodes = self.problem.mesh().node_count() as u64;
        let contact = self.contact_nodes() as u64 * (8 * self.problem.dimension() as u64 + 1);
        24 * nodes * self.vectors() + contact + 8 * self.internal() as u64
    }

    /// Number of internal variables of all elements.
    fn internal(&self) -> usize {
        self.problem.variables() * self.problem.mesh().element_count()
    }

    /// Number of nodal vector fields.
    fn vectors(&self) -> u64 {
        1 + self.supplied.iter().filter(|supplied| **supplied).count() as u64
    }

    fn instants(&self) -> usize {
        self.kept.as_ref().map_or(self.times.step_count() + 1, |kept| kept.steps.len())
    }

    /// The instants in the file (s).
    fn stored_times(&self) -> Vec<f64> {
        let all = self.times.instants();
        self.kept.as_ref().map_or_else(|| all.to_vec(), |kept| kept.steps.iter().map(|&n| all[n]).collect())
    }

    /// Creates the file, with space for all steps and the initial displacement, and its writing thread.
    ///
    /// # Errors
    /// An existing file (or one in use, if it is to be replaced), a folder that is missing or not writable,
    /// a disk without enough space. No file is left then.
    pub fn create(&self, path: impl AsRef<Path>, overwrite: Overwrite) -> Result<Writer, FileError> {
        let path = path.as_ref();
        let named = self.unnamed(path, overwrite, self.bytes()).and_then(|(unnamed, places)| {
            unnamed.reserve()?;
            let path = unnamed.path().to_path_buf();
            self.writer(Target::Named(unnamed.put()?, path), places)
        });
        named.map_err(|cause| cause.at(path))
    }

    /// The same for a history that is there already, with its first `count` instants: the file has its name, and
    /// replaces another one, once it is complete. Without [`Writer::finish`], nothing is left of it. Instants that a
    /// stopped run never reached take no room.
    ///
    /// # Errors
    /// As for [`Plan::create`].
    pub fn create_whole(
        &self,
        path: impl AsRef<Path>,
        overwrite: Overwrite,
        count: usize,
    ) -> Result<Writer, FileError> {
        let path = path.as_ref();
        let unwritten = self.instants().saturating_sub(count) as u64;
        let unnamed = self.unnamed(path, overwrite, self.bytes().saturating_sub(unwritten.saturating_mul(self.row())));
        let writer = unnamed.and_then(|(unnamed, places)| self.writer(Target::Unnamed(unnamed), places));
        writer.map_err(|cause| cause.at(path))
    }

    /// Creates the file without its name; `bytes` is the room that it will take.
    fn unnamed(&self, path: &Path, overwrite: Overwrite, bytes: u64) -> Result<(Unnamed, Places), FileCause> {
        let (unnamed, places) = Unnamed::new(path, overwrite, bytes, |file, texts| self.fill(file, texts))?;
        let start = write_vectors(
            unnamed.file(),
            places.displacement,
            self.problem.initial_displacement(),
            self.problem.dimension(),
        );
        start.map_err(|source| unnamed.unwritten(source))?;
        Ok((unnamed, places))
    }

    fn writer(&self, target: Target, places: Places) -> Result<Writer, FileCause> {
        let begun = Begun {
            last: self.times.step_count(),
            next: 0,
            stored: 0,
            supplied: self.supplied,
            kept: self.kept.clone(),
        };
        Writer::new(target, places, begun).map_err(|source| FileCause::Create { source })
    }

    fn fill(&self, file: &Group, texts: &mut Texts) -> Result<Places, FileCause> {
        let mesh = self.problem.mesh();
        let vtk = write_grid(file, mesh)?;
        let ours = ours(file, Kind::History, mesh.dimension())?;
        statement(&ours, texts, &self.statement, self.case.as_ref())?;
        write_groups(&ours, mesh)?;
        let (elsewhere, dimension) = (self.elsewhere.as_ref(), mesh.dimension());
        elsewhere.map_or(Ok(()), |elsewhere| elsewhere.write(&ours, texts, dimension))?;
        let velocity = self.problem.initial_velocity();
        unit(&numbers(&ours, "initial_velocity", &[mesh.node_count(), dimension], velocity)?, "m/s")?;
        let surface = if self.has_contact() { self.problem.contact_nodes() } else { &[] };
        let nodes = surface.iter().map(|contact| contact.node.index());
        let run = if self.is_thinned() { self.times.instants() } else { &[] };
        let texts = (self.statement.as_str(), self.case.as_ref(), elsewhere);
        let sum = fixed_part(mesh, velocity, texts, [&self.stored_times(), run], nodes);
        numbers(&ours, "checksum", &[], &[sum])?;
        let checksums = room::<i64>(&ours, "checksums", &[self.instants(), sums_at_an_instant(self.internal() > 0)])?;
        let fields = [mesh.node_count(), dimension, self.internal()];
        let checkpoints = checkpoints::make_room(&ours, self.steps_to_go_on(), fields)?;
        let steps_written = numbers(&ours, "steps_written", &[], &[0_i64])?;
        let complete = numbers(&ours, "complete", &[], &[0_u8])?;
        let instants = &self.stored_times();
        unit(&numbers(&ours, "times", &[instants.len()], instants)?, "s")?;
        self.run(&ours)?;
        let (reaction, touching) = self.contact(&ours)?;
        let (places, names) = self.nodal(&vtk)?;
        let (plastic, mut cells) = (self.plastic(&vtk)?, self.bodies(&vtk)?.into_iter().collect::<Vec<_>>());
        cells.extend(plastic.map(|_| (PLASTIC, mesh.element_count())));
        write_steps(&vtk, instants, &names, &cells)?;
        Ok(Places {
            displacement: places[0].unwrap_or_default(),
            velocity: places[1],
            acceleration: places[2],
            reaction,
            touching,
            plastic: plastic.map(|place| (place, self.internal())),
            steps_written: offset(&steps_written)?,
            complete: offset(&complete)?,
            checksums: offset(&checksums)?,
            checkpoints,
            dimension,
            nodes: mesh.node_count(),
            contact_nodes: self.problem.contact_nodes().len(),
            has_contact: self.has_contact(),
            had: 0,
        })
    }

    /// Room for displacement, velocity and acceleration: their places, and the names of those that are there with
    /// their rows at an instant.
    fn nodal(&self, vtk: &Group) -> Result<([Option<u64>; 3], Vec<StepField<'static>>), FileCause> {
        let (nodes, [velocity, acceleration]) = (self.problem.mesh().node_count(), self.supplied);
        let fields =
            [("displacement", "m", true), ("velocity", "m/s", velocity), ("acceleration", "m/s2", acceleration)];
        let (data, mut names, mut places) = (group(vtk, "PointData")?, Vec::new(), [None; 3]);
        for (place, (name, of, _)) in places.iter_mut().zip(fields).filter(|(_, (_, _, there))| *there) {
            let set = room::<f64>(&data, name, &[self.instants() * nodes, 3])?;
            unit(&set, of)?;
            *place = Some(offset(&set)?);
            names.push((name, nodes));
        }
        Ok((places, names))
    }

    /// The numbers of the bodies of the elements, of several bodies.
    fn bodies(&self, vtk: &Group) -> Result<Option<(&'static str, usize)>, FileCause> {
        let mesh = self.problem.mesh();
        if mesh.parts() > 1 { write_bodies(&cell_data(vtk)?, mesh) } else { Ok(None) }
    }

    /// Room for the internal variables of the elements, if there are any, and its place.
    fn plastic(&self, vtk: &Group) -> Result<Option<u64>, FileCause> {
        if self.internal() == 0 {
            return Ok(None);
        }
        let rows = self.instants() * self.problem.mesh().element_count();
        let set = room::<f64>(&cell_data(vtk)?, PLASTIC, &[rows, self.problem.variables()])?;
        unit(&set, "1")?;
        Ok(Some(offset(&set)?))
    }

    /// The steps of a thinned history in its run; and whether motion comes from the scheme, as it does if any is kept.
    fn run(&self, ours: &Group) -> Result<(), FileCause> {
        let Some(kept) = &self.kept else { return Ok(()) };
        attribute(ours, "by_scheme", 1_u8)?;
        if !kept.reaction && !self.problem.contact_nodes().is_empty() {
            attribute(ours, "without_reactions", 1_u8)?;
        }
        if self.is_thinned() {
            let steps: Vec<i64> = kept.steps.iter().map(|n| *n as i64).collect();
            numbers(ours, "steps", &[steps.len()], &steps)?;
            let times = self.times.instants();
            unit(&numbers(ours, "run_times", &[times.len()], times)?, "s")?;
        }
        Ok(())
    }

    /// Contact data, if any node can touch, and the place of their rows.
    fn contact(&self, ours: &Group) -> Result<(u64, u64), FileCause> {
        let surface = self.problem.contact_nodes();
        if !self.has_contact() {
            return Ok((0, 0));
        }
        let contact = group(ours, "contact")?;
        let nodes: Vec<i64> = surface.iter().map(|c| c.node.index() as i64).collect();
        numbers(&contact, "nodes", &[nodes.len()], &nodes)?;
        let (instants, count) = (self.instants(), nodes.len());
        let reaction = room::<f64>(&contact, "reaction", &[instants, count, self.problem.dimension()])?;
        unit(&reaction, self.problem.units().of("N"))?;
        let touching = room::<u8>(&contact, "touching", &[instants, count])?;
        Ok((offset(&reaction)?, offset(&touching)?))
    }
}

/// The group of the fields of elements.
fn cell_data(vtk: &Group) -> Result<Group, FileCause> {
    if vtk.link_exists("CellData") {
        return vtk.group("CellData").map_err(|error| crate::library::refused(&error));
    }
    group(vtk, "CellData")
}
