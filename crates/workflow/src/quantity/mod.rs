//! Quantities that a run is made for: peak force, impulse, rebound, and fields at points. How they change from mesh to
//! mesh, and why one of them may not converge.

mod field;
mod judge;
mod obstruction;
mod probe;

pub use field::Field;
pub use judge::{Judgement, judge};
pub use obstruction::Obstruction;
pub use probe::{Probe, ProbeSink};

use crate::failure::Failure;
use crate::message::{hint, percent};
use crate::report::{ContactResultants, ObstacleSummary, Report};
use percute_core::mesh::Mesh;
use percute_core::problem::AnyProblem;
use percute_core::units::Units;
use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

/// Smaller changes from mesh to mesh are not worth a sentence: nobody refines for them.
const SMALL: f64 = 0.01;
/// Below this order the limit is three times the last change away, and more.
const SLOW: f64 = 0.4;

/// A quantity of a run, one number.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// Largest normal force of all nodes together (N), averaged over the time in which a wave crosses the struck
    /// element.
    PeakForce,
    /// Normal impulse of all obstacles (N s).
    Impulse,
    /// Normal velocity of the centre of mass after contact (m/s).
    Rebound,
    /// Largest value of a field at a point over time, without its sign.
    Probe(Probe),
}

impl Quantity {
    /// Its unit.
    #[must_use]
    pub fn unit(&self, units: Units) -> &str {
        match self {
            Self::PeakForce => units.of("N"),
            Self::Impulse => units.of("N s"),
            Self::Rebound => "m/s",
            Self::Probe(probe) => probe.field().unit(),
        }
    }

    /// Its name in a sentence.
    #[must_use]
    pub fn told(&self) -> String {
        match self {
            Self::PeakForce => "averaged peak force".to_string(),
            Self::Impulse => "impulse".to_string(),
            Self::Rebound => "rebound".to_string(),
            Self::Probe(probe) => probe.told(),
        }
    }

    /// A sink for the steps of a run of this problem; none if the quantity needs no steps.
    ///
    /// # Errors
    /// A probe that does not fit the body.
    pub fn sink<'p>(&self, problem: &'p AnyProblem) -> Result<Option<ProbeSink<'p>>, Failure> {
        let Self::Probe(probe) = self else { return Ok(None) };
        ProbeSink::new(problem, probe).map(Some).map_err(Failure::Argument)
    }

    /// Its value after a run, from the report and the sink that followed the steps; none without contact, a rebound
    /// without a coefficient of restitution.
    #[must_use]
    pub fn value(&self, report: &Report, sink: Option<&ProbeSink<'_>>) -> Option<f64> {
        let contact = report.contact.as_ref().filter(|contact| contact.first_touch.is_some());
        match self {
            Self::PeakForce => Some(contact?.averaged_peak?.force),
            Self::Impulse => Some(contact?.obstacles.iter().zip(&report.problem.obstacles).map(impulse).sum()),
            Self::Rebound => report.rebound.as_ref().filter(|found| found.restitution.is_some())?.normal_after,
            Self::Probe(_) => sink?.largest(),
        }
    }

    /// What may keep it from converging, from the mesh and the report of the finest run.
    #[must_use]
    pub fn obstruction(&self, mesh: &Mesh, report: &Report) -> Option<Obstruction> {
        match self {
            Self::PeakForce => obstruction::of_force(report),
            Self::Probe(probe) => obstruction::of_probe(probe, mesh),
            Self::Impulse | Self::Rebound => None,
        }
    }

    /// A sentence about a quantity that does not converge or does so slowly, with the reason and the way out if they
    /// are known. None of one that changes by less than 1 %.
    #[must_use]
    pub fn warning(&self, judgement: &Judgement, obstruction: Option<&Obstruction>) -> Option<String> {
        let change = judgement.change.filter(|change| change.abs() > SMALL)?;
        let slow = judgement.order.zip(judgement.remaining).filter(|(order, _)| *order < SLOW);
        let reason = match (obstruction, slow) {
            (Some(found), _) if found.is_of_the_problem() || slow.is_some() || judgement.converges != Some(true) => {
                found.told()
            }
            (_, Some((order, remaining))) => format!(
                "its differences fall like h^{order:.1} only, and the limit is another {} away: take more levels",
                percent(remaining.abs())
            ),
            _ if judgement.converges == Some(false) => {
                let front = "; where a front passes, the largest value over time may have no limit";
                let front = if matches!(self, Self::Probe(_)) { front } else { "" };
                format!("its differences do not fall from mesh to mesh: take more levels{front}")
            }
            _ => return None,
        };
        let (goes, by) = (if change > 0.0 { "grows" } else { "falls" }, percent(change.abs()));
        Some(format!("The {} {goes} by {by} on the finest mesh: {reason}.", self.told()))
    }
}

/// The normal impulse of an obstacle (N s).
fn impulse((resultants, obstacle): (&ContactResultants, &ObstacleSummary)) -> f64 {
    let last = resultants.impulse.last();
    let normal: f64 = last.map_or(0.0, |last| last.iter().zip(&obstacle.normal).map(|(a, b)| a * b).sum());
    // Two surfaces that touch are two obstacles with one impulse.
    if obstacle.point.is_some() { normal } else { 0.5 * normal }
}

/// As it is written.
impl Display for Quantity {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::PeakForce => f.write_str("peak_force"),
            Self::Impulse => f.write_str("impulse"),
            Self::Rebound => f.write_str("rebound"),
            Self::Probe(probe) => write!(f, "probe:{probe}"),
        }
    }
}

impl FromStr for Quantity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.trim() {
            "peak_force" => Ok(Self::PeakForce),
            "impulse" => Ok(Self::Impulse),
            "rebound" => Ok(Self::Rebound),
            probe if probe.contains(':') => probe.parse().map(Self::Probe),
            other => {
                let hint = hint(other, ["peak_force", "impulse", "rebound", "probe"]);
                Err(format!(
                    "there is no quantity {other:?}; give peak_force, impulse, rebound or a probe, as in \
                     probe:0.01,0.02:von_mises{hint}"
                ))
            }
        }
    }
}

/// Probes of a mesh from their texts; `what` names the argument.
///
/// # Errors
/// A text that is no probe, one that does not fit the body, one that is given twice.
pub fn probes(texts: &[String], mesh: &Mesh, what: &str) -> Result<Vec<Probe>, Failure> {
    let refused = |told: String| Failure::Argument(format!("{what}: {told}"));
    let mut found: Vec<Probe> = Vec::new();
    for text in texts {
        let probe: Probe = text.parse().map_err(refused)?;
        probe.around(mesh).map_err(refused)?;
        if found.contains(&probe) {
            return Err(refused(format!("{probe} is given twice; give each probe once")));
        }
        found.push(probe);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn other_words_are_no_quantities(text in "[a-z_ ]{0,12}") {
            if let Err(told) = text.parse::<Quantity>() {
                prop_assert!(told.contains("peak_force, impulse, rebound or a probe"), "{}", told);
            }
        }
    }

    /// Differences that grow, fall slowly, fall, and are small.
    #[test]
    fn only_what_does_not_converge_has_a_warning() {
        let warning = |values: &[f64], found: Option<&Obstruction>| {
            let sizes: Vec<f64> = (0..values.len()).map(|k| 0.5_f64.powi(k as i32)).collect();
            Quantity::PeakForce.warning(&judge(values, &sizes), found)
        };
        let has = |values: &[f64], words: &str| warning(values, None).is_some_and(|told| told.contains(words));
        assert!(has(&[1.0, 2.0, 4.0], "grows by 50.0 % on the finest mesh: its differences do not fall"));
        // Differences 5, 4: h^0.3, and 4/(5/4 − 1) = 16 more.
        assert!(has(&[109.0, 104.0, 100.0], "h^0.3 only, and the limit is another 16.0 % away"));
        assert_eq!([warning(&[7.0, 5.0, 4.0], None), warning(&[1.0, 1.001, 1.003], None)], [None, None]);
        // A corner is said whatever the differences are, a curve only where they do not fall.
        let of = |values: &[f64], found: Obstruction| warning(values, Some(&found));
        assert!(of(&[7.0, 5.0, 4.0], Obstruction::Corner).is_some_and(|told| told.contains("round the corner")));
        assert_eq!(of(&[7.0, 5.0, 4.0], Obstruction::Curve), None);
        assert!(of(&[1.0, 2.0, 4.0], Obstruction::Curve).is_some_and(|told| told.contains("smaller elements")));
    }

    #[test]
    fn quantities_are_read_as_they_are_written() {
        for text in ["peak_force", "impulse", "rebound", "probe:0.01,0.02:von_mises", "probe:1e-9:stress"] {
            assert_eq!(text.parse::<Quantity>().map(|quantity| quantity.to_string()), Ok(text.to_string()));
        }
        let told = "peak-force".parse::<Quantity>().unwrap_err();
        assert!(told.contains("did you mean `peak_force`?"), "{told}");
    }
}
