//! The page of an estimate.

use crate::common::{ARRAYS, BAR, BLOCK, Bench, stderr};
use serde_json::Value;

/// The page of a case in a file of this name, and the JSON document of the same run.
fn page(bench: &Bench, case: &str) -> (String, Value) {
    let output = bench.percute(&["run", case, "--report", "page.html", "--json", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let page = std::fs::read_to_string(bench.path("page.html")).unwrap();
    (page, serde_json::from_slice(&output.stdout).unwrap())
}

/// All single numbers below a value, without lists of more than eight.
fn numbers(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Number(number) => found.push(number.to_string()),
        Value::Array(all) if all.len() <= 8 => all.iter().for_each(|one| numbers(one, found)),
        Value::Object(all) => all.values().for_each(|one| numbers(one, found)),
        _ => {}
    }
}

#[test]
fn a_page_has_all_numbers_and_needs_nothing_else() {
    for (case, figures) in [(BLOCK, 6), (BAR, 5), (ARRAYS, 2)] {
        let (page, mut document) = page(&Bench::new(case), "case.toml");
        // A page is the same for identical runs.
        document["seconds"] = Value::Null;
        let mut all = Vec::new();
        numbers(&document, &mut all);
        assert!(all.len() > 60, "{}", all.len());
        for number in all {
            assert!(page.contains(&number), "{number} is missing");
        }
        assert!(page.matches("<figure>").count() >= figures, "{}", page.matches("<figure>").count());
        for outside in ["src=", "http:", "https:", "<script", "@import", "url(", "<link"] {
            assert!(!page.contains(outside), "{outside}");
        }
        for raw in ["Δt_c", "J^½", "e_E", "e_mean"] {
            let body = page.split("<body>").nth(1).unwrap();
            let shown = body
                .split("<h2>All numbers")
                .next()
                .unwrap()
                .split("<pre>")
                .map(|part| part.split_once("</pre>").map_or(part, |(_, after)| after).to_string());
            assert!(!shown.collect::<String>().contains(raw), "{raw} is not typeset");
        }
    }
}

#[test]
fn names_and_texts_mean_nothing_to_a_browser() {
    let bench = Bench::new("");
    let name = "<script>alert(1)<&\"'.toml".replace('/', "");
    std::fs::write(bench.path(&name), format!("{BAR}\n# <img onerror=\"x\"> & more\n")).unwrap();
    let (page, _) = page(&bench, &name);
    assert!(!page.contains("<script") && !page.contains("<img"));
    assert!(page.contains("&lt;script&gt;alert(1)&lt;&amp;&quot;&#39;.toml"));
    assert!(page.contains("# &lt;img onerror=&quot;x&quot;&gt; &amp; more"));
}

#[test]
fn case_history_and_estimate_give_the_same_page() {
    let bench = Bench::new(BLOCK);
    let done = |arguments: &[&str]| {
        let output = bench.percute(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    };
    done(&["run", "case.toml", "--history", "h.vtkhdf", "--estimate", "e.vtkhdf", "--report", "run.html"]);
    done(&["report", "case.toml"]);
    done(&["report", "h.vtkhdf"]);
    done(&["report", "e.vtkhdf", "e-page.html"]);
    let read = |name: &str| std::fs::read_to_string(bench.path(name)).unwrap();
    // Without the duration of the work, and for the history without its name and commands.
    let steady = |page: String| {
        let without = [
            "seconds",
            "duration of the work",
            "<h1>",
            "<title>",
            "percute run",
            "percute simulate",
            "percute estimate",
            ">case<",
        ];
        page.lines()
            .filter(|line| !without.iter().any(|word| line.contains(word)))
            .map(str::to_string)
            .collect::<Vec<_>>()
    };
    let run = steady(read("run.html"));
    assert!(run.len() > 500);
    assert_eq!(steady(read("case.html")), run);
    assert_eq!(steady(read("e-page.html")), run);
    assert_eq!(steady(read("h.html")), run);
    let history = read("h.html");
    assert!(history.contains(
        "percute simulate case.toml --history h.vtkhdf\npercute estimate h.vtkhdf --reconstruction corrected"
    ));
}

#[test]
fn a_large_mesh_is_drawn_with_pixels() {
    let large = BLOCK.replace("nx = 5, ny = 4", "nx = 64, ny = 64").replace("end = 5e-6", "end = 4e-8");
    let (page, document) = page(&Bench::new(&large), "case.toml");
    assert_eq!(document["problem"]["elements"], 2 * 64 * 64);
    assert!(page.contains("data:image/png;base64,") && page.matches("<polygon").count() < 200);
    assert!(page.len() < 1_500_000, "{} bytes", page.len());
}

#[test]
fn pages_that_cannot_be_made_fail_before_the_work() {
    let bench = Bench::new(BAR);
    let output = bench.percute(&["report", "case.toml", "page.pdf"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains(".html"), "{}", stderr(&output));
    let output = bench.percute(&["report", "cas.toml"]);
    assert!(stderr(&output).contains("case.toml"), "{}", stderr(&output));
    assert_eq!(bench.files(), ["case.toml"]);
}

#[test]
fn the_head_of_a_page_is_stated() {
    let bench = Bench::new(BLOCK);
    let head = ["--title", "A <b>", "--author", "B & C"];
    let done = bench.percute(&[&["report", "case.toml", "--quiet"][..], &head].concat());
    assert_eq!(done.status.code(), Some(0), "{}", stderr(&done));
    let page = std::fs::read_to_string(bench.path("case.html")).unwrap();
    assert!(page.contains("<title>A &lt;b&gt;</title>"), "{}", &page[..400]);
    assert!(page.contains(
        "<h1>A &lt;b&gt;</h1>\n<p>B &amp; C</p>\n<p class=\"faint\">Error of the simulation case.toml · percute"
    ));
    // Refused before the run: percute is the program, and a text has a word.
    for (wrong, told) in
        [(["--program", "Akantu"], "percute simulated this"), (["--title", " "], "`title` has no word")]
    {
        let done = bench.percute(&[&["report", "case.toml", "none.html"][..], &wrong].concat());
        assert!(done.status.code() == Some(2) && stderr(&done).contains(told), "{}", stderr(&done));
    }
    assert!(!bench.path("none.html").exists());
}
