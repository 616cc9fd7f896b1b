mod case;

use super::modes::MOMENTS;
use super::*;
use crate::kinematic::ElementMotion;
use crate::measure::NodalBalance;
use case::{Case, problem_of, problems};
use percute_core::ids::FaceId;
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, Mesh};
use percute_testkit::{Random, random_rectangle};

/// Moments on an edge act like forces at its two nodes: no mode gives any element a resultant or a moment.
#[test]
fn modes_have_no_resultant_on_any_element() {
    problems().map(Case::new).iter().for_each(check_resultants);
}

fn check_resultants(case: &Case) {
    let links = case.on_links(&case.random_modes(&mut Random::new(1)));
    for e in 0..case.elements.len() {
        let points = case.problem.mesh().corners::<2, 3>(ElementId::new(e));
        let all = case.of_element(e, &links);
        for lane in 0..LANES {
            let (mut force, mut couple) = ([0.0; 2], 0.0);
            for k in 0..3 {
                for p in 0..2 {
                    let at = points[crate::stress::face_node::<3>(k, p)];
                    let f = [0, 1].map(|c| all[4 * k + 2 * p + c].0[lane]);
                    force = [force[0] + f[0], force[1] + f[1]];
                    couple += at[0] * f[1] - at[1] * f[0];
                }
            }
            // Couples of unit moment have forces of 1/edge, some 300 N here: rounding of a dozen of them.
            assert!(force.iter().all(|f| f.abs() < 1e-11), "element {e}: {force:?}");
            assert!(couple.abs() < 1e-12, "element {e}: {couple}");
        }
    }
}

/// Their number is that of all changes that balance: unknown moments less three equations for each element. One of them
/// is redundant where the body may move along its line of symmetry.
#[test]
fn the_modes_are_all_there_are() {
    for (case, redundant) in problems().map(Case::new).iter().zip([0, 1]) {
        let mesh = case.problem.mesh();
        let unknown = |f: usize| match mesh.face(FaceId::new(f)).neighbour {
            Some(_) => 2,
            None => case.problem.supported(FaceId::new(f)).into_iter().filter(|supported| *supported).count(),
        };
        let unknown: usize = (0..mesh.faces().len()).map(unknown).sum();
        let modes = case.modes();
        // One column for each mode: the moments that it makes.
        let column = |m: &usize| {
            // Couples of 1 N have levers of some 5 mm.
            let turn = *m < 3 * mesh.node_count() && m % 3 == 2;
            let one = case.with(&[*m], |_| Lanes::constant(if turn { 0.01 } else { 1.0 }));
            case.on_links(&one).iter().flatten().map(|lanes| lanes.0[0]).collect::<Vec<_>>()
        };
        let columns: Vec<_> = modes.iter().map(column).collect();
        let matrix = nalgebra::DMatrix::from_fn(columns[0].len(), modes.len(), |r, c| columns[c][r]);
        assert_eq!(modes.len(), 2 * unknown + redundant - 3 * case.elements.len());
        // Singular values of independent modes of size 1 are far above this, those of dependent ones at rounding.
        assert_eq!(matrix.rank(1e-6), modes.len());
    }
}

/// A line of symmetry gets no traction along it.
#[test]
fn modes_leave_given_tractions_alone() {
    let [_, case] = problems().map(Case::new);
    let links = case.on_links(&case.random_modes(&mut Random::new(1)));
    let (mesh, mut across) = (case.problem.mesh(), 0.0_f64);
    for node in (0..mesh.node_count()).map(NodeId::new) {
        let star = mesh.stars().star(node);
        for (face, moment) in star.links.iter().zip(&links[mesh.stars().link_range(node)]) {
            if face.is_some_and(|face| mesh.face(face).neighbour.is_none()) {
                assert_eq!(moment[1].0, [0.0; LANES], "{node:?}");
                across = across.max(moment[0].0[0].abs());
            }
        }
    }
    assert!(across > 0.1);
}

#[test]
fn adding_slopes_is_the_transpose_of_adding_changes() {
    let [_, case] = problems().map(Case::new);
    let mut random = Random::new(2);
    let (modes, slopes) = (case.random_modes(&mut random), case.random_slopes(&mut random));
    let (links, gathered) = (case.on_links(&modes), case.in_modes(&slopes));
    for lane in 0..LANES {
        let (mut work, mut size) = (0.0, 0.0);
        for (e, slope) in slopes.iter().enumerate() {
            for (m, s) in case.of_element(e, &links).iter().zip(slope) {
                work += m.0[lane] * s.0[lane];
                size += (m.0[lane] * s.0[lane]).abs();
            }
        }
        let same: f64 = modes.all().zip(gathered.all()).map(|(a, b)| a.0[lane] * b.0[lane]).sum();
        // Rounding of some thousand terms.
        assert!((work - same).abs() < 1e-14 * size, "{work} {same} of {size}");
    }
}

/// The slopes of an element are differences of its energy, in a body that is not of unit thickness.
#[test]
fn slopes_are_differences_of_the_energy() {
    let [case, _] = problems().map(Case::new);
    let mut random = Random::new(8);
    for (e, element) in case.elements.iter().enumerate() {
        let (id, points) = (ElementId::new(e), case.problem.mesh().corners::<2, 3>(ElementId::new(e)));
        let measure = ElementMeasure::new(&case.problem, element, id, Acceleration::Closest);
        let mut forms = EnergyForms::new(CellKind::Triangle);
        let [lane, ..] = forms.prepare(&case.problem, std::iter::once((id, points)));
        let form = forms.of(&case.problem, id, &points, lane);
        let mut vector = || [(); 2].map(|()| random.between(-1.0, 1.0));
        let fields = NodalBalance {
            moments: [(); 3].map(|()| [vector(), vector()]),
            acceleration: [(); 3].map(|()| vector()),
            skew: None,
            body_force: [0.0; 2],
            displacement: None,
        };
        let motion = ElementMotion::any([(); 3].map(|()| vector().map(|u| 1e-12 * u)), [[0.0; 2]; 3]);
        let [stress, _] = measure.stress_and_strain(&element.gradient(motion.displacement()));
        let slopes = moment_slope(&measure, &form, &fields, &stress);
        let largest = slopes.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        for (m, slope) in slopes.iter().enumerate() {
            let energy = |step: f64| {
                let mut fields = fields;
                fields.moments[m / 4][m / 2 % 2][m % 2] += step;
                let stress = measure.stress(&form, &measure.balanced(&fields));
                measure.error(&stress, &[[0.0; 2]; 3], &motion, None).elastic
            };
            // The energy is quadratic: differences of any step are exact.
            let difference = 0.5 * (energy(1.0) - energy(-1.0));
            assert!((slope - difference).abs() < 1e-12 * largest, "element {e}, moment {m}: {slope} {difference}");
        }
    }
}

/// The matrix has the energy of the elements' own maps.
#[test]
fn the_matrix_is_the_energy() {
    problems().map(Case::new).iter().for_each(check_matrix);
}

fn check_matrix(case: &Case) {
    let mut random = Random::new(5);
    let mut coefficients = case.random_modes(&mut random);
    let x = coefficients.clone();
    let (to, product) = case.multiply(&x);
    case.all.operator.relax(&case.block(), &x.nodes, &mut coefficients.edges);
    case.all.operator.unscale_nodes(&case.block(), &x.nodes, &mut coefficients.nodes);
    let none = vec![[Lanes::ZERO; MOMENTS]; case.elements.len()];
    let energy = case.energy(&none, &coefficients).0;
    for lane in 0..LANES {
        let same: f64 = 0.5 * x.all().zip(to.all()).map(|(a, b)| a.0[lane] * b.0[lane]).sum::<f64>();
        // Rounding of some hundred terms of like size.
        assert!((same - energy[lane]).abs() < 1e-12 * energy[lane], "{same} {}", energy[lane]);
        assert!((0.5 * product.0[lane] - same).abs() < 1e-12 * same);
    }
    let matrix = case.matrix();
    assert!((&matrix - matrix.transpose()).amax() < 1e-13);
}

/// Ten times as long.
fn stretched(mesh: &Mesh) -> Mesh {
    let points = mesh.points_in::<2>().iter().map(|p| [10.0 * p[0], p[1]]).collect();
    let cells: Vec<_> = mesh.nodes_of::<3>().iter().map(|cell| cell.map(|n| n.index())).collect();
    let nodes = |f: &FaceId| mesh.face_nodes::<2>(*f).map(|n| n.index());
    let groups = mesh.face_groups().iter().map(|(name, faces)| (name.clone(), faces.iter().map(nodes).collect()));
    Mesh::new(points, &cells, &groups.collect(), &ElementGroups::new()).unwrap()
}

/// Random meshes and structured ones, also stretched and almost incompressible. Measured are 97.6 to 99.1 % of what can
/// be gained, stretched 94.0 to 97.8 %. With the slopes of impacts and vibrations they are 98.7 to 99.9 % over all
/// instants, stretched 93 to 96 %.
#[test]
fn the_steps_gain_most_of_what_can_be_gained() {
    let body = |mesh: Mesh, ratio: f64| problem_of(mesh, Elastic::plane_strain(210e9, ratio, 7800.0, 1.0).unwrap());
    let random = |seed: u64| random_rectangle(0.05, 0.04, 8, seed).unwrap();
    let structured = Mesh::rectangle(0.05, 0.04, 10, 8).unwrap();
    let cases = [
        (body(random(1), 0.3), 0.95),
        (body(random(2), 0.49), 0.95),
        (body(structured.clone(), 0.3), 0.95),
        (body(stretched(&random(3)), 0.3), 0.93),
        (body(stretched(&structured), 0.49), 0.93),
    ];
    for (problem, part) in cases {
        let case = Case::new(problem);
        let slopes = case.random_slopes(&mut Random::new(3));
        let (reached, least) = (case.energy(&slopes, &case.change(&slopes)), case.least(&slopes));
        let parts = reached / least;
        assert!(parts.0.iter().all(|x| (part..=1.0 + 1e-12).contains(x)), "{parts:?}");
    }
}

/// Close below the exact one: measured are 98.8 to 100 %. In structured meshes the largest eigenvalues lie close
/// together: six steps of Lanczos find 94 %. The iteration gains energy up to 1.14 times the eigenvalue that it
/// assumes.
#[test]
fn the_largest_eigenvalue() {
    let mesh = Mesh::rectangle(0.05, 0.05, 12, 12).unwrap();
    for mesh in [stretched(&mesh), mesh, random_rectangle(0.05, 0.04, 6, 3).unwrap()] {
        let case = Case::new(problem_of(mesh, Elastic::plane_strain(210e9, 0.4, 7800.0, 1.0).unwrap()));
        let (exact, found) = (case.matrix().symmetric_eigenvalues().max(), case.all.largest_eigenvalue);
        assert!(found <= (1.0 + 1e-12) * exact && found > 0.98 * exact, "{found} {exact}");
    }
}

/// A lane does not depend on its neighbours, and one without any slope stays where it is.
#[test]
fn lanes_are_apart() {
    let [_, case] = problems().map(Case::new);
    let mut random = Random::new(4);
    let slopes = case.random_slopes(&mut random);
    let together = case.change(&slopes);
    for lane in 0..LANES {
        let only = |slope: &[Lanes; MOMENTS]| {
            slope.map(|lanes| Lanes::at_levels(|l| if l == 0 { lanes.0[lane] } else { 0.0 }))
        };
        let alone = case.change(&slopes.iter().map(only).collect::<Vec<_>>());
        for (a, b) in together.all().zip(alone.all()) {
            assert_eq!(a.0[lane], b.0[0]);
            assert!(b.0[1..].iter().all(|x| *x == 0.0));
        }
    }
}

/// Threads, and an order of nodes without any locality, do not change the work that each number is made of.
#[test]
fn the_order_of_the_work_does_not_matter() {
    let mesh = Mesh::rectangle(0.05, 0.04, 160, 130).unwrap();
    for mesh in [mesh.clone(), percute_testkit::renumbered(&mesh, 1).unwrap().0] {
        let case = Case::new(problem_of(mesh, Elastic::plane_strain(210e9, 0.3, 7800.0, 1.0).unwrap()));
        let slopes = case.random_slopes(&mut Random::new(6));
        let change = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| case.change(&slopes)).all().map(|lanes| lanes.0).collect::<Vec<_>>()
        };
        let alone = change(1);
        assert!(alone.iter().flatten().all(|x| x.is_finite()));
        assert!([2, 3].into_iter().all(|threads| change(threads) == alone));
    }
}

/// Work that is stopped leaves the change as it was.
#[test]
fn a_stop_leaves_the_change_alone() {
    let case = Case::new(problem_of(
        random_rectangle(0.05, 0.04, 12, 1).unwrap(),
        Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap(),
    ));
    let slopes = case.in_modes(&case.random_slopes(&mut Random::new(6)));
    let largest = |stopped: bool| {
        let (mut space, stop) = (Workspace::new(&case.all.numbers), StopFlag::default());
        space.slopes = slopes.clone();
        stop.set(stopped);
        case.all.minimise(&mut space, &stop);
        space.change.all().flat_map(|lanes| lanes.0).fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    assert_eq!(largest(true), 0.0);
    assert!(largest(false) > 0.0);
}
