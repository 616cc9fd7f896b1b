//! What contact did, for the report: resultants at every step, and what each node went through, but not all nodes at
//! all steps, which may be millions.

use percute_core::contact_results::{AveragedPeak, ContactResults, Nearest, NodeSummary, Resultant};
use serde::Serialize;

/// The gap that is left where nothing has touched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NearestNode {
    /// The node of the contact surface that is nearest to its obstacle at the last instant.
    pub node: usize,
    /// Its gap (m).
    pub gap: f64,
    /// The first instant at which a gap would close at the speed of the last step (s); none if no node approaches.
    pub touch: Option<f64>,
}

/// The largest contact force, averaged over the time in which a wave crosses the struck element.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PeakForce {
    /// The largest sum of the normal forces of all nodes (N).
    pub force: f64,
    /// Its instant (s), at the end of the average.
    pub time: f64,
    /// The largest pressure of a node (Pa).
    pub pressure: f64,
    /// This node.
    pub node: usize,
}

/// What contact did.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct ContactReport {
    pub first_touch: Option<f64>,
    pub nearest: Option<NearestNode>,
    pub averaged_peak: Option<PeakForce>,
    pub time: Vec<f64>,
    pub total: ContactResultants,
    pub obstacles: Vec<ContactResultants>,
    pub nodes: ContactNodes,
}

/// Resultants at every step.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct ContactResultants {
    pub force: Vec<Vec<f64>>,
    pub normal_force: Vec<f64>,
    pub impulse: Vec<Vec<f64>>,
    pub area: Vec<f64>,
    pub in_contact: Vec<usize>,
    pub slipping: Vec<usize>,
    pub friction_energy: Vec<f64>,
    pub centre: Vec<Option<Vec<f64>>>,
}

/// What each contact node went through.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct ContactNodes {
    pub node: Vec<usize>,
    pub obstacle: Vec<usize>,
    pub point: Vec<Vec<f64>>,
    pub area: Vec<f64>,
    pub first_touch: Vec<Option<f64>>,
    pub time_in_contact: Vec<f64>,
    pub peak_normal_force: Vec<f64>,
    pub time_of_peak: Vec<Option<f64>>,
    pub peak_pressure: Vec<f64>,
    pub impulse: Vec<Vec<f64>>,
    pub friction_energy: Vec<f64>,
}

impl ContactReport {
    /// None without planes.
    pub(super) fn new(results: &ContactResults) -> Option<Self> {
        if results.obstacles.is_empty() {
            return None;
        }
        Some(Self {
            first_touch: results.first_touch(),
            nearest: results.nearest.map(|Nearest { at, gap, touch }| NearestNode {
                node: results.nodes[at].node.index(),
                gap,
                touch,
            }),
            averaged_peak: results.averaged_peak.map(|AveragedPeak { force, time, pressure, at }| PeakForce {
                force,
                time,
                pressure,
                node: results.nodes[at].node.index(),
            }),
            time: results.instants.clone(),
            total: ContactResultants::new(&results.total, results.dimension),
            obstacles: results.obstacles.iter().map(|all| ContactResultants::new(all, results.dimension)).collect(),
            nodes: ContactNodes::new(results),
        })
    }
}

impl ContactResultants {
    fn new(over_time: &[Resultant], dimension: usize) -> Self {
        let column = |of: fn(&Resultant) -> f64| over_time.iter().map(of).collect();
        Self {
            force: over_time.iter().map(|r| r.force[..dimension].to_vec()).collect(),
            normal_force: column(|r| r.normal_force),
            impulse: over_time.iter().map(|r| r.impulse[..dimension].to_vec()).collect(),
            area: column(|r| r.area),
            in_contact: over_time.iter().map(|r| r.in_contact).collect(),
            slipping: over_time.iter().map(|r| r.slipping).collect(),
            friction_energy: column(|r| r.friction_energy),
            centre: over_time.iter().map(|r| r.centre.map(|x| x[..dimension].to_vec())).collect(),
        }
    }
}

impl ContactNodes {
    fn new(results: &ContactResults) -> Self {
        let &ContactResults { dimension, ref nodes, ref summary, .. } = results;
        let column = |of: fn(&NodeSummary) -> f64| summary.iter().map(of).collect();
        Self {
            node: nodes.iter().map(|place| place.node.index()).collect(),
            obstacle: nodes.iter().map(|place| place.obstacle).collect(),
            point: nodes.iter().map(|place| place.point[..dimension].to_vec()).collect(),
            area: nodes.iter().map(|place| place.area).collect(),
            first_touch: summary.iter().map(|s| s.first_touch).collect(),
            time_in_contact: column(|s| s.time_in_contact),
            peak_normal_force: column(|s| s.peak_normal_force),
            time_of_peak: summary.iter().map(|s| s.time_of_peak).collect(),
            peak_pressure: column(|s| s.peak_pressure),
            impulse: summary.iter().map(|s| s.impulse[..dimension].to_vec()).collect(),
            friction_energy: column(|s| s.friction_energy),
        }
    }
}
