//! Laws of separation, alignment and cohesion, each with more of its own.

use crate::{Plain, add, clip, dot, each, length, moved, others, turned, unit, unit_or};

pub(crate) fn boids_five_force(now: &Plain) -> Plain {
    let (range, k_coh, k_ali, k_sep, dt) = (20.0, 30.0, 10.0, 0.025, 0.05);
    // all are in one flock, and there is no food
    let size = now.position.len() as f64;
    each(now, |i| {
        let (mut centre, mut matched, mut mates) = ([0.0; 2], [0.0; 2], 0.0);
        let (mut nearest, mut least) = ([0.0; 2], range);
        for (j, offset, distance) in others(now, i) {
            if distance < range {
                add(&mut centre, 1.0, offset);
                add(&mut matched, 1.0, now.velocity[j]);
                mates += 1.0;
                if distance < least {
                    (nearest, least) = (offset, distance);
                }
            }
        }
        let mut velocity = now.velocity[i];
        if mates > 0.0 {
            let far = length(centre) / mates;
            add(&mut velocity, dt * far * far / (k_coh * size), unit(centre));
            add(&mut velocity, dt / (k_ali * far), unit(matched));
            add(&mut velocity, -dt * k_sep * (mates / least).powi(2), unit(nearest));
        }
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn reynolds_kline(now: &Plain) -> Plain {
    let (range, separation, least_urgency, largest_urgency, fastest, cruising) = (9.0, 3.0, 0.05, 0.1, 1.0, 0.5);
    let urgency = |of: f64| of.clamp(least_urgency, largest_urgency);
    each(now, |i| {
        let mine = now.velocity[i];
        let (mut middle, mut nearest, mut least) = ([0.0; 2], None, range);
        for (j, offset, distance) in others(now, i) {
            if distance < range {
                add(&mut middle, 1.0, offset);
                if distance < least {
                    (nearest, least) = (Some((j, offset)), distance);
                }
            }
        }
        let mut change = [0.0; 2];
        if let Some((j, offset)) = nearest {
            let towards = if least < separation { -urgency(least / separation) } else { urgency(least / separation) };
            add(&mut change, towards, unit(offset));
            add(&mut change, least_urgency, unit(now.velocity[j]));
            add(&mut change, least_urgency, unit(middle));
        }
        let excess = (length(mine) - cruising) / fastest;
        add(&mut change, if excess > 0.0 { -urgency(excess) } else { urgency(-excess) }, unit(mine));
        let mut velocity = mine;
        add(&mut velocity, 1.0, clip(change, fastest * largest_urgency));
        let velocity = clip(velocity, fastest);
        (moved(now, i, velocity, 1.0), velocity)
    })
}

pub(crate) fn hartman_benes_2006(now: &Plain) -> Plain {
    let (separation_radius, view_radius, separation, cohesion, alignment) = (2.0, 8.0, 0.5, 0.1, 0.3);
    let (least_eccentricity, chance, lasting, thrust, boost, fastest, dt) = (0.3, 0.05, 40.0, 1.0, 1.5, 2.0, 0.1);
    let mut next = now.next();
    for i in 0..now.position.len() {
        let (mine, heading) = (now.velocity[i], unit(now.velocity[i]));
        let (mut apart, mut matched, mut centre, mut count) = ([0.0; 2], [0.0; 2], [0.0; 2], 0.0);
        for (j, offset, distance) in others(now, i) {
            if distance < view_radius {
                if distance < separation_radius {
                    add(&mut apart, -1.0, offset);
                }
                add(&mut matched, 1.0, now.velocity[j]);
                add(&mut centre, 1.0, offset);
                count += 1.0;
            }
        }
        let (mut timer, mut acceleration) = (now.state[0][i], [0.0; 2]);
        if count > 0.0 {
            let centre = centre.map(|c| c / count);
            let eccentricity = length(centre) / view_radius;
            let in_front = dot(centre, heading) < 0.0 && eccentricity >= least_eccentricity;
            if timer == 0.0 && in_front && now.draws(i).uniform(0) < chance * eccentricity {
                timer = lasting;
            }
            add(&mut acceleration, separation, apart);
            add(&mut acceleration, alignment / count, matched);
            add(&mut acceleration, -alignment, mine);
            if timer == 0.0 {
                add(&mut acceleration, cohesion, centre);
            }
        }
        let mut limit = fastest;
        if timer > 0.0 {
            add(&mut acceleration, thrust, heading);
            limit = boost * fastest;
            timer -= 1.0;
        }
        next.state[0][i] = timer;
        let mut velocity = mine;
        add(&mut velocity, dt, acceleration);
        next.velocity[i] = clip(velocity, limit);
        next.position[i] = moved(now, i, next.velocity[i], dt);
    }
    next
}

pub(crate) fn hauert_2011(now: &Plain) -> Plain {
    let (range, w_s, w_a, w_c, speed, turning, dt) = (300.0, 1.0, 1.0, 1.0, 14.0, 0.5, 0.1);
    each(now, |i| {
        let (mut apart, mut matched, mut centre) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        for (j, offset, distance) in others(now, i) {
            if distance < range {
                add(&mut apart, -1.0 / distance, unit(offset));
                add(&mut matched, 1.0, now.velocity[j]);
                add(&mut centre, 1.0, offset);
            }
        }
        let mut wanted = unit(apart).map(|c| w_s * c);
        add(&mut wanted, w_a, unit(matched));
        add(&mut wanted, w_c, unit(centre));
        let heading = unit(now.velocity[i]);
        let velocity = turned(heading, unit_or(wanted, heading), turning * dt).map(|c| c * speed);
        (moved(now, i, velocity, dt), velocity)
    })
}
