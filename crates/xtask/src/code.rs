//! Rust text without what is not code: comments, strings and characters become spaces; lines stay where they are.

/// The code of a Rust file.
pub(crate) fn code(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    while at < letters.len() {
        let end = skipped(&letters, at);
        if end > at {
            out.extend(letters[at..end].iter().map(|&letter| if letter == '\n' { '\n' } else { ' ' }));
            at = end;
        } else if letters[at].is_alphanumeric() || letters[at] == '_' {
            // a whole word, so that the r of `for"` is not taken for the start of a raw string
            let word = letters[at..].iter().take_while(|&&l| l.is_alphanumeric() || l == '_').count();
            out.extend(&letters[at..at + word]);
            at += word;
        } else {
            out.push(letters[at]);
            at += 1;
        }
    }
    out
}

/// The end of what starts here if it is no code, otherwise the start itself.
fn skipped(letters: &[char], start: usize) -> usize {
    let at = |k: usize| letters.get(start + k).copied().unwrap_or('\0');
    let rest = &letters[start..];
    match (at(0), at(1)) {
        ('/', '/') => start + rest.iter().position(|&l| l == '\n').unwrap_or(rest.len()),
        ('/', '*') => block_comment(letters, start),
        ('"', _) => quoted(letters, start + 1, '"'),
        ('b' | 'c', '"') => quoted(letters, start + 2, '"'),
        ('b', '\'') => quoted(letters, start + 2, '\''),
        ('\'', '\\') => quoted(letters, start + 1, '\''),
        ('\'', _) if at(2) == '\'' => start + 3,
        ('r', '"' | '#') => raw(letters, start, start + 1),
        ('b' | 'c', 'r') if matches!(at(2), '"' | '#') => raw(letters, start, start + 2),
        _ => start,
    }
}

fn block_comment(letters: &[char], start: usize) -> usize {
    let (mut depth, mut at) = (0, start);
    while at < letters.len() {
        match (letters[at], letters.get(at + 1)) {
            ('/', Some('*')) => (depth, at) = (depth + 1, at + 2),
            ('*', Some('/')) => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at.min(letters.len())
}

fn quoted(letters: &[char], mut at: usize, end: char) -> usize {
    while at < letters.len() && letters[at] != end {
        at += if letters[at] == '\\' { 2 } else { 1 };
    }
    (at + 1).min(letters.len())
}

/// A raw string whose hashes or quote start at `at`; a raw identifier is code.
fn raw(letters: &[char], start: usize, mut at: usize) -> usize {
    let hashes = letters[at..].iter().take_while(|&&l| l == '#').count();
    at += hashes;
    if letters.get(at) != Some(&'"') {
        return start;
    }
    at += 1;
    while at < letters.len() {
        let closed =
            letters[at] == '"' && letters[at + 1..].iter().take(hashes).filter(|&&l| l == '#').count() == hashes;
        at += 1;
        if closed {
            return (at + hashes).min(letters.len());
        }
    }
    at
}

/// The lines, counted from 1, whose code has a word.
pub(crate) fn lines_with(text: &str, word: &str) -> Vec<usize> {
    let is_there = |line: &str| line.split(|l: char| !l.is_alphanumeric() && l != '_').any(|found| found == word);
    code(text).lines().enumerate().filter(|(_, line)| is_there(line)).map(|(n, _)| n + 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_code_counts() {
        let text = r####"// word
/* word /* word */ word */
let a = "word \" word"; let b = r#"word " word"#; let c = b"word";
let quote = '"'; let escaped = '\''; let byte = b'"'; fn f<'a>(x: &'a str) {}
#![deny(word_in_word)]
let r#type = for_r("word");
word { }
x(word);"####;
        assert_eq!(lines_with(text, "word"), [7, 8]);
        assert_eq!(code(text).lines().count(), text.lines().count());
        assert!(code(text).contains("fn f<'a>(x: &'a str) {}"));
    }
}
