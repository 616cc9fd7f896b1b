//! Coulomb's law: the cone, the status of a node, dissipation.

use super::frame::{Frame, dot};

/// A tangential force within this of Coulomb's limit, relatively, slides. That leaves room for forces that
/// another program has stored in single precision.
const LIMIT: f64 = 1e-6;
/// A tangential force is part of a vector, and no more accurate than this times its normal force.
const ROUNDING: f64 = 1e-15;

/// The state of a node of the contact surface under R_n, in the step from t_n to t_{n+1}.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Status {
    /// R_n is zero.
    #[default]
    Free = 0,
    /// No motion along the obstacle: R_n is inside Coulomb's cone.
    Stick = 1,
    /// Motion along the obstacle: R_n is on the cone, eq. \[2\]. Without friction all contact slips.
    Slip = 2,
}

/// Coulomb's law with a coefficient μ ≥ 0, eq. \[2\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    friction: f64,
}

impl Coulomb {
    /// Contact without friction.
    pub(crate) const FRICTIONLESS: Self = Self { friction: 0.0 };

    pub(super) fn new(friction: f64) -> Self {
        Self { friction }
    }

    /// Coefficient of friction μ.
    #[inline]
    #[must_use]
    pub fn friction(self) -> f64 {
        self.friction
    }

    /// The largest tangential force under a normal force, μF_n.
    #[inline]
    #[must_use]
    pub fn limit(self, normal: f64) -> f64 {
        self.friction * normal
    }

    /// Scales `factor` down so that a tangential force of this size, which goes with it, reaches the limit only.
    #[inline]
    pub(crate) fn admissible(self, normal: f64, tangential: f64, factor: f64) -> f64 {
        let limit = self.limit(normal);
        if tangential > limit { factor * limit / tangential } else { factor }
    }

    /// Projects a force into the cone: F_n ← max(0, F_n), ‖F_t‖ ≤ μF_n, eq. \[49\], \[50\].
    #[inline]
    #[must_use]
    pub fn project<const D: usize>(self, frame: &Frame<D>, force: &[f64; D]) -> [f64; D] {
        let (normal, tangential) = frame.split(force);
        let normal = normal.max(0.0);
        let scale = self.admissible(normal, dot(&tangential, &tangential).sqrt(), 1.0);
        std::array::from_fn(|c| normal * frame.normal()[c] + scale * tangential[c])
    }

    /// How far a force lies outside the cone (N): ‖F_t‖ − μF_n and −F_n, both at most 0 inside.
    #[inline]
    #[must_use]
    pub fn excess<const D: usize>(self, frame: &Frame<D>, force: &[f64; D]) -> [f64; 2] {
        let (normal, tangential) = frame.split(force);
        [dot(&tangential, &tangential).sqrt() - self.limit(normal), -normal]
    }

    /// The status under a reaction (N).
    #[must_use]
    pub fn status<const D: usize>(self, frame: &Frame<D>, reaction: &[f64; D]) -> Status {
        let (normal, tangential) = frame.split(reaction);
        if normal <= 0.0 {
            return Status::Free;
        }
        let limit = self.limit(normal) * (1.0 - LIMIT) - ROUNDING * normal;
        if dot(&tangential, &tangential).sqrt() >= limit { Status::Slip } else { Status::Stick }
    }

    /// b(−w, F) + w·F of a sliding velocity w and a force along one tangent, μF_n|w| + wF_t (W): 0 where the law holds.
    #[inline]
    #[must_use]
    pub fn misfit(self, normal: f64, tangential: f64, sliding: f64) -> f64 {
        self.limit(normal) * sliding.abs() + sliding * tangential
    }

    /// The same of vectors (N, m/s), of which the parts along the obstacle count.
    #[inline]
    #[must_use]
    pub fn misfit_along<const D: usize>(self, frame: &Frame<D>, force: &[f64; D], velocity: &[f64; D]) -> f64 {
        let ((normal, tangential), (_, sliding)) = (frame.split(force), frame.split(velocity));
        self.limit(normal) * dot(&sliding, &sliding).sqrt() + dot(&sliding, &tangential)
    }
}

/// Energy (J) that friction dissipates under a force (N) over a path (m), −F_t·Δu.
#[inline]
pub(crate) fn dissipation<const D: usize>(frame: &Frame<D>, force: &[f64; D], path: &[f64; D]) -> f64 {
    -dot(&frame.split(force).1, path)
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: [f64; 2] = [0.0, 1.0];

    #[test]
    fn forces_are_projected_into_the_cone() {
        let project = |force| Coulomb::new(0.5).project(&Frame::new(UP), &force);
        assert_eq!(project([0.3, 1.0]), [0.3, 1.0]);
        assert_eq!(project([-3.0, 1.0]), [-0.5, 1.0]);
        assert_eq!(project([1.0, -1.0]), [0.0, 0.0]);
    }

    #[test]
    fn the_cone_decides_the_status() {
        let status = |friction, reaction| Coulomb::new(friction).status(&Frame::new(UP), &reaction);
        assert_eq!(status(0.5, [0.0, 0.0]), Status::Free);
        assert_eq!(status(0.5, [0.4999, 1.0]), Status::Stick);
        assert_eq!(status(0.5, [-0.5, 1.0]), Status::Slip);
        // Stored in single precision: 6e-8 too small.
        assert_eq!(status(0.3, [f64::from(0.3_f32 * 0.7), f64::from(0.7_f32)]), Status::Slip);
        assert_eq!(status(0.0, [0.0, 1.0]), Status::Slip);
        // The coefficient is tiny, and rounding has removed the tangential force.
        assert_eq!(status(1e-16, [0.0, 1.0]), Status::Slip);
    }
}
