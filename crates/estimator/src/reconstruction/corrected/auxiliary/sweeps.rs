//! Sweeps over pairs of elements, for all motions together.

use super::lanes::{FirstPair, Gradient, Nodal};
use super::pairs::{Laws, Moduli, PairSurroundings, TrianglePair};
use percute_core::simd::Registers;

/// A gradient or a stress, column by column.
pub(super) type Columns<R> = [<R as Registers>::Eight; 2];

/// Subtracts K x from `to` (N).
#[inline(always)]
pub(super) fn subtract_stiffness<R: Registers>(
    r: R,
    laws: &[Moduli],
    pairs: &[TrianglePair],
    x: &[Nodal],
    to: &mut [Nodal],
) {
    let to = &mut to[..x.len()];
    for pair in pairs {
        subtract(r, laws, pair, differences(r, pair, x), to);
    }
}

/// Subtracts the part of K x that is made of plain strains from `to` (N), keeps V∇x of the first pair of motions in
/// `gradients`, and adds it to the patches.
#[inline(always)]
pub(super) fn subtract_plain_part<R: Registers>(
    r: R,
    laws: &Laws,
    (pairs, around): (&[TrianglePair], &[PairSurroundings]),
    x: &[Nodal],
    to: &mut [Nodal],
    (gradients, patches): (&mut [Gradient], &mut [Gradient]),
) {
    let to = &mut to[..x.len()];
    let (own, _) = gradients.as_chunks_mut::<2>();
    for ((pair, around), own) in pairs.iter().zip(around).zip(own) {
        let [a, b, c] = differences(r, pair, x);
        let [g, h, i, k] = pair.gradients;
        let (first, last) = (gradient(r, &[g, h], [a, b]), gradient(r, &[i, k], [b, c]));
        let moduli = &laws.rest[pair.law as usize];
        subtract_stresses(r, pair, [stress(r, moduli, &first), stress(r, moduli, &last)], to);
        let (first, last) = (kept(r, first, around.roots[0]), kept(r, last, around.roots[1]));
        (own[0].0, own[1].0) = (r.store(first), r.store(last));
        let both = r.add(first, last);
        for (patch, sum) in around.patches.iter().zip([both, first, both, last]) {
            let patch = &mut patches[*patch as usize];
            patch.0 = r.store(r.add(r.load(&patch.0), sum));
        }
    }
}

/// V times the gradient of the first pair of motions.
#[inline(always)]
fn kept<R: Registers>(r: R, [along, across]: Columns<R>, root: f64) -> R::Eight {
    r.mul(r.join(r.first(along), r.first(across)), r.splat(root))
}

/// Subtracts the part of K x of the first pair of motions that is made of smoothed strains from `to` (N): means of the
/// gradients of elements, by their places less `start`, and of the patches, times their weights.
#[inline(always)]
pub(super) fn subtract_smoothed_part<R: Registers>(
    r: R,
    laws: &Laws,
    (pairs, around): (&[TrianglePair], &[PairSurroundings]),
    (gradients, start): (&[Gradient], usize),
    (own, patches): (&[Gradient], &[Gradient]),
    to: &mut [Nodal],
) {
    let (own, _) = own.as_chunks::<2>();
    for ((pair, around), own) in pairs.iter().zip(around).zip(own) {
        let [p, q, s, t] = around.patches.map(
            #[inline(always)]
            |patch| r.load(&patches[patch as usize].0),
        );
        let shared = r.add(p, s);
        let moduli = &laws.smoothed[pair.law as usize];
        let first = smoothed(r, around, 0, (r.load(&own[0].0), r.add(shared, q)), (gradients, start));
        let last = smoothed(r, around, 1, (r.load(&own[1].0), r.add(shared, t)), (gradients, start));
        let (first, last) = (stress_of_first(r, moduli, first), stress_of_first(r, moduli, last));
        subtract_first_stresses(r, pair, [first, last], to);
    }
}

/// √V times the smoothed gradient in A or B, from its own and the sum of those of its nodes. A function: closures that
/// are not inlined would pass each register through memory.
#[inline(always)]
fn smoothed<R: Registers>(
    r: R,
    around: &PairSurroundings,
    which: usize,
    (own, nodes): (R::Eight, R::Eight),
    (gradients, start): (&[Gradient], usize),
) -> R::Eight {
    let ([a, b, c], beyond) = (around.weights[which], around.beyond[which]);
    let mut sum = r.add(nodes, r.mul(own, r.splat(a + b + c)));
    for (weight, place) in [a, b, c].into_iter().zip(beyond) {
        sum = r.add(sum, r.mul(r.load(&gradients[place as usize - start].0), r.splat(weight)));
    }
    r.mul(sum, r.splat(around.roots[which]))
}

/// Subtracts K x from `to` (N), and adds (M − M_c) x of the first pair of motions to `lumping`.
#[inline(always)]
pub(super) fn subtract_both<R: Registers>(
    r: R,
    laws: &[Moduli],
    pairs: &[TrianglePair],
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
pub(super) fn add_lumping<R: Registers>(r: R, pairs: &[TrianglePair], x: &[FirstPair], to: &mut [FirstPair]) {
    let to = &mut to[..x.len()];
    for pair in pairs {
        let [n0, n1, n2, n3] = places(pair);
        let base = r.load4(&x[n0].0);
        let values = [r.load4(&x[n1].0), r.load4(&x[n2].0), r.load4(&x[n3].0)];
        lump(r, pair, [r.sub4(values[0], base), r.sub4(values[1], base), r.sub4(values[2], base)], to);
    }
}

#[inline(always)]
pub(super) fn places(pair: &TrianglePair) -> [usize; 4] {
    let [a, b, c, d] = pair.nodes;
    [a as usize, b as usize, c as usize, d as usize]
}

/// Differences of the values at the nodes 1, 2, 3 with that at node 0: a translation leaves no rounding.
#[inline(always)]
pub(super) fn differences<R: Registers>(r: R, pair: &TrianglePair, x: &[Nodal]) -> [R::Eight; 3] {
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
        r.add(r.mul(*along, r.load(&own[0])), r.mul(r.swap_pairs(*across), r.load(&partner[0]))),
        r.add(r.mul(*across, r.load(&own[1])), r.mul(r.swap_pairs(*along), r.load(&partner[1]))),
    ]
}

/// The same of the first pair of motions, at derivatives along x, then along y.
#[inline(always)]
fn stress_of_first<R: Registers>(r: R, moduli: &Moduli, gradient: R::Eight) -> [R::Four; 2] {
    let other = r.swap_pairs(gradient);
    [
        column_of_first(r, moduli, 0, [r.first(gradient), r.last(other)]),
        column_of_first(r, moduli, 1, [r.last(gradient), r.first(other)]),
    ]
}

/// A column of it, at the derivatives along its axis and the other one, with their components exchanged.
#[inline(always)]
fn column_of_first<R: Registers>(r: R, moduli: &Moduli, k: usize, [own, other]: [R::Four; 2]) -> R::Four {
    let (direct, cross) = (r.first(r.load(&moduli.own[k])), r.first(r.load(&moduli.partner[k])));
    r.add4(r.mul4(own, direct), r.mul4(other, cross))
}

/// Forces of a stress of A or B at two nodes (N): its product with the gradients there.
#[inline(always)]
fn forces<R: Registers>(r: R, [first, last]: [[f64; 2]; 2], [along, across]: Columns<R>) -> [R::Eight; 2] {
    [
        r.add(r.mul(along, r.splat(first[0])), r.mul(across, r.splat(first[1]))),
        r.add(r.mul(along, r.splat(last[0])), r.mul(across, r.splat(last[1]))),
    ]
}

#[inline(always)]
fn subtract<R: Registers>(r: R, laws: &[Moduli], pair: &TrianglePair, [a, b, c]: [R::Eight; 3], to: &mut [Nodal]) {
    let (moduli, [g, h, i, k]) = (&laws[pair.law as usize], pair.gradients);
    let (first, last) = (gradient(r, &[g, h], [a, b]), gradient(r, &[i, k], [b, c]));
    subtract_stresses(r, pair, [stress(r, moduli, &first), stress(r, moduli, &last)], to);
}

/// Subtracts the forces of stresses of A and B.
#[inline(always)]
fn subtract_stresses<R: Registers>(r: R, pair: &TrianglePair, [a, b]: [Columns<R>; 2], to: &mut [Nodal]) {
    let [g, h, i, k] = pair.gradients;
    let [first, mine] = forces(r, [g, h], a);
    let [other, last] = forces(r, [i, k], b);
    let shared = r.add(mine, other);
    let sum = r.add(r.add(first, last), shared);
    let [n0, n1, n2, n3] = places(pair);
    // Nodes may be the same: each is stored before the next is read.
    to[n0].0 = r.store(r.add(r.load(&to[n0].0), sum));
    to[n1].0 = r.store(r.sub(r.load(&to[n1].0), first));
    to[n2].0 = r.store(r.sub(r.load(&to[n2].0), shared));
    to[n3].0 = r.store(r.sub(r.load(&to[n3].0), last));
}

/// The same for the first pair of motions.
#[inline(always)]
fn subtract_first_stresses<R: Registers>(r: R, pair: &TrianglePair, stresses: [[R::Four; 2]; 2], to: &mut [Nodal]) {
    let [g, h, i, k] = pair.gradients;
    let [a, b] = stresses;
    let (first, shared) = (force_of_first(r, a, g), r.add4(force_of_first(r, a, h), force_of_first(r, b, i)));
    let last = force_of_first(r, b, k);
    let sum = r.add4(r.add4(first, last), shared);
    let [n0, n1, n2, n3] = places(pair);
    let nothing = r.splat4(0.0);
    add_to_first(r, &mut to[n0], sum);
    add_to_first(r, &mut to[n1], r.sub4(nothing, first));
    add_to_first(r, &mut to[n2], r.sub4(nothing, shared));
    add_to_first(r, &mut to[n3], r.sub4(nothing, last));
}

/// The force of a stress at a node (N), of the first pair of motions.
#[inline(always)]
fn force_of_first<R: Registers>(r: R, [along, across]: [R::Four; 2], gradient: [f64; 2]) -> R::Four {
    r.add4(r.mul4(along, r.splat4(gradient[0])), r.mul4(across, r.splat4(gradient[1])))
}

/// Adds to the first pair of motions.
#[inline(always)]
fn add_to_first<R: Registers>(r: R, to: &mut Nodal, change: R::Four) {
    let whole = r.load(&to.0);
    to.0 = r.store(r.with_first(whole, r.add4(r.first(whole), change)));
}

/// Adds the nodal forces of the skew part of the stress that lumping the mass is for a motion w of elements of a plane
/// body: τ = ρ/4 Σ w_i ⊗ d_i, d_i from the centroid, gives |E|(τ − τᵀ)/2 ∇φ_i. Both d_i and ∇φ_i are edges turned.
#[inline(always)]
pub(super) fn add_skew<const D: usize>(laws: &Laws, pairs: &[TrianglePair], w: &[[f64; D]], to: &mut [[f64; D]]) {
    let to = &mut to[..w.len()];
    let y = D - 1;
    for pair in pairs {
        let nodes = places(pair);
        let base = w[nodes[0]];
        let from = |k: usize| [w[nodes[k]][0] - base[0], w[nodes[k]][y] - base[y]];
        let [g, h, i, k] = pair.gradients;
        let third = laws.thirds[pair.law as usize];
        let turning = |[p, q]: [[f64; 2]; 2], [u, v]: [[f64; 2]; 2], share: f64| {
            let along = u[0] * (p[0] + 2.0 * q[0]) + u[1] * (p[1] + 2.0 * q[1]);
            (along - (v[0] * (2.0 * p[0] + q[0]) + v[1] * (2.0 * p[1] + q[1]))) * (share * third)
        };
        let (a, b, c) = (from(1), from(2), from(3));
        let (first, last) = (turning([g, h], [a, b], pair.shares[0]), turning([i, k], [b, c], pair.shares[1]));
        let mut add = |node: usize, x: f64, z: f64| {
            to[node][0] -= z;
            to[node][y] += x;
        };
        let (one, mine, other, end) = (
            [g[0] * first, g[1] * first],
            [h[0] * first, h[1] * first],
            [i[0] * last, i[1] * last],
            [k[0] * last, k[1] * last],
        );
        let sum = |c: usize| one[c] + mine[c] + other[c] + end[c];
        add(nodes[0], -sum(0), -sum(1));
        add(nodes[1], one[0], one[1]);
        add(nodes[2], mine[0] + other[0], mine[1] + other[1]);
        add(nodes[3], end[0], end[1]);
    }
}

/// A triangle gives m/(D+2) times the distance to the mean of its nodes, here less the value at node 0.
#[inline(always)]
fn lump<R: Registers>(r: R, pair: &TrianglePair, [a, b, c]: [R::Four; 3], to: &mut [FirstPair]) {
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
