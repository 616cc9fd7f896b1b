//! Problem P_CA with the condition that the gap stays non-negative.
//!
//! The gap is linear in the knot velocities at every point of the window, so each point gives a
//! linear constraint. Only a few matter: the points where the gap is least are added as they are
//! found (an exchange method), each half step keeping one, until nothing penetrates.

use super::window::Window;
use nalgebra::{DMatrix, DVector};

/// Exchanges after which the search ends; what still penetrates shows in the residuals.
const MOST_EXCHANGES: usize = 200;

/// A point of a window at which the gap must not be negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// Which half step.
    pub(super) half_step: usize,
    /// Time since its beginning (s).
    pub(super) offset: f64,
}

/// One linear condition on the free velocities x: row · x ≥ or = bound.
struct Condition {
    row: Vec<f64>,
    bound: f64,
}

/// The velocities nearest to the wanted ones under the rendezvous and a non-negative gap.
/// `start` is the solution without the gap condition.
pub(super) fn shape(window: &Window<'_>, start: &[f64], tolerance: f64) -> Vec<f64> {
    let free = window.free_knots();
    let mut velocity = start.to_vec();
    let mut cuts: Vec<Cut> = Vec::new();
    for _ in 0..MOST_EXCHANGES {
        let path = window.integrate(&velocity);
        let mut found = false;
        for m in 0..window.lengths.len() {
            let (cut, gap) = window.least(&path, m);
            // The gap at the very ends is given.
            let given = (m == 0 && cut.offset == 0.0)
                || (window.arrives && m + 1 == window.lengths.len() && cut.offset == window.lengths[m]);
            if gap < -tolerance && !given {
                found = true;
                exchange(&mut cuts, canonical(window, cut));
            }
        }
        if !found {
            break;
        }
        let conditions: Vec<Condition> = cuts.iter().map(|cut| condition(window, cut)).collect();
        let end = window.arrives.then(|| {
            let last = window.lengths.len() - 1;
            condition(window, &Cut { half_step: last, offset: window.lengths[last] })
        });
        velocity[..free].copy_from_slice(&nearest(window, end, conditions));
    }
    velocity
}

/// A point at the end of a half step is the beginning of the next.
fn canonical(window: &Window<'_>, cut: Cut) -> Cut {
    let ends = cut.offset == window.lengths[cut.half_step];
    if ends && cut.half_step + 1 < window.lengths.len() {
        Cut { half_step: cut.half_step + 1, offset: 0.0 }
    } else {
        cut
    }
}

/// Keeps one cut strictly inside each half step and one at each knot: nearly equal ones would make
/// the system singular.
fn exchange(cuts: &mut Vec<Cut>, new: Cut) {
    let same = |old: &Cut| old.half_step == new.half_step && (old.offset == 0.0) == (new.offset == 0.0);
    match cuts.iter_mut().find(|old| same(old)) {
        Some(old) => *old = new,
        None => cuts.push(new),
    }
}

/// The gap at a cut as a linear condition: gap ≥ 0.
fn condition(window: &Window<'_>, cut: &Cut) -> Condition {
    let free = window.free_knots();
    let (gap, first) = window.start;
    let mut row = vec![0.0; free];
    let mut given = gap;
    // Velocity of knot k, counted from the first one, with a coefficient.
    let mut add = |k: usize, coefficient: f64| match k {
        0 => given += coefficient * first,
        k if k <= free => row[k - 1] += coefficient,
        _ => (),
    };
    for m in 0..cut.half_step {
        add(m, 0.5 * window.lengths[m]);
        add(m + 1, 0.5 * window.lengths[m]);
    }
    let curvature = 0.5 * cut.offset * cut.offset / window.lengths[cut.half_step];
    add(cut.half_step, cut.offset - curvature);
    add(cut.half_step + 1, curvature);
    Condition { row, bound: -given }
}

/// Minimises ½Σω(x − wanted)² under one equality and several inequalities.
///
/// Works on the multipliers, as Lawson and Hanson's non-negative least squares does: x follows
/// from them by the diagonal weights, and the system is as small as the number of conditions.
fn nearest(window: &Window<'_>, equality: Option<Condition>, inequalities: Vec<Condition>) -> Vec<f64> {
    let free = window.free_knots();
    let equal = usize::from(equality.is_some());
    let conditions: Vec<Condition> = equality.into_iter().chain(inequalities).collect();
    let count = conditions.len();
    let inverse: Vec<f64> = (0..free).map(|k| 1.0 / window.weight(k)).collect();
    let product = |a: &[f64], b: &[f64]| (0..free).map(|k| a[k] * b[k] * inverse[k]).sum::<f64>();
    let gram = DMatrix::from_fn(count, count, |i, j| product(&conditions[i].row, &conditions[j].row));
    let lacking = |c: &Condition| c.bound - c.row.iter().zip(window.wanted).map(|(a, v)| a * v).sum::<f64>();
    let lack = DVector::from_iterator(count, conditions.iter().map(lacking));

    let multipliers = non_negative(&gram, &lack, equal);
    let correction = |k: usize| (0..count).map(|i| multipliers[i] * conditions[i].row[k]).sum::<f64>() * inverse[k];
    (0..free).map(|k| window.wanted[k] + correction(k)).collect()
}

/// Multipliers λ with gram λ = lack on the active conditions, λ ≥ 0 but for the first `equal`.
fn non_negative(gram: &DMatrix<f64>, lack: &DVector<f64>, equal: usize) -> DVector<f64> {
    let count = lack.len();
    let mut active: Vec<usize> = (0..equal).collect();
    let mut current = DVector::zeros(count);
    // Each condition enters and leaves a few times at most.
    for _ in 0..10 * (count + 1) {
        loop {
            let solution = solve_active(gram, lack, &active);
            let blocking = active.iter().filter(|&&i| i >= equal && solution[i] <= 0.0);
            let step = blocking.map(|&i| current[i] / (current[i] - solution[i])).fold(1.0_f64, f64::min);
            if step >= 1.0 {
                current = solution;
                break;
            }
            current += step * (solution - &current);
            let least = current.amax() * 1e-14;
            active.retain(|&i| i < equal || current[i] > least);
            (equal..count).filter(|i| !active.contains(i)).for_each(|i| current[i] = 0.0);
        }
        let missing = lack - gram * &current;
        let scale = 1e-13 * lack.amax();
        let next = (equal..count).filter(|i| !active.contains(i) && missing[*i] > scale);
        let Some(next) = next.max_by(|&a, &b| missing[a].total_cmp(&missing[b])) else { break };
        active.push(next);
    }
    current
}

/// Solves the system of the active conditions; the others' multipliers are zero.
fn solve_active(gram: &DMatrix<f64>, lack: &DVector<f64>, active: &[usize]) -> DVector<f64> {
    let mut all = DVector::zeros(lack.len());
    let size = active.len();
    // Scaled to a unit diagonal: rows differ by orders of magnitude in time.
    let scale = |i: usize| 1.0 / gram[(i, i)].sqrt();
    let matrix =
        DMatrix::from_fn(size, size, |i, j| gram[(active[i], active[j])] * scale(active[i]) * scale(active[j]));
    let right = DVector::from_fn(size, |i, _| lack[active[i]] * scale(active[i]));
    if let Some(solution) = matrix.full_piv_lu().solve(&right) {
        active.iter().zip(solution.iter()).for_each(|(&i, x)| all[i] = x * scale(i));
    }
    all
}
