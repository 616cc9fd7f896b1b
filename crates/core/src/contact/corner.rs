//! A node at two planes at once: the reactions of both, with Coulomb friction on each.
//!
//! The normal problem of one plane depends on the friction on the other. There are few cases, each with a closed form:
//! either plane alone, or both, where each part slides or sticks. Parts that stick are not unique; those with the least
//! friction are. They depend on the sum of both alone, and not on the order of the planes.
//!
//! In a solid both planes meet along an edge. Across it, all is as in the plane of both normals. Along it, friction
//! stops the node as far as what the cones have left allows.

use super::constraint::Constraint;
use super::frame::dot;

/// Such a part of the force is rounding.
const ROUNDING: f64 = 1e-12;
/// Rounds of [`in_turn`] at the most: with an opening of 165° each leaves about 0.93 of the misfit.
const ROUNDS: usize = 500;

/// The reactions (N) of the two constraints of a node, of which the step violates at least one, for a step of these
/// Δt_n and h_n (s). Gaps within the tolerance (m) are none.
pub(super) fn reactions<const D: usize>(pair: &[Constraint<D>; 2], steps: [f64; 2], tolerance: f64) -> [[f64; D]; 2] {
    let [dt, h] = steps;
    let (mut open, mut closed) = (Vec::new(), Vec::new());
    for i in (0..2).filter(|&i| pair[i].gap < -tolerance) {
        let force = pair[i].alone(steps);
        let other = &pair[1 - i];
        let gap = other.gap + dt * h / other.mass * dot(&force, other.frame.normal());
        let mut both = [[0.0; D]; 2];
        both[i] = force;
        if gap > tolerance {
            open.push(both);
        } else if gap >= -tolerance {
            closed.push(both);
        }
    }
    if let Some(found) = least(open) {
        return found;
    }
    let (violation, parts) = together(pair, steps, tolerance);
    if violation == 0.0 {
        return parts;
    }
    // Across the edge, friction of a node that slides along it is less than in the plane of the normals.
    least(closed).unwrap_or_else(|| if D == 3 { in_turn(pair, steps) } else { parts })
}

/// Each reaction in turn for that of the other plane, until both stay.
fn in_turn<const D: usize>(pair: &[Constraint<D>; 2], steps: [f64; 2]) -> [[f64; D]; 2] {
    let [dt, h] = steps;
    let mut forces = [[0.0; D]; 2];
    for _ in 0..ROUNDS {
        let before = forces;
        for i in 0..2 {
            let other = &forces[1 - i];
            let mut one = pair[i];
            one.gap += dt * h / one.mass * dot(other, one.frame.normal());
            (0..D).for_each(|c| one.velocity[c] += h / one.mass * other[c]);
            forces[i] = if one.gap < 0.0 { one.alone(steps) } else { [0.0; D] };
        }
        let [changes, sizes] = [true, false].map(|change| {
            let difference = |(now, before): (&f64, &f64)| if change { (now - before).abs() } else { now.abs() };
            forces.as_flattened().iter().zip(before.as_flattened()).map(difference).fold(0.0, f64::max)
        });
        if changes <= ROUNDING * sizes {
            break;
        }
    }
    forces
}

/// The reactions with the least squares.
fn least<const D: usize>(all: Vec<[[f64; D]; 2]>) -> Option<[[f64; D]; 2]> {
    let square = |both: &[[f64; D]; 2]| both.as_flattened().iter().map(|f| f * f).sum::<f64>();
    all.into_iter().min_by(|a, b| square(a).total_cmp(&square(b)))
}

/// A part of the force in the corner: n λ + t τ, with τ = ∓μλ while it slides.
#[derive(Clone, Copy)]
struct ForcePart {
    normal: [f64; 2],
    tangent: [f64; 2],
    friction: f64,
    /// −1, 0 or 1: against the direction in which it slides.
    sliding: f64,
}

impl ForcePart {
    /// The force of λ = 1 without a sticking part.
    fn unit(&self) -> [f64; 2] {
        [0, 1].map(|c| self.normal[c] + self.sliding * self.friction * self.tangent[c])
    }

    /// The force of λ and of a sticking part.
    fn force(&self, normal: f64, sticking: f64) -> [f64; 2] {
        let unit = self.unit();
        [0, 1].map(|c| normal * unit[c] + sticking * self.tangent[c])
    }
}

/// The reactions that bring the node to both planes, and by how much they violate the cones, over their sum.
fn together<const D: usize>(pair: &[Constraint<D>; 2], [dt, h]: [f64; 2], tolerance: f64) -> (f64, [[f64; D]; 2]) {
    let across = Across::new(pair.each_ref().map(|one| one.frame.normal()));
    let normals = pair.each_ref().map(|one| across.planar(one.frame.normal()));
    // The change of velocity that closes both gaps.
    let change =
        solve([[normals[0][0], normals[1][0]], [normals[0][1], normals[1][1]]], [0, 1].map(|i| -pair[i].gap / dt));
    let velocity = across.planar(&pair[0].velocity);
    let after = [0, 1].map(|c| velocity[c] + change[c]);
    let total = change.map(|v| pair[0].mass * v / h);
    let parts = [0, 1].map(|i| {
        let (normal, friction) = (normals[i], pair[i].law.friction());
        let tangent = [normal[1], -normal[0]];
        let along = tangent[0] * after[0] + tangent[1] * after[1];
        let sliding = if along.abs() * dt > tolerance { -along.signum() } else { 0.0 };
        ForcePart { normal, tangent, friction, sliding }
    });
    let size = total[0].hypot(total[1]);
    let (violation, [first, second]) = split(&parts, total);
    // A part of rounding is none: it decides on the status.
    let forces = match [first, second].map(|[normal, _]| normal <= ROUNDING * size) {
        [false, false] => [0, 1].map(|i| parts[i].force([first, second][i][0], [first, second][i][1])),
        [true, _] => [[0.0; 2], total],
        [_, true] => [total, [0.0; 2]],
    };
    let along = across.friction_along(&parts, &forces, pair[0].mass / h, &pair[0].velocity);
    (violation, [0, 1].map(|i| across.in_space(&forces[i], along[i])))
}

/// The plane of two normals, and the direction across it.
struct Across<const D: usize> {
    axes: [[f64; D]; 2],
    edge: Option<[f64; D]>,
}

impl<const D: usize> Across<D> {
    /// In a plane body that of the body.
    fn new([one, two]: [&[f64; D]; 2]) -> Self {
        if D < 3 {
            return Self { axes: [0, 1].map(|k| std::array::from_fn(|c| f64::from(u8::from(c == k)))), edge: None };
        }
        let along = dot(one, two);
        let rest: [f64; D] = std::array::from_fn(|c| two[c] - along * one[c]);
        let length = dot(&rest, &rest).sqrt();
        let second = rest.map(|x| x / length);
        let next = |c: usize, by: usize| (c + by) % D;
        let edge = std::array::from_fn(|c| one[next(c, 1)] * second[next(c, 2)] - one[next(c, 2)] * second[next(c, 1)]);
        Self { axes: [*one, second], edge: Some(edge) }
    }

    fn planar(&self, vector: &[f64; D]) -> [f64; 2] {
        if self.edge.is_some() {
            return self.axes.each_ref().map(|axis| dot(axis, vector));
        }
        [0, 1].map(|c| vector.get(c).copied().unwrap_or(0.0))
    }

    /// The forces of both parts along the edge (N) that stop a node of this mass over h (kg/s) there, or slow it down
    /// as far as the cones of parts with these forces allow, in proportion to what each has left.
    fn friction_along(
        &self,
        parts: &[ForcePart; 2],
        forces: &[[f64; 2]; 2],
        rate: f64,
        velocity: &[f64; D],
    ) -> [f64; 2] {
        let Some(edge) = &self.edge else { return [0.0; 2] };
        let left = [0, 1].map(|i| {
            let [normal, aside] = [&parts[i].normal, &parts[i].tangent].map(|axis| dot(axis, &forces[i]));
            let limit = parts[i].friction * normal.max(0.0);
            (limit * limit - aside * aside).max(0.0).sqrt()
        });
        let (stop, all) = (-rate * dot(edge, velocity), left[0] + left[1]);
        let share = if all > 0.0 { (stop.abs() / all).min(1.0) * stop.signum() } else { 0.0 };
        left.map(|left| share * left)
    }

    fn in_space(&self, force: &[f64; 2], along: f64) -> [f64; D] {
        match &self.edge {
            Some(edge) => {
                std::array::from_fn(|c| force[0] * self.axes[0][c] + force[1] * self.axes[1][c] + along * edge[c])
            }
            None => std::array::from_fn(|c| force.get(c).copied().unwrap_or(0.0)),
        }
    }
}

/// λ and the sticking part of τ of both parts of a force: in the cones, with the least friction where it sticks; and by
/// how much they violate the cones, over the force, if none are in them.
fn split(parts: &[ForcePart; 2], total: [f64; 2]) -> (f64, [[f64; 2]; 2]) {
    let units = parts.map(|part| part.unit());
    // λ = λ_0 − Σ x_i slope_i, of the sticking parts x_i of τ.
    let start = solve(units, total);
    let slopes = parts.map(|part| solve(units, part.tangent));
    if [start, slopes[0], slopes[1]].as_flattened().iter().any(|x| !x.is_finite()) {
        // The forces of both are parallel: no sum of them is the force, or many are.
        return (f64::INFINITY, [[0.0; 2]; 2]);
    }
    let normal = |x: [f64; 2]| [0, 1].map(|i| start[i] - x[0] * slopes[0][i] - x[1] * slopes[1][i]);
    // Conditions a·x ≤ b.
    let mut conditions: Vec<([f64; 2], f64)> = Vec::with_capacity(6);
    for i in 0..2 {
        conditions.push((slopes.map(|slope| slope[i]), start[i]));
        for sign in [1.0, -1.0] {
            let mut along = [0.0; 2];
            along[i] = sign;
            // ±x_i ≤ μλ_i; no sticking part where it slides.
            let limit = if parts[i].sliding == 0.0 { parts[i].friction } else { 0.0 };
            conditions.push(([0, 1].map(|k| along[k] + limit * slopes[k][i]), limit * start[i]));
        }
    }
    let size = total[0].hypot(total[1]);
    let violation = |x: &[f64; 2]| {
        let worst = conditions.iter().map(|(a, b)| a[0] * x[0] + a[1] * x[1] - b).fold(0.0, f64::max);
        if worst <= ROUNDING * size { 0.0 } else { worst / size }
    };
    // The least of a convex polygon: in it, on a side, or at a corner.
    let mut points = vec![[0.0; 2]];
    for (k, (a, b)) in conditions.iter().enumerate() {
        let square = a[0] * a[0] + a[1] * a[1];
        if square > 0.0 {
            points.push(a.map(|a| a * b / square));
        }
        points.extend(conditions[..k].iter().map(|(c, d)| solve([[a[0], c[0]], [a[1], c[1]]], [*b, *d])));
    }
    points.retain(|x| x.iter().all(|x| x.is_finite()));
    let key = |x: &[f64; 2]| (violation(x), x[0] * x[0] + x[1] * x[1]);
    let compare = |a: &[f64; 2], b: &[f64; 2]| {
        let (a, b) = (key(a), key(b));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    };
    let found = points.into_iter().min_by(compare).unwrap_or_default();
    let lambda = normal(found);
    (violation(&found), [0, 1].map(|i| [lambda[i], found[i]]))
}

/// x with x_0 a_0 + x_1 a_1 = b for columns a.
fn solve([a, c]: [[f64; 2]; 2], b: [f64; 2]) -> [f64; 2] {
    let determinant = a[0] * c[1] - a[1] * c[0];
    [(b[0] * c[1] - b[1] * c[0]) / determinant, (a[0] * b[1] - a[1] * b[0]) / determinant]
}

#[cfg(test)]
mod tests;
