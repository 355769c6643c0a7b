//! What kind of file a text says it is.

use super::tree::parse;
use super::{Problem, Problems, Sources, Tree};
use space::spelling::nearest;

/// Which of the known kinds a text says it is; none where it does not say.
///
/// # Errors
/// A kind that is not known, at its place.
pub fn kind_of<'a>(name: &str, text: &str, known: &[&'a str]) -> Result<Option<&'a str>, Problems> {
    let mut sources = Sources::default();
    let source = sources.add(name, text);
    // what else is wrong is for the reader of the kind to say
    let tree = parse(&sources, source, &mut Vec::new());
    let Some(node) = tree.get("kind") else { return Ok(None) };
    let Tree::Text(kind) = &node.tree else { return Ok(None) };
    if let Some(found) = known.iter().find(|id| *id == kind) {
        return Ok(Some(found));
    }
    let near = nearest(kind, known.iter().copied());
    let problem = Problem {
        span: node.span.clone(),
        what: format!("no kind of file is called \"{kind}\""),
        expected: format!("expected one of {}", known.join(", ")),
        help: near.map_or_else(String::new, |near| format!("did you mean \"{near}\"?")),
    };
    Err(Problems::new(sources, vec![problem]))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn a_file_says_what_it_is() {
        let known = ["scenario", "study"];
        let of = |text: &str| kind_of("a.toml", text, &known);
        assert_eq!(of("kind = \"study\"\nx = ]").unwrap(), Some("study"), "a damaged file too");
        assert_eq!(of("title = \"x\"").unwrap(), None);
        assert_eq!(of("kind = 3").unwrap(), None);
        let problem = of("kind = \"stady\"").unwrap_err().to_string();
        assert!(problem.contains("did you mean \"study\"?") && problem.contains("a.toml:1:8"), "{problem}");
    }
}
