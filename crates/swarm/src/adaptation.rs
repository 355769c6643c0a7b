//! Members that differ and members that change: parameters by member, other parameters in a situation, decisions now and then.

use crate::parameters::{Value, Values};
use space::{Column, ColumnKind, Real};

/// A parameter of which every member has its own value.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    /// Full name of the parameter.
    pub parameter: String,
    /// One value for each member.
    pub values: Vec<Value>,
}

/// Other parameters in a situation, from the step after it was met on, for a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Adaptation<R> {
    /// The parameters that then hold in place of the group's.
    pub parameters: Values,
    /// An obstacle or wall is nearer to the surface of the body than this.
    pub obstacle: Option<R>,
    /// The body met something in the step before.
    pub collision: bool,
    /// At least so many members of the own group are nearer than this.
    pub crowd: Option<(R, usize)>,
    /// How long they hold after the situation was last met.
    pub hold: R,
}

impl<R: Real> Adaptation<R> {
    /// The column with the time that is left.
    pub const TIMER: Column = Column {
        name: "adapted",
        unit: "time",
        kind: ColumnKind::Quantity,
        about: "Time for which the other parameters still hold; 0 where the group's own do.",
    };
    /// The column that tells contacts; kept by the models that declare it, and by every body that adapts to them.
    pub const COLLIDED: Column =
        Column { name: "collided", unit: "1", kind: ColumnKind::Count, about: "Whether it met something in the step." };
    /// Columns of the body.
    pub fn columns(&self) -> impl Iterator<Item = Column> {
        [Self::TIMER].into_iter().chain(self.collision.then_some(Self::COLLIDED))
    }
    /// What can be known at load.
    ///
    /// # Errors
    /// A sentence that says what does not fit.
    pub fn check(&self) -> Result<(), String> {
        if self.obstacle.is_none() && !self.collision && self.crowd.is_none() {
            return Err("adapt: it never happens; say when (`obstacle`, `collision` or `crowd`)".into());
        }
        let mut numbers = vec![("hold", self.hold)];
        numbers.extend(self.obstacle.map(|within| ("obstacle", within)));
        numbers.extend(self.crowd.map(|(within, _)| ("crowd.within", within)));
        match numbers.into_iter().find(|(_, value)| !(*value >= R::ZERO && value.finite())) {
            Some((name, value)) => Err(format!("adapt: {name} must be 0 or more, found {value}")),
            None => Ok(()),
        }
    }
}
