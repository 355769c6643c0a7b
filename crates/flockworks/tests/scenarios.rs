//! Scenarios as a user meets them: the shipped files, wrong files, folders, stopping and going on.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

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
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("scenarios").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    path
}

fn study(name: &str) -> String {
    format!("{}/../../studies/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn shipped() -> Vec<String> {
    let gallery = std::fs::read_dir(study("gallery")).unwrap();
    let mut files: Vec<String> = gallery.map(|entry| entry.unwrap().path().to_str().unwrap().to_owned()).collect();
    files.push(study("schooling.toml"));
    files.retain(|file| file.ends_with(".toml"));
    files.sort();
    files
}

/// Runs into a folder and expects it to end well.
fn run(file: &str, out: &Path, more: &[&str]) -> Output {
    let out = out.to_str().unwrap();
    let run = ran(&[&["run", file, "--out", out], more].concat());
    assert_eq!(run.status.code(), Some(0), "{file}: {}", text(&run.stderr));
    run
}

/// The tables and the full states of a run, by name.
fn results(folder: &Path) -> Vec<(&'static str, Vec<u8>)> {
    ["trajectory.parquet", "metrics.parquet", "events.parquet", "keyframes.log"]
        .into_iter()
        .map(|name| (name, std::fs::read(folder.join(name)).unwrap()))
        .collect()
}

fn manifest(folder: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join("manifest.json")).unwrap()).unwrap()
}

#[test]
fn every_shipped_scenario_runs_and_leaves_a_whole_folder() {
    assert_eq!(shipped().len(), 9);
    for file in shipped() {
        let name = Path::new(&file).file_stem().unwrap().to_str().unwrap().to_owned();
        let out = fresh(&format!("shipped-{name}"));
        let run = run(&file, &out, &["--quick"]);
        assert!(text(&run.stdout).contains("report.html"), "{name}");
        let mut files: Vec<String> =
            std::fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        files.sort();
        // where there are obstacles, their places are a table too
        let obstacles = files.iter().position(|name| name == "obstacles.parquet").map(|at| files.remove(at));
        let source = std::fs::read_to_string(&file).unwrap();
        assert_eq!(obstacles.is_some(), source.contains("[[obstacle]]") || source.contains("[scatter."), "{name}");
        let usual = [
            "events.parquet",
            "keyframes.log",
            "manifest.json",
            "metrics.parquet",
            "report.html",
            "trajectory.parquet",
        ];
        assert_eq!(files, usual, "{name}");
        assert_eq!(manifest(&out)["status"], "complete");
        let page = std::fs::read_to_string(out.join("report.html")).unwrap();
        assert!(page.contains("<svg") && page.contains("Methods"), "{name}");
        for broken in [">NaN", "\"NaN", ",NaN", " NaN,"] {
            assert!(!page.contains(broken), "{name}: {broken}");
        }
    }
}

#[test]
fn threads_and_stops_change_no_byte() {
    let file = study("gallery/foraging.toml");
    let once = fresh("bytes-once");
    run(&file, &once, &["--threads", "1"]);
    let other = fresh("bytes-threads");
    run(&file, &other, &["--threads", "3"]);
    assert_eq!(results(&once), results(&other));
}

/// Bytes of a growing file that holds a whole block, with its full state, and a part of the next: a block of the schooling
/// study has about 700,000.
const CONTINUABLE: u64 = 1_000_000;

/// Starts a run and waits until it has written something that can be continued.
fn started(file: &str, out: &Path) -> Child {
    let child = flockworks()
        .args(["run", file, "--out", out.to_str().unwrap()])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let log = out.join("unfinished.log");
    while std::fs::metadata(&log).map_or(0, |m| m.len()) < CONTINUABLE {
        assert!(!out.join("report.html").exists(), "the run must be long enough to be stopped in the middle");
        std::thread::yield_now();
    }
    child
}

#[test]
fn a_killed_run_continues_to_the_same_bytes() {
    let file = study("schooling.toml");
    let whole = fresh("kill-whole");
    run(&file, &whole, &[]);
    let killed = fresh("kill-killed");
    for _ in 0..2 {
        let mut child = started(&file, &killed);
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(!killed.join("trajectory.parquet").exists(), "nothing half-written");
        if killed.join("unfinished.log").metadata().unwrap().len() > 3_000_000 {
            break;
        }
    }
    let run = run(&file, &killed, &[]);
    assert!(text(&run.stderr).contains("continues after step"), "{}", text(&run.stderr));
    assert_eq!(results(&whole), results(&killed));
    let again = ran(&["run", &file, "--out", killed.to_str().unwrap()]);
    assert_eq!(again.status.code(), Some(0));
    assert!(text(&again.stdout).contains("complete already"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_and_the_same_command_continues() {
    let file = study("schooling.toml");
    let whole = fresh("int-whole");
    run(&file, &whole, &["--seed", "5"]);
    let stopped = fresh("int-stopped");
    let child = flockworks()
        .args(["run", &file, "--seed", "5", "--out", stopped.to_str().unwrap()])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while std::fs::metadata(stopped.join("unfinished.log")).map_or(0, |m| m.len()) < CONTINUABLE {
        std::thread::yield_now();
    }
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(130));
    assert!(text(&ended.stdout).contains("the same command continues it"));
    assert_eq!(manifest(&stopped)["status"], "stopped");
    run(&file, &stopped, &["--seed", "5"]);
    assert_eq!(results(&whole), results(&stopped));
    assert_eq!(manifest(&stopped)["sessions"].as_array().unwrap().len(), 2);
}

#[test]
fn a_torn_log_loses_its_last_block_only() {
    let file = study("schooling.toml");
    let whole = fresh("torn-whole");
    run(&file, &whole, &["--set", "time.duration=300"]);
    let torn = fresh("torn");
    let mut child = flockworks()
        .args(["run", &file, "--out", torn.to_str().unwrap(), "--set", "time.duration=300"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let log = torn.join("unfinished.log");
    while std::fs::metadata(&log).map_or(0, |m| m.len()) < 1_200_000 && child.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let bytes = std::fs::read(&log).unwrap();
    std::fs::write(&log, &bytes[..bytes.len() - 40]).unwrap();
    run(&file, &torn, &["--set", "time.duration=300"]);
    assert_eq!(results(&whole), results(&torn));
}

#[test]
fn the_folder_of_another_run_is_refused_with_the_difference() {
    let out = fresh("other");
    let file = study("gallery/corral.toml");
    run(&file, &out, &["--quick"]);
    let before = results(&out);
    let other = ran(&["run", &file, "--quick", "--out", out.to_str().unwrap(), "--set", "group.flock.count=14"]);
    assert_eq!(other.status.code(), Some(2));
    assert!(text(&other.stderr).contains("group.flock.count: 15 there, 14 now"), "{}", text(&other.stderr));
    let seed = ran(&["run", &file, "--quick", "--out", out.to_str().unwrap(), "--seed", "9"]);
    let there = format!("seed: {} there, 9 now", manifest(&out)["seed"]);
    assert!(text(&seed.stderr).contains(&there), "{}", text(&seed.stderr));
    assert_eq!(before, results(&out), "nothing changed");
    let foreign = fresh("foreign");
    std::fs::create_dir_all(&foreign).unwrap();
    std::fs::write(foreign.join("thesis.txt"), "mine").unwrap();
    let refused = ran(&["run", &file, "--out", foreign.to_str().unwrap()]);
    assert_eq!(refused.status.code(), Some(2));
    assert_eq!(std::fs::read_to_string(foreign.join("thesis.txt")).unwrap(), "mine");
}

#[test]
fn a_seed_that_was_not_given_is_told_and_kept() {
    let file = fresh("seedless.toml");
    let source = std::fs::read_to_string(study("gallery/corral.toml")).unwrap();
    let lines: Vec<&str> = source.lines().filter(|line| !line.starts_with("seed = ")).collect();
    std::fs::write(&file, lines.join("\n")).unwrap();
    let (one, two) = (fresh("seedless-1"), fresh("seedless-2"));
    let first = run(file.to_str().unwrap(), &one, &[]);
    let seed = manifest(&one)["seed"].as_u64().unwrap().to_string();
    assert!(text(&first.stderr).contains(&format!("seed {seed}")));
    assert_eq!(manifest(&one)["seed_given"], false);
    run(file.to_str().unwrap(), &two, &["--seed", &seed]);
    assert_eq!(results(&one)[0].1.len(), results(&two)[0].1.len());
    assert_eq!(results(&one), results(&two));
}

/// The problems that a change of a shipped file leads to.
fn problems(file: &str, from: &str, to: &str) -> String {
    let source = std::fs::read_to_string(study(file)).unwrap();
    assert!(source.contains(from), "{file} has no `{from}`");
    let mut name = String::from("bad");
    name.extend((file.to_owned() + from + to).chars().filter(|c| c.is_alphanumeric()));
    name.truncate(80);
    let path = fresh(&format!("{name}.toml"));
    std::fs::write(&path, source.replacen(from, to, 1)).unwrap();
    let run = ran(&["check", path.to_str().unwrap()]);
    assert_eq!(run.status.code(), Some(2), "`{to}` must be refused: {}", text(&run.stdout));
    assert!(run.stdout.is_empty());
    text(&run.stderr)
}

#[test]
fn what_is_wrong_in_a_file_is_shown_at_its_place() {
    let cases: &[(&str, &str, &str, &[&str])] = &[
        (
            "schooling.toml",
            "duration = 600",
            "duraton = 600",
            &["unknown key `duraton`", "did you mean `duration`?", "^^^"],
        ),
        ("schooling.toml", "duration = 600", "duration = 0x", &["not TOML"]),
        ("schooling.toml", "duration = 600", "duration = -1", &["`duration` must be 0 or more", "-1"]),
        ("schooling.toml", "duration = 600", "duration = inf", &["`duration` must be 0 or more", "inf"]),
        ("schooling.toml", "duration = 600", "duration = 600.05", &["no multiple of the step of 0.1", "600.1"]),
        ("schooling.toml", "duration = 600", "duration = 600\nstep = 0", &["`step` must be more than 0"]),
        ("schooling.toml", "size = 335", "size = 0", &["`size` must be more than 0"]),
        ("schooling.toml", "size = 335", "size = [335, 335]", &["2 entries for 3 axes"]),
        ("schooling.toml", "size = 335\n", "\n", &["axis 0 ends"]),
        ("schooling.toml", "count = 200", "count = -200", &["`count`", "-200"]),
        ("schooling.toml", "count = 200", "count = 2.5", &["takes a whole number, found 2.5"]),
        ("schooling.toml", "count = 200", "count = \"many\"", &["takes a whole number, found \"many\""]),
        ("schooling.toml", "count = 200", "count = 9000", &["found a place", "too little room"]),
        ("schooling.toml", "spacing = 2", "spacing = nan", &["`spacing` must be 0 or more, found NaN"]),
        (
            "schooling.toml",
            "considered = 0",
            "considred = 0",
            &["no parameter `considred`", "did you mean `considered`?"],
        ),
        ("schooling.toml", "\"logistic\"", "\"logistik\"", &["takes one of", "\"logistik\""]),
        (
            "schooling.toml",
            "behaviour_selection]",
            "behavior_selection]",
            &["unknown model `behavior_selection`", "did you mean `behaviour_selection`?"],
        ),
        ("schooling.toml", "dimensions = 3", "dimensions = 4", &["`dimensions` must be from 1 to 3"]),
        ("schooling.toml", "dimensions = 3", "dimensions = 2", &["works in 3 dimensions, not in 2"]),
        ("schooling.toml", "\"expanse\"", "\"expense\"", &["unknown metric `expense`", "did you mean `expanse`?"]),
        ("schooling.toml", "linking_distance", "linkage", &["no measured metric has a parameter `linkage`"]),
        (
            "schooling.toml",
            "kind = \"scenario\"",
            "kind = \"scenarios\"",
            &["no kind of file is called \"scenarios\"", "did you mean"],
        ),
        ("schooling.toml", "kind = \"scenario\"\n", "\n", &["does not say what it is"]),
        ("schooling.toml", "count = 120", "count = 120\npercent = 2", &["both say how many"]),
        ("schooling.toml", "count = 120", "percent = 50", &["too dense"]),
        (
            "gallery/mill.toml",
            "place.ball = { centre = [0, 0], radius = 6 }",
            "place = \"anywhere\"",
            &["which is open"],
        ),
        (
            "gallery/mill.toml",
            "noise_deviation = 3",
            "noise_deviation = -3",
            &["`noise_deviation` must be 0 or more, found -3"],
        ),
        ("gallery/bottleneck.toml", "normal = [1.34, 0.26]", "normal = [1.34, -1]", &["standard deviation"]),
        ("gallery/bottleneck.toml", "normal = [1.34, 0.26]", "gauss = [1, 1]", &["no choice `gauss`"]),
        (
            "gallery/bottleneck.toml",
            "low = [12, 0], high = [12.4, 4.4]",
            "low = [13, 0], high = [12.4, 4.4]",
            &["low corner must not exceed"],
        ),
        ("gallery/foraging.toml", "health = { amount", "helth = { amount", &["column `helth`"]),
        ("gallery/laser_robots.toml", "association = 0.3\n", "\n", &["association"]),
        ("gallery/laser_robots.toml", "length = \"m\"", "length = \"cm\"", &["metres"]),
        (
            "gallery/laser_robots.toml",
            "driver.asynchronous = { tick = 0.01",
            "driver.asynchronous = { tick = 0",
            &["`tick` must be more than 0"],
        ),
        (
            "gallery/starlings.toml",
            "neighbour_count = 7",
            "neighbour_count = 7\nk = 7",
            &["given already", "given twice"],
        ),
        ("gallery/starlings.toml", "step = 0.1", "step = 0.1\nstep = 0.2", &["not TOML"]),
        ("schooling.toml", "spacing = 2", "spacing = 1e308", &["`spacing` must be from -1e15 to 1e15, found 1e308"]),
        (
            "gallery/starlings.toml",
            "neighbour_count = 7",
            "neighbour_count = 1e308",
            &["`neighbour_count`", "found 1e308"],
        ),
        ("gallery/bottleneck.toml", "normal = [1.34, 0.26]", "normal = [1.34, 1e20]", &["1e20"]),
        (
            "gallery/foraging.toml",
            "chromosome = [1, 30, 1, 10, 0.025, 1,",
            "chromosome = [1, 30, 1, 10, 0.025, {},",
            &["`chromosome` takes a list", "found a table in it"],
        ),
    ];
    for (file, from, to, parts) in cases {
        let shown = problems(file, from, to);
        for part in *parts {
            assert!(shown.contains(part), "`{part}` is not in:\n{shown}");
        }
        assert!(shown.contains(".toml:"), "it names the place:\n{shown}");
        assert!(!shown.contains("backtrace") && !shown.contains("panicked"));
    }
}

/// A scenario with whatever can be wrong in one line of it.
const SMALL: &str = r#"
kind = "scenario"
title = "Small"
units = { length = "m", time = "s" }
[time]
duration = 20
step = 0.1
[space]
dimensions = 2
edges = "walls"
size = 25
[[obstacle]]
shape.ball = { centre = [12, 12], radius = 2 }
[group.fish]
count = 3
model.couzin_2002 = { speed = 0.5 }
start = { place = { points = [[5, 5], [6, 6], [7, 7]] } }
physics = { radius = 0.25, contact = "slide" }
[group.others]
count = 1
model = { vicsek_1995 = { radius = 1 } }
start = { place = { points = [[20, 20]] } }
physics = { radius = 0.25, contact = "refuse" }
[record]
interval = 1
[measure]
metrics = ["polarisation", "group_count"]
parameters = { linking_distance = 1 }
interval = 1
"#;

/// What `check` says of it, with a line changed, and its exit code.
fn small(name: &str, from: &str, to: &str) -> (Option<i32>, String) {
    assert_eq!(SMALL.matches(from).count(), 1, "`{from}`");
    let path = fresh(&format!("small-{name}.toml"));
    std::fs::write(&path, SMALL.replace(from, to)).unwrap();
    let run = ran(&["check", path.to_str().unwrap()]);
    (run.status.code(), text(&run.stderr))
}

#[test]
fn bodies_cannot_begin_in_walls_obstacles_or_each_other() {
    let refused = [
        ("[7, 7]", "[12, 13]", "`obstacle.0`", "[12, 13]"),
        ("[7, 7]", "[9.8, 12]", "`obstacle.0`", "[9.8, 12]"),
        ("[7, 7]", "[7, 0.2]", "into a wall here, on axis 1", "[7, 0.2]"),
        ("[7, 7]", "[5, 5.4]", "overlap that of member 0", "[5, 5.4]"),
        ("[7, 7]", "[6, 6]", "overlap that of member 1: 0 apart", "[6, 6]"),
        ("[20, 20]", "[7.3, 7]", "member 2 of `fish`", "[7.3, 7]"),
    ];
    for (number, (from, to, what, at)) in refused.into_iter().enumerate() {
        let (code, told) = small(&format!("body-{number}"), from, to);
        assert_eq!(code, Some(2), "{to}");
        let carets = format!("{} no room for a body", "^".repeat(at.len()));
        assert!(told.contains(what) && told.contains(&carets), "{told}");
    }
    // who only touches, and who may be anywhere
    let fine = [
        ("[7, 7]", "[5, 5.5]"),
        ("[7, 7]", "[7, 0.25]"),
        ("contact = \"slide\"", "contact = \"free\""),
        ("[[5, 5], [6, 6], [7, 7]] }", "[[5, 5], [5, 5.1], [12, 12]] }, jitter = 0.1"),
    ];
    for (number, (from, to)) in fine.into_iter().enumerate() {
        let (code, told) = small(&format!("fine-{number}"), from, to);
        assert_eq!(code, Some(0), "{to}: {told}");
    }
}

#[test]
fn what_would_have_no_effect_is_refused() {
    for (number, (from, to, parts)) in [
        (
            "interval = 1\n[measure]",
            "interval = 30\n[measure]",
            ["`record.interval` is 30, longer than the run", "at most 20"],
        ),
        (
            "count = 1\n",
            "count = 1\nselect = { neighbours = { k_nearest = 0 } }\n",
            ["`k_nearest` must be more than 0", "^ "],
        ),
        (
            "count = 1\n",
            "count = 1\nsensing = { laser = { detection = \"sensor_based\", association = 1, front_step = 2000 } }\n",
            ["the step along the heading (2000) is none of the 1024 of a turn", "^^^^ not possible"],
        ),
        (
            "count = 1\n",
            "count = 1\nsensing.laser = { detection.clustered = { least_width = 2 }, association = 1 }\n",
            ["the least width (2) is above the greatest (0.5)", "^ not possible"],
        ),
        (
            "count = 1\n",
            "count = 1\nsensing.laser = { detection.member_based = { least_readings = 5000 }, association = 1 }\n",
            ["the 682 rays never give 5000 readings", "^^^^ not possible"],
        ),
        ("duration = 20", "duration = 1e-9", ["shorter than a step of 0.1", "at least one step"]),
        (
            "place = { points = [[5, 5], [6, 6], [7, 7]] }",
            "place.lattice = { centre = [5, 5], spacing = 0.4 }",
            ["overlap", "^"],
        ),
        ("[7, 7]", "[7, 26]", ["26 lies outside the space", "^^ a place inside"]),
        (
            "\"group_count\"",
            "\"kth_neighbour_distance\"",
            ["no measured metric has a parameter `linking_distance`", "^^^^"],
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let (code, told) = small(&format!("effect-{number}"), from, to);
        assert_eq!(code, Some(2), "{to}");
        assert!(parts.iter().all(|part| told.contains(part)), "{parts:?} not in {told}");
    }
    let (code, told) =
        small("measure", "linking_distance = 1 }\ninterval = 1", "linking_distance = 1 }\ninterval = 20.1");
    assert_eq!(code, Some(2));
    assert!(told.contains("`measure.interval` is 20.1") && told.contains("^^^^^^^^ at most 20"), "at the key: {told}");
    // a run of no time shows how it begins
    assert_eq!(small("no-time", "duration = 20", "duration = 0").0, Some(0));
}

#[test]
fn carets_stand_at_what_is_wrong() {
    let with = |text: &str| format!("count = 1\n{text}");
    for (number, (from, to, marked, what)) in [
        (
            "linking_distance = 1 }",
            "linkin_distance = 1 }".to_owned(),
            "linkin_distance",
            "did you mean `linking_distance`?",
        ),
        ("linking_distance = 1 }", "foo = 1 }".to_owned(), "foo", "those that are measured take linking_distance"),
        ("linking_distance = 1 }", "eps = 1 }".to_owned(), "eps", "it is a parameter of dbscan_"),
        (
            "radius = 0.25, contact = \"slide\"",
            "radius = 0.25, length = 0.1".to_owned(),
            "0.1",
            "length: an elongated body",
        ),
        (
            "radius = 0.25, contact = \"slide\"",
            "radius = 0.25, mobility = { turn_limited = { rate = 1, vertical = 2 } }".to_owned(),
            "2",
            "a vertical turn rate needs three dimensions",
        ),
        (
            "count = 1\n",
            with("select = { neighbors = { k_nearest = 1 } }\n"),
            "neighbors",
            "did you mean `neighbours`?",
        ),
        ("[[20, 20]] }", "[[20, 20]] }, state = { foo = 1 }".to_owned(), "foo", "no column `foo`"),
        ("{ radius = 1 }", "{ radius = 1, time_step = 2 }".to_owned(), "time_step", "given here and as time.step"),
        ("[time]\nduration = 20\nstep = 0.1", "time = { step = 0.1 }".to_owned(), "time", "`duration` is missing"),
        (
            "step = 0.1",
            "step = 0.1\ndriver = { asynchronous = { delay = 1e6 } }".to_owned(),
            "1e6",
            "delay of readings",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let (code, told) = small(&format!("caret-{number}"), from, &to);
        assert_eq!(code, Some(2), "{to}");
        assert!(told.contains(what), "`{what}` not in {told}");
        // the line that is shown, and the carets below it
        let mut lines =
            told.lines().skip_while(|line| !line.contains(" | ")).map(|line| line.split_once('|').unwrap().1);
        let (line, below) = (lines.next().unwrap(), lines.next().unwrap());
        let carets: String =
            line.chars().zip(below.chars()).filter(|(_, mark)| *mark == '^').map(|(shown, _)| shown).collect();
        assert_eq!(carets, marked, "{told}");
    }
}

#[test]
fn the_readme_shows_what_the_program_says() {
    let folder = fresh("readme");
    std::fs::create_dir_all(&folder).unwrap();
    let template = text(&ran(&["new", "scenario"]).stdout);
    assert!(template.contains("\nduration = 200"));
    std::fs::write(folder.join("flock.toml"), template.replace("\nduration = 200", "\nduraton = 200")).unwrap();
    let run = flockworks().current_dir(&folder).args(["check", "flock.toml"]).output().unwrap();
    assert_eq!(run.status.code(), Some(2));
    let told: String =
        text(&run.stderr).lines().map(|line| format!("    {line}").trim_end().to_owned() + "\n").collect();
    let readme = std::fs::read_to_string(format!("{}/../../README.md", env!("CARGO_MANIFEST_DIR"))).unwrap();
    assert!(readme.contains(&told), "the README does not show:\n{told}");
}

#[test]
fn a_complete_run_that_lacks_a_table_is_told_from_a_whole_one() {
    let out = fresh("lacking");
    let file = study("gallery/corral.toml");
    run(&file, &out, &["--quick"]);
    let folder = out.to_str().unwrap();
    let again = || ran(&["run", &file, "--quick", "--out", folder]);
    assert_eq!(again().status.code(), Some(0));
    for name in ["trajectory.parquet", "metrics.parquet", "events.parquet", "obstacles.parquet", "keyframes.log"] {
        let bytes = std::fs::read(out.join(name)).unwrap();
        std::fs::remove_file(out.join(name)).unwrap();
        let refused = again();
        assert_eq!(refused.status.code(), Some(2), "{name}");
        let told = text(&refused.stderr);
        assert!(told.contains(name) && told.contains("remove the folder to run anew"), "{told}");
        std::fs::write(out.join(name), bytes).unwrap();
        assert_eq!(again().status.code(), Some(0), "{name}");
    }
    std::fs::remove_file(out.join("report.html")).unwrap();
    assert!(text(&again().stderr).contains("`flockworks report "), "{}", text(&again().stderr));
    assert_eq!(ran(&["report", folder]).status.code(), Some(0));
    assert_eq!(again().status.code(), Some(0));
    // a run without positions lacks none
    let out = fresh("lacking-none");
    for _ in 0..2 {
        run(&file, &out, &["--quick", "--set", "record.trajectory=false"]);
    }
}

#[test]
fn all_problems_of_a_file_are_shown_at_once() {
    let path = fresh("many.toml");
    let source = std::fs::read_to_string(study("schooling.toml")).unwrap();
    let source = source
        .replace("duration = 600", "duraton = 1")
        .replace("size = 335", "size = -1")
        .replace("count = 200", "count = \"x\"");
    std::fs::write(&path, source).unwrap();
    let shown = text(&ran(&["check", path.to_str().unwrap()]).stderr);
    for part in ["duraton", "`duration` is missing", "`size` must be", "takes a whole number", "4 problems"] {
        assert!(shown.contains(part), "`{part}` is not in:\n{shown}");
    }
}

#[test]
fn wrong_settings_are_refused() {
    let file = study("gallery/corral.toml");
    for (set, part) in [
        (&["group.flock.count=10", "group.flock.count=11"][..], "`--set group.flock.count=10` sets it already"),
        (&["group.flock.count=10", "group.flock={ count = 3 }"], "contradicts `group.flock.count`"),
        (&["group.flock={ count = 3 }", "group.flock.count=10"], "lies within `group.flock`"),
        (&["time.duration=10", "time.duration.more=10"], "contradicts `time.duration`"),
        (&["group.flock.count=[1"], "unclosed array"),
        (&["flock.count=10"], "unknown key `flock`"),
        (&["group.flock.coutn=10"], "did you mean `count`?"),
        (&["group.flock.count"], "has no `=`"),
        (&["group.flock.count="], "not a value"),
        (&["obstacle.9.opaque=false"], "count from 0"),
    ] {
        let sets: Vec<&str> = set.iter().flat_map(|set| ["--set", *set]).collect();
        let run = ran(&[&["check", &file], &sets[..]].concat());
        assert_eq!(run.status.code(), Some(2), "{set:?}");
        assert!(text(&run.stderr).contains(part), "{set:?}: {}", text(&run.stderr));
        let consequences = text(&run.stderr).contains("problems");
        assert!(!consequences, "one mistake, one problem: {set:?}: {}", text(&run.stderr));
    }
    for (arguments, part) in [
        (&["--threads", "0"][..], "from 1 to 1024, found 0"),
        (&["--threads", "100000"], "from 1 to 1024, found 100000"),
        (&["--seed", "-1"], ""),
        (&["--seed", "18446744073709551615"], "below 2^63"),
        (&["--seed", "3", "--set", "seed=4"], "`--seed 3` and `--set seed=4` both give the seed"),
        (&["--nothing"], ""),
        (&["--out", &file], "is no folder"),
    ] {
        let run = ran(&[&["run", &file], arguments].concat());
        assert_eq!(run.status.code(), Some(2), "{arguments:?}");
        assert!(text(&run.stderr).contains(part), "{arguments:?}: {}", text(&run.stderr));
        assert!(run.stdout.is_empty(), "nothing ran: {arguments:?}");
    }
}

#[test]
fn damaged_copies_of_the_shipped_files_never_panic() {
    // every file, cut at many places, and with characters changed: refused or accepted, never our fault
    for (number, file) in shipped().into_iter().enumerate() {
        let source = std::fs::read(&file).unwrap();
        let mut damaged = Vec::new();
        for k in 1..8 {
            damaged.push(source[..source.len() * k / 8 - k].to_vec());
            let mut changed = source.clone();
            let at = (k * 7919 + number * 104_729) % changed.len();
            changed[at] = b"]=\"\n0-}"[k - 1];
            damaged.push(changed);
        }
        let paths: Vec<String> = damaged
            .iter()
            .enumerate()
            .map(|(k, bytes)| {
                let path = fresh(&format!("damaged-{number}-{k}.toml"));
                std::fs::write(&path, bytes).unwrap();
                path.to_str().unwrap().to_owned()
            })
            .collect();
        let mut arguments = vec!["check"];
        arguments.extend(paths.iter().map(String::as_str));
        let run = ran(&arguments);
        assert_eq!(run.status.code(), Some(2), "{file}: {}", text(&run.stderr));
        assert!(!text(&run.stderr).contains("our fault"), "{}", text(&run.stderr));
    }
}

#[test]
fn damaged_folders_are_told_from_whole_ones() {
    let out = fresh("damaged-folder");
    let file = study("gallery/corral.toml");
    run(&file, &out, &["--quick"]);
    let folder = out.to_str().unwrap();
    let table = std::fs::read(out.join("metrics.parquet")).unwrap();
    for bytes in [&table[..table.len() / 2], &[], b"PAR1PAR1"] {
        std::fs::write(out.join("metrics.parquet"), bytes).unwrap();
        let report = ran(&["report", folder]);
        assert_eq!(report.status.code(), Some(2), "{}", text(&report.stderr));
        assert!(text(&report.stderr).contains("metrics.parquet"), "{}", text(&report.stderr));
    }
    std::fs::write(out.join("metrics.parquet"), &table).unwrap();
    let page = std::fs::read(out.join("report.html")).unwrap();
    std::fs::remove_file(out.join("report.html")).unwrap();
    assert_eq!(ran(&["report", folder]).status.code(), Some(0));
    assert_eq!(std::fs::read(out.join("report.html")).unwrap(), page, "the same page");
    std::fs::write(out.join("manifest.json"), "{}").unwrap();
    assert_eq!(ran(&["report", folder]).status.code(), Some(2));
    assert_eq!(ran(&["report", fresh("nowhere").to_str().unwrap()]).status.code(), Some(2));
}

#[test]
fn tables_can_be_had_as_csv() {
    let out = fresh("csv");
    run(&study("gallery/foraging.toml"), &out, &[]);
    let csv = fresh("csv-out");
    let export = ran(&["export", out.to_str().unwrap(), "--to", "csv", "--out", csv.to_str().unwrap()]);
    assert_eq!(export.status.code(), Some(0), "{}", text(&export.stderr));
    let trajectory = std::fs::read_to_string(csv.join("trajectory.csv")).unwrap();
    let mut lines = trajectory.lines();
    assert_eq!(lines.next().unwrap(), "run,frame,t,id,group,x,y,vx,vy,flock,health,energy");
    assert_eq!(lines.clone().count(), 100 * 81);
    assert!(lines.next().unwrap().starts_with("0,0,0,0,regular,"));
    let events = std::fs::read_to_string(csv.join("events.csv")).unwrap();
    assert!(events.lines().nth(1).unwrap().contains(",ate,"), "somebody eats");
    let metrics = std::fs::read_to_string(csv.join("metrics.csv")).unwrap();
    assert!(metrics.starts_with("run,step,t,group,members,mean_speed,"));
    assert_eq!(metrics.lines().count(), 1 + 3 * 81, "two groups and everyone together");
}

#[test]
fn what_new_writes_runs_and_all_it_offers_is_known() {
    let template = text(&ran(&["new", "scenario"]).stdout);
    let file = fresh("template.toml");
    std::fs::write(&file, &template).unwrap();
    run(file.to_str().unwrap(), &fresh("template"), &["--quick"]);
    // every offered line is taken up: a paragraph of them at a time
    for paragraph in template.split("\n\n").filter(|paragraph| paragraph.contains("#: ")) {
        let with = template.replace(paragraph, &paragraph.replace("#: ", ""));
        std::fs::write(&file, with).unwrap();
        let check = ran(&["check", file.to_str().unwrap()]);
        assert_eq!(check.status.code(), Some(0), "{paragraph}\n{}", text(&check.stderr));
    }
    assert_eq!(ran(&["new", "novel"]).status.code(), Some(2));
}

#[test]
fn schema_metrics_completions_and_man_pages() {
    let schema: serde_json::Value = serde_json::from_str(&text(&ran(&["schema", "scenario"]).stdout)).unwrap();
    let keys = schema["$defs"]["Scenario"]["properties"].as_object().unwrap();
    assert!(keys.contains_key("group") && keys.contains_key("measure"));
    let models = schema["$defs"]["Model"]["oneOf"].as_array().unwrap();
    assert!(models.len() > 20);
    let metrics = text(&ran(&["metrics"]).stdout);
    assert!(
        metrics.contains("polarisation") && metrics.contains("metrics of a frame") && metrics.contains("leadership")
    );
    let one = text(&ran(&["metrics", "group_count"]).stdout);
    assert!(one.contains("linking_distance = 25") && one.contains("Source"));
    let over_time = text(&ran(&["metrics", "leadership"]).stdout);
    assert!(over_time.contains("max_lag = (to be given) s") && over_time.contains("delay (s)"));
    assert_eq!(ran(&["metrics", "polarization"]).status.code(), Some(2));
    for shell in ["bash", "zsh", "fish"] {
        assert!(text(&ran(&["completions", shell]).stdout).contains("conformance"), "{shell}");
    }
    let man = fresh("man");
    assert_eq!(ran(&["man", man.to_str().unwrap()]).status.code(), Some(0));
    assert!(man.join("flockworks-run.1").exists());
}

#[test]
fn the_page_shows_how_a_turn_passes_where_members_meet_an_obstacle() {
    let folder = fresh("turns");
    run(&study("behaviour-selection/obstacle.toml"), &folder, &["--set", "time.duration=12"]);
    let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(page.contains("Change of heading of every member"));
    let told: u32 = page
        .split_once("Member ")
        .and_then(|(_, rest)| rest.split_once(" is the first that has an obstacle"))
        .map(|(id, _)| id.parse().unwrap())
        .unwrap();
    // who it is according to the table
    assert!(ran(&["export", folder.to_str().unwrap(), "--to", "csv"]).status.success());
    let table = std::fs::read_to_string(folder.join("trajectory.csv")).unwrap();
    let mut rows = table.lines().map(|line| line.split(',').collect::<Vec<&str>>());
    let names = rows.next().unwrap();
    let column = |name: &str| names.iter().position(|other| *other == name).unwrap();
    let (id, met) = (column("id"), column("o_avoid"));
    let first = rows.find(|row| row[met].parse::<f64>().unwrap() > 0.0).unwrap();
    assert_eq!(first[id].parse::<u32>().unwrap(), told);
    // where nothing stands in the way, there is no such figure
    let folder = fresh("no_turns");
    run(&study("gallery/tank.toml"), &folder, &["--set", "time.duration=5"]);
    assert!(
        !std::fs::read_to_string(folder.join("report.html")).unwrap().contains("Change of heading of every member")
    );
}

#[test]
fn bodies_of_any_scenario_may_be_elongated() {
    let file = study("gallery/tank.toml");
    let made = |name: &str, more: &[&str]| {
        let folder = fresh(name);
        run(&file, &folder, &[&["--seed", "4", "--set", "time.duration=20"], more].concat());
        results(&folder)
    };
    let long = ["--set", "group.fish.physics.length=8"];
    let one = made("elongated_1", &[&long[..], &["--threads", "1"]].concat());
    assert!(one == made("elongated_2", &[&long[..], &["--threads", "2"]].concat()), "threads change bytes");
    assert!(one != made("round", &[]), "long bodies are like round ones");
    let wrong = ran(&["check", &file, "--set", "group.fish.physics.length=1"]);
    assert_eq!(wrong.status.code(), Some(2));
    let told = text(&wrong.stderr);
    assert!(told.contains("from 2 to 66; found 1") && told.contains("--set:1:1"), "{told}");
}

#[test]
fn recording_changes_no_result() {
    let file = study("gallery/mill.toml");
    let (much, little) = (fresh("record-much"), fresh("record-little"));
    run(&file, &much, &["--set", "record.interval=0.1"]);
    run(&file, &little, &["--set", "record.trajectory=false", "--set", "measure.interval=1"]);
    assert!(!little.join("trajectory.parquet").exists());
    let csv = |folder: &Path| {
        assert_eq!(ran(&["export", folder.to_str().unwrap(), "--to", "csv"]).status.code(), Some(0));
        std::fs::read_to_string(folder.join("metrics.csv")).unwrap()
    };
    let (much, little) = (csv(&much), csv(&little));
    let every_tenth: Vec<&str> = much.lines().take(1).chain(much.lines().skip(1).step_by(10)).collect();
    assert_eq!(every_tenth, little.lines().collect::<Vec<_>>());
}
