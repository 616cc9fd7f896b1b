//! Γ_DA on an element, from ã at its nodes (§6.2.2).

use crate::options::Acceleration;
use percute_core::simd::lanes::Value;

/// The linear map, constant in time, from nodal ã to the nodal values of Γ_DA/ρ.
///
/// All choices balance the resultant and the moment of the equilibrated tractions. These do the lumped work
/// ρ|E|/(D+1) Σ ã_i·u_i on every linear field u. With `split` they do the work ∫ρ a_c·u + ρ|E|/(D+1) Σ o_i·u_i on rigid
/// motions u, o the acceleration of the skew part of the stress of lumping: ρ a_c lacks only the resultant and the
/// moment of o. As the map is linear, it turns the time integrals of ã, or of a_c and o, into ∫Γ_DA/ρ dt as well.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia<const D: usize, const N: usize> {
    choice: Acceleration,
    /// Whether the work on all linear fields is kept, and not on rigid motions alone: those of the present places of a
    /// body that turns are among them at any time.
    linear: bool,
    /// The first D(D − 1)/2 of them are the rotations of the element.
    rotations: [Rotation<D, N>; D],
}

/// A rotation about the centroid, orthogonal to the others.
#[derive(Clone, Copy, Debug)]
struct Rotation<const D: usize, const N: usize> {
    /// Its values at the nodes (m).
    field: [[f64; D]; N],
    /// 1 over the sum of their squares (1/m²).
    inverse: f64,
}

/// Places of the nodes from the centroid (m), from differences, so that a distant origin costs no digits.
#[inline(always)]
pub(crate) fn arms<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> [[f64; D]; N] {
    let mut arms = [[0.0; D]; N];
    for i in 0..N {
        for c in 0..D {
            let mut sum = 0.0;
            for q in points {
                sum += points[i][c] - q[c];
            }
            arms[i][c] = sum * (1.0 / N as f64);
        }
    }
    arms
}

/// Number of rotations.
const fn rotation_count(dimension: usize) -> usize {
    dimension * (dimension - 1) / 2
}

impl<const D: usize, const N: usize> Inertia<D, N> {
    #[inline(always)]
    pub(crate) fn new(choice: Acceleration, arms: &[[f64; D]; N]) -> Self {
        let mut rotations = [Rotation { field: [[0.0; D]; N], inverse: 0.0 }; D];
        let mut at = 0;
        for b in 1..D {
            for a in 0..b {
                let (earlier, later) = rotations.split_at_mut(at);
                let field = &mut later[0].field;
                for (value, arm) in field.iter_mut().zip(arms) {
                    (value[a], value[b]) = (-arm[b], arm[a]);
                }
                for rotation in earlier {
                    rotation.remove_from(field);
                }
                let mut square = 0.0;
                for value in &*field {
                    let mut sum = 0.0;
                    for x in value {
                        sum += x * x;
                    }
                    square += sum;
                }
                later[0].inverse = 1.0 / square;
                at += 1;
            }
        }
        Self { choice, linear: false, rotations }
    }

    /// The same for a body that turns: the map remains constant in time.
    #[inline(always)]
    pub(crate) fn turning(self) -> Self {
        Self { linear: true, ..self }
    }

    /// Γ_DA/ρ at the nodes (m/s²), or its time integral, from ã, or a_c and o with `split`, or from
    /// theirs.
    #[inline(always)]
    pub(crate) fn apply<T: Value>(&self, acceleration: &[[T; D]; N], skew: Option<&[[T; D]; N]>) -> [[T; D]; N] {
        let mean = mean(acceleration);
        // The lumped moment is D + 2 times that of the linear field.
        match self.choice {
            // Add the other D + 1.
            Acceleration::Closest => self.turned(*acceleration, (D + 1) as f64, acceleration),
            Acceleration::Rigid => self.turned([mean; N], (D + 2) as f64, acceleration),
            Acceleration::Weak => weak(acceleration),
            Acceleration::Split => {
                let Some(difference) = skew else { return *acceleration };
                if self.linear {
                    let (mut field, shift) = (*acceleration, weak(difference));
                    for (value, shift) in field.iter_mut().zip(&shift) {
                        (0..D).for_each(|c| value[c] += shift[c]);
                    }
                    return field;
                }
                let mean = self::mean(difference);
                let mut shifted = *acceleration;
                for value in &mut shifted {
                    for c in 0..D {
                        value[c] += mean[c];
                    }
                }
                self.turned(shifted, (D + 2) as f64, difference)
            }
        }
    }

    /// A field with this multiple of the rotation that is nearest to a nodal field.
    #[inline(always)]
    fn turned<T: Value>(&self, mut field: [[T; D]; N], factor: f64, nodal: &[[T; D]; N]) -> [[T; D]; N] {
        for rotation in &self.rotations[..rotation_count(D)] {
            let turning = rotation.work_on(nodal) * rotation.inverse * factor;
            for i in 0..N {
                for c in 0..D {
                    field[i][c] += turning * rotation.field[i][c];
                }
            }
        }
        field
    }
}

/// The field of which the consistent mass does the work of the lumped mass on this one: M_c g = M o.
#[inline(always)]
fn weak<T: Value, const D: usize, const N: usize>(nodal: &[[T; D]; N]) -> [[T; D]; N] {
    let (mean, mut field) = (mean(nodal), *nodal);
    for value in &mut field {
        for c in 0..D {
            value[c] = value[c] * (D + 2) as f64 - mean[c] * N as f64;
        }
    }
    field
}

/// The mean over the nodes.
#[inline(always)]
fn mean<T: Value, const D: usize, const N: usize>(nodal: &[[T; D]; N]) -> [T; D] {
    let mut mean = [nodal[0][0].zero(); D];
    for value in nodal {
        for c in 0..D {
            mean[c] += value[c] * (1.0 / N as f64);
        }
    }
    mean
}

impl<const D: usize, const N: usize> Rotation<D, N> {
    /// Σ of the products with another nodal field.
    #[inline(always)]
    fn work_on<T: Value>(&self, nodal: &[[T; D]; N]) -> T {
        let mut work = nodal[0][0].zero();
        for i in 0..N {
            for c in 0..D {
                work += nodal[i][c] * self.field[i][c];
            }
        }
        work
    }

    /// Makes another nodal field orthogonal to this one.
    #[inline(always)]
    fn remove_from(&self, nodal: &mut [[f64; D]; N]) {
        let share = self.work_on(nodal) * self.inverse;
        for i in 0..N {
            (0..D).for_each(|c| nodal[i][c] -= share * self.field[i][c]);
        }
    }
}

/// Adds the symmetric part of the stress that lumping the mass of an element is: for a linear field w, the nodal forces
/// (M − M_c) w of the element are |E| τ∇φ_i with τ = ρ/(D+2) Σ w_i ⊗ d_i, d_i the places of the nodes from the
/// centroid.
#[inline(always)]
pub(crate) fn add_lumping_stress<T: Value, const D: usize, const N: usize>(
    density: f64,
    arms: &[[f64; D]; N],
    w: &[[T; D]; N],
    stress: &mut [[T; D]; D],
) {
    let half = 0.5 * density / (D + 2) as f64;
    // The places sum up to 0: a translation leaves no rounding.
    for i in 1..N {
        for a in 0..D {
            let change = (w[i][a] - w[0][a]) * half;
            for b in 0..D {
                stress[a][b] += change * arms[i][b];
                stress[b][a] += change * arms[i][b];
            }
        }
    }
}

/// All of this stress: the symmetric part of a body that turns is that about its present places.
#[inline(always)]
pub(crate) fn lumping_stress<T: Value, const D: usize, const N: usize>(
    density: f64,
    arms: &[[f64; D]; N],
    w: &[[T; D]; N],
) -> [[T; D]; D] {
    let (factor, mut stress) = (density / (D + 2) as f64, [[w[0][0].zero(); D]; D]);
    for i in 1..N {
        for a in 0..D {
            let change = (w[i][a] - w[0][a]) * factor;
            (0..D).for_each(|b| stress[a][b] += change * arms[i][b]);
        }
    }
    stress
}

/// ∫ρ a·b over an element of this mass (kg) for two linear fields.
#[inline(always)]
pub(crate) fn mass_product<T: Value, const D: usize>(mass: f64, a: &[[T; D]], b: &[[T; D]]) -> T {
    let zero = a[0][0].zero();
    let mut product = zero;
    for c in 0..D {
        let (mut sum_a, mut sum_b) = (zero, zero);
        for i in 0..a.len() {
            product += a[i][c] * b[i][c];
            sum_a += a[i][c];
            sum_b += b[i][c];
        }
        product += sum_a * sum_b;
    }
    product * (mass / ((D + 1) * (D + 2)) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    const POINTS: [[f64; 2]; 3] = [[0.1, 0.2], [1.3, 0.4], [0.3, 0.9]];
    const NODAL: [[f64; 2]; 3] = [[1.0, -2.0], [0.5, 3.0], [-4.0, 0.7]];

    /// Every choice does the lumped work on translations and on the rotation.
    #[test]
    fn resultant_and_moment_are_those_of_the_lumped_mass() {
        for choice in [Acceleration::Closest, Acceleration::Rigid, Acceleration::Weak] {
            let map = Inertia::new(choice, &arms(&POINTS));
            let field = map.apply(&NODAL, None);
            let rotation = POINTS.map(|p| [-p[1], p[0]]);
            for test in [[[1.0, 0.0]; 3], [[0.0, 1.0]; 3], rotation] {
                let lumped: f64 = (0..3).map(|i| (NODAL[i][0] * test[i][0] + NODAL[i][1] * test[i][1]) / 3.0).sum();
                let work = mass_product(1.0, &field, &test);
                assert!((work - lumped).abs() < 1e-14, "{choice}: {work} against {lumped}");
            }
        }
    }

    const LUMPING: [[f64; 2]; 3] = [[0.3, 1.0], [-2.0, 0.4], [0.9, -0.1]];

    /// `split` gives, of all linear fields that do the work of the consistent mass on ã and of the lumped mass on o on
    /// rigid motions, the nearest to ã: the solution g of the least-squares problem |g − ã|² → min, Bg = f with a
    /// multiplier for each rigid motion.
    #[test]
    fn split_solves_the_least_squares_problem() {
        let arms = arms(&POINTS);
        let rigid = [[[1.0, 0.0]; 3], [[0.0, 1.0]; 3], arms.map(|d| [-d[1], d[0]])];
        let unit = |k: usize| -> [[f64; 2]; 3] {
            std::array::from_fn(|i| std::array::from_fn(|c| f64::from(u8::from(2 * i + c == k))))
        };
        let (mut matrix, mut right) = (DMatrix::zeros(9, 9), DVector::zeros(9));
        for k in 0..6 {
            (0..6).for_each(|l| matrix[(k, l)] = mass_product(1.0, &unit(k), &unit(l)));
            right[k] = mass_product(1.0, &unit(k), &NODAL);
            for (r, motion) in rigid.iter().enumerate() {
                let work = mass_product(1.0, &unit(k), motion);
                (matrix[(k, 6 + r)], matrix[(6 + r, k)]) = (work, work);
            }
        }
        for (r, motion) in rigid.iter().enumerate() {
            let lumped: f64 = (0..3).map(|i| (LUMPING[i][0] * motion[i][0] + LUMPING[i][1] * motion[i][1]) / 3.0).sum();
            right[6 + r] = mass_product(1.0, &NODAL, motion) + lumped;
        }
        let nearest = matrix.lu().solve(&right).unwrap();
        let field = Inertia::new(Acceleration::Split, &arms).apply(&NODAL, Some(&LUMPING));
        for (k, value) in field.as_flattened().iter().enumerate() {
            assert!((value - nearest[k]).abs() < 1e-13, "{value} against {}", nearest[k]);
        }
    }

    /// In a bar nothing turns: `split` adds the mean of o.
    #[test]
    fn split_bar() {
        let map = Inertia::new(Acceleration::Split, &arms(&[[0.0], [2.0]]));
        assert_eq!(map.apply(&[[1.0], [4.0]], Some(&[[0.5], [1.0]])), [[1.75], [4.75]]);
    }

    /// `closest` is the L2-nearest of all fields that balance: its distance from ã is orthogonal to
    /// the fields without resultant and moment, here to the two others.
    #[test]
    fn closest_is_nearest() {
        let distance = |choice| {
            let field = Inertia::new(choice, &arms(&POINTS)).apply(&NODAL, None);
            let mut difference = field;
            (0..3).for_each(|i| (0..2).for_each(|c| difference[i][c] -= NODAL[i][c]));
            mass_product(1.0, &difference, &difference)
        };
        assert!(distance(Acceleration::Closest) < distance(Acceleration::Rigid));
        assert!(distance(Acceleration::Closest) < distance(Acceleration::Weak));
    }

    /// The rotations are rigid, orthogonal, and as many as the dimension allows.
    #[test]
    fn a_tetrahedron_has_three_rotations() {
        let arms = arms(&[[0.0, 0.1, 0.0], [1.0, 0.0, 0.2], [0.3, 0.9, 0.0], [0.2, 0.3, 1.1]]);
        let rotations = Inertia::new(Acceleration::Closest, &arms).rotations;
        for (i, rotation) in rotations.iter().enumerate() {
            assert!((rotation.work_on(&rotation.field) * rotation.inverse - 1.0).abs() < 1e-14);
            rotations[..i].iter().for_each(|other| assert!(other.work_on(&rotation.field).abs() < 1e-14));
            for (p, a) in arms.iter().zip(&rotation.field) {
                for (q, b) in arms.iter().zip(&rotation.field) {
                    let stretch: f64 = (0..3).map(|c| (p[c] - q[c]) * (a[c] - b[c])).sum();
                    assert!(stretch.abs() < 1e-14);
                }
            }
        }
    }

    /// In 1D the consistent mass matrix inverts to the weak field.
    #[test]
    fn weak_bar() {
        let field = Inertia::new(Acceleration::Weak, &arms(&[[0.0], [2.0]])).apply(&[[1.0], [4.0]], None);
        // (1/6)(2Γ_0 + Γ_1) = ½·1 and (1/6)(Γ_0 + 2Γ_1) = ½·4 give Γ = (−2, 7).
        assert_eq!(field, [[-2.0], [7.0]]);
    }
}
