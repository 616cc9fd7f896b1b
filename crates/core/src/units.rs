//! Units of quantities that are proportional to the thickness of a plane body.

/// Whether they are those of the body, or per metre of thickness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Units {
    /// Per metre of thickness.
    pub per_metre: bool,
}

impl Units {
    /// A unit as it is here: that of a force, an impulse, an energy, its root, a mass or an area of contact may be per
    /// metre.
    #[must_use]
    pub fn of(self, unit: &str) -> &str {
        const PER_METRE: [(&str, &str); 10] = [
            ("N", "N/m"),
            ("N s", "N s/m"),
            ("J", "J/m"),
            ("J^½", "(J/m)^½"),
            ("J^(1/2)", "(J/m)^(1/2)"),
            ("J^0.5", "(J/m)^0.5"),
            ("kg", "kg/m"),
            ("m2", "m2/m"),
            ("m^2", "m^2/m"),
            ("m²", "m²/m"),
        ];
        let found = PER_METRE.iter().find(|(of_body, _)| self.per_metre && *of_body == unit);
        found.map_or(unit, |(_, per_metre)| per_metre)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stresses_and_lengths_are_the_same_per_metre() {
        let of = |per_metre: bool| ["N", "J^½", "Pa", "m", ""].map(|unit| Units { per_metre }.of(unit));
        assert_eq!(of(true), ["N/m", "(J/m)^½", "Pa", "m", ""]);
        assert_eq!(of(false), ["N", "J^½", "Pa", "m", ""]);
    }
}
