//! Sweeps over pairs of elements, for all motions together.

use super::lanes::{FirstPair, Nodal};
use super::pairs::{Moduli, Pair};
use crate::simd::Registers;

/// A gradient or a stress, column by column.
pub(super) type Columns<R> = [<R as Registers>::Eight; 2];

/// Subtracts K x from `to` (N).
#[inline(always)]
pub(super) fn subtract_stiffness<R: Registers>(r: R, laws: &[Moduli], pairs: &[Pair], x: &[Nodal], to: &mut [Nodal]) {
    let to = &mut to[..x.len()];
    for pair in pairs {
        subtract(r, laws, pair, differences(r, pair, x), to);
    }
}

/// Subtracts K x from `to` (N), and adds (M − M_c) x of the first pair of motions to `lumping`.
#[inline(always)]
pub(super) fn subtract_both<R: Registers>(
    r: R,
    laws: &[Moduli],
    pairs: &[Pair],
    x: &[Nodal],
    to: &mut [Nodal],
    lumping: &mut [FirstPair],
) {
    let (to, lumping) = (&mut to[..x.len()], &mut lumping[..x.len()]);
    for pair in pairs {
        let values = differences(r, pair, x);
        subtract(r, laws, pair, values, to);
        let [a, b, c] = values;
        lump(r, pair, [r.first(a), r.first(b), r.first(c)], lumping);
    }
}

/// Adds (M − M_c) x to `to`.
#[inline(always)]
pub(super) fn add_lumping<R: Registers>(r: R, pairs: &[Pair], x: &[FirstPair], to: &mut [FirstPair]) {
    let to = &mut to[..x.len()];
    for pair in pairs {
        let [n0, n1, n2, n3] = places(pair);
        let base = r.load4(&x[n0].0);
        let values = [r.load4(&x[n1].0), r.load4(&x[n2].0), r.load4(&x[n3].0)];
        lump(r, pair, [r.sub4(values[0], base), r.sub4(values[1], base), r.sub4(values[2], base)], to);
    }
}

#[inline(always)]
pub(super) fn places(pair: &Pair) -> [usize; 4] {
    let [a, b, c, d] = pair.nodes;
    [a as usize, b as usize, c as usize, d as usize]
}

/// Differences of the values at the nodes 1, 2, 3 with that at node 0: a translation leaves no rounding.
#[inline(always)]
pub(super) fn differences<R: Registers>(r: R, pair: &Pair, x: &[Nodal]) -> [R::Eight; 3] {
    let [n0, n1, n2, n3] = places(pair);
    let base = r.load(&x[n0].0);
    [r.sub(r.load(&x[n1].0), base), r.sub(r.load(&x[n2].0), base), r.sub(r.load(&x[n3].0), base)]
}

/// √V times the gradient in A or B, from the differences at two nodes.
#[inline(always)]
pub(super) fn gradient<R: Registers>(r: R, [first, last]: &[[f64; 2]; 2], [x, y]: [R::Eight; 2]) -> Columns<R> {
    [
        r.add(r.mul(x, r.splat(first[0])), r.mul(y, r.splat(last[0]))),
        r.add(r.mul(x, r.splat(first[1])), r.mul(y, r.splat(last[1]))),
    ]
}

/// The stress at a gradient.
#[inline(always)]
pub(super) fn stress<R: Registers>(r: R, moduli: &Moduli, [along, across]: &Columns<R>) -> Columns<R> {
    let (own, partner) = (&moduli.own, &moduli.partner);
    [
        r.add(r.mul(*along, r.load(&own[0])), r.mul(r.swap(*across), r.load(&partner[0]))),
        r.add(r.mul(*across, r.load(&own[1])), r.mul(r.swap(*along), r.load(&partner[1]))),
    ]
}

/// Forces K x of A or B at two nodes (N), from the differences there.
#[inline(always)]
fn forces<R: Registers>(r: R, moduli: &Moduli, gradients: &[[f64; 2]; 2], values: [R::Eight; 2]) -> [R::Eight; 2] {
    // The same as a product with the gradient at one node, of a stress.
    let [along, across] = stress(r, moduli, &gradient(r, gradients, values));
    let [first, last] = gradients;
    [
        r.add(r.mul(along, r.splat(first[0])), r.mul(across, r.splat(first[1]))),
        r.add(r.mul(along, r.splat(last[0])), r.mul(across, r.splat(last[1]))),
    ]
}

#[inline(always)]
fn subtract<R: Registers>(r: R, laws: &[Moduli], pair: &Pair, [a, b, c]: [R::Eight; 3], to: &mut [Nodal]) {
    let moduli = &laws[pair.law as usize];
    let [[g, h], [i, k]] = [[pair.gradients[0], pair.gradients[1]], [pair.gradients[2], pair.gradients[3]]];
    let [first, mine] = forces(r, moduli, &[g, h], [a, b]);
    let [other, last] = forces(r, moduli, &[i, k], [b, c]);
    let shared = r.add(mine, other);
    let sum = r.add(r.add(first, last), shared);
    let [n0, n1, n2, n3] = places(pair);
    // Nodes may be the same: each is stored before the next is read.
    to[n0].0 = r.store(r.add(r.load(&to[n0].0), sum));
    to[n1].0 = r.store(r.sub(r.load(&to[n1].0), first));
    to[n2].0 = r.store(r.sub(r.load(&to[n2].0), shared));
    to[n3].0 = r.store(r.sub(r.load(&to[n3].0), last));
}

/// A triangle gives m/(D+2) times the distance to the mean of its nodes, here less the value at node 0.
#[inline(always)]
fn lump<R: Registers>(r: R, pair: &Pair, [a, b, c]: [R::Four; 3], to: &mut [FirstPair]) {
    let [share, other] = pair.shares;
    let mean = r.mul4(r.add4(a, b), r.splat4(share * (1.0 / 3.0)));
    let other_mean = r.mul4(r.add4(b, c), r.splat4(other * (1.0 / 3.0)));
    let both = r.add4(mean, other_mean);
    let first = r.sub4(r.mul4(a, r.splat4(share)), mean);
    let shared = r.sub4(r.mul4(b, r.splat4(share + other)), both);
    let last = r.sub4(r.mul4(c, r.splat4(other)), other_mean);
    let [n0, n1, n2, n3] = places(pair);
    to[n0].0 = r.store4(r.sub4(r.load4(&to[n0].0), both));
    to[n1].0 = r.store4(r.add4(r.load4(&to[n1].0), first));
    to[n2].0 = r.store4(r.add4(r.load4(&to[n2].0), shared));
    to[n3].0 = r.store4(r.add4(r.load4(&to[n3].0), last));
}
