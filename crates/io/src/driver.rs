//! HDF5 over percute's own reads and writes of an open file.
//!
//! A write that fails is kept as the fault of the file, and HDF5 is told that it was done: HDF5 2.0 crashes when it
//! closes a file after a failed write, and a failure at the end of a data set is lost, because its handle is dropped.
//! HDF5 takes no locks this way, whatever its environment says, and needs no name.
//!
//! This is the only unsafe code of the crate: the bindings know the drivers of the library alone. The library is built
//! into the program, and refuses a driver of another version than its own.

#![allow(unsafe_code)]

use crate::error::FileCause;
use crate::library::{damaged, detail, refused};
use hdf5::plist::{FileAccess, FileCreate};
use hdf5_sys::h5::{haddr_t, herr_t, hsize_t};
use hdf5_sys::h5f::{H5F_ACC_RDONLY, H5F_ACC_RDWR, H5F_ACC_TRUNC, H5Fcreate, H5Fopen};
use hdf5_sys::h5fd::H5FDregister;
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5p::H5Pset_driver;
use percute_system::{read_exact_at, write_all_at};
use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_int, c_uint, c_ulong, c_void};
use std::fs::File;
use std::io;
use std::ptr::null;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// A file of HDF5 over an open file.
pub(crate) struct Driven {
    file: hdf5::File,
    channel: Arc<Channel>,
}

/// What went wrong.
pub(crate) enum DriverFault {
    /// A read or write.
    System(io::Error),
    /// HDF5 refuses.
    Library(hdf5::Error),
}

impl DriverFault {
    /// In the creation of a file.
    pub(crate) fn of_creation(self) -> FileCause {
        match self {
            Self::System(source) => FileCause::Create { source },
            Self::Library(error) => refused(&error),
        }
    }

    /// In reading.
    pub(crate) fn of_reading(self) -> FileCause {
        match self {
            Self::System(source) => FileCause::Read { source },
            Self::Library(error) => damaged(error),
        }
    }

    pub(crate) fn text(&self) -> String {
        match self {
            Self::System(error) => error.to_string(),
            Self::Library(error) => detail(error),
        }
    }
}

impl From<hdf5::Error> for DriverFault {
    fn from(error: hdf5::Error) -> Self {
        Self::Library(error)
    }
}

impl Driven {
    /// Creates the contents of an empty file.
    pub(crate) fn create(file: &File, access: &FileAccess, creation: &FileCreate) -> Result<Self, DriverFault> {
        // SAFETY: the name ends with zero, and both property lists are open.
        Self::new(file, access, || unsafe { H5Fcreate(NAME.as_ptr(), H5F_ACC_TRUNC, creation.id(), access.id()) })
    }

    /// Opens a file for reading.
    pub(crate) fn read(file: &File) -> Result<Self, DriverFault> {
        Self::open(file, H5F_ACC_RDONLY)
    }

    /// Opens a file for changes.
    pub(crate) fn change(file: &File) -> Result<Self, DriverFault> {
        Self::open(file, H5F_ACC_RDWR)
    }

    fn open(file: &File, flags: c_uint) -> Result<Self, DriverFault> {
        let access = FileAccess::build().finish()?;
        // SAFETY: the name ends with zero, and the property list is open.
        Self::new(file, &access, || unsafe { H5Fopen(NAME.as_ptr(), flags, access.id()) })
    }

    fn new(file: &File, access: &FileAccess, open: impl FnOnce() -> hid_t) -> Result<Self, DriverFault> {
        let channel = Arc::new(Channel::new(file).map_err(DriverFault::System)?);
        let failed = || DriverFault::Library(hdf5::Error::query().unwrap_or_else(|error| error));
        let opened = hdf5::sync::sync(|| {
            // SAFETY: the property list is open, and the driver takes no information from it.
            if unsafe { H5Pset_driver(access.id(), registered(), null()) } < 0 {
                return Err(failed());
            }
            NEXT.replace(Some(channel.clone()));
            let id = open();
            NEXT.take();
            // SAFETY: the library has made the identifier for us alone.
            if id < 0 { Err(failed()) } else { Ok(unsafe { hdf5::from_id::<hdf5::File>(id) }?) }
        });
        // What the library makes of a read that failed does not matter.
        let file = opened.map_err(|fault| channel.state().fault.take().map_or(fault, DriverFault::System))?;
        Ok(Self { file, channel })
    }

    pub(crate) fn file(&self) -> &hdf5::File {
        &self.file
    }

    /// Closes the file, and gives what was made in it; `told` makes faults errors.
    ///
    /// # Errors
    /// The first write that failed, the error of `made`, a refusal of the library.
    pub(crate) fn close<T, E>(self, made: Result<T, E>, told: impl FnOnce(DriverFault) -> E) -> Result<T, E> {
        let Self { file, channel } = self;
        let closed = file.close();
        match (channel.state().fault.take(), made, closed) {
            (Some(error), ..) => Err(told(DriverFault::System(error))),
            (None, Ok(_), Err(error)) => Err(told(DriverFault::Library(error))),
            (None, made, _) => made,
        }
    }
}

/// An open file and what became of it.
struct Channel {
    file: File,
    state: Mutex<State>,
}

struct State {
    /// Bytes of the file, as HDF5 knows it: a write that failed counts.
    length: u64,
    fault: Option<io::Error>,
}

impl Channel {
    fn new(file: &File) -> io::Result<Self> {
        let state = State { length: file.metadata()?.len(), fault: None };
        Ok(Self { file: file.try_clone()?, state: Mutex::new(state) })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reads from a place; behind the end of the file there are zeros, and anything may be after a write has failed.
    fn read(&self, bytes: &mut [u8], place: u64) -> herr_t {
        let mut state = self.state();
        let there = usize::try_from(state.length.saturating_sub(place)).unwrap_or(usize::MAX).min(bytes.len());
        let (stored, beyond) = bytes.split_at_mut(there);
        beyond.fill(0);
        match read_exact_at(&self.file, stored, place) {
            Ok(()) => DONE,
            Err(_) if state.fault.is_some() => DONE,
            Err(error) => {
                state.fault = Some(error);
                FAILED
            }
        }
    }

    /// Writes, unless a write has failed before.
    fn write(&self, length: impl FnOnce(u64) -> u64, make: impl FnOnce(&File) -> io::Result<()>) {
        let mut state = self.state();
        state.length = length(state.length);
        if state.fault.is_none() {
            state.fault = make(&self.file).err();
        }
    }
}

/// HDF5 asks for a name, and looks at none.
const NAME: &CStr = c"percute";
const DONE: herr_t = 0;
const FAILED: herr_t = -1;

thread_local! {
    /// The file that the library is about to open, in this thread.
    static NEXT: RefCell<Option<Arc<Channel>>> = const { RefCell::new(None) };
}

/// `H5FD_t` of H5FDdevelop.h, version 2.0, with our own part behind it. The library fills the first part in.
#[repr(C)]
struct Open {
    driver: hid_t,
    class: *const Class,
    serial: c_ulong,
    access: c_uint,
    features: c_ulong,
    most: haddr_t,
    base: haddr_t,
    threshold: hsize_t,
    alignment: hsize_t,
    paged: bool,
    channel: Arc<Channel>,
    /// End of what the library has given out.
    end: haddr_t,
}

/// A function that this driver does not have.
type Absent = Option<unsafe extern "C" fn()>;

/// `H5FD_class_t` of the same file.
#[repr(C)]
struct Class {
    version: c_uint,
    value: c_int,
    name: *const c_char,
    most: haddr_t,
    close_degree: c_int,
    terminate: Absent,
    superblock: [Absent; 3],
    access_size: usize,
    access: [Absent; 3],
    transfer_size: usize,
    transfer: [Absent; 2],
    open: unsafe extern "C" fn(*const c_char, c_uint, hid_t, haddr_t) -> *mut Open,
    close: unsafe extern "C" fn(*mut Open) -> herr_t,
    compare: Absent,
    query: unsafe extern "C" fn(*const Open, *mut c_ulong) -> herr_t,
    map: Absent,
    room: [Absent; 2],
    end: unsafe extern "C" fn(*const Open, c_int) -> haddr_t,
    set_end: unsafe extern "C" fn(*mut Open, c_int, haddr_t) -> herr_t,
    length: unsafe extern "C" fn(*const Open, c_int) -> haddr_t,
    handle: Absent,
    read: unsafe extern "C" fn(*mut Open, c_int, hid_t, haddr_t, usize, *mut c_void) -> herr_t,
    write: unsafe extern "C" fn(*mut Open, c_int, hid_t, haddr_t, usize, *const c_void) -> herr_t,
    several: [Absent; 4],
    flush: Absent,
    truncate: unsafe extern "C" fn(*mut Open, hid_t, bool) -> herr_t,
    locks: [Absent; 2],
    others: [Absent; 2],
    free_lists: [c_int; 7],
}

/// The driver of this process.
fn registered() -> hid_t {
    static DRIVER: OnceLock<hid_t> = OnceLock::new();
    *DRIVER.get_or_init(|| {
        let class = Class {
            version: 1,
            // Up to 511 for drivers that are not registered with the library's authors.
            value: 377,
            name: c"percute".as_ptr(),
            most: i64::MAX as haddr_t,
            close_degree: 1,
            terminate: None,
            superblock: [None; 3],
            access_size: 0,
            access: [None; 3],
            transfer_size: 0,
            transfer: [None; 2],
            open,
            close,
            compare: None,
            query,
            map: None,
            room: [None; 2],
            end,
            set_end,
            length,
            handle: None,
            read,
            write,
            several: [None; 4],
            flush: None,
            truncate,
            locks: [None; 2],
            others: [None; 2],
            // Of metadata and of numbers, as the driver that files had before.
            free_lists: [1, 1, 1, 3, 3, 1, 1],
        };
        // SAFETY: the library copies the class, which is laid out as its own.
        unsafe { H5FDregister((&raw const class).cast()) }
    })
}

unsafe extern "C" fn open(_: *const c_char, _: c_uint, _: hid_t, _: haddr_t) -> *mut Open {
    let Some(channel) = NEXT.with_borrow(Clone::clone) else { return std::ptr::null_mut() };
    Box::into_raw(Box::new(Open {
        driver: 0,
        class: null(),
        serial: 0,
        access: 0,
        features: 0,
        most: 0,
        base: 0,
        threshold: 0,
        alignment: 0,
        paged: false,
        channel,
        end: 0,
    }))
}

unsafe extern "C" fn close(file: *mut Open) -> herr_t {
    // SAFETY: it comes from `open`, and the library closes it once.
    drop(unsafe { Box::from_raw(file) });
    DONE
}

/// As the driver of the library for ordinary files: metadata and small numbers share blocks, which keeps the layout of
/// files; small reads share one; any other driver reads the files.
unsafe extern "C" fn query(_: *const Open, features: *mut c_ulong) -> herr_t {
    if !features.is_null() {
        // SAFETY: the library gives a place for the number.
        unsafe { *features = 0x1 | 0x2 | 0x4 | 0x8 | 0x10 | 0x8000 };
    }
    DONE
}

unsafe extern "C" fn end(file: *const Open, _: c_int) -> haddr_t {
    // SAFETY: the file is open, here and below; the library uses it in one thread at a time.
    unsafe { (*file).end }
}

unsafe extern "C" fn set_end(file: *mut Open, _: c_int, end: haddr_t) -> herr_t {
    // SAFETY: as above.
    unsafe { (*file).end = end };
    DONE
}

unsafe extern "C" fn length(file: *const Open, _: c_int) -> haddr_t {
    // SAFETY: as above.
    unsafe { &(*file).channel }.state().length
}

unsafe extern "C" fn read(
    file: *mut Open,
    _: c_int,
    _: hid_t,
    place: haddr_t,
    count: usize,
    to: *mut c_void,
) -> herr_t {
    if count == 0 {
        return DONE;
    }
    // SAFETY: as above; the library owns `count` bytes there, and nobody else sees them.
    let (channel, bytes) = unsafe { (&(*file).channel, std::slice::from_raw_parts_mut(to.cast::<u8>(), count)) };
    channel.read(bytes, place)
}

unsafe extern "C" fn write(
    file: *mut Open,
    _: c_int,
    _: hid_t,
    place: haddr_t,
    count: usize,
    from: *const c_void,
) -> herr_t {
    if count == 0 {
        return DONE;
    }
    // SAFETY: as above; the bytes there do not change during the call.
    let (channel, bytes) = unsafe { (&(*file).channel, std::slice::from_raw_parts(from.cast::<u8>(), count)) };
    let end = place.saturating_add(count as u64);
    channel.write(|length| length.max(end), |to| write_all_at(to, bytes, place));
    DONE
}

/// Gives the file the length of what the library has given out.
unsafe extern "C" fn truncate(file: *mut Open, _: hid_t, _: bool) -> herr_t {
    // SAFETY: as above.
    let (channel, end) = unsafe { (&(*file).channel, (*file).end) };
    if channel.state().length != end {
        channel.write(|_| end, |to| to.set_len(end));
    }
    DONE
}
