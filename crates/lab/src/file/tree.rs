//! The tree of a TOML text: every value knows its place.

use super::source::{Problem, Sources, Span};
use toml::de::{DeTable, DeValue};

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// A number; whole numbers are kept as such.
    Number(f64),
    /// A whole number.
    Whole(i64),
    /// True or false.
    Truth(bool),
    /// A text.
    Text(String),
    /// A list.
    List(Vec<Node>),
    /// A table, in the order of the file.
    Table(Vec<Entry>),
}

/// A key with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Place of the key.
    pub span: Span,
    /// The value.
    pub node: Node,
}

/// A value with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The value.
    pub tree: Tree,
    /// Its place.
    pub span: Span,
}

impl From<f64> for Tree {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}
impl From<bool> for Tree {
    fn from(value: bool) -> Self {
        Self::Truth(value)
    }
}
impl From<&str> for Tree {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}

impl Tree {
    /// A table of values that have no place.
    pub fn table(entries: impl IntoIterator<Item = (String, Self)>) -> Self {
        let entry = |(key, tree)| Entry { key, span: Span::default(), node: Node { tree, span: Span::default() } };
        Self::Table(entries.into_iter().map(entry).collect())
    }
    /// A list of values that have no place.
    pub fn list(values: impl IntoIterator<Item = Self>) -> Self {
        Self::List(values.into_iter().map(|tree| Node { tree, span: Span::default() }).collect())
    }
    /// What kind of value it is, in words.
    pub fn describe(&self) -> String {
        match self {
            Self::Number(number) => written(*number),
            Self::Whole(number) => number.to_string(),
            Self::Truth(truth) => truth.to_string(),
            Self::Text(text) if text.chars().count() > 40 => "a long text".into(),
            Self::Text(text) => format!("\"{text}\""),
            Self::List(list) => format!("a list of {}", list.len()),
            Self::Table(_) => "a table".into(),
        }
    }
    /// The number, of either kind.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Whole(number) => Some(*number as f64),
            _ => None,
        }
    }
    /// As JSON. Numbers that JSON cannot hold become null.
    pub fn json(&self) -> serde_json::Value {
        match self {
            Self::Number(number) => serde_json::Value::from(*number),
            Self::Whole(number) => serde_json::Value::from(*number),
            Self::Truth(truth) => serde_json::Value::from(*truth),
            Self::Text(text) => serde_json::Value::from(text.as_str()),
            Self::List(list) => list.iter().map(|node| node.tree.json()).collect(),
            Self::Table(entries) => {
                serde_json::Value::Object(entries.iter().map(|e| (e.key.clone(), e.node.tree.json())).collect())
            }
        }
    }
    fn entry(&self, key: &str) -> Option<&Entry> {
        if let Self::Table(entries) = self { entries.iter().find(|e| e.key == key) } else { None }
    }
}

/// A number as it is told, never with hundreds of digits.
pub fn written(number: f64) -> String {
    let size = number.abs();
    let long = size.is_finite() && (size > 1e15 || (size < 1e-6 && size > 0.0));
    if long { format!("{number:e}") } else { number.to_string() }
}

impl Node {
    /// The value of a key; none where this is no table.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.tree.entry(key).map(|e| &e.node)
    }
    /// The place that says most about a path like `group.fish.count`: that of its last key, or of the nearest part
    /// of the path that is there.
    pub fn place(&self, path: &str) -> Span {
        self.found(path, false)
    }
    /// As [`Self::place`], of the last key itself and not of its value.
    pub fn key_place(&self, path: &str) -> Span {
        self.found(path, true)
    }
    fn found(&self, path: &str, of_key: bool) -> Span {
        let mut node = self;
        let mut span = self.span.clone();
        for part in path.split('.').filter(|part| !part.is_empty()) {
            let next = match &node.tree {
                Tree::Table(_) => node.tree.entry(part).map(|e| (&e.node, &e.span)),
                Tree::List(list) => part.parse().ok().and_then(|k: usize| list.get(k)).map(|n| (n, &n.span)),
                _ => None,
            };
            let Some((below, key)) = next else { break };
            span = if of_key || matches!(below.tree, Tree::Table(_)) { key.clone() } else { below.span.clone() };
            node = below;
        }
        span
    }
    /// The table on the way of a path that is not there yet, and the names of those beside which it would be.
    pub fn new_name(&self, path: &str) -> Option<(String, Vec<String>)> {
        let (first, rest) = path.split_once('.')?;
        let Tree::Table(entries) = &self.tree else { return None };
        match self.get(first) {
            Some(below) => below.new_name(rest),
            None => Some((first.to_owned(), entries.iter().map(|entry| entry.key.clone()).collect())),
        }
    }
    /// The same value, read from a text that began `by` bytes later.
    fn moved(mut self, by: usize) -> Self {
        fn move_by(span: &mut Span, by: usize) {
            span.bytes = span.bytes.start + by..span.bytes.end + by;
        }
        move_by(&mut self.span, by);
        match &mut self.tree {
            Tree::List(list) => *list = core::mem::take(list).into_iter().map(|node| node.moved(by)).collect(),
            Tree::Table(entries) => {
                for entry in entries.iter_mut() {
                    move_by(&mut entry.span, by);
                }
                let moved = |entry: Entry| Entry { node: entry.node.moved(by), ..entry };
                *entries = core::mem::take(entries).into_iter().map(moved).collect();
            }
            _ => {}
        }
        self
    }
    /// Puts a value at a path, making tables on the way.
    ///
    /// # Errors
    /// Where something on the way is no table and no list with this entry.
    pub fn set(&mut self, path: &str, value: Node) -> Result<(), String> {
        let (first, rest) = path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)));
        if first.is_empty() {
            return Err(format!("a part of the path is empty before `{path}`"));
        }
        if rest.is_some() && self.tree == Tree::Text(first.to_owned()) {
            // a choice may be written as a word, which stands for a table with that key
            let node = Node { tree: Tree::Table(Vec::new()), span: self.span.clone() };
            self.tree = Tree::Table(vec![Entry { key: first.to_owned(), span: self.span.clone(), node }]);
        }
        match &mut self.tree {
            Tree::Table(entries) => {
                let at = match entries.iter().position(|e| e.key == first) {
                    Some(at) => at,
                    None => {
                        let node = Node { tree: Tree::Table(Vec::new()), span: value.span.clone() };
                        entries.push(Entry { key: first.to_owned(), span: value.span.clone(), node });
                        entries.len() - 1
                    }
                };
                match rest {
                    Some(rest) => entries[at].node.set(rest, value),
                    None => {
                        entries[at].span = value.span.clone();
                        entries[at].node = value;
                        Ok(())
                    }
                }
            }
            Tree::List(list) => {
                let count = list.len();
                let entry = first.parse::<usize>().ok().and_then(|k| list.get_mut(k));
                match (entry, rest) {
                    (Some(node), Some(rest)) => node.set(rest, value),
                    (Some(node), None) => {
                        *node = value;
                        Ok(())
                    }
                    (None, _) => {
                        Err(format!("`{first}` names none of the {count} entries of a list; they count from 0"))
                    }
                }
            }
            other => Err(format!("`{first}` would lie below {}, which is no table", other.describe())),
        }
    }
}

/// Reads a TOML text. What can be read of a damaged one comes with the problems.
pub fn parse(sources: &Sources, source: usize, problems: &mut Vec<Problem>) -> Node {
    let (table, errors) = DeTable::parse_recoverable(sources.text(source));
    for error in errors {
        let bytes = error.span().unwrap_or(0..0);
        let what = error.message().trim().replace('\n', ", ");
        problems.push(Problem {
            span: Span { source, bytes },
            what: format!("not TOML: {what}"),
            expected: String::new(),
            help: String::new(),
        });
    }
    let bytes = table.span();
    Node { tree: of_table(table.get_ref(), source, problems), span: Span { source, bytes } }
}

/// Reads one TOML value, as on the right of a `--set`; a bare word is a text.
pub fn parse_value(sources: &Sources, source: usize, from: usize, problems: &mut Vec<Problem>) -> Node {
    let text = sources.text(source);
    let right = text.get(from..).unwrap_or("");
    let span = Span { source, bytes: from..text.len() };
    match DeValue::parse(right) {
        Ok(value) => {
            // the parser counts from the value, and a caret stands below the whole text
            let (own, before) = (Span { source, bytes: 0..right.len() }, problems.len());
            let node = Node { tree: of_value(value.get_ref(), &own, source, problems), span: own };
            for problem in &mut problems[before..] {
                problem.span.bytes = problem.span.bytes.start + from..problem.span.bytes.end + from;
            }
            node.moved(from)
        }
        Err(_) if !right.is_empty() && right.chars().all(|c| c.is_alphanumeric() || "_-/. ".contains(c)) => {
            Node { tree: Tree::Text(right.to_owned()), span }
        }
        Err(error) => {
            problems.push(Problem {
                span: span.clone(),
                what: format!("not a value: {}", error.message()),
                expected: "a number, a text, true, false, or a list in brackets".into(),
                help: String::new(),
            });
            Node { tree: Tree::Text(String::new()), span }
        }
    }
}

fn of_table(table: &DeTable<'_>, source: usize, problems: &mut Vec<Problem>) -> Tree {
    let entries = table.iter().map(|(key, value)| {
        let place = Span { source, bytes: value.span() };
        let tree = of_value(value.get_ref(), &place, source, problems);
        Entry {
            key: key.get_ref().to_string(),
            span: Span { source, bytes: key.span() },
            node: Node { tree, span: place },
        }
    });
    Tree::Table(entries.collect())
}

fn of_value(value: &DeValue<'_>, place: &Span, source: usize, problems: &mut Vec<Problem>) -> Tree {
    match value {
        DeValue::String(text) => Tree::Text(text.to_string()),
        DeValue::Integer(number) => {
            let digits: String = number.as_str().chars().filter(|&c| c != '_').collect();
            match (i64::from_str_radix(&digits, number.radix()), digits.parse()) {
                (Ok(whole), _) => Tree::Whole(whole),
                // too large for a whole number
                (Err(_), Ok(large)) => Tree::Number(large),
                (Err(_), Err(_)) => {
                    problems.push(Problem {
                        span: place.clone(),
                        what: "not TOML: a number without digits, or too large".into(),
                        expected: "a number".into(),
                        help: String::new(),
                    });
                    Tree::Whole(0)
                }
            }
        }
        DeValue::Float(number) => {
            let digits: String = number.as_str().chars().filter(|&c| c != '_').collect();
            Tree::Number(digits.parse().unwrap_or(f64::NAN))
        }
        DeValue::Boolean(truth) => Tree::Truth(*truth),
        DeValue::Datetime(date) => {
            problems.push(Problem {
                span: place.clone(),
                what: format!("a date, {date}, has no meaning here"),
                expected: "a number, a text, true, false, a list or a table".into(),
                help: String::new(),
            });
            Tree::Text(date.to_string())
        }
        DeValue::Array(list) => Tree::List(
            list.iter()
                .map(|entry| {
                    let span = Span { source, bytes: entry.span() };
                    Node { tree: of_value(entry.get_ref(), &span, source, problems), span }
                })
                .collect(),
        ),
        DeValue::Table(table) => of_table(table, source, problems),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn read(text: &str) -> (Node, Vec<Problem>) {
        let mut sources = Sources::default();
        let source = sources.add("a.toml", text);
        let mut problems = Vec::new();
        (parse(&sources, source, &mut problems), problems)
    }

    #[test]
    fn values_and_places() {
        let text = "a = 1_000\n[b.c]\nd = [1.5, true, \"x\", 0x10]\ne = { f = -inf }\n";
        let (node, problems) = read(text);
        assert!(problems.is_empty());
        assert_eq!(node.get("a").unwrap().tree, Tree::Whole(1000));
        let list = node.get("b").unwrap().get("c").unwrap().get("d").unwrap();
        let Tree::List(entries) = &list.tree else { unreachable!() };
        assert_eq!(entries[0].tree, Tree::Number(1.5));
        assert_eq!(entries[3].tree, Tree::Whole(16));
        let of = |path: &str| text[node.place(path).bytes].to_owned();
        assert_eq!(of("b.c.d.2"), "\"x\"");
        assert_eq!(of("b.c.d.9"), "[1.5, true, \"x\", 0x10]");
        assert_eq!(of("b.c.e.f"), "-inf");
        assert_eq!(of("b.c.nothing"), "c");
        let key = |path: &str| text[node.key_place(path).bytes].to_owned();
        assert_eq!([key("b.c.e.f"), key("a"), key("b.c.nothing")], ["f", "a", "c"]);
    }

    #[test]
    fn every_mistake_of_a_text_is_found() {
        let (node, problems) = read("a = \nb = 2\nc = 1979-05-27\nd = ]\n");
        assert!(problems.len() >= 3, "{problems:?}");
        assert_eq!(node.get("b").unwrap().tree, Tree::Whole(2));
    }

    #[test]
    fn a_value_behind_its_path_knows_its_place_in_the_whole_text() {
        let mut sources = Sources::default();
        let text = "a.b={ c = [1, 1979-05-27] }";
        let source = sources.add("--set", text);
        let mut problems = Vec::new();
        let node = parse_value(&sources, source, 4, &mut problems);
        assert_eq!(&text[node.place("c.0").bytes], "1");
        assert_eq!(&text[node.place("c").bytes], "[1, 1979-05-27]");
        assert_eq!(&text[problems[0].span.bytes.clone()], "1979-05-27");
    }

    #[test]
    fn a_new_name_is_told_from_those_beside_it() {
        let (node, _) = read("[group.fish]\ncount = 1\n[group.bird]\ncount = 2\n");
        let beside = Some(("fsh".to_owned(), vec!["fish".to_owned(), "bird".to_owned()]));
        assert_eq!(node.new_name("group.fsh.count"), beside);
        assert_eq!(node.new_name("group.fish.model.x"), Some(("model".to_owned(), vec!["count".to_owned()])));
        assert_eq!(node.new_name("group.fish.new"), None);
        assert_eq!(node.new_name("group.fish.count"), None);
    }

    #[test]
    fn a_value_is_put_at_a_path() {
        let (mut node, _) = read("a.b = 1\nl = [1, 2]\n");
        let two = Node { tree: Tree::Whole(2), span: Span::default() };
        node.set("a.b", two.clone()).unwrap();
        node.set("a.new.deep", two.clone()).unwrap();
        node.set("l.1", two.clone()).unwrap();
        assert_eq!(node.tree.json().to_string(), r#"{"a":{"b":2,"new":{"deep":2}},"l":[1,2]}"#);
        assert!(node.set("a.b.c", two.clone()).unwrap_err().contains("no table"));
        assert!(node.set("l.7", two.clone()).unwrap_err().contains("count from 0"));
        assert!(node.set("a..c", two).is_err());
    }
}
