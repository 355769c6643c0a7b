//! The page of an evolution: fitness and genes over the generations, the champions, and what was done.

use super::execute::{CHAMPION, Run};
use super::form::Search;
use super::plan::Plan;
use super::tables::Spread;
use crate::report::of_run::{paragraphs, short};
use crate::report::{Axis, Fact, Figure, Line, Lines, Page, Table};
use measure::statistics::{linear_regression, mean_interval};

/// Points of a line, at most: the generations between are averaged.
const POINTS: usize = 500;

/// The page.
pub fn page(plan: &Plan, runs: &[Run], program: &str) -> Page {
    let champions: Vec<(usize, &[f64], f64)> = runs
        .iter()
        .enumerate()
        .filter_map(|(k, run)| run.champion(plan).map(|(genes, score)| (k, genes, score)))
        .collect();
    let mut figures = vec![
        fitness(plan, runs, "fitness-mean", "Mean fitness of a generation", |spread| spread.mean),
        fitness(plan, runs, "fitness-best", "Best fitness of a generation", |spread| spread.best),
    ];
    figures.extend(kept(plan, runs));
    figures.extend(genes(plan, runs));
    Page {
        title: plan.form.title.clone(),
        lead: paragraphs(&plan.form.about),
        methods: methods(plan),
        summary: summary(plan, runs, &champions),
        figures: figures.into_iter().map(Figure::Lines).collect(),
        tables: vec![champion_table(plan, &champions)],
        command: format!("flockworks run {}", plan.sources.name(0)),
        source: plan.sources.text(0).to_owned(),
        made_by: format!("{program}, seed {}", plan.form.seed),
    }
}

/// A line of one value of each generation, thinned by averaging.
fn thinned(name: String, values: &[f64]) -> Line {
    let width = values.len().div_ceil(POINTS).max(1);
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (k, part) in values.chunks(width).enumerate() {
        let there: Vec<f64> = part.iter().copied().filter(|value| value.is_finite()).collect();
        x.push(k as f64 * width as f64 + (part.len() as f64 - 1.0) / 2.0);
        y.push((!there.is_empty()).then(|| there.iter().sum::<f64>() / there.len() as f64));
    }
    Line { name, x, y }
}

fn thinning(generations: usize) -> String {
    match generations.div_ceil(POINTS) {
        0 | 1 => String::new(),
        width => format!(" Each point is the mean of {width} generations."),
    }
}

/// Lines shown at most: one more would not be told apart.
const LINES: usize = 8;

fn over_generations(
    plan: &Plan,
    runs: &[Run],
    (id, title, about): (&str, &str, &str),
    y: Axis,
    value: impl Fn(&super::execute::Generation) -> f64,
) -> Lines {
    let line = |(k, run): (usize, &Run)| {
        let values: Vec<f64> = run.generations.iter().map(&value).collect();
        thinned(format!("run {}", k + 1), &values)
    };
    let shown = if runs.len() > LINES { format!(" The first {LINES} of {} runs.", runs.len()) } else { String::new() };
    Lines {
        id: id.to_owned(),
        title: title.to_owned(),
        about: format!("{about}{}{shown}", thinning(plan.generations)),
        x: Axis { label: "generation".into(), unit: String::new(), range: None },
        y,
        lines: runs.iter().enumerate().take(LINES).map(line).collect(),
    }
}

fn fitness(plan: &Plan, runs: &[Run], id: &str, title: &str, of: impl Fn(Spread) -> f64) -> Lines {
    let y = Axis { label: "fitness".into(), unit: String::new(), range: None };
    let about = format!("Fitness is {}.", plan.form.fitness);
    over_generations(plan, runs, (id, title, &about), y, |one| of(Spread::of(&one.evaluated.scores)))
}

/// What was kept: of a shared world as it is, of candidates the mean.
fn kept(plan: &Plan, runs: &[Run]) -> Vec<Lines> {
    let names: Vec<String> = plan.kept().into_iter().map(str::to_owned).collect();
    let lines = |(k, name): (usize, &String)| {
        let y = Axis { label: name.clone(), unit: String::new(), range: None };
        let about = match plan.shared {
            Some(_) => format!("{} at the end of the world of a generation.", plan.form.keep.0[k].1),
            None => "The mean of a generation.".to_owned(),
        };
        over_generations(plan, runs, (&format!("kept-{name}"), name, &about), y, |one| {
            let values: Vec<f64> = one.evaluated.kept.iter().filter_map(|row| row.get(k).copied()).collect();
            Spread::of(&values).mean
        })
    };
    names.iter().enumerate().map(lines).collect()
}

/// Mean of each gene over its reference.
fn genes(plan: &Plan, runs: &[Run]) -> Vec<Lines> {
    let lines = |(k, gene): (usize, &super::plan::GeneAxis)| {
        let unit = if gene.unit == "-" { String::new() } else { gene.unit.clone() };
        let y = Axis { label: gene.name.clone(), unit, range: None };
        let about = format!("{}: the mean of a generation. The reference is {}.", gene.about, gene.axis.reference);
        over_generations(plan, runs, (&format!("gene-{}", gene.name), &gene.name, &about), y, |one| {
            one.candidates.iter().map(|genes| genes[k]).sum::<f64>() / one.candidates.len() as f64
        })
    };
    plan.axes.iter().enumerate().map(lines).collect()
}

fn summary(plan: &Plan, runs: &[Run], champions: &[(usize, &[f64], f64)]) -> Vec<Fact> {
    let fact = |label: &str, value: String| Fact { label: label.into(), value };
    let candidates = runs.first().and_then(|run| run.generations.first()).map_or(0, |one| one.candidates.len());
    let mut facts = vec![
        fact("Runs", runs.len().to_string()),
        fact("Generations", plan.generations.to_string()),
        fact("Candidates", candidates.to_string()),
        fact("Genes", plan.axes.len().to_string()),
    ];
    if let Some((run, _, score)) =
        champions.iter().copied().reduce(|best, other| if other.2 > best.2 { other } else { best })
    {
        facts.push(fact("Fitness of the champion", format!("{} (run {})", short(score), run + 1)));
    }
    // whether fitness rises: a slope for each run, judged over runs, since one run may drift anywhere
    let slopes: Vec<f64> = runs
        .iter()
        .filter_map(|run| {
            let points = run.generations.iter().enumerate();
            let points: Vec<(f64, f64)> = points
                .map(|(k, one)| (k as f64, Spread::of(&one.evaluated.scores).mean))
                .filter(|(_, mean)| mean.is_finite())
                .collect();
            let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
            Some(linear_regression(&x, &y, 0.95).ok()?.slope * 1000.0)
        })
        .collect();
    match mean_interval(&slopes, 0.95) {
        Ok(interval) => facts.push(fact(
            "Slope of the mean fitness per 1000 generations, over runs",
            format!(
                "{} (95 % {} to {})",
                short(slopes.iter().sum::<f64>() / slopes.len() as f64),
                short(interval.low),
                short(interval.high)
            ),
        )),
        Err(_) => {
            if let [slope] = slopes.as_slice() {
                facts.push(fact("Slope of the mean fitness per 1000 generations", short(*slope)));
            }
        }
    }
    facts
}

fn methods(plan: &Plan) -> Vec<String> {
    let search = match &plan.form.search {
        Search::Genetic(genetic) => format!(
            "A genetic algorithm of {} candidates: {} selection, {} crossover, {} mutation of one gene in {} % of offspring, {}",
            plan.candidates(genetic),
            genetic.selection.replace('_', " "),
            genetic.crossover.replace('_', "-"),
            genetic.mutation,
            short(genetic.mutation_rate * 100.0),
            match genetic.elite {
                0 => "and no elite.".to_owned(),
                elite => format!("and an elite of {elite}."),
            }
        ),
        Search::CmaEs(_) => "CMA-ES, which begins at the references of the genes.".to_owned(),
        Search::MapElites(form) => {
            let kinds: Vec<&str> = form.kind.0.iter().map(|(name, _)| name.as_str()).collect();
            format!("MAP-Elites with {} cells over {}.", form.cells, kinds.join(", "))
        }
    };
    let worlds = match &plan.shared {
        Some(shared) => format!(
            "All candidates of a generation live in one world, new in every generation, where each owns {} of the {} \
             members of `{}`; its fitness is the mean of theirs at the end.",
            shared.members, shared.count, plan.scenario.group.0[shared.group].0
        ),
        None => format!(
            "Each candidate is tried in {} of its own, with the same seeds for all; its fitness is the mean.",
            if plan.form.trials == 1 { "a world".to_owned() } else { format!("{} worlds", plan.form.trials) }
        ),
    };
    let confirmed = match plan.form.confirm {
        0 => String::new(),
        worlds => format!(
            " The candidates of the last generation are tried again in {worlds} worlds that no generation had, and the \
             champion is the best of them on average; `{CHAMPION}` has it as a scenario."
        ),
    };
    vec![
        format!("{search} Fitness, the larger the better: {}.", plan.form.fitness),
        format!("{worlds}{confirmed}"),
        format!(
            "A world has {} agents and {} steps. {} independent {} with the seeds {} to {}.",
            plan.agents,
            plan.schedule.steps,
            plan.form.runs,
            if plan.form.runs == 1 { "run" } else { "runs" },
            plan.seed_of(1),
            plan.seed_of(plan.form.runs)
        ),
    ]
}

fn champion_table(plan: &Plan, champions: &[(usize, &[f64], f64)]) -> Table {
    let names: Vec<&str> = plan.axes.iter().map(|gene| gene.name.as_str()).collect();
    let mut csv = format!("run,fitness,{}\n", names.join(","));
    for (run, genes, score) in champions {
        let genes: Vec<String> = genes.iter().map(ToString::to_string).collect();
        csv += &format!("{},{score},{}\n", run + 1, genes.join(","));
    }
    Table { file: "champions.csv".into(), about: "The champion of each run: fitness and genes.".into(), csv }
}
