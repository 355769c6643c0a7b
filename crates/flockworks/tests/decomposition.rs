//! Decompositions through the program itself: threads, stopping and going on, the primitives it writes, mistakes.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("flockworks-decomposition-{}-{name}", std::process::id()));
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
fn a_decomposition_is_the_same_for_any_threads_and_stops_and_its_primitives_are_grammars() {
    let folder = folder("threads");
    std::fs::write(folder.join("bend.toml"), done(&folder, &["new", "decomposition"])).unwrap();
    let run = |out: &str, threads: &str| {
        done(&folder, &["run", "bend.toml", "--quick", "--threads", threads, "--out", out, "--set", "offsets=2"])
    };
    run("one", "1");
    run("three", "3");
    let mut names: Vec<String> = ["approaches.parquet", "clusters.parquet", "report.html"].map(str::to_owned).to_vec();
    for below in ["primitives", "environments"] {
        let files = std::fs::read_dir(folder.join("one").join(below)).unwrap();
        names.extend(files.map(|file| format!("{below}/{}", file.unwrap().file_name().into_string().unwrap())));
    }
    let files = |out: &str| -> Vec<Vec<u8>> {
        names.iter().map(|name| std::fs::read(folder.join(out).join(name)).unwrap()).collect()
    };
    assert!(names.len() >= 3 + 4 * 2, "a grammar, two drawings and a scenario for each cluster: {names:?}");
    assert!(files("one") == files("three"), "threads change nothing");
    // a stop cuts the log somewhere
    std::fs::create_dir_all(folder.join("torn")).unwrap();
    std::fs::copy(folder.join("one/manifest.json"), folder.join("torn/manifest.json")).unwrap();
    let log = std::fs::read(folder.join("one/approaches.log")).unwrap();
    std::fs::write(folder.join("torn/approaches.log"), &log[..log.len() * 3 / 5]).unwrap();
    run("torn", "2");
    assert!(files("one") == files("torn"), "a stop changes nothing");
    done(&folder, &["report", "one"]);
    assert!(files("one") == files("three"));
    // clusters may be made in another way from what is there
    let set = ["--set", "offsets=2", "--set", "cluster={ dbscan = { radius = 1.5 } }"];
    let again = done(&folder, &[&["run", "bend.toml", "--quick", "--out", "three"], &set[..]].concat());
    assert!(again.contains("0 approaches in"), "{again}");
    for file in std::fs::read_dir(folder.join("three/primitives")).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        assert!(
            again.contains(&format!("{}:", name.trim_end_matches(".toml"))),
            "{name} is of another clustering: {again}"
        );
    }
    // what is found can be built with
    let grammar = names.iter().find(|name| name.starts_with("primitives/")).unwrap();
    let bend = std::fs::read_to_string(folder.join("bend.toml")).unwrap();
    let group = bend[..bend.find("# What is stated").unwrap()].split_once("[scenario]").unwrap().1;
    let text = format!(
        "kind = \"design\"\ntitle = \"built with what was found\"\ncandidates.grammar = \"one/{grammar}\"\nattempts = 2\n\
         behaviour.apart.score.binary.when = \"n_groups(25) >= 2\"\n[scenario]{group}"
    );
    std::fs::write(folder.join("design.toml"), text).unwrap();
    assert!(done(&folder, &["check", "design.toml"]).contains("grammar"));
    std::fs::remove_dir_all(folder).unwrap();
}

/// A straight wall that is approached at 45 degrees is the mirror image of the same wall at -45 degrees: members are turned as far to the
/// other side, and what left on the left leaves on the right. Draws are not mirrored, so that this holds within sampling.
#[test]
fn a_mirror_image_swaps_left_and_right() {
    use lab::decomposition::probe::{Sum, place};
    let text = lab::decomposition::TEMPLATE;
    let begin = text.find("line = [").unwrap();
    let end = begin + text[begin..].find("\n]\n").unwrap();
    let text = format!("{}line = [[[-15, 0], [15, 0]]{}", &text[..begin], &text[end..]);
    let set = ["windows=[30]", "trials=6"].map(str::to_owned);
    let plan = lab::decomposition::read("wall.toml", &text, &set, false, &mut |_| Err("no other file".into())).unwrap();
    assert_eq!(plan.fragments.len(), 1);
    let of = |heading: usize| {
        let mut sum = Sum::default();
        for offset in 0..plan.form.offsets {
            for trial in 1..=plan.trials {
                let probe = plan.probe(heading, offset);
                let done = lab::decomposition::execute::once(&plan, &probe, plan.seed_of(trial), &|| false);
                done.unwrap().unwrap().0.add_to(&mut sum);
            }
        }
        sum.descriptor().unwrap()
    };
    let (one, other) = (of(1), of(7));
    let number = |of: &[f64], name: &str| of[place(name)];
    assert!(number(&one, "turn") < -10.0, "a wall from the left turns to the right: {one:?}");
    assert!((number(&one, "turn") + number(&other, "turn")).abs() < 8.0, "{one:?} {other:?}");
    for (name, twin) in [("left", "right"), ("right", "left"), ("through", "through"), ("back", "back")] {
        assert!((number(&one, name) - number(&other, twin)).abs() < 0.1, "{name}: {one:?} {other:?}");
    }
}

#[test]
fn the_cost_is_told_before_anything_is_run() {
    let folder = folder("plan");
    std::fs::write(folder.join("bend.toml"), done(&folder, &["new", "decomposition"])).unwrap();
    let told = done(&folder, &["run", "bend.toml", "--plan"]);
    for what in ["fragments x 8 headings x 5 offsets x 2 trials", "agent-updates", "time "] {
        assert!(told.contains(what), "{told}");
    }
    assert!(!folder.join("runs").exists());
    std::fs::remove_dir_all(folder).unwrap();
}

/// Two walls as they are drawn, of a segment and an arc; the rest of the file is that of the study.
#[test]
fn marked_stretches_are_fitted_and_varied() {
    let folder = folder("directed");
    let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/environments");
    std::fs::copy(studies.join("junction.toml"), folder.join("junction.toml")).unwrap();
    let text = std::fs::read_to_string(studies.join("decomposition-directed.toml")).unwrap();
    let text = text
        .replace("angles = [-30, -20, -10, 0, 10, 20, 30]", "angles = [-30, 0]")
        .replace("lengths = [0.5, 0.75, 1, 1.25, 1.5]", "lengths = [0.5, 1]");
    std::fs::write(folder.join("walls.toml"), &text).unwrap();
    let run = |out: &str, threads: &str| {
        done(&folder, &["run", "walls.toml", "--quick", "--threads", threads, "--out", out, "--set", "vary.least=0"])
    };
    let told = run("one", "1");
    assert!(
        told.contains("pieces: holds [2]") && told.contains("angle \u{2212}30\u{b0} to 0\u{b0}, length 0.5 to 1"),
        "{told}"
    );
    run("three", "3");
    let names = ["variations.parquet", "report.html", "primitives/slanting.toml", "primitives/bent.toml"];
    let files = |out: &str| -> Vec<Vec<u8>> {
        names.iter().map(|name| std::fs::read(folder.join(out).join(name)).unwrap()).collect()
    };
    assert!(files("one") == files("three"), "threads change nothing");
    for (from, to, told) in [
        ("to = 2.8", "to = 28", "no stretch from 0 to 28"),
        ("line = 2", "line = 3", "no line 3"),
        ("angles = [-30, 0]", "angles = [-30, 10]", "0 among them"),
        ("is.turn-right", "is.turn-righ", "did you mean `turn-right`"),
        ("[interval.bent]", "[interval.narrowing]", "a name of its own"),
        ("angles[interval = slanting] > 0", "angles[interval = slantin] > 0", "did you mean `slanting`"),
    ] {
        let text = wrong(&folder, &changed(&text, from, to));
        assert!(text.contains(told) && text.contains("wrong.toml:"), "{to}: {text}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn mistakes_are_told_at_their_place() {
    let folder = folder("mistakes");
    let bend = done(&folder, &["new", "decomposition"]);
    for (from, to, told) in [
        ("windows = [40]", "windows = []", "neither a window nor a stretch"),
        ("windows = [40]", "windows = [0.0001]", "at most 100000"),
        ("windows = [40]", "windows = [400]", "are still in an empty arena"),
        ("[[0, 0], [50, 0], [50, 50]]", "[[0, 0]]", "at least two points"),
        ("[[0, 0], [50, 0], [50, 50]]", "[[0, 0], [50]]", "2"),
        ("headings = 8", "heading = 8", "did you mean `headings`"),
        ("heading.along = [1, 0]", "heading.random = {}", "heads nowhere in common"),
        ("units = \"field\"", "units = \"metres\"", "nothing is converted"),
        ("least = 2", "least = 60", "at least are more than"),
        ("link = 25 ", "# link = 25 ", "`link` is missing"),
        ("link = 25", "link = 25\nbudget = 10", "less than a single fragment takes"),
        ("link = 25", "link = 25\nmargin = 0.1", "a margin of at least that"),
        ("named[effect = turn] > 0", "named[effect = trun] > 0", "did you mean `turn`"),
        ("named[effect = turn] > 0", "named > 0", "needs [effect = ...]"),
        ("link = 25", "link = 25\ncandidates.schema.id = \"funel\"", "did you mean `funnel`"),
        ("link = 25", "link = 25\ncandidates.files = [\"none.wkt\"]", "none.wkt"),
        ("link = 25", "link = 25\nattempt = 7\ncandidates.grid = { id = \"funnel\" }", "no candidate 7"),
    ] {
        let text = wrong(&folder, &changed(&bend, from, to));
        assert!(text.contains(told) && text.contains("wrong.toml:"), "{to}: {text}");
    }
    let nothing: String = bend
        .lines()
        .filter(|line| !line.starts_with("  [[") && *line != "line = [" && *line != "]")
        .map(|line| format!("{line}\n"))
        .collect();
    assert!(wrong(&folder, &nothing).contains("no construct to be decomposed"));
    std::fs::remove_dir_all(folder).unwrap();
}
