//! Tables of text, with columns as wide as they need to be.

/// A table of text.
pub struct Table {
    rows: Vec<Vec<String>>,
    right: Vec<usize>,
}

impl Table {
    /// A table with these headings.
    pub fn new(headings: &[&str]) -> Self {
        Self { rows: vec![headings.iter().map(|&h| h.to_owned()).collect()], right: Vec::new() }
    }
    /// Sets columns flush right.
    pub fn right(&mut self, columns: &[usize]) {
        self.right = columns.to_vec();
    }
    /// Adds a row.
    pub fn row(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }
    /// Whether it has no row beside the headings.
    pub fn is_empty(&self) -> bool {
        self.rows.len() == 1
    }
    /// The table in plain text.
    pub fn text(&self) -> String {
        let columns = self.rows[0].len();
        let wide = |c: usize| self.rows.iter().filter_map(|row| row.get(c)).map(|t| t.chars().count()).max();
        let widths: Vec<usize> = (0..columns).map(|c| wide(c).unwrap_or(0)).collect();
        let mut text = String::new();
        for (r, row) in self.rows.iter().enumerate() {
            let mut line = String::new();
            for (c, entry) in row.iter().enumerate() {
                let width = widths[c];
                if c > 0 {
                    line += "  ";
                }
                line += &if self.right.contains(&c) { format!("{entry:>width$}") } else { format!("{entry:<width$}") };
            }
            text += line.trim_end();
            text.push('\n');
            if r == 0 {
                let rules: Vec<String> = widths.iter().map(|&width| "-".repeat(width)).collect();
                text += rules.join("  ").trim_end();
                text.push('\n');
            }
        }
        text
    }
    /// The table as comma-separated values; what holds a comma, a quote or a line break is quoted.
    pub fn csv(&self) -> String {
        let cell = |entry: &String| match entry.contains([',', '"', '\n']) {
            true => format!("\"{}\"", entry.replace('"', "\"\"")),
            false => entry.clone(),
        };
        self.rows.iter().map(|row| row.iter().map(cell).collect::<Vec<_>>().join(",") + "\n").collect()
    }
    /// The table in Markdown.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        for (r, row) in self.rows.iter().enumerate() {
            let cells: Vec<String> = row.iter().map(|entry| entry.replace('|', "\\|").replace('\n', "<br>")).collect();
            text += &format!("| {} |\n", cells.join(" | "));
            if r == 0 {
                let rule = |c: usize| if self.right.contains(&c) { "---:" } else { "---" };
                let rules: Vec<&str> = (0..row.len()).map(rule).collect();
                text += &format!("| {} |\n", rules.join(" | "));
            }
        }
        text
    }
}
