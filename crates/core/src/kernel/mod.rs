//! Internal forces of the elements: the trait `Kernel` and one file for each formulation.
//!
//! A kernel cuts the elements of a strip into chunks. The pass moves the nodes that a chunk needs, sweeps its elements,
//! and sums up the nodes that no later chunk has.

mod elements;
mod internal;
mod linear;
mod pairs;
mod points;
mod reach;

pub(crate) use elements::ElementKernel;
pub use internal::InternalForces;
use linear::LinearKernel;
pub(crate) use points::PointKernel;
pub(crate) use reach::Reach;

use crate::material::{Elastic, VonMises};
use crate::mesh::Strips;
use crate::problem::Problem;
use crate::simd::{Eight, Registers, Task, run_task};

/// The internal forces of all elements, ∫σ_h ∇φ_i, by one formulation.
pub(crate) trait Kernel<const D: usize>: Sync {
    /// Elements of a strip that are swept together.
    type Chunk<'a>
    where
        Self: 'a;

    /// Elements that are worked on at the same time.
    fn strips(&self) -> &Strips;

    /// The chunks of a strip, each with the nodes that it needs.
    fn chunks(&self, strip: usize) -> impl Iterator<Item = (&Reach, Self::Chunk<'_>)>;

    /// Internal variables of an element.
    fn variables(&self) -> usize {
        0
    }

    /// Subtracts the internal forces of a chunk, adds twice its strain energy, and takes the internal variables to this
    /// instant, a row for each element. Nodes and elements are counted in the strip.
    fn sweep<L: Registers>(
        &self,
        lanes: L,
        chunk: &Self::Chunk<'_>,
        displacement: &[[f64; D]],
        internal: &mut [f64],
        force: &mut [[f64; D]],
        energy: &mut Eight,
    );

    /// Subtracts the internal forces of all elements from `force` (N), takes the internal variables to this instant,
    /// and returns the strain energy (J).
    fn subtract(&self, displacement: &[[f64; D]], internal: &mut [f64], force: &mut [[f64; D]]) -> f64
    where
        Self: Sized,
    {
        let strips = self.strips();
        let mut energies = vec![0.0; strips.count()];
        for parity in 0..2 {
            for strip in (parity..strips.count()).step_by(2) {
                let nodes = strips.nodes(strip);
                let (displacement, force) = (&displacement[nodes.clone()], &mut force[nodes]);
                let elements = strips.elements(strip);
                let internal = &mut internal[self.variables() * elements.start..self.variables() * elements.end];
                energies[strip] = run_task(StripSweep { kernel: self, strip, displacement, internal, force });
            }
        }
        0.5 * energies.iter().sum::<f64>()
    }
}

/// The kernel of a problem: that of linear laws is the fastest.
#[derive(Clone, Debug)]
pub(crate) enum ProblemKernel<const D: usize> {
    /// All laws are linear.
    Linear(LinearKernel),
    /// Those of bodies that may turn.
    Points(PointKernel<Elastic, D>),
    /// Some materials yield.
    Yielding(PointKernel<VonMises, D>),
    /// Those of solids.
    Solid(ElementKernel<Elastic, D>),
}

impl<const D: usize> ProblemKernel<D> {
    pub(crate) fn new(problem: &Problem<D>) -> Self {
        match (problem.is_finite(), problem.yields()) {
            _ if D == 3 => Self::linear(problem),
            (false, false) => Self::linear(problem),
            (true, _) => Self::Points(PointKernel::new(problem, |law| *law)),
            (false, true) => Self::Yielding(PointKernel::new(problem, VonMises::new)),
        }
    }

    /// The kernel of Hooke's law, whatever the materials are.
    pub(crate) fn linear(problem: &Problem<D>) -> Self {
        if D == 3 {
            Self::Solid(ElementKernel::new(problem, |law| *law))
        } else {
            Self::Linear(LinearKernel::new(problem))
        }
    }

    /// Subtracts the internal forces of all elements from `force` (N) and returns the strain energy (J); of materials
    /// that yield those of a body that had no strain before.
    pub(crate) fn subtract_from_rest(&self, displacement: &[[f64; D]], force: &mut [[f64; D]]) -> f64 {
        on_kernel!(self, kernel => {
            let variables = Kernel::<D>::variables(kernel) * Kernel::<D>::strips(kernel).element_count();
            kernel.subtract(displacement, &mut vec![0.0; variables], force)
        })
    }
}

/// Gives the kernel of a problem to an expression that takes any.
macro_rules! on_kernel {
    ($of:expr, $kernel:ident => $result:expr) => {
        match $of {
            $crate::kernel::ProblemKernel::Linear($kernel) => $result,
            $crate::kernel::ProblemKernel::Points($kernel) => $result,
            $crate::kernel::ProblemKernel::Yielding($kernel) => $result,
            $crate::kernel::ProblemKernel::Solid($kernel) => $result,
        }
    };
}
pub(crate) use on_kernel;

/// The sweep over one strip alone.
struct StripSweep<'a, K, const D: usize> {
    kernel: &'a K,
    strip: usize,
    displacement: &'a [[f64; D]],
    internal: &'a mut [f64],
    force: &'a mut [[f64; D]],
}

impl<K: Kernel<D>, const D: usize> Task for StripSweep<'_, K, D> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Registers>(self, lanes: L) -> f64 {
        let Self { kernel, strip, displacement, internal, force } = self;
        let mut energy = [0.0; 8];
        for (_, chunk) in kernel.chunks(strip) {
            kernel.sweep(lanes, &chunk, displacement, internal, force, &mut energy);
        }
        energy.iter().sum()
    }
}
