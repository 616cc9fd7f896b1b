//! Nodal fields whose memory is used again.
//!
//! Each step needs a dozen fields for a short time. New memory from the operating system would cost more than the work
//! on it.

use crate::parallel::by_pieces;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, PoisonError};

/// Memory of fields that are no longer needed.
#[derive(Clone, Debug)]
pub(crate) struct FieldPool<const D: usize>(Arc<Inner<D>>);

#[derive(Debug)]
struct Inner<const D: usize> {
    nodes: usize,
    free: Mutex<Vec<Vec<[f64; D]>>>,
}

/// A vector at each node. Its memory goes back to its pool.
#[derive(Debug)]
pub(crate) struct NodalField<const D: usize> {
    values: Vec<[f64; D]>,
    pool: FieldPool<D>,
}

impl<const D: usize> FieldPool<D> {
    /// For fields on so many nodes.
    pub(crate) fn new(nodes: usize) -> Self {
        Self(Arc::new(Inner { nodes, free: Mutex::default() }))
    }

    /// A field whose values are those of an earlier one, or zero.
    pub(crate) fn take(&self) -> NodalField<D> {
        let free = self.0.free.lock().unwrap_or_else(PoisonError::into_inner).pop();
        NodalField { values: free.unwrap_or_else(|| vec![[0.0; D]; self.0.nodes]), pool: self.clone() }
    }

    /// A field with these values.
    pub(crate) fn copy(&self, values: &[[f64; D]]) -> NodalField<D> {
        let mut field = self.take();
        by_pieces((&mut field[..], values), &|_, (field, values)| field.copy_from_slice(values));
        field
    }

    /// A field of zeros.
    pub(crate) fn zeros(&self) -> NodalField<D> {
        let mut field = self.take();
        field.fill([0.0; D]);
        field
    }
}

impl<const D: usize> NodalField<D> {
    /// Another field on the same nodes, with any values.
    pub(crate) fn another(&self) -> Self {
        self.pool.take()
    }
}

impl<const D: usize> Deref for NodalField<D> {
    type Target = [[f64; D]];

    #[inline]
    fn deref(&self) -> &Self::Target {
        &self.values
    }
}

impl<const D: usize> DerefMut for NodalField<D> {
    #[inline]
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.values
    }
}

impl<const D: usize> Clone for NodalField<D> {
    fn clone(&self) -> Self {
        self.pool.copy(self)
    }
}

impl<const D: usize> Drop for NodalField<D> {
    fn drop(&mut self) {
        let values = std::mem::take(&mut self.values);
        self.pool.0.free.lock().unwrap_or_else(PoisonError::into_inner).push(values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field that is no longer needed gives its memory to the next one.
    #[test]
    fn memory_is_used_again() {
        let pool = FieldPool::<2>::new(3);
        let first = pool.copy(&[[1.0, 2.0]; 3]);
        let place = first.as_ptr();
        let copy = first.clone();
        drop(first);
        let second = pool.zeros();
        assert_eq!((second.as_ptr(), &second[..]), (place, &[[0.0; 2]; 3][..]));
        assert_eq!(copy[..], [[1.0, 2.0]; 3]);
    }
}
