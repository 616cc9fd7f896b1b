//! The place of a file as seen from the folder of a page.

use std::path::{Component, Path, PathBuf, absolute};

/// The way from a folder to a file, both as seen from the working directory, with slashes; none if the file is not
/// there, or on another drive.
pub(super) fn seen_from(folder: &Path, file: &str) -> Option<String> {
    let (folder, file) = (absolute(Path::new(".").join(folder)).ok()?, absolute(file).ok()?);
    if file.is_file() { way(&folder, &file) } else { None }
}

/// The way between two absolute paths.
fn way(folder: &Path, file: &Path) -> Option<String> {
    let [folder, file] = [folder, file].map(resolved);
    let common = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    let way = up.chain(file.components().skip(common)).map(|part| part.as_os_str().to_string_lossy());
    (common > 0).then(|| way.collect::<Vec<_>>().join("/"))
}

/// A path without `.` and `..`.
fn resolved(path: &Path) -> PathBuf {
    let mut resolved = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => drop(resolved.pop()),
            part => resolved.push(part),
        }
    }
    resolved
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_seen_from_the_folder_of_the_page() {
        let of = |folder: &str, file: &str| way(Path::new(folder), Path::new(file)).unwrap();
        assert_eq!(of("/a/b", "/a/b/c.vtkhdf"), "c.vtkhdf");
        assert_eq!(of("/a/b", "/a/b/runs/c.vtkhdf"), "runs/c.vtkhdf");
        assert_eq!(of("/a/pages/x", "/a/runs/c.vtkhdf"), "../../runs/c.vtkhdf");
        assert_eq!(of("/a/./b/../pages", "/a/pages/c.vtkhdf"), "c.vtkhdf");
        assert_eq!(seen_from(Path::new("."), "no such file"), None);
    }
}
