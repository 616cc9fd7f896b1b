//! Products of motions in the energy ½x·Kx + ½y·M_c y.

use crate::element::Element;
use crate::inertia::mass_product;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;

/// Displacements and velocities of all nodes. Empty where there is no motion.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion<const D: usize> {
    /// x (m).
    pub(super) displacement: Vec<[f64; D]>,
    /// y (m/s).
    pub(super) velocity: Vec<[f64; D]>,
    /// Kx (N); on prescribed components, where x is 0, any number.
    pub(super) internal: Vec<[f64; D]>,
}

/// Which motions of the four are multiplied.
const PAIRS: [(usize, usize); 5] = [(0, 0), (0, 1), (1, 1), (2, 2), (3, 3)];

/// The masses and elements that products need.
#[derive(Debug)]
pub(super) struct EnergyProducts<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    /// m/((D+1)(D+2)) of each element (kg), m its mass.
    shares: Vec<f64>,
    /// Elements with a node that may touch.
    near: Vec<(ElementId, Element<D, N>)>,
}

impl<'p, const D: usize, const N: usize> EnergyProducts<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, elements: &[Element<D, N>]) -> Self {
        let mut touches = vec![false; problem.mesh().node_count()];
        problem.surface().nodes().iter().for_each(|contact| touches[contact.node.index()] = true);
        let near = elements.iter().enumerate().filter(|(_, e)| e.nodes.iter().any(|n| touches[n.index()]));
        Self {
            problem,
            shares: elements.iter().map(|e| e.nodal_mass / (D + 2) as f64).collect(),
            near: near.map(|(e, element)| (ElementId::new(e), *element)).collect(),
        }
    }

    /// The energy of the first motion, its product with the second, and the energies of the second to the fourth (J).
    pub(super) fn energies(&self, motions: [&Motion<D>; 4]) -> [f64; 5] {
        let strain = PAIRS.map(|(a, b)| nodal(None, &motions[a].displacement, &motions[b].internal));
        // An element gives m/((D+1)(D+2)) (Σy_i·z_i + Σy_i·Σz_i); the first sum is of nodes.
        let mass = Some(self.problem.mass());
        let scale = 1.0 / (D + 2) as f64;
        let own = PAIRS.map(|(a, b)| scale * nodal(mass, &motions[a].velocity, &motions[b].velocity));
        let mut mixed = [0.0; 5];
        for (nodes, share) in self.problem.mesh().cells().iter().zip(&self.shares) {
            let sums = motions.map(|motion| {
                let mut sum = [0.0; D];
                for n in nodes {
                    if let Some(v) = motion.velocity.get(n.index()) {
                        (0..D).for_each(|c| sum[c] += v[c]);
                    }
                }
                sum
            });
            for (value, (a, b)) in mixed.iter_mut().zip(PAIRS) {
                *value += share * (0..D).map(|c| sums[a][c] * sums[b][c]).sum::<f64>();
            }
        }
        std::array::from_fn(|k| 0.5 * (strain[k] + own[k] + mixed[k]))
    }

    /// The energy of a motion in the elements with a node that may touch (J).
    pub(super) fn near(&self, motion: &Motion<D>) -> f64 {
        let energy = |(id, element): &(ElementId, Element<D, N>)| {
            let gradient = element.gradient(&element.gather(&motion.displacement));
            let stress = self.problem.material(*id).stress(&gradient);
            let work: f64 = (0..D).map(|a| (0..D).map(|b| stress[a][b] * gradient[a][b]).sum::<f64>()).sum();
            let velocity = element.gather(&motion.velocity);
            0.5 * (element.volume * work + mass_product(N as f64 * element.nodal_mass, &velocity, &velocity))
        };
        self.near.iter().map(energy).sum()
    }
}

/// Σa_i·b_i over the nodes, each with its mass if there is one.
fn nodal<const D: usize>(mass: Option<&[f64]>, a: &[[f64; D]], b: &[[f64; D]]) -> f64 {
    let dot = |(a, b): (&[f64; D], &[f64; D])| (0..D).map(|c| a[c] * b[c]).sum::<f64>();
    let products = a.iter().zip(b).map(dot);
    match mass {
        Some(mass) => products.zip(mass).map(|(product, mass)| product * mass).sum(),
        None => products.sum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::elements;
    use percute_core::contact::Obstacle;
    use percute_core::dynamics::Stiffness;
    use percute_core::material::Elastic;
    use percute_core::mesh::TriangleMesh;
    use percute_core::problem::TriangleProblem;
    use percute_testkit::{Random, random_rectangle};

    fn problem(mesh: TriangleMesh) -> TriangleProblem {
        let plane = Obstacle::plane([0.0, -1.0], [0.0, 1.0], 0.0, None).unwrap();
        let law = Elastic::plane_strain(70.0, 0.3, 2.7, 0.5).unwrap();
        Problem::builder(mesh).material(law).obstacle(plane).build().unwrap()
    }

    fn motions(problem: &TriangleProblem) -> [Motion<2>; 4] {
        let (stiffness, mut random) = (Stiffness::new(problem), Random::new(11));
        let mut field = || -> Vec<[f64; 2]> {
            (0..problem.mesh().node_count()).map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0)]).collect()
        };
        std::array::from_fn(|_| {
            let (displacement, velocity) = (field(), field());
            let mut force = vec![[0.0; 2]; displacement.len()];
            stiffness.subtract_internal_forces(&displacement, &mut force);
            Motion { displacement, velocity, internal: force.into_iter().map(|f| f.map(|f| -f)).collect() }
        })
    }

    /// ½∫σ:ε + ½∫ρ y·z over the elements that are wanted; the middles of the sides integrate quadratic functions exactly.
    fn expected(problem: &TriangleProblem, [a, b]: [&Motion<2>; 2], wanted: impl Fn(&[[f64; 2]; 3]) -> bool) -> f64 {
        let mut sum = 0.0;
        for (e, element) in elements(problem).iter().enumerate() {
            let id = ElementId::new(e);
            if !wanted(&problem.mesh().cell_points(id)) {
                continue;
            }
            let law = problem.material(id);
            let stress = law.stress(&element.gradient(&element.gather(&a.displacement)));
            let gradient = element.gradient(&element.gather(&b.displacement));
            let work: f64 = stress.iter().flatten().zip(gradient.iter().flatten()).map(|(s, g)| s * g).sum();
            let (y, z) = (element.gather(&a.velocity), element.gather(&b.velocity));
            let middle = |v: &[[f64; 2]; 3], k: usize, c: usize| 0.5 * (v[k][c] + v[(k + 1) % 3][c]);
            let mean: f64 = (0..6).map(|i| middle(&y, i % 3, i / 3) * middle(&z, i % 3, i / 3)).sum::<f64>() / 3.0;
            sum += 0.5 * element.volume * (work + law.density() * mean);
        }
        sum
    }

    #[test]
    fn products_are_integrals_over_the_elements() {
        let problem = problem(random_rectangle(1.0, 0.8, 5, 3).unwrap());
        let (all, products) = (motions(&problem), EnergyProducts::new(&problem, &elements(&problem)));
        let found = products.energies(all.each_ref());
        for ((a, b), found) in PAIRS.into_iter().zip(found) {
            let expected = expected(&problem, [&all[a], &all[b]], |_| true);
            // Rounding of some hundred terms, of which those of a product of two motions cancel.
            assert!((found - expected).abs() < 1e-10 * expected.abs(), "{a}, {b}: {found} for {expected}");
        }
        let bottom = |points: &[[f64; 2]; 3]| points.iter().any(|p| p[1] < 1e-9);
        let (near, expected) = (products.near(&all[0]), expected(&problem, [&all[0], &all[0]], bottom));
        assert!((near - expected).abs() < 1e-12 * expected && near < 0.7 * found[0], "{near} for {expected}");
    }

    /// Where nothing moves there is nothing to multiply.
    #[test]
    fn no_motion() {
        let problem = problem(random_rectangle(1.0, 0.8, 2, 1).unwrap());
        let (all, none) = (motions(&problem), Motion::default());
        let products = EnergyProducts::new(&problem, &elements(&problem));
        let [energy, product, square, third, fourth] = products.energies([&all[0], &none, &none, &all[3]]);
        assert!(energy > 0.0 && fourth > 0.0);
        assert_eq!((product, square, third), (0.0, 0.0, 0.0));
    }
}
