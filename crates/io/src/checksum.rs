//! Checksums of stored numbers and texts.

use percute_core::mesh::Mesh;

/// A checksum of what was added to it. Each step maps its 64 bits one to one, so that a change of one number always
/// changes it, and of more with all but a probability of 2⁻⁶⁴.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Checksum(u64);

impl Checksum {
    pub(crate) fn new() -> Self {
        Self(0x243f_6a88_85a3_08d3)
    }

    fn word(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    }

    /// Adds the bits of numbers, and their count.
    pub(crate) fn numbers(mut self, values: &[f64]) -> Self {
        values.iter().for_each(|x| self.word(x.to_bits()));
        self.word(values.len() as u64);
        self
    }

    /// Adds whole numbers, and their count.
    pub(crate) fn indices(mut self, values: impl IntoIterator<Item = usize>) -> Self {
        let mut count = 0;
        for value in values {
            self.word(value as u64);
            count += 1;
        }
        self.word(count);
        self
    }

    /// Adds a text.
    pub(crate) fn text(self, text: &str) -> Self {
        self.indices(text.bytes().map(usize::from))
    }

    /// Adds a mesh: its points, elements and groups.
    pub(crate) fn mesh<const D: usize, const N: usize>(self, mesh: &Mesh<D, N>) -> Self {
        let cells = mesh.cells().iter().flatten().map(|node| node.index());
        let mut all = self.numbers(mesh.points().as_flattened()).indices(cells);
        for (name, members) in mesh.facet_groups() {
            let nodes = members.iter().flat_map(|facet| mesh.facets()[facet.index()].nodes);
            all = all.text(name).indices(nodes.map(|node| node.index()));
        }
        for (name, members) in mesh.element_groups() {
            all = all.text(name).indices(members.iter().map(|element| element.index()));
        }
        all
    }

    /// As it is stored.
    pub(crate) fn stored(self) -> i64 {
        self.0.cast_signed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_change_of_one_bit_and_each_exchange_is_seen() {
        let values = [1.0_f64, -2.5, 0.0, 3e300];
        let sum = |values: &[f64]| Checksum::new().numbers(values).stored();
        for at in 0..values.len() {
            for bit in 0..64 {
                let mut other = values;
                other[at] = f64::from_bits(values[at].to_bits() ^ (1 << bit));
                assert_ne!(sum(&other), sum(&values), "bit {bit} of {at}");
            }
        }
        assert_ne!(sum(&[-2.5, 1.0, 0.0, 3e300]), sum(&values));
        assert_ne!(sum(&values[..3]), sum(&values));
        assert_ne!(Checksum::new().text("ab").text("c").stored(), Checksum::new().text("a").text("bc").stored());
    }
}
