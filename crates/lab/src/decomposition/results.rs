//! What came of a decomposition: clusters of approaches, named by what they do, and the names by which statements ask for them.

use super::clusters;
use super::directed::{Found, range};
use super::form::{Clustering, Effects};
use super::plan::Plan;
use super::probe::{Descriptor, NUMBERS, place};
use crate::environment::claims::{Data, hint, known};
use crate::study::expression::{Mistake, Selector, Value};
use core::ops::Range;

/// What a fragment may do to a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effect {
    /// It turns counter-clockwise.
    TurnLeft,
    /// It turns clockwise.
    TurnRight,
    /// It comes out narrower than it went in.
    Narrowing,
    /// It comes apart.
    Splitting,
    /// It leaves where it came from.
    TurningBack,
    /// Nothing that reaches the least size of an effect.
    None,
}

impl Effect {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::TurnLeft, Self::TurnRight, Self::Narrowing, Self::Splitting, Self::TurningBack, Self::None];
    /// Its name in files and tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::TurnLeft => "turn_left",
            Self::TurnRight => "turn_right",
            Self::Narrowing => "narrowing",
            Self::Splitting => "splitting",
            Self::TurningBack => "turning_back",
            Self::None => "none",
        }
    }
    /// The dominant effect of a descriptor that is relative to an empty arena: the one that exceeds its least size most often; of
    /// equals the first.
    pub fn dominant(relative: &Descriptor, sizes: &Effects) -> Self {
        let number = |name: &str| relative[place(name)];
        let times = [
            (Self::TurnLeft, number("turn") / sizes.turn),
            (Self::TurnRight, -number("turn") / sizes.turn),
            (Self::Narrowing, -number("across") / sizes.narrowing),
            (Self::Splitting, number("groups") / sizes.splitting),
            (Self::TurningBack, number("back") / sizes.back),
        ];
        let greatest = times.into_iter().fold((Self::None, 0.0), |best, one| if one.1 > best.1 { one } else { best });
        if greatest.1 >= 1.0 { greatest.0 } else { Self::None }
    }
    /// Whether it is what a word asks for; `turn` is to either side.
    fn is(self, word: &str) -> bool {
        self.word() == word || (word == "turn" && matches!(self, Self::TurnLeft | Self::TurnRight))
    }
}

/// An approach that was tried: a fragment at a heading.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// Its number among the approaches.
    pub approach: usize,
    /// What was found.
    pub descriptor: Descriptor,
    /// The same less what was found in an empty arena; transit as a share of that.
    pub relative: Descriptor,
    /// Its own dominant effect.
    pub effect: Effect,
    /// Its cluster; none where it is noise.
    pub cluster: Option<usize>,
}

/// Approaches that do the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Cluster {
    /// Its name, as for files: the dominant effect of its mean, with a number where several have the same.
    pub name: String,
    /// The dominant effect of its mean.
    pub effect: Effect,
    /// Its approaches, by their places among the items.
    pub items: Vec<usize>,
    /// The one nearest to all others.
    pub medoid: usize,
    /// Mean of the relative descriptors.
    pub mean: Descriptor,
    /// Mean and standard deviation of the standardised ones.
    pub standardised: Vec<(f64, f64)>,
}

/// The results.
pub struct Results<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// What was found in empty arenas, by window.
    pub controls: Vec<Option<Descriptor>>,
    /// The approaches in whose arenas somebody came.
    pub items: Vec<Item>,
    /// The clusters, the largest first.
    pub clusters: Vec<Cluster>,
    /// Silhouettes by numbers of clusters.
    pub silhouettes: Vec<(usize, f64)>,
    /// The silhouette of these clusters.
    pub silhouette: f64,
    /// What was found of the variations of each stretch; the last is without any wall.
    pub varied: Vec<Vec<Found>>,
}

/// A descriptor in comparison with that of an empty arena.
fn relative(found: &Descriptor, control: &Descriptor) -> Descriptor {
    let transit = place("transit");
    core::array::from_fn(|k| match k {
        k if k == transit && control[k] > 0.0 => found[k] / control[k],
        k => found[k] - control[k],
    })
}

impl<'a> Results<'a> {
    /// From what was found of each approach, in each empty arena, and of the variations of each stretch.
    pub fn new(
        plan: &'a Plan,
        found: Vec<Option<Descriptor>>,
        controls: Vec<Option<Descriptor>>,
        varied: Vec<Vec<Found>>,
    ) -> Self {
        // of a stretch between peaks of curvature the window that is nearest to its length
        let window = |width: f64| {
            let off = |k: usize| (plan.form.windows[k] - width).abs();
            (0..plan.form.windows.len()).min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(0)
        };
        let mut items: Vec<Item> = Vec::new();
        for (approach, found) in found.into_iter().enumerate() {
            let control = controls.get(window(plan.approach(approach).0.width)).copied().flatten();
            let (Some(descriptor), Some(control)) = (found, control) else { continue };
            let relative = relative(&descriptor, &control);
            let effect = Effect::dominant(&relative, &plan.form.effect);
            items.push(Item { approach, descriptor, relative, effect, cluster: None });
        }
        let rows: Vec<Vec<f64>> = items.iter().map(|item| item.relative.to_vec()).collect();
        let scaled = clusters::standardised(&rows);
        let distances = clusters::distances(&scaled);
        let (labels, silhouettes): (Vec<Option<usize>>, _) = match &plan.form.cluster {
            Clustering::AverageLinkage(linkage) => {
                let (labels, silhouettes) = clusters::by_linkage(&distances, linkage.least, linkage.most);
                (labels.into_iter().map(Some).collect(), silhouettes)
            }
            Clustering::Dbscan(density) => {
                (clusters::by_density(&distances, density.radius, density.least), Vec::new())
            }
        };
        let mut results = Self { plan, controls, items, clusters: Vec::new(), silhouette: 0.0, silhouettes, varied };
        results.silhouette = clusters::silhouette_of(&distances, &labels);
        results.name(&labels, &clusters::medoids(&distances, &labels), &scaled);
        results
    }
    /// Puts clusters in order and names them.
    fn name(&mut self, labels: &[Option<usize>], medoids: &[usize], scaled: &[Vec<f64>]) {
        for (cluster, &medoid) in medoids.iter().enumerate() {
            let items: Vec<usize> = (0..labels.len()).filter(|&item| labels[item] == Some(cluster)).collect();
            let count = items.len().max(1) as f64;
            let mean_of = |of: &dyn Fn(usize) -> f64| items.iter().map(|&item| of(item)).sum::<f64>() / count;
            let mean: Descriptor = core::array::from_fn(|k| mean_of(&|item| self.items[item].relative[k]));
            let standardised = (0..NUMBERS.len()).map(|k| {
                let mean = mean_of(&|item| scaled[item][k]);
                (mean, mean_of(&|item| (scaled[item][k] - mean) * (scaled[item][k] - mean)).sqrt())
            });
            let standardised = standardised.collect();
            let effect = Effect::dominant(&mean, &self.plan.form.effect);
            self.clusters.push(Cluster { name: String::new(), effect, items, medoid, mean, standardised });
        }
        // the largest first; of equals the one that has the first item
        self.clusters.sort_by_key(|cluster| (std::cmp::Reverse(cluster.items.len()), cluster.items.first().copied()));
        for number in 0..self.clusters.len() {
            let effect = self.clusters[number].effect;
            let before = self.clusters[..number].iter().filter(|cluster| cluster.effect == effect).count();
            let word = effect.word();
            self.clusters[number].name = if before == 0 { word.to_owned() } else { format!("{word}_{}", before + 1) };
            for item in self.clusters[number].items.clone() {
                self.items[item].cluster = Some(number);
            }
        }
    }
    /// Results without an item, to find out whether statements have a meaning.
    pub(super) fn example(plan: &'a Plan) -> Self {
        let (items, clusters, silhouettes) = (Vec::new(), Vec::new(), Vec::new());
        let varied = vec![vec![Found::default(); super::directed::variations(&plan.form.vary)]; plan.marked.len()];
        Self { plan, controls: Vec::new(), items, clusters, silhouettes, silhouette: 0.0, varied }
    }
    /// What was found of the fit of a stretch itself, and without any wall.
    pub fn fit(&self, marked: usize) -> (Found, Found) {
        let vary = &self.plan.form.vary;
        let own = (0..self.varied[marked].len()).find(|&k| super::directed::variation(vary, k) == Some((0.0, 1.0)));
        let of = |k: Option<usize>| k.and_then(|k| self.varied[marked].get(k)).copied().unwrap_or_default();
        (of(own), of(self.varied[marked].len().checked_sub(1)))
    }
    /// The range of angles and factors in which a stretch still does what is expected.
    pub fn range(&self, marked: usize) -> Option<[(f64, f64); 2]> {
        range(&self.plan.form.vary, &self.varied[marked])
    }
    /// The name of an item's cluster.
    pub fn cluster_of(&self, item: &Item) -> &str {
        item.cluster.map_or("noise", |cluster| self.clusters[cluster].name.as_str())
    }
    /// The share of pairs of approaches with these effects of their own that are not of one cluster; none without a pair.
    pub fn apart(&self, one: &str, other: &str) -> Option<f64> {
        let count = |word: &str, cluster: Option<usize>| {
            let own = self.items.iter().filter(|item| item.effect.is(word));
            own.filter(|item| cluster.is_none() || item.cluster == cluster).count() as f64
        };
        let pairs = count(one, None) * count(other, None);
        let same: f64 = (0..self.clusters.len()).map(|k| count(one, Some(k)) * count(other, Some(k))).sum();
        (pairs > 0.0).then(|| 1.0 - same / pairs)
    }
}

/// Names that statements may use, with what they mean.
pub const NAMES: [(&str, &str); 11] = [
    ("fragments", "fragments of the construct"),
    ("clusters", "clusters"),
    ("silhouette", "mean silhouette of the clusters"),
    ("named", "clusters with this dominant effect; needs [effect = ...]"),
    ("share", "share of the approaches whose own dominant effect this is; needs [effect = ...]"),
    (
        "apart",
        "share of pairs of approaches with these two effects that lie in different clusters; needs [effect = ..., from = ...]",
    ),
    ("pieces", "segments and arcs that fit a stretch; needs [interval = ...], as those below"),
    ("rate", "share of successes of the fit of a stretch"),
    ("bare", "share of successes without any wall"),
    ("angles", "width of the range of angles in which the fit still does what is expected, degrees"),
    ("lengths", "width of the range of factors"),
];

impl Data for Results<'_> {
    /// Fragments of a construct are all there are.
    fn items(&self) -> usize {
        0
    }
    fn value(
        &self,
        name: &str,
        selectors: &[Selector],
        bytes: &Range<usize>,
        _: Option<&[usize]>,
    ) -> Result<Value, Mistake> {
        known(name, &NAMES, bytes, "a decomposition")?;
        let words: Vec<&str> = Effect::ALL.iter().map(|effect| effect.word()).chain(["turn"]).collect();
        let intervals: Vec<&str> = self.plan.marked.iter().map(|marked| marked.name.as_str()).collect();
        let (mut effect, mut from, mut interval) = (None, None, None);
        for selector in selectors {
            if selector.factor == "interval" {
                let level = match &selector.level {
                    Value::Text(level) => level.clone(),
                    // a name may be a number
                    Value::Number(number) => number.to_string(),
                    _ => return Err(Mistake::new(selector.bytes.clone(), "a name is needed here")),
                };
                interval = Some(intervals.iter().position(|known| *known == level).ok_or_else(|| {
                    let what = format!("there is no interval `{level}`");
                    Mistake { help: hint(&level, &intervals), ..Mistake::new(selector.bytes.clone(), what) }
                })?);
                continue;
            }
            let place = match selector.factor.as_str() {
                "effect" => &mut effect,
                "from" => &mut from,
                other => {
                    let help = hint(other, &["effect", "from", "interval"]);
                    return Err(Mistake { help, ..Mistake::new(selector.bytes.clone(), format!("unknown `{other}`")) });
                }
            };
            let Value::Text(word) = &selector.level else {
                return Err(Mistake::new(selector.bytes.clone(), "the name of an effect is needed here"));
            };
            if !words.contains(&word.as_str()) {
                let what = format!("there is no effect `{word}`");
                return Err(Mistake { help: hint(word, &words), ..Mistake::new(selector.bytes.clone(), what) });
            }
            *place = Some(word.clone());
        }
        let needed = |word: Option<String>, key: &str| {
            word.ok_or_else(|| {
                let help = format!("one of {}", words.join(", "));
                Mistake { help, ..Mistake::new(bytes.clone(), format!("`{name}` needs [{key} = ...]")) }
            })
        };
        let stretch = || match (interval, self.plan.marked.len()) {
            (Some(number), _) => Ok(number),
            (None, 1) => Ok(0),
            _ => {
                let help = format!("known here: {}", intervals.join(", "));
                Err(Mistake { help, ..Mistake::new(bytes.clone(), format!("`{name}` needs [interval = ...]")) })
            }
        };
        let width = |axis: usize| -> Result<f64, Mistake> {
            Ok(self.range(stretch()?).map_or(f64::NAN, |range| range[axis].1 - range[axis].0))
        };
        Ok(Value::Number(match name {
            "pieces" => self.plan.marked[stretch()?].fits.len() as f64,
            "rate" => self.fit(stretch()?).0.rate(),
            "bare" => self.fit(stretch()?).1.rate(),
            "angles" => width(0)?,
            "lengths" => width(1)?,
            "fragments" => self.plan.fragments.len() as f64,
            "clusters" => self.clusters.len() as f64,
            "silhouette" => self.silhouette,
            "named" => {
                let word = needed(effect, "effect")?;
                self.clusters.iter().filter(|cluster| cluster.effect.is(&word)).count() as f64
            }
            "share" => {
                let word = needed(effect, "effect")?;
                let own = self.items.iter().filter(|item| item.effect.is(&word)).count();
                own as f64 / self.items.len() as f64
            }
            _ => self.apart(&needed(effect, "effect")?, &needed(from, "from")?).unwrap_or(f64::NAN),
        }))
    }
}
