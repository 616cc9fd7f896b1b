#![no_main]

use percute_fuzz::{entry, in_proportion, keep_objects};
use std::path::PathBuf;
use std::sync::LazyLock;

/// A file of this process in `TMPDIR`, best on a file system in memory.
static FILE: LazyLock<PathBuf> =
    LazyLock::new(|| std::env::temp_dir().join(format!("percute-fuzz-{}.vtkhdf", std::process::id())));

libfuzzer_sys::fuzz_target!(init: keep_objects(), |bytes: &[u8]| in_proportion(bytes, |bytes| drop(entry::history(bytes, &FILE))));
