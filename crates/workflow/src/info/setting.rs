//! What a case is about: materials, and planes and other bodies with their gaps, so that a slip shows before the run.

use crate::message::{counted, percent, trimmed};
use percute_core::contact::{Interface, contact_name, side_names};
use percute_core::material::Law;
use percute_core::problem::AnyProblem;
use serde::Serialize;

/// A material.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct MaterialInfo {
    pub group: Option<String>,
    pub young: f64,
    pub density: f64,
    pub wave_speed: f64,
    pub yield_stress: Option<f64>,
    /// Of a law with plasticity: the slope of the uniaxial stress over the strain beyond the yield stress (Pa).
    pub tangent: Option<f64>,
    /// The share of its hardening that is kinematic.
    pub kinematic: Option<f64>,
}

/// A plane at the start, or two surfaces of different bodies.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct PlaneInfo {
    /// The groups of edges of two bodies; none for a plane.
    pub groups: Option<[String; 2]>,
    /// Whether their nodes face each other in pairs; none for a plane.
    pub matching: Option<bool>,
    /// Smallest gap of the nodes that may touch it (m).
    pub gap: f64,
    pub contact_nodes: usize,
    /// Largest speed of such a node towards it (m/s).
    pub approach_speed: f64,
}

/// The materials as they were stated.
pub(super) fn materials(problem: &AnyProblem) -> Vec<MaterialInfo> {
    let stated = problem.conditions().materials.iter();
    let told = stated.map(|(group, law)| MaterialInfo {
        group: group.clone(),
        young: law.young(),
        density: law.density(),
        wave_speed: law.wave_speed(),
        yield_stress: law.yield_stress(),
        tangent: law.hardening().map(|hardening| hardening.tangent(law.young())),
        kinematic: law.hardening().map(|hardening| hardening.kinematic()),
    });
    told.collect()
}

/// The planes, in their order, and the surfaces of different bodies.
pub(super) fn planes(problem: &AnyProblem) -> Vec<PlaneInfo> {
    let starts = problem.starts_of_contact();
    let told = |obstacle: usize| {
        let surface = problem.contact_nodes().iter().enumerate();
        let mine = surface.filter(|(_, node)| node.obstacle == obstacle && node.free);
        let speeds = mine.clone().map(|(at, _)| -starts[at].1);
        PlaneInfo {
            groups: problem.interface_of(obstacle).map(|interface| interface.groups().map(str::to_string)),
            matching: problem.interface_of(obstacle).map(Interface::is_matching),
            gap: problem.initial_gap(problem.slave_of(obstacle)),
            contact_nodes: mine.count(),
            approach_speed: speeds.fold(f64::NEG_INFINITY, f64::max),
        }
    };
    // The two sides of a pair have the same gaps; of non-matching interfaces, those of the slave count.
    (0..problem.obstacle_count()).filter(|&obstacle| problem.leads_interface(obstacle)).map(told).collect()
}

impl MaterialInfo {
    pub(super) fn line(&self) -> (&'static str, String) {
        let of = self.group.as_ref().map_or_else(String::new, |group| format!(" of \"{group}\""));
        let [young, density, speed] = [self.young, self.density, self.wave_speed].map(|x| trimmed(x, 4));
        let yields =
            self.yield_stress.map_or_else(String::new, |stress| format!(", yield stress {} Pa", trimmed(stress, 4)));
        let beyond = match (self.yield_stress, self.tangent, self.kinematic) {
            (Some(_), Some(tangent), Some(kinematic)) => {
                let kinematic = (kinematic > 0.0).then(|| format!(", {} kinematic", percent(kinematic)));
                format!(" with tangent {} Pa{}", trimmed(tangent, 4), kinematic.unwrap_or_default())
            }
            (Some(_), ..) => " for the verdict alone".to_string(),
            _ => String::new(),
        };
        ("material", format!("E {young} Pa, density {density} kg/m³, waves {speed} m/s{yields}{beyond}{of}"))
    }
}

impl PlaneInfo {
    pub(super) fn line(&self) -> (&'static str, String) {
        let (gap, speed) = (trimmed(self.gap, 4), trimmed(self.approach_speed, 4));
        // Of what moves nearer by itself; loads may bring it sooner or later.
        let when = if self.approach_speed > 0.0 {
            format!(" at {speed} m/s: {} s", trimmed(self.gap / self.approach_speed, 4))
        } else {
            String::new()
        };
        match &self.groups {
            None => ("plane", format!("gap {gap} m{when}, {} may touch", counted(self.contact_nodes, "node"))),
            Some([first, second]) => {
                let nodes = match self.matching {
                    Some(false) => {
                        format!(
                            "{} of {} may touch, non-matching",
                            counted(self.contact_nodes, "node"),
                            side_names([first, second])[0]
                        )
                    }
                    _ => format!("{} of nodes may touch", counted(self.contact_nodes, "pair")),
                };
                ("contact", format!("{}: gap {gap} m{when}, {nodes}", contact_name([first, second])))
            }
        }
    }
}
