//! The energies of the simulation and of the auxiliary solution, and the energy that contact gives to the latter.

use super::response::dot;
use super::surface::SurfaceForces;
use percute_core::problem::Problem;
use percute_core::ratio;
use std::array::from_fn;

/// The energies of both so far.
#[derive(Debug)]
pub(in crate::reconstruction::corrected) struct EnergyBalance<const D: usize> {
    /// Largest kinetic and strain energy of the simulation (J).
    peak: f64,
    /// The same without that of the common velocity along `free` (J).
    peak_relative: f64,
    free: FreeDirections<D>,
    /// ½ v·M v of the auxiliary solution half a step after the last level (J).
    kinetic: f64,
    contact_work: ContactWork,
    driven: bool,
}

impl<const D: usize> EnergyBalance<D> {
    /// Before the first level.
    pub(super) fn new(problem: &Problem<D>) -> Self {
        Self {
            peak: 0.0,
            peak_relative: 0.0,
            free: FreeDirections::new(problem),
            kinetic: 0.0,
            contact_work: ContactWork::default(),
            driven: is_driven(problem),
        }
    }

    /// Takes in a level: the energy and velocity of the simulation (J, m/s), the kinetic energy of the auxiliary
    /// solution half a step later (J), and the work of contact on it (J).
    pub(super) fn add(
        &mut self,
        problem: &Problem<D>,
        [simulated, kinetic]: [f64; 2],
        velocity: &[[f64; D]],
        work: f64,
    ) {
        self.peak = self.peak.max(simulated);
        self.peak_relative = self.peak_relative.max(simulated - self.free.energy(problem, velocity));
        self.kinetic = kinetic;
        self.contact_work.add(work);
    }

    /// The largest energy that contact has given the auxiliary solution so far, over that of the simulation without
    /// the common velocity that no plane stops. Loads and supports may give that velocity and take back what contact
    /// gives: with them it counts.
    pub(super) fn contact_energy(&self) -> f64 {
        ratio(self.contact_work.most, if self.driven { self.peak } else { self.peak_relative })
    }

    /// Whether the kinetic energy of the auxiliary solution is beyond so many times the energy of the simulation, as it
    /// becomes where a history of another scheme takes steps above the critical one. A stable one has about the energy
    /// of the simulation, an unstable one soon any.
    pub(super) fn is_beyond(&self, factor: f64) -> bool {
        // A body that starts unstrained at rest has no energy before it is loaded.
        self.kinetic.is_nan() || (self.peak > 0.0 && self.kinetic > factor * self.peak)
    }

    /// The work of contact so far (J): now, and its largest.
    #[cfg(test)]
    pub(super) fn work(&self) -> [f64; 2] {
        [self.contact_work.sum, self.contact_work.most]
    }
}

/// The work of the normal forces of F_DA, Σf_n·(u_{n+1} − u_{n−1})/2. With equal steps, this is what they add to an
/// energy that the corrected scheme keeps. Planes have none to give, and bodies that strike each other only their own:
/// a sum that becomes large is that of forces that do not fit the motion. Friction takes energy, and is left out,
/// unless loads or supports give what it takes.
#[derive(Clone, Copy, Debug, Default)]
struct ContactWork {
    sum: f64,
    most: f64,
}

impl ContactWork {
    /// Takes in the work of a level (J).
    fn add(&mut self, work: f64) {
        self.sum += work;
        self.most = self.most.max(self.sum);
    }
}

/// Whether loads or supports may give and take energy, too.
fn is_driven<const D: usize>(problem: &Problem<D>) -> bool {
    problem.is_loaded() || !problem.prescribed().is_empty()
}

/// The work (J) of the normal parts of forces (N) on the contact nodes over half of this time (s), at the velocities of
/// the half step; of whole forces where the problem is driven. Forces along supports act on these.
pub(super) fn half_work<const D: usize>(
    (problem, surface): (&Problem<D>, &SurfaceForces),
    half_step: impl Fn(usize) -> [f64; D],
    forces: &[[f64; D]],
    time: f64,
) -> f64 {
    let whole = is_driven(problem);
    let of = |node: usize, obstacle: usize, force: &[f64; D]| {
        let mut velocity = half_step(node);
        surface.prescribed(&(node..node + 1)).for_each(|(_, c)| velocity[c] = 0.0);
        let frame = problem.obstacles()[obstacle].flat_frame();
        if whole { dot(&velocity, force) } else { frame.split(&velocity).0 * frame.split(force).0 }
    };
    let nodes = problem.surface().nodes().iter().zip(forces).filter(|(_, force)| **force != [0.0; D]);
    0.5 * time * nodes.map(|(contact, force)| of(contact.node.index(), contact.obstacle, force)).sum::<f64>()
}

/// ½ v·M v of velocities (J).
pub(super) fn kinetic_energy<const D: usize>(problem: &Problem<D>, velocity: &[[f64; D]]) -> f64 {
    let moving = velocity.iter().zip(problem.mass());
    moving.map(|(v, m)| 0.5 * m * v.iter().map(|v| v * v).sum::<f64>()).sum()
}

/// The directions in which no plane stops the bodies. A common velocity along them changes nothing in contact.
#[derive(Debug)]
struct FreeDirections<const D: usize>(Vec<[f64; D]>);

impl<const D: usize> FreeDirections<D> {
    fn new(problem: &Problem<D>) -> Self {
        /// Normals whose difference is below this are parallel: far above rounding.
        const PARALLEL: f64 = 1e-6;
        let planes = problem.obstacles().iter().filter(|obstacle| obstacle.as_plane().is_some());
        let normals = planes.map(|plane| (*plane.flat_frame().normal(), false));
        let axes = (0..D).map(|axis| (from_fn(|c| if c == axis { 1.0 } else { 0.0 }), true));
        let (mut basis, mut free): (Vec<[f64; D]>, _) = (Vec::new(), Vec::new());
        for (direction, is_free) in normals.chain(axes) {
            let rest = basis.iter().fold(direction, |rest, unit| {
                let along = dot(unit, &rest);
                from_fn(|c| rest[c] - along * unit[c])
            });
            let length = dot(&rest, &rest).sqrt();
            if length > PARALLEL {
                let unit = rest.map(|x| x / length);
                basis.push(unit);
                free.extend(is_free.then_some(unit));
            }
        }
        Self(free)
    }

    /// The kinetic energy of the common velocity along them (J).
    fn energy(&self, problem: &Problem<D>, velocity: &[[f64; D]]) -> f64 {
        if self.0.is_empty() {
            return 0.0;
        }
        let (mut mass, mut momentum) = (0.0, [0.0; D]);
        for (m, v) in problem.mass().iter().zip(velocity) {
            mass += m;
            (0..D).for_each(|c| momentum[c] += m * v[c]);
        }
        self.0.iter().map(|unit| 0.5 * dot(unit, &momentum).powi(2) / mass).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::*;
    use super::FreeDirections;
    use percute_core::contact::Obstacle;
    use percute_core::dynamics::critical_time_step;
    use percute_core::load::Support;
    use percute_core::material::Elastic;
    use percute_testkit::{Random, random_rectangle};

    /// A body with a support, and with a plane that all its boundary may touch.
    fn held() -> Problem<2> {
        Problem::<2>::builder(random_rectangle(1.0, 0.8, 5, 3).unwrap())
            .material(Elastic::plane_strain(70.0, 0.3, 2.0, 0.5).unwrap())
            .obstacle(Obstacle::plane([0.0, -10.0], [0.0, 1.0], 0.0, None).unwrap())
            .support(Support { group: "left".into(), components: [false, true, false], velocity: None })
            .build()
            .unwrap()
    }

    /// Without corrections, the work of normal contact forces is what they add to ½v·Mv + ½u_n·Ku_{n+1}, which the
    /// scheme keeps without forces. Those along the support add nothing.
    #[test]
    fn work_is_what_the_energy_gains() {
        let (problem, steps) = (held(), 40);
        let dt = 0.7 * critical_time_step(&problem);
        let times = TimeGrid::uniform(dt * steps as f64, steps).unwrap();
        let dynamics = Dynamics::new(&problem, &times);
        let mut motions =
            AuxiliarySolutions::<2, 3>::new(&problem, &times, Arc::new(Smoothing::new(&problem)), Shares::NONE);
        let (count, mut random) = (problem.mesh().node_count(), Random::new(4));
        let (mut displacements, mut sums) = (Vec::new(), Vec::new());
        for n in 0..=steps {
            let mut pull: Vec<[f64; 2]> =
                problem.surface().nodes().iter().map(|_| [0.0, random.between(-1.0, 1.0)]).collect();
            for (contact, pull) in problem.surface().nodes().iter().zip(&mut pull) {
                let held = problem.prescribed().iter().any(|held| held.node == contact.node);
                pull[1] *= if held { 0.0 } else { 1.0 };
            }
            let (mut displacement, mut acceleration) = (vec![[0.0; 2]; count], vec![[0.0; 2]; count]);
            let level =
                AuxiliaryLevel { displacement: &mut displacement, acceleration: &mut acceleration, split: None };
            motions.begin(&dynamics, n);
            let still = vec![[0.0; 2]; count];
            let simulated = SimulatedLevel { velocity: &still, strain: 0.0, reaction: &pull };
            motions.advance(&dynamics, n, &simulated, &pull, level);
            displacements.push(displacement);
            sums.push(motions.energy_balance.work()[0]);
        }
        let product = |a: &[[f64; 2]], b: &[[f64; 2]]| -> f64 {
            a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a * b).sum()
        };
        let energy = |now: &[[f64; 2]], next: &[[f64; 2]]| {
            let mut internal = vec![[0.0; 2]; count];
            dynamics.subtract_internal_forces(now, &mut internal);
            let moved = next.iter().zip(now).zip(problem.mass());
            let kinetic: f64 =
                moved.map(|((next, now), m)| (0..2).map(|c| m * (next[c] - now[c]).powi(2)).sum::<f64>()).sum();
            0.5 * kinetic / (dt * dt) - 0.5 * product(next, &internal)
        };
        let energies: Vec<f64> = displacements.windows(2).map(|pair| energy(&pair[0], &pair[1])).collect();
        let largest = energies.iter().fold(0.0_f64, |m, e| m.max(*e));
        for (n, found) in energies.iter().enumerate() {
            let gained = sums[n] - sums[0];
            // Rounding of some hundred terms.
            assert!((found - energies[0] - gained).abs() < 1e-11 * largest, "{n}: {found} for {gained}");
        }
        let most = sums.iter().fold(0.0_f64, |most, sum| most.max(*sum));
        assert!(most > 0.1 * largest && motions.energy_balance.work()[1] == most, "{most} of {largest}");
    }

    /// A common velocity is taken from the energy where no plane stops it: along one plane, in no direction of two that
    /// cross, in all without any.
    #[test]
    fn a_common_velocity_counts_where_a_plane_stops_it() {
        let energy = |normals: &[[f64; 2]]| {
            let mut builder = Problem::<2>::builder(random_rectangle(1.0, 0.8, 5, 3).unwrap())
                .material(Elastic::plane_strain(70.0, 0.3, 2.0, 0.5).unwrap());
            for (normal, group) in normals.iter().zip(["bottom", "top"]) {
                let point = normal.map(|x| -10.0 * x);
                builder = builder.obstacle(Obstacle::plane(point, *normal, 0.0, Some(group.into())).unwrap());
            }
            let problem = builder.build().unwrap();
            FreeDirections::new(&problem).energy(&problem, &vec![[3.0, 4.0]; problem.mesh().node_count()])
        };
        // The mass is 0.8 kg.
        for (normals, free) in [
            (&[][..], 25.0),
            (&[[0.0, 1.0]], 9.0),
            (&[[0.0, 1.0], [0.0, -1.0]], 9.0),
            (&[[0.0, 1.0], [-0.6, -0.8]], 0.0),
        ] {
            assert!((energy(normals) - 0.4 * free).abs() < 1e-12, "{normals:?}");
        }
    }
}
