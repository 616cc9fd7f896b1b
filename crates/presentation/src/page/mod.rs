//! The page that hands an estimate over: one HTML file, which needs nothing else.

mod about;
mod contact;
mod error;
mod html;
mod model;
mod numbers;
mod place;
mod reproduce;
mod verdict;
mod yielding;

pub use crate::chart::Surface;
pub use about::About;

use crate::body::Body;
use crate::document::Document;
use crate::svg;
use crate::typeset::escaped;
use std::path::Path;

/// The looks of the page.
const STYLE: &str = include_str!("page.css");

/// What a page is made of.
#[derive(Clone, Copy, Debug)]
pub struct Contents<'a> {
    /// Title, author and program.
    pub about: &'a About,
    /// The JSON document.
    pub document: &'a Document,
    /// The mesh.
    pub body: &'a Body,
    /// The problem in the language of the case files.
    pub statement: &'a str,
    /// The case file as given.
    pub case: Option<&'a percute_io::Case>,
    /// Contact of all nodes at all instants, of each plane and each two bodies.
    pub surfaces: &'a [Surface],
}

/// The page, for a browser and for paper (A4), that will lie in a folder.
#[must_use]
pub fn page(contents: &Contents<'_>, folder: &Path) -> String {
    let document = contents.document;
    let (marks, light) = svg::style();
    let title = contents.about.title.clone().unwrap_or_else(|| match document.name() {
        name if name.is_empty() => "Error of a simulation".to_string(),
        name => format!("Error of {name}"),
    });
    let sections = [
        verdict::section(document),
        error::map(contents),
        error::over_time(document),
        error::sources(document),
        contact::section_of(contents),
        yielding::section(document),
        model::balance(document),
        model::section_of(contents),
        reproduce::section(contents, folder),
        numbers::section(document),
    ];
    let style = STYLE.replace("/*light*/", &light);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n<style>\n{style}{marks}</style>\n\
         </head>\n<body>\n<main>\n{}{}</main>\n</body>\n</html>\n",
        verdict::head(contents),
        sections.join(""),
        title = escaped(&title),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::Mesh;
    use percute_io::Case;

    /// The page of a document on a mesh of two triangles.
    fn shown(document: &str, case: Option<&Case>) -> String {
        shown_about(&About::default(), document, case)
    }

    fn shown_about(about: &About, document: &str, case: Option<&Case>) -> String {
        let points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let mesh = Mesh::new(points, &[[0, 1, 2], [0, 2, 3]], &Default::default(), &Default::default()).unwrap();
        let (document, body) = (Document::parse(document).unwrap(), Body::new(&mesh));
        page(&Contents { about, document: &document, body: &body, statement: "", case, surfaces: &[] }, Path::new(""))
    }

    #[test]
    fn a_history_without_a_case_says_how_it_was_made() {
        let about = |rest: &str| {
            let options = r#""options": {"reconstruction": "corrected", "every": 2}"#;
            shown(&format!(r#"{{"error": {{"sup": 1.5}}, "end": 1e-3, "time_step": 1e-5, {options}, {rest}}}"#), None)
        };
        let arrays = about(r#""case": "", "consistency": {"balance": 0}"#);
        assert!(arrays.contains("made from arrays of another program in Python"), "{arrays}");
        let simulated = about(r#""case": """#);
        assert!(simulated.contains("The history was simulated in Python and is in no file"), "{simulated}");
        let command = "percute estimate history.vtkhdf --reconstruction corrected --every 2 --report report.html";
        for page in [arrays, simulated] {
            assert!(page.contains("<pre>estimate.history.save(&quot;history.vtkhdf&quot;)</pre>"), "{page}");
            assert!(page.contains(command) && page.contains("<title>Error of a simulation</title>"), "{page}");
            // What a reader cannot run is no command.
            assert!(!page.contains("percute.simulate(") && !page.contains("from_arrays("), "{page}");
        }
        let named = about(r#""case": "a.vtkhdf", "consistency": {}, "simulated_by": "Akantu <5>""#);
        assert!(named.contains("<code>Akantu &lt;5&gt;</code> simulated it, and no case file"), "{named}");
        let stored = about(r#""case": "runs/their.vtkhdf", "consistency": {}"#);
        assert!(stored.contains("percute estimate their.vtkhdf --reconstruction corrected --every 2"), "{stored}");
        assert!(stored.contains("another program simulated it"), "{stored}");
    }

    #[test]
    fn yielding_has_its_places() {
        let page = |materials: &str| {
            let bodies = r#"[{"name": "body 0", "permanent_strain": [-0.01, 0.004, 0.0]}]"#;
            let of = format!(r#""deformation": {{"bodies": {bodies}, "materials": [{materials}]}}"#);
            shown(&format!(r#"{{"error": {{"sup": 1.5}}, {of}}}"#), None)
        };
        let stress = r#""von_mises": {"value": 3.2e8, "element": 1, "centroid": [0.25, 0.5], "time": 2e-6}"#;
        let plastic = r#"{"equivalent_strain": {"value": 0.02, "element": 0, "centroid": [0.5, 0.125], "time": 3e-6},
            "mean_equivalent_strain": 0.005}"#;
        let first = r#""first": 1e-6, "first_place": {"element": 1, "centroid": [0.25, 0.5]}"#;
        let yielding = format!(
            r#"{{"group": "rib", {stress}, "yielding": {{"yield_stress": 3e8, "stress_ratio": 1.0667, "share": 0.5,
            {first}, "plastic": {plastic}}}}}"#
        );
        let told = page(&yielding);
        let words = ["<h2>Yielding</h2>", "Material of “rib”", "107\u{a0}%", "(0.25, 0.5)", "(0.5, 0.125)", "-0.01"];
        for words in words {
            let plain = words.replace('\u{a0}', " ");
            assert!(told.contains(words) || told.contains(&plain), "{words}: {told}");
        }
        assert!(!shown(r#"{"error": {"sup": 1.5}}"#, None).contains("Yielding"));
    }

    #[test]
    fn the_head_has_title_author_and_program() {
        let text = |text: &str| Some(text.to_string());
        let document = r#"{"error": {"sup": 1.5}, "case": "a/b.vtkhdf", "consistency": {}, "simulated_by": "One"}"#;
        let head = |about: &About| {
            let page = shown_about(about, document, None);
            let title = page.split("<title>").nth(1).unwrap().split("</title>").next().unwrap().to_string();
            let rest = page.split("<main>").nth(1).unwrap();
            (title, rest.split("<section>").next().unwrap().to_string())
        };
        let (title, plain) = head(&About::default());
        assert_eq!(title, "Error of b.vtkhdf");
        assert!(plain.contains("<h1>Error of the simulation b.vtkhdf</h1>\n<p class=\"faint\">simulated by One, "));
        let about = About { title: text("Drop <test>"), author: text("A & B"), program: text("\"Two\"") };
        let (title, told) = head(&about);
        assert_eq!(title, "Drop &lt;test&gt;");
        let wanted = "<h1>Drop &lt;test&gt;</h1>\n<p>A &amp; B</p>\n<p class=\"faint\">Error of the simulation \
                      b.vtkhdf · simulated by &quot;Two&quot;, estimated by ";
        assert!(told.contains(wanted), "{told}");
        let page = shown_about(&about, document, None);
        let command = "--output estimate.vtkhdf\npercute report estimate.vtkhdf report.html \
                       --title &#39;Drop &lt;test&gt;&#39; \
                       --author &#39;A &amp; B&#39; --program";
        assert!(page.contains(command) && !page.contains("--report"), "{page}");
    }

    #[test]
    fn the_mesh_file_of_a_case_is_named() {
        let case = |text: &str| Case { name: "a/beam.toml".to_string(), text: text.to_string() };
        let document = r#"{"error": {"sup": 1.5}, "case": "beam.toml"}"#;
        let page = shown(document, Some(&case("[mesh]\nfile = \"beam.msh\"\n")));
        assert!(page.contains("mesh file <code>beam.msh</code>, which gives 2 triangles and 4 nodes"), "{page}");
        assert!(page.contains("percute run beam.toml --report report.html"), "{page}");
        assert!(!shown(document, Some(&case("[mesh]\nbar = {}\n"))).contains("mesh file"));
    }

    #[test]
    fn a_document_of_an_earlier_version_has_a_page() {
        let html = shown(r#"{"error": {"sup": 1.5}}"#, None);
        assert!(html.contains("<h2>Error of the elements</h2>") && html.ends_with("</html>\n"));
        for absent in ["<h2>Contact</h2>", "<h2>Sources of the error</h2>", "Trust:", "NaN"] {
            assert!(!html.contains(absent), "{absent}");
        }
    }

    #[test]
    fn a_motion_that_is_no_rebound_has_its_reason() {
        let about = |rebound: &str| {
            let contact = r#""contact": {"first_touch": 1e-6}"#;
            shown(&format!(r#"{{"error": {{"sup": 1.5}}, {contact}, "rebound": {{{rebound}}}}}"#), None)
        };
        let held = about(r#""restitution": null, "no_restitution": "supports change the velocity, too""#);
        let reason = "There is no coefficient of restitution: supports change the velocity, too.</p>";
        assert!(held.contains(reason) && held.contains("<th>centre of mass</th>"), "{held}");
        let free = about(r#""restitution": 0.5, "no_restitution": null"#);
        assert!(free.contains("<th>rebound</th>") && !free.contains("There is no coefficient"), "{free}");
        assert!(!held.contains("no restitution</td>") && !free.contains("no restitution</td>"));
    }

    #[test]
    fn negative_sources_are_explained() {
        let about = |mesh: f64| {
            let mean = format!(r#"{{"surface": 1.0, "front": 2.0, "dispersion": 3.0, "mesh": {mesh}}}"#);
            let html = shown(&format!(r#"{{"error": {{"sup": 1.5}}, "sources": {{"mean": {mean}}}}}"#), None);
            (html.contains("A source may be negative"), html.matches("class=\"bar\"").count())
        };
        assert_eq!(about(-0.5), (true, 3));
        assert_eq!(about(0.5), (false, 4));
    }

    #[test]
    fn verdict_rebound_and_consistency_are_shown_where_they_are_known() {
        let html = shown(
            r#"{"error": {"sup": 1.5}, "verdict": {"trust": "limited", "text": ["Refine <there>.", "Keep Δt_c."]},
                "contact": {"first_touch": 1e-6}, "consistency": {"balance": 2.5e-9},
                "rebound": {"restitution": 0.875, "velocity_before": [0.0, -4.0], "velocity_after": null,
                            "ended": false}}"#,
            None,
        );
        for part in [
            "<div class=\"verdict limited\"><p><b class=\"trust\">Trust: limited</b></p>",
            "<p>Refine &lt;there&gt;.</p>\n<p>Keep Δ<i>t</i><sub>c</sub>.</p>",
            "<dt>Restitution</dt><dd>0.875<",
            "before contact</td><td class=\"n\">(0,\u{a0}−4)\u{a0}m/s</td>",
            "<td>velocity V′ after contact</td><td class=\"n\">–</td>",
            "<td>contact has ended</td><td class=\"n\">no</td>",
            "over its largest term</td><td class=\"n\">2.50×10<sup>−7</sup>\u{a0}%",
        ] {
            assert!(html.contains(part), "{part}");
        }
    }
}
