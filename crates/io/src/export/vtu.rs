//! An instant as VTK XML: an unstructured grid with binary arrays in base64.

use super::base64::encode;
use super::{Contents, FieldPlace};
use crate::mesh::{BODY, VTK_TYPES, bodies, in_space};

/// The text of a file.
pub(super) fn text(contents: &Contents<'_>, time: f64, values: &[Vec<f64>]) -> Vec<u8> {
    let mesh = contents.mesh;
    let (nodes, cells) = (mesh.node_count(), mesh.element_count());
    let mut to = Vec::new();
    line(&mut to, "<?xml version=\"1.0\"?>");
    line(
        &mut to,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">",
    );
    line(&mut to, "<UnstructuredGrid>\n<FieldData>");
    array(&mut to, "Float64", "Name=\"TimeValue\" NumberOfTuples=\"1\"", time.to_le_bytes().to_vec());
    line(&mut to, &format!("</FieldData>\n<Piece NumberOfPoints=\"{nodes}\" NumberOfCells=\"{cells}\">\n<Points>"));
    floats(&mut to, "Points", 3, &in_space(mesh.points(), mesh.dimension()));
    line(&mut to, "</Points>\n<Cells>");
    let connectivity = mesh.cells().flatten().map(|node| node.index() as i64);
    array(&mut to, "Int64", "Name=\"connectivity\"", connectivity.flat_map(i64::to_le_bytes).collect());
    let offsets = (1..=cells).map(|e| (e * mesh.nodes_of_element()) as i64);
    array(&mut to, "Int64", "Name=\"offsets\"", offsets.flat_map(i64::to_le_bytes).collect());
    array(&mut to, "UInt8", "Name=\"types\"", vec![VTK_TYPES[mesh.dimension() - 1].0; cells]);
    line(&mut to, "</Cells>");
    for (place, name) in [(FieldPlace::Nodes, "PointData"), (FieldPlace::Elements, "CellData")] {
        line(&mut to, &format!("<{name}>"));
        for (field, values) in contents.fields.iter().zip(values).filter(|(field, _)| field.place == place) {
            floats(&mut to, field.name, field.components, values);
        }
        if let Some(bodies) = bodies(mesh).filter(|_| place == FieldPlace::Elements) {
            let bytes = bodies.into_iter().flat_map(i64::to_le_bytes).collect();
            array(&mut to, "Int64", &format!("Name=\"{BODY}\""), bytes);
        }
        line(&mut to, &format!("</{name}>"));
    }
    line(&mut to, "</Piece>\n</UnstructuredGrid>\n</VTKFile>");
    to
}

fn line(to: &mut Vec<u8>, text: &str) {
    to.extend_from_slice(text.as_bytes());
    to.push(b'\n');
}

fn floats(to: &mut Vec<u8>, name: &str, components: usize, values: &[f64]) {
    let attributes = format!("Name=\"{name}\" NumberOfComponents=\"{components}\"");
    array(to, "Float64", &attributes, values.iter().flat_map(|x| x.to_le_bytes()).collect());
}

/// A data array: its number of bytes, and the bytes.
fn array(to: &mut Vec<u8>, kind: &str, attributes: &str, mut bytes: Vec<u8>) {
    let count = (bytes.len() as u64).to_le_bytes();
    bytes.splice(0..0, count);
    line(to, &format!("<DataArray type=\"{kind}\" {attributes} format=\"binary\">"));
    encode(&bytes, to);
    line(to, "\n</DataArray>");
}
