//! Hierarchical schemas and doors through the program itself: stages alone and together, rejections, threads and stops, mistakes.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("flockworks-stages-{}-{name}", std::process::id()));
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

/// Walkers go along x through a funnel and then a corridor; the narrow neck lets no body through.
const WALKERS: &str = r#"
kind = "design"
title = "Through two stages"
seed = 3
attempts = 10
trials = 4
workspace.base.empty = { units = "metres" }

[[candidates.stages]]
name = "one"
schema = { id = "funnel", at = { mouth = 2, chute = 1 }, values.neck = [0.3, 1] }
entry = { at = [-2, 0], region.ball = { centre = [-2, 0], radius = 0.3 } }
exit = { at = [0.5, 0], region.ball = { centre = [0.5, 0], radius = 0.1 } }
region.mouth.ball = { centre = [-0.5, 0], radius = 0.5 }
behaviour.score.share = "share_visited(mouth)"

[[candidates.stages]]
name = "two"
schema = { id = "funnel", at = { mouth = 1, neck = 1, chute = 2 } }
entry = { at = [-0.5, 0], region.ball = { centre = [-0.5, 0], radius = 0.1 } }
handover = { share = 0.5, steps = 2 }
gate.end = [2, -1, 2, 1]
behaviour.score.binary.when = "share_crossed(end) >= 0.5"

[behaviour.far]
score.binary.when = "centroid_x >= 4.5"

[scenario]
time.duration = 10
[scenario.units]
length = "m"
time = "s"
[scenario.space]
dimensions = 2
edges = "open"
[scenario.group.near]
count = 1
physics = { radius = 0.2, contact = "slide" }
model.composed = { motion = "direction", speed = 1, terms = [{ travel = { direction = [1, 0] } }] }
start = { place.points = [[-2, 0]], heading.along = [1, 0] }
[scenario.group.away]
count = 1
physics = { radius = 0.2, contact = "slide" }
model.composed = { motion = "direction", speed = 1, terms = [{ travel = { direction = [1, 0] } }] }
start = { place.points = [[-2, 5]], heading.along = [1, 0] }

[[claim]]
id = "alone"
text = "Alone the second stage succeeds as it does behind the first"
strength = "A"
number = "alone[behaviour = two] - rate[behaviour = two]"
holds = "alone[behaviour = two] = rate[behaviour = two]"
"#;

#[test]
fn stages_are_tried_alone_and_together() {
    let folder = folder("walkers");
    std::fs::write(folder.join("walkers.toml"), WALKERS).unwrap();
    let checked = done(&folder, &["check", "walkers.toml"]);
    assert!(checked.contains("stages one, two: 2 candidates") && checked.contains("4 behaviours"), "{checked}");
    let told = done(&folder, &["run", "walkers.toml", "--threads", "1", "--out", "one"]);
    // one of two members comes to the mouth: half, which is no success; the second stage is a success, and the whole is half
    for line in [
        "2 generated, 1 feasible",
        "one, group: 0.0 % (0.0 to 49.0)",
        "two, group: 100.0 % (51.0 to 100.0)",
        "whole, group: 0.0 %",
        "far, group: 100.0 %",
        "one, group: alone 0.0 %",
        "two, group: alone 100.0 % (51.0 to 100.0); behind the others 100.0 %",
        "alone: holds",
    ] {
        assert!(told.contains(line), "{line}: {told}");
    }
    let page = std::fs::read_to_string(folder.join("one/report.html")).unwrap();
    assert!(page.contains("Each stage alone, and behind the others"));
    assert!(
        page.contains("no body fits through from the entry of <code>one</code> to that of <code>two</code>"),
        "the reason is counted"
    );
    let told = done(&folder, &["run", "walkers.toml", "--set", "success=0.5", "--out", "half"]);
    assert!(told.contains("whole, group: 100.0 %") && told.contains("whole, group: alone 100.0 % (product)"), "{told}");
    let told = done(&folder, &["run", "walkers.toml", "--set", "success=0.51", "--out", "more"]);
    assert!(told.contains("whole, group: 0.0 %"), "{told}");
    // nobody is handed over: the second stage is not tried alone, and fails behind the first
    let never = ["--set", "candidates.stages.1.handover.share=0.9"];
    let told = done(&folder, &[&["run", "walkers.toml", "--out", "never"], &never[..]].concat());
    assert!(told.contains("two, group: alone \u{2013}; behind the others 0.0 %"), "{told}");
    // unless the one who stays away is no longer wanted
    let wanted = ["--set", "candidates.stages.1.handover.groups=[\"near\"]", "--out", "wanted"];
    let told = done(&folder, &[&["run", "walkers.toml"], &never[..], &wanted[..]].concat());
    assert!(told.contains("two, group: alone 100.0 %"), "{told}");
    std::fs::remove_dir_all(folder).unwrap();
}

/// A walker stands before a door until it has been there for a while.
const DOOR: &str = r#"
kind = "design"
title = "A door"
attempts = 1
trials = 2
workspace.base.empty = { units = "metres" }
workspace.region.hall.box = { low = [-1, -1], high = [0, 1] }
door.gate = { wall = [0, -5, 0, 5], opens = { when = "share_in(hall) >= 1", sustained = 20 } }
candidates.schema = { id = "funnel", at = { mouth = 2, neck = 2, chute = 1 } }
behaviour.through.score.binary = { when = "centroid_x >= 1", within = 90 }
[scenario]
time.duration = 10
[scenario.units]
length = "m"
time = "s"
[scenario.space]
dimensions = 2
edges = "open"
[scenario.group.walker]
count = 1
physics = { radius = 0.2, contact = "slide" }
model.composed = { motion = "direction", speed = 1, terms = [{ travel = { direction = [1, 0] } }] }
start = { place.points = [[-2, 0]], heading.along = [1, 0] }
"#;

#[test]
fn doors_open_and_shut_on_conditions() {
    let folder = folder("doors");
    std::fs::write(folder.join("door.toml"), DOOR).unwrap();
    let run = |set: &[&str], out: &str| done(&folder, &[&["run", "door.toml", "--out", out], set].concat());
    assert!(run(&[], "opens").contains("through, group: 100.0 %"));
    // inside from step 10 on, so that the door goes with step 29; from before it to 1 it takes 12 steps more
    assert!(run(&["--set", "behaviour.through.score.binary.within=41"], "soon").contains("through, group: 0.0 %"));
    let never = "door.gate.opens.when=\"share_in(hall) > 1\"";
    assert!(run(&["--set", never], "never").contains("through, group: 0.0 %"));
    // the exported trial is the same: the door goes at the time at which it went
    let text = std::fs::read_to_string(folder.join("opens/environments/through-group-0.toml")).unwrap();
    assert!(text.contains("disappears = 2.9"), "{text}");
    done(&folder, &["run", "opens/environments/through-group-0.toml", "--out", "again"]);
    done(&folder, &["export", "again", "--to", "csv"]);
    let table = std::fs::read_to_string(folder.join("again/trajectory.csv")).unwrap();
    let last: Vec<f64> =
        table.lines().last().unwrap().split(',').map(|word| word.parse().unwrap_or(f64::NAN)).collect();
    // 7.1 of ten seconds are left, from where it touched the door
    assert!((last[5] - (7.1 - 0.2)).abs() < 0.05, "{last:?}");
    for (from, to, told) in [
        ("sustained = 20 } }", "sustained = 20 }, opened = {} }", "did you mean `opens`"),
        (", opens = { when = \"share_in(hall) >= 1\", sustained = 20 } }", " }", "neither opens nor shuts"),
        ("wall = [0, -5, 0, 5]", "wall = [0, -5, 0, -5]", "the door has no length"),
        ("share_in(hall)", "share_in(hull)", "did you mean `hall`"),
    ] {
        std::fs::write(folder.join("wrong.toml"), DOOR.replace(from, to)).unwrap();
        let output = flockworks(&folder, &["check", "wrong.toml"]);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{to}");
        assert!(text.contains(told) && text.contains("wrong.toml:"), "{to}: {text}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

const NAMES: [&str; 6] =
    ["candidates.parquet", "results.parquet", "trials.parquet", "rates.parquet", "stages.parquet", "report.html"];

#[test]
fn threads_and_stops_change_nothing() {
    let folder = folder("threads");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/environments/gather-and-sort.toml");
    std::fs::copy(file, folder.join("sort.toml")).unwrap();
    let run = |out: &str, threads: &str| {
        let set = ["--set", "trials=2", "--set", "scenario.time.duration=60", "--set", "attempts=4"];
        done(&folder, &[&["run", "sort.toml", "--threads", threads, "--out", out], &set[..]].concat())
    };
    let files = |out: &str| NAMES.map(|name| std::fs::read(folder.join(out).join(name)).unwrap());
    run("one", "1");
    run("three", "3");
    assert!(files("one") == files("three"), "threads change nothing");
    std::fs::create_dir_all(folder.join("torn")).unwrap();
    std::fs::copy(folder.join("one/manifest.json"), folder.join("torn/manifest.json")).unwrap();
    let log = std::fs::read(folder.join("one/candidates.log")).unwrap();
    std::fs::write(folder.join("torn/candidates.log"), &log[..log.len() * 3 / 5]).unwrap();
    run("torn", "2");
    assert!(files("one") == files("torn"), "a stop changes nothing");
    done(&folder, &["report", "one"]);
    assert!(files("one") == files("torn"));
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn mistakes_are_told_at_their_place() {
    let folder = folder("mistakes");
    for (from, to, told) in [
        (
            "exit = { at = [0.5, 0], region.ball = { centre = [0.5, 0], radius = 0.1 } }\n",
            "",
            "`one` has no exit to which `two`",
        ),
        ("id = \"funnel\", at = { mouth = 2", "id = \"funel\", at = { mouth = 2", "did you mean `funnel`"),
        ("values.neck = [0.3, 1]", "values.nek = [0.3, 1]", "did you mean `neck`"),
        ("values.neck = [0.3, 1]", "values.neck = [3]", "at most the mouth"),
        ("values.neck = [0.3, 1]", "values.neck = [0.3]", "1: no body fits through from the entry of `one`"),
        ("share_visited(mouth)", "share_visited(moth)", "did you mean `mouth`"),
        ("share_crossed(end)", "share_crossed(mouth)", "unknown gate `mouth`"),
        ("name = \"two\"", "name = \"one\"", "is the name of something else"),
        ("name = \"two\"", "name = \"whole\"", "is the name of something else"),
        ("[behaviour.far]", "[behaviour.two]", "`two` is the name of a stage"),
        ("handover = { share = 0.5, steps = 2 }", "handover = { groups = [\"neer\"] }", "did you mean `near`"),
        (
            "handover = { share = 0.5, steps = 2 }",
            "handover.when.when = \"share_in(moth) > 1\"",
            "unknown region `moth`",
        ),
        ("name = \"one\"", "name = \"one\"\nhandover = {}", "the first stage begins with the trial"),
        ("at = [-2, 0], region", "at = [-2], region", "1 coordinates in a space of 2"),
        ("alone[behaviour = two] - rate", "alone[behaviour = far] - rate", "`far` is no stage"),
        ("radius = 0.2, contact", "radius = 0, contact", "bodies have no radius"),
    ] {
        assert!(WALKERS.contains(from), "{from}");
        std::fs::write(folder.join("wrong.toml"), WALKERS.replace(from, to)).unwrap();
        let output = flockworks(&folder, &["check", "wrong.toml"]);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{to}: {}", String::from_utf8_lossy(&output.stdout));
        assert!(text.contains(told) && text.contains("wrong.toml:"), "{to}: {text}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}
