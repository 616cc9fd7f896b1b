//! A time level with the stress of the finite elements and equilibrated tractions.

use super::{Equilibration, MassTerm};
use crate::element::{BLOCK, Element};
use crate::residual::worse;
use crate::time_level::{ForcesKnown, Side};
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::Law;
use rayon::prelude::*;

/// σ_h of a level.
#[derive(Clone, Debug)]
pub(crate) struct FemStress<const D: usize> {
    /// σ_h of each element (Pa).
    pub(super) of_element: Vec<[[f64; D]; D]>,
    /// Largest nodal force of any element (N).
    pub(super) force_scale: f64,
}

#[cfg(test)]
impl<const D: usize> FemStress<D> {
    /// For tests that change it.
    pub(crate) fn of_element_mut(&mut self) -> &mut [[[f64; D]; D]] {
        &mut self.of_element
    }
}

/// A level of which all fields are known. Only [`Equilibration`] makes one.
#[derive(Clone, Debug)]
pub(crate) struct Equilibrated<const D: usize> {
    forces: ForcesKnown<D>,
    stress: FemStress<D>,
    /// Projected traction moments on the links of all stars (N).
    moments: Vec<[f64; D]>,
    /// Those around contact nodes before t_n, where the contact force jumps there.
    moments_before: Option<Vec<[f64; D]>>,
}

impl<const D: usize> Equilibrated<D> {
    /// n.
    #[inline]
    pub(crate) fn index(&self) -> usize {
        self.forces.level.index
    }

    /// The fields that the stars were solved for.
    #[inline]
    pub(crate) fn forces(&self) -> &ForcesKnown<D> {
        &self.forces
    }

    /// For tests that spoil them.
    #[cfg(test)]
    pub(crate) fn forces_mut(&mut self) -> &mut ForcesKnown<D> {
        &mut self.forces
    }

    /// σ_h of each element (Pa).
    #[inline]
    pub(crate) fn stress(&self) -> &[[[f64; D]; D]] {
        &self.stress.of_element
    }

    /// Largest nodal force of any element (N).
    #[inline]
    pub(crate) fn force_scale(&self) -> f64 {
        self.stress.force_scale
    }

    /// The moments on the links of all stars (N), for changes that balance. No instant of such a level may be a jump.
    pub(crate) fn moments_mut(&mut self) -> &mut [[f64; D]] {
        &mut self.moments
    }
}

impl<const D: usize, const N: usize> Equilibration<'_, D, N> {
    /// σ_h of every element, and the largest nodal force.
    pub(crate) fn stress(&self, forces: &ForcesKnown<D>) -> FemStress<D> {
        let displacement = &forces.level.displacement;
        let mut stress = vec![[[0.0; D]; D]; self.elements.len()];
        let blocks = stress.par_chunks_mut(BLOCK).zip(self.elements.par_chunks(BLOCK)).enumerate();
        let largest = blocks.map(|(block, (stress, elements))| {
            let mut largest: f64 = 0.0;
            for (k, (stress, element)) in stress.iter_mut().zip(elements).enumerate() {
                let law = self.problem.material(ElementId::new(block * BLOCK + k));
                *stress = law.stress(&element.gradient(&element.gather(displacement)));
                largest = largest.max(largest_force(element, stress, &forces.acceleration));
            }
            largest
        });
        let force_scale = largest.reduce(|| 0.0, f64::max);
        FemStress { of_element: stress, force_scale }
    }

    /// Solves the star problems of a level, and returns the largest relative miss of their equations too.
    pub(crate) fn solve_stars(&self, forces: ForcesKnown<D>, stress: FemStress<D>) -> (Equilibrated<D>, f64) {
        let stars = self.problem.mesh().stars();
        let nodes = self.problem.mesh().node_count();
        let mut moments = vec![[0.0; D]; stars.link_count()];
        let mut blocks = Vec::with_capacity(nodes.div_ceil(BLOCK));
        let mut rest = moments.as_mut_slice();
        for start in (0..nodes).step_by(BLOCK) {
            let end = (start + BLOCK).min(nodes);
            let links = stars.link_range(NodeId::new(end - 1)).end - stars.link_range(NodeId::new(start)).start;
            let (block, others) = rest.split_at_mut(links);
            blocks.push((start..end, block));
            rest = others;
        }
        let solve = |(nodes, mut block): (std::ops::Range<usize>, &mut [[f64; D]])| {
            let mut worst: f64 = 0.0;
            for node in nodes.map(NodeId::new) {
                let (moments, others) = std::mem::take(&mut block).split_at_mut(stars.link_range(node).len());
                block = others;
                let mass_term = MassTerm::new(&forces, node);
                let star = self.solve_star(&forces.level, &stress, node, mass_term, &forces.density, moments);
                worst = worse(worst, self.star_residual(star, &forces.level, &stress, node));
            }
            worst
        };
        let miss = blocks.into_par_iter().map(solve).reduce(|| 0.0, worse);
        let (moments_before, miss_before) = self.stars_before_jump(&forces, &stress).unzip();
        let miss = worse(miss, miss_before.unwrap_or(0.0));
        (Equilibrated { forces, stress, moments, moments_before }, miss)
    }

    /// The stars of contact nodes once more, with the values before a jump.
    fn stars_before_jump(&self, forces: &ForcesKnown<D>, stress: &FemStress<D>) -> Option<(Vec<[f64; D]>, f64)> {
        let before = forces.before.as_ref()?;
        let mut moments = vec![[0.0; D]; self.contact_links.last().copied().unwrap_or(0)];
        let mut worst: f64 = 0.0;
        for (at, contact) in self.problem.surface().nodes().iter().enumerate() {
            let links = &mut moments[self.contact_links[at]..self.contact_links[at + 1]];
            let mass_term = MassTerm::Lumped(&before.acceleration[at]);
            let star = self.solve_star(&forces.level, stress, contact.node, mass_term, &before.density, links);
            worst = worse(worst, self.star_residual(star, &forces.level, stress, contact.node));
        }
        Some((moments, worst))
    }

    /// The moments by which the star of local node `i` enters and leaves an element.
    #[inline]
    pub(crate) fn moments_around<'l>(
        &self,
        level: &'l Equilibrated<D>,
        data: &Element<D, N>,
        i: usize,
        contact: Option<usize>,
        side: Side,
    ) -> (&'l [f64; D], &'l [f64; D]) {
        let link = data.links[i] as usize;
        match (contact, side, &level.moments_before) {
            (Some(at), Side::Before, Some(moments)) => {
                let first = self.problem.mesh().stars().link_range(data.nodes[i]).start;
                let link = self.contact_links[at] + link - first;
                (&moments[link], &moments[link + 1])
            }
            _ => (&level.moments[link], &level.moments[link + 1]),
        }
    }
}

/// Largest |Vσ∇φ_i| and lumped inertia force of an element (N).
fn largest_force<const D: usize, const N: usize>(
    element: &Element<D, N>,
    stress: &[[f64; D]; D],
    acceleration: &[[f64; D]],
) -> f64 {
    let mut largest: f64 = 0.0;
    for i in 0..N {
        let internal = element.internal_force(i, stress);
        let a = &acceleration[element.nodes[i].index()];
        for c in 0..D {
            largest = largest.max(internal[c].abs()).max((element.nodal_mass * a[c]).abs());
        }
    }
    largest
}
