//! Given velocities against those of the displacements, at t_n and at other instants.

use super::attempt::{FALL, falls};
use super::balance::Motion;
use super::window::Window;
use super::{take_in, widest};
use crate::message::percent;
use percute_core::border::Vector;
use percute_core::time::TimeGrid;

/// What rows of velocities may hold instead of v_n.
const ELSEWHERE: [&str; 4] = [
    "the row of t_n holds the velocity of the middle of the step before it, v_{n-1/2}: it should be \
     v_{n-1/2} + a_n dt/2",
    "the row of t_n holds the velocity of the middle of the step after it, v_{n+1/2}: it should be \
     v_{n+1/2} - a_n dt/2",
    "they are a step too late: the row of t_n holds v_{n-1}",
    "they are a step too early: the row of t_n holds v_{n+1}",
];

/// Largest differences of given velocities from those of the displacements, each with the largest velocity (m/s).
#[derive(Clone, Debug, Default)]
pub(super) struct Rates {
    at_once: [f64; 2],
    elsewhere: [[f64; 2]; 4],
    /// The given velocities and those of the displacements at the instant before.
    before: Option<[Vec<Vector>; 2]>,
}

impl Rates {
    /// Takes in an instant with its motion.
    pub(super) fn take(&mut self, window: Window<'_>, motion: &Motion, times: &TimeGrid) {
        let now = window.now;
        let Some(given) = &now.velocity else { return };
        let derived: Vec<Vector> = match now.index.checked_sub(1) {
            None => motion.back.clone(),
            Some(before) => {
                let half = 0.5 * times.step(before);
                let pairs = motion.back.iter().zip(&motion.acceleration);
                pairs.map(|(v, a)| std::array::from_fn(|c| v[c] + half * a[c])).collect()
            }
        };
        take_in(&mut self.elsewhere[1], widest(given.as_flattened(), motion.forward.as_flattened()));
        if now.index > 0 {
            take_in(&mut self.at_once, widest(given.as_flattened(), derived.as_flattened()));
            take_in(&mut self.elsewhere[0], widest(given.as_flattened(), motion.back.as_flattened()));
        }
        if let Some([earlier, made]) = &self.before {
            take_in(&mut self.elsewhere[2], widest(given.as_flattened(), made.as_flattened()));
            take_in(&mut self.elsewhere[3], widest(earlier.as_flattened(), derived.as_flattened()));
        }
        self.before = Some([given.clone(), derived]);
    }

    /// The difference over the largest velocity; none without given velocities.
    pub(super) fn misfit(&self) -> Option<f64> {
        share(self.at_once)
    }

    /// What is wrong with them.
    pub(super) fn cause(&self) -> Option<String> {
        let misfit = self.misfit()?;
        let others = self.elsewhere.iter().zip(ELSEWHERE).filter_map(|(pair, text)| Some((share(*pair)?, text)));
        let (left, text) = others.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(if left <= FALL * misfit {
            format!(
                "the velocities are not those of t_n: {text}; read so, their largest difference falls {}. Or leave \
                 them out",
                falls(misfit, left)
            )
        } else {
            format!(
                "the velocities are not those of the displacements, they differ by {} of the largest; leave them out",
                percent(misfit)
            )
        })
    }
}

fn share([difference, largest]: [f64; 2]) -> Option<f64> {
    (largest > 0.0).then(|| difference / largest)
}
