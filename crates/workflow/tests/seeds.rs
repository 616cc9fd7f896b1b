//! The seeds of the fuzz targets, and the inputs that fuzzing found, through the readers that it calls: no panic, and a
//! success or a refusal in words, as the names of the files say.

#[path = "../../../fuzz/src/entry.rs"]
#[allow(unreachable_pub)]
mod entry;

use std::path::Path;

/// Gives the files of a folder to a reader.
fn check(folder: &str, reader: impl Fn(&[u8]) -> Result<(), String>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds").join(folder);
    let (mut read, mut refused) = (0, 0);
    for file in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let name = file.file_name().unwrap().to_str().unwrap();
        let told = reader(&std::fs::read(&file).unwrap());
        match &told {
            Ok(()) => read += 1,
            Err(message) => {
                assert!(message.len() > 20 && !message.contains("Some("), "{name}: {message}");
                refused += 1;
            }
        }
        assert!(name.starts_with(if told.is_ok() { "read-" } else { "refused-" }), "{name}: {told:?}");
    }
    assert!(read > 2 && refused > 0, "{read} read, {refused} refused");
}

#[test]
fn cases() {
    check("case", entry::case);
}

#[test]
fn meshes() {
    check("mesh", entry::mesh);
}

#[test]
fn histories() {
    let folder = tempfile::tempdir().unwrap();
    check("history", |bytes| entry::history(bytes, &folder.path().join("a.vtkhdf")));
}

/// What the library would read without end, behind a buffer or into too much memory is refused before it reads.
#[test]
fn histories_that_the_library_does_not_survive() {
    let folder = tempfile::tempdir().unwrap();
    for (name, words) in [
        ("names", "damaged: the names of a group;"),
        ("header", "damaged: an object header;"),
        ("length", "damaged: the length of the text `percute/problem`;"),
        ("attribute", "damaged: the text attribute `percute.kind` is longer than the file;"),
        ("type", "has a type of another size;"),
    ] {
        let seed = format!("{}/../../fuzz/seeds/history/refused-{name}.vtkhdf", env!("CARGO_MANIFEST_DIR"));
        let told = entry::history(&std::fs::read(seed).unwrap(), &folder.path().join("a.vtkhdf")).unwrap_err();
        assert!(told.contains(words), "{name}: {told}");
    }
}
