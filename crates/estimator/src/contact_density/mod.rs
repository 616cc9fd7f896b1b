//! Contact densities F_DA on the candidate faces: the forces that they do on nodes, and their misfit of the contact
//! law.

mod corner_sliding;
mod friction_misfit;
mod hat;
mod non_matching;
mod normal_misfit;

use crate::residual::worse;
pub(crate) use corner_sliding::{CornerSliding, trapezoids};
pub(crate) use friction_misfit::{FaceDensity, face_power};
pub(crate) use hat::NarrowHat;
pub(crate) use non_matching::{NonMatchingDensity, NonMatchingFaces, ResidualStress, SlaveHat};
pub(crate) use normal_misfit::{FacePressures, NormalMisfit, OffContact};
use percute_core::contact::ContactFace;
use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use std::ops::Deref;
use std::sync::{Arc, OnceLock};

/// A density on the candidate faces. Constant once a reconstruction has made it.
///
/// It derefs to the nodal values (Pa) on each face of the linear density with its moments.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Densities<const D: usize> {
    linear: Vec<[[f64; D]; D]>,
    /// The part that is linear on each face, if hats or non-matching interfaces come with it.
    wide: Option<Vec<[[f64; D]; D]>>,
    hats: Vec<NarrowHat<D>>,
    shares: f64,
    /// The parts of non-matching interfaces.
    non_matching: Option<Arc<NonMatching<D>>>,
}

/// The parts of non-matching interfaces.
#[derive(Debug)]
struct NonMatching<const D: usize> {
    densities: Vec<NonMatchingDensity<D>>,
    faces: Arc<[NonMatchingFaces]>,
    /// Elements in which these have stresses beside that of linear tractions, in order: made at first use, for sampled
    /// instants alone.
    residual: OnceLock<Vec<(ElementId, ResidualStress)>>,
}

impl<const D: usize> PartialEq for NonMatching<D> {
    fn eq(&self, other: &Self) -> bool {
        self.densities == other.densities
    }
}

/// The densities of one instant that depend on no other.
#[derive(Clone, Debug)]
pub(crate) struct LevelDensities<const D: usize> {
    /// F_DA.
    pub(crate) acting: Densities<D>,
    /// Those of which the normal work is measured.
    pub(crate) sudden: Densities<D>,
}

impl<const D: usize> Deref for Densities<D> {
    type Target = [[[f64; D]; D]];

    #[inline]
    fn deref(&self) -> &Self::Target {
        &self.linear
    }
}

impl<const D: usize> Densities<D> {
    /// The values on each candidate face, by its position.
    pub(crate) fn new(problem: &Problem<D>, value: impl Fn(usize, &ContactFace<D>) -> [[f64; D]; D]) -> Self {
        Self::with_hats(problem, value, Vec::new())
    }

    /// The values of the part that is linear on each face, and hats.
    pub(crate) fn with_hats(
        problem: &Problem<D>,
        value: impl Fn(usize, &ContactFace<D>) -> [[f64; D]; D],
        mut hats: Vec<NarrowHat<D>>,
    ) -> Self {
        // In the order of the nodes already, but for those at two planes.
        hats.sort_by_key(|hat| hat.star);
        let faces = problem.surface().faces();
        let mut linear: Vec<_> = faces.iter().enumerate().map(|(f, face)| value(f, face)).collect();
        let wide = (!hats.is_empty()).then(|| linear.clone());
        for hat in &hats {
            let [near, far] = hat.equivalent();
            for (end, force) in [(hat.end, near), (1 - hat.end, far)] {
                (0..D).for_each(|c| linear[hat.face][end][c] += force[c] / faces[hat.face].area);
            }
        }
        Self { linear, wide, hats, shares: 0.0, non_matching: None }
    }

    /// The density with those of all non-matching interfaces.
    pub(crate) fn with_non_matching(
        mut self,
        problem: &Problem<D>,
        faces: &Arc<[NonMatchingFaces]>,
        densities: Vec<NonMatchingDensity<D>>,
    ) -> Self {
        if densities.is_empty() {
            return self;
        }
        self.wide.get_or_insert_with(|| self.linear.clone());
        for (k, (faces, density)) in faces.iter().zip(&densities).enumerate() {
            density.apply((problem, &problem.surface().non_matching()[k]), faces, &mut self.linear);
        }
        let non_matching = NonMatching { densities, faces: Arc::clone(faces), residual: OnceLock::new() };
        Self { non_matching: Some(Arc::new(non_matching)), ..self }
    }

    /// The density with the residual of the shares of its hats: at least 0, their sum 1.
    pub(crate) fn with_shares(self, shares: f64) -> Self {
        Self { shares, ..self }
    }

    /// The residual of the shares of its hats.
    pub(crate) fn shares(&self) -> f64 {
        self.shares
    }

    /// No force anywhere.
    pub(crate) fn none(problem: &Problem<D>) -> Self {
        Self::new(problem, |_, _| [[0.0; D]; D])
    }

    /// The part that is linear on each face.
    pub(crate) fn wide(&self) -> &[[[f64; D]; D]] {
        self.wide.as_deref().unwrap_or(&self.linear)
    }

    /// The rest.
    pub(crate) fn hats(&self) -> &[NarrowHat<D>] {
        &self.hats
    }

    /// The parts of non-matching interfaces.
    pub(crate) fn non_matching(&self) -> &[NonMatchingDensity<D>] {
        self.non_matching.as_ref().map_or(&[], |non_matching| &non_matching.densities)
    }

    /// The residuals of non-matching interfaces: of Coulomb's cone, and of opposite forces.
    pub(crate) fn non_matching_residuals(&self, problem: &Problem<D>) -> [f64; 2] {
        let Some(non_matching) = &self.non_matching else { return [0.0; 2] };
        let all = non_matching.densities.iter().zip(&*non_matching.faces).zip(problem.surface().non_matching());
        let one = |((density, faces), surfaces): ((&NonMatchingDensity<D>, &NonMatchingFaces), _)| {
            density.residuals((problem, surfaces), faces, &self.linear)
        };
        all.map(one).fold([0.0; 2], |a, b| [0, 1].map(|k| worse(a[k], b[k])))
    }

    /// The stresses beside that of linear tractions in an element.
    pub(crate) fn residual(&self, problem: &Problem<D>, element: ElementId) -> ResidualStress {
        let Some(non_matching) = &self.non_matching else { return ResidualStress::NONE };
        let residual = non_matching.residual.get_or_init(|| {
            let all = non_matching.densities.iter().zip(&*non_matching.faces).zip(problem.surface().non_matching());
            let mut residual: Vec<_> =
                all.flat_map(|((density, faces), surfaces)| density.residual((problem, surfaces), faces)).collect();
            residual.sort_by_key(|(element, _)| *element);
            residual
        });
        let start = residual.partition_point(|(other, _)| *other < element);
        let own = residual[start..].iter().take_while(|(other, _)| *other == element);
        own.fold(ResidualStress::NONE, |sum, (_, stress)| sum.plus(stress))
    }

    /// The hats of one star.
    pub(crate) fn hats_of(&self, star: usize) -> &[NarrowHat<D>] {
        let start = self.hats.partition_point(|hat| hat.star < star);
        let end = self.hats.partition_point(|hat| hat.star <= star);
        &self.hats[start..end]
    }

    /// For tests that change them.
    #[cfg(test)]
    pub(crate) fn values_mut(&mut self) -> &mut [[[f64; D]; D]] {
        &mut self.linear
    }
}

/// ∫F φ_k over all faces, for each node of the contact surface (N).
pub(crate) fn nodal_forces<const D: usize>(problem: &Problem<D>, densities: &Densities<D>) -> Vec<[f64; D]> {
    let mut forces = vec![[0.0; D]; problem.surface().nodes().len()];
    for (face, density) in problem.surface().faces().iter().zip(densities.iter()) {
        let moments = Problem::<D>::face_moments(face.area, density);
        for (node, moment) in face.nodes.iter().zip(moments) {
            (0..D).for_each(|c| forces[*node][c] += moment[c]);
        }
    }
    forces
}

/// The forces that move the nodes of the contact surface under a density (N): [`nodal_forces`] without the tangential
/// part at guided nodes, whose tangential motion is prescribed; in a solid without the prescribed components, as such a
/// node may be free along the other direction of its plane.
pub(crate) fn driving_forces<const D: usize>(problem: &Problem<D>, densities: &Densities<D>) -> Vec<[f64; D]> {
    let mut forces = nodal_forces(problem, densities);
    for (contact, force) in problem.surface().nodes().iter().zip(&mut forces).filter(|(contact, _)| contact.guided) {
        if D == 3 {
            let held = problem.prescribed().iter().filter(|held| held.node == contact.node);
            held.for_each(|held| force[held.component] = 0.0);
            continue;
        }
        let frame = problem.obstacles()[contact.obstacle].flat_frame();
        *force = frame.normal().map(|n| n * frame.split(force).0);
    }
    forces
}
