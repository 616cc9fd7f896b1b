//! The paper's figures 8 and 9: stress, and what each element has added to the error, at several instants.

use super::block::{Block, Impact};
use crate::reproduce::chart::{Colours, MeshMap, MeshMaps};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, Part, ReproduceError, Section, Tally, weight};
use percute_core::history::{SinkError, Step, StepSink};
use percute_core::ids::ElementId;
use percute_core::observer::Observer;
use percute_core::problem::TriangleProblem;
use percute_estimator::{Acceleration, Estimate, Estimator, Reconstruction, Request};
use percute_workflow::message::{percent, short};

pub(super) const PART: Part =
    Part { key: "stress-maps", title: "The paper's figures 8 and 9: stress and error, element by element", make };

/// The mesh: 640 elements.
const CELLS: [usize; 2] = [20, 16];
/// Source: Louf, Gallimard and Pelle, §7.2.2: relative errors of the run of their figures 8 and 9 (%), sup and mean.
const PAPER: [f64; 2] = [29.1, 23.8];
/// How many instants, without the start.
const INSTANTS: usize = 6;

fn make(effort: &Effort, observer: &mut dyn Observer) -> Result<Section, ReproduceError> {
    let block = Block::new(CELLS);
    let Impact { problem, times, .. } = block.impact()?;
    let mut request = Request::evenly(&times, INSTANTS + 1, 1);
    request.steps.remove(0);
    let weight = weight(&problem, &times) * Reconstruction::ALL.len() as f64;
    let tally = &mut Tally::new(PART.key, weight, observer);
    let mut estimators = Vec::new();
    for &reading in Reconstruction::ALL {
        let options = effort.options(reading, Acceleration::default());
        estimators.push(Estimator::new(&problem, &times, options)?.keeping(&request).map_err(ReproduceError::from)?);
    }
    let mut sink = Sink { estimators, steps: request.steps.clone(), displacements: Vec::new() };
    tally.simulate(weight, &problem, &times, &mut sink)?;
    let estimates = sink.estimators.into_iter().map(Estimator::finish).collect::<Result<Vec<_>, _>>()?;
    let instants: Vec<f64> = request.steps.iter().map(|&n| 1e6 * times.instants()[n]).collect();
    let drawn = Drawn { problem: &problem, instants, displacements: sink.displacements };
    let mut section = Section::new(PART.key, PART.title);
    introduce(&mut section, &block, &estimates);
    stress(&mut section, &drawn)?;
    error(&mut section, &drawn, &estimates)?;
    Ok(section)
}

/// Takes the steps to all estimators, and keeps the displacements of some.
struct Sink<'p> {
    estimators: Vec<Estimator<'p, 2, 3>>,
    steps: Vec<usize>,
    displacements: Vec<Vec<[f64; 2]>>,
}

impl StepSink<2> for Sink<'_> {
    fn push(&mut self, step: &Step<'_, 2>) -> Result<(), SinkError> {
        if self.steps.contains(&step.index) {
            self.displacements.push(step.displacement.to_vec());
        }
        self.estimators.iter_mut().try_for_each(|estimator| estimator.push(step))
    }
}

/// What the maps are drawn on.
struct Drawn<'p> {
    problem: &'p TriangleProblem,
    /// In µs.
    instants: Vec<f64>,
    displacements: Vec<Vec<[f64; 2]>>,
}

impl Drawn<'_> {
    /// A table with a row for each element and a column for each instant.
    fn table(&self, name: &str, caption: String, unit: &str, equation: &str) -> Table {
        let place = |name: &str| Column::new(name).unit("mm");
        let first = [Column::new("contact force"), Column::new("element"), place("x"), place("y")];
        let at = self.instants.iter().map(|t| Column::new(at(*t)).unit(unit).equation(equation));
        Table::new(name, caption, first.into_iter().chain(at).collect()).long()
    }

    /// Adds the values of all elements, instant by instant, under the name of what they belong to.
    fn fill(&self, table: &mut Table, of: &str, values: &[Vec<f64>]) {
        let mesh = self.problem.mesh();
        for e in 0..mesh.element_count() {
            let corners = mesh.cell_points(ElementId::new(e));
            let centre = [0, 1].map(|c| Cell::from(1e3 * corners.iter().map(|p| p[c]).sum::<f64>() / 3.0));
            let values = values.iter().map(|values| Cell::from(values[e]));
            table.push([Cell::from(of), Cell::from(e)].into_iter().chain(centre).chain(values));
        }
    }

    /// Maps of the values that the table has under this name.
    fn maps(&self, table: &Table, of: &str, colours: Colours) -> MeshMaps {
        let mesh = self.problem.mesh();
        let cells: Vec<_> = mesh.cells().iter().map(|cell| cell.map(|node| node.index())).collect();
        let maps = self.instants.iter().zip(&self.displacements).map(|(&t, u)| MeshMap {
            title: at(t),
            points: mesh.points().iter().zip(u).map(|(x, u)| [x[0] + u[0], x[1] + u[1]]).collect(),
            cells: cells.clone(),
            values: table.numbers(&at(t), &[("contact force", of.into())]),
        });
        let plane = self.problem.obstacles().first().map(|plane| [*plane.point(), *plane.normal()]);
        MeshMaps { maps: maps.collect(), columns: 3, colours, plane }
    }
}

/// An instant in words.
fn at(microseconds: f64) -> String {
    format!("t = {} µs", short(microseconds, 3))
}

fn introduce(section: &mut Section, block: &Block, estimates: &[Estimate<2>]) {
    let errors = Reconstruction::ALL.iter().zip(estimates).map(|(reading, estimate)| {
        let [sup, mean] = [estimate.error.relative_sup, estimate.error.relative_mean].map(percent);
        format!("{sup} and {mean} with `{reading}`")
    });
    section.text(format!(
        "The block of table 1 on {} squares cut in two, with the same assumptions. The paper does not say which mesh and \
         which instants its figures 8 and 9 show; its relative errors there, {} % (sup) and {} % (mean), belong to \
         another mesh or interval than those of its table 1. Here they are {}.",
        block.mesh(),
        PAPER[0],
        PAPER[1],
        errors.collect::<Vec<_>>().join(", "),
    ));
}

/// σ of von Mises in plane stress (Pa), constant in each element.
fn von_mises(problem: &TriangleProblem, displacement: &[[f64; 2]]) -> Vec<f64> {
    let mesh = problem.mesh();
    let one = |e: ElementId| {
        let geometry = mesh.cell_geometry(e);
        let mut gradient = [[0.0; 2]; 2];
        for (node, shape) in mesh.cells()[e.index()].iter().zip(&geometry.gradients) {
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                gradient[a][b] += displacement[node.index()][a] * shape[b];
            }
        }
        let [[xx, xy], [_, yy]] = problem.material(e).stress(&gradient);
        (xx * xx - xx * yy + yy * yy + 3.0 * xy * xy).sqrt()
    };
    (0..mesh.element_count()).map(|e| one(ElementId::new(e))).collect()
}

fn stress(section: &mut Section, drawn: &Drawn<'_>) -> Result<(), ReproduceError> {
    let values: Vec<Vec<f64>> = drawn
        .displacements
        .iter()
        .map(|u| von_mises(drawn.problem, u).into_iter().map(|stress| 1e-9 * stress).collect())
        .collect();
    let caption = "Von Mises stress of each element (by its centroid at the start) at each instant.".to_string();
    let mut table = drawn.table("stress-maps-von-mises", caption, "GPa", "[9]");
    drawn.fill(&mut table, "all", &values);
    let most = largest(&values);
    let colours = Colours::between("von Mises stress (GPa)", 0.0, most);
    let svg = drawn.maps(&table, "all", colours).svg()?;
    section.figure(
        "figure-8",
        svg,
        format!(
            "The paper's figure 8: von Mises stress of the finite-element solution at {} instants, from 0 to {} GPa in all \
             maps. The body is drawn where it is, at true scale; grey is the rigid plane. The compression wave runs up \
             from the plane, is reflected at the top and at the sides, and friction makes it lean.",
            drawn.instants.len(),
            short(most, 3),
        ),
    );
    section.table(table);
    Ok(())
}

fn error(section: &mut Section, drawn: &Drawn<'_>, estimates: &[Estimate<2>]) -> Result<(), ReproduceError> {
    let caption =
        "e_E accumulated from 0 to each instant, √((1/T)∫₀ᵗ η_E dt), of each element (by its centroid at the start).";
    let mut table = drawn.table("stress-maps-error", caption.to_string(), "J^½", "[20]");
    let mut summary = summary();
    let mut most: f64 = 0.0;
    for (reading, estimate) in Reconstruction::ALL.iter().zip(estimates) {
        let values: Vec<Vec<f64>> = estimate.maps.iter().map(|map| map.error(estimate.end)).collect();
        most = most.max(largest(&values));
        drawn.fill(&mut table, &reading.to_string(), &values);
        for (t, values) in drawn.instants.iter().zip(&values) {
            summary.push(summary_row(&reading.to_string(), *t, values));
        }
    }
    for reading in Reconstruction::ALL {
        let colours = Colours::ratio("accumulated e_E (J^½)", 0.01 * most, most);
        let svg = drawn.maps(&table, &reading.to_string(), colours).svg()?;
        let shares = summary.numbers("half of it in", &[("contact force", reading.to_string().into())]);
        let caption = format!(
            "The paper's figure 9, with the contact force `{reading}`: what each element has contributed to the mean error until \
             the instant, √((1/T)∫₀ᵗ η_E dt) [20] (J^½). The colours are logarithmic, from a hundredth of the largest value \
             on, and the same for all readings. The squares of the last map add up to e_mean²; half of that is in {} % of the \
             elements, along the plane and at its corners first.",
            short(shares.last().copied().unwrap_or(f64::NAN), 2),
        );
        section.figure(format!("figure-9-{reading}"), svg, caption);
    }
    section.table(summary);
    section.table(table);
    Ok(())
}

fn summary() -> Table {
    let columns = vec![
        Column::new("contact force"),
        Column::new("t").unit("µs"),
        Column::new("all elements").unit("J^½").equation("[20]"),
        Column::new("largest element").unit("J^½").equation("[20]"),
        Column::new("half of it in").unit("% of the elements").digits(3),
    ];
    let caption = "The accumulated error at the instants of the maps: of all elements together, the largest of one, and in how \
                   few elements half of its square is.";
    Table::new("stress-maps-summary", caption, columns)
}

fn summary_row(reading: &str, t: f64, values: &[f64]) -> [Cell; 5] {
    let mut squares: Vec<f64> = values.iter().map(|e| e * e).collect();
    squares.sort_by(|a, b| b.total_cmp(a));
    let all: f64 = squares.iter().sum();
    let mut part = 0.0;
    let few = squares.iter().take_while(|&&square| {
        part += square;
        part - square < 0.5 * all
    });
    let share = 100.0 * few.count() as f64 / values.len() as f64;
    [reading.into(), t.into(), all.sqrt().into(), squares.first().copied().map(f64::sqrt).into(), share.into()]
}

fn largest(values: &[Vec<f64>]) -> f64 {
    values.iter().flatten().copied().fold(0.0, f64::max)
}
