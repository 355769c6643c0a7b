//! The page and its parts, in the binary.

/// The page.
pub(super) const PAGE: &[u8] = include_bytes!("../../../../web/index.html");

macro_rules! parts {
    ($($name:literal: $kind:literal;)*) => {
        /// Its parts: name, kind, bytes.
        pub(super) const FILES: &[(&str, &str, &[u8])] =
            &[$(($name, $kind, include_bytes!(concat!("../../../../web/", $name)))),*];
    };
}

parts! {
    "style.css": "text/css; charset=utf-8";
    "camera.js": "text/javascript; charset=utf-8";
    "charts.js": "text/javascript; charset=utf-8";
    "connection.js": "text/javascript; charset=utf-8";
    "decomposition.js": "text/javascript; charset=utf-8";
    "design.js": "text/javascript; charset=utf-8";
    "draw.js": "text/javascript; charset=utf-8";
    "drawing.js": "text/javascript; charset=utf-8";
    "evolution.js": "text/javascript; charset=utf-8";
    "explain.js": "text/javascript; charset=utf-8";
    "formation.js": "text/javascript; charset=utf-8";
    "frame.js": "text/javascript; charset=utf-8";
    "gallery.js": "text/javascript; charset=utf-8";
    "main.js": "text/javascript; charset=utf-8";
    "map.js": "text/javascript; charset=utf-8";
    "optimisation.js": "text/javascript; charset=utf-8";
    "pair.js": "text/javascript; charset=utf-8";
    "pane.js": "text/javascript; charset=utf-8";
    "paper.js": "text/javascript; charset=utf-8";
    "painter.js": "text/javascript; charset=utf-8";
    "panel.js": "text/javascript; charset=utf-8";
    "picture.js": "text/javascript; charset=utf-8";
    "plot.js": "text/javascript; charset=utf-8";
    "searched.js": "text/javascript; charset=utf-8";
    "sketch.js": "text/javascript; charset=utf-8";
    "solids.js": "text/javascript; charset=utf-8";
    "study.js": "text/javascript; charset=utf-8";
    "trails.js": "text/javascript; charset=utf-8";
    "vector.js": "text/javascript; charset=utf-8";
    "words.js": "text/javascript; charset=utf-8";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_the_page_is_here_and_the_whole_is_small() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../web");
        let there =
            std::fs::read_dir(folder).map(|entries| entries.flatten().map(|e| e.file_name()).collect::<Vec<_>>());
        for name in there.unwrap_or_default() {
            let name = name.to_string_lossy().into_owned();
            let part = name.ends_with(".js") || name.ends_with(".css");
            assert!(!part || FILES.iter().any(|(known, ..)| *known == name), "{name} is not in the list");
        }
        let size = PAGE.len() + FILES.iter().map(|(_, _, bytes)| bytes.len()).sum::<usize>();
        assert!(size < 500_000, "the page has {size} bytes");
    }
}
