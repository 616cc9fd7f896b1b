//! The corrected acceleration on some of the elements: that which the pass makes, as a sum of parts.
//!
//! Of the modules that foresee the motion of contact nodes, this one alone knows the operator of the pass.

use super::lanes::{FirstPair, Gradient, Nodal};
use super::pairs::{Laws, PairSurroundings, TrianglePair};
use super::sweeps::{add_lumping, subtract_both, subtract_plain_part, subtract_smoothed_part, subtract_stiffness};
use super::weights::{LevelWeights, Weights};
use crate::smoothing::Smoothing;
use percute_core::ids::NodeId;
use percute_core::problem::Problem;
use percute_core::simd::{Registers, Task, run_task};
use std::array::from_fn;
use std::collections::BTreeMap;

/// The corrected acceleration of a node comes from ã in so many rings of elements around it: one for each lumping
/// difference.
pub(super) const RINGS: usize = 3;

/// ã comes from displacements in so many more: those of smoothed strains.
const STRAIN_RINGS: usize = 2;

/// The parts of the acceleration: ã, the correction of the mass, −M⁻¹Kã.
pub(super) const PARTS: usize = 3;

/// The parts of an acceleration (m/s²).
pub(super) type AccelerationParts<const D: usize> = [[f64; D]; PARTS];

/// Factors of the parts, as the pass has them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factors([f64; PARTS]);

impl Factors {
    /// Those from t_n on, of the auxiliary solution.
    pub(super) fn new(level: &LevelWeights<'_>) -> Self {
        Self([1.0, if level.smooths { 1.0 } else { 0.0 }, level.time[0].0[0]])
    }

    /// The sum of the parts.
    pub(super) fn sum<const D: usize>(&self, parts: &AccelerationParts<D>) -> [f64; D] {
        from_fn(|c| self.0.iter().zip(parts).map(|(factor, part)| factor * part[c]).sum())
    }
}

/// The numbers of the operator.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchOperator<'a> {
    pub(super) laws: &'a Laws,
    pub(super) weights: &'a Weights,
}

/// A pair of elements of a mesh, with nodes, patches and places counted in the mesh, and its number there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    pub(super) pair: TrianglePair,
    /// None where strains stay.
    pub(super) around: Option<PairSurroundings>,
    pub(super) number: u32,
}

/// Some elements and their nodes, with fields of their own.
#[derive(Debug)]
pub(super) struct Patch {
    /// Pairs of elements, their nodes numbered as in `nodes`.
    pub(super) pairs: Vec<TrianglePair>,
    /// Their nodes in the mesh, or in the patch of which this is a part, ascending.
    pub(super) nodes: Vec<u32>,
    inverse_mass: Vec<f64>,
    /// The body of each node.
    bodies: Vec<u32>,
    /// Prescribed components: node and component, ascending.
    prescribed: Vec<(u32, usize)>,
    pub(super) displacement: Vec<Nodal>,
    /// Forces, later ã.
    pub(super) rate: Vec<Nodal>,
    internal: Vec<Nodal>,
    /// The lumping difference once, twice and three times.
    lumping: [Vec<FirstPair>; 3],
    strains: Strains,
}

/// The smoothed strains of a patch; empty where strains stay. At its border they lack the elements beyond.
#[derive(Debug, Default)]
struct Strains {
    around: Vec<PairSurroundings>,
    gradients: Vec<Gradient>,
    patches: Vec<Gradient>,
    /// β/(3V) of each patch (1/m³).
    weights: Vec<f64>,
}

impl Strains {
    /// Those of some pairs, in their order.
    fn new(near: &[Near], smoothing: &Smoothing) -> Self {
        let mut around: Vec<PairSurroundings> = near.iter().filter_map(|near| near.around).collect();
        let places: BTreeMap<u32, u32> = near.iter().zip(0..).map(|(near, own)| (near.number, own)).collect();
        let mut patches: Vec<u32> = around.iter().flat_map(|around| around.patches).collect();
        patches.sort_unstable();
        patches.dedup();
        for (around, own) in around.iter_mut().zip(0..) {
            around.patches = around.patches.map(|patch| patches.partition_point(|known| *known < patch) as u32);
            for (which, beyond) in around.beyond.iter_mut().enumerate() {
                let within = |place: u32| places.get(&(place / 2)).map(|k| 2 * k + place % 2);
                *beyond = beyond.map(|place| within(place).unwrap_or(2 * own + which as u32));
            }
        }
        Self {
            gradients: vec![Gradient::ZERO; 2 * around.len()],
            patches: vec![Gradient::ZERO; patches.len()],
            weights: patches.into_iter().map(|patch| smoothing.weights()[patch as usize]).collect(),
            around,
        }
    }
}

impl Patch {
    /// The elements around these nodes of a mesh.
    pub(super) fn new<const D: usize>(
        problem: &Problem<D>,
        smoothing: &Smoothing,
        nodes: impl Iterator<Item = usize>,
        pairs: impl Iterator<Item = Near> + Clone,
    ) -> Self {
        let mut within = vec![false; problem.mesh().node_count()];
        nodes.for_each(|node| within[node] = true);
        let mut around: Vec<Near> = Vec::new();
        for _ in 0..RINGS + if smoothing.smooths() { STRAIN_RINGS } else { 0 } {
            around.clear();
            around.extend(pairs.clone().filter(|near| near.pair.nodes.iter().any(|n| within[*n as usize])));
            around.iter().flat_map(|near| near.pair.nodes).for_each(|n| within[n as usize] = true);
        }
        let mut prescribed: Vec<_> =
            problem.prescribed().iter().map(|p| (p.node.index() as u32, p.component)).collect();
        prescribed.sort_unstable();
        let inertia =
            |node: u32| (1.0 / problem.mass()[node as usize], smoothing.body(NodeId::new(node as usize)) as u32);
        let strains = Strains::new(&around, smoothing);
        Self { strains, ..Self::of(around.into_iter().map(|near| near.pair).collect(), &prescribed, inertia) }
    }

    /// From pairs and prescribed components with nodes of any numbers, and the inverse mass and body of each; without
    /// strains.
    fn of(mut pairs: Vec<TrianglePair>, prescribed: &[(u32, usize)], inertia: impl Fn(u32) -> (f64, u32)) -> Self {
        let mut nodes: Vec<u32> = pairs.iter().flat_map(|pair| pair.nodes).collect();
        nodes.sort_unstable();
        nodes.dedup();
        for pair in &mut pairs {
            pair.nodes = pair.nodes.map(|n| nodes.partition_point(|known| *known < n) as u32);
        }
        let held = nodes.iter().zip(0..).flat_map(|(&node, own)| {
            let first = prescribed.partition_point(|(held, _)| *held < node);
            prescribed[first..].iter().take_while(move |(held, _)| *held == node).map(move |&(_, c)| (own, c))
        });
        let (fields, pair_fields) = (vec![Nodal::ZERO; nodes.len()], vec![FirstPair::ZERO; nodes.len()]);
        let (inverse_mass, bodies) = nodes.iter().map(|&node| inertia(node)).unzip();
        Self {
            prescribed: held.collect(),
            inverse_mass,
            bodies,
            displacement: fields.clone(),
            rate: fields.clone(),
            internal: fields,
            lumping: from_fn(|_| pair_fields.clone()),
            strains: Strains::default(),
            pairs,
            nodes,
        }
    }

    /// The part of a patch with these pairs.
    pub(super) fn part(&self, pairs: impl Iterator<Item = u32>) -> Self {
        let pairs = pairs.map(|pair| self.pairs[pair as usize]).collect();
        Self::of(pairs, &self.prescribed, |node| (self.inverse_mass[node as usize], self.bodies[node as usize]))
    }

    /// Where a node is in the fields.
    pub(super) fn place(&self, node: u32) -> usize {
        self.nodes.partition_point(|known| *known < node)
    }

    /// Subtracts the internal forces of `displacement` from `rate` (N), of smoothed strains if they are.
    pub(super) fn subtract_forces(&mut self, laws: &Laws, smooths: bool) {
        let Self { pairs, displacement, rate, strains, .. } = self;
        let strains = Some(strains).filter(|strains| smooths && !strains.around.is_empty());
        run_task(Forces { laws, pairs, displacement, forces: rate, strains });
    }

    /// ã of the forces in `rate`, and its corrections.
    pub(super) fn accelerate(&mut self, laws: &Laws) {
        for (rate, inverse) in self.rate.iter_mut().zip(&self.inverse_mass) {
            rate.0.iter_mut().for_each(|x| *x *= inverse);
        }
        self.internal.fill(Nodal::ZERO);
        self.lumping.iter_mut().for_each(|field| field.fill(FirstPair::ZERO));
        let [once, ..] = &mut self.lumping;
        run_task(Once { laws, pairs: &self.pairs, rate: &self.rate, internal: &mut self.internal, once });
        for &(node, c) in &self.prescribed {
            self.internal[node as usize].set(c, 0.0);
        }
        self.finish_lumping(0);
        for which in 1..3 {
            let (before, after) = self.lumping.split_at_mut(which);
            run_task(Again { pairs: &self.pairs, before: &before[which - 1], after: &mut after[0] });
            self.finish_lumping(which);
        }
    }

    /// The last product with M⁻¹ of one of the lumping differences.
    fn finish_lumping(&mut self, which: usize) {
        for (field, inverse) in self.lumping[which].iter_mut().zip(&self.inverse_mass) {
            field.0.iter_mut().for_each(|x| *x *= inverse);
        }
        for &(node, c) in &self.prescribed {
            self.lumping[which][node as usize].set(c, 0.0);
        }
    }

    /// The parts of the acceleration at a place.
    pub(super) fn acceleration<const D: usize>(&self, weights: &Weights, place: usize) -> AccelerationParts<D> {
        let internal: [f64; D] = self.internal[place].of(0);
        let mut mass = [0.0; D];
        for (field, factor) in self.lumping.iter().zip(weights.auxiliary(self.bodies[place] as usize)) {
            let difference: [f64; D] = field[place].auxiliary();
            (0..D).for_each(|c| mass[c] += factor * difference[c]);
        }
        [self.rate[place].of(0), mass, internal.map(|force| self.inverse_mass[place] * force)]
    }

    /// The accelerations of all nodes under unit forces at a place, by component of the force. The operator is
    /// symmetric: they are also those at the place under unit forces at the nodes, by component of the acceleration.
    pub(super) fn under_unit_forces<const D: usize>(
        &mut self,
        place: usize,
        operator: PatchOperator<'_>,
    ) -> Vec<[AccelerationParts<D>; D]> {
        let mut moved = vec![[[[0.0; D]; PARTS]; D]; self.nodes.len()];
        for here in 0..D {
            if self.prescribed.contains(&(place as u32, here)) {
                continue;
            }
            self.rate.fill(Nodal::ZERO);
            self.rate[place].set(here, 1.0);
            self.accelerate(operator.laws);
            for (node, moved) in moved.iter_mut().enumerate() {
                moved[here] = self.acceleration(operator.weights, node);
            }
        }
        moved
    }
}

/// Internal forces.
struct Forces<'a> {
    laws: &'a Laws,
    pairs: &'a [TrianglePair],
    displacement: &'a [Nodal],
    forces: &'a mut [Nodal],
    strains: Option<&'a mut Strains>,
}

impl Task for Forces<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        let Self { laws, pairs, displacement, forces, strains } = self;
        let Some(Strains { around, gradients, patches, weights }) = strains else {
            return subtract_stiffness(r, &laws.plain, pairs, displacement, forces);
        };
        patches.fill(Gradient::ZERO);
        let kept = (&mut gradients[..], &mut patches[..]);
        subtract_plain_part(r, laws, (pairs, around), displacement, forces, kept);
        for (patch, weight) in patches.iter_mut().zip(weights) {
            patch.0.iter_mut().for_each(|x| *x *= *weight);
        }
        let (gradients, patches) = (&gradients[..], &patches[..]);
        subtract_smoothed_part(r, laws, (pairs, around), (gradients, 0), (gradients, patches), forces);
    }
}

/// −Kã and (M − M_c)ã.
struct Once<'a> {
    laws: &'a Laws,
    pairs: &'a [TrianglePair],
    rate: &'a [Nodal],
    internal: &'a mut [Nodal],
    once: &'a mut [FirstPair],
}

impl Task for Once<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        subtract_both(r, &self.laws.plain, self.pairs, self.rate, self.internal, self.once);
    }
}

/// (M − M_c) of a lumping difference.
struct Again<'a> {
    pairs: &'a [TrianglePair],
    before: &'a [FirstPair],
    after: &'a mut [FirstPair],
}

impl Task for Again<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        add_lumping(r, self.pairs, self.before, self.after);
    }
}
