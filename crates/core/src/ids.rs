//! Typed indices: a node number cannot be taken for an element number.

use std::num::NonZeroU32;

/// Defines a 32-bit index type.
macro_rules! index {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        // Transparent, so that arrays of indices can be shown as arrays of numbers.
        #[repr(transparent)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(u32);

        impl $name {
            /// The index that stands for position `i`; meshes are checked to have fewer than 2³² entities.
            #[inline]
            #[must_use]
            pub const fn new(i: usize) -> Self {
                Self(i as u32)
            }

            /// The position this index stands for.
            #[inline]
            #[must_use]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

/// Defines a 32-bit index type whose `Option` takes no more room: it holds the number from 1.
macro_rules! compact_index {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(NonZeroU32);

        impl $name {
            /// The index that stands for position `i`; meshes are checked to have fewer than 2³² − 1 entities.
            #[inline]
            #[must_use]
            pub const fn new(i: usize) -> Self {
                match NonZeroU32::new((i as u32).wrapping_add(1)) {
                    Some(number) => Self(number),
                    None => Self(NonZeroU32::MAX),
                }
            }

            /// The position this index stands for.
            #[inline]
            #[must_use]
            pub const fn index(self) -> usize {
                (self.0.get() - 1) as usize
            }
        }

        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.debug_tuple(stringify!($name)).field(&self.index()).finish()
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.index().fmt(f)
            }
        }
    };
}

index!(
    /// A node of the mesh, numbered from 0.
    NodeId
);
compact_index!(
    /// An element of the mesh, numbered from 0.
    ElementId
);
compact_index!(
    /// A face of the mesh: an edge in 2D, a point in 1D.
    FaceId
);
