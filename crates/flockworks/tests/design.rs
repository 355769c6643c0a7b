//! Designs, maps and optimisations through the program itself: templates, threads, stopping and going on, exported environments, mistakes.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("flockworks-design-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn flockworks(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flockworks")).current_dir(folder).args(arguments).output().unwrap()
}

fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = flockworks(folder, arguments);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{arguments:?}: {text}{}", String::from_utf8_lossy(&output.stderr));
    text
}

/// What a file with a mistake is told; the exit code must be that of wrong input.
fn wrong(folder: &Path, text: &str) -> String {
    std::fs::write(folder.join("wrong.toml"), text).unwrap();
    let output = flockworks(folder, &["check", "wrong.toml"]);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stdout));
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn files(folder: &Path, names: &[&str]) -> Vec<Vec<u8>> {
    names.iter().map(|name| std::fs::read(folder.join(name)).unwrap()).collect()
}

/// Cuts off the last part of a log, as a stop does.
fn torn(from: &Path, to: &Path, log: &str) {
    std::fs::create_dir_all(to).unwrap();
    std::fs::copy(from.join("manifest.json"), to.join("manifest.json")).unwrap();
    let bytes = std::fs::read(from.join(log)).unwrap();
    std::fs::write(to.join(log), &bytes[..bytes.len() * 3 / 5]).unwrap();
}

const DESIGN: [&str; 6] =
    ["candidates.parquet", "results.parquet", "trials.parquet", "rates.parquet", "robustness.parquet", "report.html"];

#[test]
fn a_design_is_the_same_for_any_threads_and_stops() {
    let folder = folder("design");
    std::fs::write(folder.join("split.toml"), done(&folder, &["new", "design"])).unwrap();
    assert!(done(&folder, &["check", "split.toml"]).contains("grammar splitting"));
    done(&folder, &["run", "split.toml", "--quick", "--threads", "1", "--out", "one"]);
    done(&folder, &["run", "split.toml", "--quick", "--threads", "3", "--out", "three"]);
    let one = files(&folder.join("one"), &DESIGN);
    assert!(one == files(&folder.join("three"), &DESIGN), "threads change nothing");
    torn(&folder.join("one"), &folder.join("torn"), "candidates.log");
    done(&folder, &["run", "split.toml", "--quick", "--out", "torn"]);
    assert!(one == files(&folder.join("torn"), &DESIGN), "a stop changes nothing");
    let again = done(&folder, &["run", "split.toml", "--quick", "--out", "one"]);
    assert!(again.contains("0 candidates in"), "what is there is not done again: {again}");
    done(&folder, &["report", "one"]);
    assert!(one == files(&folder.join("one"), &DESIGN));
    // more candidates may be added, another seed is another design
    done(&folder, &["run", "split.toml", "--quick", "--out", "one", "--set", "quick_attempts=12"]);
    let other = flockworks(&folder, &["run", "split.toml", "--quick", "--out", "one", "--seed", "9"]);
    assert_eq!(other.status.code(), Some(2));
    // environments are files that run
    let mut endings: Vec<String> = Vec::new();
    for entry in std::fs::read_dir(folder.join("one/environments")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        endings.push(name.rsplit('.').next().unwrap().to_owned());
        if name.ends_with(".toml") {
            done(&folder, &["run", &format!("one/environments/{name}"), "--quick", "--out", &format!("run-{name}")]);
        }
    }
    for ending in ["svg", "geojson", "toml"] {
        assert!(endings.iter().any(|own| own == ending), "{endings:?}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// Two groups that walk up, one of them slowly; a wall far away, and one that nobody passes. Where nothing is in the way the
/// outcome is that of the group for certain, behind the wall it is always the same.
const INVERSE: &str = r#"
kind = "design"
title = "Who walks here"
trials = 10
control = false
candidates.primitives = { count = 1, kind.wall = { x = [-200], y = [-300, 10], angle = [0], length = [400] } }
[behaviour.far]
score.binary = { when = "centroid_y >= 20", within = 40 }
[scenario]
time.duration = 60
[scenario.space]
dimensions = 2
edges = "open"
[scenario.group.walkers]
count = 3
model.control_random = { noise_deviation = 0 }
start = { place.box = { low = [-5, -5], high = [5, 0] }, heading.along = [0, 1] }
[population.swift]
[population.slow]
set."group.walkers.model.control_random.step_length" = 0.1
[inverse]
identifications = 4
most = 6
[[inverse.claim]]
id = "chosen"
text = "The open place tells more than the average one"
number = "needed[by = average] - needed[by = chosen]"
holds = "needed[by = chosen] < needed[by = average] and needed[by = greedy] = 1 and right[by = chosen] = 1"
"#;

const IDENTIFIED: [&str; 6] = [
    "outcomes.parquet",
    "information.parquet",
    "identifications.parquet",
    "courses.parquet",
    "trials.parquet",
    "report.html",
];

#[test]
fn an_unknown_group_is_named_where_environments_tell_groups_apart() {
    let folder = folder("inverse");
    std::fs::write(folder.join("who.toml"), INVERSE).unwrap();
    let told = done(&folder, &["run", "who.toml", "--threads", "1", "--out", "one"]);
    // 10 of 10 against 0 of 10: one whole bit, and one trial gives odds of 10.5 to 0.5, which is above 0.95
    assert!(told.contains("a trial in environment 0 tells most: 1.000 (1.000 to 1.000) bits"), "{told}");
    assert!(told.contains("chosen: 1 (1 to 1) trials, 100.0 % named, 100.0 % of them rightly"), "{told}");
    // behind the wall nobody is ever named, and all six trials are made
    assert!(told.contains("average: 3.5 (3.5 to 3.5) trials, 50.0 % named, 100.0 % of them rightly"), "{told}");
    assert!(told.contains("chosen: holds [2.5 (2.5 to 2.5)]"), "{told}");
    let one = files(&folder.join("one"), &IDENTIFIED);
    done(&folder, &["run", "who.toml", "--threads", "3", "--out", "three"]);
    assert!(one == files(&folder.join("three"), &IDENTIFIED), "threads change nothing");
    torn(&folder.join("one"), &folder.join("torn"), "candidates.log");
    done(&folder, &["run", "who.toml", "--out", "torn"]);
    assert!(one == files(&folder.join("torn"), &IDENTIFIED), "a stop changes nothing");
    done(&folder, &["report", "one"]);
    assert!(one == files(&folder.join("one"), &IDENTIFIED));
    // what was seen is kept: a lower threshold needs no new trials, a higher one some, and both are as if asked at once
    let again = |out: &str, set: &str| done(&folder, &["run", "who.toml", "--out", out, "--set", set]);
    again("one", "inverse.threshold=0.99");
    again("whole", "inverse.threshold=0.99");
    assert!(files(&folder.join("one"), &IDENTIFIED[..5]) == files(&folder.join("whole"), &IDENTIFIED[..5]));
    let log = |out: &str| std::fs::metadata(folder.join(out).join("candidates.log")).unwrap().len();
    let before = log("one");
    again("one", "inverse.threshold=0.95");
    assert!(one[..5] == files(&folder.join("one"), &IDENTIFIED[..5]));
    assert_eq!(log("one"), before);
    // with the certain prior the group is known before anything is seen
    let known = again("known", "inverse.prior={swift = 99, slow = 1}");
    assert!(known.contains("chosen: 0 (0 to 0) trials, 100.0 % named, 50.0 % of them rightly"), "{known}");
    // outcomes may be parts of a graded fitness
    let graded = "[behaviour.height]\nscore.ramp = { signal = \"centroid_y\", worst = 0, best = 40 }\n[scenario]";
    let parted = INVERSE.replacen("[scenario]", graded, 1).replacen(
        "[inverse]",
        "[inverse]\noutcome = { far = [1], height = [0.2, 0.8] }",
        1,
    );
    std::fs::write(folder.join("parted.toml"), parted).unwrap();
    done(&folder, &["run", "parted.toml", "--out", "parted"]);
    done(&folder, &["export", "parted", "--to", "csv"]);
    let table = std::fs::read_to_string(folder.join("parted/outcomes.csv")).unwrap();
    for row in [
        "0,swift,\"far, height from 0.8\",10,10,1,",
        "0,slow,\"not far, height below 0.2\",10,10,1,",
        "0,slow,\"far, height 0.2 to 0.8\",0,10,0,",
    ] {
        assert!(table.contains(row), "{table}");
    }
    // groups that are alike do alike in the same trials: nothing is told, and nobody is named
    std::fs::write(folder.join("twins.toml"), INVERSE.replace("step_length\" = 0.1", "step_length\" = 1")).unwrap();
    let twins = done(&folder, &["run", "twins.toml", "--out", "twins"]);
    assert!(twins.contains("tells most: 0.000 (0.000 to 0.000) bits"), "{twins}");
    for way in ["chosen", "average", "greedy", "drawn"] {
        assert!(twins.contains(&format!("{way}: 6 (6 to 6) trials, 0.0 % named, \u{2013} of them rightly")), "{twins}");
    }
    assert!(twins.contains("chosen: does not hold"), "{twins}");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_map_is_the_same_for_any_threads_and_stops() {
    let folder = folder("map");
    let text = done(&folder, &["new", "map"]);
    // fewer cells: a test
    std::fs::write(
        folder.join("wall.toml"),
        text.replace("cells = 5", "cells = 3").replace("trials = 40", "trials = 4"),
    )
    .unwrap();
    assert!(done(&folder, &["check", "wall.toml"]).contains("dirt over angle, length"));
    let set = ["--set", "trials=2", "--set", "refine.iterations=1"];
    let run = |out: &str, threads: &str| {
        let mut arguments = vec!["run", "wall.toml", "--threads", threads, "--out", out];
        arguments.extend(set);
        done(&folder, &arguments)
    };
    run("one", "1");
    run("three", "3");
    let names = ["leaves.parquet", "measures.parquet", "report.html"];
    let one = files(&folder.join("one"), &names);
    assert!(one == files(&folder.join("three"), &names), "threads change nothing");
    torn(&folder.join("one"), &folder.join("torn"), "evaluations.log");
    run("torn", "2");
    assert!(one == files(&folder.join("torn"), &names), "a stop changes nothing");
    done(&folder, &["report", "one"]);
    assert!(one == files(&folder.join("one"), &names));
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn an_optimisation_is_the_same_for_any_threads_and_stops_and_beats_no_wall() {
    let folder = folder("optimisation");
    std::fs::write(folder.join("best.toml"), done(&folder, &["new", "optimisation"])).unwrap();
    assert!(done(&folder, &["check", "best.toml"]).contains("dirt over angle, length by uniform, strategy, archive"));
    let run = |out: &str, more: &[&str]| {
        let set = ["--set", "confirm_trials=20", "--set", "control_trials=20", "--set", "lighten.trials=10"];
        done(&folder, &[&["run", "best.toml", "--quick", "--out", out], &set[..], more].concat())
    };
    let told = run("one", &["--threads", "1"]);
    assert!(told.contains("better: holds"), "{told}");
    let names = ["best.parquet", "evaluations.parquet", "elites.parquet", "report.html"];
    let one = files(&folder.join("one"), &names);
    run("three", &["--threads", "3"]);
    assert!(one == files(&folder.join("three"), &names), "threads change nothing");
    torn(&folder.join("one"), &folder.join("torn"), "evaluations.log");
    run("torn", &["--threads", "2"]);
    assert!(one == files(&folder.join("torn"), &names), "a stop changes nothing");
    done(&folder, &["report", "one"]);
    assert!(one == files(&folder.join("one"), &names));
    // more evaluations may be added; what is there is not done again
    let more = run("one", &["--set", "quick_evaluations=25"]);
    let made: usize = more.lines().find_map(|line| line.split_once(" evaluations in")?.0.trim().parse().ok()).unwrap();
    assert!(made < 200, "{more}");
    let whole = run("whole", &["--set", "quick_evaluations=25"]);
    assert!(whole.contains("better: "), "{whole}");
    assert!(files(&folder.join("one"), &names[..3]) == files(&folder.join("whole"), &names[..3]));
    // the best is a file that runs
    done(&folder, &["run", "one/environments/strategy.toml", "--quick", "--out", "again"]);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn derivations_of_a_grammar_are_searched_like_a_schema() {
    let folder = folder("derivations");
    let text = "kind = \"optimisation\"\ntitle = \"Walls\"\nevaluations = 12\nruns = 2\ntrials = 1\nconfirm_trials = 2\n\
                control_trials = 2\nfinalists = 2\nworkspace.base = \"field\"\ngrammar = \"corralling\"\ndecisions = 19\n\
                filter = [{ corralling = {} }]\nbehaviour.is = \"corralling\"\n\
                scenario = { time = { step = 1, duration = 60 }, space = { dimensions = 2, edges = \"open\" }, \
                group.flock = { count = 3, start = { place.box = { low = [-21, -21], high = [21, 21] } }, \
                model.control_boids = {} } }\n\
                [method.draws]\nuniform.candidates = 6\n[method.cross]\ngenetic = { candidates = 6, mutation = \"reset\" }\n";
    std::fs::write(folder.join("walls.toml"), text).unwrap();
    done(&folder, &["check", "walls.toml"]);
    done(&folder, &["run", "walls.toml", "--threads", "1", "--out", "one"]);
    done(&folder, &["run", "walls.toml", "--threads", "3", "--out", "three"]);
    let names = ["best.parquet", "evaluations.parquet", "report.html"];
    assert!(files(&folder.join("one"), &names) == files(&folder.join("three"), &names), "threads change nothing");
    // what is not feasible is not tried: every evaluation that was is of eight or nine walls, and some were not
    done(&folder, &["export", "one", "--to", "csv"]);
    let table = std::fs::read_to_string(folder.join("one/evaluations.csv")).unwrap();
    let mut lines = table.lines();
    let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| heads.iter().position(|head| *head == name).unwrap();
    let (trials, pieces, last) = (column("trials"), column("pieces"), column("decision_19"));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()).collect();
    assert!(rows.iter().all(|row| (0.0..=1.0).contains(&row[last])));
    assert!(rows.iter().filter(|row| row[trials] > 0.0).all(|row| row[pieces] == 8.0 || row[pieces] == 9.0));
    assert!(rows.iter().any(|row| row[trials] == 0.0) && rows.iter().any(|row| row[trials] > 0.0));
    for (from, to, told) in [
        ("grammar = \"corralling\"", "grammar = \"coralling\"", "did you mean `corralling`"),
        ("grammar = \"corralling\"", "", "`schema` or `grammar`"),
        ("grammar = \"corralling\"", "grammar = \"corralling\"\nschema.id = \"dirt\"", "by a schema or by a grammar"),
        ("decisions = 19", "decisions = 0", "decisions"),
        ("{ corralling = {} }", "{ coralling = {} }", "did you mean `corralling`"),
        ("[method.draws]", "[axis.decision_91]\n[method.draws]", "no parameter `decision_91`"),
        ("base = \"field\"", "base = \"arena\"", "metres"),
    ] {
        let told_of = wrong(&folder, &text.replacen(from, to, 1));
        assert!(told_of.contains(told), "{to}: {told_of}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn mistakes_are_told_at_their_place_with_what_is_near() {
    let folder = folder("mistakes");
    let (design, map) = (done(&folder, &["new", "design"]), done(&folder, &["new", "map"]));
    let changed = |text: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        wrong(&folder, &text.replacen(from, to, 1))
    };
    for (from, to, told) in [
        ("grammar = \"splitting\"", "grammar = \"spliting\"", "did you mean `splitting`"),
        ("splitting = {}", "spliting = {}", "did you mean `splitting`"),
        ("is.simple-split", "is.simple-splot", "did you mean `simple-split`"),
        ("largest_share(25)", "largest_shore(25)", "did you mean `largest_share`"),
        ("base = \"field\"", "base = \"fild\"", "did you mean `field`"),
        ("base = \"field\"", "base = \"arena\"", "is in metres"),
        ("attempts = 60", "atempts = 60", "did you mean `attempts`"),
        ("number = \"rate[behaviour = split,", "number = \"rate[behaviour = splat,", "did you mean `split`"),
        ("is.simple-split", "is.turn-right = {}\nis.simple-split", "takes one choice"),
    ] {
        let text = changed(&design, from, to);
        assert!(text.contains(told) && text.contains("wrong.toml:"), "{to}: {text}");
    }
    for (from, to, told) in [
        ("[axis.angle]", "[axis.angel]", "did you mean `angle`"),
        ("id = \"dirt\"", "id = \"dirts\"", "did you mean `dirt`"),
        ("at.anchor = 4", "at.anchor = 9", "9"),
        ("number = \"inside - bare\"", "number = \"insid - bare\"", "did you mean `inside`"),
        ("inside = { angle = [200, 240]", "inside = { angles = [200, 240]", "did you mean `angle`"),
    ] {
        let text = changed(&map, from, to);
        assert!(text.contains(told), "{to}: {text}");
    }
    for (from, to, told) in [
        ("[inverse]", "[inverse]\noutcome.fare = [1]", "did you mean `far`"),
        ("[inverse]", "[inverse]\noutcome.far = [1, 0.5]", "ascending"),
        (
            "[inverse]",
            "[inverse]\noutcome.far = [0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09, 0.1, 0.11, 0.12, \
                       0.13, 0.14, 0.15, 0.16]",
            "at most 16",
        ),
        ("[inverse]", "[inverse]\nprior = { swift = 1, slo = 1 }", "did you mean `slow`"),
        ("[inverse]", "[inverse]\nprior = { swift = 1 }", "one for each group"),
        ("[inverse]", "[inverse]\nprior = { swift = 0, slow = 0 }", "a weight above 0"),
        ("[inverse]", "[inverse]\nthreshold = 0.4", "threshold"),
        ("[inverse]", "[inverse]\nidentification = 4", "did you mean `identifications`"),
        ("trials = 10", "trials = 10\nsequential = {}", "no `sequential` beside `inverse`"),
        ("[population.slow]\nset.\"group.walkers.model.control_random.step_length\" = 0.1", "", "at least two"),
        ("needed[by = average] -", "needed[by = averge] -", "did you mean `average`"),
        ("needed[by = average] -", "needed -", "[by = ...]"),
        ("needed[by = average] -", "neded[by = average] -", "did you mean `needed`"),
    ] {
        let text = changed(INVERSE, from, to);
        assert!(text.contains(told) && text.contains("wrong.toml:"), "{to}: {text}");
    }
    let best = done(&folder, &["new", "optimisation"]);
    for (from, to, told) in [
        ("[axis.angle]", "[axis.angel]", "did you mean `angle`"),
        ("low = 170", "low = 300", "the lower first"),
        ("cma_es = {}", "cma_ex = {}", "did you mean `cma_es`"),
        ("cma_es = {}", "genetic.selection = \"rang\"", "did you mean `rank`"),
        ("kind.material", "kind.materials", "did you mean `material`"),
        ("rate[method = strategy] - control", "rate[method = strategie] - control", "did you mean `strategy`"),
    ] {
        let text = changed(&best, from, to);
        assert!(text.contains(told), "{to}: {text}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// Every shipped file of environments can be run.
#[test]
fn the_shipped_files_are_in_order() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/environments");
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .filter_map(|entry| entry.unwrap().file_name().into_string().ok())
        .filter(|name| name.ends_with(".toml"))
        .collect();
    names.sort_unstable();
    assert!(names.len() >= 8, "{names:?}");
    let mut arguments = vec!["check"];
    arguments.extend(names.iter().map(String::as_str));
    done(&folder, &arguments);
}
