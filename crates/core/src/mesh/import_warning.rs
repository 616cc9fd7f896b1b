//! What the user of a mesh should know, though it is no error.

/// Something that was reported, and reoriented or left out, when a mesh was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportWarning {
    /// Its name, for programs.
    pub name: &'static str,
    /// A few words.
    pub brief: String,
    /// What was reported, and what to do if it was not meant.
    pub message: String,
    /// The groups that it is about.
    pub groups: Vec<String>,
}
