//! Obstacles and the nodes that face them, of any dimension.

use super::{ContactConfiguration, Coulomb, Frame, Obstacle, ObstacleError, Plane};
use crate::border::{Vector, cut, padded, vectors};
use std::any::Any;

/// An obstacle of any dimension.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyObstacle {
    /// Of a bar.
    D1(Obstacle<1>),
    /// Of a plane body.
    D2(Obstacle<2>),
    /// Of a solid.
    D3(Obstacle<3>),
}

macro_rules! on {
    ($any:expr, $inner:pat => $body:expr) => {
        match $any {
            Self::D1($inner) => $body,
            Self::D2($inner) => $body,
            Self::D3($inner) => $body,
        }
    };
}

impl From<Obstacle<1>> for AnyObstacle {
    fn from(obstacle: Obstacle<1>) -> Self {
        Self::D1(obstacle)
    }
}

impl From<Obstacle<2>> for AnyObstacle {
    fn from(obstacle: Obstacle<2>) -> Self {
        Self::D2(obstacle)
    }
}

impl From<Obstacle<3>> for AnyObstacle {
    fn from(obstacle: Obstacle<3>) -> Self {
        Self::D3(obstacle)
    }
}

/// The place of a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaneAt {
    /// A point on it (m).
    Point(Vector),
    /// Its distance from the nearest node at the start (m).
    Gap(f64),
}

impl AnyObstacle {
    /// A plane in so many dimensions: [`Obstacle::plane`], [`Obstacle::plane_at_gap`].
    ///
    /// # Errors
    /// A value out of range.
    pub fn plane(
        dimension: usize,
        place: PlaneAt,
        normal: &Vector,
        friction: f64,
        group: Option<String>,
    ) -> Result<Self, ObstacleError> {
        fn made<const D: usize>(
            place: PlaneAt,
            normal: &Vector,
            friction: f64,
            group: Option<String>,
        ) -> Result<Obstacle<D>, ObstacleError> {
            match place {
                PlaneAt::Point(point) => Obstacle::plane(cut(&point), cut(normal), friction, group),
                PlaneAt::Gap(gap) => Obstacle::plane_at_gap(gap, cut(normal), friction, group),
            }
        }
        match dimension {
            1 => made(place, normal, friction, group).map(Self::D1),
            2 => made(place, normal, friction, group).map(Self::D2),
            _ => made(place, normal, friction, group).map(Self::D3),
        }
    }

    /// The obstacle with its dimension.
    pub(crate) fn typed<const D: usize>(&self) -> Option<&Obstacle<D>> {
        on!(self, obstacle => (obstacle as &dyn Any).downcast_ref())
    }

    /// Its friction.
    #[must_use]
    pub fn law(&self) -> Coulomb {
        on!(self, obstacle => obstacle.law())
    }

    /// The group of faces that may touch it, if it is not all.
    #[must_use]
    pub fn group(&self) -> Option<&str> {
        on!(self, obstacle => obstacle.group())
    }

    /// The interface whose nodes do not face each other, of which it is a side.
    #[must_use]
    pub fn non_matching(&self) -> Option<usize> {
        on!(self, obstacle => obstacle.non_matching())
    }

    /// Whether it is a plane; else it is the surface of another body.
    #[must_use]
    pub fn is_plane(&self) -> bool {
        on!(self, obstacle => obstacle.as_plane().is_some())
    }

    /// A point of a plane (m) and its direction as it was stated.
    #[must_use]
    pub fn as_plane(&self) -> Option<[Vector; 2]> {
        fn of<const D: usize>(plane: &Plane<D>) -> [Vector; 2] {
            [padded(plane.point()), padded(plane.direction())]
        }
        on!(self, obstacle => obstacle.as_plane().map(of))
    }

    /// The distance of a place from a plane (m), negative behind it; none of the surface of another body.
    #[must_use]
    pub fn gap(&self, place: &Vector) -> Option<f64> {
        on!(self, obstacle => obstacle.as_plane().map(|plane| plane.gap(&cut(place))))
    }

    /// Its frame.
    #[must_use]
    pub fn frame(&self) -> Frame<3> {
        on!(self, obstacle => Frame::new(padded(obstacle.flat_frame().normal())))
    }
}

/// The contact surface at an instant, in any dimension. Fields are in rows.
#[derive(Clone, Debug)]
pub enum AnyContactConfiguration<'a> {
    /// Of a bar.
    D1(ContactConfiguration<'a, 1>),
    /// Of a plane body.
    D2(ContactConfiguration<'a, 2>),
    /// Of a solid.
    D3(ContactConfiguration<'a, 3>),
}

impl AnyContactConfiguration<'_> {
    /// A nodal field at a node less that at its counterpart: [`ContactConfiguration::relative`].
    #[must_use]
    pub fn relative(&self, at: usize, field: &[f64]) -> Vector {
        on!(self, configuration => padded(&configuration.relative(at, vectors(field))))
    }

    /// The gap of a node (m): [`ContactConfiguration::gap`].
    #[must_use]
    pub fn gap(&self, at: usize, displacement: &[f64]) -> f64 {
        on!(self, configuration => configuration.gap(at, vectors(displacement)))
    }

    /// How far a condition gives way (m): [`ContactConfiguration::give`].
    #[must_use]
    pub fn give(&self, at: usize, forces: &[f64]) -> f64 {
        on!(self, configuration => configuration.give(at, vectors(forces)))
    }

    /// Whether a node has a condition of contact: [`ContactConfiguration::has_condition`].
    #[must_use]
    pub fn has_condition(&self, at: usize) -> bool {
        on!(self, configuration => configuration.has_condition(at))
    }

    /// The forces that the conditions are about (N): [`ContactConfiguration::forces`].
    #[must_use]
    pub fn forces(&self, reaction: &[f64]) -> Vec<f64> {
        on!(self, configuration => configuration.forces(vectors(reaction)).into_flattened())
    }

    /// Gives masters the status that follows from that of their slaves: [`ContactConfiguration::settle_masters`].
    pub fn settle_masters(&self, touching: &mut [bool]) {
        on!(self, configuration => configuration.settle_masters(touching));
    }
}
