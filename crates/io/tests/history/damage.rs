//! Files that were cut or changed: an error or numbers, never a panic, a crash or memory without end.

use crate::history::common::*;
use crate::history::foreign::{Style, rewrite};
use percute_core::history::History;
use percute_io::{FileCause, kind};
use percute_testkit::Random;
use std::path::{Path, PathBuf};
use std::process::Command;

const FOLDER: &str = "PERCUTE_TEST_FOLDER";

/// A file as this crate writes it, and others of the same content in older formats of HDF5, which
/// have no checksums, in pieces and compressed.
fn samples(folder: &Path) -> Vec<PathBuf> {
    let path = folder.join("native.vtkhdf");
    small(&path);
    let mut paths = vec![path.clone()];
    for style in [Style::Old, Style::Chunked, Style::Deflated, Style::Narrow] {
        let other = folder.join(format!("{style:?}.vtkhdf"));
        rewrite(&path, &other, style);
        paths.push(other);
    }
    paths
}

/// Everything that can be asked of a file; whatever is said must be said in words.
fn ask(path: &Path) -> Option<History> {
    let problem = block(4, 3);
    let told = replayed(path, &problem).and_then(|history| plane_file(path).arrays().map(|_| history));
    if let Err(error) = &told {
        assert!(error.path == path && error.to_string().len() > 20, "{error}");
    }
    let _ = kind(path);
    told.ok()
}

/// Cuts files at many lengths and changes bytes at many places. Runs with little memory, see below.
#[test]
fn child() {
    let Ok(folder) = std::env::var(FOLDER) else { return };
    let folder = PathBuf::from(folder);
    let mut random = Random::new(7);
    let problem = block(4, 3);
    let original = run(&problem, &steps(&problem, 12));
    for sample in samples(&folder) {
        let whole = std::fs::read(&sample).unwrap();
        let spoilt = folder.join("spoilt.vtkhdf");
        for k in 0..=100 {
            let length = if k < 40 { k * 13 } else { whole.len() * k / 101 };
            std::fs::write(&spoilt, &whole[..length]).unwrap();
            assert!(ask(&spoilt).is_none(), "{} cut at {length} of {}", sample.display(), whole.len());
        }
        let mut good = 0;
        for k in 0..400 {
            let mut bytes = whole.clone();
            for _ in 0..=k % 4 {
                let at = random.bits() as usize % bytes.len();
                bytes[at] = if k % 3 == 0 { 0xff } else { random.bits() as u8 };
            }
            std::fs::write(&spoilt, &bytes).unwrap();
            let Some(history) = ask(&spoilt) else { continue };
            good += 1;
            // What has checksums is as it was, or refused.
            if sample.ends_with("native.vtkhdf") {
                assert_eq!(history.len(), original.len());
                assert_same(&history, &original, original.len());
            }
        }
        assert!(good < 400, "{}: {good}", sample.display());
    }
}

/// HDF5 takes memory for the length in a reference before it looks for the text.
#[test]
fn a_text_longer_than_its_file_is_refused() {
    let folder = folder();
    let [path, other] = ["a.vtkhdf", "b.vtkhdf"].map(|name| folder.path().join(name));
    small(&path);
    rewrite(&path, &other, Style::Narrow);
    assert!(ask(&other).is_some());
    let place = raw(&other, hdf5::OpenMode::Read).dataset("percute/problem").unwrap().offset().unwrap() as usize;
    let mut bytes = std::fs::read(&other).unwrap();
    bytes[place + 3] = 0xf0;
    std::fs::write(&other, bytes).unwrap();
    let told = percute_io::history::open(&other).unwrap_err().to_string();
    assert!(
        told.contains("the length of the text `percute/problem`") || told.contains("the length of a text"),
        "{told}"
    );
}

/// Each stored number of the steps and of the mesh: one that is changed is refused, with its field and instant, or is
/// not read.
#[test]
fn a_changed_number_is_refused() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    small(&path);
    let whole = std::fs::read(&path).unwrap();
    let places = plane_file(&path).arrays().unwrap();
    let spoilt = folder.path().join("spoilt.vtkhdf");
    for array in &places {
        let width = if array.name == "touching" { 1 } else { 8 };
        let row = width * array.shape[1..].iter().product::<usize>();
        for step in [0, 5, 12] {
            let mut bytes = whole.clone();
            // The lowest bit of the first number.
            bytes[array.offset.unwrap() as usize + step * row] ^= 1;
            std::fs::write(&spoilt, &bytes).unwrap();
            let error = replayed(&spoilt, &block(4, 3)).unwrap_err();
            let FileCause::Checksum { name, step: Some(at) } = &error.cause else { panic!("{}: {error}", array.name) };
            // The first checksum of an instant is that of the displacements.
            let changed = if array.name == "checksums" { "displacement" } else { array.name };
            assert_eq!((name.as_str(), *at), (changed, step));
        }
    }
    assert!(places.len() >= 4);
    // A point of the mesh, the initial velocity and a letter of the statement.
    let place = |part: &[u8]| whole.windows(part.len()).position(|bytes| bytes == part).unwrap();
    for at in [place(&0.0125_f64.to_ne_bytes()), place(&400.0_f64.to_ne_bytes()), place(&STATEMENT.as_bytes()[..20])] {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        std::fs::write(&spoilt, &bytes).unwrap();
        let error = replayed(&spoilt, &block(4, 3)).unwrap_err();
        assert!(matches!(&error.cause, FileCause::Checksum { step: None, .. }), "{error}");
    }
}

/// In an address space of 2 GB (a few times what the test needs as it is): whoever takes memory for what a
/// spoilt file says dies.
#[test]
fn cut_and_changed_files_are_survived() {
    let folder = folder();
    let output = Command::new("sh")
        .args(["-c", "ulimit -v 2000000; exec \"$0\" --exact history::damage::child"])
        .arg(std::env::current_exe().unwrap())
        .env(FOLDER, folder.path())
        .env("RUST_TEST_THREADS", "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {said}", output.status);
    // The library tells its errors to us, not to the terminal.
    assert!(!said.contains("HDF5-DIAG"), "{said}");
}

/// Errors of the library stay silent in every thread.
#[test]
fn the_library_is_silent_in_every_thread() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    std::fs::write(&path, b"\x89HDF\r\n\x1a\nand nothing more").unwrap();
    let error = std::thread::spawn(move || replayed(&path, &block(4, 3)).unwrap_err()).join().unwrap();
    let FileCause::Damaged { detail } = &error.cause else { panic!("{error}") };
    assert!(error.to_string().contains("truncated or damaged") && detail.len() > 5, "{error}");
}
