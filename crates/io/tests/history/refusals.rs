//! Files that are whole, but wrong: each error names the part and what is needed.

use crate::history::common::*;
use hdf5::types::VarLenUnicode;
use hdf5::{File, H5Type, OpenMode};
use percute_io::history::open;
use percute_io::{FileCause, Kind};

/// Spoils a small finished file and returns the error of reading it.
#[track_caller]
fn spoilt(spoil: impl FnOnce(&File)) -> String {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    let (problem, _) = small(&path);
    let file = raw(&path, OpenMode::ReadWrite);
    spoil(&file);
    file.close().unwrap();
    let error = replayed(&path, &problem).unwrap_err();
    assert_eq!(error.path, path);
    error.cause.to_string()
}

/// Puts another data set in the place of one.
fn replace<T: H5Type>(file: &File, name: &str, shape: &[usize], values: &[T]) {
    file.unlink(name).unwrap();
    let set = file.new_dataset::<T>().shape(shape).create(name).unwrap();
    set.write_raw(values).unwrap();
}

/// Changes one number of a data set.
fn change<T: H5Type>(file: &File, name: &str, at: usize, value: T) {
    let set = file.dataset(name).unwrap();
    let mut values: Vec<T> = set.read_raw().unwrap();
    values[at] = value;
    set.write_raw(&values).unwrap();
}

/// 20 nodes, 24 elements, 13 instants.
const NODES: usize = 20;
const CELLS: usize = 24;

#[track_caller]
fn assert_says(said: &str, words: &[&str]) {
    assert!(words.iter().all(|w| said.contains(w)), "{said}");
}

#[test]
fn foreign_files() {
    let folder = folder();
    let path = folder.path().join("a.h5");
    for (names, words) in [
        (vec![], "it is empty"),
        (vec!["mesh"], "it holds `mesh`"),
        (vec!["a", "b", "c"], "it holds `a`, `b` and more"),
        (vec!["VTKHDF"], "it is VTKHDF, but has no group `percute`"),
    ] {
        let file = raw(&path, OpenMode::Create);
        names.iter().for_each(|name| drop(file.create_group(name).unwrap()));
        file.close().unwrap();
        let error = open(&path).unwrap_err();
        assert!(matches!(error.cause, FileCause::Foreign { .. }) && error.to_string().contains(words), "{error}");
    }
    std::fs::write(&path, "GIF89a, and not HDF5 at all").unwrap();
    assert!(matches!(open(&path).unwrap_err().cause, FileCause::NotHdf5));
}

#[test]
fn other_kinds_and_layouts() {
    let attribute = |file: &File, name: &str, value: i64| {
        file.group("percute").unwrap().attr(name).unwrap().write_scalar(&value).unwrap();
    };
    let kind = |file: &File, value: &str| {
        let ours = file.group("percute").unwrap();
        ours.attr("kind").unwrap().write_scalar(&value.parse::<hdf5::types::FixedUnicode<64>>().unwrap()).unwrap();
    };
    assert_says(&spoilt(|f| kind(f, "estimate")), &["this is an estimate, but a history is needed here"]);
    assert_says(&spoilt(|f| kind(f, "song")), &["`percute.kind`", "\"song\" is not a known kind"]);
    assert_says(&spoilt(|f| attribute(f, "layout", 3)), &["layout 3", "reads 2 only", "newer percute"]);
    assert_says(&spoilt(|f| attribute(f, "layout", 1)), &["layout 1", "reads 2 only", "simulate or estimate again"]);
    assert_says(&spoilt(|f| attribute(f, "layout", -3)), &["`percute.layout`", "there is no layout -3"]);
    assert_says(
        &spoilt(|f| attribute(f, "dimension", 4)),
        &["`percute.dimension`", "4 is not a known dimension", "1 (bars), 2 (triangles) or 3"],
    );
    assert_says(
        &spoilt(|f| f.group("percute").unwrap().delete_attr("layout").unwrap()),
        &["`percute.layout` is missing"],
    );
    assert_eq!(Kind::Estimate.to_string(), "an estimate");
}

/// The library would take memory for the length that the attribute states, in this file 0.5 GB, before it refuses it.
#[test]
fn texts_of_attributes_longer_than_the_file() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/seeds/history/refused-attribute.vtkhdf");
    assert_says(&open(file).unwrap_err().to_string(), &["the text attribute `percute.kind` is longer than the file"]);
}

#[test]
fn missing_parts() {
    for name in [
        "VTKHDF",
        "VTKHDF/Points",
        "VTKHDF/Connectivity",
        "VTKHDF/Offsets",
        "VTKHDF/Types",
        "VTKHDF/Steps",
        "VTKHDF/PointData",
        "VTKHDF/PointData/displacement",
        "percute/initial_velocity",
        "percute/problem",
        "percute/contact/nodes",
        "percute/contact/reaction",
        "percute/contact/touching",
    ] {
        let said = spoilt(|f| f.unlink(name).unwrap());
        assert_says(&said, &[&format!("`{name}` is missing")]);
    }
    // Instants may be at either place.
    let said = spoilt(|f| ["VTKHDF/Steps/Values", "percute/times"].iter().for_each(|name| f.unlink(name).unwrap()));
    assert_says(&said, &["`VTKHDF/Steps/Values` is missing"]);
}

#[test]
fn wrong_shapes() {
    let zeros = |count: usize| vec![0.0; count];
    let cases: [(&str, Vec<usize>, &[&str]); 9] = [
        ("VTKHDF/Points", vec![NODES, 2], &["[20, 2]", "[20, 3]"]),
        ("VTKHDF/Points", vec![3 * NODES], &["[60]", "(nodes, 3)"]),
        ("VTKHDF/PointData/displacement", vec![13, NODES, 3], &["[13, 20, 3]", "[260, 3]"]),
        ("VTKHDF/PointData/displacement", vec![12 * NODES, 3], &["[240, 3]", "[260, 3]", "(instants x nodes, 3)"]),
        ("VTKHDF/PointData/displacement", vec![0, 3], &["[0, 3]", "[260, 3]"]),
        ("percute/initial_velocity", vec![NODES, 3], &["[20, 3]", "[20, 2]"]),
        ("percute/contact/reaction", vec![13, 5], &["[13, 5]", "[13, 5, 2]"]),
        ("percute/contact/touching", vec![13, 4], &["[13, 4]", "[13, 5]"]),
        ("percute/times", vec![1, 13], &["[1, 13]", "(instants)"]),
    ];
    for (name, shape, words) in cases {
        let said = spoilt(|f| replace(f, name, &shape, &zeros(shape.iter().product())));
        assert_says(&said, &[&format!("`{name}` has the shape"), "it must be"]);
        assert_says(&said, words);
    }
    let said = spoilt(|f| replace(f, "VTKHDF/Connectivity", &[71], &[0_i64; 71]));
    assert_says(&said, &["`VTKHDF/Connectivity` has the shape [71]", "3 nodes for each element"]);
    let said = spoilt(|f| replace(f, "percute/contact/nodes", &[5, 1], &[0_i64; 5]));
    assert_says(&said, &["`percute/contact/nodes` has the shape [5, 1]"]);
    let said = spoilt(|f| replace(f, "percute/steps_written", &[2], &[1_i64; 2]));
    assert_says(&said, &["`percute/steps_written` has the shape [2]", "a single number"]);
}

#[test]
fn wrong_types() {
    let said = spoilt(|f| replace(f, "VTKHDF/Connectivity", &[72], &[0.0; 72]));
    assert_says(&said, &["`VTKHDF/Connectivity` holds float64; it must be integers"]);
    let said = spoilt(|f| replace(f, "percute/contact/touching", &[13, 5], &[0.0; 65]));
    assert_says(&said, &["`percute/contact/touching` holds float64", "integers 0 and 1, or booleans"]);
    let text = |f: &File, name: &str, count: usize| {
        let value: VarLenUnicode = "x".parse().unwrap();
        replace(f, name, &[count], &vec![value; count]);
    };
    assert_says(&spoilt(|f| text(f, "percute/times", 13)), &["`percute/times` holds", "floating-point numbers"]);
    assert_says(&spoilt(|f| text(f, "percute/problem", 2)), &["`percute/problem` has the shape [2]", "one text"]);
    let said = spoilt(|f| replace(f, "percute/problem", &[1], &[1_i64]));
    assert_says(&said, &["`percute/problem` holds int64; it must be a text"]);
}

#[test]
fn numbers_that_are_none() {
    for value in [f64::NAN, f64::INFINITY] {
        let said = spoilt(|f| change(f, "VTKHDF/PointData/displacement", 3 * (4 * NODES + 7) + 1, value));
        assert_says(&said, &["`VTKHDF/PointData/displacement` is", "at step 4, node 7"]);
        let said = spoilt(|f| change(f, "VTKHDF/PointData/displacement", 3 * 7, value));
        assert_says(&said, &["displacement", "at step 0, node 7"]);
        let said = spoilt(|f| change(f, "percute/initial_velocity", 5, value));
        assert_says(&said, &["`percute/initial_velocity` is", "node 2"]);
        // The third node of the lowest row.
        let said = spoilt(|f| change(f, "percute/contact/reaction", 2 * (5 * 6 + 2), value));
        assert_says(&said, &["`percute/contact/reaction` is", "at step 6, node 2"]);
        let said = spoilt(|f| change(f, "VTKHDF/Points", 3 * 4, value));
        assert_says(&said, &["the mesh: node 4 has the coordinate"]);
        let said = spoilt(|f| change(f, "percute/times", 5, value));
        assert_says(&said, &["`percute/times`: instant 5 is"]);
    }
    // A third component in the plane.
    let said = spoilt(|f| change(f, "VTKHDF/PointData/displacement", 3 * (4 * NODES + 7) + 2, 1e-3));
    assert_says(&said, &["displacement", "components beyond the dimension of the problem, 2, must be 0"]);
    let said = spoilt(|f| change(f, "VTKHDF/Points", 8, 1.0));
    assert_says(&said, &["`VTKHDF/Points`: row 2", "must be 0"]);
}

#[test]
fn times_out_of_order() {
    let said = spoilt(|f| change(f, "percute/times", 3, 0.0));
    assert_says(&said, &["`percute/times`: instant 3 is 0 s, not after the"]);
    assert_says(&spoilt(|f| change(f, "percute/times", 0, -1.0)), &["the first instant is -1 s; it must be 0"]);
    let one = spoilt(|f| replace(f, "percute/times", &[1], &[0.0]));
    assert_says(&one, &["`percute/times`"]);
}

#[test]
fn indices_and_flags_out_of_range() {
    let said = spoilt(|f| change(f, "VTKHDF/Connectivity", 6, 20_i64));
    assert_says(&said, &["`VTKHDF/Connectivity`: entry 6 is 20, but there are 20 nodes, counted from 0"]);
    assert_says(&spoilt(|f| change(f, "VTKHDF/Connectivity", 6, -1_i64)), &["entry 6 is -1"]);
    let said = spoilt(|f| change(f, "VTKHDF/Offsets", 2, 7_i64));
    assert_says(&said, &["`VTKHDF/Offsets`: entry 2 is 7; it must be 6"]);
    let said = spoilt(|f| change(f, "VTKHDF/Types", CELLS - 1, 9_u8));
    assert_says(&said, &["`VTKHDF/Types`", "type 9", "all must be 5 (VTK_TRIANGLE)"]);
    let said = spoilt(|f| change(f, "VTKHDF/NumberOfCells", 0, 3_i64));
    assert_says(&said, &["`VTKHDF/NumberOfCells`: 3 does not fit the mesh, which has 24"]);
    // Twice is for nodes at two planes, which the problem knows.
    let said = spoilt(|f| {
        ["percute/checksum", "percute/checksums"].iter().for_each(|name| f.unlink(name).unwrap());
        change(f, "percute/contact/nodes", 1, 0_i64);
    });
    assert_says(&said, &["`percute/contact/nodes`: node 0 occurs in it twice"]);
    let said = spoilt(|f| [1, 2].iter().for_each(|&row| change(f, "percute/contact/nodes", row, 0_i64)));
    assert_says(&said, &["node 0 occurs in it three times"]);
    let said = spoilt(|f| change(f, "percute/contact/touching", 30, 2_u8));
    assert_says(&said, &["`percute/contact/touching`: 2 is neither 0 nor 1"]);
    let said = spoilt(|f| change(f, "VTKHDF/Steps/PointDataOffsets/displacement", 2, 0_i64));
    assert_says(&said, &["`VTKHDF/Steps/PointDataOffsets/displacement`: entry 2 is 0; it must be 40"]);
    let said = spoilt(|f| change(f, "percute/face_groups/bottom", 0, 99_i64));
    assert_says(&said, &["`percute/face_groups/bottom`: entry 0 is 99"]);
    // Inside the mesh: nodes 6 and 7 are joined by an edge that two elements share.
    let said = spoilt(|f| replace(f, "percute/face_groups/bottom", &[1, 2], &[6_i64, 7]));
    assert_says(&said, &["the mesh: group \"bottom\" names the edge of nodes 6 and 7, which is not on the boundary"]);
}

#[test]
fn counters_out_of_range() {
    for wrong in [14, -1] {
        let said = spoilt(|f| change(f, "percute/steps_written", 0, wrong as i64));
        assert_says(&said, &["`percute/steps_written`", &format!("{wrong} instants"), "room for 13"]);
    }
    let said = spoilt(|f| {
        f.unlink("percute/steps_written").unwrap();
        f.group("VTKHDF/Steps").unwrap().attr("NSteps").unwrap().write_scalar(&5_i64).unwrap();
    });
    assert_says(&said, &["`VTKHDF/Steps.NSteps`: 5 steps, but there are 13 instants"]);
}

/// A shape of a million million numbers of which none is stored: no memory is taken for it.
#[test]
fn hollow_shapes() {
    for chunk in [None, Some(1 << 20)] {
        let said = spoilt(|f| {
            f.unlink("VTKHDF/Points").unwrap();
            let made = f.new_dataset::<f64>().shape([1_usize << 40, 3]);
            let made = chunk.map_or(made.clone(), |c| made.chunk([c, 3]));
            made.create("VTKHDF/Points").unwrap();
        });
        assert_says(&said, &["`VTKHDF/Points` has the shape [1099511627776, 3], but only 0 bytes are stored"]);
    }
}

/// A problem on another mesh cannot take the steps.
#[test]
fn another_problem() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    small(&path);
    let error = plane_file(&path).source(&block(3, 3)).unwrap_err();
    assert!(matches!(error.cause, FileCause::Problem { given: 16, needed: NODES, .. }), "{error}");
    let error = plane_file(&path).displacement(13..14).unwrap_err();
    assert!(error.to_string().contains("step 13 is not in the file, which holds 13 instants"), "{error}");
}
