//! `percute export`: the steps that are chosen.

use crate::common::{BLOCK, Bench, stderr};

#[test]
fn an_option_in_place_of_steps_is_named() {
    let bench = Bench::new(BLOCK);
    let output = bench.percute(&["export", "a.vtkhdf", "-o", "b.vtu", "--steps", "--every", "2"]);
    assert_eq!(output.status.code(), Some(2));
    let told = stderr(&output);
    assert!(told.contains("--steps needs the numbers of steps"), "{told}");
}

#[test]
fn of_a_part_of_a_run_the_instants_kept_are_counted() {
    let bench = Bench::new(&(BLOCK.to_string() + "[output]\nevery = 4\n"));
    assert_eq!(bench.percute(&["simulate", "case.toml", "--quiet"]).status.code(), Some(0));
    let kept = |more: &[&str]| bench.percute(&[&["export", "case.vtkhdf", "-o"], more].concat());
    let beyond = kept(&["a.vtu", "--steps", "20"]);
    assert_eq!(beyond.status.code(), Some(2));
    let told = stderr(&beyond);
    let said = told.split_once("its own instants are counted: ").map(|(_, numbers)| numbers);
    let numbers =
        said.and_then(|said| said.split_once(" of the run")).and_then(|(said, _)| said.split_once(" is step "));
    let [last, step] = numbers.map(|(last, step)| [last, step].map(|n| n.parse::<usize>().unwrap())).unwrap();
    assert!(
        told.contains(&format!("the last is step {last}; ")) && 4 * (last - 1) < step && step <= 4 * last,
        "{told}"
    );
    let done = kept(&["b.pvd", "--steps", "0,-1"]);
    assert_eq!(done.status.code(), Some(0), "{}", stderr(&done));
    let name = |of: usize| format!("b_{of}.vtu");
    assert!(bench.path(&name(0)).exists() && bench.path(&name(last)).exists(), "{:?}", bench.files());
}
