//! A rigid block with Coulomb friction under a driving force.

/// Between two changes, the motion is a polynomial of the time since `start`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    start: f64,
    /// −1, 1: direction of sliding; 0: it sticks.
    way: f64,
    position: f64,
    velocity: f64,
    push: f64,
    slope: f64,
    dissipated: f64,
}

/// A rigid block on a plane, at rest at t = 0, that a force P(t), piecewise linear in time, pushes along the plane
/// against dry friction of at most F = μN (N) with a constant normal force N. It
///
/// - sticks while |P| ≤ F: the friction is −P;
/// - else slides, mẍ = P − F sgn ẋ, until its velocity is zero again.
///
/// Its motion is a cubic between the changes, whose instants are roots of linear and quadratic equations. A block on a
/// plane tilted by θ is the case P = mg sin θ, F = μmg cos θ: it sticks if tan θ ≤ μ, else slides with g sin θ − μg cos
/// θ.
///
/// Source: Coulomb's law, eq. \[2\], for a point mass; den Hartog (1931), *Forced vibrations with combined Coulomb and
/// viscous friction*, has the same pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidSlide {
    mass: f64,
    limit: f64,
    pieces: Vec<Piece>,
}

impl RigidSlide {
    /// A block of `mass` (kg), a friction of at most `limit` (N) and a push (N) at instants (s), from 0 on and
    /// increasing, straight between them and constant after the last. `None` if the mass is not positive, the limit
    /// negative or the instants are not so.
    #[must_use]
    pub fn new(mass: f64, limit: f64, push: &[(f64, f64)]) -> Option<Self> {
        let increasing = push.windows(2).all(|w| w[0].0 < w[1].0) && push.first().is_some_and(|p| p.0 == 0.0);
        if !increasing || mass.is_nan() || mass <= 0.0 || limit.is_nan() || limit < 0.0 {
            return None;
        }
        let mut slide = Self { mass, limit, pieces: Vec::new() };
        let (mut position, mut velocity, mut dissipated) = (0.0, 0.0, 0.0);
        for (i, &(start, force)) in push.iter().enumerate() {
            let end = push.get(i + 1).map_or(f64::INFINITY, |p| p.0);
            let slope = push.get(i + 1).map_or(0.0, |p| (p.1 - force) / (end - start));
            let mut piece = Piece { start, way: 0.0, position, velocity, push: force, slope, dissipated };
            loop {
                piece.way = slide.way(&piece);
                slide.pieces.push(piece);
                let change = slide.change(&piece);
                let last = change.is_none_or(|t| t >= end);
                let next = if last { end } else { change.unwrap_or(end) };
                if next.is_infinite() {
                    break;
                }
                piece = slide.at_end(&piece, next, !last);
                if last {
                    break;
                }
            }
            (position, velocity, dissipated) = (piece.position, piece.velocity, piece.dissipated);
        }
        Some(slide)
    }

    /// Direction of sliding at the start of a piece.
    fn way(&self, piece: &Piece) -> f64 {
        let grows = piece.push.abs() == self.limit && piece.push * piece.slope > 0.0;
        if piece.velocity != 0.0 {
            piece.velocity.signum()
        } else if piece.push.abs() > self.limit || grows {
            piece.push.signum()
        } else {
            0.0
        }
    }

    /// Time at which it starts to slide, or stops (s).
    fn change(&self, piece: &Piece) -> Option<f64> {
        if piece.way == 0.0 {
            let bound = self.limit * piece.slope.signum();
            return (piece.slope != 0.0).then(|| piece.start + (bound - piece.push) / piece.slope);
        }
        // In the direction of sliding: w + a τ + b τ² = 0 for the first τ > 0.
        let w = self.mass * piece.velocity * piece.way;
        let a = piece.push * piece.way - self.limit;
        let b = 0.5 * piece.slope * piece.way;
        let root = if b == 0.0 {
            -w / a
        } else {
            let square = a * a - 4.0 * b * w;
            let q = -0.5 * (a + a.signum() * square.sqrt());
            let roots = [q / b, w / q].into_iter().filter(|t| *t > 0.0);
            roots.fold(f64::INFINITY, f64::min)
        };
        (root > 0.0 && root.is_finite()).then_some(piece.start + root)
    }

    /// State of a piece at `time`; `changes` if it then starts or stops.
    fn at_end(&self, piece: &Piece, time: f64, changes: bool) -> Piece {
        let (position, velocity) = self.motion(piece, time);
        let since = time - piece.start;
        Piece {
            start: time,
            position,
            velocity: if changes || piece.way == 0.0 { 0.0 } else { velocity },
            // Exactly on the limit, so that the next piece slides.
            push: if changes && piece.way == 0.0 {
                self.limit * piece.slope.signum()
            } else {
                piece.push + piece.slope * since
            },
            dissipated: piece.dissipated + self.limit * (position - piece.position).abs(),
            ..*piece
        }
    }

    fn motion(&self, piece: &Piece, time: f64) -> (f64, f64) {
        if piece.way == 0.0 {
            return (piece.position, 0.0);
        }
        let t = time - piece.start;
        let (a, j) = ((piece.push - piece.way * self.limit) / self.mass, piece.slope / self.mass);
        let velocity = piece.velocity + t * (a + 0.5 * j * t);
        (piece.position + t * (piece.velocity + t * (0.5 * a + j * t / 6.0)), velocity)
    }

    fn piece(&self, time: f64) -> &Piece {
        let after = self.pieces.partition_point(|p| p.start <= time);
        &self.pieces[after.saturating_sub(1)]
    }

    /// Displacement (m).
    #[must_use]
    pub fn position(&self, time: f64) -> f64 {
        self.motion(self.piece(time), time).0
    }

    /// Velocity (m/s).
    #[must_use]
    pub fn velocity(&self, time: f64) -> f64 {
        self.motion(self.piece(time), time).1
    }

    /// Force of friction on the block (N).
    #[must_use]
    pub fn friction(&self, time: f64) -> f64 {
        let piece = self.piece(time);
        if piece.way == 0.0 { -(piece.push + piece.slope * (time - piece.start)) } else { -piece.way * self.limit }
    }

    /// Energy dissipated so far (J).
    #[must_use]
    pub fn dissipated(&self, time: f64) -> f64 {
        let piece = self.piece(time);
        piece.dissipated + self.limit * (self.position(time) - piece.position).abs()
    }

    /// The instants at which it starts or stops (s).
    #[must_use]
    pub fn changes(&self) -> Vec<f64> {
        self.pieces.windows(2).filter(|w| w[0].way != w[1].way).map(|w| w[1].start).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A push of −1, 1, −1, 1, … times `amplitude` at the quarters of a period of 4 s, from 0.
    fn triangle(amplitude: f64) -> Vec<(f64, f64)> {
        let corner = |i: u32| (f64::from(2 * i + 1), if i.is_multiple_of(2) { amplitude } else { -amplitude });
        std::iter::once((0.0, 0.0)).chain((0..8).map(corner)).collect()
    }

    /// A constant push: nothing below the limit, ½(P − F)t²/m above.
    #[test]
    fn a_constant_push() {
        let still = RigidSlide::new(2.0, 3.0, &[(0.0, 2.9)]).unwrap();
        assert_eq!((still.position(7.0), still.velocity(7.0), still.friction(7.0)), (0.0, 0.0, -2.9));
        let slides = RigidSlide::new(2.0, 3.0, &[(0.0, -4.0)]).unwrap();
        assert_eq!((slides.position(4.0), slides.velocity(4.0), slides.friction(4.0)), (-4.0, -2.0, 3.0));
        assert_eq!(slides.dissipated(4.0), 12.0);
    }

    /// By hand: P = 4t and F = 2, m = 1 slide from ½ s on with v = 2(t − ½)², ½ at 1 s; then P falls, v = ½ + 2θ − 2θ²
    /// is zero after ½(1 + √2) s.
    #[test]
    fn a_triangle_by_hand() {
        let slide = RigidSlide::new(1.0, 2.0, &triangle(4.0)[..3]).unwrap();
        assert_eq!((slide.velocity(0.4), slide.velocity(1.0)), (0.0, 0.5));
        let changes = slide.changes();
        assert_eq!(changes[0], 0.5);
        assert!((changes[1] - (1.5 + 0.5_f64.sqrt())).abs() < 1e-15, "{changes:?}");
        // P is −0.83 there, within the limit until it is −2 at 2.5 s: v = −2(t − 2.5)² until 3 s, then P stays.
        assert_eq!((slide.velocity(2.4), changes[2]), (0.0, 2.5));
        assert_eq!((slide.velocity(3.0), slide.velocity(4.0)), (-0.5, -2.5));
    }

    /// mẍ = P + friction by differences, Coulomb's law, and the work of P is kinetic energy plus dissipated energy.
    #[test]
    fn equation_of_motion_law_and_energy() {
        for amplitude in [2.5, 3.0, 4.0, 9.0] {
            let (table, h) = (triangle(amplitude), 1e-5);
            let slide = RigidSlide::new(1.5, 2.0, &table).unwrap();
            let push = |t: f64| {
                let k = table.partition_point(|p| p.0 <= t).min(table.len() - 1);
                table[k - 1].1 + (table[k].1 - table[k - 1].1) * (t - table[k - 1].0) / (table[k].0 - table[k - 1].0)
            };
            let (mut work, steps) = (0.0, 140_000);
            let dt = 14.0 / f64::from(steps);
            for i in 0..steps {
                let t = (f64::from(i) + 0.5) * dt;
                work += push(t) * slide.velocity(t) * dt;
                if i % 991 != 0 || slide.changes().iter().any(|c| (c - t).abs() < 2.0 * h) {
                    continue;
                }
                let v = (slide.position(t + h) - slide.position(t - h)) / (2.0 * h);
                // Cubics: (h²/6)·ẍ' plus rounding, 1e-16·20/h.
                assert!((v - slide.velocity(t)).abs() < 1e-8, "velocity at {t}");
                let a = (slide.velocity(t + h) - slide.velocity(t - h)) / (2.0 * h);
                assert!((1.5 * a - push(t) - slide.friction(t)).abs() < 1e-3, "motion at {t}");
                assert!(slide.friction(t).abs() <= 2.0 + 1e-13 && slide.friction(t) * slide.velocity(t) <= 0.0);
                assert!(slide.velocity(t) == 0.0 || slide.friction(t).abs() == 2.0, "law at {t}");
                let kinetic = 0.75 * slide.velocity(t).powi(2);
                // Midpoints of 1e-4 s, the last one half too much: |Pv|·1e-4 of up to 9·5.
                assert!((work - kinetic - slide.dissipated(t)).abs() < 5e-3, "energy at {t}");
            }
            assert!(slide.changes().len() >= 6, "{:?}", slide.changes());
        }
    }

    #[test]
    fn nonsense_is_refused() {
        assert_eq!(RigidSlide::new(0.0, 1.0, &[(0.0, 1.0)]), None);
        assert_eq!(RigidSlide::new(1.0, -1.0, &[(0.0, 1.0)]), None);
        assert_eq!(RigidSlide::new(1.0, 1.0, &[(0.0, 1.0), (0.0, 2.0)]), None);
        assert_eq!(RigidSlide::new(1.0, 1.0, &[]), None);
    }
}
