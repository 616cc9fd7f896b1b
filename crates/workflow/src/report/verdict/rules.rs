//! Effectivity indices of the evidence, situation by situation. Each range has its source beside it: a table that
//! `python -m studies` writes. The tests of the evidence compare the ranges with its page.

use super::facts::Facts;
use crate::report::symptoms::INCLINATION;
use crate::report::touches::Touches;
use percute_estimator::{Acceleration, Reconstruction};

/// A situation that the evidence has, and its effectivity indices.
#[derive(Clone, Copy)]
pub(super) struct Rule {
    /// Whether a run is in this situation. The first rule that applies counts.
    pub(super) applies: fn(&Facts) -> bool,
    /// The smallest and largest effectivity index, of the largest error and of the mean, rounded outwards.
    pub(super) range: [f64; 2],
    /// The situation in words, after "in tests of".
    pub(super) situation: &'static str,
    /// The reason to distrust the number, if there is one.
    pub(super) reason: Option<&'static str>,
}

/// Bodies of less mean thickness over their diagonal bend: 0.13 for the frame of the evidence, 0.18 and more for its
/// other bodies.
const SLENDER: f64 = 0.15;

/// Wave passages until which the index of a flat impact stays below 1.6 and above 0.85.
pub(super) const LONG: f64 = 5.0;
/// The most passages, the smallest Courant number and the fewest edges in contact of flat impacts with an index up to
/// 1.25.
const SHORT: (f64, f64, usize) = (1.1, 0.45, 8);

/// The most elements of non-matching interfaces in contact for an index above 1.6, studies/struck.py.
const FEW: usize = 2;

/// Wave passages of the flat impacts with finite kinematics that the evidence has, studies/random_bodies, turning.
const SETTLED: f64 = 3.0;

/// Corners of two planes that open by less (degrees) have an index of their own.
const ACUTE: f64 = 59.9;

/// The rules in their order.
const RULES: [Rule; 34] = [
    // effectivity.csv, effectivity-steps.csv, bar-maps.csv, ablation-slide: on very fine bars `consistent` and
    // `published` fall to a quarter.
    Rule {
        applies: |f| f.reconstruction == Reconstruction::Consistent,
        range: [0.23, 18.0],
        situation: "impacts with `consistent`",
        reason: Some("`consistent` drops forces; estimate with `corrected`"),
    },
    Rule {
        applies: |f| f.reconstruction == Reconstruction::Published,
        range: [0.27, 65.0],
        situation: "impacts with `published`",
        reason: Some("`published` drops forces; estimate with `corrected`"),
    },
    // crates/estimator/tests/solids: the range of few cases, and trust is limited by `tested_range`.
    Rule {
        applies: |f| f.is_solid() && f.contact.touches == Touches::None,
        range: [0.8, 1.4],
        situation: "solids that vibrate without contact",
        reason: None,
    },
    // The same.
    Rule {
        applies: |f| f.is_solid() && f.contact.touches == Touches::Face,
        range: [0.8, 1.6],
        situation: "flat impacts of solids",
        reason: None,
    },
    Rule { applies: Facts::is_solid, range: [0.8, 40.0], situation: "impacts of solids", reason: Some(WIDE) },
    // See `report/flat.rs`; studies/flat_elements.py.
    Rule { applies: |f| f.flat, range: [0.95, 10.0], situation: "meshes with nearly flat elements", reason: None },
    // docs/finite.md, studies/turning_blocks, and studies/random_bodies, turning: 0.94 to 1.47 on edges, up to 2.2 with
    // few elements or ν = 0.49.
    Rule {
        applies: |f| f.linearity.finite && f.contact.touches == Touches::Edge && f.passages <= SETTLED,
        // The evidence has few bodies: trust is limited.
        range: [0.75, 2.2],
        situation: "flat impacts with finite kinematics",
        reason: None,
    },
    // The same: 0.94 to 1.93 for corners and curves.
    Rule {
        applies: |f| f.linearity.finite && f.contact.touches != Touches::None,
        range: [0.6, 2.6],
        situation: "impacts with finite kinematics",
        reason: None,
    },
    // studies/random_bodies, turning, without contact; see docs/finite.md.
    Rule { applies: |f| f.linearity.finite, range: [0.6, 2.4], situation: "bodies that turn freely", reason: None },
    // effectivity-turning.csv, closest.
    Rule {
        applies: |f| f.vibrates_with_closest(),
        range: [1.2, 2.1],
        situation: "bodies that vibrate without contact, with `closest`,",
        reason: None,
    },
    // effectivity-turning.csv, time-steps-mass.csv: bodies that vibrate freely. 90 random bodies over 1 to 30 periods
    // have 0.81 to 1.39 (studies/random_bodies, vibration).
    Rule {
        applies: |f| f.contact.touches == Touches::None,
        range: [0.8, 1.4],
        situation: "bodies that vibrate without contact",
        reason: None,
    },
    // The time from the first touch counts for both planes together.
    Rule {
        applies: |f| f.is_cornered() && f.has_just_begun(),
        range: [0.7, 3.5],
        situation: "impacts just after the first touch",
        reason: None,
    },
    // studies/corners.py: triangles with an obtuse angle have up to 2.4 at 45 degrees, 4.4 at 30
    // and 8.5 at 20.
    Rule {
        applies: |f| f.is_cornered() && f.corner.is_some_and(|opening| opening < ACUTE),
        range: [0.9, 10.0],
        situation: "bodies in an acute corner of two planes",
        reason: None,
    },
    // The same, pressed for 200 µs: 0.88 to 2.07.
    Rule {
        applies: |f| f.is_cornered() && f.passages > LONG,
        range: [0.85, 2.2],
        situation: "bodies pressed for long into the corner of two planes",
        reason: None,
    },
    // The same, and crates/estimator/tests/corner.rs: 0.90 to 1.57.
    Rule {
        applies: Facts::is_cornered,
        range: [0.89, 1.7],
        situation: "bodies in the corner of two planes",
        reason: None,
    },
    // speeds.csv, frame; examples/beam.toml (test `as_far_from_the_truth_as_measured`). Random frames, rings and beams
    // have 0.92 to 1.46.
    Rule {
        applies: |f| f.is_thin() && f.contact.touches != Touches::Edge,
        range: [0.8, 1.6],
        situation: "thin parts that bend",
        reason: None,
    },
    // bounces-runs.csv: after 3, 5 and 10 phases.
    Rule {
        applies: |f| f.phases > 1,
        range: [0.49, 2.8],
        situation: "several contact phases",
        reason: Some("after several contacts, small errors of timing dominate"),
    },
    // studies/struck.py has 0.90 to 1.66, random_strikes.py 1.01 to 1.85.
    Rule {
        applies: Facts::slides_on_little,
        range: [0.83, 2.2],
        situation: "corners, curves and parts of an edge on non-matching interfaces",
        reason: None,
    },
    // crates/estimator/tests/sliding_blocks.rs has 1.08 to 1.37 for non-matching interfaces, two_blocks.rs 1.07 to 1.15
    // for blocks of metals. studies/two_bodies.py has 0.86 to 1.66 for soft and skewed bodies, with edges beside
    // inclined sides, at 0.4 m/s as well.
    Rule {
        applies: |f| f.bodies && f.dimension == 2,
        range: [0.83, 1.8],
        situation: "bodies that strike each other",
        reason: None,
    },
    // bar-maps.csv at Δt = Δt_c: after release the shortest wave grows.
    Rule {
        applies: |f| f.dimension == 1 && f.courant > 0.99,
        range: [0.5, 1.7],
        situation: "bars at the critical step",
        reason: Some("at the critical step a short wave grows after release; take courant = 0.9"),
    },
    // bar-rows.csv.
    Rule {
        applies: |f| f.bodies && f.dimension == 1,
        range: [0.82, 1.26],
        situation: "bars that strike each other",
        reason: None,
    },
    // bar-maps.csv, effectivity-steps.csv.
    Rule { applies: |f| f.dimension == 1, range: [0.85, 1.26], situation: "bars that strike a wall", reason: None },
    // speeds.csv, trapezoid 45° with a corner of one element, has 1.61 to 1.88; random bodies have 0.97 to 1.35.
    Rule {
        applies: |f| f.contact.single_element,
        range: [0.95, 2.0],
        situation: "obtuse corners of a single element",
        reason: None,
    },
    // speeds.csv, L tilted by 10°: its second corner arrives at another instant than that of the reference.
    Rule {
        applies: |f| f.contact.zones > 1,
        range: [0.49, 1.8],
        situation: "bodies that touch at several places",
        reason: Some("at a second contact zone, a small error of timing is a large error of the motion"),
    },
    // studies/durations.py: the index falls in the first passage, and grows slowly after it.
    Rule {
        applies: Facts::has_just_begun,
        range: [0.7, 3.5],
        situation: "impacts just after the first touch",
        reason: None,
    },
    Rule {
        applies: |f| f.contact.touches == Touches::Edge && f.passages > LONG,
        range: [0.7, 1.6],
        situation: "flat impacts of up to 10 wave passages",
        reason: None,
    },
    // effectivity.csv, flat; speeds.csv, flat.
    Rule {
        applies: |f| f.contact.touches == Touches::Edge && f.is_short(),
        range: [0.85, 1.25],
        situation: "flat impacts",
        reason: None,
    },
    // The same with more passages, shorter steps or larger elements; effectivity-steps.csv, block.
    Rule {
        applies: |f| f.contact.touches == Touches::Edge && f.courant < SHORT.1,
        range: [0.85, 1.6],
        situation: "flat impacts with short steps",
        reason: None,
    },
    Rule {
        applies: |f| f.contact.touches == Touches::Edge && f.elements_in_contact < SHORT.2,
        range: [0.85, 1.6],
        situation: "flat impacts on few elements",
        reason: None,
    },
    Rule {
        applies: |f| f.contact.touches == Touches::Edge,
        range: [0.85, 1.6],
        situation: "flat impacts of up to 5 wave passages",
        reason: None,
    },
    // speeds.csv, trapezoid, flat.
    Rule {
        applies: |f| f.contact.touches == Touches::End,
        range: [0.9, 1.35],
        situation: "edges beside an inclined side",
        reason: None,
    },
    // effectivity.csv, curved; speeds.csv, curved; bounces-runs.csv after one phase. Random bodies have 1.03 to 1.35.
    Rule {
        applies: |f| f.contact.touches == Touches::Curve,
        range: [0.95, 1.6],
        situation: "impacts of curves",
        reason: None,
    },
    // effectivity.csv, tilted and corner first; effectivity-steps.csv, tilted block; speeds.csv, corner first;
    // durations.py, short steps.
    Rule {
        applies: |f| f.contact.touches == Touches::Corner,
        range: [0.85, 1.6],
        situation: "impacts with a corner",
        reason: None,
    },
    Rule { applies: |_| true, range: [0.4, 2.8], situation: "impacts", reason: None },
];

/// The indices of bars that yield, studies/yielding, and of plane bodies, studies/random_bodies, yielding.
const YIELDING: [([f64; 2], [&str; 2]); 2] = [
    ([0.6, 1.6], ["bars that may yield", "bars that yield"]),
    ([0.5, 1.9], ["bodies that may yield", "bodies that yield"]),
];

/// The rule of a run: the first one that applies. Where a material yields, or the run does not show that it stays
/// elastic, its range has that of such bodies as well.
pub(super) fn rule(facts: &Facts) -> Rule {
    let first = RULES.iter().find(|rule| (rule.applies)(facts)).unwrap_or(&RULES[RULES.len() - 1]);
    if !facts.may_flow() {
        return *first;
    }
    let ([low, high], situations) = YIELDING[facts.dimension - 1];
    let situation = situations[usize::from(facts.linearity.yielded.is_some())];
    Rule { range: [first.range[0].min(low), first.range[1].max(high)], situation, ..*first }
}

impl Facts {
    /// Whether a body is one of tetrahedra.
    pub(super) fn is_solid(&self) -> bool {
        self.dimension == 3
    }

    /// Whether nothing touches, and Γ_DA is `closest` with `corrected`.
    pub(super) fn vibrates_with_closest(&self) -> bool {
        self.contact.touches == Touches::None && self.dimension == 2 && self.acceleration == Some(Acceleration::Closest)
    }

    /// Whether the body touches two planes that meet at one of its nodes, in one contact phase.
    fn is_cornered(&self) -> bool {
        self.corner.is_some() && self.phases == 1
    }

    /// Whether the run ends so soon after the first touch of a plane body that the index has not settled.
    pub(super) fn has_just_begun(&self) -> bool {
        let onset = match self.contact.touches {
            Touches::Edge | Touches::Face => 0.75,
            Touches::End => 0.5,
            Touches::Corner | Touches::Curve => 0.25,
            Touches::None => return false,
        };
        self.dimension == 2 && self.passages < onset
    }

    /// Whether a body is so thin that it bends.
    pub(super) fn is_thin(&self) -> bool {
        !self.bodies && self.dimension == 2 && self.slenderness < SLENDER
    }

    /// Whether two surfaces slide that touch with a corner, a curve or few elements.
    fn slides_on_little(&self) -> bool {
        let curved = matches!(self.contact.touches, Touches::Curve | Touches::Corner);
        self.slides && (curved || self.elements_in_contact <= FEW)
    }

    /// Whether a flat impact ends soon after its first contact and is resolved well in space, with ordinary steps.
    /// Plates that fall flat have up to 1.5, studies/beyond.py.
    fn is_short(&self) -> bool {
        let (passages, steps, edges) = SHORT;
        !self.is_thin() && self.passages <= passages && self.courant >= steps && self.elements_in_contact >= edges
    }
}

/// The property with which the effectivity index is outside the range of the rules, if a run has one.
pub(super) fn outside(facts: &Facts) -> Option<&'static str> {
    let touches_at_a_point = matches!(facts.contact.touches, Touches::Corner | Touches::Curve);
    match () {
        // studies/penalties.py: 1.02 to 2.97 in flat and tilted impacts.
        () if facts.by_a_penalty => Some(PENALTY),
        () if facts.is_solid() && !matches!(facts.contact.touches, Touches::None | Touches::Face) => Some(POINTED),
        () if facts.acts_late() => Some(LATE),
        () if facts.at_surface_end && touches_at_a_point => Some(AT_SURFACE_END),
        () if facts.inclination > INCLINATION => Some(INCLINED),
        () => None,
    }
}

/// Cubes on a corner have 1.3 at 400 m/s, 9 at 4 m/s and 29 at 0.4 m/s; on an edge up to 36.
const POINTED: &str = "edges, corners and curves of solids";
/// Why.
const WIDE: &str = "the tractions of an edge, a corner or a curve of a solid are as wide as its faces, and the \
                    estimate is too large, many times at low speed";

/// Contact of a history of another program.
pub(super) const PENALTY: &str = "contact by a penalty";
/// The gap of a slave is a mean over its edges: a corner enters them first.
const LATE: &str = "corners and curves that penetrate the struck edges";

/// Corners that slide off a plate at 100 to 400 m/s: 1.2 to 24; that strike within a 16th of their edge from its end:
/// up to 9; that are beyond it by less than a thousandth of their edge: up to 41.
const AT_SURFACE_END: &str =
    "corners and curves that slide off the end of the other surface, or strike within 1/16 of an edge of it";

/// The motion differs by a tenth and more from that with a contact for each slope.
const INCLINED: &str = "surfaces inclined to their common normal";
