//! The start of a history against the initial state of its problem, and its end against the same.

use super::attempt::FALL;
use super::balance::{Balance, Motion, dot, norm, rate};
use super::figures::Consistency;
use super::limits::PLACE;
use super::window::{Window, rows_of, vectors_of};
use super::{ratio, widest};
use crate::message::{trimmed, vector};
use percute_core::border::{Vector, row};
use percute_core::problem::AnyProblem;

/// Offsets that differ by less than this share are the same: digits of single precision, on the way of many steps.
const RIGID: f64 = 1e-3;

/// What start and end say.
#[derive(Clone, Debug)]
pub(super) struct Ends {
    /// Velocity of the first step without its forces, over v₀, at nodes without contact force: the best factor; none if
    /// none of them moves.
    pub(super) speed: Option<f64>,
    /// Means over these nodes, of v₀ as it is given over all: of that velocity, and of the stated v₀ (m/s).
    pub(super) start: [Vector; 2],
    /// The factor of the stated v₀ that gives the velocity at the start, as it is given, else as above; none if the
    /// two have different directions.
    pub(super) multiple: Option<f64>,
    /// Difference of −v of the last step from v₀, over the norm of v₀; largest difference of u_N from u_0, over the
    /// size.
    pub(super) reversed: [f64; 2],
    /// Largest difference of u_0 less the places of the nodes from that of the problem, over the size.
    pub(super) places: f64,
    /// u_0 less that of the problem (m).
    pub(super) offset: Vec<Vector>,
}

impl Ends {
    pub(super) fn new() -> Self {
        Self {
            speed: None,
            start: [[0.0; 3]; 2],
            multiple: None,
            reversed: [0.0; 2],
            places: f64::INFINITY,
            offset: Vec::new(),
        }
    }

    /// Compares the state at t_0 with that of the problem; `reaction` is R_0 at all nodes (N), and
    /// follows from the balance at those that are `open`.
    pub(super) fn start(
        &mut self,
        (balance, window): (&Balance<'_>, Window<'_>),
        motion: &Motion,
        (reaction, open): (&[Vector], &dyn Fn(usize) -> bool),
        found: &mut Consistency,
    ) {
        let (problem, now) = (balance.problem(), window.now);
        let moved = widest(now.step().displacement, problem.initial_displacement());
        found.initial_displacement = moved[0] / problem.mesh().size();
        let less = |(a, b): (&Vector, &Vector)| std::array::from_fn(|c| a[c] - b[c]);
        let d = problem.dimension();
        self.offset = now.displacement.iter().zip(&vectors_of(problem.initial_displacement(), d)).map(less).collect();
        self.places = widest(&rows_of(&self.offset, d), problem.mesh().points())[0] / problem.mesh().size();
        let (terms, h) = (balance.terms(now, &motion.forward), balance.times().velocity_step(0));
        let without = |(node, v): (usize, &Vector)| {
            let change = |c: usize| terms.load[node][c] - terms.stiffness[node][c] + reaction[node][c];
            std::array::from_fn(|c| v[c] - h / problem.mass()[node] * change(c))
        };
        let derived = supported(problem, motion.forward.iter().enumerate().map(without).collect());
        let given = now.velocity.clone().map(|given| supported(problem, given));
        let stated = &vectors_of(problem.initial_velocity(), d)[..];
        let quiet = |node: usize| !open(node) && reaction[node] == [0.0; 3];
        self.speed = factor(&derived, stated, quiet);
        let started = given.clone().unwrap_or(derived);
        // At a node with a contact force, the velocity without forces depends on its mass.
        let counts = |node: usize| given.is_some() || quiet(node);
        self.multiple = multiple(&started, stated, counts);
        let pairs =
            (0..stated.len()).filter(|node| counts(*node)).flat_map(|node| started[node].into_iter().zip(stated[node]));
        let [difference, most] = pairs.fold([0.0_f64; 2], |[d, m], (v, v0)| [d.max((v - v0).abs()), m.max(v.abs())]);
        let largest = stated.iter().flatten().fold(most, |most, v| most.max(v.abs()));
        found.initial_velocity = ratio(difference, largest);
        let quiet: Vec<usize> = (0..stated.len()).filter(|node| counts(*node)).collect();
        self.start = [&started[..], stated].map(|field| mean(field, &quiet));
    }

    /// Compares the end with the start, as in a history that runs backwards.
    pub(super) fn end(&mut self, balance: &Balance<'_>, window: Window<'_>) {
        let (Some(before), problem) = (window.before, balance.problem()) else { return };
        let back = rate(&window.now.displacement, &before.displacement, balance.times().step(window.now.index - 1));
        let speed = apart(&rows_of(&back, problem.dimension()), problem.initial_velocity());
        let [place, _] = widest(window.now.step().displacement, problem.initial_displacement());
        self.reversed = [speed, place / problem.mesh().size()];
    }
}

impl Ends {
    /// That the displacements are those of the problem, shifted by the same everywhere.
    pub(super) fn shift(&self, problem: &AnyProblem) -> Option<String> {
        let first = *self.offset.first()?;
        let size = norm(&first);
        let apart = self.offset.iter().flat_map(|u| u.iter().zip(first).map(|(a, b)| (a - b).abs()));
        if size <= PLACE * problem.mesh().size() || apart.fold(0.0, f64::max) > RIGID * size {
            return None;
        }
        let axes: Vec<&str> = (0..3).filter(|&c| first[c].abs() > RIGID * size).map(|c| ["x", "y", "z"][c]).collect();
        let (along, shift) = (axes.join(" and "), vector(&first[..problem.dimension()], 6));
        let subtract =
            format!("all displacements have the same offset of {shift} m, along {along}: subtract it from all");
        let velocity = row(problem.initial_velocity(), 0, problem.dimension());
        let time = dot(&first, &velocity) / dot(&velocity, &velocity);
        let way = first.iter().zip(velocity).map(|(u, v)| (u - time * v).abs()).fold(0.0, f64::max);
        Some(if time > 0.0 && way <= RIGID * size {
            format!(
                "{subtract}, if their origin is another one; or the start is missing: it is the way of {} s at the \
                     initial velocity, give the history from t_0 on",
                trimmed(time, 4)
            )
        } else {
            subtract
        })
    }
}

/// Whether the last two instants, dt (s) apart, have the initial velocity (m/s) of a history that runs backwards, but
/// for nodes that touch in its first step.
pub(crate) fn runs_backwards(last: [&[f64]; 2], dt: f64, velocity: &[f64]) -> bool {
    let back: Vec<f64> = last[1].iter().zip(last[0]).map(|(a, b)| (b - a) / dt).collect();
    apart(&back, velocity) <= FALL
}

/// The norm of the difference of two fields over that of the second.
fn apart(field: &[f64], stated: &[f64]) -> f64 {
    let squares = field.iter().zip(stated).fold([0.0; 2], |[difference, own], (v, v0)| {
        let rest: f64 = v - v0;
        [difference + rest * rest, own + v0 * v0]
    });
    ratio(squares[0], squares[1]).sqrt()
}

/// The velocity with prescribed components as stated.
fn supported(problem: &AnyProblem, mut velocity: Vec<Vector>) -> Vec<Vector> {
    for p in problem.prescribed() {
        let (node, c) = (p.node.index(), p.component);
        velocity[node][c] = problem.initial_velocity()[problem.dimension() * node + c];
    }
    velocity
}

/// The factor of the second field that fits the first best at some nodes; none if it is zero there.
fn factor(field: &[Vector], stated: &[Vector], at: impl Fn(usize) -> bool) -> Option<f64> {
    let nodes = (0..field.len()).filter(|&node| at(node));
    let (along, own) = nodes.fold((0.0, 0.0), |(along, own), node| {
        let v0 = &stated[node];
        (along + dot(&field[node], v0), own + dot(v0, v0))
    });
    (own > 0.0).then(|| along / own)
}

/// That factor, if it leaves little of the difference of the fields.
fn multiple(field: &[Vector], stated: &[Vector], at: impl Fn(usize) -> bool) -> Option<f64> {
    let factor = factor(field, stated, &at)?;
    let nodes: Vec<usize> = (0..field.len()).filter(|&node| at(node)).collect();
    let apart = |factor: f64| -> f64 {
        let pairs = nodes.iter().flat_map(|&node| field[node].into_iter().zip(stated[node]));
        pairs.map(|(v, v0)| (v - factor * v0).powi(2)).sum::<f64>().sqrt()
    };
    (apart(factor) <= FALL * apart(1.0)).then_some(factor)
}

fn mean(field: &[Vector], nodes: &[usize]) -> Vector {
    std::array::from_fn(|c| nodes.iter().map(|&node| field[node][c]).sum::<f64>() / nodes.len().max(1) as f64)
}
