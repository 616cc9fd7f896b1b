//! Keys of other programs for what percute does not have, and what to do instead.

/// What to say of a key in a table, if percute has nothing of the kind.
pub(super) fn absent(key: &str, table: &str) -> Option<&'static str> {
    let of_obstacle = table.starts_with("[[obstacle]]") || table.starts_with("[obstacle]");
    Some(match key {
        "damping" | "viscosity" | "bulk_viscosity" | "rayleigh" => {
            "percute has no damping: only contact, friction and supports take energy, and the estimate has the rest; \
             leave it out"
        }
        "hardening_modulus" | "tangent_modulus" | "plasticity" | "ultimate_stress" => {
            "a material yields with a `yield_stress` (Pa) and linear hardening: `tangent` (Pa), the slope of the \
             uniaxial curve beyond it, or `hardening` (Pa), its slope over the plastic strain"
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
