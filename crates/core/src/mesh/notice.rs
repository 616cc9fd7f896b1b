//! What the user of a mesh should know, though it is no error.

/// Something that was noticed, and mended or left out, when a mesh was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// Its name, for programs.
    pub name: &'static str,
    /// A few words.
    pub brief: String,
    /// What was noticed, and what to do if it was not meant.
    pub message: String,
    /// The groups that it is about.
    pub groups: Vec<String>,
}
