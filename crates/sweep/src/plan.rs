//! The cases of a sweep.

use crate::key::replace;
use crate::name::names;
use crate::values::Values;
use percute_io::is_named_pipe;
use percute_workflow::Failure;
use percute_workflow::case::{Source, parse};
use percute_workflow::effort::Long;
use std::path::{Component, Path, PathBuf};
use toml_edit::{Document, DocumentMut, Item, Value};

/// Keys of a sweep file.
const KEYS: [&str; 5] = ["case", "folder", "grid", "list", "table"];

/// A case of a sweep.
#[derive(Clone, Debug)]
pub struct Planned {
    /// Its name, that of its folder.
    pub name: String,
    /// The text of its case file, in its folder.
    pub text: String,
}

/// The cases of a sweep, and where they go.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The folder of all.
    pub folder: PathBuf,
    /// Keys and their values in each case.
    pub values: Values,
    /// The cases, in the order of the values.
    pub cases: Vec<Planned>,
}

impl Plan {
    /// Reads a sweep file; `folder` counts before the one that it names. Files that it names are beside it, but for the
    /// folder, which is in the working directory.
    ///
    /// # Errors
    /// Something wrong with the file, with the case, or with the first case of the sweep.
    pub fn read(file: &Path, folder: Option<&Path>, long: Long) -> Result<Self, Failure> {
        let told = |message: String| Failure::Argument(format!("{}: {message}", file.display()));
        refuse_pipe(file)?;
        let text = std::fs::read_to_string(file);
        let text = text.map_err(|cause| told(format!("cannot read the sweep file: {cause}")))?;
        let document = Document::parse(text.as_str()).map_err(|error| told(error.to_string().trim().to_string()))?;
        let given = document.as_table();
        if let Some((key, _)) = given.iter().find(|(key, _)| !KEYS.contains(key)) {
            let hint = percute_workflow::message::hint(key, KEYS);
            let known = percute_workflow::message::list(KEYS);
            return Err(told(format!("`{key}` is not a key of a sweep{hint}; it has {known}")));
        }
        let text_of = |key: &str| match given.get(key).map(Item::as_str) {
            Some(None) => Err(told(format!("`{key}` must be the name of a file or folder, in quotes"))),
            Some(found) => Ok(found),
            None => Ok(None),
        };
        let example = "give the case that is to be varied, as in case = \"block.toml\"";
        let case = text_of("case")?.ok_or_else(|| told(format!("`case` is missing: {example}")))?;
        let beside = |name: &str| file.parent().unwrap_or(Path::new("")).join(name);
        let stem = || PathBuf::from(file.file_stem().unwrap_or_default());
        let folder = folder.map(Path::to_path_buf).or(text_of("folder")?.map(PathBuf::from)).unwrap_or_else(stem);
        let mut values = Values::none();
        if let Some(table) = text_of("table")? {
            values = values.with_rows_of(&beside(table))?;
        }
        let table = |key: &str| match given.get(key).map(Item::as_table_like) {
            Some(None) => Err(told(format!("`{key}` must be a table of keys with their values"))),
            found => Ok(found.flatten()),
        };
        if let Some(list) = table("list")? {
            values = values.together(list).map_err(|message| told(format!("[list] {message}")))?;
        }
        if let Some(grid) = table("grid")? {
            values = values.grid(grid).map_err(|message| told(format!("[grid] {message}")))?;
        }
        if values.keys().is_empty() {
            let example =
                "give values in [grid], as in \"obstacle.0.friction\" = [0.0, 0.3], in [list], or in a `table`";
            return Err(told(format!("no key is varied; {example}")));
        }
        Self::new(&beside(case), folder, values, long)
    }

    /// The sweep of a case file over these values.
    ///
    /// # Errors
    /// A case that cannot be read, a key that it does not have; a mistake in the first case. Those of the others are
    /// told when they are run.
    pub fn new(case: &Path, folder: PathBuf, values: Values, long: Long) -> Result<Self, Failure> {
        refuse_pipe(case)?;
        let text = std::fs::read_to_string(case);
        let text = text.map_err(|cause| Failure::Unreadable { file: case.to_path_buf(), cause })?;
        let shown = case.display().to_string();
        let told = |message: String| Failure::Argument(format!("{shown}: {message}"));
        let beside = case.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let base: DocumentMut = match text.parse() {
            Ok(base) => base,
            // In the words of the reader of cases.
            Err(error) => {
                parse(Source::new(&shown, text).in_folder(beside))?;
                return Err(told(error.to_string()));
            }
        };
        let mut cases = Vec::new();
        for (i, (name, row)) in names(values.keys(), values.cases()).into_iter().zip(values.cases()).enumerate() {
            let mut case = base.clone();
            for (key, value) in values.keys().iter().zip(row) {
                key.set(&mut case, value).map_err(told)?;
            }
            if i == 0 {
                check(&format!("{shown} with {name}"), &case.to_string(), beside, long)?;
            }
            move_mesh(&mut case, beside, &folder.join(&name));
            cases.push(Planned { name, text: case.to_string() });
        }
        let mut sorted: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
        sorted.sort_unstable();
        if let Some(twice) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(told(format!("two cases of the sweep are the same: {}; give each value once", twice[0])));
        }
        Ok(Self { folder, values, cases })
    }
}

/// Finds mistakes before any case is run.
fn check(name: &str, text: &str, folder: &Path, long: Long) -> Result<(), Failure> {
    Ok(parse(Source::new(name, text).in_folder(folder))?.check_run(true, long)?)
}

/// Refuses a pipe, which would wait for its writer.
fn refuse_pipe(file: &Path) -> Result<(), Failure> {
    let told = || format!("{}: this is a pipe, which may have no writer; name a file", file.display());
    if is_named_pipe(file) { Err(Failure::Argument(told())) } else { Ok(()) }
}

/// Lets a case find its mesh from its own folder.
fn move_mesh(case: &mut DocumentMut, from: &Path, to: &Path) {
    let file = case.get_mut("mesh").and_then(|mesh| mesh.get_mut("file"));
    let Some(place) = file else { return };
    if let Some(file) = place.as_str().map(Path::new).filter(|file| file.is_relative()) {
        let moved = relative(&absolute(&from.join(file)), &absolute(to));
        replace(place, Value::from(moved.to_string_lossy().into_owned()));
    }
}

/// The path from the root, without links as far as it is there. One that cannot be known stays as it is.
fn absolute(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let there = whole.ancestors().find_map(|there| Some((there.canonicalize().ok()?, there)));
    there.map_or(whole.clone(), |(real, there)| real.join(whole.strip_prefix(there).unwrap_or(Path::new(""))))
}

/// How to reach a file from a folder, both from the root.
fn relative(file: &Path, folder: &Path) -> PathBuf {
    let common = file.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    up.chain(file.components().skip(common)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_is_found_from_another_folder() {
        let real = tempfile::tempdir().unwrap();
        let (folder, link) = (real.path().canonicalize().unwrap(), real.path().join("link"));
        std::fs::create_dir(folder.join("a")).unwrap();
        std::os::unix::fs::symlink(folder.join("a"), &link).unwrap();
        assert_eq!(absolute(&link.join("../b/c")), folder.join("b/c"));
        assert_eq!(relative(Path::new("/a/b/c.msh"), Path::new("/a/d/e")), Path::new("../../b/c.msh"));
        let mut case: DocumentMut = "mesh.file = \"b/c.msh\"".parse().unwrap();
        move_mesh(&mut case, Path::new("/a"), Path::new("/a/d/e"));
        assert_eq!(case.to_string().trim(), "mesh.file = \"../../b/c.msh\"");
    }
}
