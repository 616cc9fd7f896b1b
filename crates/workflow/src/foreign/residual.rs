//! The residual of the balance at all nodes and instants, and factors of its terms that make it least.

use super::balance::Terms;

/// M a.
pub(super) const INERTIA: usize = 0;
/// K u.
pub(super) const STIFFNESS: usize = 1;
/// F.
pub(super) const LOAD: usize = 2;
/// R.
pub(super) const REACTION: usize = 3;
/// The signs of the terms in the residual.
const SIGNS: [f64; 4] = [1.0, 1.0, -1.0, -1.0];

/// Sums over all nodes and instants.
#[derive(Clone, Debug)]
pub(super) struct Residual {
    /// Largest component and largest term (N).
    largest: [f64; 2],
    /// Node and instant (s) of the largest component.
    pub(super) place: (usize, f64),
    /// Sum of squares of the residual at each node (N²).
    pub(super) by_node: Vec<f64>,
    /// Nodes whose contact forces follow from the balance: it says nothing there.
    pub(super) open: Vec<bool>,
    /// Scalar products of the terms with their signs at all other nodes (N²).
    products: [[f64; 4]; 4],
}

impl Residual {
    pub(super) fn new(open: Vec<bool>) -> Self {
        Self { largest: [0.0; 2], place: (0, 0.0), by_node: vec![0.0; open.len()], open, products: [[0.0; 4]; 4] }
    }

    /// Adds an instant (s) with its contact forces at all nodes (N).
    pub(super) fn add<const D: usize>(&mut self, terms: &Terms<D>, reaction: &[[f64; D]], time: f64) {
        for (node, force) in reaction.iter().enumerate() {
            for (c, r) in force.iter().enumerate() {
                let fields = [terms.inertia[node][c], terms.stiffness[node][c], terms.load[node][c], *r];
                let signed: [f64; 4] = std::array::from_fn(|k| SIGNS[k] * fields[k]);
                let rest = signed[INERTIA] + signed[STIFFNESS] + signed[LOAD] + signed[REACTION];
                self.expect(fields.into_iter().fold(0.0, |most: f64, x| most.max(x.abs())));
                if rest.abs() > self.largest[0] {
                    self.largest[0] = rest.abs();
                    self.place = (node, time);
                }
                self.by_node[node] += rest * rest;
                if !self.open[node] {
                    let rows = self.products.iter_mut().zip(signed);
                    rows.for_each(|(row, a)| row.iter_mut().zip(signed).for_each(|(sum, b)| *sum += a * b));
                }
            }
        }
    }

    /// Takes in a force that the residual is compared with (N).
    pub(super) fn expect(&mut self, force: f64) {
        self.largest[1] = self.largest[1].max(force);
    }

    /// The largest component over the largest term.
    pub(super) fn relative(&self) -> f64 {
        let [residual, term] = self.largest;
        if residual == 0.0 { 0.0 } else { residual / term }
    }

    /// The norm of the residual with such factors of its terms, over that of the terms; infinite if it is no number.
    pub(super) fn norm(&self, factors: [f64; 4]) -> f64 {
        let (mut rest, mut size) = (0.0, 0.0);
        for (row, a) in self.products.iter().zip(factors) {
            rest += a * row.iter().zip(factors).map(|(product, b)| b * product).sum::<f64>();
        }
        (0..4).for_each(|k| size += factors[k] * factors[k] * self.products[k][k]);
        // Rounding can make a residual of zero negative.
        let norm = (rest.max(0.0) / size).sqrt();
        if norm.is_nan() { f64::INFINITY } else { norm }
    }

    /// The factors of one or two terms that make the residual least, among all four; none if a term is zero.
    pub(super) fn fit(&self, terms: &[usize]) -> Option<[f64; 4]> {
        let g = &self.products;
        let rest = |k: usize| -(0..4).filter(|j| !terms.contains(j)).map(|j| g[k][j]).sum::<f64>();
        let mut factors = [1.0; 4];
        match *terms {
            [a] => factors[a] = rest(a) / g[a][a],
            [a, b] => {
                let determinant = g[a][a] * g[b][b] - g[a][b] * g[b][a];
                factors[a] = (rest(a) * g[b][b] - rest(b) * g[a][b]) / determinant;
                factors[b] = (rest(b) * g[a][a] - rest(a) * g[b][a]) / determinant;
            }
            _ => return None,
        }
        factors.iter().all(|factor| factor.is_finite()).then_some(factors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Terms of which M a is `factors[0]` times and R `factors[1]` times what balances the others.
    fn residual(factors: [f64; 2]) -> Residual {
        let mut residual = Residual::new(vec![false; 3]);
        let stiffness = vec![[1.0, -2.0], [0.5, 3.0], [-1.5, 0.25]];
        let load = vec![[0.1, 0.2], [-0.3, 0.4], [0.5, 0.0]];
        let reaction = [[0.0, 4.0], [1.0, 0.5], [0.0, 0.0]];
        let inertia = |node: usize, c: usize| load[node][c] + reaction[node][c] - stiffness[node][c];
        let terms = Terms {
            inertia: (0..3).map(|node| std::array::from_fn(|c| factors[0] * inertia(node, c))).collect(),
            stiffness: stiffness.clone(),
            load: load.clone(),
        };
        residual.add(&terms, &reaction.map(|r| r.map(|r| factors[1] * r)), 0.0);
        residual
    }

    #[test]
    fn factors_of_one_and_of_two_terms_are_found() {
        for (given, terms) in
            [([2.0, 1.0], &[INERTIA][..]), ([1.0, -1e3], &[REACTION]), ([1e6, 1e-3], &[INERTIA, REACTION])]
        {
            let residual = residual(given);
            let found = residual.fit(terms).unwrap();
            // A few roundings; the squares of terms that differ by 1e9 lose half of the digits.
            assert!((found[INERTIA] * given[0] - 1.0).abs() < 1e-6, "{found:?}");
            assert!((found[REACTION] * given[1] - 1.0).abs() < 1e-6, "{found:?}");
            assert!(residual.norm([1.0; 4]) > 0.1 && residual.norm(found) < 1e-6);
        }
        assert!(residual([1.0, 0.0]).fit(&[REACTION]).is_none());
    }
}
