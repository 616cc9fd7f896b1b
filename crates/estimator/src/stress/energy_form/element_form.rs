//! The form of a single element.

use super::triangle_forms::{COLUMNS, ReferenceMap, coordinates};
use super::{EnergyForm, EnergyForms, FluctuationForm};
use crate::stress::bar::BarStress;
use crate::stress::fluctuation::FLUCTUATION_LOADS;
use crate::stress::tetrahedron::TetrahedronForm;
use crate::stress::{Fluctuation, Loading};
use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use percute_core::simd::lanes::Value;

/// The form of one element.
#[derive(Clone, Debug)]
pub(crate) enum ElementForm {
    Bar(BarStress),
    Triangle(Box<StoredTriangleForm>),
    Tetrahedron(Box<TetrahedronForm>),
}

/// The form of one triangle.
#[derive(Clone, Debug)]
pub(crate) struct StoredTriangleForm {
    map: ReferenceMap,
    /// L; above the diagonal, 0.
    factor: [[f64; FLUCTUATION_LOADS]; FLUCTUATION_LOADS],
}

impl ElementForm {
    /// That of an element, which it shares with no other.
    pub(crate) fn new<const D: usize, const N: usize>(problem: &Problem<D>, id: ElementId) -> Self {
        let points = problem.mesh().corners::<D, N>(id);
        let mut forms = EnergyForms::new(problem.mesh().kind());
        let [lane, ..] = forms.prepare(problem, std::iter::once((id, points)));
        match forms.of(problem, id, &points, lane) {
            EnergyForm::Bar(map) => Self::Bar(map),
            EnergyForm::Triangle(form) => {
                Self::Triangle(Box::new(StoredTriangleForm { map: form.map, factor: form.factor() }))
            }
            EnergyForm::Tetrahedron(form) => Self::Tetrahedron(Box::new(form.clone())),
        }
    }

    /// Memory of one in this dimension (bytes), at most.
    pub(crate) const fn memory<const D: usize>() -> usize {
        if D == 3 { size_of::<TetrahedronForm>() } else { size_of::<StoredTriangleForm>() }
    }
}

impl FluctuationForm for ElementForm {
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
            Self::Tetrahedron(form) => form.fluctuation(loading),
        }
    }
}

impl StoredTriangleForm {
    /// The products of some columns of L with loads, as those of a form in a lane.
    #[inline(always)]
    fn columns<const FIRST: usize, T: Value>(&self, loads: &[T; FLUCTUATION_LOADS]) -> [T; COLUMNS] {
        let mut sums = [loads[0].zero(); COLUMNS];
        for i in FIRST..FLUCTUATION_LOADS {
            for j in 0..COLUMNS {
                sums[j] += loads[i] * self.factor[i][FIRST + j];
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::material::Elastic;
    use percute_core::mesh::Mesh;
    use percute_testkit::{Random, random_rectangle};

    /// The form that is kept gives the bits of the form that is made anew, among others.
    #[test]
    fn a_form_that_is_kept_is_that_of_the_element() {
        let mesh = random_rectangle(1.0, 1.0, 4, 7).unwrap();
        let law = Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap();
        let problem = Problem::<2>::builder(mesh).material(law).build().unwrap();
        let mut random = Random::new(3);
        let ids: Vec<ElementId> = (0..8).map(ElementId::new).collect();
        let points = |id: &ElementId| problem.mesh().corners::<2, 3>(*id);
        let mut forms = EnergyForms::new(problem.mesh().kind());
        let lanes = forms.prepare(&problem, ids.iter().map(|id| (*id, points(id))));
        for (id, lane) in ids.iter().zip(lanes) {
            let mut vector = || [(); 2].map(|()| random.between(-1.0, 1.0));
            let loading =
                Loading { traction: [(); 3].map(|()| [vector(), vector()]), volume: [(); 3].map(|()| vector()) };
            let made = forms.of(&problem, *id, &points(id), lane).fluctuation(&loading);
            let kept = ElementForm::new::<2, 3>(&problem, *id).fluctuation(&loading);
            assert!(made.energy() > 0.0);
            assert_eq!(made.coordinates, kept.coordinates, "{id:?}");
        }
    }

    /// The same for tetrahedra, with the memory that is reckoned with.
    #[test]
    fn a_tetrahedron_keeps_its_form() {
        let law = Elastic::solid(70e9, 0.3, 2700.0).unwrap();
        let problem =
            Problem::<3>::builder(Mesh::cuboid([1.0, 0.7, 0.4], [1; 3]).unwrap()).material(law).build().unwrap();
        let (mut random, mut forms) = (Random::new(3), EnergyForms::new(problem.mesh().kind()));
        for id in (0..problem.mesh().element_count()).map(ElementId::new) {
            let points = problem.mesh().corners::<3, 4>(id);
            let [lane, ..] = forms.prepare(&problem, std::iter::once((id, points)));
            let mut vector = || [(); 3].map(|()| random.between(-1.0, 1.0));
            let loading =
                Loading { traction: [(); 4].map(|()| [(); 3].map(|()| vector())), volume: [(); 4].map(|()| vector()) };
            let made = forms.of(&problem, id, &points, lane).fluctuation(&loading);
            let kept = ElementForm::new::<3, 4>(&problem, id).fluctuation(&loading);
            assert!(made.energy() > 0.0);
            assert_eq!(made.coordinates, kept.coordinates, "{id:?}");
        }
        assert!(
            ElementForm::memory::<3>() > 8 * 36 * 37 / 2 && ElementForm::memory::<3>() > ElementForm::memory::<2>()
        );
    }
}
