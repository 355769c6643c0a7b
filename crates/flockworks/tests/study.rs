//! Studies as a user meets them: the same tables for any number of threads, stops and shards; what may be added and what
//! is refused; single trials; the shipped files.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn flockworks() -> Command {
    Command::new(env!("CARGO_BIN_EXE_flockworks"))
}

fn ran(arguments: &[&str]) -> Output {
    flockworks().args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A folder of this test's own, empty.
fn fresh(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("study").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// A small study, with what is to be changed in it.
fn file(folder: &Path, changes: &[(&str, &str)]) -> String {
    let mut study = "\
kind = \"study\"
title = \"A small study\"
trials = 4
quick_trials = 2
[looks]
from = 10
interval = 1
[reading.order]
of.metric = { id = \"polarisation\" }
[reading.spacing]
of.metric = { id = \"nearest_neighbour_distance\" }
[factor.noise]
path = \"group.points.model.vicsek_1995.noise_amplitude\"
values = [0, 2, 4]
[factor.size]
[factor.size.level.small]
\"group.points.count\" = 20
[factor.size.level.large]
\"group.points.count\" = 40
[define]
per_point = \"2.5\"
[derive]
\"space.size\" = \"sqrt(per_point * group.points.count)\"
[scenario]
time.duration = 30
space = { dimensions = 2, edges = \"periodic\", size = 1 }
[scenario.group.points]
count = 20
model = \"vicsek_1995\"
[[figure]]
title = \"Order\"
y = [\"order\"]
x = \"noise\"
[[test]]
y = \"order\"
between = \"noise\"
only = { size = \"small\" }
[[claim]]
id = \"falls\"
text = \"Order falls with noise\"
holds = \"order[noise = 0, size = small] > order[noise = 4, size = small]\"
"
    .to_owned();
    for (from, to) in changes {
        assert!(study.contains(from), "{from}");
        study = study.replacen(from, to, 1);
    }
    let path = folder.join("small.toml");
    std::fs::write(&path, study).unwrap();
    path.to_str().unwrap().to_owned()
}

fn run(file: &str, out: &Path, more: &[&str]) -> Output {
    let run = ran(&[&["run", file, "--out", out.to_str().unwrap()], more].concat());
    assert_eq!(run.status.code(), Some(0), "{file}: {}", text(&run.stderr));
    run
}

/// The tables and the page of a study.
fn results(folder: &Path) -> Vec<Vec<u8>> {
    ["trials.parquet", "cells.parquet", "report.html"].map(|name| std::fs::read(folder.join(name)).unwrap()).to_vec()
}

fn refused(arguments: &[&str], parts: &[&str]) {
    let run = ran(arguments);
    let said = text(&run.stderr);
    assert_eq!(run.status.code(), Some(2), "{arguments:?}: {said}");
    for part in parts {
        assert!(said.contains(part), "{arguments:?}: {part} is not in\n{said}");
    }
}

#[test]
fn threads_shards_selections_and_extensions_change_no_byte() {
    let folder = fresh("bytes");
    let study = file(&folder, &[]);
    let whole = folder.join("whole");
    run(&study, &whole, &["--threads", "1"]);
    let mut names: Vec<String> =
        std::fs::read_dir(&whole).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["cells.parquet", "manifest.json", "report.html", "trials.log", "trials.parquet"]);
    for threads in ["2", "3"] {
        let out = folder.join(threads);
        run(&study, &out, &["--threads", threads]);
        assert_eq!(results(&whole), results(&out), "{threads} threads");
    }
    // piece by piece: quick, some cells, some trials, the rest
    let pieces = folder.join("pieces");
    run(&study, &pieces, &["--cells", "noise=2"]);
    run(&study, &pieces, &["--trials", "1-3", "--cells", "1,6"]);
    run(&study, &pieces, &["--quick"]);
    run(&study, &pieces, &[]);
    assert_eq!(results(&whole), results(&pieces), "pieces");
    // shards on other machines, one of them done twice
    let shards: Vec<String> = (1..=3).map(|i| folder.join(format!("shard-{i}")).to_str().unwrap().to_owned()).collect();
    for (i, out) in shards.iter().enumerate() {
        run(&study, Path::new(out), &["--shard", &format!("{}/3", i + 1)]);
    }
    let merged = folder.join("merged");
    let from: Vec<&str> = [2, 0, 1, 0].map(|k: usize| shards[k].as_str()).to_vec();
    let merge = ran(&[&["merge"], from.as_slice(), &["--out", merged.to_str().unwrap()]].concat());
    assert_eq!(merge.status.code(), Some(0), "{}", text(&merge.stderr));
    assert_eq!(results(&whole), results(&merged), "shards");
    // a level and trials are added: the old trials stay as they are, and are not made again
    let larger = file(&folder, &[("trials = 4", "trials = 5"), ("values = [0, 2, 4]", "values = [0, 1, 2, 4]")]);
    let extended = run(&larger, &pieces, &[]);
    assert!(text(&extended.stderr).contains("24 are there already"), "{}", text(&extended.stderr));
    let anew = folder.join("anew");
    run(&larger, &anew, &[]);
    assert_eq!(results(&anew), results(&pieces), "extended");
}

#[test]
fn a_killed_study_goes_on_where_it_was() {
    let folder = fresh("killed");
    let study = file(&folder, &[("trials = 4", "trials = 40"), ("duration = 30", "duration = 300")]);
    let (whole, out) = (folder.join("whole"), folder.join("out"));
    run(&study, &whole, &[]);
    let mut kills = 0;
    for at in [1_000, 3_000, 6_000, 9_000] {
        let mut child = flockworks()
            .args(["run", &study, "--out", out.to_str().unwrap(), "--threads", "2"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // until so many bytes of trials are there, or it ended before
        let log = out.join("trials.log");
        while std::fs::metadata(&log).map_or(0, |m| m.len()) < at && child.try_wait().unwrap().is_none() {
            std::thread::yield_now();
        }
        kills += usize::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(kills > 0, "it was over before it could be killed");
    run(&study, &out, &[]);
    assert_eq!(results(&whole), results(&out));
    let again = run(&study, &out, &[]);
    assert!(text(&again.stdout).contains("there already"), "{}", text(&again.stdout));
}

#[test]
fn another_study_is_refused_with_the_difference() {
    let folder = fresh("another");
    let study = file(&folder, &[]);
    let out = folder.join("out");
    let to = out.to_str().unwrap();
    run(&study, &out, &["--quick"]);
    let before = results(&out);
    for (changes, difference) in [
        (&[("duration = 30", "duration = 31")][..], "time.duration: 30.0 there, 31.0 now"),
        (&[("trials = 4", "trials = 4\nseed = 1")], "seed: 0 there, 1 now"),
        (&[("values = [0, 2, 4]", "values = [0, 4]")], "noise = 2, size = small: there, not now"),
        (&[("interval = 1", "interval = 2")], "looks.interval"),
        (&[("id = \"nearest_neighbour_distance\"", "id = \"mean_speed\"")], "readings.spacing"),
    ] {
        let changed = file(&folder, changes);
        refused(&["run", &changed, "--out", to], &["holds another study", difference, "--out"]);
    }
    assert_eq!(before, results(&out), "nothing was changed");
    let small = file(&folder, &[]);
    let scenario = format!("{}/../../studies/gallery/mill.toml", env!("CARGO_MANIFEST_DIR"));
    refused(&["run", &scenario, "--out", to], &["another run"]);
    refused(&["run", &scenario, "--cells", "1"], &["--cells is for studies"]);
    let other = folder.join("other");
    run(&file(&folder, &[("duration = 30", "duration = 20")]), &other, &["--quick"]);
    let both = ["merge", to, other.to_str().unwrap(), "--out", folder.join("no").to_str().unwrap()].map(str::to_owned);
    refused(&both.iter().map(String::as_str).collect::<Vec<_>>(), &["time.duration"]);
    assert!(!folder.join("no").exists());
    drop(small);
}

#[test]
fn mistakes_are_shown_at_their_place() {
    let folder = fresh("mistakes");
    for (changes, parts) in [
        (&[("noise_amplitude\"", "noise_amplitud\"")][..], &["has no parameter `noise_amplitud`", "did you mean"][..]),
        (
            &[("per_point * group", "per_pont * group")],
            &["unknown name `per_pont`", "did you mean `per_point`?", "^^^^^^^^"],
        ),
        (&[("sqrt(per_point * group.points.count)", "sqrt(per_point * ")], &["the expression ends", "small.toml:"]),
        (&[("\"sqrt(", "\"log(0 * ")], &["the expression gives"]),
        (&[("x = \"noise\"", "x = \"nois\"")], &["no factor is called `nois`", "did you mean `noise`?"]),
        (&[("order[noise = 0,", "order[noise = 9,")], &["`noise` has no such level", "it has 0, 2, 4"]),
        (&[("order[noise = 0,", "oder[noise = 0,")], &["no reading and no factor is called `oder`"]),
        (
            &[("id = \"polarisation\"", "id = \"polarization\"")],
            &["unknown metric `polarization`", "did you mean `polarisation`"],
        ),
        (&[("interval = 1", "interval = 1.5")], &["1.5 is no multiple of the step"]),
        (&[("from = 10", "from = 40")], &["after the end"]),
        (&[("[reading.order]", "[reading.trial]")], &["a column of the tables is called `trial` already"]),
        (&[("values = [0, 2, 4]", "values = []")], &["has no levels"]),
        (&[("values = [0, 2, 4]", "values = [0, 2, 0]")], &["`noise` has the level 0 twice"]),
        (
            &[("values = [0, 2, 4]\n", "values = [0, 2, 4]\nlevel.\"2.5\" = { \"group.points.count\" = 30 }\n")],
            &["`noise` has no level `2.5`", "did you mean `2`?"],
        ),
        (&[("[scenario]", "[senario]")], &["unknown key `senario`"]),
        (&[("[factor.noise]", "design = \"zip\"\n[factor.noise]")], &["`size` has 2 levels and `noise` 3"]),
        (&[("values = [0, 2, 4]", "steps = { from = 0, to = -1, by = 1 }")], &["lead nowhere"]),
        (&[("values = [0, 2, 4]", "values = [0, 2, inf]")], &["has the level inf", "a finite number"]),
        (&[("values = [0, 2, 4]", "range = [0, 4]")], &["a range is for designs that draw", "random = "]),
        (
            &[("\"group.points.count\" = 40", "\"group.points.count\" = 40\nseed = 3")],
            &["`seed` cannot differ between cells", "the seed of the study plus t"],
        ),
        (&[("\"space.size\" =", "\"record.every\" =")], &["`record` cannot differ between cells"]),
        (
            &[("path = \"group.points.model.vicsek_1995.noise_amplitude\"", "path = \"measure.interval\"")],
            &["`measure` cannot differ between cells", "[reading.NAME]"],
        ),
        (&[("title = \"A small study\"", "title = \"A\"\nextends = \"none.toml\"")], &["cannot read", "none.toml"]),
    ] {
        // a key before the first table
        let changes: Vec<(&str, &str)> = changes.to_vec();
        let study = if changes[0].1.starts_with("design") {
            file(&folder, &[("trials = 4", "trials = 4\ndesign = \"zip\"")])
        } else {
            file(&folder, &changes)
        };
        refused(&["check", &study], parts);
    }
    let study = file(&folder, &[]);
    for (option, value, part) in [
        ("--cells", "7", "from 1 to 6"),
        ("--cells", "noise=9", "`noise` has no level `9`; it has 0, 2, 4"),
        ("--cells", "size=smal", "did you mean `small`?"),
        ("--cells", "nois=2", "no factor is called `nois`; did you mean `noise`?"),
        ("--trials", "0", "--trials takes"),
        ("--shard", "3/2", "--shard takes I/N"),
        ("--cell", "noise=2", "2 cells have"),
    ] {
        refused(&["run", &study, option, value], &[part]);
    }
    refused(
        &["run", &study, "--cell", "1", "--cells", "2"],
        &["`--cell <CELL>` cannot stand beside `--cells <CELLS>`"],
    );
}

#[test]
fn designs_make_their_cells() {
    let folder = fresh("designs");
    let cells = |design: &str, values: &str| {
        let changes =
            [("trials = 4", format!("trials = 1\ndesign = {design}")), ("values = [0, 2, 4]", values.to_owned())];
        let changes: Vec<(&str, &str)> = changes.iter().map(|(from, to)| (*from, to.as_str())).collect();
        // without what speaks of levels
        let study = file(&folder, &changes);
        let whole = std::fs::read_to_string(&study).unwrap();
        std::fs::write(&study, whole.split("[[claim]]").next().unwrap()).unwrap();
        let plan = ran(&["run", &study, "--plan"]);
        assert_eq!(plan.status.code(), Some(0), "{}", text(&plan.stderr));
        text(&plan.stdout)
    };
    let of = |plan: &str, line: &str| plan.lines().find(|l| l.trim_start().starts_with(line)).unwrap().to_owned();
    assert!(of(&cells("\"zip\"", "values = [0, 2]"), "small:").contains("2 cells"));
    let table = "{ table = [{ noise = 1, size = \"small\" }, { noise = 3, size = \"large\" }, { noise = 1, size = \"large\" }] }";
    assert!(of(&cells(table, ""), "small:").contains("3 cells"));
    let random = cells("{ random = { samples = 3 } }", "range = [0, 6]");
    let more = cells("{ random = { samples = 4 } }", "range = [0, 6]");
    let levels = |plan: &str| of(plan, "noise").split(": ").nth(1).unwrap().to_owned();
    assert!(levels(&more).starts_with(&levels(&random)), "more samples change none: {random} {more}");
    let cube = levels(&cells("{ latin_hypercube = { samples = 6 } }", "range = [0, 6]"));
    let mut parts: Vec<u32> = cube.split(", ").map(|x| x.parse::<f64>().unwrap() as u32).collect();
    parts.sort_unstable();
    assert_eq!(parts, [0, 1, 2, 3, 4, 5], "one in each part of the range");
}

#[test]
fn the_study_to_start_from_runs_and_its_page_is_whole() {
    let folder = fresh("template");
    let template = ran(&["new", "study"]);
    let study = folder.join("template.toml");
    std::fs::write(&study, &template.stdout).unwrap();
    let out = folder.join("out");
    run(study.to_str().unwrap(), &out, &["--quick"]);
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    for part in
        ["Order falls with noise", "whisker", "Tukey-Kramer", "With trials as blocks", "statements.csv", "holds"]
    {
        assert!(page.contains(part), "{part}");
    }
    for broken in [">NaN", "\"NaN", ",NaN", " NaN,", ">inf"] {
        assert!(!page.contains(broken), "{broken}");
    }
    let csv = ran(&["export", out.to_str().unwrap(), "--to", "csv"]);
    assert_eq!(csv.status.code(), Some(0), "{}", text(&csv.stderr));
    let cells = std::fs::read_to_string(out.join("cells.csv")).unwrap();
    assert!(cells.starts_with("part,cell,condition,noise,density,trials,order_mean,order_sem,order_n\n"), "{cells}");
    assert_eq!(cells.lines().count(), 13);
    let first = std::fs::read(out.join("report.html")).unwrap();
    assert_eq!(ran(&["report", out.to_str().unwrap()]).status.code(), Some(0));
    assert_eq!(first, std::fs::read(out.join("report.html")).unwrap());
    assert!(text(&ran(&["schema"]).stdout).lines().any(|kind| kind == "study"));
}

#[test]
fn a_single_trial_can_be_run_again() {
    let folder = fresh("single");
    let study = file(&folder, &[]);
    let out = folder.join("one");
    run(&study, &out, &["--cell", "noise=2,size=large", "--trial", "3"]);
    let manifest: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("manifest.json")).unwrap()).unwrap();
    assert_eq!((&manifest["kind"], &manifest["seed"]), (&"scenario".into(), &3.into()));
    let scenario = &manifest["identity"]["scenario"];
    assert_eq!(scenario["space"]["size"], 10.0);
    assert_eq!(scenario["group"]["points"]["model"]["vicsek_1995"]["noise_amplitude"], 2.0);
    assert!(out.join("trajectory.parquet").exists());
    // the study's seed and its few trials choose the trial, and change it no further
    let out = folder.join("other");
    run(&study, &out, &["--cell", "noise=2,size=large", "--trial", "3", "--seed", "5", "--quick"]);
    let manifest: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("manifest.json")).unwrap()).unwrap();
    assert_eq!(manifest["seed"], 8);
    assert_eq!(manifest["identity"]["scenario"]["time"]["duration"], 30.0);
}

#[test]
fn finished_trials_are_never_dropped() {
    let folder = fresh("kept");
    let (few, more) = (folder.join("few"), folder.join("more"));
    run(&file(&folder, &[]), &few, &["--trials", "1-2"]);
    let study = file(&folder, &[("trials = 4", "trials = 5"), ("values = [0, 2, 4]", "values = [0, 1, 2, 4]")]);
    run(&study, &more, &["--trials", "3-5"]);
    // whichever folder is named first, and a torn tail stays as it is
    let log = few.join("trials.log");
    let mut bytes = std::fs::read(&log).unwrap();
    bytes.extend([1, 0, 0, 0, 9]);
    std::fs::write(&log, &bytes).unwrap();
    let merged: Vec<_> = [["few", "more"], ["more", "few"]]
        .map(|order| {
            let out = folder.join(format!("{}-first", order[0]));
            let from = order.map(|name| folder.join(name).to_str().unwrap().to_owned());
            let merge = ran(&["merge", &from[0], &from[1], "--out", out.to_str().unwrap()]);
            assert_eq!(merge.status.code(), Some(0), "{}", text(&merge.stderr));
            assert!(text(&merge.stdout).contains("36 trials of 2 folders"), "{}", text(&merge.stdout));
            results(&out)
        })
        .to_vec();
    assert_eq!(merged[0], merged[1]);
    assert_eq!(bytes, std::fs::read(&log).unwrap());
    // a page is not made from nothing, nor from a part
    let before = results(&few);
    std::fs::rename(&log, folder.join("aside")).unwrap();
    refused(&["report", few.to_str().unwrap()], &["trials.log"]);
    bytes[200] ^= 1;
    std::fs::write(&log, &bytes).unwrap();
    for verb in [&["report"][..], &["run", &file(&folder, &[]), "--out"]] {
        refused(&[verb, &[few.to_str().unwrap()]].concat(), &["damaged at byte", "truncate --size"]);
    }
    assert_eq!(before, results(&few));
    assert_eq!(bytes, std::fs::read(&log).unwrap());
}

/// The experiments of the behaviour-selection study are those of its table: so many conditions, so many different ones.
#[test]
fn the_shipped_studies_have_their_cells() {
    let shipped = |name: &str| format!("{}/../../studies/{name}", env!("CARGO_MANIFEST_DIR"));
    for (name, cells, trials) in [
        ("exp1", 20, 2000),
        ("exp2", 48, 4800),
        ("exp3a", 22, 2200),
        ("exp3b", 21, 2100),
        ("exp4", 11, 1100),
        ("exp5", 55, 5500),
        ("exp6", 12, 1200),
        ("exp7", 15, 1500),
        ("exp8", 33, 3300),
        ("exp9a", 22, 2200),
        ("exp9b", 22, 2200),
        ("literal", 20, 2000),
    ] {
        let file = shipped(&format!("behaviour-selection/{name}.toml"));
        let check = ran(&["check", &file]);
        assert_eq!(check.status.code(), Some(0), "{}", text(&check.stderr));
        let said = text(&check.stdout);
        assert!(said.contains(&format!(" {cells} cells, {cells} different conditions, {trials} trials")), "{said}");
    }
    let check = ran(&["check", &shipped("behaviour-selection/all.toml")]);
    let said = text(&check.stdout);
    assert!(said.contains("281 cells, 236 different conditions, 23600 trials"), "{said}{}", text(&check.stderr));
}

/// The case studies are as large as their sources say, and every model but those of other dimensions is in the last.
#[test]
fn the_shipped_case_studies_have_their_cells() {
    let shipped = |name: &str| format!("{}/../../studies/{name}", env!("CARGO_MANIFEST_DIR"));
    for (name, said) in [
        ("perception/trials.toml", "90 cells, 90 different conditions, 630 trials"),
        ("perception/robots.toml", "90 cells, 90 different conditions, 630 trials"),
        ("perception/repulsion.toml", "16 cells, 16 different conditions, 112 trials"),
        ("abstracted/robots-errors.toml", "16 cells, 16 different conditions, 640 trials"),
        ("abstracted/simulations.toml", "16 cells, 16 different conditions, 160 trials"),
        ("abstracted/robots.toml", "4 cells, 4 different conditions"),
        ("cross/all.toml", "496 cells, 496 different conditions"),
    ] {
        let check = ran(&["check", &shipped(name)]);
        assert!(text(&check.stdout).contains(said), "{}{}", text(&check.stdout), text(&check.stderr));
    }
    let parts = std::fs::read_dir(shipped("cross")).unwrap().map(|entry| entry.unwrap().path());
    let parts: String = parts.filter_map(|path| std::fs::read_to_string(path).ok()).collect();
    for entry in swarm::models::LIST.iter().filter(|entry| entry.dimensions.contains(&2) && entry.card.id != "composed")
    {
        assert!(parts.contains(&format!("[factor.model.level.{}]", entry.card.id)), "{}", entry.card.id);
    }
}

#[test]
fn statements_that_must_hold_decide_how_it_ends() {
    let folder = fresh("must-hold");
    let claim = "holds = \"order[noise = 0, size = small] > order[noise = 4, size = small]\"";
    for (holds, strength, verdict, code) in [
        ("min(order) >= 0", "A", "holds", 0),
        ("max(order) < 0", "A", "does not hold", 1),
        ("max(order) < 0", "B", "does not hold", 0),
    ] {
        let study = file(&folder, &[(claim, &format!("holds = \"{holds}\"\nstrength = \"{strength}\""))]);
        let out = folder.join(format!("{strength}-{code}"));
        let ended = ran(&["run", &study, "--out", out.to_str().unwrap(), "--must-hold"]);
        assert_eq!(ended.status.code(), Some(code), "{holds}: {}", text(&ended.stderr));
        assert!(text(&ended.stdout).contains(&format!("{verdict:17}falls: Order falls with noise")));
        // nobody asked: it ends well, whatever came
        run(&study, &out, &[]);
    }
}

#[test]
fn a_statement_says_what_it_is_about_and_how_sure_it_must_be() {
    let folder = fresh("about-these");
    let claim = "holds = \"order[noise = 0, size = small] > order[noise = 4, size = small]\"";
    let always = "holds = \"min(order) >= 0\"";
    // one trial says nothing of others, but it is what it is
    for (more, trials, verdict, why) in [
        ("", "1", "cannot be judged", "a single trial says nothing"),
        ("exact = true", "1", "holds", "said of these very trials"),
        ("doubt = 0.005", "4", "holds", "at most 0.5 % may disagree"),
    ] {
        let study = file(&folder, &[(claim, &format!("{always}\n{more}"))]);
        let out = folder.join(format!("{}-{trials}", more.split(' ').next().unwrap()));
        let ended = run(&study, &out, &["--set", &format!("trials={trials}")]);
        let said = text(&ended.stdout);
        assert!(said.contains(&format!("{verdict:17}falls")), "{more}: {said}");
        let page = std::fs::read_to_string(out.join("report.html")).unwrap();
        assert!(page.contains(why), "{more}: {why}");
    }
    // what other cells lack does not matter, and numbers that are none give no verdict
    for (holds, only, verdict, why) in [
        ("order[noise = 0, size = small] >= 0", "noise=0,size=small", "holds", "true in 100 % of the drawings"),
        ("not 0/0 > 2", "noise=0,size=small", "cannot be judged", "this has no value"),
    ] {
        let study = file(&folder, &[(claim, &format!("holds = \"{holds}\""))]);
        let out = folder.join(verdict.split(' ').next().unwrap());
        run(&study, &out, &["--trials", "1-1", "--cells", "noise=2"]);
        let ended = run(&study, &out, &["--cells", only]);
        assert!(text(&ended.stdout).contains(&format!("{verdict:17}falls")), "{}", text(&ended.stdout));
        let page = std::fs::read_to_string(out.join("report.html")).unwrap();
        let said = ["tried 0 to 4 times (of 4 planned)", "fewer than ten trials", why];
        assert!(said.iter().all(|said| page.contains(said)), "{holds}");
    }
    let study = file(&folder, &[(claim, &format!("{always}\ndoubt = 0.6"))]);
    refused(&["check", &study], &["doubt", "0.6"]);
}

#[test]
fn a_test_over_several_cells_takes_only_trials_that_all_of_them_have() {
    let folder = fresh("pooled");
    let only = "only = { size = \"small\" }\n";
    let study = file(&folder, &[(only, ""), ("trials = 4", "trials = 6")]);
    let (whole, partial) = (folder.join("whole"), folder.join("partial"));
    run(&study, &whole, &["--trials", "1-3"]);
    run(&study, &partial, &["--trials", "1-3"]);
    // three more trials of one size without noise and of the other with it: no group can be told from them
    run(&study, &partial, &["--cells", "noise=0,size=small"]);
    run(&study, &partial, &["--cells", "noise=4,size=large"]);
    let sentence = |folder: &Path| {
        let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
        let from = page.find("between the levels of").unwrap();
        page[from..].split("</p>").next().unwrap().to_owned()
    };
    let (before, after) = (sentence(&whole), sentence(&partial));
    assert_eq!(after, format!("{before} Left out: 6 trials that some of the cells of their level lack."));
}

#[test]
fn members_in_a_box_and_other_statistics() {
    let folder = fresh("statistics");
    let box_ = "of.inside = { low = [0, 0], high = [5, 100] }";
    let readings = format!(
        "[reading.order]\nof.metric = {{ id = \"polarisation\", statistic = \"binder\" }}\n[reading.inside]\n{box_}\n\
         [reading.all]\nof.inside = {{ low = [0, 0], high = [100, 100], statistic = \"least\" }}"
    );
    let kept = "[reading.order]\nof.metric = { id = \"polarisation\" }";
    let holds = "holds = \"order[noise = 0, size = small] > order[noise = 4, size = small]\"";
    // everyone is in the box of everything, some are in its part, and a fully ordered flock has the cumulant 2/3
    let claim = "strength = \"A\"\nholds = \"min(all) = 20 and max(all) = 40 and min(inside) > 0 and max(inside) < 40 and \
                 max(order) < 0.667\"";
    let study = file(&folder, &[(kept, &readings), (holds, claim)]);
    let out = folder.join("out");
    let ended = run(&study, &out, &["--must-hold"]);
    assert!(text(&ended.stdout).contains("holds            falls"), "{}", text(&ended.stdout));
    let flat = file(&folder, &[(kept, "[reading.order]\nof.inside = { low = [0], high = [1] }")]);
    refused(&["check", &flat], &["`low` has 1 coordinates in 2 dimensions"]);
}

#[test]
fn the_shipped_results_of_the_literature_are_studies() {
    let folder = format!("{}/../../studies/literature", env!("CARGO_MANIFEST_DIR"));
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let studies: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    assert!(studies.len() > 10);
    for study in studies {
        let check = ran(&["check", study.to_str().unwrap()]);
        assert_eq!(check.status.code(), Some(0), "{}", text(&check.stderr));
        // what does not hold is said as well, so not every file has a statement that must
        let text = std::fs::read_to_string(&study).unwrap();
        let parts = ["[[claim]]", "holds = ", "strength = ", "[[figure]]"];
        assert!(parts.iter().all(|part| text.contains(part)), "{}", study.display());
    }
}
