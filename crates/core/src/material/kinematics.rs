//! Which displacements a material is for, and the names of it in cases and in Python.

use super::HyperelasticLaw;

/// Which displacements a law is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kinematics {
    /// Small strains and rotations: σ of ε, eq. \[5\].
    #[default]
    Small,
    /// Any: P of F, by a hyperelastic law that is Hooke's at small strains.
    Finite(HyperelasticLaw),
}

/// The names of the laws.
const LAWS: [(&str, HyperelasticLaw); 3] = [
    ("neo_hookean", HyperelasticLaw::NeoHookean),
    ("svk", HyperelasticLaw::SaintVenantKirchhoff),
    ("hencky", HyperelasticLaw::Hencky),
];

impl Kinematics {
    /// The names of the two.
    pub const NAMES: [&'static str; 2] = ["small", "finite"];

    /// The names of the laws, the default first.
    #[must_use]
    pub fn law_names() -> [&'static str; 3] {
        LAWS.map(|(name, _)| name)
    }

    /// Of the names that are stated, if any.
    ///
    /// # Errors
    /// The key, `kinematics` or `law`, and what is wrong with it.
    pub fn from_names(kinematics: Option<&str>, law: Option<&str>) -> Result<Self, (&'static str, &'static str)> {
        let wanted = law.map(|name| LAWS.iter().find(|(known, _)| *known == name).map(|(_, law)| *law));
        let wanted = match wanted {
            Some(None) => return Err(("law", "must be \"neo_hookean\", \"svk\" or \"hencky\"")),
            Some(law) => law,
            None => None,
        };
        match (kinematics, wanted) {
            (Some("finite"), law) => Ok(Self::Finite(law.unwrap_or_default())),
            (None | Some("small"), None) => Ok(Self::Small),
            (None | Some("small"), Some(_)) => {
                Err(("law", "is one for kinematics = \"finite\": give this, or leave the law out"))
            }
            _ => Err(("kinematics", "must be \"small\" or \"finite\"")),
        }
    }

    /// The names of kinematics and law.
    #[must_use]
    pub fn names(self) -> (&'static str, Option<&'static str>) {
        let Self::Finite(law) = self else { return ("small", None) };
        ("finite", LAWS.iter().find(|(_, known)| *known == law).map(|(name, _)| *name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_come_back() {
        for name in Kinematics::law_names() {
            let finite = Kinematics::from_names(Some("finite"), Some(name)).unwrap();
            assert_eq!(finite.names(), ("finite", Some(name)));
        }
        assert_eq!(Kinematics::from_names(None, None).map(Kinematics::names), Ok(("small", None)));
        assert_eq!(Kinematics::from_names(Some("finite"), None), Ok(Kinematics::Finite(HyperelasticLaw::NeoHookean)));
        let key = |kinematics, law| Kinematics::from_names(kinematics, law).unwrap_err().0;
        assert_eq!([key(Some("large"), None), key(Some("finite"), Some("ogden"))], ["kinematics", "law"]);
        assert_eq!([key(None, Some("svk")), key(Some("small"), Some("svk"))], ["law"; 2]);
    }
}
