//! Time grids that cannot be.

use percute_core::time::{TimeError, TimeGrid};

#[test]
fn lengths_of_time_that_are_not_positive() {
    let error = TimeGrid::from_steps(&[1.0, 0.0]).unwrap_err();
    assert_eq!(error, TimeError::NotPositive { name: "steps[1]".to_string(), value: 0.0 });
    assert_eq!(
        TimeGrid::uniform(-1.0, 2).unwrap_err(),
        TimeError::NotPositive { name: "end".to_string(), value: -1.0 }
    );
    assert_eq!(TimeGrid::uniform(1.0, 0).unwrap_err(), TimeError::Empty);
    let error = TimeGrid::with_step(1.0, 1e-10).unwrap_err();
    let TimeError::TooMany { end, step, count } = error else { panic!("{error}") };
    // ceil(1e10 − 1e-6), whatever the rounding of the quotient.
    assert_eq!((end, step), (1.0, 1e-10));
    assert!((count - 1e10).abs() <= 1.0);
}

/// A step that the time does not feel would be Δt = 0 in the forces of contact.
#[test]
fn steps_lost_in_the_sum() {
    assert!(TimeGrid::from_steps(&[1.0, 1e-20]).is_err());
    assert!(TimeGrid::from_steps(&[1e308, 1e308]).is_err());
}
