//! Rows of a case against what they must be.

use percute::reproduce::Tally;
use percute::reproduce::pack::{CASES, Expected, Outcome};
use percute_core::observer::Unobserved;
use std::ops::RangeInclusive;

/// What a row must be: the start of its name, the range of its order, and its largest difference on the finest mesh.
pub(crate) type Must = (&'static str, RangeInclusive<f64>, f64);

/// Orders of bounded rows: they have none.
pub(crate) const NONE: RangeInclusive<f64> = 0.0..=0.0;

/// Runs the case of this name.
pub(crate) fn outcome(key: &str) -> Outcome {
    let case = CASES.iter().find(|case| case.key == key).unwrap();
    let mut observer = Unobserved;
    case.run(&mut Tally::new("pack", case.runs() as f64, &mut observer)).unwrap()
}

/// Each row of a case is what it must be; its order lies in a range that holds the expected one.
pub(crate) fn check(key: &str, must: &[Must]) {
    let outcome = outcome(key);
    assert_eq!(outcome.rows.len(), must.len(), "{key}: rows without a test, or tests without a row");
    let mut wrong = Vec::new();
    for (row, (name, orders, largest)) in outcome.rows.iter().zip(must) {
        assert!(row.quantity.starts_with(name), "{key}: {} is not {name}", row.quantity);
        let difference = row.difference().abs();
        if let Expected::Order(expected) = row.expected {
            assert!(orders.contains(&expected), "{key}: {name}: {orders:?} without {expected}");
            if !row.observed().is_some_and(|order| orders.contains(&order)) {
                wrong.push(format!("{name}: order {:?} of {:?} around {}", row.observed(), row.computed, row.exact));
            }
        } else if let Expected::Within(bound) = row.expected {
            assert!(*largest <= bound, "{key}: {name}: the page promises less than {largest}");
        }
        if difference.is_nan() || difference > *largest {
            wrong.push(format!("{name}: {} instead of {}, {largest} off at most", row.finest(), row.exact));
        }
    }
    assert!(wrong.is_empty(), "{key}:\n{}", wrong.join("\n"));
    if let Some(curve) = outcome.curve {
        assert_eq!((curve.exact.len(), curve.computed.len()), (curve.time.len(), curve.time.len()), "{key}");
        assert!(curve.exact.iter().chain(&curve.computed).all(|value| value.is_finite()), "{key}");
    }
}
