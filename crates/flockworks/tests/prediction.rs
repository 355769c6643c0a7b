//! Predictions through the program itself: threads, stopping and going on, other models, a sure outcome, mistakes.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("flockworks-prediction-{}-{name}", std::process::id()));
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

fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replace(from, to)
}

#[test]
fn a_prediction_is_the_same_for_any_threads_and_stops_and_models_come_and_go() {
    let folder = folder("threads");
    let text = done(&folder, &["new", "prediction"]);
    std::fs::write(folder.join("wall.toml"), &text).unwrap();
    let less = [
        "--set",
        "quick_trials=2",
        "--set",
        "quick_predicted=6",
        "--set",
        "control_trials=4",
        "--set",
        "model.cells.least=10",
    ];
    let run = |file: &str, out: &str, threads: &str| {
        done(&folder, &[&["run", file, "--quick", "--threads", threads, "--out", out], &less[..]].concat())
    };
    let told = run("wall.toml", "one", "1");
    for what in ["held_out by mean", "corner by cells", "better: ", "16 constructs", "a predicted one"] {
        assert!(told.contains(what), "{what}: {told}");
    }
    run("wall.toml", "two", "2");
    run("wall.toml", "four", "4");
    let names = ["constructs.parquet", "scores.parquet", "states.parquet", "report.html"];
    let files = |out: &str| -> Vec<Vec<u8>> {
        names.iter().map(|name| std::fs::read(folder.join(out).join(name)).unwrap()).collect()
    };
    assert!(files("one") == files("two") && files("one") == files("four"), "threads change nothing");
    // a stop cuts the log somewhere: in what was simulated, in what was predicted
    let log = std::fs::read(folder.join("one/constructs.log")).unwrap();
    for (out, kept) in [("torn", log.len() * 2 / 5), ("cut", log.len() - 100)] {
        std::fs::create_dir_all(folder.join(out)).unwrap();
        std::fs::copy(folder.join("one/manifest.json"), folder.join(out).join("manifest.json")).unwrap();
        std::fs::write(folder.join(out).join("constructs.log"), &log[..kept]).unwrap();
        run("wall.toml", out, "2");
        assert!(files("one") == files(out), "a stop changes nothing");
    }
    done(&folder, &["report", "one"]);
    assert!(files("one") == files("two"));
    // another model simulates nothing again, and the one before is as it was
    let other = changed(&text, "[model.linear]\nreach = 2", "[model.linear]\nreach = 1");
    std::fs::write(folder.join("other.toml"), other).unwrap();
    let again = run("other.toml", "two", "2");
    assert!(again.contains("0 constructs"), "{again}");
    let line = |text: &str, name: &str| text.lines().find(|line| line.contains(name)).unwrap().to_owned();
    assert_eq!(line(&again, "held_out by cells"), line(&told, "held_out by cells"));
    assert!(files("one") != files("two"));
    run("wall.toml", "two", "2");
    assert!(files("one") == files("two"), "and back again");
    // other trials are another prediction
    let refused = flockworks(&folder, &["run", "wall.toml", "--quick", "--out", "one", "--set", "every=7"]);
    assert_eq!(refused.status.code(), Some(2));
    std::fs::remove_dir_all(folder).unwrap();
}

/// A robot without noise that goes up a stem, where no wall comes near: what it does is sure, and so is what is predicted.
#[test]
fn what_is_sure_is_predicted_surely() {
    let folder = folder("sure");
    let text = done(&folder, &["new", "prediction"]);
    let text = changed(&text, "count = 7", "count = 1");
    let text = changed(&text, "wander_deviation = 68.75493541569878", "wander_deviation = 0");
    let text = changed(
        &text,
        "place.points = [[0, -4], [0.5, -4], [0.25, -3.567], [-0.25, -3.567], [-0.5, -4], [-0.25, -4.433], [0.25, -4.433]]\njitter = 0.1",
        "place.points = [[0, -4]]",
    );
    let text = changed(&text, "low = 1\nhigh = 3.5", "low = 0.25\nhigh = 1");
    for (step, chance) in [(59, 0), (61, 1)] {
        // it goes 0.05 in a step, from -4 to -1
        let wanted = format!("score.binary = {{ when = \"centroid_y >= -1.0001\", within = {step} }}");
        let text = changed(&text, "is.turn-right = { share = 0.9, horizon = 220 }", &wanted);
        std::fs::write(folder.join("sure.toml"), text).unwrap();
        let out = format!("out-{step}");
        let told = done(&folder, &["run", "sure.toml", "--quick", "--out", &out]);
        for by in ["mean", "parameters", "cells", "linear"] {
            for test in ["held_out", "corner"] {
                let line = format!("{test} by {by}: Brier score 0, mean absolute error 0,");
                assert!(told.contains(&line), "{line}: {told}");
            }
        }
        let page = std::fs::read_to_string(folder.join(out).join("report.html")).unwrap();
        assert!(page.contains(&format!("simulated, {} of 5 succeed", 5 * chance)), "{step}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn mistakes_are_told_at_their_place() {
    let folder = folder("mistakes");
    let text = done(&folder, &["new", "prediction"]);
    let first = &text[text.find("constructs = 40").unwrap()..text.find("\ntrials = 20").unwrap()];
    for (from, to, told) in [
        ("held_out = 0.25", "held_out = 0.99", "from 0 to 0.9"),
        ("held_out = 0.25", "held_uot = 0.25", "did you mean `held_out`"),
        ("id = \"dirt\"", "id = \"drit\"", "did you mean `dirt`"),
        ("[range.angle]", "[range.angel]", "did you mean `angle`"),
        ("low = 1\nhigh = 3.5", "low = 3.5\nhigh = 1", "cannot be drawn from 3.5 to 1"),
        ("high = 3.5", "high = 35", "cannot be drawn from 1 to 35"),
        ("at.anchor = 3", "at.ancor = 3", "did you mean `anchor`"),
        ("[test.corner]", "[test.held_out]", "another name"),
        ("[model.linear]", "[model.mean]", "is what a model is compared with"),
        ("reach = 2 ", "raech = 2 ", "did you mean `reach`"),
        ("sectors = 8", "sectors = 2", "from 3 to 64"),
        ("is.turn-right", "is.turn-rihgt", "did you mean `turn-right`"),
        ("link = 1 ", "# link = 1 ", "`link` is missing"),
        ("every = 10 ", "every = 0 ", "`every` must be"),
        ("[by = cells] <", "[by = cels] <", "did you mean `cells`"),
        ("brier[by = cells] <", "breir[by = cells] <", "did you mean `brier`"),
        ("brier[by = cells] <", "brier < 1 and brier[by = cells] <", "needs [by = ...]"),
        ("brier[by = cells] <", "brier[by = cells, test = corenr] <", "did you mean `corner`"),
        (first, "constructs = 5\nheld_out = 0.9", "1 of 5 constructs are left to fit a model to"),
    ] {
        let text = wrong(&folder, &changed(&text, from, to));
        assert!(text.contains(told) && text.contains("wrong.toml:"), "{to}: {text}");
    }
    let refused = flockworks(&folder, &["run", "wrong.toml", "--must-hold"]);
    assert_eq!(refused.status.code(), Some(2));
    std::fs::remove_dir_all(folder).unwrap();
}
