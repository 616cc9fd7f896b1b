//! Pictures.

use crate::common::{ARRAYS, BAR, BLOCK, Bench, stderr};

/// Checks that tags open and close in order and that attributes are quoted; returns the names.
pub(crate) fn tags(xml: &str) -> Vec<String> {
    let (mut open, mut all) = (Vec::new(), Vec::new());
    for piece in xml.split('<').skip(1) {
        let (tag, text) = piece.split_once('>').expect("a tag without end");
        assert!(!text.contains('&') || text.contains(';'), "a bare ampersand: {text}");
        assert_eq!(tag.matches('"').count() % 2, 0, "an open quote: {tag}");
        let name = tag.trim_start_matches('/').split([' ', '/', '\n']).next().unwrap_or_default().to_string();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "closed out of order");
            continue;
        }
        if !tag.ends_with('/') {
            open.push(name.clone());
        }
        all.push(name);
    }
    assert!(open.is_empty(), "never closed: {open:?}");
    all
}

#[test]
fn triangles_planes_and_units_are_drawn() {
    let bench = Bench::new(BLOCK);
    let output = bench.percute(&["run", "case.toml", "--picture", "map.svg"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let svg = std::fs::read_to_string(bench.path("map.svg")).unwrap();
    // The elements, and 64 shades of the scale.
    assert_eq!(tags(&svg).iter().filter(|tag| *tag == "polygon").count(), 40 + 64);
    for word in ["½</tspan>", "x (mm)", "y (mm)", "Constitutive relation error", "case.toml", "viewBox"] {
        assert!(svg.contains(word), "no `{word}`");
    }
}

#[test]
fn the_error_of_a_bar_is_a_curve() {
    let bench = Bench::new(BAR);
    assert_eq!(bench.percute(&["run", "case.toml", "--picture", "bar.svg"]).status.code(), Some(0));
    let svg = std::fs::read_to_string(bench.path("bar.svg")).unwrap();
    let tags = tags(&svg);
    assert!(tags.contains(&"polyline".to_string()) && !tags.contains(&"polygon".to_string()), "{tags:?}");
    assert!(svg.contains("x (mm)"));
}

#[test]
fn the_end_of_the_name_chooses_the_format() {
    let bench = Bench::new(BLOCK);
    let output = bench.percute(&["run", "case.toml", "--picture", "map.PNG"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let png = std::fs::read(bench.path("map.PNG")).unwrap();
    assert!(png.starts_with(b"\x89PNG") && png.len() > 10_000, "{} bytes", png.len());
    // Width and height, two pixels for each of the SVG.
    assert_eq!(bench.percute(&["run", "case.toml", "--picture", "map.svg"]).status.code(), Some(0));
    let svg = std::fs::read_to_string(bench.path("map.svg")).unwrap();
    let width: u32 = svg.split("width=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
    assert_eq!(u32::from_be_bytes(png[16..20].try_into().unwrap()), 2 * width);
}

#[test]
fn existing_pictures_and_pages_are_kept_unless_forced() {
    let bench = Bench::new(BAR);
    for (flag, file) in [("--picture", "a.svg"), ("--picture", "a.png"), ("--report", "a.html")] {
        std::fs::write(bench.path(file), "old").unwrap();
        let output = bench.percute(&["run", "case.toml", flag, file]);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "before any work");
        assert!(
            stderr(&output).contains("exists already") && stderr(&output).contains("--force"),
            "{}",
            stderr(&output)
        );
        assert_eq!(std::fs::read_to_string(bench.path(file)).unwrap(), "old");
        let output = bench.percute(&["run", "case.toml", flag, file, "--force"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(std::fs::read(bench.path(file)).unwrap() != b"old");
    }
    // What was written under temporary names has got its own.
    assert_eq!(bench.files(), ["a.html", "a.png", "a.svg", "case.toml"]);
}

#[test]
fn names_are_escaped() {
    let bench = Bench::new("");
    std::fs::write(bench.path("a<b>&\"c\".toml"), ARRAYS).unwrap();
    let output = bench.percute(&["run", "a<b>&\"c\".toml", "--picture", "map.svg"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let svg = std::fs::read_to_string(bench.path("map.svg")).unwrap();
    tags(&svg);
    assert!(svg.contains("a&lt;b&gt;&amp;"));
}

#[test]
fn a_picture_that_cannot_be_written_fails_before_the_run() {
    let bench = Bench::new(BAR);
    let output = bench.percute(&["run", "case.toml", "--picture", "none/map.svg"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    assert!(stderr(&output).contains("none/map.svg"), "{}", stderr(&output));
}

#[test]
fn large_meshes_make_files_of_reasonable_size() {
    let large = BLOCK.replace("nx = 5, ny = 4", "nx = 160, ny = 128").replace("end = 5e-6", "end = 4e-8");
    let bench = Bench::new(&large);
    assert_eq!(bench.percute(&["run", "case.toml", "--picture", "map.svg", "--quiet"]).status.code(), Some(0));
    let size = std::fs::metadata(bench.path("map.svg")).unwrap().len();
    assert!((1_000_000..10_000_000).contains(&size), "{size} bytes for 40 960 triangles");
}
