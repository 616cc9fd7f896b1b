//! Runs that were to end with the rebound and go to their latest end: the warning is in all that is said.

use crate::common::{BAR, Bench, stderr, stdout};
use serde_json::Value;

/// Three bars: the second one, struck by the first, reaches the third after 79 µs.
fn cradle(time: &str) -> String {
    let body = |(name, origin, velocity): (&str, f64, f64)| {
        format!(
            "[[body]]\nname = \"{name}\"\nbar = {{ length = 0.1, elements = 20 }}\norigin = {origin}\n\
             material = {{ young = 70e9, density = 2700.0, section = 1e-4 }}\nvelocity = {velocity:?}\n\n"
        )
    };
    let bodies = [("a", 0.0, 10.0), ("b", 0.10001, 0.0), ("c", 0.2008, 0.0)].map(body).concat();
    format!("{bodies}[time]\nend = \"rebound\"\nafter = 20e-6\ncourant = 0.9\n{time}\n")
}

/// Runs a case; its warning on standard error, in the summary and in the document.
fn told(case: &str) -> [String; 3] {
    let bench = Bench::new(case);
    let [shown, document] = [&[][..], &["--json"]].map(|more| bench.percute(&[&["run", "case.toml"], more].concat()));
    assert_eq!((shown.status.code(), document.status.code()), (Some(0), Some(0)), "{}", stderr(&shown));
    let summary = stdout(&shown).split_whitespace().collect::<Vec<_>>().join(" ");
    let document: Value = serde_json::from_slice(&document.stdout).unwrap();
    let found = document["warnings"].as_array().unwrap().iter().find(|warning| warning["name"] == "no_rebound");
    let message = found.map_or(String::new(), |warning| warning["message"].as_str().unwrap().to_string());
    [stderr(&shown), summary, message]
}

#[test]
fn a_run_without_rebound_says_so_everywhere_and_says_what_goes_on() {
    let bar = |longest: &str| BAR.replace("end = 20e-6", &format!("end = \"rebound\"\nlongest = {longest}"));
    for (case, words) in [
        (bar("20e-6"), "the body has not left its plane by 2e-5 s"),
        (bar("60e-6"), "less than"),
        (cradle("longest = 30e-6"), "contact has not ended by 3e-5 s"),
        (cradle("longest = 75e-6"), "\"b\" and \"c\" approach each other at 9.84 m/s at 7.5e-5 s"),
    ] {
        let [error, summary, message] = told(&case);
        let said: Vec<&str> = error.lines().filter(|line| line.contains(words)).collect();
        assert!(said.len() == 1 && said[0].starts_with("warning: "), "{error}");
        assert!(summary.contains("WARNING") && summary.contains(words), "{summary}");
        assert_eq!(said[0], format!("warning: {message}"));
    }
    let [error, summary, message] = told(&cradle("longest = 1e-3"));
    assert!(error.is_empty() && !summary.contains("WARNING") && message.is_empty(), "{error}{summary}{message}");
}

#[test]
fn a_run_that_goes_on_has_the_warning_too() {
    let bench = Bench::new(&cradle("longest = 75e-6"));
    let arguments = ["run", "case.toml", "--history", "h.vtkhdf", "--json"];
    assert_eq!(bench.percute(&arguments).status.code(), Some(0));
    let again = bench.percute(&[&arguments[..], &["--resume"]].concat());
    let document: Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!(document["warnings"][0]["name"], "no_rebound", "{}", stderr(&again));
    assert_eq!(stderr(&again).matches("the latest end: the run ends there").count(), 1);
}
