//! Admissible stress σ_DA on an element (§6.2.2): in equilibrium with the tractions on its faces
//! and with Γ_DA − f_d, exactly, and of least complementary energy among a family.

mod bar;
mod combined_gram;
mod conditions;
mod elimination;
mod energy_form;
mod fluctuation;
mod piecewise;
mod reference;
mod shapes;
mod tetrahedron;
mod traction_forms;
mod triangle;

use bar::BarStress;
pub(crate) use energy_form::{ElementForm, EnergyForm, EnergyForms, FluctuationForm};
pub(crate) use fluctuation::Fluctuation;
use percute_core::cell::{Cell, CellKind};
use percute_core::material::LinearLaw;
pub(crate) use piecewise::MONOMIALS;
pub(crate) use reference::LOADS;
pub(crate) use tetrahedron::MomentForms;
use tetrahedron::TetrahedronStress;
pub(crate) use traction_forms::{BasisForm, EDGES, TractionForms};
pub(crate) use triangle::TriangleStress;

/// What an element's stress must balance, per unit of section or thickness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Loading<const D: usize, const N: usize, T = f64> {
    /// |e| F̂ at the nodes of each face: face k lies opposite to node k, its p-th node is
    /// k + 1 + p (mod N).
    pub(crate) traction: [[[T; D]; D]; N],
    /// Γ_DA − f_d at the nodes (N/m³).
    pub(crate) volume: [[T; D]; N],
}

/// Local number of the p-th node of the face opposite to node k.
#[inline]
pub(crate) const fn face_node<const N: usize>(k: usize, p: usize) -> usize {
    (k + 1 + p) % N
}

/// Largest relative violations of the equations of one element's stress.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StressResiduals {
    pub(crate) divergence: f64,
    pub(crate) edges: f64,
    pub(crate) inner: f64,
}

/// The linear map from loading to stress of one element; constant in time.
#[derive(Clone, Debug)]
pub(crate) enum StressMap {
    Bar(BarStress),
    Triangle(Box<TriangleStress>),
    Tetrahedron(Box<TetrahedronStress>),
}

impl StressMap {
    pub(crate) fn new<const D: usize, const N: usize>(
        kind: &dyn Cell<D, N>,
        points: &[[f64; D]; N],
        law: &impl LinearLaw,
    ) -> Self {
        match kind.kind() {
            CellKind::Bar => Self::Bar(BarStress::new(kind.signed_volume(points), law)),
            CellKind::Triangle => {
                let corners = std::array::from_fn(|i| [points[i][0], points[i][1]]);
                Self::Triangle(Box::new(TriangleStress::new(&corners, law)))
            }
            CellKind::Tetrahedron => {
                let corners = std::array::from_fn(|i| [points[i][0], points[i][1], points[i][2]]);
                Self::Tetrahedron(Box::new(TetrahedronStress::new(&corners, law)))
            }
        }
    }

    /// Mean over the element of the stress that balances a loading (Pa).
    pub(crate) fn mean<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> [[f64; D]; D] {
        match self {
            Self::Bar(map) => [[map.mean(loading); D]; D],
            Self::Triangle(map) => tensor(&map.mean(loading)),
            Self::Tetrahedron(map) => tensor(&map.mean(loading)),
        }
    }

    /// How well the stress satisfies its equations; `floor` is the smallest traction |e|F that
    /// counts.
    pub(crate) fn residuals<const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N>,
        floor: f64,
    ) -> StressResiduals {
        match self {
            Self::Bar(map) => map.residuals(loading, floor),
            Self::Triangle(map) => map.residuals(loading, floor),
            Self::Tetrahedron(map) => map.residuals(loading, floor),
        }
    }
}

/// A stress of which 11, 22 and 12 are given in a plane, 11, 22, 33, 23, 13 and 12 in space.
pub(crate) fn tensor<const D: usize, const COMPONENTS: usize>(components: &[f64; COMPONENTS]) -> [[f64; D]; D] {
    let at = |a: usize, b: usize| if a == b { a } else { COMPONENTS - a - b };
    std::array::from_fn(|a| std::array::from_fn(|b| components[at(a, b)]))
}
