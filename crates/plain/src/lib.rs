//! The plainest loops for some laws: all pairs, 64-bit, default parameters, as a user would write them by hand for the world in which
//! `bench models` measures the engine against them: in open space, or on a ring where there is one dimension, without obstacles and
//! food. Most are of the plane. They are a second opinion on the laws.

mod accelerations;
mod angles;
mod bodies;
mod boids;
mod forces;
mod headings;
mod line;
mod robots;
mod states;
mod topological;
mod way_points;
mod zones;

use space::random::{Purpose, Stream};

/// The members at one moment, one entry an agent.
#[derive(Clone, Debug, PartialEq)]
pub struct Plain<const D: usize = 2> {
    /// Positions.
    pub position: Vec<[f64; D]>,
    /// Velocities.
    pub velocity: Vec<[f64; D]>,
    /// What else a law keeps from step to step: the columns of [`kept`], in their order.
    pub state: Vec<Vec<f64>>,
    /// Seed of random draws.
    pub seed: u64,
    /// Steps made so far.
    pub step: u64,
    /// Length of the ring where there is one dimension; infinite in open space.
    pub ring: f64,
}

impl<const D: usize> Plain<D> {
    /// Everything as it is, a step later.
    fn next(&self) -> Self {
        Self { step: self.step + 1, ..self.clone() }
    }
    /// The random draws of member `i` in this step: those of the engine.
    fn draws(&self, i: usize) -> Stream {
        Stream::new(self.seed, Purpose::Behaviour, self.step, i as u32)
    }
}

/// One step of a law.
pub type PlainStep<const D: usize = 2> = fn(&Plain<D>) -> Plain<D>;

/// The plain loop of a model of the plane, where there is one.
pub fn plain(model: &str) -> Option<PlainStep> {
    match model {
        "vicsek_1995" => Some(vicsek_1995),
        "couzin_2002" => Some(couzin_2002),
        "boids_rule_vectors" => Some(boids_rule_vectors),
        "cucker_smale_2007" => Some(cucker_smale_2007),
        // without walls they are the same law
        "reynolds_opensteer" | "boids_plus" => Some(reynolds_opensteer),
        "viscido_snn" => Some(viscido_snn),
        "czirok_1997" => Some(headings::czirok_1997),
        "toner_tu_1998" => Some(headings::toner_tu_1998),
        "smith_martin_2009" => Some(headings::smith_martin_2009),
        // they differ by their noise, which is none
        "gregoire_2003_vectorial" | "gregoire_2003_angular" => Some(headings::gregoire_2003_vectorial),
        "boids_unit_heading" => Some(headings::boids_unit_heading),
        "abm_flocking" => Some(headings::abm_flocking),
        "codling_2007" => Some(headings::codling_2007),
        "control_boids" => Some(headings::control_boids),
        "ballerini_2008" => Some(topological::ballerini_2008),
        "camperi_2012" => Some(topological::camperi_2012),
        "niizato_gunji_2011" => Some(topological::niizato_gunji_2011),
        "jadbabaie_2002_leaderless" => Some(angles::jadbabaie_2002_leaderless),
        "jadbabaie_2002_leader" => Some(angles::jadbabaie_2002_leader),
        "warren_2018" => Some(angles::warren_2018),
        "huth_wissel_a" => Some(angles::huth_wissel_a),
        "huth_wissel_d" => Some(angles::huth_wissel_d),
        "katz_herbert_read_2011" => Some(angles::katz_herbert_read_2011),
        "kunz_hemelrijk_2003" => Some(angles::kunz_hemelrijk_2003),
        "couzin_2005" => Some(zones::couzin_2005),
        "conradt_2009" => Some(zones::conradt_2009),
        "lopez_2012" => Some(zones::lopez_2012),
        "tien_2004" => Some(zones::tien_2004),
        "lukeman_2010" => Some(zones::lukeman_2010),
        "dong_2012" => Some(forces::dong_2012),
        "levine_2000" => Some(forces::levine_2000),
        "dorsogna_2006" => Some(forces::dorsogna_2006),
        "gazi_passino_2003" => Some(forces::gazi_passino_2003),
        "olfati_saber_2006" => Some(forces::olfati_saber_2006),
        "helbing_2005" => Some(forces::helbing_2005),
        "tanner_2003_fixed" => Some(accelerations::tanner_2003_fixed),
        "tanner_2003_dynamic" => Some(accelerations::tanner_2003_dynamic),
        "shimoyama_1996" => Some(accelerations::shimoyama_1996),
        "szabo_2008" => Some(accelerations::szabo_2008),
        "boids_five_force" => Some(boids::boids_five_force),
        "reynolds_kline" => Some(boids::reynolds_kline),
        "hartman_benes_2006" => Some(boids::hartman_benes_2006),
        "hauert_2011" => Some(boids::hauert_2011),
        "control_random" => Some(bodies::control_random),
        "control_snn" => Some(bodies::control_snn),
        "contact_only" => Some(bodies::contact_only),
        "arkin_balch_1999" => Some(robots::arkin_balch_1999),
        "turgut_2008" => Some(robots::turgut_2008),
        "gokce_sahin_2009" => Some(robots::gokce_sahin_2009),
        "kelly_keating_1996" => Some(robots::kelly_keating_1996),
        "mataric_1993" => Some(robots::mataric_1993),
        "hamilton_2d" => Some(way_points::hamilton_2d),
        "viscido_lch" => Some(way_points::viscido_lch),
        "viscido_ha" => Some(way_points::viscido_ha),
        "ha_extended" => Some(way_points::ha_extended),
        "lch_member_pose" => Some(way_points::lch_member_pose),
        "lch_member_bearing" => Some(way_points::lch_member_bearing),
        "lch_group_pose" => Some(way_points::lch_group_pose),
        "lch_group_bearing" => Some(way_points::lch_group_bearing),
        "snn_plus" => Some(way_points::snn_plus),
        "rm_plus" => Some(way_points::rm_plus),
        "warburton_lazarus_1991" => Some(way_points::warburton_lazarus_1991),
        "gueron_1996" => Some(states::gueron_1996),
        "competing_flocks" => Some(states::competing_flocks),
        _ => None,
    }
}

/// The plain loop of a model of the line, where there is one.
pub fn on_a_ring(model: &str) -> Option<PlainStep<1>> {
    match model {
        "hamilton_1d" => Some(line::hamilton_1d),
        "gazi_passino_2005" => Some(line::gazi_passino_2005),
        _ => None,
    }
}

/// The plain loop of a model of three dimensions alone, where there is one.
pub fn in_space(model: &str) -> Option<PlainStep<3>> {
    match model {
        "behaviour_selection" => Some(states::behaviour_selection),
        _ => None,
    }
}

/// Declared columns of a model that its plain loop keeps, too; the others only tell what a step was like.
pub fn kept(model: &str) -> &'static [&'static str] {
    match model {
        "gueron_1996" | "kelly_keating_1996" | "mataric_1993" | "turgut_2008" | "gokce_sahin_2009" => &["theta"],
        "contact_only" => &["collided"],
        "hartman_benes_2006" => &["timer"],
        "shimoyama_1996" => &["axis_x", "axis_y"],
        "szabo_2008" => &["prev_vel_x", "prev_vel_y"],
        "competing_flocks" => &["flock"],
        "behaviour_selection" => &["theta", "phi"],
        _ => &[],
    }
}

/// What a law makes of member `i`: its new position and velocity.
fn each(now: &Plain, law: impl Fn(usize) -> ([f64; 2], [f64; 2])) -> Plain {
    let mut next = now.next();
    for i in 0..now.position.len() {
        (next.position[i], next.velocity[i]) = law(i);
    }
    next
}

/// Everyone but `i`: the index, the offset and the distance.
fn others(now: &Plain, i: usize) -> impl Iterator<Item = (usize, [f64; 2], f64)> + '_ {
    let me = now.position[i];
    (0..now.position.len()).filter(move |&j| j != i).map(move |j| {
        let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
        (j, offset, (offset[0] * offset[0] + offset[1] * offset[1]).sqrt())
    })
}

/// The nearest of these others.
fn nearest(others: impl Iterator<Item = (usize, [f64; 2], f64)>) -> Option<(usize, [f64; 2], f64)> {
    others.reduce(|best, other| if other.2 < best.2 { other } else { best })
}

/// A vector times a number onto another.
fn add(sum: &mut [f64; 2], factor: f64, vector: [f64; 2]) {
    sum[0] += factor * vector[0];
    sum[1] += factor * vector[1];
}

/// Moves `i` a time with a velocity.
fn moved(now: &Plain, i: usize, velocity: [f64; 2], dt: f64) -> [f64; 2] {
    [now.position[i][0] + velocity[0] * dt, now.position[i][1] + velocity[1] * dt]
}

/// The direction, or another one where there is none.
fn unit_or(vector: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let direction = unit(vector);
    if direction == [0.0; 2] { other } else { direction }
}

/// A heading turned to another by at most an angle.
fn turned(heading: [f64; 2], wanted: [f64; 2], limit: f64) -> [f64; 2] {
    let between =
        (heading[0] * wanted[1] - heading[1] * wanted[0]).atan2(heading[0] * wanted[0] + heading[1] * wanted[1]);
    if between.abs() <= limit || heading == [0.0; 2] {
        return wanted;
    }
    turned_by(heading, limit.copysign(between))
}

/// A vector turned to the left by an angle.
fn turned_by([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [x * cos - y * sin, x * sin + y * cos]
}

/// The angle of a vector, from the x axis.
fn angle([x, y]: [f64; 2]) -> f64 {
    y.atan2(x)
}

/// The direction at an angle.
fn at_angle(angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos, sin]
}

/// The representative of an angle in (-pi, pi].
fn wrapped(angle: f64) -> f64 {
    let turn = core::f64::consts::TAU;
    angle - turn * (angle / turn - 0.5).ceil()
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

fn unit([x, y]: [f64; 2]) -> [f64; 2] {
    let length = (x * x + y * y).sqrt();
    if length > 1e-12 { [x / length, y / length] } else { [0.0, 0.0] }
}

fn clip([x, y]: [f64; 2], limit: f64) -> [f64; 2] {
    let length = (x * x + y * y).sqrt();
    if length > limit { [x * limit / length, y * limit / length] } else { [x, y] }
}

fn vicsek_1995(now: &Plain) -> Plain {
    let (radius, speed, dt) = (1.0, 0.03, 1.0);
    let mut next = now.next();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let [mut x, mut y] = unit(now.velocity[i]);
        for j in 0..now.position.len() {
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            if j != i && offset[0] * offset[0] + offset[1] * offset[1] < radius * radius {
                let heading = unit(now.velocity[j]);
                x += heading[0];
                y += heading[1];
            }
        }
        let mut wanted = unit([x, y]);
        if wanted == [0.0, 0.0] {
            wanted = unit(now.velocity[i]);
        }
        next.velocity[i] = [speed * wanted[0], speed * wanted[1]];
        next.position[i] = [me[0] + now.velocity[i][0] * dt, me[1] + now.velocity[i][1] * dt];
    }
    next
}

fn couzin_2002(now: &Plain) -> Plain {
    let (r_r, r_o, r_a, speed, dt): (f64, f64, f64, f64, f64) = (1.0, 6.0, 14.0, 3.0, 0.1);
    let cos_half = (270.0f64.to_radians() / 2.0).cos();
    let limit = 40.0f64.to_radians() * dt;
    let mut next = now.next();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let heading = unit(now.velocity[i]);
        let (mut repulsion, mut orientation, mut attraction) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let (mut repelled, mut oriented, mut attracted) = (0, 0, 0);
        for j in 0..now.position.len() {
            if j == i {
                continue;
            }
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
            if distance >= r_a {
                continue;
            }
            let direction = unit(offset);
            if distance < r_r {
                repulsion[0] -= direction[0];
                repulsion[1] -= direction[1];
                repelled += 1;
            } else if heading == [0.0; 2] || heading[0] * offset[0] + heading[1] * offset[1] >= cos_half * distance {
                if distance < r_o {
                    let other = unit(now.velocity[j]);
                    orientation[0] += other[0];
                    orientation[1] += other[1];
                    oriented += 1;
                } else {
                    attraction[0] += direction[0];
                    attraction[1] += direction[1];
                    attracted += 1;
                }
            }
        }
        let mut wanted = if repelled > 0 {
            unit(repulsion)
        } else {
            match (oriented > 0, attracted > 0) {
                (true, true) => unit([(orientation[0] + attraction[0]) / 2.0, (orientation[1] + attraction[1]) / 2.0]),
                (true, false) => unit(orientation),
                (false, true) => unit(attraction),
                (false, false) => heading,
            }
        };
        if wanted == [0.0, 0.0] {
            wanted = heading;
        }
        wanted = turned(heading, wanted, limit);
        next.velocity[i] = [speed * wanted[0], speed * wanted[1]];
        next.position[i] = [me[0] + next.velocity[i][0] * dt, me[1] + next.velocity[i][1] * dt];
    }
    next
}

fn boids_rule_vectors(now: &Plain) -> Plain {
    let (radius, w_av, w_vm, w_fc, max_speed, dt): (f64, f64, f64, f64, f64, f64) = (10.0, 1.0, 1.0, 0.1, 2.0, 0.1);
    let mut next = now.next();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let (mut avoid, mut matched, mut centre, mut count) = ([0.0; 2], [0.0; 2], [0.0; 2], 0.0);
        for j in 0..now.position.len() {
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
            if j == i || distance >= radius {
                continue;
            }
            let direction = unit(offset);
            let weight = if distance > 1e-12 { (radius / distance).powi(2) } else { 0.0 };
            let heading = unit(now.velocity[j]);
            for a in 0..2 {
                avoid[a] -= weight * direction[a];
                matched[a] += heading[a];
                centre[a] += offset[a];
            }
            count += 1.0;
        }
        let mut velocity = now.velocity[i];
        if count > 0.0 {
            for a in 0..2 {
                velocity[a] += dt * (w_av * avoid[a] + w_vm * matched[a] + w_fc * centre[a]) / count;
            }
        }
        let velocity = clip(velocity, max_speed);
        next.velocity[i] = velocity;
        next.position[i] = [me[0] + velocity[0] * dt, me[1] + velocity[1] * dt];
    }
    next
}

fn cucker_smale_2007(now: &Plain) -> Plain {
    let (strength, sigma, beta, dt): (f64, f64, f64, f64) = (1.0, 1.0, 0.4, 0.05);
    let mut next = now.next();
    for i in 0..now.position.len() {
        let (me, mine) = (now.position[i], now.velocity[i]);
        let mut sum = [0.0; 2];
        for j in 0..now.position.len() {
            if j != i {
                let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
                let squared = offset[0] * offset[0] + offset[1] * offset[1];
                let weight = strength / (sigma * sigma + squared).powf(beta);
                sum[0] += weight * (now.velocity[j][0] - mine[0]);
                sum[1] += weight * (now.velocity[j][1] - mine[1]);
            }
        }
        next.velocity[i] = [mine[0] + dt * sum[0], mine[1] + dt * sum[1]];
        next.position[i] = [me[0] + dt * mine[0], me[1] + dt * mine[1]];
    }
    next
}

fn reynolds_opensteer(now: &Plain) -> Plain {
    let (sep_radius, sep_cos, w_sep) = (5.0, -0.707, 12.0);
    let (ali_radius, ali_cos, w_ali) = (7.5, 0.7, 8.0);
    let (coh_radius, coh_cos, w_coh) = (9.0, -0.15, 8.0);
    let (min_dist, max_force, max_speed, dt) = (1.5, 27.0, 9.0, 0.05);
    let mut next = now.next();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let heading = unit(now.velocity[i]);
        let (mut separation, mut alignment, mut cohesion) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let (mut separated, mut aligned, mut cohering) = (0.0, 0.0, 0.0);
        for j in 0..now.position.len() {
            if j == i {
                continue;
            }
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            let squared = offset[0] * offset[0] + offset[1] * offset[1];
            let distance = squared.sqrt();
            let direction = unit(offset);
            let ahead = heading[0] * direction[0] + heading[1] * direction[1];
            let seen = |radius: f64, cos: f64| distance < min_dist || (distance < radius && ahead > cos);
            if seen(sep_radius, sep_cos) {
                if distance > 1e-12 {
                    separation[0] -= offset[0] / squared;
                    separation[1] -= offset[1] / squared;
                }
                separated += 1.0;
            }
            if seen(ali_radius, ali_cos) {
                let other = unit(now.velocity[j]);
                alignment[0] += other[0];
                alignment[1] += other[1];
                aligned += 1.0;
            }
            if seen(coh_radius, coh_cos) {
                cohesion[0] += offset[0];
                cohesion[1] += offset[1];
                cohering += 1.0;
            }
        }
        let mut force = [0.0; 2];
        let mut add = |weight: f64, direction: [f64; 2]| {
            force[0] += weight * direction[0];
            force[1] += weight * direction[1];
        };
        if separated > 0.0 {
            add(w_sep, unit([separation[0] / separated, separation[1] / separated]));
        }
        if aligned > 0.0 {
            add(w_ali, unit([alignment[0] / aligned - heading[0], alignment[1] / aligned - heading[1]]));
        }
        if cohering > 0.0 {
            add(w_coh, unit([cohesion[0] / cohering, cohesion[1] / cohering]));
        }
        let force = clip(force, max_force);
        let velocity = clip([now.velocity[i][0] + dt * force[0], now.velocity[i][1] + dt * force[1]], max_speed);
        next.velocity[i] = velocity;
        next.position[i] = [me[0] + dt * velocity[0], me[1] + dt * velocity[1]];
    }
    next
}

fn viscido_snn(now: &Plain) -> Plain {
    let (step, r_rep) = (1.0, 2.0);
    let mut next = now.next();
    for i in 0..now.position.len() {
        let me = now.position[i];
        let (mut nearest, mut least) = ([0.0; 2], f64::INFINITY);
        for j in 0..now.position.len() {
            let offset = [now.position[j][0] - me[0], now.position[j][1] - me[1]];
            let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
            if j != i && distance < least {
                (nearest, least) = (offset, distance);
            }
        }
        let moved = if least > r_rep && least.is_finite() { unit(nearest).map(|c| c * step) } else { [0.0; 2] };
        next.velocity[i] = moved;
        next.position[i] = [me[0] + moved[0], me[1] + moved[1]];
    }
    next
}
