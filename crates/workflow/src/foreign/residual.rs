//! The residual of the balance at all nodes and instants, and factors of its terms that make it least.

use super::balance::Terms;
use super::ratio;
use percute_core::border::Vector;

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

/// The largest component of the residual.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Worst {
    pub(super) node: usize,
    pub(super) component: usize,
    /// Its instant (s).
    pub(super) time: f64,
    /// M a, K u, F and R there (N).
    pub(super) terms: [f64; 4],
    /// Its size (N).
    pub(super) size: f64,
}

/// Sums over all nodes and instants.
#[derive(Clone, Debug)]
pub(super) struct Residual {
    /// The largest component.
    pub(super) worst: Worst,
    /// The largest term (N).
    largest: f64,
    /// Sums of squares of the residual at each node and each instant (N²).
    pub(super) by_node: Vec<f64>,
    pub(super) by_instant: Vec<f64>,
    /// The largest component at each instant (N).
    pub(super) largest_at: Vec<f64>,
    /// Nodes that can touch a plane.
    surface: Vec<bool>,
    /// Whether their contact forces follow from the balance: it says nothing there.
    open: bool,
    /// Scalar products of the terms with their signs (N²), inside the body and at its surface.
    products: [[[f64; 4]; 4]; 2],
}

impl Residual {
    /// Of a body with these nodes that can touch a plane; with `open`, the balance says nothing at them.
    pub(super) fn new(surface: Vec<bool>, open: bool) -> Self {
        let by_node = vec![0.0; surface.len()];
        let (worst, by_instant, largest_at) = (Worst::default(), Vec::new(), Vec::new());
        Self { worst, largest: 0.0, by_node, by_instant, largest_at, surface, open, products: [[[0.0; 4]; 4]; 2] }
    }

    /// The residual of the same body before the first instant.
    pub(super) fn emptied(&self) -> Self {
        Self::new(self.surface.clone(), self.open)
    }

    /// Adds an instant (s) with its contact forces at all nodes (N).
    pub(super) fn add(&mut self, terms: &Terms, reaction: &[Vector], index: usize, time: f64) {
        for sizes in [&mut self.by_instant, &mut self.largest_at] {
            sizes.resize(sizes.len().max(index + 1), 0.0);
        }
        for (node, force) in reaction.iter().enumerate() {
            for (component, r) in force.iter().enumerate() {
                let of = |field: &[Vector]| field[node][component];
                let fields = [of(&terms.inertia), of(&terms.stiffness), of(&terms.load), *r];
                let signed: [f64; 4] = std::array::from_fn(|k| SIGNS[k] * fields[k]);
                let rest = signed[INERTIA] + signed[STIFFNESS] + signed[LOAD] + signed[REACTION];
                self.expect(fields.into_iter().fold(0.0, |most: f64, x| most.max(x.abs())));
                if rest.abs() > self.worst.size {
                    self.worst = Worst { node, component, time, terms: fields, size: rest.abs() };
                }
                self.by_node[node] += rest * rest;
                self.by_instant[index] += rest * rest;
                self.largest_at[index] = self.largest_at[index].max(rest.abs());
                let rows = self.products[usize::from(self.surface[node])].iter_mut().zip(signed);
                rows.for_each(|(row, a)| row.iter_mut().zip(signed).for_each(|(sum, b)| *sum += a * b));
            }
        }
    }

    /// Takes in a force that the residual is compared with (N).
    pub(super) fn expect(&mut self, force: f64) {
        self.largest = self.largest.max(force);
    }

    /// Whether the balance says nothing at a node.
    pub(super) fn is_open(&self, node: usize) -> bool {
        self.open && self.surface[node]
    }

    /// Leaves out what contact forces can change.
    pub(super) fn leave_the_surface_open(&mut self) {
        self.open = true;
    }

    /// The largest component over the largest term.
    pub(super) fn relative(&self) -> f64 {
        self.share(self.worst.size)
    }

    /// A force (N) over the largest term.
    pub(super) fn share(&self, force: f64) -> f64 {
        ratio(force, self.largest)
    }

    fn products(&self) -> [[f64; 4]; 4] {
        let [inside, surface] = &self.products;
        let share = if self.open { 0.0 } else { 1.0 };
        std::array::from_fn(|i| std::array::from_fn(|j| inside[i][j] + share * surface[i][j]))
    }

    /// The norm of the residual with such factors of its terms, over that of the terms; infinite if it is no number.
    pub(super) fn norm(&self, factors: [f64; 4]) -> f64 {
        norm(&self.products(), factors)
    }

    /// The same inside the body, where no contact force acts.
    pub(super) fn inside(&self) -> f64 {
        self.inside_with([1.0; 4])
    }

    /// The same with such factors of its terms.
    pub(super) fn inside_with(&self, factors: [f64; 4]) -> f64 {
        norm(&self.products[0], factors)
    }

    /// The square of the residual (N²), and that of the norm of all terms.
    pub(super) fn squares(&self) -> [f64; 2] {
        squares(&self.products(), [1.0; 4])
    }

    /// The factors of one or two terms that make the residual least, among all four; none if a term is zero.
    pub(super) fn fit(&self, terms: &[usize]) -> Option<[f64; 4]> {
        fit(&self.products(), terms)
    }
}

/// The square of the residual with such factors of its terms, and the sum of the squares of the terms (N²).
fn squares<const K: usize>(products: &[[f64; K]; K], factors: [f64; K]) -> [f64; 2] {
    let (mut rest, mut size) = (0.0, 0.0);
    for (row, a) in products.iter().zip(factors) {
        rest += a * row.iter().zip(factors).map(|(product, b)| b * product).sum::<f64>();
    }
    (0..K).for_each(|k| size += factors[k] * factors[k] * products[k][k]);
    // Rounding can make a residual of zero negative.
    [rest.max(0.0), size]
}

/// The norm of the residual with such factors of its terms, over that of the terms; infinite if it is no number.
pub(super) fn norm<const K: usize>(products: &[[f64; K]; K], factors: [f64; K]) -> f64 {
    let [rest, size] = squares(products, factors);
    let norm = (rest / size).sqrt();
    if norm.is_nan() { f64::INFINITY } else { norm }
}

/// The factors of one or two terms that make the residual least, among all; none if a term is zero.
pub(super) fn fit<const K: usize>(g: &[[f64; K]; K], terms: &[usize]) -> Option<[f64; K]> {
    let rest = |k: usize| -(0..K).filter(|j| !terms.contains(j)).map(|j| g[k][j]).sum::<f64>();
    let mut factors = [1.0; K];
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Terms of which M a is `factors[0]` times and R `factors[1]` times what balances the others.
    fn residual(factors: [f64; 2]) -> Residual {
        let mut residual = Residual::new(vec![false; 3], false);
        let stiffness = vec![[1.0, -2.0, 0.0], [0.5, 3.0, 0.0], [-1.5, 0.25, 0.0]];
        let load = vec![[0.1, 0.2, 0.0], [-0.3, 0.4, 0.0], [0.5, 0.0, 0.0]];
        let reaction = [[0.0, 4.0, 0.0], [1.0, 0.5, 0.0], [0.0, 0.0, 0.0]];
        let inertia = |node: usize, c: usize| load[node][c] + reaction[node][c] - stiffness[node][c];
        let terms = Terms {
            inertia: (0..3).map(|node| std::array::from_fn(|c| factors[0] * inertia(node, c))).collect(),
            stiffness: stiffness.clone(),
            load: load.clone(),
        };
        residual.add(&terms, &reaction.map(|r| r.map(|r| factors[1] * r)), 0, 0.0);
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
