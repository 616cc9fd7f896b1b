//! Steps of different lengths, which can be unstable below the critical step.

use crate::common::{BLOCK, Bench, stderr, stdout};

/// A case with steps that alternate between 0.8 and 0.9 of the critical one, which `percute info` tells.
fn alternating(count: usize) -> Bench {
    let bench = Bench::new(BLOCK);
    let info: serde_json::Value =
        serde_json::from_slice(&bench.percute(&["info", "case.toml", "--json"]).stdout).unwrap();
    let critical = info["time"]["critical_time_step"].as_f64().unwrap();
    let step = |n: usize| format!("{:e}", critical * if n.is_multiple_of(2) { 0.8 } else { 0.9 });
    let steps = (0..count).map(step).collect::<Vec<_>>().join(", ");
    let velocity = "time = [0.0, 1e-4], value = [400.0, 400.0]";
    let case = BLOCK.replace("end = 5e-6\ncourant = 0.9", &format!("steps = [{steps}]"));
    std::fs::write(bench.path("case.toml"), case.replace(velocity, "time = [0.0, 1e-3], value = [400.0, 400.0]"))
        .unwrap();
    bench
}

#[test]
fn steps_that_amplify_vibrations_are_warned_of_and_then_refused() {
    let few = alternating(90);
    let output = few.percute(&["run", "case.toml", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = stderr(&output);
    assert!(
        told.contains("[time], steps: change so that they amplify vibrations") && told.contains("take equal steps"),
        "{told}"
    );
    assert_eq!(told.matches("so that they amplify").count(), 1, "{told}");
    assert!(stdout(&output).contains("\"varying_steps\""));

    let many = alternating(300);
    for command in ["run", "simulate", "info", "verify"] {
        let output = many.percute(&[command, "case.toml"]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        let told = stderr(&output);
        assert!(told.contains("the run would be unstable") && told.contains("take equal steps"), "{told}");
    }
    assert_eq!(many.files(), ["case.toml"]);
}
