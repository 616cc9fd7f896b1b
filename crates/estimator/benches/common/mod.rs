//! The cases of all criterion benches.

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput};
use percute_benches::{Block, Motion, Order, SIZES};
use std::cell::LazyCell;
use std::time::Duration;

/// A block that is made when a bench asks for it: those that a filter leaves out cost nothing.
pub(crate) type Case = LazyCell<Block, Box<dyn FnOnce() -> Block>>;

/// Hands all sizes and orders to `bench`, each with its name, such as `40960/shuffled`.
pub(crate) fn each_case(criterion: &mut Criterion, bench: impl Fn(&mut BenchmarkGroup<'_, WallTime>, &str, &Case)) {
    for cells in SIZES {
        for order in Order::ALL {
            let elements = 2 * cells[0] * cells[1];
            let case: Case =
                LazyCell::new(Box::new(move || Block::new(cells, order, Motion::Impact).expect("a valid block")));
            let mut group = criterion.benchmark_group("per element");
            group.throughput(Throughput::Elements(elements as u64)).sample_size(10);
            group.warm_up_time(Duration::from_secs(1));
            bench(&mut group, &format!("{elements}/{}", order.name()), &case);
            group.finish();
        }
    }
}
