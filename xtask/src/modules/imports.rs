//! Finds the paths of a source file that refer to other modules of its crate.

use super::tokens::{Token, tokens};

/// The imports of a source file.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Imports {
    /// The first name after the crate root of each path: a module or an item of the root.
    pub names: Vec<String>,
    /// Child modules that are compiled only for tests or documentation.
    pub test_modules: Vec<String>,
    /// Names of macros that the file exports at the root of the crate (`#[macro_export]`).
    pub macros: Vec<String>,
}

/// Reads the file of the module at this path below the root (empty for the root itself). Comments and items that exist
/// only for tests are ignored.
pub fn imports(source: &str, module: &[String]) -> Imports {
    let tokens = tokens(source);
    let mut found = Imports::default();
    let mut module = module.to_vec();
    // Brace depths at which inline modules began.
    let mut inline = Vec::new();
    let mut depth = 0;
    let mut i = 0;
    while i < tokens.len() {
        if let Some((attribute, after)) = attribute(&tokens, i) {
            if is_for_tests(attribute) {
                let (end, child) = after_item(&tokens, after);
                found.test_modules.extend(child);
                i = end;
            } else {
                i = after;
                if attribute.first().is_some_and(|word| word.is("macro_export"))
                    && let Some(name) = macro_name(&tokens[after..])
                {
                    found.macros.push(name);
                    // The paths in an exported macro belong to the modules that use it.
                    i = after_item(&tokens, after).0;
                }
            }
            continue;
        }
        match &tokens[i] {
            Token::Sign('{') => depth += 1,
            Token::Sign('}') => {
                depth -= 1;
                if inline.last() == Some(&depth) {
                    inline.pop();
                    module.pop();
                }
            }
            Token::Word(word) if word == "mod" && tokens.get(i + 2) == Some(&Token::Sign('{')) => {
                module.extend(tokens[i + 1].word().map(str::to_owned));
                inline.push(depth);
            }
            Token::Word(word) if starts_path(&tokens, i, word) => {
                let mut level = if word == "crate" { 0 } else { module.len() };
                if word == "super" {
                    level = level.saturating_sub(1);
                }
                i += 2;
                while tokens.get(i).is_some_and(|token| token.is("super")) {
                    level = level.saturating_sub(1);
                    i += 2;
                }
                if level == 0 {
                    found.names.extend(first_names(&tokens[i..]));
                }
                continue;
            }
            _ => {}
        }
        i += 1;
    }
    found
}

/// True for `crate::`, `self::` and `super::` at the beginning of a path.
fn starts_path(tokens: &[Token], i: usize, word: &str) -> bool {
    matches!(word, "crate" | "self" | "super")
        && tokens.get(i + 1) == Some(&Token::Path)
        && (i == 0 || tokens[i - 1] != Token::Path)
}

/// The name after the beginning of a path, or all names of a group.
fn first_names(tokens: &[Token]) -> Vec<String> {
    match tokens.first() {
        Some(Token::Word(word)) => vec![word.clone()],
        Some(Token::Sign('{')) => {
            let mut names = Vec::new();
            let mut depth = 0;
            let mut is_first = false;
            for token in tokens {
                match token {
                    Token::Sign('{') => {
                        depth += 1;
                        is_first = depth == 1;
                    }
                    Token::Sign('}') => depth -= 1,
                    Token::Sign(',') => is_first = depth == 1,
                    Token::Word(word) if is_first => {
                        names.push(word.clone());
                        is_first = false;
                    }
                    _ => {}
                }
                if depth == 0 {
                    break;
                }
            }
            names
        }
        _ => Vec::new(),
    }
}

/// The tokens inside an attribute that begins here, and the index after it.
fn attribute(tokens: &[Token], i: usize) -> Option<(&[Token], usize)> {
    if tokens[i] != Token::Sign('#') {
        return None;
    }
    let is_inner = tokens.get(i + 1) == Some(&Token::Sign('!'));
    let open = i + 1 + usize::from(is_inner);
    if tokens.get(open) != Some(&Token::Sign('[')) {
        return None;
    }
    let end = after_group(tokens, open);
    Some((&tokens[open + 1..end - 1], end))
}

/// True for `#[cfg(test)]`, `#[cfg(all(test, ..))]`, `#[cfg(doc)]` and `#[test]`.
fn is_for_tests(attribute: &[Token]) -> bool {
    let has = |word: &str| attribute.iter().any(|token| token.is(word));
    let is_test = attribute.len() == 1 && has("test");
    let is_cfg = attribute.first().is_some_and(|token| token.is("cfg"));
    is_test || (is_cfg && !has("not") && !has("any") && (has("test") || has("doc") || has("doctest")))
}

/// The index after the item that begins here, and the name of the module if the item is `mod name;`.
fn after_item(tokens: &[Token], mut i: usize) -> (usize, Option<String>) {
    while i < tokens.len() {
        match attribute(tokens, i) {
            Some((_, after)) => i = after,
            None => break,
        }
    }
    let start = i;
    let mut is_use = false;
    while i < tokens.len() {
        match &tokens[i] {
            Token::Word(word) if word == "use" => is_use = true,
            Token::Sign(';') => {
                let words: Vec<&str> = tokens[start..i].iter().filter_map(Token::word).collect();
                let place = words.iter().position(|word| *word == "mod");
                return (i + 1, place.and_then(|place| words.get(place + 1)).map(|name| (*name).to_owned()));
            }
            Token::Sign(',') => return (i + 1, None),
            // The end of the enclosing block, for example after the last field of a struct.
            Token::Sign('}') => return (i, None),
            Token::Sign('{') if !is_use => {
                let end = after_group(tokens, i);
                // A block that does not end the item, as in `static X: [u8; { 1 }] = ..`, is inside brackets.
                return (end, None);
            }
            Token::Sign('{' | '(' | '[') => {
                i = after_group(tokens, i);
                continue;
            }
            _ => {}
        }
        i += 1;
    }
    (i, None)
}

/// The index after a group in brackets.
fn after_group(tokens: &[Token], mut i: usize) -> usize {
    let mut depth = 0;
    while i < tokens.len() {
        match tokens[i] {
            Token::Sign('{' | '(' | '[') => depth += 1,
            Token::Sign('}' | ')' | ']') => depth -= 1,
            _ => {}
        }
        i += 1;
        if depth == 0 {
            break;
        }
    }
    i
}

/// The name of the macro whose definition follows, possibly after other attributes.
fn macro_name(tokens: &[Token]) -> Option<String> {
    let at = tokens.iter().take(40).position(|token| token.is("macro_rules"))?;
    Some(tokens.get(at + 2)?.word()?.to_owned())
}

#[cfg(test)]
mod tests {
    use super::imports;

    fn names(source: &str, module: &str) -> Vec<String> {
        let module: Vec<String> =
            module.split("::").filter(|name| !name.is_empty()).map(Into::into).collect();
        imports(source, &module).names
    }

    #[test]
    fn paths_from_the_root_are_found() {
        assert_eq!(names("use crate::a::b; fn f() -> crate::c::D { crate::e() }", "x"), ["a", "c", "e"]);
        assert_eq!(names("use crate::{a, b::{c, d}, e::*, F as G};", "x"), ["a", "b", "e", "F"]);
        assert_eq!(names("pub(crate) use foo; pub(in crate::a) fn f() {}", "a::x"), ["a"]);
        assert_eq!(names("macro_rules! m { () => { $crate::a::f() } }", "x"), ["a"]);
    }

    #[test]
    fn chains_of_super_are_resolved() {
        assert_eq!(names("use super::a;", "x"), ["a"]);
        assert_eq!(names("use super::{a, b};", "x::y"), [""; 0]);
        assert_eq!(names("use super::super::{a, b::c};", "x::y"), ["a", "b"]);
        assert_eq!(names("mod inner { use super::a; use super::super::b; } use super::c;", "x"), ["b", "c"]);
        assert_eq!(names("use other::super::x;", "x"), [""; 0]);
    }

    #[test]
    fn tests_and_comments_are_ignored() {
        let source = "
            #[cfg(test)] use crate::a;
            #[cfg(test)] #[path = \"t.rs\"] mod tests;
            #[cfg(all(test, unix))] mod more { use crate::b; fn f() { crate::c() } }
            struct S { #[cfg(test)] a: crate::d::A, b: crate::kept::B, #[cfg(test)] c: crate::e::C }
            #[test] fn t() { crate::f::g() }
            #[cfg(doc)] use crate::g::H;
            /// [`crate::h`]
            #[cfg(not(test))] use crate::also::I;
        ";
        let found = imports(source, &["x".to_owned()]);
        assert_eq!(found.names, ["kept", "also"]);
        assert_eq!(found.test_modules, ["tests"]);
    }

    #[test]
    fn exported_macros_are_found() {
        let found = imports(
            "#[macro_export]\n#[doc(hidden)]\nmacro_rules! deep { () => { $crate::a } } use crate::b;",
            &["x".to_owned()],
        );
        assert_eq!(found.macros, ["deep"]);
        assert_eq!(found.names, ["b"]);
    }
}
