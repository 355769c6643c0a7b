//! Clusters of points: average linkage, cut where the mean silhouette is greatest, or by density.

use kodama::{Method, Step, linkage};

/// Columns made comparable: each less its mean, over its standard deviation. One that does not vary becomes 0.
pub fn standardised(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let columns = rows.first().map_or(0, Vec::len);
    let mut scaled = rows.to_vec();
    for column in 0..columns {
        let count = rows.len() as f64;
        let mean = rows.iter().map(|row| row[column]).sum::<f64>() / count;
        let variance = rows.iter().map(|row| (row[column] - mean) * (row[column] - mean)).sum::<f64>() / count;
        let deviation = variance.sqrt();
        for row in &mut scaled {
            // what differs by rounding alone does not vary
            row[column] = if deviation > 1e-12 * (1.0 + mean.abs()) { (row[column] - mean) / deviation } else { 0.0 };
        }
    }
    scaled
}

/// Distances between points, `[points][points]`.
pub fn distances(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let distance = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    rows.iter().map(|a| rows.iter().map(|b| distance(a, b)).collect()).collect()
}

/// Steps of average linkage: which two clusters are joined, the nearest first.
fn joined(distances: &[Vec<f64>]) -> Vec<Step<f64>> {
    let count = distances.len();
    if count < 2 {
        return Vec::new();
    }
    let mut condensed: Vec<f64> = (0..count).flat_map(|a| distances[a][a + 1..].iter().copied()).collect();
    linkage(&mut condensed, count, Method::Average).steps().to_vec()
}

/// The clusters after all but the last joins, as a number for each point; numbers go by the first point.
fn cut(steps: &[Step<f64>], points: usize, clusters: usize) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..points + steps.len()).collect();
    for (k, step) in steps.iter().enumerate().take(points.saturating_sub(clusters)) {
        parent[step.cluster1] = points + k;
        parent[step.cluster2] = points + k;
    }
    let root = |mut at: usize| {
        while parent[at] != at {
            at = parent[at];
        }
        at
    };
    let mut known: Vec<usize> = Vec::new();
    let number = |point: usize| {
        let root = root(point);
        known.iter().position(|one| *one == root).unwrap_or_else(|| {
            known.push(root);
            known.len() - 1
        })
    };
    (0..points).map(number).collect()
}

/// The mean silhouette (Rousseeuw 1987): how much nearer points are to their own cluster than to the next, from -1 to 1. A point alone
/// in its cluster counts as 0; of fewer than two clusters it is 0.
pub fn silhouette(distances: &[Vec<f64>], labels: &[usize]) -> f64 {
    let clusters = labels.iter().max().map_or(0, |most| most + 1);
    if clusters < 2 {
        return 0.0;
    }
    let of = |point: usize| {
        let (mut sums, mut counts) = (vec![0.0; clusters], vec![0usize; clusters]);
        for (other, &label) in labels.iter().enumerate().filter(|(other, _)| *other != point) {
            sums[label] += distances[point][other];
            counts[label] += 1;
        }
        let own = labels[point];
        if counts[own] == 0 {
            return 0.0;
        }
        let mean = |label: usize| sums[label] / counts[label] as f64;
        let (inside, outside) = (
            mean(own),
            (0..clusters).filter(|&label| label != own && counts[label] > 0).map(mean).fold(f64::INFINITY, f64::min),
        );
        let greater = inside.max(outside);
        if greater > 0.0 && greater.is_finite() { (outside - inside) / greater } else { 0.0 }
    };
    (0..labels.len()).map(of).sum::<f64>() / labels.len() as f64
}

/// Clusters by average linkage: the number of clusters, within bounds, that has the greatest silhouette (of equals the fewest). A
/// number for each point, and the silhouettes by numbers of clusters.
pub fn by_linkage(distances: &[Vec<f64>], least: usize, most: usize) -> (Vec<usize>, Vec<(usize, f64)>) {
    let points = distances.len();
    let steps = joined(distances);
    let cuts = (least.min(points)..=most.min(points)).map(|clusters| {
        let labels = cut(&steps, points, clusters);
        let silhouette = silhouette(distances, &labels);
        (clusters, labels, silhouette)
    });
    let mut best: Option<(Vec<usize>, f64)> = None;
    let mut silhouettes = Vec::new();
    for (clusters, labels, value) in cuts {
        silhouettes.push((clusters, value));
        if best.as_ref().is_none_or(|best| value > best.1) {
            best = Some((labels, value));
        }
    }
    (best.map_or_else(|| vec![0; points], |best| best.0), silhouettes)
}

/// Clusters by density: a point with at least `least` points (itself included) within `radius` is a core; cores within `radius` of each
/// other are of one cluster, and so is what is within `radius` of a core (of the first that reaches it). None: noise.
pub fn by_density(distances: &[Vec<f64>], radius: f64, least: usize) -> Vec<Option<usize>> {
    let near = |point: usize| (0..distances.len()).filter(move |&other| distances[point][other] <= radius);
    let core: Vec<bool> = (0..distances.len()).map(|point| near(point).count() >= least).collect();
    let mut labels = vec![None; distances.len()];
    let mut clusters = 0;
    for first in 0..distances.len() {
        if labels[first].is_some() || !core[first] {
            continue;
        }
        labels[first] = Some(clusters);
        let mut reached = vec![first];
        while let Some(point) = reached.pop() {
            for other in near(point) {
                if labels[other].is_none() {
                    labels[other] = Some(clusters);
                    reached.extend(core[other].then_some(other));
                }
            }
        }
        clusters += 1;
    }
    labels
}

/// The silhouette of what is no noise.
pub fn silhouette_of(distances: &[Vec<f64>], labels: &[Option<usize>]) -> f64 {
    let own: Vec<usize> = (0..labels.len()).filter(|&point| labels[point].is_some()).collect();
    let among: Vec<Vec<f64>> = own.iter().map(|&a| own.iter().map(|&b| distances[a][b]).collect()).collect();
    silhouette(&among, &labels.iter().flatten().copied().collect::<Vec<_>>())
}

/// The point of each cluster that is nearest to all others in it; of equals the first.
pub fn medoids(distances: &[Vec<f64>], labels: &[Option<usize>]) -> Vec<usize> {
    let clusters = labels.iter().flatten().max().map_or(0, |most| most + 1);
    let of = |cluster: usize| {
        let own: Vec<usize> = (0..labels.len()).filter(|&point| labels[point] == Some(cluster)).collect();
        let sum = |point: usize| own.iter().map(|&other| distances[point][other]).sum::<f64>();
        let best = own.iter().map(|&point| (point, sum(point))).reduce(|a, b| if b.1 < a.1 { b } else { a });
        best.map_or(0, |best| best.0)
    };
    (0..clusters).map(of).collect()
}
