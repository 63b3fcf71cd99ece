//! Checks the links between documents: files, pages and headings. External links are not fetched.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::PAGES;
use super::markdown::{self, Document};

/// Documents outside the guide: the Markdown files in these folders.
const FOLDERS: [&str; 4] = ["", "docs", "docs/design", "crates/splashdown/scenes"];

/// Checks every document and returns the number of links and the broken ones.
///
/// # Errors
/// If a document or an included part does not exist, or a page is missing from the table of contents.
pub fn check(root: &Path) -> Result<(usize, Vec<String>)> {
    let mut documents = BTreeMap::new();
    for path in documents_of(root)? {
        documents.insert(path.clone(), markdown::read(&root.join(&path))?);
    }
    let pages = pages(root)?;
    for page in written_pages(root)? {
        ensure!(pages.contains(&page), "{} is not listed in {PAGES}/SUMMARY.md", page.display());
    }
    for page in pages {
        documents.insert(page.clone(), markdown::read(&root.join(&page))?);
    }
    let mut problems = Vec::new();
    let mut count = 0;
    for (path, document) in &documents {
        for (line, target) in &document.links {
            count += 1;
            if let Err(problem) = check_link(root, &documents, path, target) {
                problems.push(format!("{}:{line}: {target}: {problem}", path.display()));
            }
        }
    }
    Ok((count, problems))
}

fn check_link(
    root: &Path,
    documents: &BTreeMap<PathBuf, Document>,
    from: &Path,
    target: &str,
) -> Result<(), String> {
    if ["https://", "http://", "mailto:"].iter().any(|scheme| target.starts_with(scheme)) {
        return Ok(());
    }
    let (file, heading) = target.split_once('#').unwrap_or((target, ""));
    let path = if file.is_empty() {
        from.to_owned()
    } else {
        normal(&from.with_file_name("").join(file)).ok_or("leaves the repository")?
    };
    let is_page = from.starts_with(PAGES);
    if is_page && !path.starts_with(PAGES) {
        return Err(format!("leaves {PAGES}, so the book would not contain it"));
    }
    if !root.join(&path).exists() {
        return Err("does not exist".to_owned());
    }
    let is_markdown = path.extension().is_some_and(|end| end == "md");
    match documents.get(&path) {
        None if is_page && is_markdown => Err("is not a page of the guide".to_owned()),
        None if heading.is_empty() => Ok(()),
        None => Err("headings of this file are not known".to_owned()),
        Some(document) if heading.is_empty() || document.anchors.contains(heading) => Ok(()),
        Some(_) => Err(format!("has no heading #{heading}")),
    }
}

/// Removes `.` and `..`; `None` if the path leaves its starting folder.
fn normal(path: &Path) -> Option<PathBuf> {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if out.pop() => {}
            Component::Normal(name) => out.push(name),
            _ => return None,
        }
    }
    Some(out)
}

fn documents_of(root: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for folder in FOLDERS {
        let entries = fs::read_dir(root.join(folder)).with_context(|| format!("cannot read {folder:?}"))?;
        for entry in entries {
            let name = PathBuf::from(entry?.file_name());
            if name.extension().is_some_and(|end| end == "md") {
                found.push(Path::new(folder).join(name));
            }
        }
    }
    Ok(found)
}

/// The pages of the table of contents, relative to the repository.
///
/// # Errors
/// If the table of contents cannot be read.
pub fn pages(root: &Path) -> Result<Vec<PathBuf>> {
    let summary = Path::new(PAGES).join("SUMMARY.md");
    let mut pages = vec![summary.clone()];
    for (_, target) in markdown::read(&root.join(&summary))?.links {
        pages.push(Path::new(PAGES).join(target));
    }
    Ok(pages)
}

/// The Markdown files directly in the folder of pages.
fn written_pages(root: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(root.join(PAGES))? {
        let name = PathBuf::from(entry?.file_name());
        if name.extension().is_some_and(|end| end == "md") {
            found.push(Path::new(PAGES).join(name));
        }
    }
    Ok(found)
}

/// Files other than pages that pages link to, relative to the repository.
///
/// # Errors
/// If a page cannot be read.
pub fn linked_files(root: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for page in pages(root)? {
        for (_, target) in markdown::read(&root.join(&page))?.links {
            let file = target.split('#').next().unwrap_or_default();
            if file.is_empty()
                || file.contains("://")
                || Path::new(file).extension().is_some_and(|end| end == "md")
            {
                continue;
            }
            found.extend(normal(&page.with_file_name("").join(file)));
        }
    }
    found.sort();
    found.dedup();
    Ok(found)
}

/// The name that mdBook gives to a page: `README.md` becomes `index.html`, `SUMMARY.md` becomes `toc.html`.
pub fn html_name(page: &Path) -> PathBuf {
    let relative = page.strip_prefix(PAGES).unwrap_or(page);
    match relative.file_name().and_then(|name| name.to_str()) {
        Some("README.md") => relative.with_file_name("index.html"),
        Some("SUMMARY.md") => relative.with_file_name("toc.html"),
        _ => relative.with_extension("html"),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    use super::{PAGES, check, html_name, normal};

    /// A small repository in a temporary folder.
    struct Repository(PathBuf);

    impl Repository {
        fn new(name: &str, page: &str) -> Self {
            let root = std::env::temp_dir().join(format!("splashdown-links-{name}-{}", std::process::id()));
            let _ = fs::remove_dir_all(&root);
            for folder in ["docs/design", "crates/splashdown/scenes", PAGES] {
                fs::create_dir_all(root.join(folder)).unwrap();
            }
            let write = |path: &str, text: &str| fs::write(root.join(path), text).unwrap();
            write(
                "README.md",
                "# Start\n\n[guide](docs/guide/src/SUMMARY.md), [code](src), [web](https://example.org)\n",
            );
            fs::create_dir(root.join("src")).unwrap();
            write(&format!("{PAGES}/SUMMARY.md"), "# Summary\n\n- [Page](page.md)\n- [Two](two.md)\n");
            write(&format!("{PAGES}/page.md"), page);
            write(
                &format!("{PAGES}/two.md"),
                "# Two\n\n## Part\n\n<!-- ANCHOR: t -->\nText\n<!-- ANCHOR_END: t -->\n",
            );
            Self(root)
        }

        fn problems(&self) -> Vec<String> {
            check(&self.0).unwrap().1
        }
    }

    impl Drop for Repository {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn valid_links_pass() {
        let text = "# One\n\n[two](two.md#part), [here](#one)\n\n{{#include two.md:t}}\n";
        let repository = Repository::new("valid", text);
        assert_eq!(repository.problems(), Vec::<String>::new());
        assert!(check(&repository.0).unwrap().0 >= 6);
    }

    /// Negative controls: each kind of broken link is found.
    #[test]
    fn broken_links_are_found() {
        for (index, (text, complaint)) in [
            ("[x](gone.md)", "does not exist"),
            ("[x](two.md#gone)", "has no heading #gone"),
            ("[x](#gone)", "has no heading #gone"),
            ("[x](../../../README.md)", "leaves docs/guide/src"),
            ("![x](gone.png)", "does not exist"),
            ("[x](../../../../elsewhere)", "leaves the repository"),
        ]
        .into_iter()
        .enumerate()
        {
            let repository = Repository::new(&format!("broken{index}"), text);
            let problems = repository.problems();
            assert_eq!(problems.len(), 1, "{text}: {problems:?}");
            assert!(problems[0].contains(complaint), "{text}: {problems:?}");
        }
    }

    #[test]
    fn missing_parts_and_unlisted_pages_are_errors() {
        let repository = Repository::new("part", "{{#include two.md:gone}}\n");
        assert!(format!("{:#}", check(&repository.0).unwrap_err()).contains("no part"));
        let repository = Repository::new("unlisted", "# One\n");
        fs::write(repository.0.join(PAGES).join("three.md"), "# Three\n").unwrap();
        assert!(check(&repository.0).unwrap_err().to_string().contains("not listed"));
    }

    #[test]
    fn page_names_match_those_of_mdbook() {
        assert_eq!(normal(Path::new("a/../b/./c")), Some(PathBuf::from("b/c")));
        assert_eq!(normal(Path::new("../a")), None);
        assert_eq!(html_name(&Path::new(PAGES).join("scenes/README.md")), Path::new("scenes/index.html"));
        assert_eq!(html_name(&Path::new(PAGES).join("faq.md")), Path::new("faq.html"));
    }
}
