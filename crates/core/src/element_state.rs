//! Strain, stress and energies of the elements at an instant, from the motion of the nodes.

use crate::border::vectors;
use crate::ids::ElementId;
use crate::material::{Law, PointLaw, Tensor, VonMises, symmetric};
use crate::mesh::Mesh;
use crate::on_problem;
use crate::problem::{Problem, ProblemRef};

/// The state of a P1 element at an instant: strain and stress are constant in it. Components beyond the dimension are
/// 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementState {
    dimension: usize,
    /// ε, eq. \[5\], or the Green strain of a finite law.
    pub strain: Tensor<3>,
    /// σ_h (Pa), eq. \[9\]: force per present area.
    pub stress: Tensor<3>,
    /// σ_zz (Pa), 0 in plane stress and in a bar.
    pub stress_across: f64,
    /// ½∫σ:ε, or that of a finite law (J), over the element with its section or thickness. Of a material that yields
    /// ½∫σ:(ε − ε_p).
    pub strain_energy: f64,
    /// ε_p as xx, yy, zz and xy; 0 where the material does not yield.
    pub plastic_strain: [f64; 4],
    /// p = ∫√(⅔ ε̇_p:ε̇_p) dt.
    pub equivalent_plastic_strain: f64,
    /// ∫σ:ε̇_p dt over the element (J).
    pub plastic_work: f64,
}

impl ElementState {
    /// The state of an element for these displacements of all nodes (m) and internal variables of all elements, in
    /// rows; without internal variables that of a body that has not yielded.
    #[must_use]
    pub fn new<'p>(
        problem: impl Into<ProblemRef<'p>>,
        element: ElementId,
        displacement: &[f64],
        internal: &[f64],
    ) -> Self {
        fn of(problem: ProblemRef<'_>, element: ElementId, displacement: &[f64], internal: &[f64]) -> ElementState {
            on_problem!(problem, problem => ElementState::of(problem, element, vectors(displacement), internal))
        }
        of(problem.into(), element, displacement, internal)
    }

    fn of<const D: usize>(
        problem: &Problem<D>,
        element: ElementId,
        displacement: &[[f64; D]],
        internal: &[f64],
    ) -> Self {
        let law = problem.material(element);
        let gradient = displacement_gradient(problem.mesh(), element, displacement);
        let count = problem.variables();
        if law.hardening().is_some() && !internal.is_empty() {
            let variables = &internal[count * element.index()..][..count];
            return Self::of_yielding(&VonMises::new(law), problem.volume(element), &gradient, variables);
        }
        Self {
            dimension: D,
            plastic_strain: [0.0; 4],
            equivalent_plastic_strain: 0.0,
            plastic_work: 0.0,
            strain: in_space::<D>(&law.strain(&gradient)),
            stress: in_space(&law.stress(&gradient)),
            stress_across: law.stress_across(&gradient),
            strain_energy: problem.volume(element) * law.strain_energy(&gradient),
        }
    }

    fn of_yielding<const D: usize>(law: &VonMises, volume: f64, gradient: &Tensor<D>, internal: &[f64]) -> Self {
        let state = law.state::<f64, D>(gradient, internal);
        let [stored, dissipated] = law.plastic_energies::<f64, D>(internal);
        Self {
            dimension: D,
            strain: in_space::<D>(&symmetric(gradient)),
            stress: in_space(&state.stress),
            stress_across: state.stress_across,
            strain_energy: volume * state.elastic_energy,
            plastic_strain: state.plastic_strain.0,
            equivalent_plastic_strain: state.equivalent,
            plastic_work: volume * (stored + dissipated),
        }
    }

    /// Von Mises stress (Pa): √(½((σ₁₁ − σ₂₂)² + (σ₂₂ − σ₃₃)² + (σ₃₃ − σ₁₁)²) + 3σ₁₂²), in a bar |σ|.
    #[must_use]
    pub fn von_mises(&self) -> f64 {
        let [a, b, c] = self.normal_stresses();
        let squares = (a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2);
        let shears = (0..3).flat_map(|i| (0..i).map(move |j| (i, j)));
        (0.5 * squares + 3.0 * shears.map(|(i, j)| self.stress[i][j].powi(2)).sum::<f64>()).sqrt()
    }

    /// The principal strain in the plane (a bar: ε) that is largest without its sign; of two equal ones, the
    /// elongation.
    #[must_use]
    pub fn principal_strain(&self) -> f64 {
        if self.dimension == 1 {
            return self.strain[0][0];
        }
        if self.dimension == 3 {
            let principal = principal_values(&self.strain);
            return if principal[0] + principal[2] < 0.0 { principal[0] } else { principal[2] };
        }
        let (xx, yy, xy) = (self.strain[0][0], self.strain[1][1], self.strain[0][1]);
        let (mean, radius) = (0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
        if mean < 0.0 { mean - radius } else { mean + radius }
    }

    /// Pressure −⅓ tr σ (Pa), positive in compression.
    #[must_use]
    pub fn pressure(&self) -> f64 {
        -self.normal_stresses().iter().sum::<f64>() / 3.0
    }

    /// σ₁₁, σ₂₂ and σ₃₃ (Pa).
    fn normal_stresses(&self) -> [f64; 3] {
        [self.stress[0][0], self.stress[1][1], self.stress_across]
    }
}

/// A tensor with three rows and columns.
/// The eigenvalues of a symmetric tensor, ascending.
#[must_use]
pub fn principal_values(tensor: &Tensor<3>) -> [f64; 3] {
    let mean = (tensor[0][0] + tensor[1][1] + tensor[2][2]) / 3.0;
    let deviator: Tensor<3> =
        std::array::from_fn(|a| std::array::from_fn(|b| tensor[a][b] - if a == b { mean } else { 0.0 }));
    let size = (deviator.iter().flatten().map(|x| x * x).sum::<f64>() / 6.0).sqrt();
    if size == 0.0 {
        return [mean; 3];
    }
    // Of s = deviator/size, det s = 2 cos 3θ.
    let s = deviator.map(|row| row.map(|x| x / size));
    let determinant = s[0][0] * (s[1][1] * s[2][2] - s[1][2] * s[2][1])
        - s[0][1] * (s[1][0] * s[2][2] - s[1][2] * s[2][0])
        + s[0][2] * (s[1][0] * s[2][1] - s[1][1] * s[2][0]);
    let angle = (0.5 * determinant).clamp(-1.0, 1.0).acos() / 3.0;
    let value = |k: f64| mean + 2.0 * size * (angle + k * std::f64::consts::TAU / 3.0).cos();
    [value(1.0), value(2.0), value(0.0)]
}

fn in_space<const D: usize>(tensor: &Tensor<D>) -> Tensor<3> {
    std::array::from_fn(|a| std::array::from_fn(|b| if a < D && b < D { tensor[a][b] } else { 0.0 }))
}

/// ∂u_a/∂x_b of an element for these displacements of all nodes (m).
#[must_use]
pub fn displacement_gradient<const D: usize>(mesh: &Mesh, element: ElementId, displacement: &[[f64; D]]) -> Tensor<D> {
    let (nodes, slopes) = (mesh.cell(element), mesh.gradients_in::<D>(element));
    let mut gradient = [[0.0; D]; D];
    // Against the first node: a translation of the body leaves no rounding.
    for k in 1..nodes.len() {
        for a in 0..D {
            let motion = displacement[nodes[k].index()][a] - displacement[nodes[0].index()][a];
            (0..D).for_each(|b| gradient[a][b] += motion * slopes[k][b]);
        }
    }
    gradient
}

/// First Piola–Kirchhoff stress P of an element (Pa), force per undeformed area, for these displacements of all nodes
/// (m) and internal variables of all elements, in rows. With small strains it is σ.
#[must_use]
pub fn first_piola_stress<'p>(
    problem: impl Into<ProblemRef<'p>>,
    element: ElementId,
    displacement: &[f64],
    internal: &[f64],
) -> Tensor<3> {
    fn of<const D: usize>(
        problem: &Problem<D>,
        element: ElementId,
        displacement: &[[f64; D]],
        internal: &[f64],
    ) -> Tensor<3> {
        if problem.yields() {
            return ElementState::of(problem, element, displacement, internal).stress;
        }
        let gradient = displacement_gradient(problem.mesh(), element, displacement);
        in_space(&problem.material(element).respond(&gradient, &mut []).0)
    }
    fn any(problem: ProblemRef<'_>, element: ElementId, displacement: &[f64], internal: &[f64]) -> Tensor<3> {
        on_problem!(problem, problem => of(problem, element, vectors(displacement), internal))
    }
    any(problem.into(), element, displacement, internal)
}

/// Principal stretches of an element in the plane, the larger one first, for these displacements of all nodes (m), in
/// rows: the roots of the eigenvalues of FᵀF. Of a bar the stretch, and 1.
#[must_use]
pub fn principal_stretches<'p>(
    problem: impl Into<ProblemRef<'p>>,
    element: ElementId,
    displacement: &[f64],
) -> [f64; 2] {
    fn of<const D: usize>(problem: &Problem<D>, element: ElementId, displacement: &[[f64; D]]) -> [f64; 2] {
        let gradient = displacement_gradient(problem.mesh(), element, displacement);
        if D == 1 { [(1.0 + gradient[0][0]).abs(), 1.0] } else { stretches(&gradient) }
    }
    fn any(problem: ProblemRef<'_>, element: ElementId, displacement: &[f64]) -> [f64; 2] {
        on_problem!(problem, problem => of(problem, element, vectors(displacement)))
    }
    any(problem.into(), element, displacement)
}

/// The principal stretches of a plane displacement gradient, the larger one first: the singular values of F are the sum
/// and the difference of the lengths of its parts that turn and mirror.
#[must_use]
pub fn stretches<const D: usize>(gradient: &Tensor<D>) -> [f64; 2] {
    let h = in_space(gradient);
    let turning = (2.0 + h[0][0] + h[1][1]).hypot(h[1][0] - h[0][1]);
    let mirroring = (h[0][0] - h[1][1]).hypot(h[1][0] + h[0][1]);
    [0.5 * (turning + mirroring), 0.5 * (turning - mirroring).abs()]
}

/// Kinetic energy of an element (J) for these velocities of all nodes (m/s), in rows, with its share of their lumped
/// masses, eq. \[35\].
#[must_use]
pub fn kinetic_energy<'p>(problem: impl Into<ProblemRef<'p>>, element: ElementId, velocity: &[f64]) -> f64 {
    fn of<const D: usize>(problem: &Problem<D>, element: ElementId, velocity: &[[f64; D]]) -> f64 {
        let nodes = problem.mesh().cell(element);
        let mass = problem.material(element).density() * problem.volume(element) / nodes.len() as f64;
        0.5 * mass * nodes.iter().flat_map(|node| velocity[node.index()]).map(|v| v * v).sum::<f64>()
    }
    fn any(problem: ProblemRef<'_>, element: ElementId, velocity: &[f64]) -> f64 {
        on_problem!(problem, problem => of(problem, element, vectors(velocity)))
    }
    any(problem.into(), element, velocity)
}
