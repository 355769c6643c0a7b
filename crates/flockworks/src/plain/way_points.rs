//! Laws of way-points: the velocity is the step made.

use super::{Plain, add, clip, each, moved, others, unit};

pub(super) fn hamilton_2d(now: &Plain) -> Plain {
    let (step, r_rho, range) = (1.0, 2.0, 10.0);
    each(now, |i| {
        let (mut nearest, mut least) = ([0.0; 2], range);
        for (_, offset, distance) in others(now, i) {
            if distance < least {
                (nearest, least) = (offset, distance);
            }
        }
        let moves = least > r_rho && least < range;
        let made = if moves { unit(nearest).map(|c| c * step) } else { [0.0; 2] };
        (moved(now, i, made, 1.0), made)
    })
}

pub(super) fn viscido_lch(now: &Plain) -> Plain {
    let (step, decay) = (1.0, 0.375);
    each(now, |i| {
        let mut sum = [0.0; 2];
        for (_, offset, distance) in others(now, i) {
            add(&mut sum, 1.0 / (1.0 + decay * distance), offset);
        }
        let made = unit(sum).map(|c| c * step);
        (moved(now, i, made, 1.0), made)
    })
}

pub(super) fn lch_member_pose(now: &Plain) -> Plain {
    let (step, range) = (0.1, 3000.0);
    each(now, |i| {
        let (mut sum, mut count) = ([0.0; 2], 0.0);
        for (_, offset, distance) in others(now, i) {
            if distance < range {
                add(&mut sum, 1.0, offset);
                count += 1.0;
            }
        }
        let made = if count > 0.0 { unit(sum.map(|c| c / count)).map(|c| c * step) } else { [0.0; 2] };
        (moved(now, i, made, 1.0), made)
    })
}

pub(super) fn lch_member_bearing(now: &Plain) -> Plain {
    let (step, range) = (0.1, 3000.0);
    each(now, |i| {
        let mut sum = [0.0; 2];
        for (_, offset, distance) in others(now, i) {
            if distance < range {
                add(&mut sum, 1.0, unit(offset));
            }
        }
        let made = unit(sum).map(|c| c * step);
        (moved(now, i, made, 1.0), made)
    })
}

pub(super) fn warburton_lazarus_1991(now: &Plain) -> Plain {
    let (preferred, decay, withdrawal, step) = (2.0, 4.0, 1.0, 0.5);
    each(now, |i| {
        let (mut sum, mut count) = ([0.0; 2], 0.0);
        for (_, offset, distance) in others(now, i) {
            let tendency = if distance < preferred {
                -withdrawal * (1.0 - distance / preferred)
            } else {
                1.0 - f64::exp(-(distance - preferred) / decay)
            };
            add(&mut sum, tendency, unit(offset));
            count += 1.0;
        }
        let made = if count > 0.0 { clip(sum.map(|c| c / count), 1.0).map(|c| c * step) } else { [0.0; 2] };
        (moved(now, i, made, 1.0), made)
    })
}
