//! Every mistake in a case file is named with its line, and nothing is computed.

use crate::common::{ARRAYS, BAR, BLOCK, Bench, stderr};
use percute::case::{Case, Source};

/// What to change in a good case, the line that the error must name, and words that it must say.
struct Mistake(&'static str, &'static str, usize, &'static [&'static str]);

/// Makes each mistake in `case` and checks what `percute` says.
fn check(case: &str, mistakes: &[Mistake]) {
    let good = Bench::new(case).percute(&["run", "case.toml"]);
    assert_eq!(good.status.code(), Some(0), "the case without a mistake: {}", stderr(&good));
    for Mistake(old, new, line, phrases) in mistakes {
        assert_eq!(case.matches(old).count(), 1, "`{old}` must be in the case once");
        let output = Bench::new(&case.replacen(old, new, 1)).percute(&["run", "case.toml"]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "`{new}` for `{old}`: {said}");
        assert!(output.stdout.is_empty(), "`{new}` for `{old}` printed a result");
        assert!(
            said.starts_with(&format!("error: case.toml:{line}: ")),
            "`{new}` for `{old}`, not line {line}: {said}"
        );
        for phrase in *phrases {
            assert!(said.contains(phrase), "`{new}` for `{old}` does not say `{phrase}`: {said}");
        }
    }
}

#[test]
fn misspelt_missing_and_surplus_keys() {
    check(
        BLOCK,
        &[
            Mistake("poisson = 0.3", "poison = 0.3", 6, &["[material], poison", "did you mean `poisson`?", "`young`"]),
            Mistake("[initial]", "[intial]", 10, &["no table `intial`", "did you mean `initial`?"]),
            Mistake("young = 70e9\n", "", 4, &["[material]", "`young` is missing", "Pa"]),
            Mistake("plane = \"stress\"\n", "", 4, &["`plane` is missing", "\"stress\" or \"strain\""]),
            Mistake("friction = 0.2\n", "", 13, &["[[obstacle]] 1", "`friction` is missing", "0 or more"]),
            Mistake("normal = [0.0, 1.0]\n", "", 13, &["`normal` is missing"]),
            Mistake("end = 5e-6\n", "", 28, &["[time]", "`end` is missing", "s"]),
            Mistake("courant = 0.9\n", "", 28, &["exactly one of `courant`"]),
            Mistake("courant = 0.9", "courant = 0.9\nstep = 1e-7", 31, &["[time], step", "exactly one of"]),
            Mistake("components = [\"x\"]\n", "", 19, &["`components` is missing"]),
            Mistake("height = 0.04, ", "", 2, &["[mesh], rectangle", "`height` is missing", "m"]),
            Mistake("height = 0.04", "hieght = 0.04", 2, &["rectangle.hieght", "did you mean `height`?"]),
            Mistake("[time]", "[[time]]\nend = 1.0\n[[time]]", 30, &["[[time]] 2", "one [time] only"]),
            Mistake("[mesh]\n", "[mesh]\ncells = [[0, 1, 2]]\n", 2, &["goes with `points`"]),
            Mistake("poisson = 0.3", "poisson = 0.3\nsection = 0.1", 7, &["[material], section", "bars only"]),
            Mistake(
                "time = [0.0, 1e-4], value",
                "times = [0.0, 1e-4], value",
                22,
                &["velocity.times", "did you mean `time`?"],
            ),
        ],
    );
}

#[test]
fn wrong_types_and_syntax() {
    check(
        BLOCK,
        &[
            Mistake("young = 70e9", "young = \"70 GPa\"", 5, &["is \"70 GPa\"", "a finite number in Pa"]),
            Mistake("poisson = 0.3", "poisson = true", 6, &["is true", "a finite number"]),
            Mistake("density = 2700.0", "density = nan", 7, &["is nan", "finite number in kg/m³"]),
            Mistake("density = 2700.0", "density = 1e999", 7, &["is 1e999", "finite number in kg/m³"]),
            Mistake("nx = 5", "nx = 5.5", 2, &["rectangle.nx", "is 5.5", "a whole number, 1 or more"]),
            Mistake("every = 1", "every = 0", 34, &["[estimate], every", "is 0", "a whole number, 1 or more"]),
            Mistake("every = 1", "every = -3", 34, &["is -3", "1 or more"]),
            Mistake("velocity = [400.0, -400.0]", "velocity = 400.0", 11, &["is 400.0", "2 finite numbers in m/s"]),
            Mistake(
                "velocity = [400.0, -400.0]",
                "velocity = [1, 2, 3]",
                11,
                &["is [1, 2, 3]", "2 finite numbers in m/s"],
            ),
            Mistake("plane = \"stress\"", "plane = 3", 8, &["is 3", "\"strain\", in quotes"]),
            Mistake("group = \"top\"", "group = [\"top\"]", 20, &["[[support]] 1, group", "name of a group"]),
            Mistake("components = [\"x\"]", "components = \"x\"", 21, &["is \"x\"", "a list of axes"]),
            Mistake("rectangle = {", "rectangle = [] #", 2, &["is []", "a table, such as"]),
            Mistake("[initial]\n", "[[obstacle]]\nvelocity = 1\n[no_table\n", 12, &["no valid TOML"]),
            Mistake("young = 70e9", "young = 70e9\nyoung = 71e9", 6, &["no valid TOML", "duplicate"]),
            Mistake("young = 70e9", "young = 70 GPa", 5, &["no valid TOML"]),
        ],
    );
}

#[test]
fn impossible_values() {
    check(
        BLOCK,
        &[
            Mistake("young = 70e9", "young = -1.0", 5, &["[material], young", "is -1 Pa", "positive"]),
            Mistake("poisson = 0.3", "poisson = 0.5", 6, &["is 0.5", "above -1 and below 0.5"]),
            Mistake("density = 2700.0", "density = 0", 7, &["is 0 kg/m³", "positive"]),
            Mistake("plane = \"stress\"", "plane = \"strian\"", 8, &["did you mean `strain`?"]),
            Mistake(
                "plane = \"stress\"",
                "plane = \"stress\"\nthickness = 0.0",
                9,
                &["thickness", "is 0 m", "positive"],
            ),
            Mistake("width = 0.05", "width = -0.05", 2, &["rectangle.width", "-0.05", "a positive length in metres"]),
            Mistake("ny = 4", "ny = 400000000", 2, &["rectangle.ny", "from 1 to 20 000 000"]),
            Mistake("friction = 0.2", "friction = -0.2", 16, &["[[obstacle]] 1, friction", "-0.2", "zero or positive"]),
            Mistake("normal = [0.0, 1.0]", "normal = [0, 0]", 15, &["[0.0, 0.0]", "not zero"]),
            Mistake("end = 5e-6", "end = 0.0", 29, &["[time], end", "is 0.0", "a positive number in s"]),
            Mistake("courant = 0.9", "courant = 1.5", 30, &["is 1.5", "above 0 and at most 1"]),
            Mistake("courant = 0.9", "step = 1e-3", 30, &["is 1e-3 s", "critical step of this mesh, 1."]),
            Mistake("courant = 0.9", "step = 1e-30", 30, &["steps", "at most 1e8"]),
            Mistake("courant = 0.9", "steps = [1e-6, 1e-3]", 30, &["steps[1]", "is 1e-3 s", "critical step"]),
            Mistake("courant = 0.9", "steps = [1e-6, 1e-6]", 29, &["[time], end", "is 5e-6 s", "2e-6 s"]),
            Mistake("courant = 0.9", "steps = []", 30, &["`steps` is empty"]),
            Mistake("\"sharp\"", "\"sharpe\"", 33, &["\"sharp\", \"paper\"", "did you mean `sharp`?"]),
            Mistake(
                "every = 1",
                "acceleration = \"rigit\"",
                34,
                &["\"closest\", \"rigid\", \"weak\"", "did you mean `rigid`?"],
            ),
        ],
    );
}

#[test]
fn supports_and_loads_that_contradict() {
    check(
        BLOCK,
        &[
            Mistake("group = \"top\"", "group = \"roof\"", 20, &["no group \"roof\"", "\"left\""]),
            Mistake("group = \"left\"", "group = \"lfet\"", 25, &["[[traction]] 1, group", "did you mean `left`?"]),
            Mistake("[\"x\"]", "[\"z\"]", 21, &["components[0]", "is \"z\"", "`x`, `y`"]),
            Mistake("[\"x\"]", "[]", 21, &["one axis or more"]),
            Mistake("[\"x\"]", "[\"x\", \"x\"]", 21, &["`x` twice"]),
            Mistake(
                "time = [0.0, 1e-4]",
                "time = [0.0]",
                22,
                &["velocity.value", "`time` has 1 entries and `value` has 2"],
            ),
            Mistake("time = [0.0, 1e-4]", "time = [1e-4, 0.0]", 22, &["velocity.time", "instants must increase"]),
            Mistake("value = [400.0, 400.0]", "value = [3.0, 400.0]", 11, &["[initial], velocity", "400 m/s", "3 m/s"]),
            Mistake("value = [400.0, 400.0]", "value = [[1.0, 2.0], 400.0]", 22, &["value[0]", "in m/s"]),
            Mistake("value = [1e6, 0.0]", "value = 1e6", 26, &["[[traction]] 1, value", "2 finite numbers in Pa"]),
            Mistake(
                "value = [1e6, 0.0]",
                "value = [1e6, 0.0]\nprofile = { value = 1.0 }",
                27,
                &["profile", "`gradient` is missing"],
            ),
            Mistake("group = \"left\"", "group = \"top\"", 25, &["both loaded and supported"]),
            Mistake("[initial]\nvelocity = [400.0, -400.0]\n", "", 20, &["[initial], velocity", "starts at 0 m/s"]),
            Mistake(
                "[time]",
                "[[body_force]]\nvalue = [0, -9.81, 0]\n[time]",
                29,
                &["[[body_force]] 1, value", "N/m³"],
            ),
        ],
    );
}

#[test]
fn planes_that_contradict() {
    check(
        BLOCK,
        &[
            Mistake("group = \"bottom\"", "group = \"botom\"", 17, &["no group \"botom\"", "did you mean `bottom`?"]),
            Mistake("group = \"bottom\"", "group = \"left\"", 17, &["supported or loaded", "take it out of the group"]),
            Mistake(
                "normal = [0.0, 1.0]",
                "normal = [0.0, -1.0]",
                15,
                &["faces the plane", "point from the plane to the body"],
            ),
            Mistake("point = [0.0, -0.0005]", "point = [0.0, 0.001]", 14, &["behind the plane", "1.000000e-3 m"]),
            Mistake("point = [0.0, -0.0005]", "point = [0.0, 0.0]", 14, &["starts on the plane", "leave a gap"]),
            Mistake("point = [0.0, -0.0005]", "point = [0.0, -1e-6]", 14, &["too near", "start at least"]),
        ],
    );
}

#[test]
fn bars() {
    check(
        BAR,
        &[
            Mistake("velocity = -400.0", "velocity = [1.0, 2.0]", 10, &["field has 2 values", "21 nodes"]),
            Mistake("velocity = -400.0", "velocity = \"fast\"", 10, &["is \"fast\"", "a finite number in m/s"]),
            Mistake("section = 0.02", "section = 0.02\npoisson = 0.0", 8, &["does not apply to a bar"]),
            Mistake("section = 0.02", "", 4, &["`section` is missing", "m²"]),
            Mistake("normal = 1.0", "normal = 1.0\nfriction = 0.1", 15, &["a bar has no tangent"]),
            Mistake(
                "normal = 1.0",
                "normal = 1.0\ngroup = \"ende\"",
                15,
                &["no group \"ende\"", "did you mean `end`?"],
            ),
            Mistake("elements = 20", "elements = 0", 2, &["bar.elements", "is 0", "1 or more"]),
            Mistake(
                "[mesh]\n",
                "[mesh]\nrectangle = { width = 1, height = 1, nx = 1, ny = 1 }\n",
                3,
                &["exactly one of"],
            ),
        ],
    );
}

#[test]
fn meshes_as_arrays() {
    check(
        ARRAYS,
        &[
            Mistake("  [0.01, 0.0],", "  [0.01],", 4, &["points[1]", "2 finite numbers in m"]),
            Mistake("  [0, 3, 2],", "  [0, 3],", 10, &["cells[1]", "3 node numbers, counted from 0"]),
            Mistake("  [0, 3, 2],", "  [0, 3, 7],", 10, &["cells[1]", "node 7", "nodes 0 to 3"]),
            Mistake("  [0, 3, 2],", "  [0, 2, 2],", 6, &["points[3]", "belongs to no element"]),
            Mistake("  [0.0, 0.01],", "  [0.02, 0.02],", 10, &["cells[1]", "degenerate"]),
            Mistake("  [0.0, 0.01],", "  [0.01, 0.01],", 6, &["points[3]", "merge duplicate nodes"]),
            Mistake("foot = [[0, 1]]", "foot = [[1, 3]]", 14, &["groups.foot", "not on the boundary"]),
            Mistake("right = [0]", "right = [5]", 17, &["elements.right", "element 5", "0 to 1"]),
            Mistake("group = \"left\"", "group = \"lift\"", 21, &["[[material]] 1, group", "did you mean `left`?"]),
            Mistake("right = [0]", "right = [0, 1]", 28, &["[[material]] 2, group", "must not overlap"]),
            Mistake("group = \"right\"\n", "", 27, &["[[material]] 2", "must not overlap"]),
            Mistake("left = [1]", "left = []", 21, &["\"left\" is empty"]),
            Mistake("  [0, 3, 2],", "  [0, 3, -2],", 10, &["is -2", "a whole number, 0 or more"]),
        ],
    );
}

#[test]
fn outputs() {
    let case = BLOCK.to_string() + "\n[output]\ninstants = 5\nfields = true\n";
    check(
        &case,
        &[
            Mistake("instants = 5", "instants = 0", 37, &["[output], instants", "is 0", "1 or more"]),
            Mistake("instants = 5", "instants = \"all\"", 37, &["is \"all\"", "whole number"]),
            Mistake("instants = 5", "instants = []", 37, &["a list of one time or more"]),
            Mistake("instants = 5", "instants = [0.0, -1e-6]", 37, &["none of them negative"]),
            Mistake("fields = true", "fields = 1", 38, &["[output], fields", "is 1", "true or false"]),
            Mistake("fields = true", "history = \"\"", 38, &["is \"\"", "the name of a file"]),
            Mistake("fields = true", "estimate = true", 38, &["[output], estimate", "the name of a file, in quotes"]),
            Mistake("fields = true", "histroy = \"a\"", 38, &["did you mean `history`?"]),
        ],
    );
}

#[test]
fn files_that_are_no_case() {
    for (text, line, phrase) in
        [("", 1, "[mesh] is missing"), ("[mesh]\n", 1, "exactly one of"), ("mesh = 3\n", 1, "is no table")]
    {
        let output = Bench::new(text).percute(&["run", "case.toml"]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.starts_with(&format!("error: case.toml:{line}: ")) && said.contains(phrase), "{said}");
    }
    let bench = Bench::new("");
    std::fs::write(bench.path("latin.toml"), b"[mesh]\n# \xe9\n").unwrap();
    let said = stderr(&bench.percute(&["run", "latin.toml"]));
    assert!(said.starts_with("error: latin.toml:2: ") && said.contains("UTF-8"), "{said}");
}

/// Values of all kinds.
const ODD: [&str; 13] = [
    "-1",
    "0",
    "1e300",
    "1e-300",
    "nan",
    "true",
    "\"x\"",
    "[]",
    "[[]]",
    "[[1, 2], 3]",
    "{}",
    "{ x = 1 }",
    "1979-05-27",
];

/// A line with each of its values replaced by each odd one.
fn spoilt(line: &str) -> Vec<String> {
    let mut all = Vec::new();
    for (equals, _) in line.match_indices(" = ") {
        // Inside a table in braces a value ends at the next comma or brace; lists are cut short.
        let (before, after) = line.split_at(equals + 3);
        let inner = line.find('{').is_some_and(|brace| brace < equals);
        let end = if inner { after.find(", ").or(after.find(" }")).unwrap_or(after.len()) } else { after.len() };
        all.extend(ODD.iter().map(|value| format!("{before}{value}{}", &after[end..])));
    }
    all
}

/// With every value replaced by values of all kinds and every line left out in turn, each text is
/// read or refused with a line that exists.
#[test]
fn whatever_is_written_there_is_no_panic() {
    let (mut read, mut refused) = (0, 0);
    let output = BAR.to_string() + "[output]\nhistory = \"a\"\nestimate = \"b\"\ninstants = [0.0]\nfields = true\n";
    for case in [BLOCK, &output, ARRAYS] {
        let lines: Vec<&str> = case.lines().collect();
        for (at, line) in lines.iter().enumerate() {
            for new in spoilt(line).into_iter().chain([String::new()]) {
                let text = [&lines[..at], &[new.as_str()], &lines[at + 1..]].concat().join("\n");
                match Case::parse(Source::new("case.toml", text.clone())) {
                    Ok(_) => read += 1,
                    Err(error) => {
                        refused += 1;
                        assert!((1..=lines.len()).contains(&error.line), "{error}\n{text}");
                        assert!(error.message.len() > 10, "{error}");
                    }
                }
            }
        }
    }
    assert!(read > 20 && refused > 300, "{read} read, {refused} refused");
}
