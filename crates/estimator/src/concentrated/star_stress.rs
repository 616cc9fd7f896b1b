//! The stress of concentrated tractions in the star of a node, of least energy.
//!
//! The traction of a hat less the linear traction with the same resultant and moment balances itself. It is balanced in
//! the whole star, on sub-triangles that carry the macro-element's stress: balanced in one element it would cost many
//! times the energy. Unknown are the linear tractions on the edges between sub-triangles. They minimise the
//! complementary energy under equilibrium of each sub-triangle. The same holds for any traction that is linear between
//! break points.

use super::HATS;
use super::cut_star::{CutStar, SubTriangle};
use super::edge_traction::{EdgeTraction, OnEdge, forces, radii};
use super::layer::Layer;
use super::least_energy::{Solved, SubTriangles};
use super::panel::{self, Panel};
use crate::residual::worse;
use crate::stress::{LOADS, Loading, MONOMIALS, StressResiduals, TriangleStress};
use nalgebra::{DMatrix, SMatrix};
use percute_core::material::LinearLaw;

/// A symmetric matrix: its lower triangle, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Symmetric(Vec<f64>);

impl Symmetric {
    fn new(matrix: &DMatrix<f64>) -> Self {
        Self((0..matrix.nrows()).flat_map(|i| (0..=i).map(move |j| matrix[(i, j)])).collect())
    }

    #[inline]
    pub(crate) fn at(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.max(j), i.min(j));
        self.0[i * (i + 1) / 2 + j]
    }

    /// The entries of a row up to the diagonal.
    #[inline]
    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.0[i * (i + 1) / 2..][..=i]
    }
}

/// The stresses of unit resultants in a star, in the order of [`super::place`].
///
/// Elements begin with the node of the star. Forces are per unit of the thickness of an element.
#[derive(Clone, Debug)]
pub(crate) struct StarStress {
    /// ∫τ:K⁻¹τ over the star, of unit resultants (m/N).
    pub(crate) energy: Symmetric,
    /// ∫τ:K⁻¹τ in each element but the last (m/N per unit of thickness), which has the rest.
    energies: Vec<Symmetric>,
    /// Thickness of each element (m).
    extents: Vec<f64>,
    /// ∫σ:K⁻¹τ in each element, one row for each load of the element, with σ the stress that balances it: tractions,
    /// then Γ_DA − f_d.
    pub(crate) products: Vec<DMatrix<f64>>,
    /// How far they are from equilibrium, relative to the largest term.
    pub(crate) residuals: StarResiduals,
}

/// Residuals of the stresses of a star.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StarResiduals {
    /// Resultants and moments of sub-triangles.
    pub(crate) resultants: f64,
    /// Divergence, tractions and their continuity inside sub-triangles.
    pub(crate) stress: StressResiduals,
}

/// Rounding that one refinement can balance leaves less, at most 2e-13, and forms that are definite. From 1e-11 on,
/// some energies are negative.
const BALANCED: f64 = 1e-12;

impl StarResiduals {
    /// Whether rounding leaves stresses that balance: the closer ν is to ½, and the more slender elements are, the more
    /// digits are lost.
    pub(crate) fn balanced(&self) -> bool {
        self.within(BALANCED)
    }

    /// Whether all residuals are at most this.
    pub(super) fn within(&self, limit: f64) -> bool {
        let StressResiduals { divergence, edges, inner } = self.stress;
        [self.resultants, divergence, edges, inner].iter().all(|residual| *residual <= limit)
    }
}

/// One element of a star.
pub(crate) struct StarElement<'a, L> {
    /// Its other corners, from the node of the star (m), counterclockwise.
    pub(crate) ends: [[f64; 2]; 2],
    /// Its law.
    pub(crate) law: &'a L,
}

/// ∫mτ for each monomial m in the three parts of an element, rows (monomial, component), under each load.
type MonomialMoments = [DMatrix<f64>; 3];

impl StarStress {
    /// Those of hats on candidate edges of a star: 0 the first, 1 the last. `elements` are ordered counterclockwise;
    /// `supported` are the components on the first and the last edge whose tractions are unknown.
    pub(crate) fn new<L: LinearLaw>(
        elements: &[StarElement<'_, L>],
        edges: &[usize],
        supported: [[bool; 2]; 2],
    ) -> Self {
        let hats = |&edge: &usize| EdgeTraction::narrow_hats().map(move |hat| (edge, hat));
        Self::of(elements, &edges.iter().flat_map(hats).collect::<Vec<_>>(), supported)
    }

    /// Those of tractions along both axes, less the linear tractions with the same moments.
    pub(super) fn of<L: LinearLaw, const P: usize>(
        elements: &[StarElement<'_, L>],
        tractions: &[OnEdge<P>],
        supported: [[bool; 2]; 2],
    ) -> Self {
        let radii = radii(tractions.iter().flat_map(|(_, traction)| traction.0.map(|[place, _]| place)));
        Self::under(elements, &radii, |piece| forces(piece, tractions), supported)
    }

    /// Those of tractions that balance themselves, one for each column of `forces`: on a piece of the first and of the
    /// last edge, two components at its inner and its outer end. They are linear between these radii.
    pub(super) fn under<L: LinearLaw>(
        elements: &[StarElement<'_, L>],
        radii: &[f64],
        forces: impl Fn([f64; 2]) -> [DMatrix<f64>; 2],
        supported: [[bool; 2]; 2],
    ) -> Self {
        // Loads are those of stress times thickness. The modulus makes the system one of numbers near 1.
        let scale = elements[0].law.extent() / elements[0].law.compliance::<2>().0;
        let solved = solve(elements, scale, (radii, forces), supported);
        let (moments, residuals) = gather(&solved, elements.len());
        let works: Vec<_> = (0..=elements.len()).map(|edge| solved.work(edge) / scale).collect();
        let extents: Vec<f64> = elements.iter().map(|element| element.law.extent()).collect();
        let parts =
            works.windows(2).zip(&extents).map(|(works, extent)| Symmetric::new(&((&works[0] - &works[1]) * *extent)));
        Self {
            energies: parts.take(elements.len() - 1).collect(),
            energy: Symmetric::new(&(&works[0] - &works[elements.len()])),
            extents,
            products: elements.iter().zip(moments).map(|(element, moments)| products(element, &moments)).collect(),
            residuals,
        }
    }

    /// ∫τ:K⁻¹τ of two unit resultants in an element (m/N per unit of thickness).
    pub(super) fn energy_in(&self, element: usize, i: usize, j: usize) -> f64 {
        let own = |(energy, extent): (&Symmetric, &f64)| energy.at(i, j) / extent;
        let extent = self.extents[element];
        self.energies.get(element).map_or_else(
            || extent * (self.energy.at(i, j) - self.energies.iter().zip(&self.extents).map(own).sum::<f64>()),
            |energy| energy.at(i, j),
        )
    }

    /// About how much memory it takes (bytes), with so many elements and edges with hats.
    pub(crate) fn memory(elements: usize, edges: usize) -> usize {
        let unit = 2 * HATS * edges;
        size_of::<Self>() + size_of::<f64>() * elements * (unit * (unit + 1) / 2 + LOADS * unit)
    }
}

/// Rings whose ratios differ by less are similar: rounding of a power.
const SAME_RATIO: f64 = 16.0 * f64::EPSILON;

/// The star, cut at the break points of tractions and about by halves, and its loads under each of them.
fn solve<L: LinearLaw>(
    elements: &[StarElement<'_, L>],
    scale: f64,
    (radii, forces): (&[f64], impl Fn([f64; 2]) -> [DMatrix<f64>; 2]),
    supported: [[bool; 2]; 2],
) -> Solved {
    let mut fan = vec![elements[0].ends[0]];
    fan.extend(elements.iter().map(|element| element.ends[1]));
    let star = CutStar::new(&fan);
    let panels = |triangles: Vec<SubTriangle>| -> Vec<Panel> {
        let panel = |triangle: SubTriangle| {
            let law = elements[triangle.element()].law;
            Panel::new(triangle, law, scale / law.extent())
        };
        triangles.into_iter().map(panel).collect()
    };
    let layer = |triangles| Layer::new(panels(triangles), star.sectors(), &supported);
    let (mut ratios, mut layers, mut rings) = (Vec::new(), Vec::new(), Vec::new());
    for pair in radii.windows(2) {
        let ratio = pair[1] / pair[0];
        let same = |other: &f64| (other - ratio).abs() <= SAME_RATIO * ratio;
        let known = ratios.iter().position(same).unwrap_or(ratios.len());
        if known == ratios.len() {
            ratios.push(ratio);
            layers.push(layer(star.ring(ratio)));
        }
        rings.push((known, pair[0]));
    }
    rings.push((layers.len(), radii[radii.len() - 1]));
    layers.push(layer(star.core()));
    let inner = radii[1..].iter().chain(&[0.0]);
    let given: Vec<_> = inner.zip(radii).map(|(inner, outer)| forces([*inner, *outer])).collect();
    Solved::new(&star, SubTriangles { outline: panels(star.outline()), layers, rings }, &given, &supported)
}

/// Moments of the stresses in each element, and the residuals of all sub-triangles.
fn gather(solved: &Solved, elements: usize) -> (Vec<MonomialMoments>, StarResiduals) {
    let columns = solved.states[0].force.ncols();
    let mut all = vec![[(); 3].map(|()| DMatrix::zeros(3 * MONOMIALS, columns)); elements];
    let mut residuals = StarResiduals::default();
    let mut next = 0;
    solved.each(|panel, ring, loads| {
        let radius = solved.parts.rings[ring].1;
        let into = &mut all[panel.triangle.element()][panel.triangle.opposite()];
        // Rows of monomials of degree 0, 1 and 2. A stress of given loads is as 1 over lengths.
        for (rows, degree) in [(0..3, 1), (3..9, 2), (9..18, 3)] {
            let (first, count) = (rows.start, rows.len());
            let moments = panel.moments.rows(first, count) * loads;
            into.rows_mut(first, count).zip_apply(&moments, |sum, m| *sum += radius.powi(degree) * m);
        }
        let miss = panel.resultants * loads;
        for (load, miss) in loads.column_iter().zip(miss.column_iter()) {
            // The traction of a unit hat on its edge is at least 1 over the length of the edge: its loads are near 1.
            residuals.resultants = worse(residuals.resultants, miss.amax() / load.amax().max(1.0));
        }
        // The stress is a constant linear map of the loads: each sub-triangle is checked under one of them in its turn.
        let stress = panel.map.residuals(&panel.loading(loads.column(next % columns).as_slice()), 1.0);
        residuals.stress.divergence = worse(residuals.stress.divergence, stress.divergence);
        residuals.stress.edges = worse(residuals.stress.edges, stress.edges);
        residuals.stress.inner = worse(residuals.stress.inner, stress.inner);
        next += 1;
    });
    (all, residuals)
}

/// ∫σ:K⁻¹τ for the stress σ of each unit load of an element.
fn products<L: LinearLaw>(element: &StarElement<'_, L>, moments: &MonomialMoments) -> DMatrix<f64> {
    let [first, second] = element.ends;
    let map = TriangleStress::new(&[[0.0; 2], first, second], element.law);
    let (alpha, beta) = element.law.compliance::<2>();
    let mut product = DMatrix::zeros(LOADS, moments[0].ncols());
    for (part, moments) in moments.iter().enumerate() {
        let mut strains = SMatrix::<f64, LOADS, { 3 * MONOMIALS }>::zeros();
        for load in 0..LOADS {
            for (m, [xx, yy, xy]) in map.piecewise(&unit_load(load)).polynomials(part).into_iter().enumerate() {
                let trace = beta * (xx + yy);
                strains[(load, 3 * m)] = alpha * xx - trace;
                strains[(load, 3 * m + 1)] = alpha * yy - trace;
                strains[(load, 3 * m + 2)] = 2.0 * alpha * xy;
            }
        }
        product += strains * moments;
    }
    product
}

fn unit_load(load: usize) -> Loading<2, 3> {
    let at = |k: usize| f64::from(u8::from(k == load));
    let traction = panel::tractions(&std::array::from_fn(at)).traction;
    let volume = std::array::from_fn(|i| std::array::from_fn(|c| at(panel::LOADS + 2 * i + c)));
    Loading { traction, volume }
}

#[cfg(test)]
mod tests;
