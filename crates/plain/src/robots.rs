//! Laws of robots, which face where they drive, or are pulled and pushed.

use crate::{Plain, add, angle, at_angle, clip, dot, each, length, moved, nearest, others, unit, wrapped};
use core::f64::consts::FRAC_PI_4;

pub(crate) fn arkin_balch_1999(now: &Plain) -> Plain {
    let (goal, goal_gain, robot_gain, noise_gain) = ([100.0, 0.0], 0.8, 2.0, 0.1);
    let (sphere, minimum, cap, fastest, dt) = (20.0, 5.0, 10.0, 1.0, 1.0);
    each(now, |i| {
        let [x, y] = now.position[i];
        let mut wanted = unit([goal[0] - x, goal[1] - y]).map(|c| goal_gain * c);
        for (_, offset, distance) in others(now, i) {
            if distance <= sphere {
                let push = if distance <= minimum { cap } else { (sphere - distance) / (sphere - minimum) };
                add(&mut wanted, -robot_gain * push, unit(offset));
            }
        }
        add(&mut wanted, noise_gain, now.draws(i).unit(0).0);
        let velocity = clip(wanted, 1.0).map(|c| c * fastest);
        (moved(now, i, velocity, dt), velocity)
    })
}

/// Turns robot `i` and drives it on, along its new orientation.
fn drive(next: &mut Plain, i: usize, turn: f64, speed: f64, dt: f64) {
    let theta = wrapped(next.state[0][i] + turn);
    next.state[0][i] = theta;
    next.velocity[i] = at_angle(theta).map(|c| c * speed);
    next.position[i] = moved(next, i, next.velocity[i], dt);
}

/// Kobots; a target, if there is one, has a weight.
fn kobots(now: &Plain, target: Option<([f64; 2], f64)>) -> Plain {
    let (hearing, infrared, desired, divisor, beta) = (20.0, 0.2, 0.12, 0.0064, 12.0);
    let (fastest, gain, dt) = (0.07, 0.5, 0.1);
    let heading: Vec<[f64; 2]> = now.state[0].iter().map(|&theta| at_angle(theta)).collect();
    let mut next = now.next();
    for i in 0..now.position.len() {
        let theta = now.state[0][i];
        let (mut heard, mut hears, mut nearest) = ([0.0; 2], false, [f64::INFINITY; 8]);
        for (j, offset, distance) in others(now, i) {
            if distance < hearing {
                add(&mut heard, 1.0, heading[j]);
                hears = true;
            }
            if distance < infrared {
                let sector = ((angle(offset) - theta) / FRAC_PI_4 + 0.5).floor().rem_euclid(8.0) as usize;
                nearest[sector] = nearest[sector].min(distance);
            }
        }
        let mut wanted = if hears { unit(heard) } else { heading[i] };
        for (sector, distance) in nearest.into_iter().enumerate() {
            if distance < infrared {
                let excess = distance - desired;
                let force = excess * excess.abs() / divisor;
                add(&mut wanted, beta * force / 8.0, at_angle(theta + sector as f64 * FRAC_PI_4));
            }
        }
        if let Some((place, weight)) = target {
            add(&mut wanted, weight, unit([place[0] - now.position[i][0], place[1] - now.position[i][1]]));
            add(&mut wanted, -weight, heading[i]);
        }
        let turn = wrapped(angle(wanted) - theta);
        drive(&mut next, i, dt * gain * turn, f64::max(fastest * turn.cos(), 0.0), dt);
    }
    next
}

pub(crate) fn turgut_2008(now: &Plain) -> Plain {
    kobots(now, None)
}

pub(crate) fn gokce_sahin_2009(now: &Plain) -> Plain {
    kobots(now, Some(([100.0, 0.0], 0.1)))
}

pub(crate) fn kelly_keating_1996(now: &Plain) -> Plain {
    let (range, avoidance, near, far, w_at, w_al) = (5.0, 0.6, 1.0, 2.0, 1.0, 0.5);
    let (leading, slow, fast, dt) = (0.2, 0.1, 0.4, 0.5);
    let most = 60f64.to_radians() * dt;
    let mut next = now.next();
    for i in 0..now.position.len() {
        let theta = now.state[0][i];
        let heading = at_angle(theta);
        // who is avoided and who is followed lies ahead
        let seen = others(now, i).filter(|&(_, offset, distance)| distance < range && dot(heading, offset) >= 0.0);
        let (turn, speed) = match nearest(seen) {
            None => (0.0, leading),
            Some((_, offset, distance)) if distance < avoidance => {
                (if wrapped(angle(offset) - theta) >= 0.0 { -most } else { most }, slow)
            }
            Some((j, offset, distance)) => {
                let mut wanted = unit(offset).map(|c| w_at * c);
                add(&mut wanted, w_al, at_angle(now.state[0][j]));
                let speed = if distance > far {
                    fast
                } else if distance < near {
                    slow
                } else {
                    length(now.velocity[j])
                };
                (wrapped(angle(wanted) - theta).clamp(-most, most), speed)
            }
        };
        drive(&mut next, i, turn, speed, dt);
    }
    next
}

pub(crate) fn mataric_1993(now: &Plain) -> Plain {
    let (range, avoidance, backing, dispersion, aggregation) = (6.0, 1.0, 0.4, 2.0, 3.0);
    let (w_disp, w_agg, w_fwd, speed, dt) = (1.0, 1.0, 1.0, 0.2, 1.0);
    let (aside, most) = (45f64.to_radians(), 45f64.to_radians() * dt);
    let mut next = now.next();
    for i in 0..now.position.len() {
        let theta = now.state[0][i];
        let heading = at_angle(theta);
        let (mut met, mut least) = ([0.0; 2], avoidance);
        let (mut near, mut centre, mut count) = ([0.0; 2], [0.0; 2], 0.0);
        for (_, offset, distance) in others(now, i) {
            if distance < least && dot(heading, offset) >= 0.0 {
                (met, least) = (offset, distance);
            }
            if distance < dispersion {
                add(&mut near, 1.0, offset);
            }
            if distance < range {
                add(&mut centre, 1.0, offset);
                count += 1.0;
            }
        }
        let (turn, speed) = if least < avoidance {
            let turn = if wrapped(angle(met) - theta) >= 0.0 { -aside } else { aside };
            (turn, if least < backing { -speed / 2.0 } else { speed })
        } else {
            let mut wanted = heading.map(|c| w_fwd * c);
            add(&mut wanted, -w_disp, unit(near));
            if length(centre) > aggregation * count {
                add(&mut wanted, w_agg, unit(centre));
            }
            (wrapped(angle(wanted) - theta), speed)
        };
        drive(&mut next, i, turn.clamp(-most, most), speed, dt);
    }
    next
}
