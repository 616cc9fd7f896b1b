//! All nodal and element fields at one instant t_n.

use crate::kinematic::Knot;
use crate::reconstruction::{Densities, Pressure, SurfaceStep};

/// Which value at an instant where contact changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Before,
    After,
}

/// The fields of one instant, filled as they become known: first the motion, then the contact force
/// on both sides and ã, then stress and tractions.
#[derive(Clone, Debug)]
pub(crate) struct TimeLevel<const D: usize> {
    /// n.
    pub(crate) index: usize,
    pub(crate) knot: Knot<D>,
    /// The knot t_{n−½}.
    pub(crate) mid: Option<Knot<D>>,
    /// u_n of the simulation (m).
    pub(crate) displacement: Vec<[f64; D]>,
    /// Σ forces but contact (N): external, internal, supports. Emptied once ã is known.
    pub(crate) force: Vec<[f64; D]>,
    /// f_d on each element (N/m³), empty if there is none.
    pub(crate) body_force: Vec<[f64; D]>,
    /// Prescribed moments on the loaded facets (N).
    pub(crate) load_moments: Vec<[[f64; D]; D]>,
    pub(crate) surface: SurfaceStep<D>,
    /// ã (m/s²), at contact nodes on the side `After`.
    pub(crate) acceleration: Vec<[f64; D]>,
    /// ã at contact nodes on the side `Before`.
    pub(crate) acceleration_before: Vec<[f64; D]>,
    pub(crate) density_before: Densities<D>,
    pub(crate) density_after: Densities<D>,
    /// Where densities may act off contact: the normal pressures on each candidate facet, at its beginning and its end, of
    /// each step since the sampled level before.
    pub(crate) pressures: Vec<Vec<[Pressure<D>; 2]>>,
    /// Part of friction in the contact part of η on each candidate facet (J), up to t_{n−½} and to t_n.
    pub(crate) contact: Vec<[f64; 2]>,
    /// σ_h of each element (Pa).
    pub(crate) stress: Vec<[[f64; D]; D]>,
    /// Largest nodal force of any element (N).
    pub(crate) force_scale: f64,
    /// Moments of the tractions along the walks around all nodes (N), side `After`.
    pub(crate) flux: Vec<[f64; D]>,
    /// The same around contact nodes, side `Before`.
    pub(crate) flux_before: Vec<[f64; D]>,
}

impl<const D: usize> TimeLevel<D> {
    /// A level of which the motion alone is known.
    pub(crate) fn new(index: usize, mid: Option<Knot<D>>, knot: Knot<D>, contact_facets: usize) -> Self {
        let none = vec![[[0.0; D]; D]; contact_facets];
        Self {
            index,
            knot,
            mid,
            displacement: Vec::new(),
            force: Vec::new(),
            body_force: Vec::new(),
            load_moments: Vec::new(),
            surface: SurfaceStep { reaction: Vec::new(), smoothed_reaction: Vec::new(), touching: Vec::new() },
            acceleration: Vec::new(),
            acceleration_before: Vec::new(),
            density_before: none.clone(),
            density_after: none,
            pressures: Vec::new(),
            contact: vec![[0.0; 2]; contact_facets],
            stress: Vec::new(),
            force_scale: 0.0,
            flux: Vec::new(),
            flux_before: Vec::new(),
        }
    }
}
