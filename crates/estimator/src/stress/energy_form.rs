//! The elastic energy of the stress of an element, for some elements side by side.
//!
//! The law is constant in an element, so the mean of a stress and what is left of it have separate energies. The mean
//! follows from the forces on the nodes. The rest, the *fluctuation*, follows from the differences of the tractions at
//! the nodes of each face and from Γ_DA − f_d: with these given, the tractions that put no force on any node are
//! unique. The tractions of a constant stress add nothing to the fluctuation.
//!
//! The form of the fluctuation follows from the shape and the law. It is written LLᵀ, so that Lᵀ gives coordinates in
//! which the energy is the sum of squares. Coordinates are linear in the loads: half way between two instants they are
//! the mean. The form takes more memory than all other data of an element, so it is made anew for each window of
//! levels, for [`LANES`] elements at once, and elements of the same shape share it. Elements around contact nodes,
//! of which there are few, keep theirs ([`ElementForm`]).

mod element_form;
mod triangle_forms;

use super::bar::BarStress;
use super::tetrahedron::{TetrahedronForm, TetrahedronForms};
use super::{Fluctuation, Loading};
pub(crate) use element_form::ElementForm;
use percute_core::cell::{CellKind, cell};
use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use percute_core::simd::lanes::{LANES, Value};
use triangle_forms::{TriangleForm, TriangleForms};

/// The forms of the last elements that were asked for.
#[derive(Clone, Debug)]
pub(crate) enum EnergyForms {
    Bars,
    Triangles(TriangleForms),
    Tetrahedra(TetrahedronForms),
}

/// The form of one element.
#[derive(Clone, Copy, Debug)]
pub(crate) enum EnergyForm<'a> {
    Bar(BarStress),
    Triangle(TriangleForm<'a>),
    Tetrahedron(&'a TetrahedronForm),
}

impl EnergyForms {
    /// For elements of this shape.
    pub(crate) fn new(shape: CellKind) -> Self {
        match shape {
            CellKind::Bar => Self::Bars,
            CellKind::Triangle => Self::Triangles(TriangleForms::new()),
            CellKind::Tetrahedron => Self::Tetrahedra(TetrahedronForms::new()),
        }
    }

    /// Makes the forms of at most [`LANES`] elements with these nodes (m), unless they are there, and gives their
    /// lanes.
    #[inline(always)]
    pub(crate) fn prepare<const D: usize, const N: usize>(
        &mut self,
        problem: &Problem<D>,
        elements: impl Iterator<Item = (ElementId, [[f64; D]; N])> + Clone,
    ) -> [usize; LANES] {
        match self {
            Self::Bars => [0; LANES],
            Self::Triangles(forms) => {
                forms.prepare(elements.map(|(id, points)| (corners(&points), problem.material(id))))
            }
            Self::Tetrahedra(forms) => {
                forms.prepare(elements.map(|(id, points)| (corners(&points), problem.material(id))))
            }
        }
    }

    /// The form of an element with these nodes (m), in a lane.
    #[inline(always)]
    pub(crate) fn of<const D: usize, const N: usize>(
        &self,
        problem: &Problem<D>,
        id: ElementId,
        points: &[[f64; D]; N],
        lane: usize,
    ) -> EnergyForm<'_> {
        match self {
            Self::Bars => EnergyForm::Bar(BarStress::new(cell::<D, N>().signed_volume(points), problem.material(id))),
            Self::Triangles(forms) => EnergyForm::Triangle(forms.of(lane, &corners(points))),
            Self::Tetrahedra(forms) => EnergyForm::Tetrahedron(forms.of(lane)),
        }
    }
}

/// A form by which fluctuations are made.
pub(crate) trait FluctuationForm {
    /// The coordinates of the fluctuation of the stress that balances a loading.
    fn fluctuation<T: Value, const D: usize, const N: usize>(&self, loading: &Loading<D, N, T>)
    -> Fluctuation<D, N, T>;
}

impl FluctuationForm for EnergyForm<'_> {
    #[inline(always)]
    fn fluctuation<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> Fluctuation<D, N, T> {
        match self {
            Self::Bar(map) => map.fluctuation(loading),
            Self::Triangle(form) => form.fluctuation(loading),
            Self::Tetrahedron(form) => form.fluctuation(loading),
        }
    }
}

impl EnergyForm<'_> {
    /// The slope (m) of the energy of a fluctuation (J) in the outward moments (N) at the nodes of each face; in 1D,
    /// where a face is a point, zero.
    #[inline(always)]
    pub(crate) fn fluctuation_slope<T: Value, const D: usize, const N: usize>(
        &self,
        fluctuation: &Fluctuation<D, N, T>,
    ) -> [[[T; D]; D]; N] {
        match self {
            Self::Bar(_) => [[[fluctuation.coordinates[0][0][0].zero(); D]; D]; N],
            Self::Triangle(form) => form.fluctuation_slope(fluctuation),
            Self::Tetrahedron(form) => form.fluctuation_slope(fluctuation),
        }
    }
}

/// The corners of an element whose dimension and nodes are `E` and `M`.
#[inline(always)]
fn corners<const D: usize, const N: usize, const E: usize, const M: usize>(points: &[[f64; D]; N]) -> [[f64; E]; M] {
    let mut corners = [[0.0; E]; M];
    for i in 0..M {
        for c in 0..E {
            corners[i][c] = points[i][c];
        }
    }
    corners
}
