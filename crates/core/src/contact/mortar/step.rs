//! A non-matching interface at one step.

use super::band::Band;
use super::coupling::Coupling;
use super::friction::FrictionProblem;
use super::gram::gram;
use super::normal::NormalProblem;
use super::partition::{larger, smaller};
use super::side::Side;
use super::surfaces::NonMatchingSurfaces;
use crate::contact::frame::dot;
use crate::contact::prediction::{Predicted, Prediction};
use crate::contact::surface::ContactSurface;

/// Where all of the slave is farther from the master than this times the height of the master, no weighted gap is
/// negative: ∫|ψ| is at most 4.6 ∫ψ.
const FAR: f64 = 4.0;

/// The contact of a non-matching interface, solved anew at each step in the same memory. It depends on the prediction
/// of the step alone.
#[derive(Clone, Debug)]
pub(crate) struct NonMatchingContact {
    /// Among [`ContactSurface::non_matching`].
    index: usize,
    shifts: Vec<f64>,
    coupling: Coupling,
    normal_matrix: Band,
    /// That of the normal part where multipliers set in.
    softened: Band,
    /// Another one only if the tangential motion of some node is prescribed.
    tangential_matrix: Option<Band>,
    /// Memory of [`gram`].
    window: Vec<f64>,
    normal: NormalProblem,
    friction: FrictionProblem,
    /// Limits of the tangential multipliers (N/m).
    limit: Vec<f64>,
    /// b of the normal and of the tangential part, for each multiplier.
    right: Vec<[f64; 2]>,
    sides: [SideState; 2],
    touches: bool,
}

/// One side at a step, node by node.
#[derive(Clone, Debug)]
struct SideState {
    /// The nodes of the mesh.
    nodes: Vec<usize>,
    /// 1/m (1/kg), for forces along n and along t.
    inverse_mass: [Vec<f64>; 2],
    guided: Vec<bool>,
    /// η at t_{n+1} (m) and the tangential part of v_{n+½} (m/s), without contact.
    motion: Vec<[f64; 2]>,
    /// The tangential displacement at t_{n+1} (m), without contact.
    along: Vec<f64>,
    /// The least and the largest η (m).
    range: [f64; 2],
    /// Normal and tangential force (N).
    force: Vec<[f64; 2]>,
}

impl SideState {
    fn new<const D: usize>(surface: &ContactSurface<D>, side: &Side, inverse_mass: &[f64]) -> Self {
        let slots = || (0..side.len()).map(|node| &surface.nodes()[side.position(node)]);
        let nodes: Vec<usize> = slots().map(|contact| contact.node.index()).collect();
        let normal: Vec<f64> = nodes.iter().map(|&node| inverse_mass[node]).collect();
        let guided: Vec<bool> = slots().map(|contact| contact.guided).collect();
        let tangential = normal.iter().zip(&guided).map(|(inverse, guided)| if *guided { 0.0 } else { *inverse });
        Self {
            nodes,
            inverse_mass: [normal.clone(), tangential.collect()],
            guided,
            motion: vec![[0.0; 2]; side.len()],
            along: vec![0.0; side.len()],
            range: [0.0; 2],
            force: vec![[0.0; 2]; side.len()],
        }
    }

    /// The motion of a step without contact, with the normal and the tangent as axes.
    fn predict<const D: usize>(&mut self, side: &Side, axes: [&[f64; D]; 2], prediction: &Prediction<'_, D>) {
        let (dt, nodes) = (prediction.steps[0], &prediction.nodes[side.positions()]);
        let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
        let own = self.motion.iter_mut().zip(&mut self.along);
        for ((motion, along), (eta, Predicted { displacement, velocity })) in own.zip(side.eta().iter().zip(nodes)) {
            let [normal, tangential] = axes.map(|axis| [dot(displacement, axis), dot(velocity, axis)]);
            let eta = eta + normal[0] + dt * normal[1];
            (low, high) = (smaller(eta, low), larger(eta, high));
            *motion = [eta, tangential[1]];
            *along = tangential[0] + dt * tangential[1];
        }
        self.range = [low, high];
    }

    /// Sets the forces in global axes (N) where they are not 0.
    fn act<const D: usize>(&self, [normal, tangent]: [&[f64; D]; 2], reaction: &mut [[f64; D]]) {
        let forces = self.force.iter().zip(&self.guided);
        for (reaction, (&[press, along], guided)) in reaction.iter_mut().zip(forces) {
            if press != 0.0 || along != 0.0 {
                let along = if *guided { 0.0 } else { along };
                *reaction = std::array::from_fn(|c| press * normal[c] + along * tangent[c]);
            }
        }
    }
}

impl NonMatchingContact {
    /// Makes room for the surfaces of an index, with 1/m of all nodes (1/kg).
    pub(crate) fn new<const D: usize>(surface: &ContactSurface<D>, index: usize, inverse_mass: &[f64]) -> Self {
        let non_matching = &surface.non_matching()[index];
        let sides =
            [non_matching.slave(), non_matching.master()].map(|side| SideState::new(surface, side, inverse_mass));
        let guided = sides.iter().any(|side| side.guided.contains(&true));
        Self {
            index,
            shifts: Vec::new(),
            coupling: Coupling::default(),
            normal_matrix: Band::default(),
            softened: Band::default(),
            tangential_matrix: guided.then(Band::default),
            window: Vec::new(),
            normal: NormalProblem::default(),
            friction: FrictionProblem::default(),
            limit: Vec::new(),
            right: Vec::new(),
            sides,
            touches: false,
        }
    }

    /// Sets the forces of a step on nodes of the contact surface (N), where they are not 0, and marks those that touch
    /// at t_{n+1}.
    pub(crate) fn react<const D: usize>(
        &mut self,
        surface: &ContactSurface<D>,
        prediction: &Prediction<'_, D>,
        reaction: &mut [[f64; D]],
        touching: &mut [bool],
    ) {
        let non_matching = &surface.non_matching()[self.index];
        let (sides, axes) =
            ([non_matching.slave(), non_matching.master()], [non_matching.frame().normal(), non_matching.tangent()]);
        for (state, side) in self.sides.iter_mut().zip(sides) {
            state.predict(side, axes, prediction);
        }
        self.touches = self.is_touched(non_matching, prediction);
        if !self.touches {
            return;
        }
        self.solve(non_matching, prediction.steps);
        self.add_up(touching, sides);
        for (state, side) in self.sides.iter().zip(sides) {
            state.act(axes, &mut reaction[side.positions()]);
        }
    }

    /// Computes the coupling and b. Whether any weighted gap is negative.
    fn is_touched<const D: usize>(
        &mut self,
        non_matching: &NonMatchingSurfaces<D>,
        prediction: &Prediction<'_, D>,
    ) -> bool {
        let Self { shifts, coupling, right, sides: [slave, master], .. } = self;
        let ([low, _], [bottom, top]) = (slave.range, master.range);
        non_matching.find_shifts(shifts, |node| slave.along[node], |node| master.along[node]);
        if shifts.iter().any(|shift| !shift.is_finite()) || low - top > FAR * (top - bottom) {
            return false;
        }
        non_matching.update(coupling, shifts);
        let ([dt, h], mut touches) = (prediction.steps, false);
        let over = [1.0 / (dt * h), 1.0 / h];
        right.clear();
        right.extend((0..coupling.len()).map(|k| {
            let [gap, slip] = coupling.differences(k, &slave.motion, &master.motion);
            touches |= coupling.is_active(k) && gap < -prediction.tolerance * coupling.weight(k);
            [gap * over[0], slip * over[1]]
        }));
        touches
    }

    /// Solves for the multipliers of a step of Δt (s) with h (s).
    fn solve<const D: usize>(&mut self, non_matching: &NonMatchingSurfaces<D>, [dt, h]: [f64; 2]) {
        let Self { coupling, sides: [slave, master], normal, friction, right, softened, .. } = self;
        let inverse = |which: usize| [&slave.inverse_mass[which][..], &master.inverse_mass[which][..]];
        let rough = non_matching.law().friction() > 0.0;
        gram(&mut self.normal_matrix, coupling, inverse(0), &mut self.window);
        let soft = coupling.sets_in();
        if soft {
            softened.clone_from(&self.normal_matrix);
            coupling.soften(softened, 1.0 / (dt * h));
        }
        let matrix = if soft { &*softened } else { &self.normal_matrix };
        normal.solve(matrix, right, |k| coupling.is_active(k));
        if !rough {
            friction.clear(coupling.len());
            return;
        }
        let limit = |(k, force): (usize, &f64)| if slave.guided[k] { 0.0 } else { non_matching.law().limit(*force) };
        self.limit.clear();
        self.limit.extend(normal.force().iter().enumerate().map(limit));
        let matrix = match &mut self.tangential_matrix {
            Some(matrix) => {
                gram(matrix, coupling, inverse(1), &mut self.window);
                &*matrix
            }
            None => &self.normal_matrix,
        };
        // The solution with the softened matrix is none of the friction.
        let sticking = if soft { &[] } else { normal.sticking() };
        friction.solve(matrix, |k| right[k][1], &self.limit, (normal.pressed(), sticking));
    }

    /// Forces Dᵀλ on the slave and −Mᵀλ on the master. Marks the nodes on which multipliers act, of the master but for
    /// rounding.
    fn add_up(&mut self, touching: &mut [bool], [own, other]: [&Side; 2]) {
        let Self { coupling, sides: [slave, master], normal, friction, .. } = self;
        slave.force.fill([0.0; 2]);
        master.force.fill([0.0; 2]);
        for &k in normal.pressed() {
            let multipliers = [normal.force()[k], friction.force()[k]];
            let add = |force: &mut [f64; 2], part: f64| (0..2).for_each(|c| force[c] += part * multipliers[c]);
            touching[own.position(k)] = true;
            let [before, here, after] = coupling.slave_row(k);
            add(&mut slave.force[k], here);
            if before != 0.0 {
                add(&mut slave.force[k - 1], before);
            }
            if after != 0.0 {
                add(&mut slave.force[k + 1], after);
            }
            let ((first, row), least) = (coupling.master_row(k), coupling.least_part(k));
            let nodes = row.iter().zip(&mut master.force[first..]).zip(&mut touching[other.position(first)..]);
            for ((part, force), touches) in nodes {
                add(force, -part);
                if part.abs() > least {
                    *touches = true;
                }
            }
        }
    }

    /// Adds the reactions of the step (N), by their position in the contact surface, to the forces on all nodes (N).
    pub(crate) fn add<const D: usize>(
        &self,
        surface: &ContactSurface<D>,
        reaction: &[[f64; D]],
        force: &mut [[f64; D]],
    ) {
        if !self.touches {
            return;
        }
        let non_matching = &surface.non_matching()[self.index];
        for (state, side) in self.sides.iter().zip([non_matching.slave(), non_matching.master()]) {
            for (&node, reaction) in state.nodes.iter().zip(&reaction[side.positions()]) {
                (0..D).for_each(|c| force[node][c] += reaction[c]);
            }
        }
    }

    /// The master touches where a node of the slave that touches acts on it.
    pub(crate) fn settle_master<const D: usize>(&self, surface: &ContactSurface<D>, touching: &mut [bool]) {
        surface.non_matching()[self.index].settle_master(&self.coupling, touching);
    }
}
