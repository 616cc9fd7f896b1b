//! What an estimate file holds.

use super::{Info, writer};
use crate::message::{bytes, counted, percent, short, trimmed};
use crate::report::summary::counts;
use crate::report::{FORMAT, Versions, units_of};
use percute_io::Provenance;
use percute_io::estimate_file::EstimateFile;
use serde::Serialize;
use serde_json::Value;
use std::path::Path;

/// An estimate.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct EstimateInfo {
    pub format: u32,
    pub versions: Versions,
    pub file: String,
    pub written_by: Provenance,
    pub case: Option<String>,
    pub dimension: usize,
    pub nodes: usize,
    pub elements: usize,
    pub instants: Vec<f64>,
    pub fields: bool,
    pub bytes: u64,
    pub report: Value,
}

/// What an estimate file holds.
#[must_use]
pub fn of_estimate(path: &Path, file: &EstimateFile) -> Info {
    Info::Estimate(Box::new(EstimateInfo {
        format: FORMAT,
        versions: Versions::of_this_program(),
        file: path.display().to_string(),
        written_by: file.provenance.clone(),
        case: file.case.as_ref().map(|case| case.name.clone()),
        dimension: file.dimension,
        nodes: file.nodes,
        elements: file.elements,
        instants: file.instants.clone(),
        fields: file.fields,
        bytes: file.bytes,
        // A report of another program is no reason to say nothing.
        report: serde_json::from_str(&file.report).unwrap_or_default(),
    }))
}

impl EstimateInfo {
    pub(super) fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines =
            vec![("estimate", format!("{}, {}", self.file, bytes(self.bytes))), ("written", writer(&self.written_by))];
        lines.extend(self.case.as_ref().map(|case| ("case", case.clone())));
        lines.push(("body", counts(self.dimension, self.elements, self.nodes)));
        lines.push(("holds", "the error over time and of each element;".to_string()));
        lines.push(("", self.maps()));
        if let [Some(sup), Some(mean)] = ["sup", "mean"].map(|key| self.report["error"][key].as_f64()) {
            let norm = units_of(&self.report).of("J^½");
            lines.push(("error", format!("sup {} {norm}, mean {} {norm}", short(sup, 4), short(mean, 4))));
        }
        lines.extend(self.yielded().map(|yielded| ("yielded", yielded)));
        let uses = "percute report writes its page, percute plot draws it, percute.open reads it in Python";
        lines.push(("use", uses.to_string()));
        lines
    }

    /// How much yielded, or how near it is to yielding; nothing without a yield stress.
    fn yielded(&self) -> Option<String> {
        let found = &self.report["deformation"]["yielding"];
        let (share, ratio) = (found["share"].as_f64()?, found["stress_ratio"].as_f64()?);
        let stress = format!("stress at most {} of the yield stress", percent(ratio));
        Some(match found["equivalent_strain"].as_f64() {
            _ if share == 0.0 => format!("nothing: {stress}"),
            Some(strain) => format!("{} of the volume, plastic strain at most {}", percent(share), percent(strain)),
            None => format!("{stress}, above it in {} of the volume", percent(share)),
        })
    }

    /// The maps of the elements at chosen instants.
    fn maps(&self) -> String {
        let (Some(first), Some(last)) = (self.instants.first(), self.instants.last()) else {
            return "no maps at instants: `instants` of the estimate makes them".to_string();
        };
        let [first, last] = [first, last].map(|instant| trimmed(*instant, 5));
        let fields = if self.fields { ", with the admissible fields" } else { "" };
        format!("maps at {} from {first} to {last} s{fields}", counted(self.instants.len(), "instant"))
    }
}
