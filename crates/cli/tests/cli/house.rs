//! The house as its documents describe it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: impl AsRef<Path>) -> String {
    std::fs::read_to_string(root().join(path)).unwrap()
}

/// core ← estimator ← io ← cli ← py, with exact at the side: no crate uses one further down the chain.
#[test]
fn dependencies_never_point_back() {
    let may_use = BTreeMap::from([
        ("exact", vec![]),
        ("core", vec![]),
        ("estimator", vec!["percute-core", "percute-exact"]),
        ("io", vec!["percute-core", "percute-estimator"]),
        ("cli", vec!["percute-core", "percute-estimator", "percute-io"]),
        ("py", vec!["percute-core", "percute-estimator", "percute-exact", "percute-io", "percute"]),
        ("testkit", vec!["percute-core"]),
    ]);
    let folders: Vec<_> = std::fs::read_dir(root().join("crates")).unwrap().map(|f| f.unwrap().file_name()).collect();
    assert_eq!(folders.len(), may_use.len(), "a crate is missing here: {folders:?}");
    for (folder, allowed) in may_use {
        let manifest: toml::Table = read(format!("crates/{folder}/Cargo.toml")).parse().unwrap();
        let none = toml::Table::new();
        let used = manifest.get("dependencies").and_then(|d| d.as_table()).unwrap_or(&none);
        for name in used.keys().filter(|name| name.starts_with("percute")) {
            assert!(allowed.contains(&name.as_str()), "crates/{folder} must not use {name}");
        }
    }
}

/// Every path that the documents name is there.
#[test]
fn documents_name_what_exists() {
    let pages = [
        "README.md",
        "ARCHITECTURE.md",
        "CONVENTIONS.md",
        "CHANGELOG.md",
        "docs/json.md",
        "docs/mesh.md",
        "docs/history.md",
        "docs/estimate.md",
    ];
    for page in pages {
        let text = read(page);
        let quoted = text.split('`').skip(1).step_by(2);
        let linked = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let mut seen = 0;
        for path in quoted.chain(linked) {
            let starts = ["crates/", "python/", "examples/", "docs/", ".ci/", ".cargo/", "tools/"];
            let is_page = path.ends_with(".md") && !path.contains(' ');
            if is_page || (starts.iter().any(|s| path.starts_with(s)) && !path.contains(' ')) {
                seen += 1;
                let beside = root().join(page).with_file_name(path);
                assert!(root().join(path).exists() || beside.exists(), "{page} names {path}");
            }
        }
        assert!(seen > 0 || !page.starts_with(['R', 'A']), "{page} names no path at all: is this test awake?");
    }
}
