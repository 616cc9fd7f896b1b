//! Contact forces of a plane body with components in other axes.

/// How their components may be read; the axis along the plane has either direction.
pub(super) const READINGS: [&str; 5] = [EXCHANGED, NORMAL_FIRST, NORMAL_FIRST, NORMAL_LAST, NORMAL_LAST];
const EXCHANGED: &str = "the components of the contact forces are exchanged: give them in global axes, x before y";
const NORMAL_FIRST: &str =
    "the contact forces are in the axes of the plane, the normal part first: give them in global axes, x before y";
const NORMAL_LAST: &str =
    "the contact forces are in the axes of the plane, the normal part last: give them in global axes, x before y";

/// A force (N) on a plane with this normal, read in each way; of a bar, as it is.
pub(super) fn read<const D: usize>(force: &[f64; D], normal: &[f64; D]) -> [[f64; D]; 5] {
    let (&[a, b], &[x, y]) = (force.as_slice(), normal.as_slice()) else { return [*force; 5] };
    let in_axes = |pressing: f64, along: f64| [pressing * x + along * y, pressing * y - along * x];
    let all = [[b, a], in_axes(a, b), in_axes(a, -b), in_axes(b, a), in_axes(b, -a)];
    all.map(|read| std::array::from_fn(|c| read[c]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_reading_finds_the_force_again() {
        let (normal, force) = ([0.6, 0.8], [2.0, -7.0]);
        let (pressing, along) = (0.6 * 2.0 - 0.8 * 7.0, 0.8 * 2.0 + 0.6 * 7.0);
        let given = [[-7.0, 2.0], [pressing, along], [pressing, -along], [along, pressing], [-along, pressing]];
        for (reading, given) in given.iter().enumerate() {
            let near = |read: &[f64; 2]| (read[0] - force[0]).hypot(read[1] - force[1]) < 1e-12;
            let found: Vec<usize> = (0..5).filter(|&k| near(&read(given, &normal)[k])).collect();
            assert_eq!(found, [reading]);
        }
        assert_eq!(read(&[3.0], &[1.0]), [[3.0]; 5]);
    }
}
