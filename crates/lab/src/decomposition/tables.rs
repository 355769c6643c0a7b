//! The tables of a decomposition: every approach, every cluster, every variation of a stretch.

use super::directed::variation;
use super::probe::NUMBERS;
use super::results::{Cluster, Item, Results};
use crate::design::tables::words;
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_table};

/// A row for each approach in whose arena somebody came.
pub const APPROACHES: &str = "approaches.parquet";
/// A row for each cluster.
pub const CLUSTERS: &str = "clusters.parquet";
/// A row for each variation of each stretch.
pub const VARIATIONS: &str = "variations.parquet";

/// Writes the tables.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, results: &Results<'_>) -> Result<(), StoreError> {
    let notes = [("flockworks.title".to_owned(), results.plan.form.title.clone())];
    let (headings, columns) = approaches(results);
    write_table(folder, APPROACHES, &headings, &columns, &notes)?;
    let (headings, columns) = clusters(results);
    write_table(folder, CLUSTERS, &headings, &columns, &notes)?;
    let (headings, columns) = variations(results);
    write_table(folder, VARIATIONS, &headings, &columns, &notes)
}

fn variations(results: &Results<'_>) -> (Vec<Heading>, Vec<Values>) {
    let vary = &results.plan.form.vary;
    let rows: Vec<(usize, usize)> =
        results.varied.iter().enumerate().flat_map(|(marked, all)| (0..all.len()).map(move |k| (marked, k))).collect();
    let of = |of: &dyn Fn(usize, usize) -> f64| Values::Double(rows.iter().map(|&(marked, k)| of(marked, k)).collect());
    let headings = vec![
        Heading::new("interval", "", "The stretch.", Kind::Word),
        Heading::new(
            "angle",
            "deg",
            "By what the fit is turned about its first end; not a number without any wall.",
            Kind::Double,
        ),
        Heading::new("factor", "1", "By what it is stretched; not a number without any wall.", Kind::Double),
        Heading::new("trials", "1", "Trials.", Kind::Long),
        Heading::new("rate", "1", "Share of successes.", Kind::Double),
    ];
    let columns = vec![
        words(rows.iter().map(|row| results.plan.marked[row.0].name.clone())),
        of(&|_, k| variation(vary, k).map_or(f64::NAN, |variation| variation.0)),
        of(&|_, k| variation(vary, k).map_or(f64::NAN, |variation| variation.1)),
        Values::Long(rows.iter().map(|row| results.varied[row.0][row.1].trials as i64).collect()),
        of(&|marked, k| results.varied[marked][k].rate()),
    ];
    (headings, columns)
}

/// Attributes of an approach, with units and meanings: of what a primitive has ranges.
pub const ATTRIBUTES: [(&str, &str, &str); 4] = [
    ("width", "length", "Width of the window."),
    ("length", "length", "Length of wall in it."),
    ("angle", "deg", "Heading of the approach, from the direction of the line through the window."),
    ("curvature", "deg/length", "How far the line turns within the window, per width."),
];

/// The attributes of an item.
pub fn attributes(results: &Results<'_>, item: &Item) -> [f64; ATTRIBUTES.len()] {
    let (fragment, heading) = results.plan.approach(item.approach);
    [fragment.width, fragment.length, heading, fragment.turning / fragment.width]
}

fn approaches(results: &Results<'_>) -> (Vec<Heading>, Vec<Values>) {
    let rows = &results.items;
    let plan = results.plan;
    let of = |of: &dyn Fn(&Item) -> f64| Values::Double(rows.iter().map(of).collect());
    let mut headings = vec![
        Heading::new("line", "1", "The line of the construct, from 1.", Kind::Long),
        Heading::new("middle", "length", "Arc length of the window's middle.", Kind::Double),
        Heading::new("x", "length", "Middle of the fragment.", Kind::Double),
        Heading::new("y", "length", "Middle of the fragment.", Kind::Double),
    ];
    let mut columns = vec![
        Values::Long(rows.iter().map(|item| plan.approach(item.approach).0.line as i64 + 1).collect()),
        of(&|item| plan.approach(item.approach).0.middle),
        of(&|item| plan.approach(item.approach).0.pose.at[0]),
        of(&|item| plan.approach(item.approach).0.pose.at[1]),
    ];
    for (k, (name, unit, about)) in ATTRIBUTES.iter().enumerate() {
        headings.push(Heading::new(name, unit, about, Kind::Double));
        columns.push(of(&|item| attributes(results, item)[k]));
    }
    for (k, (name, unit, about)) in NUMBERS.iter().enumerate() {
        headings.push(Heading::new(name, unit, about, Kind::Double));
        columns.push(of(&|item| item.descriptor[k]));
    }
    for (k, (name, ..)) in NUMBERS.iter().enumerate() {
        let about = format!("`{name}` in comparison with an empty arena.");
        headings.push(Heading::new(&format!("{name}_relative"), "", &about, Kind::Double));
        columns.push(of(&|item| item.relative[k]));
    }
    headings.extend([
        Heading::new("effect", "", "The dominant effect of this approach.", Kind::Word),
        Heading::new("cluster", "", "Its cluster; `noise` where it belongs to none.", Kind::Word),
    ]);
    columns.extend([
        words(rows.iter().map(|item| item.effect.word().to_owned())),
        words(rows.iter().map(|item| results.cluster_of(item).to_owned())),
    ]);
    (headings, columns)
}

/// Least and greatest of an attribute in a cluster.
pub fn range(results: &Results<'_>, cluster: &Cluster, attribute: usize) -> (f64, f64) {
    let values = cluster.items.iter().map(|&item| attributes(results, &results.items[item])[attribute]);
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

fn clusters(results: &Results<'_>) -> (Vec<Heading>, Vec<Values>) {
    let rows = &results.clusters;
    let of = |of: &dyn Fn(&Cluster) -> f64| Values::Double(rows.iter().map(of).collect());
    let mut headings = vec![
        Heading::new("cluster", "", "Its name.", Kind::Word),
        Heading::new("effect", "", "The dominant effect of its mean.", Kind::Word),
        Heading::new("approaches", "1", "Approaches in it.", Kind::Long),
    ];
    let mut columns = vec![
        words(rows.iter().map(|cluster| cluster.name.clone())),
        words(rows.iter().map(|cluster| cluster.effect.word().to_owned())),
        Values::Long(rows.iter().map(|cluster| cluster.items.len() as i64).collect()),
    ];
    for (k, (name, unit, about)) in ATTRIBUTES.iter().enumerate() {
        for end in ["low", "medoid", "high"] {
            headings.push(Heading::new(&format!("{name}_{end}"), unit, about, Kind::Double));
            columns.push(of(&|cluster| match end {
                "low" => range(results, cluster, k).0,
                "high" => range(results, cluster, k).1,
                _ => attributes(results, &results.items[cluster.medoid])[k],
            }));
        }
    }
    for (k, (name, ..)) in NUMBERS.iter().enumerate() {
        let about = format!("Mean of `{name}` in comparison with an empty arena.");
        headings.push(Heading::new(&format!("{name}_relative"), "", &about, Kind::Double));
        columns.push(of(&|cluster| cluster.mean[k]));
    }
    (headings, columns)
}
