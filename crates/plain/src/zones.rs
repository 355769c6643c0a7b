//! Laws of zones.

use crate::{Plain, add, each, moved, others, turned, unit, unit_or};

pub(crate) fn couzin_2005(now: &Plain) -> Plain {
    let (r_rho, range, speed, turning, dt) = (1.0, 6.0, 1.0, 2.0, 0.2);
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let (mut apart, mut social, mut repelled) = ([0.0; 2], [0.0; 2], false);
        for (j, offset, distance) in others(now, i) {
            if distance < r_rho {
                add(&mut apart, -1.0, unit(offset));
                repelled = true;
            }
            if distance < range {
                add(&mut social, 1.0, unit(offset));
                add(&mut social, 1.0, unit(now.velocity[j]));
            }
        }
        let wanted = unit_or(if repelled { apart } else { social }, heading);
        let velocity = turned(heading, wanted, turning * dt).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn conradt_2009(now: &Plain) -> Plain {
    let (r_rho, r_att, speed, dt) = (1.0, 10.0, 1.0, 0.2);
    each(now, |i| {
        let (mut apart, mut social, mut repelled, mut attracted) = ([0.0; 2], [0.0; 2], 0.0, 0.0);
        for (j, offset, distance) in others(now, i) {
            if distance < r_rho {
                add(&mut apart, -1.0, unit(offset));
                repelled += 1.0;
            } else if distance < r_att {
                add(&mut social, 0.25, unit(offset));
                add(&mut social, 0.25, unit(now.velocity[j]));
                attracted += 1.0;
            }
        }
        let wanted = if repelled > 0.0 {
            apart.map(|c| c / repelled)
        } else if attracted > 0.0 {
            social.map(|c| c / attracted)
        } else {
            [0.0; 2]
        };
        let velocity = unit_or(wanted, unit(now.velocity[i])).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn lopez_2012(now: &Plain) -> Plain {
    let (radius, w_al, decay, w_at, r_e, speed, dt) = (6.0, 1.0, 3.0, 1.0, 1.0, 1.0, 0.1);
    each(now, |i| {
        let (mut sum, mut count) = ([0.0; 2], 0.0);
        for (j, offset, distance) in others(now, i) {
            if distance < radius {
                add(&mut sum, w_al * f64::exp(-distance / decay), unit(now.velocity[j]));
                add(&mut sum, w_at * f64::clamp((distance - r_e) / r_e, -1.0, 1.0), unit(offset));
                count += 1.0;
            }
        }
        let heading = unit(now.velocity[i]);
        let wanted = if count > 0.0 { unit_or(sum.map(|c| c / count), heading) } else { heading };
        let velocity = wanted.map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn tien_2004(now: &Plain) -> Plain {
    let (r_r, r_n, r_a, speed, dt) = (1.0, 2.5, 6.0, 1.0, 0.2);
    let cos_half = (300f64.to_radians() / 2.0).cos();
    let turning = 90f64.to_radians();
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let (mut apart, mut towards, mut repelled) = ([0.0; 2], [0.0; 2], false);
        for (_, offset, distance) in others(now, i) {
            if distance >= r_a || heading[0] * offset[0] + heading[1] * offset[1] < cos_half * distance {
                continue;
            }
            if distance < r_r {
                add(&mut apart, -1.0, unit(offset));
                repelled = true;
            } else if distance >= r_n {
                add(&mut towards, 1.0, unit(offset));
            }
        }
        let wanted = unit_or(if repelled { apart } else { towards }, heading);
        let velocity = turned(heading, wanted, turning * dt).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn lukeman_2010(now: &Plain) -> Plain {
    let (r_rep, r_al, r_att, w_rep, w_al, w_att, w_fr) = (1.5, 3.0, 6.0, 1.5, 0.5, 0.3, 0.3);
    let (d_fr, r_fr, propulsion, drag, dt) = (2.0, 4.0, 1.0, 1.0, 0.1);
    let cos_half = (60f64.to_radians() / 2.0).cos();
    each(now, |i| {
        let heading = unit(now.velocity[i]);
        let (mut sums, mut counts) = ([[0.0; 2]; 4], [0.0; 4]);
        for (j, offset, distance) in others(now, i) {
            let direction = unit(offset);
            let (which, factor, vector) = if distance < r_rep {
                (0, 1.0 - distance / r_rep, direction)
            } else if distance < r_al {
                (1, 1.0, unit(now.velocity[j]))
            } else if distance < r_att {
                (2, 1.0, direction)
            } else {
                continue;
            };
            add(&mut sums[which], factor, vector);
            counts[which] += 1.0;
            if distance < r_fr && heading[0] * offset[0] + heading[1] * offset[1] >= cos_half * distance {
                add(&mut sums[3], f64::clamp((distance - d_fr) / d_fr, -1.0, 1.0), direction);
                counts[3] += 1.0;
            }
        }
        let mut force = heading.map(|c| c * propulsion);
        add(&mut force, -drag, now.velocity[i]);
        for ((sum, count), weight) in sums.into_iter().zip(counts).zip([-w_rep, w_al, w_att, w_fr]) {
            if count > 0.0 {
                add(&mut force, weight / count, sum);
            }
        }
        let mut velocity = now.velocity[i];
        add(&mut velocity, dt, force);
        (moved(now, i, velocity, dt), velocity)
    })
}
