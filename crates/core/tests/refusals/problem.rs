//! Each [`Cause`] from a bad problem, at its place.

use percute_core::contact::Obstacle;
use percute_core::load::{BodyForce, Profile, Support, Table, TableError, Traction};
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_core::problem::{Builder, Cause, GroupOf, HeldBy, Initial, InputError, Place, Problem};

/// A unit square of two triangles, 0-1-2 below the diagonal and 0-2-3 above it, with its sides, an
/// empty group, the groups of elements `lower` and `all`, and no material.
fn square() -> Builder<2> {
    let sides = [("bottom", [0, 1]), ("right", [1, 2]), ("top", [2, 3]), ("left", [3, 0])];
    let mut faces: FaceGroups<2> = sides.iter().map(|(name, nodes)| (name.to_string(), vec![*nodes])).collect();
    faces.insert("nothing".to_string(), vec![]);
    let elements = ElementGroups::from([("lower".to_string(), vec![0]), ("all".to_string(), vec![0, 1])]);
    let points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    Problem::<2>::builder(Mesh::new(points, &[[0, 1, 2], [0, 2, 3]], &faces, &elements).unwrap())
}

fn elastic() -> Elastic {
    Elastic::plane_stress(1.0, 0.3, 1.0, 1.0).unwrap()
}

fn solid() -> Builder<2> {
    square().material(elastic())
}

fn refused(builder: Builder<2>) -> (Place, Cause) {
    let InputError { place, cause } = builder.build().unwrap_err();
    (place, cause)
}

fn place(table: &'static str, index: Option<usize>, key: &'static str) -> Place {
    Place { table, index, key }
}

fn support(group: &str, components: [bool; 2], velocity: Option<[f64; 2]>) -> Support {
    Support {
        group: group.to_string(),
        components: [components[0], components[1], false],
        velocity: velocity.map(Table::constant),
    }
}

fn traction(group: &str, value: [f64; 2]) -> Traction {
    Traction { group: group.to_string(), value: Table::constant(value), profile: Profile::UNIFORM }
}

fn floor(height: f64, group: Option<&str>) -> Obstacle<2> {
    Obstacle::plane([0.0, height], [0.0, 2.0], 0.1, group.map(String::from)).unwrap()
}

fn known() -> Vec<String> {
    ["bottom", "left", "nothing", "right", "top"].map(String::from).to_vec()
}

/// The statement that all others below spoil is accepted.
#[test]
fn the_good_statement_is_accepted() {
    let good = solid().support(support("left", [true, false], None)).traction(traction("top", [0.0, 1.0]));
    let good = good.obstacle(floor(-0.1, Some("bottom")));
    assert!(good.initial_velocity(Initial::Uniform([0.0, -1.0])).build().is_ok());
}

/// What the parts themselves refuse goes into the same error.
#[test]
fn parts_that_were_refused_before() {
    let material = Elastic::bar(-1.0, 1.0, 1.0).unwrap_err();
    let error = Cause::from(material.clone()).at("material", Some(0), "young");
    assert_eq!(error.to_string(), format!("material 1, `young`: {material}"));
    assert!(matches!(error.cause, Cause::Material(m) if m.name == "young" && m.value == -1.0));
    let plane = Obstacle::plane([0.0, 0.0], [0.0, 0.0], 0.0, None).unwrap_err();
    assert!(matches!(Cause::from(plane.clone()), Cause::Obstacle(p) if p == plane));
    let table = Table::new(vec![0.0, 0.0], vec![[1.0], [2.0]]).unwrap_err();
    assert!(matches!(Cause::from(table), Cause::Table(TableError::Order { index: 1, time }) if time == 0.0));
}

#[test]
fn unknown_and_empty_groups() {
    let (edges, roof) = (GroupOf::Edges, "roof".to_string());
    let unknown = Cause::UnknownGroup { name: roof, of: edges, known: known() };
    let empty = Cause::EmptyGroup { name: "nothing".to_string(), of: edges };
    let lower = "lower".to_string();
    let other = Cause::OtherGroup { name: lower, found: GroupOf::Elements, of: edges, known: known() };
    for (name, cause) in [("roof", unknown), ("nothing", empty), ("lower", other)] {
        let held = solid().support(support("left", [true, false], None)).support(support(name, [true, true], None));
        assert_eq!(refused(held), (place("support", Some(1), "group"), cause.clone()));
        assert_eq!(
            refused(solid().traction(traction(name, [1.0, 0.0]))),
            (place("traction", Some(0), "group"), cause.clone())
        );
        assert_eq!(refused(solid().obstacle(floor(-1.0, Some(name)))), (place("obstacle", Some(0), "group"), cause));
    }
    let (name, known) = ("core".to_string(), vec!["all".to_string(), "lower".to_string()]);
    let elements = Cause::UnknownGroup { name, of: GroupOf::Elements, known };
    assert_eq!(
        refused(square().material_of("core", elastic())),
        (place("material", Some(0), "group"), elements.clone())
    );
    let force = BodyForce { group: Some("core".to_string()), value: Table::constant([1.0, 0.0]) };
    assert_eq!(refused(solid().body_force(force)), (place("body_force", Some(0), "group"), elements));
}

#[test]
fn materials_missing_or_twice() {
    assert_eq!(refused(square()), (place("material", None, ""), Cause::NoMaterial { element: 0, count: 2 }));
    let half = square().material_of("lower", elastic());
    assert_eq!(refused(half.clone()), (place("material", None, ""), Cause::NoMaterial { element: 1, count: 1 }));
    let twice = half.material_of("all", elastic());
    let two =
        |everywhere| (place("material", Some(1), "group"), Cause::TwoMaterials { element: 0, first: 1, everywhere });
    assert_eq!(refused(twice), two(false));
    assert_eq!(refused(square().material(elastic()).material_of("lower", elastic())), two(true));
}

#[test]
fn initial_fields() {
    let short = solid().initial_velocity(Initial::Nodal(vec![[0.0; 2]; 3]));
    assert_eq!(refused(short), (place("initial", None, "velocity"), Cause::FieldLength { given: 3, nodes: 4 }));
    let mut values = vec![[0.0; 2]; 4];
    values[2][1] = f64::NEG_INFINITY;
    let cause = Cause::FieldNotFinite { node: 2, value: f64::NEG_INFINITY };
    let endless = solid().initial_displacement(Initial::Nodal(values));
    assert_eq!(refused(endless), (place("initial", None, "displacement"), cause));
}

#[test]
fn loads_that_are_not_finite() {
    let endless = [f64::INFINITY, 0.0];
    let at = |builder| refused(builder);
    assert_eq!(
        at(solid().support(support("left", [true, false], Some(endless)))),
        (place("support", Some(0), "velocity"), Cause::NotFinite { value: f64::INFINITY })
    );
    assert_eq!(
        at(solid().traction(traction("top", endless))),
        (place("traction", Some(0), "value"), Cause::NotFinite { value: f64::INFINITY })
    );
    let steep = Traction {
        profile: Profile { value: 1.0, gradient: [f64::INFINITY, 0.0, 0.0] },
        ..traction("right", [1.0, 0.0])
    };
    assert_eq!(
        at(solid().traction(steep)),
        (place("traction", Some(0), "profile"), Cause::NotFinite { value: f64::INFINITY })
    );
    let force = BodyForce { group: None, value: Table::constant(endless) };
    assert_eq!(
        at(solid().body_force(force)),
        (place("body_force", Some(0), "value"), Cause::NotFinite { value: f64::INFINITY })
    );
}

/// Bottom and right share node 1.
#[test]
fn supports_that_hold_nothing_or_disagree() {
    let none = solid().support(support("left", [false, false], None));
    assert_eq!(refused(none), (place("support", Some(0), "components"), Cause::NoComponent));
    let held = ["left", "right", "bottom", "top"];
    let all = held.iter().fold(solid(), |solid, side| solid.support(support(side, [true, true], None)));
    assert_eq!(refused(all), (place("support", None, ""), Cause::NoFreedom));
    let moving = |group, speed| support(group, [true, false], Some([speed, 0.0]));
    let disagree = solid().support(moving("bottom", 1.0)).support(moving("right", 2.0));
    let cause = Cause::ConflictingSupports { node: 1, component: 'x', first: 1 };
    assert_eq!(refused(disagree), (place("support", Some(1), "velocity"), cause));
    let start = Initial::Uniform([1.0, 0.0]);
    assert!(
        solid().support(moving("bottom", 1.0)).support(moving("right", 1.0)).initial_velocity(start).build().is_ok()
    );
}

#[test]
fn a_start_against_the_supports() {
    let pushed =
        solid().support(support("top", [false, true], Some([0.0, 3.0]))).initial_velocity(Initial::Uniform([0.0, 2.0]));
    let cause = Cause::InconsistentStart { node: 2, component: 'y', initial: 2.0, prescribed: 3.0 };
    assert_eq!(refused(pushed), (place("initial", None, "velocity"), cause));
}

/// sin(π) is 1e-16, and the support's velocity is 0: an admissible start has the latter, bit for bit.
#[test]
fn a_start_that_agrees_with_the_supports_up_to_rounding() {
    let rounded = [0.0, 3.0 * (1.0 + f64::EPSILON)];
    let pushed = solid().support(support("top", [false, true], Some([0.0, 3.0])));
    let problem = pushed.initial_velocity(Initial::Uniform(rounded)).build().expect("agrees up to rounding");
    let speeds = problem.initial_velocity().iter().map(|v| v[1]);
    assert_eq!(speeds.collect::<Vec<_>>(), [rounded[1], rounded[1], 3.0, 3.0]);
}

#[test]
fn loads_on_supports() {
    let both = solid().support(support("top", [false, true], None)).traction(traction("top", [0.0, 1.0]));
    let cause = Cause::LoadedSupport { component: 'y', nodes: vec![2, 3] };
    assert_eq!(refused(both), (place("traction", Some(0), "group"), cause));
    // Along the rollers a load may act.
    assert!(solid().support(support("top", [false, true], None)).traction(traction("top", [1.0, 0.0])).build().is_ok());
}

#[test]
fn contact_on_faces_that_are_not_free() {
    let cause = |by| Cause::NotFree { nodes: vec![0, 1], by };
    let at = place("obstacle", Some(0), "group");
    let held = solid().support(support("bottom", [true, false], None)).obstacle(floor(-1.0, Some("bottom")));
    assert_eq!(refused(held), (at, cause(HeldBy::Support(0))));
    let loaded = solid().traction(traction("bottom", [1.0, 0.0])).obstacle(floor(-1.0, Some("bottom")));
    assert_eq!(refused(loaded), (at, cause(HeldBy::Traction(0))));
}

#[test]
fn planes_that_nothing_faces() {
    let away = Cause::NothingFaces {
        group: "top".to_string(),
        outward: Box::new([0.0, 1.0]),
        normal: Box::new([0.0, 1.0]),
        facing: Box::new(["bottom".to_string()]),
    };
    assert_eq!(refused(solid().obstacle(floor(-1.0, Some("top")))), (place("obstacle", Some(0), "group"), away));
    let taken = Cause::AllHeld { nodes: vec![0, 1], by: HeldBy::Support(0) };
    let held = solid().support(support("bottom", [true, true], None)).obstacle(floor(-1.0, None));
    assert_eq!(refused(held), (place("obstacle", Some(0), ""), taken));
    let sides = ["left", "right"].map(|side| support(side, [false, true], None));
    let guided = sides.into_iter().fold(solid(), |solid, side| solid.support(side)).obstacle(floor(-1.0, None));
    assert_eq!(refused(guided), (place("obstacle", Some(0), ""), Cause::HeldNodes { node: 0 }));
}

/// Bottom and left share node 0.
#[test]
fn nodes_between_two_planes() {
    let plane = |normal: [f64; 2], friction| {
        let point = normal.map(|n| -3.0 * n / f64::hypot(normal[0], normal[1]));
        Obstacle::plane(point, normal, friction, Some("left".to_string())).unwrap()
    };
    let floor = |friction| Obstacle::plane([0.0, -1.0], [0.0, 1.0], friction, Some("bottom".to_string())).unwrap();
    let both =
        |first: f64, normal, second: f64| refused(solid().obstacle(floor(first)).obstacle(plane(normal, second)));
    assert!(solid().obstacle(floor(1.0)).obstacle(plane([1.0, 0.0], 0.999)).build().is_ok());
    let jams = |friction: f64| match both(1.0, [1.0, 0.0], friction) {
        (at, Cause::Jams { node: 0, first: 1, opening, angles, limit }) => {
            assert_eq!(at, place("obstacle", Some(1), "friction"));
            assert!((opening - 90.0).abs() < 1e-12 && (angles[0] - 45.0).abs() < 1e-12, "{opening} {angles:?}");
            limit
        }
        other => panic!("{other:?}"),
    };
    assert!((jams(1.001).unwrap() - 1.0).abs() < 1e-12);
    assert!(matches!(both(2.0, [1.0, -1.9], 0.5).1, Cause::Jams { limit: None, .. }));
    let narrow = both(0.0, [1.0, -4.0], 0.0);
    assert!(matches!(narrow.1, Cause::Opening { node: 0, first: 1, opening } if opening < 15.0), "{narrow:?}");
    let anywhere = |normal| Obstacle::plane([-3.0, -3.0], normal, 0.0, None).unwrap();
    let edge = refused(solid().obstacle(floor(0.0)).obstacle(anywhere([1.0, 1.0])));
    assert_eq!(edge, (place("obstacle", Some(1), "group"), Cause::TwoPlanes { nodes: vec![0, 1], first: 1 }));
}

#[test]
fn starts_behind_or_into_the_plane() {
    let inside = solid().obstacle(floor(0.25, None));
    assert_eq!(
        refused(inside),
        (place("obstacle", Some(0), "point"), Cause::Penetrates { node: 0, depth: 0.25, clear: vec![0.0, 0.0] })
    );
    // A displacement counts: the body lies above the plane, but starts pushed into it.
    let pushed = solid().obstacle(floor(-0.5, None)).initial_displacement(Initial::Uniform([0.0, -0.75]));
    assert_eq!(refused(pushed).1, Cause::Penetrates { node: 0, depth: 0.25, clear: vec![0.0, -0.75] });
    // All of it behind: the normal is the wrong way round. Where it rests on the plane it is not behind.
    let reversed = |height| solid().obstacle(Obstacle::plane([0.0, height], [0.0, -1.0], 0.0, None).unwrap());
    let behind = Cause::Behind { node: 2, depth: 1.5, reversed: vec![-0.0, 1.0] };
    assert_eq!(refused(reversed(-0.5)), (place("obstacle", Some(0), "normal"), behind));
    assert!(matches!(refused(reversed(0.0)).1, Cause::Behind { depth: 1.0, .. }));
    assert!(reversed(1.0).build().is_ok());
    let blow = solid().obstacle(floor(0.0, None)).initial_velocity(Initial::Uniform([1.0, -3.0]));
    let cause = Cause::StrikesAtStart { node: 0, gap: 0.0, speed: 3.0 };
    assert_eq!(refused(blow), (place("obstacle", Some(0), "point"), cause));
    // Up or along the plane is no blow.
    for velocity in [[1.0, 0.0], [0.0, 2.0]] {
        assert!(solid().obstacle(floor(0.0, None)).initial_velocity(Initial::Uniform(velocity)).build().is_ok());
    }
}
