//! At which steps the error is sampled.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::num::NonZeroUsize;
use std::str::FromStr;
use thiserror::Error;

/// With `auto`, so many elements for each step from sample to sample: on a mesh of few elements η fluctuates from step
/// to step. The sup and the mean of all cases of the evidence then differ by less than 1 % from those of all steps
/// (docs/speed.md).
const ELEMENTS: usize = 1400;
/// With `auto`, the most steps from sample to sample are the root of the number of elements over this. A wave crosses a
/// plane mesh of that many elements in a number of steps near this root.
const CROSSING: f64 = 6.0;
/// With `auto`, a run has at least so many intervals between samples, as far as it has steps.
const INTERVALS: usize = 32;
/// The name of [`Sampling::Auto`].
const AUTO: &str = "auto";

/// At which steps the error is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// Around onset, release and peaks of the contact force, and between them as sparsely as keeps the mean: at each
    /// step on small meshes, at about one in 30 on 40 000 elements.
    #[default]
    Auto,
    /// At every half-step instant if 1, else at t_0, t_k, t_2k, … and at the end, so that the mean covers the whole
    /// run.
    Every(usize),
}

impl Sampling {
    /// Maps may be requested at each multiple of this step: all with `auto`, which samples the steps requested as well.
    #[must_use]
    pub fn stride(self) -> usize {
        match self {
            Self::Auto => 1,
            Self::Every(steps) => steps.max(1),
        }
    }

    /// Steps from sample to sample, away from changes of contact, on a mesh of so many elements over so many steps.
    #[must_use]
    pub fn spacing(self, elements: usize, steps: usize) -> usize {
        match self {
            Self::Auto => {
                let part_of_crossing = ((elements as f64).sqrt() / CROSSING) as usize;
                (elements / ELEMENTS).min(part_of_crossing).min(steps / INTERVALS).max(1)
            }
            Self::Every(steps) => steps.max(1),
        }
    }
}

impl fmt::Display for Sampling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str(AUTO),
            Self::Every(steps) => write!(f, "{steps}"),
        }
    }
}

/// A text that names no sampling.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("must be \"{AUTO}\" or a whole number of steps, 1 or more")]
pub struct UnknownSampling;

impl FromStr for Sampling {
    type Err = UnknownSampling;

    fn from_str(text: &str) -> Result<Self, UnknownSampling> {
        match text {
            AUTO => Ok(Self::Auto),
            _ => text.parse::<NonZeroUsize>().map(|steps| Self::Every(steps.get())).map_err(|_| UnknownSampling),
        }
    }
}

/// The form in reports: a name or a number.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Written {
    Steps(usize),
    Name(Name),
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Name {
    Auto,
}

impl Serialize for Sampling {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let steps = match self {
            Self::Auto => None,
            Self::Every(steps) => Some(*steps),
        };
        if serializer.is_human_readable() {
            steps.map_or(Written::Name(Name::Auto), Written::Steps).serialize(serializer)
        } else {
            steps.serialize(serializer)
        }
    }
}

impl<'de> Deserialize<'de> for Sampling {
    fn deserialize<R: Deserializer<'de>>(deserializer: R) -> Result<Self, R::Error> {
        let steps = if deserializer.is_human_readable() {
            match Written::deserialize(deserializer)? {
                Written::Steps(steps) => Some(steps),
                Written::Name(Name::Auto) => None,
            }
        } else {
            Option::deserialize(deserializer)?
        };
        Ok(steps.map_or(Self::Auto, Self::Every))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_round_trip() {
        for sampling in [Sampling::Auto, Sampling::Every(1), Sampling::Every(70)] {
            assert_eq!(sampling.to_string().parse(), Ok(sampling));
        }
        for wrong in ["0", "-1", "1.5", "", "Auto", "all"] {
            assert_eq!(wrong.parse::<Sampling>(), Err(UnknownSampling), "{wrong}");
        }
    }

    #[test]
    fn the_spacing_grows_with_the_mesh_and_leaves_enough_samples() {
        let auto = |elements, steps| Sampling::Auto.spacing(elements, steps);
        let counts = [1, 640, 2799, 5824, 40_960, 655_360];
        assert_eq!(counts.map(|elements| auto(elements, 10_000)), [1, 1, 1, 4, 29, 134]);
        assert_eq!([0, 31, 63, 320, 5000].map(|steps| auto(1_000_000, steps)), [1, 1, 1, 10, 156]);
        assert_eq!(Sampling::Every(7).spacing(1_000_000, 3), 7);
    }
}
