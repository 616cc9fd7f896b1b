//! Follows the deformation in the steps of a run.

use super::permanent::FlowSums;
use super::{
    BodyDeformation, Deformation, ElementPlace, Extreme, MaterialStress, OverallYielding, PlasticFlow, Yielding,
};
use crate::flight::next_touch;
use percute_core::element_state::ElementState;
use percute_core::history::{SinkError, State, StateSink, Step};
use percute_core::ids::ElementId;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{AnyProblem, RigidMotion};

/// Instants from one that is looked at to the next one. Stress behind a front stays for longer, and the work is a few
/// hundredths of that of the estimate.
const EVERY: usize = 8;

/// Follows the deformation in the steps that it takes.
#[derive(Clone, Debug)]
pub(crate) struct DeformationRecorder<'p> {
    problem: &'p AnyProblem,
    last: usize,
    rigid: RigidMotion,
    body_of_element: Vec<usize>,
    /// Whether the stress in an element was above its yield stress.
    yielded: Vec<bool>,
    /// The largest plastic strain or stress of each material at the instant at which it yields.
    onset: Vec<Extreme>,
    flow: FlowSums,
    found: Deformation,
}

impl<'p> DeformationRecorder<'p> {
    /// That of a run of so many steps.
    pub(crate) fn new(problem: &'p AnyProblem, steps: usize) -> Self {
        let mesh = problem.mesh();
        let of_node = mesh.part_numbers();
        let body = |name| BodyDeformation {
            name,
            rotation: 0.0,
            time_of_rotation: 0.0,
            angular_velocity: 0.0,
            strain: Extreme::default(),
            permanent_strain: None,
        };
        let stated = &problem.conditions().materials;
        let material = |(at, law): (usize, &Elastic)| MaterialStress {
            group: stated.get(at).and_then(|(group, _)| group.clone()),
            young: law.young(),
            von_mises: Extreme::default(),
            yielding: yielding(law),
        };
        let found = Deformation {
            bodies: mesh.part_names().into_iter().map(body).collect(),
            materials: problem.materials().iter().enumerate().map(material).collect(),
            yielding: None,
            next_touch: None,
        };
        let yields = problem.materials().iter().any(|law| law.yield_stress().is_some());
        let body_of_element: Vec<usize> = mesh.cells().map(|nodes| of_node[nodes[0].index()]).collect();
        Self {
            problem,
            last: steps,
            rigid: RigidMotion::new(problem),
            yielded: vec![false; if yields { mesh.element_count() } else { 0 }],
            onset: vec![Extreme::default(); found.materials.len()],
            flow: FlowSums::new(problem, &body_of_element),
            body_of_element,
            found,
        }
    }

    /// What was found, with elements as `number` calls them, those of `mesh`.
    pub(crate) fn finish(mut self, mesh: &Mesh, number: impl Fn(usize) -> usize) -> Deformation {
        let place = |element: usize| {
            let element = number(element);
            let centroid = mesh.centroid(ElementId::new(element))[..mesh.dimension()].to_vec();
            ElementPlace { element, centroid }
        };
        let placed = |extreme: &mut Extreme| {
            ElementPlace { element: extreme.element, centroid: extreme.centroid } = place(extreme.element);
        };
        let volumes = self.volumes();
        for (k, (material, [all, above])) in self.found.materials.iter_mut().zip(&volumes).enumerate() {
            placed(&mut material.von_mises);
            let Some(yielding) = &mut material.yielding else { continue };
            yielding.stress_ratio = material.von_mises.value / yielding.yield_stress;
            yielding.first_place = yielding.first.map(|_| place(self.onset[k].element));
            yielding.share = if *all > 0.0 { above / all } else { 0.0 };
            if let Some(plastic) = &mut yielding.plastic {
                placed(&mut plastic.equivalent_strain);
                plastic.mean_equivalent_strain = self.flow.mean_equivalent_strain(k);
            }
        }
        self.found.yielding = overall(&self.found.materials, &volumes);
        for (k, body) in self.found.bodies.iter_mut().enumerate() {
            placed(&mut body.strain);
            body.permanent_strain = self.flow.permanent_strain(k, self.problem.materials());
        }
        self.found.bodies = self.bodies_of(mesh, number);
        self.found
    }

    /// The volume of each material with a yield stress, and the part of it that yielded (m³).
    fn volumes(&self) -> Vec<[f64; 2]> {
        let materials = self.problem.element_material();
        let mut volumes = vec![[0.0; 2]; self.found.materials.len()];
        for (element, yielded) in self.yielded.iter().enumerate() {
            let volume = self.problem.volume(ElementId::new(element));
            let [all, above] = &mut volumes[usize::from(materials[element])];
            (*all, *above) = (*all + volume, if *yielded { *above + volume } else { *above });
        }
        volumes
    }

    /// Whether a material with a yield stress has not yielded: then each instant counts, for its margin and for the
    /// instant at which it yields.
    fn watches(&self) -> bool {
        let waits = |material: &MaterialStress| material.yielding.as_ref().is_some_and(|found| found.first.is_none());
        self.found.materials.iter().any(waits)
    }

    /// The bodies in the order of a mesh, with its names.
    fn bodies_of(&self, mesh: &Mesh, number: impl Fn(usize) -> usize) -> Vec<BodyDeformation> {
        let (of_node, mut bodies) = (mesh.part_numbers(), self.found.bodies.clone());
        for (own, found) in self.found.bodies.iter().enumerate() {
            // Each body has an element: nodes without one are refused.
            if let Some(element) = self.body_of_element.iter().position(|&body| body == own) {
                bodies[of_node[mesh.cell(ElementId::new(number(element)))[0].index()]].clone_from(found);
            }
        }
        bodies.iter_mut().zip(mesh.part_names()).for_each(|(body, name)| body.name = name);
        bodies
    }

    fn rotations(&mut self, displacement: &[f64], time: f64) {
        let rotations = match self.problem.is_finite() {
            true => vec![present_rotation(self.problem, displacement)],
            false => self.rigid.rotations(displacement),
        };
        for (body, rotation) in self.found.bodies.iter_mut().zip(rotations) {
            if rotation.abs() > body.rotation.abs() {
                (body.rotation, body.time_of_rotation) = (rotation, time);
            }
        }
    }

    /// The angular velocity of each body and, at the last instant, what would follow.
    fn turning(&mut self, state: &State<'_>) {
        let (step, velocity) = (state.step(), state.velocity());
        let spins = match self.problem.is_finite() {
            true => vec![present_spin(self.problem, step.displacement, &velocity)],
            false => self.rigid.rotations(&velocity),
        };
        for (body, spin) in self.found.bodies.iter_mut().zip(spins) {
            body.angular_velocity = spin;
        }
        if step.index == self.last {
            self.found.next_touch = next_touch(self.problem, &self.rigid, step.time, [step.displacement, &velocity]);
        }
    }

    fn elements(&mut self, &Step { displacement, internal, time, .. }: &Step<'_>) {
        let materials = self.problem.element_material();
        self.flow.clear();
        for element in 0..self.body_of_element.len() {
            let id = ElementId::new(element);
            let state = ElementState::new(self.problem, id, displacement, internal);
            let (body, material) = (self.body_of_element[element], usize::from(materials[element]));
            self.found.bodies[body].strain.take(state.principal_strain(), element, time);
            let (found, von_mises) = (&mut self.found.materials[material], state.von_mises());
            found.von_mises.take(von_mises, element, time);
            let Some(yielding) = &mut found.yielding else { continue };
            let (beyond, amount) = match &mut yielding.plastic {
                Some(plastic) => {
                    let p = state.equivalent_plastic_strain;
                    plastic.equivalent_strain.take(p, element, time);
                    self.flow.add([body, material], self.problem.volume(id), &state);
                    (p > 0.0, p)
                }
                None => (von_mises > yielding.yield_stress, von_mises),
            };
            if beyond {
                self.yielded[element] = true;
                if *yielding.first.get_or_insert(time) == time {
                    self.onset[material].take(amount, element, time);
                }
            }
        }
    }
}

impl StateSink for DeformationRecorder<'_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let step = state.step();
        let chosen = step.index.is_multiple_of(EVERY) || step.index == self.last;
        if chosen || self.watches() {
            self.elements(step);
        }
        if chosen {
            self.rotations(step.displacement, step.time);
            self.turning(state);
        }
        Ok(())
    }
}

/// A material that has not yielded; none without a yield stress.
fn yielding(law: &Elastic) -> Option<Yielding> {
    let yield_stress = law.yield_stress()?;
    let plastic = law.hardening().map(|hardening| PlasticFlow {
        tangent_ratio: hardening.tangent(law.young()) / law.young(),
        equivalent_strain: Extreme::default(),
        mean_equivalent_strain: 0.0,
    });
    Some(Yielding { yield_stress, stress_ratio: 0.0, share: 0.0, first: None, first_place: None, plastic })
}

/// What materials of these volumes, and of these parts that yielded (m³), did together.
fn overall(materials: &[MaterialStress], volumes: &[[f64; 2]]) -> Option<OverallYielding> {
    let all = || materials.iter().filter_map(|material| material.yielding.as_ref());
    let stress_ratio = all().map(|yielding| yielding.stress_ratio).reduce(f64::max)?;
    let stated = || materials.iter().zip(volumes).filter(|(material, _)| material.yielding.is_some());
    let [volume, yielded] = [0, 1].map(|k| stated().map(|(_, volumes)| volumes[k]).sum::<f64>());
    let flows = all().filter_map(|yielding| yielding.plastic.as_ref());
    Some(OverallYielding {
        share: if volume > 0.0 { yielded / volume } else { 0.0 },
        stress_ratio,
        equivalent_strain: flows.map(|flow| flow.equivalent_strain.value).reduce(f64::max),
    })
}

/// The mean rotation of a plane body of finite kinematics, of Σ m (x − x̄)(X − X̄)ᵀ, from −π to π (rad); 0 of a bar.
fn present_rotation(problem: &AnyProblem, displacement: &[f64]) -> f64 {
    let [turned, along] = moments(problem, problem.mesh().points(), &moved(problem, displacement));
    turned.atan2(along)
}

/// The angular momentum of a plane body of finite kinematics about its centre over its present moment of inertia
/// (rad/s); 0 of a bar.
fn present_spin(problem: &AnyProblem, displacement: &[f64], velocity: &[f64]) -> f64 {
    let places = moved(problem, displacement);
    let [[turning, _], [_, inertia]] = [velocity, &places].map(|field| moments(problem, &places, field));
    if inertia > 0.0 { turning / inertia } else { 0.0 }
}

/// The present places of all nodes, in rows (m).
fn moved(problem: &AnyProblem, displacement: &[f64]) -> Vec<f64> {
    problem.mesh().points().iter().zip(displacement).map(|(x, u)| x + u).collect()
}

/// Σ m a×b and Σ m a·b of two fields in rows, each less its mean; 0 of a bar.
fn moments(problem: &AnyProblem, a: &[f64], b: &[f64]) -> [f64; 2] {
    let (mass, mut sums) = (problem.mass(), [0.0; 2]);
    if problem.dimension() != 2 {
        return sums;
    }
    let total: f64 = mass.iter().sum();
    let [p, q] = [a, b].map(|field| {
        let mut mean = [0.0; 2];
        field.iter().enumerate().for_each(|(k, x)| mean[k % 2] += mass[k / 2] * x / total);
        mean
    });
    for (m, (a, b)) in mass.iter().zip(a.as_chunks::<2>().0.iter().zip(b.as_chunks::<2>().0)) {
        let ([x, y], [u, v]) = ([a[0] - p[0], a[1] - p[1]], [b[0] - q[0], b[1] - q[1]]);
        sums[0] += m * (x * v - y * u);
        sums[1] += m * (x * u + y * v);
    }
    sums
}
