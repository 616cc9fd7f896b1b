//! The admissible motion of a non-matching interface.
//!
//! Contact of the simulation is between a node of the slave and a weighted part of the master. Problem P_CA is solved
//! for this weighted relative motion x_k. Its change from the simulation, δ_k = ẋ_k − W_k, is shared by the nodes of
//! both surfaces with the least kinetic energy: Δv = ±m⁻¹Gᵀ A⁻¹ (w δ). Where the surfaces still penetrate between their
//! nodes, nodes of the slave are lifted by a small height while it is needed. Zero gap at each point is not asked for,
//! as it would make the interface straight.
//!
//! Lifts follow from the whole run. So this motion is known at its end.

mod lift;
mod path;
mod record;

use super::normal_motions::{NormalMotions, Pair, most_bytes};
use crate::estimate::SurfaceEstimate;
use crate::residual::{Residuals, worse};
use crate::scratch_file::{ScratchError, ScratchFile};
use lift::{Lift, Penetration};
use path::solve;
use percute_core::contact::{ContactFace, NonMatchingSurfaces, Side};
use percute_core::material::Law;
use percute_core::problem::Problem;
use record::{InterfaceMotion, Record};
use std::ops::Range;

/// Rounds of lifts after which the search ends; a penetration that is left shows in the residuals.
const MOST_ROUNDS: usize = 20;

/// Instants that are worked on at once.
const PIECE: usize = 64;

/// The motion of two surfaces, of the simulation until the run is over and admissible from then on.
#[derive(Debug)]
pub(crate) struct NonMatchingMotion {
    /// Among the pairs of non-matching interfaces.
    index: usize,
    record: Record,
    /// ẋ_k and x_k of the nodes of the slave, with their lifts (m/s, m), once they are known.
    relative: NormalMotions,
    /// Lifts of slave and master.
    lifts: [Vec<Lift>; 2],
    rounds: usize,
}

/// About how many bytes the motions take of surfaces with so many nodes.
pub(super) fn memory(nodes: usize) -> usize {
    // Simulation and change of all nodes, seven more pairs of numbers of those of slaves.
    9 * most_bytes(nodes, usize::MAX)
}

/// Both surfaces at an instant, in the admissible motion.
#[derive(Clone, Debug)]
pub(crate) struct NonMatchingInstant {
    /// How far each part of the slave has moved against the master along the tangent (m).
    pub(crate) shifts: Vec<f64>,
    /// η of the nodes of the slave and of the master (m).
    pub(crate) eta: [Vec<f64>; 2],
    /// Normal speeds of opening (m/s): ẋ_k of the nodes of the slave, and of lifts of the nodes of the master.
    pub(crate) speed: [Vec<f64>; 2],
}

impl NonMatchingMotion {
    pub(crate) fn new<const D: usize>(problem: &Problem<D>, index: usize, span: usize) -> Self {
        let non_matching = &problem.surface().non_matching()[index];
        Self {
            index,
            record: Record::new(non_matching, span),
            relative: NormalMotions::new(0, span, ScratchFile::default()),
            lifts: sides(non_matching).map(|side| vec![Lift::NONE; side.len()]),
            rounds: 0,
        }
    }

    /// Takes in the instant at the end of a half step of this length (s), with displacement (m) and velocity (m/s) of
    /// the nodes of the mesh.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn push<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        half: f64,
        motion: impl Fn(usize) -> [[f64; D]; 2],
    ) -> Result<(), ScratchError> {
        let surface = problem.surface();
        self.record.push((surface, &surface.non_matching()[self.index]), half, motion)
    }

    /// Takes in which nodes of the contact surface touch at a step.
    pub(crate) fn touch<const D: usize>(&mut self, problem: &Problem<D>, step: usize, touching: &[bool]) {
        let slave = problem.surface().non_matching()[self.index].slave();
        self.record.touch(step, |node| touching[slave.position(node)]);
    }

    /// Finds the admissible motion of the run, and hands it on: for each node of the contact surface, the changes of
    /// normal velocity and displacement (m/s, m) along its own normal from an instant on.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn finish<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        residuals: &mut Residuals,
        write: impl FnMut(usize, usize, &[Pair]) -> Result<(), ScratchError>,
    ) -> Result<(), ScratchError> {
        let non_matching = &problem.surface().non_matching()[self.index];
        let count = self.record.count();
        let scale = [problem.mesh().size(), problem.contact_tolerance()];
        let mut change = Changes::new(non_matching, count)?;
        self.relative = zeros(nodes(non_matching), count)?;
        for node in 0..non_matching.slave().len() {
            let Some(target) = self.record.target(node)? else { continue };
            let path = solve(&self.record, node, &target, scale, residuals)?;
            self.relative.write(node, 0, &path)?;
            change.aim(node, &path, &target.0)?;
        }
        change.share(problem, non_matching, &mut self.record)?;
        loop {
            let found = self.penetration(problem, &mut change)?;
            self.rounds += 1;
            if !found.is_found() || self.rounds > MOST_ROUNDS {
                let [at, between] = found.deepest.map(|depth| depth / scale[0]);
                residuals.penetration_at_instants = worse(residuals.penetration_at_instants, at);
                residuals.penetration_between_instants = worse(residuals.penetration_between_instants, between);
                break;
            }
            let (mut first, halves) = (0, self.record.halves());
            for ((lifts, found), sign) in self.lifts.iter_mut().zip(&found.lifts).zip(SIGNS) {
                for (node, (lift, more)) in
                    lifts.iter_mut().zip(found).enumerate().filter(|(_, (_, more))| more.height > 0.0)
                {
                    let last = lift.motion(halves);
                    *lift = lift.with(more, lift.height + more.height);
                    let now = lift.motion(halves);
                    let rise: Vec<Pair> = now.iter().zip(&last).map(|(a, b)| [a[0] - b[0], a[1] - b[1]]).collect();
                    add(&mut change.all, first + node, sign, &rise)?;
                    add(&mut self.relative, first + node, 1.0, &rise)?;
                }
                first += lifts.len();
            }
        }
        change.hand_on(non_matching, write)
    }

    /// How far the surfaces slide at most (m), the largest lift (m), and the number of rounds, of a motion that is
    /// known.
    pub(crate) fn summary(&self) -> SurfaceEstimate {
        let lift = self.lifts.iter().flatten().fold(0.0_f64, |highest, lift| highest.max(lift.height));
        SurfaceEstimate { slide: self.record.slide(), lift, rounds: self.rounds, stress: 0.0 }
    }

    /// The penetration of the motion so far.
    fn penetration<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        change: &mut Changes,
    ) -> Result<Penetration, ScratchError> {
        let non_matching = &problem.surface().non_matching()[self.index];
        // The stiffer surface gives way less.
        let [own, other] = sides(non_matching).map(|side| stiffness(problem, side));
        let nodes = sides(non_matching).map(Side::len);
        let mut found = Penetration::new(nodes, other / (own + other), problem.contact_tolerance());
        let mut last: Option<InterfaceMotion> = None;
        for instants in portions(self.record.count()) {
            let motions = change.motions(non_matching, &mut self.record, instants.clone())?;
            for (instant, motion) in instants.zip(motions) {
                if let Some(last) = &last {
                    found.between(non_matching, [last, &motion], self.record.halves()[instant]);
                }
                found.at(non_matching, &motion, instant);
                last = Some(motion);
            }
        }
        Ok(found)
    }

    /// Both surfaces at some instants of the admissible motion; `change` gives the change of the normal displacement
    /// (m) of a node of the contact surface along its own normal.
    ///
    /// # Errors
    /// A temporary file that fails.
    pub(crate) fn instants<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        instants: Range<usize>,
        change: impl Fn(usize, usize) -> f64,
    ) -> Result<Vec<NonMatchingInstant>, ScratchError> {
        let non_matching = &problem.surface().non_matching()[self.index];
        let motions = self.record.motions(non_matching, instants.clone())?;
        let mut made: Vec<NonMatchingInstant> = Vec::with_capacity(motions.len());
        for (instant, mut motion) in instants.clone().zip(motions) {
            for (k, side) in sides(non_matching).into_iter().enumerate() {
                for (node, eta) in motion.eta[k].iter_mut().enumerate() {
                    *eta += SIGNS[k] * change(side.position(node), instant);
                }
            }
            made.push(NonMatchingInstant {
                shifts: motion.places(),
                eta: motion.eta,
                speed: sides(non_matching).map(|side| vec![0.0; side.len()]),
            });
        }
        let (mut pairs, mut first) = (Vec::new(), 0);
        for (k, side) in sides(non_matching).into_iter().enumerate() {
            for node in 0..side.len() {
                pairs.clear();
                self.relative.read(first + node, instants.clone(), &mut pairs)?;
                made.iter_mut().zip(&pairs).for_each(|(made, [speed, _])| made.speed[k][node] = *speed);
            }
            first += side.len();
        }
        Ok(made)
    }
}

/// The normals of slave and master along that of the slave.
const SIGNS: [f64; 2] = [1.0, -1.0];

/// ρc² of the elements at a surface (Pa), the least of them.
fn stiffness<const D: usize>(problem: &Problem<D>, side: &Side) -> f64 {
    let element = |face: &ContactFace<D>| problem.mesh().face(face.face).owner;
    let own = |face: &&ContactFace<D>| side.node_at(face.nodes[0]).is_some();
    let stiffness = |face| problem.material(element(face)).wave_modulus();
    problem.surface().faces().iter().filter(own).map(stiffness).fold(f64::INFINITY, f64::min)
}

/// Number of nodes of both surfaces.
fn nodes<const D: usize>(non_matching: &NonMatchingSurfaces<D>) -> usize {
    non_matching.slave().len() + non_matching.master().len()
}

fn sides<const D: usize>(non_matching: &NonMatchingSurfaces<D>) -> [&Side; 2] {
    [non_matching.slave(), non_matching.master()]
}

/// All instants, some at a time.
fn portions(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count).step_by(PIECE).map(move |first| first..(first + PIECE).min(count))
}

/// Numbers of so many nodes at so many instants: 0.
fn zeros(nodes: usize, count: usize) -> Result<NormalMotions, ScratchError> {
    let mut zeros = NormalMotions::new(nodes, count, ScratchFile::default());
    (0..count).try_for_each(|_| zeros.extend())?;
    (0..nodes).try_for_each(|node| zeros.write(node, 0, &vec![[0.0; 2]; count]))?;
    Ok(zeros)
}

/// Adds numbers at all instants to those of a node.
fn add(store: &mut NormalMotions, node: usize, sign: f64, more: &[Pair]) -> Result<(), ScratchError> {
    let mut pairs = Vec::with_capacity(more.len());
    store.read(node, 0..more.len(), &mut pairs)?;
    pairs.iter_mut().zip(more).for_each(|(pair, more)| (0..2).for_each(|c| pair[c] += sign * more[c]));
    store.write(node, 0, &pairs)
}

/// The changes of the normal motion of both surfaces (m/s, m), along the normal of the slave, its nodes first.
#[derive(Debug)]
struct Changes {
    all: NormalMotions,
    slaves: usize,
    count: usize,
}

impl Changes {
    fn new<const D: usize>(non_matching: &NonMatchingSurfaces<D>, count: usize) -> Result<Self, ScratchError> {
        let slaves = non_matching.slave().len();
        Ok(Self { all: zeros(nodes(non_matching), count)?, slaves, count })
    }

    /// Keeps δ of a node of the slave until it is shared.
    fn aim(&mut self, node: usize, path: &[Pair], target: &[f64]) -> Result<(), ScratchError> {
        let miss: Vec<Pair> = path.iter().zip(target).map(|([speed, _], target)| [speed - target, 0.0]).collect();
        self.all.write(node, 0, &miss)
    }

    /// Shares δ out at each instant; displacements follow by the trapezoidal rule.
    fn share<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        non_matching: &NonMatchingSurfaces<D>,
        record: &mut Record,
    ) -> Result<(), ScratchError> {
        let inverse = sides(non_matching).map(|side| -> Vec<f64> {
            let node = |k| problem.surface().nodes()[side.position(k)].node.index();
            (0..side.len()).map(|k| 1.0 / problem.mass()[node(k)]).collect()
        });
        let nodes = self.slaves + inverse[1].len();
        let mut last: Vec<Pair> = vec![[0.0; 2]; nodes];
        for instants in portions(self.count) {
            let mut portion = self.read(0..self.slaves, instants.clone())?;
            portion.resize(nodes, vec![[0.0; 2]; instants.len()]);
            for (j, instant) in instants.clone().enumerate() {
                let mut speed = vec![0.0; nodes];
                if portion[..self.slaves].iter().any(|pairs| pairs[j][0] != 0.0) {
                    let coupling = non_matching.coupling_at(&record.shifts(instant));
                    let right: Vec<f64> = (0..self.slaves).map(|k| coupling.weight(k) * portion[k][j][0]).collect();
                    let [slave, master] = coupling.share([&inverse[0], &inverse[1]], &right);
                    speed = slave.into_iter().chain(master).collect();
                }
                let half = record.halves()[instant];
                for (k, speed) in speed.into_iter().enumerate() {
                    let place = last[k][1] + 0.5 * half * (last[k][0] + speed);
                    last[k] = [speed, place];
                    portion[k][j] = last[k];
                }
            }
            for (k, pairs) in portion.iter().enumerate() {
                self.all.write(k, instants.start, pairs)?;
            }
        }
        Ok(())
    }

    /// The motion of both surfaces with these changes.
    fn motions<const D: usize>(
        &mut self,
        non_matching: &NonMatchingSurfaces<D>,
        record: &mut Record,
        instants: Range<usize>,
    ) -> Result<Vec<InterfaceMotion>, ScratchError> {
        let mut motions = record.motions(non_matching, instants.clone())?;
        let changes = self.read(0..self.slaves + non_matching.master().len(), instants)?;
        for (j, motion) in motions.iter_mut().enumerate() {
            let (slave, master) = changes.split_at(self.slaves);
            for (k, side) in [slave, master].into_iter().enumerate() {
                for (node, pairs) in side.iter().enumerate() {
                    let [speed, place] = pairs[j];
                    motion.speed[k][node] += speed;
                    motion.eta[k][node] += place;
                }
            }
        }
        Ok(motions)
    }

    /// Hands on the changes of each node along its own normal.
    fn hand_on<const D: usize>(
        &mut self,
        non_matching: &NonMatchingSurfaces<D>,
        mut write: impl FnMut(usize, usize, &[Pair]) -> Result<(), ScratchError>,
    ) -> Result<(), ScratchError> {
        let mut first = 0;
        for (side, sign) in sides(non_matching).into_iter().zip(SIGNS) {
            for node in 0..side.len() {
                for instants in portions(self.count) {
                    let pairs = self.read(first + node..first + node + 1, instants.clone())?.remove(0);
                    let own: Vec<Pair> = pairs.iter().map(|pair| pair.map(|value| sign * value)).collect();
                    write(side.position(node), instants.start, &own)?;
                }
            }
            first += side.len();
        }
        Ok(())
    }

    /// Those of some nodes at some instants.
    fn read(&mut self, nodes: Range<usize>, instants: Range<usize>) -> Result<Vec<Vec<Pair>>, ScratchError> {
        let read = |node| {
            let mut pairs = Vec::with_capacity(instants.len());
            self.all.read(node, instants.clone(), &mut pairs).map(|()| pairs)
        };
        nodes.map(read).collect()
    }
}
