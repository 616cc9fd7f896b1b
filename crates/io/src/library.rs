//! The HDF5 library.

/// Version of the HDF5 library that is built in: files name it, so that what they hold can be explained.
pub fn hdf5_version() -> String {
    let (major, minor, release) = hdf5::library_version();
    format!("{major}.{minor}.{release}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The library built in is the one that the bindings were made for; a system's older one is not taken in silence.
    #[test]
    fn the_library_is_the_bundled_one() {
        assert!(hdf5_version().starts_with("2."), "HDF5 {}", hdf5_version());
    }
}
