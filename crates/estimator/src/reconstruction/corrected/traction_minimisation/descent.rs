//! Preconditioned conjugate gradients over the modes.

use super::basis::{Basis, FacetMoments, Modes, apply};
use super::energy::{Form, MOMENTS};
use super::{LANES, Lanes};

/// The change of the moments that a number of steps bring, given the slope of the energy of each element in its
/// moments.
pub(super) fn descend<const D: usize>(
    basis: &Basis<D>,
    forms: &[Form],
    slope: impl Fn(usize) -> [Lanes; MOMENTS],
    steps: usize,
) -> Vec<FacetMoments<D>> {
    let mut change = basis.no_moments();
    let mut facets = basis.no_moments();
    (0..forms.len()).for_each(|e| basis.add_to_facets(e, &slope(e), &mut facets));
    let mut residual = basis.no_modes();
    basis.gather(&facets, &mut residual);
    each(&mut residual, |x| *x = x.map(|x| -x));
    let mut scaled = basis.no_modes();
    basis.scale(&residual, &mut scaled);
    let mut direction = scaled.clone();
    let mut product = basis.no_modes();
    let mut moments = basis.no_moments();
    let mut height = dot(&residual, &scaled);
    for _ in 0..steps {
        basis.spread(&direction, &mut moments);
        facets.fill([[[0.0; LANES]; D]; D]);
        for (e, form) in forms.iter().enumerate() {
            basis.add_to_facets(e, &apply(form, &basis.of_element(e, &moments)), &mut facets);
        }
        basis.gather(&facets, &mut product);
        let length = quotients(&height, &dot(&direction, &product));
        for (change, moment) in change.iter_mut().flatten().flatten().zip(moments.iter().flatten().flatten()) {
            (0..LANES).for_each(|lane| change[lane] += length[lane] * moment[lane]);
        }
        pairs(&mut residual, &product, |r, p| (0..LANES).for_each(|lane| r[lane] -= length[lane] * p[lane]));
        basis.scale(&residual, &mut scaled);
        let next = dot(&residual, &scaled);
        let share = quotients(&next, &height);
        pairs(&mut direction, &scaled, |d, z| (0..LANES).for_each(|lane| d[lane] = share[lane] * d[lane] + z[lane]));
        height = next;
    }
    change
}

/// a/b; 0 where nothing can be gained any more, or where numbers are beyond their range, which shows in the measure.
fn quotients(a: &Lanes, b: &Lanes) -> Lanes {
    std::array::from_fn(|lane| if a[lane] > 0.0 && b[lane] > 0.0 { a[lane] / b[lane] } else { 0.0 })
}

fn dot(a: &Modes, b: &Modes) -> Lanes {
    let mut sum = [0.0; LANES];
    let mut add = |x: &Lanes, y: &Lanes| (0..LANES).for_each(|lane| sum[lane] += x[lane] * y[lane]);
    a.edges.iter().zip(&b.edges).for_each(|(x, y)| add(x, y));
    a.nodes.iter().flatten().zip(b.nodes.iter().flatten()).for_each(|(x, y)| add(x, y));
    sum
}

fn each(modes: &mut Modes, change: impl Fn(&mut Lanes)) {
    modes.edges.iter_mut().chain(modes.nodes.iter_mut().flatten()).for_each(change);
}

fn pairs(a: &mut Modes, b: &Modes, change: impl Fn(&mut Lanes, &Lanes)) {
    let all = a.edges.iter_mut().chain(a.nodes.iter_mut().flatten());
    all.zip(b.edges.iter().chain(b.nodes.iter().flatten())).for_each(|(x, y)| change(x, y));
}
