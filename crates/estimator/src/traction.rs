//! Equilibrated tractions F̂ by star problems (§6.2.2).
//!
//! Around a node i, the projected traction moments b = ∫F̂φ_i on the faces must satisfy Σ η b = r on each element of
//! its star. In the order of the star the system is a chain: the moment that leaves an element is the one that
//! enters it plus r. One constant per component is left where no face of the chain is known. It is
//! chosen so that the moments are nearest to those of the averaged finite-element traction. That is
//! the pseudo-inverse of the star matrix, in as many operations as the star has faces.

mod equilibrated;
mod mass_term;
mod solve;
mod star_chain;
mod star_graph;
mod star_terms;

use crate::blocks::{ElementBlocks, MeshPart, StarBlocks, parts};
use crate::contact_density::Densities;
use crate::element::Element;
use crate::loaded::LoadedFaces;
use crate::pool::Pool;
use crate::time_level::{ForcesKnown, TimeLevel};
pub(crate) use equilibrated::{EquilibratedLevel, EquilibratedLevels, KeptLevel};
use mass_term::MassTerm;
use percute_core::cell::cell;
use percute_core::ids::{ElementId, FaceId, NodeId};
use percute_core::material::Law;
use percute_core::mesh::{Star, Strips};
use percute_core::observer::StopFlag;
use percute_core::problem::Problem;
use percute_core::simd::lanes::Value;
pub(crate) use solve::BalancedStrains;
use solve::StarFields;
use star_chain::Ends;
use star_terms::Compatibility;

/// Work on the elements of a part of the mesh, of which the tractions are final.
pub(crate) type Then<'t, const D: usize> = &'t mut dyn FnMut(&EquilibratedLevels<D>, &MeshPart);

/// Elements of a strip, at least.
const STRIP: usize = 512;

/// Face without prescribed moments.
const FREE: u32 = u32::MAX;

/// A relative miss that is rounding for sure.
const EXPLAINED: f64 = 1e-12;

/// The fixed data of the star problems.
#[derive(Debug)]
pub(crate) struct Equilibration<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D>,
    pub(crate) elements: Vec<Element<D, N>>,
    pub(crate) blocks: ElementBlocks<N>,
    star_blocks: StarBlocks<N>,
    pub(crate) strips: Strips,
    parts: Vec<MeshPart>,
    star_fields: Pool<StarFields<D>>,
    /// For each face, its place among the loaded faces, then the candidate faces of contact.
    slots: Vec<u32>,
    /// For each local node, the faces by which its star enters and leaves an element.
    pub(crate) crossing: [[Option<usize>; 2]; N],
    /// Number of loaded faces.
    loaded: usize,
    /// Where the links of each contact node's star begin among those of all contact nodes.
    contact_links: Vec<usize>,
    /// Once it is up, no further part is worked on.
    pub(crate) stop: StopFlag,
}

impl<'p, const D: usize, const N: usize> Equilibration<'p, D, N> {
    pub(crate) fn new(problem: &'p Problem<D>) -> Self {
        let mut slots = vec![FREE; problem.mesh().faces().len()];
        let loaded = LoadedFaces::new(problem);
        let contact = problem.surface().faces().iter().map(|f| f.face);
        for (slot, face) in loaded.faces().iter().copied().chain(contact).enumerate() {
            slots[face.index()] = slot as u32;
        }
        let mut contact_links = vec![0];
        for contact in problem.surface().nodes() {
            let links = problem.mesh().stars().link_range(contact.node).len();
            contact_links.push(contact_links[contact_links.len() - 1] + links);
        }
        let (elements, loaded) = (crate::element::elements(problem), loaded.faces().len());
        let crossing = cell::<D, N>().faces_around();
        let (blocks, star_blocks) = (ElementBlocks::new(problem.mesh()), StarBlocks::new(problem.mesh()));
        let strips = Strips::with_fewest(problem.mesh(), STRIP);
        let parts = parts(problem.mesh(), &strips);
        let star_fields = Pool::new();
        Self {
            problem,
            elements,
            blocks,
            star_blocks,
            strips,
            parts,
            star_fields,
            slots,
            crossing,
            loaded,
            contact_links,
            stop: StopFlag::default(),
        }
    }

    /// The parts that go through the work one after the other, until it is stopped.
    pub(crate) fn parts(&self) -> impl Iterator<Item = &MeshPart> {
        self.parts.iter().take_while(|_| !self.stop.is_up())
    }

    /// Known moment on a boundary face at one of its nodes: load, contact force, or nothing.
    #[inline]
    fn known_moment(&self, level: &TimeLevel<D>, densities: &Densities<D>, face: FaceId, node: NodeId) -> [f64; D] {
        let slot = self.slots[face.index()];
        if slot == FREE {
            return [0.0; D];
        }
        let slot = slot as usize;
        let position = self.problem.mesh().face(face).position(node);
        if slot < self.loaded {
            return level.load_moments[slot][position];
        }
        let contact = slot - self.loaded;
        let area = self.problem.surface().faces()[contact].area;
        Problem::<D>::face_moments(area, &densities[contact])[position]
    }

    /// Whether a face has known moments that may differ from zero.
    #[inline(always)]
    fn is_known(&self, face: FaceId) -> bool {
        self.slots[face.index()] != FREE
    }

    /// The known moments of the first and the last link of a star, in the form of a number.
    #[inline(always)]
    fn ends<T: Value>(&self, like: T, star: &Star<'_>, known: impl Fn(FaceId) -> [T; D]) -> Ends<D, T> {
        let closed = star.is_closed();
        let links = [star.links[0], star.links[star.elements.len()]].map(|link| link.filter(|_| !closed));
        let supported = |link: Option<FaceId>| link.map_or([false; D], |f| self.problem.supported(f));
        let mut moments = [[like.zero(); D]; 2];
        for (moment, link) in moments.iter_mut().zip(links) {
            if let Some(link) = link {
                *moment = known(link);
            }
        }
        Ends { closed, moments, supported: links.map(supported) }
    }

    /// The local number of a node in an element.
    #[inline(always)]
    fn position(&self, element: ElementId, node: NodeId) -> usize {
        self.elements[element.index()].nodes.iter().position(|&n| n == node).unwrap_or(0)
    }

    /// The residual of a star, relative to its largest term.
    ///
    /// The terms of ∫σ_h∇φ_i are themselves sums, modulus times displacement gradient, that cancel in a
    /// turning body. They are looked at only where what is left of them does not explain the miss.
    fn star_residual(&self, star: Compatibility<f64>, forces: &ForcesKnown<D>, force_scale: f64, node: NodeId) -> f64 {
        let relative = |scale: f64| if star.miss == 0.0 { 0.0 } else { star.miss / scale };
        let scale = star.scale.max(1e-12 * force_scale);
        if relative(scale) <= EXPLAINED {
            return relative(scale);
        }
        let largest = |m: f64, values: &[f64; D]| values.iter().fold(m, |m, x| m.max(x.abs()));
        let terms = |&element: &ElementId| {
            let (data, law) = (&self.elements[element.index()], self.problem.material(element));
            let gradient = data.gradient(&data.gather(&forces.level.displacement)).iter().fold(0.0, largest);
            let modulus = law.wave_modulus();
            modulus * gradient * data.gradients.iter().fold(0.0, largest)
        };
        let elements = self.problem.mesh().stars().star(node).elements;
        relative(elements.iter().map(terms).fold(scale, f64::max))
    }
}
