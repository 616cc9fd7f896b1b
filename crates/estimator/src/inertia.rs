//! Γ_DA on an element, from ã at its nodes (§6.2.2).

use crate::options::Acceleration;

/// The linear map, constant in time, from nodal ã to the nodal values of Γ_DA/ρ.
///
/// All three choices balance the resultant and the moment of the equilibrated tractions, which do
/// the lumped work ρ|E|/(D+1) Σ ã_i·u_i on every linear field u. As the map is linear, it turns
/// ∫ã dt into ∫Γ_DA/ρ dt as well.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia<const D: usize, const N: usize> {
    choice: Acceleration,
    /// x_i − centroid turned by a quarter, the unit rotation at node i; zero in 1D.
    rotation: [[f64; D]; N],
    /// 1/Σ|x_i − centroid|².
    inverse: f64,
}

impl<const D: usize, const N: usize> Inertia<D, N> {
    pub(crate) fn new(choice: Acceleration, points: &[[f64; D]; N]) -> Self {
        let mut rotation = [[0.0; D]; N];
        let mut sum = 0.0;
        if D == 2 {
            for i in 0..N {
                // From differences, so that a distant origin costs no digits.
                let arm = |c: usize| (0..N).map(|j| points[i][c] - points[j][c]).sum::<f64>() / N as f64;
                rotation[i][0] = -arm(1);
                rotation[i][1] = arm(0);
                sum += rotation[i].iter().map(|r| r * r).sum::<f64>();
            }
        }
        Self { choice, rotation, inverse: if D == 2 { 1.0 / sum } else { 0.0 } }
    }

    /// Γ_DA/ρ at the nodes (m/s²), or its time integral.
    #[inline(always)]
    pub(crate) fn apply(&self, nodal: &[[f64; D]; N]) -> [[f64; D]; N] {
        let mut mean = [0.0; D];
        let mut turning = 0.0;
        for i in 0..N {
            for c in 0..D {
                mean[c] += nodal[i][c] / N as f64;
                turning += nodal[i][c] * self.rotation[i][c];
            }
        }
        turning *= self.inverse;
        let mut field = *nodal;
        for i in 0..N {
            for c in 0..D {
                field[i][c] = match self.choice {
                    // The lumped moment is four times that of the linear field, whose own is
                    // turning: add the other three.
                    Acceleration::Closest => nodal[i][c] + 3.0 * turning * self.rotation[i][c],
                    Acceleration::Rigid => mean[c] + 4.0 * turning * self.rotation[i][c],
                    // M_consistent Γ/ρ = M_lumped ã.
                    Acceleration::Weak => (D + 2) as f64 * nodal[i][c] - N as f64 * mean[c],
                };
            }
        }
        field
    }
}

/// ∫ρ a·b over an element of this mass (kg) for two linear fields.
#[inline(always)]
pub(crate) fn mass_product<const D: usize, const N: usize>(mass: f64, a: &[[f64; D]; N], b: &[[f64; D]; N]) -> f64 {
    let mut product = 0.0;
    for c in 0..D {
        let (mut sum_a, mut sum_b) = (0.0, 0.0);
        for i in 0..N {
            product += a[i][c] * b[i][c];
            sum_a += a[i][c];
            sum_b += b[i][c];
        }
        product += sum_a * sum_b;
    }
    mass * product / ((D + 1) * (D + 2)) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [[f64; 2]; 3] = [[0.1, 0.2], [1.3, 0.4], [0.3, 0.9]];
    const NODAL: [[f64; 2]; 3] = [[1.0, -2.0], [0.5, 3.0], [-4.0, 0.7]];

    /// Every choice does the lumped work on translations and on the rotation.
    #[test]
    fn resultant_and_moment_are_those_of_the_lumped_mass() {
        for choice in [Acceleration::Closest, Acceleration::Rigid, Acceleration::Weak] {
            let map = Inertia::new(choice, &POINTS);
            let field = map.apply(&NODAL);
            let rotation = POINTS.map(|p| [-p[1], p[0]]);
            for test in [[[1.0, 0.0]; 3], [[0.0, 1.0]; 3], rotation] {
                let lumped: f64 = (0..3).map(|i| (NODAL[i][0] * test[i][0] + NODAL[i][1] * test[i][1]) / 3.0).sum();
                let work = mass_product(1.0, &field, &test);
                assert!((work - lumped).abs() < 1e-14, "{choice}: {work} against {lumped}");
            }
        }
    }

    /// `closest` is the L2-nearest of all fields that balance: its distance from ã is orthogonal to
    /// the fields without resultant and moment, here to the two others.
    #[test]
    fn closest_is_nearest() {
        let distance = |choice| {
            let field = Inertia::new(choice, &POINTS).apply(&NODAL);
            let mut difference = field;
            (0..3).for_each(|i| (0..2).for_each(|c| difference[i][c] -= NODAL[i][c]));
            mass_product(1.0, &difference, &difference)
        };
        assert!(distance(Acceleration::Closest) < distance(Acceleration::Rigid));
        assert!(distance(Acceleration::Closest) < distance(Acceleration::Weak));
    }

    /// In 1D the consistent mass matrix inverts to the weak field.
    #[test]
    fn weak_bar() {
        let field = Inertia::new(Acceleration::Weak, &[[0.0], [2.0]]).apply(&[[1.0], [4.0]]);
        // (1/6)(2Γ_0 + Γ_1) = ½·1 and (1/6)(Γ_0 + 2Γ_1) = ½·4 give Γ = (−2, 7).
        assert_eq!(field, [[-2.0], [7.0]]);
    }
}
