//! The scenarios that are built in, for looking at without any file.

/// A scenario that is built in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Built {
    /// Its id.
    pub id: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! gallery {
    ($($id:literal: $path:literal;)*) => {
        /// The scenarios, in the order in which they are shown.
        pub const LIST: &[Built] = &[$(Built { id: $id, text: include_str!(concat!("../../../studies/", $path)) }),*];
    };
}

gallery! {
    "schooling": "schooling.toml";
    "tank": "gallery/tank.toml";
    "vicsek": "gallery/vicsek.toml";
    "mill": "gallery/mill.toml";
    "starlings": "gallery/starlings.toml";
    "bottleneck": "gallery/bottleneck.toml";
    "foraging": "gallery/foraging.toml";
    "laser_robots": "gallery/laser_robots.toml";
    "corral": "gallery/corral.toml";
}

/// The scenario of an id.
pub fn find(id: &str) -> Option<&'static Built> {
    LIST.iter().find(|built| built.id == id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_one_can_be_read() {
        for built in LIST {
            let read = crate::scenario::build::read(built.id, built.text, &[]);
            assert!(read.is_ok_and(|read| !read.scenario.about.trim().is_empty()), "{}", built.id);
        }
        assert!(find("mill").is_some() && find("mil").is_none());
    }
}
