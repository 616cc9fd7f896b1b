//! The common motion of two nodes that may touch.
//!
//! Across the interface it is that of their centre of mass, which no force between the two changes. The solution of
//! P_CA is their relative motion; each does its part of it, as under the force of least kinetic energy that would cause
//! the change: m'/(m + m'), with the mass m' of the other one.

use percute_core::problem::Problem;

/// The value of a nodal field, displacement or velocity, at a contact node without its part of the normal motion
/// against another body. At a rigid obstacle it is that of the node.
#[inline]
pub(crate) fn common<const D: usize>(problem: &Problem<D>, at: usize, field: &[[f64; D]]) -> [f64; D] {
    let surface = problem.surface();
    let contact = &surface.nodes()[at];
    let own = field[contact.node.index()];
    if contact.partner.is_none() {
        return own;
    }
    let frame = problem.obstacles()[contact.obstacle].flat_frame();
    let (relative, _) = frame.split(&surface.against_obstacle(at, field));
    let part = surface.own_part(at, problem.mass()) * relative;
    std::array::from_fn(|c| own[c] - part * frame.normal()[c])
}
