//! Which impacts are looked at, and their names.

use super::body::Body;
use super::study::{Case, ESTIMATED, STEP};
use crate::reproduce::Effort;
use percute_core::material::Hypothesis::{self, PlaneStrain, PlaneStress};

/// Along and across the plane (m/s).
const OBLIQUE: [f64; 2] = [400.0, -400.0];
const NORMAL: [f64; 2] = [0.0, -400.0];
/// Refinements of the references: 160×128 and 320×256 cells of a block, and for one case 640×512: it is that of the
/// independent figures in the estimator's tests.
const REFERENCES: &[usize] = &[5, 6];
const ONE_MORE: &[usize] = &[5, 6, 7];

/// Meshes of the small effort, and of studies of other things than the mesh, which show the last of them.
pub(super) const FEW: usize = 2;

/// Cases that are judged together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Kind {
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
    pub(in super::super) const ALL: [Self; 4] = [Self::Flat, Self::Tilted, Self::Curved, Self::Corner];

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
    pub(in super::super) fn kind(&self) -> Kind {
        match self.body {
            Body::Disc | Body::Rounded => Kind::Curved,
            _ if self.tilt == 0.0 => Kind::Flat,
            // After 3° of turning, the 50 mm of a side arrive within 6.5 µs; after 10° nothing but the corner does.
            _ if self.tilt.abs() < 5.0 => Kind::Tilted,
            _ => Kind::Corner,
        }
    }

    /// The same on few meshes, against the first of the references.
    pub(super) fn few(self) -> Self {
        Self { meshes: FEW, references: &self.references[..1], ..self }
    }

    /// Its name in tables.
    pub(in super::super) fn name(&self) -> String {
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
pub(in super::super) fn cases(effort: &Effort) -> Vec<Case> {
    let block = Case {
        body: Body::Structured,
        hypothesis: PlaneStress,
        friction: 0.2,
        tilt: 0.0,
        velocity: OBLIQUE,
        gap: 0.2e-3,
        end: 13e-6,
        ratio: STEP,
        meshes: ESTIMATED.len(),
        references: REFERENCES,
    };
    let tilted = Case { end: 16e-6, ..block };
    if effort.small {
        return [block, Case { tilt: 3.0, ..tilted }].map(Case::few).to_vec();
    }
    let flat = |hypothesis: Hypothesis| {
        let variants = [0.0, 0.2, 0.5].into_iter().flat_map(|friction| [(friction, OBLIQUE), (friction, NORMAL)]);
        variants.map(move |(friction, velocity)| {
            let case = Case { hypothesis, friction, velocity, ..block };
            if case == block { Case { references: ONE_MORE, ..case } } else { case }
        })
    };
    let mut cases: Vec<Case> = [PlaneStress, PlaneStrain].into_iter().flat_map(flat).collect();
    let unstructured = Case { body: Body::Unstructured, ..block };
    cases.extend([unstructured, Case { hypothesis: PlaneStrain, friction: 0.5, ..unstructured }]);
    cases.extend([3.0, -3.0].map(|tilt| Case { tilt, ..tilted }));
    cases.push(Case { body: Body::Unstructured, tilt: 3.0, ..tilted });
    cases.extend([10.0, -10.0].map(|tilt| Case { tilt, velocity: NORMAL, gap: 0.1e-3, ..tilted }));
    cases.extend([OBLIQUE, NORMAL].map(|velocity| Case { body: Body::Rounded, tilt: 10.0, velocity, ..tilted }));
    cases.extend([OBLIQUE, NORMAL].map(|velocity| Case { body: Body::Disc, velocity, end: 40e-6, ..tilted }));
    cases
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::part::effectivity::study::Found;
    use percute_core::observer::Unobserved;
    use percute_estimator::Reconstruction;

    /// Tables and figure find a case by its name; the small effort computes rows of the full one.
    #[test]
    fn names_are_unique_and_the_small_cases_among_all() {
        let names: Vec<String> = cases(&Effort::FULL).iter().map(Case::name).collect();
        let mut unique = names.clone();
        unique.sort_unstable();
        unique.dedup();
        assert_eq!(unique.len(), names.len());
        for small in cases(&Effort::SMALL) {
            let full = cases(&Effort::FULL).into_iter().find(|case| case.name() == small.name()).unwrap();
            assert!(full.references.starts_with(small.references) && full.meshes >= small.meshes);
            assert_eq!(Case { meshes: full.meshes, references: full.references, ..small }, full);
        }
    }

    /// e_sup/e_ref and e_mean/e_ref of a computation independent of this program, against 160×128 cells.
    #[test]
    fn the_known_case_has_the_known_effectivities() {
        let case = cases(&Effort::SMALL)[0];
        let found: Vec<Found> =
            case.run(&super::super::study::readings(), &mut Unobserved).unwrap().into_iter().flatten().collect();
        let known = [
            (Reconstruction::Consistent, [[1.50, 1.51], [1.26, 1.26]]),
            (Reconstruction::Published, [[1.80, 1.83], [1.78, 1.65]]),
        ];
        for (reading, meshes) in known {
            let r = Reconstruction::ALL.iter().position(|other| *other == reading).unwrap();
            for (found, known) in found.iter().zip(meshes) {
                for (value, known) in found.effectivity(r).into_iter().zip(known) {
                    // Rounded to 0.01; critical steps of both programs, good to 1e-3, move the instants of impact.
                    assert!((value / known - 1.0).abs() < 0.03, "{reading}: {value}, not {known}");
                }
            }
        }
    }
}
