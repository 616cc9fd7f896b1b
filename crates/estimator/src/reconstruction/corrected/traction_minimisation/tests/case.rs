//! A problem with all that the minimisation is compared with.

use super::super::chebyshev::Product;
use super::super::energy::moment_gradient;
use super::super::modes::MOMENTS;
use super::super::operator::Block;
use super::super::*;
use crate::element::elements;
use crate::stress::{Loading, TriangleStress};
use percute_core::cell::cell;
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;
use percute_testkit::{Random, random_rectangle};

/// Second derivative of the energy of an element in the moments on its edges.
type Form = [[f64; MOMENTS]; MOMENTS];

pub(super) fn problem_of(mesh: Mesh, material: Elastic) -> Problem<2> {
    held(mesh, material, [true; 2])
}

fn held(mesh: Mesh, material: Elastic, components: [bool; 2]) -> Problem<2> {
    Problem::<2>::builder(mesh)
        .material(material)
        .support(Support { group: "left".into(), components: [components[0], components[1], false], velocity: None })
        .build()
        .unwrap()
}

/// Blocks of random triangles whose left side is held, and is a line of symmetry.
pub(super) fn problems() -> [Problem<2>; 2] {
    let material = Elastic::plane_stress(70e9, 0.3, 2700.0, 0.3).unwrap();
    [true, false].map(|y| held(random_rectangle(0.05, 0.04, 4, 1).unwrap(), material, [true, y]))
}

/// The minimisation of a problem with all that tests compare it with.
pub(super) struct Case {
    pub(super) problem: Problem<2>,
    pub(super) elements: Vec<Element<2, 3>>,
    forms: Vec<Form>,
    pub(super) all: TractionMinimisation,
}

impl Case {
    pub(super) fn new(problem: Problem<2>) -> Self {
        let elements = elements(&problem);
        let form = |(e, element): (usize, &Element<2, 3>)| {
            let id = ElementId::new(e);
            let measure = ElementMeasure::new(&problem, element, id, Acceleration::Closest);
            let stress = TriangleStress::new(&problem.mesh().corners::<2, 3>(id), problem.material(id));
            std::array::from_fn(|i| {
                let mut moments = [[[0.0; 2]; 2]; 3];
                moments[i / 4][i / 2 % 2][i % 2] = 1.0;
                let loading = Loading { traction: measure.tractions(&moments), volume: [[0.0; 2]; 3] };
                moment_gradient(&stress.traction_slope(&loading))
            })
        };
        let forms = elements.iter().enumerate().map(form).collect();
        let all = TractionMinimisation::new(&problem, &elements).unwrap();
        Self { problem, elements, forms, all }
    }

    /// Which coefficients belong to modes: three of each node, then those of edges.
    pub(super) fn modes(&self) -> Vec<usize> {
        let Operator { node_scale, edge_scale, .. } = &self.all.operator;
        let nodes = node_scale.iter().flat_map(|scale| [0, 1, 2].map(|i| scale[i][i]));
        nodes.chain(edge_scale.iter().copied()).enumerate().filter(|(_, scale)| *scale > 0.0).map(|(m, _)| m).collect()
    }

    /// Modes of which these coefficients have values.
    pub(super) fn with(&self, places: &[usize], mut value: impl FnMut(usize) -> Lanes) -> Modes {
        let mut modes = Modes::new(&self.all.numbers);
        let mut all: Vec<_> = modes.nodes.as_flattened_mut().iter_mut().chain(&mut modes.edges).collect();
        places.iter().for_each(|&m| *all[m] = value(m));
        modes
    }

    pub(super) fn random_modes(&self, random: &mut Random) -> Modes {
        self.with(&self.modes(), |_| Lanes::at_levels(|_| random.between(-1.0, 1.0)))
    }

    /// The moments on the links of all stars that modes make.
    pub(super) fn on_links(&self, modes: &Modes) -> Vec<[Lanes; 2]> {
        let stars = self.problem.mesh().stars();
        let mut moments = vec![[Lanes::ZERO; 2]; stars.link_count()];
        for node in (0..self.problem.mesh().node_count()).map(NodeId::new) {
            let own = &mut moments[stars.link_range(node)];
            self.all.numbers.add_change(Lanes::ZERO, self.problem.mesh(), node, (modes, None), own);
        }
        moments
    }

    /// The moments on the edges of an element, outward.
    pub(super) fn of_element(&self, e: usize, links: &[[Lanes; 2]]) -> [Lanes; MOMENTS] {
        let crossing = cell::<2, 3>().faces_around();
        let mut moments = [Lanes::ZERO; MOMENTS];
        for i in 0..3 {
            let [enter, exit] = self.elements[e].links[i].map(|link| link.place());
            for (face, (link, sign)) in crossing[i].into_iter().zip([(enter, -1.0), (exit, 1.0)]) {
                let k = face.unwrap();
                // Node i is node (i − k − 1) mod 3 of face k.
                let first = 4 * k + 2 * ((i + 2 - k) % 3);
                (0..2).for_each(|c| moments[first + c] = links[link][c] * sign);
            }
        }
        moments
    }

    /// Slopes of all elements as a random quadratic energy has them at its start.
    pub(super) fn random_slopes(&self, random: &mut Random) -> Vec<[Lanes; MOMENTS]> {
        let mut moments = || std::array::from_fn(|_| Lanes::at_levels(|_| random.between(-1.0, 1.0)));
        self.forms.iter().map(|form| apply(form, &moments())).collect()
    }

    /// Their sum in the modes.
    pub(super) fn in_modes(&self, slopes: &[[Lanes; MOMENTS]]) -> Modes {
        let mut modes = Modes::new(&self.all.numbers);
        for (e, slope) in slopes.iter().enumerate() {
            self.all.numbers.add_slope::<_, 2, 3>(self.problem.mesh(), (e, slope), None, &mut modes.part());
        }
        modes
    }

    pub(super) fn change(&self, slopes: &[[Lanes; MOMENTS]]) -> Modes {
        let mut space = Workspace::new(&self.all.numbers);
        space.slopes = self.in_modes(slopes);
        self.all.minimise(&mut space, &StopFlag::default());
        space.change
    }

    /// ½cᵀHc + slope·c of a change c.
    pub(super) fn energy(&self, slopes: &[[Lanes; MOMENTS]], change: &Modes) -> Lanes {
        let links = self.on_links(change);
        let mut energy = Lanes::ZERO;
        for (e, (form, slope)) in self.forms.iter().zip(slopes).enumerate() {
            let moments = self.of_element(e, &links);
            let product = apply(form, &moments);
            (0..MOMENTS).for_each(|m| energy += moments[m] * (product[m] * 0.5 + slope[m]));
        }
        energy
    }

    pub(super) fn block(&self) -> Block {
        Block::new(&self.all.numbers, 0..self.all.numbers.nodes(), 0)
    }

    /// The product with the matrix of the iteration, and the scalar product of both.
    pub(super) fn multiply(&self, x: &Modes) -> (Modes, Lanes) {
        let (mut to, mut edges) = (x.clone(), [x.edges.clone(), x.edges.clone()]);
        let of = (&self.all.numbers, &self.all.operator, &self.all.wavefront);
        let product = spectrum::product(of, x, &mut Product { modes: &mut to, edges: &mut edges });
        (to, product)
    }

    /// The matrix of the iteration, without coefficients that belong to no mode.
    pub(super) fn matrix(&self) -> nalgebra::DMatrix<f64> {
        let modes = self.modes();
        let column = |m: &usize| {
            let (to, _) = self.multiply(&self.with(&[*m], |_| Lanes::constant(1.0)));
            to.all().map(|lanes| lanes.0[0]).collect::<Vec<_>>()
        };
        let columns: Vec<_> = modes.iter().map(column).collect();
        nalgebra::DMatrix::from_fn(modes.len(), modes.len(), |r, c| columns[c][modes[r]])
    }

    /// The least energy that modes can reach, from a decomposition of the matrix.
    pub(super) fn least(&self, slopes: &[[Lanes; MOMENTS]]) -> Lanes {
        let (modes, mut scaled) = (self.modes(), self.in_modes(slopes));
        self.all.operator.scale_slopes(&self.block(), &mut scaled.nodes, &mut scaled.edges);
        self.all.operator.balance(&self.block(), &mut scaled.nodes, &scaled.edges);
        let (scaled, factors) =
            (scaled.all().map(|lanes| lanes.0).collect::<Vec<_>>(), self.matrix().cholesky().unwrap());
        Lanes::at_levels(|lane| {
            let b = nalgebra::DVector::from_fn(modes.len(), |m, _| scaled[modes[m]][lane]);
            -0.5 * b.dot(&factors.solve(&b))
        })
    }
}

fn apply(form: &Form, moments: &[Lanes; MOMENTS]) -> [Lanes; MOMENTS] {
    form.map(|row| {
        let mut sum = Lanes::ZERO;
        row.iter().zip(moments).for_each(|(entry, moment)| sum += *moment * *entry);
        sum
    })
}
