//! Which impacts are looked at, and their names.

use super::body::Body;
use super::study::{Case, ESTIMATED};
use crate::reproduce::Effort;
use percute_core::material::Hypothesis::{self, PlaneStrain, PlaneStress};

/// Along and across the plane (m/s).
const OBLIQUE: [f64; 2] = [400.0, -400.0];
const NORMAL: [f64; 2] = [0.0, -400.0];
/// Refinements of the references: 160×128 and 320×256 cells of a block, and for one case 640×512.
const REFERENCES: &[usize] = &[5, 6];
const ONE_MORE: &[usize] = &[5, 6, 7];
/// Curved bodies: their true error falls nearly as fast as h, so that a coarser reference will do.
const CURVED: &[usize] = &[4, 5];

/// Meshes of the small effort, against the first of the references.
const FEW: usize = 2;

/// Cases that are judged together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A side arrives at once.
    Flat,
    /// A side arrives from one end to the other.
    Tilted,
    /// A curved outline: the contact zone grows and shrinks.
    Curved,
    /// A corner arrives alone.
    Corner,
}

impl Kind {
    /// All of them.
    pub(super) const ALL: [Self; 4] = [Self::Flat, Self::Tilted, Self::Curved, Self::Corner];

    /// Its name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Tilted => "tilted by 3°",
            Self::Curved => "curved",
            Self::Corner => "corner first",
        }
    }
}

impl Case {
    /// With which others it is judged.
    pub(super) fn kind(&self) -> Kind {
        match self.body {
            Body::Disc | Body::Rounded => Kind::Curved,
            _ if self.tilt == 0.0 => Kind::Flat,
            // After 3° of turning, the 50 mm of a side arrive within 6.5 µs; after 10° nothing but the corner does.
            _ if self.tilt.abs() < 5.0 => Kind::Tilted,
            _ => Kind::Corner,
        }
    }

    /// Its name in tables.
    pub(super) fn name(&self) -> String {
        let body = match self.body {
            Body::Structured => "block",
            Body::Unstructured => "unstructured block",
            Body::Rounded => "rounded block",
            Body::Disc => "disc",
        };
        let tilt =
            if self.tilt == 0.0 { String::new() } else { format!(" tilted by {}°", self.tilt).replace('-', "−") };
        let hypothesis = if self.hypothesis == PlaneStrain { "plane strain" } else { "plane stress" };
        let way = if self.velocity == NORMAL { "normal" } else { "oblique" };
        format!("{body}{tilt}, {hypothesis}, μ = {}, {way}", self.friction)
    }
}

/// The cases, the longest last; those of the small effort are some of them, on fewer meshes.
pub(super) fn cases(effort: &Effort) -> Vec<Case> {
    let block = Case {
        body: Body::Structured,
        hypothesis: PlaneStress,
        friction: 0.2,
        tilt: 0.0,
        velocity: OBLIQUE,
        gap: 0.2e-3,
        end: 13e-6,
        meshes: ESTIMATED.len(),
        references: REFERENCES,
    };
    let tilted = Case { end: 16e-6, ..block };
    if effort.small {
        let few = |case: Case| Case { meshes: FEW, references: &case.references[..1], ..case };
        return [block, Case { tilt: 3.0, ..tilted }].map(few).to_vec();
    }
    let flat = |hypothesis: Hypothesis| {
        let variants = [0.0, 0.2, 0.5].into_iter().flat_map(|friction| [(friction, OBLIQUE), (friction, NORMAL)]);
        variants.map(move |(friction, velocity)| Case { hypothesis, friction, velocity, ..block })
    };
    let mut cases: Vec<Case> = [PlaneStress, PlaneStrain].into_iter().flat_map(flat).collect();
    let unstructured = Case { body: Body::Unstructured, ..block };
    cases.extend([unstructured, Case { hypothesis: PlaneStrain, friction: 0.5, ..unstructured }]);
    cases.extend([3.0, -3.0].map(|tilt| Case { tilt, ..tilted }));
    cases.push(Case { body: Body::Unstructured, tilt: 3.0, ..tilted });
    cases.extend([10.0, -10.0].map(|tilt| Case { tilt, velocity: NORMAL, gap: 0.1e-3, ..tilted }));
    let curved = Case { references: CURVED, ..tilted };
    cases.extend([OBLIQUE, NORMAL].map(|velocity| Case { body: Body::Rounded, tilt: 10.0, velocity, ..curved }));
    cases.extend([OBLIQUE, NORMAL].map(|velocity| Case { body: Body::Disc, velocity, end: 40e-6, ..curved }));
    // The one of method and tests, with a third reference.
    let known = |case: &Case| *case == block;
    let first = cases.iter().position(known);
    first.into_iter().for_each(|first| {
        cases.remove(first);
        cases.push(Case { references: ONE_MORE, ..block });
    });
    cases
}
