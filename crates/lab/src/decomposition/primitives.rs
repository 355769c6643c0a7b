//! The primitives that were found, as files: of each cluster and of each stretch a shape grammar that a design file can name, which draws
//! the medoid, or the fit, with attributes out of the range that was found; and each as it is, with a trial.

use super::results::{Cluster, Results};
use super::tables::{ATTRIBUTES, attributes, range};
use crate::design::export::{ENVIRONMENTS, environment_files};
use crate::environment::trial;
use crate::file::write::toml;
use crate::file::{Node, Span, Tree};
use crate::store::StoreError;
use crate::store::folder::{Folder, whole_file};
use std::io::Write;
use terrain::{Construct, Environment, Geometry, Piece, Units, Workspace};

/// The folder of primitives, inside that of the decomposition.
pub const PRIMITIVES: &str = "primitives";

/// Writes the files.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, results: &Results<'_>) -> Result<(), StoreError> {
    // clusters made in another way have other names
    for old in [PRIMITIVES, ENVIRONMENTS] {
        let old = folder.file(old);
        if old.exists() {
            std::fs::remove_dir_all(&old).map_err(|error| StoreError::io("remove the folder", &old, error))?;
        }
    }
    let below = folder.file(PRIMITIVES);
    std::fs::create_dir_all(&below).map_err(|error| StoreError::io("make the folder", &below, error))?;
    let plan = results.plan;
    let write = |name: &str, text: &str| {
        let path = below.join(format!("{name}.toml"));
        whole_file(&path, |out| out.write_all(text.as_bytes()).map_err(|error| StoreError::io("write", &path, error)))
    };
    for (number, marked) in plan.marked.iter().enumerate() {
        if let Some(text) = of_stretch(results, number) {
            write(&marked.name, &text)?;
        }
        let environment = Environment {
            workspace: plan.workspace.workspace.clone(),
            construct: marked.construct(plan.construct.units, 0.0, 1.0),
            schedule: None,
        };
        let title = format!("{}: {}", plan.form.title, marked.name);
        let trial = trial::file(&plan.population, environment.geometry(), Vec::new(), plan.varied_seed(1), &title);
        environment_files(folder, &marked.name, &environment, &trial)?;
    }
    for cluster in &results.clusters {
        write(&cluster.name, &of_cluster(results, cluster))?;
        let item = &results.items[cluster.medoid];
        let probe = plan.probe(item.approach, plan.form.offsets / 2);
        let piece = Piece { name: cluster.name.clone(), geometry: probe.geometry };
        let construct = Construct::new(plan.construct.units, vec![piece]);
        let workspace = Workspace::empty("arena", plan.construct.units);
        let environment = Environment { workspace, construct, schedule: None };
        let title = format!("{}: {}", plan.form.title, cluster.name);
        let trial = trial::file(&plan.population, environment.geometry(), Vec::new(), plan.seed_of(1), &title);
        environment_files(folder, &cluster.name, &environment, &trial)?;
    }
    Ok(())
}

/// The grammar of a cluster: its medoid about the origin, for a group that comes along x. The angle is one of those in the cluster,
/// the scale uniform between the widths of its windows.
pub fn of_cluster(results: &Results<'_>, cluster: &Cluster) -> String {
    let plan = results.plan;
    let item = &results.items[cluster.medoid];
    let (fragment, _) = plan.approach(item.approach);
    let mut turns: Vec<f64> =
        cluster.items.iter().map(|&item| 0.0 - plan.approach(results.items[item].approach).1).collect();
    turns.sort_by(f64::total_cmp);
    turns.dedup();
    let width = range(results, cluster, 0);
    let ranges = ATTRIBUTES.iter().enumerate().map(|(k, (name, unit, _))| {
        let ((low, high), medoid) = (range(results, cluster, k), attributes(results, item)[k]);
        format!("{name}, {unit}: {low} to {high}; of the medoid {medoid}")
    });
    let lead = format!(
        "A primitive that was found by decomposition: {} of {} approaches do this, `{}`. It stands about the\norigin for a group that comes \
         along x.",
        cluster.items.len(),
        results.items.len(),
        cluster.effect.word()
    );
    let about: Vec<String> = std::iter::once(lead).chain(ranges).collect();
    let size = (width.0 / fragment.width, width.1 / fragment.width);
    let angle = entry("choice", numbers(&turns));
    grammar(&cluster.name, &about.join("\n"), plan.construct.units, &fragment.geometry, angle, size)
}

/// The grammar of a stretch: its fit about the origin, turned and stretched within the range that still does what is expected; none
/// where the fit itself does not.
pub fn of_stretch(results: &Results<'_>, marked: usize) -> Option<String> {
    let plan = results.plan;
    let own = &plan.marked[marked];
    let [angle, factor] = results.range(marked)?;
    let (found, bare) = results.fit(marked);
    let pieces = own.fits.iter().map(|fit| {
        let shape = &fit.shape;
        let kind = if matches!(shape, terrain::fit::Shape::Segment(_)) { "segment" } else { "arc" };
        let (heading, length, turning) = (shape.heading(), shape.length(), shape.turning());
        format!(
            "{kind}: angle {} to {} deg, length {} to {}, turning {turning} deg",
            heading + angle.0,
            heading + angle.1,
            length * factor.0,
            length * factor.1
        )
    });
    let lead = format!(
        "A primitive that was found by decomposition: the stretch `{}` does what is expected in {} of {} trials as it\nwas fitted, {} of {} \
         without any wall. Its first end is the origin, its heading that of the construct.",
        own.name, found.successes, found.trials, bare.successes, bare.trials
    );
    let about: Vec<String> = std::iter::once(lead).chain(pieces).collect();
    let turn = entry("uniform", numbers(&[angle.0, angle.1]));
    Some(grammar(&own.name, &about.join("\n"), plan.construct.units, &own.shape(0.0, 1.0), turn, factor))
}

fn numbers(values: &[f64]) -> Tree {
    Tree::list(values.iter().map(|value| Tree::Number(*value)))
}

fn table(entries: Vec<(&str, Tree)>) -> Tree {
    Tree::table(entries.into_iter().map(|(key, value)| (key.to_owned(), value)))
}

fn entry(key: &str, value: Tree) -> Tree {
    table(vec![(key, value)])
}

/// A grammar that puts geometry at the origin, at an angle and a size that are drawn.
fn grammar(name: &str, about: &str, units: Units, geometry: &[Geometry], angle: Tree, size: (f64, f64)) -> String {
    let (mut lines, mut points) = (Vec::new(), Vec::new());
    for part in geometry {
        match part {
            Geometry::Disc { centre, radius } => {
                points.push(table(vec![("centre", numbers(&centre.0)), ("radius", Tree::Number(*radius))]));
            }
            other => lines.extend(other.segments().iter().map(|wall| numbers(&wall.numbers()))),
        }
    }
    let mut shape = vec![("name", "primitive".into()), ("kind", "terminal".into())];
    for (key, list) in [("lines", lines), ("points", points)] {
        if !list.is_empty() {
            shape.push((key, Tree::list(list)));
        }
    }
    let place = vec![
        ("name", "place".into()),
        ("kind", "nonterminal".into()),
        ("lines", Tree::list([numbers(&[-0.5, 0.0, 0.5, 0.0])])),
    ];
    let put = vec![
        ("shape", "primitive".into()),
        ("at", "origin".into()),
        ("turn", "angle".into()),
        ("scale", "size".into()),
    ];
    let vars = vec![("angle", angle), ("size", entry("uniform", numbers(&[size.0, size.1])))];
    let rule = vec![
        ("name", "put".into()),
        ("kind", "substitution".into()),
        ("left", Tree::list([entry("shape", "place".into())])),
        ("right", Tree::list([table(put)])),
        ("vars", table(vars)),
    ];
    let tree = table(vec![
        ("grammar", table(vec![("name", name.into()), ("units", units.word().into())])),
        ("shape", Tree::list([table(shape), table(place)])),
        ("axiom", Tree::list([entry("shape", "place".into())])),
        ("rule", Tree::list([table(rule)])),
    ]);
    let about: Vec<String> = about.lines().map(|line| format!("# {line}\n")).collect();
    let taken = format!("# A design takes it by candidates.grammar = \"{name}.toml\".\n");
    format!("{}{taken}{}", about.concat(), toml(&Node { tree, span: Span::default() }))
}
