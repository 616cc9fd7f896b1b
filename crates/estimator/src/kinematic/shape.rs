//! Problem P_CA with the condition that the gap stays non-negative.
//!
//! The gap is linear in the velocities at the half-step instants, at every point of the window, so each point gives a
//! linear constraint. Only a few matter: the points where the gap is least are added as they are
//! found (an exchange method) and dropped when they are no longer active, until nothing penetrates. The
//! distance from the target velocities grows with every exchange, so that none comes back.

use super::window::{Cut, FlightWindow, Path};
use nalgebra::{DMatrix, DVector};

/// Exchanges after which the search ends; a penetration that is left shows in the residuals.
const MOST_EXCHANGES: usize = 200;

/// Cuts nearer to each other than this fraction of a half step are one. The parabola between two
/// such cuts is deeper than at them by 1e-13 of its height, and their rows differ by enough digits.
const SAME_CUT: f64 = 1e-6;

/// One linear condition on the free velocities x: row · x ≥ or = bound.
struct Condition {
    row: Vec<f64>,
    bound: f64,
}

#[cfg(test)]
thread_local! {
    /// How many windows this thread has solved here, so that tests can tell whether any were.
    static SHAPED: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// The motion over a window: the velocity nearest to the target that respects the onset and does not penetrate by more
/// than `tolerance` (m).
pub(super) fn solve(window: &FlightWindow<'_>, tolerance: f64) -> Path {
    let velocity = window.shifted();
    let path = window.integrate(&velocity);
    if window.deepest(&path).1 >= -tolerance {
        return path;
    }
    window.integrate(&shape(window, &velocity, 0.1 * tolerance))
}

/// The velocities nearest to the targets under the onset and a non-negative gap.
/// `start` is the solution without the gap condition.
fn shape(window: &FlightWindow<'_>, start: &[f64], tolerance: f64) -> Vec<f64> {
    #[cfg(test)]
    SHAPED.set(SHAPED.get() + 1);
    let free = window.free_instants();
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
                add(&mut cuts, canonical(window, cut), SAME_CUT * window.lengths[m]);
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
        let (found, active) = nearest(window, end, conditions);
        velocity[..free].copy_from_slice(&found);
        let mut active = active.into_iter();
        cuts.retain(|_| active.next() == Some(true));
    }
    velocity
}

/// A point at the end of a half step is the beginning of the next.
fn canonical(window: &FlightWindow<'_>, cut: Cut) -> Cut {
    let ends = cut.offset == window.lengths[cut.half_step];
    if ends && cut.half_step + 1 < window.lengths.len() {
        Cut { half_step: cut.half_step + 1, offset: 0.0 }
    } else {
        cut
    }
}

/// Adds a cut, or moves one that is nearly the same: rows that are nearly equal would make the system
/// singular.
fn add(cuts: &mut Vec<Cut>, new: Cut, apart: f64) {
    let same = |old: &Cut| {
        old.half_step == new.half_step
            && (old.offset == 0.0) == (new.offset == 0.0)
            && (old.offset - new.offset).abs() < apart
    };
    match cuts.iter_mut().find(|old| same(old)) {
        Some(old) => *old = new,
        None => cuts.push(new),
    }
}

/// The gap at a cut as a linear condition: gap ≥ 0.
fn condition(window: &FlightWindow<'_>, cut: &Cut) -> Condition {
    let free = window.free_instants();
    let (gap, first) = window.start;
    let mut row = vec![0.0; free];
    let mut given = gap;
    // Velocity of instant k, counted from the first one, with a coefficient.
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

/// Minimises ½Σω(x − target)² under one equality and several inequalities; returns which of these are active too.
///
/// Works on the multipliers, as Lawson and Hanson's non-negative least squares does: x follows from
/// them by the diagonal weights, and the system is as small as the number of conditions.
fn nearest(
    window: &FlightWindow<'_>,
    equality: Option<Condition>,
    inequalities: Vec<Condition>,
) -> (Vec<f64>, Vec<bool>) {
    let free = window.free_instants();
    let equal = usize::from(equality.is_some());
    let conditions: Vec<Condition> = equality.into_iter().chain(inequalities).collect();
    let count = conditions.len();
    // In y = √ω (x − target) the norm is that of Euclid. Each condition is scaled to a unit row:
    // they differ by orders of magnitude in time.
    let root: Vec<f64> = (0..free).map(|k| window.weight(k).sqrt()).collect();
    let mut columns = DMatrix::from_fn(free, count, |k, i| conditions[i].row[k] / root[k]);
    let lacking = |c: &Condition| c.bound - c.row.iter().zip(window.target).map(|(a, v)| a * v).sum::<f64>();
    let mut lack = DVector::from_iterator(count, conditions.iter().map(lacking));
    for i in 0..count {
        let norm = columns.column(i).norm().max(f64::MIN_POSITIVE);
        columns.column_mut(i).unscale_mut(norm);
        lack[i] /= norm;
    }
    let multipliers = non_negative(&columns, &lack, equal);
    let y = &columns * &multipliers;
    let found = (0..free).map(|k| window.target[k] + y[k] / root[k]).collect();
    (found, multipliers.iter().skip(equal).map(|m| *m > 0.0).collect())
}

/// Multipliers λ with Cᵀ C λ = lack on the active conditions, the columns of C, and λ ≥ 0 but for the
/// first `equal`.
fn non_negative(columns: &DMatrix<f64>, lack: &DVector<f64>, equal: usize) -> DVector<f64> {
    let count = lack.len();
    let mut active: Vec<usize> = (0..equal).collect();
    let mut current = solve_active(columns, lack, &active);
    // Conditions that rounding alone calls missing.
    let mut refused: Vec<usize> = Vec::new();
    // Each condition enters and leaves a few times at most.
    for _ in 0..10 * (count + 1) {
        let missing = lack - columns.tr_mul(&(columns * &current));
        let scale = 1e-15 * lack.amax();
        let candidates = (equal..count).filter(|i| !active.contains(i) && !refused.contains(i) && missing[*i] > scale);
        let Some(next) = candidates.max_by(|&a, &b| missing[a].total_cmp(&missing[b])) else { break };
        active.push(next);
        if solve_active(columns, lack, &active)[next] <= 0.0 {
            active.pop();
            refused.push(next);
            continue;
        }
        refused.clear();
        current = descend(columns, lack, &mut active, current, equal);
    }
    current
}

/// Goes from the multipliers `current` towards those of the active conditions and drops the ones that
/// turn negative on the way.
fn descend(
    columns: &DMatrix<f64>,
    lack: &DVector<f64>,
    active: &mut Vec<usize>,
    mut current: DVector<f64>,
    equal: usize,
) -> DVector<f64> {
    loop {
        let solution = solve_active(columns, lack, active);
        let crossing = |i: usize| current[i] / (current[i] - solution[i]);
        let blocking = active.iter().copied().filter(|&i| i >= equal && solution[i] <= 0.0);
        let Some(first) = blocking.min_by(|&a, &b| crossing(a).total_cmp(&crossing(b))) else { return solution };
        current += crossing(first) * (&solution - &current);
        current[first] = 0.0;
        active.retain(|&i| i < equal || current[i] > 0.0);
    }
}

/// The multipliers of the active conditions; the others' are zero. By orthogonal factors, for cuts of
/// one half step may have nearly parallel columns.
fn solve_active(columns: &DMatrix<f64>, lack: &DVector<f64>, active: &[usize]) -> DVector<f64> {
    let mut all = DVector::zeros(lack.len());
    if active.is_empty() || active.len() > columns.nrows() {
        return all;
    }
    let triangle = columns.select_columns(active).qr().unpack_r();
    let right = lack.select_rows(active);
    let solution = triangle.tr_solve_upper_triangular(&right).and_then(|z| triangle.solve_upper_triangular(&z));
    if let Some(solution) = solution {
        active.iter().zip(solution.iter()).for_each(|(&i, x)| all[i] = *x);
    }
    all
}

#[cfg(test)]
mod tests;
