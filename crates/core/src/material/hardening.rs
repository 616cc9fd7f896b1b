//! The growth of the elastic range of a material that yields.

use super::{MaterialError, require};

/// The growth of the elastic range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hardening {
    /// H = H_i + C (Pa): the slope of the uniaxial stress over the plastic strain.
    modulus: f64,
    /// C/H.
    kinematic: f64,
}

impl Hardening {
    /// Of a modulus H (Pa) and the share of it that is kinematic.
    ///
    /// # Errors
    /// A modulus that is not positive, or a share outside of 0 to 1.
    pub fn new(modulus: f64, kinematic: f64) -> Result<Self, MaterialError> {
        require(modulus > 0.0, "hardening", modulus, "Pa", "positive")?;
        require((0.0..=1.0).contains(&kinematic), "kinematic", kinematic, "(no unit)", "from 0 to 1")?;
        Ok(Self { modulus, kinematic })
    }

    /// Of the slope E_t of the uniaxial stress over the strain (Pa): H = E E_t/(E − E_t).
    ///
    /// # Errors
    /// A slope that is not between 0 and Young's modulus (Pa), or a share outside of 0 to 1.
    pub fn of_tangent(young: f64, tangent: f64, kinematic: f64) -> Result<Self, MaterialError> {
        require(tangent > 0.0 && tangent < young, "tangent", tangent, "Pa", "above 0 and below `young`")?;
        Self::new(young * tangent / (young - tangent), kinematic)
    }

    /// Of the values that are stated beside a yield stress (Pa), if any: E_t or H (Pa), and the kinematic share, 0 by
    /// default.
    ///
    /// # Errors
    /// A value out of range, both moduli, or one value without those that it needs.
    pub fn stated(
        young: f64,
        yield_stress: Option<f64>,
        [tangent, hardening, kinematic]: [Option<f64>; 3],
    ) -> Result<Option<Self>, MaterialError> {
        let share = kinematic.unwrap_or(0.0);
        let made = match (tangent, hardening, kinematic) {
            (Some(tangent), Some(_), _) => {
                let allowed = "left out where `hardening` is given: H = E E_t/(E - E_t) follows from one of them";
                return Err(MaterialError { name: "tangent", value: tangent, unit: "Pa", allowed });
            }
            (None, None, Some(share)) => {
                let allowed = "given with `tangent` or `hardening` (Pa), of which it is a share";
                return Err(MaterialError { name: "kinematic", value: share, unit: "(no unit)", allowed });
            }
            (Some(tangent), None, _) => Self::of_tangent(young, tangent, share)?,
            (None, Some(modulus), _) => Self::new(modulus, share)?,
            (None, None, None) => return Ok(None),
        };
        let (name, value) =
            if let Some(tangent) = tangent { ("tangent", tangent) } else { ("hardening", made.modulus) };
        let allowed = "given with a `yield_stress` (Pa), from which on the material hardens";
        require(yield_stress.is_some(), name, value, "Pa", allowed)?;
        Ok(Some(made))
    }

    /// H (Pa).
    #[must_use]
    pub fn modulus(&self) -> f64 {
        self.modulus
    }

    /// The share of it that is kinematic, C/H.
    #[must_use]
    pub fn kinematic(&self) -> f64 {
        self.kinematic
    }

    /// E_t = E H/(E + H) of a material with this Young's modulus (Pa).
    #[must_use]
    pub fn tangent(&self, young: f64) -> f64 {
        young * self.modulus / (young + self.modulus)
    }
}
