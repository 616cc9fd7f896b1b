//! Equilibrated tractions F̂ by star problems (§6.2.2).
//!
//! Around a node i, the moments b = ∫F̂φ_i on the facets must satisfy Σ η b = r on each element of
//! its star. Walked along, the system is a chain: the moment that leaves an element is the one that
//! enters it plus r. One constant per component is left where no facet of the chain is known; it is
//! chosen so that the moments are nearest to those of the averaged finite-element traction. That is
//! the pseudo-inverse of the star matrix, in as many operations as the star has facets.

use crate::contact_force::Densities;
use crate::element::Element;
use crate::level::{Level, Side};
use crate::residual::worse;
use percute_core::ids::{ElementId, FacetId, NodeId};
use percute_core::problem::Problem;
use std::collections::BTreeMap;

/// Facet without prescribed moments.
const FREE: u32 = u32::MAX;

/// A relative miss that is rounding for sure.
const EXPLAINED: f64 = 1e-12;

/// What the star problems know of the boundary.
#[derive(Debug)]
pub(crate) struct Equilibration<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    pub(crate) elements: Vec<Element<D, N>>,
    /// For each facet, its place among the loaded facets, then the candidate facets of contact.
    slots: Vec<u32>,
    pub(crate) loaded: Vec<FacetId>,
    /// Where the links of each contact node's star begin in [`Level::flux_before`].
    pub(crate) contact_links: Vec<usize>,
}

/// How far a star is from compatible.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Compatibility {
    /// Largest |Σ η b − r| (N).
    pub(crate) miss: f64,
    /// Largest term (N).
    pub(crate) scale: f64,
}

impl<'p, const D: usize, const N: usize> Equilibration<'p, D, N> {
    pub(crate) fn new(problem: &'p Problem<D, N>) -> Self {
        let mut slots = vec![FREE; problem.mesh().facets().len()];
        let mut loaded: Vec<FacetId> = problem.facet_loads().iter().map(|l| l.facet).collect();
        loaded.sort_unstable();
        loaded.dedup();
        let contact = problem.surface().facets().iter().map(|f| f.facet);
        for (slot, facet) in loaded.iter().copied().chain(contact).enumerate() {
            slots[facet.index()] = slot as u32;
        }
        let mut contact_links = vec![0];
        for contact in problem.surface().nodes() {
            let links = problem.mesh().stars().link_range(contact.node).len();
            contact_links.push(contact_links[contact_links.len() - 1] + links);
        }
        Self { problem, elements: crate::element::elements(problem), slots, loaded, contact_links }
    }

    /// Moments of the tractions on the loaded facets at an instant (N).
    pub(crate) fn load_moments(&self, t: f64) -> Vec<[[f64; D]; D]> {
        let mut sums: BTreeMap<FacetId, [[f64; D]; D]> = self.loaded.iter().map(|&f| (f, [[0.0; D]; D])).collect();
        for load in self.problem.facet_loads() {
            let area = self.problem.facet_area(load.facet);
            let moments = Problem::<D, N>::facet_moments(area, &self.problem.facet_traction_at(load, t));
            if let Some(sum) = sums.get_mut(&load.facet) {
                (0..D).for_each(|i| (0..D).for_each(|c| sum[i][c] += moments[i][c]));
            }
        }
        sums.into_values().collect()
    }

    /// Known moment on a boundary facet at one of its nodes: load, contact force, or nothing.
    #[inline]
    fn known_moment(&self, level: &Level<D>, densities: &Densities<D>, facet: FacetId, node: NodeId) -> [f64; D] {
        let slot = self.slots[facet.index()];
        if slot == FREE {
            return [0.0; D];
        }
        let slot = slot as usize;
        let position = self.problem.mesh().facets()[facet.index()].position(node);
        if slot < self.loaded.len() {
            return level.load_moments[slot][position];
        }
        let contact = slot - self.loaded.len();
        let area = self.problem.surface().facets()[contact].area;
        Problem::<D, N>::facet_moments(area, &densities[contact])[position]
    }

    /// Solves one star. `flux` receives, for each link, the moment that leaves the element before
    /// it (and enters, with the other sign, the one after it).
    pub(crate) fn solve_star(
        &self,
        level: &Level<D>,
        node: NodeId,
        acceleration: &[f64; D],
        densities: &Densities<D>,
        flux: &mut [[f64; D]],
    ) -> Compatibility {
        let mesh = self.problem.mesh();
        let star = mesh.stars().star(node);
        let closed = star.is_closed();
        let last = star.elements.len();
        let mut target_sum = [0.0; D];
        let mut sum = [0.0; D];
        let mut scale: f64 = 0.0;

        let end = |link: Option<FacetId>| link.filter(|_| !closed);
        let known = |link| end(link).map_or([0.0; D], |f| self.known_moment(level, densities, f, node));
        let supported = |link| end(link).map_or([false; D], |f| self.problem.supported(f));
        let (first_known, last_known) = (known(star.links[0]), known(star.links[last]));
        let (first_free, last_free) = (supported(star.links[0]), supported(star.links[last]));

        flux[0] = first_known.map(|b| -b);
        let mut averages = Averages::new(self, level, node, &star, closed);
        for c in 0..D {
            // In a closed chain the first link is the last and counts once.
            if first_free[c] {
                flux[0][c] = 0.0;
                target_sum[c] += averages.before_first()[c];
            }
        }
        for (m, &element) in star.elements.iter().enumerate() {
            let r = self.residual_of(level, element, node, acceleration, &mut scale);
            let target = averages.after(m);
            for c in 0..D {
                flux[m + 1][c] = flux[m][c] + r[c];
                if m + 1 < last || closed || last_free[c] {
                    target_sum[c] += target[c];
                    sum[c] += flux[m + 1][c];
                }
            }
        }
        let mut miss: f64 = 0.0;
        for c in 0..D {
            let (open_start, open_end) = (closed || first_free[c], closed || last_free[c]);
            let shift = match (open_start, open_end) {
                // The mean over all facets without a known moment.
                (true, true) => (target_sum[c] - sum[c]) / (last + usize::from(!closed)) as f64,
                (true, false) => last_known[c] - flux[last][c],
                _ => 0.0,
            };
            if closed {
                miss = worse(miss, (flux[last][c] - flux[0][c]).abs());
            } else if !open_start && !open_end {
                miss = worse(miss, (flux[last][c] - last_known[c]).abs());
            }
            if shift != 0.0 {
                flux.iter_mut().for_each(|f| f[c] += shift);
            }
            scale = scale.max(flux[0][c].abs()).max(last_known[c].abs());
        }
        Compatibility { miss, scale }
    }

    /// The residual of a star, relative to its largest term.
    ///
    /// The terms of ∫σ_h∇φ_i are themselves sums, modulus times displacement gradient, that cancel in a
    /// turning body. They are looked at only where what is left of them does not explain the miss.
    pub(crate) fn star_residual(&self, star: Compatibility, level: &Level<D>, node: NodeId) -> f64 {
        let relative = |scale: f64| if star.miss == 0.0 { 0.0 } else { star.miss / scale };
        let scale = star.scale.max(1e-12 * level.force_scale);
        if relative(scale) <= EXPLAINED {
            return relative(scale);
        }
        let largest = |m: f64, values: &[f64; D]| values.iter().fold(m, |m, x| m.max(x.abs()));
        let terms = |&element: &ElementId| {
            let (data, law) = (&self.elements[element.index()], self.problem.material(element));
            let gradient = data.gradient(&data.gather(&level.displacement)).iter().fold(0.0, largest);
            let modulus = law.density() * law.wave_speed() * law.wave_speed();
            modulus * gradient * data.gradients.iter().fold(0.0, largest)
        };
        let elements = self.problem.mesh().stars().star(node).elements;
        relative(elements.iter().map(terms).fold(scale, f64::max))
    }

    /// r_i^E = ∫σ_h∇φ_i + ρV/(D+1) ã_i − ∫f_dφ_i.
    #[inline]
    fn residual_of(
        &self,
        level: &Level<D>,
        element: ElementId,
        node: NodeId,
        acceleration: &[f64; D],
        scale: &mut f64,
    ) -> [f64; D] {
        let e = element.index();
        let data = &self.elements[e];
        let i = data.nodes.iter().position(|&n| n == node).unwrap_or(0);
        let mut r = data.internal_force(i, &level.stress[e]);
        for c in 0..D {
            let inertia = data.nodal_mass * acceleration[c];
            *scale = scale.max(r[c].abs()).max(inertia.abs());
            r[c] += inertia;
            if let Some(force) = level.body_force.get(e) {
                r[c] -= data.volume / N as f64 * force[c];
            }
        }
        r
    }

    /// The fluxes by which a walk around local node `i` enters and leaves an element.
    #[inline]
    pub(crate) fn flux_around<'l>(
        &self,
        level: &'l Level<D>,
        data: &Element<D, N>,
        i: usize,
        contact: Option<usize>,
        side: Side,
    ) -> (&'l [f64; D], &'l [f64; D]) {
        let link = data.links[i] as usize;
        match contact {
            Some(at) if side == Side::Before => {
                let first = self.problem.mesh().stars().link_range(data.nodes[i]).start;
                let link = self.contact_links[at] + link - first;
                (&level.flux_before[link], &level.flux_before[link + 1])
            }
            _ => (&level.flux[link], &level.flux[link + 1]),
        }
    }
}

/// Moments of the averaged finite-element traction ½(σ_h⁺ + σ_h⁻)·n along the walk around a node; on
/// the boundary of σ_h·n.
struct Averages<'a, 'p, const D: usize, const N: usize> {
    all: &'a Equilibration<'p, D, N>,
    level: &'a Level<D>,
    node: NodeId,
    elements: &'a [ElementId],
    closed: bool,
}

impl<'a, 'p, const D: usize, const N: usize> Averages<'a, 'p, D, N> {
    fn new(
        all: &'a Equilibration<'p, D, N>,
        level: &'a Level<D>,
        node: NodeId,
        star: &percute_core::mesh::Star<'a>,
        closed: bool,
    ) -> Self {
        Self { all, level, node, elements: star.elements, closed }
    }

    /// ∫σφ_i n over the facet by which the walk leaves (1) or enters (0) element `e`, outward:
    /// |e|n/D = −V∇φ_k.
    #[inline]
    fn moment(&self, e: ElementId, exit: usize, stress: &[[f64; D]; D]) -> [f64; D] {
        let data = &self.all.elements[e.index()];
        let i = data.nodes.iter().position(|&n| n == self.node).unwrap_or(0);
        let facet = percute_core::mesh::entry_and_exit::<D>(i)[exit];
        facet.map_or([0.0; D], |k| data.internal_force(k, stress).map(|f| -f))
    }

    /// The moment that enters the first element.
    #[inline]
    fn before_first(&mut self) -> [f64; D] {
        let e = self.elements[0];
        self.moment(e, 0, &self.level.stress[e.index()]).map(|f| -f)
    }

    /// The moment that leaves element `m` of the walk.
    #[inline]
    fn after(&mut self, m: usize) -> [f64; D] {
        let e = self.elements[m];
        let here = &self.level.stress[e.index()];
        let next = match self.elements.get(m + 1) {
            Some(next) => &self.level.stress[next.index()],
            None if self.closed => &self.level.stress[self.elements[0].index()],
            None => here,
        };
        let mut mean = *here;
        for a in 0..D {
            for b in 0..D {
                mean[a][b] = 0.5 * (here[a][b] + next[a][b]);
            }
        }
        self.moment(e, 1, &mean)
    }
}
