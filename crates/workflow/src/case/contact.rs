//! `[[contact]]`: bodies, or surfaces of them, that may touch.

use super::source::CaseError;
use super::table::Table;
use super::value::Value;
use percute_core::contact::ObstacleError;
use percute_core::problem::{Between, Contact};

const GROUPS: &str = "the groups of edges of two bodies that may touch, such as [\"anvil.top\", \"hammer.bottom\"]";
const BODIES: &str = "the names of two bodies that may touch, such as [\"anvil\", \"hammer\"]";

/// What is wrong with the contact of all bodies of a mesh that has one only.
pub const ONE_BODY: &str = "is the contact of bodies with each other, but there is one body only, so that nothing can \
                            touch; give the other bodies, or leave it out: a rigid plane is an obstacle";

/// Reads all contacts on a mesh of so many parts.
pub(super) fn read(root: &Table<'_>, dimension: usize, parts: usize) -> Result<Vec<Contact>, CaseError> {
    root.tables("contact")?.iter().map(|table| one(table, dimension, parts)).collect()
}

fn one(table: &Table<'_>, dimension: usize, parts: usize) -> Result<Contact, CaseError> {
    table.only()?;
    let between = match (table.get("bodies"), table.get("groups")) {
        (Some(_), Some(groups)) => {
            return Err(groups.error("cannot be given together with `bodies`; leave one of the two out"));
        }
        (Some(bodies), None) => Between::Bodies(two(&bodies, BODIES)?),
        (None, Some(groups)) => Between::Groups(two(&groups, GROUPS)?),
        (None, None) if parts < 2 => return Err(table.error(ONE_BODY)),
        (None, None) => Between::All,
    };
    let friction = super::obstacle::friction(table, dimension)?;
    let matching = table.get("matching").map(|value| value.flag()).transpose()?;
    Contact::new(dimension, between, friction, matching).map_err(|error| {
        let key = match error {
            ObstacleError::Friction { .. } | ObstacleError::FrictionInOneDimension { .. } => "friction",
            ObstacleError::Normal { .. } | ObstacleError::Point { .. } | ObstacleError::Gap { .. } => "groups",
        };
        table.get(key).map_or_else(|| table.error(error.to_string()), |value| value.error(error.to_string()))
    })
}

/// Two names.
fn two(value: &Value<'_>, needed: &str) -> Result<[String; 2], CaseError> {
    let names = value.list("two names")?;
    let [first, second] = names.as_slice() else { return Err(value.must_be(needed)) };
    let name = |value: &Value<'_>| value.text("a name").map(str::to_string);
    Ok([name(first)?, name(second)?])
}
