//! The auxiliary solution of a body, for either kinematics and any kind of elements.

use super::finite::FiniteAuxiliary;
use super::solid::SolidAuxiliary;
use super::{AuxiliaryLevel, AuxiliarySolutions, EnergyBalance, Foreseen, Shares, SimulatedLevel};
use crate::difference::Difference;
use crate::element::Element;
use crate::plastic::EigenStrains;
use crate::reconstruction::corrected::present_stars::PresentStars;
use crate::smoothing::Smoothing;
use percute_core::cell::CellKind;
use percute_core::dynamics::Dynamics;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::sync::Arc;

/// That of small strains, with the motions beside it, that of a body that turns, or that of a solid.
#[derive(Debug)]
pub(in crate::reconstruction::corrected) enum Auxiliary<'p, const D: usize, const N: usize> {
    Small(Box<AuxiliarySolutions<'p, D, N>>),
    Finite(Box<FiniteAuxiliary<'p, D, N>>),
    Solid(Box<SolidAuxiliary<'p, D, N>>),
}

/// The same method of each.
macro_rules! of_either {
    ($of:expr, $own:ident => $result:expr) => {
        match $of {
            Self::Small($own) => $result,
            Self::Finite($own) => $result,
            Self::Solid($own) => $result,
        }
    };
}

impl<'p, const D: usize, const N: usize> Auxiliary<'p, D, N> {
    /// Before the first level, with these shares of the corrections.
    pub(in crate::reconstruction::corrected) fn new(
        problem: &'p Problem<D>,
        times: &'p TimeGrid,
        smoothing: Arc<Smoothing>,
        shares: Shares,
    ) -> Self {
        match problem.mesh().kind() {
            _ if problem.is_finite() => Self::Finite(Box::new(FiniteAuxiliary::new(problem, times, smoothing, shares))),
            CellKind::Tetrahedron => Self::Solid(Box::new(SolidAuxiliary::new(problem, times, smoothing, shares))),
            CellKind::Bar | CellKind::Triangle => {
                Self::Small(Box::new(AuxiliarySolutions::new(problem, times, smoothing, shares)))
            }
        }
    }

    /// About how much memory it takes (bytes).
    pub(in crate::reconstruction::corrected) fn memory(nodes: usize, elements: usize) -> usize {
        match D {
            3 => SolidAuxiliary::<D, N>::memory(nodes, elements),
            _ => AuxiliarySolutions::<D, N>::memory(nodes, elements),
        }
    }

    /// Takes in the data of the elements.
    pub(in crate::reconstruction::corrected) fn prepare(&mut self, elements: &[Element<D, N>]) {
        of_either!(self, own => own.prepare(elements));
    }

    /// Takes in the loads and supports of a level. Levels come in order.
    pub(in crate::reconstruction::corrected) fn begin(&mut self, dynamics: &Dynamics<'_, D>, n: usize) {
        match self {
            Self::Small(own) => own.begin(dynamics, n),
            Self::Finite(own) => own.begin(dynamics, n),
            Self::Solid(own) => own.begin(n),
        }
    }

    /// Foresees the motion at all contact nodes until t_{n+1}, after `begin`; of a body that turns from its stars at
    /// t_n. None where nodes have no contacts of their own.
    pub(in crate::reconstruction::corrected) fn foresee<'a>(
        &'a mut self,
        n: usize,
        stars: Option<&'a PresentStars<'_, D>>,
    ) -> Option<Foreseen<'a, D>> {
        match self {
            Self::Small(own) => Some(own.foresee(n)),
            Self::Finite(own) => own.foresee(n, stars?),
            Self::Solid(_) => None,
        }
    }

    /// Takes in a level: forces of the density on the nodes of the contact surface (N). Goes on to the next half step
    /// and fills in the fields of the auxiliary solution.
    pub(in crate::reconstruction::corrected) fn advance(
        &mut self,
        dynamics: &Dynamics<'_, D>,
        n: usize,
        simulated: &SimulatedLevel<'_, D>,
        pull: &[[f64; D]],
        level: AuxiliaryLevel<'_, D>,
    ) {
        of_either!(self, own => own.advance(dynamics, n, simulated, pull, level));
    }

    /// Measures the difference of the simulation and this solution at the last level taken in, once for a level; not of
    /// a body that turns, nor of a solid.
    pub(in crate::reconstruction::corrected) fn differ(&mut self, simulated: [&[[f64; D]]; 2], halvings: [f64; 2]) {
        if let Self::Small(own) = self {
            own.differ(simulated, halvings);
        }
    }

    /// The differences at all levels so far: those that were measured.
    pub(in crate::reconstruction::corrected) fn differences(&self) -> Option<&[Difference]> {
        match self {
            Self::Small(own) => own.differences(),
            Self::Finite(_) | Self::Solid(_) => None,
        }
    }

    /// ε* of all elements at the level that has begun, where a material yields.
    pub(in crate::reconstruction::corrected) fn eigenstrains(&self) -> Option<&EigenStrains> {
        match self {
            Self::Small(own) => own.eigenstrains(),
            Self::Finite(_) | Self::Solid(_) => None,
        }
    }

    /// u at the level to come (m), of a body that turns.
    pub(in crate::reconstruction::corrected) fn displacement(&self) -> Option<&[[f64; D]]> {
        match self {
            Self::Small(_) | Self::Solid(_) => None,
            Self::Finite(own) => Some(own.displacement()),
        }
    }

    /// Whether strains are smoothed at the level that has begun.
    pub(in crate::reconstruction::corrected) fn smooths(&self) -> bool {
        of_either!(self, own => own.smooths())
    }

    /// Whether it has become unstable.
    pub(in crate::reconstruction::corrected) fn is_unstable(&self) -> bool {
        of_either!(self, own => own.is_unstable())
    }

    /// The largest energy that contact has given it so far, over that of the simulation.
    pub(in crate::reconstruction::corrected) fn contact_energy(&self) -> f64 {
        let balance: &EnergyBalance<D> = of_either!(self, own => own.energy_balance());
        balance.contact_energy()
    }
}
