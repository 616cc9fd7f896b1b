//! The place at which a function that jumps becomes positive.

use std::cmp::Ordering;

/// Bisections: to 1e-12 of the largest place.
const BISECTIONS: usize = 40;

/// Interpolations that narrow a bracket: enough for any smooth function, few where it jumps.
const INTERPOLATIONS: usize = 12;

/// A place and the value there.
type Point = [f64; 2];

/// Bisects between 0 and the largest place: the middle of the last interval between a value below 0 and one from 0 on.
///
/// Most values are not computed. Once both ends have values, interpolation narrows the bracket; bisections outside of
/// it then have the sign of its nearer end. Where the sign changes once, the place is that of all bisections, bit by
/// bit.
pub(super) fn bisected(largest: f64, value: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, largest);
    let mut bracket: [Option<Point>; 2] = [None; 2];
    let mut narrowed = false;
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        let [below, above] = bracket.map(|end| end.map(|[place, _]| place));
        let negative = if below.is_some_and(|place| middle <= place) {
            true
        } else if above.is_some_and(|place| middle >= place) {
            false
        } else {
            let found = value(middle);
            bracket[side(found)] = Some([middle, found]);
            side(found) == 0
        };
        if negative {
            low = middle
        } else {
            high = middle
        }
        if let ([Some(below), Some(above)], false) = (bracket, narrowed) {
            let width = 0.5_f64.powi(BISECTIONS as i32 + 2) * largest;
            bracket = narrow([below, above], width, &value).map(Some);
            narrowed = true;
        }
    }
    0.5 * (low + high)
}

/// 0 of a value below 0, else 1.
fn side(value: f64) -> usize {
    usize::from(value.partial_cmp(&0.0) != Some(Ordering::Less))
}

/// A narrower bracket, if possible of this width: by inverse quadratic interpolation where the function is smooth, by
/// bisection elsewhere (T. R. Chandrupatla, Advances in Engineering Software 28, 145-149, 1997).
fn narrow([below, above]: [Point; 2], width: f64, value: impl Fn(f64) -> f64) -> [Point; 2] {
    let (mut bracket, mut newest, mut part) = ([below, above], 0, 0.5);
    for _ in 0..INTERPOLATIONS {
        let [a, b] = [bracket[newest][0], bracket[1 - newest][0]];
        let distance = (b - a).abs();
        if distance <= width {
            break;
        }
        let least = (0.5 * width / distance).min(0.5);
        let place = a + f64::clamp(part, least, 1.0 - least) * (b - a);
        let found = value(place);
        newest = side(found);
        let replaced = std::mem::replace(&mut bracket[newest], [place, found]);
        part = next_part(bracket[newest], bracket[1 - newest], replaced);
    }
    bracket
}

/// Where the next value is computed, as a part of the way from the newest end `a` to the other end `b`, with the point
/// `c` that it replaced.
fn next_part([a, fa]: Point, [b, fb]: Point, [c, fc]: Point) -> f64 {
    let (place, size) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
    if size * size < place && (1.0 - size) * (1.0 - size) < 1.0 - place {
        fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    } else {
        0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_testkit::Random;
    use std::cell::Cell;

    fn plain(largest: f64, value: impl Fn(f64) -> f64) -> f64 {
        let (mut low, mut high) = (0.0, largest);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if value(middle) < 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Bit by bit the place of all bisections, with 24 of 40 values at most where the function is smooth, and not many
    /// more than 40 where it jumps.
    #[test]
    fn the_place_is_that_of_all_bisections() {
        let mut random = Random::new(5);
        for _ in 0..1000 {
            let (largest, root) = (10_f64.powf(random.between(-3.0, 9.0)), random.between(-0.1, 1.1));
            let (curve, jump) = (random.between(0.0, 5.0), random.between(0.0, 2.0));
            let smooth = |x: f64| {
                let x = x / largest;
                (x - root) + curve * (x * x - root.abs() * root) + 0.1 * (x.sqrt() - root.max(0.0).sqrt())
            };
            let jumps = |x: f64| smooth(x) + if x < root * largest { -jump } else { jump };
            for (value, most) in [(&smooth as &dyn Fn(f64) -> f64, 24), (&jumps, BISECTIONS + INTERPOLATIONS)] {
                let count = Cell::new(0);
                let found = bisected(largest, |x| {
                    count.set(count.get() + 1);
                    value(x)
                });
                assert_eq!(found, plain(largest, value));
                let inside = (0.01..0.99).contains(&root);
                assert!(!inside || count.get() <= most, "{} of {most}", count.get());
            }
        }
    }
}
