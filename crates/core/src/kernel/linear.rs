//! Internal forces of bars and triangles with linear laws.

use super::pairs::{ChunkData, ElementPairs, PairNodes};
use super::{Kernel, Reach};
use crate::mesh::Strips;
use crate::problem::Problem;
use crate::simd::{Eight, Registers};

/// The stiffness of a bar or a plane body, applied element by element. Its scaled gradients are valid for linear laws
/// only.
///
/// The sweep goes over pairs of elements that share a face: a pair has four nodes to read and write where two
/// triangles have six. First all even strips are swept, then all odd ones.
#[derive(Clone, Debug)]
pub(crate) struct LinearKernel {
    strips: Strips,
    pairs: ElementPairs,
}

impl LinearKernel {
    /// Prepares the elements of a bar or a plane body.
    pub(crate) fn new<const D: usize>(problem: &Problem<D>) -> Self {
        Self::on_strips(problem, Strips::new(problem.mesh()))
    }

    /// The same with a cut of its own.
    fn on_strips<const D: usize>(problem: &Problem<D>, strips: Strips) -> Self {
        let pairs = ElementPairs::new(problem, &strips);
        Self { strips, pairs }
    }
}

impl<const D: usize> Kernel<D> for LinearKernel {
    type Chunk<'a> = ChunkData<'a>;

    fn strips(&self) -> &Strips {
        &self.strips
    }

    #[inline(always)]
    fn chunks(&self, strip: usize) -> impl Iterator<Item = (&Reach, ChunkData<'_>)> {
        self.pairs.strip(strip)
    }

    #[inline(always)]
    fn sweep<L: Registers>(
        &self,
        lanes: L,
        chunk: &ChunkData<'_>,
        displacement: &[[f64; D]],
        _: &mut [f64],
        force: &mut [[f64; D]],
        energy: &mut Eight,
    ) {
        if D == 2 {
            let force = force[..displacement.len()].as_flattened_mut().as_chunks_mut().0;
            triangles(lanes, chunk, displacement.as_flattened().as_chunks().0, force, energy);
        } else {
            any(chunk, displacement, force, energy);
        }
    }
}

/// Two pairs of triangles at a time. Their gradients ∂u/∂x and ∂u/∂y have a sign less, so that forces are added.
#[inline(always)]
fn triangles<L: Registers>(
    l: L,
    chunk: &ChunkData<'_>,
    displacement: &[[f64; 2]],
    force: &mut [[f64; 2]],
    energy: &mut Eight,
) {
    let u = displacement;
    // One check of an index is enough for both.
    let force = &mut force[..u.len()];
    let [direct, other] = chunk.law;
    let (direct_x, direct_y) = (l.twice([[direct, 1.0]; 2]), l.twice([[1.0, direct]; 2]));
    let (other_x, other_y) = (l.twice([[other, 1.0]; 2]), l.twice([[1.0, other]; 2]));
    let mut total = l.load(energy);
    for ([a, b], gradients) in chunk.nodes.iter().zip(chunk.gradients) {
        let (a, b) = (places(a), places(b));
        let base = l.twice([u[a[0]], u[b[0]]]);
        let (shared_a, shared_b) = (u[a[2]], u[b[2]]);
        let first = l.sub(base, l.quad([u[a[1]], shared_a, u[b[1]], shared_b]));
        let last = l.sub(base, l.quad([shared_a, u[a[3]], shared_b, u[b[3]]]));
        let [first_gradient, last_gradient] = gradients.0;
        let (g, h) = (l.load(&first_gradient), l.load(&last_gradient));
        let (gx, gy, hx, hy) = (l.evens(g), l.odds(g), l.evens(h), l.odds(h));
        let along_x = l.add(l.mul(first, gx), l.mul(last, hx));
        let along_y = l.add(l.mul(first, gy), l.mul(last, hy));
        // (σ_xx, σ_yx) and (σ_xy, σ_yy), over G.
        let on_x = l.add(l.mul(direct_x, along_x), l.mul(other_x, l.swap_lanes(along_y)));
        let on_y = l.add(l.mul(direct_y, along_y), l.mul(other_y, l.swap_lanes(along_x)));
        total = l.add(total, l.add(l.mul(on_x, along_x), l.mul(on_y, along_y)));
        let first = l.add(l.mul(on_x, gx), l.mul(on_y, gy));
        let last = l.add(l.mul(on_x, hx), l.mul(on_y, hy));
        // Element B lies in vectors 1 and 3; the vectors 0 and 2 of these sums are those of the pairs.
        let shared = l.add(last, l.swap_pairs(first));
        let other = l.swap_pairs(last);
        let base = l.add(l.add(first, shared), other);
        let (first, shared, other, base) = (l.ends(first), l.ends(shared), l.ends(other), l.ends(base));
        for (p, node) in [a, b].iter().enumerate() {
            l.take_from(&mut force[node[0]], base[p]);
            l.add_to(&mut force[node[1]], first[p]);
            l.add_to(&mut force[node[2]], shared[p]);
            l.add_to(&mut force[node[3]], other[p]);
        }
    }
    *energy = l.store(total);
}

#[inline(always)]
fn places([a, b, c, d]: &PairNodes) -> [usize; 4] {
    [*a as usize, *b as usize, *c as usize, *d as usize]
}

/// The same for simplices of any dimension up to 2, one element at a time.
#[inline(always)]
fn any<const D: usize>(chunk: &ChunkData<'_>, u: &[[f64; D]], force: &mut [[f64; D]], energy: &mut Eight) {
    let [direct, other] = chunk.law;
    for (nodes, gradients) in chunk.nodes.iter().zip(chunk.gradients) {
        for (lane, slot) in energy.iter_mut().step_by(2).enumerate() {
            let (pair, l) = (lane / 2, lane % 2);
            let node = |i: usize| nodes[pair][if i == 0 { 0 } else { i + l }] as usize;
            let slope = |i: usize, b: usize| gradients.0[i][2 * lane + b];
            let mut gradient = [[0.0; D]; D];
            for i in 0..D {
                for a in 0..D {
                    for b in 0..D {
                        gradient[a][b] += (u[node(i + 1)][a] - u[node(0)][a]) * slope(i, b);
                    }
                }
            }
            let mut stress = [[0.0; D]; D];
            for a in 0..D {
                for b in 0..D {
                    stress[a][b] = gradient[a][b] + gradient[b][a];
                }
                let others = (0..D).filter(|&b| b != a).map(|b| gradient[b][b]).sum::<f64>();
                stress[a][a] = direct * gradient[a][a] + other * others;
            }
            for i in 0..D {
                for a in 0..D {
                    let f: f64 = (0..D).map(|b| stress[a][b] * slope(i, b)).sum();
                    force[node(i + 1)][a] -= f;
                    force[node(0)][a] += f;
                }
            }
            *slot += (0..D)
                .flat_map(|a| (0..D).map(move |b| (a, b)))
                .map(|(a, b)| stress[a][b] * gradient[a][b])
                .sum::<f64>();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::ElementId;
    use crate::kernel::StripSweep;
    use crate::material::{Elastic, Law};
    use crate::mesh::Mesh;
    use crate::simd::{Portable, Task, run_task};
    use percute_testkit::{Random, random_rectangle};

    /// A random mesh of this crate's own types, with groups of elements.
    fn random_mesh(n: usize, seed: u64) -> Mesh {
        let mesh = random_rectangle(1.0, 0.7, n, seed).unwrap();
        let groups = [(0, "soft"), (1, "hard")].map(|(k, name)| {
            (name.to_string(), (0..mesh.element_count()).filter(|e| (e / 7) % 2 == k).collect::<Vec<_>>())
        });
        let cells: Vec<_> = mesh.nodes_of::<3>().iter().map(|cell| cell.map(|node| node.index())).collect();
        Mesh::new(mesh.points_in::<2>().to_vec(), &cells, &Default::default(), &groups.into()).unwrap()
    }

    /// The forces and the energy, element by element with the law and the gradients as they are stated.
    fn plain<const D: usize>(problem: &Problem<D>, u: &[[f64; D]]) -> (Vec<[f64; D]>, f64) {
        let (mut force, mut energy) = (vec![[0.0; D]; u.len()], 0.0);
        for (e, cell) in problem.mesh().cells().enumerate() {
            let element = ElementId::new(e);
            let (material, volume) = (problem.material(element), problem.volume(element));
            let gradients = problem.mesh().gradients_in::<D>(element);
            let mut gradient = [[0.0; D]; D];
            for (node, slope) in cell.iter().zip(&gradients) {
                (0..D * D).for_each(|k| gradient[k / D][k % D] += u[node.index()][k / D] * slope[k % D]);
            }
            let stress = material.stress(&gradient);
            energy += volume * material.strain_energy(&gradient);
            for (node, slope) in cell.iter().zip(&gradients) {
                (0..D * D).for_each(|k| force[node.index()][k / D] -= volume * stress[k / D][k % D] * slope[k % D]);
            }
        }
        (force, energy)
    }

    /// Forces within 1e-14 of the largest that elements exchange, which is far below one unit of displacement on an
    /// element; the energy, a sum of positive terms, relatively.
    fn check<const D: usize>(problem: &Problem<D>, strips: Strips, random: &mut Random) {
        let u: Vec<[f64; D]> = problem
            .mesh()
            .points_in::<D>()
            .iter()
            .map(|_| std::array::from_fn(|_| random.between(-1.0, 1.0)))
            .collect();
        let stiffness = LinearKernel::on_strips(problem, strips);
        let (expected, energy) = plain(problem, &u);
        let mut force = vec![[0.0; D]; u.len()];
        let found = stiffness.subtract(&u, &mut [], &mut force);
        let scale = expected.iter().flatten().fold(0.0_f64, |m, f| m.max(f.abs()));
        for (found, expected) in force.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found - expected).abs() <= 1e-14 * scale, "{found} against {expected}, scale {scale}");
        }
        assert!((found / energy - 1.0).abs() < 1e-14, "{found} against {energy}");
    }

    /// Two materials, in bands that cut pairs apart, and strips of any length.
    #[test]
    fn the_sweep_agrees_with_the_plain_sum() {
        let mut random = Random::new(5);
        let soft = Elastic::plane_strain(3.0, 0.4, 1.0, 0.5).unwrap();
        for seed in 0..20 {
            let mesh = random_mesh(5 + seed as usize, seed);
            let strips = Strips::with_fewest(&mesh, 8 + seed as usize);
            let hard = Elastic::plane_stress(7.0, 0.3, 2.0, 1.0).unwrap();
            let problem = Problem::<2>::builder(mesh).material_of("soft", soft).material_of("hard", hard);
            check(&problem.build().unwrap(), strips, &mut random);
        }
        for elements in [1, 2, 3, 8, 101] {
            let mesh = crate::mesh::Mesh::uniform_bar(2.0, elements).unwrap();
            let strips = Strips::with_fewest(&mesh, 10);
            let problem = Problem::<1>::builder(mesh).material(Elastic::bar(3.0, 1.0, 0.1).unwrap()).build().unwrap();
            check(&problem, strips, &mut random);
        }
    }

    /// The instruction set of the machine and plain arrays.
    #[test]
    fn all_vectors_give_the_same_bits() {
        let mesh = random_mesh(30, 3);
        let law = Elastic::plane_stress(7.0, 0.3, 2.0, 1.0).unwrap();
        let problem = Problem::<2>::builder(mesh).material(law).build().unwrap();
        let (stiffness, mut random) = (LinearKernel::new(&problem), Random::new(6));
        let u: Vec<[f64; 2]> = problem
            .mesh()
            .points_in::<2>()
            .iter()
            .map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0)])
            .collect();
        let mut forces = [vec![[0.0; 2]; u.len()], vec![[0.0; 2]; u.len()]];
        let [a, b] = forces.each_mut().map(|force| StripSweep {
            kernel: &stiffness,
            strip: 0,
            displacement: &u,
            internal: &mut [],
            force,
        });
        assert_eq!(run_task(a).to_bits(), b.run(Portable).to_bits());
        assert!(forces[0] == forces[1]);
    }
}
