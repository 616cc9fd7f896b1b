//! A bar or a plane problem, found out at run time.

/// An object in 1D or 2D, such as a mesh, a problem or a file that contains one of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByDimension<B, P> {
    /// Of a bar: 1D.
    Bar(B),
    /// Of a plane body: 2D.
    Plane(P),
}

/// Does the same with a [`ByDimension`](crate::simplex::ByDimension) in each dimension:
/// `each_dimension!(any, it => it.count())`.
#[macro_export]
macro_rules! each_dimension {
    ($any:expr, $it:pat => $body:expr) => {
        match $any {
            $crate::simplex::ByDimension::Bar($it) => $body,
            $crate::simplex::ByDimension::Plane($it) => $body,
        }
    };
}

/// The same, with a [`ByDimension`](crate::simplex::ByDimension) as its result.
#[macro_export]
macro_rules! map_dimension {
    ($any:expr, $it:pat => $body:expr) => {
        match $any {
            $crate::simplex::ByDimension::Bar($it) => $crate::simplex::ByDimension::Bar($body),
            $crate::simplex::ByDimension::Plane($it) => $crate::simplex::ByDimension::Plane($body),
        }
    };
}
