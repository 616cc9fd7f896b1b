//! How far bodies strain and turn, and how far stress goes: strains and rotations are small by assumption, and the law
//! is linear.

use crate::flight::{NextTouch, next_touch};
use percute_core::element_state::ElementState;
use percute_core::history::{SinkError, State, StateSink, Step};
use percute_core::ids::ElementId;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{AnyProblem, RigidMotion};
use serde::Serialize;

/// Instants from one that is looked at to the next one. Stress behind a front stays for longer, and the work is a few
/// hundredths of that of the estimate.
const EVERY: usize = 8;

/// The deformation of bodies and the stress in materials, at each eighth instant and the last one.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Deformation {
    /// The bodies, in the order of their first nodes.
    pub bodies: Vec<BodyDeformation>,
    /// The materials, in their order.
    pub materials: Vec<MaterialStress>,
    /// The first point of a single body that would reach a plane by turning, if the run went on.
    #[serde(skip)]
    pub next_touch: Option<NextTouch>,
}

/// How far a body strains and turns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyDeformation {
    /// Its name: that of the group of all its elements, or "body 0".
    pub name: String,
    /// Its largest mean rotation, counterclockwise (rad): Σm x×u / Σm|x|², x from the centre of mass; 0 of a bar.
    pub rotation: f64,
    /// The instant of this rotation (s).
    pub time_of_rotation: f64,
    /// Its angular velocity at the last instant, counterclockwise (rad/s), that of the rigid motion which fits best; 0
    /// of a bar.
    pub angular_velocity: f64,
    /// The principal strain of an element, in the plane, that is largest without its sign.
    pub strain: Extreme,
}

/// The stress in the elements of a material.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialStress {
    /// Its group of elements; none if it is that of all.
    pub group: Option<String>,
    /// Young's modulus (Pa).
    pub young: f64,
    /// The largest von Mises stress of an element (Pa).
    pub von_mises: Extreme,
    /// Where it was above the yield stress; none without one.
    pub yielding: Option<Yielding>,
}

/// Where and when a material yielded or, if its law is elastic, the von Mises stress was above the yield stress.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Yielding {
    /// The yield stress (Pa).
    pub yield_stress: f64,
    /// The part of the volume of the material that yielded, or in which the stress was above it at some instant.
    pub share: f64,
    /// The first of these instants (s).
    pub first: Option<f64>,
    /// Of a law with plasticity.
    pub plastic: Option<PlasticFlow>,
}

/// What plastic flow did in a material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlasticFlow {
    /// E_t/E, the slope of the uniaxial curve beyond the yield stress over Young's modulus.
    pub tangent_ratio: f64,
    /// The largest equivalent plastic strain p of an element.
    pub equivalent_strain: Extreme,
}

/// A largest value with its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The element.
    pub element: usize,
    /// The instant (s).
    pub time: f64,
}

impl Extreme {
    /// The larger of two; the first of equal ones.
    fn larger(self, other: Self) -> Self {
        if other.value.abs() > self.value.abs() { other } else { self }
    }

    /// Takes in a value; the first of equal ones stays.
    fn take(&mut self, value: f64, element: usize, time: f64) {
        *self = self.larger(Self { value, element, time });
    }
}

impl Deformation {
    /// The largest principal strain of all bodies.
    #[must_use]
    pub fn strain(&self) -> Extreme {
        self.bodies.iter().map(|body| body.strain).fold(Extreme::default(), Extreme::larger)
    }
}

/// Follows the deformation in the steps that it takes.
#[derive(Clone, Debug)]
pub(crate) struct DeformationRecorder<'p> {
    problem: &'p AnyProblem,
    last: usize,
    rigid: RigidMotion,
    body_of_element: Vec<usize>,
    /// Whether the stress in an element was above its yield stress.
    yielded: Vec<bool>,
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
        };
        let stated = &problem.conditions().materials;
        let material = |(at, law): (usize, &Elastic)| MaterialStress {
            group: stated.get(at).and_then(|(group, _)| group.clone()),
            young: law.young(),
            von_mises: Extreme::default(),
            yielding: law.yield_stress().map(|yield_stress| Yielding {
                yield_stress,
                share: 0.0,
                first: None,
                plastic: law.hardening().map(|hardening| PlasticFlow {
                    tangent_ratio: hardening.tangent(law.young()) / law.young(),
                    equivalent_strain: Extreme::default(),
                }),
            }),
        };
        let found = Deformation {
            bodies: mesh.part_names().into_iter().map(body).collect(),
            materials: problem.materials().iter().enumerate().map(material).collect(),
            next_touch: None,
        };
        let yields = problem.materials().iter().any(|law| law.yield_stress().is_some());
        Self {
            problem,
            last: steps,
            rigid: RigidMotion::new(problem),
            body_of_element: mesh.cells().map(|nodes| of_node[nodes[0].index()]).collect(),
            yielded: vec![false; if yields { mesh.element_count() } else { 0 }],
            found,
        }
    }

    /// What was found, with elements as `number` calls them, those of `mesh`.
    pub(crate) fn finish(mut self, mesh: &Mesh, number: impl Fn(usize) -> usize) -> Deformation {
        let materials = self.problem.element_material();
        let mut volumes = vec![[0.0; 2]; self.found.materials.len()];
        for (element, yielded) in self.yielded.iter().enumerate() {
            let volume = self.problem.volume(ElementId::new(element));
            let [all, above] = &mut volumes[usize::from(materials[element])];
            (*all, *above) = (*all + volume, if *yielded { *above + volume } else { *above });
        }
        for (material, [all, above]) in self.found.materials.iter_mut().zip(volumes) {
            material.von_mises.element = number(material.von_mises.element);
            if let Some(plastic) = material.yielding.as_mut().and_then(|yielding| yielding.plastic.as_mut()) {
                plastic.equivalent_strain.element = number(plastic.equivalent_strain.element);
            }
            if let Some(yielding) = material.yielding.as_mut().filter(|_| all > 0.0) {
                yielding.share = above / all;
            }
        }
        self.found.bodies.iter_mut().for_each(|body| body.strain.element = number(body.strain.element));
        self.found.bodies = self.bodies_of(mesh, number);
        self.found
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
        for element in 0..self.body_of_element.len() {
            let state = ElementState::new(self.problem, ElementId::new(element), displacement, internal);
            let body = &mut self.found.bodies[self.body_of_element[element]];
            body.strain.take(state.principal_strain(), element, time);
            let material = &mut self.found.materials[usize::from(materials[element])];
            let von_mises = state.von_mises();
            material.von_mises.take(von_mises, element, time);
            let Some(yielding) = &mut material.yielding else { continue };
            let beyond = match &mut yielding.plastic {
                Some(plastic) => {
                    plastic.equivalent_strain.take(state.equivalent_plastic_strain, element, time);
                    state.equivalent_plastic_strain > 0.0
                }
                None => von_mises > yielding.yield_stress,
            };
            if beyond {
                yielding.first = yielding.first.or(Some(time));
                self.yielded[element] = true;
            }
        }
    }
}

impl StateSink for DeformationRecorder<'_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let step = state.step();
        if step.index.is_multiple_of(EVERY) || step.index == self.last {
            self.rotations(step.displacement, step.time);
            self.elements(step);
            self.turning(state);
        }
        Ok(())
    }
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
