//! The part of space that a picture shows.

/// A rectangle of the plane, and the pixels that show it, at the same scale along both axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    /// Lower left corner (m).
    pub(super) low: [f64; 2],
    /// Upper right corner (m).
    pub(super) high: [f64; 2],
    /// Width and height (pixels).
    pub(super) pixels: [i32; 2],
}

/// Largest and smallest plot (pixels); slim bodies get more room around them, not another scale.
const LARGEST: [f64; 2] = [760.0, 600.0];
const SMALLEST: [f64; 2] = [380.0, 160.0];
/// Room around the body, as a part of its larger side.
const ROOM: f64 = 0.06;

impl Frame {
    /// The frame around a body between two corners.
    pub(super) fn around(low: [f64; 2], high: [f64; 2]) -> Self {
        let room = ROOM * (high[0] - low[0]).max(high[1] - low[1]);
        let (mut low, mut high) = (low.map(|x| x - room), high.map(|x| x + room));
        let scale = (LARGEST[0] / (high[0] - low[0])).min(LARGEST[1] / (high[1] - low[1]));
        let mut pixels = [0; 2];
        for c in 0..2 {
            let size = (scale * (high[c] - low[c])).max(SMALLEST[c]);
            let missing = size / scale - (high[c] - low[c]);
            low[c] -= 0.5 * missing;
            high[c] += 0.5 * missing;
            pixels[c] = size.round() as i32;
        }
        Self { low, high, pixels }
    }

    /// Pixels per metre.
    pub(super) fn scale(&self) -> f64 {
        f64::from(self.pixels[0]) / (self.high[0] - self.low[0])
    }

    /// The part of the line through `point` along `direction` inside the frame, as the range of
    /// its parameter.
    pub(super) fn clip(&self, point: [f64; 2], direction: [f64; 2]) -> Option<(f64, f64)> {
        let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
        for c in 0..2 {
            let (a, b) = (self.low[c] - point[c], self.high[c] - point[c]);
            if direction[c] == 0.0 {
                if a > 0.0 || b < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (a / direction[c], b / direction[c]);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
        (from < to).then_some((from, to))
    }

    /// The part of the line between two points inside the frame.
    pub(super) fn within(&self, from: [f64; 2], to: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let direction = [0, 1].map(|c| to[c] - from[c]);
        let (start, end) = self.clip(from, direction)?;
        let (start, end) = (start.max(0.0), end.min(1.0));
        (start < end).then(|| [start, end].map(|s| [0, 1].map(|c| from[c] + s * direction[c])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_equal_even_for_slim_bodies() {
        for high in [[0.05, 0.04], [1.0, 0.01], [0.01, 1.0], [3e-6, 2e-6]] {
            let frame = Frame::around([0.0, 0.0], high);
            let other = f64::from(frame.pixels[1]) / (frame.high[1] - frame.low[1]);
            assert!((frame.scale() / other - 1.0).abs() < 0.01, "{frame:?}");
            assert!(frame.pixels[0] <= 761 && frame.pixels[1] <= 601);
            assert!((0..2).all(|c| frame.low[c] < 0.0 && high[c] < frame.high[c]));
        }
    }

    #[test]
    fn lines_are_cut_at_the_frame() {
        let frame = Frame { low: [0.0, 0.0], high: [2.0, 1.0], pixels: [200, 100] };
        assert_eq!(frame.clip([0.0, 0.5], [1.0, 0.0]), Some((0.0, 2.0)));
        assert_eq!(frame.clip([0.0, 1.5], [1.0, 0.0]), None);
        assert_eq!(frame.clip([0.0, 0.0], [1.0, 1.0]), Some((0.0, 1.0)));
        assert_eq!(frame.clip([3.0, 0.0], [1.0, 1.0]), None);
        assert_eq!(frame.within([1.0, 0.5], [1.5, 0.75]), Some([[1.0, 0.5], [1.5, 0.75]]));
        assert_eq!(frame.within([-1.0, 0.5], [1.0, 0.5]), Some([[0.0, 0.5], [1.0, 0.5]]));
        assert_eq!(frame.within([2.5, 0.5], [3.0, 0.5]), None);
    }
}
