//! Where files go: names that are taken, folders that are not there, full disks, locks.

use crate::history::common::*;
use percute_io::history::{Plan, Writer, open, recover};
use percute_io::{FileCause, FileError, Overwrite};
use std::fs::{self, File};
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::process::Command;

fn create(path: &Path, overwrite: Overwrite) -> Result<Writer, FileError> {
    let problem = block(4, 3);
    Plan::new(&problem, &steps(&problem, 12), STATEMENT, None).create(path, overwrite)
}

fn refused(path: &Path, overwrite: Overwrite) -> FileError {
    create(path, overwrite).unwrap_err()
}

/// Names of what a folder holds.
fn names(folder: &Path) -> Vec<String> {
    fs::read_dir(folder).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_file_that_exists_is_kept_unless_asked() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    fs::write(&path, "dear").unwrap();
    let error = refused(&path, Overwrite::Refuse);
    assert!(matches!(error.cause, FileCause::Exists), "{error}");
    assert!(
        error
            .to_string()
            .ends_with("a.vtkhdf: the file exists already; give another name, or ask for it to be replaced")
    );
    assert_eq!(fs::read_to_string(&path).unwrap(), "dear");
    drop(create(&path, Overwrite::Replace).unwrap());
    assert_eq!(plane_file(&path).count(), 0);
    assert_eq!(names(folder.path()), ["a.vtkhdf"]);
}

/// The next file in a folder removes what killed processes left there, and nothing else.
#[test]
fn files_left_behind_are_removed() {
    let folder = folder();
    let [left, used, other] = [".percute-left", ".percute-used", "percute-notes"].map(|name| folder.path().join(name));
    for path in [&left, &used, &other] {
        fs::write(path, "half a history").unwrap();
    }
    let lock = File::open(&used).unwrap();
    lock.lock_shared().unwrap();
    drop(create(&folder.path().join("a.vtkhdf"), Overwrite::Refuse).unwrap());
    assert!(!left.exists() && used.exists() && other.exists(), "{:?}", names(folder.path()));
}

/// Processes that begin in one folder at the same time leave each other's files alone.
#[test]
fn files_that_are_being_made_are_not_taken_for_left_behind() {
    let folder = folder();
    std::thread::scope(|scope| {
        for thread in 0..4 {
            let folder = folder.path();
            scope.spawn(move || {
                for k in 0..100 {
                    percute_io::write_bytes(folder.join(format!("{thread}-{k}")), Overwrite::Refuse, b"a picture")
                        .unwrap();
                }
            });
        }
    });
    assert_eq!(names(folder.path()).len(), 400);
}

/// Whatever fails before the new file is whole leaves the old one.
#[test]
fn a_file_to_be_replaced_stays_until_the_new_one_is_there() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    fs::write(&path, "dear").unwrap();
    let problem = block(4, 3);
    let times = steps(&problem, 12);
    let error = Plan::new(&problem, &times, "a\0b", None).create(&path, Overwrite::Replace).unwrap_err();
    assert!(error.to_string().ends_with("`problem`: a text must not hold NUL"), "{error}");
    assert_eq!((fs::read_to_string(&path).unwrap().as_str(), names(folder.path()).len()), ("dear", 1));
}

#[test]
fn through_a_link_its_target_is_replaced() {
    let folder = folder();
    let (target, link) = (folder.path().join("target"), folder.path().join("link"));
    fs::write(&target, "old").unwrap();
    std::os::unix::fs::symlink(&target, &link).unwrap();
    assert!(matches!(refused(&link, Overwrite::Refuse).cause, FileCause::Exists));
    create(&link, Overwrite::Replace).unwrap().finish().unwrap();
    assert!(link.is_symlink() && plane_file(&target).is_complete());
}

#[test]
fn what_is_no_file_is_not_replaced() {
    let folder = folder();
    for path in [folder.path(), Path::new("/dev/full")] {
        assert!(matches!(refused(path, Overwrite::Replace).cause, FileCause::NotAFile), "{}", path.display());
        let error = open(path).unwrap_err();
        assert!(matches!(error.cause, FileCause::NotAFile), "{error}");
    }
}

/// A folder that is not there, and one that is none: what a folder without permission gives too, but
/// permissions do not bind who runs tests as root.
#[test]
fn folders_that_cannot_hold_a_file() {
    let folder = folder();
    fs::write(folder.path().join("file"), "").unwrap();
    for (name, kind) in
        [("none/a.vtkhdf", std::io::ErrorKind::NotFound), ("file/a.vtkhdf", std::io::ErrorKind::NotADirectory)]
    {
        let error = refused(&folder.path().join(name), Overwrite::Refuse);
        assert!(matches!(&error.cause, FileCause::Create { source } if source.kind() == kind), "{error}");
        assert!(error.to_string().contains("cannot be created") && error.to_string().contains("the folder exists"));
    }
    assert!(matches!(open(folder.path().join("none")).unwrap_err().cause, FileCause::Missing));
    assert!(matches!(open(folder.path().join("file/a")).unwrap_err().cause, FileCause::Read { .. }));
}

#[test]
fn names_without_a_folder_are_in_the_present_one() {
    let name = Path::new("percute-test-of-a-bare-name.vtkhdf");
    let made = create(name, Overwrite::Replace).map(Writer::finish);
    fs::remove_file(name).unwrap();
    made.unwrap().unwrap();
}

/// More than any disk has free: 29 TB for 2e7 steps of 60 501 nodes.
#[test]
fn more_than_the_disk_can_hold() {
    let folder = folder();
    let problem = block(300, 200);
    let times = percute_core::time::TimeGrid::uniform(1.0, 20_000_000).unwrap();
    let plan = Plan::new(&problem, &times, STATEMENT, None);
    let error = plan.create(folder.path().join("a.vtkhdf"), Overwrite::Refuse).unwrap_err();
    let needed = plan.bytes();
    assert!(matches!(error.cause, FileCause::NoSpace { needed: n, free } if n == needed && free < n), "{error}");
    assert!(names(folder.path()).is_empty());
}

/// A disk of 1 MiB: too small for one history, large enough for another.
#[test]
fn small_disk() {
    let folder = folder();
    let disk = folder.path().join("disk");
    fs::create_dir(&disk).unwrap();
    let mounted = Command::new("mount").args(["-t", "tmpfs", "-o", "size=1m", "tmpfs"]).arg(&disk).output();
    if !mounted.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: a small disk cannot be mounted here");
        return;
    }
    let result = std::panic::catch_unwind(|| {
        drop(create(&disk.join("fits.vtkhdf"), Overwrite::Refuse).unwrap());
        let problem = block(20, 16);
        let times = steps(&problem, 500);
        let plan = Plan::new(&problem, &times, STATEMENT, None);
        let error = plan.create(disk.join("large.vtkhdf"), Overwrite::Refuse).unwrap_err();
        assert!(matches!(error.cause, FileCause::NoSpace { needed, free } if needed == plan.bytes() && free < 1 << 20));
        assert!(error.to_string().contains(&format!("needs {} bytes", plan.bytes())), "{error}");
        assert_eq!(names(&disk), ["fits.vtkhdf"]);
        // What is reserved cannot be taken by others.
        let path = disk.join("reserved.vtkhdf");
        let problem = block(10, 8);
        let history = run(&problem, &steps(&problem, 200));
        let mut writer = write_some(&path, &problem, &history, 1);
        let filled = fs::write(disk.join("filler"), vec![1; 1 << 20]);
        assert!(filled.is_err());
        (1..201).for_each(|n| writer.push(&history.step(n).unwrap()).unwrap());
        writer.finish().unwrap();
        assert_same(&replayed(&path, &problem).unwrap(), &history, 201);
        // A run that goes on tells the room that it lacks: its file has given back that of the steps to come.
        fs::remove_file(&path).unwrap();
        fs::remove_file(disk.join("filler")).unwrap();
        write_some(&path, &problem, &history, 3).finish().unwrap();
        let found = fs::metadata(&path).unwrap();
        assert!(fs::write(disk.join("filler"), vec![1; 1 << 20]).is_err());
        let missing = found.len() - 512 * found.blocks();
        let error = plane_file(&path).resume(&problem).unwrap_err();
        assert!(matches!(error.cause, FileCause::NoSpace { needed, .. } if needed == missing), "{missing}: {error}");
    });
    // Lazily: a process that another test is about to start may still hold what this one has closed.
    assert!(Command::new("umount").arg("-l").arg(&disk).status().unwrap().success());
    result.unwrap();
}

/// A lock of another program, as HDF5 takes it for writing.
#[test]
fn locked_files() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    small(&path);
    let other = File::open(&path).unwrap();
    // In so many words everywhere: a child that another test forks keeps what is only closed.
    other.lock().unwrap();
    for error in [open(&path).unwrap_err(), refused(&path, Overwrite::Replace), percute_io::kind(&path).unwrap_err()] {
        assert!(matches!(error.cause, FileCause::InUse), "{error}");
        assert!(error.to_string().contains("another program is using the file"));
    }
    other.unlock().unwrap();
    // Who only reads does not hinder reading, but the file is not taken from under him.
    other.lock_shared().unwrap();
    assert!(open(&path).is_ok());
    assert!(matches!(refused(&path, Overwrite::Replace).cause, FileCause::InUse));
    other.unlock().unwrap();
    assert!(create(&path, Overwrite::Replace).is_ok());
}

/// A file that is being written is neither replaced nor recovered nor opened for writing by HDF5, and
/// whoever reads it with a lock does not keep it from being finished.
#[test]
fn files_being_written_are_held() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    let writer = create(&path, Overwrite::Refuse).unwrap();
    assert!(matches!(refused(&path, Overwrite::Replace).cause, FileCause::InUse));
    assert!(matches!(recover(&path).unwrap_err().cause, FileCause::InUse));
    let error = hdf5::File::open_rw(&path).unwrap_err();
    assert!(error.to_string().contains("lock"), "{error}");
    let reader = File::open(&path).unwrap();
    reader.lock_shared().unwrap();
    writer.finish().unwrap();
    assert!(plane_file(&path).is_complete());
}

/// A file that is moved or replaced while the run goes on.
#[test]
fn files_that_go_away() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    let writer = create(&path, Overwrite::Refuse).unwrap();
    let moved = folder.path().join("b.vtkhdf");
    fs::rename(&path, &moved).unwrap();
    let error = writer.finish().unwrap_err();
    assert!(matches!(&error.cause, FileCause::Lost { now: Some(now) } if *now == moved), "{error}");
    assert!(plane_file(&moved).is_complete(), "it is completed in its new place");

    // One that was stopped as well holds a part of its steps.
    let problem = block(4, 3);
    let writer = write_some(&path, &problem, &run(&problem, &steps(&problem, 12)), 3);
    let stopped = folder.path().join("c.vtkhdf");
    fs::rename(&path, &stopped).unwrap();
    let error = writer.finish().unwrap_err().to_string();
    assert!(error.ends_with(&format!("; all steps done are in it, as {}", stopped.display())), "{error}");
    assert!(!plane_file(&stopped).has_ended() && plane_file(&stopped).count() == 3);

    let writer = create(&path, Overwrite::Refuse).unwrap();
    fs::remove_file(&path).unwrap();
    let error = writer.finish().unwrap_err();
    assert!(matches!(error.cause, FileCause::Lost { now: None }), "{error}");

    let (problem, _) = small(&path);
    let file = plane_file(&path);
    let source = file.source(&problem).unwrap();
    fs::remove_file(&path).unwrap();
    small(&path);
    assert!(matches!(file.displacement(0..1).unwrap_err().cause, FileCause::Replaced));
    let error = percute_core::history::StepSource::replay(&source, &mut |_| Ok(())).unwrap_err();
    assert!(error.to_string().ends_with("the file was replaced since it was opened; open it again"), "{error}");
}

/// Steps that do not fit are refused, and those before them stay.
#[test]
fn steps_that_do_not_fit() {
    let folder = folder();
    let path = folder.path().join("a.vtkhdf");
    let problem = block(4, 3);
    let history = run(&problem, &steps(&problem, 12));
    let mut writer = write_some(&path, &problem, &history, 3);
    let step = history.step(3).unwrap();
    let mut refuse = |step: &percute_core::history::Step<'_>, words: &str| {
        let error = writer.push(step).unwrap_err();
        assert!(error.to_string().contains(words) && error.is::<FileError>(), "{error}");
    };
    refuse(&history.step(4).unwrap(), "step 4 came where step 3 was expected");
    refuse(&percute_core::history::Step { velocity: Some(step.displacement), ..step }, "velocity is there");
    refuse(&percute_core::history::Step { reaction: &step.reaction[1..], ..step }, "reaction has");
    writer.push(&step).unwrap();
    writer.finish().unwrap();
    assert_same(&replayed(&path, &problem).unwrap(), &history, 4);
}
