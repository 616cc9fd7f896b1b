//! No circle of files within a crate, and none of folders but those listed. A module and the modules inside it may use
//! each other.

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

/// Uses between modules in circles of folders: a list that shrinks. What is no longer there must go from the list.
const LEFT: [&str; 2] = ["core: contact::mortar uses contact::surface", "core: contact::surface uses contact::mortar"];

/// The modules that each module of a crate uses, but for its own and the modules around it; tests use what they like.
fn uses_in<'a>(known: &'a BTreeMap<Module, String>) -> BTreeMap<&'a Module, BTreeSet<Module>> {
    let of = |(module, code): (&'a Module, &String)| {
        let test = module.last().is_some_and(|name| name == "tests" || name == "fixture");
        let all = paths(code).into_iter().map(|path| target(module, &path, known));
        let other = |to: &Module| !test && !to.starts_with(module) && !module.starts_with(to);
        (module, all.filter(other).collect())
    };
    known.iter().map(of).collect()
}

/// Where two modules part: each with all that is inside it.
fn parted(from: &Module, to: &Module) -> (Module, Module) {
    let shared = from.iter().zip(to).take_while(|(a, b)| a == b).count();
    (from[..=shared].to_vec(), to[..=shared].to_vec())
}

/// The uses that are part of a circle.
fn in_circles<'a>(uses: &'a BTreeMap<&'a Module, BTreeSet<Module>>) -> Vec<(&'a Module, &'a Module)> {
    let back = |from: &'a Module, to: &'a Module| {
        let mut seen = BTreeSet::new();
        reached(to, uses, &mut seen);
        seen.contains(from)
    };
    let all = uses.iter().flat_map(|(from, used)| used.iter().map(|to| (*from, to)));
    all.filter(|(from, to)| back(from, to)).collect()
}

/// The modules of each crate.
fn crates() -> BTreeMap<String, BTreeMap<Module, String>> {
    let folders = std::fs::read_dir(root().join("crates")).unwrap().map(|entry| entry.unwrap());
    let of = |folder: std::fs::DirEntry| {
        let mut known = BTreeMap::new();
        modules(&folder.path().join("src"), &[], &mut known);
        (folder.file_name().into_string().unwrap(), known)
    };
    folders.map(of).collect()
}

#[test]
fn files_do_not_use_each_other_in_circles() {
    for (name, known) in crates() {
        let uses = uses_in(&known);
        let found: Vec<_> = in_circles(&uses).iter().map(|(from, to)| [from.join("::"), to.join("::")]).collect();
        assert!(found.is_empty(), "crates/{name}: {found:?}");
    }
}

#[test]
fn folders_do_not_use_each_other_in_new_circles() {
    let mut found = BTreeSet::new();
    for (name, known) in crates() {
        let uses = uses_in(&known);
        let pairs = uses.iter().flat_map(|(from, used)| used.iter().map(|to| parted(from, to)));
        let pairs: Vec<(Module, Module)> = pairs.collect();
        let mut whole = BTreeMap::<&Module, BTreeSet<Module>>::new();
        for (from, to) in &pairs {
            whole.entry(from).or_default().insert(to.clone());
            whole.entry(to).or_default();
        }
        let told = |(from, to): &(&Module, &Module)| format!("{name}: {} uses {}", from.join("::"), to.join("::"));
        found.extend(in_circles(&whole).iter().map(told));
    }
    assert_eq!(found, LEFT.map(str::to_string).into());
}
