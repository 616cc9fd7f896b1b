//! What the paper's table 1 says.

/// A row of the paper's table 1; each pair is sup and mean.
pub(super) struct Row {
    /// Squares along x and y, each cut in two: the paper gives their nodes and elements, 30 and 40 to 1 353 and 2 560.
    pub(super) cells: [usize; 2],
    /// Relative errors (%).
    pub(super) relative: [f64; 2],
    /// Absolute errors (J^½).
    pub(super) absolute: [f64; 2],
}

impl Row {
    /// The denominators that both say together (J^½).
    pub(super) fn denominators(&self) -> [f64; 2] {
        [0, 1].map(|k| 100.0 * self.absolute[k] / self.relative[k])
    }
}

/// Source: Louf, Gallimard and Pelle, table 1.
pub(super) const ROWS: [Row; 4] = [
    Row { cells: [5, 4], relative: [31.6, 26.6], absolute: [499.0, 394.0] },
    Row { cells: [10, 8], relative: [25.5, 21.3], absolute: [396.0, 313.0] },
    Row { cells: [20, 16], relative: [22.1, 17.8], absolute: [346.0, 260.0] },
    Row { cells: [40, 32], relative: [20.0, 15.7], absolute: [312.0, 228.0] },
];

/// How far absolute errors (sup and mean on each mesh) are from the paper's: the root of the mean square of their
/// relative differences; nothing unless all meshes are there.
pub(super) fn deviation(errors: &[[f64; 2]]) -> Option<f64> {
    if errors.len() != ROWS.len() {
        return None;
    }
    let square =
        |(ours, row): (&[f64; 2], &Row)| (0..2).map(|k| (ours[k] / row.absolute[k] - 1.0).powi(2)).sum::<f64>();
    let sum: f64 = errors.iter().zip(&ROWS).map(square).sum();
    Some((sum / (2 * ROWS.len()) as f64).sqrt())
}
