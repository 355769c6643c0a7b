//! Laws that keep something of their own from step to step.

use crate::{Plain, add, clip, each, moved, others, unit, wrapped};
use core::f64::consts::FRAC_PI_2;

pub(crate) fn gueron_1996(now: &Plain) -> Plain {
    let (stress, neutral, attraction) = ([1.0, 1.0], [3.0, 3.0], [8.0, 8.0]);
    let (front, factor, walking, dt) = (15f64.to_radians(), 1.5, 1.0, 1.0);
    let mut next = now.next();
    for i in 0..now.position.len() {
        let theta = now.state[0][i];
        let (sin, cos) = theta.sin_cos();
        let (mut in_front, mut left_front, mut right_front, mut left_back, mut right_back) =
            (false, false, false, false, false);
        let (mut outer, mut near, mut ahead, mut towards) = (false, false, false, [0.0; 2]);
        for (_, offset, _) in others(now, i) {
            let (along, across) = (offset[0] * cos + offset[1] * sin, offset[1] * cos - offset[0] * sin);
            let within = |half: [f64; 2]| along.abs() <= half[0] && across.abs() <= half[1];
            if !within(attraction) {
                continue;
            }
            let bearing = across.atan2(along);
            if within(stress) {
                if bearing.abs() <= front {
                    in_front = true;
                } else if bearing.abs() <= FRAC_PI_2 {
                    left_front |= bearing > 0.0;
                    right_front |= bearing <= 0.0;
                } else {
                    left_back |= bearing > 0.0;
                    right_back |= bearing <= 0.0;
                }
                continue;
            }
            outer = true;
            near |= within(neutral);
            if bearing.abs() <= FRAC_PI_2 {
                ahead = true;
                add(&mut towards, 1.0, unit(offset));
            }
        }
        let (left, right) = (left_front || left_back, right_front || right_back);
        let (facing, speed) = if in_front || left || right {
            if left && !right {
                (wrapped(theta - FRAC_PI_2), walking)
            } else if right && !left {
                (wrapped(theta + FRAC_PI_2), walking)
            } else if left_front && right_front {
                (theta, 0.0)
            } else if in_front {
                (theta, walking / factor)
            } else if left_front || right_front {
                (theta, walking)
            } else {
                (theta, walking * factor)
            }
        } else if outer && !ahead {
            (theta, walking / factor)
        } else if outer && !near {
            let facing = if unit(towards) == [0.0; 2] { theta } else { towards[1].atan2(towards[0]) };
            (facing, walking * factor)
        } else {
            (theta, walking)
        };
        next.state[0][i] = facing;
        next.velocity[i] = [speed * facing.cos(), speed * facing.sin()];
        next.position[i] = moved(now, i, next.velocity[i], dt);
    }
    next
}

pub(crate) fn competing_flocks(now: &Plain) -> Plain {
    let c: [f64; 12] = [1.0, 30.0, 1.0, 10.0, 0.025, 1.0, 1.0, 0.0025, 36.0, 1.0, 300.0, 1.0];
    let (mate_radius, other_radius, largest_speed, largest_acceleration, drag, dt) = (50.0, 50.0, 12.0, 6.0, 0.1, 1.5);
    let flock = &now.state[0];
    each(now, |i| {
        let size = flock.iter().filter(|&&other| other == flock[i]).count() as f64;
        let (mut centre, mut matched, mut mates) = ([0.0; 2], [0.0; 2], 0.0);
        let (mut nearest, mut least) = ([0.0; 2], f64::INFINITY);
        let (mut shunned, mut strangers) = ([0.0; 2], 0.0);
        for (j, offset, distance) in others(now, i) {
            if flock[j] != flock[i] {
                if distance < other_radius {
                    add(&mut shunned, 1.0, offset);
                    strangers += 1.0;
                }
            } else if distance < mate_radius {
                add(&mut centre, 1.0, offset);
                add(&mut matched, 1.0, now.velocity[j]);
                mates += 1.0;
                if distance < least {
                    (nearest, least) = (offset, distance);
                }
            }
        }
        let length = |[x, y]: [f64; 2]| (x * x + y * y).sqrt();
        let mut force = [0.0; 2];
        if mates > 0.0 {
            let far = length(centre) / mates;
            add(&mut force, (c[0] * far).powi(2) / (c[1] * size), unit(centre));
            add(&mut force, c[2] / (c[3] * far.max(1.0)), unit(matched));
            add(&mut force, -c[4] * (c[5] * mates / (c[6] * least.max(1.0))).powi(2), unit(nearest));
        }
        if strangers > 0.0 {
            add(&mut force, -c[10] / (c[11] * (length(shunned) / strangers).max(1.0)), unit(shunned));
        }
        let mut acceleration = clip(force, largest_acceleration);
        add(&mut acceleration, -drag, now.velocity[i]);
        let mut velocity = now.velocity[i];
        add(&mut velocity, dt, acceleration);
        let velocity = clip(velocity, largest_speed);
        (moved(now, i, velocity, dt), velocity)
    })
}

pub(crate) fn behaviour_selection(now: &Plain<3>) -> Plain<3> {
    let (preferred, growth, speed, dt): (f64, f64, f64, f64) = (10.0, 2.0, 6.0, 0.1);
    let (body, avoidance, alignment, sight) = (1.0, 4.0, 10.0, 24.0);
    // from centre to centre
    let (touch, near, middle, far) = (2.0 * body, avoidance + 2.0 * body, alignment + 2.0 * body, sight + 2.0 * body);
    let cos_half = (270f64.to_radians() / 2.0).cos();
    let (most_turn, most_rise) = (180f64.to_radians() * dt, 90f64.to_radians() * dt);
    let members = now.position.len();
    let mut next = now.next();
    let mut wanted_place = now.position.clone();
    for i in 0..members {
        let me = now.position[i];
        let heading = now.velocity[i].map(|c| c / speed);
        let (mut apart, mut matched, mut towards) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        let (mut avoided, mut aligned, mut attracted) = (0, 0, 0);
        for j in (0..members).filter(|&j| j != i) {
            let other = now.position[j];
            let offset = [other[0] - me[0], other[1] - me[1], other[2] - me[2]];
            let distance = (offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]).sqrt();
            let ahead = heading[0] * offset[0] + heading[1] * offset[1] + heading[2] * offset[2];
            if distance > far || ahead < cos_half * distance {
                continue;
            }
            let direction = if distance > 1e-12 { offset.map(|c| c / distance) } else { [0.0; 3] };
            if distance < near {
                (0..3).for_each(|a| apart[a] -= direction[a]);
                avoided += 1;
            } else if distance < middle {
                (0..3).for_each(|a| matched[a] += now.velocity[j][a] / speed);
                aligned += 1;
            } else {
                (0..3).for_each(|a| towards[a] += direction[a]);
                attracted += 1;
            }
        }
        let draws = now.draws(i);
        let aligns = || draws.uniform(0) < 1.0 / (1.0 + (-growth * (f64::from(aligned) - preferred)).exp());
        let (theta, phi) = (now.state[0][i], now.state[1][i]);
        let (mut turn, mut rise) = (0.0, 0.0);
        if avoided + aligned + attracted == 0 {
            turn = most_turn * (2.0 * draws.uniform(1) - 1.0);
            rise = most_rise * (2.0 * draws.uniform(2) - 1.0);
        } else {
            let [x, y, z] = if avoided > 0 {
                apart
            } else if attracted == 0 || (aligned > 0 && aligns()) {
                matched
            } else {
                towards
            };
            let level = (x * x + y * y).sqrt();
            let length = (x * x + y * y + z * z).sqrt();
            if length >= 1e-9 {
                if level >= 1e-9 * length {
                    turn = wrapped(y.atan2(x) - theta).clamp(-most_turn, most_turn);
                }
                rise = (z.atan2(level) - phi).clamp(-most_rise, most_rise);
            }
        }
        let (theta, phi) = (wrapped(theta + turn), (phi + rise).clamp(-FRAC_PI_2, FRAC_PI_2));
        (next.state[0][i], next.state[1][i]) = (theta, phi);
        let velocity = [phi.cos() * theta.cos(), phi.cos() * theta.sin(), phi.sin()].map(|c| c * speed);
        next.velocity[i] = velocity;
        (0..3).for_each(|a| wanted_place[i][a] = me[a] + velocity[a] * dt);
    }
    // a move that would touch is not made: one by one, against new places of those before and old ones of those behind
    for i in 0..members {
        let squared = |place: [f64; 3], j: usize| -> f64 {
            let other = next.position[j];
            (place[0] - other[0]).powi(2) + (place[1] - other[1]).powi(2) + (place[2] - other[2]).powi(2)
        };
        let touches = (0..members).filter(|&j| j != i).any(|j| {
            let after = squared(wanted_place[i], j);
            // who touches already may move away
            after < touch * touch && after <= squared(now.position[i], j)
        });
        if !touches {
            next.position[i] = wanted_place[i];
        }
    }
    next
}
