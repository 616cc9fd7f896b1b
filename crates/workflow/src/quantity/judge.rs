//! How a quantity changes from mesh to mesh.

use serde::Serialize;

/// Changes below this part of a value are rounding, summed over some thousand steps.
const ROUNDING: f64 = 1e-9;
/// Orders are looked for up to this one, without its sign.
const LARGEST_ORDER: f64 = 20.0;
/// Values with a smaller order do not converge in practice: the limit is 14 times the last change away, and more.
const LEAST_ORDER: f64 = 0.1;

/// How the values of a quantity change on the finest meshes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Judgement {
    /// From the finest mesh but one to the finest, relative to the finest; none with one value or at zero.
    pub change: Option<f64>,
    /// p of differences that fall like h^p between the three finest meshes; negative where they grow. None with fewer
    /// meshes, where differences change their sign, and where nothing changes.
    pub order: Option<f64>,
    /// The distance of the finest mesh from the limit with this order, relative to the finest value, with the sign of
    /// the change; none without a limit.
    pub remaining: Option<f64>,
    /// Whether the values converge: differences fall, and do not change their sign, or are rounding. None with fewer
    /// than three meshes, and where differences fall but change their sign.
    pub converges: Option<bool>,
}

/// Judges values of a quantity on meshes of these element sizes, from the coarsest to the finest.
#[must_use]
pub fn judge(values: &[f64], sizes: &[f64]) -> Judgement {
    let [.., middle, fine] = *values else { return Judgement::default() };
    let step = fine - middle;
    let change = Some(step / fine).filter(|change| change.is_finite());
    let (&[.., coarse, _, _], &[.., h1, h2, h3]) = (values, sizes) else {
        return Judgement { change, ..Judgement::default() };
    };
    let before = middle - coarse;
    let settled = step.abs() <= ROUNDING * fine.abs().max(middle.abs());
    if settled || step * before < 0.0 {
        let converges = if settled || step.abs() < before.abs() { settled.then_some(true) } else { Some(false) };
        return Judgement { change, converges, ..Judgement::default() };
    }
    let order = order(before / step, [(h1 / h2).ln(), (h2 / h3).ln()]);
    let converges = order.is_some_and(|p| p > LEAST_ORDER);
    let remaining = order.filter(|_| converges).map(|p| step / fine / (p * (h2 / h3).ln()).exp_m1());
    Judgement { change, order, remaining, converges: Some(converges) }
}

/// p with (h₁^p − h₂^p)/(h₂^p − h₃^p) = `ratio`, from the logarithms of h₁/h₂ and h₂/h₃. The left side grows with p.
fn order(ratio: f64, [first, second]: [f64; 2]) -> Option<f64> {
    let left = |p: f64| if p == 0.0 { first / second } else { (p * first).exp_m1() / -(-p * second).exp_m1() };
    let [mut low, mut high] = [-LARGEST_ORDER, LARGEST_ORDER];
    let inside = ratio.is_finite() && first > 0.0 && second > 0.0 && (left(low)..=left(high)).contains(&ratio);
    // Halved so often, the interval is two neighbouring numbers.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if left(middle) < ratio { low = middle } else { high = middle }
    }
    inside.then_some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Values a + b h^p have this order and this limit, on meshes of any sizes; for p < 0 they have no limit.
        #[test]
        fn power_laws_are_recognised(
            p in prop::sample::select(vec![-1.0, -0.45, -0.1, 0.15, 0.33, 2.0 / 3.0, 1.0, 2.0]),
            a in 0.5..2.0_f64,
            b in prop::sample::select(vec![-0.3, 0.2]),
            sizes in prop::array::uniform2(1.3..3.0_f64),
        ) {
            let h = [sizes[0] * sizes[1], sizes[1], 1.0];
            let values = h.map(|h| a + b * h.powf(p));
            let judgement = judge(&values, &h);
            // Differences of about 1e-2 lose two digits, a weak order two more.
            prop_assert!(judgement.order.is_some_and(|found| (found - p).abs() < 1e-9), "{:?}", judgement);
            prop_assert_eq!(judgement.converges, Some(p > 0.0));
            let limit = judgement.remaining.map(|remaining| values[2] * (1.0 + remaining));
            prop_assert_eq!(limit.is_some(), p > 0.0);
            prop_assert!(limit.is_none_or(|limit| (limit - a).abs() < 1e-8), "{:?}", limit);
        }
    }

    #[test]
    fn other_sequences_have_no_order() {
        let of = |values: &[f64]| {
            let sizes: Vec<f64> = (0..values.len()).map(|k| 0.5_f64.powi(k as i32)).collect();
            let Judgement { change, order, converges, .. } = judge(values, &sizes);
            (change, order, converges)
        };
        assert_eq!(of(&[]), (None, None, None));
        assert_eq!(of(&[2.0]), (None, None, None));
        assert_eq!(of(&[2.0, 4.0]), (Some(0.5), None, None));
        assert_eq!(of(&[0.0, 0.0, 0.0]), (None, None, Some(true)));
        assert_eq!(of(&[3.0, 2.0, 2.0 + 1e-12]).2, Some(true));
        // Alternating: falling ones may converge, growing ones do not.
        assert_eq!(of(&[5.0, 3.0, 4.0]), (Some(0.25), None, None));
        assert_eq!(of(&[4.5, 5.0, 4.0]), (Some(-0.25), None, Some(false)));
        // Equal differences, those of a logarithm.
        let (_, order, converges) = of(&[1.0, 2.0, 3.0]);
        assert!(order.is_some_and(|p| p.abs() < 1e-12) && converges == Some(false), "{order:?}");
        assert_eq!(of(&[1.0, f64::NAN, 3.0]).1, None);
    }
}
