//! No circle of files within a crate. A module and the modules inside it may use each other.

use super::dependencies::root;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

type Module = Vec<String>;

/// The text of each module, without comments and tests.
pub(super) fn modules(source: &Path, at: &[String], found: &mut BTreeMap<Module, String>) {
    for entry in std::fs::read_dir(source).unwrap().map(|entry| entry.unwrap().path()) {
        let mut module = at.to_vec();
        let stem = entry.file_stem().unwrap().to_str().unwrap().to_string();
        if entry.is_dir() {
            module.push(stem);
            modules(&entry, &module, found);
            continue;
        }
        if !["mod", "lib", "main"].contains(&stem.as_str()) {
            module.push(stem);
        }
        let text = std::fs::read_to_string(&entry).unwrap();
        let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        let code = text.lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n");
        found.insert(module, code);
    }
}

/// The paths in a tree of imports: `a::b` and `a::c::d` of `a::{b, c::d}`.
fn leaves(tree: &str, prefix: &str, paths: &mut Vec<String>) {
    let tree = tree.trim();
    let Some((head, rest)) = tree.split_once('{') else { return paths.push(format!("{prefix}{tree}")) };
    let (inside, _) = rest.rsplit_once('}').unwrap();
    let (mut depth, mut start) = (0, 0);
    for (at, letter) in inside.char_indices().chain([(inside.len(), ',')]) {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                leaves(&inside[start..at], &format!("{prefix}{head}"), paths);
                start = at + 1;
            }
            _ => {}
        }
    }
}

/// The paths from `crate` or `super` in a text.
fn paths(code: &str) -> Vec<String> {
    let mut paths = Vec::new();
    for start in ["crate::", "super::"] {
        for (at, _) in code.match_indices(start).filter(|(at, _)| !code[..*at].ends_with("super::")) {
            let end = match code[..at].ends_with("use ") {
                true => code[at..].find(';'),
                false => code[at..].find(|c: char| !c.is_alphanumeric() && c != '_' && c != ':'),
            };
            leaves(&code[at..at + end.unwrap_or(code.len() - at)], "", &mut paths);
        }
    }
    paths
}

/// The module that a path in `module` leads to.
fn target(module: &Module, path: &str, known: &BTreeMap<Module, String>) -> Module {
    let mut at = if path.starts_with("crate") { Vec::new() } else { module.clone() };
    for part in path.split("::").map(str::trim) {
        match part {
            "crate" => {}
            "super" => _ = at.pop(),
            name => {
                at.push(name.to_string());
                if !known.contains_key(&at) {
                    at.pop();
                    break;
                }
            }
        }
    }
    at
}

/// All modules that a module uses, directly or not.
fn reached<'a>(from: &'a Module, uses: &'a BTreeMap<&Module, BTreeSet<Module>>, seen: &mut BTreeSet<&'a Module>) {
    for next in &uses[from] {
        if seen.insert(next) {
            reached(next, uses, seen);
        }
    }
}

#[test]
fn files_do_not_use_each_other_in_circles() {
    for folder in ["core", "estimator", "exact", "io", "workflow", "presentation", "cli", "py", "testkit"] {
        let mut known = BTreeMap::new();
        modules(&root().join("crates").join(folder).join("src"), &[], &mut known);
        let uses = known.iter().map(|(module, code)| {
            let test = module.last().is_some_and(|name| name == "tests" || name == "fixture");
            let all = paths(code).into_iter().map(|path| target(module, &path, &known));
            let other = |to: &Module| !test && !to.starts_with(module) && !module.starts_with(to);
            (module, all.filter(other).collect::<BTreeSet<_>>())
        });
        let uses: BTreeMap<_, _> = uses.collect();
        for module in uses.keys() {
            let mut seen = BTreeSet::new();
            reached(module, &uses, &mut seen);
            assert!(!seen.contains(module), "crates/{folder}: {} is part of a circle", module.join("::"));
        }
    }
}
