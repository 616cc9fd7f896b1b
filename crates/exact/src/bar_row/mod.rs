//! Bars in a row that strike each other.

mod signal;
#[cfg(test)]
mod tests;

use signal::Signal;

/// Events that are nearer to each other than this part of the shortest passage are one: instants are sums of passages.
const TOGETHER: f64 = 1e-9;
/// Velocities that differ by less than this part of the largest one are equal.
const EQUAL: f64 = 1e-12;

/// A uniform bar of a row, undeformed on [start, start + length] at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowBar {
    /// Its end of lower x (m).
    pub start: f64,
    /// L (m).
    pub length: f64,
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Density ρ (kg/m³).
    pub density: f64,
    /// Section S (m²).
    pub section: f64,
    /// Velocity at t = 0 along x, with its sign (m/s).
    pub velocity: f64,
}

impl RowBar {
    /// c = √(E/ρ) (m/s).
    #[must_use]
    pub fn wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// Z = ρcS (N s/m).
    #[must_use]
    pub fn impedance(&self) -> f64 {
        self.density * self.wave_speed() * self.section
    }

    /// L/c (s).
    fn passage(&self) -> f64 {
        self.length / self.wave_speed()
    }

    /// The end of higher x (m).
    fn end(&self) -> f64 {
        self.start + self.length
    }
}

/// Uniform bars in a row on one axis, free at both ends, that strike each other, part, and meet again.
///
/// Source: the longitudinal impact of bars by travelling waves, Timoshenko and Goodier, *Theory of Elasticity*,
/// "Longitudinal impact of bars" (after de Saint-Venant, 1867). The closed form is d'Alembert's, derived here.
///
/// In each bar, v = p + q and N = Z(q − p), where the wave p(t − ξ/c) leaves the end of lower x and q(t − (L − ξ)/c)
/// the other one, with ξ the distance from the lower end. At first both are half of the velocity of the bar. A free end
/// sends back what arrives. Where a wave a arrives from the left at two ends that touch and b from the right, the ends
/// move together with V = 2(Z₁a + Z₂b)/(Z₁ + Z₂) and press with 2(a − b)/(1/Z₁ + 1/Z₂) while that is positive; with
/// a < b they part. As all velocities are constant between jumps, so are p and q. The solution follows jump by jump,
/// from the instants at which a jump arrives at an end and those at which a gap closes.
#[derive(Clone, Debug, PartialEq)]
pub struct BarRow {
    bars: Vec<RowBar>,
    /// Of each bar, the waves p and q as they leave their end.
    sent: Vec<[Signal; 2]>,
    /// Of each interface, the intervals in which the bars press on each other (s).
    contacts: Vec<Vec<[f64; 2]>>,
}

impl BarRow {
    /// The bars in the order of x up to the time `end` (s). `None` unless lengths, moduli, densities, sections and
    /// `end` are positive, all is finite, and no bar starts before the end of the one before; bars may touch.
    #[must_use]
    pub fn new(bars: &[RowBar], end: f64) -> Option<Self> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let of_bar = |bar: &RowBar| {
            [bar.length, bar.young, bar.density, bar.section].into_iter().all(positive)
                && bar.start.is_finite()
                && bar.velocity.is_finite()
        };
        let ordered = bars.windows(2).all(|pair| pair[1].start >= pair[0].end());
        if bars.is_empty() || !bars.iter().all(of_bar) || !ordered || !positive(end) {
            return None;
        }
        let sent = bars.iter().map(|bar| [0.5, 0.5].map(|half| Signal::new(half * bar.velocity))).collect();
        let mut row = Self { bars: bars.to_vec(), sent, contacts: vec![Vec::new(); bars.len() - 1] };
        row.solve(end);
        Some(row)
    }

    /// The bars.
    #[must_use]
    pub fn bars(&self) -> &[RowBar] {
        &self.bars
    }

    /// The intervals in which bar `first` and the next one press on each other (s); the last one is cut at the end.
    ///
    /// # Panics
    /// If there is no such interface.
    #[must_use]
    pub fn contacts(&self, first: usize) -> &[[f64; 2]] {
        &self.contacts[first]
    }

    /// Displacement at x in bar `bar` (m).
    ///
    /// # Panics
    /// Like all fields, if there is no such bar.
    #[must_use]
    pub fn displacement(&self, bar: usize, x: f64, t: f64) -> f64 {
        let since = |(signal, delay): (&Signal, f64)| signal.integral(t - delay) - signal.integral(-delay);
        self.waves(bar, x).map(since).iter().sum()
    }

    /// Velocity at a place and an instant, as [`BarRow::displacement`] (m/s).
    #[must_use]
    pub fn velocity(&self, bar: usize, x: f64, t: f64) -> f64 {
        let [p, q] = self.arrived(bar, x, t);
        p + q
    }

    /// Normal force at a place and an instant, as [`BarRow::displacement`] (N), tension positive.
    #[must_use]
    pub fn normal_force(&self, bar: usize, x: f64, t: f64) -> f64 {
        let [p, q] = self.arrived(bar, x, t);
        self.bars[bar].impedance() * (q - p)
    }

    /// Force with which bar `first` and the next one press on each other (N).
    #[must_use]
    pub fn contact_force(&self, first: usize, t: f64) -> f64 {
        -self.normal_force(first, self.bars[first].end(), t)
    }

    /// The places in a bar at which v and N jump at the time t (m), in ascending order.
    #[must_use]
    pub fn fronts(&self, bar: usize, t: f64) -> Vec<f64> {
        let body = &self.bars[bar];
        let (c, from) = (body.wave_speed(), t - body.passage());
        let [p, q] = &self.sent[bar];
        let inside = |x: &f64| (body.start..=body.end()).contains(x);
        let forward = p.jumps_after(from).map(|jump| body.start + c * (t - jump));
        let backward = q.jumps_after(from).map(|jump| body.end() - c * (t - jump));
        let mut places: Vec<f64> = forward.chain(backward).filter(inside).collect();
        places.sort_by(f64::total_cmp);
        places
    }

    /// Both waves of a bar, each with its delay up to x (s).
    fn waves(&self, bar: usize, x: f64) -> [(&Signal, f64); 2] {
        let body = &self.bars[bar];
        let c = body.wave_speed();
        let [p, q] = &self.sent[bar];
        [(p, (x - body.start) / c), (q, (body.end() - x) / c)]
    }

    /// Both waves of a bar at x.
    fn arrived(&self, bar: usize, x: f64, t: f64) -> [f64; 2] {
        self.waves(bar, x).map(|(signal, delay)| signal.at(t - delay))
    }

    /// Follows the waves from event to event.
    fn solve(&mut self, end: f64) {
        let together = TOGETHER * self.bars.iter().map(RowBar::passage).fold(f64::INFINITY, f64::min);
        let fastest = self.bars.iter().map(|bar| bar.velocity.abs()).fold(0.0, f64::max);
        let equal = EQUAL * fastest;
        let mut gaps: Vec<f64> = self.bars.windows(2).map(|pair| pair[1].start - pair[0].end()).collect();
        let mut time = 0.0;
        while time < end {
            let opening = self.send(time, together, equal, &gaps);
            let arrivals = self.sent.iter().zip(&self.bars).flat_map(|(waves, bar)| {
                let after = time + together - bar.passage();
                waves.iter().filter_map(move |wave| Some(wave.jumps_after(after).next()? + bar.passage()))
            });
            let closing = gaps.iter().zip(&opening).filter(|(gap, rate)| **gap > 0.0 && **rate < -equal);
            let next = arrivals.chain(closing.map(|(gap, rate)| time - gap / rate)).fold(end, f64::min);
            for (gap, rate) in gaps.iter_mut().zip(&opening) {
                let after = *gap + rate * (next - time);
                *gap = if after <= together * fastest { 0.0 } else { after };
            }
            time = next;
        }
        for interval in self.contacts.iter_mut().filter_map(|intervals| intervals.last_mut()) {
            interval[1] = interval[1].min(end);
        }
    }

    /// Sends the waves of all ends from an event on, and gives the speed at which each gap opens (m/s).
    fn send(&mut self, time: f64, together: f64, equal: f64, gaps: &[f64]) -> Vec<f64> {
        let arrive = |(waves, bar): (&[Signal; 2], &RowBar)| {
            // At the end of lower x the wave q, at the other one p.
            [1, 0].map(|wave: usize| waves[wave].at(time + together - bar.passage()))
        };
        let arrived: Vec<[f64; 2]> = self.sent.iter().zip(&self.bars).map(arrive).collect();
        let mut leaving = arrived.clone();
        let mut opening = Vec::with_capacity(gaps.len());
        for (first, gap) in gaps.iter().enumerate() {
            let (a, b) = (arrived[first][1], arrived[first + 1][0]);
            let press = *gap <= 0.0 && a - b > equal;
            if press {
                let [z1, z2] = [first, first + 1].map(|bar| self.bars[bar].impedance());
                let common = 2.0 * (z1 * a + z2 * b) / (z1 + z2);
                leaving[first][1] = common - a;
                leaving[first + 1][0] = common - b;
            }
            opening.push(if press { 0.0 } else { 2.0 * (b - a) });
            record(&mut self.contacts[first], time, press);
        }
        for (waves, leaving) in self.sent.iter_mut().zip(leaving) {
            waves.iter_mut().zip(leaving).for_each(|(wave, value)| wave.jump(time, value, equal));
        }
        opening
    }
}

/// Opens or ends an interval; one that is open ends at infinity.
fn record(intervals: &mut Vec<[f64; 2]>, time: f64, press: bool) {
    let open = intervals.last_mut().filter(|interval| interval[1] == f64::INFINITY);
    match open {
        Some(interval) if !press => interval[1] = time,
        None if press => intervals.push([time, f64::INFINITY]),
        _ => {}
    }
}
