//! Files as other programs write them: any layout, width and byte order.

use crate::history::common::*;
use hdf5::dataset::AllocTime;
use hdf5::file::LibraryVersion;
use hdf5::types::{FloatSize, IntSize, TypeDescriptor, VarLenUnicode};
use hdf5::{Dataset, Group, OpenMode};
use percute_core::history::{Discard, StepSource};
use percute_core::observer::Unobserved;
use percute_estimator::{Options, Request, estimate};
use std::os::unix::fs::FileExt;
use std::path::Path;

/// How a file is written again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Style {
    /// In the oldest format of HDF5, as h5py does.
    Old,
    /// In pieces.
    Chunked,
    /// In pieces, compressed.
    Deflated,
    /// With integers of 32 bits and texts of variable length.
    Narrow,
}

/// Copies all groups, data sets and attributes that a history needs into a new file.
pub(crate) fn rewrite(from: &Path, to: &Path, style: Style) {
    let old = raw(from, OpenMode::Read);
    let new = hdf5::File::with_options()
        .with_fapl(|p| p.libver_bounds(LibraryVersion::Earliest, LibraryVersion::V110).file_locking(false))
        .create(to)
        .unwrap();
    let mut texts = Vec::new();
    let stored = std::fs::read(from).unwrap();
    copy(&old, &new, style, &stored, &mut texts);
    new.close().unwrap();
    let file = std::fs::File::options().write(true).open(to).unwrap();
    texts.iter().for_each(|(place, text): &(u64, Vec<u8>)| file.write_all_at(text, *place).unwrap());
}

/// Texts of fixed length are put in place later: the bindings write none of a length that is known late.
fn copy(from: &Group, to: &Group, style: Style, stored: &[u8], texts: &mut Vec<(u64, Vec<u8>)>) {
    for name in from.attr_names().unwrap() {
        copy_attribute(from, to, &name, style);
    }
    for name in from.member_names().unwrap() {
        // Checksums of numbers that were 64 bits wide.
        if style == Style::Narrow && name.starts_with("checksum") {
            continue;
        }
        match from.group(&name) {
            Ok(group) => copy(&group, &to.create_group(&name).unwrap(), style, stored, texts),
            Err(_) => {
                let set = from.dataset(&name).unwrap();
                match set.dtype().unwrap().to_descriptor().unwrap() {
                    TypeDescriptor::FixedUnicode(length) => {
                        let place = set.offset().unwrap() as usize;
                        copy_text(&stored[place..place + length], to, &name, style, texts);
                    }
                    _ => copy_data(&set, to, &name, style),
                }
            }
        }
    }
}

fn copy_attribute(from: &Group, to: &Group, name: &str, style: Style) {
    let attribute = from.attr(name).unwrap();
    match attribute.dtype().unwrap().to_descriptor().unwrap() {
        TypeDescriptor::Integer(_) => {
            let values: Vec<i64> = attribute.read_raw().unwrap();
            let made = to.new_attr::<i64>();
            if attribute.is_scalar() {
                made.create(name).unwrap().write_scalar(&values[0]).unwrap();
            } else {
                made.shape(values.len()).create(name).unwrap().write_raw(&values).unwrap();
            }
        }
        TypeDescriptor::FixedUnicode(64) => {
            let value: hdf5::types::FixedUnicode<64> = attribute.read_scalar().unwrap();
            if style == Style::Narrow {
                let value: VarLenUnicode = value.as_str().parse().unwrap();
                to.new_attr::<VarLenUnicode>().create(name).unwrap().write_scalar(&value).unwrap();
            } else {
                to.new_attr::<hdf5::types::FixedUnicode<64>>().create(name).unwrap().write_scalar(&value).unwrap();
            }
        }
        TypeDescriptor::FixedAscii(16) => {
            let value: hdf5::types::FixedAscii<16> = attribute.read_scalar().unwrap();
            to.new_attr::<hdf5::types::FixedAscii<16>>().create(name).unwrap().write_scalar(&value).unwrap();
        }
        other => panic!("{name}: {other}"),
    }
}

fn copy_text(text: &[u8], to: &Group, name: &str, style: Style, texts: &mut Vec<(u64, Vec<u8>)>) {
    if style == Style::Narrow {
        let value: VarLenUnicode = std::str::from_utf8(text).unwrap().parse().unwrap();
        to.new_dataset::<VarLenUnicode>().create(name).unwrap().write_scalar(&value).unwrap();
        return;
    }
    let kind = TypeDescriptor::FixedUnicode(text.len());
    let set = to.new_dataset_builder().empty_as(&kind).alloc_time(Some(AllocTime::Early)).create(name).unwrap();
    texts.push((set.offset().unwrap(), text.to_vec()));
}

fn copy_data(from: &Dataset, to: &Group, name: &str, style: Style) {
    let shape = from.shape();
    let chunk: Vec<usize> = shape.iter().map(|&d| d.div_ceil(3).max(1)).collect();
    let chunked = !shape.is_empty() && from.size() > 0 && matches!(style, Style::Chunked | Style::Deflated);
    let made = |kind: &TypeDescriptor| {
        let builder = to.new_dataset_builder();
        let builder = if style == Style::Deflated && chunked { builder.deflate(6) } else { builder };
        let builder = builder.empty_as(kind).shape(shape.clone());
        let builder = if chunked { builder.chunk(chunk.clone()) } else { builder.no_chunk() };
        builder.create(name).unwrap()
    };
    let kind = from.dtype().unwrap().to_descriptor().unwrap();
    match kind {
        TypeDescriptor::Float(_) => {
            let set = made(&TypeDescriptor::Float(FloatSize::U8));
            set.write_raw(&from.read_raw::<f64>().unwrap()).unwrap();
        }
        _ => {
            let kind = if style == Style::Narrow { TypeDescriptor::Integer(IntSize::U4) } else { kind };
            let values: Vec<i64> = from.read_raw().unwrap();
            if values.is_empty() { drop(made(&kind)) } else { made(&kind).write_raw(&values).unwrap() }
        }
    }
}

/// The same numbers in another layout give the same steps and the same estimate.
#[test]
fn any_layout_gives_the_same_bits() {
    let folder = folder();
    let path = folder.path().join("native.vtkhdf");
    let (problem, history) = small(&path);
    let estimated = |path: &Path| {
        let source = plane_file(path).source(&problem).unwrap();
        estimate(&problem, &source, Options::default(), &Request::default(), &mut Discard, &mut Unobserved).unwrap()
    };
    let native = estimated(&path);
    for style in [Style::Old, Style::Chunked, Style::Deflated, Style::Narrow] {
        let other = folder.path().join(format!("{style:?}.vtkhdf"));
        rewrite(&path, &other, style);
        assert_same(&replayed(&other, &problem).unwrap(), &history, history.len());
        assert_eq!(estimated(&other), native, "{style:?}");
        let in_place = plane_file(&other).arrays().unwrap().iter().all(|a| a.offset.is_some());
        assert_eq!(in_place, style == Style::Old, "{style:?}");
    }
}

/// Rows of contact data may come in any order; nodes that are not listed never touch, and nodes that
/// cannot touch may be listed as long as they do not.
#[test]
fn contact_rows_go_by_their_nodes() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    let (problem, history) = small(&path);
    let surface: Vec<i64> = problem.contact_nodes().iter().map(|c| c.node.index() as i64).collect();
    let (instants, count) = (history.len(), surface.len());
    // Backwards, and a node of the top first.
    let mut nodes = vec![problem.mesh().node_count() as i64 - 1];
    nodes.extend(surface.iter().rev());
    let mut reaction = Vec::new();
    let mut touching = Vec::new();
    for n in 0..instants {
        let step = history.step(n).unwrap();
        reaction.extend([0.0, 0.0]);
        reaction.extend(step.reaction.as_chunks::<2>().0.iter().rev().flatten());
        touching.push(0_u8);
        touching.extend(step.touching.iter().rev().map(|&t| u8::from(t)));
    }
    let write = |path: &Path, touching: &[u8]| {
        let file = raw(path, OpenMode::ReadWrite);
        let ours = file.group("percute").unwrap();
        ours.unlink("contact").unwrap();
        // The file is changed on purpose.
        for sums in ["checksum", "checksums"] {
            if ours.link_exists(sums) {
                ours.unlink(sums).unwrap();
            }
        }
        let contact = ours.create_group("contact").unwrap();
        contact.new_dataset_builder().with_data(&nodes).create("nodes").unwrap();
        let set = contact.new_dataset::<f64>().shape((instants, count + 1, 2)).create("reaction").unwrap();
        set.write_raw(&reaction).unwrap();
        let set = contact.new_dataset::<u8>().shape((instants, count + 1)).create("touching").unwrap();
        set.write_raw(touching).unwrap();
    };
    write(&path, &touching);
    assert_same(&replayed(&path, &problem).unwrap(), &history, instants);
    touching[3 * (count + 1)] = 1;
    write(&path, &touching);
    let error = replayed(&path, &problem).unwrap_err();
    let words =
        format!("node {} touches or has a reaction at step 3, but no obstacle", problem.mesh().node_count() - 1);
    assert!(error.to_string().contains(&words), "{error}");

    let file = raw(&path, OpenMode::ReadWrite);
    file.unlink("percute/contact").unwrap();
    drop(file);
    let without = replayed(&path, &problem).unwrap();
    assert!(without.reaction().iter().all(|r| *r == 0.0) && !without.touching().contains(&true));
    assert_eq!((without.reaction().len(), without.times()), (history.reaction().len(), history.times()));
}
