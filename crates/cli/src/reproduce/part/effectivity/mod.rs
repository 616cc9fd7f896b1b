//! How good the estimate is in 2D: the estimated over the true error of impacts, against finer meshes.

pub(super) mod body;
pub(super) mod cases;
mod figure;
mod short_steps;
mod speeds;
pub(super) mod study;
mod tables;
mod touch;

use super::parallel::{in_order, threads};
use crate::reproduce::{Effort, Part, ReproduceError, Section};
use cases::{Kind, cases};
use figure::GOOD;
use percute_core::observer::Observer;
use percute_estimator::{Acceleration, Reconstruction};
use percute_workflow::message::{percent, short};
use study::STEP;

pub(super) const PART: Part =
    Part { key: "effectivity", title: "How good the estimate is in 2D, which the paper does not show", make };

fn make(effort: &Effort, observer: &mut dyn Observer) -> Result<Section, ReproduceError> {
    let cases = cases(effort);
    // The longest are begun first.
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by_key(|&k| cases[k].cost());
    let run = |&k: &usize, stop: &mut dyn Observer| cases[k].run(&study::readings(), stop);
    let mut found: Vec<_> =
        order.iter().zip(in_order(PART.key, threads(effort.threads), &order, observer, run)?).collect();
    found.sort_by_key(|(k, _)| **k);
    let results: Vec<tables::Result> = cases.iter().copied().zip(found.into_iter().map(|(_, found)| found)).collect();
    let effectivities = tables::effectivities(&results);
    let mut section = Section::new(PART.key, PART.title);
    introduce(&mut section);
    section.figure(
        "effectivity",
        figure::draw(&effectivities, &results)?,
        format!(
            "Effectivity e/e_ref (both axes logarithmic) over refinement, of the largest error ([15], above) and of the mean ([16], below), for \
             each reading of the contact force: one curve for each case, in the colour of its family; blocks on structured and unstructured meshes \
             share it. The band is from {} to {}. A curve that falls to the band and stays \
             there is what one wants; one that rises says that the estimate loses track as meshes become finer.",
            GOOD[0], GOOD[1],
        ),
    );
    // Both need all cases, meshes and references.
    if !effort.small {
        section.table(tables::kinds(&results));
        section.text(outside(&results));
        section.table(effectivities);
    }
    short_steps::add(&mut section, effort, observer)?;
    speeds::add(&mut section, effort, observer)?;
    section.heading("The cases, and whether the references are fine enough");
    section.table(tables::cases(&results));
    if !effort.small {
        section.text(settled(&results));
    }
    section.table(tables::references(&results));
    section.table(tables::runs(&results));
    Ok(section)
}

fn introduce(section: &mut Section) {
    section.text(format!(
        "Bodies of aluminium (E = 70 GPa, ν = 0.3, ρ = 2700 kg/m³) fly against a rigid plane; the estimates, with Γ_DA `{}`, are set against the \
         energy norm of the difference to a run on a much finer mesh, in which the mesh is nested: e_ref² = max or mean over the t_n of ½∫ρ|Δv|² + \
         ½∫Δε:K:Δε, exact in space, the reference being interpolated linearly between its instants. Runs take steps of {STEP} Δt_c, but for those with short steps further down, and end with the first \
         past T. The velocity is 400 m/s across the plane (normal), and for oblique impacts as much along it; a tilt turns plane and velocity clockwise \
         under the body.",
        Acceleration::default(),
    ));
    section.text(
        "The block is that of table 1, on 5×4 to 40×32 cells cut in two, or on unstructured triangles of 10 mm that are refined three times. The \
         rounded block has lower corners with a radius of 15 mm, and the disc one of 25 mm; on all meshes they are the same polygons, with edges \
         of 22.5° and 15°, so that edge after edge comes to touch: the contact zone of the disc grows and shrinks again before T.",
    );
}

/// Why a corner that touches alone is told too large, and what grows.
fn outside(results: &[tables::Result]) -> String {
    let r = Reconstruction::ALL.iter().position(|reading| *reading == Reconstruction::default()).unwrap_or(0);
    let corner = results.iter().filter(|(case, _)| case.kind() == Kind::Corner);
    let shares = corner.filter_map(|(_, found)| Some(found.last()?.as_ref()?.contact[r]));
    let least = shares.fold(f64::INFINITY, f64::min);
    format!(
        "Where a corner touches alone, the estimate of `{}` stays about twice too large. Its force is a density, linear \
         along the edges beside the corner, and those are off the plane: on mesh 4 at least {} of η, where it is largest, is \
         the energy gap·F_n of this and the work of what arrives. A point force would have no gap, but no stress of finite \
         energy balances it. With the curved bodies each edge that comes to touch is such a corner for some steps. {}",
        Reconstruction::default(),
        percent(least),
        growth(results, r),
    )
}

/// Which case grows most from mesh 2 to mesh 4, and why.
fn growth(results: &[tables::Result], r: usize) -> String {
    let grown = results.iter().filter_map(|(case, found)| {
        let at = |mesh: usize| found.get(mesh)?.as_ref();
        let growth = at(3)?.effectivity(r)[0] / at(1)?.effectivity(r)[0];
        let falls: Option<Vec<String>> =
            (1..4).map(|mesh| Some(short(at(mesh - 1)?.exact.last()?[0] / at(mesh)?.exact.last()?[0], 3))).collect();
        let contact = [at(1)?.contact[r], at(3)?.contact[r]];
        Some((growth, case.name(), *tables::moves(found).last()?, falls?, contact))
    });
    let Some((most, name, lack, falls, contact)) = grown.max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return String::new();
    };
    format!(
        "What grows most from mesh 2 to mesh 4 is the largest error for {name}: by {}, of which the references may lack {} (below). \
         Its part of contact falls faster than the rest, from {} of η to {}. The parts of inertia and stress hold the dispersion that has \
         added up and fall more slowly; so will the true error when little else is left of it: from mesh to mesh it falls by {} \
         as yet.",
        percent(most - 1.0),
        percent(lack),
        percent(contact[0]),
        percent(contact[1]),
        falls.join(", "),
    )
}

/// How far references agree, kind by kind.
fn settled(results: &[tables::Result]) -> String {
    let moved = Kind::ALL.into_iter().filter_map(|kind| {
        let own = results.iter().filter(|(case, _)| case.kind() == kind);
        let largest = own.filter_map(|(_, found)| tables::moves(found).first().copied()).reduce(f64::max)?;
        Some(format!("{} ({})", percent(largest), kind.name()))
    });
    let further = results.iter().filter_map(|(case, found)| match tables::moves(found).as_slice() {
        [first, second] => Some(format!(
            "For {}, a third reference moves it by another {} after {}. ",
            case.name(),
            percent(*second),
            percent(*first)
        )),
        _ => None,
    });
    format!(
        "From the first reference to the second, which has four times as many elements, the true error on mesh 4 moves by at most {}. {}\
         The true error itself falls by a factor of about {} from mesh to mesh for flat impacts, where fronts are discontinuous. What the last \
         reference still lacks is at most of the size of the last move: it makes effectivities on mesh 4 too large by that, and those on coarser \
         meshes by less.",
        moved.collect::<Vec<_>>().join(", "),
        further.collect::<String>(),
        short(fall(results), 2),
    )
}

/// The mean factor by which the largest true error of flat impacts falls from mesh to mesh.
fn fall(results: &[tables::Result]) -> f64 {
    let flat = results.iter().filter(|(case, _)| case.kind() == Kind::Flat);
    let ends = flat.filter_map(|(_, found)| {
        let sup = |found: &Option<study::Found>| found.as_ref()?.exact.last().map(|exact| exact[0]);
        Some((sup(found.first()?)? / sup(found.last()?)?).ln() / (found.len() - 1) as f64)
    });
    let logs: Vec<f64> = ends.collect();
    (logs.iter().sum::<f64>() / logs.len().max(1) as f64).exp()
}
