//! The stress of an element beside that of the tractions that balance.

use crate::numbers::Reader;
use crate::stress::LOADS;

/// Stresses in an element that balance themselves, beside σ_DA.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ResidualStress {
    /// The root of the energy of those without tractions on the other edges of the element, or a bound of it (J^½).
    /// They do no work on a constant strain.
    pub(crate) inside: f64,
    /// The root of the energy of those in the stars of nodes (J^½), and their ∫σ:K⁻¹τ for the stress σ of each unit
    /// load of the element (J).
    pub(crate) shared: f64,
    pub(crate) products: [f64; LOADS],
}

/// Numbers of it in memory.
const NUMBERS: usize = 2 + LOADS;

impl ResidualStress {
    pub(crate) const NONE: Self = Self { inside: 0.0, shared: 0.0, products: [0.0; LOADS] };

    /// One with tractions on no other edge of its element.
    pub(super) fn inside(root: f64) -> Self {
        Self { inside: root, ..Self::NONE }
    }

    /// Whether there is none.
    pub(crate) fn is_none(&self) -> bool {
        self.inside == 0.0 && self.shared == 0.0
    }

    /// The sum of the roots: a bound of the root of the energy of all together (J^½).
    pub(crate) fn root(&self) -> f64 {
        self.inside + self.shared
    }

    /// Both together.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            inside: self.inside + other.inside,
            shared: self.shared + other.shared,
            products: std::array::from_fn(|load| self.products[load] + other.products[load]),
        }
    }

    /// The mean of two.
    pub(crate) fn mean(a: &Self, b: &Self) -> Self {
        let Self { inside, shared, products } = a.plus(b);
        Self { inside: 0.5 * inside, shared: 0.5 * shared, products: products.map(|product| 0.5 * product) }
    }

    /// Appends it to numbers.
    pub(crate) fn append(&self, numbers: &mut Vec<f64>) {
        numbers.extend([self.inside, self.shared]);
        numbers.extend(self.products);
    }

    /// One that was appended.
    pub(crate) fn read(numbers: &mut Reader<'_>) -> Self {
        let all: [f64; NUMBERS] = numbers.take();
        Self { inside: all[0], shared: all[1], products: std::array::from_fn(|load| all[2 + load]) }
    }
}
