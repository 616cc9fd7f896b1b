//! Probes: the largest value of a field at a point over time.

use super::field::Field;
use crate::message::{counted, short, vector};
use percute_core::border::{Vector, row};
use percute_core::history::{SinkError, State, StateSink};
use percute_core::mesh::{Around, Mesh};
use percute_core::problem::AnyProblem;
use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

/// A probe as it is written.
const EXAMPLE: &str = "0.01,0.02:von_mises";

/// A field at a point of the undeformed body. Its value is the largest over time, without its sign.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    point: Vec<f64>,
    field: Field,
}

impl Probe {
    /// Its point in the undeformed body (m).
    #[must_use]
    pub fn point(&self) -> &[f64] {
        &self.point
    }

    /// The point in a mesh; none of another dimension.
    pub(super) fn place(&self, mesh: &Mesh) -> Option<Vector> {
        (self.point.len() == mesh.dimension()).then(|| row(&self.point, 0, mesh.dimension()))
    }

    /// Its field.
    #[must_use]
    pub fn field(&self) -> Field {
        self.field
    }

    /// The probe in words.
    #[must_use]
    pub fn told(&self) -> String {
        format!("{} at {}", self.field.told(), vector(&self.point, 6))
    }

    /// The elements of a mesh that contain it.
    ///
    /// # Errors
    /// A point of another dimension or outside the body, a field that such bodies do not have.
    pub fn around(&self, mesh: &Mesh) -> Result<Vec<Around>, String> {
        let d = mesh.dimension();
        let (body, needed) = if d == 1 { ("a bar", "one coordinate") } else { ("a plane body", "two coordinates") };
        let name = self.field.name();
        let Some(point) = self.place(mesh) else {
            let example = if d == 1 { "0.1:stress" } else { EXAMPLE };
            let given = counted(self.point.len(), "coordinate");
            return Err(format!("the point of {self} has {given}; {body} needs {needed} (m), as in {example}"));
        };
        if !self.field.is_of(d) {
            return Err(format!("{body} has no field {name:?}; {}", Field::choose(name, &[d])));
        }
        let around = mesh.around(&point);
        if around.is_empty() {
            let (nearest, distance) = mesh.nearest_of_outline(&point);
            return Err(format!(
                "the point of {self} is {} m outside the undeformed body; its nearest point is {} (m)",
                short(distance, 3),
                vector(&nearest[..d], 6)
            ));
        }
        Ok(around)
    }
}

/// As it is written.
impl Display for Probe {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let point: Vec<String> = self.point.iter().map(|&x| shortest(x)).collect();
        write!(f, "{}:{}", point.join(","), self.field.name())
    }
}

/// A number in the fewest digits that give it back.
fn shortest(x: f64) -> String {
    let (decimal, exponential) = (format!("{}", x + 0.0), format!("{:e}", x + 0.0));
    if decimal.len() <= exponential.len() + 3 { decimal } else { exponential }
}

impl FromStr for Probe {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let given = text.trim();
        let Some((point, field)) = given.strip_prefix("probe:").unwrap_or(given).rsplit_once(':') else {
            return Err(format!("{given:?} has no field; give point (m) and field, as in {EXAMPLE}"));
        };
        let coordinate = |text: &str| {
            let text = text.trim();
            let number = text.parse::<f64>().ok().filter(|x| x.is_finite());
            number.ok_or_else(|| {
                format!(
                    "the coordinate {text:?} of {given:?} is no number; give numbers in m without a unit, as in \
                     {EXAMPLE}"
                )
            })
        };
        let point = point.split(',').map(coordinate).collect::<Result<_, _>>()?;
        Ok(Self { point, field: field.trim().parse()? })
    }
}

/// Follows a probe at each step of a run.
#[derive(Clone, Debug)]
pub struct ProbeSink<'p> {
    problem: &'p AnyProblem,
    around: Vec<Around>,
    field: Field,
    largest: Option<f64>,
}

impl<'p> ProbeSink<'p> {
    /// That of a problem.
    ///
    /// # Errors
    /// As [`Probe::around`].
    pub fn new(problem: &'p AnyProblem, probe: &Probe) -> Result<Self, String> {
        Ok(Self { problem, around: probe.around(problem.mesh())?, field: probe.field, largest: None })
    }

    /// The largest value so far, without its sign; none before the first step.
    #[must_use]
    pub fn largest(&self) -> Option<f64> {
        self.largest
    }
}

impl StateSink for ProbeSink<'_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let value = self.field.at(self.problem, &self.around, state).abs();
        self.largest = Some(self.largest.map_or(value, |largest| largest.max(value)));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whatever is printed is read again, bit by bit.
        #[test]
        fn a_probe_is_read_as_it_is_written(
            point in prop::collection::vec(any::<f64>().prop_filter("finite", |x| x.is_finite()), 1..3),
            field in prop::sample::select(&Field::ALL[..]),
        ) {
            let point: Vec<f64> = point.into_iter().map(|x| x + 0.0).collect();
            let probe = Probe { point, field };
            prop_assert_eq!(probe.to_string().parse::<Probe>(), Ok(probe.clone()));
            prop_assert_eq!(format!("probe:{probe}").parse::<Probe>(), Ok(probe));
        }

        /// No text makes it panic, and each refusal says what is needed.
        #[test]
        fn other_texts_are_refused_with_a_remedy(text in ".{0,20}|[0-9e.,:+-]{0,12}:[a-z_]{0,9}") {
            if let Err(told) = text.parse::<Probe>() {
                prop_assert!(told.contains(EXAMPLE) || told.contains("choose from"), "{}", told);
            }
        }
    }

    #[test]
    fn a_probe_must_fit_the_body() {
        let plane = Mesh::rectangle(0.05, 0.04, 2, 2).unwrap();
        let bar = Mesh::uniform_bar(0.1, 4).unwrap();
        let refused = |text: &str, words: &[&str]| {
            let probe = text.parse::<Probe>();
            let told = probe.and_then(|probe| probe.around(&plane).map(drop)).unwrap_err();
            assert!(words.iter().all(|word| told.contains(word)), "{text}: {told}");
        };
        refused("0.01:von_mises", &["1 coordinate;", "two coordinates (m)", EXAMPLE]);
        refused("0.01,0.02,0.03:von_mises", &["3 coordinates", EXAMPLE]);
        refused("0.01,0.02", &["no field", EXAMPLE]);
        refused("0.01,nan:von_mises", &["\"nan\"", "no number", EXAMPLE]);
        refused("10mm,0:von_mises", &["\"10mm\"", "in m without a unit"]);
        refused("0.01,0.02:vonmises", &["\"vonmises\"", "did you mean `von_mises`?"]);
        refused("0.01,0.02:stress", &["a plane body has no field \"stress\"", "stress_xx"]);
        refused("0.06,0.02:von_mises", &["0.01", "outside the undeformed body", "(0.05, 0.02)"]);
        let of_bar = |text: &str| text.parse::<Probe>().and_then(|probe| probe.around(&bar).map(|around| around.len()));
        assert_eq!([of_bar("0.05:stress"), of_bar("0.06:stress")], [Ok(2), Ok(1)]);
        assert!(of_bar("0.05:stress_xx").is_err_and(|told| told.contains("a bar has no field \"stress_xx\"")));
        assert!(of_bar("0.2:stress").is_err_and(|told| told.contains("its nearest point is 0.1 (m)")));
    }
}
