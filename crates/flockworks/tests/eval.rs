//! `flockworks eval` as a user meets it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use serde_json::{Value, json};
use std::path::PathBuf;
use std::process::Command;

/// The exit code, standard output and standard error for a file.
fn eval(path: &str) -> (Option<i32>, String, String) {
    let run = Command::new(env!("CARGO_BIN_EXE_flockworks")).args(["eval", path]).output().unwrap();
    (run.status.code(), String::from_utf8(run.stdout).unwrap(), String::from_utf8(run.stderr).unwrap())
}

/// The same for a file of these contents, in this run of the tests.
fn eval_text(name: &str, text: &str) -> (Option<i32>, String, String) {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).unwrap();
    eval(path.to_str().unwrap())
}

/// Whether two values agree, numbers within a tolerance.
fn agree(expected: &Value, found: &Value, tolerance: f64) -> bool {
    match (expected, found) {
        (Value::Number(e), Value::Number(f)) => (e.as_f64().unwrap() - f.as_f64().unwrap()).abs() <= tolerance,
        (Value::Array(e), Value::Array(f)) => {
            e.len() == f.len() && e.iter().zip(f).all(|(e, f)| agree(e, f, tolerance))
        }
        _ => expected == found,
    }
}

#[test]
fn every_case_comes_out_as_expected() {
    let path = format!("{}/tests/cases/eval.json", env!("CARGO_MANIFEST_DIR"));
    let file: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let (code, out, err) = eval(&path);
    assert_eq!((code, err.as_str()), (Some(0), ""));
    let answers: Value = serde_json::from_str(&out).unwrap();
    let cases = file["cases"].as_array().unwrap();
    assert_eq!(answers.as_object().unwrap().len(), cases.len());
    for case in cases {
        let id = case["id"].as_str().unwrap();
        let tolerance = case["tol"].as_f64().unwrap_or(0.0);
        assert!(agree(&case["expected"], &answers[id], tolerance), "{id}: {} for {}", answers[id], case["expected"]);
    }
}

#[test]
fn what_cannot_be_answered_is_named_case_by_case_beside_what_can() {
    let cases = json!({ "cases": [
        { "id": "good", "kind": "x_sd", "input": { "x": [0, 2] } },
        { "id": "kind", "kind": "segment_clas", "input": {} },
        { "id": "key", "kind": "x_sd", "input": { "y": [0, 2] } },
        { "id": "missing", "kind": "dirt", "input": { "anchor": [0, 0], "length": 1 } },
        { "id": "value", "kind": "segment_class", "input": { "a": [0, 0, 1], "b": [0, 0, 1, 1] } },
        { "id": "rules", "kind": "sirt", "input": { "anchor": [0, 0], "x_res": 1, "y_res": 1, "rules": [4], "k": 2 } },
        { "id": "k", "kind": "sirt", "input": { "anchor": [0, 0], "x_res": 1, "y_res": 1, "rules": [1], "k": 5 } },
        { "id": "mode", "kind": "posts", "input": { "wall": [0, 0, 1, 0], "per_wall": 2, "mode": "cell" } },
        { "id": "rows", "kind": "assignment_cost", "input": { "cost": [[1], [2]] } },
        { "id": "weights", "kind": "splitting_pass", "input": { "weights": [0, 0, 0] } },
        { "id": "far", "kind": "point_segment_distance", "input": { "p": [1e99, 0], "s": [0, 0, 1, 0] } },
        { "id": "extra", "kind": "x_sd", "input": { "x": [0] }, "inputs": 1 },
    ]});
    let (code, out, err) = eval_text("refused.json", &cases.to_string());
    assert_eq!(code, Some(2));
    let answers: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(answers["good"], json!(2f64.sqrt()));
    for (id, part) in [
        ("kind", "did you mean `segment_class`?"),
        ("key", "unknown key `y`"),
        ("missing", "`angle_deg` is missing"),
        ("value", "cases[4].input.a: expected 4 numbers, found 3"),
        ("rules", "expected 1, 2 or 3, found 4"),
        ("k", "k = 5 asks for 4 rules, found 1"),
        ("mode", "did you mean `cells`?"),
        ("rows", "no more rows than columns"),
        ("weights", "sum of the weights"),
        ("far", "at most 1e70 in size"),
        ("extra", "did you mean `input`?"),
    ] {
        let line =
            err.lines().find(|line| line.contains(&format!(": {id}: "))).unwrap_or_else(|| panic!("{id}: {err}"));
        assert!(line.contains(part), "{line}");
        assert!(answers[id]["error"].as_str().unwrap().contains(part), "{}", answers[id]);
    }
    assert_eq!(err.lines().count(), 11);
}

#[test]
fn wrong_files_give_one_message_and_no_answers() {
    for (name, text, part) in [
        ("eval_empty.json", "", "is empty"),
        ("eval_list.json", "[]", "expected an object"),
        ("eval_none.json", "{}", "`cases` is missing"),
        ("eval_key.json", r#"{"cases": [], "case": 1}"#, "did you mean `cases`?"),
        ("eval_id.json", r#"{"cases": [{"kind": "x_sd"}]}"#, "`id` is missing"),
        ("eval_twice.json", r#"{"cases": [{"id": "a"}, {"id": "a"}]}"#, "comes twice"),
        ("eval_cut.json", r#"{"cases": ["#, "not JSON"),
    ] {
        let (code, out, err) = eval_text(name, text);
        assert_eq!((code, out.as_str()), (Some(2), ""), "{err}");
        assert!(err.lines().count() == 1 && err.contains(name) && err.contains(part), "{err}");
    }
    assert_eq!(eval_text("eval_no_cases.json", r#"{"cases": []}"#), (Some(0), "{}\n".into(), String::new()));
}
