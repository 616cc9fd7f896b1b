//! An SVG document, mark by mark. Colours are classes, so that a page can change them in the dark.

use crate::typeset;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// The looks of all classes.
const STYLE: &str = include_str!("svg.css");
/// Light colours, in the place of the variables of a page.
const LIGHT: [(&str, &str); 10] = [
    ("paper", "#ffffff"),
    ("ink", "#282830"),
    ("faint", "#6e6e78"),
    ("grid", "#e2e2e6"),
    ("s0", SERIES[0]),
    ("s1", SERIES[1]),
    ("s2", SERIES[2]),
    ("s3", SERIES[3]),
    ("s4", SERIES[4]),
    ("s5", SERIES[5]),
];
/// The light colours of the lines of a chart, the first line first.
pub const SERIES: [&str; 6] = ["#1f4e8c", "#c2571a", "#2a7f62", "#8b2f7a", "#8a7200", "#5b5b66"];
/// Font sizes of the classes (pixels).
pub(crate) const TITLE: f64 = 19.0;
pub(crate) const LABEL: f64 = 13.0;

/// The place of a text relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// A picture under construction; lengths are pixels.
#[derive(Clone, Debug)]
pub(crate) struct Svg {
    size: [f64; 2],
    body: String,
}

/// A length with a tenth of a pixel.
fn px(x: f64) -> String {
    let text = format!("{x:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0".to_string() } else { text.to_string() }
}

fn list(points: impl IntoIterator<Item = [f64; 2]>) -> String {
    points.into_iter().map(|[x, y]| format!("{},{}", px(x), px(y))).collect::<Vec<_>>().join(" ")
}

impl Svg {
    /// An empty picture of this size.
    pub(crate) fn new(size: [f64; 2]) -> Self {
        Self { size, body: String::new() }
    }

    /// The picture with another one below it.
    pub(crate) fn above(mut self, other: &Self) -> Self {
        self.begin(&format!("transform=\"translate(0,{})\"", px(self.size[1])));
        self.body += &other.body;
        self.end();
        self.size = [self.size[0].max(other.size[0]), self.size[1] + other.size[1]];
        self
    }

    /// Begins a group of marks with these attributes.
    pub(crate) fn begin(&mut self, attributes: &str) {
        self.body += &format!("<g {attributes}>\n");
    }

    /// Ends a group.
    pub(crate) fn end(&mut self) {
        self.body += "</g>\n";
    }

    pub(crate) fn line(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        let [[a, b], [c, d]] = [from.map(px), to.map(px)];
        self.body += &format!("<line class=\"{class}\" x1=\"{a}\" y1=\"{b}\" x2=\"{c}\" y2=\"{d}\"/>\n");
    }

    pub(crate) fn polyline(&mut self, class: &str, points: impl IntoIterator<Item = [f64; 2]>) {
        self.body += &format!("<polyline class=\"{class}\" points=\"{}\"/>\n", list(points));
    }

    /// A filled polygon of a colour that is the same in the dark.
    pub(crate) fn polygon(&mut self, colour: [u8; 3], points: impl IntoIterator<Item = [f64; 2]>) {
        let [r, g, b] = colour;
        self.body += &format!("<polygon fill=\"#{r:02x}{g:02x}{b:02x}\" points=\"{}\"/>\n", list(points));
    }

    /// A rectangle from a corner to the opposite one.
    pub(crate) fn rectangle(&mut self, look: &str, from: [f64; 2], to: [f64; 2]) {
        let [x, y] = [0, 1].map(|c| px(from[c].min(to[c])));
        let [w, h] = [0, 1].map(|c| px((to[c] - from[c]).abs()));
        self.body += &format!("<rect {look} x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/>\n");
    }

    pub(crate) fn circle(&mut self, class: &str, at: [f64; 2], radius: f64) {
        let [x, y] = at.map(px);
        self.body += &format!("<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{}\"/>\n", px(radius));
    }

    /// A text; `turned` reads upwards.
    pub(crate) fn text(&mut self, class: &str, at: [f64; 2], anchor: Anchor, turned: bool, text: &str) {
        let [x, y] = at.map(px);
        let size = if class == "title" { TITLE } else { LABEL };
        let anchor = match anchor {
            Anchor::Start => String::new(),
            Anchor::Middle => " text-anchor=\"middle\"".to_string(),
            Anchor::End => " text-anchor=\"end\"".to_string(),
        };
        let turned = if turned { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
        let text = typeset::svg(text, size);
        self.body += &format!("<text class=\"{class}\" x=\"{x}\" y=\"{y}\"{anchor}{turned}>{text}</text>\n");
    }

    /// A PNG between two corners; the pixels of `cells` keep their edges.
    pub(crate) fn image(&mut self, class: &str, png: &[u8], from: [f64; 2], to: [f64; 2]) {
        let [x, y] = from.map(px);
        let [w, h] = [0, 1].map(|c| px(to[c] - from[c]));
        self.body += &format!(
            "<image class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
             href=\"data:image/png;base64,{}\"/>\n",
            STANDARD.encode(png)
        );
    }

    /// The document of a file: with light colours of its own, on white.
    pub(crate) fn alone(&self) -> String {
        let style =
            LIGHT.iter().fold(STYLE.to_string(), |s, (name, colour)| s.replace(&format!("var(--{name})"), colour));
        let [w, h] = self.size.map(px);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
             <style>{style}</style>\n<rect class=\"paper\" width=\"{w}\" height=\"{h}\"/>\n{}</svg>\n",
            self.body
        )
    }

    /// The element of a page, which has the style; `label` is its text for screen readers.
    pub(crate) fn inside(&self, label: &str) -> String {
        let [w, h] = self.size.map(px);
        let label = typeset::escaped(label);
        format!(
            "<svg viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\" role=\"img\" aria-label=\"{label}\">\n{}</svg>",
            self.body
        )
    }

    /// The marks alone, without a background: what is not drawn is transparent.
    pub(crate) fn transparent(&self) -> String {
        let [w, h] = self.size.map(px);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} \
             {h}\">\n{}</svg>\n",
            self.body
        )
    }
}

/// The style of a page that contains pictures, and its light colours as declarations.
pub(crate) fn style() -> (&'static str, String) {
    (STYLE, LIGHT.iter().map(|(name, colour)| format!("--{name}:{colour};")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_no_variables_left() {
        assert!(!Svg::new([10.0, 10.0]).alone().contains("var("));
        assert_eq!([0.04, -0.04, 1.25, 300.0].map(px), ["0", "0", "1.2", "300"]);
    }
}
