//! Rigid planes with Coulomb friction.

use thiserror::Error;

/// Why a plane was refused.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PlaneError {
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

/// A rigid plane that the body may touch, eq. \[2\] and \[3\].
#[derive(Clone, Debug, PartialEq)]
pub struct Plane<const D: usize> {
    point: [f64; D],
    direction: [f64; D],
    normal: [f64; D],
    friction: f64,
    group: Option<String>,
}

impl<const D: usize> Plane<D> {
    /// A plane through `point` (m) with its outward `normal` (of any length; it points to the
    /// body) and a coefficient of friction μ ≥ 0. With a `group`, only its facets may touch.
    ///
    /// # Errors
    /// A zero normal, values that are not finite, negative friction, friction in 1D.
    pub fn new(point: [f64; D], normal: [f64; D], friction: f64, group: Option<String>) -> Result<Self, PlaneError> {
        let length = dot(&normal, &normal).sqrt();
        if !length.is_finite() || length <= 0.0 {
            return Err(PlaneError::Normal { normal: normal.to_vec() });
        }
        if point.iter().any(|x| !x.is_finite()) {
            return Err(PlaneError::Point { point: point.to_vec() });
        }
        if !friction.is_finite() || friction < 0.0 {
            return Err(PlaneError::Friction { friction });
        }
        if D == 1 && friction != 0.0 {
            return Err(PlaneError::FrictionInOneDimension { friction });
        }
        Ok(Self { point, direction: normal, normal: normal.map(|n| n / length), friction, group })
    }

    /// The point it goes through (m).
    #[must_use]
    pub fn point(&self) -> &[f64; D] {
        &self.point
    }

    /// The normal as it was given, of any length: from it comes the same plane, bit by bit.
    #[must_use]
    pub fn direction(&self) -> &[f64; D] {
        &self.direction
    }

    /// Outward unit normal n.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> &[f64; D] {
        &self.normal
    }

    /// Coefficient of friction μ.
    #[inline]
    #[must_use]
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// The group of facets that may touch, if it was named.
    #[must_use]
    pub fn group(&self) -> Option<&str> {
        self.group.as_deref()
    }

    /// Signed distance of a point to the plane (m), positive outside.
    #[inline]
    #[must_use]
    pub fn gap(&self, x: &[f64; D]) -> f64 {
        (0..D).map(|c| (x[c] - self.point[c]) * self.normal[c]).sum()
    }

    /// Splits a vector into its normal component and its tangential part, eq. \[1\].
    ///
    /// The tangential part comes from the antisymmetric products w_cb = v_c n_b − v_b n_c, not by subtraction of the
    /// normal part: it is orthogonal to the normal to rounding of itself, however large the normal component is.
    #[inline]
    #[must_use]
    pub fn split(&self, v: &[f64; D]) -> (f64, [f64; D]) {
        let (n, mut tangential) = (&self.normal, [0.0; D]);
        for c in 0..D {
            for b in (0..D).filter(|&b| b != c) {
                tangential[c] += (v[c] * n[b] - v[b] * n[c]) * n[b];
            }
        }
        (dot(v, &self.normal), tangential)
    }

    /// Projects a force into Coulomb's cone: F_n ← max(0, F_n), ‖F_t‖ ≤ μF_n, eq. \[49\], \[50\].
    #[inline]
    #[must_use]
    pub fn project_into_cone(&self, force: &[f64; D]) -> [f64; D] {
        let (normal, tangential) = self.split(force);
        let normal = normal.max(0.0);
        let length = dot(&tangential, &tangential).sqrt();
        let limit = self.friction * normal;
        let scale = if length > limit { limit / length } else { 1.0 };
        let mut projected = [0.0; D];
        for c in 0..D {
            projected[c] = normal * self.normal[c] + scale * tangential[c];
        }
        projected
    }
}

#[inline]
pub(crate) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cone_projection() {
        let plane = Plane::new([0.0, 0.0], [0.0, 2.0], 0.5, None).unwrap();
        assert_eq!(plane.project_into_cone(&[0.3, 1.0]), [0.3, 1.0]);
        assert_eq!(plane.project_into_cone(&[-3.0, 1.0]), [-0.5, 1.0]);
        assert_eq!(plane.project_into_cone(&[1.0, -1.0]), [0.0, 0.0]);
        assert_eq!(plane.gap(&[7.0, -0.25]), -0.25);
    }

    #[test]
    fn impossible_planes_are_refused() {
        assert!(matches!(Plane::new([0.0], [0.0], 0.0, None), Err(PlaneError::Normal { .. })));
        assert!(matches!(Plane::new([f64::NAN], [1.0], 0.0, None), Err(PlaneError::Point { .. })));
        assert!(matches!(Plane::new([0.0, 0.0], [1.0, 0.0], -0.1, None), Err(PlaneError::Friction { .. })));
        assert!(matches!(Plane::new([0.0], [1.0], 0.1, None), Err(PlaneError::FrictionInOneDimension { .. })));
    }
}
