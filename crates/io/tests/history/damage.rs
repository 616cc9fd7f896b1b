//! Files that were cut or changed: an error or numbers, never a panic, a crash or memory without end.

use crate::common::*;
use crate::foreign::{Style, rewrite};
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
    for style in [Style::Old, Style::Chunked, Style::Deflated] {
        let other = folder.join(format!("{style:?}.vtkhdf"));
        rewrite(&path, &other, style);
        paths.push(other);
    }
    paths
}

/// Everything that can be asked of a file; whatever is said must be said in words.
fn ask(path: &Path) -> bool {
    let problem = block(4, 3);
    let told = replayed(path, &problem).map(|_| ()).and_then(|()| plane_file(path).arrays().map(|_| ()));
    if let Err(error) = &told {
        assert!(error.path == path && error.to_string().len() > 20, "{error}");
    }
    let _ = kind(path);
    told.is_ok()
}

/// Cuts files at many lengths and changes bytes at many places. Runs with little memory, see below.
#[test]
fn child() {
    let Ok(folder) = std::env::var(FOLDER) else { return };
    let folder = PathBuf::from(folder);
    let mut random = Random::new(7);
    for sample in samples(&folder) {
        let whole = std::fs::read(&sample).unwrap();
        let spoilt = folder.join("spoilt.vtkhdf");
        for k in 0..=100 {
            let length = if k < 40 { k * 13 } else { whole.len() * k / 101 };
            std::fs::write(&spoilt, &whole[..length]).unwrap();
            assert!(!ask(&spoilt), "{} cut at {length} of {}", sample.display(), whole.len());
        }
        let mut good = 0;
        for k in 0..400 {
            let mut bytes = whole.clone();
            for _ in 0..=k % 4 {
                let at = random.bits() as usize % bytes.len();
                bytes[at] = if k % 3 == 0 { 0xff } else { random.bits() as u8 };
            }
            std::fs::write(&spoilt, &bytes).unwrap();
            good += usize::from(ask(&spoilt));
        }
        // Most bytes are numbers, of which another one is as good.
        assert!(good > 40 && good < 400, "{}: {good}", sample.display());
    }
}

/// In an address space of 2 GB (a few times what the test needs as it is): whoever takes memory for what a
/// spoilt file says dies.
#[test]
fn cut_and_changed_files_are_survived() {
    let folder = folder();
    let output = Command::new("sh")
        .args(["-c", "ulimit -v 2000000; exec \"$0\" --exact damage::child"])
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
