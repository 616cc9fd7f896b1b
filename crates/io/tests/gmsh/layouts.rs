//! What a file may look like: the same mesh whatever its order, its bytes and what else it holds.

use crate::gmsh::common::*;

/// Numbers in either order of bytes, with tags of 4 or 8 bytes.
struct Binary {
    bytes: Vec<u8>,
    big: bool,
    size: usize,
}

impl Binary {
    fn put(&mut self, little: &[u8]) {
        let mut field = little.to_vec();
        if self.big {
            field.reverse();
        }
        self.bytes.extend(field);
    }

    fn ints(&mut self, numbers: &[i32]) {
        numbers.iter().for_each(|n| self.put(&n.to_le_bytes()));
    }

    fn sizes(&mut self, numbers: &[u64]) {
        numbers.iter().for_each(|n| self.put(&n.to_le_bytes()[..self.size]));
    }

    fn reals(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|n| self.put(&n.to_le_bytes()));
    }

    fn line(&mut self, text: &str) {
        self.bytes.extend(text.as_bytes());
        self.bytes.push(b'\n');
    }
}

/// `SQUARE` as a binary file of version 4.1.
fn binary_square(big: bool, size: usize) -> Vec<u8> {
    let mut out = Binary { bytes: Vec::new(), big, size };
    out.line(&format!("$MeshFormat\n4.1 1 {size}"));
    out.ints(&[1]);
    out.line(
        "\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"foot\"\n2 5 \"lower\"\n2 6 \"upper\"\n$EndPhysicalNames\n$Entities",
    );
    out.sizes(&[0, 1, 2, 0]);
    for (tag, group) in [(1, 1), (1, 5), (2, 6)] {
        out.ints(&[tag]);
        out.reals(&[0.0, 0.0, 0.0, 1.0, 1.0, 0.0]);
        out.sizes(&[1]);
        out.ints(&[group]);
        out.sizes(&[0]);
    }
    out.line("\n$EndEntities\n$Nodes");
    out.sizes(&[1, 5, 2, 30]);
    out.ints(&[2, 1, 0]);
    out.sizes(&[5, 2, 30, 4, 9, 6]);
    out.reals(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 7.0, 7.0, 7.0]);
    out.line("\n$EndNodes\n$Elements");
    out.sizes(&[3, 3, 10, 90]);
    for (head, element) in [([1, 1, 1], &[10, 30, 2][..]), ([2, 1, 2], &[90, 2, 30, 4]), ([2, 2, 2], &[50, 2, 9, 4])] {
        out.ints(&head);
        out.sizes(&[1]);
        out.sizes(element);
    }
    out.line("\n$EndElements");
    out.bytes
}

#[test]
fn nodes_and_elements_come_in_the_order_of_their_tags() {
    let read = plane(of_bytes(SQUARE.as_bytes()).unwrap());
    assert_eq!(read.node_tags, [2, 4, 9, 30]);
    assert_eq!(read.element_tags, [50, 90]);
    assert_eq!(read.mesh.points_in::<2>(), [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]);
    let cells: Vec<_> = read.mesh.nodes_of::<3>().iter().map(|cell| cell.map(|node| node.index())).collect();
    // 50 is (2, 9, 4) in the file, clockwise.
    assert_eq!(cells, [[0, 1, 2], [0, 3, 1]]);
    assert_eq!(read.mesh.element_groups()["upper"][0].index(), 0);
    let foot = read.mesh.face_groups()["foot"][0];
    assert_eq!(read.mesh.face_nodes::<2>(foot).map(|node| node.index()), [0, 3]);
}

#[test]
fn all_orders_and_sizes_of_bytes_are_read() {
    let text = plane(of_bytes(SQUARE.as_bytes()).unwrap()).mesh;
    for (big, size) in [(false, 8), (false, 4), (true, 8), (true, 4)] {
        assert_same(&plane(of_bytes(&binary_square(big, size)).unwrap()).mesh, &text);
    }
}

#[test]
fn sections_come_in_any_order_with_others_between_them() {
    let text = plane(of_bytes(SQUARE.as_bytes()).unwrap()).mesh;
    let mut parts: Vec<String> = Vec::new();
    for line in SQUARE.lines() {
        if line.starts_with('$') && !line.starts_with("$End") {
            parts.push(String::new());
        }
        *parts.last_mut().unwrap() += &format!("{line}\r\n");
    }
    parts[1..].reverse();
    parts.insert(0, "$Comments\nnot a $Nodes section\n$EndComments\n".to_string());
    parts.insert(3, "$NodeData\n1\n\"T\"\n1\n0.0\n3\n0\n1\n1\n2 5.0\n$EndNodeData\n\n".to_string());
    let shuffled = parts.concat();
    assert!(shuffled.find("$Elements") < shuffled.find("$Entities"));
    assert_same(&plane(of_bytes(shuffled.as_bytes()).unwrap()).mesh, &text);
    let with_mark = format!("\u{feff}{SQUARE}");
    assert_same(&plane(of_bytes(with_mark.as_bytes()).unwrap()).mesh, &text);
}

#[test]
fn parametric_nodes_are_read() {
    let text = plane(of_bytes(SQUARE.as_bytes()).unwrap()).mesh;
    let with =
        SQUARE.replace("2 1 0 5", "2 1 1 5").replace("1 1 0\n0 1 0\n7 7 7", "1 1 0 0.1 0.2\n0 1 0 5 5\n7 7 7 nan 0");
    let with = with.replace("\n0 0 0\n1 0 0\n", "\n0 0 0 0 0\n1 0 0 0.5 -1\n");
    assert_same(&plane(of_bytes(with.as_bytes()).unwrap()).mesh, &text);
    let old = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n3\n1 0 0 0 0 1\n2 1 0 0 1 4 0.5\n3 0 1 0 2 4 \
        0.5 0.5\n\
               $EndParametricNodes\n$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n";
    assert_eq!(plane(of_bytes(old.as_bytes()).unwrap()).mesh.points_in::<2>(), [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
}

/// Version 2.2 has an element once for each of its groups; twice in one group or surface is worth a word.
#[test]
fn doubled_elements_of_version_2_are_one() {
    let file = |second: &str| {
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n2\n\
             1 2 2 7 1 1 2 3\n2 2 {second}\n$EndElements\n"
        )
    };
    let read = plane(of_bytes(file("2 8 1 3 2 1").as_bytes()).unwrap());
    assert_eq!((read.mesh.element_count(), read.element_tags), (1, vec![1]));
    assert_eq!(read.mesh.element_groups().keys().collect::<Vec<_>>(), ["7", "8"]);
    assert!(read.mesh.import_warnings().is_empty());
    for (second, groups) in [("2 7 1 1 2 3", &["7"][..]), ("2 8 2 3 1 2", &["7", "8"])] {
        let read = plane(of_bytes(file(second).as_bytes()).unwrap());
        assert_eq!((read.mesh.element_count(), read.element_tags), (1, vec![1]));
        assert_eq!(read.mesh.element_groups().keys().collect::<Vec<_>>(), groups);
        assert!(read.mesh.element_groups().values().all(|members| members.len() == 1));
        let names: Vec<_> = read.mesh.import_warnings().iter().map(|import_warning| import_warning.name).collect();
        assert_eq!(names, ["duplicate_elements"]);
    }
}

/// Gmsh makes such files of those of version 2.2 in which elements are in several groups.
#[test]
fn elements_of_version_4_on_the_same_nodes_are_one() {
    // Triangle 90 comes again as 95 in the surface "upper", between others; its edge comes again in a second curve.
    let text = SQUARE
        .replace("0 1 2 0\n", "0 2 2 0\n")
        .replace("1 0 0 0 1 0 0 1 1 0\n", "1 0 0 0 1 0 0 1 1 0\n2 0 0 0 1 0 0 1 2 0\n")
        .replace("3 3 10 90\n", "4 5 10 97\n")
        .replace(
            "2 1 2 1\n90 2 30 4\n2 2 2 1\n50 2 9 4",
            "1 2 1 1\n97 2 30\n2 2 2 2\n95 4 2 30\n96 2 9 4\n2 1 2 1\n90 2 30 4",
        );
    let read = plane(of_bytes(text.as_bytes()).unwrap());
    assert_eq!(read.element_tags, [90, 96]);
    let numbers = |group: &str| read.mesh.element_groups()[group].iter().map(|e| e.index()).collect::<Vec<_>>();
    assert_eq!((numbers("lower"), numbers("upper")), (vec![0], vec![0, 1]));
    for foot in ["foot", "2"] {
        let face = read.mesh.face_groups()[foot][0];
        assert_eq!(read.mesh.face_nodes::<2>(face).map(|node| node.index()), [0, 3]);
    }
    let import_warning =
        read.mesh.import_warnings().iter().find(|import_warning| import_warning.name == "duplicate_elements").unwrap();
    assert!(
        import_warning.message.contains("1 element of the mesh file (tag 95) was left out"),
        "{}",
        import_warning.message
    );
}

#[test]
fn groups_of_one_name_are_one_and_those_without_have_their_number() {
    let named = SQUARE.replace("2 6 \"upper\"", "2 6 \"lower\"");
    let mesh = plane(of_bytes(named.as_bytes()).unwrap()).mesh;
    assert_eq!(mesh.element_groups().keys().collect::<Vec<_>>(), ["lower"]);
    assert_eq!(mesh.element_groups()["lower"].len(), 2);
    let nameless = SQUARE.replace("3\n1 1 \"foot\"\n2 5 \"lower\"", "1");
    let mesh = plane(of_bytes(nameless.as_bytes()).unwrap()).mesh;
    assert_eq!(mesh.element_groups().keys().collect::<Vec<_>>(), ["5", "upper"]);
    assert_eq!(mesh.face_groups().keys().collect::<Vec<_>>(), ["1"]);
}
