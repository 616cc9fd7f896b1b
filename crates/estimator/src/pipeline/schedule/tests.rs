use super::*;

/// The samples of a run with these steps, in each of which some nodes touch with a force (N), on a mesh so fine that
/// the spacing is limited by the number of steps.
fn sampled(every: Sampling, steps: &[(&[bool], f64)], requested: &[usize]) -> Vec<usize> {
    sampled_with(&Options { every, ..Options::default() }, steps, requested)
}

fn sampled_with(options: &Options, steps: &[(&[bool], f64)], requested: &[usize]) -> Vec<usize> {
    let last = steps.len() - 1;
    let mut schedule = Schedule::new(options, 10_000_000, last);
    schedule.request(requested);
    for (n, &(touching, force)) in steps.iter().enumerate() {
        schedule.advance(n, touching, force);
    }
    assert!(!schedule.finish(last));
    schedule.steps().to_vec()
}

/// The samples among the multiples of a number.
fn but_multiples(of: usize, steps: &[usize]) -> Vec<usize> {
    steps.iter().copied().filter(|n| n % of != 0).collect()
}

#[test]
fn a_number_samples_its_multiples_and_the_end() {
    let steps = [(&[false, true][..], 1.0); 12];
    assert_eq!(sampled(Sampling::Every(4), &steps, &[8]), [0, 4, 8, 11]);
    assert_eq!(sampled(Sampling::Every(20), &steps, &[]), [0, 11]);
}

#[test]
fn steps_around_onset_and_release_are_sampled() {
    let status = |n: usize| if (37..73).contains(&n) { &[true, false][..] } else { &[false, false] };
    let steps: Vec<_> = (0..=320).map(|n| (status(n), 0.0)).collect();
    let all = sampled(Sampling::Auto, &steps, &[123, 200]);
    assert_eq!(but_multiples(10, &all), [36, 37, 38, 72, 73, 74, 123]);
    assert_eq!(all.len(), 33 + 7);
}

#[test]
fn peaks_of_the_force_are_sampled_and_fluctuations_are_not() {
    let force = |n: usize| match n {
        0..=33 => n as f64,
        34..=101 => 33.0 - 0.2 * (n as f64 - 33.0) + 0.15 * f64::from(n.is_multiple_of(2)),
        102..=117 => 20.0 + (n as f64 - 102.0),
        _ => 0.0,
    };
    let steps: Vec<_> = (0..=320).map(|n| (&[true][..], force(n))).collect();
    assert_eq!(but_multiples(10, &sampled(Sampling::Auto, &steps, &[])), [33, 117]);
}

/// Of 64 nodes that touch one after the other, those count that are the first, or a quarter of all that touch since one
/// counted.
#[test]
fn nodes_among_many_count_together() {
    let status: Vec<Vec<bool>> = (0..=320).map(|n| (0..64).map(|k| n > 50 + 2 * k).collect()).collect();
    let steps: Vec<_> = status.iter().map(|touching| (&touching[..], 0.0)).collect();
    let counted: Vec<usize> = [1, 2, 3, 4, 6, 8, 11, 15, 20, 27, 36, 48, 64].map(|count| 49 + 2 * count).to_vec();
    let mut expected: Vec<usize> = counted.iter().flat_map(|n| [n - 1, *n, n + 1]).filter(|n| n % 10 != 0).collect();
    expected.dedup();
    assert_eq!(but_multiples(10, &sampled(Sampling::Auto, &steps, &[])), expected);
    // Each of them counts where F_DA begins with contact.
    let consistent = Options { reconstruction: Reconstruction::Consistent, ..Options::default() };
    let all: Vec<usize> = (50..=178).filter(|n| n % 10 != 0).collect();
    assert_eq!(but_multiples(10, &sampled_with(&consistent, &steps, &[])), all);
}

/// The samples up to a step are those of a run that is interrupted there, but for its end.
#[test]
fn later_steps_change_nothing_before_the_last_two() {
    let status = |n: usize| [n > 5 && n < 300, n > 20 && n % 50 > 10, n > 40];
    let force = |n: usize| (0.1 * n as f64).sin().abs();
    let mut whole = Schedule::new(&Options::default(), 10_000_000, 320);
    for n in 0..=320 {
        whole.advance(n, &status(n), force(n));
        let mut part = whole.clone();
        if part.finish(n) {
            assert_eq!(part.steps().last(), Some(&n));
        }
        let mut again = Schedule::new(&Options::default(), 10_000_000, 320);
        (0..=n).for_each(|k| {
            again.advance(k, &status(k), force(k));
        });
        assert_eq!(again.steps(), whole.steps(), "{n}");
    }
}
