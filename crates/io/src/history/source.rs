//! Steps from a file, as a source for the estimator.

use super::file::HistoryFile;
use super::sums::{of_flags, of_vectors};
use crate::error::{FileCause, FileError};
use crate::mesh::vectors;
use crate::read::{Opened, Part};
use percute_core::contact::ContactNode;
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;

/// Bytes of steps that are read at once: enough for the disk, little for memory.
const BLOCK: usize = 1 << 23;

/// Reads the steps of a history file, with contact data on the contact surface of the problem.
#[derive(Clone, Debug)]
pub struct HistorySource {
    file: HistoryFile,
    /// The row of each surface node in the file; a node that is not listed never touches.
    rows: Vec<Option<usize>>,
    /// Rows of nodes that cannot touch, with their nodes.
    strange: Vec<(usize, usize)>,
}

/// Some consecutive steps.
struct StepBlock {
    displacement: Vec<f64>,
    reaction: Vec<f64>,
    touching: Vec<bool>,
    motion: [Option<Vec<f64>>; 2],
    plastic: Vec<f64>,
}

impl HistoryFile {
    /// The first `count` steps in blocks that are read at once.
    pub(super) fn blocks(&self, count: usize) -> impl Iterator<Item = Range<usize>> {
        let internal = 8 * self.variables() * self.mesh().element_count();
        let step = 24 * self.mesh().node_count() + 16 * self.contact_nodes().len() + internal;
        let size = (BLOCK / step.max(1)).max(1);
        (0..count).step_by(size).map(move |start| start..count.min(start + size))
    }

    /// The steps for a problem that was built from this file.
    ///
    /// # Errors
    /// A problem on another mesh.
    pub fn source(&self, problem: &AnyProblem) -> Result<HistorySource, FileError> {
        let (given, needed) = (problem.mesh().node_count(), self.mesh().node_count());
        if given != needed {
            return Err(FileCause::Problem { what: "nodes", given, needed }.at(self.path()));
        }
        HistorySource::new(self.clone(), problem)
    }
}

impl HistorySource {
    fn new(file: HistoryFile, problem: &AnyProblem) -> Result<Self, FileError> {
        let mut rows_of: BTreeMap<usize, VecDeque<usize>> = BTreeMap::new();
        for (row, &node) in file.contact_nodes().iter().enumerate() {
            rows_of.entry(node).or_default().push_back(row);
        }
        // Rows of surface nodes are removed, those of a node at two planes in their order; the remaining nodes can
        // touch no obstacle.
        let take = |contact: &ContactNode| rows_of.get_mut(&contact.node.index())?.pop_front();
        let rows = problem.contact_nodes().iter().map(take).collect();
        let mut strange = Vec::new();
        for (node, left) in rows_of {
            let touches_one = problem.contact_nodes().iter().any(|contact| contact.node.index() == node);
            if left.len() > usize::from(!touches_one) {
                let (name, detail) = ("percute/contact/nodes".to_string(), format!("node {node} occurs in it twice"));
                return Err(FileCause::Value { name, detail }.at(file.path()));
            }
            strange.extend(left.into_iter().map(|row| (row, node)));
        }
        Ok(Self { file, rows, strange })
    }

    fn block(&self, steps: Range<usize>) -> Result<StepBlock, FileError> {
        let nodes = self.file.mesh().node_count();
        let rows = steps.start * nodes..steps.end * nodes;
        self.file.again(|opened| {
            self.check_counter(opened)?;
            let fields = opened.root().group("VTKHDF")?.group("PointData")?;
            let motion = [0, 1].map(|at| self.motion(&fields, at, rows.clone(), steps.start));
            let [velocity, acceleration] = motion;
            let displacement = fields.data("displacement")?;
            let displacement = vectors(&displacement, &displacement.float_rows(rows.clone())?, self.file.dimension())?;
            self.finite("VTKHDF/PointData/displacement", &displacement, steps.start, |at| at)?;
            self.file.check(opened, "displacement", steps.clone(), &displacement, of_vectors)?;
            let (reaction, touching) = self.contact(opened, steps.clone())?;
            let motion = [velocity?, acceleration?];
            for (name, values) in ["velocity", "acceleration"].into_iter().zip(&motion) {
                let Some(values) = values else { continue };
                self.file.check(opened, name, steps.clone(), values, of_vectors)?;
            }
            let plastic = self.file.plastic_rows(opened, steps)?;
            Ok(StepBlock { displacement, reaction, touching, motion, plastic })
        })
    }

    fn check_counter(&self, opened: &Opened) -> Result<(), FileCause> {
        let Some(counter) = opened.root().group("percute")?.optional("steps_written")? else { return Ok(()) };
        match counter.integers()?.as_slice() {
            [count] if *count >= self.file.count() as i64 => Ok(()),
            other => {
                let detail = format!("`{}` was {} and is {other:?} now", counter.name, self.file.count());
                Err(FileCause::Damaged { detail })
            }
        }
    }

    fn motion(
        &self,
        fields: &Part<'_>,
        which: usize,
        rows: Range<usize>,
        first: usize,
    ) -> Result<Option<Vec<f64>>, FileCause> {
        // Motion by the scheme is made again from all steps; a thinned history has no other.
        let there = if self.file.thinned_steps().is_some() { self.file.stored() } else { self.file.supplied() };
        if !there[which] {
            return Ok(None);
        }
        let data = fields.data(["velocity", "acceleration"][which])?;
        let values = vectors(&data, &data.float_rows(rows)?, self.file.dimension())?;
        self.finite(&data.name, &values, first, |at| at)?;
        Ok(Some(values))
    }

    /// Reactions and touching status on the surface of the problem.
    fn contact(&self, opened: &Opened, steps: Range<usize>) -> Result<(Vec<f64>, Vec<bool>), FileCause> {
        let (listed, d) = (self.file.contact_nodes(), self.file.dimension());
        let count = self.rows.len() * steps.len();
        if listed.is_empty() {
            return Ok((vec![0.0; d * count], vec![false; count]));
        }
        let contact = opened.root().group("percute")?.group("contact")?;
        let data = contact.data("reaction")?;
        let reaction = data.float_rows(steps.clone())?;
        let touching = match self.file.supplied_contact()[1] {
            true => contact.data("touching")?.flag_rows(steps.clone())?,
            false => vec![false; reaction.len() / d],
        };
        self.finite(&data.name, &reaction, steps.start, |row| listed[row])?;
        self.file.check(opened, "reaction", steps.clone(), &reaction, of_vectors)?;
        self.file.check(opened, "touching", steps.clone(), &touching, of_flags)?;
        let force = |place: usize| &reaction[d * place..d * (place + 1)];
        for (k, step) in steps.clone().enumerate() {
            let here = |row: usize| k * listed.len() + row;
            let touches = |row: usize| touching[here(row)] || force(here(row)).iter().any(|x| *x != 0.0);
            if let Some(&(_, node)) = self.strange.iter().find(|(row, _)| touches(*row)) {
                return Err(FileCause::Contact { step, node });
            }
        }
        let at = |k: usize| self.rows.iter().map(move |row| row.map(|row| k * listed.len() + row));
        let places = || (0..steps.len()).flat_map(at);
        let on_surface = places().flat_map(|place| place.map_or(&[0.0; 3][..d], force)).copied().collect();
        Ok((on_surface, places().map(|place| place.is_some_and(|p| touching[p])).collect()))
    }

    /// Refuses NaN and infinity; `node` gives the node of a row within a step.
    fn finite(&self, name: &str, values: &[f64], first: usize, node: impl Fn(usize) -> usize) -> Result<(), FileCause> {
        let Some(at) = values.iter().position(|x| !x.is_finite()) else { return Ok(()) };
        let (value, at) = (values[at], at / self.file.dimension());
        let rows =
            if name.starts_with("percute") { self.file.contact_nodes().len() } else { self.file.mesh().node_count() };
        Err(FileCause::NotFinite { name: name.to_string(), step: first + at / rows, node: node(at % rows), value })
    }

    fn hand_on(
        &self,
        block: &StepBlock,
        steps: Range<usize>,
        take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>,
    ) -> Result<(), SinkError> {
        let (surface, d) = (self.rows.len(), self.file.dimension());
        let nodal = d * self.file.mesh().node_count();
        let internal = self.file.variables() * self.file.mesh().element_count();
        for (k, index) in steps.enumerate() {
            let rows = |row: usize| k * row..(k + 1) * row;
            let [velocity, acceleration] = [0, 1].map(|m| block.motion[m].as_ref().map(|v| &v[rows(nodal)]));
            take(&Step {
                index,
                time: self.file.times().instants()[index],
                displacement: &block.displacement[rows(nodal)],
                reaction: &block.reaction[rows(d * surface)],
                touching: &block.touching[rows(surface)],
                internal: &block.plastic[rows(internal)],
                velocity,
                acceleration,
            })?;
        }
        Ok(())
    }
}

impl StepSource for HistorySource {
    fn times(&self) -> &TimeGrid {
        self.file.times()
    }

    fn count(&self) -> usize {
        self.file.count()
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        self.file.expect_all()?;
        self.replay_stored(take)
    }
}

impl HistorySource {
    /// The stored steps, also of a thinned history: numbered by their place in the file, and with the motion that it
    /// has.
    #[must_use]
    pub fn stored(&self) -> StoredSteps<'_> {
        StoredSteps(self)
    }

    fn replay_stored(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        for steps in self.file.blocks(self.count()) {
            let block = self.block(steps.clone())?;
            self.hand_on(&block, steps, take)?;
        }
        Ok(())
    }
}

/// The stored steps of a history, which may be thinned.
#[derive(Clone, Copy, Debug)]
pub struct StoredSteps<'s>(&'s HistorySource);

impl StepSource for StoredSteps<'_> {
    fn times(&self) -> &TimeGrid {
        self.0.times()
    }

    fn count(&self) -> usize {
        self.0.count()
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        self.0.replay_stored(take)
    }
}
