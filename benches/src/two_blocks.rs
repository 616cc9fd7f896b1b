//! Two blocks that strike each other: the cost of their contact.

use crate::block::{COURANT, material};
use crate::{Block, Failure};
use percute_core::contact::Interface;
use percute_core::dynamics::critical_time_step;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_testkit::translated;

/// Cells along and across each block: 41 000 elements in both, and 250 edges on either side of the interface.
const CELLS: [usize; 2] = [250, 41];
/// Those of an upper block whose nodes face none of the lower one.
const OTHER_CELLS: [usize; 2] = [249, 41];
/// Width and height of a block (m): its cells are squares.
const SIDES: [f64; 2] = [0.05, 0.0082];
/// Speed towards each other, and of the upper block along the interface (m/s).
const VELOCITY: [f64; 2] = [100.0, 20.0];

/// What the two blocks do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// They fly, and nothing looks for contact.
    None,
    /// They meet in the second step, in pairs of nodes.
    Pairs,
    /// The same, with non-matching interfaces; the nodes do not match.
    NonMatching,
}

impl Contact {
    /// All of them, with their names.
    pub const ALL: [(Self, &'static str); 3] =
        [(Self::None, "none"), (Self::Pairs, "pairs"), (Self::NonMatching, "non_matching")];
}

/// The two blocks. Those that slide have 164 elements less, of 41 000.
///
/// # Errors
/// None with these numbers.
pub fn two_blocks(contact: Contact) -> Result<Block, Failure> {
    let [width, height] = SIDES;
    let lower = Mesh::rectangle(width, height, CELLS[0], CELLS[1])?;
    let cells = if contact == Contact::NonMatching { OTHER_CELLS } else { CELLS };
    let upper = Mesh::rectangle(width, height, cells[0], cells[1])?;
    let at = |gap: f64| -> Result<Problem<2>, Failure> {
        let upper = translated(&upper, [0.0, height + gap])?;
        let mesh = Mesh::joined(&[("upper", &upper), ("lower", &lower)])?;
        let count = upper.node_count();
        let velocity = |i: usize| if i < count { [VELOCITY[0], -VELOCITY[1]] } else { [0.0, VELOCITY[1]] };
        let velocity = Initial::Nodal((0..mesh.node_count()).map(velocity).collect());
        let builder = Problem::<2>::builder(mesh).material(material()?).initial_velocity(velocity);
        let builder = match contact {
            Contact::None => builder,
            Contact::Pairs => builder.interface(Interface::matching(2, "upper.bottom", "lower.top", 0.2)?),
            Contact::NonMatching => builder.interface(Interface::non_matching(2, "upper.bottom", "lower.top", 0.2)?),
        };
        Ok(builder.build()?)
    };
    // The step does not depend on the gap.
    let step = COURANT * critical_time_step(&at(height)?);
    let gap = 1.5 * 2.0 * VELOCITY[1] * step;
    let given = at(gap)?;
    let problem = given.mesh().local_numbering().map_or_else(|| given.clone(), |order| given.renumbered(&order));
    Ok(Block { problem, step, gap })
}
