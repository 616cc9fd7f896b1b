//! Names of the cases of a sweep, which are those of their folders.

use crate::key::Key;
use std::collections::HashMap;
use toml_edit::Value;

/// Longer names are cut (bytes); file systems allow 255.
const LONGEST: usize = 120;

/// For each key the shortest end of it that no other key has.
pub(crate) fn labels(keys: &[Key]) -> Vec<String> {
    let all: Vec<Vec<String>> = keys.iter().map(|key| key.tails().collect()).collect();
    let alone = |i: usize, tail: &String| all.iter().enumerate().all(|(j, tails)| i == j || !tails.contains(tail));
    let label = |(i, tails): (usize, &Vec<String>)| tails.iter().find(|tail| alone(i, tail)).or(tails.last()).cloned();
    all.iter().enumerate().map(|entry| label(entry).unwrap_or_default()).collect()
}

/// The names of cases with these values of the keys: `nx=20,friction=0.3`. Two names differ if two lists of values do.
pub(crate) fn names(keys: &[Key], cases: &[Vec<Value>]) -> Vec<String> {
    let labels = labels(keys);
    let whole: Vec<String> = cases.iter().map(|values| whole(&labels, values)).collect();
    let plain: Vec<String> = whole.iter().map(|whole| plain(whole)).collect();
    // Some file systems do not tell capital letters.
    let mut seen: HashMap<String, usize> = HashMap::new();
    plain.iter().for_each(|name| *seen.entry(name.to_lowercase()).or_default() += 1);
    let name = |(whole, plain): (&String, &String)| {
        let short: String = plain.chars().take(LONGEST).collect();
        if short == *plain && seen[&plain.to_lowercase()] == 1 { short } else { format!("{short}~{:08x}", hash(whole)) }
    };
    whole.iter().zip(&plain).map(name).collect()
}

fn whole(labels: &[String], values: &[Value]) -> String {
    let pair = |(label, value): (&String, &Value)| format!("{label}={}", text(value));
    labels.iter().zip(values).map(pair).collect::<Vec<_>>().join(",")
}

/// A value as a text without quotes; a number in its shorter form, the same from all sources.
pub(crate) fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.value().clone(),
        Value::Float(number) => {
            let (plain, exponential) = (format!("{}", number.value()), format!("{:e}", number.value()));
            if plain.len() > exponential.len() + 1 { exponential } else { plain }
        }
        Value::Array(list) => format!("[{}]", list.iter().map(text).collect::<Vec<_>>().join(",")),
        other => other.clone().decorated("", "").to_string(),
    }
}

/// Without characters that shells or file systems treat in a way of their own.
fn plain(name: &str) -> String {
    let kept = |c: char| match c {
        '[' | ']' | '{' | '}' | '"' | '\'' | ' ' => None,
        c if c.is_ascii_alphanumeric() || "=,.+-_~".contains(c) => Some(c),
        _ => Some('_'),
    };
    name.chars().filter_map(kept).collect()
}

/// The 32 bits of FNV-1a.
fn hash(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn keys(names: &[&str]) -> Vec<Key> {
        names.iter().map(|name| Key::parse(name).unwrap()).collect()
    }

    #[test]
    fn labels_are_short_and_differ() {
        assert_eq!(labels(&keys(&["mesh.rectangle.nx", "obstacle.0.friction"])), ["nx", "friction"]);
        let two = keys(&["obstacle.0.friction", "obstacle.1.friction", "initial.velocity.0"]);
        assert_eq!(labels(&two), ["obstacle.0.friction", "obstacle.1.friction", "velocity.0"]);
    }

    #[test]
    fn names_are_short_and_plain() {
        let keys = keys(&["mesh.file", "initial.velocity"]);
        let velocity: Value = "[400.0, -3e2]".parse().unwrap();
        let found = names(&keys, &[vec!["meshes/a b.msh".into(), velocity]]);
        assert_eq!(found, ["file=meshes_ab.msh,velocity=400,-300"]);
        let floats = [0.3, 400.0, 7e10, 5e-6, 0.001].map(|x| text(&x.into()));
        assert_eq!(floats, ["0.3", "400", "7e10", "5e-6", "0.001"]);
        let long = names(&keys[..1], &[vec!["x".repeat(300).into()], vec!["x".repeat(301).into()]]);
        assert!(long.iter().all(|name| name.len() == LONGEST + 9) && long[0] != long[1]);
        // By the definition of FNV-1a.
        assert_eq!(hash("a"), 0xe40c_292c);
    }

    proptest! {
        #[test]
        fn values_that_differ_have_names_that_differ(a in ".{0,40}", b in ".{0,40}") {
            let found = names(&keys(&["mesh.file"]), &[vec![a.as_str().into()], vec![b.as_str().into()]]);
            prop_assert_eq!(found[0] == found[1], a == b);
            prop_assert!(found.iter().all(|name| !name.contains(['/', '\0', '\n']) && name.starts_with("file=")));
        }
    }
}
