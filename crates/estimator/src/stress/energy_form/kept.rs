//! The form of an element that is kept.

use super::{COLUMNS, EnergyForm, EnergyForms, FluctuationForm, LOADS, ReferenceMap, coordinates};
use crate::lanes::Value;
use crate::stress::bar::BarStress;
use crate::stress::{Fluctuation, Loading};
use percute_core::ids::ElementId;
use percute_core::problem::Problem;

/// The form of one element.
#[derive(Clone, Debug)]
pub(crate) enum KeptForm {
    Bar(BarStress),
    Triangle(Box<KeptTriangle>),
}

/// The form of one triangle.
#[derive(Clone, Debug)]
pub(crate) struct KeptTriangle {
    map: ReferenceMap,
    /// L; above the diagonal, 0.
    factor: [[f64; LOADS]; LOADS],
}

impl KeptForm {
    /// That of an element, which it shares with no other.
    pub(crate) fn new<const D: usize, const N: usize>(problem: &Problem<D, N>, id: ElementId) -> Self {
        let points = problem.mesh().cell_points(id);
        let mut forms = EnergyForms::new(problem.mesh().simplex().shape());
        let [lane, ..] = forms.prepare(problem, std::iter::once((id, points)));
        match forms.of(problem, id, &points, lane) {
            EnergyForm::Bar(map) => Self::Bar(map),
            EnergyForm::Triangle(form) => Self::Triangle(Box::new(KeptTriangle {
                map: form.map,
                factor: form.factors.each_ref().map(|row| row.each_ref().map(|entry| entry.0[lane])),
            })),
        }
    }

    /// Memory of one (bytes).
    pub(crate) const fn memory() -> usize {
        size_of::<KeptTriangle>()
    }
}

impl FluctuationForm for KeptForm {
    #[inline(always)]
    fn fluctuation<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> Fluctuation<D, N, T> {
        match self {
            Self::Bar(map) => map.fluctuation(loading),
            Self::Triangle(form) => {
                let loads = form.map.pull_back(loading);
                coordinates(form.columns::<0, T>(&loads), form.columns::<COLUMNS, T>(&loads))
            }
        }
    }
}

impl KeptTriangle {
    /// The products of some columns of L with loads, as those of a form in a lane.
    #[inline(always)]
    fn columns<const FIRST: usize, T: Value>(&self, loads: &[T; LOADS]) -> [T; COLUMNS] {
        let mut sums = [loads[0].zero(); COLUMNS];
        for i in FIRST..LOADS {
            for j in 0..COLUMNS {
                sums[j] += loads[i] * self.factor[i][FIRST + j];
            }
        }
        sums
    }
}
