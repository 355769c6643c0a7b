//! Evolutions through the program itself: the template, threads, stopping and going on, a shared world, mistakes.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("flockworks-evolution-{}-{name}", std::process::id()));
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

/// What an evolution made, without what may differ between equal ones.
fn tables(folder: &Path) -> Vec<Vec<u8>> {
    ["generations.parquet", "candidates.parquet", "champions.parquet", "champion.toml"]
        .iter()
        .map(|name| std::fs::read(folder.join(name)).unwrap())
        .collect()
}

/// Two small flocks and one supply of food; each candidate owns two members.
const SHARED: &str = r#"
kind = "evolution"
title = "Small flocks"
seed = 5
runs = 2
generations = 6
fitness = "health + sum(health[group = red]) - 0.15 * sum(health[group = blue])"
confirm = 2

[shared]
group = "red"
members = 2

[gene.c]
path = "group.red.model.competing_flocks.chromosome"
relative = true
low = 0.001
high = 1000
start = [0, 2]

[search.genetic]
selection = "stochastic_universal"
mutation_rate = 0.5

[keep]
meals = "sum(meals[group = red])"

[scenario]
time.duration = 30
[scenario.space]
dimensions = 2
edges = "walls"
size = 80
[scenario.food]
count = 5
within = 5
gains = { energy = { amount = 40, capacity = 100 }, health = { amount = 10, capacity = 100 } }
respawn.after = 0
metabolism = { cost = 4 }
[scenario.group.red]
count = 8
model.competing_flocks = { flock = 0 }
[scenario.group.blue]
count = 8
model.competing_flocks = { flock = 1 }
"#;

#[test]
fn the_template_runs_and_its_champion_is_a_scenario() {
    let folder = folder("template");
    let template = done(&folder, &["new", "evolution"]);
    std::fs::write(folder.join("milling.toml"), template).unwrap();
    done(&folder, &["check", "milling.toml"]);
    done(&folder, &["run", "milling.toml", "--quick", "--threads", "1", "--out", "one"]);
    done(&folder, &["run", "milling.toml", "--quick", "--threads", "3", "--out", "three"]);
    assert_eq!(tables(&folder.join("one")), tables(&folder.join("three")), "threads change nothing");
    done(&folder, &["check", "one/champion.toml"]);
    let page = std::fs::read_to_string(folder.join("one/report.html")).unwrap();
    assert!(page.contains("Best fitness of a generation"));
    done(&folder, &["report", "one"]);
}

#[test]
fn a_shared_world_goes_on_as_if_it_had_never_stopped() {
    let folder = folder("shared");
    std::fs::write(folder.join("flocks.toml"), SHARED).unwrap();
    done(&folder, &["run", "flocks.toml", "--out", "whole", "--threads", "2"]);
    // generations may be added: what is there is kept
    done(&folder, &["run", "flocks.toml", "--out", "parts", "--set", "generations=2", "--threads", "1"]);
    done(&folder, &["run", "flocks.toml", "--out", "parts", "--set", "generations=5", "--threads", "3"]);
    done(&folder, &["run", "flocks.toml", "--out", "parts"]);
    assert_eq!(tables(&folder.join("whole")), tables(&folder.join("parts")));
    // a log cut anywhere loses the record in work
    let log = folder.join("whole/generations.log");
    let bytes = std::fs::read(&log).unwrap();
    for cut in [bytes.len() / 3, bytes.len() / 2 + 1, bytes.len() - 1] {
        let again = folder.join("again");
        let _ = std::fs::remove_dir_all(&again);
        std::fs::create_dir(&again).unwrap();
        std::fs::copy(folder.join("whole/manifest.json"), again.join("manifest.json")).unwrap();
        std::fs::write(again.join("generations.log"), &bytes[..cut]).unwrap();
        done(&folder, &["run", "flocks.toml", "--out", "again"]);
        assert_eq!(tables(&folder.join("whole")), tables(&again), "cut at {cut}");
    }
    // anything else that changes is refused
    let refused = flockworks(&folder, &["run", "flocks.toml", "--out", "whole", "--set", "search.genetic.elite=1"]);
    let text = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{text}");
    assert!(text.contains("elite"), "{text}");
}

#[test]
fn a_killed_evolution_goes_on_to_the_same_history() {
    let folder = folder("killed");
    std::fs::write(folder.join("flocks.toml"), SHARED).unwrap();
    let run = |out: &str, threads: &str| {
        done(&folder, &["run", "flocks.toml", "--out", out, "--set", "generations=80", "--threads", threads]);
    };
    run("whole", "2");
    let log = folder.join("killed/generations.log");
    let length = || log.metadata().map_or(0, |file| file.len());
    let whole = folder.join("whole/generations.log").metadata().unwrap().len();
    // killed as soon as something more is written, several times over
    for share in [20, 5, 2] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_flockworks"))
            .current_dir(&folder)
            .args(["run", "flocks.toml", "--out", "killed", "--set", "generations=80", "--threads", "1"])
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        while length() < whole / share && child.try_wait().unwrap().is_none() {
            std::thread::yield_now();
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(length() > 0, "nothing was kept");
    run("killed", "3");
    assert_eq!(tables(&folder.join("whole")), tables(&folder.join("killed")));
}

#[test]
fn other_searches_run_and_go_on() {
    let folder = folder("searches");
    let template = done(&folder, &["new", "evolution"]);
    let from = template.find("[search.genetic]").unwrap();
    let to = from + template[from..].find("\n# The scenario").unwrap();
    for (name, search) in [
        ("cma", "search.cma_es = { candidates = 4 }"),
        (
            "elites",
            "search.map_elites = { candidates = 4, cells = 9, random_generations = 1, kind.width = { of = \"attraction\", low = 1, high = 14 } }",
        ),
    ] {
        // a key of the top level stands before the tables
        let text = format!("{search}\n{}{}", &template[..from], &template[to..]);
        std::fs::write(folder.join("other.toml"), text).unwrap();
        let set = |generations: &str| format!("generations={generations}");
        let (whole, part) = (format!("{name}-whole"), format!("{name}-parts"));
        let run = |out: &str, generations: &str| {
            let set = set(generations);
            done(&folder, &["run", "other.toml", "--out", out, "--set", "trials=1", "--set", "runs=1", "--set", &set]);
        };
        run(&whole, "4");
        run(&part, "1");
        run(&part, "4");
        assert_eq!(tables(&folder.join(whole)), tables(&folder.join(part)), "{name}");
    }
}

/// What is asked of `SHARED`: two ways of selection, a contest, questions.
const ASKED: &str = r#"
kind = "evolution"
title = "Asked"
extends = "flocks.toml"

[follow]
cohesion = "c_0 * c_0 / c_1"

[vary.selection]
path = "search.genetic.selection"
values = ["rank", "roulette"]

[contest]
worlds = 3
single = [0.5, 2]
random = 6
chosen_in = 2
without.no_avoidance = ["c_10"]

[[contest.test]]
y = "fitness"
between = "who"

[[figure]]
title = "The end"
y = ["end", "cohesion_end", "margin"]
x = "selection"

[[claim]]
id = "alive"
text = "Somebody eats"
number = "meals_end"
holds = "all(meals_end > 0)"

[[claim]]
id = "same"
text = "A contender has one fitness"
strength = "A"
number = "contest.fitness[who = champion, selection = rank] - contest.fitness[who = champion, selection = rank]"
holds = "contest.fitness[who = single, selection = rank] == contest.fitness[who = single, selection = rank] + 1"
"#;

#[test]
fn variants_and_contests_are_the_same_however_they_came_about() {
    let folder = folder("asked");
    std::fs::write(folder.join("flocks.toml"), SHARED).unwrap();
    std::fs::write(folder.join("asked.toml"), ASKED).unwrap();
    let told = done(&folder, &["check", "asked.toml"]);
    assert!(told.contains("2 variants of 2 runs"), "{told}");
    let told = done(&folder, &["run", "asked.toml", "--out", "whole", "--threads", "3"]);
    assert!(told.contains("holds            runs.alive: Somebody eats"), "{told}");
    assert!(told.contains("does not hold    runs.same: "), "{told}");
    done(&folder, &["run", "asked.toml", "--out", "parts", "--threads", "1", "--set", "generations=2"]);
    done(&folder, &["run", "asked.toml", "--out", "parts", "--threads", "1"]);
    let contest = |name: &str| std::fs::read(folder.join(name).join("contest.parquet")).unwrap();
    assert_eq!(tables(&folder.join("whole")), tables(&folder.join("parts")));
    assert_eq!(contest("whole"), contest("parts"));
    // a contest cut off in the middle is gone on with
    let log = folder.join("whole/generations.log");
    let bytes = std::fs::read(&log).unwrap();
    std::fs::write(&log, &bytes[..bytes.len() - bytes.len() / 20]).unwrap();
    done(&folder, &["run", "asked.toml", "--out", "whole"]);
    assert_eq!(contest("whole"), contest("parts"));
    let judged = flockworks(&folder, &["run", "asked.toml", "--out", "whole", "--must-hold"]);
    assert_eq!(judged.status.code(), Some(1));
    assert!(folder.join("whole/champion-2.toml").exists());
    let page = std::fs::read_to_string(folder.join("whole/report.html")).unwrap();
    for words in [
        "Contest: roulette",
        "no_avoidance",
        "Alleles of c_3",
        "does not hold",
        "Alleles of cohesion",
        "Fitness: roulette",
    ] {
        assert!(page.contains(words), "{words}");
    }
    done(&folder, &["report", "whole"]);
}

#[test]
fn a_rival_evolves_for_itself() {
    let folder = folder("rival");
    std::fs::write(folder.join("flocks.toml"), SHARED).unwrap();
    let run = |out: &str, more: &[&str]| {
        let arguments = ["run", "flocks.toml", "--set", "shared.rival=\"blue\"", "--out", out];
        done(&folder, &[&arguments, more].concat());
    };
    run("whole", &["--threads", "2"]);
    run("parts", &["--set", "generations=3"]);
    run("parts", &[]);
    assert_eq!(tables(&folder.join("whole")), tables(&folder.join("parts")));
    done(&folder, &["run", "flocks.toml", "--out", "alone"]);
    assert_ne!(tables(&folder.join("whole")), tables(&folder.join("alone")), "an opponent that evolves is another one");
}

#[test]
fn mistakes_are_shown_at_their_place() {
    let folder = folder("mistakes");
    std::fs::write(folder.join("flocks.toml"), SHARED).unwrap();
    for (set, words) in [
        ("search.genetic.selection=\"roulete\"", "did you mean `roulette`"),
        ("shared.group=\"rde\"", "did you mean `red`"),
        ("shared.members=3", "cannot be shared out"),
        ("fitness=\"heath\"", "did you mean `health`"),
        ("fitness=\"health +\"", "the expression ends"),
        ("fitness=\"sum(health[group = green])\"", "unknown name `green`"),
        ("keep.meals=\"meals\"", "not a number"),
        ("gene.c.path=\"group.red.model.competing_flocks.chromosom\"", "names no value"),
        ("gene.c.low=2000", "is not between 1000 and 2000"),
        ("search.genetic.elite=4", "elite"),
        ("search.genetic.mutation_rate=2", "mutation_rate"),
        ("generations=0", "generations"),
        ("trials=2", "shared world is one"),
        ("shared.rival=\"red\"", "cannot evolve against"),
        ("shared.rival=\"bleu\"", "cannot evolve against"),
        ("keep={ fitness = \"sum(meals)\" }", "a column of the tables is called `fitness`"),
        ("keep={ run = \"sum(meals)\" }", "a column of the tables is called `run`"),
        ("keep={ c_3 = \"sum(meals)\" }", "`c_3` is in `gene` already"),
        ("keep={ \"a b\" = \"sum(meals)\" }", "cannot be a name"),
        ("follow={ x = \"c_12\" }", "did you mean `c_1"),
        ("vary={ kind = { path = \"runs\", values = [1, 2] } }", "the same for all variants"),
        ("vary={ x = { values = [1, 2] } }", "the values have no path"),
        ("contest={ without = { plain = [\"c_44\"] } }", "no gene is called `c_44`"),
        ("claim=[{ id = \"a\", text = \"b\", holds = \"ent > 0\" }]", "did you mean `end`"),
    ] {
        refused(&folder, "flocks.toml", set, words);
    }
    let template = done(&folder, &["new", "evolution"]);
    std::fs::write(folder.join("milling.toml"), template).unwrap();
    for (set, words) in [
        ("gene.generation={ reference = 1, low = 0, high = 2 }", "a column of the tables is called `generation`"),
        ("gene.milling={ reference = 1, low = 0, high = 2 }", "`milling` is in `gene` already"),
        ("reading.fitness={ of.metric = { id = \"polarisation\" } }", "a column of the tables is called `fitness`"),
    ] {
        refused(&folder, "milling.toml", set, words);
    }
}

fn refused(folder: &Path, file: &str, set: &str, words: &str) {
    let output = flockworks(folder, &["check", file, "--set", set]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{set}: {text}");
    assert!(text.contains(words), "{set}: {text}");
}
