//! Formation files through the program itself: the template, threads, stopping and going on, mistakes.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("flockworks-formation-{}-{name}", std::process::id()));
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

fn files(folder: &Path) -> Vec<Vec<u8>> {
    let names = ["outcomes.parquet", "trials.parquet", "walls.parquet", "report.html"];
    names.iter().map(|name| std::fs::read(folder.join(name)).unwrap()).collect()
}

/// The template with every way of bringing targets along, and with walls that are searched.
fn everything(template: &str) -> String {
    let methods = "[method.posts]\nby.posts = {}\n[method.back]\nby.restored = {}\n[method.pilots]\nby.piloting = {}\n\
                   [method.cage]\nby.caging = {}\n[method.one]\nby.vaughan_2000 = {}\n[method.lien]\nby.lien_2004 = {}\n\
                   [method.several]\nby.lien_2005 = { regroup = 1.5 }\n[method.arc]\nby.pierson_schwager_2015 = {}\n\
                   shepherds = { wheels = true, asynchronous = true, noise = true }\n\
                   [solver]\ncandidates = 4\nfirst_trials = 1\nfurther_trials = 1\n\
                   [task.searched]\npath = [[-3, 0], [0, 0]]\n";
    let text = template
        .replace("duration = 100", "duration = 20")
        .replace("[method.walls]", &format!("{methods}[method.walls]"));
    assert_ne!(text, template);
    text
}

#[test]
fn a_formation_file_is_the_same_for_any_threads_and_stops() {
    let folder = folder("same");
    let text = everything(&done(&folder, &["new", "formation"]));
    std::fs::write(folder.join("corner.toml"), text).unwrap();
    assert!(done(&folder, &["check", "corner.toml"]).contains("2 tasks (1 whose walls are searched), 11 methods"));
    done(&folder, &["run", "corner.toml", "--quick", "--threads", "1", "--out", "one"]);
    done(&folder, &["run", "corner.toml", "--quick", "--threads", "3", "--out", "three"]);
    let one = files(&folder.join("one"));
    assert!(one == files(&folder.join("three")), "threads change nothing");
    std::fs::create_dir_all(folder.join("torn")).unwrap();
    std::fs::copy(folder.join("one/manifest.json"), folder.join("torn/manifest.json")).unwrap();
    let log = std::fs::read(folder.join("one/trials.log")).unwrap();
    std::fs::write(folder.join("torn/trials.log"), &log[..log.len() / 2]).unwrap();
    done(&folder, &["run", "corner.toml", "--quick", "--out", "torn"]);
    assert!(one == files(&folder.join("torn")), "a stop changes nothing");
    let again = done(&folder, &["run", "corner.toml", "--quick", "--out", "one"]);
    assert!(again.contains("0 trials in"), "what is there is not done again: {again}");
    done(&folder, &["report", "one"]);
    assert!(one == files(&folder.join("one")));
    // more trials may be added, another seed is another file
    done(&folder, &["run", "corner.toml", "--quick", "--out", "one", "--set", "quick_trials=3"]);
    let other = flockworks(&folder, &["run", "corner.toml", "--quick", "--out", "one", "--seed", "9"]);
    assert_eq!(other.status.code(), Some(2));
}

#[test]
fn mistakes_are_told_at_their_place() {
    let folder = folder("wrong");
    let template = done(&folder, &["new", "formation"]);
    for (from, to, told) in [
        ("by.walls = {}", "by.wals = {}", "did you mean"),
        ("[0, 0], [-4, 0]]", "[0, 0], [0, 0]]", "it is where the point before it is"),
        ("leg = 2, at = [1.2,", "leg = 3, at = [1.2,", "the path has 2 legs"),
        ("\"corner, robots\"", "\"corner, robot\"", "did you mean `robots`?"),
        ("fitness[method = walls] >", "fitnes[method = walls] >", "did you mean `fitness`?"),
        ("count = 4", "count = 400", "found a place"),
    ] {
        let text = template.replacen(from, to, 1);
        assert_ne!(text, template, "{from}");
        std::fs::write(folder.join("wrong.toml"), text).unwrap();
        let output = flockworks(&folder, &["check", "wrong.toml"]);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{to}");
        assert!(error.contains(told) && error.contains("wrong.toml:"), "{to}: {error}");
    }
}
