//! The likely cause of an inconsistency: changes of the history are tried and compared.

use super::complete::Derived;
use super::figures::Consistency;
use super::limits::{BALANCE, Excess, PLACE};
use super::measure::{Evidence, measure};
use super::tried::{FALL, Tried};
use super::units;
use crate::message::{numbered, percent, times, trimmed, vector};
use crate::through::Through;
use percute_core::dynamics::critical_time_step;
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::problem::Problem;
use percute_core::time::is_stable;

/// Energy that drifts by more than this, relatively, comes from unstable steps; the histories of percute have up to
/// 0.02.
const DRIFT: f64 = 0.1;
/// The cause of a history that runs backwards.
pub(crate) const REVERSED: &str = "the order in time is reversed: the last instants fit the initial state";
/// The share of the residual that some nodes must have to be its cause.
const CONCENTRATED: f64 = 0.99;

/// A history with its figures.
pub(super) struct Suspect<'s, const D: usize, const N: usize> {
    pub(super) problem: &'s Problem<D, N>,
    pub(super) source: &'s dyn StepSource<D>,
    pub(super) derived: &'s [Derived],
    pub(super) found: &'s Consistency,
    pub(super) evidence: &'s Evidence<'s, D, N>,
}

impl<const D: usize, const N: usize> Suspect<'_, D, N> {
    /// The likely cause, if the numbers single one out.
    pub(super) fn cause(&self, exceeded: &[Excess]) -> Result<Option<String>, SinkError> {
        let over = |name: &str| exceeded.iter().any(|excess| excess.name == name);
        if let Some(reversed) = self.reversed(over("initial_velocity") || over("initial_displacement")) {
            return Ok(Some(reversed));
        }
        if over("balance") {
            return self.of_the_balance();
        }
        Ok(self.of_the_state(&over))
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
        let told: [(&str, &dyn Fn() -> String); 8] = [
            ("initial_velocity", &|| self.velocity_at_start()),
            ("velocity", &|| {
                "velocities are those of t_n, v_{n-1/2} + a_n dt/2, not of the middle of a step; leave them out"
                    .to_string()
            }),
            ("energy", &|| self.unstable()),
            ("plane", &|| self.plane(false).unwrap_or_default()),
            ("touching", &|| self.touching()),
            ("cone", &|| self.friction("or a normal ")),
            ("slip", &|| self.friction("")),
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
        let [given, stated] = ends.start;
        let factor = ends.given.or(ends.speed).filter(|f| f.is_finite() && (f - 1.0).abs() > BALANCE);
        let factor = factor.map_or(String::new(), |f| format!(", {} the stated one", times(f)));
        format!(
            "`initial_velocity` is not that of the history, which starts with {} m/s on average{factor}; the problem \
             has {} m/s",
            vector(&given, 4),
            vector(&stated, 4)
        )
    }

    /// Nodes under force are at the same distance from their plane.
    fn plane(&self, missing: bool) -> Option<String> {
        let (k, gap) = self.evidence.contact.offset(missing)?;
        let side = if gap > 0.0 { "above" } else { "below" };
        let (which, away) = (self.which(k), trimmed(gap.abs(), 4));
        Some(format!(
            "the `point` of {which} is off by {away} m: nodes under force are {away} m {side} it on average; move it \
             by {} m along its normal",
            trimmed(gap, 4)
        ))
    }

    /// Contact forces that throw nodes off their plane.
    fn unstable(&self) -> String {
        format!(
            "the contact is unstable, and the energy drifts by {}: is a penalty too stiff for the steps? Otherwise the \
             `point` of a plane is not that of the history",
            percent(self.found.energy)
        )
    }

    /// A plane, for messages.
    fn which(&self, k: usize) -> String {
        if self.problem.obstacles().len() > 1 { format!("plane {k} (from 0)") } else { "the plane".to_string() }
    }

    fn touching(&self) -> String {
        let [given, early, late] = self.evidence.contact.disagree.map(|count| count as f64);
        let rest =
            "a node touches at t_{n+1} if and only if a force acts at t_n; leave `touching` out, and it is derived";
        match () {
            () if late <= FALL * given => format!("`touching` is a step late: {rest}"),
            () if early <= FALL * given => format!("`touching` is a step early: {rest}"),
            () => format!("`touching` and the contact forces disagree at {given} nodes and instants: {rest}"),
        }
    }

    fn friction(&self, other: &str) -> String {
        let told = self.evidence.contact.friction().map_or(String::new(), |(k, friction)| {
            let stated = self.problem.obstacles()[k].law().friction();
            format!(
                ": where nodes slide on {}, |R_t|/R_n is {} on average, not {stated}",
                self.which(k),
                trimmed(friction, 4)
            )
        });
        format!("`friction` {other}is not that of the history{told}")
    }

    /// The change that leaves the least residual, if it is little.
    fn of_the_balance(&self) -> Result<Option<String>, SinkError> {
        if let Some(text) = self.accelerations()? {
            return Ok(Some(text));
        }
        let mut tried = self.shifts()?;
        tried.extend(units::scales(self.evidence, self.derived));
        tried.extend(self.orders()?);
        let best = tried.into_iter().min_by(|a, b| a.left.total_cmp(&b.left));
        if let Some(Tried { text, left }) = best.filter(|best| best.left <= FALL * self.residual()) {
            return Ok(Some(format!("{text}; with that the residual is {}", percent(left))));
        }
        Ok(self.samples().or_else(|| self.nodes()))
    }

    /// The norm of the residual, relative.
    fn residual(&self) -> f64 {
        self.evidence.residual.norm([1.0; 4])
    }

    fn tried(&self, source: &dyn StepSource<D>, shift: isize, text: String) -> Result<Tried, SinkError> {
        let (_, evidence) = measure(self.problem, source, self.derived, shift)?;
        Ok(Tried { text, left: evidence.residual.norm([1.0; 4]) })
    }

    /// Given accelerations without which the history is consistent.
    fn accelerations(&self) -> Result<Option<String>, SinkError> {
        let Some(differs) = self.found.acceleration.filter(|differs| *differs > BALANCE) else { return Ok(None) };
        let without = Through::new(self.source, |step, take| take(&Step { acceleration: None, ..*step }));
        let text = format!(
            "the accelerations are not those of the displacements, they differ by {} of the largest; leave them out",
            percent(differs)
        );
        let tried = self.tried(&without, 0, text)?;
        Ok((tried.left <= FALL * self.residual()).then_some(tried.text))
    }

    fn shifts(&self) -> Result<Vec<Tried>, SinkError> {
        if self.derived.contains(&Derived::Reaction) {
            return Ok(Vec::new());
        }
        let told = [(1, "late", "R_{n+1}"), (-1, "early", "R_{n-1}")];
        let tried = told.map(|(shift, when, row)| {
            let text =
                format!("the contact forces are a step too {when}: the row of t_n should hold what is given as {row}");
            self.tried(self.source, shift, text)
        });
        tried.into_iter().collect()
    }

    /// Other orders of the nodes: all reversed, or the two with the largest residual exchanged.
    fn orders(&self) -> Result<Vec<Tried>, SinkError> {
        let count = self.evidence.residual.by_node.len();
        let worst = self.worst();
        let mut exchanged: Vec<usize> = (0..count).collect();
        exchanged.swap(worst[0], worst[1]);
        let told = [
            ((0..count).rev().collect(), "the displacements are in the opposite order of the nodes".to_string()),
            (exchanged, format!("the displacements of nodes {} and {} are exchanged", worst[0], worst[1])),
        ];
        let tried = told.map(|(rows, text): (Vec<usize>, String)| {
            let reordered = Through::new(self.source, |step, take| {
                let of = |field: &[[f64; D]]| rows.iter().map(|&row| field[row]).collect::<Vec<_>>();
                let (displacement, acceleration) = (of(step.displacement), step.acceleration.map(of));
                take(&Step { displacement: &displacement, acceleration: acceleration.as_deref(), ..*step })
            });
            self.tried(&reordered, 0, text)
        });
        tried.into_iter().collect()
    }

    /// The nodes with the largest residuals, the largest first.
    fn worst(&self) -> Vec<usize> {
        let squares = &self.evidence.residual.by_node;
        let mut order: Vec<usize> = (0..squares.len()).collect();
        order.sort_by(|&a, &b| squares[b].total_cmp(&squares[a]));
        order
    }

    /// Instants that are farther apart than any stable step.
    fn samples(&self) -> Option<String> {
        let (step, critical) = (self.source.times().longest_step(), critical_time_step(self.problem));
        (!is_stable(step, critical)).then(|| {
            format!(
                "the instants are {} critical steps apart: they are samples, not the steps of the solver; give \
                 velocities and accelerations too",
                trimmed(step / critical, 4)
            )
        })
    }

    /// Nodes that have most of the residual.
    fn nodes(&self) -> Option<String> {
        let squares = &self.evidence.residual.by_node;
        let total: f64 = squares.iter().sum();
        let surface = self.problem.surface().nodes().iter().zip(&self.evidence.contact.forced);
        let silent: Vec<usize> = surface.filter(|(_, forced)| !**forced).map(|(c, _)| c.node.index()).collect();
        let share = |nodes: &[usize]| nodes.iter().map(|&node| squares[node]).sum::<f64>() / total;
        if share(&silent) >= CONCENTRATED {
            let place = units::displacements(self.evidence).or_else(|| self.plane(true));
            if place.is_some() {
                return place;
            }
            let missing = silent.into_iter().filter(|&node| squares[node] > 1e-6 * total);
            let nodes = numbered("node", &missing.collect::<Vec<_>>());
            return Some(format!("the contact forces of {nodes} are missing: a force acts there by the balance"));
        }
        let order = self.worst();
        let most = order.len() / 3;
        if share(&order[..most]) >= CONCENTRATED {
            let few = numbered("node", &order[..most]);
            return Some(format!(
                "few nodes have almost all of it ({few}): their rows, supports, loads or materials differ"
            ));
        }
        (self.found.balance > 0.3).then(|| {
            "the displacements do not fit the mesh and its material: is the order of the nodes that of the mesh, and \
             are all units those of SI?"
                .to_string()
        })
    }
}
