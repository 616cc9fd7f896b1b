//! The stress of tractions on the edges of a star less linear ones: what balances itself.

use super::edge_traction::{on, radii};
use super::hat_stress::{StarFrame, in_element};
use super::star_stress::{StarElement, StarStress};
use crate::stress::LOADS;
use nalgebra::DMatrix;
use percute_core::material::LinearLaw;

/// Break points that the tractions of a star may have.
const POINTS: usize = 48;

/// A traction on an edge of a star, and the linear one that is taken off it. Values are times the length of the edge
/// (N), places are from the node of the star.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeRest {
    /// Places, ascending, and the values there: linear between, zero before the first and after the last.
    pub(crate) points: Vec<(f64, [f64; 2])>,
    /// The linear one at the node and at the other end.
    pub(crate) linear: [[f64; 2]; 2],
}

impl EdgeRest {
    fn component(&self, c: usize) -> Vec<[f64; 2]> {
        self.points.iter().map(|(place, value)| [*place, value[c]]).collect()
    }

    /// The largest force along an axis between two break points, or of the linear traction (N).
    fn largest(&self, c: usize) -> f64 {
        let force = |[a, fa]: [f64; 2], [b, fb]: [f64; 2]| 0.5 * (b - a) * (fa.abs() + fb.abs());
        let [near, far] = self.linear;
        let spans = self.points.windows(2).map(|span| force([span[0].0, span[0].1[c]], [span[1].0, span[1].1[c]]));
        spans.fold(force([0.0, near[c]], [1.0, far[c]]), f64::max)
    }
}

/// Energies below minus this part of their sum show that rounding has spoilt a stress.
const NEGATIVE: f64 = 1e-10;

/// Larger residuals show that too: rings a hundredth of their radius wide leave up to 2e-12 of forces near 1. A smaller
/// limit would be met or not by rounding.
const SPOILT: f64 = 1e-11;

/// The stress τ of such a rest in one element of the star.
#[derive(Clone, Debug)]
pub(crate) struct RestStress {
    /// The root of its energy (J^½).
    pub(crate) root: f64,
    /// ∫σ:K⁻¹τ for the stress σ of each unit load of the element (J), whose first corner is the node of the star.
    products: [f64; LOADS],
}

impl RestStress {
    /// ∫σ:K⁻¹τ (J) for the loads of the element, which has this corner at the node of the star.
    pub(crate) fn products(&self, at: usize) -> [f64; LOADS] {
        in_element(&self.products, at, StarFrame([1.0, 0.0]))
    }
}

/// The stress in the elements of a star, for what is on its first and on its last edge; both balance each other. None
/// if there are too many points, or if rounding spoils the stress.
pub(crate) fn rest_stress<L: LinearLaw>(
    elements: &[StarElement<'_, L>],
    edges: &[EdgeRest; 2],
    supported: [[bool; 2]; 2],
) -> Option<Vec<RestStress>> {
    if edges.iter().map(|edge| edge.points.len()).sum::<usize>() > POINTS {
        return None;
    }
    // Each component is a column of its own, with forces near 1.
    let size = [0, 1].map(|c| edges[0].largest(c).max(edges[1].largest(c)));
    let own = edges.each_ref().map(|edge| [0, 1].map(|c| edge.component(c)));
    let forces = |piece: [f64; 2]| {
        let mut forces = [(); 2].map(|()| DMatrix::zeros(4, 2));
        for (e, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let ([near, far], values) = (edges[e].linear, on(&own[e][c], piece));
            for end in 0..2 {
                let linear = near[c] + (far[c] - near[c]) * piece[end];
                let scale = if size[c] > 0.0 { (piece[1] - piece[0]) / size[c] } else { 0.0 };
                forces[e][(2 * end + c, c)] = scale * (values[end] - linear);
            }
        }
        forces
    };
    let places = edges.iter().flat_map(|edge| edge.points.iter().map(|(place, _)| *place));
    let stress = StarStress::under(elements, &radii(places), forces, supported);
    if !stress.residuals.within(SPOILT) {
        return None;
    }
    let [x, y] = size;
    let energy = |(element, data): (usize, &StarElement<'_, L>)| {
        let form = |i: usize, j: usize| stress.energy_in(element, i, j);
        let sum = x * x * form(0, 0) + 2.0 * x * y * form(0, 1) + y * y * form(1, 1);
        0.5 * sum / data.law.extent()
    };
    let energies: Vec<f64> = elements.iter().enumerate().map(energy).collect();
    let total: f64 = energies.iter().sum();
    if total < 0.0 || energies.iter().any(|energy| *energy < -NEGATIVE * total) {
        return None;
    }
    let of = |(energy, products): (&f64, &DMatrix<f64>)| {
        // A stress without energy does no work: what is left of it is rounding.
        let size = if *energy > 0.0 { size } else { [0.0; 2] };
        let product = |load: usize| size[0] * products[(load, 0)] + size[1] * products[(load, 1)];
        RestStress { root: energy.max(0.0).sqrt(), products: std::array::from_fn(product) }
    };
    Some(energies.iter().zip(&stress.products).map(of).collect())
}
