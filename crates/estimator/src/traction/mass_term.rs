//! The mass term of the star problems.

use percute_core::simd::lanes::Value;

/// The nodal inertia forces of the elements around a node.
pub(super) enum MassTerm<'a, const D: usize, const N: usize, T: Value> {
    /// ρV/(D+1) ã_i, with ã of the node; their sum over the star is M ã there.
    Lumped([T; D]),
    /// (M_c a_c)_i + ρV/(D+1) o_i, with a_c and o at nodes, and the places of the nodes of each element. With the
    /// symmetric part of the stress of lumping, their sum over the star is M ã at the node.
    Split { acceleration: &'a [[T::Stored; D]], skew: &'a [[T::Stored; D]], nodes: &'a [[u32; N]] },
}

impl<const D: usize, const N: usize, T: Value> MassTerm<'_, D, N, T> {
    /// Component `c` at local node `i` of an element, and the size of its parts before they cancel; both over the
    /// lumped mass of the element there (m/s²), in the form of a number.
    #[inline(always)]
    pub(super) fn at(&self, like: T, element: usize, i: usize, c: usize) -> [T; 2] {
        match *self {
            Self::Lumped(acceleration) => [acceleration[c], acceleration[c].abs()],
            Self::Split { acceleration, skew, nodes } => {
                let nodes = &nodes[element];
                let skew = like.load(&skew[nodes[i] as usize][c]);
                let (mut sum, mut size) = (like.load(&acceleration[nodes[i] as usize][c]), skew.abs());
                for n in nodes {
                    let a = like.load(&acceleration[*n as usize][c]);
                    (sum, size) = (sum + a, size.max(a.abs()));
                }
                [sum * (1.0 / (D + 2) as f64) + skew, size]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::elements;
    use crate::inertia::{add_lumping_stress, arms};
    use percute_core::ids::ElementId;
    use percute_core::material::{Elastic, Law};
    use percute_core::problem::Problem;
    use percute_testkit::{Random, random_rectangle};

    /// M ã = M_c a_c + (M − M_c) w for any c: over each star, the elements with a_c = ã + c o, w = (1 − c)ã + c o, o
    /// the lumping difference of ã, sum up to (M ã)_i, with the symmetric part of the stress of lumping and the
    /// acceleration of the skew one.
    #[test]
    fn stars_sum_up_to_the_lumped_mass() {
        let problem = Problem::<2>::builder(random_rectangle(0.05, 0.04, 4, 1).unwrap())
            .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 0.3).unwrap())
            .build()
            .unwrap();
        let (mesh, mut random, elements) = (problem.mesh(), Random::new(1), elements(&problem));
        let nodes = mesh.node_count();
        let plain: Vec<_> = (0..nodes).map(|_| [0, 1].map(|_| random.between(-1.0, 1.0))).collect();
        // M − M_c of an element takes the mean off its nodes, times m/4.
        let mut once = vec![[0.0; 2]; nodes];
        for element in &elements {
            for (n, c) in element.nodes.iter().flat_map(|n| [(n.index(), 0), (n.index(), 1)]) {
                let mean = element.nodes.iter().map(|j| plain[j.index()][c]).sum::<f64>() / 3.0;
                once[n][c] += 0.75 * element.nodal_mass * (plain[n][c] - mean) / problem.mass()[n];
            }
        }
        let c = 1.3;
        let of = |n: usize, own: f64| [0, 1].map(|k| own * plain[n][k] + c * once[n][k]);
        let acceleration: Vec<_> = (0..nodes).map(|n| of(n, 1.0)).collect();
        let lumped: Vec<_> = (0..nodes).map(|n| of(n, 1.0 - c)).collect();
        let mut skew = vec![[0.0; 2]; nodes];
        let mut sums = vec![[0.0; 2]; nodes];
        for (e, element) in elements.iter().enumerate() {
            let id = ElementId::new(e);
            let (arms, w) = (arms(&mesh.corners::<2, 3>(id)), element.gather(&lumped));
            let mut symmetric = [[0.0; 2]; 2];
            let density = problem.material(id).density();
            add_lumping_stress(density, &arms, &w, &mut symmetric);
            let tau = |a: usize, b: usize| density / 4.0 * (0..3).map(|i| w[i][a] * arms[i][b]).sum::<f64>();
            let rest = [0, 1].map(|a| [0, 1].map(|b| tau(a, b) - symmetric[a][b]));
            assert!((rest[0][1] + rest[1][0]).abs() < 1e-12 * tau(0, 1).abs(), "{rest:?}");
            for (i, node) in element.nodes.iter().enumerate() {
                let [even, odd] = [symmetric, rest].map(|stress| element.internal_force(i, &stress));
                for k in 0..2 {
                    sums[node.index()][k] += even[k];
                    skew[node.index()][k] += odd[k] / problem.mass()[node.index()];
                }
            }
        }
        let cells: Vec<_> = elements.iter().map(|e| e.nodes.map(|n| n.index() as u32)).collect();
        let term: MassTerm<'_, 2, 3, f64> = MassTerm::Split { acceleration: &acceleration, skew: &skew, nodes: &cells };
        for (e, element) in elements.iter().enumerate() {
            for (i, k) in (0..3).flat_map(|i| [(i, 0), (i, 1)]) {
                sums[element.nodes[i].index()][k] += element.nodal_mass * term.at(0.0, e, i, k)[0];
            }
        }
        for (n, k) in (0..nodes).flat_map(|n| [(n, 0), (n, 1)]) {
            let wanted = problem.mass()[n] * plain[n][k];
            // Rounding of some thirty terms.
            assert!((sums[n][k] - wanted).abs() < 1e-13 * problem.mass()[n], "{n}, {k}: {} for {wanted}", sums[n][k]);
        }
    }
}
