//! The order in which a pass needs and leaves the nodes of a strip.

/// Nodes are handled so many at a time, the numbers of a cache line.
const GRAIN: u32 = 8;

/// The nodes of a chunk among those of its strip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    /// No node of this chunk or of those before it in the strip has this number or a higher one.
    pub(crate) reached: u32,
    /// No node of a later chunk of the strip has a lower number.
    pub(crate) left: u32,
}

impl Reach {
    /// That of a chunk alone: behind its highest node, and its lowest.
    pub(super) fn of(nodes: impl Iterator<Item = u32>) -> Self {
        let alone = Self { reached: 0, left: u32::MAX };
        nodes.fold(alone, |all, node| Self { reached: all.reached.max(node + 1), left: all.left.min(node) })
    }

    /// Completes the chunks of a strip of so many nodes, each of which has that of its own.
    pub(super) fn close<'a>(chunks: impl DoubleEndedIterator<Item = &'a mut Self>, nodes: usize) {
        let (mut chunks, nodes) = (chunks.collect::<Vec<_>>(), nodes as u32);
        let mut reached = 0;
        for chunk in &mut chunks {
            reached = chunk.reached.next_multiple_of(GRAIN).min(nodes).max(reached);
            chunk.reached = reached;
        }
        // The last chunk is followed by no other: all nodes have been reached, and all are left.
        if let Some(last) = chunks.last_mut() {
            last.reached = nodes;
        }
        let mut left = nodes;
        for chunk in chunks.into_iter().rev() {
            let own = std::mem::replace(&mut chunk.left, if left < nodes { left - left % GRAIN } else { left });
            left = left.min(own);
        }
    }
}
