//! The page of a decomposition: the construct with its fragments by cluster, what clusters do, their medoids with the ways of a group,
//! what was stated.

use super::execute::once;
use super::form::Clustering;
use super::plan::Plan;
use super::primitives::PRIMITIVES;
use super::probe::NUMBERS;
use super::results::{Cluster, NAMES, Results};
use super::tables::{ATTRIBUTES, attributes, range};
use crate::design::report::{add_ways, put};
use crate::environment::{claims, trial};
use crate::report::of_run::paragraphs;
use crate::report::{
    Axis, Drawing, Drawings, Fact, Figure, Line, Lines, Listing, Map, MapCell, MapPanel, Means, Page, Stroke, Table,
    short,
};

/// What came of it, in lines for a terminal.
pub fn lines(results: &Results<'_>) -> Vec<String> {
    let of = |cluster: &Cluster| {
        format!("{}: {} approaches; {}", cluster.name, cluster.items.len(), effects(cluster).join(", "))
    };
    let judged = claims::rows(&results.plan.form.claim, results, results.plan.form.seed);
    let stretches = fits(results)
        .rows
        .into_iter()
        .map(|row| format!("{}: {}; angle {}, length {}", row[0], row[3], row[5], row[6]));
    results.clusters.iter().map(of).chain(stretches).chain(judged.into_iter().map(|row| claims::line(&row))).collect()
}

/// What a cluster does, in words.
pub(crate) fn effects(cluster: &Cluster) -> Vec<String> {
    let number = |name: &str| cluster.mean[super::probe::place(name)];
    vec![
        format!("turn {} deg", short(number("turn"))),
        format!("across {}", short(number("across"))),
        format!("groups {}", short(number("groups"))),
        format!("back {}", short(number("back"))),
    ]
}

/// The page.
pub fn page(results: &Results<'_>, program: &str) -> Page {
    let plan = results.plan;
    let mut figures: Vec<Figure> = Vec::new();
    if !results.clusters.is_empty() {
        figures.extend(construct(results).map(Figure::Drawings));
        figures.push(Figure::Listing(clusters(results)));
        figures.push(Figure::Means(descriptors(results)));
        figures.push(Figure::Drawings(medoids(results)));
        figures.push(Figure::Listing(empty(results)));
        if !results.silhouettes.is_empty() {
            figures.push(Figure::Listing(silhouettes(results)));
        }
    }
    if !plan.marked.is_empty() {
        figures.push(Figure::Drawings(stretches(results)));
        figures.push(Figure::Listing(fits(results)));
        figures.push(Figure::Map(varied(results)));
    }
    if !plan.form.claim.is_empty() {
        figures.push(Figure::Listing(Listing {
            title: "Statements".into(),
            about: "Verdicts are of these fragments as they are.".into(),
            header: claims::header(),
            rows: claims::rows(&plan.form.claim, results, plan.form.seed),
        }));
    }
    Page {
        title: plan.form.title.clone(),
        lead: paragraphs(&plan.form.about),
        methods: methods(results),
        summary: summary(results),
        figures,
        tables: if results.items.is_empty() { Vec::new() } else { vec![csv(results)] },
        command: format!("flockworks run {}", plan.sources.name(0)),
        source: plan.sources.text(0).to_owned(),
        made_by: format!("{program}, seed {}", plan.form.seed),
    }
}

fn summary(results: &Results<'_>) -> Vec<Fact> {
    let fact = |label: &str, value: String| Fact { label: label.into(), value };
    let plan = results.plan;
    let mut facts = vec![fact("Trials", plan.all_trials().to_string())];
    if !results.clusters.is_empty() {
        facts.extend([
            fact("Fragments", plan.fragments.len().to_string()),
            fact("Approaches", results.items.len().to_string()),
            fact("Clusters", results.clusters.len().to_string()),
            fact("Silhouette", short(results.silhouette)),
        ]);
    }
    if !plan.marked.is_empty() {
        facts.push(fact("Stretches", plan.marked.len().to_string()));
    }
    facts
}

/// The stretches with their fits, and the ways of a group in a trial with the fit alone.
fn stretches(results: &Results<'_>) -> Drawings {
    let plan = results.plan;
    let mut drawings = Vec::new();
    for (number, marked) in plan.marked.iter().enumerate() {
        let mut drawing =
            Drawing { caption: format!("{}: the construct, and the fit", marked.name), ..Drawing::default() };
        put(&mut drawing, plan.construct.geometry(), Stroke::There);
        for fit in &marked.fits {
            drawing.strokes.push((Stroke::Built, fit.shape.points().iter().map(|point| point.0).collect()));
        }
        drawing.marks.push(marked.first().0);
        drawings.push(drawing);
        let (found, _) = results.fit(number);
        let construct = marked.construct(plan.construct.units, 0.0, 1.0);
        let caption = format!("{}: the fit alone, {} of {}", marked.name, found.successes, found.trials);
        let mut drawing = Drawing { caption, ..Drawing::default() };
        put(&mut drawing, &plan.workspace.workspace.geometry, Stroke::There);
        put(&mut drawing, construct.geometry(), Stroke::Built);
        if let Ok(behaviour) = plan.expected(number, &construct, true) {
            let there = plan.workspace.workspace.geometry.iter();
            let scenario = plan.population.among(there.chain(construct.geometry()));
            let mut course = Vec::new();
            // a trial that was possible is possible again
            let _ = trial::run(&scenario, &plan.population, &[behaviour], plan.varied_seed(1), &|| false, &mut |now| {
                course.push(now.to_vec());
            });
            add_ways(&mut drawing, &course);
        }
        drawings.push(drawing);
    }
    Drawings {
        title: "Stretches and their fits".into(),
        about: "A cross marks the end about which the fit is turned and stretched. Ways are those of the first trial, from blue to orange \
                with time."
            .into(),
        bounds: None,
        drawings,
    }
}

fn fits(results: &Results<'_>) -> Listing {
    let row = |(number, marked): (usize, &super::directed::Marked)| {
        let pieces: Vec<String> = marked
            .fits
            .iter()
            .map(|fit| {
                let shape = &fit.shape;
                let kind = if matches!(shape, terrain::fit::Shape::Segment(_)) { "segment" } else { "arc" };
                let turning = if shape.turning() == 0.0 {
                    String::new()
                } else {
                    format!(", turning {}\u{b0}", short(shape.turning()))
                };
                format!("{kind} of {} at {}\u{b0}{turning}", short(shape.length()), short(shape.heading()))
            })
            .collect();
        let (found, bare) = results.fit(number);
        let share = |found: super::directed::Found| format!("{} of {}", found.successes, found.trials);
        let range = results.range(number);
        let ends = |axis: usize, unit: &str| match range {
            Some(range) => format!("{}{unit} to {}{unit}", short(range[axis].0), short(range[axis].1)),
            None => "none".to_owned(),
        };
        let wanted = expected(results.plan, number);
        vec![
            marked.name.clone(),
            wanted,
            pieces.join("; "),
            share(found),
            share(bare),
            ends(0, "\u{b0}"),
            ends(1, ""),
            short(marked.error()),
        ]
    };
    Listing {
        title: "Fits and their ranges".into(),
        about: format!(
            "The range is the largest box around the fit in whose variations at least {} of the trials do what is expected; turned by an angle, \
             stretched by a factor. `{PRIMITIVES}/NAME.toml` in the folder is a grammar that draws from it.",
            results.plan.form.vary.least
        ),
        header: ["stretch", "expected", "fit", "as fitted", "without any wall", "angle", "length", "error"]
            .map(str::to_owned)
            .to_vec(),
        rows: results.plan.marked.iter().enumerate().map(row).collect(),
    }
}

/// What a stretch is expected to do, in words.
pub(crate) fn expected(plan: &Plan, marked: usize) -> String {
    let interval = &plan.form.interval.0[marked].1;
    if interval.about.is_empty() { interval.behaviour.words() } else { interval.about.clone() }
}

/// Shares of successes by angle and factor.
fn varied(results: &Results<'_>) -> Map {
    let vary = &results.plan.form.vary;
    // cells end half-way to their neighbours
    let ends = |list: &[f64], k: usize| {
        let half = |a: f64, b: f64| (a + b) / 2.0;
        let only = |k: usize, other: usize| list.get(other).map_or(0.5, |other| (list[k] - other).abs() / 2.0);
        let low = if k > 0 { half(list[k - 1], list[k]) } else { list[k] - only(k, k + 1) };
        let high = list.get(k + 1).map_or_else(
            || list[k] + k.checked_sub(1).map_or(0.5, |before| only(k, before)),
            |next| half(list[k], *next),
        );
        (low, high)
    };
    let whole = |list: &[f64]| (ends(list, 0).0, ends(list, list.len() - 1).1);
    let panel = |(marked, own): (usize, &super::directed::Marked)| {
        let cell = |k: usize| {
            let (a, b) = (k / vary.lengths.len(), k % vary.lengths.len());
            let (x, y) = (ends(&vary.angles, a), ends(&vary.lengths, b));
            let rate = results.varied[marked][k].rate();
            MapCell { low: [x.0, y.0], high: [x.1, y.1], rate, valid: rate >= vary.least }
        };
        let (_, bare) = results.fit(marked);
        let caption = format!("{}; without any wall {}", own.name, short(bare.rate()));
        MapPanel { caption, cells: (0..vary.angles.len() * vary.lengths.len()).map(cell).collect() }
    };
    Map {
        title: "Which variations still do".into(),
        about: "The darker a cell, the more trials do what is expected; + marks those that do so often enough.".into(),
        x: Axis { label: "turned by".into(), unit: "deg".into(), range: Some(whole(&vary.angles)) },
        y: Axis { label: "stretched by".into(), unit: String::new(), range: Some(whole(&vary.lengths)) },
        areas: true,
        panels: results.plan.marked.iter().enumerate().map(panel).collect(),
    }
}

/// Unit of lengths.
pub(crate) fn unit(plan: &Plan) -> &'static str {
    if plan.construct.units == terrain::Units::Metres { "m" } else { "units" }
}

/// The construct, once for each window and heading: the middle of each window in the colour of its cluster.
fn construct(results: &Results<'_>) -> Option<Drawings> {
    let plan = results.plan;
    let mut drawings = Vec::new();
    let windows = plan.form.windows.iter().copied().map(Some);
    // stretches between peaks of curvature have widths of their own
    for window in windows.chain(plan.form.split.as_ref().map(|_| None)) {
        for heading in 0..plan.form.headings {
            let mut drawing = Drawing::default();
            put(&mut drawing, plan.construct.geometry(), Stroke::There);
            let own = results.items.iter().filter(|item| {
                let width = plan.approach(item.approach).0.width;
                let known = plan.form.windows.contains(&width);
                item.approach % plan.form.headings == heading && window.map_or(!known, |window| window == width)
            });
            let mut angle = 0.0;
            for item in own {
                let fragment;
                (fragment, angle) = plan.approach(item.approach);
                // the middles of windows lie side by side
                let half = fragment.width / if window.is_some() { 8.0 } else { 2.0 };
                let line = &plan.lines[fragment.line];
                let points = line.between(fragment.middle - half, fragment.middle + half);
                let stroke = item.cluster.map(Stroke::Series);
                drawing.strokes.extend(stroke.map(|stroke| (stroke, points.iter().map(|point| point.0).collect())));
            }
            let what =
                window.map_or("between peaks".to_owned(), |width| format!("window {} {}", short(width), unit(plan)));
            drawing.caption = format!("{what}, approached at {}\u{b0}", short(angle));
            drawings.push(drawing);
        }
    }
    let names: Vec<&str> = results.clusters.iter().map(|cluster| cluster.name.as_str()).collect();
    (!drawings.is_empty()).then(|| Drawings {
        title: "The construct and its fragments by cluster".into(),
        about: format!(
            "A stretch of line has the colour of the cluster to which the fragment in the window around it belongs when it is approached \
             at this angle to the line, counter-clockwise. Colours are those of the next figures ({}).",
            names.join(", ")
        ),
        bounds: None,
        drawings,
    })
}

fn clusters(results: &Results<'_>) -> Listing {
    let row = |cluster: &Cluster| {
        let mut row = vec![cluster.name.clone(), cluster.items.len().to_string(), effects(cluster).join(", ")];
        for k in 0..ATTRIBUTES.len() {
            let ((low, high), medoid) =
                (range(results, cluster, k), attributes(results, &results.items[cluster.medoid])[k]);
            row.push(format!("{} ({} to {})", short(medoid), short(low), short(high)));
        }
        row
    };
    let attributes = ATTRIBUTES.iter().map(|(name, unit, _)| match *unit {
        "length" => format!("{name}, {}", self::unit(results.plan)),
        unit => format!("{name}, {unit}"),
    });
    Listing {
        title: "The clusters".into(),
        about: format!(
            "What each does in comparison with an empty arena, and the primitive that it is: of each attribute the medoid's value and the \
             range. `{PRIMITIVES}/NAME.toml` in the folder is a grammar that draws it, which a design takes as its candidates."
        ),
        header: ["cluster", "approaches", "mean effects"].map(str::to_owned).into_iter().chain(attributes).collect(),
        rows: results.clusters.iter().map(row).collect(),
    }
}

/// What a group does where nothing stands.
fn empty(results: &Results<'_>) -> Listing {
    let row = |(width, control): (&f64, &Option<super::probe::Descriptor>)| {
        let number = |k: usize| control.map_or("\u{2013}".to_owned(), |numbers| short(numbers[k]));
        std::iter::once(short(*width)).chain((0..NUMBERS.len()).map(number)).collect()
    };
    Listing {
        title: "Empty arenas".into(),
        about: "What everything is compared with: the same group where nothing stands in its way, by window.".into(),
        header: std::iter::once("window")
            .chain(NUMBERS.iter().map(|number| number.0))
            .map(|name| name.replace('_', " "))
            .collect(),
        rows: results.plan.form.windows.iter().zip(&results.controls).map(row).collect(),
    }
}

fn descriptors(results: &Results<'_>) -> Means {
    let x: Vec<f64> = (0..NUMBERS.len()).map(|k| k as f64).collect();
    let line = |cluster: &Cluster| Line {
        name: cluster.name.clone(),
        x: x.clone(),
        y: cluster.standardised.iter().map(|(mean, _)| Some(*mean)).collect(),
    };
    Means {
        lines: Lines {
            id: "descriptors".into(),
            title: "What clusters do".into(),
            about: "Descriptors in comparison with an empty arena, standardised over all approaches: 0 is their mean, 1 their standard \
                    deviation."
                .into(),
            x: Axis { label: "descriptor".into(), unit: String::new(), range: None },
            y: Axis { label: "standardised value".into(), unit: String::new(), range: None },
            lines: results.clusters.iter().map(line).collect(),
        },
        spread: results
            .clusters
            .iter()
            .map(|cluster| cluster.standardised.iter().map(|(_, deviation)| Some(*deviation)).collect())
            .collect(),
        spread_name: "standard deviation over approaches".into(),
        names: NUMBERS.iter().map(|(name, ..)| (*name).replace('_', " ")).collect(),
    }
}

/// The medoids with the ways of the group in a trial.
fn medoids(results: &Results<'_>) -> Drawings {
    let plan = results.plan;
    let one = |(number, cluster): (usize, &Cluster)| {
        let item = &results.items[cluster.medoid];
        let (fragment, heading) = plan.approach(item.approach);
        let probe = plan.probe(item.approach, plan.form.offsets / 2);
        let caption = format!(
            "{}: window {} {}, approached at {}\u{b0}",
            cluster.name,
            short(fragment.width),
            unit(plan),
            short(heading)
        );
        let mut drawing = Drawing { caption, ..Drawing::default() };
        put(&mut drawing, &probe.geometry, Stroke::Series(number));
        // a trial that was possible is possible again
        if let Ok(Some((watch, _))) = once(plan, &probe, plan.seed_of(1), &|| false) {
            add_ways(&mut drawing, &watch.course());
        }
        drawing
    };
    Drawings {
        title: "The medoids".into(),
        about: "Of each cluster the approach nearest to all others in it, with the ways of the group in a trial without offset, from blue to \
                orange with time."
            .into(),
        bounds: None,
        drawings: results.clusters.iter().enumerate().map(one).collect(),
    }
}

fn silhouettes(results: &Results<'_>) -> Listing {
    Listing {
        title: "Silhouettes".into(),
        about: "How much nearer approaches are to their own cluster than to the next, by the number of clusters. The greatest was taken.".into(),
        header: ["clusters", "mean silhouette"].map(str::to_owned).to_vec(),
        rows: results.silhouettes.iter().map(|(count, value)| vec![count.to_string(), short(*value)]).collect(),
    }
}

fn methods(results: &Results<'_>) -> Vec<String> {
    let plan = results.plan;
    let models = plan.population.scenario.group.0.iter();
    let models: Vec<String> = models.map(|(_, own)| format!("{} of {}", own.count, own.model.id)).collect();
    let widths: Vec<String> = plan.form.windows.iter().map(|width| short(*width)).collect();
    let clustering = match &plan.form.cluster {
        Clustering::AverageLinkage(linkage) => {
            let (least, most) = (linkage.least, linkage.most);
            format!("Average linkage, cut at {least} to {most} clusters where the mean silhouette is greatest.")
        }
        Clustering::Dbscan(density) => {
            let noise = results.items.iter().filter(|item| item.cluster.is_none()).count();
            let (radius, least) = (density.radius, density.least);
            format!("Clusters by density, of what has {least} within {radius}; {noise} approaches are noise.")
        }
    };
    let effect = &plan.form.effect;
    let numbers: Vec<String> = NUMBERS.iter().map(|(name, _, about)| format!("`{name}`: {about}")).collect();
    let mut words = Vec::new();
    if !plan.fragments.is_empty() {
        words.extend([
        format!(
            "A window of {} {} slides along the lines of the construct, a quarter of its width at a time; what of the construct lies inside \
             is a fragment. Each stands alone in an arena and is approached by {} ({} steps at most), with offsets over {} of the window: {}, \
             in all {} trials with those in empty arenas.",
            widths.join(" and "),
            unit(plan),
            models.join(" and "),
            plan.population.steps,
            plan.form.span,
            plan.cost(),
            plan.all_trials()
        ),
        "What is put into clusters is an approach, a fragment at a heading: over all headings a fragment that is its own mirror image turns \
         nobody on average, whatever it does."
            .to_owned(),
        format!("Descriptors. {}", numbers.join(" ")),
        format!(
            "Each descriptor is compared with that of the empty arena (transit as a ratio, the others as differences), and standardised. \
             {clustering} A cluster has the name of the effect of its \
             mean that exceeds its least size most often: a turn of {}\u{b0}, {} of the spread narrower across, {} groups more, {} leaving \
             back; else `none`.",
            effect.turn, effect.narrowing, effect.splitting, effect.back
        ),
        ]);
        if let Some(split) = &plan.form.split {
            words.push(format!(
                "Lines are also split where they turn by {}\u{b0} or more within {} {}; the stretches between are fragments too.",
                split.corner,
                split.over,
                unit(plan)
            ));
        }
        if plan.fragments.len() < plan.possible {
            words.push(format!(
                "The budget of {} trials allows {} of {} fragments, which are spread evenly; the others were not tried.",
                plan.form.budget.unwrap_or(0),
                plan.fragments.len(),
                plan.possible
            ));
        }
    }
    if !plan.marked.is_empty() {
        let vary = &plan.form.vary;
        words.push(format!(
            "A marked stretch is fitted by least squares: by a segment, where that is off by more than {} in the root mean square by an arc, else \
             it is split where it is farthest from its chord. The fit stands in the workspace `{}` without the rest of the construct, turned by \
             {} angles and stretched by {} factors about its first end, {} trials each by {}, and as many without any wall.",
            vary.tolerance,
            plan.workspace.workspace.name,
            vary.angles.len(),
            vary.lengths.len(),
            plan.varied_trials(),
            models.join(" and ")
        ));
    }
    words.push(format!(
        "Statements are expressions over {}.",
        NAMES.iter().map(|(name, about)| format!("`{name}` ({about})")).collect::<Vec<_>>().join(", ")
    ));
    words
}

fn csv(results: &Results<'_>) -> Table {
    let names = |list: &mut dyn Iterator<Item = &'static str>| list.collect::<Vec<_>>().join(",");
    let mut csv = format!(
        "line,middle,{},{},effect,cluster\n",
        names(&mut ATTRIBUTES.iter().map(|attribute| attribute.0)),
        names(&mut NUMBERS.iter().map(|number| number.0))
    );
    for item in &results.items {
        let (fragment, _) = results.plan.approach(item.approach);
        let values: Vec<String> =
            attributes(results, item).iter().chain(&item.descriptor).map(ToString::to_string).collect();
        let cluster = results.cluster_of(item);
        csv += &format!(
            "{},{},{},{},{cluster}\n",
            fragment.line + 1,
            fragment.middle,
            values.join(","),
            item.effect.word()
        );
    }
    Table { file: "approaches.csv".into(), about: "Every approach: attributes, what was found, cluster.".into(), csv }
}
