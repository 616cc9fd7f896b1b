//! Warnings from the import of a mesh.

/// A change that the import made to a mesh, or a part of the file that it left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportWarning {
    /// Its name, for programs.
    pub name: &'static str,
    /// A short form of the message.
    pub brief: String,
    /// The change, and the remedy if it was not intended.
    pub message: String,
    /// The groups concerned.
    pub groups: Vec<String>,
}
