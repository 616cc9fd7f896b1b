//! Files that were cut or changed: an error or a mesh, never a panic or memory without end.

use crate::gmsh::common::*;
use percute_testkit::Random;
use std::process::Command;

const CHILD: &str = "PERCUTE_TEST_GMSH";

/// What is said must be said in words.
fn ask(bytes: &[u8]) -> bool {
    let read = of_bytes(bytes);
    if let Err(error) = &read {
        let message = error.to_string();
        assert!(message.len() > 30 && message.len() < 1000 && !message.contains("Some("), "{message}");
    }
    read.is_ok()
}

/// Cuts files at every byte and changes bytes at many places. Runs with little memory, see below.
#[test]
fn child() {
    if std::env::var(CHILD).is_err() {
        return;
    }
    let mut random = Random::new(11);
    for name in ["block", "bar"].iter().flat_map(|of| FORMATS.map(|format| format!("{of}-{format}.msh"))) {
        let whole = std::fs::read(file(&name)).unwrap();
        let end = whole.trim_ascii_end().len();
        for length in 0..=whole.len() {
            assert_eq!(ask(&whole[..length]), length >= end, "{name} cut at {length} of {}", whole.len());
        }
        let mut good = 0;
        for k in 0..2000 {
            let mut bytes = whole.clone();
            for _ in 0..=k % 3 {
                let at = random.bits() as usize % bytes.len();
                bytes[at] = match k % 4 {
                    0 => 0xff,
                    1 => b'9',
                    _ => random.bits() as u8,
                };
            }
            good += usize::from(ask(&bytes));
        }
        // Many bytes are digits of coordinates, of which another one may do as well.
        assert!(good > 20 && good < 1900, "{name}: {good}");
    }
}

/// In an address space of 500 MB, a few times what the test needs: whoever takes memory for what a spoilt file says
/// dies.
#[test]
fn cut_and_changed_files_are_survived() {
    let output = Command::new("sh")
        .args(["-c", "ulimit -v 500000; exec \"$0\" --exact gmsh::damage::child"])
        .arg(std::env::current_exe().unwrap())
        .env(CHILD, "1")
        .env("RUST_TEST_THREADS", "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {said}", output.status);
}
