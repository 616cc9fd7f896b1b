//! The layout of the project as its documents describe it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: impl AsRef<Path>) -> String {
    std::fs::read_to_string(root().join(path)).unwrap()
}

/// core ← estimator ← io ← workflow ← presentation, sweep ← cli ← py, with exact and system at the side: no crate uses
/// one further down the chain.
#[test]
fn dependencies_never_point_back() {
    let before_cli =
        ["percute-core", "percute-estimator", "percute-exact", "percute-io", "percute-system", "percute-workflow"];
    let may_use = BTreeMap::from([
        ("exact", vec![]),
        ("system", vec![]),
        ("core", vec![]),
        ("estimator", vec!["percute-core", "percute-exact", "percute-system"]),
        ("io", vec!["percute-core", "percute-estimator", "percute-system"]),
        ("workflow", vec!["percute-core", "percute-estimator", "percute-io"]),
        ("presentation", vec!["percute-core", "percute-estimator", "percute-io", "percute-workflow"]),
        ("sweep", vec!["percute-core", "percute-io", "percute-system", "percute-workflow"]),
        ("cli", [&before_cli[..], &["percute-presentation", "percute-sweep"]].concat()),
        ("py", [&before_cli[..], &["percute-presentation", "percute-sweep", "percute"]].concat()),
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

/// The pages of the project: those at its root, in `docs` and beside the examples.
fn pages() -> Vec<PathBuf> {
    let of = |folder: &str| std::fs::read_dir(root().join(folder)).unwrap().map(|f| f.unwrap().path());
    let pages = ["", "docs", "examples"].into_iter().flat_map(of);
    let kinds = ["md", "cff", "toml"];
    pages.filter(|p| p.extension().is_some_and(|e| kinds.iter().any(|kind| e == *kind))).collect()
}

/// Every path that the documents name, in quotes or as a link, is there.
#[test]
fn documents_name_what_exists() {
    let starts = ["benches/", "crates/", "python/", "examples/", "docs/", "tests/", ".ci/", ".cargo/", "tools/"];
    let mut seen = BTreeMap::new();
    for page in pages() {
        let (name, text) = (page.file_name().unwrap().to_str().unwrap().to_string(), read(&page));
        let quoted = text.split('`').skip(1).step_by(2);
        let linked = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let linked = linked.filter(|link| !link.contains("://") && !link.starts_with('#'));
        let named = quoted.filter(|path| {
            let page = [".md", ".cff", ".svg"].iter().any(|end| path.ends_with(end));
            !path.contains(char::is_whitespace) && (page || starts.iter().any(|start| path.starts_with(start)))
        });
        for path in named.chain(linked) {
            let path = path.split('#').next().unwrap_or(path);
            let beside = page.with_file_name(path);
            // Names of files that users make stand without a folder.
            assert!(root().join(path).exists() || beside.exists() || !path.contains(['/', '.']), "{name} names {path}");
            *seen.entry(name.clone()).or_insert(0) += 1;
        }
    }
    for page in ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"] {
        assert!(seen.get(page).is_some_and(|&count| count > 5), "{page} names hardly a path: is this test awake?");
    }
}

/// Licences and the page on how to cite are there, and say what the manifests say.
#[test]
fn licences_and_citation_agree_with_the_manifests() {
    let manifest: toml::Table = read("Cargo.toml").parse().unwrap();
    let package = manifest["workspace"]["package"].as_table().unwrap();
    let (licence, version) = (package["license"].as_str().unwrap(), package["version"].as_str().unwrap());
    let citation = read("CITATION.cff");
    assert!(
        citation.contains(&format!("version: {version}\n")) && citation.contains(&format!("license: \"{licence}\"\n"))
    );
    assert!(read("pyproject.toml").contains(&format!("license = \"{licence}\"")));
    assert!(read("LICENSE-MIT").starts_with("MIT License") && read("LICENSE-APACHE").contains("Apache License"));
}
