//! The bar map of all readings: ranges of the effectivity over elements, steps and gaps.
//!
//! `cargo run --release -p percute-estimator --example bar_map [small|full] [T - t_c in L/c] [gaps in steps …]`
//! (2.5, and 1.1 1.3 1.5 1.7 1.9 unless given)

#![allow(clippy::print_stdout)]

#[path = "../../cli/src/reproduce/part/parallel.rs"]
mod parallel;
#[path = "../../cli/src/reproduce/part/bar_maps/study.rs"]
mod study;

use percute_core::observer::Unobserved;
use study::{Failure, Outcome, Setting, choices};

fn print(title: &str, settings: &[Setting], outcomes: &[Outcome]) {
    println!("{title}");
    for (c, (reading, option)) in choices().iter().enumerate() {
        print!("  {:<10} {:<8}", reading.to_string(), option.to_string());
        for which in 0..2 {
            let values: Vec<f64> = outcomes.iter().map(|o| o.effectivity(c)[which]).collect();
            let extreme = |sign: f64| {
                let order = |a: &usize, b: &usize| (sign * values[*a]).total_cmp(&(sign * values[*b]));
                let k = (0..values.len()).max_by(order).unwrap_or(0);
                (values[k], settings[k])
            };
            let ((low, at), (high, there)) = (extreme(-1.0), extreme(1.0));
            let share = values.iter().filter(|v| (0.7..=1.8).contains(*v)).count() as f64 / values.len() as f64;
            print!(
                " | {} {low:.2} (n {} α {:.1} gap {:.1}) … {high:.2} (n {} α {:.1} gap {:.1}), in 0.7…1.8 {:3.0} %, ratio {:.1}",
                ["sup", "mean"][which],
                at.elements,
                at.ratio,
                at.gap,
                there.elements,
                there.ratio,
                there.gap,
                100.0 * share,
                high / low
            );
        }
        println!();
    }
}

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let full = arguments.next().is_some_and(|a| a == "full");
    let after_impact = arguments.next().map_or(Ok(study::AFTER_IMPACT), |a| a.parse())?;
    let mut gaps: Vec<f64> = arguments.map(|a| a.parse()).collect::<Result<_, _>>()?;
    if gaps.is_empty() {
        gaps = [0.1, 0.3, 0.5, 0.7, 0.9].map(|fraction| 1.0 + fraction).to_vec();
    }
    let elements: &[usize] = if full { &[10, 20, 40, 80, 120, 160, 240, 320, 400] } else { &[10, 20, 40, 80] };
    let ratios: &[f64] = if full { &[0.5, 0.6, 0.7, 0.8, 0.9, 1.0] } else { &[0.5, 0.7, 0.9, 1.0] };
    let mut settings = Vec::new();
    for &elements in elements {
        for &ratio in ratios {
            settings.extend(gaps.iter().map(|&gap| Setting { elements, ratio, gap, after_impact }));
        }
    }
    let start = std::time::Instant::now();
    // The longest first.
    settings.reverse();
    let outcomes = parallel::in_order("bar", 2, &settings, &mut Unobserved, |s, stop| s.run(&choices(), stop))?;
    print(&format!("T = t_c + {after_impact} L/c"), &settings, &outcomes.unwrap_or_default());
    println!("{:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}
