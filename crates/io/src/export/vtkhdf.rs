//! All instants in one VTKHDF file.

use super::{Contents, FieldPlace};
use crate::create::{Overwrite, Unnamed};
use crate::error::{FileCause, FileError};
use crate::library::refused;
use crate::mesh::{bytes_of_bodies, write_bodies, write_grid};
use crate::steps::{give_steps, note_steps, write_steps};
use crate::write::{Texts, group, offset, room, unit};
use hdf5::Group;
use percute_system::write_all_at;
use std::path::{Path, PathBuf};

/// Overhead of the library beside the arrays (bytes), with a margin.
const LIBRARY: u64 = 24_000;

/// An export whose file has no name yet.
pub(super) struct Single<'a> {
    contents: Contents<'a>,
    path: PathBuf,
    unnamed: Unnamed,
    /// The first byte of each field.
    places: Vec<u64>,
    written: usize,
}

impl<'a> Single<'a> {
    pub(super) fn new(path: &Path, overwrite: Overwrite, contents: Contents<'a>) -> Result<Self, FileError> {
        let fill = |file: &hdf5::File, _: &mut Texts| fill(file, &contents);
        let made = Unnamed::new(path, overwrite, bytes(&contents), fill);
        let reserved = made.and_then(|made| made.0.reserve().map(|()| made));
        let (unnamed, places) = reserved.map_err(|cause| cause.at(path))?;
        Ok(Self { contents, path: path.to_path_buf(), unnamed, places, written: 0 })
    }

    pub(super) fn push(&mut self, values: &[Vec<f64>]) -> Result<(), FileError> {
        for ((field, place), values) in self.contents.fields.iter().zip(&self.places).zip(values) {
            let row = (8 * field.components * self.contents.rows(field.place)) as u64;
            let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_ne_bytes()).collect();
            let written = write_all_at(self.unnamed.file(), &bytes, place + self.written as u64 * row);
            written.map_err(|source| self.unnamed.unwritten(source).at(&self.path))?;
        }
        self.written += 1;
        Ok(())
    }

    pub(super) fn finish(self) -> Result<Vec<PathBuf>, FileError> {
        let Self { path, unnamed, .. } = self;
        unnamed.sync().and_then(|()| unnamed.put().map(drop)).map_err(|cause| cause.at(&path))?;
        Ok(vec![path])
    }
}

/// Size of the file.
fn bytes(contents: &Contents<'_>) -> u64 {
    let (nodes, cells) = (contents.rows(FieldPlace::Nodes), contents.rows(FieldPlace::Elements));
    let grid = 24 * nodes + 8 * contents.mesh.nodes_of_element() * cells + 8 * (cells + 1) + cells;
    let fields: usize = contents.fields.iter().map(|field| 8 * field.components * contents.rows(field.place) + 8).sum();
    let instants = contents.instants.len();
    (grid + instants * (fields + 56)) as u64 + LIBRARY + bytes_of_bodies(contents.mesh, instants)
}

/// Creates the grid, the instants and room for the fields; returns the place of each field.
fn fill(file: &hdf5::File, contents: &Contents<'_>) -> Result<Vec<u64>, FileCause> {
    let vtk = write_grid(file, contents.mesh)?;
    let of = |place: FieldPlace| contents.fields.iter().filter(move |field| field.place == place);
    let mut groups: [Option<Group>; 2] = [None, None];
    for (to, (place, name)) in
        groups.iter_mut().zip([(FieldPlace::Nodes, "PointData"), (FieldPlace::Elements, "CellData")])
    {
        if of(place).next().is_some() || (place == FieldPlace::Elements && contents.mesh.parts() > 1) {
            *to = Some(group(&vtk, name)?);
        }
    }
    let bodies = groups[1].as_ref().map(|cells| write_bodies(cells, contents.mesh)).transpose()?.flatten();
    let mut places = Vec::new();
    for field in contents.fields {
        let [points, cells] = &groups;
        let Some(to) = (if field.place == FieldPlace::Nodes { points } else { cells }) else { continue };
        let rows = contents.rows(field.place) * contents.instants.len();
        let shape = if field.components == 1 { vec![rows] } else { vec![rows, field.components] };
        let set = room::<f64>(to, field.name, &shape)?;
        unit(&set, field.unit)?;
        places.push(offset(&set)?);
    }
    let starts = |place: FieldPlace| of(place).map(|field| (field.name, contents.rows(place))).collect::<Vec<_>>();
    let times: Vec<f64> = contents.instants.iter().map(|(_, time)| *time).collect();
    let of_elements: Vec<_> = starts(FieldPlace::Elements).into_iter().chain(bodies).collect();
    write_steps(&vtk, &times, &starts(FieldPlace::Nodes), &of_elements)?;
    give_steps(&vtk, &times).and_then(|()| note_steps(&vtk, times.len())).map_err(|error| refused(&error))?;
    Ok(places)
}
