//! Checksums of stored numbers and texts.

use percute_core::mesh::Mesh;

/// A checksum of what was added to it. Each step maps its 64 bits one to one, so that a change of one number always
/// changes it. A step spreads the change of any bit over many, so that the change of another number undoes it by chance
/// only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Checksum(u64);

impl Checksum {
    pub(crate) fn new() -> Self {
        Self(0x243f_6a88_85a3_08d3)
    }

    fn word(&mut self, word: u64) {
        // A product carries a change to higher bits only; the shift brings it to the lower ones before.
        let mixed = self.0 ^ word;
        self.0 = (mixed ^ (mixed >> 32)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
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
    pub(crate) fn mesh(self, mesh: &Mesh) -> Self {
        let cells = mesh.cells().flatten().map(|node| node.index());
        let mut all = self.numbers(mesh.points()).indices(cells);
        for (name, members) in mesh.face_groups() {
            let nodes = members.iter().flat_map(|&face| mesh.face(face).nodes);
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

    /// As the sign of a number and a bit of the next once cancelled each other.
    #[test]
    fn changes_of_two_bits_are_seen() {
        let sum = |values: &[f64]| Checksum::new().numbers(values).stored();
        for values in [[1.0_f64, -2.5, 0.0], [3e300, 7e-12, -1.0]] {
            let whole = sum(&values);
            for pair in 0..64 * 64 {
                let (first, second) = (1_u64 << (pair / 64), 1_u64 << (pair % 64));
                let changed = [values[0].to_bits() ^ first, values[1].to_bits() ^ second].map(f64::from_bits);
                assert_ne!(sum(&[changed[0], changed[1], values[2]]), whole, "bits {} and {}", pair / 64, pair % 64);
            }
        }
    }

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
