//! The page of a study.
use super::execute::Results;
use super::plan::Plan;
use crate::report::Page;

/// The page.
pub fn page(plan: &Plan, _results: &Results, program: &str) -> Page {
    Page { title: plan.title.clone(), made_by: program.to_owned(), ..Page::default() }
}
