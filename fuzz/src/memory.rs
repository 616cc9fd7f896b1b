//! Memory of one execution, of Rust and of HDF5, counted by the address sanitizer.

use std::ffi::{c_int, c_void};
use std::sync::Once;
use std::sync::atomic::{AtomicIsize, Ordering::Relaxed};

/// Bytes that may be taken for each byte of an input.
const RATIO: isize = 50;
/// Bytes that may be taken for any input: buffers and caches of HDF5, threads, the mesh and the steps that a case asks
/// for.
const CONSTANT: isize = 32 << 20;

static NOW: AtomicIsize = AtomicIsize::new(0);
static MOST: AtomicIsize = AtomicIsize::new(0);

// SAFETY: these are functions of the sanitizer's runtime, with the types of <sanitizer/allocator_interface.h>.
unsafe extern "C" {
    fn __sanitizer_install_malloc_and_free_hooks(
        taken: extern "C" fn(*const c_void, usize),
        given: extern "C" fn(*const c_void),
    ) -> c_int;
    safe fn __sanitizer_get_allocated_size(place: *const c_void) -> usize;
}

extern "C" fn taken(_: *const c_void, bytes: usize) {
    let now = NOW.fetch_add(bytes as isize, Relaxed) + bytes as isize;
    MOST.fetch_max(now, Relaxed);
}

extern "C" fn given(place: *const c_void) {
    if !place.is_null() {
        NOW.fetch_sub(__sanitizer_get_allocated_size(place) as isize, Relaxed);
    }
}

/// Runs `reader` on an input.
///
/// # Panics
/// If it takes more memory than the size of the input allows.
pub fn in_proportion(bytes: &[u8], reader: impl FnOnce(&[u8])) {
    static HOOKS: Once = Once::new();
    // SAFETY: both hooks live as long as the process and take no memory.
    HOOKS.call_once(|| assert_ne!(unsafe { __sanitizer_install_malloc_and_free_hooks(taken, given) }, 0));
    let before = NOW.load(Relaxed);
    MOST.store(before, Relaxed);
    reader(bytes);
    let most = MOST.load(Relaxed) - before;
    let allowed = CONSTANT + RATIO * bytes.len() as isize;
    assert!(most <= allowed, "{most} bytes of memory for an input of {} bytes; {allowed} are allowed", bytes.len());
}
