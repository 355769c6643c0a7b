//! The page as one HTML document: the template, filled.

use super::number::{bytes, quantity};
use super::palette::{self, SERIES};
use super::{
    Border, Figure, Lines, Means, Page, Replay, Scenes, Stage, Table, chart, drawing, escape, map, replay, scene,
};
use core::fmt::Write;
use minijinja::{Environment, Value, context};
use serde_json::json;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The page as one HTML file. It needs nothing but itself: no network, no other file, and no JavaScript for the charts,
/// the scenes and the words.
pub fn html(page: &Page) -> String {
    let mut number = 0;
    let mut counted = |figures: &mut Vec<Value>, figure: &dyn Fn(usize) -> Value| {
        number += 1;
        figures.push(figure(number));
    };
    let (mut replays, mut charts, mut scenes) = (Vec::new(), Vec::new(), Vec::new());
    let (mut replay_data, mut chart_data, mut part_data) = (Vec::new(), Vec::new(), Vec::new());
    // the figures are numbered in the order in which the page shows them
    for recording in
        page.figures.iter().filter_map(|figure| if let Figure::Replay(it) = figure { Some(it) } else { None })
    {
        counted(&mut replays, &|number| replay_figure(recording, number));
        replay_data.push(replay::data(recording));
    }
    fn drawn(figure: &Figure) -> Option<(&Lines, Option<&Means>)> {
        match figure {
            Figure::Lines(lines) => Some((lines, None)),
            Figure::Means(means) => Some((&means.lines, Some(means))),
            _ => None,
        }
    }
    for (lines, means) in page.figures.iter().filter_map(drawn) {
        let id = escape::file_name(&lines.id, &format!("chart-{}", chart_data.len() + 1));
        let chart = means.map_or_else(|| chart::chart(lines, &id), |means| chart::means(means, &id));
        counted(&mut charts, &|number| chart_figure(lines, &chart.svg, number));
        chart_data.push(chart.data);
    }
    for moments in
        page.figures.iter().filter_map(|figure| if let Figure::Scenes(it) = figure { Some(it) } else { None })
    {
        let first = part_data.len();
        part_data.extend(moments.moments.iter().map(|moment| scene::data(moments, moment)));
        counted(&mut scenes, &|number| scenes_figure(moments, number, first));
    }
    let mut drawings = Vec::new();
    for figure in &page.figures {
        let (title, about, wide, parts): (_, _, _, Vec<(&String, String, String)>) = match figure {
            Figure::Drawings(it) => {
                let parts = it.drawings.iter();
                let parts = parts.map(|part| (&part.caption, drawing::drawing(it, part), drawing::data(part)));
                (&it.title, &it.about, false, parts.collect())
            }
            Figure::Map(it) => {
                let parts = it.panels.iter();
                let parts = parts.map(|part| (&part.caption, map::panel(it, part), map::data(it, part)));
                (&it.title, &it.about, true, parts.collect())
            }
            _ => continue,
        };
        let mut part = |(caption, svg, data): (&String, String, String)| {
            part_data.push(data);
            context! { caption, svg => safe(svg), data => part_data.len() - 1 }
        };
        let parts: Vec<Value> = parts.into_iter().map(&mut part).collect();
        counted(&mut drawings, &|number| {
            let file = escape::file_name(&title.to_lowercase(), &format!("drawings-{number}"));
            context! { number, title, about, wide, file, parts => &parts }
        });
    }
    let listings: Vec<Value> = page
        .figures
        .iter()
        .filter_map(|figure| if let Figure::Listing(it) = figure { Some(it) } else { None })
        .map(|it| context! { title => &it.title, about => &it.about, header => &it.header, rows => &it.rows })
        .collect();
    let data = escape::data(&json!({
        "charts": chart_data,
        "replays": replay_data,
        "parts": part_data,
        "tables": page.tables.iter().enumerate().map(|(index, table)| json!({
            "file": table_file(table, index),
            "csv": table.csv,
        })).collect::<Vec<_>>(),
    }));
    let words = [&page.title, &page.command, &page.source, &page.made_by, &data].into_iter();
    let facts = page.summary.iter().flat_map(|fact| [&fact.label, &fact.value]);
    let nonce = nonce(words.chain(&page.lead).chain(&page.methods).chain(facts));
    let summary: Vec<Value> =
        page.summary.iter().map(|fact| context! { label => &fact.label, value => &fact.value }).collect();
    let tables: Vec<Value> =
        page.tables.iter().enumerate().map(|(index, table)| described_table(table, index)).collect();
    let mut environment = Environment::new();
    environment.add_filter("words", |text: String| safe(escape::words(&text)));
    let filled = environment.render_named_str(
        "page.html",
        TEMPLATE,
        context! {
            title => if page.title.trim().is_empty() { "Untitled" } else { &page.title },
            lead => &page.lead,
            summary,
            replays,
            charts,
            listings,
            scenes,
            drawings,
            methods => &page.methods,
            tables,
            command => &page.command,
            source => &page.source,
            made_by => &page.made_by,
            nonce,
            style => safe(format!("{}{}{STYLE}", palette::style(), series_style())),
            script => safe(SCRIPT.to_owned()),
            data => safe(data),
        },
    );
    // the template is a constant, and a test renders it; a page with the reason is better than none
    filled.unwrap_or_else(|fault| {
        format!("<!doctype html><title>no page</title><p>{}", escape::markup(&fault.to_string()))
    })
}

/// Markup that is not to be escaped again.
fn safe(markup: String) -> Value {
    Value::from_safe_string(markup)
}

/// Classes that give the series their colours.
fn series_style() -> String {
    let mut style = String::new();
    for index in 0..SERIES {
        // writing to a string cannot fail
        let _ = write!(style, ".s{index}{{--series:var(--series-{index})}}");
    }
    style
}

fn replay_figure(replay: &Replay, number: usize) -> Value {
    let mut members = vec![0usize; replay.stage.groups.len()];
    for &group in &replay.group {
        if let Some(count) = members.get_mut(group) {
            *count += 1;
        }
    }
    context! {
        number,
        title => &replay.title,
        about => &replay.about,
        groups => groups(&replay.stage, |group| members.get(group).copied().unwrap_or(0)),
        obstacles => replay.obstacles.iter().any(|frame| !frame.is_empty()),
        food => false,
        space => replay::axes(&replay.stage) == 3,
        open => replay.stage.edges[..replay::axes(&replay.stage)].contains(&Border::Open),
        frames => replay.times.len().min(replay.position.len()),
    }
}

fn chart_figure(lines: &Lines, svg: &str, number: usize) -> Value {
    context! {
        number,
        title => &lines.title,
        about => &lines.about,
        svg => safe(svg.to_owned()),
    }
}

fn scenes_figure(scenes: &Scenes, number: usize, first: usize) -> Value {
    let moments: Vec<Value> = scenes
        .moments
        .iter()
        .enumerate()
        .map(|(k, moment)| {
            context! {
                time => quantity(moment.time, &scenes.time_unit),
                svg => safe(scene::scene(scenes, moment)),
                data => first + k,
            }
        })
        .collect();
    let most = |group: usize| {
        let count = |moment: &super::Moment| moment.agents.iter().filter(|agent| agent.group == group).count();
        scenes.moments.iter().map(count).max().unwrap_or(0)
    };
    context! {
        number,
        title => &scenes.title,
        about => &scenes.about,
        groups => groups(&scenes.stage, most),
        obstacles => scenes.moments.iter().any(|moment| !moment.obstacles.is_empty()),
        food => scenes.moments.iter().any(|moment| !moment.items.is_empty()),
        file => escape::file_name(&scenes.title.to_lowercase(), &format!("scenes-{number}")),
        space => replay::axes(&scenes.stage) == 3,
        moments,
    }
}

/// Names of the groups with their colours and the number of their members.
fn groups(stage: &Stage, members: impl Fn(usize) -> usize) -> Vec<Value> {
    let named = stage.groups.iter().enumerate();
    named.map(|(group, name)| context! { name, series => group % SERIES, members => members(group) }).collect()
}

fn table_file(table: &Table, index: usize) -> String {
    escape::file_name(&table.file, &format!("table-{}.csv", index + 1))
}

fn described_table(table: &Table, index: usize) -> Value {
    let rows = table.csv.lines().filter(|line| !line.is_empty()).count().saturating_sub(1);
    context! {
        file => table_file(table, index),
        about => &table.about,
        rows,
        size => bytes(table.csv.len()),
    }
}

/// A word that only this page's own scripts and styles carry. It follows from the words and the data of the page, so
/// that none of them can name it.
fn nonce<'a>(texts: impl Iterator<Item = &'a String>) -> String {
    let mut hashes = [0xcbf2_9ce4_8422_2325_u64, 0x9e37_79b9_7f4a_7c15];
    for byte in texts.flat_map(|text| text.bytes().chain([0])) {
        hashes = hashes.map(|hash| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    }
    format!("{:016x}{:016x}", hashes[0], hashes[1])
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic, reason = "tests")]
mod tests {
    use super::super::{Axis, Fact, Line, Listing, Moment, Outline, Seen};
    use super::*;

    /// A text that gets out of wherever it is not escaped.
    const HOSTILE: &str = "</script></style></title><img src=x onerror=alert(1)>\"'&{{ nonce }}<!--";

    fn stage(dimensions: usize) -> Stage {
        Stage {
            dimensions,
            low: [0.0; 3],
            high: [10.0; 3],
            edges: [Border::Seam; 3],
            unit: HOSTILE.into(),
            groups: vec![HOSTILE.into()],
            radius: vec![0.2],
        }
    }

    fn figures() -> Vec<Figure> {
        let axis = || Axis { label: HOSTILE.into(), unit: HOSTILE.into(), range: None };
        let means = Means {
            lines: Lines {
                id: HOSTILE.into(),
                title: HOSTILE.into(),
                about: HOSTILE.into(),
                x: axis(),
                y: axis(),
                lines: vec![Line { name: HOSTILE.into(), x: vec![0.0, 1.0], y: vec![Some(1.0), None] }],
            },
            spread: vec![vec![Some(0.1), None]],
            spread_name: HOSTILE.into(),
            names: vec![HOSTILE.into(), HOSTILE.into()],
        };
        let listing = Listing {
            title: HOSTILE.into(),
            about: HOSTILE.into(),
            header: vec![HOSTILE.into()],
            rows: vec![vec![HOSTILE.into()]],
        };
        let line = Line { name: HOSTILE.into(), x: vec![0.0, 1.0], y: vec![Some(1.0), None] };
        let agent = Seen { group: 0, position: [1.0; 3], heading: [1.0, 0.0, 0.0], trail: vec![[0.5; 3]] };
        let wall = Outline::Cuboid { low: [1.0; 3], high: [2.0; 3] };
        let moment = Moment { time: 1.0, agents: vec![agent], items: vec![[3.0; 3]], obstacles: vec![wall.clone()] };
        vec![
            Figure::Scenes(Scenes {
                title: HOSTILE.into(),
                about: HOSTILE.into(),
                stage: stage(3),
                time_unit: HOSTILE.into(),
                moments: vec![moment],
            }),
            Figure::Lines(Lines {
                id: HOSTILE.into(),
                title: HOSTILE.into(),
                about: HOSTILE.into(),
                x: axis(),
                y: axis(),
                lines: vec![line.clone(), line],
            }),
            Figure::Replay(Replay {
                title: HOSTILE.into(),
                about: HOSTILE.into(),
                stage: stage(2),
                time_unit: HOSTILE.into(),
                times: vec![0.0],
                group: vec![0],
                position: vec![vec![[1.0; 3]]],
                heading: vec![vec![[1.0, 0.0, 0.0]]],
                obstacles: vec![vec![wall]],
            }),
            Figure::Means(means),
            Figure::Listing(listing),
        ]
    }

    fn hostile() -> Page {
        Page {
            title: HOSTILE.into(),
            lead: vec![HOSTILE.into()],
            methods: vec![HOSTILE.into()],
            summary: vec![Fact { label: HOSTILE.into(), value: HOSTILE.into() }],
            figures: figures(),
            tables: vec![Table { file: HOSTILE.into(), about: HOSTILE.into(), csv: format!("a\n\"{HOSTILE}\"\n") }],
            command: HOSTILE.into(),
            source: HOSTILE.into(),
            made_by: HOSTILE.into(),
        }
    }

    #[test]
    fn texts_of_the_user_stay_texts() {
        let page = html(&hostile());
        assert!(page.starts_with("<!doctype html>"), "{page}");
        assert!(!page.contains("<img"));
        assert_eq!(page.matches("<script").count(), 3);
        assert_eq!(page.matches("</script>").count(), 3);
        assert_eq!(
            page.matches("</title><").count() + page.matches("</title>\n").count(),
            page.matches("<title>").count()
        );
        assert!(page.contains("{{ nonce }}"), "a text is not a template");
    }

    #[test]
    fn the_data_is_json() {
        let page = html(&hostile());
        let (_, after) = page.split_once("id=\"figures\">").unwrap();
        let (data, _) = after.split_once("</script>").unwrap();
        let data: serde_json::Value = serde_json::from_str(data).unwrap();
        assert_eq!(data["charts"][0]["lines"][0]["name"], HOSTILE);
        assert_eq!(data["tables"][0]["csv"], format!("a\n\"{HOSTILE}\"\n"));
    }

    #[test]
    fn nothing_is_fetched_from_anywhere() {
        for page in [html(&hostile()), html(&Page::default())] {
            let page = page.replace("http://www.w3.org/2000/svg", "");
            for bad in ["http:", "https:", "url(", "@import", "src=\"", "fetch(", "XMLHttpRequest"] {
                assert!(!page.contains(bad), "{bad}");
            }
            assert!(page.contains("default-src 'none'"));
            assert!(!page.contains("unsafe"));
        }
    }

    #[test]
    fn the_parts_stand_in_their_order() {
        let page = html(&hostile());
        let ids = [
            "<h1>",
            "class=\"lead\"",
            "id=\"summary\"",
            "id=\"replay\"",
            "id=\"measures\"",
            "id=\"listings\"",
            "id=\"scenes\"",
            "id=\"methods\"",
            "id=\"data\"",
            "id=\"command\"",
            "id=\"source\"",
            "<footer>",
        ];
        let places: Vec<usize> =
            ids.iter().map(|id| page.find(id).unwrap_or_else(|| panic!("{id} is missing"))).collect();
        assert!(places.is_sorted(), "{places:?}");
        for number in 1..=4 {
            assert_eq!(page.matches(&format!("id=\"figure-{number}\"")).count(), 1);
        }
    }

    #[test]
    fn an_empty_page_is_a_page() {
        let page = html(&Page::default());
        assert!(page.contains("<h1>Untitled</h1>") && page.trim_end().ends_with("</html>"));
        for part in ["<h2", "<figure", "<footer", "<table"] {
            assert!(!page.split("<script").next().unwrap().contains(part), "{part}");
        }
    }

    #[test]
    fn what_a_page_weighs_by_itself() {
        let size = html(&Page::default()).len();
        assert!(size < 64_000, "{size} bytes");
    }

    #[test]
    fn the_same_page_gives_the_same_bytes_and_another_one_another_nonce() {
        assert_eq!(html(&hostile()), html(&hostile()));
        let of = |texts: [&str; 2]| nonce(texts.map(str::to_owned).iter());
        assert_ne!(of(["a", "b"]), of(["ab", ""]));
    }
}
