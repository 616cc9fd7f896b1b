//! A symmetric impact: all of it, and its right half.

use crate::image::{doubled, rotated, translated};
use percute_core::contact::{Interface, Obstacle};
use percute_core::load::{Support, Table};
use percute_core::material::Elastic;
use percute_core::mesh::{Mesh, MeshError};
use percute_core::problem::{Builder, Initial, Problem};
use std::error::Error;
use std::f64::consts::FRAC_PI_2;

/// Height of both bodies (m).
const HEIGHT: f64 = 0.025;
const FRICTION: f64 = 0.2;
/// The gap is the way in so long a time (s).
const WAY: f64 = 1e-6;

/// A roof of aluminium strikes a plate, with friction. Its ridge points down, or up where the angle is negative.
#[derive(Clone, Debug)]
pub struct Roof {
    /// The right halves of `roof` and `plate`, and both as a whole.
    halves: [Mesh; 2],
    whole: [Mesh; 2],
    speed: f64,
    along: f64,
    quarters: u8,
}

impl Roof {
    /// With an angle of its sides (°), a speed (m/s), half of the width of the plate (m), that of the roof being 20 mm,
    /// and cells along half of the roof and of the plate.
    ///
    /// # Errors
    /// None beyond those of the meshes.
    pub fn new(angle: f64, speed: f64, plate: f64, cells: [usize; 2]) -> Result<Self, MeshError> {
        let slope = angle.to_radians().tan();
        let roof = Mesh::rectangle(0.02, HEIGHT, cells[0], 4)?.mapped(|p: &[f64; 2]| [p[0], p[1] + slope * p[0]])?;
        let halves = [
            translated(&roof, [0.0, HEIGHT + WAY * speed - (0.02 * slope).min(0.0)])?,
            Mesh::rectangle(plate, HEIGHT, cells[1], 4)?,
        ];
        let whole = [doubled(&halves[0])?, doubled(&halves[1])?];
        Ok(Self { halves, whole, speed, along: 0.0, quarters: 0 })
    }

    /// The same in a frame in which all moves along the plate with this speed (m/s).
    #[must_use]
    pub fn moving(self, along: f64) -> Self {
        Self { along, ..self }
    }

    /// The same turned about the origin by so many right angles, with the rounding of a cosine.
    #[must_use]
    pub fn turned(self, quarters: u8) -> Self {
        Self { quarters, ..self }
    }

    /// All of it.
    ///
    /// # Errors
    /// None with an angle and cells that have meshes.
    pub fn whole(&self) -> Result<Builder<2>, Box<dyn Error>> {
        self.builder(&self.whole)
    }

    /// Its right half, held along the line of symmetry.
    ///
    /// # Errors
    /// As [`Roof::whole`].
    pub fn half(&self) -> Result<Builder<2>, Box<dyn Error>> {
        let velocity = (self.along != 0.0).then(|| Table::constant(self.turn([self.along, 0.0])));
        let held = |group: &str| Support { velocity: velocity.clone(), ..self.held(group) };
        Ok(self.builder(&self.halves)?.support(held("roof.left")).support(held("plate.left")))
    }

    /// The roof on a rigid plane instead of the plate: all of it, and its right half.
    ///
    /// # Errors
    /// As [`Roof::whole`].
    pub fn alone(&self) -> Result<[Builder<2>; 2], Box<dyn Error>> {
        let builder = |roof: &Mesh| -> Result<Builder<2>, Box<dyn Error>> {
            let [point, normal] = [[0.0, HEIGHT], [0.0, 1.0]].map(|vector| self.turn(vector));
            Ok(Problem::<2>::builder(self.mesh(roof)?)
                .material(aluminium()?)
                .initial_velocity(Initial::Uniform(self.turn([0.0, -self.speed])))
                .obstacle(Obstacle::plane(point, normal, FRICTION, Some("bottom".to_string()))?))
        };
        Ok([builder(&self.whole[0])?, builder(&self.halves[0])?.support(self.held("left"))])
    }

    /// The number in the whole of a node of the half.
    #[must_use]
    pub fn in_whole(&self, node: usize) -> usize {
        let [half, whole] = [&self.halves, &self.whole].map(|bodies| bodies[0].node_count());
        if node < half { node } else { node - half + whole }
    }

    fn builder(&self, [roof, plate]: &[Mesh; 2]) -> Result<Builder<2>, Box<dyn Error>> {
        let mesh = Mesh::joined(&[("roof", roof), ("plate", plate)])?;
        let velocity = |node: usize| self.turn([self.along, if node < roof.node_count() { -self.speed } else { 0.0 }]);
        let velocity = Initial::Nodal((0..mesh.node_count()).map(velocity).collect());
        Ok(Problem::<2>::builder(self.mesh(&mesh)?)
            .material(aluminium()?)
            .initial_velocity(velocity)
            .interface(Interface::non_matching(2, "roof.bottom", "plate.top", FRICTION)?))
    }

    fn mesh(&self, mesh: &Mesh) -> Result<Mesh, MeshError> {
        let angle = f64::from(self.quarters) * FRAC_PI_2;
        if self.quarters == 0 { Ok(mesh.clone()) } else { rotated(mesh, angle) }
    }

    fn turn(&self, vector: [f64; 2]) -> [f64; 2] {
        (0..self.quarters).fold(vector, |[x, y], _| [-y, x])
    }

    /// The support of a group on the line of symmetry.
    fn held(&self, group: &str) -> Support {
        let along = self.quarters.is_multiple_of(2);
        Support { group: group.to_string(), components: [along, !along, false], velocity: None }
    }
}

fn aluminium() -> Result<Elastic, Box<dyn Error>> {
    Ok(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0)?)
}
