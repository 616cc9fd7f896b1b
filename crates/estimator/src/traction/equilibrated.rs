//! Time levels with equilibrated tractions, side by side.

use super::star_solver::{Compatibility, StarSolver};
use super::{EXPLAINED, Equilibration, MassTerm};
use crate::blocks::{BLOCK, StarBlock};
use crate::element::Element;
use crate::lanes::{FieldLanes, Lanes, Value};
use crate::residual::worse;
use crate::simd::dispatch;
use crate::stress::hooke;
use crate::time_level::{ForcesKnown, Side};
use percute_core::ids::{ElementId, FacetId, NodeId};
use rayon::prelude::*;
use std::sync::Arc;

/// At most [`LANES`](crate::lanes::LANES) levels of which all fields are known. Only [`Equilibration`] makes them.
#[derive(Clone, Debug, Default)]
pub(crate) struct EquilibratedLevels<const D: usize> {
    forces: Vec<ForcesKnown<D>>,
    /// Largest nodal force of any element (N).
    force_scale: Lanes,
    /// Projected traction moments on the links of all stars (N).
    moments: Vec<[Lanes; D]>,
    /// Those around contact nodes before t_n, where the contact force jumps there.
    moments_before: Vec<Option<Vec<[f64; D]>>>,
}

/// One of these levels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EquilibratedLevel<'a, const D: usize> {
    forces: &'a ForcesKnown<D>,
    force_scale: f64,
    moments: Moments<'a, D>,
    moments_before: Option<&'a [[f64; D]]>,
}

/// The moments of a level on links of stars (N).
#[derive(Clone, Copy, Debug)]
enum Moments<'a, const D: usize> {
    /// On some links: their numbers, in order, and their moments.
    Some(&'a [u32], &'a [[f64; D]]),
    Lane(&'a [[Lanes; D]], usize),
}

/// A level that is kept for the interval that begins there.
#[derive(Clone, Debug)]
pub(crate) struct KeptLevel<const D: usize> {
    forces: ForcesKnown<D>,
    force_scale: f64,
    links: Arc<[u32]>,
    moments: Vec<[f64; D]>,
}

impl<const D: usize> EquilibratedLevels<D> {
    /// Number of levels.
    pub(crate) fn len(&self) -> usize {
        self.forces.len()
    }

    /// One of them.
    pub(crate) fn level(&self, k: usize) -> EquilibratedLevel<'_, D> {
        EquilibratedLevel {
            forces: &self.forces[k],
            force_scale: self.force_scale.0[k],
            moments: Moments::Lane(&self.moments, k),
            moments_before: self.moments_before[k].as_deref(),
        }
    }

    /// The fields that the stars were solved for.
    pub(crate) fn forces(&self) -> &[ForcesKnown<D>] {
        &self.forces
    }

    /// f_d on an element (N/m³).
    pub(crate) fn body_force(&self, element: ElementId) -> [Lanes; D] {
        let of = |k: usize, c: usize| {
            self.forces.get(k).and_then(|f| f.level.body_force.get(element.index())).map_or(0.0, |f| f[c])
        };
        std::array::from_fn(|c| Lanes::at_levels(|k| of(k, c)))
    }

    /// Largest nodal force of any element (N).
    pub(crate) fn force_scale(&self) -> Lanes {
        self.force_scale
    }

    /// The moments on the links of all stars (N).
    pub(crate) fn moments(&self) -> &[[Lanes; D]] {
        &self.moments
    }

    /// The same, for changes that balance. No instant of these levels may be a jump.
    pub(crate) fn moments_mut(&mut self) -> &mut [[Lanes; D]] {
        &mut self.moments
    }

    /// For tests that spoil them.
    #[cfg(test)]
    pub(crate) fn forces_mut(&mut self) -> &mut [ForcesKnown<D>] {
        &mut self.forces
    }

    /// Takes the last level out, with the moments on some links, in order, and frees the fields of the others.
    pub(crate) fn keep_last(&mut self, links: &Arc<[u32]>) -> Option<KeptLevel<D>> {
        let forces = self.forces.pop()?;
        let lane = self.forces.len();
        self.forces.clear();
        self.moments_before.clear();
        Some(KeptLevel {
            forces,
            force_scale: self.force_scale.0[lane],
            moments: links.iter().map(|&link| self.moments[link as usize].map(|m| m.0[lane])).collect(),
            links: Arc::clone(links),
        })
    }
}

impl<const D: usize> KeptLevel<D> {
    pub(crate) fn level(&self) -> EquilibratedLevel<'_, D> {
        EquilibratedLevel {
            forces: &self.forces,
            force_scale: self.force_scale,
            moments: Moments::Some(&self.links, &self.moments),
            moments_before: None,
        }
    }
}

impl<'a, const D: usize> EquilibratedLevel<'a, D> {
    /// n.
    #[inline]
    pub(crate) fn index(&self) -> usize {
        self.forces.level.index
    }

    /// The fields that the stars were solved for.
    #[inline]
    pub(crate) fn forces(&self) -> &'a ForcesKnown<D> {
        self.forces
    }

    /// Largest nodal force of any element (N).
    #[inline]
    pub(crate) fn force_scale(&self) -> f64 {
        self.force_scale
    }

    #[inline]
    fn moment(&self, link: usize) -> [f64; D] {
        match self.moments {
            Moments::Some(links, moments) => {
                let at = links.partition_point(|&kept| (kept as usize) < link);
                debug_assert_eq!(links[at] as usize, link, "only the links of near elements are kept");
                moments[at]
            }
            Moments::Lane(moments, lane) => moments[link].map(|m| m.0[lane]),
        }
    }
}

/// The fields of the nodes and elements of a block of stars.
#[derive(Clone, Debug, Default)]
struct StarFields<const D: usize> {
    displacement: FieldLanes<D>,
    acceleration: FieldLanes<D>,
    lumping_difference: FieldLanes<D>,
    /// σ_h (Pa).
    stress: Vec<[[Lanes; D]; D]>,
    /// f_d (N/m³), empty if there is none.
    body_force: Vec<[Lanes; D]>,
}

impl<const D: usize, const N: usize> Equilibration<'_, D, N> {
    /// Solves the star problems of at most [`LANES`](crate::lanes::LANES) levels. Returns the largest relative miss of their equations. `levels`
    /// gives its memory.
    pub(crate) fn solve(&self, forces: Vec<ForcesKnown<D>>, levels: &mut EquilibratedLevels<D>) -> f64 {
        levels.force_scale = self.force_scale(&forces);
        let stars = self.problem.mesh().stars();
        levels.moments.resize(stars.link_count(), [Lanes::ZERO; D]);
        let mut blocks = Vec::with_capacity(self.star_blocks.count());
        let mut rest = levels.moments.as_mut_slice();
        for block in 0..self.star_blocks.count() {
            let nodes = self.star_blocks.centres(block);
            let links =
                stars.link_range(NodeId::new(nodes.end - 1)).end - stars.link_range(NodeId::new(nodes.start)).start;
            let (moments, others) = rest.split_at_mut(links);
            blocks.push((block, moments));
            rest = others;
        }
        let force_scale = levels.force_scale;
        let solve = |fields: &mut StarFields<D>, (block, moments): (usize, &mut [[Lanes; D]])| {
            dispatch(
                #[inline(always)]
                || self.solve_block(&forces, &force_scale, block, fields, moments),
            )
        };
        let miss = blocks.into_par_iter().map_init(StarFields::default, solve).reduce(|| 0.0, worse);
        levels.moments_before.clear();
        let mut worst = miss;
        for (forces, force_scale) in forces.iter().zip(force_scale.0) {
            let (moments, miss) = self.stars_before_jump(forces, force_scale).unzip();
            worst = worse(worst, miss.unwrap_or(0.0));
            levels.moments_before.push(moments);
        }
        levels.forces = forces;
        worst
    }

    /// Largest nodal force of any element at each level (N).
    fn force_scale(&self, forces: &[ForcesKnown<D>]) -> Lanes {
        let blocks = (0..self.elements.len().div_ceil(BLOCK)).into_par_iter();
        let largest = |fields: &mut StarFields<D>, block: usize| {
            dispatch(
                #[inline(always)]
                || self.force_scale_of(forces, block, fields),
            )
        };
        blocks.map_init(StarFields::default, largest).reduce(|| Lanes::ZERO, Value::max)
    }

    #[inline(always)]
    fn force_scale_of(&self, forces: &[ForcesKnown<D>], block: usize, fields: &mut StarFields<D>) -> Lanes {
        let (range, block) = (self.blocks.elements(block), self.blocks.block(block));
        fields.displacement.gather(block.nodes, forces.iter().map(|f| Some(&f.level.displacement[..])));
        fields.acceleration.gather(block.nodes, forces.iter().map(|f| Some(&f.acceleration[..])));
        let mut largest = Lanes::ZERO;
        for (e, local) in range.zip(block.local) {
            let (element, law) = (&self.elements[e], self.problem.material(ElementId::new(e)));
            let stress = hooke(law, &element.gradient(&fields.displacement.of(local)));
            largest = largest.max(largest_force(element, &stress, &fields.acceleration.of(local)));
        }
        largest
    }

    /// Solves the stars of a block. Returns the largest residual.
    #[inline(always)]
    fn solve_block(
        &self,
        forces: &[ForcesKnown<D>],
        force_scale: &Lanes,
        block: usize,
        fields: &mut StarFields<D>,
        mut moments: &mut [[Lanes; D]],
    ) -> f64 {
        let (centres, place) = (self.star_blocks.centres(block), self.star_blocks.block(block));
        let mixed = fields.gather(self, forces, &place);
        let mut worst: f64 = 0.0;
        for node in centres.map(NodeId::new) {
            let star = self.problem.mesh().stars().star(node);
            let (own, others) = std::mem::take(&mut moments).split_at_mut(star.links.len());
            moments = others;
            let acceleration = fields.acceleration.values();
            let local = self.star_blocks.around(node);
            let mass_term = if mixed {
                let lumping_difference = fields.lumping_difference.values();
                MassTerm::Mixed { acceleration, lumping_difference, nodes: place.local }
            } else {
                let own = self.position(star.elements[0], node);
                MassTerm::Lumped(acceleration[place.local[local[0] as usize][own] as usize])
            };
            let ends = self.ends(&star, |facet| self.known_moments(forces, facet, node));
            let solver = StarSolver {
                all: self,
                node,
                elements: star.elements,
                local,
                stress: &fields.stress,
                body_force: &fields.body_force,
                mass_term,
                ends: &ends,
            };
            let found = solver.solve(own);
            let scale = found.scale.max(*force_scale * 1e-12);
            let relative = found.miss / scale.max(Lanes::constant(f64::MIN_POSITIVE));
            let largest = relative.0[..forces.len()].iter().copied().fold(0.0, worse);
            if largest <= EXPLAINED {
                worst = worse(worst, largest);
                continue;
            }
            for (lane, forces) in forces.iter().enumerate() {
                let star = Compatibility { miss: found.miss.0[lane], scale: found.scale.0[lane] };
                worst = worse(worst, self.star_residual(star, forces, force_scale.0[lane], node));
            }
        }
        worst
    }

    /// The known moments on a facet at a node, at each level.
    #[inline(always)]
    fn known_moments(&self, forces: &[ForcesKnown<D>], facet: FacetId, node: NodeId) -> [Lanes; D] {
        if !self.is_known(facet) {
            return [Lanes::ZERO; D];
        }
        let mut moments = [Lanes::ZERO; D];
        for (lane, forces) in forces.iter().enumerate() {
            let moment = self.known_moment(&forces.level, &forces.density, facet, node);
            (0..D).for_each(|c| moments[c].0[lane] = moment[c]);
        }
        moments
    }

    /// The stars of contact nodes once more, with the values before a jump, and the largest relative miss of their equations.
    fn stars_before_jump(&self, forces: &ForcesKnown<D>, force_scale: f64) -> Option<(Vec<[f64; D]>, f64)> {
        let before = forces.before.as_ref()?;
        let mut moments = vec![[0.0; D]; self.contact_links.last().copied().unwrap_or(0)];
        let mut worst: f64 = 0.0;
        for (at, contact) in self.problem.surface().nodes().iter().enumerate() {
            let node = contact.node;
            let links = &mut moments[self.contact_links[at]..self.contact_links[at + 1]];
            let star = self.problem.mesh().stars().star(node);
            let stress: Vec<_> = star.elements.iter().map(|&e| self.stress_of(forces, e)).collect();
            let body = &forces.level.body_force;
            let body_force: Vec<_> = star.elements.iter().filter_map(|e| body.get(e.index()).copied()).collect();
            let local: Vec<u32> = (0..star.elements.len() as u32).collect();
            let ends = self.ends(&star, |facet| self.known_moment(&forces.level, &before.density, facet, node));
            let solver = StarSolver {
                all: self,
                node,
                elements: star.elements,
                local: &local,
                stress: &stress,
                body_force: &body_force,
                mass_term: MassTerm::Lumped(before.acceleration[at]),
                ends: &ends,
            };
            worst = worse(worst, self.star_residual(solver.solve(links), forces, force_scale, node));
        }
        Some((moments, worst))
    }

    /// σ_h of one element (Pa).
    pub(crate) fn stress_of(&self, forces: &ForcesKnown<D>, element: ElementId) -> [[f64; D]; D] {
        let data = &self.elements[element.index()];
        hooke(self.problem.material(element), &data.gradient(&data.gather(&forces.level.displacement)))
    }

    /// The moments by which the star of local node `i` enters and leaves an element.
    #[inline]
    pub(crate) fn moments_around(
        &self,
        level: &EquilibratedLevel<'_, D>,
        data: &Element<D, N>,
        i: usize,
        contact: Option<usize>,
        side: Side,
    ) -> [[f64; D]; 2] {
        let link = data.links[i] as usize;
        match (contact, side, level.moments_before) {
            (Some(at), Side::Before, Some(moments)) => {
                let first = self.problem.mesh().stars().link_range(data.nodes[i]).start;
                let link = self.contact_links[at] + link - first;
                [moments[link], moments[link + 1]]
            }
            _ => [level.moment(link), level.moment(link + 1)],
        }
    }
}

impl<const D: usize> StarFields<D> {
    /// Takes the fields of a block. Returns whether there is a lumping difference.
    #[inline(always)]
    fn gather<const N: usize>(
        &mut self,
        all: &Equilibration<'_, D, N>,
        forces: &[ForcesKnown<D>],
        block: &StarBlock<'_, N>,
    ) -> bool {
        self.displacement.gather(block.nodes, forces.iter().map(|f| Some(&f.level.displacement[..])));
        self.acceleration.gather(block.nodes, forces.iter().map(|f| Some(&f.acceleration[..])));
        let mixed = forces.iter().any(|f| f.level.lumping_difference.is_some());
        if mixed {
            self.lumping_difference.gather(block.nodes, forces.iter().map(|f| f.level.lumping_difference.as_deref()));
        }
        self.stress.clear();
        for (id, local) in block.cells() {
            let element = &all.elements[id.index()];
            self.stress.push(hooke(all.problem.material(id), &element.gradient(&self.displacement.of(local))));
        }
        self.body_force.clear();
        if forces.iter().any(|f| !f.level.body_force.is_empty()) {
            let of = |e: usize, c: usize| {
                Lanes::at_levels(|k| forces.get(k).and_then(|f| f.level.body_force.get(e)).map_or(0.0, |f| f[c]))
            };
            let vector = |&e: &u32| std::array::from_fn(|c| of(e as usize, c));
            self.body_force.extend(block.elements.iter().map(vector));
        }
        mixed
    }
}

/// Largest |Vσ∇φ_i| and lumped inertia force of an element (N).
#[inline(always)]
fn largest_force<const D: usize, const N: usize>(
    element: &Element<D, N>,
    stress: &[[Lanes; D]; D],
    acceleration: &[[Lanes; D]; N],
) -> Lanes {
    let mut largest = Lanes::ZERO;
    for i in 0..N {
        let internal = element.internal_force(i, stress);
        for c in 0..D {
            largest = largest.max(internal[c].abs()).max((acceleration[i][c] * element.nodal_mass).abs());
        }
    }
    largest
}
