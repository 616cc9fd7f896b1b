//! The matrices of the multipliers against what defines them.

use super::band::{Band, Factors};
use super::coupling::Coupling;
use super::friction::FrictionProblem;
use super::gram::gram;
use super::normal::NormalProblem;
use super::relaxation::relax;
use super::side::Side;
use super::{DualShape, Segment};
use proptest::prelude::*;

/// Nodes nearer than this are at one place; lengths are of order 1.
const ONE_PLACE: f64 = 1e-12;

/// A side in one piece, from the ξ of its nodes.
fn side(xi: &[f64]) -> Side {
    Side::new(0, [xi.to_vec(), vec![0.0; xi.len()]], (0..xi.len() - 1).collect(), &[0])
}

fn coupling(slave: &Side, master: &Side, shift: f64) -> Coupling {
    let mut coupling = Coupling::default();
    coupling.update([slave, master], &[shift], ONE_PLACE);
    coupling
}

/// ∫fg over a segment, from f and g at both ends.
fn integral(segment: &Segment, f: [f64; 2], g: [f64; 2]) -> f64 {
    let length = segment.ends[1] - segment.ends[0];
    // Simpson's rule, exact to the third degree.
    length / 6.0 * (f[0] * g[0] + (f[0] + f[1]) * (g[0] + g[1]) + f[1] * g[1])
}

/// The second hat of an edge at the ends of a segment.
fn hat(ends: [f64; 2], segment: &Segment) -> [f64; 2] {
    segment.ends.map(|xi| (xi - ends[0]) / (ends[1] - ends[0]))
}

/// All that holds for any two surfaces.
fn check(slave: &Side, master: &Side, shift: f64) {
    let coupling = coupling(slave, master, shift);
    let (xi, places) = (slave.xi(), coupling.places(0));
    let covered: f64 = coupling.segments().iter().map(|s| s.ends[1] - s.ends[0]).sum();
    let common = xi[xi.len() - 1].min(places[places.len() - 1]) - xi[0].max(places[0]);
    // Rounding of some ten sums of lengths of order 1 to 10.
    let rounding = 1e-13;
    assert!((covered - common.max(0.0)).abs() < rounding, "{covered} of {common}");
    let (mut weights, mut density) = (vec![0.0; slave.len()], vec![0.0; slave.len()]);
    let mut hats = vec![0.0; slave.len()];
    let mut biorthogonal = vec![[0.0; 2]; slave.edges().len()];
    for segment in coupling.segments() {
        let first = slave.edges()[segment.slave];
        let second = hat([xi[first], xi[first + 1]], segment);
        let shape = coupling.shape(segment.slave);
        let dual = second.map(|hat| shape.dual(hat));
        let chi = second.map(|hat| shape.density(hat));
        for k in 0..2 {
            // χ and ψ are partitions of unity on all that is covered, and χ ≥ 0.
            assert!((dual[k][0] + dual[k][1] - 1.0).abs() < 1e-12 && (chi[k][0] + chi[k][1] - 1.0).abs() < 1e-12);
            assert!(chi[k].iter().all(|x| *x > -1e-12));
            weights[first + k] += integral(segment, [dual[0][k], dual[1][k]], [1.0; 2]);
            density[first + k] += integral(segment, [chi[0][k], chi[1][k]], [1.0; 2]);
        }
        hats[first] += integral(segment, [1.0 - second[0], 1.0 - second[1]], [1.0; 2]);
        hats[first + 1] += integral(segment, second, [1.0; 2]);
        if matches!(shape, DualShape::Both(_)) {
            biorthogonal[segment.slave][0] += integral(segment, [dual[0][0], dual[1][0]], second);
            biorthogonal[segment.slave][1] +=
                integral(segment, [dual[0][1], dual[1][1]], [1.0 - second[0], 1.0 - second[1]]);
        }
    }
    assert!(biorthogonal.iter().flatten().all(|x| x.abs() < rounding), "{biorthogonal:?}");
    for k in 0..slave.len() {
        let w = coupling.weight(k);
        assert!((w - weights[k]).abs() < rounding && (w - density[k]).abs() < rounding, "{k}");
    }
    check_columns(&coupling, &self::coupling(master, slave, -shift), &hats);
    check_linear_fields(&coupling, slave);
    check_multipliers(&coupling);
}

/// Rows of D and M have the weights for their sums. A uniform pressure is that of the hats of both sides: of the slave
/// `hats`, of the master those of `back`, where the roles are exchanged.
fn check_columns(coupling: &Coupling, back: &Coupling, hats: &[f64]) {
    let rounding = 1e-13;
    let mut columns = [vec![0.0; coupling.len()], vec![0.0; back.len()]];
    for k in 0..coupling.len() {
        let (first, row) = coupling.master_row(k);
        let w = coupling.weight(k);
        assert!((row.iter().sum::<f64>() - w).abs() < rounding, "{k}");
        row.iter().enumerate().for_each(|(at, value)| columns[1][first + at] += value);
        for (at, value) in coupling.slave_row(k).into_iter().enumerate().filter(|(_, value)| *value != 0.0) {
            columns[0][k + at - 1] += value;
        }
    }
    for (found, expected) in columns[0].iter().zip(hats) {
        assert!((found - expected).abs() < rounding, "{found} {expected}");
    }
    for (j, found) in columns[1].iter().enumerate() {
        let expected = back.slave_row(j)[1]
            + if j > 0 { back.slave_row(j - 1)[2] } else { 0.0 }
            + if j + 1 < back.len() { back.slave_row(j + 1)[0] } else { 0.0 };
        assert!((found - expected).abs() < rounding, "{found} {expected}");
    }
}

/// The weighted difference of one linear field on both sides is that on the nodes: 0.
fn check_linear_fields(coupling: &Coupling, slave: &Side) {
    let linear = |xi: f64| 3.0 - 2.0 * xi;
    for k in 0..coupling.len() {
        let difference =
            coupling.difference(k, |node| linear(slave.xi()[node]), |node| linear(coupling.places(0)[node]));
        assert!(difference.abs() < 1e-12, "{k}: {difference}");
    }
}

/// Multipliers come back from their forces on the slave.
fn check_multipliers(coupling: &Coupling) {
    let given: Vec<f64> =
        (0..coupling.len()).map(|k| if coupling.is_active(k) { 1.0 + (k as f64).sin() } else { 0.0 }).collect();
    let mut force = vec![0.0; coupling.len()];
    for (k, multiplier) in given.iter().enumerate() {
        for (at, part) in coupling.slave_row(k).into_iter().enumerate().filter(|(_, part)| *part != 0.0) {
            force[k + at - 1] += part * multiplier;
        }
    }
    for (k, (found, expected)) in coupling.multipliers(&force).iter().zip(&given).enumerate() {
        // Rounding of forces of order 1 over weights down to 1e-9 of the largest.
        let scale = coupling.weight(k).max(1e-300);
        assert!((found - expected).abs() * scale < 1e-13, "{k}: {found} {expected}");
    }
}

#[test]
fn matching_surfaces_are_pairs() {
    let xi = [0.0, 0.3, 0.5, 1.1, 1.15];
    let (slave, master) = (side(&xi), side(&xi.map(|x| x + 7.0)));
    let coupling = coupling(&slave, &master, 7.0);
    let lengths = [0.15, 0.25, 0.4, 0.325, 0.025];
    for k in 0..5 {
        assert!((coupling.weight(k) - lengths[k]).abs() < 1e-15);
        assert_eq!(coupling.slave_row(k)[0], 0.0);
        assert_eq!(coupling.slave_row(k)[2], 0.0);
        let (first, row) = coupling.master_row(k);
        for (at, value) in row.iter().enumerate() {
            let expected = if first + at == k { lengths[k] } else { 0.0 };
            assert!((value - expected).abs() < 1e-15, "{k}: {row:?}");
        }
        assert_eq!(coupling.acts_on(k).collect::<Vec<_>>(), [k]);
    }
}

/// A narrow master inside one edge, inside two, a narrow slave, and a master that leaves.
#[test]
fn one_side_may_be_narrower() {
    let wide = side(&[0.0, 1.0, 2.0, 3.0]);
    check(&wide, &side(&[1.2, 1.5]), 0.0);
    check(&wide, &side(&[1.6, 1.7, 1.9]), 0.0);
    check(&side(&[1.2, 1.5]), &wide, 0.0);
    check(&wide, &side(&[0.6, 0.8, 1.3]), 0.0);
    for step in 0..=50 {
        check(&wide, &side(&[0.0, 0.7, 1.4, 2.2, 3.1]), 0.07 * f64::from(step));
    }
    let apart = coupling(&wide, &side(&[0.0, 0.7, 1.4]), 1.5);
    assert!(apart.segments().is_empty() && (0..4).all(|k| !apart.is_active(k)));
}

/// A part of an edge from an end on has a multiplier for each of its ends, a short one only one: of a corner up to a
/// 16th, elsewhere up to an eighth. In the middle of an edge, half of it has two, and less the one of the nearer node.
#[test]
fn an_edge_may_be_covered_in_part() {
    let slave = side(&[-1.0, 0.0, 1.0, 2.0]);
    let on_edge = |edge: usize, from: f64, to: f64| coupling(&slave, &side(&[from, to]), 0.0).shape(edge);
    let parts = [(1, 0.6, 3.0, 0, 0.44), (1, 0.05, 3.0, 0, 1.0), (1, -2.0, 0.45, 1, 0.52), (0, -2.0, -0.9, 1, 1.0)];
    for (edge, from, to, uncovered, onset) in parts {
        let DualShape::Part(part) = on_edge(edge, from, to) else { panic!("{from} {to}") };
        assert!(part.uncovered().0 == uncovered && (part.uncovered().1 - onset).abs() < 1e-14, "{from} {to}: {part:?}");
    }
    assert_eq!(on_edge(1, -2.0, 0.12), DualShape::One(0));
    assert_eq!(on_edge(1, 0.9, 3.0), DualShape::One(1));
    assert_eq!(on_edge(0, -2.0, -0.95), DualShape::One(0));
    assert_eq!(on_edge(2, 1.95, 3.0), DualShape::One(1));
    assert!(matches!(on_edge(1, 0.2, 0.8), DualShape::Both(_)));
    assert_eq!(on_edge(1, 0.55, 0.8), DualShape::One(1));
    assert_eq!(on_edge(1, 1.5, 3.0), DualShape::None);
}

/// A node at which the slave turns away from its master by more than 40° is a corner, not one of a curve or of a notch:
/// the second multiplier sets in at once.
#[test]
fn a_slave_may_have_a_corner_inside() {
    for (eta, is_corner) in [([1.0, 0.0, 1.0], true), ([0.3, 0.0, 0.3], false), ([-1.0, 0.0, -1.0], false)] {
        let slave = Side::new(0, [vec![0.0, 1.0, 2.0], eta.to_vec()], vec![0, 1], &[0]);
        let coupling = coupling(&slave, &side(&[-1.0, 1.3]), 0.0);
        assert_eq!(coupling.binds(2), is_corner, "{eta:?}");
    }
}

/// A side of elements that are not stiff.
fn soft(xi: &[f64]) -> Side {
    side(xi).with_compliance(vec![0.1; xi.len() - 1])
}

/// The gaps of an edge of which a part is covered are those at both ends of the part once the second multiplier has set
/// in. Until then its weight grows from nothing, and the gap of the other one goes over from the mean.
#[test]
fn a_part_of_an_edge_has_the_gaps_at_its_ends() {
    let slave = soft(&[-1.0, 0.0, 1.0, 2.0]);
    for (covered, onset) in [(0.75 - 1e-9, 1.0), (0.9, 1.0), (0.125 + 1e-6, 1.6e-6), (0.3, 0.28), (0.7, 0.92)] {
        for (uncovered, [from, to]) in [(2, [-2.0, covered]), (1, [1.0 - covered, 3.0])] {
            let coupling = coupling(&slave, &soft(&[from, to]), 0.0);
            let gap = |xi: f64| 0.2 + 0.7 * xi;
            let of = |k: usize| coupling.difference(k, |k| gap(slave.xi()[k]), |_| 0.0) / coupling.weight(k);
            let (own, node) = (3 - uncovered, gap(slave.xi()[3 - uncovered]));
            let end = gap(if uncovered == 2 { covered } else { 1.0 - covered });
            // Half of the whole edge beside it, and of the part all that the multiplier of the uncovered node has not
            // taken.
            let before = (1.0 - onset) * covered;
            let sum = 0.5 * node + 0.5 * onset * covered * node + before * 0.5 * (node + end);
            let expected = sum / (0.5 + 0.5 * onset * covered + before);
            assert!(
                (of(uncovered) - end).abs() < 1e-12 && (of(own) - expected).abs() < 1e-12,
                "{covered}: {}",
                of(own)
            );
            // 1e-6 beyond the begin of the onset is known to 1e-16; its end is 1e-6 early.
            assert!((coupling.weight(uncovered) - 0.5 * onset * covered).abs() < 1e-9 * onset);
            assert_eq!([coupling.binds(uncovered), coupling.binds(own)], [onset == 1.0, true]);
        }
    }
}

/// What the conditions of an edge give way: nothing before and after the onset, and then the more the more their
/// multipliers differ; both together nothing. The softness of the master is that of its edge at the end.
#[test]
fn conditions_give_way_while_a_multiplier_sets_in() {
    let (slave, multiplier) = (soft(&[-1.0, 0.0, 1.0, 2.0]), [2.0, 3.0, 5.0, 8.0]);
    let give = |ends: [f64; 3]| {
        let master = side(&ends).with_compliance(vec![0.3, 0.7]);
        let coupling = coupling(&slave, &master, 0.0);
        [0, 1, 2, 3].map(|k| coupling.give(k, |k| multiplier[k]))
    };
    for covered in [0.05, 0.125, 0.75, 0.9] {
        assert_eq!(give([-2.0, 0.03, covered]), [0.0; 4]);
    }
    for covered in [0.2, 0.4, 0.6] {
        let onset = (covered - 0.125) / 0.625;
        let rest = 1.0 - onset;
        let expected = |soft: f64| 4.0 * onset * rest * rest * 0.5 * covered * (0.1 + soft) * 2.0;
        let to_end = (give([-2.0, 0.1, covered]), expected(0.7));
        for (found, uncovered) in [to_end, (give([1.0 - covered, 0.9, 3.0]), expected(0.3))] {
            assert!(found[0] == 0.0 && found[3] == 0.0 && found[1] == -found[2], "{covered}: {found:?}");
            assert!((found[2] - uncovered).abs() < 1e-12, "{covered}: {found:?} {uncovered}");
        }
    }
}

/// A surface in two pieces: nothing acts in the hole.
#[test]
fn a_surface_may_have_a_hole() {
    let pieces = Side::new(0, [vec![0.0, 1.0, 2.0, 3.0], vec![0.0; 4]], vec![0, 2], &[0]);
    let whole = side(&[0.0, 0.4, 0.8, 1.2, 1.6, 2.0, 2.4, 3.0]);
    for (slave, master) in [(&pieces, &whole), (&whole, &pieces)] {
        let coupling = coupling(slave, master, 0.0);
        let covered: f64 = coupling.segments().iter().map(|s| s.ends[1] - s.ends[0]).sum();
        assert!((covered - 2.0).abs() < 1e-14);
        assert!(coupling.segments().iter().all(|s| s.ends[1] <= 1.0 || s.ends[0] >= 2.0));
        check_linear_fields(&coupling, slave);
        check_multipliers(&coupling);
    }
}

/// Nodes with distances of 0.05 to 1.
fn nodes() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(0.05..1.0_f64, 1..9).prop_map(|steps| {
        let mut xi = vec![0.0];
        steps.iter().for_each(|step| xi.push(xi[xi.len() - 1] + step));
        xi
    })
}

/// A as a full matrix, from its definition.
fn dense(coupling: &Coupling, masses: [&[f64]; 2]) -> Vec<Vec<f64>> {
    let count = coupling.len();
    let mut rows = vec![vec![0.0; masses[0].len() + masses[1].len()]; count];
    for (k, row) in rows.iter_mut().enumerate() {
        let unit = |at: usize| move |node: usize| f64::from(u8::from(node == at));
        for at in 0..masses[0].len() {
            row[at] = coupling.difference(k, unit(at), |_| 0.0);
        }
        for at in 0..masses[1].len() {
            row[masses[0].len() + at] = coupling.difference(k, |_| 0.0, unit(at));
        }
    }
    let inverse: Vec<f64> = masses.concat();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).zip(&inverse).map(|((a, b), m)| a * b * m).sum::<f64>();
    (0..count).map(|k| (0..count).map(|l| product(&rows[k], &rows[l])).collect()).collect()
}

proptest! {
    #[test]
    fn any_partition(slave in nodes(), master in nodes(), part in -0.2..1.2_f64) {
        let shift = part * (slave[slave.len() - 1] + master[master.len() - 1]) - slave[slave.len() - 1];
        check(&side(&slave), &side(&master), -shift);
    }

    /// The matrix is that of its definition; the normal problem is solved; relaxation finds the same.
    #[test]
    fn the_normal_problem(
        slave in nodes(), master in nodes(), part in 0.2..0.8_f64,
        given in proptest::collection::vec(-1.0..0.5_f64, 9), light in 0.1..1.0_f64,
    ) {
        let shift = part * (slave[slave.len() - 1] + master[master.len() - 1]) - slave[slave.len() - 1];
        let coupling = coupling(&side(&slave), &side(&master), -shift);
        let inverse: [Vec<f64>; 2] = [slave.iter().map(|x| light + x.fract()).collect(), vec![1.0; master.len()]];
        let mut matrix = Band::default();
        gram(&mut matrix, &coupling, inverse.each_ref().map(|m| &m[..]), &mut Vec::new());
        let full = dense(&coupling, inverse.each_ref().map(|m| &m[..]));
        let right: Vec<[f64; 2]> = (0..slave.len()).map(|k| [given[k] * coupling.weight(k), 0.0]).collect();
        let mut problem = NormalProblem::default();
        problem.solve(&matrix, &right, |k| coupling.is_active(k));
        let mut relaxed = vec![0.0; slave.len()];
        let project = |k: usize, f: f64| if coupling.is_active(k) { f.max(0.0) } else { 0.0 };
        relax(&matrix, |k| right[k][0], &mut relaxed, 0..slave.len(), project);
        for k in (0..slave.len()).filter(|&k| coupling.is_active(k)) {
            let product: f64 = full[k].iter().zip(problem.force()).map(|(a, x)| a * x).sum();
            prop_assert!((matrix.product(k, problem.force()) - product).abs() < 1e-12 * (1.0 + product.abs()));
            let (force, residual) = (problem.force()[k], product + right[k][0]);
            prop_assert!(force >= 0.0 && residual > -1e-12 && (force == 0.0 || residual.abs() < 1e-12));
            // Both are forces of order 1 on the node.
            prop_assert!((force - relaxed[k]).abs() * coupling.weight(k) < 1e-9, "{} {}", force, relaxed[k]);
        }
    }
}

/// The matrix of two bodies side by side, of which each moves in its own way, until both have segments on the same
/// edges of the master and the second one begins before the end of the first one.
#[test]
fn the_matrix_of_two_bodies() {
    let xi = [0.0, 0.9, 1.7, 2.0, 2.1, 3.0, 4.0, 4.2];
    let slave = Side::new(0, [xi.to_vec(), vec![0.0; 8]], vec![0, 1, 2, 4, 5, 6], &[0, 4]);
    for (edges, count) in [(1.1, 5), (0.3, 16)] {
        let master = side(&(0..count).map(|k| edges * f64::from(k)).collect::<Vec<_>>());
        for shift in [0.0, -0.3, -0.7, -1.2] {
            let mut coupling = Coupling::default();
            coupling.update([&slave, &master], &[0.1, shift], ONE_PLACE);
            let inverse = [&slave, &master].map(|side| side.xi().iter().map(|xi| 1.0 + 0.3 * xi).collect::<Vec<_>>());
            let inverse = inverse.each_ref().map(|m| &m[..]);
            let mut matrix = Band::default();
            gram(&mut matrix, &coupling, inverse, &mut Vec::new());
            let full = dense(&coupling, inverse);
            for (k, row) in full.iter().enumerate() {
                for (l, value) in row.iter().enumerate() {
                    let unit: Vec<f64> = (0..slave.len()).map(|at| f64::from(u8::from(at == l))).collect();
                    // Of numbers of order 1.
                    assert!((matrix.product(k, &unit) - value).abs() < 1e-15, "{edges} {shift} {k} {l}");
                }
            }
        }
    }
}

/// The work of a step, on surfaces of 20 to 320 edges: entries of a row do not depend on the number of rows, and both
/// active sets settle in a few rounds, whatever sticks, slips and opens.
#[test]
fn the_work_is_that_of_the_nodes() {
    for count in [20_usize, 80, 320] {
        let even = |count: usize| -> Vec<f64> { (0..=count).map(|k| k as f64 / count as f64).collect() };
        let (slave, master) = (side(&even(count)), side(&even(count - count / 10)));
        let coupling = coupling(&slave, &master, 0.3 / count as f64);
        let inverse = [&slave, &master].map(|side| side.xi().iter().map(|xi| 1.0 + 0.3 * xi).collect::<Vec<_>>());
        let mut matrix = Band::default();
        gram(&mut matrix, &coupling, inverse.each_ref().map(|m| &m[..]), &mut Vec::new());
        assert!(matrix.width() <= 4);
        for waves in [0.0, 1.0, 3.0, 7.0] {
            let press = |k: usize| -1.0 - 2.0 * (waves * slave.xi()[k]).sin();
            let shear = |k: usize| 0.5 * (5.0 * slave.xi()[k] + waves).cos();
            let right: Vec<[f64; 2]> =
                (0..=count).map(|k| [press(k), shear(k)].map(|b| coupling.weight(k) * b)).collect();
            let mut normal = NormalProblem::default();
            let rounds = normal.solve(&matrix, &right, |k| coupling.is_active(k));
            assert!(rounds <= 5, "{count}, {waves}: {rounds}");
            let mut slipping = 0;
            for friction in [0.05, 0.2, 0.5] {
                let limit: Vec<f64> = normal.force().iter().map(|force| friction * force).collect();
                let mut problem = FrictionProblem::default();
                let of = (normal.pressed(), normal.sticking());
                let rounds = problem.solve(&matrix, |k| right[k][1], &limit, of);
                assert!(rounds <= 6, "{count}, {waves}, {friction}: {rounds}");
                // Relaxation, which knows nothing of sets, finds the same.
                let mut relaxed = vec![0.0; count + 1];
                let project = |k: usize, force: f64| force.clamp(-limit[k], limit[k]);
                relax(&matrix, |k| right[k][1], &mut relaxed, 0..count + 1, project);
                let largest = limit.iter().copied().fold(0.0, f64::max);
                for k in 0..=count {
                    assert!((problem.force()[k] - relaxed[k]).abs() <= 1e-11 * largest, "{count}, {k}");
                    slipping += usize::from(limit[k] > 0.0 && problem.force()[k].abs() == limit[k]);
                }
            }
            assert!(slipping > count / 4);
        }
    }
}

/// A set of rows of a band of width 3, against the product.
#[test]
fn factors_solve_a_part_of_the_matrix() {
    let mut matrix = Band::default();
    matrix.reset(12, 3);
    let width = matrix.width();
    for (row, values) in matrix.rows_mut().enumerate() {
        for apart in 0..=row.min(3) {
            values[width - apart] = if apart == 0 { 4.0 } else { 1.0 / (1 + apart) as f64 };
        }
    }
    let inside: Vec<bool> = (0..12).map(|k| ![2, 6, 7, 10].contains(&k)).collect();
    let mut factors = Factors::default();
    assert!(factors.factorise(&matrix, &inside));
    // Values outside the set do not matter.
    let mut solution: Vec<[f64; 1]> = (0..12).map(|k| [f64::from(k).cos()]).collect();
    factors.solve(&mut solution);
    let all = solution.concat();
    for k in 0..12 {
        if inside[k] {
            assert!((matrix.product(k, &all) - (k as f64).cos()).abs() < 1e-14);
        } else {
            assert_eq!(all[k], 0.0);
        }
    }
    let mut indefinite = Band::default();
    indefinite.reset(2, 1);
    let width = indefinite.width();
    indefinite
        .rows_mut()
        .zip([[0.0, 1.0], [2.0, 1.0]])
        .for_each(|(row, values)| row[width - 1..].copy_from_slice(&values));
    assert!(!factors.factorise(&indefinite, &[true; 2]));
}
