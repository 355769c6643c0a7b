//! Texts with names, places in them, and problems shown at their place.

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use core::ops::Range;

/// A place: a text, and bytes in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// Index of the text.
    pub source: usize,
    /// Bytes.
    pub bytes: Range<usize>,
}

/// The texts that make up one input: the file, and each `--set`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    texts: Vec<(String, String)>,
}

impl Sources {
    /// Adds a text by its name; its index.
    pub fn add(&mut self, name: &str, text: &str) -> usize {
        self.texts.push((name.to_owned(), text.to_owned()));
        self.texts.len() - 1
    }
    /// A text.
    pub fn text(&self, source: usize) -> &str {
        self.texts.get(source).map_or("", |(_, text)| text)
    }
    /// The name of a text.
    pub fn name(&self, source: usize) -> &str {
        self.texts.get(source).map_or("", |(name, _)| name)
    }
    /// The name of a source without folder and ending, to call a folder after; none where it has none.
    pub fn stem(&self, source: usize) -> Option<&str> {
        std::path::Path::new(self.name(source)).file_stem().and_then(|stem| stem.to_str())
    }
}

/// Something wrong at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where.
    pub span: Span,
    /// What, in one sentence.
    pub what: String,
    /// What was expected there; shown beside the caret. May be empty.
    pub expected: String,
    /// What would help; may be empty.
    pub help: String,
}

/// All that is wrong with an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problems {
    /// The texts.
    pub sources: Sources,
    /// The problems, in the order of their places.
    pub list: Vec<Problem>,
}

/// More than so many are counted, not shown.
const SHOWN: usize = 20;

impl Problems {
    /// The problems in the order of their places.
    pub fn new(sources: Sources, mut list: Vec<Problem>) -> Self {
        list.sort_by_key(|p| (p.span.source, p.span.bytes.start, p.span.bytes.end));
        list.dedup();
        Self { sources, list }
    }
    /// Written out, with colours where `styled`.
    pub fn show(&self, styled: bool) -> String {
        let renderer = if styled { Renderer::styled() } else { Renderer::plain() };
        let mut out = String::new();
        for problem in self.list.iter().take(SHOWN) {
            let text = self.sources.text(problem.span.source);
            let bytes = visible(text, &problem.span.bytes);
            let mut annotation = AnnotationKind::Primary.span(bytes);
            if !problem.expected.is_empty() {
                annotation = annotation.label(problem.expected.as_str());
            }
            let name = self.sources.name(problem.span.source);
            let snippet = Snippet::source(text).line_start(1).path(name).annotation(annotation);
            let mut group = Group::with_title(Level::ERROR.primary_title(problem.what.as_str())).element(snippet);
            if !problem.help.is_empty() {
                group = group.element(Level::HELP.message(problem.help.as_str()));
            }
            out.push_str(&renderer.render(&[group]));
            out.push('\n');
        }
        let count = self.list.len();
        if count > SHOWN {
            out.push_str(&format!("and {} more\n", count - SHOWN));
        }
        if count > 1 {
            out.push_str(&format!("{count} problems\n"));
        }
        out
    }
}

impl core::fmt::Display for Problems {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(out, "{}", self.show(false))
    }
}
impl core::error::Error for Problems {}

/// The first line of a place: a caret below ten lines of a table says less than one below its name.
fn visible(text: &str, bytes: &Range<usize>) -> Range<usize> {
    let start = bytes.start.min(text.len());
    let end = bytes.end.clamp(start, text.len());
    let first = text.get(start..end).and_then(|part| part.find('\n')).map_or(end, |line| start + line);
    start..first
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_is_shown_at_its_place() {
        let mut sources = Sources::default();
        let source = sources.add("a.toml", "one = 1\ntow = 2\n");
        let problem = Problem {
            span: Span { source, bytes: 8..11 },
            what: "unknown key `tow`".into(),
            expected: "not known here".into(),
            help: "did you mean `two`?".into(),
        };
        let text = Problems::new(sources, vec![problem.clone(), problem]).to_string();
        assert!(text.contains("a.toml:2:1"), "{text}");
        assert!(text.contains("^^^ not known here") && text.contains("did you mean `two`?"), "{text}");
        assert!(!text.contains("problems"), "the same problem is shown once: {text}");
    }

    #[test]
    fn a_place_outside_the_text_does_no_harm() {
        let mut sources = Sources::default();
        let source = sources.add("a.toml", "é");
        let span = |bytes| Span { source, bytes };
        let problem =
            |bytes| Problem { span: span(bytes), what: "x".into(), expected: String::new(), help: String::new() };
        let problems = Problems::new(sources.clone(), vec![problem(7..9), problem(0..0)]);
        assert!(problems.to_string().contains("2 problems"));
    }
}
