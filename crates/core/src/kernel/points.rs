//! Internal forces of P1 elements with any law: one point of integration in each, four pairs of elements at a time.

use super::pairs::{CHUNK, Pair, PairNodes, in_chunks};
use super::{Kernel, Reach};
use crate::material::{Elastic, Law, MOST_VARIABLES, PointLaw};
use crate::mesh::Strips;
use crate::problem::Problem;
use crate::simd::lanes::{LANES, Lanes, Value, load, store};
use crate::simd::{Eight, Registers, Task, Wide, run_task};
use std::ops::Range;

/// Pairs of a group.
const PAIRS: usize = LANES / 2;
/// Groups of a chunk, at the most.
const GROUPS: usize = CHUNK / PAIRS;

/// Four pairs of elements of one law: element l of pair p has lane 2 p + l. Lanes that are left have no volume.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group<const D: usize> {
    /// Their nodes in the strip.
    nodes: [PairNodes; PAIRS],
    /// ∇φ_i of the nodes i + 1 + l of a pair (1/m).
    slopes: [[Lanes; D]; D],
    /// |E| with section or thickness (m³).
    volume: Lanes,
}

/// A tensor at eight points.
type Tensors<R, const D: usize> = [[Wide<R>; D]; D];

/// Groups of one law that are swept together.
#[derive(Clone, Debug)]
struct PointChunk {
    groups: Range<u32>,
    law: u32,
    reach: Reach,
}

/// A chunk as the sweep needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PointChunkData<'a, M, const D: usize> {
    groups: &'a [Group<D>],
    /// Numbers of the elements in the strip.
    elements: &'a [[u32; LANES]],
    law: &'a M,
}

/// The elements of all strips.
#[derive(Clone, Debug)]
pub(crate) struct PointKernel<M, const D: usize> {
    strips: Strips,
    groups: Vec<Group<D>>,
    /// Their elements, apart from them: only laws with internal variables read these.
    elements: Vec<[u32; LANES]>,
    chunks: Vec<PointChunk>,
    /// Where the chunks of each strip begin.
    of_strip: Vec<usize>,
    laws: Vec<M>,
}

impl<M: PointLaw, const D: usize> PointKernel<M, D> {
    /// That of a problem, with a law for each material.
    pub(crate) fn new(problem: &Problem<D>, law: impl Fn(&Elastic) -> M) -> Self {
        Self::with_laws(problem, Strips::new(problem.mesh()), problem.materials().iter().map(law).collect())
    }

    /// The same with these strips.
    fn with_laws(problem: &Problem<D>, strips: Strips, laws: Vec<M>) -> Self {
        let (groups, elements, chunks) = (Vec::new(), Vec::new(), Vec::new());
        let mut all = Self { strips, groups, elements, chunks, of_strip: vec![0], laws };
        let mut taken = vec![false; problem.mesh().element_count()];
        for strip in 0..all.strips.count() {
            let (nodes, elements) = (all.strips.nodes(strip), all.strips.elements(strip));
            let first_chunk = all.chunks.len();
            let law = |e: usize| problem.element_material()[e].into();
            in_chunks(problem, elements.clone(), &mut taken, law, |pairs, law| {
                all.add(problem, [nodes.start, elements.start], pairs, law);
            });
            Reach::close(all.chunks[first_chunk..].iter_mut().map(|chunk| &mut chunk.reach), nodes.len());
            all.of_strip.push(all.chunks.len());
        }
        all
    }

    /// Adds a chunk of pairs.
    fn add(&mut self, problem: &Problem<D>, starts: [usize; 2], pairs: &[Pair], law: u32) {
        let from = self.groups.len();
        for pairs in pairs.chunks(PAIRS) {
            let (group, elements) = Group::new(problem, starts, pairs);
            self.groups.push(group);
            self.elements.push(elements);
        }
        let nodes = self.groups[from..].iter().flat_map(|group| group.nodes.into_iter().flatten());
        self.chunks.push(PointChunk { reach: Reach::of(nodes), groups: from as u32..self.groups.len() as u32, law });
    }

    /// A stable step (s) at these displacements, Δt = 2/ω_max with the largest ω² of any element alone: some per cent
    /// below the critical one.
    pub(crate) fn stable_step(&self, problem: &Problem<D>, displacement: &[[f64; D]]) -> f64 {
        let densities: Vec<f64> = problem.materials().iter().map(Law::density).collect();
        let largest = (0..self.strips.count()).fold(0.0, |largest, strip| {
            let displacement = &displacement[self.strips.nodes(strip)];
            larger(largest, run_task(StripBound { kernel: self, strip, displacement, densities: &densities }))
        });
        2.0 / largest.sqrt()
    }

    /// Whether the stable step is at least this one (s): much faster than to find it.
    pub(crate) fn is_stable(&self, problem: &Problem<D>, displacement: &[[f64; D]], step: f64) -> bool {
        let largest = 4.0 / (step * step);
        let limits = problem.materials().iter().map(|law| largest * law.density() / (D + 1) as f64);
        let limits: Vec<f64> = limits.collect();
        (0..self.strips.count()).all(|strip| {
            let displacement = &displacement[self.strips.nodes(strip)];
            run_task(StripTest { kernel: self, strip, displacement, limits: &limits })
        })
    }

    #[inline(always)]
    fn chunks_of(&self, strip: usize) -> &[PointChunk] {
        &self.chunks[self.of_strip[strip]..self.of_strip[strip + 1]]
    }

    #[inline(always)]
    fn data(&self, chunk: &PointChunk) -> PointChunkData<'_, M, D> {
        let groups = chunk.groups.start as usize..chunk.groups.end as usize;
        let (elements, law) = (&self.elements[groups.clone()], &self.laws[chunk.law as usize]);
        PointChunkData { groups: &self.groups[groups], elements, law }
    }
}

/// The larger of two numbers; NaN counts as largest.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

impl<const D: usize> Group<D> {
    /// A group, and the numbers of its elements.
    fn new(problem: &Problem<D>, [first_node, first_element]: [usize; 2], pairs: &[Pair]) -> (Self, [u32; LANES]) {
        let (mesh, zero) = (problem.mesh(), [[Lanes::ZERO; D]; D]);
        let nodes = |pair: &Pair| pair.nodes::<D>(mesh).map(|node| (node.index() - first_node) as u32);
        // Lanes that are left move with a node of the group.
        let first = nodes(&pairs[0])[0];
        let mut group = Self { nodes: [[first; 4]; PAIRS], slopes: zero, volume: Lanes::ZERO };
        let mut elements = [0; LANES];
        for (p, pair) in pairs.iter().enumerate() {
            group.nodes[p] = nodes(pair);
            for (l, element, slopes) in pair.elements::<D>(mesh) {
                let lane = 2 * p + l;
                elements[lane] = (element.index() - first_element) as u32;
                group.volume.0[lane] = problem.volume(element);
                for i in 0..D {
                    (0..D).for_each(|b| group.slopes[i][b].0[lane] = slopes[i][b]);
                }
            }
        }
        (group, elements)
    }

    /// The slopes, and H = ∂u_a/∂X_b.
    #[inline(always)]
    fn gradient<R: Registers>(&self, like: Wide<R>, displacement: &[[f64; D]]) -> [Tensors<R, D>; 2] {
        let differences = self.differences(like, displacement);
        let (mut slopes, mut gradient) = ([[like; D]; D], [[like; D]; D]);
        for i in 0..D {
            slopes[i] = load(like, &self.slopes[i]);
            for a in 0..D {
                for b in 0..D {
                    let part = differences[i][a] * slopes[i][b];
                    gradient[a][b] = if i == 0 { part } else { gradient[a][b] + part };
                }
            }
        }
        [slopes, gradient]
    }

    /// u at the node k of each pair of triangles.
    #[inline(always)]
    fn at<R: Registers>(&self, like: Wide<R>, u: &[[f64; D]], k: usize) -> Wide<R> {
        let ([a, b, c, d], u) = (&self.nodes, u.as_flattened().as_chunks().0);
        like.quad([u[a[k] as usize], u[b[k] as usize], u[c[k] as usize], u[d[k] as usize]])
    }

    /// u at the node i + 1 of each element less that at its first, `[i][c]` of component c.
    #[inline(always)]
    fn differences<R: Registers>(&self, like: Wide<R>, u: &[[f64; D]]) -> Tensors<R, D> {
        let mut found = [[like; D]; D];
        if D == 2 {
            let base = self.at(like, u, 0);
            let (first, shared, last) =
                (self.at(like, u, 1) - base, self.at(like, u, 2) - base, self.at(like, u, 3) - base);
            let of_elements = [first.interleave(shared), shared.interleave(last)];
            for i in 0..D {
                (0..D).for_each(|c| found[i][c] = of_elements[i][c]);
            }
        } else {
            let node = |lane: usize, i: usize| self.nodes[lane / 2][i] as usize;
            for i in 0..D {
                for c in 0..D {
                    let difference = |lane| u[node(lane, i + 1 + lane % 2)][c] - u[node(lane, 0)][c];
                    found[i][c] = like.load(&Lanes::at_levels(difference));
                }
            }
        }
        found
    }

    /// The forces on the nodes i + 1 of each element, `[i][a]` of component a, from P times the volume.
    #[inline(always)]
    fn forces<R: Registers>(&self, like: Wide<R>, stress: &[[Lanes; D]; D]) -> Tensors<R, D> {
        let mut forces = [[like; D]; D];
        for a in 0..D {
            for b in 0..D {
                let stress = like.load(&stress[a][b]);
                for i in 0..D {
                    let part = stress * like.load(&self.slopes[i][b]);
                    forces[i][a] = if b == 0 { part } else { forces[i][a] + part };
                }
            }
        }
        forces
    }

    /// Subtracts these forces, and adds them to that on the first node.
    #[inline(always)]
    fn subtract<R: Registers>(&self, lanes: R, forces: &Tensors<R, D>, from: &mut [[f64; D]]) {
        if D == 2 {
            let from = from.as_flattened_mut().as_chunks_mut().0;
            let [first, shared] = forces[0][0].interleave(forces[0][1]);
            let [also_shared, last] = forces[1][0].interleave(forces[1][1]);
            let shared = shared + also_shared;
            let base = first + shared + last;
            let (base, first, shared, last) = (base.vectors(), first.vectors(), shared.vectors(), last.vectors());
            for p in 0..PAIRS {
                let nodes = &self.nodes[p];
                lanes.add_to(&mut from[nodes[0] as usize], base[p]);
                lanes.take_from(&mut from[nodes[1] as usize], first[p]);
                lanes.take_from(&mut from[nodes[2] as usize], shared[p]);
                lanes.take_from(&mut from[nodes[3] as usize], last[p]);
            }
        } else {
            for i in 0..D {
                for c in 0..D {
                    let forces = forces[i][c].store();
                    for lane in 0..LANES {
                        let nodes = &self.nodes[lane / 2];
                        from[nodes[i + 1 + lane % 2] as usize][c] -= forces.0[lane];
                        from[nodes[0] as usize][c] += forces.0[lane];
                    }
                }
            }
        }
    }

    /// The internal variables of its elements.
    #[inline(always)]
    fn variables<M: PointLaw, R: Registers>(
        like: Wide<R>,
        elements: &[u32; LANES],
        internal: &[f64],
    ) -> [Wide<R>; MOST_VARIABLES] {
        let mut found = [like; MOST_VARIABLES];
        for k in 0..M::variables::<D>() {
            let of_element = |lane: usize| internal[M::variables::<D>() * elements[lane] as usize + k];
            found[k] = like.load(&Lanes::at_levels(of_element));
        }
        found
    }

    /// Stores them.
    #[inline(always)]
    fn store<M: PointLaw, R: Registers>(
        &self,
        variables: &[Wide<R>; MOST_VARIABLES],
        elements: &[u32; LANES],
        internal: &mut [f64],
    ) {
        for k in 0..M::variables::<D>() {
            let stored = variables[k].store();
            for lane in (0..LANES).filter(|lane| self.volume.0[*lane] > 0.0) {
                internal[M::variables::<D>() * elements[lane] as usize + k] = stored.0[lane];
            }
        }
    }
}

impl<M: PointLaw, const D: usize> Kernel<D> for PointKernel<M, D> {
    type Chunk<'a>
        = PointChunkData<'a, M, D>
    where
        M: 'a;

    fn strips(&self) -> &Strips {
        &self.strips
    }

    fn variables(&self) -> usize {
        M::variables::<D>()
    }

    #[inline(always)]
    fn chunks(&self, strip: usize) -> impl Iterator<Item = (&Reach, PointChunkData<'_, M, D>)> {
        self.chunks_of(strip).iter().map(
            #[inline(always)]
            |chunk| (&chunk.reach, self.data(chunk)),
        )
    }

    #[inline(always)]
    fn sweep<L: Registers>(
        &self,
        lanes: L,
        chunk: &PointChunkData<'_, M, D>,
        displacement: &[[f64; D]],
        internal: &mut [f64],
        force: &mut [[f64; D]],
        energy: &mut Eight,
    ) {
        let like = Wide::zeros(lanes);
        // One check of an index is enough for both.
        let force = &mut force[..displacement.len()];
        // Each part has a loop of its own: a group alone keeps the processor waiting for quotients and powers.
        let mut tensors = [[[Lanes::ZERO; D]; D]; GROUPS];
        for (group, gradient) in chunk.groups.iter().zip(&mut tensors) {
            let [_, found] = group.gradient(like, displacement);
            (0..D).for_each(|a| gradient[a] = store(&found[a]));
        }
        let mut total = like;
        for ((group, elements), tensor) in chunk.groups.iter().zip(chunk.elements).zip(&mut tensors) {
            let mut gradient = [[like; D]; D];
            (0..D).for_each(|a| gradient[a] = load(like, &tensor[a]));
            let mut variables = Group::<D>::variables::<M, L>(like, elements, internal);
            let (stress, density) = chunk.law.respond(&gradient, &mut variables[..M::variables::<D>()]);
            group.store::<M, L>(&variables, elements, internal);
            let volume = like.load(&group.volume);
            total += density * volume;
            for a in 0..D {
                (0..D).for_each(|b| tensor[a][b] = (stress[a][b] * volume).store());
            }
        }
        for (group, stress) in chunk.groups.iter().zip(&tensors) {
            group.subtract(lanes, &group.forces(like, stress), force);
        }
        *energy = (like.load(&Lanes(*energy)) + total * 2.0).store().0;
    }
}

/// The largest ω² of the elements of a strip.
struct StripBound<'a, M, const D: usize> {
    kernel: &'a PointKernel<M, D>,
    strip: usize,
    displacement: &'a [[f64; D]],
    densities: &'a [f64],
}

impl<M: PointLaw, const D: usize> Task for StripBound<'_, M, D> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Registers>(self, lanes: L) -> f64 {
        let like = Wide::zeros(lanes);
        let mut largest = like;
        for chunk in self.kernel.chunks_of(self.strip) {
            let law = chunk.law as usize;
            for group in self.kernel.data(chunk).groups {
                let [slopes, gradient] = group.gradient(like, self.displacement);
                let bound = self.kernel.laws[law].stiffness_bound(&gradient, &root(square(&slopes)));
                largest = largest.worse(bound * ((D + 1) as f64 / self.densities[law]));
            }
        }
        largest.store().0.into_iter().fold(0.0, larger)
    }
}

/// Whether no ω² of the elements of a strip is above that of the limits (Pa/m²).
struct StripTest<'a, M, const D: usize> {
    kernel: &'a PointKernel<M, D>,
    strip: usize,
    displacement: &'a [[f64; D]],
    limits: &'a [f64],
}

impl<M: PointLaw, const D: usize> Task for StripTest<'_, M, D> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Registers>(self, lanes: L) -> bool {
        let like = Wide::zeros(lanes);
        for chunk in self.kernel.chunks_of(self.strip) {
            let limit = self.limits[chunk.law as usize];
            let PointChunkData { groups, law, .. } = self.kernel.data(chunk);
            for group in groups {
                let [slopes, gradient] = group.gradient(like, self.displacement);
                let excess = law.stiffness_excess(&gradient, &square(&slopes), limit);
                if excess.any(|excess| excess > 0.0 || excess.is_nan()) {
                    return false;
                }
            }
        }
        true
    }
}

/// Σ ∇φ_i⊗∇φ_i over all nodes.
#[inline(always)]
fn square<V: Value, const D: usize>(slopes: &[[V; D]; D]) -> [[V; D]; D] {
    let mut square = [[slopes[0][0].zero(); D]; D];
    for a in 0..D {
        for b in 0..D {
            let (mut first, mut second) = (square[a][b], square[a][b]);
            for i in 0..D {
                square[a][b] += slopes[i][a] * slopes[i][b];
                first += slopes[i][a];
                second += slopes[i][b];
            }
            square[a][b] += first * second;
        }
    }
    square
}

/// The root of a symmetric tensor Q that is not negative.
#[inline(always)]
fn root<V: Value, const D: usize>(mut square: [[V; D]; D]) -> [[V; D]; D] {
    if D == 1 {
        square[0][0] = square[0][0].sqrt();
        return square;
    }
    // √Q = (Q + √det Q 1)/√(tr Q + 2 √det Q); lanes that are left have no slopes.
    let determinant = (square[0][0] * square[1][1] - square[0][1] * square[1][0]).sqrt();
    let trace = square[0][0] + square[1][1] + determinant * 2.0;
    let scale = trace.fill(1.0) / trace.sqrt().max(trace.fill(f64::MIN_POSITIVE));
    for a in 0..D {
        square[a][a] += determinant;
        (0..D).for_each(|b| square[a][b] = square[a][b] * scale);
    }
    square
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::ElementId;
    use crate::kernel::LinearKernel;
    use crate::material::{Hardening, HyperelasticLaw, Kinematics, LinearLaw, Response};
    use crate::mesh::Mesh;
    use percute_testkit::Random;

    /// A block of two materials in bands, with elements of each in each chunk.
    fn block(kinematics: [Kinematics; 2]) -> Problem<2> {
        let mesh = Mesh::rectangle(1.0, 0.7, 13, 60).unwrap();
        let groups = [(0, "soft"), (1, "hard")].map(|(k, name)| {
            (name.to_string(), (0..mesh.element_count()).filter(|e| (e / 7) % 2 == k).collect::<Vec<_>>())
        });
        let cells: Vec<_> = mesh.nodes_of::<3>().iter().map(|cell| cell.map(|node| node.index())).collect();
        let mesh = Mesh::new(mesh.points_in::<2>().to_vec(), &cells, &Default::default(), &groups.into()).unwrap();
        let soft = Elastic::plane_strain(3.0, 0.4, 1.0, 0.5).unwrap().with_kinematics(kinematics[0]).unwrap();
        let hard = Elastic::plane_stress(7.0, 0.3, 2.0, 1.0).unwrap().with_kinematics(kinematics[1]).unwrap();
        Problem::builder(mesh).material_of("soft", soft).material_of("hard", hard).build().unwrap()
    }

    fn random_field(nodes: usize, size: f64, random: &mut Random) -> Vec<[f64; 2]> {
        (0..nodes).map(|_| [random.between(-size, size), random.between(-size, size)]).collect()
    }

    fn kernel<M: PointLaw>(problem: &Problem<2>, laws: Vec<M>) -> PointKernel<M, 2> {
        PointKernel::with_laws(problem, Strips::with_fewest(problem.mesh(), 100), laws)
    }

    /// Two independent sweeps of linear laws, within 1e-14 of the largest force.
    #[test]
    fn small_strains_agree_with_the_stiffness() {
        let problem = block([Kinematics::Small; 2]);
        let u = random_field(problem.mesh().node_count(), 1.0, &mut Random::new(3));
        let points = kernel(&problem, problem.materials().to_vec());
        assert!(Kernel::<2>::strips(&points).count() > 4);
        let mut forces = [vec![[0.0; 2]; u.len()], vec![[0.0; 2]; u.len()]];
        let energy = points.subtract(&u, &mut [], &mut forces[0]);
        let expected = LinearKernel::new(&problem).subtract(&u, &mut [], &mut forces[1]);
        let scale = forces[1].iter().flatten().fold(0.0_f64, |most, f| most.max(f.abs()));
        assert!((energy / expected - 1.0).abs() < 1e-14, "{energy} against {expected}");
        for (found, expected) in forces[0].iter().flatten().zip(forces[1].iter().flatten()) {
            assert!((found - expected).abs() < 1e-14 * scale, "{found} against {expected}, scale {scale}");
        }
    }

    /// Linear and angular momentum: internal forces have no resultant, and no moment about any point of the present
    /// places, to the rounding of the sums over all nodes.
    #[test]
    fn internal_forces_are_in_equilibrium() {
        let kinematics = [HyperelasticLaw::NeoHookean, HyperelasticLaw::Hencky].map(Kinematics::Finite);
        let problem = block(kinematics);
        let mut random = Random::new(4);
        let u = random_field(problem.mesh().node_count(), 0.003, &mut random);
        // A rotation by 2 rad beside.
        let places: Vec<[f64; 2]> = (problem.mesh().points_in::<2>().iter().zip(&u))
            .map(|(p, u)| [p[0] + u[0], p[1] + u[1]])
            .map(|[x, y]| [2_f64.cos() * x - 2_f64.sin() * y, 2_f64.sin() * x + 2_f64.cos() * y])
            .collect();
        let turned: Vec<[f64; 2]> =
            (places.iter().zip(problem.mesh().points_in::<2>())).map(|(x, p)| [x[0] - p[0], x[1] - p[1]]).collect();
        let mut force = vec![[0.0; 2]; u.len()];
        let energy = kernel(&problem, problem.materials().to_vec()).subtract(&turned, &mut [], &mut force);
        assert!(energy > 0.0);
        let scale: f64 = force.iter().flatten().map(|f| f.abs()).sum();
        for c in 0..2 {
            assert!(force.iter().map(|f| f[c]).sum::<f64>().abs() < 1e-14 * scale);
        }
        let moment: f64 = places.iter().zip(&force).map(|(x, f)| x[0] * f[1] - x[1] * f[0]).sum();
        assert!(moment.abs() < 1e-14 * scale, "{moment}, scale {scale}");
    }

    /// The step at rest is that of the linear code, but for the power of the trace: its root is at most 2.2 % too
    /// large.
    #[test]
    fn the_bound_at_rest_is_that_of_linear_laws() {
        let problem =
            block([HyperelasticLaw::NeoHookean, HyperelasticLaw::SaintVenantKirchhoff].map(Kinematics::Finite));
        let points = kernel(&problem, problem.materials().to_vec());
        let rest = vec![[0.0; 2]; problem.mesh().node_count()];
        let (found, expected) = (points.stable_step(&problem, &rest), crate::dynamics::element_time_step(&problem));
        assert!((0.9785..=1.0 + 1e-14).contains(&(found / expected)), "{found} against {expected}");
        assert!(points.is_stable(&problem, &rest, found));
        assert!(!points.is_stable(&problem, &rest, 1.023 * found));
    }

    /// Eight elements at once have the forces of each alone, where some of them yield and others have no strain at all:
    /// in plane strain and plane stress, beside an elastic material.
    #[test]
    fn elements_yield_side_by_side() {
        let hardening = Hardening::new(0.5, 0.3).unwrap();
        for of in [Elastic::plane_strain, Elastic::plane_stress] {
            let mesh = block([Kinematics::Small; 2]).mesh().clone();
            let yields = of(7.0, 0.3, 2.0, 1.0).unwrap().with_yield_stress(0.01).unwrap();
            let law = yields.with_hardening(hardening).unwrap();
            let elastic = of(3.0, 0.2, 1.0, 1.0).unwrap();
            let built = Problem::builder(mesh).material_of("soft", law).material_of("hard", elastic).build();
            let problem = built.unwrap();
            let laws = problem.yielding_laws();
            let (points, mut random) = (kernel(&problem, laws.clone()), Random::new(8));
            let (nodes, elements) = (problem.mesh().node_count(), problem.mesh().element_count());
            let (mut internal, mut alone) = (vec![0.0; 4 * elements], vec![0.0; 4 * elements]);
            let mut u = vec![[0.0; 2]; nodes];
            for instant in 1..4 {
                // A part of the body that grows moves.
                for moved in u.iter_mut().take(nodes * instant / 4) {
                    *moved = [random.between(-0.001, 0.001), random.between(-0.001, 0.001)];
                }
                let (mut force, mut expected) = (vec![[0.0; 2]; nodes], vec![[0.0; 2]; nodes]);
                let energy = points.subtract(&u, &mut internal, &mut force);
                let mut sum = 0.0;
                for e in 0..elements {
                    let id = ElementId::new(e);
                    let gradient = crate::element_state::displacement_gradient::<2>(problem.mesh(), id, &u);
                    let law = &laws[usize::from(problem.element_material()[e])];
                    let (stress, density) = law.respond(&gradient, &mut alone[4 * e..4 * e + 4]);
                    sum += problem.volume(id) * density;
                    for (node, slope) in problem.mesh().cell(id).iter().zip(problem.mesh().gradients_in::<2>(id)) {
                        for a in 0..2 {
                            (0..2).for_each(|b| {
                                expected[node.index()][a] -= problem.volume(id) * stress[a][b] * slope[b];
                            });
                        }
                    }
                }
                let scale = expected.iter().flatten().fold(0.0_f64, |most, f| most.max(f.abs()));
                assert!((energy / sum - 1.0).abs() < 1e-13, "{energy} for {sum}");
                for (found, expected) in force.iter().flatten().zip(expected.iter().flatten()) {
                    assert!((found - expected).abs() < 1e-13 * scale, "{found} for {expected}, scale {scale}");
                }
            }
            assert!(alone.iter().filter(|x| **x != 0.0).count() > elements && alone.contains(&0.0));
            assert!(internal.iter().zip(&alone).all(|(a, b)| (a - b).abs() < 1e-14));
        }
    }

    /// A law with two internal variables: the number of instants, and the largest trace of H, which softens it.
    #[derive(Clone, Copy, Debug)]
    struct Softening(Elastic);

    impl PointLaw for Softening {
        fn variables<const D: usize>() -> usize {
            2
        }

        fn respond<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], internal: &mut [V]) -> Response<V, D> {
            let (stress, energy) = self.0.respond(gradient, &mut []);
            let mut trace = gradient[0][0];
            (1..D).for_each(|a| trace += gradient[a][a]);
            internal[0] += trace.fill(1.0);
            internal[1] = internal[1].max(trace);
            let factor = trace.fill(1.0) / (internal[1] + trace.fill(1.0));
            (stress.map(|row| row.map(|s| s * factor)), energy * factor)
        }

        fn stiffness_bound<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], root: &[[V; D]; D]) -> V {
            self.0.stiffness_bound(gradient, root)
        }

        fn stiffness_excess<V: Value, const D: usize>(
            &self,
            gradient: &[[V; D]; D],
            square: &[[V; D]; D],
            limit: f64,
        ) -> V {
            self.0.stiffness_excess(gradient, square, limit)
        }
    }

    /// Each element has its own internal variables, in its row, and its stress is that of their new values.
    #[test]
    fn laws_have_internal_variables() {
        let problem = block([Kinematics::Small; 2]);
        let laws: Vec<_> = problem.materials().iter().map(|law| Softening(*law)).collect();
        let (points, mut random) = (kernel(&problem, laws), Random::new(5));
        let elements = problem.mesh().element_count();
        let (mut internal, mut largest) = (vec![0.0; 2 * elements], vec![0.0_f64; elements]);
        for instant in 1..=3 {
            let u = random_field(problem.mesh().node_count(), 0.01, &mut random);
            let (mut force, mut expected) = (vec![[0.0; 2]; u.len()], vec![[0.0; 2]; u.len()]);
            points.subtract(&u, &mut internal, &mut force);
            for e in 0..elements {
                let element = ElementId::new(e);
                let gradient = crate::element_state::displacement_gradient(problem.mesh(), element, &u);
                largest[e] = largest[e].max(gradient[0][0] + gradient[1][1]);
                assert_eq!(internal[2 * e], f64::from(instant));
                assert!((internal[2 * e + 1] - largest[e]).abs() < 1e-15);
                let law = problem.material(element);
                let (lambda, shear) = law.moduli();
                let slopes = problem.mesh().gradients_in::<2>(element);
                let factor = problem.volume(element) / (1.0 + largest[e]);
                for (node, slope) in problem.mesh().cell(element).iter().zip(slopes) {
                    for a in 0..2 {
                        for b in 0..2 {
                            let spherical = if a == b { lambda * (gradient[0][0] + gradient[1][1]) } else { 0.0 };
                            let stress = spherical + shear * (gradient[a][b] + gradient[b][a]);
                            expected[node.index()][a] -= factor * stress * slope[b];
                        }
                    }
                }
            }
            let scale = expected.iter().flatten().fold(0.0_f64, |most, f| most.max(f.abs()));
            for (found, expected) in force.iter().flatten().zip(expected.iter().flatten()) {
                assert!((found - expected).abs() < 1e-14 * scale);
            }
        }
    }
}
