//! Internal forces of P1 elements with any law: one point of integration in each, eight elements at a time.

use super::{Kernel, Reach};
use crate::ids::ElementId;
use crate::material::{Elastic, Law, MOST_VARIABLES, PointLaw};
use crate::mesh::Strips;
use crate::problem::Problem;
use crate::simd::lanes::{LANES, Lanes, Value, load};
use crate::simd::{Eight, Registers, Task, Wide, run_task};
use std::ops::Range;

/// A chunk has so many groups of eight elements, of all laws.
const CHUNK: usize = 8;

/// Eight elements of one law; lanes that are left have no volume.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group<const D: usize> {
    /// Their numbers in the strip, and how many there are.
    elements: [u32; LANES],
    count: u32,
    /// Their first and other nodes in the strip.
    first: [u32; LANES],
    others: [[u32; LANES]; D],
    /// ∇φ_i of the other nodes (1/m).
    slopes: [[Lanes; D]; D],
    /// |E| with section or thickness (m³).
    volume: Lanes,
    law: u32,
}

/// A tensor at eight points.
type Tensors<R, const D: usize> = [[Wide<R>; D]; D];

/// The elements of all strips.
#[derive(Clone, Debug)]
pub(crate) struct PointKernel<M, const D: usize> {
    strips: Strips,
    groups: Vec<Group<D>>,
    /// Nodes and groups of each chunk.
    chunks: Vec<(Reach, Range<u32>)>,
    /// Where the chunks of each strip begin.
    of_strip: Vec<usize>,
    laws: Vec<M>,
}

impl<const D: usize> PointKernel<Elastic, D> {
    /// That of a problem, with its materials.
    pub(crate) fn new(problem: &Problem<D>) -> Self {
        Self::with_laws(problem, Strips::new(problem.mesh()), problem.materials().to_vec())
    }
}

impl<M: PointLaw, const D: usize> PointKernel<M, D> {
    /// The same with a law for each material.
    fn with_laws(problem: &Problem<D>, strips: Strips, laws: Vec<M>) -> Self {
        let (mut groups, mut chunks, mut of_strip) = (Vec::new(), Vec::new(), vec![0]);
        for strip in 0..strips.count() {
            let (starts, first_chunk) = ([strips.nodes(strip).start, strips.elements(strip).start], chunks.len());
            let elements: Vec<usize> = strips.elements(strip).collect();
            for window in elements.chunks(CHUNK * LANES) {
                let from = groups.len();
                for law in 0..laws.len() {
                    let same = window.iter().filter(|e| usize::from(problem.element_material()[**e]) == law);
                    let same: Vec<ElementId> = same.map(|e| ElementId::new(*e)).collect();
                    groups.extend(same.chunks(LANES).map(|elements| Group::new(problem, starts, elements, law)));
                }
                let nodes = groups[from..].iter().flat_map(|group: &Group<D>| group.nodes());
                chunks.push((Reach::of(nodes), from as u32..groups.len() as u32));
            }
            Reach::close(chunks[first_chunk..].iter_mut().map(|(reach, _)| reach), strips.nodes(strip).len());
            of_strip.push(chunks.len());
        }
        Self { strips, groups, chunks, of_strip, laws }
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
}

/// The larger of two numbers; NaN counts as largest.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

impl<const D: usize> Group<D> {
    fn new(problem: &Problem<D>, [first_node, first_element]: [usize; 2], elements: &[ElementId], law: usize) -> Self {
        let (mesh, zero) = (problem.mesh(), [[Lanes::ZERO; D]; D]);
        let place = |element: ElementId, i: usize| (mesh.cell(element)[i].index() - first_node) as u32;
        // Lanes that are left move with a node of the group.
        let mut group = Self {
            elements: [0; LANES],
            count: elements.len() as u32,
            first: [place(elements[0], 0); LANES],
            others: [[place(elements[0], 0); LANES]; D],
            slopes: zero,
            volume: Lanes::ZERO,
            law: law as u32,
        };
        for (lane, &element) in elements.iter().enumerate() {
            let slopes = mesh.gradients_in::<D>(element);
            group.elements[lane] = (element.index() - first_element) as u32;
            group.first[lane] = place(element, 0);
            group.volume.0[lane] = problem.volume(element);
            for i in 0..D {
                group.others[i][lane] = place(element, i + 1);
                (0..D).for_each(|b| group.slopes[i][b].0[lane] = slopes[i + 1][b]);
            }
        }
        group
    }

    fn nodes(&self) -> impl Iterator<Item = u32> {
        self.first.into_iter().chain(self.others.into_iter().flatten())
    }

    /// The internal variables of its elements.
    #[inline(always)]
    fn variables<M: PointLaw, R: Registers>(&self, like: Wide<R>, internal: &[f64]) -> [Wide<R>; MOST_VARIABLES] {
        let mut found = [like; MOST_VARIABLES];
        for k in 0..M::VARIABLES {
            let of_element = |lane: usize| internal[M::VARIABLES * self.elements[lane] as usize + k];
            found[k] = like.load(&Lanes::at_levels(of_element));
        }
        found
    }

    /// Stores them.
    #[inline(always)]
    fn store<M: PointLaw, R: Registers>(&self, variables: &[Wide<R>; MOST_VARIABLES], internal: &mut [f64]) {
        for k in 0..M::VARIABLES {
            let stored = variables[k].store();
            for lane in 0..self.count as usize {
                internal[M::VARIABLES * self.elements[lane] as usize + k] = stored.0[lane];
            }
        }
    }

    /// H = ∂u_a/∂X_b, and ∇φ_i of the other nodes.
    #[inline(always)]
    fn gradient<R: Registers>(&self, like: Wide<R>, displacement: &[[f64; D]]) -> [Tensors<R, D>; 2] {
        let (zero, first) = (like.zero(), gather(like, displacement, &self.first));
        let (mut gradient, mut slopes) = ([[zero; D]; D], [[zero; D]; D]);
        for i in 0..D {
            slopes[i] = load(like, &self.slopes[i]);
            let u = gather(like, displacement, &self.others[i]);
            for a in 0..D {
                (0..D).for_each(|b| gradient[a][b] += (u[a] - first[a]) * slopes[i][b]);
            }
        }
        [gradient, slopes]
    }
}

/// A nodal field at eight nodes.
#[inline(always)]
fn gather<R: Registers, const D: usize>(like: Wide<R>, field: &[[f64; D]], nodes: &[u32; LANES]) -> [Wide<R>; D] {
    let mut found = [like; D];
    if D == 2 {
        let field = field.as_flattened().as_chunks::<2>().0;
        let both = like.transpose(nodes.each_ref().map(|node| &field[*node as usize]));
        (0..D).for_each(|c| found[c] = both[c]);
    } else {
        (0..D).for_each(|c| found[c] = like.load(&Lanes::at_levels(|lane| field[nodes[lane] as usize][c])));
    }
    found
}

impl<M: PointLaw, const D: usize> Kernel<D> for PointKernel<M, D> {
    type Chunk<'a>
        = &'a [Group<D>]
    where
        M: 'a;

    fn strips(&self) -> &Strips {
        &self.strips
    }

    fn variables(&self) -> usize {
        M::VARIABLES
    }

    #[inline(always)]
    fn chunks(&self, strip: usize) -> impl Iterator<Item = (&Reach, &[Group<D>])> {
        let chunks = &self.chunks[self.of_strip[strip]..self.of_strip[strip + 1]];
        chunks.iter().map(
            #[inline(always)]
            |(reach, groups)| (reach, &self.groups[groups.start as usize..groups.end as usize]),
        )
    }

    #[inline(always)]
    fn sweep<L: Registers>(
        &self,
        lanes: L,
        chunk: &&[Group<D>],
        displacement: &[[f64; D]],
        internal: &mut [f64],
        force: &mut [[f64; D]],
        energy: &mut Eight,
    ) {
        let like = Wide::zeros(lanes);
        let force = &mut force[..displacement.len()];
        let mut total = like.load(&Lanes(*energy));
        for group in *chunk {
            let [gradient, slopes] = group.gradient(like, displacement);
            let mut variables = group.variables::<M, L>(like, internal);
            let law = &self.laws[group.law as usize];
            let (stress, density) = law.respond(&gradient, &mut variables[..M::VARIABLES]);
            group.store::<M, L>(&variables, internal);
            let volume = like.load(&group.volume);
            total += density * volume * 2.0;
            let mut first = [like; D];
            for i in 0..D {
                let mut on_node = [like; D];
                for a in 0..D {
                    (0..D).for_each(|b| on_node[a] += stress[a][b] * slopes[i][b]);
                    on_node[a] = on_node[a] * volume;
                    first[a] += on_node[a];
                }
                scatter(force, &group.others[i], on_node.map(|f| -f));
            }
            scatter(force, &group.first, first);
        }
        *energy = total.store().0;
    }
}

/// Adds forces at eight nodes.
#[inline(always)]
fn scatter<R: Registers, const D: usize>(force: &mut [[f64; D]], nodes: &[u32; LANES], added: [Wide<R>; D]) {
    let added = added.map(Value::store);
    for lane in 0..LANES {
        let at = &mut force[nodes[lane] as usize];
        (0..D).for_each(|c| at[c] += added[c].0[lane]);
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
        for (_, groups) in self.kernel.chunks(self.strip) {
            for group in groups {
                let [gradient, slopes] = group.gradient(like, self.displacement);
                let law = group.law as usize;
                let bound = self.kernel.laws[law].stiffness_bound(&gradient, &root(&slopes));
                largest = largest.worse(bound * ((D + 1) as f64 / self.densities[law]));
            }
        }
        largest.store().0.into_iter().fold(0.0, larger)
    }
}

/// The root of Σ ∇φ_i⊗∇φ_i over all nodes.
#[inline(always)]
fn root<V: Value, const D: usize>(slopes: &[[V; D]; D]) -> [[V; D]; D] {
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
    if D == 1 {
        return square.map(|row| row.map(Value::sqrt));
    }
    // √Q = (Q + √det Q 1)/√(tr Q + 2 √det Q); lanes that are left have no slopes.
    let determinant = (square[0][0] * square[1][1] - square[0][1] * square[1][0]).sqrt();
    let trace = square[0][0] + square[1][1] + determinant * 2.0;
    let scale = trace.fill(1.0) / trace.sqrt().max(trace.fill(f64::MIN_POSITIVE));
    for a in 0..D {
        square[a][a] += determinant;
    }
    square.map(|row| row.map(|x| x * scale))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Stiffness;
    use crate::material::{HyperelasticLaw, Kinematics, LinearLaw, Response};
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
        let expected = Stiffness::new(&problem).subtract_internal_forces(&u, &mut forces[1]);
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
    }

    /// A law with two internal variables: the number of instants, and the largest trace of H, which softens it.
    #[derive(Clone, Copy, Debug)]
    struct Softening(Elastic);

    impl PointLaw for Softening {
        const VARIABLES: usize = 2;

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
