//! A column without lateral contraction that drops on a plane, against the exact bar.

use super::{Run, random_box};
use crate::properties::estimating::assert_admissible;
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::material::Elastic;
use percute_core::problem::{Initial, Problem};

const SIZE: [f64; 3] = [0.01, 0.01, 0.05];
const SPEED: f64 = 20.0;

/// The prototypes of the method have 0.90 to 1.03 on such meshes; fronts are steep.
#[test]
fn column() {
    for cells in [2, 3] {
        let mesh = random_box(SIZE, [cells, cells, 5 * cells], 0.15, 1);
        let law = Elastic::solid(70e9, 0.0, 2700.0).unwrap();
        let free = Problem::<3>::builder(mesh.clone()).material(law).build().unwrap();
        let gap = 1.3 * 0.9 * critical_time_step(&free) * SPEED;
        let problem = Problem::<3>::builder(mesh)
            .material(law)
            .initial_velocity(Initial::Uniform([0.0, 0.0, -SPEED]))
            .obstacle(Obstacle::plane([0.0, 0.0, -gap], [0.0, 0.0, 1.0], 0.0, None).unwrap())
            .build()
            .unwrap();
        let (wave, start) = ((70e9_f64 / 2700.0).sqrt(), gap / SPEED);
        let end = start + 2.4 * SIZE[2] / wave;
        let exact = |p: [f64; 3], t: f64| {
            let way = wave * (t - start);
            let front = if way <= SIZE[2] { way } else { 2.0 * SIZE[2] - way };
            let pressed = way > 0.0 && front > 0.0 && p[2] < front;
            let speed = if way <= SIZE[2] { -SPEED } else { SPEED };
            let stress = if pressed { -2700.0 * wave * SPEED } else { 0.0 };
            let mut tensor = [[0.0; 3]; 3];
            tensor[2][2] = stress;
            (tensor, [0.0, 0.0, if pressed { 0.0 } else { speed }])
        };
        let run = Run::new(&problem, (end, 0.9), 40, &exact);
        assert_admissible("column", &run.estimate);
        let index = run.effectivity();
        assert!(index.iter().all(|index| (0.9..1.15).contains(index)), "{cells}: {index:?}");
    }
}
