//! Code that is compiled once for each element.

use std::any::Any;

/// An object for one element, which is known from a [`Shape`](super::Shape), with its type. It has functions for this
/// element, compiled in the crate of the object. Generic code of other crates calls them through it. Otherwise
/// optimised builds compile generic functions anew in each crate.
///
/// # Panics
/// If the object is that of another element.
#[must_use]
pub fn instance<T: Any>(object: &'static dyn Any) -> &'static T {
    let Some(typed) = object.downcast_ref() else { unreachable!("the object of another element") };
    typed
}
