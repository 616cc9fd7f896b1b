//! The likely cause of an inconsistency.

use super::attempt::FALL;
use super::complete::Derived;
use super::diagnosis::Diagnosis;
use super::limits::{BALANCE, DRIFT, Excess, PLACE, THROUGH_PLANES, by_a_penalty};
use super::nearness::NEAR;
use super::{of_balance, penalty, planes, skipped, systems, units};
use crate::message::{percent, times, trimmed, vector};
use percute_core::history::SinkError;

/// The cause of a history that runs backwards.
pub(crate) const REVERSED: &str = "the order in time is reversed: the last instants fit the initial state";

impl Diagnosis<'_> {
    /// The likely cause, if the numbers single one out.
    pub(super) fn cause(&self, exceeded: &[Excess]) -> Result<Option<String>, SinkError> {
        let over = |name: &str| exceeded.iter().any(|excess| excess.name == name);
        if let Some(reversed) = self.reversed(over("initial_velocity") || over("initial_displacement")) {
            return Ok(Some(reversed));
        }
        if let Some(shift) = self.evidence.ends.shift(self.problem).filter(|_| over("initial_displacement")) {
            return Ok(Some(shift));
        }
        if (over("balance") || over("initial_velocity"))
            && let Some(text) = systems::whole(self)?
        {
            return Ok(Some(text));
        }
        if over("balance") || over("long_step") {
            if !over("initial_displacement") {
                return of_balance::cause(self);
            }
            if let Some(text) = of_balance::changed(self)? {
                return Ok(Some(text));
            }
        }
        if ["velocity", "touching", "slip", "gap_under_force"].into_iter().any(over)
            && let Some(text) = skipped::skipped(self)?
        {
            return Ok(Some(text));
        }
        Ok(self.of_the_state(&over))
    }

    /// All arrays in another system of units, or the change that leaves the least residual.
    pub(super) fn in_other_units(&self) -> Result<Option<String>, SinkError> {
        let whole = systems::whole(self)?;
        if whole.is_some() { Ok(whole) } else { of_balance::changed(self) }
    }

    /// The end is the start, with the opposite velocity.
    fn reversed(&self, wrong: bool) -> Option<String> {
        let ([speed, place], found) = (self.evidence.ends.reversed, self.found);
        // A file takes u_0 from its first instant, which then says nothing.
        let there = found.initial_displacement <= PLACE || place <= FALL * found.initial_displacement;
        (wrong && there && speed <= FALL).then(|| REVERSED.to_string())
    }

    fn of_the_state(&self, over: &dyn Fn(&str) -> bool) -> Option<String> {
        if over("initial_displacement") {
            return Some(
                "the first displacements are not those of `initial_displacement`; give the history from t_0 on"
                    .to_string(),
            );
        }
        if let Some(text) = self.evidence.rates.cause().filter(|_| over("velocity")) {
            return Some(text);
        }
        let told: [(&str, &dyn Fn() -> String); 10] = [
            ("initial_velocity", &|| self.velocity_at_start()),
            (penalty::UNSTABLE, &|| self.unstable()),
            ("energy", &|| self.unstable()),
            (THROUGH_PLANES, &|| self.without_contact()),
            ("interface_balance", &|| self.evidence.contact.unbalanced_interface()),
            ("plane", &|| planes::place(self, false).unwrap_or_default()),
            ("touching", &|| self.touching()),
            ("cone", &|| planes::friction(self, "or a normal ")),
            ("slip", &|| planes::friction(self, "")),
            ("gap", &|| "the `point` of a plane, or the unit of length, is not that of the history".to_string()),
        ];
        let off = over("plane") || over("gap_under_force") || over("penetration");
        let over = |name: &str| match name {
            "energy" => off && self.found.energy > DRIFT,
            "gap" => off,
            name => over(name),
        };
        told.into_iter().find(|(name, _)| over(name)).map(|(_, text)| text())
    }

    fn velocity_at_start(&self) -> String {
        let ends = &self.evidence.ends;
        if let Some(text) = units::displacements(self.evidence) {
            return text;
        }
        let [given, stated] = ends.start.map(|start| vector(&start[..self.problem.dimension()], 4));
        let factor = ends.multiple.filter(|f| f.is_finite() && (f - 1.0).abs() > BALANCE);
        let factor = factor.map_or(String::new(), |f| format!(", {} the stated one", times(f)));
        format!(
            "`initial_velocity` is not that of the history, which starts with {given} m/s on average{factor}; the \
             problem has {stated} m/s"
        )
    }

    /// Contact forces that throw nodes off their plane.
    fn unstable(&self) -> String {
        let drift = percent(self.found.energy);
        match penalty::cause(self).filter(|_| by_a_penalty(self.found)) {
            Some(text) => format!("{text}. The energy drifts by {drift}"),
            None => format!(
                "the contact is unstable, and the energy drifts by {drift}: is a penalty too stiff for the steps? \
                 Otherwise the `point` of a plane is not that of the history"
            ),
        }
    }

    fn without_contact(&self) -> String {
        let [through, or] = match self.problem.conditions().interfaces.is_empty() {
            true => ["their plane", "the `point` of the plane is not that"],
            false => ["another body", "the places of the bodies are not those"],
        };
        format!(
            "nodes go through {through} without contact: it is left out of the simulation or of the history, or {or} \
             of the history"
        )
    }

    fn touching(&self) -> String {
        let [given, early, late] = self.evidence.contact.disagree.map(|count| count as f64);
        let rest =
            "a node touches at t_{n+1} if and only if a force acts at t_n; leave `touching` out, and it is derived";
        match () {
            () if self.derived.contains(&Derived::Touching) => format!(
                "contact forces act at {given} nodes and instants where the node is more than {} of an element above \
                 its plane one step later: are displacements and forces of the same run, and exact to that?",
                trimmed(NEAR, 1)
            ),
            () if late <= FALL * given => format!("`touching` is a step late: {rest}"),
            () if early <= FALL * given => format!("`touching` is a step early: {rest}"),
            () => format!("`touching` and the contact forces disagree at {given} nodes and instants: {rest}"),
        }
    }
}
