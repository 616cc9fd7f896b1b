//! The mass term of the star problems.

use crate::lanes::Value;

/// The nodal inertia forces of the elements around a node. Their sum over the star is M ã at the node.
pub(super) enum MassTerm<'a, const D: usize, const N: usize, T: Value> {
    /// ρV/(D+1) ã_i, with ã of the node.
    Lumped([T; D]),
    /// (M_c ã)_i + ρV/(D+1) o_i, with ã and the lumping difference o at nodes, and the places of the nodes of each
    /// element.
    Mixed { acceleration: &'a [[T::Stored; D]], lumping_difference: &'a [[T::Stored; D]], nodes: &'a [[u32; N]] },
}

impl<const D: usize, const N: usize, T: Value> MassTerm<'_, D, N, T> {
    /// Component `c` at local node `i` of an element, and the size of its parts before they cancel; both over the
    /// lumped mass of the element there (m/s²), in the form of a number.
    #[inline(always)]
    pub(super) fn at(&self, like: T, element: usize, i: usize, c: usize) -> [T; 2] {
        match *self {
            Self::Lumped(acceleration) => [acceleration[c], acceleration[c].abs()],
            Self::Mixed { acceleration, lumping_difference, nodes } => {
                let nodes = &nodes[element];
                let lumping = like.load(&lumping_difference[nodes[i] as usize][c]);
                let (mut sum, mut size) = (like.load(&acceleration[nodes[i] as usize][c]), lumping.abs());
                for n in nodes {
                    let a = like.load(&acceleration[*n as usize][c]);
                    (sum, size) = (sum + a, size.max(a.abs()));
                }
                [sum * (1.0 / (D + 2) as f64) + lumping, size]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::elements;
    use percute_core::load::Support;
    use percute_core::material::Elastic;
    use percute_core::problem::Problem;
    use percute_testkit::{Random, random_rectangle};

    /// Over each star the elements sum up to (M ã)_i where nothing is prescribed, and to (M_c ã)_i, which a support
    /// carries, where o is 0.
    #[test]
    fn stars_sum_up_to_the_lumped_mass() {
        let problem = Problem::builder(random_rectangle(0.05, 0.04, 4, 1).unwrap())
            .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 0.3).unwrap())
            .support(Support { group: "left".into(), components: [true, false], velocity: None })
            .build()
            .unwrap();
        let (mesh, mut random) = (problem.mesh(), Random::new(1));
        let nodes = mesh.node_count();
        let acceleration: Vec<_> = (0..nodes).map(|_| [0, 1].map(|_| random.between(-1.0, 1.0))).collect();
        // (M_c a)_i of an element is m/12 (a_i + Σa_j).
        let elements = elements(&problem);
        let mut consistent = vec![[0.0; 2]; nodes];
        for element in &elements {
            for (n, c) in element.nodes.iter().flat_map(|n| [(n.index(), 0), (n.index(), 1)]) {
                let sum: f64 = element.nodes.iter().map(|j| acceleration[j.index()][c]).sum();
                consistent[n][c] += element.nodal_mass / 4.0 * (acceleration[n][c] + sum);
            }
        }
        let lumped = |n: usize, c: usize| problem.mass()[n] * acceleration[n][c];
        let held = |n: usize, c: usize| problem.prescribed().iter().any(|p| (p.node.index(), p.component) == (n, c));
        let free = |n, c| if held(n, c) { 0.0 } else { (lumped(n, c) - consistent[n][c]) / problem.mass()[n] };
        let lumping_difference: Vec<_> = (0..nodes).map(|n| [0, 1].map(|c| free(n, c))).collect();
        let cells: Vec<_> = elements.iter().map(|e| e.nodes.map(|n| n.index() as u32)).collect();
        let term: MassTerm<'_, 2, 3, f64> =
            MassTerm::Mixed { acceleration: &acceleration, lumping_difference: &lumping_difference, nodes: &cells };
        let mut sums = vec![[0.0; 2]; nodes];
        for (e, element) in elements.iter().enumerate() {
            for (i, c) in (0..3).flat_map(|i| [(i, 0), (i, 1)]) {
                sums[element.nodes[i].index()][c] += element.nodal_mass * term.at(0.0, e, i, c)[0];
            }
        }
        assert!(problem.prescribed().len() > 3);
        for (n, c) in (0..nodes).flat_map(|n| [(n, 0), (n, 1)]) {
            let wanted = if held(n, c) { consistent[n][c] } else { lumped(n, c) };
            // Rounding of a dozen terms.
            assert!((sums[n][c] - wanted).abs() < 1e-14 * problem.mass()[n], "{n}, {c}: {} for {wanted}", sums[n][c]);
        }
    }
}
