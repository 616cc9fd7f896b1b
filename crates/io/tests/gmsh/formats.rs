//! Files that Gmsh itself wrote (`files/make.py`): the same mesh from all four formats.

use crate::gmsh::common::*;
use percute_io::gmsh::read;

fn names(groups: &[String]) -> Vec<&str> {
    groups.iter().map(String::as_str).collect()
}

#[test]
fn a_block_of_two_materials_is_read_from_every_format() {
    for format in FORMATS {
        let read = plane(read(&file(&format!("block-{format}.msh")), 1e-3).unwrap());
        let mesh = &read.mesh;
        assert_eq!((mesh.node_count(), read.node_tags.len()), (38, 38), "{format}");
        assert_eq!(mesh.element_count(), read.element_tags.len());
        assert!(read.node_tags.is_sorted_by(|a, b| a < b) && read.element_tags.is_sorted_by(|a, b| a < b));
        let groups: Vec<_> = mesh.face_groups().keys().collect();
        assert_eq!(groups, ["Dach, außen", "bottom", "interface", "right side"], "{format}");
        let groups: Vec<_> = mesh.element_groups().keys().collect();
        assert_eq!(groups, ["30", "aluminium", "steel"], "{format}");
        // By the script: 20 mm and 30 mm wide, 40 mm high; sums of some 50 areas round to about 1e-14.
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-13 * b;
        assert!(near(area(mesh, "steel"), 8e-4) && near(area(mesh, "aluminium"), 12e-4), "{format}");
        assert_eq!(mesh.element_groups()["30"], mesh.element_groups()["steel"]);
        // The left part is clockwise in the file.
        assert_eq!(mesh.reoriented_elements(), mesh.element_groups()["steel"].len());
    }
}

#[test]
fn groups_of_curves_are_where_the_script_puts_them() {
    for format in FORMATS {
        // A power of two leaves all digits as they are.
        let mesh = plane(read(&file(&format!("block-{format}.msh")), 0.5).unwrap()).mesh;
        // Lengths (mm), and the constant coordinate of each group with its value.
        for (group, length, axis, value) in
            [("bottom", 25.0, 1, 0.0), ("right side", 20.0, 0, 25.0), ("Dach, außen", 25.0, 1, 20.0)]
        {
            let members = &mesh.face_groups()[group];
            let total: f64 = members.iter().map(|&face| mesh.normal_in::<2>(face).1).sum();
            assert!((total - length).abs() <= 1e-13 * length, "{format}: {group} has {total}");
            for node in members.iter().flat_map(|face| mesh.face_nodes::<2>(*face)) {
                assert_eq!(mesh.points_in::<2>()[node.index()][axis], value, "{format}: {group}");
            }
        }
        let reported: Vec<_> = mesh.import_warnings().iter().map(|n| (n.name, names(&n.groups))).collect();
        let expected =
            [("dropped_nodes", vec![]), ("points_left_out", vec!["probe"]), ("inner_edges", vec!["interface"])];
        assert_eq!(reported, expected, "{format}");
        assert!(mesh.face_groups()["interface"].is_empty());
    }
}

/// The block is 64 mm from corner to corner: who forgets the scale is asked.
#[test]
fn a_mesh_that_may_be_in_millimetres_is_reported() {
    let reported = |scale: f64| {
        let mesh = plane(read(&file("block-4.1.msh"), scale).unwrap()).mesh;
        mesh.import_warnings()
            .iter()
            .find(|import_warning| import_warning.name == "large_mesh")
            .map(|import_warning| import_warning.message.clone())
    };
    assert!(reported(1.0).is_some_and(|message| message.contains("is 64.031 m large") && message.contains("1e-3")));
    assert_eq!((reported(1e-3), reported(0.999)), (None, None));
}

#[test]
fn formats_agree_bit_by_bit_up_to_numbering() {
    let read = |format: &str| plane(read(&file(&format!("block-{format}.msh")), 1.0).unwrap()).mesh;
    let exact = |format: &str| Shape::of(&read(format), |x| x);
    assert_eq!(exact("4.1"), exact("2.2"));
    assert_eq!(exact("4.1-binary"), exact("2.2-binary"));
    // Gmsh writes texts with 16 digits: single precision is the same in both.
    let rounded = |format: &str| Shape::of(&read(format), |x| f64::from(x as f32));
    assert_eq!(rounded("4.1"), rounded("4.1-binary"));
}

#[test]
fn tags_are_those_of_the_file() {
    let read = plane(read(&file("block-4.1.msh"), 1.0).unwrap());
    // In the file, node 276 is (0, 0, 5) and node 227 is (9.999999999984821, 0, 5).
    for (tag, place) in [(276, [0.0, 0.0]), (227, [9.999_999_999_984_821, 0.0])] {
        let at = read.node_tags.iter().position(|&t| t == tag).unwrap();
        assert_eq!(read.mesh.points_in::<2>()[at], place);
    }
    assert!(read.element_tags.iter().all(|tag| tag % 11 == 0));
    assert!(!read.node_tags.contains(&234), "a node of no triangle");
}

#[test]
fn a_bar_is_read_from_every_format() {
    for format in FORMATS {
        let mesh = bar(read(&file(&format!("bar-{format}.msh")), 1.0).unwrap()).mesh;
        let place = |group: &str| {
            let face = mesh.face_groups()[group][0];
            mesh.points_in::<1>()[mesh.face_nodes::<1>(face)[0].index()]
        };
        assert_eq!((place("start"), place("end")), ([0.02], [0.12]), "{format}");
        let length = |group: &str| {
            let members = &mesh.element_groups()[group];
            members.iter().map(|&element| mesh.geometry::<1, 2>(element).volume).sum::<f64>()
        };
        // Differences of coordinates up to 0.12 m round to about 1e-17 m.
        assert!((length("left") - 0.04).abs() < 1e-15 && (length("right") - 0.06).abs() < 1e-15, "{format}");
        // The right line runs against x.
        assert_eq!(mesh.reoriented_elements(), mesh.element_groups()["right"].len());
        let reported: Vec<_> = mesh.import_warnings().iter().map(|n| (n.name, names(&n.groups))).collect();
        assert_eq!(reported, [("inner_edges", vec!["middle"])]);
    }
}
