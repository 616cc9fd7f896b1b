//! The star problems of some levels side by side, block by block.

use super::star_chain::ChainStar;
use super::star_graph::{GraphRoom, GraphStar};
use super::star_terms::{Compatibility, StarTerms};
use super::{EXPLAINED, EquilibratedLevel, EquilibratedLevels, Equilibration, MassTerm};
use crate::blocks::{BLOCK, MeshPart, StarBlock};
use crate::components::{subtract, tensor};
use crate::deformation::Deformation;
use crate::element::Element;
use crate::field_lanes::FieldLanes;
use crate::inertia::{add_lumping_stress, arms, lumping_stress};
use crate::plastic::{EigenLevels, take_off};
use crate::residual::worse;
use crate::smoothing::{Smoothed, SmoothedStrains, Smoothing, StrainLevel};
use crate::time_level::{ForcesKnown, Side, TimeLevel};
use percute_core::ids::{ElementId, FaceId, NodeId};
use percute_core::material::{Law, PointLaw, first_stress};
use percute_core::mesh::Star;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{Lanes, Value, load};
use percute_core::simd::{Registers, Task, run_task};
use rayon::prelude::*;
use std::ops::Range;

/// The fields of the nodes and elements of a block of stars.
#[derive(Clone, Debug, Default)]
pub(super) struct StarFields<const D: usize> {
    displacement: FieldLanes<D>,
    acceleration: FieldLanes<D>,
    skew: FieldLanes<D>,
    lumped: FieldLanes<D>,
    /// The stress that is balanced (Pa): σ_h, or σ̄ with the symmetric part of the stress of lumping.
    stress: Vec<[[Lanes; D]; D]>,
    /// f_d (N/m³), empty if there is none.
    body_force: Vec<[Lanes; D]>,
    /// For the stars of solids.
    room: GraphRoom<[Lanes; D], D>,
}

/// The strains of which the stress of some levels is made.
pub(crate) type BalancedStrains<'a> = (&'a SmoothedStrains, &'a Smoothing);

impl<const D: usize, const N: usize> Equilibration<'_, D, N> {
    /// Takes in the strains of some levels, smoothed where they are.
    pub(crate) fn fill_strains(&self, smoothing: &Smoothing, forces: &[ForcesKnown<D>], strains: &mut SmoothedStrains) {
        fn level<const D: usize>(level: &TimeLevel<D>) -> StrainLevel<'_, D> {
            let TimeLevel { displacement, plastic, smoothed, .. } = level;
            StrainLevel { displacement, plastic: plastic.as_ref(), smoothed: *smoothed }
        }
        let levels: Vec<_> = forces.iter().map(|forces| level(&forces.level)).collect();
        strains.fill(self.smoothed(smoothing), &self.blocks, &levels);
    }

    /// The elements with the data of their smoothing.
    fn smoothed<'a>(&'a self, smoothing: &'a Smoothing) -> Smoothed<'a, D, N> {
        Smoothed { problem: self.problem, smoothing, elements: &self.elements }
    }

    /// Solves the star problems of at most [`LANES`](percute_core::simd::lanes::LANES) levels, part by part, and gives
    /// `then` each part when all stars of its elements are solved. Returns the largest relative miss of their
    /// equations. `levels` gives its memory, `strains` those of which stress is made where it is not that of the
    /// displacements.
    pub(crate) fn solve(
        &self,
        forces: Vec<ForcesKnown<D>>,
        levels: &mut EquilibratedLevels<D>,
        strains: Option<BalancedStrains<'_>>,
        mut then: impl FnMut(&EquilibratedLevels<D>, &MeshPart),
    ) -> f64 {
        levels.force_scale = self.force_scale(&forces);
        levels.moments.resize(self.problem.mesh().stars().link_count(), [Lanes::ZERO; D]);
        levels.moments_before.clear();
        let mut worst = 0.0;
        for (forces, force_scale) in forces.iter().zip(levels.force_scale.0) {
            let (moments, miss) = self.stars_before_jump(forces, force_scale).unzip();
            worst = worse(worst, miss.unwrap_or(0.0));
            levels.moments_before.push(moments);
        }
        levels.forces = forces;
        for part in self.parts() {
            worst = worse(worst, self.solve_part(part, levels, strains));
            then(levels, part);
        }
        worst
    }

    /// Solves the stars of a part.
    fn solve_part(
        &self,
        part: &MeshPart,
        levels: &mut EquilibratedLevels<D>,
        strains: Option<BalancedStrains<'_>>,
    ) -> f64 {
        let EquilibratedLevels { forces, force_scale, moments, .. } = levels;
        let mut blocks = Vec::with_capacity(part.stars.len());
        let mut rest = &mut moments[self.links(&self.nodes(part))];
        for block in part.stars.clone() {
            let (own, others) = rest.split_at_mut(self.links(&self.star_blocks.centres(block)).len());
            blocks.push((block, own));
            rest = others;
        }
        let solve = |(block, moments): (usize, &mut [[Lanes; D]])| {
            let task = |fields: &mut StarFields<D>| {
                run_task(SolveBlock { all: self, forces, strains, force_scale, block, fields, moments })
            };
            self.star_fields.lend(StarFields::default, task)
        };
        blocks.into_par_iter().map(solve).reduce(|| 0.0, worse)
    }

    /// The nodes of the stars of a part.
    fn nodes(&self, part: &MeshPart) -> Range<usize> {
        let centres = |block: usize| self.star_blocks.centres(block);
        let Range { start, end } = part.stars;
        if start < end { centres(start).start..centres(end - 1).end } else { 0..0 }
    }

    /// The links of the stars of some nodes.
    fn links(&self, nodes: &Range<usize>) -> Range<usize> {
        if nodes.is_empty() {
            return 0..0;
        }
        let stars = self.problem.mesh().stars();
        stars.link_range(NodeId::new(nodes.start)).start..stars.link_range(NodeId::new(nodes.end - 1)).end
    }

    /// The nodes of the stars of a part and the moments on their links, for changes that balance. No instant of these
    /// levels may be a jump.
    pub(crate) fn moments_mut<'l>(
        &self,
        part: &MeshPart,
        levels: &'l mut EquilibratedLevels<D>,
    ) -> (Range<usize>, &'l mut [[Lanes; D]]) {
        let nodes = self.nodes(part);
        let moments = &mut levels.moments[self.links(&nodes)];
        (nodes, moments)
    }

    /// Largest nodal force of any element at each level (N).
    fn force_scale(&self, forces: &[ForcesKnown<D>]) -> Lanes {
        let blocks = (0..self.elements.len().div_ceil(BLOCK)).into_par_iter();
        let largest = |block: usize| {
            let task = |fields: &mut StarFields<D>| run_task(LargestForce { all: self, forces, block, fields });
            self.star_fields.lend(StarFields::default, task)
        };
        blocks.map(largest).reduce(|| Lanes::ZERO, Value::max)
    }

    #[inline(always)]
    fn force_scale_of<R: Registers>(
        &self,
        like: Wide<R>,
        forces: &[ForcesKnown<D>],
        block: usize,
        fields: &mut StarFields<D>,
    ) -> Wide<R> {
        let (range, block) = (self.blocks.elements(block), self.blocks.block(block));
        fields.displacement.gather(like, block.nodes, forces.iter().map(|f| Some(&f.level.displacement[..])));
        fields.acceleration.gather(like, block.nodes, forces.iter().map(|f| Some(&f.acceleration[..])));
        let eigen = eigenstrains(forces);
        let mut largest = like.zero();
        for (e, local) in range.zip(block.local) {
            let (element, law) = (&self.elements[e], self.problem.material(ElementId::new(e)));
            let mut gradient = element.gradient(&fields.displacement.of(like, local));
            take_off(eigen.as_ref(), &mut gradient, e);
            let (stress, _) = law.respond(&gradient, &mut []);
            largest = largest.max(largest_force(element, &stress, &fields.acceleration.of(like, local)));
        }
        largest
    }

    /// Solves the stars of a block. Returns the largest residual.
    #[inline(always)]
    fn solve_block<R: Registers>(
        &self,
        like: Wide<R>,
        (forces, strains): (&[ForcesKnown<D>], Option<BalancedStrains<'_>>),
        force_scale: &Lanes,
        block: usize,
        fields: &mut StarFields<D>,
        mut moments: &mut [[Lanes; D]],
    ) -> f64 {
        let (centres, place) = (self.star_blocks.centres(block), self.star_blocks.block(block));
        let split = fields.gather(like, self, (forces, strains), &place);
        let StarFields { acceleration, skew, stress, body_force, room, .. } = fields;
        let floor = like.load(force_scale) * 1e-12;
        let mut worst: f64 = 0.0;
        for node in centres.map(NodeId::new) {
            let star = self.problem.mesh().stars().star(node);
            let (own, others) = std::mem::take(&mut moments).split_at_mut(star.links.len());
            moments = others;
            let acceleration = acceleration.values();
            let local = self.star_blocks.around(node);
            let mass_term = if split {
                let skew = skew.values();
                MassTerm::Split { acceleration, skew, nodes: place.local }
            } else {
                let own = self.position(star.elements[0], node);
                MassTerm::Lumped(load(like, &acceleration[place.local[local[0] as usize][own] as usize]))
            };
            let terms =
                StarTerms { all: self, node, elements: star.elements, local, stress, body_force, mass_term, like };
            let found = self.solve_star(terms, star, own, forces, room);
            let scale = found.scale.max(floor);
            let relative = found.miss / scale.max(like.fill(f64::MIN_POSITIVE));
            let largest = relative.store().0[..forces.len()].iter().copied().fold(0.0, worse);
            if largest <= EXPLAINED {
                worst = worse(worst, largest);
                continue;
            }
            let (miss, scale) = (found.miss.store(), found.scale.store());
            for (lane, forces) in forces.iter().enumerate() {
                let star = Compatibility { miss: miss.0[lane], scale: scale.0[lane] };
                worst = worse(worst, self.star_residual(star, forces, force_scale.0[lane], node));
            }
        }
        worst
    }

    /// Solves one star for the moments on its links.
    #[inline(always)]
    fn solve_star<R: Registers>(
        &self,
        terms: StarTerms<'_, '_, D, N, Wide<R>>,
        star: Star<'_>,
        moments: &mut [[Lanes; D]],
        forces: &[ForcesKnown<D>],
        room: &mut GraphRoom<[Lanes; D], D>,
    ) -> Compatibility<Wide<R>> {
        let (like, node) = (terms.like, terms.node);
        if D == 3 {
            let known = |face| load(like, &self.known_moments(forces, face, node));
            return GraphStar { terms, links: star.links }.solve(moments, known, room);
        }
        let ends = self.ends(
            like,
            &star,
            #[inline(always)]
            |face| load(like, &self.known_moments(forces, face, node)),
        );
        ChainStar { terms, ends: &ends }.solve(moments)
    }

    /// The known moments on a face at a node, at each level.
    #[inline(always)]
    fn known_moments(&self, forces: &[ForcesKnown<D>], face: FaceId, node: NodeId) -> [Lanes; D] {
        if !self.is_known(face) {
            return [Lanes::ZERO; D];
        }
        let mut moments = [Lanes::ZERO; D];
        for (lane, forces) in forces.iter().enumerate() {
            let moment = self.known_moment(&forces.level, &forces.density, face, node);
            (0..D).for_each(|c| moments[c].0[lane] = moment[c]);
        }
        moments
    }

    /// The stars of contact nodes once more, with the values before a jump, and the largest relative miss of their
    /// equations.
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
            let terms = StarTerms {
                all: self,
                node,
                elements: star.elements,
                local: &local,
                stress: &stress,
                body_force: &body_force,
                mass_term: MassTerm::Lumped(before.acceleration[at]),
                like: 0.0,
            };
            let known = |face| self.known_moment(&forces.level, &before.density, face, node);
            let found = if D == 3 {
                GraphStar { terms, links: star.links }.solve(links, known, &mut GraphRoom::default())
            } else {
                let ends = self.ends(0.0, &star, known);
                ChainStar { terms, ends: &ends }.solve(links)
            };
            worst = worse(worst, self.star_residual(found, forces, force_scale, node));
        }
        Some((moments, worst))
    }

    /// σ_h of one element (Pa).
    pub(crate) fn stress_of(&self, forces: &ForcesKnown<D>, element: ElementId) -> [[f64; D]; D] {
        let data = &self.elements[element.index()];
        let mut gradient = data.gradient(&data.gather(&forces.level.displacement));
        if let Some(strains) = &forces.level.plastic {
            subtract(&mut gradient, &tensor(strains[element.index()]));
        }
        self.problem.material(element).respond(&gradient, &mut []).0
    }

    /// The moments on the links of local node `i` of an element.
    #[inline]
    pub(crate) fn moments_around(
        &self,
        level: &EquilibratedLevel<'_, D>,
        data: &Element<D, N>,
        i: usize,
        contact: Option<usize>,
        side: Side,
    ) -> [[f64; D]; D] {
        data.links[i].map(|link| match (contact, side, level.moments_before) {
            (Some(at), Side::Before, Some(moments)) => {
                let first = self.problem.mesh().stars().link_range(data.nodes[i]).start;
                moments[self.contact_links[at] + link.place() - first]
            }
            _ => level.moment(link.place()),
        })
    }
}

/// A block of stars to be solved.
struct SolveBlock<'b, 'p, const D: usize, const N: usize> {
    all: &'b Equilibration<'p, D, N>,
    forces: &'b [ForcesKnown<D>],
    strains: Option<BalancedStrains<'b>>,
    force_scale: &'b Lanes,
    block: usize,
    fields: &'b mut StarFields<D>,
    moments: &'b mut [[Lanes; D]],
}

impl<const D: usize, const N: usize> Task for SolveBlock<'_, '_, D, N> {
    type Output = f64;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> f64 {
        let Self { all, forces, strains, force_scale, block, fields, moments } = self;
        all.solve_block(Wide::zeros(registers), (forces, strains), force_scale, block, fields, moments)
    }
}

/// A block of elements whose largest force is wanted.
struct LargestForce<'b, 'p, const D: usize, const N: usize> {
    all: &'b Equilibration<'p, D, N>,
    forces: &'b [ForcesKnown<D>],
    block: usize,
    fields: &'b mut StarFields<D>,
}

impl<const D: usize, const N: usize> Task for LargestForce<'_, '_, D, N> {
    type Output = Lanes;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> Lanes {
        self.all.force_scale_of(Wide::zeros(registers), self.forces, self.block, self.fields).store()
    }
}

impl<const D: usize> StarFields<D> {
    /// Takes the fields of a block. Returns whether the mass term is split.
    #[inline(always)]
    fn gather<R: Registers, const N: usize>(
        &mut self,
        like: Wide<R>,
        all: &Equilibration<'_, D, N>,
        (forces, strains): (&[ForcesKnown<D>], Option<BalancedStrains<'_>>),
        block: &StarBlock<'_, N>,
    ) -> bool {
        let (finite, eigen) = (all.problem.is_finite(), eigenstrains(forces));
        if strains.is_none() || finite {
            self.displacement.gather(like, block.nodes, forces.iter().map(|f| Some(&f.level.displacement[..])));
        }
        self.acceleration.gather(like, block.nodes, forces.iter().map(|f| Some(&f.acceleration[..])));
        let split = forces.iter().any(|f| f.level.split.is_some());
        if split {
            self.skew.gather(like, block.nodes, forces.iter().map(|f| f.level.skew()));
            let lumped = forces.iter().map(|f| f.level.split.as_ref().map(|split| &split.lumped[..]));
            self.lumped.gather(like, block.nodes, lumped);
        }
        self.stress.clear();
        for (id, local) in block.cells() {
            let (element, law) = (&all.elements[id.index()], all.problem.material(id));
            let mean = |(strains, smoothing): BalancedStrains<'_>| strains.of(like, all.smoothed(smoothing), id);
            let (gradient, mut stress) = match strains.map(mean) {
                Some(strain) if !finite => (strain, law.respond(&strain, &mut []).0),
                mean => {
                    let mut gradient = element.gradient(&self.displacement.of(like, local));
                    take_off(eigen.as_ref(), &mut gradient, id.index());
                    let plain = || law.respond(&gradient, &mut []).0;
                    (gradient, mean.map_or_else(plain, |second| first_stress(&gradient, &second)))
                }
            };
            if split {
                let arms = arms(&all.problem.mesh().corners::<D, N>(id));
                let lumped = self.lumped.of(like, local);
                if law.is_finite() {
                    let lumping = lumping_stress(law.density(), &arms, &lumped);
                    let symmetric = Deformation::new(&gradient).symmetric_part(&lumping, &gradient);
                    (0..D).for_each(|a| (0..D).for_each(|b| stress[a][b] += symmetric[a][b]));
                } else {
                    add_lumping_stress(law.density(), &arms, &lumped, &mut stress);
                }
            }
            let mut stored = [[Lanes::ZERO; D]; D];
            for (to, from) in stored.as_flattened_mut().iter_mut().zip(stress.as_flattened()) {
                *to = from.store();
            }
            self.stress.push(stored);
        }
        self.body_force.clear();
        if forces.iter().any(|f| !f.level.body_force.is_empty()) {
            let of = |e: usize, c: usize| {
                Lanes::at_levels(|k| forces.get(k).and_then(|f| f.level.body_force.get(e)).map_or(0.0, |f| f[c]))
            };
            let vector = |&e: &u32| std::array::from_fn(|c| of(e as usize, c));
            self.body_force.extend(block.elements.iter().map(vector));
        }
        split
    }
}

/// ε* at each level; none where no material yields.
fn eigenstrains<const D: usize>(forces: &[ForcesKnown<D>]) -> Option<EigenLevels<'_>> {
    EigenLevels::new(forces.iter().map(|forces| forces.level.plastic.as_ref()))
}

/// Largest |Vσ∇φ_i| and lumped inertia force of an element (N).
#[inline(always)]
fn largest_force<T: Value, const D: usize, const N: usize>(
    element: &Element<D, N>,
    stress: &[[T; D]; D],
    acceleration: &[[T; D]; N],
) -> T {
    let mut largest = stress[0][0].zero();
    for i in 0..N {
        let internal = element.internal_force(i, stress);
        for c in 0..D {
            largest = largest.max(internal[c].abs()).max((acceleration[i][c] * element.nodal_mass).abs());
        }
    }
    largest
}
