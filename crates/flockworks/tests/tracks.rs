//! Tracks as a user meets them: the shipped files, tables that leave something open, folders that play.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use lab::live::{Shown, Tracked};
use lab::store::table::Table;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn ran(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flockworks")).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Runs and expects it to end well; what it printed.
fn well(arguments: &[&str]) -> String {
    let output = ran(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

fn refused(arguments: &[&str]) -> String {
    let output = ran(arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", text(&output.stdout));
    text(&output.stderr)
}

/// A folder of this test's own, not there yet.
fn fresh(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("tracks").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    path
}

fn shipped(name: &str) -> String {
    format!("{}/../../studies/tracks/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn means(folder: &Path, metric: &str) -> f64 {
    let table = Table::open(&folder.join("metrics.parquet")).unwrap();
    let column = table.column(metric).unwrap();
    let values: Vec<f64> = (0..table.groups())
        .flat_map(|group| {
            let read = table.read(group, &[column]).unwrap();
            (0..read[0].len()).map(|row| read[0].number(row)).collect::<Vec<f64>>()
        })
        .filter(|value| value.is_finite())
        .collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn the_shipped_tracks_run_and_play() {
    let out = fresh("sticklebacks");
    let told = well(&["run", &shipped("sticklebacks.toml"), "--out", out.to_str().unwrap()]);
    assert!(told.contains("individuals  5") && told.contains("times are in frames"), "{told}");
    // as trajectorytools and numpy have it, over frames 1 to 300
    assert!(
        (means(&out, "nearest_neighbour_distance") * 301.0 - 40.404_472_36 - 68.968_235_653_862_44 * 300.0).abs()
            < 1e-5
    );
    for file in ["manifest.json", "trajectory.parquet", "events.parquet", "over_time.parquet", "report.html"] {
        assert!(out.join(file).exists(), "{file}");
    }
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    for what in ["Replay of shoal", "Paths of shoal", "Mean squared displacement", "Distribution of polarisation"] {
        assert!(page.contains(what), "{what}");
    }
    let mut shown = Tracked::open(&out, 0).unwrap();
    assert_eq!(shown.scene()["frames"], 301);
    shown.seek(300).unwrap();
    let frame = shown.frame(1);
    assert_eq!(frame.len(), 24 + 5 * 16);
    assert_eq!(shown.moment(), (300, 300.0, Some(300)));
    assert!(Tracked::open(&out, 1).is_err());
    // the same again into the same folder, and the page alone
    well(&["run", &shipped("sticklebacks.toml"), "--out", out.to_str().unwrap()]);
    well(&["report", out.to_str().unwrap()]);
    let other = ["run", &shipped("corridor.toml"), "--out", out.to_str().unwrap()];
    assert!(refused(&other).contains("holds another analysis"));
    assert!(well(&["check", &shipped("corridor.toml")]).contains("34 individuals, 250 frames"));
}

#[test]
fn a_simulation_and_a_recording_stand_on_one_page() {
    let (run, out) = (fresh("simulated"), fresh("both"));
    let gallery = format!("{}/../../studies/gallery/vicsek.toml", env!("CARGO_MANIFEST_DIR"));
    let few = ["--set", "group.points.count=60", "--set", "time.duration=20"];
    let groups = std::fs::read_to_string(&gallery).unwrap();
    let name = groups.split("[group.").nth(1).unwrap().split([']', '.']).next().unwrap().to_owned();
    let count = format!("group.{name}.count=60");
    well(&["run", &gallery, "--seed", "1", "--out", run.to_str().unwrap(), "--set", &count, few[2], few[3]]);
    let csv = out.with_extension("csv");
    let corridor = shipped("corridor.txt");
    let both = ["analyze", &corridor, run.to_str().unwrap(), "--out", out.to_str().unwrap(), "--per-frame"];
    let told = well(&[&both[..], &[csv.to_str().unwrap()]].concat());
    assert!(told.contains("layout       run") && told.contains("layout       pedestrian"), "{told}");
    let lines = std::fs::read_to_string(&csv).unwrap();
    let header = lines.lines().next().unwrap();
    assert!(header.starts_with("run,frame,t,group,positions,velocities,headings,polarisation"), "{header}");
    assert!(lines.lines().any(|line| line.starts_with("1,")));
    // the run's own measure of itself
    let own = Table::open(&run.join("metrics.parquet")).unwrap();
    let first = own.read(0, &[own.column("polarisation").unwrap()]).unwrap()[0].number(0);
    let at = header.split(',').position(|name| name == "polarisation").unwrap();
    let row = lines.lines().find(|line| line.starts_with("1,0,")).unwrap();
    let found: f64 = row.split(',').nth(at).unwrap().parse().unwrap();
    assert!((found - first).abs() < 1e-6, "{found} and {first}");
    assert!(Tracked::open(&out, 1).is_ok());
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("Replay of corridor") && page.contains("Replay of simulated"));
}

#[test]
fn cleaning_is_counted_and_both_averages_are_told() {
    let table = fresh("dirty.csv");
    let mut rows = "frame,id,x,y\n".to_owned();
    for frame in 0..40 {
        let jump = if frame == 20 { 500.0 } else { 0.0 };
        rows += &format!("{frame},a,{},0\n", f64::from(frame) + jump);
        if frame != 10 {
            rows += &format!("{frame},b,{},3\n", f64::from(frame));
        }
    }
    std::fs::write(&table, rows).unwrap();
    let out = fresh("dirty");
    let (table, folder) = (table.to_str().unwrap(), out.to_str().unwrap());
    let told = well(&[
        "analyze",
        table,
        "--fps",
        "1",
        "--interpolate",
        "3",
        "--greatest-speed",
        "5",
        "--smooth",
        "5,2",
        "--out",
        folder,
    ]);
    for what in [
        "1 gaps filled, 1 positions",
        "1 positions flagged: impossible speed",
        "80 positions smoothed",
        "without flagged",
    ] {
        assert!(told.contains(what), "{what}: {told}");
    }
    let events = Table::open(&out.join("events.parquet")).unwrap();
    assert_eq!(events.rows(), 1);
    let plain = well(&["analyze", table, "--fps", "1"]);
    assert!(!plain.contains("without flagged") && !plain.contains("filled"), "nothing is cleaned unasked: {plain}");
}

#[test]
fn what_is_wrong_is_said_in_a_sentence_and_nothing_is_left() {
    let folder = fresh("wrong");
    std::fs::create_dir_all(&folder).unwrap();
    let table = folder.join("fish.csv");
    std::fs::write(&table, "frame,id,x,y\n0,1,0,0\n1,1,1,0\n").unwrap();
    let table = table.to_str().unwrap();
    let out = folder.join("out");
    let out = out.to_str().unwrap();
    for (arguments, what) in [
        (vec!["analyze", table, "--out", out], "--fps F"),
        (vec!["analyze", table, "--fps", "fast", "--out", out], "a number above 0 or `unknown`"),
        (vec!["analyze", table, "--fps", "1", "--columns", "id", "--out", out], "ROLE=NAME"),
        (vec!["analyze", table, "--fps", "1", "--columns", "idd=id", "--out", out], "no column can be `idd`"),
        (
            vec!["analyze", table, "--fps", "1", "--metrics", "polarization", "--out", out],
            "did you mean `polarisation`",
        ),
        (vec!["analyze", table, "--fps", "1", "--smooth", "4", "--out", out], "odd number"),
        (
            vec!["analyze", table, "--fps", "1", "--set", "measure.parameters.eps=-1", "--metrics", "dbscan_clusters"],
            "eps",
        ),
        (
            vec!["analyze", table, "--fps", "1", "--scale", "nan", "--out", out],
            "`scale` must be more than 0, found NaN",
        ),
        (
            vec!["analyze", table, "--fps", "1", "--layout", "animalta", "--columns", "x=x", "--out", out],
            "it takes frame",
        ),
        (vec!["analyze", "nowhere.csv", "--out", out], "cannot read"),
        (vec!["analyze", table, table, "--fps", "1", "--out", out], "two recordings are called `fish`"),
    ] {
        let error = refused(&arguments);
        assert!(error.contains(what), "{arguments:?}: {error}");
        assert!(!Path::new(out).exists(), "{arguments:?} left a folder");
    }
}

#[test]
fn what_cleaning_was_asked_for_is_counted_and_both_averages_are_told() {
    let folder = fresh("cleaned");
    std::fs::create_dir_all(&folder).unwrap();
    let row = |k: i64, who: i64| format!("{k},{who},{},{}\n", if (k, who) == (12, 0) { 90.0 } else { k as f64 }, who);
    let rows: String = (0..40).flat_map(|k| (0..3).map(move |who| (k, who))).map(|(k, who)| row(k, who)).collect();
    let table = folder.join("fish.csv");
    std::fs::write(&table, format!("frame,id,x,y\n{rows}")).unwrap();
    let (table, out) = (table.to_str().unwrap(), folder.join("out"));
    let clean = ["--greatest-speed", "2", "--swaps", "--interpolate", "3"];
    let asked = [&["analyze", table, "--fps", "1", "--out", out.to_str().unwrap()][..], &clean].concat();
    let told = well(&asked);
    for what in ["0 gaps filled", "1 positions flagged: impossible speed", "0 positions flagged: identity swap"] {
        assert!(told.contains(what), "{what}: {told}");
    }
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("flags.csv") && page.contains("fish without flagged"));
    let over = Table::open(&out.join("over_time.parquet")).unwrap();
    let columns: Vec<usize> =
        ["metric", "flagged", "field", "value", "label"].map(|name| over.column(name).unwrap()).to_vec();
    let read = over.read(0, &columns).unwrap();
    let greatest = |flagged: &str| {
        let is =
            |row: &usize| [(0, "speed"), (1, flagged), (2, "max")].iter().all(|&(k, word)| read[k].text(*row) == word);
        let rows: Vec<usize> = (0..read[0].len()).filter(is).collect();
        rows.iter().map(|&row| read[3].number(row)).fold(0.0, f64::max)
    };
    assert!((greatest("kept") - 79.0).abs() < 1e-9 && (greatest("left_out") - 1.0).abs() < 1e-9);
}
