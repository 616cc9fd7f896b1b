//! The fields of one time level t_n, in the states in which they become known.
//!
//! The motion comes first ([`MotionKnown`]), then the contact force over the step that ends at t_n ([`ForcesBefore`]),
//! then that over the step that begins there ([`ForcesKnown`]). Stress and tractions make it an
//! [`Equilibrated`](crate::traction::Equilibrated) level. Each state takes the fields of the one before without copying
//! them.

use crate::contact_density::{CornerSliding, Densities, LevelDensities, OffContact};
use crate::increment::Increment;
use crate::kinematic::NodalMotion;
use crate::nodal_field::NodalField;
use crate::plastic::EigenStrains;

/// Which value at an instant where contact changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Before,
    After,
}

/// The state of the contact surface at t_n.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceStep<const D: usize> {
    /// Reactions of the simulation (N).
    pub(crate) reaction: Vec<[f64; D]>,
    /// The forces of which densities are made (N).
    pub(crate) force: Vec<[f64; D]>,
    /// The densities of this instant, until the step that begins here has them; `None` where they depend on other
    /// instants.
    pub(crate) densities: Option<LevelDensities<D>>,
    pub(crate) touching: Vec<bool>,
    /// Gaps of the simulation (m).
    pub(crate) gap: Vec<f64>,
}

/// The fields that do not change from state to state.
#[derive(Clone, Debug)]
pub(crate) struct TimeLevel<const D: usize> {
    /// n.
    pub(crate) index: usize,
    /// The displacement whose stress is equilibrated (m).
    pub(crate) displacement: NodalField<D>,
    /// f_d on each element (N/m³), empty if there is none.
    pub(crate) body_force: Vec<[f64; D]>,
    /// Prescribed moments on the loaded faces (N).
    pub(crate) load_moments: Vec<[[f64; D]; D]>,
    pub(crate) surface: SurfaceStep<D>,
    /// The other fields of a split mass term.
    pub(crate) split: Option<SplitFields<D>>,
    /// Whether its stress is that of smoothed strains.
    pub(crate) smoothed: bool,
    /// ε* of the balanced stress, where a material yields.
    pub(crate) plastic: Option<EigenStrains>,
    /// Strain energy of the simulation and its plastic work (J).
    pub(crate) energies: [f64; 2],
}

/// The fields of a split mass term beside a_c (m/s²): M ã = M_c a_c + (M − M_c) w.
#[derive(Clone, Debug)]
pub(crate) struct SplitFields<const D: usize> {
    /// w.
    pub(crate) lumped: NodalField<D>,
    /// o₂, the acceleration of the skew part of the stress that (M − M_c) w is.
    pub(crate) skew: NodalField<D>,
}

/// The inertia that is balanced, as far as it is known without F_DA.
#[derive(Clone, Debug)]
pub(crate) enum KnownInertia<const D: usize> {
    /// All nodal forces but those of contact (N): external, internal, of supports.
    Forces(NodalField<D>),
    /// ã under all forces; a_c of a split mass term (m/s²).
    Acceleration(NodalField<D>),
}

impl<const D: usize> TimeLevel<D> {
    /// o₂ of a split mass term.
    pub(crate) fn skew(&self) -> Option<&[[f64; D]]> {
        self.split.as_ref().map(|split| &split.skew[..])
    }
}

/// A level of which the motion is known.
#[derive(Clone, Debug)]
pub(crate) struct MotionKnown<const D: usize> {
    pub(crate) level: TimeLevel<D>,
    /// At t_n.
    pub(crate) now: NodalMotion<D>,
    /// u̇_CA at t_{n−½} (m/s).
    pub(crate) mid_velocity: Option<NodalField<D>>,
    pub(crate) inertia: KnownInertia<D>,
}

/// Motion and ∫ã dt at an instant.
#[derive(Clone, Debug)]
pub(crate) struct Velocities<const D: usize> {
    pub(crate) motion: NodalMotion<D>,
    pub(crate) increment: Increment<D>,
    /// The same of o₂.
    pub(crate) skew_increment: Option<Increment<D>>,
}

/// A level of which the fields before t_n are known, ã and the contact density among them.
#[derive(Clone, Debug)]
pub(crate) struct ForcesBefore<const D: usize> {
    /// The level as it is unless the contact force jumps at t_n. No density acts before t_0.
    pub(crate) forces: ForcesKnown<D>,
    /// All forces but those of contact at the nodes of the contact surface (N), where ã depends on F_DA.
    pub(crate) surface_force: Vec<[f64; D]>,
}

/// A level of which ã and the contact density are known on both sides of t_n.
#[derive(Clone, Debug)]
pub(crate) struct ForcesKnown<const D: usize> {
    pub(crate) level: TimeLevel<D>,
    pub(crate) now: Velocities<D>,
    /// u̇_CA at t_{n−½} (m/s); the other fields there follow from those at t_n and at the level before.
    pub(crate) mid_velocity: Option<NodalField<D>>,
    /// ã after t_n; a_c of a split mass term (m/s²).
    pub(crate) acceleration: NodalField<D>,
    /// The contact density after t_n.
    pub(crate) density: Densities<D>,
    /// The values before t_n, where the contact force jumps there.
    pub(crate) before: Option<BeforeJump<D>>,
    /// Densities where nodes do not touch, over each step since the sampled level before.
    pub(crate) off_contact: Vec<OffContact<D>>,
    /// Densities and velocities beside nodes at two planes, over each step since the sampled level before.
    pub(crate) corner_sliding: Vec<CornerSliding<D>>,
    /// Part of friction in the contact part of η on each candidate face (J), up to t_{n−½} and to t_n.
    pub(crate) friction: Vec<[f64; 2]>,
}

/// Fields just before an instant at which the contact force jumps.
#[derive(Clone, Debug)]
pub(crate) struct BeforeJump<const D: usize> {
    /// ã at the nodes of the contact surface (m/s²).
    pub(crate) acceleration: Vec<[f64; D]>,
    pub(crate) density: Densities<D>,
}
