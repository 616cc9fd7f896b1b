//! Reads contact results.

use crate::error::{FileCause, FileError};
use crate::estimate_file::maps::size;
use crate::kind::Kind;
use crate::read::{Part, reading};
use percute_core::border::{Vector, row};
use percute_core::contact::Status;
use percute_core::contact_results::{
    AveragedPeak, ContactPoint, ContactResults, ContactSteps, Nearest, NodeSummary, Resultant,
};
use percute_core::ids::NodeId;
use std::path::Path;

/// Arrays in which NaN stands for a missing value.
const MAY_BE_NONE: [&str; 3] = ["first_touch", "time_of_peak", "centre"];

/// Reads the contact results, if the file has any.
///
/// # Errors
/// As [`open`](crate::estimate_file::open).
pub fn contact(path: impl AsRef<Path>) -> Result<Option<ContactResults>, FileError> {
    reading(path.as_ref(), |opened| {
        opened.expect(Kind::Estimate)?;
        let root = opened.root();
        let ours = root.group("percute")?;
        let Some(part) = ours.optional_group("contact")? else { return Ok(None) };
        let [dimension, nodes, _] = size(&root.group("VTKHDF")?, &ours)?;
        Ok(Some(Reader { part: &part, dimension }.results(nodes)?))
    })
}

/// Reads the group written by [`write`].
struct Reader<'a, 'f> {
    part: &'a Part<'f>,
    dimension: usize,
}

impl<'f> Reader<'_, 'f> {
    /// A part of the group.
    fn of<'b>(&self, part: &'b Part<'f>) -> Reader<'b, 'f> {
        Reader { part, dimension: self.dimension }
    }

    fn results(&self, nodes: usize) -> Result<ContactResults, FileCause> {
        let node = self.part.data("node")?;
        node.expect_dimensions(1, "(contact nodes)")?;
        let (count, node) = (node.shape[0], node.indices(nodes, "nodes")?);
        let time = self.part.data("time")?;
        time.expect_dimensions(1, "(instants)")?;
        let instants = time.floats()?;
        let obstacles = self.part.group("obstacles")?;
        let mut of_obstacles = Vec::new();
        while let Some(part) = obstacles.optional_group(&of_obstacles.len().to_string())? {
            of_obstacles.push(self.of(&part).resultants(instants.len())?);
        }
        let steps = self.steps(instants.len(), count)?;
        let (nodes, summary) = (self.places(&node, of_obstacles.len())?, self.summary(count, &steps)?);
        Ok(ContactResults {
            dimension: self.dimension,
            slip: self.one("slip")?,
            penetration: self.one("penetration")?,
            at_surface_end: self.one("at_surface_end")? > 0.0,
            inclination: self.one("inclination")?,
            averaged_peak: self.averaged_peak(count)?,
            nearest: Nearest::of_steps(&instants, &nodes, &summary, &steps),
            nodes,
            summary,
            total: self.of(&self.part.group("total")?).resultants(instants.len())?,
            obstacles: of_obstacles,
            steps: Some(steps),
            instants,
        })
    }

    /// The largest averaged force; none without force, and in files of earlier versions.
    fn averaged_peak(&self, nodes: usize) -> Result<Option<AveragedPeak>, FileCause> {
        let [force, time, pressure, at] = [
            "averaged_peak_force",
            "time_of_averaged_peak",
            "averaged_peak_pressure",
            "place_of_averaged_peak_pressure",
        ]
        .map(|name| self.one(name));
        let (force, time, pressure, at) = (force?, time?, pressure?, at? as usize);
        Ok((force > 0.0 && at < nodes).then_some(AveragedPeak { force, time, pressure, at }))
    }

    /// A number that is left out where it is 0.
    fn one(&self, name: &str) -> Result<f64, FileCause> {
        let Some(number) = self.part.optional(name)? else { return Ok(0.0) };
        number.expect(&[1], "one number")?;
        Ok(number.floats()?[0])
    }

    fn places(&self, node: &[usize], obstacles: usize) -> Result<Vec<ContactPoint>, FileCause> {
        let obstacle = self.part.data("obstacle")?;
        obstacle.expect(&[node.len()], "one for each contact node")?;
        let obstacle = obstacle.indices(obstacles, "obstacles")?;
        let (point, normal) = (self.vectors("point", node.len())?, self.vectors("normal", node.len())?);
        let area = self.all("area", &[node.len()])?;
        let place = |k: usize| ContactPoint {
            node: NodeId::new(node[k]),
            obstacle: obstacle[k],
            point: point[k],
            normal: normal[k],
            area: area[k],
        };
        Ok((0..node.len()).map(place).collect())
    }

    fn summary(&self, count: usize, steps: &ContactSteps) -> Result<Vec<NodeSummary>, FileCause> {
        let column = |name: &str| self.all(name, &[count]);
        let (first, time, force) = (column("first_touch")?, column("time_in_contact")?, column("peak_normal_force")?);
        let (peak, pressure, impulse) =
            (column("time_of_peak")?, column("peak_pressure")?, self.vectors("impulse", count)?);
        let friction = &steps.friction_energy[steps.friction_energy.len().saturating_sub(count)..];
        let one = |k: usize| NodeSummary {
            first_touch: (!first[k].is_nan()).then_some(first[k]),
            time_in_contact: time[k],
            peak_normal_force: force[k],
            time_of_peak: (!peak[k].is_nan()).then_some(peak[k]),
            peak_pressure: pressure[k],
            impulse: impulse[k],
            friction_energy: friction.get(k).copied().unwrap_or_default(),
        };
        Ok((0..count).map(one).collect())
    }

    fn steps(&self, instants: usize, nodes: usize) -> Result<ContactSteps, FileCause> {
        let shape = [instants, nodes];
        let data = self.part.data("status")?;
        data.expect(&shape, "instants, contact nodes")?;
        let status = data.indices(3, "kinds of contact status")?;
        let status = status.into_iter().map(|s| [Status::Free, Status::Stick, Status::Slip][s]).collect();
        Ok(ContactSteps {
            force: self.all("force", &[instants, nodes, self.dimension])?,
            gap: self.all("gap", &shape)?,
            sliding_velocity: self.all("sliding_velocity", &[instants, nodes, self.dimension])?,
            status,
            friction_energy: self.all("friction_energy", &shape)?,
            area: match self.part.optional("area_over_time")? {
                Some(_) => self.all("area_over_time", &shape)?,
                None => Vec::new(),
            },
        })
    }

    fn resultants(&self, instants: usize) -> Result<Vec<Resultant>, FileCause> {
        let column = |name: &str| self.all(name, &[instants]);
        let field = |name: &str| self.vectors(name, instants);
        let count = |name: &str| -> Result<Vec<usize>, FileCause> {
            let data = self.part.data(name)?;
            data.expect(&[instants], "one for each instant")?;
            data.indices(usize::MAX, "nodes")
        };
        let (normal_force, area, friction_energy) =
            (column("normal_force")?, column("area")?, column("friction_energy")?);
        let (force, impulse, centre) = (field("force")?, field("impulse")?, field("centre")?);
        let (in_contact, slipping) = (count("in_contact")?, count("slipping")?);
        let one = |n: usize| Resultant {
            force: force[n],
            normal_force: normal_force[n],
            impulse: impulse[n],
            area: area[n],
            in_contact: in_contact[n],
            slipping: slipping[n],
            friction_energy: friction_energy[n],
            centre: (!centre[n].iter().any(|x| x.is_nan())).then_some(centre[n]),
        };
        Ok((0..instants).map(one).collect())
    }

    fn vectors(&self, name: &str, rows: usize) -> Result<Vec<Vector>, FileCause> {
        let values = self.all(name, &[rows, self.dimension])?;
        Ok((0..rows).map(|at| row(&values, at, self.dimension)).collect())
    }

    /// Numbers, all of them finite except where values may be missing. The gap of a node that faces nothing is
    /// infinite.
    fn all(&self, name: &str, shape: &[usize]) -> Result<Vec<f64>, FileCause> {
        let data = self.part.data(name)?;
        data.expect(shape, "as the other arrays of the group")?;
        let values = data.floats()?;
        let allowed = |x: &f64| {
            x.is_finite() || (x.is_nan() && MAY_BE_NONE.contains(&name)) || (*x == f64::INFINITY && name == "gap")
        };
        match values.iter().position(|x| !allowed(x)) {
            None => Ok(values),
            Some(at) => {
                let detail = format!("entry {at} is {}; it must be a finite number", values[at]);
                Err(FileCause::Value { name: data.name, detail })
            }
        }
    }
}
