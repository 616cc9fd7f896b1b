//! Keys of other programs for what percute does not have, and what to do instead.

/// What to say of a key in a table, if percute has nothing of the kind.
pub(super) fn absent(key: &str, table: &str) -> Option<&'static str> {
    let of_obstacle = table.starts_with("[[obstacle]]") || table.starts_with("[obstacle]");
    Some(match key {
        "damping" | "viscosity" | "bulk_viscosity" | "rayleigh" => {
            "percute has no damping: only contact, friction and supports take energy, and the estimate has the rest; \
             leave it out"
        }
        "hardening" | "hardening_modulus" | "tangent_modulus" | "plasticity" | "ultimate_stress" => {
            "percute has no plasticity: the law is linear; `yield_stress` (Pa) says where and when the stress is above \
             it; leave the rest out"
        }
        "velocity" if of_obstacle => {
            "planes do not move: subtract the velocity of the plane from that of the bodies, in [initial]; a plane \
             that is accelerated is a body with a [[support]]"
        }
        "circle" | "sphere" | "cylinder" | "radius" | "centre" | "center" | "rectangle" if of_obstacle => {
            "obstacles are planes: make another shape a stiff [[body]], held by a [[support]]"
        }
        "mass" if of_obstacle => "planes have no mass: make an impactor a [[body]]",
        "gravity" => {
            "`gravity` is a key of the whole case: write it above the first table, as in gravity = [0.0, -9.81]"
        }
        _ => return None,
    })
}
