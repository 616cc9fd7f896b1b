//! A disk that fills up during a run.

use crate::common::{Bench, stderr};
use crate::resume::{case, running};
use percute_io::history::open;
use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

/// Displacements and reactions of all steps, bit by bit.
fn steps(file: &Path) -> [Vec<u64>; 2] {
    let file = open(file).unwrap();
    let (all, bits) = (0..file.count(), |values: Vec<f64>| values.iter().map(|x| x.to_bits()).collect());
    [bits(file.displacement(all.clone()).unwrap()), bits(file.reaction(all).unwrap())]
}

/// A file system that cannot reserve room, in a file of 100 MB, and without one if it cannot be mounted here.
#[allow(clippy::print_stderr)]
fn mounted(bench: &Bench) -> bool {
    let (image, disk) = (bench.path("image"), bench.path("disk"));
    File::create(&image).unwrap().set_len(100 << 20).unwrap();
    fs::create_dir(&disk).unwrap();
    let made = Command::new("mkfs.ext2").arg("-q").arg(&image).output();
    let mount = || Command::new("mount").args(["-o", "loop"]).args([&image, &disk]).output();
    let done = made.is_ok_and(|made| made.status.success()) && mount().is_ok_and(|mount| mount.status.success());
    if !done {
        eprintln!("skipped: no disk of ext2 can be mounted here");
    }
    done
}

/// The steps before are kept, the error has the reason, and the run goes on once there is room.
#[test]
fn a_full_disk_costs_no_step() {
    let (bench, undisturbed) = (Bench::new(&case()), Bench::new(&case()));
    if !mounted(&bench) {
        return;
    }
    let result = std::panic::catch_unwind(|| {
        let (file, filler) = (bench.path("disk/case.vtkhdf"), bench.path("disk/filler"));
        let run = running(&bench, &["run", "case.toml", "--history", "disk/case.vtkhdf"], "disk/case.vtkhdf", 70);
        let filled = fs::write(&filler, vec![1; 120 << 20]).unwrap_err();
        assert_eq!(filled.kind(), std::io::ErrorKind::StorageFull);
        let output = run.wait_with_output().unwrap();
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{told}");
        assert!(told.contains("could not be written: No space left on device"), "{told}");
        assert!(told.contains("all steps before it are in the file"), "{told}");
        fs::remove_file(filler).unwrap();
        let resumed = bench.percute(&["simulate", "case.toml", "--history", "disk/case.vtkhdf", "--resume"]);
        assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
        assert_eq!(undisturbed.percute(&["simulate", "case.toml"]).status.code(), Some(0));
        assert!(steps(&file) == steps(&undisturbed.path("case.vtkhdf")));
    });
    assert!(Command::new("umount").arg("-l").arg(bench.path("disk")).status().unwrap().success());
    result.unwrap();
}
