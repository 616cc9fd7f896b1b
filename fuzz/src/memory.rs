//! Memory of one execution, of Rust and of HDF5, counted by the address sanitizer. Large blocks count with the pages
//! that were touched: HDF5 asks for the size that a damaged file states, and then finds that the file is shorter.

use std::ffi::{c_int, c_uchar, c_void};
use std::sync::Once;
use std::sync::atomic::{AtomicIsize, Ordering::Relaxed};

/// Bytes that may be taken for each byte of an input.
const RATIO: isize = 50;
/// Bytes that may be taken for any input: buffers and caches of HDF5, threads, the mesh and the steps that a case asks
/// for.
const CONSTANT: isize = 32 << 20;

/// Blocks from this size on count with the pages that were touched.
const LARGE: usize = 8 << 20;
const PAGE: usize = 4096;
/// Bytes whose pages are asked for at once.
const CHUNK: usize = 1 << 30;

static NOW: AtomicIsize = AtomicIsize::new(0);
static MOST: AtomicIsize = AtomicIsize::new(0);

// SAFETY: these are functions of the sanitizer's runtime, with the types of <sanitizer/allocator_interface.h>, of
// Linux, with those of <sys/mman.h>, and of HDF5, with those of <H5public.h>.
unsafe extern "C" {
    fn __sanitizer_install_malloc_and_free_hooks(
        taken: extern "C" fn(*const c_void, usize),
        given: extern "C" fn(*const c_void),
    ) -> c_int;
    safe fn __sanitizer_get_allocated_size(place: *const c_void) -> usize;
    safe fn H5set_free_list_limits(
        objects: c_int,
        objects_of_a_kind: c_int,
        arrays: c_int,
        arrays_of_a_kind: c_int,
        blocks: c_int,
        blocks_of_a_size: c_int,
    ) -> c_int;
    fn mincore(place: *const c_void, bytes: usize, pages: *mut c_uchar) -> c_int;
}

extern "C" fn taken(_: *const c_void, bytes: usize) {
    if bytes < LARGE {
        let now = NOW.fetch_add(bytes as isize, Relaxed) + bytes as isize;
        MOST.fetch_max(now, Relaxed);
    }
}

extern "C" fn given(place: *const c_void) {
    if place.is_null() {
        return;
    }
    match __sanitizer_get_allocated_size(place) {
        bytes if bytes < LARGE => {
            NOW.fetch_sub(bytes as isize, Relaxed);
        }
        bytes => {
            MOST.fetch_max(NOW.load(Relaxed) + touched(place, bytes) as isize, Relaxed);
        }
    }
}

/// Bytes of the pages of a large block that were touched.
fn touched(place: *const c_void, bytes: usize) -> usize {
    let mut pages = vec![0; CHUNK / PAGE];
    let start = place.map_addr(|at| at.next_multiple_of(PAGE));
    let whole = (bytes - (start.addr() - place.addr())) / PAGE * PAGE;
    let chunks = (0..whole).step_by(CHUNK).map(|at| {
        let length = CHUNK.min(whole - at);
        // SAFETY: the pages are those of one block that is still in use.
        let told = unsafe { mincore(start.byte_add(at), length, pages.as_mut_ptr()) };
        assert_eq!(told, 0);
        pages[..length / PAGE].iter().filter(|&&page| page & 1 != 0).count() * PAGE
    });
    chunks.sum()
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

/// Lets HDF5 keep more of its objects between executions: the largest, of 0.5 MB for each open file, took a fifth of an
/// execution. The limits of arrays and blocks are those of the library.
///
/// # Panics
/// If the library refuses.
pub fn keep_objects() {
    let told = H5set_free_list_limits(4 << 20, 1 << 20, 4 << 20, 256 << 10, 16 << 20, 1 << 20);
    assert!(told >= 0);
}
