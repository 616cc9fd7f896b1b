//! Whether memory can be had, asked before it is needed: Rust ends a process that gets none.

/// Whether so many bytes can be allocated now. Linux promises more than the machine has, but neither more than its
/// memory and swap together nor more than a limit of the process (`ulimit -v`).
#[must_use]
pub fn can_be_had(bytes: u64) -> bool {
    usize::try_from(bytes).is_ok_and(|bytes| Vec::<u8>::new().try_reserve_exact(bytes).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn little_can_be_had_and_too_much_cannot() {
        assert!(can_be_had(1 << 20));
        assert!(!can_be_had(1 << 60) && !can_be_had(u64::MAX));
    }
}
