#![allow(clippy::print_stdout, missing_docs, unreachable_pub, dead_code)]
#[path = "../src/reproduce/part/effectivity/mod.rs"]
mod effectivity;
#[path = "../src/reproduce/part/parallel.rs"]
mod parallel;
use effectivity::*;
use percute_core::material::Hypothesis::{self, *};
use percute_core::observer::Unobserved;
use percute_estimator::ContactForce;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: usize| arguments.get(i).map_or(default, |a| a.parse().unwrap_or(default));
    let (finest, reference) = (number(1, 3), number(2, 5));
    let meshes = Meshes { estimated: (0..=finest).collect(), references: (5..=reference.max(5)).collect() };
    let meshes = if reference < 5 { Meshes { references: vec![reference], ..meshes } } else { meshes };
    let which = arguments.first().map_or("all", String::as_str);
    let mut cases: Vec<(String, Case)> = Vec::new();
    let base = Case {
        body: Body::Structured,
        hypothesis: PlaneStress,
        friction: 0.2,
        tilt: 0.0,
        velocity: [400.0, -400.0],
        gap: 0.2e-3,
        end: 13e-6,
    };
    let short = |h: Hypothesis| if h == PlaneStress { "stress" } else { "strain" };
    for hypothesis in [PlaneStress, PlaneStrain] {
        for friction in [0.0, 0.2, 0.5] {
            for velocity in [[400.0, -400.0], [0.0, -400.0]] {
                cases.push((
                    format!("flat {} μ {friction} v {velocity:?}", short(hypothesis)),
                    Case { hypothesis, friction, velocity, ..base },
                ));
            }
        }
    }
    for (hypothesis, friction) in [(PlaneStress, 0.2), (PlaneStrain, 0.5)] {
        cases.push((
            format!("unstructured flat {} μ {friction}", short(hypothesis)),
            Case { body: Body::Unstructured, hypothesis, friction, ..base },
        ));
    }
    for tilt in [3.0, -3.0] {
        cases.push((format!("tilted {tilt}°"), Case { tilt, end: 16e-6, ..base }));
        cases.push((
            format!("tilted {tilt}° unstructured"),
            Case { tilt, end: 16e-6, body: Body::Unstructured, ..base },
        ));
    }
    for tilt in [10.0, -10.0] {
        for gap in [0.1e-3, 0.2e-3] {
            cases.push((
                format!("tilted {tilt}° normal gap {gap}"),
                Case { tilt, gap, end: 16e-6, velocity: [0.0, -400.0], ..base },
            ));
        }
    }
    for velocity in [[400.0, -400.0], [0.0, -400.0]] {
        cases.push((
            format!("rounded tilted 10° v {velocity:?}"),
            Case { body: Body::Rounded, tilt: 10.0, velocity, end: 16e-6, ..base },
        ));
        cases
            .push((format!("rounded flat v {velocity:?}"), Case { body: Body::Rounded, velocity, end: 16e-6, ..base }));
        cases.push((format!("disc v {velocity:?}"), Case { body: Body::Disc, velocity, end: 16e-6, ..base }));
        cases.push((format!("disc v {velocity:?} 40 µs"), Case { body: Body::Disc, velocity, end: 40e-6, ..base }));
    }
    cases.retain(|case| which == "all" || case.0.contains(which));
    let start = std::time::Instant::now();
    let results = parallel::in_order("effectivity", 2, &cases, &mut Unobserved, |case, stop| {
        let start = std::time::Instant::now();
        Ok::<_, Failure>((case.1.run(&meshes, stop)?, start.elapsed().as_secs_f64()))
    })?;
    for ((name, _), (found, seconds)) in cases.iter().zip(results.unwrap_or_default()) {
        println!("{name}  ({seconds:.1} s)");
        for (r, reading) in ContactForce::ALL.iter().enumerate() {
            print!("  {:<8}", reading.to_string());
            for which in 0..2 {
                print!(" {:<5}", ["sup", "mean"][which]);
                for f in &found {
                    f.as_ref().map_or_else(|| print!("     – "), |f| print!(" {:6.2}", f.effectivity(r)[which]));
                }
            }
            println!();
        }
        for (k, reference) in meshes.references.iter().enumerate() {
            print!("  e_ref {reference} ");
            for which in 0..2 {
                print!(" {:<5}", ["sup", "mean"][which]);
                for f in &found {
                    f.as_ref().map_or_else(|| print!("     – "), |f| print!(" {:6.1}", f.exact[k][which]));
                }
            }
            println!();
        }
    }
    println!("{:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}
