//! Metrics of every frame of tracks, spread over threads.

use crate::{Counted, Measure, Sample, Tracks};
use space::parallel::Workers;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Frames that are measured together.
const BLOCK: usize = 64;

/// Metrics frame by frame, `[frames]` each.
#[derive(Clone, Debug, PartialEq)]
pub struct PerFrame {
    /// Number of individuals with a position.
    pub positions: Vec<u32>,
    /// Number of individuals with a position and a velocity.
    pub velocities: Vec<u32>,
    /// Number of individuals with a heading.
    pub headings: Vec<u32>,
    /// Number of individuals whose direction of the body is known.
    pub bodies: Vec<u32>,
    /// Values, `[metrics][frames]`; NaN where a metric is undefined.
    pub values: Vec<Vec<f64>>,
}

impl PerFrame {
    fn new(metrics: usize, frames: usize) -> Self {
        let counts = || Vec::with_capacity(frames);
        let values = (0..metrics).map(|_| Vec::with_capacity(frames)).collect();
        Self { positions: counts(), velocities: counts(), headings: counts(), bodies: counts(), values }
    }
    /// How many individuals entered a metric, `[frames]`.
    pub fn counts(&self, counted: Counted) -> &[u32] {
        match counted {
            Counted::Positions => &self.positions,
            Counted::Velocities => &self.velocities,
            Counted::Headings => &self.headings,
            Counted::Bodies => &self.bodies,
        }
    }
    fn push<const D: usize>(&mut self, sample: &Sample<D>, metrics: &[Box<dyn Measure<D>>]) {
        self.positions.push(sample.count(Counted::Positions) as u32);
        self.velocities.push(sample.count(Counted::Velocities) as u32);
        self.headings.push(sample.count(Counted::Headings) as u32);
        self.bodies.push(sample.count(Counted::Bodies) as u32);
        for (column, metric) in self.values.iter_mut().zip(metrics) {
            column.push(metric.on(sample).unwrap_or(f64::NAN));
        }
    }
    fn append(&mut self, block: Self) {
        self.positions.extend(block.positions);
        self.velocities.extend(block.velocities);
        self.headings.extend(block.headings);
        self.bodies.extend(block.bodies);
        self.values.iter_mut().zip(block.values).for_each(|(column, values)| column.extend(values));
    }
}

/// Metrics of every frame of tracks. The same bits for any number of threads: a frame is measured by one of them alone.
pub fn per_frame<const D: usize>(tracks: &Tracks<D>, metrics: &[Box<dyn Measure<D>>], workers: &Workers) -> PerFrame {
    let frames = tracks.frames().len();
    let blocks: Vec<OnceLock<PerFrame>> = (0..frames.div_ceil(BLOCK)).map(|_| OnceLock::new()).collect();
    let samples: Vec<Mutex<Sample<D>>> = (0..workers.threads()).map(|_| Mutex::new(Sample::empty())).collect();
    workers.each(blocks.len(), |worker, block| {
        // each worker has a sample of its own: nobody waits here
        let mut sample = samples[worker].lock().unwrap_or_else(PoisonError::into_inner);
        let range = block * BLOCK..frames.min((block + 1) * BLOCK);
        let mut measured = PerFrame::new(metrics.len(), range.len());
        for frame in range {
            tracks.sample_into(frame, &mut sample);
            measured.push(&sample, metrics);
        }
        // each block is measured once
        let _ = blocks[block].set(measured);
    });
    let mut all = PerFrame::new(metrics.len(), frames);
    blocks.into_iter().filter_map(OnceLock::into_inner).for_each(|block| all.append(block));
    all
}
