//! Rows of the pack: what was expected, what came out.

/// What theory says of a difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// It falls with this power of the size of the elements, or of what is halved from run to run.
    Order(f64),
    /// It is at most this.
    Within(f64),
}

/// One quantity of one case on meshes each twice as fine as the one before.
#[derive(Clone, Debug, PartialEq)]
pub struct PackRow {
    /// What it is.
    pub quantity: String,
    /// Its unit.
    pub unit: &'static str,
    /// Its exact value.
    pub exact: f64,
    /// What was computed, the finest last.
    pub computed: Vec<f64>,
    /// What theory says of the difference.
    pub expected: Expected,
    /// Why.
    pub reason: &'static str,
}

impl PackRow {
    /// A quantity that converges with an order.
    pub(super) fn of_order(
        quantity: impl Into<String>,
        unit: &'static str,
        exact: f64,
        computed: Vec<f64>,
        order: f64,
        reason: &'static str,
    ) -> Self {
        Self { quantity: quantity.into(), unit, exact, computed, expected: Expected::Order(order), reason }
    }

    /// Computed on the finest mesh.
    #[must_use]
    pub fn finest(&self) -> f64 {
        self.computed.last().copied().unwrap_or(f64::NAN)
    }

    /// Computed less exact, on the finest mesh.
    #[must_use]
    pub fn difference(&self) -> f64 {
        self.finest() - self.exact
    }

    /// The mean order of convergence over the meshes; of a difference that is only bounded, none.
    #[must_use]
    pub fn observed(&self) -> Option<f64> {
        let Expected::Order(_) = self.expected else { return None };
        let first = (self.computed.first()? - self.exact).abs();
        let refinements = self.computed.len() - 1;
        (refinements > 0).then(|| (first / self.difference().abs()).log2() / refinements as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Differences 8, −2, ½: order 2.
    #[test]
    fn orders() {
        let row = |expected| PackRow {
            quantity: String::new(),
            unit: "m",
            exact: 1.0,
            computed: vec![9.0, -1.0, 1.5],
            expected,
            reason: "",
        };
        assert_eq!(row(Expected::Order(2.0)).observed(), Some(2.0));
        assert_eq!((row(Expected::Within(1.0)).observed(), row(Expected::Within(1.0)).difference()), (None, 0.5));
    }
}
