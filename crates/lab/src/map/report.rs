//! The page of a map: its panels, what was measured, what was published.

use super::measures::Found;
use super::plan::Plan;
use crate::environment::claims;
use crate::report::of_run::paragraphs;
use crate::report::{Axis, Fact, Figure, Line, Lines, Listing, Map, MapCell, MapPanel, Page, Table, short};

/// What came of it, in lines for a terminal.
pub fn lines(found: &Found<'_>) -> Vec<String> {
    let panels = panels(found).rows.into_iter().map(|row| {
        format!(
            "{}: {} evaluations, {} of {} cells valid, density {}, {} regions; without a construct {}",
            row[0], row[1], row[2], row[3], row[4], row[5], row[7]
        )
    });
    let judged = claims::rows(&found.plan.form.claim, found, found.plan.form.seed);
    panels.chain(judged.into_iter().map(|row| claims::line(&row))).collect()
}

/// The page.
pub fn page(found: &Found<'_>, program: &str) -> Page {
    let plan = found.plan;
    let mut figures = Vec::new();
    match plan.axes.as_slice() {
        [_] => figures.push(Figure::Lines(line(found))),
        [_, _, ..] => figures.push(Figure::Map(map(found))),
        [] => {}
    }
    figures.push(Figure::Listing(panels(found)));
    if !plan.form.measure.0.is_empty() {
        figures.push(Figure::Listing(measures(found)));
    }
    if !plan.form.claim.is_empty() {
        figures.push(Figure::Listing(Listing {
            title: "Beside what was published".into(),
            about: "Verdicts are of this map as it is. The results are a reconstruction with the parameters of this file; equality \
                    with the source is not claimed."
                .into(),
            header: claims::header(),
            rows: claims::rows(&plan.form.claim, found, plan.form.seed),
        }));
    }
    Page {
        title: plan.form.title.clone(),
        lead: paragraphs(&plan.form.about),
        methods: methods(plan),
        summary: summary(found),
        figures,
        tables: vec![csv(found)],
        command: format!("flockworks run {}", plan.sources.name(0)),
        source: plan.sources.text(0).to_owned(),
        made_by: format!("{program}, seed {}", plan.form.seed),
    }
}

fn axis(found: &Found<'_>, k: usize) -> Axis {
    let axis = &found.plan.axes[k];
    let unit = match (axis.unit.as_str(), found.plan.workspace.workspace.units) {
        ("length", terrain::Units::Metres) => "m",
        ("length", terrain::Units::Field) => "unit",
        (unit, _) => unit,
    };
    Axis { label: axis.name.clone(), unit: unit.to_owned(), range: Some((axis.axis.low, axis.axis.high)) }
}

fn map(found: &Found<'_>) -> Map {
    let panel = |(k, panel): (usize, &super::measures::PanelMap)| {
        let population = &found.plan.panels[k].population;
        let cell = |(leaf, result): (&search::refine::Leaf, super::measures::CellResult)| {
            let (low, high) = panel.map.bounds(&leaf.cell);
            MapCell { low: [low[0], low[1]], high: [high[0], high[1]], rate: result.rate(), valid: leaf.found.valid }
        };
        let about = if population.about.is_empty() { String::new() } else { format!(": {}", population.about) };
        let control = panel.control.successes as f64 / panel.control.trials as f64;
        let control =
            if control.is_finite() { format!("; without a construct {}", short(control)) } else { String::new() };
        MapPanel { caption: format!("{}{about}{control}", population.name), cells: panel.leaves().map(cell).collect() }
    };
    let plan = found.plan;
    let more = if plan.axes.len() > 2 { " Further axes lie over each other." } else { "" };
    let drawn = if plan.form.areas { "The darker a cell, the more trials succeeded; + marks" } else { "+ marks" };
    Map {
        title: format!("Where {} makes the group do what is wanted", plan.schema.card().id),
        about: format!("{drawn} valid cells{}.{more}", if plan.form.areas { "" } else { ", a dot others" }),
        x: axis(found, 0),
        y: axis(found, 1),
        areas: plan.form.areas,
        panels: found.panels.iter().enumerate().map(panel).collect(),
    }
}

/// A map over one axis.
fn line(found: &Found<'_>) -> Lines {
    let line = |(k, panel): (usize, &super::measures::PanelMap)| {
        let mut points: Vec<(f64, f64)> =
            panel.leaves().map(|(leaf, result)| (panel.map.centre(&leaf.cell)[0], result.rate())).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (x, y): (Vec<f64>, Vec<Option<f64>>) = points.into_iter().map(|(x, y)| (x, Some(y))).unzip();
        Line { name: found.plan.panels[k].population.name.clone(), x, y }
    };
    Lines {
        id: "map".into(),
        title: "Share of successes".into(),
        about: "At the centres of the cells.".into(),
        x: axis(found, 0),
        y: Axis { label: "share of successes".into(), unit: String::new(), range: Some((0.0, 1.0)) },
        lines: found.panels.iter().enumerate().map(line).collect(),
    }
}

fn panels(found: &Found<'_>) -> Listing {
    let row = |(k, panel): (usize, &super::measures::PanelMap)| {
        let region = panel.map.region();
        let (valid, all) = region.valid_volume();
        let cells = panel.leaves().count();
        let valid_cells = panel.leaves().filter(|(leaf, _)| leaf.found.valid).count();
        let control = panel.control.successes as f64 / panel.control.trials as f64;
        vec![
            found.plan.panels[k].population.name.clone(),
            panel.map.evaluations().iter().sum::<usize>().to_string(),
            valid_cells.to_string(),
            cells.to_string(),
            short(valid as f64 / all as f64),
            region.components().len().to_string(),
            format!("{:.1} %", region.saved() * 100.0),
            if control.is_finite() { short(control) } else { "not made".into() },
        ]
    };
    Listing {
        title: "The panels".into(),
        about: "Density is the valid part of the box, and the chance that a point drawn uniformly is valid. Regions hang together \
                by faces. Saved: evaluations that a full grid of the finest cells would have needed in addition."
            .into(),
        header: ["panel", "evaluations", "valid cells", "cells", "density", "regions", "saved", "without a construct"]
            .map(str::to_owned)
            .to_vec(),
        rows: found.panels.iter().enumerate().map(row).collect(),
    }
}

fn measures(found: &Found<'_>) -> Listing {
    let row = |(name, form): &(String, super::form::MeasureForm)| {
        let mut of = form.of.word().replace('_', " ");
        for (axis, factor) in &form.along.0 {
            of += &format!(" {} {axis}", short(*factor));
        }
        let ends = |(axis, ends): &(String, Vec<f64>)| format!("{axis} {} to {}", ends[0], ends[1]);
        let inside: Vec<String> = form.inside.0.iter().map(ends).collect();
        let side = if form.outside { "outside " } else { "" };
        let place = if inside.is_empty() { "everywhere".to_owned() } else { format!("{side}{}", inside.join(", ")) };
        let panel = form.panel.clone().unwrap_or_else(|| found.plan.panels[0].population.name.clone());
        vec![name.clone(), panel, of, place, short(found.measure(form))]
    };
    Listing {
        title: "What was measured".into(),
        about: String::new(),
        header: ["measure", "panel", "of", "where", "value"].map(str::to_owned).to_vec(),
        rows: found.plan.form.measure.0.iter().map(row).collect(),
    }
}

fn summary(found: &Found<'_>) -> Vec<Fact> {
    let fact = |label: &str, value: String| Fact { label: label.into(), value };
    let evaluations: usize = found.panels.iter().flat_map(|panel| panel.map.evaluations()).sum();
    let trials: u64 = found.panels.iter().flat_map(|panel| &panel.results).map(|result| result.trials).sum();
    vec![
        fact("Panels", found.panels.len().to_string()),
        fact("Axes", found.plan.axes.len().to_string()),
        fact("Evaluations", evaluations.to_string()),
        fact("Trials", trials.to_string()),
    ]
}

fn methods(plan: &Plan) -> Vec<String> {
    let axes: Vec<String> = plan
        .axes
        .iter()
        .map(|axis| format!("{} from {} to {} ({} cells)", axis.name, axis.axis.low, axis.axis.high, axis.cells))
        .collect();
    let groups: Vec<String> = plan
        .panels
        .iter()
        .map(|panel| {
            let models = panel.population.scenario.group.0.iter();
            let models: Vec<String> = models.map(|(_, own)| format!("{} of {}", own.count, own.model.id)).collect();
            format!("{}: {}, {} steps", panel.population.name, models.join(" and "), panel.population.steps)
        })
        .collect();
    let stopping = match &plan.form.sequential {
        None => format!("{} trials", plan.trials),
        Some(test) => format!(
            "trials until Wald's test of {} against {} decides, at most {}",
            test.lower, test.higher, plan.trials
        ),
    };
    vec![
        format!(
            "The schema `{}` in the workspace `{}`, over {}. Groups: {}.",
            plan.schema.card().id,
            plan.workspace.workspace.name,
            axes.join(", "),
            groups.join("; ")
        ),
        format!(
            "What is wanted: {}. Each cell is judged at its centre by {} construct{} and {stopping}; {} iterations by the rule `{}`.",
            plan.form.behaviour.words(),
            plan.form.constructs,
            if plan.form.constructs == 1 { "" } else { "s" },
            plan.refinement.iterations,
            plan.form.refine.rule.word()
        ),
        "Nothing here equals the source's experiment: its parameters, starts and dimensions are not printed. The results are a \
         reconstruction with the parameters of the file below."
            .to_owned(),
    ]
}

fn csv(found: &Found<'_>) -> Table {
    let names: Vec<&str> = found.plan.axes.iter().map(|axis| axis.name.as_str()).collect();
    let mut csv = format!("panel,{},rate,trials,valid,generation\n", names.join(","));
    for (k, panel) in found.panels.iter().enumerate() {
        for (leaf, result) in panel.leaves() {
            let centre: Vec<String> = panel.map.centre(&leaf.cell).iter().map(ToString::to_string).collect();
            csv += &format!(
                "{},{},{},{},{},{}\n",
                found.plan.panels[k].population.name,
                centre.join(","),
                result.rate(),
                result.trials,
                u8::from(leaf.found.valid),
                leaf.cell.generation
            );
        }
    }
    Table { file: "leaves.csv".into(), about: "The leaves: their centres and what was found there.".into(), csv }
}
