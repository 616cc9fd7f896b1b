//! What a history of another program lacks, derived from the rest of it.

use super::derive::{Derivation, Heard};
use super::interface_balance::groups;
use super::pairs;
use super::window::{Held, rows_of, windows};
use crate::message::{counted, trimmed};
use percute_core::border::Vector;
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use serde::Serialize;

/// A part of a history that was derived.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Derived {
    /// Contact forces, from the balance.
    Reaction,
    /// Touching status, from gaps and forces.
    Touching,
}

impl Derived {
    /// The part of this name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        [Self::Reaction, Self::Touching].into_iter().find(|part| part.name() == name)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Reaction => "reaction",
            Self::Touching => "touching",
        }
    }
}

/// The parts that a history lacks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lacks {
    /// Contact forces; all steps have zeros in their place.
    pub reaction: bool,
    /// Touching status; all steps have `false` in its place.
    pub touching: bool,
}

/// A history with what it lacked. The last instant is left out if its contact forces are not known.
pub struct Completed<'s> {
    derivation: Derivation<'s>,
    source: &'s dyn StepSource,
    lacks: Lacks,
    times: TimeGrid,
    count: usize,
    derived: Vec<Derived>,
}

impl<'s> Completed<'s> {
    /// Looks at a history once, to see whether its last contact forces are known.
    ///
    /// # Errors
    /// A material that yields; a node that may touch two planes; missing forces on non-matching interfaces; steps that
    /// cannot be read; forces on two nodes of different bodies that are not opposite; fewer than three instants of
    /// which the last is not known.
    pub fn new(problem: &'s AnyProblem, source: &'s dyn StepSource, lacks: Lacks) -> Result<Self, SinkError> {
        if let Some(contact) = problem.contact_nodes().iter().find(|contact| contact.second_slot.is_some()) {
            let told = format!(
                "histories of other programs are read for nodes at one plane, and node {} may touch two; name for each \
                 plane a `group` so that no node lies in two, or simulate with percute",
                contact.node.index()
            );
            return Err(told.into());
        }
        if problem.yields() {
            let told = "histories of other programs are read for elastic materials: plastic strains follow from all of \
                        their steps alone; leave out `tangent` and `hardening`, or simulate with percute";
            return Err(told.into());
        }
        let (times, count) = (source.times().clone(), source.count());
        let derivation = Derivation::new(problem, source);
        let mut made = Self { derivation, source, lacks, times, count, derived: Vec::new() };
        if problem.contact_nodes().is_empty() {
            return Ok(made);
        }
        let needed = made.needed_at_the_end()?;
        if lacks.reaction {
            match made.derivation.listen(source)? {
                [_, Some(non_matching)] => return Err(forces_missing(problem, non_matching).into()),
                [Some(_), None] => {}
                [None, None] => {
                    // Nothing touches: the history is complete.
                    made.lacks = Lacks::default();
                    return Ok(made);
                }
            }
            made.derived.push(Derived::Reaction);
        }
        if lacks.touching || lacks.reaction {
            made.lacks.touching = true;
            made.derived.push(Derived::Touching);
        }
        if needed {
            made.leave_out_the_last()?;
        }
        Ok(made)
    }

    fn dimension(&self) -> usize {
        self.derivation.problem().dimension()
    }

    /// The parts that were derived.
    #[must_use]
    pub fn derived(&self) -> &[Derived] {
        &self.derived
    }

    /// The last instant of the history (s), if it was left out.
    #[must_use]
    pub fn left_out(&self) -> Option<f64> {
        let last = self.source.count().checked_sub(1)?;
        (self.count <= last).then(|| self.source.times().instants()[last])
    }

    /// The contact forces of an instant as they are given, opposite on two nodes of different bodies.
    fn given(&self, now: &Held) -> Result<Vec<Vector>, SinkError> {
        let problem = self.derivation.problem();
        if let Some([first, second]) = pairs::not_opposite(problem, &now.reaction) {
            return Err(format!(
                "`reaction`: the forces on nodes {first} and {second}, which touch each other, are not opposite at \
                 step {}; give the force on each node, or leave `reaction` out, and it is derived",
                now.index
            )
            .into());
        }
        let mut reaction = now.reaction.clone();
        pairs::make_opposite(problem, &mut reaction);
        Ok(reaction)
    }

    fn leave_out_the_last(&mut self) -> Result<(), SinkError> {
        if self.count <= 2 {
            let told = counted(self.count, "instant");
            return Err(
                format!("the history has {told}: too few, since the contact forces of the last are not known").into()
            );
        }
        self.count -= 1;
        self.times = TimeGrid::from_instants(self.times.instants()[..self.count].to_vec())?;
        Ok(())
    }

    /// Whether contact forces are needed at the last instant, but not there: all are zero, and without them a node of
    /// the surface would go into its plane in a further step.
    fn needed_at_the_end(&self) -> Result<bool, SinkError> {
        let last = self.source.count().saturating_sub(1);
        let mut needed = false;
        windows(self.source, self.dimension(), &mut |window| {
            if window.now.index < last {
                return Ok(());
            }
            let known = window.now.acceleration.is_some();
            if window.before.is_some() && !known && window.now.reaction.iter().all(|r| *r == [0.0; 3]) {
                needed = self.derivation.enters(window);
            }
            Ok(())
        })?;
        Ok(needed)
    }
}

/// What to do about the forces of non-matching interfaces, if they are missing.
fn forces_missing(problem: &AnyProblem, heard: Heard) -> String {
    let groups = problem.non_matching_of(heard.at).map(|non_matching| groups(problem, non_matching).join(" and "));
    format!(
        "`reaction` is missing: the contact forces on the non-matching interface of {} are not derived, and some act \
         from {} s on; give the force on each node of both (N) at each step of the solver, \
         or simulate with percute",
        groups.unwrap_or_default(),
        trimmed(heard.time, 5)
    )
}

impl StepSource for Completed<'_> {
    fn times(&self) -> &TimeGrid {
        &self.times
    }

    fn count(&self) -> usize {
        self.count
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        let derivation = &self.derivation;
        let mut touched = None;
        windows(self.source, self.dimension(), &mut |window| {
            let now = window.now;
            if now.index >= self.count {
                return Ok(());
            }
            let reaction = if self.lacks.reaction {
                derivation.reactions(window).unwrap_or_else(|| vec![[0.0; 3]; now.reaction.len()])
            } else {
                self.given(now)?
            };
            let rows = &rows_of(&reaction, self.dimension())[..];
            if !self.lacks.touching {
                return take(&Step { reaction: rows, ..now.step() });
            }
            let next = derivation.touching(window, rows);
            let touching = touched.replace(next).unwrap_or_else(|| derivation.touching_at_start(window, rows));
            take(&Step { reaction: rows, touching: &touching, ..now.step() })
        })
    }
}
