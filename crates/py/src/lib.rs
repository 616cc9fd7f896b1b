//! The extension module `percute._percute`; the package around it is `python/percute`.

/// What the Python package `percute` is made of; use the package.
#[pyo3::pymodule]
mod _percute {
    use pyo3::prelude::*;
    use std::ffi::OsString;

    /// Adds what is no function.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }

    /// Runs the command `percute` with these arguments, the program's name first, as the process's
    /// own: it prints to standard output and error and takes Ctrl-C over. Returns the exit code.
    #[pyfunction]
    fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
        py.detach(|| percute::process(arguments))
    }
}
