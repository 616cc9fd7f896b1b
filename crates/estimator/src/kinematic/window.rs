//! A window of the normal motion of a node between two contacts, and the gap along it.

/// A window of half steps: from the start or the end of a contact phase to the beginning of the
/// next one, or to the end of the run.
#[derive(Clone, Debug)]
pub(super) struct FlightWindow<'a> {
    /// Gap (m) and normal velocity (m/s) at its first instant, both given.
    pub(super) start: (f64, f64),
    /// Lengths of its half steps (s).
    pub(super) lengths: &'a [f64],
    /// Normal velocity of the simulation at the instants after the first (m/s). If the window ends
    /// in contact, the last instant is not free and its value is ignored.
    pub(super) target: &'a [f64],
    /// Whether the node arrives on the plane at rest at the last instant (the onset).
    pub(super) arrives: bool,
}

/// A point of a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// Which half step.
    pub(super) half_step: usize,
    /// Time since its beginning (s).
    pub(super) offset: f64,
}

/// Velocity (m/s) and gap (m) at the instants after the first.
pub(super) type Path = Vec<(f64, f64)>;

impl FlightWindow<'_> {
    /// Number of instants whose velocity is free.
    pub(super) fn free_instants(&self) -> usize {
        self.target.len() - usize::from(self.arrives)
    }

    /// Length that instant `k` (from 0, after the first) stands for in the trapezoidal integral.
    pub(super) fn trapezoid(&self, k: usize) -> f64 {
        0.5 * (self.lengths[k] + self.lengths.get(k + 1).copied().unwrap_or(0.0))
    }

    /// ω of instant `k`: the mean length of the half steps that meet there, of the one at an end.
    pub(super) fn weight(&self, k: usize) -> f64 {
        match self.lengths.get(k + 1) {
            Some(next) => 0.5 * (self.lengths[k] + next),
            None => self.lengths[k],
        }
    }

    /// The solution of the equality problem: weights and trapezoidal lengths of free instants agree,
    /// so that the onset shifts all of them by the same amount.
    pub(super) fn shifted(&self) -> Vec<f64> {
        let mut velocity = self.target.to_vec();
        if !self.arrives {
            return velocity;
        }
        let free = self.free_instants();
        velocity[free] = 0.0;
        if free == 0 {
            return velocity;
        }
        let (gap, first) = self.start;
        let mut distance = gap + 0.5 * self.lengths[0] * first;
        let mut length = 0.0;
        for k in 0..free {
            distance += self.trapezoid(k) * velocity[k];
            length += self.trapezoid(k);
        }
        velocity[..free].iter_mut().for_each(|v| *v -= distance / length);
        velocity
    }

    /// Gaps along the window: the exact integral of a piecewise linear velocity.
    pub(super) fn integrate(&self, velocity: &[f64]) -> Path {
        let (mut gap, mut before) = self.start;
        let steps = self.lengths.iter().zip(velocity);
        let advance = |(length, &v): (&f64, &f64)| {
            gap += 0.5 * length * (before + v);
            before = v;
            (v, gap)
        };
        steps.map(advance).collect()
    }

    /// State at the start of half step `m`.
    pub(super) fn before(&self, path: &Path, m: usize) -> (f64, f64) {
        if m == 0 { (self.start.1, self.start.0) } else { path[m - 1] }
    }

    /// Where within half step `m` the gap is least, and how large it is there.
    pub(super) fn least(&self, path: &Path, m: usize) -> (Cut, f64) {
        least_of_parabola(self.before(path, m), path[m], self.lengths[m], m)
    }

    /// The deepest point of the window.
    pub(super) fn deepest(&self, path: &Path) -> (Cut, f64) {
        let all = (0..self.lengths.len()).map(|m| self.least(path, m));
        all.fold((Cut { half_step: 0, offset: 0.0 }, self.start.0), |a, b| if b.1 < a.1 { b } else { a })
    }
}

/// Minimum of the gap over one half step: at an end, or where the velocity changes from inward to
/// outward.
pub(super) fn least_of_parabola(before: (f64, f64), after: (f64, f64), length: f64, m: usize) -> (Cut, f64) {
    let ((v0, g0), (v1, g1)) = (before, after);
    if v0 < 0.0 && v1 > 0.0 {
        let offset = length * v0 / (v0 - v1);
        return (Cut { half_step: m, offset }, g0 + 0.5 * v0 * offset);
    }
    if g1 < g0 { (Cut { half_step: m, offset: length }, g1) } else { (Cut { half_step: m, offset: 0.0 }, g0) }
}
