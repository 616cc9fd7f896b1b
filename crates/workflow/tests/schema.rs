//! The schema of case files has the keys that the readers ask for and the names that they accept, and describes all.

use percute_estimator::{Acceleration, Reconstruction};
use percute_workflow::case::{FIELDS, SCHEMA, Source, parse};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// What is read first, unless the table has it; bodies have a mesh and a material of their own.
const BEFORE: [(&str, &str); 3] = [
    ("mesh", "mesh = { bar = { length = 1, elements = 1 } }"),
    ("material", "material = { young = 1, density = 1, section = 1 }"),
    ("time", "time = { end = 1, courant = 0.9 }"),
];

fn schema() -> Value {
    serde_json::from_str(SCHEMA).unwrap()
}

/// What the schema says of one place, with what it refers to.
fn parts<'a>(schema: &'a Value, here: &'a Value) -> Vec<&'a Value> {
    let referred = here["$ref"].as_str().map(|name| schema.pointer(&name[1..]).unwrap());
    let ways = here["anyOf"].as_array().into_iter().flatten();
    let inner = referred.into_iter().chain(ways).chain(here.get("items"));
    std::iter::once(here).chain(inner.flat_map(|part| parts(schema, part))).collect()
}

/// The keys of each table of the schema, by its path.
fn keys_of(schema: &Value) -> BTreeMap<String, BTreeSet<String>> {
    let mut found = BTreeMap::new();
    let mut ahead = vec![(String::new(), schema)];
    while let Some((path, here)) = ahead.pop() {
        for part in parts(schema, here) {
            let Some(properties) = part["properties"].as_object() else { continue };
            assert_eq!(part["additionalProperties"], Value::Bool(false), "other keys of `{path}`");
            found.insert(path.clone(), properties.keys().cloned().collect());
            let joint = if path.is_empty() { "" } else { "." };
            ahead.extend(properties.iter().map(|(key, value)| (format!("{path}{joint}{key}"), value)));
        }
    }
    found
}

/// The words in quotes of this kind after the last `before` of the message that refuses a case.
fn refusal(table: &str, before: &str, quote: char) -> BTreeSet<String> {
    let begins = |key: &str| table.lines().any(|line| line.starts_with(&format!("{key} = ")));
    let own = |key: &str| begins("body") && key != "time";
    let needed = BEFORE.iter().filter(|(key, _)| !begins(key) && !own(key)).map(|(_, text)| *text);
    let text = needed.chain([table]).collect::<Vec<_>>().join("\n");
    let message = parse(Source::new("case.toml", text)).unwrap_err().message;
    let (_, allowed) = message.rsplit_once(before).unwrap_or_else(|| panic!("{table}: {message}"));
    allowed.split(quote).skip(1).step_by(2).map(str::to_string).collect()
}

/// Readers accept the keys of the schema: one that none of them asks for would be without effect.
#[test]
fn each_key_is_read() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/case");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let readers = files.filter(|file| file.is_file() && file.extension() == Some("rs".as_ref()));
    let readers: String = readers.map(|file| std::fs::read_to_string(file).unwrap()).collect();
    for (table, keys) in keys_of(&schema()) {
        let unread: Vec<_> = keys.iter().filter(|key| !readers.contains(&format!("\"{key}\""))).collect();
        assert!(unread.is_empty(), "[{table}]: {unread:?}");
    }
}

#[test]
fn materials_have_the_keys_of_their_body() {
    let schema = schema();
    let all = &keys_of(&schema)["material"];
    for (body, mesh) in [("bar_material", ""), ("plane_material", "\nmesh = { disc = { radius = 1, rings = 1 } }")] {
        let excluded = schema["$defs"][body]["properties"].as_object().unwrap();
        assert!(excluded.values().all(|value| *value == Value::Bool(false)));
        let left: BTreeSet<String> = all.iter().filter(|key| !excluded.contains_key(*key)).cloned().collect();
        assert_eq!(left, refusal(&format!("material = {{ stranger = 1 }}{mesh}"), "allowed are ", '`'));
    }
}

#[test]
fn the_names_are_those_of_the_readers() {
    let schema = schema();
    let names = |place: &str| -> BTreeSet<String> {
        let names = schema.pointer(place).and_then(Value::as_array).unwrap_or_else(|| panic!("{place}"));
        names.iter().map(|name| name.as_str().unwrap().to_string()).collect()
    };
    let estimate = "/$defs/estimate/properties";
    let reconstructions = Reconstruction::ALL.iter().map(ToString::to_string).collect();
    assert_eq!(names(&format!("{estimate}/reconstruction/enum")), reconstructions);
    let accelerations = Acceleration::ALL.iter().map(ToString::to_string).collect();
    assert_eq!(names(&format!("{estimate}/acceleration/enum")), accelerations);
    let fields = FIELDS.iter().chain(&["admissible"]).map(ToString::to_string).collect();
    assert_eq!(names("/$defs/output/properties/fields/anyOf/1/items/enum"), fields);
    let plane = "material = { young = 1, density = 1, poisson = 0, plane = \"none\" }\n\
                 mesh = { disc = { radius = 1, rings = 1 } }";
    assert_eq!(names("/$defs/material/properties/plane/enum"), refusal(plane, "must be ", '"'));
    let cut = "mesh = { rectangle = { width = 1, height = 1, nx = 1, ny = 1, diagonals = \"none\" } }";
    assert_eq!(names("/$defs/mesh/properties/rectangle/properties/diagonals/enum"), refusal(cut, "must be ", '"'));
    let axis = "support = { group = \"boundary\", components = [\"w\"] }\n\
                material = { young = 1, density = 1, poisson = 0 }\n\
                mesh = { ball = { radius = 1, rings = 1 } }";
    assert_eq!(names("/$defs/support/properties/components/items/enum"), refusal(axis, "must be ", '`'));
}

#[test]
fn each_key_is_described() {
    let schema = schema();
    let mut ahead = vec![&schema];
    let mut described = 0;
    while let Some(here) = ahead.pop() {
        for (key, value) in here["properties"].as_object().into_iter().flatten() {
            let told = parts(&schema, value).iter().any(|part| part["description"].is_string());
            assert!(told, "`{key}` has no description");
            described += 1;
            ahead.extend(parts(&schema, value));
        }
    }
    // Ten tables and the keys of docs/case.md.
    assert!(described > 50, "{described}");
}
