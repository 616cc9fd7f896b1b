//! The folder: what is in it, and when it is refused.

use super::{evidence, files, made, numbers, read};
use crate::common::{Bench, stderr, stdout};
use crate::picture::tags;

#[test]
fn the_folder_is_whole() {
    let bench = evidence();
    let (numbers, files) = (numbers(bench), files(&bench.path("ev")));
    let list = stdout(&bench.percute(&["reproduce", "--list"]));
    let keys: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    let made: Vec<&String> = numbers["parts"].as_object().unwrap().keys().collect();
    assert!(!keys.is_empty() && keys.iter().all(|key| made.iter().any(|made| made == key)), "{list} {made:?}");
    for part in numbers["parts"].as_object().unwrap().values() {
        let tables = part["tables"].as_object().unwrap();
        assert!(!tables.is_empty() && tables.keys().all(|name| files.contains_key(&format!("tables/{name}.csv"))));
    }
    let figures = files.keys().filter_map(|name| name.strip_prefix("figures/")?.strip_suffix(".svg"));
    let page = read(bench, "index.html");
    let count = figures
        .inspect(|name| {
            assert!(files.contains_key(&format!("figures/{name}.png")), "{name}");
            assert!(page.contains(&format!("<figure id=\"{name}\">")), "{name} is not on the page");
        })
        .count();
    assert_eq!(page.matches("<svg ").count(), count);
    assert!(count >= 6, "{count} figures");
}

#[test]
fn figures_are_drawings_and_images_of_twice_their_size() {
    let files = files(&evidence().path("ev/figures"));
    for (name, content) in files.iter().filter(|(name, _)| name.ends_with(".svg")) {
        let svg = std::str::from_utf8(content).unwrap();
        assert_eq!(tags(svg)[0], "svg", "{name}");
        let side =
            |key: &str| svg.split(&format!(" {key}=\"")).nth(1).unwrap().split('"').next().unwrap().parse::<u32>();
        let png = &files[&name.replace(".svg", ".png")];
        assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n", "{name}");
        // The first chunk of a PNG, IHDR, begins with width and height.
        let size = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
        assert_eq!([size(16), size(20)], [side("width").unwrap(), side("height").unwrap()].map(|s| 2 * s), "{name}");
        // An image without text would be much smaller, and one of a single colour a few hundred bytes.
        assert!(png.len() > 5000, "{name}: {} bytes", png.len());
    }
}

/// Nothing is fetched from anywhere, and tags close in order.
#[test]
fn the_page_needs_nothing_else() {
    let page = read(evidence(), "index.html");
    let (_, body) = page.split_once("<body>").unwrap();
    tags(&body.replace("</body>", "").replace("</html>", ""));
    assert!(page.contains("prefers-color-scheme: dark"));
    let own = page.replace("http://www.w3.org/2000/svg", "");
    for outside in ["http", "src=", "url(", "@import", "<script", "<link", "<iframe"] {
        assert!(!own.contains(outside), "the page has `{outside}`");
    }
    for link in page.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
        let target = link.strip_prefix('#').unwrap_or_else(|| panic!("a link out of the page: {link}"));
        assert!(page.contains(&format!("id=\"{target}\"")), "a link to nothing: {link}");
    }
}

#[test]
fn no_byte_depends_on_the_threads() {
    let (one, three) = (files(&evidence().path("ev")), files(&made(&["--threads", "3"]).path("ev")));
    assert_eq!(one.keys().collect::<Vec<_>>(), three.keys().collect::<Vec<_>>());
    for (name, content) in &one {
        assert!(three[name] == *content, "{name} differs");
    }
}

#[test]
fn what_cannot_be_is_refused_before_work() {
    let bench = Bench::new("");
    let output = bench.percute(&["reproduce", "tabel1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("did you mean `table1`?"), "{}", stderr(&output));
    assert_eq!(bench.files(), ["case.toml"], "a folder was made");

    std::fs::create_dir(bench.path("used")).unwrap();
    std::fs::write(bench.path("used/letter.txt"), "mine").unwrap();
    let output = bench.percute(&["reproduce", "table1", "--small", "--output", "used"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("used") && stderr(&output).contains("--force"), "{}", stderr(&output));
    assert_eq!(files(&bench.path("used")).len(), 1);
    let output = bench.percute(&["reproduce", "table1", "--small", "--output", "used", "--overwrite"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let files = files(&bench.path("used"));
    assert!(files["letter.txt"] == *b"mine" && files.contains_key("index.html"));

    for (folder, why) in [("case.toml", "no folder"), ("none/ev", "there is no folder none")] {
        let output = bench.percute(&["reproduce", "table1", "--small", "--output", folder]);
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains(why), "{}", stderr(&output));
    }
}

/// The page and its numbers hold the parts that were done.
#[test]
#[cfg(target_os = "linux")]
fn ctrl_c_keeps_the_parts_that_are_done() {
    use crate::interrupt::{send_interrupt, start};
    let bench = Bench::new("");
    let child = start(&bench, &["reproduce", "stress-maps", "time-steps", "--output", "ev"]);
    // The second part takes some seconds.
    while !bench.path("ev/numbers.json").exists() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let output = send_interrupt(child);
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stdout(&output).contains("1 of 2 parts, INTERRUPTED"), "{}", stdout(&output));
    let numbers = numbers(&bench);
    assert_eq!(numbers["parts"].as_object().unwrap().keys().collect::<Vec<_>>(), ["stress-maps"]);
    let page = read(&bench, "index.html");
    let others: Vec<_> =
        percute::reproduce::PARTS.iter().map(|part| part.key).filter(|key| *key != "stress-maps").collect();
    let missing = format!("Not on this page: {}", others.join(", "));
    assert!(page.ends_with("</html>\n") && page.contains(&missing), "{missing}");
}
