//! Time of the integrator with finite laws and with plasticity over that with Hooke's law: `laws [ROUNDS]`.
//!
//! A block of aluminium vibrates in free flight, on one thread. All laws run in each round; median and range are those
//! of the ratios of all rounds.

#![allow(clippy::print_stdout, reason = "the ratios are its purpose")]

use percute_benches::{Block, Failure, Order, SIZES, processor, simulated};
use percute_core::dynamics::critical_time_step;
use percute_core::material::{Elastic, Hardening, HyperelasticLaw, Kinematics, Law};
use percute_core::problem::{Initial, Problem};

/// Element steps of a run.
const WORK: usize = 8_000_000;

/// Speed of the sides over the wave speed: strains of about a per cent.
const SPEED: f64 = 0.01;

/// Strain from which on the metal flows.
const YIELD_STRAIN: f64 = 0.004;

/// Time step over critical time step.
const COURANT: f64 = 0.9;

fn main() -> Result<(), Failure> {
    let rounds = std::env::args().nth(1).map_or(Ok(9), |count| count.parse())?;
    for cells in &SIZES[..2] {
        for (plane, make) in
            [("strain", Elastic::plane_strain as fn(_, _, _, _) -> _), ("stress", Elastic::plane_stress)]
        {
            let material = make(70e9, 0.3, 2700.0, 1.0)?;
            ratios(*cells, plane, material, rounds)?;
        }
    }
    Ok(())
}

/// Prints the ratios of all laws.
fn ratios(cells: [usize; 2], plane: &str, material: Elastic, rounds: usize) -> Result<(), Failure> {
    let finite = [
        ("neo_hookean", HyperelasticLaw::NeoHookean),
        ("svk", HyperelasticLaw::SaintVenantKirchhoff),
        ("hencky", HyperelasticLaw::Hencky),
    ];
    let small = block(cells, material)?;
    let mut laws = Vec::new();
    for (name, law) in finite {
        laws.push((name, block(cells, material.with_kinematics(Kinematics::Finite(law))?)?, Vec::new()));
    }
    let hardening = Hardening::of_tangent(material.young(), 0.1 * material.young(), 0.3)?;
    let metal = material.with_yield_stress(YIELD_STRAIN * material.young())?.with_hardening(hardening)?;
    laws.push(("von_mises", block(cells, metal)?, Vec::new()));
    let steps = WORK / small.elements();
    let time = |block: &Block| -> Result<f64, Failure> {
        Ok(simulated(block, steps, Some(1), processor)?.0.as_secs_f64() * 1e9 / (steps * block.elements()) as f64)
    };
    let mut alone = Vec::new();
    for _ in 0..rounds {
        let reference = time(&small)?;
        alone.push(reference);
        for (_, block, ratios) in &mut laws {
            ratios.push(time(block)? / reference);
        }
    }
    let [median, ..] = spread(&mut alone);
    println!("{} elements, plane {plane}: small strains {median:.1} ns per element and step", small.elements());
    for (name, _, ratios) in &mut laws {
        let [median, least, most] = spread(ratios);
        println!("  {name:<12} {median:5.2} times as long ({least:.2} to {most:.2})");
    }
    Ok(())
}

/// Median, least and largest.
fn spread(values: &mut [f64]) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [values[values.len() / 2], values[0], values[values.len() - 1]]
}

/// The block with another material, numbered for locality as every run numbers it.
fn block(cells: [usize; 2], material: Elastic) -> Result<Block, Failure> {
    let mesh = Order::Structured.mesh(cells)?;
    let speed = SPEED * material.wave_speed();
    let stretch = |p: &[f64; 2]| [speed * (p[0] / 0.025 - 1.0), speed * (1.0 - p[1] / 0.02)];
    let velocity = Initial::Nodal(mesh.points_in::<2>().iter().map(stretch).collect());
    let problem = Problem::<2>::builder(mesh).material(material).initial_velocity(velocity).build()?;
    let small = material.with_kinematics(Kinematics::Small)?;
    let at_rest = Problem::<2>::builder(problem.mesh().clone()).material(small).build()?;
    let step = COURANT * critical_time_step(&at_rest);
    let problem = problem.mesh().local_numbering().map_or_else(|| problem.clone(), |order| problem.renumbered(&order));
    Ok(Block { problem, step, gap: 0.0 })
}
