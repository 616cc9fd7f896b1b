//! The few of many squares that hold most of their sum.

/// The share that is most of a sum.
pub(super) const MOST: f64 = 0.99;

/// The positions, ascending, of the fewest squares that hold this share of the sum, and their share; none of zeros.
pub(super) fn holding(squares: &[f64], share: f64) -> (Vec<usize>, f64) {
    let total: f64 = squares.iter().sum();
    let (mut sum, mut at) = (0.0, Vec::new());
    for position in descending(squares) {
        if sum >= share * total {
            break;
        }
        sum += squares[position];
        at.push(position);
    }
    at.sort_unstable();
    (at, if total > 0.0 { sum / total } else { 0.0 })
}

/// The positions of numbers, the largest first.
pub(super) fn descending(numbers: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    order.sort_by(|&a, &b| numbers[b].total_cmp(&numbers[a]));
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fewest_that_hold_most_are_found() {
        assert_eq!(holding(&[0.0, 90.0, 9.5, 0.5], MOST), (vec![1, 2], 0.995));
        assert_eq!(holding(&[1.0; 3], MOST), (vec![0, 1, 2], 1.0));
        assert_eq!(holding(&[0.0; 2], MOST), (Vec::new(), 0.0));
    }
}
