use super::basis::{FacetMoments, Modes};
use super::*;
use crate::element::elements;
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::problem::TriangleProblem;
use percute_testkit::{Random, random_rectangle};

/// A block of random triangles whose left side is held.
fn problem() -> TriangleProblem {
    Problem::builder(random_rectangle(0.05, 0.04, 4, 1).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 0.3).unwrap())
        .support(Support { group: "left".into(), components: [true, true], velocity: None })
        .build()
        .unwrap()
}

fn prepared(problem: &TriangleProblem) -> TractionMinimisation<2> {
    TractionMinimisation::new(problem, &elements(problem)).unwrap()
}

fn random_modes(basis: &Basis<2>, random: &mut Random) -> Modes {
    let mut modes = basis.no_modes();
    modes.edges.iter_mut().flatten().for_each(|x| *x = random.between(-1.0, 1.0));
    modes.nodes.iter_mut().flatten().flatten().for_each(|x| *x = random.between(-1.0, 1.0));
    modes
}

fn random_moments(basis: &Basis<2>, random: &mut Random) -> Vec<FacetMoments<2>> {
    let mut moments = basis.no_moments();
    moments.iter_mut().flatten().flatten().flatten().for_each(|x| *x = random.between(-1.0, 1.0));
    moments
}

/// Slopes of all elements as a random quadratic energy has them at its start.
fn random_slopes(
    problem: &TriangleProblem,
    all: &TractionMinimisation<2>,
    random: &mut Random,
) -> Vec<[Lanes; MOMENTS]> {
    let apart = random_moments(&all.basis, random);
    let slope = |e: usize| basis::apply(&all.forms[e], &all.basis.of_element(e, &apart));
    (0..problem.mesh().element_count()).map(slope).collect()
}

/// Moments on an edge act like forces at its two nodes: no mode gives any element a resultant or a moment.
#[test]
fn modes_have_no_resultant_on_any_element() {
    let (problem, mut random) = (problem(), Random::new(1));
    let basis = prepared(&problem).basis;
    let mut moments = basis.no_moments();
    basis.spread(&random_modes(&basis, &mut random), &mut moments);
    for e in 0..problem.mesh().element_count() {
        let points = problem.mesh().cell_points(ElementId::new(e));
        let all = basis.of_element(e, &moments);
        for lane in 0..LANES {
            let (mut force, mut couple) = ([0.0; 2], 0.0);
            for k in 0..3 {
                for p in 0..2 {
                    let at = points[crate::stress::facet_node::<3>(k, p)];
                    let f = [0, 1].map(|c| all[4 * k + 2 * p + c][lane]);
                    force = [force[0] + f[0], force[1] + f[1]];
                    couple += at[0] * f[1] - at[1] * f[0];
                }
            }
            // Couples of unit moment have forces of 1/edge, some 300 N here: rounding of a dozen of them.
            assert!(force.iter().all(|f| f.abs() < 1e-11), "element {e}: {force:?}");
            assert!(couple.abs() < 1e-12, "element {e}: {couple}");
        }
    }
}

/// Their number is that of all changes that balance: unknown moments less three equations for each element.
#[test]
fn the_modes_are_all_there_are() {
    let problem = problem();
    let basis = prepared(&problem).basis;
    let (facets, elements) = (basis.no_moments().len(), problem.mesh().element_count());
    let modes = basis.no_modes();
    let count = modes.edges.len() + 3 * modes.nodes.len();
    // One column for each mode: the moments that it makes.
    let mut columns = Vec::new();
    for m in 0..count {
        let mut one = basis.no_modes();
        match m.checked_sub(modes.edges.len()) {
            None => one.edges[m] = [1.0; LANES],
            Some(m) => one.nodes[m / 3][m % 3] = [if m % 3 == 2 { 0.01 } else { 1.0 }; LANES],
        }
        let mut moments = basis.no_moments();
        basis.spread(&one, &mut moments);
        columns.push(moments.iter().flatten().flatten().map(|lanes| lanes[0]).collect::<Vec<_>>());
    }
    let matrix = nalgebra::DMatrix::from_fn(4 * facets, count, |r, c| columns[c][r]);
    // A held side leaves no equation redundant.
    assert_eq!(count, 4 * facets - 3 * elements);
    // Singular values of independent modes of size 1 are far above this, those of dependent ones at rounding.
    assert_eq!(matrix.rank(1e-6), count);
}

#[test]
fn gathering_is_the_transpose_of_spreading() {
    let (problem, mut random) = (problem(), Random::new(2));
    let all = prepared(&problem);
    let (modes, moments) = (random_modes(&all.basis, &mut random), random_moments(&all.basis, &mut random));
    let (mut spread, mut gathered) = (all.basis.no_moments(), all.basis.no_modes());
    all.basis.spread(&modes, &mut spread);
    all.basis.gather(&moments, &mut gathered);
    for lane in 0..LANES {
        let work: f64 = spread
            .iter()
            .flatten()
            .flatten()
            .zip(moments.iter().flatten().flatten())
            .map(|(a, b)| a[lane] * b[lane])
            .sum();
        let edges: f64 = modes.edges.iter().zip(&gathered.edges).map(|(a, b)| a[lane] * b[lane]).sum();
        let nodes: f64 =
            modes.nodes.iter().flatten().zip(gathered.nodes.iter().flatten()).map(|(a, b)| a[lane] * b[lane]).sum();
        // Rounding of some hundred terms of up to 300.
        assert!((work - edges - nodes).abs() < 1e-9, "{work} {edges} {nodes}");
    }
}

/// Energy falls at every step, and many steps lead to where no mode has a slope any more.
#[test]
fn energy_falls_to_its_least_value() {
    let (problem, mut random) = (problem(), Random::new(3));
    let all = prepared(&problem);
    let slopes = random_slopes(&problem, &all, &mut random);
    // ½cᵀHc + slope·c of a change c.
    let energy = |change: &[FacetMoments<2>], lane: usize| -> f64 {
        let of = |e: usize| {
            let moments = all.basis.of_element(e, change);
            let product = basis::apply(&all.forms[e], &moments);
            (0..MOMENTS).map(|m| moments[m][lane] * (0.5 * product[m][lane] + slopes[e][m][lane])).sum::<f64>()
        };
        (0..slopes.len()).map(of).sum()
    };
    let after = |steps: usize| descent::descend(&all.basis, &all.forms, |e| slopes[e], steps);
    for lane in 0..LANES {
        let energies: Vec<f64> = [0, 1, 2, 3, STEPS, 400].map(|steps| energy(&after(steps), lane)).to_vec();
        assert_eq!(energies[0], 0.0);
        assert!(energies.windows(2).all(|pair| pair[1] < pair[0]), "{energies:?}");
        // What the steps taken leave of what could be gained.
        assert!(energies[4] < 0.95 * energies[5], "{energies:?}");
    }
    let change = after(400);
    let mut facets = all.basis.no_moments();
    let mut first = all.basis.no_moments();
    for (e, slope) in slopes.iter().enumerate() {
        let product = basis::apply(&all.forms[e], &all.basis.of_element(e, &change));
        let total = std::array::from_fn(|m| std::array::from_fn(|lane| product[m][lane] + slope[m][lane]));
        all.basis.add_to_facets(e, &total, &mut facets);
        all.basis.add_to_facets(e, slope, &mut first);
    }
    let size = |moments: &[FacetMoments<2>]| {
        let mut modes = all.basis.no_modes();
        all.basis.gather(moments, &mut modes);
        modes.edges.iter().flatten().chain(modes.nodes.iter().flatten().flatten()).fold(0.0_f64, |m, x| m.max(x.abs()))
    };
    // Converged to what rounding of the energies lets conjugate gradients reach.
    assert!(size(&facets) < 1e-9 * size(&first), "{} of {}", size(&facets), size(&first));
}

/// A lane does not depend on its neighbours, and one without any slope stays where it is.
#[test]
fn lanes_are_apart() {
    let (problem, mut random) = (problem(), Random::new(4));
    let all = prepared(&problem);
    let slopes = random_slopes(&problem, &all, &mut random);
    let together = descent::descend(&all.basis, &all.forms, |e| slopes[e], STEPS);
    for lane in 0..LANES {
        let only = |e: usize| slopes[e].map(|lanes| std::array::from_fn(|l| if l == 0 { lanes[lane] } else { 0.0 }));
        let alone = descent::descend(&all.basis, &all.forms, only, STEPS);
        for (a, b) in together.iter().flatten().flatten().zip(alone.iter().flatten().flatten()) {
            assert_eq!(a[lane], b[0]);
            assert!(b[1..].iter().all(|x| *x == 0.0));
        }
    }
}
