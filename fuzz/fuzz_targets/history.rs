#![no_main]

use percute_fuzz::{entry, in_proportion};
use std::path::PathBuf;
use std::sync::LazyLock;

/// A file of this process in `TMPDIR`, best on a file system in memory.
static FILE: LazyLock<PathBuf> =
    LazyLock::new(|| std::env::temp_dir().join(format!("percute-fuzz-{}.vtkhdf", std::process::id())));

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| in_proportion(bytes, |bytes| drop(entry::history(bytes, &FILE))));
