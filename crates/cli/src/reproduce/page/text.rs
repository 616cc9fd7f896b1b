//! Text in HTML.

/// Text without characters that HTML takes for its own.
pub(in crate::reproduce) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Text in which what stands between `backticks` is set as code.
pub(in crate::reproduce) fn rich(text: &str) -> String {
    let piece = |(k, piece): (usize, &str)| {
        let piece = escape(piece);
        if k % 2 == 1 { format!("<code>{piece}</code>") } else { piece }
    };
    text.split('`').enumerate().map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_of_a_text_is_markup() {
        assert_eq!(rich("a < b & `c > \"d\"` e"), "a &lt; b &amp; <code>c &gt; &quot;d&quot;</code> e");
    }
}
