//! Laws of one dimension, on a ring: the order of the members decides, so that nobody looks at all pairs.

use crate::Plain;

/// Moves `i` along the ring; the velocity is the step made.
fn make(next: &mut Plain<1>, i: usize, step: f64) {
    next.velocity[i] = [step];
    next.position[i] = [(next.position[i][0] + step).rem_euclid(next.ring)];
}

pub(crate) fn hamilton_1d(now: &Plain<1>) -> Plain<1> {
    let fraction = 1.0 / 3.0;
    let members = now.position.len();
    let mut next = now.next();
    if members < 3 {
        next.velocity.fill([0.0]);
        return next;
    }
    let mut order: Vec<usize> = (0..members).collect();
    order.sort_by(|&a, &b| now.position[a][0].total_cmp(&now.position[b][0]));
    // from each to the one behind it in the order, from the last one across the seam
    let mut gaps: Vec<f64> = order.windows(2).map(|two| now.position[two[1]][0] - now.position[two[0]][0]).collect();
    gaps.push(now.position[order[0]][0] + now.ring - now.position[order[members - 1]][0]);
    for (place, &i) in order.iter().enumerate() {
        let [left, behind, ahead, right] = [members - 2, members - 1, 0, 1].map(|from| gaps[(place + from) % members]);
        let jump = if behind + ahead < f64::min(left, right) {
            0.0
        } else if left < right {
            -behind - fraction * left
        } else {
            ahead + fraction * right
        };
        make(&mut next, i, jump);
    }
    next
}

pub(crate) fn gazi_passino_2005(now: &Plain<1>) -> Plain<1> {
    let (spacing, comfort, gain) = (0.5, 1.0, 0.5);
    let members = now.position.len();
    let mut next = now.next();
    let from = |i: usize, j: usize| {
        let offset = now.position[j][0] - now.position[i][0];
        offset - now.ring * (offset / now.ring + 0.5).floor()
    };
    for i in 0..members {
        let step = if i == 0 {
            0.0
        } else {
            let left = from(i, i - 1);
            let wanted = if i + 1 < members {
                let right = from(i, i + 1);
                f64::min(gain * (left + right) / 2.0, right - spacing)
            } else {
                gain * (left + comfort)
            };
            f64::max(wanted, left + spacing)
        };
        make(&mut next, i, step);
    }
    next
}
