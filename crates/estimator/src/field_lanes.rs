//! Nodal fields at several time levels side by side, gathered for the nodes of a block.

use percute_core::simd::Registers;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{LANES, Lanes, Value, load};

/// Takes the values of a nodal field at these nodes into their records, at each level that has the field; at the
/// others, any values.
#[inline(always)]
pub(crate) fn gather<'f, R: Registers, P, const D: usize>(
    like: Wide<R>,
    records: &mut [P],
    nodes: &[u32],
    levels: impl Iterator<Item = Option<&'f [[f64; D]]>> + Clone,
    place: impl Fn(&mut P) -> &mut [Lanes; D],
) {
    let Some(some) = levels.clone().flatten().next() else { return };
    let mut fields = [some; LANES];
    for (to, level) in fields.iter_mut().zip(levels) {
        // All of one length: the first check is then that of all.
        *to = &level.unwrap_or(some)[..some.len()];
    }
    let [a, b, c, d, e, f, g, h] = fields;
    for (to, &node) in records.iter_mut().zip(nodes) {
        let n = node as usize;
        let (a, b, c, d) = (&a[n], &b[n], &c[n], &d[n]);
        let (e, f, g, h) = (&e[n], &f[n], &g[n], &h[n]);
        let to = place(to);
        if D == 2 {
            let vectors = [pair(a), pair(b), pair(c), pair(d), pair(e), pair(f), pair(g), pair(h)];
            let [first, second] = like.transpose(vectors.each_ref());
            (to[0], to[1]) = (first.store(), second.store());
        } else {
            for k in 0..D {
                to[k] = Lanes([a[k], b[k], c[k], d[k], e[k], f[k], g[k], h[k]]);
            }
        }
    }
}

/// The first and the last component of a vector, which has two.
#[inline(always)]
fn pair<const D: usize>(vector: &[f64; D]) -> [f64; 2] {
    [vector[0], vector[D - 1]]
}

/// A nodal field at some nodes, at some levels side by side.
#[derive(Clone, Debug, Default)]
pub(crate) struct FieldLanes<const D: usize>(Vec<[Lanes; D]>);

impl<const D: usize> FieldLanes<D> {
    /// Takes the values at these nodes, at each level that has the field; at the others, any values.
    #[inline(always)]
    pub(crate) fn gather<'f, R: Registers>(
        &mut self,
        like: Wide<R>,
        nodes: &[u32],
        levels: impl Iterator<Item = Option<&'f [[f64; D]]>> + Clone,
    ) {
        self.0.resize(nodes.len(), [Lanes::ZERO; D]);
        gather(
            like,
            &mut self.0,
            nodes,
            levels,
            #[inline(always)]
            |values| values,
        );
    }

    /// The values by places.
    #[inline(always)]
    pub(crate) fn values(&self) -> &[[Lanes; D]] {
        &self.0
    }

    /// The values at the nodes of an element, which have these places, in the form of a number.
    #[inline(always)]
    pub(crate) fn of<T: Value<Stored = Lanes>, const N: usize>(&self, like: T, local: &[u32; N]) -> [[T; D]; N] {
        let mut values = [[like; D]; N];
        for i in 0..N {
            values[i] = load(like, &self.0[local[i] as usize]);
        }
        values
    }
}
