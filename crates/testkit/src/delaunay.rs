//! Delaunay triangulations of a rectangle and a disc.

use crate::{Random, TestkitError, smallest_angle};
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use spade::{DelaunayTriangulation, Point2, Triangulation};
use std::f64::consts::{PI, TAU};

/// Smallest angle of a mesh from this module (degrees).
const SMALLEST_ANGLE: f64 = 10.0;
/// Seeds tried after the one that was given.
const MOST_SEEDS: u64 = 20;

/// A rectangle [0, width] × [0, height] (m) in unstructured triangles, about `n` along its width.
///
/// Points lie at random near those of a grid, also on the sides; the corners are exact. The sides are the groups
/// `left`, `right`, `bottom`, `top`. No angle is below 10°: seeds after the given one are tried until this holds.
///
/// # Errors
/// Sides that are not positive, no elements, or no suitable seed.
pub fn random_rectangle(width: f64, height: f64, n: usize, seed: u64) -> Result<Mesh, TestkitError> {
    if !(width > 0.0 && height > 0.0 && n > 0) {
        return Err(TestkitError::Argument("width, height and n must be positive"));
    }
    let rows = ((n as f64 * height / width).round() as usize).max(1);
    let mut best = 0.0;
    for seed in seed..=seed.saturating_add(MOST_SEEDS) {
        let mesh = triangulated(jittered_grid(width, height, n, rows, seed), |a, b| {
            let on = |c: usize, value: f64| a[c] == value && b[c] == value;
            let sides = [("left", on(0, 0.0)), ("right", on(0, width)), ("bottom", on(1, 0.0)), ("top", on(1, height))];
            sides.into_iter().find(|side| side.1).map(|side| side.0)
        })?;
        best = smallest_angle(&mesh).max(best);
        if best >= SMALLEST_ANGLE {
            return Ok(mesh);
        }
    }
    Err(TestkitError::SmallAngles(best))
}

/// Points of a grid, each moved by up to a quarter of the spacing, along the side if it is on one.
fn jittered_grid(width: f64, height: f64, n: usize, rows: usize, seed: u64) -> Vec<[f64; 2]> {
    let mut random = Random::new(seed);
    let mut place = |i: usize, count: usize, length: f64| {
        let jitter = random.between(-0.25, 0.25);
        match i {
            0 => 0.0,
            _ if i == count => length,
            _ => length * (i as f64 + jitter) / count as f64,
        }
    };
    let mut points = Vec::with_capacity((n + 1) * (rows + 1));
    for j in 0..=rows {
        for i in 0..=n {
            points.push([place(i, n, width), place(j, rows, height)]);
        }
    }
    points
}

/// A disc about the origin (m) in unstructured triangles of about `target_size` (m); its
/// boundary, a polygon of points on the circle, is the group `rim`.
///
/// # Errors
/// Lengths that are not positive, or a size above the radius.
pub fn disc(radius: f64, target_size: f64) -> Result<Mesh, TestkitError> {
    if !(target_size > 0.0 && radius >= target_size) {
        return Err(TestkitError::Argument("target_size must be positive, and at most the radius"));
    }
    let rings = (radius / target_size).round() as usize;
    let mut points = vec![[0.0, 0.0]];
    let mut rim = 0;
    for ring in 1..=rings {
        let r = radius * ring as f64 / rings as f64;
        rim = (TAU * r / target_size).round() as usize;
        // Each ring turned against the one inside it by the golden section: no spokes.
        let turn = ring as f64 * PI * (5.0_f64.sqrt() - 1.0);
        for k in 0..rim {
            let (sin, cos) = (turn + TAU * k as f64 / rim as f64).sin_cos();
            points.push([r * cos, r * sin]);
        }
    }
    // Of a chord between two points of the rim, only the rim has no triangle on the other side.
    let chord = 2.0 * radius * (PI / rim as f64).sin() * 1.001;
    let on_rim = |p: &[f64; 2]| p[0].hypot(p[1]) > radius * (1.0 - 1e-9);
    triangulated(points, |a, b| {
        let near = (a[0] - b[0]).hypot(a[1] - b[1]) < chord;
        (on_rim(a) && on_rim(b) && near).then_some("rim")
    })
}

/// The Delaunay mesh of points, with its boundary edges in the groups that `side` names.
fn triangulated(
    points: Vec<[f64; 2]>,
    side: impl Fn(&[f64; 2], &[f64; 2]) -> Option<&'static str>,
) -> Result<Mesh, TestkitError> {
    let sites = points.iter().map(|p| Point2::new(p[0], p[1])).collect();
    // Stable: the vertices keep the order of the points.
    let triangulation: DelaunayTriangulation<Point2<f64>> = DelaunayTriangulation::bulk_load_stable(sites)?;
    let cells: Vec<_> =
        triangulation.inner_faces().map(|face| face.vertices().map(|vertex| vertex.fix().index())).collect();
    let mut groups = FaceGroups::new();
    for edge in triangulation.convex_hull() {
        let nodes = edge.vertices().map(|vertex| vertex.fix().index());
        if let Some(name) = side(&points[nodes[0]], &points[nodes[1]]) {
            groups.entry(name.to_string()).or_default().push(nodes);
        }
    }
    Ok(Mesh::new(points, &cells, &groups, &ElementGroups::new())?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::ids::ElementId;

    fn area(mesh: &Mesh) -> f64 {
        (0..mesh.element_count()).map(|e| mesh.geometry::<2, 3>(ElementId::new(e)).volume).sum()
    }

    fn group_length(mesh: &Mesh, group: &str) -> f64 {
        mesh.face_groups()[group].iter().map(|&f| mesh.normal_in::<2>(f).1).sum()
    }

    /// Fills the rectangle, groups all of the boundary, and has no small angle, for many seeds.
    #[test]
    fn rectangles() {
        for seed in 0..40 {
            let n = 1 + seed as usize % 12;
            let mesh = random_rectangle(2.0, 1.3, n, seed).unwrap();
            assert!(smallest_angle(&mesh) >= 10.0);
            // Rounding of a few hundred areas and lengths.
            assert!((area(&mesh) - 2.6).abs() < 1e-13);
            for (group, length) in [("left", 1.3), ("right", 1.3), ("bottom", 2.0), ("top", 2.0)] {
                assert!((group_length(&mesh, group) - length).abs() < 1e-13, "{group}");
            }
            let grouped: usize = mesh.face_groups().values().map(Vec::len).sum();
            assert_eq!(grouped, mesh.boundary().count());
        }
    }

    /// Structured meshes have six elements around each inner node; these have 4, 5, 6, 7 and more.
    #[test]
    fn rectangles_are_unstructured() {
        let mesh = random_rectangle(1.0, 1.0, 12, 5).unwrap();
        let inner = (0..mesh.node_count()).map(percute_core::ids::NodeId::new).map(|n| mesh.stars().star(n));
        let mut counts: Vec<usize> = inner.filter(|s| s.is_closed()).map(|s| s.elements.len()).collect();
        counts.sort_unstable();
        counts.dedup();
        assert!(counts.len() >= 4, "{counts:?}");
        let other = random_rectangle(1.0, 1.0, 12, 6).unwrap();
        assert_ne!(mesh.points(), other.points());
        assert_eq!(mesh.points(), random_rectangle(1.0, 1.0, 12, 5).unwrap().points());
    }

    /// The rim is all of the boundary, and its polygon of k sides has the area ½kR² sin(2π/k).
    #[test]
    fn discs() {
        for size in [1.0, 0.5, 0.21, 0.1] {
            let mesh = disc(1.0, size).unwrap();
            let sides = mesh.face_groups()["rim"].len();
            assert_eq!(sides, mesh.boundary().count());
            assert!((area(&mesh) - 0.5 * sides as f64 * (TAU / sides as f64).sin()).abs() < 1e-12);
            assert!(smallest_angle(&mesh) >= 10.0, "size {size}: {}", smallest_angle(&mesh));
            // A length of 2π in sides of the size wanted, to the nearest whole number.
            assert!((sides as f64 - TAU / size).abs() <= 0.5);
        }
    }

    #[test]
    fn impossible_arguments_are_refused() {
        assert!(matches!(random_rectangle(0.0, 1.0, 3, 0), Err(TestkitError::Argument(_))));
        assert!(matches!(random_rectangle(1.0, f64::NAN, 3, 0), Err(TestkitError::Argument(_))));
        assert!(matches!(disc(1.0, 1.5), Err(TestkitError::Argument(_))));
    }
}
