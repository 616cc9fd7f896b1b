//! Obstacles with friction: rigid planes, and the surfaces of other bodies.

use super::coulomb::Coulomb;
use super::frame::{Frame, dot};
use super::plane::Plane;
use thiserror::Error;

/// The reason why an obstacle was refused.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ObstacleError {
    /// Zero or not finite.
    #[error("`normal` is {normal:?}; it must be finite and not zero, and point from the plane to the body")]
    Normal {
        /// The normal given.
        normal: Vec<f64>,
    },
    /// Not finite.
    #[error("`point` is {point:?}; its coordinates (m) must be finite")]
    Point {
        /// The point given.
        point: Vec<f64>,
    },
    /// Negative or not finite.
    #[error("`gap` is {gap} m; it must be zero or positive, or \"auto\"")]
    Gap {
        /// The gap given.
        gap: f64,
    },
    /// Negative or not finite.
    #[error("`friction` is {friction}; the coefficient must be zero or positive")]
    Friction {
        /// The coefficient given.
        friction: f64,
    },
    /// Friction in 1D.
    #[error("`friction` is {friction}; a bar has no tangential direction; leave it out or give 0")]
    FrictionInOneDimension {
        /// The coefficient given.
        friction: f64,
    },
}

/// An obstacle that part of a body may touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle<const D: usize> {
    shape: ObstacleShape<D>,
    law: Coulomb,
    group: Option<String>,
    /// Of a plane that is still to be placed, its gap at the start (m).
    gap: Option<f64>,
}

/// The kinds of obstacles.
#[derive(Clone, Debug, PartialEq)]
enum ObstacleShape<const D: usize> {
    Plane(Plane<D>),
    /// The surface of another body, which moves; its frame does not turn. With the index of the non-matching
    /// interfaces, if they do.
    Surface(Frame<D>, Option<usize>),
}

impl<const D: usize> Obstacle<D> {
    /// A plane through `point` (m) with its outward `normal` (of any length; it points to the
    /// body) and a coefficient of friction μ ≥ 0. With a `group`, only its faces may touch.
    ///
    /// # Errors
    /// A zero normal, values that are not finite, negative friction, friction in 1D.
    pub fn plane(
        point: [f64; D],
        normal: [f64; D],
        friction: f64,
        group: Option<String>,
    ) -> Result<Self, ObstacleError> {
        let shape = Plane::new(point, normal).ok_or_else(|| ObstacleError::Normal { normal: normal.to_vec() })?;
        if point.iter().any(|x| !x.is_finite()) {
            return Err(ObstacleError::Point { point: point.to_vec() });
        }
        Ok(Self { shape: ObstacleShape::Plane(shape), law: coulomb(D, friction)?, group, gap: None })
    }

    /// The same plane, `gap` (m) from the nearest node that may touch it at the start.
    ///
    /// # Errors
    /// As [`Obstacle::plane`], and a gap that is negative or not finite.
    pub fn plane_at_gap(
        gap: f64,
        normal: [f64; D],
        friction: f64,
        group: Option<String>,
    ) -> Result<Self, ObstacleError> {
        if !gap.is_finite() || gap < 0.0 {
            return Err(ObstacleError::Gap { gap });
        }
        Ok(Self { gap: Some(gap), ..Self::plane([0.0; D], normal, friction, group)? })
    }

    /// Of a plane that is still to be placed, its gap at the start (m).
    pub(crate) fn gap_to_place(&self) -> Option<f64> {
        self.gap
    }

    /// A plane in its place, moved against its normal by a distance (m).
    pub(crate) fn moved_back(&self, distance: f64) -> Self {
        let shape = match &self.shape {
            ObstacleShape::Plane(plane) => ObstacleShape::Plane(plane.moved_back(distance)),
            surface @ ObstacleShape::Surface(..) => surface.clone(),
        };
        Self { shape, gap: None, ..self.clone() }
    }

    /// The surface of another body, as a group of faces meets it; `normal` is the unit normal from there to the group.
    /// With `non_matching`, the two slide along each other: it is their index in the contact surface.
    pub(crate) fn surface(normal: [f64; D], law: Coulomb, group: String, non_matching: Option<usize>) -> Self {
        Self { shape: ObstacleShape::Surface(Frame::new(normal), non_matching), law, group: Some(group), gap: None }
    }

    /// The index of the non-matching interfaces, if it is one of them.
    #[inline]
    #[must_use]
    pub fn non_matching(&self) -> Option<usize> {
        match self.shape {
            ObstacleShape::Plane(_) => None,
            ObstacleShape::Surface(_, non_matching) => non_matching,
        }
    }

    /// The plane, if it is one.
    #[must_use]
    pub fn as_plane(&self) -> Option<&Plane<D>> {
        match &self.shape {
            ObstacleShape::Plane(plane) => Some(plane),
            ObstacleShape::Surface(..) => None,
        }
    }

    /// The law of contact on it.
    #[inline]
    #[must_use]
    pub fn law(&self) -> Coulomb {
        self.law
    }

    /// Projects a force on a flat obstacle into the cone, eq. \[49\], \[50\].
    #[inline]
    #[must_use]
    pub fn project_into_cone(&self, force: &[f64; D]) -> [f64; D] {
        self.law.project(&self.flat_frame(), force)
    }

    /// The group of faces that may touch, if it was named.
    #[must_use]
    pub fn group(&self) -> Option<&str> {
        self.group.as_deref()
    }

    /// The gap (m) after a displacement against the obstacle (m) from a place with this gap. A distant obstacle leaves
    /// no rounding in it.
    #[inline]
    pub(super) fn gap_after(&self, gap: f64, displacement: &[f64; D]) -> f64 {
        gap + dot(displacement, self.flat_frame().normal())
    }

    /// The frame at a point.
    #[inline]
    #[must_use]
    pub fn frame_at(&self, _x: &[f64; D]) -> Frame<D> {
        self.flat_frame()
    }

    /// The frame of a flat obstacle, which is the same everywhere.
    #[inline]
    #[must_use]
    pub fn flat_frame(&self) -> Frame<D> {
        match &self.shape {
            ObstacleShape::Plane(plane) => plane.frame(),
            ObstacleShape::Surface(frame, _) => *frame,
        }
    }
}

/// The law of a coefficient of friction.
pub(super) fn coulomb(dimension: usize, friction: f64) -> Result<Coulomb, ObstacleError> {
    if !friction.is_finite() || friction < 0.0 {
        return Err(ObstacleError::Friction { friction });
    }
    if dimension == 1 && friction != 0.0 {
        return Err(ObstacleError::FrictionInOneDimension { friction });
    }
    Ok(Coulomb::new(friction))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_planes_are_refused() {
        assert!(matches!(Obstacle::plane([0.0], [0.0], 0.0, None), Err(ObstacleError::Normal { .. })));
        assert!(matches!(Obstacle::plane([f64::NAN], [1.0], 0.0, None), Err(ObstacleError::Point { .. })));
        assert!(matches!(Obstacle::plane([0.0, 0.0], [1.0, 0.0], -0.1, None), Err(ObstacleError::Friction { .. })));
        assert!(matches!(Obstacle::plane([0.0], [1.0], 0.1, None), Err(ObstacleError::FrictionInOneDimension { .. })));
    }

    #[test]
    fn the_gap_of_a_plane_is_the_distance() {
        let plane = Obstacle::plane([0.0, 0.0], [0.0, 2.0], 0.5, None).unwrap();
        assert_eq!(plane.as_plane().map(|plane| plane.gap(&[7.0, -0.25])), Some(-0.25));
    }
}
