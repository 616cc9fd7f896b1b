//! No two types of a crate have the same name.

use super::circles::modules;
use super::dependencies::root;
use std::collections::BTreeMap;

/// The types that a text defines. Types of traits and functions are indented.
fn types(code: &str) -> impl Iterator<Item = &str> {
    code.lines().filter_map(|line| {
        // Behind `pub` or `pub(in crate::module)`.
        let public =
            line.strip_prefix("pub").map(|rest| rest.split_once(") ").map_or(rest.trim_start(), |(_, rest)| rest));
        let (keyword, rest) = public.unwrap_or(line).split_once(' ')?;
        let name = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next()?;
        ["struct", "enum", "trait", "type", "union"].contains(&keyword).then_some(name)
    })
}

/// The names of several types, each with its modules.
fn doubles(texts: &BTreeMap<Vec<String>, String>) -> BTreeMap<&str, Vec<String>> {
    let mut found: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (module, code) in texts {
        types(code).for_each(|name| found.entry(name).or_default().push(module.join("::")));
    }
    found.retain(|_, modules| modules.len() > 1);
    found
}

#[test]
fn no_two_types_of_a_crate_have_the_same_name() {
    let mut count = 0;
    for folder in std::fs::read_dir(root().join("crates")).unwrap().map(|entry| entry.unwrap().path()) {
        let mut texts = BTreeMap::new();
        modules(&folder.join("src"), &[], &mut texts);
        texts.retain(|module, _| !module.iter().any(|name| name == "tests" || name == "fixture"));
        count += texts.values().flat_map(|code| types(code)).count();
        assert_eq!(doubles(&texts), BTreeMap::new(), "{}", folder.display());
    }
    assert!(count > 500, "only {count} types are found");
}

#[test]
fn doubles_are_found() {
    let one = "pub(in crate::one) struct Place<'a> {\n    /// No type.\n    pub enum: u8,\n}\ntype Pair = [f64; 2];\n";
    let other = "pub trait Value {\n    type Pair;\n}\nenum Place {}\nstruct Pairs;\n";
    let texts = [("one", one), ("other", other)].map(|(name, code)| (vec![name.to_string()], code.to_string()));
    let texts = BTreeMap::from(texts);
    assert_eq!(doubles(&texts).into_keys().collect::<Vec<_>>(), ["Place"]);
}
