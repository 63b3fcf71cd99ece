//! Splits Rust source into tokens, without comments and strings: the part of the language that paths need.

/// A word (identifier, keyword or number), a sign, or the path separator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Token {
    Word(String),
    Sign(char),
    /// `::`
    Path,
}

impl Token {
    /// The word, if the token is one.
    pub fn word(&self) -> Option<&str> {
        match self {
            Self::Word(word) => Some(word),
            _ => None,
        }
    }

    /// True if the token is this word.
    pub fn is(&self, word: &str) -> bool {
        self.word() == Some(word)
    }
}

/// Splits a source file into tokens.
pub fn tokens(source: &str) -> Vec<Token> {
    let text: Vec<char> = source.chars().collect();
    let mut tokens = Vec::new();
    let mut i = 0;
    while let Some(&c) = text.get(i) {
        let next = text.get(i + 1).copied().unwrap_or('\n');
        match c {
            '/' if next == '/' => i = find(&text, i, |c| c == '\n'),
            '/' if next == '*' => i = after_comment(&text, i),
            '"' => i = after_string(&text, i),
            '\'' => i = after_quote(&text, i),
            ':' if next == ':' => {
                tokens.push(Token::Path);
                i += 2;
            }
            c if is_part_of_word(c) => {
                let end = find(&text, i, |c| !is_part_of_word(c));
                let word: String = text[i..end].iter().collect();
                i = end;
                match text.get(i) {
                    Some('"') if matches!(word.as_str(), "b" | "c") => i = after_string(&text, i),
                    Some('"' | '#') if matches!(word.as_str(), "r" | "br" | "cr") => {
                        i = after_raw_string(&text, i);
                    }
                    Some('\'') if word == "b" => i = after_quote(&text, i),
                    _ => tokens.push(Token::Word(word)),
                }
            }
            c if c.is_whitespace() => i += 1,
            c => {
                tokens.push(Token::Sign(c));
                i += 1;
            }
        }
    }
    tokens
}

fn is_part_of_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The first index from `i` on for which `is` is true, or the end.
fn find(text: &[char], i: usize, is: impl Fn(char) -> bool) -> usize {
    text[i..].iter().position(|&c| is(c)).map_or(text.len(), |offset| i + offset)
}

/// Block comments may be nested.
fn after_comment(text: &[char], mut i: usize) -> usize {
    let mut depth = 0;
    while i + 1 < text.len() {
        match (text[i], text[i + 1]) {
            ('/', '*') => depth += 1,
            ('*', '/') => depth -= 1,
            _ => {
                i += 1;
                continue;
            }
        }
        i += 2;
        if depth == 0 {
            return i;
        }
    }
    text.len()
}

fn after_string(text: &[char], start: usize) -> usize {
    let mut i = start + 1;
    while i < text.len() && text[i] != '"' {
        i += if text[i] == '\\' { 2 } else { 1 };
    }
    (i + 1).min(text.len())
}

/// Starts at the characters after `r`; of a raw identifier (`r#type`) only the prefix is skipped.
fn after_raw_string(text: &[char], start: usize) -> usize {
    let open = find(text, start, |c| c != '#');
    if text.get(open) != Some(&'"') {
        return open;
    }
    let hashes = open - start;
    let is_end = |i: &usize| {
        text[*i] == '"' && text[i + 1..].iter().take(hashes).filter(|&&c| c == '#').count() == hashes
    };
    (open + 1..text.len()).find(is_end).map_or(text.len(), |end| end + 1 + hashes)
}

/// A character literal, or the apostrophe of a lifetime.
fn after_quote(text: &[char], start: usize) -> usize {
    let is_character = text.get(start + 1) == Some(&'\\') || text.get(start + 2) == Some(&'\'');
    if !is_character {
        return start + 1;
    }
    let mut i = start + 1;
    while i < text.len() && text[i] != '\'' {
        i += if text[i] == '\\' { 2 } else { 1 };
    }
    (i + 1).min(text.len())
}

#[cfg(test)]
mod tests {
    use super::{Token, tokens};

    fn words(source: &str) -> String {
        let word = |token: &Token| match token {
            Token::Word(word) => word.clone(),
            Token::Sign(sign) => sign.to_string(),
            Token::Path => "::".to_owned(),
        };
        tokens(source).iter().map(word).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn comments_and_strings_are_skipped() {
        assert_eq!(words("a // crate::x\nb /* crate::y /* nested */ */ c"), "a b c");
        assert_eq!(words(r#"a("crate::x \" b", b"c", 'd', '\'', '"')"#), "a ( , , , , )");
        assert_eq!(words("r\"a\" r#\"crate::\"x\"# br##\"\"#\"## z"), "z");
        assert_eq!(words("fn f<'a>(x: &'a str) -> r#type"), "fn f < a > ( x : & a str ) - > type");
        assert_eq!(words("crate::a::{b, c}"), "crate :: a :: { b , c }");
    }
}
