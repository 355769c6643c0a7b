//! Texts of the user inside markup and inside data.

use serde_json::Value;

/// A text inside XML or HTML, between tags or in a quoted attribute. Control characters, which XML forbids, go.
pub(crate) fn markup(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(letter),
            _ if letter.is_control() => {}
            _ => out.push(letter),
        }
    }
    out
}

/// A text as [`markup`]; what stands between two backticks is code.
pub(super) fn words(text: &str) -> String {
    let text = markup(text);
    let mut parts: Vec<&str> = text.split('`').collect();
    // one that is left over is a backtick
    let lonely = if parts.len().is_multiple_of(2) { parts.pop() } else { None };
    let mut out = String::with_capacity(text.len());
    for (index, part) in parts.into_iter().enumerate() {
        let (before, after) = if index % 2 == 1 { ("<code>", "</code>") } else { ("", "") };
        out.extend([before, part, after]);
    }
    out.extend(lonely.iter().flat_map(|part| ["`", part]));
    out
}

/// Data inside a `<script>` element: JSON in which nothing can end the element or begin a comment.
pub(super) fn data(value: &Value) -> String {
    // these three stand inside strings only, where their escapes mean the same
    value.to_string().replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

/// A file name without anything but letters, digits, `-`, `_` and `.`; the other one where nothing is left.
pub(super) fn file_name(name: &str, otherwise: &str) -> String {
    let keep = |letter: char| if letter.is_alphanumeric() || "-_.".contains(letter) { letter } else { '-' };
    let name: String = name.trim().chars().map(keep).take(80).collect();
    let name = name.trim_matches(['-', '.']);
    if name.is_empty() { otherwise.to_owned() } else { name.to_owned() }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic, reason = "tests")]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn nothing_gets_out() {
        assert_eq!(markup("<b a='1' c=\"2\">&\u{0}x"), "&lt;b a=&#39;1&#39; c=&quot;2&quot;&gt;&amp;x");
        let value = json!({"a": "</script><!-- & \u{2028}"});
        let text = data(&value);
        assert!(!text.contains(['<', '>', '&']));
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }

    #[test]
    fn code_between_backticks() {
        assert_eq!(words("the model `a_b` of `c<d`."), "the model <code>a_b</code> of <code>c&lt;d</code>.");
        assert_eq!(words("plain & simple"), "plain &amp; simple");
        assert_eq!(words("`a` and ` alone"), "<code>a</code> and ` alone");
        assert_eq!(words(""), "");
    }

    #[test]
    fn file_names_are_harmless() {
        assert_eq!(file_name("metrics.csv", "x"), "metrics.csv");
        assert_eq!(file_name("../../etc/passwd", "x"), "etc-passwd");
        assert_eq!(file_name("..", "table-1.csv"), "table-1.csv");
        assert_eq!(file_name("a b\"c", "x"), "a-b-c");
    }
}
