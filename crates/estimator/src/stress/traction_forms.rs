//! The energy of triangles as a form of the moments on their edges, for some triangles side by side.
//!
//! The moments are written in a basis that suits the changes that balance: on edge k, from its first node to its
//! second, opposite moments at the two; and around node i, the same moment through both edges, outward by the edge that
//! ends there. On the reference triangle, they are constant: products of the stresses are combined once for all
//! triangles.

use super::LOADS;
use super::combined_gram::{CombinedGram, unit};
use super::reference::{ALL, FREE, PAIRS, Reference};
use super::triangle::reference_compliance;
use nalgebra::Matrix2;
use percute_core::material::LinearLaw;
use percute_core::simd::lanes::{LANES, Lanes};
use std::sync::OnceLock;

/// Components of the basis: two for each edge, then two for each node.
const BASIS: usize = 12;

/// They and the free stresses.
const COMBINED: usize = BASIS + FREE;

/// Edges of the reference triangle, each opposite to its node, counterclockwise.
pub(crate) const EDGES: [[f64; 2]; 3] = [[-1.0, 1.0], [0.0, -1.0], [1.0, 0.0]];

/// A form of the components of the basis in the frame of the reference triangle, on and below the diagonal.
pub(crate) type BasisForm = [[Lanes; BASIS]; BASIS];

/// The products of the stresses of the basis and of the free stresses.
#[derive(Debug)]
pub(crate) struct TractionForms(CombinedGram<{ PAIRS.len() }>);

impl TractionForms {
    /// Those of the reference triangle, made at first use.
    pub(crate) fn get() -> &'static Self {
        static FORMS: OnceLock<TractionForms> = OnceLock::new();
        FORMS.get_or_init(|| {
            let column = |i: usize| if i < BASIS { loads(i) } else { unit(LOADS + i - BASIS) };
            let reference = Reference::get();
            Self(CombinedGram::new(&std::array::from_fn::<_, COMBINED, _>(column), |x, y| reference.product(x, y)))
        })
    }

    /// The second derivative of the energy (J) of each triangle in the components of the basis, from the edges (m) from
    /// node 0 to nodes 1 and 2 and the law of each.
    #[inline(always)]
    pub(crate) fn form<L: LinearLaw>(&self, maps: &[Matrix2<f64>; LANES], laws: &[&L; LANES]) -> BasisForm {
        let compliance: [[[f64; 3]; 3]; LANES] =
            std::array::from_fn(|lane| reference_compliance(&maps[lane], laws[lane].compliance::<2>()));
        let factor: [f64; LANES] = std::array::from_fn(|l| 1.0 / (laws[l].extent() * maps[l].determinant()));
        let weights = PAIRS.map(|(a, b)| Lanes::at_levels(|l| factor[l] * compliance[l][a][b]));
        let mut all = [[Lanes::ZERO; COMBINED]; COMBINED];
        for i in 0..COMBINED {
            for j in 0..=i {
                all[i][j] = self.0.entry(i, j, &weights);
            }
        }
        // Minimises over the free stresses, one after the other.
        for last in (BASIS..COMBINED).rev() {
            let row = all[last];
            let inverse = Lanes::constant(1.0) / row[last];
            for i in 0..last {
                let factor = row[i] * inverse;
                for j in 0..=i {
                    all[i][j] -= factor * row[j];
                }
            }
        }
        std::array::from_fn(|i| std::array::from_fn(|j| all[i][j]))
    }
}

/// The loads that component `i` of the basis makes. Tractions are D((D+1)b_p − Σb), without the extent.
fn loads(i: usize) -> [f64; ALL] {
    let mut moments = [[[0.0; 2]; 2]; 3];
    let (at, c) = (i / 2 % 3, i % 2);
    if i < BASIS / 2 {
        (moments[at][0][c], moments[at][1][c]) = (-1.0, 1.0);
    } else {
        (moments[(at + 1) % 3][1][c], moments[(at + 2) % 3][0][c]) = (1.0, -1.0);
    }
    let mut loads = [0.0; ALL];
    for (k, moments) in moments.iter().enumerate() {
        for (p, moment) in moments.iter().enumerate() {
            loads[4 * k + 2 * p + c] = 2.0 * (2.0 * moment[c] - moments[1 - p][c]);
        }
    }
    loads
}
