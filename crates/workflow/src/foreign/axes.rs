//! Contact forces of a plane body with components in other axes.

use percute_core::border::Vector;

/// How their components may be read; the axis along the plane has either direction.
pub(super) const READINGS: [&str; 5] = [EXCHANGED, NORMAL_FIRST, NORMAL_FIRST, NORMAL_LAST, NORMAL_LAST];
const EXCHANGED: &str = "the components of the contact forces are exchanged: give them in global axes, x before y";
const NORMAL_FIRST: &str =
    "the contact forces are in the axes of the plane, the normal part first: give them in global axes, x before y";
const NORMAL_LAST: &str =
    "the contact forces are in the axes of the plane, the normal part last: give them in global axes, x before y";

/// A force (N) on a plane with this normal, read in each way; of a bar, as it is.
pub(super) fn read(force: &Vector, normal: &Vector, dimension: usize) -> [Vector; 5] {
    if dimension == 1 {
        return [*force; 5];
    }
    let (&[a, b, _], &[x, y, _]) = (force, normal);
    let in_axes = |pressing: f64, along: f64| [pressing * x + along * y, pressing * y - along * x];
    let all = [[b, a], in_axes(a, b), in_axes(a, -b), in_axes(b, a), in_axes(b, -a)];
    all.map(|[x, y]| [x, y, 0.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_reading_finds_the_force_again() {
        let (normal, force) = ([0.6, 0.8, 0.0], [2.0, -7.0]);
        let (pressing, along) = (0.6 * 2.0 - 0.8 * 7.0, 0.8 * 2.0 + 0.6 * 7.0);
        let given = [[-7.0, 2.0], [pressing, along], [pressing, -along], [along, pressing], [-along, pressing]];
        for (reading, given) in given.iter().enumerate() {
            let near = |read: &Vector| (read[0] - force[0]).hypot(read[1] - force[1]) < 1e-12;
            let found: Vec<usize> =
                (0..5).filter(|&k| near(&read(&[given[0], given[1], 0.0], &normal, 2)[k])).collect();
            assert_eq!(found, [reading]);
        }
        assert_eq!(read(&[3.0, 0.0, 0.0], &[1.0, 0.0, 0.0], 1), [[3.0, 0.0, 0.0]; 5]);
    }
}
