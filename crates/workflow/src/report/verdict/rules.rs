//! Effectivity indices of the evidence, situation by situation. Each range has its source beside it: a table that
//! `percute reproduce` writes. The tests of the evidence compare the ranges with its page.

use super::facts::Facts;
use super::touches::Touches;
use crate::message::percent;
use crate::report::symptoms::{COMMON_SLOPE, DEPTH, SLIP};
use percute_estimator::{Acceleration, Reconstruction};

/// A situation that the evidence has, and its effectivity indices.
pub(super) struct Rule {
    /// Whether a run is in this situation. The first rule that applies counts.
    pub(super) applies: fn(&Facts) -> bool,
    /// The smallest and largest effectivity index, of the largest error and of the mean, rounded outwards.
    pub(super) range: [f64; 2],
    /// The situation in words, after "in tests of".
    pub(super) situation: &'static str,
    /// The reason to distrust the number, if there is one.
    pub(super) doubt: Option<&'static str>,
}

/// Speeds over the wave speed that the evidence has: 0.4 m/s in ν = 0.45 (9.9 km/s) to 400 m/s in a bar (5.1 km/s).
pub(super) const SPEEDS: [f64; 2] = [4e-5, 0.08];
/// Courant numbers of the evidence.
pub(super) const STEPS: [f64; 2] = [0.02, 0.9];
/// Largest friction of the evidence.
pub(super) const FRICTION: f64 = 0.5;

/// Bodies of less mean thickness over their diagonal bend: 0.13 for the frame of the evidence, 0.18 and more for its
/// other bodies.
const SLENDER: f64 = 0.15;

/// Residuals of the balance in a history of another program above this share of the largest term may double the
/// estimate: contact forces are far larger than those inside the body. Histories in single precision have 1e-4, with
/// steps of 0.02 Δt_c 2e-3.
const UNBALANCED: f64 = 5e-4;

/// Wave passages until which the index of a flat impact stays below 1.6 and above 0.9, and those that the evidence has.
const LONG: f64 = 5.0;
const LONGEST: f64 = 10.0;
/// The most passages, the smallest Courant number and the fewest edges in contact of flat impacts with an index up to
/// 1.25.
const SHORT: (f64, f64, usize) = (1.1, 0.45, 8);

/// The most elements of surfaces that slide in contact for an index above 1.6, python/percute/verification/struck.py.
const FEW: usize = 2;

/// Corners of two planes that open by less (degrees) have an index of their own.
const ACUTE: f64 = 59.9;

/// The rules in their order.
pub(super) const RULES: [Rule; 28] = [
    // effectivity.csv, effectivity-steps.csv, bar-maps.csv, ablation-slide: on very fine bars `consistent` and
    // `published` fall to a quarter.
    Rule {
        applies: |f| f.reconstruction == Reconstruction::Consistent,
        range: [0.23, 18.0],
        situation: "impacts with `consistent`",
        doubt: Some("`consistent` drops forces; estimate with `corrected`"),
    },
    Rule {
        applies: |f| f.reconstruction == Reconstruction::Published,
        range: [0.27, 65.0],
        situation: "impacts with `published`",
        doubt: Some("`published` drops forces; estimate with `corrected`"),
    },
    // See `report/flat.rs`; python/percute/verification/flat_elements.py.
    Rule { applies: |f| f.flat, range: [1.4, 45.0], situation: "meshes with nearly flat elements", doubt: None },
    // effectivity-turning.csv, closest.
    Rule {
        applies: |f| f.vibrates_with_closest(),
        range: [1.3, 2.1],
        situation: "bodies that vibrate without contact, with `closest`,",
        doubt: None,
    },
    // effectivity-turning.csv, time-steps-mass.csv: bodies that vibrate freely.
    Rule {
        applies: |f| f.contact.touches == Touches::None,
        range: [0.95, 1.25],
        situation: "bodies that vibrate without contact",
        doubt: None,
    },
    // The time from the first touch counts for both planes together.
    Rule {
        applies: |f| f.is_cornered() && f.has_just_begun(),
        range: [0.9, 3.5],
        situation: "impacts just after the first touch",
        doubt: None,
    },
    // python/percute/verification/corners.py: triangles with an obtuse angle have up to 2.4 at 45 degrees, 4.4 at 30
    // and 8.5 at 20.
    Rule {
        applies: |f| f.is_cornered() && f.corner.is_some_and(|opening| opening < ACUTE),
        range: [0.9, 10.0],
        situation: "bodies in an acute corner of two planes",
        doubt: None,
    },
    // The same, pressed for 200 µs: 0.88 to 2.07.
    Rule {
        applies: |f| f.is_cornered() && f.passages > LONG,
        range: [0.85, 2.2],
        situation: "bodies pressed for long into the corner of two planes",
        doubt: None,
    },
    // The same, and crates/estimator/tests/corner.rs: 0.90 to 1.57.
    Rule {
        applies: Facts::is_cornered,
        range: [0.89, 1.7],
        situation: "bodies in the corner of two planes",
        doubt: None,
    },
    // speeds.csv, frame; examples/beam.toml (test `as_far_from_the_truth_as_measured`).
    Rule {
        applies: |f| !f.bodies && f.slenderness < SLENDER,
        range: [0.74, 1.1],
        situation: "thin parts that bend",
        doubt: None,
    },
    // bounces-runs.csv: after 3, 5 and 10 phases.
    Rule {
        applies: |f| f.phases > 1,
        range: [0.49, 2.8],
        situation: "several contact phases",
        doubt: Some("after several contacts, simulation and solution are no longer in step"),
    },
    // python/percute/verification/struck.py has 0.90 to 1.66, random_strikes.py 1.01 to 1.85.
    Rule {
        applies: Facts::slides_on_little,
        range: [0.83, 2.2],
        situation: "corners, curves and parts of an edge on surfaces that slide",
        doubt: None,
    },
    // crates/estimator/tests/sliding_blocks.rs has 1.08 to 1.37 for surfaces that slide, two_blocks.rs 1.07 to 1.15 for
    // blocks of metals. python/percute/verification/two_bodies.py has 0.86 to 1.66 for soft and skewed bodies, with
    // edges beside inclined sides, at 0.4 m/s as well.
    Rule {
        applies: |f| f.bodies && f.dimension == 2,
        range: [0.83, 1.8],
        situation: "bodies that strike each other",
        doubt: None,
    },
    // bar-maps.csv at Δt = Δt_c: after release the shortest wave grows.
    Rule {
        applies: |f| f.dimension == 1 && f.courant > 0.99,
        range: [0.5, 1.7],
        situation: "bars at the critical step",
        doubt: Some("at the critical step a short wave grows after release; take courant = 0.9"),
    },
    // bar-rows.csv.
    Rule {
        applies: |f| f.bodies && f.dimension == 1,
        range: [0.82, 1.26],
        situation: "bars that strike each other",
        doubt: None,
    },
    // bar-maps.csv, effectivity-steps.csv.
    Rule { applies: |f| f.dimension == 1, range: [0.85, 1.26], situation: "bars that strike a wall", doubt: None },
    // speeds.csv, trapezoid 45° with a corner of one element.
    Rule {
        applies: |f| f.contact.single_element,
        range: [1.6, 2.0],
        situation: "obtuse corners that one element fills",
        doubt: None,
    },
    // speeds.csv, L tilted by 10°: its second corner arrives at another instant than that of the reference.
    Rule {
        applies: |f| f.contact.zones > 1,
        range: [0.49, 1.4],
        situation: "bodies that touch at several places",
        doubt: Some("where a second place touches, a small error of its instant is a large error of the motion"),
    },
    // python/percute/verification/durations.py: the index falls in the first passage, and grows slowly after it.
    Rule {
        applies: Facts::has_just_begun,
        range: [0.9, 3.5],
        situation: "impacts just after the first touch",
        doubt: None,
    },
    Rule {
        applies: |f| f.contact.touches == Touches::Edge && f.passages > LONG,
        range: [0.7, 1.6],
        situation: "flat impacts and 10 wave passages after them",
        doubt: None,
    },
    // effectivity.csv, flat; speeds.csv, flat.
    Rule {
        applies: |f| f.contact.touches == Touches::Edge && f.is_short(),
        range: [0.91, 1.25],
        situation: "flat impacts",
        doubt: None,
    },
    // The same with more passages, shorter steps or larger elements; effectivity-steps.csv, block.
    Rule {
        applies: |f| f.contact.touches == Touches::Edge && f.courant < SHORT.1,
        range: [0.9, 1.6],
        situation: "flat impacts with short steps",
        doubt: None,
    },
    Rule {
        applies: |f| f.contact.touches == Touches::Edge && f.elements_in_contact < SHORT.2,
        range: [0.9, 1.6],
        situation: "flat impacts on few elements",
        doubt: None,
    },
    Rule {
        applies: |f| f.contact.touches == Touches::Edge,
        range: [0.9, 1.6],
        situation: "flat impacts of up to 5 wave passages",
        doubt: None,
    },
    // speeds.csv, trapezoid, flat.
    Rule {
        applies: |f| f.contact.touches == Touches::End,
        range: [1.05, 1.3],
        situation: "edges beside an inclined side",
        doubt: None,
    },
    // effectivity.csv, curved; speeds.csv, curved; bounces-runs.csv after one phase.
    Rule {
        applies: |f| f.contact.touches == Touches::Curve,
        range: [1.05, 1.6],
        situation: "impacts of curves",
        doubt: None,
    },
    // effectivity.csv, tilted and corner first; effectivity-steps.csv, tilted block; speeds.csv, corner first;
    // durations.py, short steps.
    Rule {
        applies: |f| f.contact.touches == Touches::Corner,
        range: [0.89, 1.6],
        situation: "impacts with a corner",
        doubt: None,
    },
    Rule { applies: |_| true, range: [0.4, 2.8], situation: "impacts", doubt: None },
];

impl Facts {
    /// Whether nothing touches, and Γ_DA is `closest` with `corrected`.
    fn vibrates_with_closest(&self) -> bool {
        self.contact.touches == Touches::None && self.dimension == 2 && self.acceleration == Some(Acceleration::Closest)
    }

    /// Whether the body touches two planes that meet at one of its nodes, in one contact phase.
    fn is_cornered(&self) -> bool {
        self.corner.is_some() && self.phases == 1
    }

    /// Whether the run ends so soon after the first touch of a plane body that the index has not settled.
    fn has_just_begun(&self) -> bool {
        let onset = match self.contact.touches {
            Touches::Edge => 0.75,
            Touches::End => 0.5,
            Touches::Corner | Touches::Curve => 0.25,
            Touches::None => return false,
        };
        self.dimension == 2 && self.passages < onset
    }

    /// Whether two surfaces slide that touch with a corner, a curve or few elements.
    fn slides_on_little(&self) -> bool {
        let curved = matches!(self.contact.touches, Touches::Curve | Touches::Corner);
        self.slides && (curved || self.elements_in_contact <= FEW)
    }

    /// Whether a flat impact ends soon after its first contact and is resolved well in space, with ordinary steps.
    fn is_short(&self) -> bool {
        let (passages, steps, edges) = SHORT;
        self.passages <= passages && self.courant >= steps && self.elements_in_contact >= edges
    }
}

/// The property with which the effectivity index is outside the range of the rules, if a run has one.
pub(super) fn outside(facts: &Facts) -> Option<&'static str> {
    let touches_at_a_point = matches!(facts.contact.touches, Touches::Corner | Touches::Curve);
    match () {
        // python/percute/verification/penalties.py: 1.02 to 2.97 in flat and tilted impacts.
        () if facts.by_a_penalty => Some(PENALTY),
        () if facts.acts_late() => Some(LATE),
        () if facts.at_end && touches_at_a_point => Some(AT_END),
        () if facts.common_slope > COMMON_SLOPE => Some(LEANING),
        () => None,
    }
}

/// Contact of a history of another program.
const PENALTY: &str = "contact by a penalty";
/// The gap of a slave is a mean over its edges: a corner enters them first.
const LATE: &str = "corners and curves that enter the edges that they strike";

/// Corners that slide off a plate at 100 to 400 m/s: 1.2 to 24; that strike within a 16th of their edge from its end:
/// up to 9; that are beyond it by less than a thousandth of their edge: up to 41.
const AT_END: &str =
    "corners and curves that slide off the end of the other surface, or strike within 1/16 of an edge of it";

/// The motion differs by a tenth and more from that with a contact for each slope.
const LEANING: &str = "surfaces that lean together from their common normal";

/// The properties of a run that no case of the evidence has.
pub(super) fn untested(facts: &Facts) -> Vec<String> {
    let mut untested = Vec::new();
    if let Some(ratio) = facts.speed_ratio {
        if ratio > SPEEDS[1] || (ratio > 0.0 && ratio < SPEEDS[0]) {
            untested.push(format!("{} of the wave speed", crate::message::short(ratio, 2)));
        } else if ratio <= 0.0 {
            untested.push("a body that does not fly to its plane".to_string());
        }
    }
    // Rounding moves the last digits of a stated Courant number; a bar may have the critical step.
    let most = if facts.dimension == 1 { 1.0 } else { STEPS[1] };
    if facts.courant < STEPS[0] * 0.99 || facts.courant > most * 1.01 {
        untested.push(format!("steps of {} Δt_c", crate::message::short(facts.courant, 2)));
    }
    if facts.largest_friction > FRICTION {
        untested.push(format!("friction above {FRICTION}"));
    }
    if let Some(other) = facts.acceleration.filter(|_| !facts.vibrates_with_closest()) {
        untested.push(format!("acceleration `{other}`"));
    }
    untested.extend(untested_of_bodies(facts));
    if facts.dimension == 2 && facts.contact.touches == Touches::Edge && facts.passages > LONGEST {
        untested.push(format!("{} wave passages", crate::message::short(facts.passages, 2)));
    }
    if facts.corner.is_some() && facts.passages > LONG {
        untested.push(format!("{} wave passages in a corner", crate::message::short(facts.passages, 2)));
    }
    if facts.supported {
        untested.push("supports".to_string());
    }
    if facts.unbalanced > UNBALANCED {
        untested.push(format!("forces that balance to {} only", percent(facts.unbalanced)));
    }
    if facts.by_a_penalty {
        untested.push(PENALTY.to_string());
    } else if let Some(off) = facts.off_contact {
        untested
            .push(format!("nodes that are {} of an element off their plane in contact", crate::message::short(off, 2)));
    }
    if facts.shifted {
        untested.push("contact forces of another step".to_string());
    }
    if facts.sampled {
        untested.push("samples instead of steps".to_string());
    }
    untested
}

/// How bodies touch each other where no case of the evidence has it.
fn untested_of_bodies(facts: &Facts) -> Vec<String> {
    let touches = match facts.contact.touches {
        _ if !facts.bodies || facts.dimension == 1 => None,
        // A mean gap may be open although a corner is inside the other body.
        Touches::None if facts.slides => Some("surfaces that slide without contact"),
        Touches::Edge | Touches::End => None,
        _ if facts.slides => None,
        _ => Some("bodies that strike each other so"),
    };
    let edges = |value: f64| crate::message::short(value, 2);
    let slip = (facts.slip > SLIP).then(|| format!("pairs of nodes that slip by {} edges", edges(facts.slip)));
    let depth = (facts.depth > DEPTH)
        .then(|| format!("nodes that are {} of an edge inside the other body", edges(facts.depth)));
    touches.map(str::to_string).into_iter().chain(slip).chain(depth).collect()
}
