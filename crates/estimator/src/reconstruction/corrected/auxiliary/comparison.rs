//! The four motions beside their plain formulas, one field and one sweep at a time.

use super::super::split::skew_acceleration;
use super::lanes::MOTIONS;
use super::*;
use crate::element::elements;
use crate::inertia::mass_product;
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::ids::{ElementId, NodeId};
use percute_core::load::{BodyForce, Profile, Support, Table, Traction};
use percute_core::material::{Elastic, Law};
use percute_core::mesh::{ElementGroups, Mesh};
use percute_core::problem::Initial;
use percute_testkit::{Random, random_rectangle};

/// One motion.
#[derive(Clone)]
struct Plain<const D: usize> {
    displacement: Vec<[f64; D]>,
    half_step: Vec<[f64; D]>,
    shares: Shares,
    /// A motion from rest: without initial fields, loads and motions of supports.
    from_rest: bool,
}

/// Its fields at one level.
struct PlainLevel<const D: usize> {
    displacement: Vec<[f64; D]>,
    velocity: Vec<[f64; D]>,
    /// a_c, w and o₂ of a split mass term.
    split: [Vec<[f64; D]>; 3],
}

/// M⁻¹(M − M_c) of a nodal field, 0 on prescribed components: an element gives m/(D+2) times the distance to the mean
/// of its nodes.
fn lumping_difference<const D: usize, const N: usize>(
    problem: &Problem<D>,
    inverse_mass: &[f64],
    field: &[[f64; D]],
) -> Vec<[f64; D]> {
    let mut difference = vec![[0.0; D]; field.len()];
    for (e, nodes) in problem.mesh().cells().enumerate() {
        let id = ElementId::new(e);
        let share = problem.material(id).density() * problem.volume(id) / (D + 2) as f64;
        for c in 0..D {
            let mean = nodes.iter().map(|n| field[n.index()][c]).sum::<f64>() / N as f64;
            nodes.iter().for_each(|n| difference[n.index()][c] += share * (field[n.index()][c] - mean));
        }
    }
    for (value, inverse) in difference.iter_mut().zip(inverse_mass) {
        (0..D).for_each(|c| value[c] *= inverse);
    }
    problem.prescribed().iter().for_each(|p| difference[p.node.index()][p.component] = 0.0);
    difference
}

/// (K − K_s) u by the definition of σ̄: means over the elements of one material at each edge and around each node.
fn softening<const D: usize, const N: usize>(problem: &Problem<D>, u: &[[f64; D]]) -> Vec<[f64; D]> {
    let (mesh, elements, smoothing) = (problem.mesh(), elements::<D, N>(problem), Smoothing::new(problem));
    let mut forces = vec![[0.0; D]; u.len()];
    if !smoothing.smooths() {
        return forces;
    }
    let gradient: Vec<_> = elements.iter().map(|element| element.gradient(&element.gather(u))).collect();
    let mean = |of: &[ElementId], law: u16| {
        let of: Vec<_> = of.iter().filter(|e| problem.element_material()[e.index()] == law).collect();
        let volume: f64 = of.iter().map(|e| problem.volume(**e)).sum();
        let sum = |a: usize, b: usize| of.iter().map(|e| problem.volume(**e) * gradient[e.index()][a][b]).sum::<f64>();
        std::array::from_fn::<_, D, _>(|a| std::array::from_fn::<_, D, _>(|b| sum(a, b) / volume))
    };
    for (e, element) in elements.iter().enumerate() {
        let (id, law) = (ElementId::new(e), problem.element_material()[e]);
        let edges = 3.0 * smoothing.edge_weight(element.nodes[0], 1.0);
        let mut change = gradient[e];
        let mut subtract = |mean: [[f64; D]; D], share: f64| {
            (0..D).for_each(|a| (0..D).for_each(|b| change[a][b] -= share * mean[a][b]));
        };
        for face in mesh.faces_of::<N>()[e] {
            let face = &mesh.face(face);
            let both: Vec<_> = [Some(face.owner), face.neighbour].into_iter().flatten().collect();
            subtract(mean(&both, law), edges / 3.0);
        }
        for node in element.nodes {
            subtract(mean(mesh.stars().star(node).elements, law), (1.0 - edges) / 3.0);
        }
        let stress = problem.material(id).stress(&change);
        for (i, node) in element.nodes.iter().enumerate() {
            let force = element.internal_force(i, &stress);
            (0..D).for_each(|c| forces[node.index()][c] += force[c]);
        }
    }
    problem.prescribed().iter().for_each(|p| forces[p.node.index()][p.component] = 0.0);
    forces
}

impl<const D: usize> Plain<D> {
    fn new(problem: &Problem<D>, shares: Shares) -> Self {
        let (displacement, half_step) = (problem.initial_displacement().to_vec(), problem.initial_velocity().to_vec());
        Self { displacement, half_step, shares, from_rest: false }
    }

    fn from_rest(problem: &Problem<D>) -> Self {
        let zero = vec![[0.0; D]; problem.mesh().node_count()];
        Self { displacement: zero.clone(), half_step: zero, shares: Shares::NONE, from_rest: true }
    }

    /// The level n under contact forces (N), and the step to the next one.
    fn advance<const N: usize>(
        &mut self,
        dynamics: &Dynamics<'_, D>,
        times: &TimeGrid,
        n: usize,
        contact: &[[f64; D]],
    ) -> PlainLevel<D> {
        let (problem, inverse) = (dynamics.problem(), dynamics.inverse_mass());
        let mut force = vec![[0.0; D]; inverse.len()];
        if self.from_rest {
            dynamics.subtract_internal_forces(&self.displacement, &mut force);
        } else {
            dynamics.forces_without_contact(n, &self.displacement, &mut force);
        }
        let Shares { space, time } = self.shares;
        for (force, less) in force.iter_mut().zip(softening::<D, N>(problem, &self.displacement)) {
            (0..D).for_each(|c| force[c] += space * less[c]);
        }
        let mut plain = force;
        crate::acceleration::accelerate(problem, inverse, &mut plain, contact);
        if self.from_rest {
            problem.prescribed().iter().for_each(|p| plain[p.node.index()][p.component] = 0.0);
        }
        let once = lumping_difference::<D, N>(problem, inverse, &plain);
        let twice = lumping_difference::<D, N>(problem, inverse, &once);
        let thrice = lumping_difference::<D, N>(problem, inverse, &twice);
        let mut internal = vec![[0.0; D]; inverse.len()];
        dynamics.subtract_internal_forces(&plain, &mut internal);
        problem.prescribed().iter().for_each(|p| internal[p.node.index()][p.component] = 0.0);
        let [next, last] = [times.step(n.min(times.step_count() - 1)), times.step(n.saturating_sub(1))];
        let smoothing = Smoothing::new(problem);
        let mass = |i: usize| smoothing.bodies()[smoothing.body(NodeId::new(i))].mass.map(|factor| space * factor);
        let corrected = |square: f64| -> Vec<[f64; D]> {
            let one = |i: usize, c: usize| {
                let [first, second, third] = mass(i);
                let lumped = first * once[i][c] + second * twice[i][c] + third * thrice[i][c];
                plain[i][c] + lumped + time * square / 12.0 * internal[i][c] * inverse[i]
            };
            (0..inverse.len()).map(|i| std::array::from_fn(|c| one(i, c))).collect()
        };
        let back = if n == 0 { 0.0 } else { 0.5 * times.step(n - 1) };
        let before = corrected(last * last);
        let velocity = self.half_step.iter().zip(&before).map(|(v, a)| std::array::from_fn(|c| v[c] + back * a[c]));
        let (displacement, velocity) = (self.displacement.clone(), velocity.collect());
        let accelerations = corrected(next * last);
        percute_core::dynamics::advance(times, n, &mut self.half_step, &mut self.displacement, accelerations);
        let split = |of: &dyn Fn(f64, f64, f64) -> f64| -> Vec<[f64; D]> {
            (0..inverse.len()).map(|i| std::array::from_fn(|c| of(mass(i)[0], plain[i][c], once[i][c]))).collect()
        };
        let lumped = split(&|first, plain, once| (1.0 - first) * plain + first * once);
        let skew = skew_acceleration::<D, N>(problem, inverse, &lumped, &displacement);
        let split = match D {
            1 => [plain, vec![[0.0; D]; inverse.len()], once],
            _ => [split(&|first, plain, once| plain + first * once), lumped, skew],
        };
        PlainLevel { displacement, velocity, split }
    }
}

/// ½∫σ:ε + ½∫ρ y·z, element by element.
fn energy<const D: usize, const N: usize>(
    problem: &Problem<D>,
    [a, b]: [&[Vec<[f64; D]>; 2]; 2],
    wanted: impl Fn(usize) -> bool,
) -> f64 {
    let mut sum = 0.0;
    for (e, element) in elements::<D, N>(problem).iter().enumerate().filter(|(e, _)| wanted(*e)) {
        let stress = problem.material(ElementId::new(e)).stress(&element.gradient(&element.gather(&a[0])));
        let gradient = element.gradient(&element.gather(&b[0]));
        let work: f64 = stress.iter().flatten().zip(gradient.iter().flatten()).map(|(s, g)| s * g).sum();
        let mass = N as f64 * element.nodal_mass;
        sum += 0.5 * (element.volume * work + mass_product(mass, &element.gather(&a[1]), &element.gather(&b[1])));
    }
    sum
}

fn minus<const D: usize>(a: &[Vec<[f64; D]>; 2], b: &[Vec<[f64; D]>; 2]) -> [Vec<[f64; D]>; 2] {
    let one = |k: usize| a[k].iter().zip(&b[k]).map(|(a, b)| std::array::from_fn(|c| a[c] - b[c])).collect();
    [one(0), one(1)]
}

/// Largest difference over the largest value of the second.
pub(super) fn miss<const D: usize>(a: &[[f64; D]], b: &[[f64; D]]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, x| m.max(x.abs()));
    let scale = largest(&mut b.iter().flatten().copied());
    let distance = largest(&mut a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a - b));
    if scale == 0.0 { distance } else { distance / scale }
}

pub(super) fn random_field<const D: usize>(count: usize, scale: f64, random: &mut Random) -> Vec<[f64; D]> {
    (0..count).map(|_| std::array::from_fn(|_| random.between(-scale, scale))).collect()
}

/// The motions one by one, in the order of the lanes.
fn plain<const D: usize>(problem: &Problem<D>) -> [Plain<D>; MOTIONS] {
    let quarters = Shares { space: 0.75, time: 0.75 };
    let one = |shares| Plain::new(problem, shares);
    [one(Shares::ALL), one(quarters), one(Shares { space: 0.0, ..quarters }), Plain::from_rest(problem)]
}

/// Checks fields, forces and energies of all levels, under any contact forces and a random motion in place of the
/// simulation.
fn compare<const D: usize, const N: usize>(problem: &Problem<D>, times: &TimeGrid, fewest: usize) {
    let dynamics = Dynamics::new(problem, times);
    let count = problem.mesh().node_count();
    let blocks = Blocks::with_fewest(problem.mesh(), fewest);
    let smoothing = Arc::new(Smoothing::new(problem));
    let mut motions = AuxiliarySolutions::<D, N>::on_blocks(problem, times, smoothing, Shares::ALL, blocks);
    motions.prepare(&elements(problem));
    let mut plain = plain(problem);
    let (mut random, contacts) = (Random::new(5), problem.surface().nodes().len());
    for n in 0..=times.step_count() {
        let [mut pull, reaction] = [0, 1].map(|_| random_field::<D>(contacts, 0.1, &mut random));
        for (at, contact) in problem.surface().nodes().iter().enumerate() {
            if let Some(first) = contact.partner.filter(|&first| first < at) {
                pull[at] = pull[first].map(|f| -f);
            }
            // Supports bear the forces along them.
            let held = problem.prescribed().iter().filter(|held| held.node == contact.node);
            held.for_each(|held| pull[at][held.component] = 0.0);
        }
        let simulated = [1.0, 1.0].map(|scale| random_field::<D>(count, scale, &mut random));
        let [mut displacement, mut acceleration, mut lumped, mut skew] = [0; 4].map(|_| vec![[0.0; D]; count]);
        motions.begin(&dynamics, n);
        let foreseen = motions.foresee(n);
        let none = vec![[0.0; D]; contacts];
        let approaches: Vec<_> =
            (0..contacts).map(|at| [&none, &pull].map(|f| foreseen.approach(at, [None; 2], f))).collect();
        let level = AuxiliaryLevel {
            displacement: &mut displacement,
            acceleration: &mut acceleration,
            split: Some(SplitLevel { lumped: &mut lumped, skew: &mut skew }),
        };
        let given = SimulatedLevel { velocity: &simulated[1], strain: 0.0, reaction: &reaction };
        motions.advance(&dynamics, n, &given, &pull, level);
        motions.differ([&simulated[0], &simulated[1]], [0.0; 2]);

        let mut released = plain[0].clone();
        released.advance::<N>(&dynamics, times, n, &none);
        let contact: Vec<[f64; D]> =
            reaction.iter().zip(&pull).map(|(r, p)| std::array::from_fn(|c| r[c] - p[c])).collect();
        let forces = [&pull, &pull, &reaction, &contact];
        let levels: [PlainLevel<D>; MOTIONS] =
            std::array::from_fn(|l| plain[l].advance::<N>(&dynamics, times, n, forces[l]));
        let own = &levels[0];
        // On a bar the fields are ã, 0 and o.
        let expected = [&own.displacement, &own.split[0], &own.split[1], &own.split[2]];
        let misses = [&displacement, &acceleration, &lumped, &skew].into_iter().zip(expected);
        // Rounding of some fifty terms grows with the steps.
        misses.for_each(|(found, expected)| assert!(miss(found, expected) < 1e-11, "{n}"));
        compare_approaches(problem, &approaches, [&released.displacement, &plain[0].displacement], &pull);
        compare_energies::<D, N>(problem, motions.differences().unwrap().last().unwrap(), simulated, levels);
    }
    assert_eq!(motions.differences().unwrap().len(), times.step_count() + 1);
}

/// Checks the gaps at t_{n+1} without and with these contact forces (N), from the displacements then (m).
fn compare_approaches<const D: usize>(
    problem: &Problem<D>,
    approaches: &[[Approach<D>; 2]],
    next: [&[[f64; D]]; 2],
    pull: &[[f64; D]],
) {
    let surface = problem.surface();
    for (at, both) in approaches.iter().enumerate() {
        let frame = problem.obstacles()[surface.nodes()[at].obstacle].flat_frame();
        let (normal, (own, _)) = (frame.normal(), frame.split(&pull[at]));
        for ((approach, displacement), force) in both.iter().zip(next).zip([0.0, own]) {
            let found = approach.gap + force * approach.mobility.between(normal, normal);
            let place = surface.against_obstacle(at, displacement);
            // Rounding of the displacements.
            let miss = (found - surface.gap(at, &place)).abs() / place.iter().fold(0.1, |m: f64, u| m.max(u.abs()));
            assert!(miss < 1e-12, "{at}: {miss}");
        }
    }
}

fn compare_energies<const D: usize, const N: usize>(
    problem: &Problem<D>,
    found: &Difference,
    simulated: [Vec<[f64; D]>; 2],
    levels: [PlainLevel<D>; MOTIONS],
) {
    let touches = |e: usize| {
        let nodes = problem.mesh().cell(ElementId::new(e));
        problem.surface().nodes().iter().any(|contact| nodes.contains(&contact.node))
    };
    let [own, halved_elements, halved_step, contact] = levels.map(|level| [level.displacement, level.velocity]);
    let differences = [minus(&simulated, &own), contact, minus(&halved_elements, &own), minus(&halved_step, &own)];
    let product = |a: usize, b: usize| energy::<D, N>(problem, [&differences[a], &differences[b]], |_| true);
    let [whole, square] = [product(0, 0), product(1, 1)];
    let pairs = [
        (found.energy, whole, whole),
        (found.near, energy::<D, N>(problem, [&differences[0]; 2], touches), whole),
        // The product may be small beside the two energies.
        (found.contact, product(0, 1), (whole * square).sqrt()),
        (found.dispersion, whole - 2.0 * product(0, 1) + square, whole + square),
        (found.halved_elements, product(2, 2), product(2, 2)),
        (found.halved_step, product(3, 3), product(3, 3)),
    ];
    for (k, (found, expected, scale)) in pairs.into_iter().enumerate() {
        // Differences of like motions have lost digits.
        let tolerance = if k < 4 { 1e-12 } else { 1e-8 };
        assert!((found - expected).abs() <= tolerance * scale, "energy {k}: {found} for {expected}");
    }
}

/// A rough body of two materials with an obstacle, a fixed and a driven support and loads.
pub(super) fn loaded<const D: usize, const N: usize>(
    mesh: &Mesh,
    laws: [Elastic; 2],
    [fixed, driven, loaded]: [&str; 3],
) -> Problem<D> {
    let faces = mesh.face_groups().iter().map(|(name, faces)| {
        let nodes = faces.iter().map(|f| mesh.face_nodes::<D>(*f).map(|n| n.index()));
        (name.clone(), nodes.collect())
    });
    let cells: Vec<[usize; N]> = mesh.nodes_of::<N>().iter().map(|cell| cell.map(|n| n.index())).collect();
    let group = |soft: bool| (0..cells.len()).filter(|e| (e % 3 == 0) == soft).collect();
    let groups = ElementGroups::from([("soft".to_string(), group(true)), ("hard".to_string(), group(false))]);
    let mesh = Mesh::new(mesh.points_in::<D>().to_vec(), &cells, &faces.collect(), &groups).unwrap();
    let normal = std::array::from_fn(|c| if c + 1 == D { 1.0 } else { 0.0 });
    let below = std::array::from_fn(|c| if c + 1 == D { -10.0 } else { 0.0 });
    let table = |values: [f64; 2]| Table::new(vec![0.0, 1.0], values.map(|v| [v; D]).to_vec()).unwrap();
    let support = |group: &str, component: usize, velocity| Support {
        group: group.into(),
        components: std::array::from_fn(|c| c == component),
        velocity,
    };
    let rough = random_field(mesh.node_count(), 0.01, &mut Random::new(3));
    let mut builder = Problem::builder(mesh)
        .material_of("hard", laws[0])
        .material_of("soft", laws[1])
        .obstacle(Obstacle::plane(below, normal, 0.0, None).unwrap())
        .initial_displacement(Initial::Nodal(rough))
        .support(support(driven, D - 1, Some(table([0.0, 0.4]))))
        .body_force(BodyForce { group: Some("soft".into()), value: table([0.3, -0.2]) });
    if D > 1 {
        let profile = Profile { value: 1.0, gradient: [0.2, 0.2, 0.0] };
        let traction = Traction { group: loaded.into(), value: table([0.1, 0.5]), profile };
        builder = builder.support(support(fixed, 0, None)).traction(traction);
    }
    builder.build().unwrap()
}

/// Steps that become longer, and shorter again, of at most the critical one.
pub(super) fn uneven<const D: usize>(problem: &Problem<D>, count: usize) -> TimeGrid {
    let step = |n: usize| critical_time_step(problem) * (0.6 + 0.3 * (0.3 * n as f64).sin());
    TimeGrid::from_steps(&(0..count).map(step).collect::<Vec<_>>()).unwrap()
}

#[test]
fn triangles() {
    let laws =
        [[70.0, 0.3, 2.0], [20.0, 0.45, 3.0]].map(|[e, nu, rho]| Elastic::plane_strain(e, nu, rho, 0.5).unwrap());
    for (mesh, fewest) in [
        (random_rectangle(1.0, 0.8, 6, 3).unwrap(), 4),
        (Mesh::rectangle(1.0, 0.8, 3, 40).unwrap(), 1),
        (Mesh::rectangle(1.0, 0.8, 3, 41).unwrap(), 20),
        // Several chunks.
        (Mesh::rectangle(1.0, 0.8, 2, 170).unwrap(), 1),
    ] {
        let problem = loaded::<2, 3>(&mesh, laws, ["left", "top", "right"]);
        compare::<2, 3>(&problem, &uneven(&problem, 30), fewest);
    }
}

/// A normal force on one contact node moves another one as far as a force there moves this one, and none moves a node
/// along a support.
#[test]
fn responses_are_symmetric() {
    let laws =
        [[70.0, 0.3, 2.0], [20.0, 0.45, 3.0]].map(|[e, nu, rho]| Elastic::plane_strain(e, nu, rho, 0.5).unwrap());
    let problem = loaded::<2, 3>(&random_rectangle(1.0, 0.8, 6, 3).unwrap(), laws, ["left", "top", "right"]);
    let (times, nodes) = (uneven(&problem, 5), problem.surface().nodes());
    let mut motions =
        AuxiliarySolutions::<2, 3>::new(&problem, &times, Arc::new(Smoothing::new(&problem)), Shares::ALL);
    motions.begin(&Dynamics::new(&problem, &times), 0);
    let foreseen = motions.foresee(0);
    let none = vec![[0.0; 2]; nodes.len()];
    let moved = |at: usize, by: usize| {
        let mut forces = none.clone();
        forces[by] = [0.0, 1.0];
        let approach = foreseen.approach(at, [None; 2], &none);
        let own = approach.mobility.between(&[0.0, 1.0], &[0.0, 1.0]);
        if at == by { own } else { foreseen.approach(at, [None; 2], &forces).gap - approach.gap }
    };
    let held = |at: usize| problem.prescribed().iter().any(|p| p.node == nodes[at].node && p.component == 0);
    let largest = (0..nodes.len()).map(|at| moved(at, at)).fold(0.0, f64::max);
    let (mut coupled, mut along) = (0, 0);
    for (at, by) in (0..nodes.len()).flat_map(|at| (0..nodes.len()).map(move |by| (at, by))) {
        let (there, back) = (moved(at, by), moved(by, at));
        // Rounding of gaps of 10.
        assert!((there - back).abs() < 1e-14 + 1e-12 * largest, "{at}, {by}: {there} {back}");
        coupled += usize::from(at != by && there.abs() > 1e-3 * largest);
        if held(at) {
            let mut forces = none.clone();
            forces[by] = [1.0, 1.0];
            let [under, free] = [&forces, &none].map(|forces| foreseen.approach(at, [None; 2], forces).along[1][0]);
            assert_eq!(under, free, "{at}, {by}");
            along += 1;
        }
    }
    assert!(coupled > 10 && along > 0, "{coupled}, {along}");
}

#[test]
fn bars() {
    let laws = [Elastic::bar(3.0, 1.0, 0.5).unwrap(), Elastic::bar(1.0, 2.0, 0.7).unwrap()];
    let problem = loaded::<1, 2>(&Mesh::uniform_bar(1.0, 23).unwrap(), laws, ["start", "end", "start"]);
    compare::<1, 2>(&problem, &uneven(&problem, 30), 2);
}

/// Displacements, forces and differences with so many threads.
fn with_threads(problem: &Problem<2>, threads: usize) -> (Vec<[f64; 2]>, Vec<Difference>) {
    let times = uneven(problem, 10);
    let dynamics = Dynamics::new(problem, &times);
    let blocks = Blocks::with_fewest(problem.mesh(), 1);
    let smoothing = Arc::new(Smoothing::new(problem));
    let mut motions = AuxiliarySolutions::<2, 3>::on_blocks(problem, &times, smoothing, Shares::ALL, blocks);
    assert!(motions.plan.chunks.len() >= 4);
    motions.prepare(&elements::<2, 3>(problem));
    let (count, contacts) = (problem.mesh().node_count(), problem.surface().nodes().len());
    let mut random = Random::new(9);
    let [velocity, pull, reaction] = [count, contacts, contacts].map(|n| random_field::<2>(n, 1.0, &mut random));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let mut fields = Vec::new();
    pool.install(|| {
        for n in 0..=10 {
            let [mut displacement, mut acceleration, mut lumped, mut skew] = [0; 4].map(|_| vec![[0.0; 2]; count]);
            motions.begin(&dynamics, n);
            let level = AuxiliaryLevel {
                displacement: &mut displacement,
                acceleration: &mut acceleration,
                split: Some(SplitLevel { lumped: &mut lumped, skew: &mut skew }),
            };
            let given = SimulatedLevel { velocity: &velocity, strain: 0.0, reaction: &reaction };
            motions.advance(&dynamics, n, &given, &pull, level);
            motions.differ([&velocity, &velocity], [0.0; 2]);
            fields.extend([displacement, acceleration, lumped, skew].concat());
        }
    });
    (fields, motions.differences().unwrap().to_vec())
}

#[test]
fn threads_do_not_change_bits() {
    let laws =
        [[70.0, 0.3, 2.0], [20.0, 0.45, 3.0]].map(|[e, nu, rho]| Elastic::plane_strain(e, nu, rho, 0.5).unwrap());
    let problem = loaded::<2, 3>(&Mesh::rectangle(1.0, 0.8, 2, 170).unwrap(), laws, ["left", "top", "right"]);
    let one = with_threads(&problem, 1);
    for threads in [2, 3, 8] {
        assert_eq!(one, with_threads(&problem, threads), "{threads}");
    }
}
