//! The pack: exact and published cases, each run on meshes ever finer and compared with its exact solution.
//!
//! Their case files are among the examples, each with a script that makes the same comparison. What each case says is a list of
//! [`PackRow`]s.

mod bar_impact;
mod bouncing_bar;
mod clamped_rod;
mod field_error;
mod friction;
mod momentum;
mod patch;
mod row;
mod show;
mod text;
mod trial;
mod vibration;

pub(super) use friction::sliding_block;
pub use row::{Expected, PackRow};
pub(super) use show::PART;

use super::{ReproduceError, Tally};

/// A quantity over time in the first run, the coarsest, where the difference is largest.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What it is.
    pub quantity: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Instants.
    pub time: Vec<f64>,
    /// Their unit.
    pub time_unit: &'static str,
    /// Its exact values.
    pub exact: Vec<f64>,
    /// What was computed.
    pub computed: Vec<f64>,
}

/// What a case gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Its quantities.
    pub rows: Vec<PackRow>,
    /// One of them over time.
    pub curve: Option<Curve>,
}

/// A case of the pack.
#[derive(Clone, Copy, Debug)]
pub struct PackCase {
    /// Name of its file among the examples.
    pub key: &'static str,
    /// What happens, in a line.
    pub title: &'static str,
    /// What its numbers are halved by from run to run.
    pub refined: &'static str,
    /// Where the solution is from.
    pub source: &'static str,
    runs: usize,
    run: fn(&mut Tally<'_>) -> Result<Outcome, ReproduceError>,
}

impl PackCase {
    /// Runs and compares it.
    ///
    /// # Errors
    /// [`ReproduceError::Interrupted`], and what simulation and estimate refuse.
    pub fn run(&self, tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
        (self.run)(tally)
    }

    /// How many runs it makes: the weight of a [`Tally`] for it.
    #[must_use]
    pub fn runs(&self) -> usize {
        self.runs
    }
}

const GIBERT: &str = "Louf, Gallimard and Pelle, §7.1; Gibert (1988)";
const COULOMB: &str = "Coulomb's law for a rigid block";
const ELEMENTS: &str = "element size and step";
const STIFFER: &str = "1/c of the block";

/// All cases.
pub const CASES: &[PackCase] = &[
    PackCase {
        key: "bar_impact",
        title: "A bar strikes a wall, for five places of the impact in a step",
        refined: ELEMENTS,
        source: GIBERT,
        runs: bar_impact::RUNS,
        run: bar_impact::aluminium,
    },
    PackCase {
        key: "bouncing_bar",
        title: "A bar bounces on the ground",
        refined: ELEMENTS,
        source: "Doyen, Ern and Piperno (2011), SIAM J. Sci. Comput. 33, 223–249; d'Alembert",
        runs: bouncing_bar::RUNS,
        run: bouncing_bar::bouncing,
    },
    PackCase {
        key: "clamped_rod",
        title: "A clamped rod springs back against an obstacle",
        refined: ELEMENTS,
        source: "Dabaghi, Petrov, Pousin and Renard, HAL hal-00917450; d'Alembert",
        runs: clamped_rod::RUNS,
        run: clamped_rod::clamped,
    },
    PackCase {
        key: "steel_bar",
        title: "A steel bar creeps against a wall",
        refined: ELEMENTS,
        source: GIBERT,
        runs: bar_impact::STEEL_RUNS,
        run: bar_impact::steel,
    },
    PackCase {
        key: "bar_mode",
        title: "A clamped bar swings in its second mode",
        refined: ELEMENTS,
        source: "Timoshenko, Vibration Problems in Engineering",
        runs: vibration::MODE_RUNS,
        run: vibration::bar_mode,
    },
    PackCase {
        key: "block_mode",
        title: "A block between rollers swings in a mode",
        refined: ELEMENTS,
        source: "Graff, Wave Motion in Elastic Solids, §5.1",
        runs: vibration::BLOCK_RUNS,
        run: vibration::block_modes,
    },
    PackCase {
        key: "bar_ramp",
        title: "A clamped bar is pulled by a traction that grows linearly",
        refined: ELEMENTS,
        source: "Timoshenko, modal series; d'Alembert",
        runs: vibration::RAMP_RUNS,
        run: vibration::ramp,
    },
    PackCase {
        key: "tilted_plane",
        title: "A stiff block on a plane tilted by 30° slides with μ = 0.3 and sticks with 0.7",
        refined: STIFFER,
        source: COULOMB,
        runs: friction::TILT_RUNS,
        run: friction::tilted_plane,
    },
    PackCase {
        key: "stick_slip",
        title: "A stiff block is pushed to and fro, sticks and slips",
        refined: STIFFER,
        source: COULOMB,
        runs: friction::STICK_SLIP_RUNS,
        run: friction::stick_slip,
    },
    PackCase {
        key: "oblique",
        title: "A block strikes the ground, straight and sliding with μ = 0.2",
        refined: ELEMENTS,
        source: "balance of momentum and energy, Coulomb's law",
        runs: momentum::RUNS,
        run: momentum::momentum,
    },
    PackCase {
        key: "patch",
        title: "The patch test: a uniform stress in a body that flies",
        refined: "nothing, one run",
        source: "linear displacement, uniform stress",
        runs: patch::RUNS - 2,
        run: patch::free,
    },
    PackCase {
        key: "patch_contact",
        title: "The patch test in contact: a uniform stress, pressed and sheared against the ground",
        refined: "nothing, one run",
        source: "linear displacement, uniform stress",
        runs: 2,
        run: patch::contact,
    },
];
