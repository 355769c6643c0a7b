//! The page of an evolution: fitness and genes over the generations, the champions, and what was done.

use super::answers;
use super::contest::{self, Contest};
use super::evaluate::followed;
use super::execute::{CHAMPION, Generation, Run};
use super::form::Search;
use super::plan::Plan;
use super::tables::Spread;
use super::variants::Variants;
use crate::report::of_run::{paragraphs, short};
use crate::report::{Axis, Fact, Figure, Line, Lines, Listing, Page, Table};
use crate::study::claims::Judgement;
use crate::study::execute::Results;
use crate::study::plan::Plan as Study;
use crate::study::report::{Answers, csv};
use measure::statistics::{linear_regression, mean_interval, paired_t_test};

/// Points of a line, at most: the generations between are averaged.
const POINTS: usize = 500;
/// Periods whose alleles are counted.
const PERIODS: usize = 4;
/// Classes of values in which alleles are counted.
const CLASSES: usize = 24;
/// Generations of a period whose alleles are counted, at most, evenly over the period.
const COUNTED: usize = 200;

/// A champion: place of its run among all, genes, score.
type Champion<'a> = (usize, &'a [f64], f64);

/// What an evolution was asked, beside its results put as those of a study.
pub struct Asked {
    study: Study,
    results: Results,
    /// The statements with what the data say of them.
    pub judgements: Vec<Judgement>,
}

impl Asked {
    /// Of all runs and contests.
    pub fn of(variants: &Variants, runs: &[Run], contests: &[Contest]) -> Self {
        let (study, results) = answers::of(variants, runs, contests);
        let judgements = crate::study::report::judgements(&study, &results);
        Self { study, results, judgements }
    }
}

/// The page.
pub fn page(variants: &Variants, runs: &[Run], (contests, asked): (&[Contest], &Asked), program: &str) -> Page {
    let plan = variants.first();
    let of = |(k, run): (usize, &'_ Run)| {
        (k, run.champion(&variants.plans[variants.of_run(k).0]).map(|(g, s)| (g.to_vec(), s)))
    };
    let found: Vec<(usize, Vec<f64>, f64)> =
        runs.iter().enumerate().map(of).filter_map(|(k, champion)| champion.map(|(g, s)| (k, g, s))).collect();
    let champions: Vec<Champion<'_>> = found.iter().map(|(k, genes, score)| (*k, genes.as_slice(), *score)).collect();
    let course = Course { variants, runs };
    let mut figures = course.panels();
    figures.extend(course.fitness("fitness-mean", "Mean fitness of a generation", |spread| spread.mean));
    figures.extend(course.fitness("fitness-best", "Best fitness of a generation", |spread| spread.best));
    figures.extend(course.kept());
    figures.extend(course.followed());
    figures.extend(course.genes());
    let mut figures: Vec<Figure> = figures.into_iter().map(Figure::Lines).collect();
    let (alleles, counts) = alleles(variants, runs);
    figures.extend(alleles.into_iter().map(Figure::Lines));
    let mut tables = vec![champion_table(variants, &champions), counts];
    for (variant, contest) in contests.iter().enumerate() {
        figures.push(Figure::Listing(contenders(variants, variant, contest)));
    }
    let mut methods = methods(variants);
    let mut summary = summary(variants, runs, &champions);
    if asks(plan) {
        let Answers { figures: drawn, sentences, tables: more, facts } =
            crate::study::report::answers(&asked.study, &asked.results, &asked.judgements);
        // what was asked comes first
        figures = drawn.into_iter().chain(figures).collect();
        methods.extend(sentences);
        tables.extend(more);
        summary.extend(facts);
    }
    Page {
        title: plan.form.title.clone(),
        lead: paragraphs(&plan.form.about),
        methods,
        summary,
        figures,
        tables,
        command: format!("flockworks run {}{}", plan.sources.name(0), if plan.quick { " --quick" } else { "" }),
        source: plan.sources.text(0).to_owned(),
        made_by: format!("{program}, seed {}", plan.form.seed),
    }
}

/// Whether anything is asked of the results.
fn asks(plan: &Plan) -> bool {
    let form = &plan.form;
    !(form.figure.is_empty() && form.test.is_empty() && form.claim.is_empty() && form.contest.is_none())
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

/// Lines of a figure, at most: one more would not be told apart.
const LINES: usize = 8;

fn generations() -> Axis {
    Axis { label: "generation".into(), unit: String::new(), range: None }
}

/// The course of the generations.
struct Course<'a> {
    variants: &'a Variants,
    runs: &'a [Run],
}

impl Course<'_> {
    /// A value of each generation of a run.
    fn of_run(&self, run: usize, value: &dyn Fn(&Plan, &Generation) -> f64) -> Vec<f64> {
        let plan = &self.variants.plans[self.variants.of_run(run).0];
        self.runs[run].generations.iter().map(|one| value(plan, one)).collect()
    }

    /// The mean of it over the runs of a variant.
    fn of_variant(&self, variant: usize, value: &dyn Fn(&Plan, &Generation) -> f64) -> Vec<f64> {
        let each = self.variants.runs();
        let own: Vec<Vec<f64>> = (variant * each..(variant + 1) * each).map(|run| self.of_run(run, value)).collect();
        let mean = |k: usize| Spread::of(&own.iter().filter_map(|run| run.get(k).copied()).collect::<Vec<_>>()).mean;
        (0..self.variants.plans[variant].generations).map(mean).collect()
    }

    /// What is said of the points of lines.
    fn points(&self, about: &str) -> String {
        let (plan, each) = (self.variants.first(), self.variants.runs());
        let several = self.variants.plans.len() > 1;
        let means = if several && each > 1 { format!(" Means of {each} runs.") } else { String::new() };
        format!("{about}{}{means}", thinning(plan.generations))
    }

    /// A line for each run; where variants differ, one for each of them, the mean of its runs. Several figures where the lines
    /// of one would not be told apart.
    fn lines(
        &self,
        (id, title, about): (&str, &str, &str),
        y: Axis,
        value: impl Fn(&Plan, &Generation) -> f64,
    ) -> Vec<Lines> {
        let Self { variants, runs } = self;
        let several = variants.plans.len() > 1;
        let all = if several { variants.plans.len() } else { runs.len() };
        let line = |k: usize| match several {
            true => thinned(variants.name(k), &self.of_variant(k, &value)),
            false => thinned(format!("run {}", k + 1), &self.of_run(k, &value)),
        };
        let about = self.points(about);
        let parts = all.div_ceil(LINES).max(1);
        let part = |part: usize| Lines {
            id: if part == 0 { id.to_owned() } else { format!("{id}-{}", part + 1) },
            title: if parts == 1 { title.to_owned() } else { format!("{title}, part {} of {parts}", part + 1) },
            about: about.clone(),
            x: generations(),
            y: y.clone(),
            lines: (all * part / parts..all * (part + 1) / parts).map(line).collect(),
        };
        (0..parts).map(part).collect()
    }

    /// A figure for each variant: the fitness of the best, of all in the mean, and of the worst.
    fn panels(&self) -> Vec<Lines> {
        let variants = self.variants;
        if variants.plans.len() < 2 {
            return Vec::new();
        }
        let kinds: [(&str, fn(&Spread) -> f64); 3] =
            [("best", |spread| spread.best), ("mean", |spread| spread.mean), ("worst", |spread| spread.worst)];
        let panel = |variant: usize| Lines {
            id: format!("fitness-{}", variant + 1),
            title: format!("Fitness: {}", variants.name(variant)),
            about: self.points("The best candidate of a generation, the mean of all, the worst."),
            x: generations(),
            y: Axis { label: "fitness".into(), unit: String::new(), range: None },
            lines: kinds
                .iter()
                .map(|(name, of)| {
                    let value = |plan: &Plan, one: &Generation| of(&Spread::of(plan.own(&one.evaluated.scores)));
                    thinned((*name).to_owned(), &self.of_variant(variant, &value))
                })
                .collect(),
        };
        (0..variants.plans.len()).map(panel).collect()
    }

    fn fitness(&self, id: &str, title: &str, of: impl Fn(Spread) -> f64) -> Vec<Lines> {
        let y = Axis { label: "fitness".into(), unit: String::new(), range: None };
        let about = format!("Fitness is {}.", self.variants.first().form.fitness);
        self.lines((id, title, &about), y, |plan, one| of(Spread::of(plan.own(&one.evaluated.scores))))
    }

    /// What was kept: of a shared world as it is, of candidates the mean.
    fn kept(&self) -> Vec<Lines> {
        let plan = self.variants.first();
        let lines = |(k, name): (usize, &str)| {
            let y = Axis { label: name.to_owned(), unit: answers::unit_of(plan, name), range: None };
            let about = match plan.shared {
                Some(_) => format!("{} at the end of the world of a generation.", plan.form.keep.0[k].1),
                None => "The mean of a generation.".to_owned(),
            };
            self.lines((&format!("kept-{name}"), name, &about), y, |_, one| {
                Spread::of(&one.evaluated.kept.iter().filter_map(|row| row.get(k).copied()).collect::<Vec<_>>()).mean
            })
        };
        plan.kept().into_iter().enumerate().flat_map(lines).collect()
    }

    /// What is followed beside the genes, the mean of a generation.
    fn followed(&self) -> Vec<Lines> {
        let plan = self.variants.first();
        let reference = followed(plan, &plan.reference());
        let lines = |(k, (name, text)): (usize, &(String, String))| {
            let y = Axis { label: name.clone(), unit: String::new(), range: None };
            let about = format!("{text}: the mean of a generation. Of the references it is {}.", short(reference[k]));
            self.lines((&format!("follow-{name}"), name, &about), y, |plan, one| {
                let own = plan.own(&one.candidates).iter();
                Spread::of(&own.map(|genes| followed(plan, genes)[k]).collect::<Vec<_>>()).mean
            })
        };
        plan.form.follow.0.iter().enumerate().flat_map(lines).collect()
    }

    /// Mean of each gene over its reference.
    fn genes(&self) -> Vec<Lines> {
        let lines = |(k, gene): (usize, &super::plan::GeneAxis)| {
            let unit = if gene.unit == "-" { String::new() } else { gene.unit.clone() };
            let y = Axis { label: gene.name.clone(), unit, range: None };
            let about = format!("{}: the mean of a generation. The reference is {}.", gene.about, gene.axis.reference);
            self.lines((&format!("gene-{}", gene.name), &gene.name, &about), y, |plan, one| {
                let own = plan.own(&one.candidates);
                own.iter().map(|genes| genes[k]).sum::<f64>() / own.len() as f64
            })
        };
        self.variants.first().axes.iter().enumerate().flat_map(lines).collect()
    }
}

/// Which alleles there are of each gene, and of what is followed, in each period: shares by classes of values.
fn alleles(variants: &Variants, runs: &[Run]) -> (Vec<Lines>, Table) {
    let plan = variants.first();
    let genes = plan.axes.len();
    let names: Vec<&str> =
        plan.axes.iter().map(|axis| axis.name.as_str()).chain(plan.follow.iter().map(|(n, _)| n.as_str())).collect();
    // values of each number in each period, `[numbers][periods][candidates]`
    let mut values = vec![vec![Vec::new(); PERIODS]; names.len()];
    for run in runs {
        let count = run.generations.len();
        for period in 0..PERIODS {
            let part = &run.generations[count * period / PERIODS..count * (period + 1) / PERIODS];
            for one in part.iter().step_by(part.len().div_ceil(COUNTED).max(1)) {
                for candidate in plan.own(&one.candidates) {
                    let more = followed(plan, candidate);
                    for (k, &value) in candidate.iter().chain(&more).enumerate() {
                        values[k][period].push(value);
                    }
                }
            }
        }
    }
    let (mut figures, mut rows) =
        (Vec::new(), vec![["number", "from", "to", "period", "share"].map(str::to_owned).to_vec()]);
    for (k, (name, periods)) in names.iter().zip(&values).enumerate() {
        let mut all: Vec<f64> = periods.iter().flatten().copied().filter(|value| value.is_finite()).collect();
        all.sort_by(f64::total_cmp);
        // a few that have gone far would press all others into one class
        let at = |share: f64| all.get(((all.len() as f64 - 1.0).max(0.0) * share) as usize).copied();
        let (Some(low), Some(high)) = (at(0.01), at(0.99)) else { continue };
        if low >= high {
            continue;
        }
        let width = (high - low) / CLASSES as f64;
        let middles: Vec<f64> = (0..CLASSES).map(|class| low + (class as f64 + 0.5) * width).collect();
        let line = |(period, values): (usize, &Vec<f64>)| {
            let mut counts = [0usize; CLASSES];
            for value in values {
                counts[(((value - low) / width).max(0.0) as usize).min(CLASSES - 1)] += 1;
            }
            let shares: Vec<f64> = counts.iter().map(|&count| count as f64 / values.len().max(1) as f64).collect();
            for (class, share) in shares.iter().enumerate() {
                let from = low + class as f64 * width;
                rows.push(vec![
                    (*name).to_owned(),
                    from.to_string(),
                    (from + width).to_string(),
                    (period + 1).to_string(),
                    share.to_string(),
                ]);
            }
            let name = format!("quarter {}", period + 1);
            Line { name, x: middles.clone(), y: shares.into_iter().map(Some).collect() }
        };
        let lines = periods.iter().enumerate().map(line).collect();
        let reference =
            if k < genes { plan.axes[k].axis.reference } else { followed(plan, &plan.reference())[k - genes] };
        figures.push(Lines {
            id: format!("alleles-{name}"),
            title: format!("Alleles of {name}"),
            about: format!(
                "Share of the candidates of all runs, by quarters of the generations, in {CLASSES} classes of equal width; \
                 the outermost hold what lies beyond. The reference is {}.",
                short(reference)
            ),
            x: Axis { label: (*name).to_owned(), unit: String::new(), range: None },
            y: Axis { label: "share".into(), unit: String::new(), range: None },
            lines,
        });
    }
    let about = "Shares of the candidates by classes of the values of each gene, for each quarter of the generations.";
    (figures, Table { file: "alleles.csv".into(), about: about.into(), csv: csv(&rows) })
}

/// Contenders, each compared with the champion in the same worlds.
fn contenders(variants: &Variants, variant: usize, contest: &Contest) -> Listing {
    let champion = contest.find(contest::CHAMPION).map(contest::Contender::scores).unwrap_or_default();
    let row = |who: &contest::Contender| {
        let scores = who.scores();
        let spread = Spread::of(&scores);
        let mut row = vec![who.name.clone(), short(spread.mean), short(spread.deviation)];
        let differences: Vec<f64> = champion.iter().zip(&scores).map(|(own, other)| own - other).collect();
        let won = differences.iter().filter(|&&difference| difference > 0.0).count();
        match paired_t_test(&champion, &scores, 0.95) {
            Ok(test) => row.extend([
                short(test.difference),
                format!("{} to {}", short(test.low), short(test.high)),
                format!("t({}) = {}", short(test.degrees), short(test.t)),
                if test.p < 0.001 { "< 0.001".to_owned() } else { format!("{:.3}", test.p) },
                short(test.difference / Spread::of(&differences).deviation),
                format!("{won} of {}", scores.len()),
            ]),
            // the champion itself, or a single world
            Err(_) => row.extend(vec![String::new(); 6]),
        }
        row
    };
    let name = variants.name(variant);
    let names = [
        "contender",
        "fitness",
        "sd",
        "champion less this",
        "95 % interval",
        "paired t",
        "p",
        "effect (d_z)",
        "worlds won",
    ];
    Listing {
        title: if name.is_empty() { "Contest".to_owned() } else { format!("Contest: {name}") },
        about: format!(
            "Every contender in the same {} worlds, which neither a search nor a choice had seen; the champion is compared \
             with each, world by world.",
            champion.len()
        ),
        header: names.iter().map(|&name| name.to_owned()).collect(),
        rows: contest.contenders.iter().map(row).collect(),
    }
}

fn summary(variants: &Variants, runs: &[Run], champions: &[Champion<'_>]) -> Vec<Fact> {
    let plan = variants.first();
    let fact = |label: &str, value: String| Fact { label: label.into(), value };
    let candidates = runs.first().and_then(|run| run.generations.first()).map_or(0, |one| one.candidates.len());
    let mut facts = vec![
        fact("Runs", runs.len().to_string()),
        fact("Generations", plan.generations.to_string()),
        fact("Candidates", candidates.to_string()),
        fact("Genes", plan.axes.len().to_string()),
    ];
    if variants.plans.len() > 1 {
        facts.insert(0, fact("Variants", variants.plans.len().to_string()));
        return facts;
    }
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
                .map(|(k, one)| (k as f64, Spread::of(plan.own(&one.evaluated.scores)).mean))
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

fn methods(variants: &Variants) -> Vec<String> {
    let plan = variants.first();
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
    let mut methods = vec![
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
    ];
    if variants.plans.len() > 1 {
        let levels = |factor: &crate::study::plan::Varied| {
            let levels: Vec<&str> = factor.levels.iter().map(|level| level.text.as_str()).collect();
            format!("{} ({})", factor.about, levels.join(", "))
        };
        let varied: Vec<String> = variants.factors.iter().map(levels).collect();
        methods.push(format!(
            "Varied: {}. Each of {} variants had all runs, with the same seeds; what is said above is of the first.",
            varied.join("; "),
            variants.plans.len()
        ));
    }
    if plan.form.contest.is_some() {
        methods.push(
            "In the contest all contenders are tried in the same worlds, and who is chosen among many (the best change of a \
             single gene, the best of those drawn at random) is chosen in other worlds before."
                .to_owned(),
        );
    }
    methods
}

fn champion_table(variants: &Variants, champions: &[Champion<'_>]) -> Table {
    let factors = variants.factors.iter().map(|factor| factor.name.clone());
    let genes = variants.first().axes.iter().map(|gene| gene.name.clone());
    let mut rows: Vec<Vec<String>> =
        vec![factors.chain(["run".to_owned(), "fitness".to_owned()]).chain(genes).collect()];
    for (k, genes, score) in champions {
        let (variant, run) = variants.of_run(*k);
        let levels =
            variants.factors.iter().zip(&variants.levels[variant]).map(|(f, &level)| f.levels[level].text.clone());
        let numbers = [(run + 1).to_string(), score.to_string()];
        rows.push(levels.chain(numbers).chain(genes.iter().map(ToString::to_string)).collect());
    }
    Table {
        file: "champions.csv".into(),
        about: "The champion of each run: fitness and genes.".into(),
        csv: csv(&rows),
    }
}
