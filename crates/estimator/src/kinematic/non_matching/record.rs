//! The motion of a non-matching interface in the simulation.

use crate::direction::along;
use crate::kinematic::normal_motions::{NormalMotions, Pair};
use crate::residual::worse;
use crate::scratch_file::{ScratchError, ScratchFile};
use percute_core::contact::{ContactSurface, NonMatchingSurfaces, Side};

/// The weighted normal motion of a node that its simulation aims at: velocities (m/s) and the gap at t_0 (m).
pub(super) type Target = (Vec<f64>, f64);

/// The motion of all nodes of both surfaces at an instant, those of the slave first.
#[derive(Clone, Debug, Default)]
pub(super) struct InterfaceMotion {
    /// How far each part of the slave has moved against the master along the tangent (m), and how fast it does (m/s).
    pub(super) shifts: Vec<Pair>,
    /// Normal velocity (m/s).
    pub(super) speed: [Vec<f64>; 2],
    /// η (m).
    pub(super) eta: [Vec<f64>; 2],
}

/// The places of shifts and their speeds.
fn places(shifts: &[Pair]) -> Vec<f64> {
    shifts.iter().map(|[place, _]| *place).collect()
}

impl InterfaceMotion {
    /// How far each part of the slave has moved against the master (m).
    pub(super) fn places(&self) -> Vec<f64> {
        places(&self.shifts)
    }
}

/// The motion of both surfaces at the half-step instants so far.
#[derive(Debug)]
pub(super) struct Record {
    /// Those of each part of the slave at each instant.
    shifts: Vec<Vec<Pair>>,
    /// The half step that ends at each instant (s), 0 at the first one.
    halves: Vec<f64>,
    /// Normal velocity (m/s) and normal displacement (m) of the nodes of the slave, then of the master.
    normal: NormalMotions,
    /// Weighted normal velocity W of the nodes of the slave (m/s), and c = g − ∫W dt with the weighted gap g (m): the
    /// part of the gap that comes from sliding. NaN while a multiplier does not act, or just sets in.
    weighted: NormalMotions,
    /// ∫W dt so far, and W at the last instant.
    path: Vec<Pair>,
    /// For each node of the slave, the steps at which it begins and ceases to touch in turn.
    changes: Vec<Vec<usize>>,
}

impl Record {
    pub(super) fn new<const D: usize>(non_matching: &NonMatchingSurfaces<D>, span: usize) -> Self {
        let (slave, all) = (non_matching.slave().len(), non_matching.slave().len() + non_matching.master().len());
        Self {
            shifts: Vec::new(),
            halves: Vec::new(),
            normal: NormalMotions::new(all, span, ScratchFile::default()),
            weighted: NormalMotions::new(slave, span, ScratchFile::default()),
            path: vec![[0.0; 2]; slave],
            changes: vec![Vec::new(); slave],
        }
    }

    /// Takes in an instant, at the end of a half step of this length (s), with displacement (m) and velocity (m/s) of
    /// the nodes of the mesh.
    pub(super) fn push<const D: usize>(
        &mut self,
        (surface, non_matching): (&ContactSurface<D>, &NonMatchingSurfaces<D>),
        half: f64,
        motion: impl Fn(usize) -> [[f64; D]; 2],
    ) -> Result<(), ScratchError> {
        let instant = self.halves.len();
        let at = |side: &Side, node: usize| motion(surface.nodes()[side.position(node)].node.index());
        let shifts = |which: usize| {
            let part = |side, node| along(&at(side, node)[which], non_matching.tangent());
            non_matching.shifts(|node| part(non_matching.slave(), node), |node| part(non_matching.master(), node))
        };
        let (places, speeds) = (shifts(0), shifts(1));
        self.normal.extend()?;
        let normal = non_matching.frame().normal();
        let sides = [non_matching.slave(), non_matching.master()];
        let pairs = sides.map(|side| -> Vec<Pair> {
            let pair = |node| {
                let [displacement, velocity] = at(side, node);
                [along(&velocity, normal), along(&displacement, normal)]
            };
            (0..side.len()).map(pair).collect()
        });
        for (k, pair) in pairs.iter().flatten().enumerate() {
            self.normal.write(k, instant, std::slice::from_ref(pair))?;
        }
        self.weighted.extend()?;
        let coupling = non_matching.coupling_at(&places);
        let [slave, master] = [0, 1].map(|k| (&pairs[k], sides[k].eta()));
        for k in 0..coupling.len() {
            let [path, last] = self.path[k];
            let pair = if coupling.binds(k) {
                let value = |part: &dyn Fn(&Pair, f64) -> f64| {
                    let of = |(pairs, eta): (&Vec<Pair>, &[f64]), node: usize| part(&pairs[node], eta[node]);
                    coupling.difference(k, |node| of(slave, node), |node| of(master, node)) / coupling.weight(k)
                };
                let (speed, gap) = (value(&|pair, _| pair[0]), value(&|pair, eta| eta + pair[1]));
                let path = path + 0.5 * half * (last + speed);
                self.path[k] = [path, speed];
                [speed, gap - path]
            } else {
                self.path[k] = [path + 0.5 * half * last, 0.0];
                [0.0, f64::NAN]
            };
            self.weighted.write(k, instant, &[pair])?;
        }
        self.shifts.push(places.into_iter().zip(speeds).map(Pair::from).collect());
        self.halves.push(half);
        Ok(())
    }

    /// Takes in the touching status of the nodes of the slave at a step.
    pub(super) fn touch(&mut self, step: usize, touching: impl Fn(usize) -> bool) {
        for (k, changes) in self.changes.iter_mut().enumerate() {
            if touching(k) == changes.len().is_multiple_of(2) {
                changes.push(step);
            }
        }
    }

    /// Number of instants so far.
    pub(super) fn count(&self) -> usize {
        self.halves.len()
    }

    /// Half steps that end at each instant (s).
    pub(super) fn halves(&self) -> &[f64] {
        &self.halves
    }

    /// How far each part of the slave has moved against the master at an instant (m).
    pub(super) fn shifts(&self, instant: usize) -> Vec<f64> {
        places(&self.shifts[instant])
    }

    /// How far a part of the slave has moved against the master from its place at the start, at most (m).
    pub(super) fn slide(&self) -> f64 {
        let Some(start) = self.shifts.first() else { return 0.0 };
        let shifts = self.shifts.iter().flat_map(|shifts| shifts.iter().zip(start));
        shifts.fold(0.0, |most, ([place, _], [start, _])| worse(most, (place - start).abs()))
    }

    /// Steps at which a node of the slave begins and ceases to touch, in turn.
    pub(super) fn changes(&self, node: usize) -> &[usize] {
        &self.changes[node]
    }

    /// The weighted normal velocities of a node of the slave (m/s) with the part of sliding, and its gap at t_0 (m): c
    /// is constant before its multiplier acts and after that. None if it never acts.
    pub(super) fn target(&mut self, node: usize) -> Result<Option<Target>, ScratchError> {
        let count = self.count();
        let mut pairs = Vec::with_capacity(count);
        self.weighted.read(node, 0..count, &mut pairs)?;
        let Some(first) = pairs.iter().find(|pair| !pair[1].is_nan()) else { return Ok(None) };
        let mut last = first[1];
        for pair in &mut pairs {
            if pair[1].is_nan() {
                pair[1] = last;
            }
            last = pair[1];
        }
        let rate = |j: usize| {
            let [before, after] = [j - 1, (j + 1).min(count - 1)];
            let time = self.halves[j] + if after > j { self.halves[after] } else { 0.0 };
            (pairs[after][1] - pairs[before][1]) / time
        };
        let target = |j: usize| if j == 0 { pairs[0][0] } else { pairs[j][0] + rate(j) };
        Ok(Some(((0..count).map(target).collect(), pairs[0][1])))
    }

    /// The motion at some consecutive instants.
    pub(super) fn motions<const D: usize>(
        &mut self,
        non_matching: &NonMatchingSurfaces<D>,
        instants: std::ops::Range<usize>,
    ) -> Result<Vec<InterfaceMotion>, ScratchError> {
        let sides = [non_matching.slave(), non_matching.master()];
        let empty = |k: usize| vec![0.0; sides[k].len()];
        let blank = |j: usize| {
            let shifts = self.shifts[j].clone();
            InterfaceMotion { shifts, speed: [empty(0), empty(1)], eta: [empty(0), empty(1)] }
        };
        let mut motions: Vec<InterfaceMotion> = instants.clone().map(blank).collect();
        let (mut pairs, mut first) = (Vec::new(), 0);
        for (k, side) in sides.into_iter().enumerate() {
            for node in 0..side.len() {
                pairs.clear();
                self.normal.read(first + node, instants.clone(), &mut pairs)?;
                for (motion, [speed, displacement]) in motions.iter_mut().zip(&pairs) {
                    motion.speed[k][node] = *speed;
                    motion.eta[k][node] = side.eta()[node] + displacement;
                }
            }
            first += side.len();
        }
        Ok(motions)
    }
}
