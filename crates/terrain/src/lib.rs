//! `terrain`: environments that steer a group, generated and judged without one.
//!
//! A *schema* makes a [`Construct`] from parameters and a seed: a shape [`grammar`] by deriving, a computational schema
//! ([`schemas`]) by formula. Put into a [`Workspace`] it is an [`Environment`]; [`filters`] say whether it is feasible.
//! Every construct knows its seed, its attempt and its derivation, so that it can be made again and drawn step by step.
//! What a group does in it is for other rooms to find out.
//!
//! ```
//! use terrain::filters::{Corralling, Filter};
//! use terrain::{grammars, workspaces};
//!
//! let grammar = grammars::find("corralling")?;
//! let construct = grammar.construct(7, 0)?;
//! let verdict = Corralling.check(&construct, &workspaces::field(None));
//! assert!(verdict.pass || !verdict.reason.is_empty());
//! // the same again, and how it came about
//! assert_eq!(grammar.construct(7, 0)?, construct);
//! for step in &grammar.derive(7, 0)?.steps {
//!     assert!(["tighten", "curve", "open"].contains(&step.rule.as_str()));
//! }
//! # Ok::<(), terrain::TerrainError>(())
//! ```

mod arrangement;
mod clearance;
mod construct;
mod draws;
mod error;
pub mod expression;
pub mod filters;
pub mod fit;
pub mod fragments;
pub mod generate;
pub mod geometry;
pub mod grammar;
pub mod grammars;
pub mod hierarchy;
pub mod perturb;
pub mod posts;
pub mod primitives;
pub mod reduction;
pub mod schema;
pub mod schemas;
pub mod text;
mod workspace;
pub mod workspaces;

pub use arrangement::{Corral, escapes, hull, in_hull};
pub use clearance::escapes_with_clearance;
pub use construct::{Change, Construct, Environment, Marker, Piece, Placement, Provenance, TimeEvent, TimePlan};
pub use draws::{Distribution, Draws};
pub use error::TerrainError;
pub use expression::Expression;
pub use geometry::{Geometry, Point, Pose, Units};
pub use grammar::{Derivation, Grammar};
pub use schema::Schema;
pub use workspace::{Workspace, within};
