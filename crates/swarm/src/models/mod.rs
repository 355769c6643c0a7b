//! The models: one file each, one line each in the list below. Command line, files, help, docs, benches and law tests are all
//! made from the list.

use crate::card::Card;
use crate::engine::{Compiled, Kernel, Listed, Sensing, SideBySide, Stages, Streamed, World, WorldError, WorldPlan};
use crate::motion::{Abreast, Law, Model, Needs, Preset, Single, Stream, Summed, Variant};
use crate::parameters::{Descriptor, Kind, Parameter, ParameterError, Parameters, Points, Scalar, Values};
use crate::physics::Contact;
use crate::selection::NamedSet;
use crate::sensing::{Ideal, Occlusion};
use space::{Column, Real};

pub mod families;
#[cfg(test)]
mod laws;
#[cfg(test)]
pub(crate) mod oracle;
pub mod papers;

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
    pub(crate) velocity_is_step: bool,
    pub(crate) guarded: bool,
    /// For each member.
    pub(crate) initial_speeds: Vec<R>,
    /// Finishes the kernel when the stages are resolved.
    pub(crate) build: Build<R, D>,
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
    /// Distances at which those sets end that have an end.
    pub fn set_ends(&self) -> Vec<R> {
        self.sets.iter().filter_map(|set| set.perception.shell().high).filter(|end| end.finite()).collect()
    }
    /// Names of the sets that the selection stage makes for it.
    pub fn set_names(&self) -> Vec<&'static str> {
        self.sets.iter().map(|set| set.name).collect()
    }
}

/// Finishes a kernel.
type Build<R, const D: usize> = Box<dyn FnOnce(Stages<R, D>) -> Box<dyn Kernel<R, D>>>;

/// What a model says of itself, with the kernel that its law makes.
fn prepared<R: Scalar, const D: usize, M: Law<R>>(
    model: &M,
    members: usize,
    sets: Vec<NamedSet<R, D>>,
    stream_reach: Option<R>,
    build: Build<R, D>,
) -> Result<Prepared<R, D>, ParameterError> {
    points_have_all_coordinates(&model.values(), &M::descriptors(), D)?;
    model.check(members).map_err(ParameterError::Together)?;
    Ok(Prepared {
        sets,
        columns: M::columns(),
        needs: model.needs(),
        time_step: model.time_step(),
        obstacle_reach: model.obstacle_reach(),
        body_radius: model.body_radius(),
        contact: model.contact(),
        bodies_meet: model.bodies_meet(),
        velocity_is_step: model.velocity_is_step(),
        guarded: model.guarded(),
        initial_speeds: of_each(members, &|member| model.initial_speed_of(member)),
        stream_reach,
        build,
    })
}

/// The kernel of a law that is given lists.
fn listed<R: Scalar, const D: usize, T: Model<R, D>>(law: T) -> Build<R, D> {
    Box::new(move |stages| Box::new(Listed { law, stages }))
}

/// The sets, reach and kernel of a law that sums neighbour by neighbour.
fn streamed<R: Scalar, const D: usize, T: Stream<R, D>>(law: T) -> (Vec<NamedSet<R, D>>, Option<R>, Build<R, D>) {
    let (sets, reach) = (law.sets(), law.reach());
    if sets.iter().any(|set| set.perception.ranks()) {
        // a rank cannot be told neighbour by neighbour: the same sums, over lists
        return (sets, None, listed(Summed(law)));
    }
    let build: Build<R, D> = Box::new(move |stages| Box::new(Streamed { listed: Listed { law: Summed(law), stages } }));
    (sets, Some(reach), build)
}

/// A number for each member; compiled once and not with each law.
fn of_each<R: Scalar>(members: usize, number: &dyn Fn(usize) -> R) -> Vec<R> {
    (0..members).map(number).collect()
}

/// Refuses a point that lacks a coordinate: to the law it would be none at all.
fn points_have_all_coordinates(values: &Values, descriptors: &[Descriptor], axes: usize) -> Result<(), ParameterError> {
    for descriptor in descriptors.iter().filter(|descriptor| descriptor.takes == Kind::Points) {
        let points = values.get(descriptor.name).and_then(Points::<f64>::read).unwrap_or(Points(Vec::new()));
        if let Some(short) = points.0.iter().find(|point| point.len() != axes) {
            return Err(ParameterError::Together(format!(
                "`{}` needs {axes} coordinates for each point, found {}",
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
    let law = M::from_values(values)?;
    prepared(&law.clone(), members, law.sets(), None, listed(law))
}

/// A law that sums neighbour by neighbour.
fn streams<R: Scalar, const D: usize, M: Law<R> + Stream<R, D>>(
    values: &Values,
    members: usize,
) -> Result<Prepared<R, D>, ParameterError> {
    let law = M::from_values(values)?;
    let (sets, reach, build) = streamed(law.clone());
    prepared(&law, members, sets, reach, build)
}

/// A law that looks for itself and moves abreast with others.
fn abreast<R: Scalar, const D: usize, M: Law<R> + Abreast<R, D>>(
    values: &Values,
    members: usize,
) -> Result<Prepared<R, D>, ParameterError> {
    let law = M::from_values(values)?;
    let build: Build<R, D> = {
        let law = Single(law.clone());
        Box::new(move |stages| Box::new(SideBySide { listed: Listed { law, stages } }))
    };
    prepared(&law, members, law.sets(), None, build)
}

/// A variant of a law that is given lists.
fn lists_as<R: Scalar, const D: usize, M: Variant<R>>(
    values: &Values,
    members: usize,
) -> Result<Prepared<R, D>, ParameterError>
where
    M::Shared: Model<R, D>,
{
    let model = M::from_values(values)?;
    let law = model.shared();
    prepared(&model, members, law.sets(), None, listed(law))
}

/// A variant of a law that sums neighbour by neighbour.
fn streams_as<R: Scalar, const D: usize, M: Variant<R>>(
    values: &Values,
    members: usize,
) -> Result<Prepared<R, D>, ParameterError>
where
    M::Shared: Stream<R, D>,
{
    let model = M::from_values(values)?;
    let (sets, reach, build) = streamed(model.shared());
    prepared(&model, members, sets, reach, build)
}

/// A model whose law is put together when its parameters are known.
trait Composite<R: Scalar, const D: usize>: Law<R> {
    /// What it says of itself, with its kernel.
    fn prepared(self, members: usize) -> Result<Prepared<R, D>, ParameterError>;
}

/// A law that is put together from its parameters.
fn composes<R: Scalar, const D: usize, M: Composite<R, D>>(
    values: &Values,
    members: usize,
) -> Result<Prepared<R, D>, ParameterError> {
    M::from_values(values)?.prepared(members)
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
    /// Named sets of its parameters.
    pub presets: fn() -> &'static [Preset],
    /// Whether obstacles hide the others from it, where a file says nothing of its sensing.
    pub blinded_by_obstacles: fn() -> bool,
}

impl Entry {
    /// How it senses where nothing is said of that.
    pub fn default_sensing<R: Real>(&self) -> Sensing<R> {
        let occlusion = if (self.blinded_by_obstacles)() { Occlusion::Obstacles } else { Occlusion::None };
        Sensing::Ideal(Ideal { occlusion, ..Ideal::default() })
    }
}

/// The models that work in a space of `D` dimensions.
pub trait Catalogue<R: Scalar, const D: usize> {
    /// Prepares a model; `None` where none of this id works in `D` dimensions.
    fn prepare(id: &str, values: &Values, members: usize) -> Option<Result<Prepared<R, D>, ParameterError>>;
    /// Builds a world from its plan; see [`World::new`].
    ///
    /// # Errors
    /// Whatever in the plan cannot be.
    fn world(plan: WorldPlan<R, D>) -> Result<World<R, D>, WorldError>;
    /// The engine of this precision and dimension.
    fn engine() -> Compiled<R, D>;
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
            presets: <$file::$name<f64> as Law<f64>>::presets,
            blinded_by_obstacles: <$file::$name<f64> as Law<f64>>::blinded_by_obstacles,
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
            #[inline(never)]
            fn world(plan: WorldPlan<$real, $dimension>) -> Result<World<$real, $dimension>, WorldError> {
                World::build(plan)
            }
            #[inline(never)]
            fn engine() -> Compiled<$real, $dimension> {
                Compiled {
                    step: |world| world.make_step(),
                    restore: |world, saved| world.take_over(saved),
                    explain: |world, id| world.explained(id),
                    mean_neighbours: |world, every| world.count_neighbours(every),
                }
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

// one line a model: whether it streams, is given lists, is given lists and moves abreast (`_as`: through the law that its family
// shares), or is composed of its parameters, file and type, dimensions
models! {
    streams vicsek_1995::Vicsek1995 in [2, 3];
    streams_as czirok_1997::Czirok1997 in [2, 3];
    streams_as smith_martin_2009::SmithMartin2009 in [2, 3];
    streams_as toner_tu_1998::TonerTu1998 in [2, 3];
    lists_as jadbabaie_2002_leaderless::Jadbabaie2002Leaderless in [2];
    lists_as jadbabaie_2002_leader::Jadbabaie2002Leader in [2];
    streams_as gregoire_2003_angular::Gregoire2003Angular in [2];
    streams_as gregoire_2003_vectorial::Gregoire2003Vectorial in [2, 3];
    streams_as camperi_2012::Camperi2012 in [2, 3];
    lists szabo_2008::Szabo2008 in [2, 3];
    lists ballerini_2008::Ballerini2008 in [2, 3];
    lists niizato_gunji_2011::NiizatoGunji2011 in [2, 3];
    streams couzin_2002::Couzin2002 in [2, 3];
    lists couzin_2005::Couzin2005 in [2, 3];
    lists conradt_2009::Conradt2009 in [2, 3];
    lists_as huth_wissel_a::HuthWisselA in [2];
    lists_as huth_wissel_d::HuthWisselD in [2];
    lists kunz_hemelrijk_2003::KunzHemelrijk2003 in [2];
    lists tien_2004::Tien2004 in [2, 3];
    lists lopez_2012::Lopez2012 in [2, 3];
    lists lukeman_2010::Lukeman2010 in [2, 3];
    lists katz_herbert_read_2011::KatzHerbertRead2011 in [2];
    lists gueron_1996::Gueron1996 in [2];
    lists cucker_smale_2007::CuckerSmale2007 in [1, 2, 3];
    lists dong_2012::Dong2012 in [1, 2, 3];
    lists shimoyama_1996::Shimoyama1996 in [2, 3];
    lists_as levine_2000::Levine2000 in [2, 3];
    lists_as dorsogna_2006::Dorsogna2006 in [2, 3];
    lists_as tanner_2003_fixed::Tanner2003Fixed in [1, 2, 3];
    lists_as tanner_2003_dynamic::Tanner2003Dynamic in [1, 2, 3];
    lists gazi_passino_2003::GaziPassino2003 in [1, 2, 3];
    lists gazi_passino_2005::GaziPassino2005 in [1];
    lists olfati_saber_2006::OlfatiSaber2006 in [2, 3];
    lists helbing_2005::Helbing2005 in [2];
    lists warren_2018::Warren2018 in [2];
    streams reynolds_opensteer::ReynoldsOpensteer in [2, 3];
    lists boids_plus::BoidsPlus in [2];
    lists reynolds_kline::ReynoldsKline in [2, 3];
    streams boids_rule_vectors::BoidsRuleVectors in [2, 3];
    lists_as boids_five_force::BoidsFiveForce in [2];
    lists hartman_benes_2006::HartmanBenes2006 in [2, 3];
    lists hauert_2011::Hauert2011 in [2];
    lists mataric_1993::Mataric1993 in [2];
    lists kelly_keating_1996::KellyKeating1996 in [2];
    lists arkin_balch_1999::ArkinBalch1999 in [2];
    lists_as turgut_2008::Turgut2008 in [2];
    lists_as gokce_sahin_2009::GokceSahin2009 in [2];
    lists hamilton_1d::Hamilton1d in [1];
    lists_as hamilton_2d::Hamilton2d in [2, 3];
    lists_as viscido_snn::ViscidoSnn in [2, 3];
    lists viscido_ha::ViscidoHa in [2];
    streams viscido_lch::ViscidoLch in [2, 3];
    lists ha_extended::HaExtended in [2];
    lists_as lch_group_pose::LchGroupPose in [2, 3];
    lists_as lch_member_pose::LchMemberPose in [2, 3];
    lists_as lch_group_bearing::LchGroupBearing in [2, 3];
    lists_as lch_member_bearing::LchMemberBearing in [2, 3];
    lists rm_plus::RmPlus in [2];
    lists_as snn_plus::SnnPlus in [2];
    streams competing_flocks::CompetingFlocks in [2];
    abreast behaviour_selection::BehaviourSelection in [3];
    streams control_boids::ControlBoids in [2];
    lists control_snn::ControlSnn in [2];
    lists control_random::ControlRandom in [2];
    lists contact_only::ContactOnly in [2, 3];
    lists warburton_lazarus_1991::WarburtonLazarus1991 in [2, 3];
    lists codling_2007::Codling2007 in [2, 3];
    streams boids_unit_heading::BoidsUnitHeading in [2, 3];
    streams abm_flocking::AbmFlocking in [2];
    composes composed::Composed in [1, 2, 3];
}

/// The model of an id.
pub fn find(id: &str) -> Option<&'static Entry> {
    LIST.iter().find(|entry| entry.card.id == id)
}
