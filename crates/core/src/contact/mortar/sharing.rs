//! Changes of the relative motion, shared by the nodes of both surfaces.

use super::band::{Band, Factors};
use super::coupling::Coupling;
use super::gram::gram;

impl Coupling {
    /// The changes of velocity of the nodes of the slave and of the master, by the least kinetic energy, that change
    /// the values D v − M v' of the multipliers that bind by these (m²/s): m⁻¹Dᵀy and −m'⁻¹Mᵀy with A y = `change`.
    /// `inverse` has 1/m of the nodes of both (1/kg).
    #[must_use]
    pub fn share(&self, inverse: [&[f64]; 2], change: &[f64]) -> [Vec<f64>; 2] {
        let (mut matrix, mut factors) = (Band::default(), Factors::default());
        gram(&mut matrix, self, inverse, &mut Vec::new());
        let acting: Vec<bool> = (0..self.len()).map(|k| self.binds(k)).collect();
        let mut shared = inverse.map(|inverse| vec![0.0; inverse.len()]);
        if !factors.factorise(&matrix, &acting) {
            return shared;
        }
        let mut multipliers: Vec<[f64; 1]> = change[..self.len()].iter().map(|change| [*change]).collect();
        factors.solve(&mut multipliers);
        for (k, [multiplier]) in multipliers.into_iter().enumerate().filter(|(k, _)| acting[*k]) {
            for (at, part) in self.slave_row(k).into_iter().enumerate().filter(|(_, part)| *part != 0.0) {
                shared[0][k + at - 1] += part * multiplier * inverse[0][k + at - 1];
            }
            let (first, row) = self.master_row(k);
            for (at, part) in row.iter().enumerate() {
                shared[1][first + at] -= part * multiplier * inverse[1][first + at];
            }
        }
        shared
    }
}
