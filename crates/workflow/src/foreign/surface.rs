//! Contact forces against those that the balance needs at the surface: the order of their rows, their normal and
//! tangential parts, their axes.

use super::attempt::Attempt;
use super::axes::{READINGS, read};
use super::balance::{Balance, dot};
use super::diagnosis::Diagnosis;
use super::interface_balance::groups;
use super::window::windows;
use crate::message::times;
use percute_core::border::Vector;
use percute_core::history::SinkError;
use percute_core::problem::AnyProblem;

/// On larger surfaces, orders of the rows are not searched: their products take too much memory.
const MOST: usize = 2000;
/// Parts of the forces below this share of those that the balance needs are none (squares).
const NONE: f64 = 1e-6;
/// Rows that are named.
const NAMED: usize = 4;

/// Sums over all instants, of squares and scalar products of given and needed forces (N²).
struct NeededForces {
    count: usize,
    given: Vec<f64>,
    needed: Vec<f64>,
    /// Of the given force of a row with the needed one of another.
    both: Vec<f64>,
    /// Of the tangential and the normal parts under given forces: given, needed, and their product.
    parts: [[f64; 3]; 2],
    /// Of given forces with needed ones, read in other axes.
    read: [f64; READINGS.len()],
}

impl NeededForces {
    /// The square of what rows leave that hold the forces of these others.
    fn left(&self, of: &[usize]) -> f64 {
        let product = |(row, &at): (usize, &usize)| self.both[row * self.count + at];
        self.without(of.iter().enumerate().map(product).sum())
    }

    /// The square of what forces leave that have this product with the needed ones.
    fn without(&self, product: f64) -> f64 {
        self.given.iter().sum::<f64>() + self.needed.iter().sum::<f64>() - 2.0 * product
    }

    /// The rows whose needed forces are nearest to the given ones, each once.
    fn nearest(&self) -> Vec<usize> {
        let mut rows: Vec<usize> = (0..self.count).collect();
        rows.sort_by(|&a, &b| self.given[b].total_cmp(&self.given[a]));
        let (mut of, mut free) = (vec![0; self.count], vec![true; self.count]);
        for row in rows {
            let far = |at: usize| self.needed[at] - 2.0 * self.both[row * self.count + at];
            let near = (0..self.count).filter(|&at| free[at]).min_by(|&a, &b| far(a).total_cmp(&far(b)));
            let at = near.unwrap_or(row);
            (of[row], free[at]) = (at, false);
        }
        of
    }
}

/// Other orders of the rows of contact forces, other normal and tangential parts, and other axes.
pub(super) fn attempt(diagnosis: &Diagnosis<'_>) -> Result<Vec<Attempt>, SinkError> {
    let count = diagnosis.problem.contact_nodes().len();
    if count > MOST || !diagnosis.has_forces() {
        return Ok(Vec::new());
    }
    let needed = needed(diagnosis)?;
    let [rest, size] = diagnosis.evidence.residual.squares();
    let own = needed.left(&(0..count).collect::<Vec<_>>());
    let attempt = |text: String, left: f64| Attempt {
        text,
        before: diagnosis.residual(),
        left: ((rest - own + left).max(0.0) / size).sqrt(),
    };
    let nodes: Vec<usize> = diagnosis.problem.contact_nodes().iter().map(|contact| contact.node.index()).collect();
    let parts = sides(diagnosis.problem, &needed).into_iter().chain(Part::of_each().into_iter().zip(needed.parts));
    let parts = parts.filter_map(|(part, products)| part.attempt(products, own));
    let mut all: Vec<Attempt> = parts.map(|(text, left)| attempt(text, left)).collect();
    all.extend(READINGS.iter().zip(needed.read).map(|(text, both)| attempt(text.to_string(), needed.without(both))));
    all.extend(known(&nodes).into_iter().map(|(text, of)| attempt(text, needed.left(&of))));
    let of = needed.nearest();
    let moved = (0..count).filter(|&row| of[row] != row && needed.given[row] > 0.0).take(NAMED);
    let told: Vec<_> =
        moved.map(|row| format!("that of node {} holds the force of node {}", nodes[row], nodes[of[row]])).collect();
    if !told.is_empty() {
        let text =
            format!("the rows of the contact forces are in another order than `contact_nodes`: {}", told.join(", "));
        all.push(attempt(text, needed.left(&of)));
    }
    Ok(all)
}

/// Orders that other programs have: for each row, the row whose force it holds.
fn known(nodes: &[usize]) -> Vec<(String, Vec<usize>)> {
    let mut ascending: Vec<usize> = (0..nodes.len()).collect();
    ascending.sort_by_key(|&at| nodes[at]);
    let descending: Vec<usize> = ascending.iter().rev().copied().collect();
    let opposite: Vec<usize> = (0..nodes.len()).rev().collect();
    let told = [
        ("in ascending order of the nodes", "numpy.sort(problem.contact_nodes)", ascending),
        ("in descending order of the nodes", "numpy.sort(problem.contact_nodes)[::-1]", descending),
        ("in the opposite order", "problem.contact_nodes[::-1]", opposite),
    ];
    let text = |order: &str, give: &str| {
        format!("the rows of the contact forces are {order}, not in that of `contact_nodes`: give contact_nodes={give}")
    };
    let own: Vec<usize> = (0..nodes.len()).collect();
    told.into_iter().filter(|told| told.2 != own).map(|(order, give, of)| (text(order, give), of)).collect()
}

/// A part of the contact forces, for messages.
struct Part {
    /// What they are.
    forces: String,
    /// What to do if there are none.
    none: String,
    /// What is right if they have the wrong sign.
    sign: &'static str,
}

impl Part {
    /// The tangential and the normal parts.
    fn of_each() -> [Self; 2] {
        let part = |name: &str, sign| Self {
            forces: format!("the {name} contact forces"),
            none: format!("the contact forces have no {name} parts: give pressure and friction together"),
            sign,
        };
        [
            part("tangential", "they act on the body, against its sliding"),
            part("normal", "they push the body off the planes"),
        ]
    }

    /// The forces on one side of a non-matching interface.
    fn on(group: &str) -> Self {
        let give = "give the force on each node of both surfaces, as it acts on that node";
        let forces = format!("the contact forces on {group}");
        Self { none: format!("{forces} are missing: {give}"), forces, sign: give }
    }

    /// Forces whose part is left out, or needs a factor, with the square of what is left.
    fn attempt(&self, [given, wanted, both]: [f64; 3], own: f64) -> Option<(String, f64)> {
        let (Self { forces, none, sign }, misfit) = (self, given + wanted - 2.0 * both);
        if misfit <= 0.0 {
            return None;
        }
        if given <= NONE * wanted {
            return Some((none.clone(), own - misfit));
        }
        let factor = both / given;
        let text = if (factor + 1.0).abs() < 0.02 {
            format!("{forces} have the wrong sign: {sign}")
        } else {
            format!("{forces} should be {} as large", times(factor))
        };
        Some((text, own - misfit + (wanted - factor * both)))
    }
}

/// The forces on each side of a non-matching interface, with their sums: given, needed, and their product.
fn sides(problem: &AnyProblem, needed: &NeededForces) -> Vec<(Part, [f64; 3])> {
    let of_side = |(group, side): (&String, &Vec<usize>)| {
        let sums = side.iter().fold([0.0; 3], |[given, wanted, both], &row| {
            let product = needed.both[row * needed.count + row];
            [given + needed.given[row], wanted + needed.needed[row], both + product]
        });
        (Part::on(group), sums)
    };
    let of_both = |non_matching: usize| {
        let (groups, sides) = (groups(problem, non_matching), problem.sides_of_non_matching(non_matching));
        [(&groups[0], &sides[0]), (&groups[1], &sides[1])].map(of_side)
    };
    (0..problem.non_matching_count()).flat_map(of_both).collect()
}

fn needed(diagnosis: &Diagnosis<'_>) -> Result<NeededForces, SinkError> {
    let problem = diagnosis.problem;
    let balance = Balance::new(problem, diagnosis.source.times());
    let count = problem.contact_nodes().len();
    let mut sums = NeededForces {
        count,
        given: vec![0.0; count],
        needed: vec![0.0; count],
        both: vec![0.0; count * count],
        parts: [[0.0; 3]; 2],
        read: [0.0; READINGS.len()],
    };
    windows(diagnosis.source, problem.dimension(), &mut |window| {
        let now = window.now;
        let derived = if now.index > 0 { balance.motion(window).map(|motion| motion.acceleration) } else { None };
        let Some(used) = now.acceleration.as_ref().or(derived.as_ref()) else { return Ok(()) };
        let terms = balance.terms(now, used);
        let needed: Vec<Vector> =
            problem.contact_nodes().iter().map(|contact| terms.rest(contact.node.index())).collect();
        for (row, force) in now.reaction.iter().enumerate() {
            sums.needed[row] += dot(&needed[row], &needed[row]);
            if *force == [0.0; 3] {
                continue;
            }
            sums.given[row] += dot(force, force);
            for (at, other) in needed.iter().enumerate() {
                sums.both[row * count + at] += dot(force, other);
            }
            let frame = problem.frame(row);
            let ((pressed, own), (pressing, wanted)) = (frame.split(force), frame.split(&needed[row]));
            let products = [
                [dot(&own, &own), dot(&wanted, &wanted), dot(&own, &wanted)],
                [pressed * pressed, pressing * pressing, pressed * pressing],
            ];
            let parts = sums.parts.as_flattened_mut().iter_mut().zip(products.as_flattened());
            parts.for_each(|(sum, product)| *sum += product);
            let read = read(force, frame.normal(), problem.dimension());
            sums.read.iter_mut().zip(&read).for_each(|(sum, read)| *sum += dot(read, &needed[row]));
        }
        Ok(())
    })?;
    Ok(sums)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_find_the_forces_that_they_hold() {
        // Row 0 holds what row 2 needs, row 1 nothing, row 2 what row 0 needs: 3 and 5.
        let both = vec![0.0, 0.0, 25.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0];
        let (given, wanted) = (vec![25.0, 0.0, 9.0], vec![9.0, 0.0, 25.0]);
        let (parts, read) = ([[0.0; 3]; 2], [0.0; READINGS.len()]);
        let needed = NeededForces { count: 3, given, needed: wanted, both, parts, read };
        assert_eq!(needed.nearest(), [2, 1, 0]);
        assert_eq!(needed.left(&[2, 1, 0]), 0.0);
        assert_eq!(needed.left(&[0, 1, 2]), 68.0);
        assert_eq!(known(&[4, 9, 7]).len(), 3);
        assert_eq!(known(&[4, 9, 7])[0].1, [0, 2, 1]);
    }
}
