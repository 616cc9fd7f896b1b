//! The impact of a uniform bar and its estimate, written down by hand for 1D: one candidate node,
//! constant steps, no loads. It shares no code with the program, only the formulas.
//!
//! Forces stand for stresses: N = Sσ, Q = SF_DA. Node 0 faces the plane, node n is free.

use percute_estimator::{Acceleration, Reconstruction};

/// A bar [0, L] of `elements` elements that flies at `speed` towards a plane at −`gap`; `steps`
/// steps of `courant` h/c.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bar {
    pub(crate) elements: usize,
    pub(crate) length: f64,
    pub(crate) young: f64,
    pub(crate) density: f64,
    pub(crate) section: f64,
    pub(crate) speed: f64,
    pub(crate) gap: f64,
    pub(crate) courant: f64,
    pub(crate) steps: usize,
}

/// One t_n of the simulation.
#[derive(Clone, Debug)]
struct Instant {
    /// v_{n−½} and v_n.
    half: Vec<f64>,
    velocity: Vec<f64>,
    /// N of the elements, and the acceleration that they alone give.
    force: Vec<f64>,
    free: Vec<f64>,
    reaction: f64,
    touching: bool,
}

/// u_CA and u̇_CA at a half-step instant.
type Motion = (Vec<f64>, Vec<f64>);

/// What comes out: e_sup, e_mean, D_sup, √mean d, and e_E.
#[derive(Clone, Debug)]
pub(crate) struct HandEstimate {
    pub(crate) sup: f64,
    pub(crate) mean: f64,
    pub(crate) reference_sup: f64,
    pub(crate) reference_mean: f64,
    pub(crate) by_element: Vec<f64>,
    /// Whether node 0 stays out of the plane at the half-step instants: else P_CA has another solution.
    pub(crate) admissible: bool,
}

impl Bar {
    pub(crate) fn element(&self) -> f64 {
        self.length / self.elements as f64
    }

    pub(crate) fn step(&self) -> f64 {
        self.courant * self.element() / (self.young / self.density).sqrt()
    }

    /// Lumped mass of an element at one of its nodes.
    fn share(&self) -> f64 {
        0.5 * self.density * self.section * self.element()
    }

    fn mass(&self, node: usize) -> f64 {
        if node == 0 || node == self.elements { self.share() } else { 2.0 * self.share() }
    }

    /// N of each element.
    fn forces(&self, u: &[f64]) -> Vec<f64> {
        u.windows(2).map(|u| self.young * self.section * (u[1] - u[0]) / self.element()).collect()
    }

    /// Central differences with a multiplier at node 0, method.md §2.
    fn simulate(&self) -> Vec<Instant> {
        let (n, dt) = (self.elements, self.step());
        let (mut u, mut v) = (vec![0.0; n + 1], vec![-self.speed; n + 1]);
        let mut touching = false;
        let mut history = Vec::new();
        for k in 0..=self.steps {
            let force = self.forces(&u);
            let pull = |i: usize| if i < n { force[i] } else { 0.0 } - if i > 0 { force[i - 1] } else { 0.0 };
            let free: Vec<f64> = (0..=n).map(|i| pull(i) / self.mass(i)).collect();
            let length = if k == 0 { 0.5 * dt } else { dt };
            let predicted = self.gap + u[0] + dt * (v[0] + length * free[0]);
            let next = predicted < -1e-12 * self.length;
            let reaction = if next { -self.mass(0) * predicted / (dt * length) } else { 0.0 };
            let mut total = free.clone();
            total[0] += reaction / self.mass(0);
            let half = v.clone();
            let back = if k == 0 { 0.0 } else { 0.5 * dt };
            let velocity = (0..=n).map(|i| v[i] + back * total[i]).collect();
            history.push(Instant { half, velocity, force, free, reaction, touching });
            for i in 0..=n {
                v[i] += length * total[i];
                u[i] += dt * v[i];
            }
            touching = next;
        }
        history
    }

    /// N of the elements, and the acceleration that they alone give, which the balance is built on: the simulation's,
    /// or for `corrected` those of the same bar under the same pushes, with a + (Δt_c² − Δt²)/12 · K a/M for each
    /// acceleration a, and less (Δt_c²/6)² (K/M)² a/36: on a uniform bar that is what is left of (h²/12c² − Δt²/12),
    /// and β.
    fn sources(&self, history: &[Instant], reconstruction: Reconstruction) -> Vec<(Vec<f64>, Vec<f64>)> {
        if reconstruction != Reconstruction::Corrected {
            return history.iter().map(|i| (i.force.clone(), i.free.clone())).collect();
        }
        let (n, dt) = (self.elements, self.step());
        let over_mass = |force: &[f64]| -> Vec<f64> {
            let pull = |i: usize| if i < n { force[i] } else { 0.0 } - if i > 0 { force[i - 1] } else { 0.0 };
            (0..=n).map(|i| pull(i) / self.mass(i)).collect()
        };
        let critical = dt * dt / (self.courant * self.courant);
        let (left, damping) = ((critical - dt * dt) / 12.0, critical * critical / 36.0 / 36.0);
        let (mut u, mut v) = (vec![0.0; n + 1], vec![-self.speed; n + 1]);
        let mut made = Vec::new();
        for (k, smoothed) in self.smoothed_reactions(history).into_iter().enumerate() {
            let force = self.forces(&u);
            let free = over_mass(&force);
            let mut a = free.clone();
            a[0] += smoothed / self.mass(0);
            let correction = over_mass(&self.forces(&a));
            let again = over_mass(&self.forces(&correction));
            for i in 0..=n {
                v[i] += if k == 0 { 0.5 * dt } else { dt } * (a[i] - left * correction[i] - damping * again[i]);
                u[i] += dt * v[i];
            }
            made.push((force, free));
        }
        made
    }

    /// What `corrected` adds at each half-step instant: Q·gap, and ∫R|w| up to there by the trapezoidal rule.
    fn normal_law(&self, history: &[Instant], motions: &[Motion], reconstruction: Reconstruction) -> Vec<f64> {
        let smoothed = self.smoothed_reactions(history);
        // Linear in time over each step.
        let at = |force: &dyn Fn(usize) -> f64, k: usize| 0.5 * (force(k / 2) + force(k.div_ceil(2)));
        let push = |k: usize| at(&|n| smoothed[n], k);
        // The reaction as it was does the work, whatever goes on of it.
        let stop = |k: usize| at(&|n| history[n].reaction.max(0.0), k);
        let mut work = 0.0;
        let mut made = Vec::new();
        for (k, (u, v)) in motions.iter().enumerate() {
            if reconstruction != Reconstruction::Corrected {
                made.push(0.0);
                continue;
            }
            if k > 0 {
                work += 0.25 * self.step() * (stop(k - 1) * motions[k - 1].1[0].abs() + stop(k) * v[0].abs());
            }
            made.push(push(k) * (self.gap + u[0]).max(0.0) + work);
        }
        made
    }

    /// Problem P_CA at node 0: each window before a contact phase is shifted so that the integral of
    /// the velocity closes the gap; in contact the velocity is zero.
    fn contact_velocity(&self, history: &[Instant]) -> Vec<f64> {
        let half = 0.5 * self.step();
        let mut velocity = vec![history[0].velocity[0]];
        for instant in &history[1..] {
            velocity.extend([instant.half[0], instant.velocity[0]]);
        }
        let (mut start, mut gap) = (0, self.gap);
        let mut n = 1;
        while n <= self.steps {
            if history[n].touching {
                let travelled: f64 = half * (0.5 * velocity[start] + velocity[start + 1..2 * n].iter().sum::<f64>());
                let shift = (gap + travelled) / (half * (2 * n - 1 - start) as f64);
                velocity[start + 1..2 * n].iter_mut().for_each(|v| *v -= shift);
                while n < self.steps && history[n + 1].touching {
                    velocity[2 * n..=2 * n + 1].fill(0.0);
                    n += 1;
                }
                velocity[2 * n] = 0.0;
                (start, gap) = (2 * n, 0.0);
            }
            n += 1;
        }
        velocity
    }

    /// u_CA and u̇_CA at all half-step instants; displacement is the exact integral.
    fn kinematic(&self, history: &[Instant]) -> Vec<Motion> {
        let contact = self.contact_velocity(history);
        let mut motions: Vec<Motion> = vec![(vec![0.0; self.elements + 1], history[0].velocity.clone())];
        for (k, &end) in contact.iter().enumerate().skip(1) {
            let n = k.div_ceil(2);
            let mut velocity = if k % 2 == 1 { history[n].half.clone() } else { history[n].velocity.clone() };
            velocity[0] = end;
            let (u, v) = &motions[k - 1];
            let u = (0..u.len()).map(|i| u[i] + 0.25 * self.step() * (v[i] + velocity[i])).collect();
            motions.push((u, velocity));
        }
        motions
    }

    /// What `corrected` presses with: of a reaction R, the part ma that stops node 0 goes on with weights 1 − s/τ until
    /// τ = m/(ρcS) = h/2c later.
    fn smoothed_reactions(&self, history: &[Instant]) -> Vec<f64> {
        let (dt, tau) = (self.step(), 0.5 * self.element() / (self.young / self.density).sqrt());
        let weights: Vec<f64> = (0..).map(|j| 1.0 - j as f64 * dt / tau).take_while(|w| *w > 0.0).collect();
        let all: f64 = weights.iter().sum();
        let mut made = vec![0.0; history.len()];
        for (k, now) in history.iter().enumerate().filter(|(_, now)| now.reaction > 0.0) {
            let braking = self.mass(0) * (now.free[0] + now.reaction / self.mass(0));
            let share = (braking / now.reaction).clamp(0.0, 1.0);
            made[k] += (1.0 - share) * now.reaction;
            for (made, weight) in made[k..].iter_mut().zip(&weights) {
                *made += share * now.reaction * weight / all;
            }
        }
        made
    }

    /// Q at the two ends of the step from t_n to t_{n+1}, method.md §4.
    fn contact_force(&self, history: &[Instant], n: usize, reconstruction: Reconstruction) -> [f64; 2] {
        let touches = |k: usize| history[k].touching;
        let pushes = |k: usize| history[k].reaction.max(0.0);
        let smoothed = self.smoothed_reactions(history);
        // [45]–[48]: from one step after the first touch to one before the last.
        let keeps = |k: usize| k > 0 && touches(k - 1) && touches(k) && (k == self.steps || touches(k + 1));
        [n, n + 1].map(|k| match reconstruction {
            Reconstruction::Published if keeps(k) => pushes(k),
            Reconstruction::Consistent if touches(n) && touches(n + 1) => pushes(k),
            Reconstruction::Corrected => smoothed[k],
            _ => 0.0,
        })
    }

    /// M⁻¹(M − M_c) of a nodal field at a node: an element of mass m gives m/6 times the difference to its other node.
    fn lumping_difference(&self, field: &[f64], i: usize) -> f64 {
        let apart = |other: Option<&f64>| other.map_or(0.0, |other| field[i] - other);
        let sum = apart(i.checked_sub(1).map(|j| &field[j])) + apart(field.get(i + 1));
        self.share() / 3.0 * sum / self.mass(i)
    }

    /// η_E and d_E of an element: ã and its integral at its ends, Q, N of the simulation in the
    /// element and its neighbours, and the kinematic field.
    fn measure(&self, e: usize, state: &State<'_>, choice: Acceleration) -> [f64; 2] {
        let (h, inertia) = (self.element(), self.density * self.section);
        let gamma = |nodal: &[f64]| {
            let (a, b) = (nodal[e], nodal[e + 1]);
            match choice {
                Acceleration::Closest => [a, b],
                Acceleration::Rigid => [0.5 * (a + b); 2],
                // (2Γ_0 + Γ_1)/6 = ã_0/2.
                Acceleration::Weak => [2.0 * a - b, 2.0 * b - a],
                Acceleration::Split => {
                    let mean = 0.5 * (self.lumping_difference(nodal, e) + self.lumping_difference(nodal, e + 1));
                    [a + mean, b + mean]
                }
            }
        };
        let (acceleration, gained) = (gamma(state.acceleration), gamma(state.gained));
        let force = state.force;
        let left = match (e, choice) {
            (0, _) => -state.push,
            // N + (M_c ã + M o of the element before at its end): on a bar, o is all that M_c ã lacks.
            (_, Acceleration::Split) => {
                let (before, here) = (state.acceleration[e - 1], state.acceleration[e]);
                let difference = self.lumping_difference(state.acceleration, e);
                force[e - 1] + self.share() * ((2.0 * here + before) / 3.0 + difference)
            }
            _ => 0.5 * (force[e - 1] + force[e]),
        };
        let (u, v) = state.motion;
        let own = self.young * self.section * (u[e + 1] - u[e]) / h;
        let (mut error, mut sum) = (0.0, 0.0);
        // Three Gauss points: exact to degree 5, the squares have 4.
        for (at, weight) in [(-(0.6_f64.sqrt()), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6_f64.sqrt(), 5.0 / 18.0)] {
            let s = 0.5 + 0.5 * at;
            let line = |[a, b]: [f64; 2]| a + s * (b - a);
            let (dynamic, kinematic) = (-self.speed + line(gained), line([v[e], v[e + 1]]));
            let [a, b] = acceleration;
            let stress = left + inertia * h * s * (a + 0.5 * s * (b - a));
            let stiffness = self.young * self.section;
            let square = |x: f64, y: f64| h * weight * (inertia * x * x + y * y / stiffness);
            error += 0.5 * square(dynamic - kinematic, stress - own);
            sum += square(dynamic + kinematic, stress + own);
        }
        [error, sum]
    }

    /// The whole estimate.
    pub(crate) fn estimate(&self, reconstruction: Reconstruction, choice: Acceleration, every: usize) -> HandEstimate {
        let (n, dt) = (self.elements, self.step());
        let history = self.simulate();
        let motions = self.kinematic(&history);
        let sources = self.sources(&history, reconstruction);
        let normal_law = self.normal_law(&history, &motions, reconstruction);
        let mut gained = vec![0.0; n + 1];
        let mut totals = Totals::new(n);
        let mut opened = vec![[0.0; 2]; n];
        for k in 0..self.steps {
            let ((from_force, from_free), (to_force, to_free)) = (&sources[k], &sources[k + 1]);
            let [start_push, end_push] = self.contact_force(&history, k, reconstruction);
            let (mut start, mut end) = (from_free.clone(), to_free.clone());
            start[0] += start_push / self.mass(0);
            end[0] += end_push / self.mass(0);
            let elements = |instant: usize, acceleration: &[f64], gained: &[f64], force: &[f64], push: f64| {
                let state = State { acceleration, gained, force, push, motion: &motions[instant] };
                let mut all: Vec<_> = (0..n).map(|e| self.measure(e, &state, choice)).collect();
                // The contact part belongs to the element at the plane, and to d as well.
                all[0].iter_mut().for_each(|x| *x += normal_law[instant]);
                all
            };
            if k % every == 0 {
                opened = elements(2 * k, &start, &gained, from_force, start_push);
            }
            let halfway = mix(&gained, &mix(&start, &end, 0.375 * dt, 0.125 * dt), 1.0, 1.0);
            gained = mix(&gained, &mix(&start, &end, 0.5 * dt, 0.5 * dt), 1.0, 1.0);
            let (first, last) = (k - k % every, (k + 1) % every == 0 || k + 1 == self.steps);
            if last {
                let closed = elements(2 * k + 2, &end, &gained, to_force, end_push);
                let middle = (first == k).then(|| {
                    let acceleration = mix(&start, &end, 0.5, 0.5);
                    let force = mix(from_force, to_force, 0.5, 0.5);
                    elements(2 * k + 1, &acceleration, &halfway, &force, 0.5 * (start_push + end_push))
                });
                totals.add((k + 1 - first) as f64 * dt, &opened, middle.as_deref(), &closed);
            }
        }
        let admissible = motions.iter().all(|(u, _)| self.gap + u[0] >= -1e-13 * self.length);
        totals.finish(self.steps as f64 * dt, admissible)
    }
}

/// x a + y b.
fn mix(a: &[f64], b: &[f64], x: f64, y: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| x * a + y * b).collect()
}

/// Everything [`Bar::measure`] needs at one instant.
struct State<'a> {
    acceleration: &'a [f64],
    gained: &'a [f64],
    force: &'a [f64],
    push: f64,
    motion: &'a Motion,
}

/// Largest values and trapezoidal integrals of η and d.
struct Totals {
    sup: [f64; 2],
    integral: [f64; 2],
    elements: Vec<f64>,
}

impl Totals {
    fn new(n: usize) -> Self {
        Self { sup: [0.0; 2], integral: [0.0; 2], elements: vec![0.0; n] }
    }

    /// Adds an interval of η_E and d_E at its beginning, perhaps middle, and end.
    fn add(&mut self, length: f64, start: &[[f64; 2]], middle: Option<&[[f64; 2]]>, end: &[[f64; 2]]) {
        let mut samples = vec![(start, 1.0), (end, 1.0)];
        if let Some(middle) = middle {
            samples.push((middle, 2.0));
        }
        let weights: f64 = samples.iter().map(|s| s.1).sum();
        for (values, weight) in samples {
            let share = length * weight / weights;
            for which in 0..2 {
                let total: f64 = values.iter().map(|v| v[which]).sum();
                self.sup[which] = self.sup[which].max(total);
                self.integral[which] += share * total;
            }
            values.iter().zip(&mut self.elements).for_each(|(v, sum)| *sum += share * v[0]);
        }
    }

    fn finish(self, end: f64, admissible: bool) -> HandEstimate {
        HandEstimate {
            sup: self.sup[0].sqrt(),
            mean: (self.integral[0] / end).sqrt(),
            reference_sup: self.sup[1].sqrt(),
            reference_mean: (self.integral[1] / end).sqrt(),
            by_element: self.elements.iter().map(|i| (i / end).sqrt()).collect(),
            admissible,
        }
    }
}
