//! The book, README and CONTRIBUTING: short sentences, plain words, links that lead somewhere.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

use crate::common::{files_below, is_kind, report, slashed};

/// Words a sentence may have.
const MAX_SENTENCE: usize = 30;
/// Words a paragraph, an item of a list or a cell of a table may have.
const MAX_PARAGRAPH: usize = 90;
/// Characters a line may have; rows of tables, code and addresses may be longer.
const MAX_LINE: usize = 120;
/// Lines that single pages may have.
const MAX_PAGES: [(&str, usize); 3] = [("README.md", 120), ("CHANGELOG.md", 60), ("docs/method/", 150)];

/// A page says what is, in terms of the glossary or plain words.
const BANNED: [&str; 24] = [
    "now", "today", "nowadays", "no longer", "any longer", "any more", "anymore", "used to", "formerly", "previously",
    "debt", "debts", "books", "wake", "wakes", "woken", "awake", "asleep", "sleepers", "breathe", "breathed",
    "cushion", "loop of no turn", "loops of no turn",
];

/// Folders whose paths, where a page names them as code, must exist.
const FOLDERS: [&str; 9] =
    ["shaders/", "src/", "tests/", "scripts/", "scenes/", "docs/", "assets/", "python/", "examples/"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

struct Page {
    /// Relative to the root, with slashes.
    name: String,
    text: String,
}

fn pages() -> Vec<Page> {
    let docs = files_below(&root().join("docs")).into_iter().filter(|path| is_kind(path, "md"));
    let mut names: Vec<_> = docs.map(|path| format!("docs/{}", slashed(&path))).collect();
    names.extend(["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"].map(str::to_owned));
    names.sort();
    let read = |name: String| {
        let text = std::fs::read_to_string(root().join(&name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        Page { name, text }
    };
    names.into_iter().map(read).collect()
}

fn events(text: &str) -> impl Iterator<Item = (Event<'_>, Range<usize>)> {
    Parser::new_ext(text, Options::ENABLE_TABLES | Options::ENABLE_MATH).into_offset_iter()
}

fn line_of(text: &str, at: usize) -> usize {
    text[..at].matches('\n').count() + 1
}

/// Paragraphs, headings, items and cells: the line where they begin, and their words; code and equations are one word.
fn blocks(text: &str) -> Vec<(usize, String)> {
    let mut found: Vec<(usize, String)> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    let mut hidden = 0;
    for (event, range) in events(text) {
        match event {
            Event::Start(Tag::CodeBlock(_) | Tag::Image { .. }) => hidden += 1,
            Event::End(TagEnd::CodeBlock | TagEnd::Image) => hidden -= 1,
            Event::Start(Tag::Paragraph | Tag::Heading { .. } | Tag::Item | Tag::TableCell) => {
                open.push(found.len());
                found.push((line_of(text, range.start), String::new()));
            }
            Event::End(TagEnd::Paragraph | TagEnd::Heading(_) | TagEnd::Item | TagEnd::TableCell) => {
                open.pop();
            }
            _ if hidden > 0 => {}
            Event::Text(words) => append(&mut found, &open, &words),
            Event::Code(_) | Event::InlineMath(_) | Event::DisplayMath(_) => append(&mut found, &open, "X"),
            Event::SoftBreak | Event::HardBreak => append(&mut found, &open, " "),
            _ => {}
        }
    }
    found
}

fn append(found: &mut [(usize, String)], open: &[usize], words: &str) {
    if let Some(at) = open.last() {
        found[*at].1.push_str(words);
    }
}

/// Words with a letter or a digit in them.
fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).collect()
}

/// A sentence ends where a point, a question mark or an exclamation mark stands before a word that begins with a capital.
fn sentences(text: &str) -> Vec<Vec<&str>> {
    let mut found = vec![Vec::new()];
    let mut ended = false;
    for word in text.split_whitespace() {
        if ended && word.trim_start_matches(['(', '"', '[']).starts_with(char::is_uppercase) {
            found.push(Vec::new());
        }
        ended = word.trim_end_matches([')', '"', ']']).ends_with(['.', '?', '!']);
        if word.contains(char::is_alphanumeric) {
            found.last_mut().unwrap().push(word);
        }
    }
    found
}

#[test]
fn sentences_and_paragraphs_are_short() {
    let mut failures = Vec::new();
    for page in pages() {
        for (line, block) in blocks(&page.text) {
            let count = words(&block).len();
            if count > MAX_PARAGRAPH {
                failures.push(format!("{}:{line}: a paragraph of {count} words", page.name));
            }
            for sentence in sentences(&block).iter().filter(|sentence| sentence.len() > MAX_SENTENCE) {
                let start = sentence[..6].join(" ");
                failures.push(format!("{}:{line}: a sentence of {} words: {start} ...", page.name, sentence.len()));
            }
        }
    }
    report(&failures);
}

#[test]
fn words_are_plain() {
    let mut failures = Vec::new();
    for page in pages() {
        for (line, block) in blocks(&page.text) {
            let plain: Vec<_> = block.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
            let padded = format!(" {} ", plain.join(" ").to_lowercase());
            for banned in BANNED.iter().filter(|banned| padded.contains(&format!(" {banned} "))) {
                failures.push(format!("{}:{line}: `{banned}`", page.name));
            }
        }
    }
    report(&failures);
}

/// Parts of a text whose lines may be long.
fn free_parts(text: &str) -> Vec<Range<usize>> {
    let is_free = |event: &Event<'_>| match event {
        Event::Start(Tag::Table(_) | Tag::CodeBlock(_) | Tag::Image { .. } | Tag::HtmlBlock)
        | Event::DisplayMath(_) => true,
        Event::Start(Tag::Link { dest_url, .. }) => dest_url.contains("://"),
        _ => false,
    };
    events(text).filter(|(event, _)| is_free(event)).map(|(_, range)| range).collect()
}

#[test]
fn lines_and_pages_are_short() {
    let mut failures = Vec::new();
    for page in pages() {
        let free = free_parts(&page.text);
        let mut at = 0;
        for (number, line) in page.text.split('\n').enumerate() {
            let within = at..at + line.len();
            let exempt = free.iter().any(|part| part.start < within.end && part.end > within.start);
            let length = line.chars().count();
            if length > MAX_LINE && !exempt {
                failures.push(format!("{}:{}: {length} characters", page.name, number + 1));
            }
            at += line.len() + 1;
        }
        let lines = page.text.lines().count();
        for (name, most) in MAX_PAGES {
            if page.name.starts_with(name) && lines > most {
                failures.push(format!("{}: {lines} lines, at most {most}", page.name));
            }
        }
    }
    report(&failures);
}

/// Anchors of a page, as mdBook and GitHub make them of its headings.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut heading: Option<String> = None;
    for (event, _) in events(text) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => found.extend(heading.take().map(|text| slug(&text))),
            Event::Text(text) | Event::Code(text) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&text);
                }
            }
            _ => {}
        }
    }
    found
}

fn slug(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}

/// What is wrong with a link of a page, if anything.
fn broken(page: &Page, address: &str) -> Option<String> {
    if address.contains("://") || address.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = address.split_once('#').unwrap_or((address, ""));
    let folder = root().join(&page.name).parent().unwrap().to_owned();
    let target = if file.is_empty() { root().join(&page.name) } else { folder.join(file) };
    let Ok(target) = target.canonicalize() else { return Some(format!("there is no `{address}`")) };
    let docs = root().join("docs").canonicalize().unwrap();
    if page.name.starts_with("docs/") && !target.starts_with(docs) {
        return Some(format!("`{address}` leads out of the book: name the path as code"));
    }
    let missing =
        !anchor.is_empty() && !anchors(&std::fs::read_to_string(&target).unwrap_or_default()).contains(anchor);
    missing.then(|| format!("there is no heading for `{address}`"))
}

#[test]
fn links_and_paths_lead_somewhere() {
    let mut failures = Vec::new();
    for page in pages() {
        for (event, range) in events(&page.text) {
            let wrong = match event {
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => broken(&page, &dest_url),
                Event::Code(code) if FOLDERS.iter().any(|folder| code.starts_with(folder)) && is_path(&code) => {
                    (!root().join(&*code).exists()).then(|| format!("there is no `{code}`"))
                }
                _ => None,
            };
            failures.extend(wrong.map(|wrong| format!("{}:{}: {wrong}", page.name, line_of(&page.text, range.start))));
        }
    }
    report(&failures);
}

fn is_path(code: &str) -> bool {
    code.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '/' | '.' | '_' | '-'))
}

#[test]
fn the_summary_lists_every_page() {
    let summary = std::fs::read_to_string(root().join("docs/SUMMARY.md")).unwrap();
    let named: BTreeSet<String> = events(&summary)
        .filter_map(|(event, _)| match event {
            Event::Start(Tag::Link { dest_url, .. }) => Some(format!("docs/{dest_url}")),
            _ => None,
        })
        .collect();
    let found: BTreeSet<String> = pages().into_iter().map(|page| page.name).collect();
    let of_book = found.into_iter().filter(|name| name.starts_with("docs/") && name != "docs/SUMMARY.md");
    let failures: Vec<_> =
        of_book.filter(|name| !named.contains(name)).map(|name| format!("{name}: not in docs/SUMMARY.md")).collect();
    report(&failures);
}
