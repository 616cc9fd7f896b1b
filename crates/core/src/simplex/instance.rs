//! Code that is compiled once for each element.

use std::any::Any;

/// Of two objects, one for each element, that of this type. An object has functions for one element, which are compiled
/// in the crate of the object. Generic code of other crates calls them through it. Otherwise optimised builds compile
/// generic functions anew in each crate.
///
/// # Panics
/// If neither has this type: there are no other elements.
#[must_use]
pub fn instance<T: Any>(bar: &'static dyn Any, triangle: &'static dyn Any) -> &'static T {
    let mut both = [bar, triangle].into_iter();
    let Some(found) = both.find_map(|object| object.downcast_ref()) else { unreachable!("an element of neither kind") };
    found
}
