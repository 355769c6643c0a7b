//! Files that say what they are: text, tree, problems with their place, and the forms that files are read by.
//!
//! A form is declared once; reading, checking, the JSON schema, the commented starting file and the reference page come
//! from the declaration. Reading goes on after a problem, so that all problems of a file are shown at once.

pub mod edit;
pub mod form;
pub mod kind;
pub mod reference;
pub mod schema;
pub mod source;
pub mod tree;
pub mod write;

pub use form::{Anything, Desk, Field, Form, Named, Nothing, PerAxis, Rule, Shape};
pub use source::{Problem, Problems, Sources, Span};
pub use tree::{Node, Tree};
