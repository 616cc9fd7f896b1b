#![no_main]

use percute_fuzz::{entry, in_proportion};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| in_proportion(bytes, |bytes| drop(entry::case(bytes))));
