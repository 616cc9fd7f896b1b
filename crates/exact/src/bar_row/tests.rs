use super::*;
use crate::BarImpact;

/// c = 5000 m/s, Z = 4000 N s/m.
fn bar(start: f64, length: f64, velocity: f64) -> RowBar {
    RowBar { start, length, young: 2e11, density: 8000.0, section: 1e-4, velocity }
}

fn midpoints(bar: &RowBar, n: usize) -> impl Iterator<Item = f64> {
    let (start, length) = (bar.start, bar.length);
    (0..n).map(move |i| start + length * (i as f64 + 0.5) / n as f64)
}

/// Four bars of different lengths, materials and sections, which meet and part several times.
fn unlike() -> BarRow {
    let second = RowBar { young: 7e10, density: 2700.0, section: 3e-4, ..bar(0.2003, 0.13, 4.0) };
    let third = RowBar { young: 3e9, density: 1200.0, section: 2e-4, ..bar(0.3305, 0.05, 0.0) };
    let bars = [bar(0.0, 0.2, 10.0), second, third, bar(0.3806, 0.31, -7.0)];
    BarRow::new(&bars, 4e-4).unwrap()
}

/// Two equal bars at ±v with a gap of 2g: each one strikes the plane in the middle, of which [`BarImpact`] has a
/// formula of its own. Rounding of some products of 10 m/s and 1e-4 m.
#[test]
fn equal_bars_are_bars_on_a_plane() {
    let row = BarRow::new(&[bar(-0.301, 0.3, 10.0), bar(0.001, 0.3, -10.0)], 4e-4).unwrap();
    let plane = BarImpact { length: 0.3, young: 2e11, density: 8000.0, section: 1e-4, speed: 10.0, gap: 0.001 };
    assert!((row.contacts(0)[0][0] - plane.impact_time()).abs() < 1e-17);
    assert!((row.contacts(0)[0][1] - plane.release_time()).abs() < 1e-17 && row.contacts(0).len() == 1);
    for k in 0..400 {
        let t = (f64::from(k) + 0.37) * 1e-6;
        for x in midpoints(&bar(0.0, 0.3, 0.0), 13) {
            for (own, mirrored, sign) in [(1, 0.001 + x, 1.0), (0, -0.001 - x, -1.0)] {
                assert!((row.displacement(own, mirrored, t) - sign * plane.displacement(x, t)).abs() < 1e-17);
                assert!((row.velocity(own, mirrored, t) - sign * plane.velocity(x, t)).abs() < 1e-13);
                assert!((row.normal_force(own, mirrored, t) - plane.normal_force(x, t)).abs() < 1e-9);
            }
        }
    }
}

/// De Saint-Venant's results: a bar that strikes one twice as long comes to rest, and the other one leaves with half of
/// its velocity and a wave in it; of a bar that strikes an equal one at rest, all velocity passes on.
#[test]
fn known_rebounds() {
    for (length, at_rest) in [(0.2, 1.0), (0.4, 0.5)] {
        let row = BarRow::new(&[bar(0.0, 0.2, 10.0), bar(0.201, length, 0.0)], 4e-4).unwrap();
        // 1 mm at 10 m/s, and back and forth in the shorter bar.
        let [from, to] = row.contacts(0)[0];
        assert!((from - 1e-4).abs() < 1e-16 && (to - from - 8e-5).abs() < 1e-15, "{from} {to}");
        let mean = |b: usize| midpoints(&row.bars()[b], 1000).map(|x| row.velocity(b, x, 3e-4)).sum::<f64>() / 1000.0;
        // A front cuts a cell of the midpoint rule: 10 m/s over 1000 cells.
        assert!(mean(0).abs() < 0.01 && (mean(1) - 10.0 * at_rest).abs() < 0.01, "{} {}", mean(0), mean(1));
        assert!((row.contact_force(0, 1.4e-4) - 4000.0 * 5.0).abs() < 1e-8);
    }
}

/// Momentum and energy are kept, by midpoint sums of pieces that fronts cut: some 30 fronts in 4000 cells.
#[test]
fn momentum_and_energy_are_kept() {
    let row = unlike();
    let totals = |t: f64| {
        let [mut momentum, mut energy] = [0.0; 2];
        for (b, bar) in row.bars().iter().enumerate() {
            let mass = bar.density * bar.section * bar.length / 4000.0;
            for x in midpoints(bar, 4000) {
                let (v, n) = (row.velocity(b, x, t), row.normal_force(b, x, t));
                momentum += mass * v;
                energy += 0.5 * mass * v * v + 0.5 * bar.length / 4000.0 * n * n / (bar.young * bar.section);
            }
        }
        (momentum, energy)
    };
    let start = totals(0.0);
    for k in 1..=20 {
        let (momentum, energy) = totals(2e-5 * f64::from(k));
        assert!((momentum - start.0).abs() < 1e-3 * 1.6, "{momentum} {}", start.0);
        assert!((energy / start.1 - 1.0).abs() < 2e-3, "{energy} {}", start.1);
    }
}

/// The Signorini conditions at all interfaces at 20 000 instants, and free outer ends. Gaps are below 1 mm.
#[test]
fn contact_law() {
    let row = unlike();
    let mut pressed = [0; 3];
    for k in 0..20_000 {
        let t = (f64::from(k) + 0.37) * 2e-8;
        for (first, pair) in row.bars().windows(2).enumerate() {
            let left = pair[0].end() + row.displacement(first, pair[0].end(), t);
            let gap = pair[1].start + row.displacement(first + 1, pair[1].start, t) - left;
            let force = row.contact_force(first, t);
            let other = -row.normal_force(first + 1, pair[1].start, t);
            assert!((force - other).abs() < 1e-7, "opposite forces at {t}: {force} {other}");
            assert!(gap > -1e-15 && force > -1e-7, "gap {gap}, force {force} at {t}");
            assert!(gap < 1e-13 || force < 1e-7, "gap {gap}, force {force} at {t}");
            let within = row.contacts(first).iter().any(|[from, to]| (*from..*to).contains(&t));
            assert_eq!(within, force > 1e-7, "at {t}");
            pressed[first] += usize::from(within);
        }
        let last = row.bars().len() - 1;
        assert!(row.normal_force(0, 0.0, t).abs() < 1e-7);
        assert!(row.normal_force(last, row.bars()[last].end(), t).abs() < 1e-7);
    }
    assert!(pressed.iter().all(|&count| count > 500), "{pressed:?}");
}

/// Away from fronts, the slopes of the displacement in time and space are v and N/(ES): central differences of pieces
/// that are linear are exact but for rounding, 1e-16·1e-3/1e-9 s and /1e-7 m.
#[test]
fn fields_are_slopes() {
    let row = unlike();
    for t in [3.1e-5, 8.3e-5, 1.9e-4, 3.7e-4] {
        for (b, bar) in row.bars().iter().enumerate() {
            let fronts = row.fronts(b, t);
            let far = |x: &f64| fronts.iter().all(|front| (front - x).abs() > 1e-5);
            for x in midpoints(bar, 37).filter(far) {
                let (dt, dx) = (1e-9, 1e-7);
                let v = (row.displacement(b, x, t + dt) - row.displacement(b, x, t - dt)) / (2.0 * dt);
                assert!((v - row.velocity(b, x, t)).abs() < 1e-7, "v at {x}, {t}");
                let strain = (row.displacement(b, x + dx, t) - row.displacement(b, x - dx, t)) / (2.0 * dx);
                let force = bar.young * bar.section * strain;
                assert!((force - row.normal_force(b, x, t)).abs() < 1e-1, "N at {x}, {t}");
            }
        }
        // Fields jump at fronts and nowhere else.
        for (b, bar) in row.bars().iter().enumerate() {
            let mut edges = row.fronts(b, t);
            edges.insert(0, bar.start);
            edges.push(bar.end());
            for piece in edges.windows(2).filter(|piece| piece[1] - piece[0] > 1e-9) {
                let at = |s: f64| row.velocity(b, piece[0] + s * (piece[1] - piece[0]), t);
                assert!((at(0.01) - at(0.99)).abs() < 1e-10);
            }
        }
    }
}

/// Bars that touch from the start press from t = 0 on; bars at rest that touch do not.
#[test]
fn touching_from_the_start() {
    let row = BarRow::new(&[bar(0.0, 0.2, 10.0), bar(0.2, 0.2, 0.0), bar(0.4, 0.2, 0.0)], 1.5e-4).unwrap();
    assert_eq!(row.contacts(0)[0][0], 0.0);
    assert!((row.contacts(0)[0][1] - 8e-5).abs() < 1e-18);
    // The wave passes through the middle bar in 40 µs, and contact lasts as long as in the first interface.
    assert!((row.contacts(1)[0][0] - 4e-5).abs() < 1e-18 && (row.contacts(1)[0][1] - 1.2e-4).abs() < 1e-18);
    assert!((row.velocity(2, 0.5, 1.4e-4) - 10.0).abs() < 1e-12);
}

#[test]
fn bars_that_overlap_are_refused() {
    assert_eq!(BarRow::new(&[bar(0.0, 0.2, 10.0), bar(0.1, 0.2, 0.0)], 1.0), None);
    assert_eq!(BarRow::new(&[bar(0.0, -0.2, 10.0)], 1.0), None);
    assert_eq!(BarRow::new(&[], 1.0), None);
    assert_eq!(BarRow::new(&[bar(0.0, 0.2, 10.0)], f64::INFINITY), None);
}
