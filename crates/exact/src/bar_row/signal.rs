//! A wave as it leaves an end of a bar.

/// A velocity that is constant between instants, from its value before t = 0 on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Signal {
    before: f64,
    /// Instants of the jumps, from 0 on; values behind them, and integrals from 0 up to them.
    jumps: Vec<Jump>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Jump {
    time: f64,
    value: f64,
    integral: f64,
}

impl Signal {
    pub(super) fn new(before: f64) -> Self {
        Self { before, jumps: Vec::new() }
    }

    /// The last jump up to t.
    fn last(&self, t: f64) -> Jump {
        let behind = self.jumps.partition_point(|jump| jump.time <= t);
        let start = Jump { time: 0.0, value: self.before, integral: 0.0 };
        behind.checked_sub(1).map_or(start, |at| self.jumps[at])
    }

    /// Its value at t, at a jump that behind it.
    pub(super) fn at(&self, t: f64) -> f64 {
        self.last(t).value
    }

    /// Its integral from 0 to t.
    pub(super) fn integral(&self, t: f64) -> f64 {
        let Jump { time, value, integral } = self.last(t);
        integral + value * (t - time)
    }

    /// Has this value from t on, later than all jumps so far; values that differ by less than `tolerance` are one.
    pub(super) fn jump(&mut self, time: f64, value: f64, tolerance: f64) {
        if (value - self.at(f64::INFINITY)).abs() > tolerance {
            self.jumps.push(Jump { time, value, integral: self.integral(time) });
        }
    }

    /// The instants of its jumps after t.
    pub(super) fn jumps_after(&self, t: f64) -> impl Iterator<Item = f64> {
        let first = self.jumps.partition_point(|jump| jump.time <= t);
        self.jumps[first..].iter().map(|jump| jump.time)
    }
}
