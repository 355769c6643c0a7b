//! A small language of expressions: numbers, truths, texts and lists, names that somebody else knows, and nothing that
//! could change anything.
//!
//! `if(density > 0, round(density / 100 * size^3), 0)`; `mean(coverage[variant = prob, N = 6]) > 1.2 * coverage[N = 1]`.
//! Operators, the loosest first: `or`; `and`; `not`; `= == != < <= > >=`; `+ -`; `* /`; `-` as a sign; `^`. What works on
//! numbers works on lists, entry by entry.

use core::ops::Range;
use space::Real;
use space::spelling::nearest;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// True or false.
    Truth(bool),
    /// A text.
    Text(String),
    /// A list.
    List(Vec<Value>),
}

impl Value {
    /// What it is, in words.
    pub fn describe(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Truth(truth) => truth.to_string(),
            Self::Text(text) => format!("the text '{text}'"),
            Self::List(list) => format!("a list of {}", list.len()),
        }
    }
    /// The number it is; none for anything else.
    pub fn number(&self) -> Option<f64> {
        if let Self::Number(number) = self { Some(*number) } else { None }
    }
    /// Whether it is true everywhere; none where it is no truth.
    pub fn truth(&self) -> Option<bool> {
        match self {
            Self::Truth(truth) => Some(*truth),
            Self::List(list) => list.iter().map(Self::truth).try_fold(true, |all, truth| Some(all && truth?)),
            _ => None,
        }
    }
}

/// What is wrong with an expression, and which bytes of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// Where.
    pub bytes: Range<usize>,
    /// What.
    pub what: String,
    /// What would help; may be empty.
    pub help: String,
    /// Whether the expression is right, and only the numbers at hand give it no value.
    pub of_numbers: bool,
}

impl Mistake {
    /// Something wrong at a place.
    pub fn new(bytes: Range<usize>, what: impl Into<String>) -> Self {
        Self { bytes, what: what.into(), help: String::new(), of_numbers: false }
    }
}

/// A condition on a factor, in the brackets behind a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Selector {
    /// The factor.
    pub factor: String,
    /// The level wanted, as written.
    pub level: Value,
    /// Where it stands.
    pub bytes: Range<usize>,
}

/// Who knows what names mean.
pub trait Names {
    /// The value of a name with the conditions in brackets behind it.
    ///
    /// # Errors
    /// A name that is not known, or conditions that nothing fulfils.
    fn value(&self, name: &str, selectors: &[Selector], bytes: &Range<usize>) -> Result<Value, Mistake>;
    /// Whether comparing what is no finite number is a mistake, and not merely untrue: of a statement neither truth can be told then.
    fn judges(&self) -> bool {
        false
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Or,
    And,
    Equal,
    Unequal,
    Less,
    AtMost,
    More,
    AtLeast,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Constant(Value),
    Name(String, Vec<Selector>),
    List(Vec<Part>),
    Negative(Box<Part>),
    Not(Box<Part>),
    Binary(Operator, Box<Part>, Box<Part>),
    Call(String, Vec<Part>),
}

#[derive(Clone, Debug, PartialEq)]
struct Part {
    node: Node,
    bytes: Range<usize>,
}

/// An expression that can be read as one.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    root: Part,
}

/// Functions with what they take and give.
pub const FUNCTIONS: [(&str, &str); 27] = [
    ("if", "if(truth, a, b): a where the truth holds, else b"),
    ("abs", "abs(x): the size of x"),
    ("sqrt", "sqrt(x): the square root"),
    ("exp", "exp(x): e to the power x"),
    ("log", "log(x): the natural logarithm"),
    ("log10", "log10(x): the logarithm to base 10"),
    ("sin", "sin(x): x in radians"),
    ("cos", "cos(x): x in radians"),
    ("floor", "floor(x): the next whole number below"),
    ("ceil", "ceil(x): the next whole number above"),
    ("round", "round(x): the nearest whole number; halves go up"),
    ("min", "min(a, b, ...): the least, of numbers and of entries of lists"),
    ("max", "max(a, b, ...): the greatest"),
    ("sum", "sum(a, b, ...): the sum"),
    ("mean", "mean(a, b, ...): the mean"),
    ("count", "count(a, b, ...): how many"),
    ("first", "first(list): its first entry"),
    ("last", "last(list): its last entry"),
    ("all", "all(truths): whether all hold"),
    ("any", "any(truths): whether at least one holds"),
    ("share", "share(truths): how many of them hold, as a part of all"),
    ("median", "median(a, b, ...): the middle one in order; of an even number the mean of two"),
    ("at_max", "at_max(xs, ys): the x at which y is greatest"),
    ("at_min", "at_min(xs, ys): the x at which y is least"),
    ("rank_correlation", "rank_correlation(xs, ys): Spearman's, from -1 (falls) to 1 (rises)"),
    ("slope", "slope(xs, ys): of the straight line through the points by least squares"),
    ("spread", "spread(a, b, ...): the greatest less the least"),
];

/// Constants.
const CONSTANTS: [(&str, f64); 2] = [("pi", core::f64::consts::PI), ("e", core::f64::consts::E)];

/// Parts within parts, at most: enough for any sentence, few enough for the stack.
const DEEPEST: usize = 100;
/// Letters of an expression, at most, for the same reason.
const LONGEST: usize = 2000;

impl Expression {
    /// Reads an expression.
    ///
    /// # Errors
    /// What is no expression, at its place.
    pub fn parse(text: &str) -> Result<Self, Mistake> {
        if text.len() > LONGEST {
            return Err(Mistake::new(0..text.len(), format!("an expression has at most {LONGEST} letters")));
        }
        let mut parser = Parser { text, at: 0, depth: 0 };
        let root = parser.or()?;
        parser.blanks();
        if parser.at < text.len() {
            let rest = parser.at..text.len();
            return Err(Mistake::new(rest, "the expression goes on where it should end"));
        }
        Ok(Self { root })
    }
    /// Its value.
    ///
    /// # Errors
    /// What has no value, at its place.
    pub fn value(&self, names: &dyn Names) -> Result<Value, Mistake> {
        self.root.value(names)
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }
    fn blanks(&mut self) {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
    }
    /// Takes a sign, if it is next.
    fn takes(&mut self, sign: &str) -> bool {
        self.blanks();
        let found = self.rest().starts_with(sign);
        if found {
            self.at += sign.len();
        }
        found
    }
    /// Takes a word, if it is next and ends there.
    fn takes_word(&mut self, word: &str) -> bool {
        self.blanks();
        let rest = self.rest();
        let found =
            rest.strip_prefix(word).is_some_and(|after| !after.starts_with(|c: char| c.is_alphanumeric() || c == '_'));
        if found {
            self.at += word.len();
        }
        found
    }
    /// What is next, to point at.
    fn here(&self) -> Range<usize> {
        let next = self.rest().chars().next().map_or(0, char::len_utf8);
        self.at..self.at + next
    }
    fn expected(&mut self, what: &str) -> Mistake {
        self.blanks();
        let found = match self.rest().chars().next() {
            Some(c) => format!("found `{c}`"),
            None => "the expression ends".to_owned(),
        };
        Mistake::new(self.here(), format!("expected {what}, {found}"))
    }
    fn joined(operator: Operator, left: Part, right: Part) -> Part {
        let bytes = left.bytes.start..right.bytes.end;
        Part { node: Node::Binary(operator, Box::new(left), Box::new(right)), bytes }
    }
    fn or(&mut self) -> Result<Part, Mistake> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(Mistake::new(self.here(), "too many parts within parts"));
        }
        let mut left = self.and()?;
        while self.takes_word("or") {
            left = Self::joined(Operator::Or, left, self.and()?);
        }
        self.depth -= 1;
        Ok(left)
    }
    fn and(&mut self) -> Result<Part, Mistake> {
        let mut left = self.not()?;
        while self.takes_word("and") {
            left = Self::joined(Operator::And, left, self.not()?);
        }
        Ok(left)
    }
    fn not(&mut self) -> Result<Part, Mistake> {
        self.blanks();
        let from = self.at;
        if !self.takes_word("not") {
            return self.comparison();
        }
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(Mistake::new(self.here(), "too many parts within parts"));
        }
        let part = self.not()?;
        self.depth -= 1;
        let bytes = from..part.bytes.end;
        Ok(Part { node: Node::Not(Box::new(part)), bytes })
    }
    /// A chain of comparisons, `a < b <= c`, in which each must hold.
    fn comparison(&mut self) -> Result<Part, Mistake> {
        const SIGNS: [(&str, Operator); 7] = [
            ("<=", Operator::AtMost),
            (">=", Operator::AtLeast),
            ("==", Operator::Equal),
            ("!=", Operator::Unequal),
            ("<", Operator::Less),
            (">", Operator::More),
            ("=", Operator::Equal),
        ];
        let mut left = self.sum()?;
        let mut whole: Option<Part> = None;
        while let Some((_, operator)) = SIGNS.into_iter().find(|(sign, _)| self.takes(sign)) {
            let right = self.sum()?;
            let compared = Self::joined(operator, left, right.clone());
            whole = Some(match whole {
                Some(before) => Self::joined(Operator::And, before, compared),
                None => compared,
            });
            left = right;
        }
        Ok(whole.unwrap_or(left))
    }
    fn sum(&mut self) -> Result<Part, Mistake> {
        let mut left = self.product()?;
        loop {
            let operator = if self.takes("+") {
                Operator::Add
            } else if self.takes("-") {
                Operator::Subtract
            } else {
                return Ok(left);
            };
            left = Self::joined(operator, left, self.product()?);
        }
    }
    fn product(&mut self) -> Result<Part, Mistake> {
        let mut left = self.signed()?;
        loop {
            let operator = if self.takes("*") {
                Operator::Multiply
            } else if self.takes("/") {
                Operator::Divide
            } else {
                return Ok(left);
            };
            left = Self::joined(operator, left, self.signed()?);
        }
    }
    fn signed(&mut self) -> Result<Part, Mistake> {
        self.blanks();
        let from = self.at;
        if !self.takes("-") {
            return self.power();
        }
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(Mistake::new(self.here(), "too many parts within parts"));
        }
        let part = self.signed()?;
        self.depth -= 1;
        let bytes = from..part.bytes.end;
        Ok(Part { node: Node::Negative(Box::new(part)), bytes })
    }
    fn power(&mut self) -> Result<Part, Mistake> {
        let base = self.atom()?;
        if self.takes("^") {
            // the power itself may have a sign: 2^-1
            let power = self.signed()?;
            return Ok(Self::joined(Operator::Power, base, power));
        }
        Ok(base)
    }
    fn atom(&mut self) -> Result<Part, Mistake> {
        self.blanks();
        let from = self.at;
        let node = match self.rest().chars().next() {
            Some('(') => {
                self.at += 1;
                let inner = self.or()?;
                self.close(")", from)?;
                return Ok(Part { bytes: from..self.at, ..inner });
            }
            Some('[') => {
                self.at += 1;
                Node::List(self.parts("]", from)?)
            }
            Some('\'') => Node::Constant(Value::Text(self.quoted()?)),
            Some(c) if c.is_ascii_digit() || c == '.' => Node::Constant(Value::Number(self.number()?)),
            Some(c) if c.is_ascii_alphabetic() || c == '_' => {
                let name = self.name();
                match name.as_str() {
                    "true" | "false" => Node::Constant(Value::Truth(name == "true")),
                    _ if self.takes("(") => Node::Call(name, self.parts(")", from)?),
                    _ if self.rest().starts_with('[') => {
                        self.at += 1;
                        let selectors = self.selectors(from)?;
                        Node::Name(name, selectors)
                    }
                    _ => match CONSTANTS.iter().find(|(constant, _)| *constant == name) {
                        Some(&(_, value)) => Node::Constant(Value::Number(value)),
                        None => Node::Name(name, Vec::new()),
                    },
                }
            }
            _ => return Err(self.expected("a number, a name or a bracket")),
        };
        // blanks that were looked past are not part of it
        let end = from + self.text[from..self.at].trim_end().len();
        Ok(Part { node, bytes: from..end })
    }
    fn close(&mut self, sign: &str, opened: usize) -> Result<(), Mistake> {
        if self.takes(sign) {
            return Ok(());
        }
        let mut mistake = self.expected(&format!("`{sign}`"));
        if mistake.bytes.is_empty() {
            mistake.bytes = opened..opened + 1;
            mistake.what = format!("the bracket is not closed by `{sign}`");
        }
        Err(mistake)
    }
    fn parts(&mut self, sign: &str, opened: usize) -> Result<Vec<Part>, Mistake> {
        let mut parts = Vec::new();
        if self.takes(sign) {
            return Ok(parts);
        }
        loop {
            parts.push(self.or()?);
            if !self.takes(",") {
                self.close(sign, opened)?;
                return Ok(parts);
            }
        }
    }
    fn selectors(&mut self, opened: usize) -> Result<Vec<Selector>, Mistake> {
        let mut selectors = Vec::new();
        if self.takes("]") {
            return Ok(selectors);
        }
        loop {
            self.blanks();
            let from = self.at;
            let factor = self.name();
            if factor.is_empty() {
                return Err(self.expected("the name of a factor"));
            }
            if !(self.takes("==") || self.takes("=")) {
                return Err(self.expected("`=` and a level"));
            }
            self.blanks();
            let level = match self.rest().chars().next() {
                Some('\'') => Value::Text(self.quoted()?),
                Some(c) if c.is_ascii_digit() || c == '.' || c == '-' => {
                    let negative = self.takes("-");
                    let number = self.number()?;
                    Value::Number(if negative { -number } else { number })
                }
                _ => {
                    let word = self.name();
                    if word.is_empty() {
                        return Err(self.expected("a level"));
                    }
                    Value::Text(word)
                }
            };
            selectors.push(Selector { factor, level, bytes: from..self.at });
            if !self.takes(",") {
                self.close("]", opened)?;
                return Ok(selectors);
            }
        }
    }
    fn quoted(&mut self) -> Result<String, Mistake> {
        let from = self.at;
        let inside = &self.text[from + 1..];
        let Some(end) = inside.find('\'') else {
            return Err(Mistake::new(from..self.text.len(), "the text is not closed by `'`"));
        };
        let text = inside[..end].to_owned();
        self.at = from + 1 + end + 1;
        Ok(text)
    }
    fn number(&mut self) -> Result<f64, Mistake> {
        let from = self.at;
        let rest = self.rest().as_bytes();
        let mut end = 0;
        while end < rest.len() {
            let exponent = end > 0 && matches!(rest[end - 1], b'e' | b'E');
            match rest[end] {
                b'0'..=b'9' | b'.' => {}
                b'e' | b'E' if rest.get(end + 1).is_some_and(|c| matches!(c, b'0'..=b'9' | b'+' | b'-')) => {}
                b'+' | b'-' if exponent => {}
                _ => break,
            }
            end += 1;
        }
        let digits = &self.text[from..from + end];
        let number = digits.parse::<f64>().ok().filter(|n| n.is_finite());
        let number = number.ok_or_else(|| Mistake::new(from..from + end, format!("`{digits}` is no number")))?;
        self.at += end;
        Ok(number)
    }
    /// A name, with dots between its parts: a path.
    fn name(&mut self) -> String {
        let rest = self.rest();
        let mut end = 0;
        for (at, c) in rest.char_indices() {
            let begins = at == 0 && (c.is_ascii_alphabetic() || c == '_');
            let inside = at > 0 && (c.is_ascii_alphanumeric() || c == '_');
            let next = rest[at + c.len_utf8()..].chars().next();
            let dot = at > 0 && c == '.' && next.is_some_and(|n| n.is_ascii_alphanumeric() || n == '_');
            if !(begins || inside || dot) {
                break;
            }
            end = at + c.len_utf8();
        }
        let name = rest[..end].to_owned();
        self.at += end;
        name
    }
}

impl Part {
    fn value(&self, names: &dyn Names) -> Result<Value, Mistake> {
        match &self.node {
            Node::Constant(value) => Ok(value.clone()),
            Node::Name(name, selectors) => names.value(name, selectors, &self.bytes),
            Node::List(parts) => parts.iter().map(|part| part.value(names)).collect::<Result<_, _>>().map(Value::List),
            Node::Negative(part) => each(&part.value(names)?, &|x| Ok(Value::Number(-part.number(x)?))),
            Node::Not(part) => each(&part.value(names)?, &|x| Ok(Value::Truth(!part.truth(x)?))),
            Node::Binary(operator, left, right) => {
                let (a, b) = (left.value(names)?, right.value(names)?);
                self.pairs((*operator, names.judges()), left, right, &a, &b)
            }
            Node::Call(name, parts) => self.call(name, parts, names),
        }
    }
    fn number(&self, value: &Value) -> Result<f64, Mistake> {
        value.number().ok_or_else(|| {
            Mistake::new(self.bytes.clone(), format!("a number is needed here, found {}", value.describe()))
        })
    }
    fn truth(&self, value: &Value) -> Result<bool, Mistake> {
        if let Value::Truth(truth) = value {
            return Ok(*truth);
        }
        Err(Mistake::new(self.bytes.clone(), format!("true or false is needed here, found {}", value.describe())))
    }
    fn pairs(
        &self,
        operator: (Operator, bool),
        left: &Part,
        right: &Part,
        a: &Value,
        b: &Value,
    ) -> Result<Value, Mistake> {
        match (a, b) {
            (Value::List(a), Value::List(b)) => {
                if a.len() != b.len() {
                    let what = format!("lists of {} and {} entries have no common ones", a.len(), b.len());
                    return Err(Mistake::new(self.bytes.clone(), what));
                }
                let entries = a.iter().zip(b).map(|(a, b)| self.pairs(operator, left, right, a, b));
                entries.collect::<Result<_, _>>().map(Value::List)
            }
            (Value::List(a), b) => {
                a.iter().map(|a| self.pairs(operator, left, right, a, b)).collect::<Result<_, _>>().map(Value::List)
            }
            (a, Value::List(b)) => {
                b.iter().map(|b| self.pairs(operator, left, right, a, b)).collect::<Result<_, _>>().map(Value::List)
            }
            (a, b) => self.pair(operator, left, right, a, b),
        }
    }
    /// Refuses to compare what is not a number: neither truth would be one.
    fn compares(&self, left: &Part, right: &Part, a: &Value, b: &Value) -> Result<(), Mistake> {
        for (part, value) in [(left, a), (right, b)] {
            if value.number().is_some_and(|number| !number.is_finite()) {
                let what = "this has no value (divided by zero, or a statistic of numbers that are all alike)";
                return Err(Mistake { of_numbers: true, ..Mistake::new(part.bytes.clone(), what) });
            }
        }
        Ok(())
    }
    fn pair(
        &self,
        (operator, judges): (Operator, bool),
        left: &Part,
        right: &Part,
        a: &Value,
        b: &Value,
    ) -> Result<Value, Mistake> {
        Ok(match operator {
            Operator::And => Value::Truth(left.truth(a)? & right.truth(b)?),
            Operator::Or => Value::Truth(left.truth(a)? | right.truth(b)?),
            Operator::Equal | Operator::Unequal => {
                if judges {
                    self.compares(left, right, a, b)?;
                }
                let alike = core::mem::discriminant(a) == core::mem::discriminant(b);
                if !alike {
                    let what = format!("{} and {} cannot be compared", a.describe(), b.describe());
                    return Err(Mistake::new(self.bytes.clone(), what));
                }
                Value::Truth((a == b) == (operator == Operator::Equal))
            }
            _ => {
                let comparison =
                    matches!(operator, Operator::Less | Operator::AtMost | Operator::More | Operator::AtLeast);
                if judges && comparison {
                    self.compares(left, right, a, b)?;
                }
                let (a, b) = (left.number(a)?, right.number(b)?);
                match operator {
                    Operator::Less => Value::Truth(a < b),
                    Operator::AtMost => Value::Truth(a <= b),
                    Operator::More => Value::Truth(a > b),
                    Operator::AtLeast => Value::Truth(a >= b),
                    Operator::Add => Value::Number(a + b),
                    Operator::Subtract => Value::Number(a - b),
                    Operator::Multiply => Value::Number(a * b),
                    Operator::Divide => Value::Number(a / b),
                    _ => Value::Number(Real::powf(a, b)),
                }
            }
        })
    }
    fn call(&self, name: &str, parts: &[Part], names: &dyn Names) -> Result<Value, Mistake> {
        let Some((_, usage)) = FUNCTIONS.iter().find(|(known, _)| *known == name) else {
            let near = nearest(name, FUNCTIONS.iter().map(|(known, _)| *known));
            let help = near.map_or_else(
                || format!("there are {}", FUNCTIONS.map(|(known, _)| known).join(", ")),
                |near| format!("did you mean `{near}`?"),
            );
            return Err(Mistake { help, ..Mistake::new(self.bytes.clone(), format!("unknown function `{name}`")) });
        };
        let needs = |count: usize| {
            if parts.len() == count {
                return Ok(());
            }
            let what = format!("`{name}` takes {count} values, found {}", parts.len());
            Err(Mistake { help: (*usage).to_owned(), ..Mistake::new(self.bytes.clone(), what) })
        };
        let single: Option<fn(f64) -> f64> = match name {
            "abs" => Some(f64::abs),
            "sqrt" => Some(Real::root),
            "exp" => Some(Real::exp),
            "log" => Some(Real::ln),
            "log10" => Some(|x| Real::ln(x) / core::f64::consts::LN_10),
            "sin" => Some(Real::sin),
            "cos" => Some(Real::cos),
            "floor" => Some(f64::floor),
            "ceil" => Some(f64::ceil),
            "round" => Some(|x| (x + 0.5).floor()),
            _ => None,
        };
        if let Some(single) = single {
            needs(1)?;
            let part = &parts[0];
            return each(&part.value(names)?, &|x| Ok(Value::Number(single(part.number(x)?))));
        }
        if name == "if" {
            needs(3)?;
            let held = parts[0].value(names)?;
            return parts[if parts[0].truth(&held)? { 1 } else { 2 }].value(names);
        }
        if let "all" | "any" | "share" = name {
            needs(1)?;
            let value = parts[0].value(names)?;
            let list = if let Value::List(list) = value { list } else { vec![value] };
            let truths = list.iter().map(|x| parts[0].truth(x)).collect::<Result<Vec<bool>, _>>()?;
            let held = truths.iter().filter(|&&truth| truth).count();
            return Ok(match name {
                "all" => Value::Truth(held == truths.len()),
                "any" => Value::Truth(held > 0),
                _ => Value::Number(held as f64 / truths.len() as f64),
            });
        }
        if let "at_max" | "at_min" | "rank_correlation" | "slope" = name {
            needs(2)?;
            let (xs, ys) = (parts[0].numbers(names)?, parts[1].numbers(names)?);
            if xs.len() != ys.len() {
                let what = format!("`{name}` takes two lists of one length, found {} and {}", xs.len(), ys.len());
                return Err(Mistake::new(self.bytes.clone(), what));
            }
            return Ok(Value::Number(of_points(name, &xs, &ys)));
        }
        let mut numbers = Vec::new();
        for part in parts {
            numbers.extend(part.numbers(names)?);
        }
        let count = numbers.len() as f64;
        let least = numbers.iter().copied().fold(f64::INFINITY, lesser);
        let greatest = -numbers.iter().map(|x| -x).fold(f64::INFINITY, lesser);
        Ok(Value::Number(match (name, numbers.as_slice()) {
            ("count", _) => count,
            ("sum", _) => numbers.iter().sum(),
            // of nothing there is none of these
            (_, []) => f64::NAN,
            ("min", _) => least,
            ("max", _) => greatest,
            ("spread", _) => greatest - least,
            ("median", numbers) => measure::statistics::median(numbers).unwrap_or(f64::NAN),
            ("mean", _) => numbers.iter().sum::<f64>() / count,
            ("first", [first, ..]) => *first,
            (_, [.., last]) => *last,
        }))
    }
    /// A number, or a list of them.
    fn numbers(&self, names: &dyn Names) -> Result<Vec<f64>, Mistake> {
        match self.value(names)? {
            Value::List(list) => list.iter().map(|x| self.number(x)).collect(),
            value => Ok(vec![self.number(&value)?]),
        }
    }
}

/// The lesser of two numbers; what is not a number wins, so that it is not overlooked.
fn lesser(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if b < a {
        b
    } else {
        a
    }
}

fn each(value: &Value, of: &dyn Fn(&Value) -> Result<Value, Mistake>) -> Result<Value, Mistake> {
    match value {
        Value::List(list) => list.iter().map(of).collect::<Result<_, _>>().map(Value::List),
        value => of(value),
    }
}

fn of_points(name: &str, xs: &[f64], ys: &[f64]) -> f64 {
    if xs.is_empty() || xs.iter().chain(ys).any(|v| v.is_nan()) {
        return f64::NAN;
    }
    match name {
        "at_max" | "at_min" => {
            let sign = if name == "at_max" { 1.0 } else { -1.0 };
            let mut best = 0;
            for k in 1..ys.len() {
                if sign * ys[k] > sign * ys[best] {
                    best = k;
                }
            }
            xs[best]
        }
        "slope" => along(xs, ys).0,
        _ => along(&ranks(xs), &ranks(ys)).1,
    }
}

/// Ranks from 1; equal values share their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let rank = |v: &f64| {
        let below = values.iter().filter(|other| *other < v).count() as f64;
        let equal = values.iter().filter(|other| *other == v).count() as f64;
        below + (equal + 1.0) / 2.0
    };
    values.iter().map(rank).collect()
}

/// Slope and correlation of points.
fn along(xs: &[f64], ys: &[f64]) -> (f64, f64) {
    let n = xs.len() as f64;
    let (mx, my) = (xs.iter().sum::<f64>() / n, ys.iter().sum::<f64>() / n);
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for (x, y) in xs.iter().zip(ys) {
        xx += (x - mx) * (x - mx);
        yy += (y - my) * (y - my);
        xy += (x - mx) * (y - my);
    }
    (xy / xx, xy / (xx * yy).sqrt())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    struct Known;
    impl Names for Known {
        fn judges(&self) -> bool {
            true
        }
        fn value(&self, name: &str, selectors: &[Selector], bytes: &Range<usize>) -> Result<Value, Mistake> {
            match (name, selectors) {
                ("g", []) => Ok(Value::Number(50.0)),
                ("group.fish.count", []) => Ok(Value::Number(7.0)),
                ("variant", []) => Ok(Value::Text("prob".into())),
                ("M", []) => Ok(Value::List([0.0, 2.0, 4.0].map(Value::Number).to_vec())),
                ("c", []) => Ok(Value::List([5.0, 9.0, 1.0].map(Value::Number).to_vec())),
                ("c", [one]) if one.factor == "M" => Ok(one.level.clone()),
                _ => Err(Mistake::new(bytes.clone(), format!("unknown name `{name}`"))),
            }
        }
    }

    fn value(text: &str) -> Value {
        Expression::parse(text).unwrap().value(&Known).unwrap()
    }
    fn number(text: &str) -> f64 {
        value(text).number().unwrap()
    }
    fn mistake(text: &str) -> (String, String) {
        let mistake = Expression::parse(text).and_then(|e| e.value(&Known)).unwrap_err();
        (mistake.what, text[mistake.bytes].to_owned())
    }

    #[test]
    fn arithmetic() {
        for (text, expected) in [
            ("1 + 2 * 3", 7.0),
            ("(1 + 2) * 3", 9.0),
            ("-2^2", -4.0),
            ("2^-1", 0.5),
            ("2^3^2", 512.0),
            ("10 - 4 - 3", 3.0),
            ("12 / 2 / 3", 2.0),
            ("1.5e2 + .5", 150.5),
            ("round(2.5) + round(-2.5)", 1.0),
            ("min(3, [1, 2]) + max(4) + mean(1, 2)", 6.5),
            ("if(g > 10 and variant = 'prob', 1, 2)", 1.0),
            ("group.fish.count * 2", 14.0),
            ("at_max(M, c)", 2.0),
            ("at_min(M, c)", 4.0),
            ("rank_correlation(M, c)", -0.5),
            ("slope(M, M)", 1.0),
            ("c[M = -3]", -3.0),
            ("count([]) + sum([])", 0.0),
            ("spread(c)", 8.0),
        ] {
            assert!((number(text) - expected).abs() < 1e-12, "{text}: {}", number(text));
        }
        // the tank of 50 fish that has the density of 200 in 335
        assert!((number("335 * (g / 200)^(1/3)") - 211.036_775).abs() < 1e-6);
        assert_eq!(number("335 * (200 / 200)^(1/3)"), 335.0);
        assert!(number("mean([])").is_nan() && number("0/0").is_nan());
    }

    #[test]
    fn truths_and_lists() {
        assert_eq!(value("1 < 2 <= 2"), Value::Truth(true));
        assert_eq!(value("1 < 2 < 2"), Value::Truth(false));
        assert_eq!(value("not 1 > 2 and true"), Value::Truth(true));
        assert_eq!(value("all(c > 0)"), Value::Truth(true));
        assert_eq!(value("any(c > 5 or c < 0)"), Value::Truth(true));
        assert_eq!((value("c > 4")).truth(), Some(false));
        assert_eq!(value("c[M = prob]"), Value::Text("prob".into()));
        assert_eq!(value("[g, g * 2]"), Value::List(vec![Value::Number(50.0), Value::Number(100.0)]));
    }

    #[test]
    fn mistakes_are_pointed_at() {
        for (text, what, place) in [
            ("1 + ", "expected a number", ""),
            ("1 + nothing", "unknown name `nothing`", "nothing"),
            ("sqr(4)", "unknown function `sqr`", "sqr(4)"),
            ("(1 + 2", "not closed", "("),
            ("1 2", "goes on", "2"),
            ("1 + true", "a number is needed here, found true", "true"),
            ("if(1, 2, 3)", "true or false", "1"),
            ("sqrt(1, 2)", "takes 1 values, found 2", "sqrt(1, 2)"),
            ("c[M 3]", "expected `=`", "3"),
            ("variant = 1", "cannot be compared", "variant = 1"),
            ("not 0/0 > 2", "has no value", "0/0"),
            ("1 != 0/0", "has no value", "0/0"),
            ("1/0 > 2", "has no value", "1/0"),
            ("rank_correlation(M, [1, 1, 1]) < 0", "has no value", "rank_correlation(M, [1, 1, 1])"),
            ("c + [1, 2]", "no common ones", "c + [1, 2]"),
            ("'open", "not closed", "'open"),
            ("1.2.3", "is no number", "1.2.3"),
            ("1e999", "is no number", "1e999"),
            ("2 $ 3", "goes on", "$ 3"),
            ("", "expected", ""),
        ] {
            let (found, at) = mistake(text);
            assert!(found.contains(what), "{text}: {found}");
            assert_eq!(at, place, "{text}: {found}");
        }
        assert!(mistake(&"(".repeat(1500)).0.contains("parts within parts"));
        assert!(mistake(&format!("{}1", "-".repeat(1500))).0.contains("parts within parts"));
        assert!(mistake(&"1+".repeat(1500)).0.contains("at most"));
        assert!(Expression::parse(&format!("1{}", "^1".repeat(900))).is_ok());
    }
}
