//! Every mistake of `tests/mistakes.toml` that the command can be given is named, and nothing is made.

use crate::common::{ARRAYS, BAR, BLOCK, BODIES, Bench, stderr};
use percute_workflow::case::{Source, parse};
use serde::Deserialize;
use std::process::Output;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Mistakes {
    mistake: Vec<Mistake>,
}

/// See the head of the table; what is for Python alone is not looked at here.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
struct Mistake {
    name: String,
    #[serde(default)]
    base: Base,
    #[serde(default)]
    change: Vec<[String; 2]>,
    text: Option<String>,
    mesh: Option<String>,
    line: Option<usize>,
    #[serde(default)]
    place: String,
    warning: Option<String>,
    shell: Option<Vec<String>>,
    #[serde(default = "two")]
    code: i32,
    says: Vec<String>,
    #[serde(default)]
    unsaid: Vec<String>,
    shell_says: Option<Vec<String>>,
    python_says: Option<Vec<String>>,
    python: Option<String>,
    argument: Option<String>,
    damage: Option<String>,
    of: Option<String>,
    raises: Option<String>,
}

#[derive(Clone, Copy, Default, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Base {
    #[default]
    Block,
    Bar,
    Arrays,
    Bodies,
}

fn two() -> i32 {
    2
}

fn mistakes() -> Vec<Mistake> {
    toml::from_str::<Mistakes>(include_str!("../../../../tests/mistakes.toml")).unwrap().mistake
}

impl Base {
    fn text(self) -> &'static str {
        match self {
            Self::Block => BLOCK,
            Self::Bar => BAR,
            Self::Arrays => ARRAYS,
            Self::Bodies => BODIES,
        }
    }
}

impl Mistake {
    /// The case with the mistake, if it is one in a case.
    fn case(&self) -> Option<String> {
        if self.text.is_some() || self.change.is_empty() {
            return self.text.clone();
        }
        let change = |case: String, [old, new]: &[String; 2]| {
            assert_eq!(case.matches(old).count(), 1, "{}: `{old}` must be in the case once", self.name);
            case.replacen(old, new, 1)
        };
        Some(self.change.iter().fold(self.base.text().to_string(), change))
    }

    /// Complains if something is wrong with what the command did.
    fn judge(&self, output: &Output, code: i32, begins: &str, says: &[String]) -> Result<(), String> {
        let said = stderr(output);
        let told: Vec<&str> = said.split_inclusive('\n').collect();
        let at = told.iter().position(|line| line.starts_with(begins));
        // An error comes last and may have several lines; a warning has one.
        let message = at.map(|at| if self.warning.is_some() { told[at].to_string() } else { told[at..].concat() });
        let complaint = |what: &str| Err(format!("{}: {what}:\n{said}", self.name));
        let Some(message) = message else { return complaint(&format!("nothing begins with `{begins}`")) };
        if output.status.code() != Some(code) {
            return complaint(&format!("exit code {:?}, not {code}", output.status.code()));
        }
        if code != 0 && !output.stdout.is_empty() {
            return complaint("a result was printed");
        }
        if let Some(phrase) = says.iter().find(|phrase| !message.contains(phrase.as_str())) {
            return complaint(&format!("the message does not say `{phrase}`"));
        }
        if let Some(phrase) = self.unsaid.iter().find(|phrase| said.contains(phrase.as_str())) {
            return complaint(&format!("`{phrase}` must not be said"));
        }
        let debug = ["Some(", "Err(", "Ok(", "panicked", "unwrap", "called `"];
        match debug.iter().find(|word| message.contains(**word)) {
            Some(word) => complaint(&format!("`{word}` is no word for users")),
            None => Ok(()),
        }
    }
}

/// All complaints at once.
fn check(complaints: impl IntoIterator<Item = Result<(), String>>) {
    let complaints: Vec<String> = complaints.into_iter().filter_map(Result::err).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn cases_with_a_mistake() {
    check(mistakes().iter().filter_map(|mistake| {
        let bench = Bench::new(&mistake.case()?);
        mistake.mesh.iter().for_each(|mesh| std::fs::write(bench.path("block.msh"), mesh).unwrap());
        let before = bench.files();
        let line = mistake.line.expect("a mistake in a case has a line");
        let place = if mistake.place.is_empty() { String::new() } else { format!("{}: ", mistake.place) };
        let (command, code, kind) = match mistake.warning {
            Some(_) => ("info", 0, "warning"),
            None => ("run", 2, "error"),
        };
        let output = bench.percute(&[command, "case.toml"]);
        assert_eq!(bench.files(), before, "{}", mistake.name);
        Some(mistake.judge(&output, code, &format!("{kind}: case.toml:{line}: {place}"), &mistake.says))
    }));
}

#[test]
fn commands_with_a_mistake() {
    let prepare = |base: Base| {
        let bench = Bench::new(base.text());
        let files = ["run", "case.toml", "--history", "history.vtkhdf", "--estimate", "estimate.vtkhdf"];
        assert_eq!(bench.percute(&files).status.code(), Some(0), "the case without a mistake");
        std::fs::write(bench.path("notes.txt"), "The block fell.\n").unwrap();
        std::fs::create_dir(bench.path("empty")).unwrap();
        bench
    };
    let benches = [Base::Block, Base::Bar, Base::Arrays].map(|base| (base, prepare(base)));
    check(mistakes().iter().filter_map(|mistake| {
        let arguments: Vec<&str> = mistake.shell.as_ref()?.iter().map(String::as_str).collect();
        let bench = &benches.iter().find(|(base, _)| *base == mistake.base)?.1;
        let before = bench.files();
        let output = bench.percute(&arguments);
        assert_eq!(bench.files(), before, "{}", mistake.name);
        Some(mistake.judge(&output, mistake.code, "error: ", mistake.shell_says.as_ref().unwrap_or(&mistake.says)))
    }));
}

/// A block at rest on the ground, under its weight.
const RESTING: &str = r#"[mesh]
rectangle = { width = 0.05, height = 0.04, nx = 5, ny = 4 }

[material]
young = 70e9
poisson = 0.3
density = 2700.0
plane = "stress"

[[obstacle]]
point = [0.0, 0.0]
normal = [0.0, 1.0]
friction = 0.2

[[body_force]]
value = [0.0, -26487.0]

[time]
end = 5e-6
courant = 0.9
"#;

/// The bouncing bar of Doyen, Ern and Piperno (2011), in round numbers.
const NORMALISED: &str = r#"[mesh]
bar = { length = 10.0, elements = 20 }

[material]
young = 900.0
density = 1.0
section = 1.0

[[obstacle]]
point = -5.0
normal = 1.0

[[body_force]]
value = -10.0

[time]
end = 3.0
courant = 0.9
"#;

/// A pile that is driven into hard ground.
const PILE: &str = r#"[mesh]
bar = { length = 30.0, elements = 20 }

[material]
young = 35e9
density = 2400.0
section = 0.16

[initial]
velocity = -3.0

[[obstacle]]
point = -0.01
normal = 1.0

[time]
end = 0.01
courant = 0.9
"#;

/// A case without mistakes has neither errors nor warnings.
#[test]
fn good_cases_have_no_warnings() {
    let examples = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples")).unwrap();
    let examples = examples.map(|entry| entry.unwrap().path()).filter(|path| path.extension() == Some("toml".as_ref()));
    let examples: Vec<_> = examples.map(|path| path.to_str().unwrap().to_string()).collect();
    assert!(examples.len() > 2);
    let bench = Bench::new(BLOCK);
    for (name, text) in
        [("bar.toml", BAR), ("resting.toml", RESTING), ("normalised.toml", NORMALISED), ("pile.toml", PILE)]
    {
        std::fs::write(bench.path(name), text).unwrap();
    }
    let ours = ["case.toml", "bar.toml", "resting.toml", "normalised.toml", "pile.toml"];
    for case in examples.iter().map(String::as_str).chain(ours) {
        let output = bench.percute(&["info", case]);
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""), "{case}");
    }
}

#[test]
fn each_mistake_has_a_name_of_its_own() {
    let mistakes = mistakes();
    let mut names: Vec<&str> = mistakes.iter().map(|mistake| mistake.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), mistakes.len());
    let done = |m: &Mistake| m.case().is_some() || m.shell.is_some() || m.python.is_some() || m.damage.is_some();
    assert!(mistakes.iter().all(done), "an entry does nothing");
}

#[test]
fn a_case_that_is_no_text() {
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
    let output = BAR.to_string()
        + "[output]\nhistory = \"a.vtkhdf\"\nestimate = \"b.vtkhdf\"\ninstants = [0.0]\nfields = true\n";
    for case in [BLOCK, &output, ARRAYS] {
        let lines: Vec<&str> = case.lines().collect();
        for (at, line) in lines.iter().enumerate() {
            for new in spoilt(line).into_iter().chain([String::new()]) {
                let text = [&lines[..at], &[new.as_str()], &lines[at + 1..]].concat().join("\n");
                match parse(Source::new("case.toml", text.clone())) {
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
