//! Arithmetic in grammar files: numbers, names, `+ - * /`, parentheses, and comparisons as conditions.

use crate::TerrainError;
use std::fmt;

/// Where the names in an expression get their values.
pub trait Names {
    /// The value of a name such as `a` or `left.length`; `None` where there is none.
    fn value(&self, name: &str) -> Option<f64>;
    /// How many shapes of a name there now are; `None` where nothing can be counted or no shape is called so.
    fn count(&self, shape: &str) -> Option<usize> {
        let _ = shape;
        None
    }
}

/// No names.
impl Names for () {
    fn value(&self, _: &str) -> Option<f64> {
        None
    }
}

/// An arithmetic expression.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// The value of a name.
    Name(String),
    /// `count("shape")`.
    Count(String),
    /// A sum, difference, product or quotient.
    Both(char, Box<(Expression, Expression)>),
    /// The negative.
    Negative(Box<Expression>),
}

/// A comparison of two expressions.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    left: Expression,
    comparison: &'static str,
    right: Expression,
}

const COMPARISONS: [&str; 6] = ["<=", ">=", "==", "!=", "<", ">"];

impl From<f64> for Expression {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

/// The value of a name.
impl From<&str> for Expression {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

impl std::ops::Neg for Expression {
    type Output = Self;
    fn neg(self) -> Self {
        Self::Negative(Box::new(self))
    }
}

impl Expression {
    /// Reads an expression.
    ///
    /// # Errors
    /// Where it is none.
    pub fn parse(text: &str) -> Result<Self, TerrainError> {
        let mut reader = Reader { text, at: 0 };
        let expression = reader.sum()?;
        reader.end()?;
        Ok(expression)
    }
    /// Its value.
    ///
    /// # Errors
    /// A name without a value, and a result that is not finite.
    pub fn value(&self, names: &dyn Names) -> Result<f64, TerrainError> {
        let value = match self {
            Self::Number(number) => *number,
            Self::Name(name) => {
                names.value(name).ok_or_else(|| TerrainError::Grammar(format!("`{name}` has no value here")))?
            }
            Self::Count(shape) => names
                .count(shape)
                .ok_or_else(|| TerrainError::Grammar(format!("`{shape}` cannot be counted: no shape is called so")))?
                as f64,
            Self::Negative(inner) => -inner.value(names)?,
            Self::Both(operator, both) => {
                let (left, right) = (both.0.value(names)?, both.1.value(names)?);
                match operator {
                    '+' => left + right,
                    '-' => left - right,
                    '*' => left * right,
                    _ => left / right,
                }
            }
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err(TerrainError::Grammar(format!("`{self}` is {value}; expected a finite number")))
        }
    }
    /// Visits every name in it.
    pub fn names(&self, visit: &mut dyn FnMut(&str)) {
        match self {
            Self::Number(_) | Self::Count(_) => {}
            Self::Name(name) => visit(name),
            Self::Negative(inner) => inner.names(visit),
            Self::Both(_, both) => {
                both.0.names(visit);
                both.1.names(visit);
            }
        }
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(out, "{number}"),
            Self::Name(name) => out.write_str(name),
            Self::Count(shape) => write!(out, "count(\"{shape}\")"),
            Self::Negative(inner) => write!(out, "-({inner})"),
            Self::Both(operator, both) => write!(out, "({} {operator} {})", both.0, both.1),
        }
    }
}

impl Condition {
    /// Reads a comparison such as `level < 4` or `count("wall") < 12`.
    ///
    /// # Errors
    /// Where it is none.
    pub fn parse(text: &str) -> Result<Self, TerrainError> {
        let mut reader = Reader { text, at: 0 };
        let left = reader.sum()?;
        let rest = reader.rest();
        let Some(comparison) = COMPARISONS.into_iter().find(|comparison| rest.starts_with(comparison)) else {
            return reader.fault("one of < <= > >= == !=");
        };
        reader.at += comparison.len();
        let right = reader.sum()?;
        reader.end()?;
        Ok(Self { left, comparison, right })
    }
    /// Whether it holds.
    ///
    /// # Errors
    /// See [`Expression::value`].
    pub fn holds(&self, names: &dyn Names) -> Result<bool, TerrainError> {
        let (left, right) = (self.left.value(names)?, self.right.value(names)?);
        Ok(match self.comparison {
            "<" => left < right,
            "<=" => left <= right,
            ">" => left > right,
            ">=" => left >= right,
            "==" => left == right,
            _ => left != right,
        })
    }
    /// Visits every name in it.
    pub fn names(&self, visit: &mut dyn FnMut(&str)) {
        self.left.names(visit);
        self.right.names(visit);
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
}

/// How deep parentheses and signs may be nested.
const DEEPEST: usize = 64;

impl<'a> Reader<'a> {
    /// What is left, without leading blanks.
    fn rest(&mut self) -> &'a str {
        let rest = &self.text[self.at..];
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed
    }
    fn fault<T>(&mut self, expected: &str) -> Result<T, TerrainError> {
        let text = self.text;
        let found = match self.rest() {
            "" => "its end".to_owned(),
            rest => format!("`{rest}`"),
        };
        Err(TerrainError::Grammar(format!("in `{text}`: expected {expected}, found {found}")))
    }
    fn end(&mut self) -> Result<(), TerrainError> {
        if self.rest().is_empty() { Ok(()) } else { self.fault("the end of the expression") }
    }
    fn take(&mut self, among: &[char]) -> Option<char> {
        let next = self.rest().chars().next().filter(|letter| among.contains(letter))?;
        self.at += next.len_utf8();
        Some(next)
    }
    fn sum(&mut self) -> Result<Expression, TerrainError> {
        self.chain(&['+', '-'], &|reader| reader.chain(&['*', '/'], &|reader| reader.factor(0)))
    }
    fn chain(
        &mut self,
        operators: &[char],
        part: &dyn Fn(&mut Self) -> Result<Expression, TerrainError>,
    ) -> Result<Expression, TerrainError> {
        let mut left = part(self)?;
        while let Some(operator) = self.take(operators) {
            left = Expression::Both(operator, Box::new((left, part(self)?)));
        }
        Ok(left)
    }
    fn factor(&mut self, depth: usize) -> Result<Expression, TerrainError> {
        if depth > DEEPEST || self.text.len() > 4096 {
            return self.fault("a simpler expression");
        }
        if self.take(&['-']).is_some() {
            return Ok(Expression::Negative(Box::new(self.factor(depth + 1)?)));
        }
        if self.take(&['(']).is_some() {
            let inner = self.nested(depth + 1)?;
            return if self.take(&[')']).is_some() { Ok(inner) } else { self.fault("`)`") };
        }
        let rest = self.rest();
        let word = |more: &dyn Fn(char) -> bool| &rest[..rest.find(|c: char| !more(c)).unwrap_or(rest.len())];
        let name = word(&|c| c.is_alphanumeric() || c == '_' || c == '.');
        if name.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            return self.number(rest);
        }
        if name.is_empty() {
            return self.fault("a number, a name or `(`");
        }
        self.at += name.len();
        if name != "count" {
            return Ok(Expression::Name(name.to_owned()));
        }
        let rest = self.rest();
        let Some((shape, after)) = rest.strip_prefix("(\"").and_then(|rest| rest.split_once("\")")) else {
            return self.fault("a shape in quotes and parentheses, as in count(\"wall\")");
        };
        let _ = after;
        self.at += shape.len() + 4;
        Ok(Expression::Count(shape.to_owned()))
    }
    /// A sum inside parentheses.
    fn nested(&mut self, depth: usize) -> Result<Expression, TerrainError> {
        self.chain(&['+', '-'], &|reader| reader.chain(&['*', '/'], &|reader| reader.factor(depth)))
    }
    fn number(&mut self, rest: &str) -> Result<Expression, TerrainError> {
        // the longest beginning that is a number: `2e-3` is one, `2e` is not
        let longest = rest.find(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c))).unwrap_or(rest.len());
        for end in (1..=longest).rev().filter(|&end| rest.is_char_boundary(end)) {
            if let Ok(number) = rest[..end].parse::<f64>()
                && number.is_finite()
            {
                self.at += end;
                return Ok(Expression::Number(number));
            }
        }
        self.fault("a number")
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    struct Some12;
    impl Names for Some12 {
        fn value(&self, name: &str) -> Option<f64> {
            match name {
                "a" => Some(12.0),
                "left.length" => Some(3.0),
                _ => None,
            }
        }
        fn count(&self, shape: &str) -> Option<usize> {
            (shape == "wall").then_some(5)
        }
    }

    #[test]
    fn arithmetic() {
        let value = |text: &str| Expression::parse(text).unwrap().value(&Some12).unwrap();
        assert_eq!(value("1 + 2 * 3 - 4 / 2"), 5.0);
        assert_eq!(value("8 - 4 - 2"), 2.0, "from left to right");
        assert_eq!(value("-(a - 2) * 1e-1"), -1.0);
        assert_eq!(value("- -a"), 12.0);
        assert_eq!(value("left.length*2"), 6.0);
        assert_eq!(value("2+count(\"wall\")"), 7.0);
        assert_eq!(value("3-2"), 1.0);
        assert_eq!(value(".5"), 0.5);
    }

    #[test]
    fn conditions() {
        let holds = |text: &str| Condition::parse(text).unwrap().holds(&Some12).unwrap();
        assert!(holds("a < 13") && holds("a<=12") && holds("a >= 12") && holds("count(\"wall\") != 4"));
        assert!(!holds("a > 12") && !holds("a == left.length"));
    }

    #[test]
    fn wrong_ones_are_named() {
        let wrong = |text: &str| Expression::parse(text).unwrap_err().to_string();
        assert!(wrong("1 +").contains("found its end"));
        assert!(wrong("(1").contains("`)`"));
        assert!(wrong("1 2").contains("expected the end"));
        assert!(wrong("").contains("a number"));
        assert!(wrong("count(wall)").contains("count(\"wall\")"));
        assert!(wrong(&"-".repeat(1000)).contains("simpler"));
        assert!(wrong("1..2").contains("1..2"));
        assert!(Condition::parse("a").unwrap_err().to_string().contains("<="));
        let value = |text: &str| Expression::parse(text).unwrap().value(&Some12).unwrap_err().to_string();
        assert!(value("b + 1").contains("`b` has no value"));
        assert!(value("1 / 0").contains("inf"));
        assert!(value("count(\"wal\")").contains("wal"));
    }
}
