//! The models: one file each, one line each in the list below. Command line, files, help, docs, benches and law tests are all
//! made from the list.

use crate::card::Card;
use crate::engine::{Kernel, Listed, Stages, Streamed};
use crate::motion::{Law, Model, Needs, Stream, Summed};
use crate::parameters::{Descriptor, Kind, Parameter, ParameterError, Parameters, Points, Scalar, Values};
use crate::physics::Contact;
use crate::selection::NamedSet;
use space::Column;

#[cfg(test)]
mod laws;
#[cfg(test)]
pub(crate) mod oracle;

/// What a model says of itself once its parameters are known: what the engine needs to build a group.
pub struct Prepared<R, const D: usize> {
    pub(crate) sets: Vec<NamedSet<R, D>>,
    pub(crate) columns: &'static [Column],
    pub(crate) needs: Needs,
    pub(crate) time_step: R,
    pub(crate) obstacle_reach: Option<R>,
    pub(crate) body_radius: R,
    pub(crate) contact: Contact,
    pub(crate) bodies_meet: bool,
    /// For each member.
    pub(crate) initial_speeds: Vec<R>,
    /// Finishes the kernel when the stages are resolved.
    pub(crate) build: Box<dyn FnOnce(Stages<R, D>) -> Box<dyn Kernel<R, D>>>,
    /// The neighbourhood a streaming law sums over, for choosing the index.
    pub(crate) stream_reach: Option<R>,
}

impl<R: Scalar, const D: usize> Prepared<R, D> {
    /// Radius of a body, unless a group says otherwise.
    pub fn body_radius(&self) -> R {
        self.body_radius
    }
    /// Speed at which each member begins, unless its velocity is given.
    pub fn initial_speeds(&self) -> &[R] {
        &self.initial_speeds
    }
    /// Time of a step.
    pub fn time_step(&self) -> R {
        self.time_step
    }
    /// Names of the sets that the selection stage makes for it.
    pub fn set_names(&self) -> Vec<&'static str> {
        self.sets.iter().map(|set| set.name).collect()
    }
}

fn prepared<R: Scalar, const D: usize, M: Law<R>>(
    law: M,
    members: usize,
    sets: fn(&M) -> Vec<NamedSet<R, D>>,
    stream_reach: Option<R>,
    build: fn(M, Stages<R, D>) -> Box<dyn Kernel<R, D>>,
) -> Result<Prepared<R, D>, ParameterError> {
    points_have_all_coordinates::<R, D, M>(&law)?;
    law.check(members).map_err(ParameterError::Together)?;
    Ok(Prepared {
        sets: sets(&law),
        columns: M::columns(),
        needs: law.needs(),
        time_step: law.time_step(),
        obstacle_reach: law.obstacle_reach(),
        body_radius: law.body_radius(),
        contact: law.contact(),
        bodies_meet: law.bodies_meet(),
        initial_speeds: (0..members).map(|member| law.initial_speed_of(member)).collect(),
        stream_reach,
        build: Box::new(move |stages| build(law, stages)),
    })
}

/// Refuses a point that lacks a coordinate: to the law it would be none at all.
fn points_have_all_coordinates<R: Scalar, const D: usize, M: Law<R>>(law: &M) -> Result<(), ParameterError> {
    let values = law.values();
    for descriptor in M::descriptors().iter().filter(|descriptor| descriptor.takes == Kind::Points) {
        let points = values.get(descriptor.name).and_then(Points::<R>::read).unwrap_or(Points(Vec::new()));
        if let Some(short) = points.0.iter().find(|point| point.len() != D) {
            return Err(ParameterError::Together(format!(
                "`{}` needs {D} coordinates for each point, found {}",
                descriptor.name,
                short.len()
            )));
        }
    }
    Ok(())
}

/// A law that is given lists.
fn lists<R: Scalar, const D: usize, M: Law<R> + Model<R, D>>(
    values: &Values,
    members: usize,
) -> Result<Prepared<R, D>, ParameterError> {
    prepared(M::from_values(values)?, members, M::sets, None, |law, stages| Box::new(Listed { law, stages }))
}

/// A law that sums neighbour by neighbour.
fn streams<R: Scalar, const D: usize, M: Stream<R, D>>(
    values: &Values,
    members: usize,
) -> Result<Prepared<R, D>, ParameterError> {
    let law = M::from_values(values)?;
    if law.sets().iter().any(|set| set.perception.ranks()) {
        // a rank cannot be told neighbour by neighbour: the same sums, over lists
        return prepared(law, members, M::sets, None, |law, stages| Box::new(Listed { law: Summed(law), stages }));
    }
    let reach = law.reach();
    prepared(law, members, M::sets, Some(reach), |law, stages| {
        Box::new(Streamed { listed: Listed { law: Summed(law), stages } })
    })
}

/// A model of the list.
pub struct Entry {
    /// Its description of itself.
    pub card: &'static Card,
    /// Dimensions it works in.
    pub dimensions: &'static [usize],
    /// Its parameters.
    pub parameters: fn() -> Vec<Descriptor>,
    /// Its declared columns.
    pub columns: fn() -> &'static [Column],
}

/// The models that work in a space of `D` dimensions.
pub trait Catalogue<R: Scalar, const D: usize> {
    /// Prepares a model; `None` where none of this id works in `D` dimensions.
    fn prepare(id: &str, values: &Values, members: usize) -> Option<Result<Prepared<R, D>, ParameterError>>;
}

/// Implements [`Catalogue`] for each number of dimensions.
pub struct Models;

macro_rules! models {
    ($($way:ident $file:ident::$name:ident in [$($d:tt),+];)*) => {
        $(pub mod $file;)*
        /// All models, in the order of the list.
        pub const LIST: &[Entry] = &[$(Entry {
            card: &<$file::$name<f64> as Law<f64>>::CARD,
            dimensions: &[$($d),+],
            parameters: <$file::$name<f64> as Parameters>::descriptors,
            columns: <$file::$name<f64> as Law<f64>>::columns,
        },)*];
        models!(@catalogue f32 1 $($way $file::$name in [$($d),+];)*);
        models!(@catalogue f64 1 $($way $file::$name in [$($d),+];)*);
        models!(@catalogue f32 2 $($way $file::$name in [$($d),+];)*);
        models!(@catalogue f64 2 $($way $file::$name in [$($d),+];)*);
        models!(@catalogue f32 3 $($way $file::$name in [$($d),+];)*);
        models!(@catalogue f64 3 $($way $file::$name in [$($d),+];)*);
    };
    // not generic over the precision, so that all models are compiled here and nowhere else
    (@catalogue $real:tt $dimension:tt $($way:ident $file:ident::$name:ident in [$($d:tt),+];)*) => {
        impl Catalogue<$real, $dimension> for Models {
            fn prepare(
                id: &str,
                values: &Values,
                members: usize,
            ) -> Option<Result<Prepared<$real, $dimension>, ParameterError>> {
                $(if id == stringify!($file) {
                    return models!(@arm $dimension [$($d),+] $real $way $file::$name (values) (members));
                })*
                let _ = (values, members);
                None
            }
        }
    };
    (@arm 1 [1] $($rest:tt)*) => { models!(@call 1 $($rest)*) };
    (@arm 1 [1, 2] $($rest:tt)*) => { models!(@call 1 $($rest)*) };
    (@arm 1 [1, 2, 3] $($rest:tt)*) => { models!(@call 1 $($rest)*) };
    (@arm 2 [2] $($rest:tt)*) => { models!(@call 2 $($rest)*) };
    (@arm 2 [1, 2] $($rest:tt)*) => { models!(@call 2 $($rest)*) };
    (@arm 2 [2, 3] $($rest:tt)*) => { models!(@call 2 $($rest)*) };
    (@arm 2 [1, 2, 3] $($rest:tt)*) => { models!(@call 2 $($rest)*) };
    (@arm 3 [3] $($rest:tt)*) => { models!(@call 3 $($rest)*) };
    (@arm 3 [2, 3] $($rest:tt)*) => { models!(@call 3 $($rest)*) };
    (@arm 3 [1, 2, 3] $($rest:tt)*) => { models!(@call 3 $($rest)*) };
    (@arm $d:tt [$($other:tt),+] $($rest:tt)*) => { None };
    (@call $d:tt $real:tt $way:ident $file:ident::$name:ident ($values:ident) ($members:ident)) => {
        Some($way::<$real, $d, $file::$name<$real>>($values, $members))
    };
}

// one line a model: whether it streams or is given lists, file and type, dimensions
models! {
    streams vicsek_1995::Vicsek1995 in [2, 3];
    streams gregoire_2003_vectorial::Gregoire2003Vectorial in [2, 3];
    streams camperi_2012::Camperi2012 in [2, 3];
    lists ballerini_2008::Ballerini2008 in [2, 3];
    streams couzin_2002::Couzin2002 in [2, 3];
    lists gueron_1996::Gueron1996 in [2];
    lists cucker_smale_2007::CuckerSmale2007 in [1, 2, 3];
    lists gazi_passino_2005::GaziPassino2005 in [1];
    lists olfati_saber_2006::OlfatiSaber2006 in [2, 3];
    lists helbing_2005::Helbing2005 in [2];
    streams reynolds_opensteer::ReynoldsOpensteer in [2, 3];
    streams boids_rule_vectors::BoidsRuleVectors in [2, 3];
    lists hamilton_1d::Hamilton1d in [1];
    lists viscido_snn::ViscidoSnn in [2, 3];
    lists viscido_ha::ViscidoHa in [2];
    lists ha_extended::HaExtended in [2];
    lists lch_group_pose::LchGroupPose in [2, 3];
    streams competing_flocks::CompetingFlocks in [2];
    lists behaviour_selection::BehaviourSelection in [3];
    streams control_boids::ControlBoids in [2];
    streams boids_unit_heading::BoidsUnitHeading in [2, 3];
    streams abm_flocking::AbmFlocking in [2];
}

/// The model of an id.
pub fn find(id: &str) -> Option<&'static Entry> {
    LIST.iter().find(|entry| entry.card.id == id)
}
