//! Sizes of sets of points.

/// Largest distance between two corners.
pub(super) fn diameter<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> f64 {
    let mut largest: f64 = 0.0;
    for (i, a) in points.iter().enumerate() {
        for b in &points[..i] {
            let square: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
            largest = largest.max(square.sqrt());
        }
    }
    largest
}

/// Diagonal of the box that encloses the points.
pub(super) fn bounding_box_diagonal<const D: usize>(points: &[[f64; D]]) -> f64 {
    let extent = |c: usize| {
        let (low, high) =
            points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[c]), high.max(p[c])));
        (high - low) * (high - low)
    };
    (0..D).map(extent).sum::<f64>().sqrt()
}
