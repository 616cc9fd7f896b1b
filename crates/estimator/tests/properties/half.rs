//! Half of a symmetric model.

use crate::bodies::steps;
use crate::estimating::{assert_admissible, estimate, history};
use percute_estimator::{Options, Sampling};
use percute_testkit::Roof;

/// A corner of half a model is at the end of its surface, at the middle of the whole model. The stars there are halves
/// of those of the whole, and their tractions of least energy are others: in these cases they change the estimate by up
/// to 6 %, at 10° and 200 m/s by up to 17 %, and at 5° and 100 m/s by up to 38 %. With surfaces that moved by their
/// means, the corner was beyond the end, and slow corners had an estimate 7 to 14 times as large.
#[test]
fn half_of_a_symmetric_model_has_half_of_the_estimate() {
    let slow = [(0.0, 20.0), (3.0, 20.0), (10.0, 0.5), (10.0, 20.0), (28.0, 2.0), (28.0, 200.0)];
    let cases = slow.map(|case| (case, [5, 7], 0.07));
    let fast = [((10.0, 200.0), [5, 7], 0.2), ((5.0, 100.0), [10, 10], 0.4)];
    for ((angle, speed), cells, most) in cases.into_iter().chain(fast) {
        let roof = Roof::new(angle, speed, 0.03, cells).unwrap();
        let [whole, half] = [roof.whole(), roof.half()].map(|builder| builder.unwrap().build().unwrap());
        let times = steps(&whole, 0.9, 40);
        let options = Options { every: Sampling::Every(1), threads: Some(1), ..Options::default() };
        let [whole, half] = [&whole, &half].map(|problem| estimate(problem, &history(problem, &times), options));
        assert_admissible("half", &half);
        for (whole, half) in [(whole.error.sup, half.error.sup), (whole.error.mean, half.error.mean)] {
            let ratio = half * 2.0_f64.sqrt() / whole;
            assert!((ratio - 1.0).abs() < most, "{angle}° at {speed} m/s: {ratio}");
        }
    }
}
