//! Cells of a space, by what is found in them: a regression tree, whose leaves keep what fell into them (Meinshausen 2006, J. Mach. Learn.
//! Res. 7:983, draws from leaves in this way; the tree is that of Breiman and others 1984).

/// Places at which each axis may be cut, at most.
const CUTS: usize = 31;
/// Least part of the squares that a cut must explain.
const LEAST_GAIN: f64 = 1e-9;

#[derive(Clone, Debug)]
enum Node {
    /// Where the number on an axis is at most this, the first; else the second.
    Cut(usize, f64, usize, usize),
    /// From where to where the items of the cell stand.
    Cell(usize, usize),
}

/// Cells with their items.
#[derive(Clone, Debug)]
pub struct Cells {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

impl Cells {
    /// All items in one cell.
    pub fn one(items: usize) -> Self {
        Self { nodes: vec![Node::Cell(0, items)], items: (0..items as u32).collect() }
    }
    /// Cells of items at places, `[axes][items]`, cut so that values, `[values][items]`, vary as little as possible within them (each by its
    /// own spread), as long as every cell keeps at least so many items.
    pub fn grown(places: &[Vec<f64>], values: &[Vec<f64>], least: usize) -> Self {
        let items = places.first().map_or(0, Vec::len);
        let mut cells = Self::one(items);
        let cuts: Vec<Vec<f64>> = places.iter().map(|axis| cuts(axis)).collect();
        let part = |(axis, cuts): (&Vec<f64>, &Vec<f64>)| -> Vec<u8> {
            axis.iter().map(|place| cuts.partition_point(|cut| cut < place) as u8).collect()
        };
        let parts: Vec<Vec<u8>> = places.iter().zip(&cuts).map(part).collect();
        let scaled: Vec<Vec<f64>> = values.iter().filter_map(|values| scaled(values)).collect();
        // nodes are met in the order in which they come to be
        let mut next = 0;
        while let Some(Node::Cell(from, to)) = cells.nodes.get(next).cloned() {
            if let Some((axis, cut)) = best(&parts, &cuts, &scaled, &cells.items[from..to], least.max(1)) {
                let own = &mut cells.items[from..to];
                // items keep their order on both sides
                own.sort_by_key(|&item| usize::from(parts[axis][item as usize]) > cut);
                let middle = from + own.partition_point(|&item| usize::from(parts[axis][item as usize]) <= cut);
                let first = cells.nodes.len();
                cells.nodes[next] = Node::Cut(axis, cuts[axis][cut], first, first + 1);
                cells.nodes.extend([Node::Cell(from, middle), Node::Cell(middle, to)]);
            }
            next += 1;
        }
        cells
    }
    /// Number of cells.
    pub fn count(&self) -> usize {
        self.nodes.iter().filter(|node| matches!(node, Node::Cell(..))).count()
    }
    /// Shows the items of every cell.
    pub fn each(&self, mut see: impl FnMut(&[u32])) {
        for node in &self.nodes {
            if let Node::Cell(from, to) = *node {
                see(&self.items[from..to]);
            }
        }
    }
    /// The items of the cell in which a place lies.
    pub fn at(&self, place: &[f64]) -> &[u32] {
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Cut(axis, cut, below, above) => node = if place[axis] <= cut { below } else { above },
                Node::Cell(from, to) => return &self.items[from..to],
            }
        }
    }
}

/// Where an axis may be cut: at quantiles of its places.
fn cuts(axis: &[f64]) -> Vec<f64> {
    let mut sorted = axis.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut cuts: Vec<f64> = (1..=CUTS).filter_map(|k| sorted.get(k * sorted.len() / (CUTS + 1)).copied()).collect();
    cuts.dedup();
    // beyond the last there has to be something
    cuts.retain(|cut| sorted.last().is_some_and(|last| cut < last));
    cuts
}

/// Values by their standard deviation; none where they are equal.
fn scaled(values: &[f64]) -> Option<Vec<f64>> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    let deviation = (squares / values.len().max(1) as f64).sqrt();
    // what rounding leaves of an exact law is nothing to cut by
    (deviation > 1e-12).then(|| values.iter().map(|value| (value - mean) / deviation).collect())
}

/// The axis and the cut that explain most; none where none explains anything.
fn best(
    parts: &[Vec<u8>],
    cuts: &[Vec<f64>],
    values: &[Vec<f64>],
    items: &[u32],
    least: usize,
) -> Option<(usize, usize)> {
    let count = items.len();
    if count < 2 * least || values.is_empty() {
        return None;
    }
    let total: Vec<f64> = values.iter().map(|values| items.iter().map(|&item| values[item as usize]).sum()).collect();
    let whole: f64 = total.iter().map(|sum| sum * sum).sum::<f64>() / count as f64;
    let mut found: Option<(f64, usize, usize)> = None;
    let mut sums = vec![0.0; (CUTS + 1) * values.len()];
    for (axis, (parts, cuts)) in parts.iter().zip(cuts).enumerate() {
        let mut counts = [0usize; CUTS + 1];
        sums.fill(0.0);
        for &item in items {
            let part = usize::from(parts[item as usize]);
            counts[part] += 1;
            let own = &mut sums[part * values.len()..(part + 1) * values.len()];
            own.iter_mut().zip(values).for_each(|(sum, values)| *sum += values[item as usize]);
        }
        let mut below = vec![0.0; values.len()];
        let mut before = 0;
        for cut in 0..cuts.len() {
            before += counts[cut];
            below.iter_mut().zip(&sums[cut * values.len()..]).for_each(|(below, sum)| *below += sum);
            let after = count - before;
            if before < least || after < least {
                continue;
            }
            let squares = |(below, total): (&f64, &f64)| {
                let above = total - below;
                below * below / before as f64 + above * above / after as f64
            };
            let gain = below.iter().zip(&total).map(squares).sum::<f64>() - whole;
            if gain > LEAST_GAIN * count as f64 && found.is_none_or(|(most, ..)| gain > most) {
                found = Some((gain, axis, cut));
            }
        }
    }
    found.map(|(_, axis, cut)| (axis, cut))
}
