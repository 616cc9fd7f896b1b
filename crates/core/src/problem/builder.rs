//! From what the user states to a checked problem.

use super::bodies::{Contact, Start};
use super::boundary::{self, Supports};
use super::contacts::Stated;
use super::may_touch::{AllContact, all_contact};
use super::sides::Bodies;
use super::{Cause, InputError, Model, PrescribedComponent, Problem, sides, start_of_contact, symmetry};
use crate::contact::{ContactSurface, Interface, Obstacle};
use crate::ids::{ElementId, FaceId, NodeId};
use crate::load::{BodyForce, Support, Table, Traction};
use crate::material::{Elastic, Law};
use crate::mesh::Mesh;
use crate::message::axis;
use std::sync::{Arc, OnceLock};

/// An initial field.
#[derive(Clone, Debug)]
pub enum Initial<const D: usize> {
    /// The same value at all nodes.
    Uniform([f64; D]),
    /// One value per node.
    Nodal(Vec<[f64; D]>),
}

/// What the user stated, apart from mesh, obstacles and initial fields: from it comes the same
/// problem again, bit by bit.
#[derive(Clone, Debug, Default)]
pub struct Conditions {
    /// Materials, each with its group of elements; `None` means all.
    pub materials: Vec<(Option<String>, Elastic)>,
    /// Supports.
    pub supports: Vec<Support>,
    /// Tractions.
    pub tractions: Vec<Traction>,
    /// Body forces.
    pub body_forces: Vec<BodyForce>,
    /// Surfaces of different bodies that may touch.
    pub interfaces: Vec<Interface>,
}

/// Collects the parts of a problem; [`Builder::build`] checks them all, in one place.
#[derive(Clone, Debug)]
pub struct Builder<const D: usize> {
    mesh: Arc<Mesh>,
    stated: Conditions,
    displacement: Initial<D>,
    velocity: Initial<D>,
    obstacles: Vec<Obstacle<D>>,
    contacts: Vec<Contact>,
    automatic: bool,
    planes_to_be_moved: bool,
}

impl<const D: usize> Builder<D> {
    pub(super) fn new(mesh: Arc<Mesh>) -> Self {
        Self {
            mesh,
            stated: Conditions::default(),
            displacement: Initial::Uniform([0.0; D]),
            velocity: Initial::Uniform([0.0; D]),
            obstacles: Vec::new(),
            contacts: Vec::new(),
            automatic: false,
            planes_to_be_moved: false,
        }
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The material of all elements.
    #[must_use]
    pub fn material(mut self, material: Elastic) -> Self {
        self.stated.materials.push((None, material));
        self
    }

    /// The material of a group of elements.
    #[must_use]
    pub fn material_of(mut self, group: impl Into<String>, material: Elastic) -> Self {
        self.stated.materials.push((Some(group.into()), material));
        self
    }

    /// Initial displacement u₀ (m); zero unless given.
    #[must_use]
    pub fn initial_displacement(mut self, field: Initial<D>) -> Self {
        self.displacement = field;
        self
    }

    /// Initial velocity v₀ (m/s); zero unless given.
    #[must_use]
    pub fn initial_velocity(mut self, field: Initial<D>) -> Self {
        self.velocity = field;
        self
    }

    /// Adds a support.
    #[must_use]
    pub fn support(mut self, support: Support) -> Self {
        self.stated.supports.push(support);
        self
    }

    /// Adds a traction.
    #[must_use]
    pub fn traction(mut self, traction: Traction) -> Self {
        self.stated.tractions.push(traction);
        self
    }

    /// Adds a body force.
    #[must_use]
    pub fn body_force(mut self, force: BodyForce) -> Self {
        self.stated.body_forces.push(force);
        self
    }

    /// Adds the weight of the materials stated so far: a body force ρg on the elements of each, for an acceleration g
    /// (m/s²), eq. \[8\].
    #[must_use]
    pub fn gravity(mut self, acceleration: [f64; D]) -> Self {
        for (group, material) in &self.stated.materials {
            let value = Table::constant(acceleration.map(|g| material.density() * g));
            self.stated.body_forces.push(BodyForce { group: group.clone(), value });
        }
        self
    }

    /// Adds an obstacle.
    #[must_use]
    pub fn obstacle(mut self, obstacle: Obstacle<D>) -> Self {
        self.obstacles.push(obstacle);
        self
    }

    /// Adds two surfaces of different bodies that may touch.
    #[must_use]
    pub fn interface(self, interface: Interface) -> Self {
        self.contact(interface.into())
    }

    /// Adds contact between bodies.
    #[must_use]
    pub fn contact(mut self, contact: Contact) -> Self {
        self.contacts.push(contact);
        self
    }

    /// All bodies that could touch each other may do so, and not only those of which contact is stated; plane bodies
    /// need a contact between all for its coefficient of friction.
    #[must_use]
    pub fn automatic_contact(mut self) -> Self {
        self.automatic = true;
        self
    }

    /// A body may start on a plane and move into it: before a simulation, [`Problem::with_planes_moved`] moves the
    /// plane away.
    #[must_use]
    pub fn planes_to_be_moved(mut self) -> Self {
        self.planes_to_be_moved = true;
        self
    }

    /// Materials and body forces are counted in 16 bits.
    fn check_counts(&self) -> Result<(), InputError> {
        let most = usize::from(u16::MAX) - 1;
        for (table, count) in [("material", self.stated.materials.len()), ("body_force", self.stated.body_forces.len())]
        {
            if count > most {
                return Err(Cause::TooMany { count, most }.at(table, Some(most), ""));
            }
        }
        Ok(())
    }

    /// Checks everything and builds the problem.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place.
    pub fn build(mut self) -> Result<Problem<D>, InputError> {
        self.check_counts()?;
        let mesh = &*self.mesh;
        let (materials, element_material) = materials(mesh, &self.stated.materials)?;
        waves(&materials)?;
        let extent = |e: ElementId| materials[usize::from(element_material[e.index()])].extent();
        let volume = |e: ElementId| mesh.volume(e) * extent(e);

        let density = |e: ElementId| materials[usize::from(element_material[e.index()])].density();
        let mass = lumped_mass(mesh, |e| density(e) * volume(e));

        let initial_displacement = nodal(&self.displacement, mesh.node_count(), "displacement")?;
        let initial_velocity = nodal(&self.velocity, mesh.node_count(), "velocity")?;
        let supports = boundary::supports(mesh, &self.stated.supports)?;
        let fixed = supports.fixed(mesh.node_count());
        let Supports { faces: supported, prescribed, motions } = supports;
        let lines = symmetry::node_lines(mesh, &supported, &prescribed, &motions);
        if prescribed.len() == D * mesh.node_count() {
            return Err(Cause::NoFreedom.at("support", None, ""));
        }
        let face_loads = boundary::tractions(mesh, &self.stated.tractions, &supported)?;
        let (body_loads, element_body_loads) = boundary::body_forces(mesh, &self.stated.body_forces, volume)?;

        check_finite(&materials, &self.obstacles, mesh.parts())?;
        check_solid::<D>(&materials, mesh.parts())?;
        let law = |f: FaceId| &materials[usize::from(element_material[mesh.face(f).owner.index()])];
        let (body, held, velocity) = (Vec::new(), boundary::held(mesh, &self.stated), &initial_velocity[..]);
        let bodies = Bodies { mesh, body, held, fixed, supported: &supported, lines, velocity, mass: &mass, law: &law };
        let start = Start { displacement: &initial_displacement, velocity: &initial_velocity, mass: &mass };
        // One body costs no search.
        let contact = Stated { contacts: &self.contacts, automatic: self.automatic && mesh.parts() > 1 };
        let AllContact { surface, interfaces, places, groups } = all_contact(bodies, self.obstacles, contact, &start)?;
        self.stated.interfaces = interfaces;
        check_moved_along(&surface, &prescribed)?;
        sides::check_touching(&surface, mesh).map_err(|cause| cause.at("contact", None, ""))?;

        let model = Model {
            materials,
            element_material,
            mass,
            prescribed,
            motions,
            traction_tables: self.stated.tractions.iter().map(|t| t.value.clone()).collect(),
            body_loads,
            element_body_loads,
            contacts: places,
            moved_planes: Vec::new(),
            critical_step: OnceLock::new(),
            stated: self.stated,
            mesh: with_groups(self.mesh, groups),
        };
        let mut problem = Problem { model, initial_displacement, initial_velocity, supported, face_loads, surface };
        start_with_supports(&mut problem)?;
        start_of_contact::check(&problem, self.planes_to_be_moved)?;
        Ok(problem)
    }
}

/// Refuses what a body that may turn cannot have: any face of it may touch the one plane.
fn check_finite<const D: usize>(
    materials: &[Elastic],
    obstacles: &[Obstacle<D>],
    bodies: usize,
) -> Result<(), InputError> {
    let Some(first) = materials.iter().position(Elastic::is_finite) else { return Ok(()) };
    if let Some(yields) = materials.iter().position(|material| material.hardening().is_some()) {
        return Err(Cause::FiniteYielding.at("material", Some(yields), "kinematics"));
    }
    if bodies > 1 {
        return Err(Cause::FiniteBodies { bodies }.at("material", Some(first), "kinematics"));
    }
    if let Some(small) = materials.iter().position(|material| !material.is_finite()) {
        return Err(Cause::MixedKinematics { first: first + 1 }.at("material", Some(small), "kinematics"));
    }
    if obstacles.len() > 1 {
        return Err(Cause::FinitePlanes { planes: obstacles.len() }.at("obstacle", Some(1), ""));
    }
    match obstacles.iter().any(|obstacle| obstacle.group().is_some()) {
        true => Err(Cause::FiniteGroup.at("obstacle", Some(0), "group")),
        false => Ok(()),
    }
}

/// Refuses friction of nodes of a solid that a support moves along their plane.
fn check_moved_along<const D: usize>(
    surface: &ContactSurface<D>,
    prescribed: &[PrescribedComponent],
) -> Result<(), InputError> {
    let moved = |node: NodeId| prescribed.iter().any(|p| p.node == node && p.motion.is_some());
    let guided = surface.nodes().iter().filter(|contact| D == 3 && contact.guided);
    for contact in guided.filter(|contact| surface.obstacles()[contact.obstacle].law().friction() > 0.0) {
        if moved(contact.node) {
            let cause = Cause::MovedAlong { node: contact.node.index() };
            return Err(cause.at("obstacle", Some(contact.obstacle), "friction"));
        }
    }
    Ok(())
}

/// Refuses what solids do not have yet.
fn check_solid<const D: usize>(materials: &[Elastic], bodies: usize) -> Result<(), InputError> {
    if D < 3 {
        return Ok(());
    }
    for (key, has) in
        [("kinematics", Elastic::is_finite as fn(&Elastic) -> bool), ("tangent", |law| law.hardening().is_some())]
    {
        if let Some(index) = materials.iter().position(has) {
            return Err(Cause::SolidLaw.at("material", Some(index), key));
        }
    }
    if bodies > 1 {
        return Err(Cause::SolidBodies { bodies }.at("mesh", None, ""));
    }
    Ok(())
}

/// The mesh with the groups of faces that contact has added.
fn with_groups(mesh: Arc<Mesh>, groups: Vec<(String, Vec<FaceId>)>) -> Arc<Mesh> {
    if groups.is_empty() { mesh } else { Arc::new(Arc::unwrap_or_clone(mesh).with_face_groups(groups)) }
}

/// The mass of each node (kg), from those of the elements.
fn lumped_mass(mesh: &Mesh, of_element: impl Fn(ElementId) -> f64) -> Vec<f64> {
    let mut mass = vec![0.0; mesh.node_count()];
    for e in (0..mesh.element_count()).map(ElementId::new) {
        let nodes = mesh.cell(e);
        let share = of_element(e) / nodes.len() as f64;
        nodes.iter().for_each(|node| mass[node.index()] += share);
    }
    mass
}

/// One material for each element.
fn materials(mesh: &Mesh, given: &[(Option<String>, Elastic)]) -> Result<(Vec<Elastic>, Vec<u16>), InputError> {
    const NONE: u16 = u16::MAX;
    let mut of_element = vec![NONE; mesh.element_count()];
    for (index, (group, _)) in given.iter().enumerate() {
        let fail = |cause: Cause| cause.at("material", Some(index), "group");
        let members: Vec<ElementId> = match group {
            Some(name) => boundary::element_group(mesh, name).map_err(fail)?.to_vec(),
            None => (0..mesh.element_count()).map(ElementId::new).collect(),
        };
        for element in members {
            let slot = &mut of_element[element.index()];
            if *slot != NONE {
                let (first, everywhere) = (usize::from(*slot) + 1, given[usize::from(*slot)].0.is_none());
                return Err(fail(Cause::TwoMaterials { element: element.index(), first, everywhere }));
            }
            *slot = index as u16;
        }
    }
    if let Some(element) = of_element.iter().position(|&m| m == NONE) {
        let count = of_element.iter().filter(|&&m| m == NONE).count();
        return Err(Cause::NoMaterial { element, count }.at("material", None, ""));
    }
    Ok((given.iter().map(|(_, material)| *material).collect(), of_element))
}

/// No material can have waves faster than light.
fn waves(materials: &[Elastic]) -> Result<(), InputError> {
    const LIGHT: f64 = 299_792_458.0;
    for (index, material) in materials.iter().enumerate() {
        let (density, young) = (material.density(), material.young());
        let speed = (young / density).sqrt();
        if speed > LIGHT {
            let cause = Cause::FasterThanLight { density, young, speed };
            return Err(cause.at("material", Some(index), "density"));
        }
    }
    Ok(())
}

/// The values of an initial field at the nodes.
fn nodal<const D: usize>(field: &Initial<D>, nodes: usize, key: &'static str) -> Result<Vec<[f64; D]>, InputError> {
    let values = match field {
        Initial::Uniform(value) => vec![*value; nodes],
        Initial::Nodal(values) => values.clone(),
    };
    if values.len() != nodes {
        return Err(Cause::FieldLength { given: values.len(), nodes }.at("initial", None, key));
    }
    for (node, value) in values.iter().enumerate() {
        if let Some(&value) = value.iter().find(|v| !v.is_finite()) {
            return Err(Cause::FieldNotFinite { node, value }.at("initial", None, key));
        }
    }
    Ok(values)
}

/// The initial velocity must agree with the supports (§3.1, remark).
///
/// One that agrees up to rounding, as sin(kx) at a support does, becomes that of the support: kinematically admissible
/// fields satisfy both, eq. \[4\] and \[7\].
fn start_with_supports<const D: usize>(problem: &mut Problem<D>) -> Result<(), InputError> {
    let speeds = problem.initial_velocity.iter().flatten().map(|v| v.abs());
    let largest = speeds.fold(0.0, f64::max);
    for i in 0..problem.prescribed.len() {
        let p = &problem.prescribed[i];
        let (node, component, prescribed) = (p.node.index(), p.component, problem.prescribed_velocity(p, 0.0));
        let initial = &mut problem.initial_velocity[node][component];
        // Far above rounding of the two, far below any speed that matters.
        if (*initial - prescribed).abs() > 1e-12 * largest.max(prescribed.abs()) {
            let cause = Cause::InconsistentStart { node, component: axis(component), initial: *initial, prescribed };
            return Err(cause.at("initial", None, "velocity"));
        }
        *initial = prescribed;
    }
    Ok(())
}
