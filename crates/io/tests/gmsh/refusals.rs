//! Files that are refused: each with its place, in the tags of Gmsh, and with what to do there.

use crate::gmsh::common::*;
use percute_io::gmsh::{FilePlace, parse, read};

/// What is said of a file, and where.
fn said(text: &str) -> (String, Option<FilePlace>) {
    let error = of_bytes(text.as_bytes()).unwrap_err();
    let message = error.to_string();
    assert!(!message.contains("Some(") && message.contains("a.msh"), "{message}");
    (message, error.place)
}

/// `SQUARE` with a change, what must be said of it, and how the line begins that is named.
#[test]
fn mistakes_in_a_mesh_are_named_with_their_line_and_tags() {
    let mistakes: &[(&str, &str, &[&str], &str)] = &[
        ("4.1 0 8", "4 0 8", &["version 4 of the MSH format", "-format msh41"], "4 0"),
        ("4.1 0 8", "4.1 0 7", &["found `7` instead of the size of numbers"], "4.1 0 7"),
        ("4.1 0 8", "4.1 2 8", &["found `2` instead of 0 for a text"], "4.1 2 8"),
        ("1 1 \"foot\"", "1 1 foot", &["a dimension, a tag and a name in quotes"], "1 1 foot"),
        ("90 2 30 4\n2 2 2 1", "90 2 30 4\n2 2 3 1", &["element 50 is a quadrangle", "Mesh.RecombineAll = 0"], "50"),
        ("2 2 2 1", "2 2 9 1", &["element 50 is a triangle of higher order", "Mesh.ElementOrder = 1"], "50"),
        ("2 2 2 1", "2 2 5 1", &["element 50 is a hexahedron", "gmsh -3"], "50"),
        ("2 2 2 1", "2 2 99 1", &["element 50 is a hexahedron of higher order"], "50"),
        ("2 2 2 1", "2 2 77777 1", &["an element of another kind (Gmsh's type 77777)"], "50"),
        ("50 2 9 4", "50 2 9 5", &["element 50 names node 5, which is not in $Nodes"], "50"),
        ("50 2 9 4", "90 2 9 4", &["element 90 is given twice"], "90 2 9"),
        ("50 2 9 4", "0 2 9 4", &["the tag of an element is 0"], "0 2"),
        ("\n9\n6\n", "\n9\n4\n", &["node 4 is given twice"], "4"),
        ("50 2 9 4", "50 2 4 4", &["element 50 is degenerate: its nodes [2, 4, 4]", "tags in Gmsh"], "50"),
        ("50 2 9 4", "50 2 30 9", &["elements 50 and 90 lie on the same side", "BooleanFragments"], "90 2"),
        ("0 1 0\n7 7 7", "0 1 0.5\n7 7 7", &["not in a plane z = const", "node 9 has z = 0.5 m"], ""),
        ("0 1 0\n7 7 7", "0 1 inf\n7 7 7", &["found `inf` instead of a coordinate of a node"], "0 1 inf"),
        ("0 1 0\n7 7 7", "0 1 0,5\n7 7 7", &["found `0,5` instead of a coordinate of a node"], "0 1 0,5"),
        ("10 30 2", "10 30 9", &["the line 10 of nodes [30, 9]", "\"foot\"", "Coherence"], "10 30"),
        ("10 30 2", "10 30 6", &["the line 10 of nodes [30, 6]", "not an edge of any triangle"], "10 30"),
        ("1 1 1 1\n10 30 2", "1 9 1 1\n10 30 9", &["the line 10", "delete the curve", "Mesh.SaveAll = 0"], "10 30"),
        ("$Entities", "$PartitionedEntities", &["the mesh is partitioned", "Mesh > Unpartition"], "0 1 2 0"),
        ("1 5 2 30", "1 6 2 30", &["found `6` instead of the number of nodes", "another number"], "7 7 7"),
        ("2 1 0 5\n", "2 1 0 5000000000\n", &["the number of nodes of a block is 5000000000"], "2 1 0 5000000000"),
        ("3 3 10 90", "3 18446744073709551615 10 90", &["the number of elements is 18446744073709551615"], "3 1844"),
        ("$EndNodes", "8 8 8\n$EndNodes", &["the end of the section", "longer than its counts say"], "8 8 8"),
        ("7 7 7\n", "", &["found `$EndNodes` instead of a coordinate", "shorter than its counts say"], "$EndNodes"),
        ("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "", &["no section $MeshFormat"], "0 1 2 0"),
    ];
    for (from, to, phrases, line) in mistakes {
        assert!(SQUARE.contains(from), "{from}");
        let text = SQUARE.replacen(from, to, 1);
        let (message, place) = said(&text);
        for phrase in *phrases {
            assert!(message.contains(phrase), "{from} -> {to}: {message}");
        }
        let named = place.map_or("", |place| match place {
            FilePlace::Line(line) => text.lines().nth(line - 1).unwrap(),
            FilePlace::Byte(byte) => panic!("byte {byte} of a text"),
        });
        let at_its_place = if line.is_empty() { named.is_empty() } else { named.starts_with(line) };
        assert!(at_its_place, "{from} -> {to}: {message}: {named}");
    }
}

/// A mesh of lines where a plane body was meant: Gmsh saves only what is in a physical group.
#[test]
fn a_body_in_no_physical_group_is_missed() {
    let start = SQUARE.find("$Elements").unwrap();
    let (head, lines) = (&SQUARE[..start], "$Elements\n1 1 1 1\n1 1 1 1\n10 30 2\n$EndElements\n");
    let (message, _) = said(&format!("{head}{lines}"));
    assert!(message.contains("surfaces but no triangles") && message.contains("Physical Surface"), "{message}");
    let (message, _) = said(&format!("{head}$Elements\n0 0 0 0\n$EndElements\n"));
    assert!(message.contains("neither triangles nor lines") && message.contains("mesh the surfaces"), "{message}");
    let old = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 1 1 0\n$EndNodes\n$Elements\n1\n1 1 2 0 1 1 \
        2\n$EndElements\n";
    let (message, _) = said(old);
    assert!(message.contains("not a bar along x: node 1 has y = 0 m and node 2 has y = 1 m"), "{message}");
    assert!(message.contains("Physical Surface"), "{message}");
}

#[test]
fn bodies_that_only_seem_to_touch_are_told_to_be_joined() {
    let text = SQUARE
        .replace("1 5 2 30\n2 1 0 5\n2\n", "1 6 2 30\n2 1 0 6\n7\n2\n")
        .replace("\n0 0 0\n1 0 0", "\n0 0 0\n0 0 0\n1 0 0");
    let (message, _) = said(&text.replace("50 2 9 4", "50 7 9 4"));
    assert!(message.contains("nodes 2 and 7 lie at one place") && message.contains("Coherence;"), "{message}");
}

#[test]
fn bodies_that_overlap_are_told_to_be_cut_apart() {
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 3 0 0\n3 0 3 0\n4 1 1 0\n5 4 1 0\n6 4 4 \
        0\n$EndNodes\n\
                $Elements\n2\n40 2 2 0 1 1 2 3\n70 2 2 0 2 4 5 6\n$EndElements\n";
    let (message, _) = said(text);
    assert!(message.contains("elements 40 and 70 touch or overlap") && message.contains("Coherence;"), "{message}");
}

#[test]
fn a_plane_that_is_not_x_y_is_told_how_to_turn() {
    let places = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    for (turned, axis) in [("0 3 0\n1 3 0\n1 3 1\n0 3 1\n", "y = const"), ("3 0 0\n3 1 0\n3 1 1\n3 0 1\n", "x = const")]
    {
        let (message, _) = said(&SQUARE.replace(places, turned));
        assert!(message.contains(axis) && message.contains("Rotate"), "{message}");
    }
    let raised = SQUARE.replace(places, "0 0 5\n1 0 5\n1 1 5\n0 1 5\n");
    assert_eq!(plane(of_bytes(raised.as_bytes()).unwrap()).mesh.points_in::<2>()[3], [1.0, 0.0]);
}

#[test]
fn files_that_are_no_meshes_say_what_they_may_be() {
    for (text, phrase) in [
        ("", "it is empty"),
        ("Point(1) = {0, 0, 0};\n", "gmsh -2 block.geo"),
        ("SetFactory(\"OpenCASCADE\");\n", "gmsh -2 block.geo"),
        ("// a block\nlc = 1;\n", "gmsh -2 block.geo"),
        ("# vtk DataFile Version 5.1\n", "the extra `mesh`"),
        ("<VTKFile type=\"UnstructuredGrid\">\n<PointData>\n<Points>\n", "the extra `mesh`"),
        ("$ NASTRAN, mesh of a block\nGRID,1,,0.,0.,0.\n", "not a Gmsh mesh: it begins with `$ NASTRAN"),
        ("$ NASTRAN\n$ GRID Point(1)\n", "the extra `mesh`"),
        ("$NOD\n3\n", "version 1 of the MSH format"),
    ] {
        let (message, place) = said(text);
        assert!(message.contains(phrase), "{message}");
        assert_eq!(place, Some(FilePlace::Line(1)));
    }
    let by_ending = |name: &str, text: &str| parse(name.as_ref(), text.as_bytes(), 1.0).unwrap_err().to_string();
    for (name, text) in [("a.geo", "lc = 1;\n"), ("a.GEO", "h = 2;\nPoint(1) = {0, 0, 0};\n")] {
        assert!(by_ending(name, text).contains("gmsh -2 block.geo"), "{}", by_ending(name, text));
    }
    for (name, text) in [("a.geo", "<VTKFile>"), ("a.geo", ""), ("a.inp", "*Part\nPoint(1)\n")] {
        assert!(by_ending(name, text).contains("the extra `mesh`"), "{}", by_ending(name, text));
    }
    let missing = read("/nowhere/a.msh".as_ref(), 1.0).unwrap_err().to_string();
    assert!(missing.contains("/nowhere/a.msh: there is no such file"), "{missing}");
    let folder = tempfile::tempdir().unwrap();
    assert!(read(folder.path(), 1.0).unwrap_err().to_string().contains("not a regular file"));
}

#[test]
fn a_scale_must_be_positive_and_of_a_sane_size() {
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300, 1.1e12, 0.9e-12, 1e-300] {
        let error = read(&file("block-4.1.msh"), scale).unwrap_err().to_string();
        assert!(error.contains(&format!("the scale is {scale:?}; it must be a positive number from 1e-12")), "{error}");
        assert!(error.contains("1e-3 for millimetres"), "{error}");
    }
    for scale in [1e-12, 1e12] {
        assert!(read(&file("block-4.1.msh"), scale).is_ok(), "{scale}");
    }
    let far = SQUARE.replace("1 1 0\n0 1 0", "1e300 1 0\n0 1 0");
    let error = parse("a.msh".as_ref(), far.as_bytes(), 1e12).unwrap_err().to_string();
    assert!(error.contains("must be finite") && error.contains("is the scale correct?"), "{error}");
}

#[test]
fn a_name_that_is_no_utf_8_is_not_called_damage() {
    let latin: Vec<u8> = SQUARE.replace("foot", "Fuß").chars().map(|c| c as u8).collect();
    let error = of_bytes(&latin).unwrap_err();
    assert!(error.to_string().contains("save names in UTF-8"), "{error}");
    assert!(!error.to_string().contains("damaged"), "{error}");
    assert_eq!(error.place, Some(FilePlace::Line(6)));
}

/// A binary file names the byte.
#[test]
fn places_in_binary_files_are_bytes() {
    let whole = std::fs::read(file("block-4.1-binary.msh")).unwrap();
    let at = whole.windows(9).position(|w| w == b"$Elements").unwrap() + 10;
    // The head has four sizes, the first block three numbers of four bytes: the third is the kind.
    let mut spoilt = whole.clone();
    spoilt[at + 32 + 8] = 3;
    let error = of_bytes(&spoilt).unwrap_err();
    assert!(error.to_string().contains("is a quadrangle"), "{error}");
    assert_eq!(error.place, Some(FilePlace::Byte(at + 32 + 12 + 8)));
    let mut spoilt = whole;
    spoilt[20..24].copy_from_slice(&[7, 7, 7, 7]);
    let error = of_bytes(&spoilt).unwrap_err().to_string();
    assert!(error.contains("byte order") && error.contains("sent as a text"), "{error}");
}
