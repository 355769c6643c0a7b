//! Perception functions for those who look: in words, and as a shape where they have one.

use super::Perception;
use crate::parameters::Scalar;
use space::Vector;

/// The shell or cone that holds the members of a perception function; `None` where there is no such bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell<R> {
    /// Least distance.
    pub low: Option<R>,
    /// First distance that is too far.
    pub high: Option<R>,
    /// Full opening about the heading, rad.
    pub angle: Option<R>,
}

impl<R: Scalar> Shell<R> {
    const NONE: Self = Self { low: None, high: None, angle: None };

    fn and(self, other: Self) -> Self {
        let both = |a: Option<R>, b: Option<R>, tighter: fn(R, R) -> R| match (a, b) {
            (Some(a), Some(b)) => Some(tighter(a, b)),
            (one, other) => one.or(other),
        };
        Self {
            low: both(self.low, other.low, R::most),
            high: both(self.high, other.high, R::least),
            angle: both(self.angle, other.angle, R::least),
        }
    }
    /// The one that reaches farther.
    fn or(self, other: Self) -> Self {
        match (self.high, other.high) {
            (Some(a), Some(b)) if a < b => other,
            (Some(_), None) => other,
            _ => self,
        }
    }
}

/// A number without digits that say nothing.
fn number<R: Scalar>(value: R) -> String {
    format!("{}", (value.to_f64() * 1e6).round() / 1e6)
}

impl<R: Scalar, const D: usize> Perception<R, D> {
    /// The shell or cone that its members lie in; of a union, that of the part that reaches farthest.
    pub fn shell(&self) -> Shell<R> {
        match self {
            Self::DistanceBased { low, high } => Shell { low: Some(*low), high: Some(*high), angle: None },
            Self::Angle { opening, .. } => Shell { angle: Some(*opening), ..Shell::NONE },
            Self::Intersection(parts) | Self::Sequence(parts) => {
                parts.iter().map(Self::shell).fold(Shell::NONE, Shell::and)
            }
            Self::Union(parts) => parts.iter().map(Self::shell).reduce(Shell::or).unwrap_or(Shell::NONE),
            Self::Difference(from, _) => from.shell(),
            Self::All
            | Self::FixedSet(_)
            | Self::Nearest
            | Self::Voronoi
            | Self::KNearest(_)
            | Self::BoundingBox { .. } => Shell::NONE,
        }
    }
    /// The rule in words; lengths in the units of the parameters, angles in degrees.
    pub fn words(&self) -> String {
        let point = |v: &Vector<R, D>| v.0.map(number).join(", ");
        match self {
            Self::All => "everyone detected".into(),
            Self::FixedSet(_) => "members given by number".into(),
            Self::DistanceBased { low, high } if *low <= R::ZERO => format!("nearer than {}", number(*high)),
            Self::DistanceBased { low, high } => {
                format!("at distances from {} to below {}", number(*low), number(*high))
            }
            Self::Nearest => "the nearest".into(),
            Self::Voronoi => "Voronoi neighbours".into(),
            Self::KNearest(0) => "nobody".into(),
            Self::KNearest(count) => format!("the {count} nearest"),
            Self::BoundingBox { low, high, body_frame } => format!(
                "in the box from ({}) to ({}) {}",
                point(low),
                point(high),
                if *body_frame { "along the heading" } else { "about the agent" }
            ),
            Self::Angle { opening, .. } => {
                format!("in the cone of {} degrees about the heading", number(R::of(opening.to_f64().to_degrees())))
            }
            Self::Intersection(parts) => Self::joined(parts, " and "),
            Self::Union(parts) => Self::joined(parts, " or "),
            Self::Difference(from, without) => format!("{}, but not {}", from.part(), without.part()),
            Self::Sequence(parts) => Self::joined(parts, ", of these "),
        }
    }
    fn joined(parts: &[Self], word: &str) -> String {
        parts.iter().map(Self::part).collect::<Vec<_>>().join(word)
    }
    /// In words, in brackets where it is made of parts.
    fn part(&self) -> String {
        match self {
            Self::Intersection(parts) | Self::Union(parts) | Self::Sequence(parts) if parts.len() > 1 => {
                format!("({})", self.words())
            }
            Self::Difference(..) => format!("({})", self.words()),
            _ => self.words(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_told_in_words_and_as_shells() {
        let cone = Perception::<f64, 2>::angle(270f64.to_radians());
        let ring = Perception::distance(1.0, 6.0).both(cone.clone());
        assert_eq!(ring.words(), "at distances from 1 to below 6 and in the cone of 270 degrees about the heading");
        let shell = ring.shell();
        assert_eq!((shell.low, shell.high, shell.angle), (Some(1.0), Some(6.0), Some(270f64.to_radians())));
        let union = Perception::Union(vec![Perception::distance(0.0, 1.5), ring]);
        assert!(union.words().starts_with("nearer than 1.5 or (at distances"));
        assert_eq!(union.shell().high, Some(6.0));
        assert_eq!(Perception::<f64, 2>::KNearest(7).words(), "the 7 nearest");
        assert_eq!(Perception::<f64, 2>::KNearest(7).shell(), Shell::NONE);
        let without = Perception::Difference(Box::new(cone), Box::new(Perception::Nearest));
        assert_eq!(without.words(), "in the cone of 270 degrees about the heading, but not the nearest");
    }
}
