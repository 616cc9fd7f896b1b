//! Files that are no cases, by their first bytes and their names.

use percute_io::{Kind, kind};
use std::path::Path;

/// The way out for arrays.
macro_rules! arrays {
    () => {
        "; arrays of another program are graded in Python, by `pc.History.from_arrays` (docs/foreign.md)"
    };
}

/// How files of other kinds begin.
const BEGINNINGS: [(&[u8], &str); 8] = [
    (b"\x89PNG", "a picture (PNG), not a case"),
    (b"GIF8", "a picture (GIF), not a case"),
    (b"\xff\xd8\xff", "a picture (JPEG), not a case"),
    (b"%PDF", "a PDF document, not a case"),
    (b"PK\x03\x04", concat!("a ZIP archive or NumPy arrays (.npz), not a case", arrays!())),
    (b"\x93NUMPY", concat!("a NumPy array, not a case", arrays!())),
    (b"\x1f\x8b", "a compressed file (gzip), not a case; unpack it first"),
    (b"<", "XML, such as an SVG picture, an HTML page or a VTU file, not a case"),
];

/// Endings of mesh files that meshlane reads, and their formats.
const MESHES: [(&[&str], &str); 16] = [
    (&["inp"], "Abaqus"),
    (&["bdf", "nas", "fem"], "Nastran"),
    (&["vtu", "vtk"], "VTK"),
    (&["med"], "MED"),
    (&["xdmf", "xmf"], "XDMF"),
    (&["mesh", "meshb"], "Medit"),
    (&["cdb"], "Ansys"),
    (&["dat", "tec"], "Tecplot"),
    (&["e", "ex2", "exo"], "Exodus"),
    (&["cgns"], "CGNS"),
    (&["su2"], "SU2"),
    (&["stl", "ply", "off", "obj"], "surface triangles"),
    (&["vol"], "Netgen"),
    (&["avs"], "AVS"),
    (&["mdpa"], "Kratos"),
    (&["ugrid"], "UGRID"),
];
/// Endings of files that Gmsh opens, but meshlane does not read.
const OF_GMSH: [(&[&str], &str); 4] = [
    (&["step", "stp"], "a geometry (STEP)"),
    (&["iges", "igs"], "a geometry (IGES)"),
    (&["brep"], "a geometry (BREP)"),
    (&["unv"], "a mesh (I-deas UNV)"),
];
/// Endings of other input.
const DYNA: [&str; 3] = ["k", "key", "dyn"];

/// What a mesh or a geometry of another program is, by the ending of its name, and the way to a mesh file of Gmsh.
fn of_mesh(file: &Path, ending: &str) -> Option<String> {
    let of = |table: &[(&[&str], &'static str)]| {
        table.iter().find(|(endings, _)| endings.contains(&ending)).map(|(_, format)| *format)
    };
    let name = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let stem = file.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    if let Some(format) = of(&MESHES) {
        return Some(format!(
            "a mesh ({format}), which the command does not read: in Python, \
             `pc.Mesh.read(\"{name}\").write(\"{stem}.msh\")` makes a mesh file of Gmsh (it needs meshlane: pip \
             install 'percute[mesh]'), or open it in Gmsh and export .msh; the command reads that"
        ));
    }
    if let Some(what) = of(&OF_GMSH) {
        return Some(format!(
            "{what}, which percute does not read: Gmsh opens it, makes a mesh of triangles (`gmsh -2`), and saves it \
             as \"{stem}.msh\""
        ));
    }
    DYNA.contains(&ending).then(|| {
        format!(
            "an input deck (LS-DYNA), which percute does not read: write its mesh in a format that Gmsh opens, as \
             Nastran or Abaqus, and save it from Gmsh as \"{stem}.msh\""
        )
    })
}

/// The first bytes of HDF5.
const HDF5: &[u8] = b"\x89HDF";

/// What an HDF5 file is, and what can be done with it.
fn of_hdf5(file: &Path) -> &'static str {
    match kind(file) {
        Ok(Kind::Estimate) => {
            "an estimate file, not a case; `percute info` describes it, `percute report` writes its page, `percute \
             plot` draws it"
        }
        Ok(Kind::History) => {
            "a history, not a case; `percute estimate` estimates its error, `percute report` writes a page on it, \
             `percute info` describes it"
        }
        _ => "an HDF5 file, not a case, and neither a history nor an estimate file of percute",
    }
}

/// What a file is, if it is no case: of another kind, or by its name a history or an estimate file.
#[must_use]
pub fn stranger(file: &Path, content: &[u8]) -> Option<String> {
    let begins = content.trim_ascii_start();
    let known = BEGINNINGS.iter().find(|(beginning, _)| begins.starts_with(beginning)).map(|(_, kind)| *kind);
    let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let is_mesh = ending.as_deref().and_then(|ending| of_mesh(file, ending));
    if let Some(found) = is_mesh.filter(|_| std::str::from_utf8(content).map_or(true, |text| !text.contains("[time]")))
    {
        return Some(format!("this is {found}"));
    }
    let hdf5 = matches!(ending.as_deref(), Some("vtkhdf" | "h5" | "hdf5"));
    let found = match known {
        Some(kind) => kind.to_string(),
        None if begins.starts_with(HDF5) => of_hdf5(file).to_string(),
        None if begins.is_empty() && hdf5 => "an empty file, no history and no estimate file".to_string(),
        // The reader of cases says what is missing.
        None if begins.is_empty() => return None,
        None if begins[0] == b'{' => {
            "a JSON document, not a case; cases are TOML: `percute new block` prints one".to_string()
        }
        None if hdf5 => "not an HDF5 file in spite of its name: no history and no estimate file".to_string(),
        None => return None,
    };
    Some(format!("this is {found}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strangers_are_named_and_cases_are_not() {
        let of = |name: &str, content: &[u8]| stranger(Path::new(name), content);
        for (name, content, says) in [
            ("a.vtkhdf", &b""[..], "an empty file, no history"),
            ("a.VTKHDF", b"hello", "not an HDF5 file in spite of its name"),
            ("a.json", b"\n{\"levels\": []}", "a JSON document"),
            ("a.npz", b"PK\x03\x04", "`pc.History.from_arrays` (docs/foreign.md)"),
            ("a.npy", b"\x93NUMPY\x01", "`pc.History.from_arrays` (docs/foreign.md)"),
            ("a.h5", b"\x89HDF\r\n\x1a\n", "neither a history nor an estimate file"),
            ("a.svg", b"<svg/>", "an SVG picture"),
            ("part.inp", b"*Heading\n*Node", "a mesh (Abaqus), which the command does not read"),
            ("Part.INP", b"", "`pc.Mesh.read(\"Part.INP\").write(\"Part.msh\")`"),
            ("part.bdf", b"BEGIN BULK", "a mesh (Nastran)"),
            ("part.vtu", b"<VTKFile>", "percute[mesh]"),
            ("part.med", b"\x89HDF\r\n\x1a\n", "a mesh (MED)"),
            ("part.step", b"ISO-10303-21;", "a geometry (STEP)"),
            ("part.k", b"*KEYWORD", "(LS-DYNA)"),
            ("a.vtkhdf", b"\x89PNG\r\n\x1a\n", "a picture (PNG)"),
        ] {
            assert!(of(name, content).is_some_and(|told| told.contains(says)), "{name}");
        }
        for case in
            [&b""[..], b"[mesh]", b"# A case\n[mesh]", b"mesh = {}", b"hello", b"$MeshFormat", b"\xef\xbb\xbf[mesh]"]
        {
            assert_eq!(of("a.toml", case), None);
        }
        // A case with an odd name is one.
        assert_eq!(of("case.dat", b"[mesh]\n[time]"), None);
        assert_eq!(of("case.txt", &b"[mesh]"[..]), None);
    }
}
