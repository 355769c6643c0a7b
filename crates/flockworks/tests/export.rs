//! `flockworks export`: what is sent of a run, and what is told where it cannot be.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn flockworks(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flockworks")).args(arguments).output().unwrap()
}

fn place(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn recorded(name: &str) -> PathBuf {
    let out = place(name);
    let _ = std::fs::remove_dir_all(&out);
    let mill = format!("{}/../../studies/gallery/mill.toml", env!("CARGO_MANIFEST_DIR"));
    let run = flockworks(&["run", &mill, "--quick", "--out", out.to_str().unwrap()]);
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    out
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn every_form_is_written_and_says_its_size() {
    let run = recorded("export-run");
    let out = place("export-out");
    let _ = std::fs::remove_dir_all(&out);
    for (form, ending, begins) in [
        ("html", "html", &b"<!doctype html>"[..]),
        ("png", "png", b"\x89PNG"),
        ("svg", "svg", b"<svg"),
        ("gif", "gif", b"GIF89a"),
        ("gltf", "glb", b"glTF"),
    ] {
        let words = ["export", run.to_str().unwrap(), "--to", form, "--out", out.to_str().unwrap(), "--width", "200"];
        let done = flockworks(&words);
        assert_eq!(done.status.code(), Some(0), "{form}: {}", text(&done.stderr));
        let file = out.join(format!("export-run.{ending}"));
        let bytes = std::fs::read(&file).unwrap();
        assert!(bytes.starts_with(begins), "{form}");
        let told = text(&done.stdout);
        assert!(told.contains(file.to_str().unwrap()) && told.contains('B'), "{told}");
    }
    let page = std::fs::read_to_string(out.join("export-run.html")).unwrap();
    assert!(page.contains("default-src 'none'") && !page.contains("https:"), "nothing is fetched");
}

#[test]
fn what_cannot_be_sent_is_told_with_the_remedy() {
    let run = recorded("export-refused");
    let refused = |words: &[&str], part: &str| {
        let done = flockworks(&[&["export", run.to_str().unwrap()], words].concat());
        assert_eq!(done.status.code(), Some(2), "{words:?}");
        let told = text(&done.stderr);
        assert!(told.contains(part), "`{part}` is not in: {told}");
    };
    refused(&["--to", "png", "--frame", "99999"], "the last one is");
    refused(&["--to", "gif", "--frames", "5..99999"], "the last one is");
    refused(&["--to", "html", "--recording", "3"], "has 1");
    refused(&["--to", "htm"], "html");
    let nothing = |folder: &Path| {
        let done = flockworks(&["export", folder.to_str().unwrap(), "--to", "html"]);
        assert_eq!(done.status.code(), Some(2));
    };
    nothing(&place("nowhere"));
}

#[test]
fn a_trial_of_a_search_is_sent_in_every_form_and_its_page_plays_it() {
    let (folder, out) = (place("export-study"), place("export-study-out"));
    for path in [&folder, &out] {
        let _ = std::fs::remove_dir_all(path);
    }
    let file = format!("{}/../../studies/compositions/weights.toml", env!("CARGO_MANIFEST_DIR"));
    let run = flockworks(&[
        "run",
        &file,
        "--quick",
        "--trials",
        "1",
        "--set",
        "set.time.duration=80",
        "--out",
        folder.to_str().unwrap(),
    ]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let export = |words: &[&str]| {
        let begin = ["export", folder.to_str().unwrap(), "--out", out.to_str().unwrap(), "--width", "200"];
        flockworks(&[&begin, words].concat())
    };
    for (form, ending, begins) in
        [("png", "png", &b"\x89PNG"[..]), ("svg", "svg", b"<svg"), ("gif", "gif", b"GIF89a"), ("gltf", "glb", b"glTF")]
    {
        let done = export(&["--to", form, "--at", "cell=3,trial=1"]);
        assert_eq!(done.status.code(), Some(0), "{form}: {}", text(&done.stderr));
        assert!(std::fs::read(out.join(format!("export-study.{ending}"))).unwrap().starts_with(begins), "{form}");
    }
    let done = export(&["--to", "html"]);
    assert_eq!(done.status.code(), Some(0), "{}", text(&done.stderr));
    assert!(text(&done.stdout).contains("the page of the study with 3 to play"), "{}", text(&done.stdout));
    let page = std::fs::read_to_string(out.join("export-study.html")).unwrap();
    let own = std::fs::read_to_string(folder.join("report.html")).unwrap();
    let count = |page: &str| page.matches("<figure").count();
    assert_eq!(count(&page), count(&own) + 3, "all of its own page, and what is played");
    for (place, part) in [
        ("cel=3", "did you mean `cell`"),
        ("cell", "NAME=NUMBER"),
        ("cell=999,trial=1", "no cell 999"),
        ("cell=1,trial=0", "count from 1"),
    ] {
        let done = export(&["--to", "png", "--at", place]);
        assert_eq!(done.status.code(), Some(2), "{place}");
        assert!(text(&done.stderr).contains(part), "`{part}` is not in: {}", text(&done.stderr));
    }
    let run = recorded("export-no-search");
    let done = flockworks(&["export", run.to_str().unwrap(), "--to", "png", "--at", "cell=1"]);
    assert_eq!(done.status.code(), Some(2));
    assert!(text(&done.stderr).contains("--at is for searches"));
}

#[cfg(unix)]
#[test]
fn a_film_is_made_where_there_is_an_ffmpeg_and_else_the_message_says_so() {
    use std::os::unix::fs::PermissionsExt;
    let run = recorded("export-film");
    let bare = place("export-no-ffmpeg");
    std::fs::create_dir_all(&bare).unwrap();
    let export = |path: &Path| {
        Command::new(env!("CARGO_BIN_EXE_flockworks"))
            .args(["export", run.to_str().unwrap(), "--to", "mp4", "--width", "200", "--frames", "0..3"])
            .env("PATH", path)
            .output()
            .unwrap()
    };
    let done = export(&bare);
    assert_eq!(done.status.code(), Some(2));
    assert!(text(&done.stderr).contains("ffmpeg") && text(&done.stderr).contains("--to gif"));
    // one that counts the bytes of its pictures, in place of a real one
    let with = place("export-ffmpeg");
    std::fs::create_dir_all(&with).unwrap();
    let program = with.join("ffmpeg");
    std::fs::write(
        &program,
        "#!/bin/sh\nPATH=/usr/bin:/bin\nfor last; do :; done\necho \"$*\" > \"$last\"\nwc -c >> \"$last\"\n",
    )
    .unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    let done = export(&with);
    assert_eq!(done.status.code(), Some(0), "{}", text(&done.stderr));
    let film = std::fs::read_to_string(run.join("export-film.mp4")).unwrap();
    let size = film.split(" -s ").nth(1).unwrap().split(' ').next().unwrap();
    let (wide, tall) = size.split_once('x').unwrap();
    let bytes: usize = film.lines().last().unwrap().trim().parse().unwrap();
    assert_eq!(bytes, 4 * 3 * wide.parse::<usize>().unwrap() * tall.parse::<usize>().unwrap(), "four whole pictures");
}

#[test]
fn obstacles_are_told_point_by_point() {
    let folder = place("export-obstacles");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("walls.toml");
    let scenario = r#"
kind = "scenario"
title = "Obstacles of several shapes"
time.duration = 5
space = { dimensions = 2, edges = "open" }
[group.points]
count = 3
model = "vicsek_1995"
start.place.points = [[0, 0], [1, 0], [2, 0]]
[[obstacle]]
shape.ball = { centre = [9, 9.5], radius = 0.25 }
[[obstacle]]
shape.segment = { from = [-9, 1], to = [-9, 2] }
[[obstacle]]
shape.polygon = [[20, 0], [21, 0], [21, 1]]
"#;
    std::fs::write(&file, scenario).unwrap();
    let run = folder.join("run");
    let done = flockworks(&["run", file.to_str().unwrap(), "--out", run.to_str().unwrap()]);
    assert_eq!(done.status.code(), Some(0), "{}", text(&done.stderr));
    let done = flockworks(&["export", run.to_str().unwrap(), "--to", "csv"]);
    assert_eq!(done.status.code(), Some(0), "{}", text(&done.stderr));
    let rows = std::fs::read_to_string(run.join("obstacles.csv")).unwrap();
    let expected = "run,obstacle,shape,point,x,y,radius,nx,ny\n\
                    0,0,ball,centre,9,9.5,0.25,,\n\
                    0,1,segment,end,-9,1,,,\n\
                    0,1,segment,end,-9,2,,,\n\
                    0,2,polygon,corner,20,0,,,\n\
                    0,2,polygon,corner,21,0,,,\n\
                    0,2,polygon,corner,21,1,,,\n";
    assert_eq!(rows, expected);
}
