//! The forces on a non-matching interface are those of the same multipliers.

use super::balance::norm;
use percute_core::border::Vector;
use percute_core::problem::AnyProblem;

/// Sums of forces on a non-matching interface, against those of their multipliers: the largest of all instants.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct InterfaceBalance {
    /// The force on the slave beyond that of the multipliers (N): nodes that face nothing have none.
    lost: f64,
    /// The force on the master beyond the opposite one (N).
    one_sided: f64,
    /// The sum of the sizes of all forces (N).
    size: f64,
}

impl InterfaceBalance {
    /// Takes in an instant, with the forces on the nodes and those of the multipliers (N).
    pub(super) fn take(&mut self, [slave, master]: &[Vec<usize>; 2], reaction: &[Vector], forces: &[Vector]) {
        let total = |of: &[Vector], side: &[usize]| -> Vector {
            std::array::from_fn(|c| side.iter().map(|&at| of[at][c]).sum())
        };
        let (multipliers, on_slave, on_master) =
            (total(forces, slave), total(reaction, slave), total(reaction, master));
        let size: f64 = slave.iter().chain(master).map(|&at| norm(&reaction[at])).sum();
        let lost = norm(&std::array::from_fn::<_, 3, _>(|c| on_slave[c] - multipliers[c]));
        let one_sided = norm(&std::array::from_fn::<_, 3, _>(|c| on_master[c] + multipliers[c]));
        self.lost = self.lost.max(lost);
        self.one_sided = self.one_sided.max(one_sided);
        self.size = self.size.max(size);
    }

    /// The larger of both differences, over the sum of the sizes.
    pub(super) fn share(&self) -> f64 {
        super::ratio(self.lost.max(self.one_sided), self.size)
    }

    /// What is wrong with the forces on these surfaces.
    pub(super) fn cause(&self, problem: &AnyProblem, non_matching: usize) -> String {
        let [slave, master] = groups(problem, non_matching);
        if self.lost >= self.one_sided {
            return format!(
                "contact forces act on nodes of {slave} that do not face {master}: is the order of the rows that of \
                 `contact_nodes`?"
            );
        }
        format!(
            "the contact forces on {slave} and on {master} are not opposite: give the force on each node of both \
             surfaces, as it acts on that node"
        )
    }
}

/// The names of slave and master, for messages.
pub(super) fn groups(problem: &AnyProblem, non_matching: usize) -> [String; 2] {
    problem.sides_of_non_matching(non_matching).map(|side| {
        let obstacle = problem.obstacle(problem.contact_nodes()[side[0]].obstacle);
        format!("\"{}\"", obstacle.group().unwrap_or_default())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::foreign::window::vectors_of;
    use percute_core::contact::Interface;
    use percute_core::material::Elastic;
    use percute_core::mesh::Mesh;
    use percute_core::problem::Problem;
    use percute_testkit::translated;

    /// A block on another one, of which it covers a half.
    fn problem() -> Problem<2> {
        let lower = Mesh::rectangle(0.04, 0.025, 8, 2).unwrap();
        let upper = translated(&Mesh::rectangle(0.04, 0.025, 10, 2).unwrap(), [0.02, 0.026]).unwrap();
        let mesh = Mesh::joined(&[("lower", &lower), ("upper", &upper)]).unwrap();
        let material = Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap();
        let interface = Interface::non_matching(2, "lower.top", "upper.bottom", 0.2).unwrap();
        Problem::<2>::builder(mesh).material(material).interface(interface).build().unwrap()
    }

    /// The figure, and what is told, of multipliers of 3 N/m everywhere, after a change of the force on each node: with
    /// whether it has a condition, and whether it is on the slave.
    fn measured(change: impl Fn(&mut [f64; 2], bool, bool)) -> (f64, String) {
        let problem = problem();
        let surface = problem.surface();
        let (non_matching, still) = (&surface.non_matching()[0], vec![[0.0; 2]; problem.mesh().node_count()]);
        let (coupling, configuration) = (non_matching.coupling(surface, &still), surface.configuration(&still));
        let mut reaction = vec![[0.0; 2]; surface.nodes().len()];
        for k in (0..coupling.len()).filter(|&k| coupling.is_active(k)) {
            for (at, part) in coupling.slave_row(k).into_iter().enumerate().filter(|(_, part)| *part != 0.0) {
                reaction[non_matching.slave().position(k + at - 1)][1] += 3.0 * part;
            }
            let (first, row) = coupling.master_row(k);
            row.iter()
                .enumerate()
                .for_each(|(at, part)| reaction[non_matching.master().position(first + at)][1] -= 3.0 * part);
        }
        for (at, force) in reaction.iter_mut().enumerate() {
            change(force, configuration.has_condition(at), non_matching.slave().node_at(at).is_some());
        }
        let mut balance = InterfaceBalance::default();
        let forces = configuration.forces(&reaction);
        let [reaction, forces] = [&reaction, &forces].map(|all| vectors_of(all.as_flattened(), 2));
        let any = AnyProblem::from(problem.clone());
        balance.take(&any.sides_of_non_matching(0), &reaction, &forces);
        (balance.share(), balance.cause(&any, 0))
    }

    #[test]
    fn forces_of_multipliers_are_opposite() {
        // Rounding of a sum of ten forces.
        assert!(measured(|_, _, _| {}).0 < 1e-15);
        assert!(measured(|force, _, _| *force = force.map(|x| 7.0 * x)).0 < 1e-15);
    }

    #[test]
    fn a_side_without_forces_and_forces_that_face_nothing_are_told_of() {
        // Without one side, the sum of the other is all there is.
        for missing in [false, true] {
            let (share, told) = measured(|force, _, of_slave| {
                if of_slave == missing {
                    *force = [0.0; 2];
                }
            });
            assert!((share - 1.0).abs() < 1e-12 && told.contains("are not opposite"), "{share} {told}");
        }
        let (share, told) = measured(|force, acts, of_slave| {
            if of_slave && !acts {
                force[1] = 0.01;
            }
        });
        assert!(share > 0.1 && told.contains("that do not face \"lower.top\""), "{share} {told}");
    }
}
