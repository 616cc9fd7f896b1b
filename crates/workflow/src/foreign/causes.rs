//! The likely cause of an inconsistency: changes of the history are tried and compared.

use super::limits::{BALANCE, Excess, PLACE};
use super::measure::{Consistency, Evidence, Reordered, Trial, measure};
use crate::message::{numbered, percent, times, trimmed, vector};
use percute_core::dynamics::critical_time_step;
use percute_core::history::{SinkError, StepSource};
use percute_core::problem::Problem;
use percute_core::time::is_stable;

/// A change must leave less than this share of the residual to be named.
const FALL: f64 = 0.2;
/// Two numbers that agree to this, relatively, are taken for equal.
const AGREE: f64 = 0.02;
/// The share of the residual that some nodes must have to be its cause.
const CONCENTRATED: f64 = 0.99;

/// A history with its figures.
pub(crate) struct Suspect<'s, const D: usize, const N: usize> {
    pub(crate) problem: &'s Problem<D, N>,
    pub(crate) source: &'s dyn StepSource<D>,
    pub(crate) found: &'s Consistency,
    pub(crate) evidence: &'s Evidence<D>,
}

/// A change with what it leaves of the residual.
struct Tried {
    text: String,
    balance: f64,
}

impl<const D: usize, const N: usize> Suspect<'_, D, N> {
    /// The likely cause, if the numbers single one out.
    pub(crate) fn cause(&self, exceeded: &[Excess]) -> Result<Option<String>, SinkError> {
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
        let [speed, place] = self.evidence.reversed;
        let better =
            speed <= FALL * self.found.initial_velocity && place <= PLACE.max(FALL * self.found.initial_displacement);
        (wrong && better).then(|| "the order in time is reversed: the last instants fit the initial state".to_string())
    }

    fn of_the_state(&self, over: &dyn Fn(&str) -> bool) -> Option<String> {
        let text = if over("initial_displacement") {
            "the first displacements are not those of `initial_displacement`; give the history from t_0 on".to_string()
        } else if over("initial_velocity") {
            let [given, stated] = self.evidence.start;
            let factor = self.evidence.speed.filter(|f| f.is_finite() && (f - 1.0).abs() > BALANCE);
            let factor = factor.map_or(String::new(), |f| format!(", {} the stated one", times(f)));
            format!(
                "`initial_velocity` is not that of the history, which starts with {} m/s on average{factor}; the problem has {} m/s",
                vector(&given, 4),
                vector(&stated, 4)
            )
        } else if over("velocity") {
            "velocities are those of t_n, v_{n-1/2} + a_n dt/2, not of the middle of a step; leave them out".to_string()
        } else if over("touching") {
            "`touching` at t_{n+1} must be true where a force acts at t_n; leave it out, and it is derived".to_string()
        } else if over("cone") {
            "`friction` or a normal is not that of the history".to_string()
        } else if over("gap_under_force") || over("penetration") {
            "the `point` of a plane, or the unit of length, is not that of the history".to_string()
        } else {
            return None;
        };
        Some(text)
    }

    /// The change that leaves the least residual, if it is little.
    fn of_the_balance(&self) -> Result<Option<String>, SinkError> {
        let mut tried = self.shifts()?;
        tried.extend(self.scales()?);
        tried.extend(self.orders()?);
        let best = tried.into_iter().min_by(|a, b| a.balance.total_cmp(&b.balance));
        if let Some(Tried { text, balance }) = best.filter(|best| best.balance <= FALL * self.found.balance) {
            return Ok(Some(format!("{text}; with that the residual is {}", percent(balance))));
        }
        Ok(self.samples().or_else(|| self.nodes()))
    }

    fn tried(&self, trial: Trial, text: String) -> Result<Tried, SinkError> {
        let (found, _) = measure(self.problem, self.source, trial)?;
        Ok(Tried { text, balance: if found.balance.is_nan() { f64::INFINITY } else { found.balance } })
    }

    fn shifts(&self) -> Result<Vec<Tried>, SinkError> {
        let told = [(1, "late", "R_{n+1}"), (-1, "early", "R_{n-1}")];
        let tried = told.map(|(shift, when, row)| {
            let text =
                format!("the contact forces are a step too {when}: the row of t_n should hold what is given as {row}");
            self.tried(Trial { shift, ..Trial::default() }, text)
        });
        tried.into_iter().collect()
    }

    /// Factors of R, M and K.
    fn scales(&self) -> Result<Vec<Tried>, SinkError> {
        let [of_r, of_m, of_k] = self.evidence.best;
        let mut tried = vec![self.tried(Trial { factors: [of_r, 1.0, 1.0], ..Trial::default() }, force(of_r))?];
        if of_m > 0.0 {
            let trial = Trial { factors: [1.0, of_m, 1.0], ..Trial::default() };
            tried.push(self.tried(trial, self.mass(of_m))?);
        }
        if of_k > 0.0 {
            let text = format!("`young` is not that of the history: it should be {} as large", times(of_k));
            tried.push(self.tried(Trial { factors: [1.0, 1.0, of_k], ..Trial::default() }, text)?);
        }
        Ok(tried)
    }

    /// Another mass, or other times: the velocity at the start tells which.
    fn mass(&self, factor: f64) -> String {
        let scale = factor.sqrt();
        match self.evidence.speed {
            Some(speed) if (speed * scale - 1.0).abs() <= AGREE && (scale - 1.0).abs() > 0.5 * BALANCE => {
                format!("`time` is not that of the history: the steps should be {} as long", times(1.0 / scale))
            }
            Some(_) => format!("`density` is not that of the history: it should be {} as large", times(factor)),
            None => format!(
                "`density` or `time` is not that of the history: the density should be {} as large, or the \
                 steps {} as long",
                times(factor),
                times(1.0 / scale)
            ),
        }
    }

    /// Other orders of the nodes: all reversed, or the two with the largest residual exchanged.
    fn orders(&self) -> Result<Vec<Tried>, SinkError> {
        let count = self.evidence.by_node.len();
        let worst = self.worst();
        let mut exchanged: Vec<usize> = (0..count).collect();
        exchanged.swap(worst[0], worst[1]);
        let told = [
            ((0..count).rev().collect(), "the displacements are in the opposite order of the nodes".to_string()),
            (exchanged, format!("the displacements of nodes {} and {} are exchanged", worst[0], worst[1])),
        ];
        let mut tried = Vec::new();
        for (rows, text) in told {
            let (found, _) = measure(self.problem, &Reordered { source: self.source, rows }, Trial::default())?;
            tried.push(Tried { text, balance: found.balance });
        }
        Ok(tried)
    }

    /// The nodes with the largest residuals, the largest first.
    fn worst(&self) -> Vec<usize> {
        let squares = &self.evidence.by_node;
        let mut order: Vec<usize> = (0..squares.len()).collect();
        order.sort_by(|&a, &b| squares[b].total_cmp(&squares[a]));
        order
    }

    /// Instants that are farther apart than any stable step.
    fn samples(&self) -> Option<String> {
        let (step, critical) = (self.source.times().longest_step(), critical_time_step(self.problem));
        (!is_stable(step, critical)).then(|| {
            format!(
                "the instants are {} critical steps apart: they are samples, not the steps of the solver; give velocities \
                 and accelerations too",
                trimmed(step / critical, 4)
            )
        })
    }

    /// Nodes that have most of the residual.
    fn nodes(&self) -> Option<String> {
        let total: f64 = self.evidence.by_node.iter().sum();
        let surface = self.problem.surface().nodes().iter().zip(&self.evidence.forced);
        let silent: Vec<usize> = surface.filter(|(_, forced)| !**forced).map(|(c, _)| c.node.index()).collect();
        let share = |nodes: &[usize]| nodes.iter().map(|&node| self.evidence.by_node[node]).sum::<f64>() / total;
        if share(&silent) >= CONCENTRATED {
            let missing = silent.into_iter().filter(|&node| self.evidence.by_node[node] > 1e-6 * total);
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
            "the displacements do not fit the mesh and its material: is the order of the nodes that of the mesh, and are all \
             units those of SI?"
                .to_string()
        })
    }
}

/// A factor of the contact forces.
fn force(factor: f64) -> String {
    let near = |value: f64| (factor / value - 1.0).abs() <= AGREE;
    let hint = if near(-1.0) {
        return "the sign of the contact forces is wrong: they are the forces of the planes on the body".to_string();
    } else if near(2.0) || near(0.5) {
        " (symmetry or thickness)"
    } else if [3.0, -3.0, 6.0, -6.0].into_iter().any(|power| near(10f64.powf(power))) {
        " (units)"
    } else {
        ""
    };
    format!("the contact forces should be {} as large{hint}", times(factor))
}
