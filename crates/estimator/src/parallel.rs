//! Work on the nodes of a mesh, piece by piece: on all threads of the pool around it, if there is one.
//!
//! Each number is made of those of its own node, so it does not depend on pieces or threads.

/// Nodes of a piece, at most: a loop over them takes some ten times as long as the start of a task.
const PIECE: usize = 8192;

/// Values at consecutive nodes.
pub(crate) trait Fields: Send + Sized {
    /// Number of nodes.
    fn len(&self) -> usize;

    /// Those of the nodes before a place and those from it on.
    fn cut(self, at: usize) -> (Self, Self);
}

impl<T: Sync> Fields for &[T] {
    fn len(&self) -> usize {
        <[T]>::len(self)
    }

    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at(at)
    }
}

impl<T: Send> Fields for &mut [T] {
    fn len(&self) -> usize {
        <[T]>::len(self)
    }

    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }
}

impl<A: Fields, B: Fields> Fields for (A, B) {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn cut(self, at: usize) -> (Self, Self) {
        let ((a, c), (b, d)) = (self.0.cut(at), self.1.cut(at));
        ((a, b), (c, d))
    }
}

impl<A: Fields, B: Fields, C: Fields> Fields for (A, B, C) {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn cut(self, at: usize) -> (Self, Self) {
        let ((a, d), (b, e), (c, f)) = (self.0.cut(at), self.1.cut(at), self.2.cut(at));
        ((a, b, c), (d, e, f))
    }
}

/// Hands out the fields of all nodes piece by piece, each with the number of its first node.
pub(crate) fn by_pieces<F: Fields>(fields: F, work: &(impl Fn(usize, F) + Sync)) {
    from(0, fields, work);
}

fn from<F: Fields>(first: usize, fields: F, work: &(impl Fn(usize, F) + Sync)) {
    // Without a pool, rayon would start one of its own, with threads that a forked process does not have.
    if fields.len() <= PIECE || rayon::current_thread_index().is_none() {
        return work(first, fields);
    }
    let middle = fields.len() / 2;
    let (before, after) = fields.cut(middle);
    rayon::join(|| from(first, before, work), || from(first + middle, after, work));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each node is handed out once, with its number, on any number of threads.
    #[test]
    fn pieces_are_all_nodes() {
        for threads in [None, Some(1), Some(3)] {
            let numbers: Vec<usize> = (0..3 * PIECE + 7).collect();
            let mut seen = vec![(0, 0); numbers.len()];
            let mut fill = || {
                by_pieces((&mut seen[..], &numbers[..]), &|first, (seen, numbers)| {
                    for (i, (seen, number)) in seen.iter_mut().zip(numbers).enumerate() {
                        *seen = (first + i, seen.1 + number);
                    }
                });
            };
            match threads {
                None => fill(),
                Some(threads) => rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(fill),
            }
            assert!(seen.iter().enumerate().all(|(i, seen)| *seen == (i, i)));
        }
    }
}
