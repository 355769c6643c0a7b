//! The binary as a user meets it: what it prints, and the exit code.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// What a run gave.
struct Run {
    code: Option<i32>,
    out: String,
    err: String,
}

fn flockworks(arguments: &[&str]) -> Run {
    let run = Command::new(env!("CARGO_BIN_EXE_flockworks")).args(arguments).output().unwrap();
    Run {
        code: run.status.code(),
        out: String::from_utf8(run.stdout).unwrap(),
        err: String::from_utf8(run.stderr).unwrap(),
    }
}

fn data(name: &str) -> String {
    format!("{}/tests/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// A file with this text, for this run of the tests.
fn file(name: &str, text: &str) -> String {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The state that `step` prints.
fn state(arguments: &[&str]) -> Value {
    let run = flockworks(&[&["step"], arguments].concat());
    assert_eq!((run.code, run.err.as_str()), (Some(0), ""));
    serde_json::from_str(&run.out).unwrap()
}

/// Asserts that the input is refused in one message that has all these parts.
#[track_caller]
fn refused(arguments: &[&str], parts: &[&str]) {
    let run = flockworks(arguments);
    assert_eq!(run.code, Some(2), "{}{}", run.out, run.err);
    assert_eq!(run.out, "", "nothing on standard output");
    assert_eq!(run.err.trim_end().lines().count(), 1, "one message: {}", run.err);
    for part in parts {
        assert!(run.err.contains(part), "`{part}` is not in: {}", run.err);
    }
    assert!(!run.err.contains("backtrace"));
}

/// The case `pair`, changed, in a file.
fn changed(name: &str, change: impl FnOnce(&mut Value)) -> String {
    let mut case: Value = serde_json::from_str(&std::fs::read_to_string(data("cases/pair.json")).unwrap()).unwrap();
    change(&mut case);
    file(name, &case.to_string())
}

#[test]
fn a_step_prints_the_state_in_the_names_of_the_case() {
    let pair = data("cases/pair.json");
    let found = state(&[&pair]);
    let expected: Value = serde_json::from_str(&std::fs::read_to_string(&pair).unwrap()).unwrap();
    assert_eq!(found["pos"], expected["expected"]["pos"]);
    assert_eq!(found.as_object().unwrap().keys().collect::<Vec<_>>(), ["pos", "vel"]);
    let before = state(&[&pair, "--steps", "0"]);
    assert_eq!(before["pos"], expected["state"]["pos"]);
}

#[test]
fn printed_numbers_read_back_to_the_same_bits_so_that_steps_can_be_chained() {
    let pair = data("cases/pair.json");
    let once = state(&[&pair]);
    let next = changed("chained.json", |case| {
        case["state"] = once;
    });
    assert_eq!(state(&[&next]), state(&[&pair, "--steps", "2"]));
    assert_eq!(state(&[&pair, "--steps", "2", "--threads", "3"]), state(&[&pair, "--steps", "2"]));
}

#[test]
fn cases_of_a_file_are_chosen_by_name_or_index() {
    let several = data("cases/several.json");
    assert_eq!(state(&[&several])["pos"][0][0], 2.0);
    assert_eq!(state(&[&several, "--case", "viscido_snn/one-step"]), state(&[&several, "--case", "2"]));
    assert_eq!(state(&[&several, "--case", "viscido_snn"])["pos"][1][2], 3.0);
    let x = state(&[&several, "--case", "1", "--precision", "f32"])["pos"][0][0].as_f64().unwrap();
    assert!((x - 0.457_106_78).abs() < 1e-5 && x == f64::from(x as f32), "a 32-bit number: {x}");
    refused(&["step", &several, "--case", "vicsek_1995/sea"], &["vicsek_1995/sea", "vicsek_1995/seam"]);
    refused(&["step", &several, "--case", "3"], &["no case 3", "has 3"]);
}

#[test]
fn no_agents_are_no_error() {
    let none = changed("none.json", |case| {
        case["state"] = serde_json::json!({ "pos": [], "vel": [] });
    });
    assert_eq!(state(&[&none])["pos"], serde_json::json!([]));
}

#[test]
fn wrong_files_are_named_with_line_and_column() {
    refused(&["step", "/no/such/case.json"], &["/no/such/case.json", "cannot read"]);
    refused(&["step", &file("empty.json", " \n")], &["empty.json", "is empty"]);
    refused(&["step", &file("comma.json", "{\n  \"model\": \"vicsek_1995\",,\n}")], &["comma.json:2:26", "not JSON"]);
    refused(&["conformance", &file("cut.json", "{\"cases\": [")], &["cut.json:1:11", "not JSON"]);
    refused(&["step", &file("nan.json", "{\"model\": \"vicsek_1995\", \"dim\": NaN}")], &["nan.json:1:33", "not JSON"]);
    refused(&["step", &file("huge.json", "{\"model\": 1e999}")], &["huge.json:1", "out of range"]);
    refused(&["step", &file("list.json", "[1, 2]")], &["list.json", "expected an object"]);
    refused(&["step", &file("other.json", "{\"a\": 1}")], &["other.json", "expected a case"]);
    refused(&["step", &file("nocases.json", "{\"cases\": []}")], &["nocases.json", "cases: the list is empty"]);
    refused(&["step", env!("CARGO_MANIFEST_DIR")], &["cannot read"]);
}

#[test]
fn wrong_values_are_named_by_the_path_of_their_key() {
    let with = |name: &str, at: &[&str], value: Value| {
        changed(name, |case| {
            let mut place = case;
            for key in at {
                place = &mut place[*key];
            }
            *place = value;
        })
    };
    let of = |text: &str| serde_json::from_str::<Value>(text).unwrap();
    let step = |file: &str, parts: &[&str]| refused(&["step", file], parts);
    step(&with("m.json", &["model"], "viksek_1995".into()), &["m.json: model:", "viksek_1995", "`vicsek_1995`"]);
    step(&with("d.json", &["dim"], 1.into()), &["dim:", "2 or 3 dimensions, not in 1"]);
    step(&with("d4.json", &["dim"], 4.into()), &["dim: expected 1, 2 or 3, found 4"]);
    step(&with("k.json", &["stat"], 4.into()), &["unknown key `stat`", "`state`"]);
    step(&with("u.json", &["params", "raduis"], 4.into()), &["params:", "`raduis`", "did you mean `radius`"]);
    step(&with("r.json", &["params", "radius"], 0.into()), &["params.radius:", "must be more than 0, found 0"]);
    step(&with("t.json", &["params", "eta"], "big".into()), &["params.eta:", "takes a number, found \"big\""]);
    step(&with("n.json", &["params", "eta"], Value::Null), &["params.eta:", "expected a number"]);
    step(&with("a.json", &["aux", "nois"], of("[0, 0, 0]")), &["aux:", "`nois`", "did you mean `noise`"]);
    step(&with("c.json", &["aux", "noise"], of("[0, 0]")), &["aux.noise: expected 3 entries, found 2"]);
    step(&with("v.json", &["state", "vel"], of("[[0, 0]]")), &["state.vel: expected 3 entries, found 1"]);
    step(&with("p.json", &["state", "pos"], of("[[0, 0, 0]]")), &["state.pos[0]: expected 2 numbers, found 3"]);
    step(&with("x.json", &["state", "pos"], of("[[0, \"x\"]]")), &["state.pos[0][1]: expected a finite number"]);
    step(&with("theta.json", &["state", "tehta"], of("[1, 2, 3]")), &["state:", "no state `tehta`"]);
    step(&with("s.json", &["space", "kind"], "torus".into()), &["space.kind:", "periodic", "\"torus\""]);
    step(
        &with("z.json", &["space"], of(r#"{"kind": "periodic", "size": [0, 1]}"#)),
        &["space.size[0]:", "more than 0"],
    );
    step(&with("y.json", &["space"], of(r#"{"kind": "periodic"}"#)), &["space: `size` is missing"]);
    step(&with("w.json", &["params", "walls"], of("[[0, 0, 1]]")), &["params.walls[0]: expected 4 numbers"]);
    step(&with("b.json", &["params", "discs"], of("[[0, 0, -1]]")), &["obstacles"]);
    step(&with("o.json", &["aux", "obstacles"], of("[[0, 0]]")), &["aux.obstacles:", "r_obs"]);
    step(&with("both.json", &["aux"], of(r#"{"seed": 1, "noise": [0, 0, 0]}"#)), &["aux:", "seed", "noise"]);
    let several = changed("cases.json", |case| {
        let mut second = case.clone();
        second["params"]["dt"] = (-1).into();
        *case = serde_json::json!({ "cases": [case.clone(), second] });
    });
    refused(&["step", &several, "--case", "1"], &["cases.json: cases[1].params.dt:", "more than 0"]);
}

#[test]
fn a_full_disk_behind_standard_output_is_told_and_is_no_fault_of_ours() {
    let Ok(full) = std::fs::OpenOptions::new().write(true).open("/dev/full") else { return };
    let run = std::process::Command::new(env!("CARGO_BIN_EXE_flockworks")).arg("models").stdout(full).output().unwrap();
    assert_eq!(run.status.code(), Some(2));
    let told = String::from_utf8_lossy(&run.stderr);
    assert!(told.contains("cannot write to standard output") && !told.contains("os error"), "{told}");
}

#[test]
fn wrong_options_are_refused() {
    assert_eq!(flockworks(&["step"]).code, Some(2));
    assert_eq!(flockworks(&["stepp", "x.json"]).code, Some(2));
    assert_eq!(flockworks(&["step", "x.json", "--stepz", "2"]).code, Some(2));
    refused(&["models", "viksek_1995"], &["viksek_1995", "did you mean `vicsek_1995`"]);
    refused(&["run", "a.toml", "--seed", "-1"], &["`--seed <N>` takes a whole number, 0 or more, found `-1`"]);
    refused(&["run", "a.toml", "--seed", "soon"], &["`--seed <N>` takes a whole number", "found `soon`"]);
    refused(&["run", "a.toml", "--sed", "1"], &["`--sed` is not known here; did you mean `--seed`?"]);
    refused(&["run"], &["`<FILE>` is missing"]);
    refused(&["rn", "a.toml"], &["no command is called `rn`; did you mean `run`?"]);
    refused(&["analyze", "a.csv", "--scale", "-1"], &["`scale` must be more than 0"]);
    refused(&["bench", "W11"], &["W11", "did you mean `W1`"]);
    refused(&["bench", "--model", "viksek_1995"], &["did you mean `vicsek_1995`"]);
}

#[test]
fn a_seed_draws_the_same_noise_every_time_and_another_one_draws_another() {
    let seeded = |name: &str, seed: u64, step: u64| {
        changed(name, |case| {
            case["aux"] = serde_json::json!({ "seed": seed, "step": step });
            case["params"]["eta"] = 2.0.into();
        })
    };
    let first = state(&[&seeded("seed1.json", 1, 0)]);
    assert_eq!(first, state(&[&seeded("seed1.json", 1, 0)]));
    assert_ne!(first, state(&[&seeded("seed2.json", 2, 0)]));
    assert_ne!(first, state(&[&seeded("seed3.json", 1, 7)]));
}

#[test]
fn obstacles_of_a_case_do_not_stop_members_but_walls_of_the_space_do() {
    let through = changed("through.json", |case| {
        case["params"]["walls"] = serde_json::json!([[0.01, -1.0, 0.01, 1.0]]);
        case["params"]["discs"] = serde_json::json!([[2.9, 3.0, 0.05]]);
    });
    assert_eq!(state(&[&through]), state(&[&data("cases/pair.json")]));
    let inside = changed("inside.json", |case| {
        case["space"] = serde_json::json!({ "kind": "walls", "size": [3.0, 3.5] });
        case["state"]["vel"] = serde_json::json!([[-0.03, 0.0], [0.0, 0.03], [0.0, 0.03]]);
    });
    let found = state(&[&inside]);
    assert_eq!(found["pos"][0], serde_json::json!([0.0, 0.0]), "the move through the wall is not made");
    // with walls in the parameters beside it, too
    let both = changed("both.json", |case| {
        case["space"] = serde_json::json!({ "kind": "walls", "size": [3.0, 3.5] });
        case["state"]["vel"] = serde_json::json!([[-0.03, 0.0], [0.0, 0.03], [0.0, 0.03]]);
        case["params"]["walls"] = serde_json::json!([[1.0, 1.0, 2.0, 1.0]]);
    });
    assert_eq!(state(&[&both])["pos"][0], serde_json::json!([0.0, 0.0]));
}

#[test]
fn conformance_counts_and_its_exit_code_is_the_answer() {
    let several = data("cases/several.json");
    let run = flockworks(&["conformance", &several]);
    assert_eq!((run.code, run.out.lines().last()), (Some(0), Some("3 of 3")), "{}", run.out);
    let run = flockworks(&["conformance", &several, "--only", "vicsek_1995"]);
    assert_eq!((run.code, run.out.lines().last()), (Some(0), Some("2 of 2")));
    let run = flockworks(&["conformance", &several, "--precision", "f32"]);
    assert_eq!((run.code, run.out.lines().last()), (Some(0), Some("3 of 3")), "{}", run.out);
    refused(&["conformance", &several, "--only", "viscido_sn"], &["viscido_sn", "did you mean `viscido_snn`"]);
    refused(
        &["conformance", &changed("none.json", |file| *file = serde_json::json!({ "cases": [] }))],
        &["the list is empty"],
    );

    let fails = |name: &str, reason: &str, change: &dyn Fn(&mut Value)| {
        let run = flockworks(&["conformance", &changed(name, change)]);
        assert_eq!((run.code, run.out.lines().last()), (Some(1), Some("0 of 1")), "{name}: {}", run.out);
        assert!(run.out.contains(reason), "`{reason}` is not in: {}", run.out);
    };
    fails("off.json", "pos[0][0]: expected 0.030001, found 0.03", &|case| {
        case["expected"]["pos"][0][0] = 0.030_001.into();
    });
    fails("short.json", "pos: expected 2 entries, found 3", &|case| {
        case["expected"]["pos"] = serde_json::json!([[0.03, 0.0], [0.5, 0.03]]);
    });
    fails("absent.json", "theta: the model has no such state", &|case| case["expected"]["theta"] = 1.into());
    fails("unknown.json", "unknown model `viksek_1995`; did you mean `vicsek_1995`?", &|case| {
        case["model"] = "viksek_1995".into();
    });
    fails("bad.json", "params.radius: ", &|case| case["params"]["radius"] = (-1).into());
    fails("unsaid.json", "expected is missing", &|case| {
        case.as_object_mut().unwrap().remove("expected");
    });
}

/// The rows of a conformance table: model, case, result and reason.
fn results(path: &str) -> Vec<(String, String)> {
    let run = flockworks(&["conformance", path]);
    assert!(matches!(run.code, Some(0 | 1)), "{}", run.err);
    let lines: Vec<&str> = run.out.lines().collect();
    let table = &lines[2..lines.len() - 2];
    table.iter().map(|line| (line.split_whitespace().next().unwrap().to_owned(), (*line).to_owned())).collect()
}

#[test]
fn every_model_of_the_list_passes_all_its_cases() {
    for name in ["conformance", "behaviour_selection_steps", "competing_flocks_steps"] {
        let path = data(&format!("expected/{name}.json"));
        let cases: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let results = results(&path);
        assert_eq!(results.len(), cases["cases"].as_array().unwrap().len());
        for (model, line) in results {
            assert!(swarm::models::find(&model).is_some() && line.contains("  pass"), "{name}: {line}");
        }
    }
}

/// Cases that the program writes pass, and a wrong model is named.
#[test]
fn emitted_cases_pass_for_every_model() {
    for entry in swarm::models::LIST {
        let id = entry.card.id;
        let run = flockworks(&["conformance", "--emit", id]);
        assert_eq!(run.code, Some(0), "{id}: {}", run.err);
        let path = file(&format!("emitted-{id}.json"), &run.out);
        let again = flockworks(&["conformance", &path]);
        let passed = format!("{0} of {0}", 3 * entry.dimensions.len());
        assert_eq!((again.code, again.out.lines().last()), (Some(0), Some(passed.as_str())), "{id}: {}", again.out);
    }
    let other = flockworks(&["conformance", "--emit", "couzin_2002", "--seed", "2"]);
    assert_ne!(other.out, flockworks(&["conformance", "--emit", "couzin_2002"]).out);
    refused(&["conformance", "--emit", "couzin_2003"], &["couzin_2003", "did you mean `couzin_2002`"]);
    assert_eq!(flockworks(&["conformance", "--emit", "couzin_2002", "cases.json"]).code, Some(2));
}

#[test]
fn models_are_classified_and_chosen() {
    let csv = flockworks(&["models", "--table", "design", "--format", "csv"]).out;
    assert!(csv.starts_with("paper,model_ids,composition,"), "{csv}");
    assert!(
        csv.contains("\nHamilton 1971,hamilton_1d;hamilton_2d,homogeneous,idealized,discrete,none,no,yes,no,no,\n")
    );
    let table = flockworks(&["models", "--table", "validation", "--format", "md"]).out;
    assert!(table.contains("| Codling et al. 2007 | codling_2007 | S | yes | global | global | global |"), "{table}");
    let run = flockworks(&["models", "--table", "design", "--format", "json", "--where", "velocity=no collision=all"]);
    let json: Value = serde_json::from_str(&run.out).unwrap();
    let papers: Vec<&str> = json.as_array().unwrap().iter().map(|row| row["paper"].as_str().unwrap()).collect();
    assert_eq!(papers[..3], ["Mataric 1993", "Olfati-Saber 2006", "Arkin and Balch 1999"]);
    assert!(papers[3..].iter().all(|paper| paper.starts_with("ours: ")), "{papers:?}");
    assert!(flockworks(&["models", "--where", "collision=environment"]).out.contains("snn_plus"));
    refused(&["models", "--where", "colision_avoidance=all"], &["did you mean `collision_avoidance`?"]);
    refused(&["models", "--where", "time=discreet"], &["did you mean `discrete`?"]);
    for table in [&[][..], &["--table", "design"], &["--format", "json"]] {
        let none = ["models", "--where", "velocity=no velocity=yes"];
        refused(&[&none, table].concat(), &["no model meets both `velocity=no` and `velocity=yes`"]);
    }
    assert_eq!(flockworks(&["models", "vicsek_1995", "--where", "time=discrete"]).code, Some(2));
    refused(&["models", "vicsek_1995", "--format", "csv"], &["no csv form"]);
}

#[test]
fn every_model_of_the_list_can_be_shown_in_every_format() {
    let list = flockworks(&["models"]);
    let json: Value = serde_json::from_str(&flockworks(&["models", "--format", "json"]).out).unwrap();
    assert_eq!(json.as_array().unwrap().len(), swarm::models::LIST.len());
    assert!(flockworks(&["models", "--format", "md"]).out.starts_with("| id | title |"));
    for entry in swarm::models::LIST {
        let card = entry.card;
        assert!(list.out.lines().any(|line| line.starts_with(card.id) && line.contains(card.about)), "{}", card.id);
        let text = flockworks(&["models", card.id]);
        assert_eq!((text.code, text.err.as_str()), (Some(0), ""));
        let markdown = flockworks(&["models", card.id, "--format", "md"]).out;
        for part in ["Reference", "Equations", "Stages", "Parameters", "Departures", "Classification"] {
            assert!(text.out.contains(part), "{}: {part}", card.id);
            assert!(markdown.contains(&format!("## {part}")), "{}: {part}", card.id);
        }
        let json: Value = serde_json::from_str(&flockworks(&["models", card.id, "--format", "json"]).out).unwrap();
        let named: Vec<&str> =
            json["parameters"].as_array().unwrap().iter().map(|p| p["name"].as_str().unwrap()).collect();
        let expected: Vec<&str> = (entry.parameters)().iter().map(|p| p.name).collect();
        assert_eq!(named, expected, "{}", card.id);
        assert!(expected.iter().all(|name| text.out.contains(name)), "{}", card.id);
    }
}

const ROW: [&str; 10] = [
    "workload",
    "agents",
    "threads",
    "precision",
    "steps",
    "wall_s",
    "cpu_s",
    "agent_updates_per_s",
    "useful_pairs_per_s",
    "mean_neighbours",
];

#[test]
fn bench_prints_objects_with_the_promised_names() {
    let run = flockworks(&["bench", "W1", "--agents", "40,80", "--steps", "2", "--repeats", "1", "--json"]);
    assert_eq!((run.code, run.err.as_str()), (Some(0), ""));
    let rows: Value = serde_json::from_str(&run.out).unwrap();
    for row in rows.as_array().unwrap() {
        assert_eq!(row.as_object().unwrap().keys().collect::<Vec<_>>(), ROW);
        assert!(row["wall_s"].as_f64().unwrap() > 0.0 && row["mean_neighbours"].as_f64().unwrap() > 1.0);
    }
    let run = flockworks(&["bench", "--model", "vicsek_1995", "--agents", "40", "--repeats", "1", "--json"]);
    let rows: Value = serde_json::from_str(&run.out).unwrap();
    let names: Vec<&str> = rows.as_array().unwrap().iter().map(|row| row["workload"].as_str().unwrap()).collect();
    assert_eq!(names, ["models/vicsek_1995", "plain/vicsek_1995"]);
}

#[test]
fn bench_prints_a_table_and_the_growth_of_the_cost() {
    let run = flockworks(&["bench", "W1", "--agents", "40,80", "--threads", "1", "--steps", "2", "--repeats", "1"]);
    let lines: Vec<&str> = run.out.lines().collect();
    assert_eq!(lines.len(), 5, "{}", run.out);
    assert!(lines[4].starts_with("growth W1, 1 thread, f32: an agent costs"), "{}", lines[4]);
}

#[test]
fn a_reader_that_goes_away_ends_it_quietly() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_flockworks"))
        .args(["models", "--format", "json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let run = child.wait_with_output().unwrap();
    assert_eq!((run.status.code(), run.stderr.as_slice()), (Some(0), &b""[..]));
}

#[test]
fn help_says_what_there_is() {
    let help = flockworks(&["--help"]);
    assert_eq!(help.code, Some(0));
    for command in ["step", "conformance", "models", "bench", "Exit codes"] {
        assert!(help.out.contains(command), "{command}");
    }
    assert!(flockworks(&["bench", "--help"]).out.contains("W4"));
}
