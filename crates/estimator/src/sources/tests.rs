use super::*;

const MEAN: Sources = Sources { surface: 1.0, front: 2.0, dispersion: 4.0, mesh: 8.0 };

fn difference(kept: f64, halvings: f64) -> Difference {
    Difference { dispersion: 1.0, halved_elements: kept, halvings: [halvings, 1.0], ..Difference::default() }
}

/// Sources of a sample, from parts of which each has another digit.
#[test]
fn sources_add_up() {
    let near = NearParts { misfit: 300.0, front: 20.0 };
    let difference = Difference { energy: 500.0, near: 40.0, contact: 5.0, ..Difference::default() };
    let sources = Sources::new([1200.0, 70.0], &near, &difference);
    let expected = Sources { surface: 50.0 + 5.0 + 260.0, front: 20.0, dispersion: 495.0, mesh: 900.0 - 460.0 };
    assert_eq!((sources, sources.total()), (expected, 1270.0));
}

/// Smooth waves: dispersion of second order, h⁴ in energy, and interpolation of first order, h².
#[test]
fn smooth_waves() {
    let smooth = halved_elements(&Sources { front: 0.0, ..MEAN }, &difference(1.0 / 16.0, 0.0));
    assert_eq!((smooth.front, smooth.dispersion, smooth.mesh), (0.0, 0.25, 2.0));
    // A front that is small beside the misfit of the mesh brings few new waves.
    let [few, many] =
        [0.8, 80.0].map(|front| halved_elements(&Sources { front, ..MEAN }, &difference(1.0 / 16.0, 0.0)));
    assert!((few.mesh - 2.1).abs() < 1e-12 && many.mesh == 4.0, "{few:?}, {many:?}");
    assert!(few.dispersion < 0.7 && many.dispersion > 4.0, "{few:?}, {many:?}");
}

/// From nothing, ⅓ is left, from a force within a thousandth of an edge nearly all.
#[test]
fn forces_within_an_edge() {
    let [wide, some, narrow] = [0.0, 3.0, 10.0].map(|k| halved_elements(&MEAN, &difference(0.5, k)).surface);
    assert!((wide - FLAT).abs() < 1e-15 && wide < some && some < narrow && (0.8..0.9).contains(&narrow));
}

/// The energy of waves with the spectrum k⁻² to a largest k of 1, late by the phase k³t, integrated over time to t.
fn late(t: f64) -> f64 {
    const WAVES: usize = 2000;
    let wave = |n: usize| {
        let k = (n as f64 + 0.5) / WAVES as f64;
        let phase = k.powi(3) * t;
        // 4 sin²(φ/2) = 2 − 2 cos φ.
        (2.0 * t - 2.0 * phase.sin() / k.powi(3)) / (k * k)
    };
    (0..WAVES).map(wave).sum::<f64>() / WAVES as f64
}

/// The largest k is twice as large on elements half as long, and the phase at it as well; the energies are half as
/// large. With a quarter of the dispersion, the phase is that of a quarter of the time.
#[test]
fn the_dispersion_of_a_jump() {
    for exponent in 4..30 {
        let t = 1.25_f64.powi(exponent);
        let mean = |t: f64| late(t) / t;
        let kept = mean(0.25 * t) / mean(t);
        let expected = 0.5 * mean(2.0 * t) / mean(t);
        assert!((jump(kept) / expected - 1.0).abs() < 0.055, "{t}: {kept} gives {} for {expected}", jump(kept));
    }
}

/// Nothing is divided by nothing.
#[test]
fn no_error() {
    assert_eq!(halved_elements(&Sources::default(), &Difference::default()), Sources::default());
}
