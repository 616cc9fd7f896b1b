//! Free, sticking or sliding.

use crate::obstacle::{Plane, dot};
use crate::problem::Problem;

/// A tangential force within this of Coulomb's limit, relatively, slides: that leaves room for forces that
/// another program has stored in single precision.
const LIMIT: f64 = 1e-6;
/// A tangential force is a part of the whole one, and no more accurate than this times that.
const ROUNDING: f64 = 1e-15;

/// What a node of the contact surface does under R_n, in the half step after t_n.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Status {
    /// The plane does not push it: R_n is zero.
    #[default]
    Free = 0,
    /// It does not move along the plane: R_n is inside Coulomb's cone.
    Stick = 1,
    /// It moves along the plane: R_n is on the cone, eq. \[2\]. Without friction all contact slips.
    Slip = 2,
}

/// What decides the status of one node.
#[derive(Clone, Copy, Debug)]
pub(super) enum Law {
    /// Coulomb's law with this coefficient.
    Friction(f64),
    /// A support holds it along the plane, as on a plane of symmetry.
    Held,
    /// A support moves it along the plane.
    Moved,
}

impl Law {
    /// One for each node of the contact surface.
    pub(super) fn of_surface<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Vec<Self> {
        let law = |contact: &crate::problem::ContactNode| {
            if !contact.guided {
                return Self::Friction(problem.obstacles()[contact.obstacle].friction());
            }
            let moved = problem.prescribed().iter().any(|p| p.node == contact.node && p.motion.is_some());
            if moved { Self::Moved } else { Self::Held }
        };
        problem.surface().nodes().iter().map(law).collect()
    }

    /// The status under a reaction (N).
    pub(super) fn status<const D: usize>(self, plane: &Plane<D>, reaction: &[f64; D]) -> Status {
        let (normal, tangential) = plane.split(reaction);
        if normal <= 0.0 {
            return Status::Free;
        }
        match self {
            Self::Held => Status::Stick,
            Self::Moved => Status::Slip,
            Self::Friction(friction) => {
                let limit = friction * normal * (1.0 - LIMIT) - ROUNDING * normal;
                if dot(&tangential, &tangential).sqrt() >= limit { Status::Slip } else { Status::Stick }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cone_decides() {
        let plane = Plane::new([0.0, 0.0], [0.0, 1.0], 0.5, None).unwrap();
        let status = |friction, reaction| Law::Friction(friction).status(&plane, &reaction);
        assert_eq!(status(0.5, [0.0, 0.0]), Status::Free);
        assert_eq!(status(0.5, [0.4999, 1.0]), Status::Stick);
        assert_eq!(status(0.5, [-0.5, 1.0]), Status::Slip);
        // Stored in single precision: 6e-8 too small.
        assert_eq!(status(0.3, [f64::from(0.3_f32 * 0.7), f64::from(0.7_f32)]), Status::Slip);
        assert_eq!(status(0.0, [0.0, 1.0]), Status::Slip);
        // A tiny coefficient, and a tangential force that rounding has eaten.
        assert_eq!(status(1e-16, [0.0, 1.0]), Status::Slip);
        assert_eq!(Law::Held.status(&plane, &[0.0, 1.0]), Status::Stick);
        assert_eq!(Law::Moved.status(&plane, &[0.0, 1.0]), Status::Slip);
        assert_eq!(Law::Held.status(&plane, &[0.0, 0.0]), Status::Free);
    }
}
