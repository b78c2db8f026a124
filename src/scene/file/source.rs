//! The text of a scene with its `--set` overrides: which key stands where, and how a finding is shown.

use std::borrow::Cow;
use std::ops::Range;

use codespan_reporting::diagnostic::{Diagnostic, Label};
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::scene::finding::{Finding, MOST_TOLD};

/// Keys inside each other that an override may name.
const DEEPEST: usize = 64;
/// Bytes of a line that is shown with what is wrong in it.
const LONGEST_LINE: usize = 400;

/// A scene file and its overrides, laid out in one buffer so that a position names the line of either.
pub(crate) struct Source {
    /// Name of the scene file.
    name: String,
    /// The file, a newline, and one line per override.
    buffer: String,
    /// Where the file and each override line lie in the buffer.
    parts: Vec<Range<usize>>,
    /// Every key path with the place of its value.
    places: Vec<(String, Range<usize>)>,
    /// Every key path with the place of the key itself.
    keys: Vec<(String, Range<usize>)>,
}

impl Source {
    /// Lays out a scene file and its overrides.
    pub(crate) fn new(text: &str, name: &str, overrides: &[String]) -> Self {
        let mut buffer = text.to_owned();
        let mut parts = std::iter::once(0..text.len()).collect::<Vec<_>>();
        for line in overrides {
            buffer.push('\n');
            let start = buffer.len();
            buffer.push_str(line);
            parts.push(start..buffer.len());
        }
        Source { name: name.to_owned(), buffer, parts, places: Vec::new(), keys: Vec::new() }
    }

    /// The text of the scene file alone.
    pub(crate) fn text(&self) -> &str {
        &self.buffer[self.parts[0].clone()]
    }

    /// Name of the scene file.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Number of overrides.
    pub(crate) fn override_count(&self) -> usize {
        self.parts.len() - 1
    }

    /// Splits an override at its first `=`: key, TOML document `v = value` whose positions are those of the buffer.
    pub(crate) fn override_document(&self, index: usize) -> Result<(String, Vec<String>), Finding> {
        let range = self.parts[index + 1].clone();
        let line = &self.buffer[range.clone()];
        let Some((key, value)) = line.split_once('=') else {
            let help = "write key=value, for example gas.ambient.density=2 or bodies[0].density=3";
            return Err(Finding { span: Some(range), ..Finding::new("", format!("--set {line} has no `=`"), help) });
        };
        let start = range.start + key.len() + 1;
        // "v=" takes two places in front of the value; the key and its "=" leave at least that many
        let padded = |value: &str| format!("{}v={value}", " ".repeat(start - 2));
        let quoted = format!("\"{}\"", value.trim().replace('\\', "\\\\").replace('"', "\\\""));
        let key = key_path(key);
        if key.is_empty() || key.split('.').any(str::is_empty) {
            let help = "name keys as in gas.ambient.density or bodies[0].density";
            return Err(Finding { span: Some(range), ..Finding::new("", format!("--set {line} names no key"), help) });
        }
        let depth = key.split('.').count();
        if depth > DEEPEST {
            let help = format!("at most {DEEPEST} are taken");
            let message = format!("--set with {depth} keys inside each other");
            return Err(Finding { span: Some(range), ..Finding::new("", message, help) });
        }
        Ok((key, vec![padded(value), padded(&quoted)]))
    }

    /// Place of an override line.
    pub(crate) fn override_place(&self, index: usize) -> Range<usize> {
        self.parts[index + 1].clone()
    }

    /// Remembers where every key of the document stands.
    pub(crate) fn index(&mut self, root: &DeTable<'_>) {
        walk(root, &mut |entry| {
            self.places.push((entry.path.to_owned(), entry.place()));
            self.keys.extend(entry.key.map(|key| (entry.path.to_owned(), key)));
        });
    }

    /// How many keys and entries of lists there are.
    pub(crate) fn value_count(&self) -> usize {
        self.places.len()
    }

    /// The innermost key whose place holds the given one.
    pub(crate) fn path_at(&self, span: &Range<usize>) -> String {
        let holds = |place: &Range<usize>| place.start <= span.start && span.end <= place.end;
        let inner =
            self.places.iter().chain(&self.keys).filter(|(_, place)| holds(place)).min_by_key(|(_, place)| place.len());
        inner.map(|(path, _)| path.clone()).unwrap_or_default()
    }

    /// The place of a key, or of its nearest parent that is written down.
    fn place_of(&self, path: &str) -> Range<usize> {
        let mut path = path;
        loop {
            if let Some((_, place)) = self.places.iter().find(|(known, _)| known == path) {
                return place.clone();
            }
            match path.rfind(['.', '[']) {
                Some(end) => path = &path[..end],
                None => return 0..0,
            }
        }
    }

    /// All findings as text, with the lines they belong to.
    pub(crate) fn report(&self, findings: &[Finding]) -> String {
        let mut files = SimpleFiles::new();
        for (index, part) in self.parts.iter().enumerate() {
            let name = if index == 0 { self.name.clone() } else { "--set".to_owned() };
            files.add(name, &self.buffer[part.clone()]);
        }
        let config = term::Config { chars: term::Chars::ascii(), ..term::Config::default() };
        let mut text = String::new();
        for finding in findings.iter().take(MOST_TOLD) {
            let span = finding.span.clone().unwrap_or_else(|| self.place_of(&finding.path));
            let finding = finding.clipped();
            let index = self.parts.iter().rposition(|part| part.start <= span.start).unwrap_or(0);
            let part = &self.parts[index];
            let local = span.start - part.start..span.end.clamp(span.start, part.end.max(span.start)) - part.start;
            let key = if finding.path.is_empty() { String::new() } else { format!("{}: ", finding.path) };
            let message = format!("{key}{}", finding.message);
            let own = &self.buffer[part.clone()];
            if [local.start, local.end].iter().any(|at| line(own, *at).len() > LONGEST_LINE) {
                let above = &own[..own.floor_char_boundary(local.start)];
                let (row, column) = (above.matches('\n').count() + 1, above.len() - line_start(above) + 1);
                let name = if index == 0 { &self.name } else { "--set" };
                text.push_str(&format!("error: {message}\n  --> {name}:{row}:{column}\n  = {}\n\n", finding.help));
                continue;
            }
            let diagnostic = Diagnostic::error()
                .with_message(message)
                .with_label(Label::primary(index, local))
                .with_note(finding.help.clone());
            // the only error is a place outside the file, which the clamp excludes
            let shown =
                term::emit_into_string(&config, &files, &diagnostic).unwrap_or_else(|_| finding.message.clone());
            text.push_str(shown.trim_end());
            text.push_str("\n\n");
        }
        if let rest @ 1.. = findings.len().saturating_sub(MOST_TOLD) {
            text.push_str(&format!("and {rest} more\n\n"));
        }
        text.push_str(&format!("{}: {} in this scene", self.name, count(findings.len())));
        text
    }
}

/// A key as people write it, `bodies[0].density`, as [`set`] takes it: `bodies.0.density`.
pub(crate) fn key_path(key: &str) -> String {
    key.trim().replace('[', ".").replace(']', "")
}

/// Where the last line begins.
fn line_start(text: &str) -> usize {
    text.rfind('\n').map_or(0, |end| end + 1)
}

/// The line around a place.
fn line(text: &str, at: usize) -> &str {
    let start = line_start(&text[..text.floor_char_boundary(at)]);
    text[start..].split('\n').next().unwrap_or_default()
}

fn count(findings: usize) -> String {
    if findings == 1 { "1 error".to_owned() } else { format!("{findings} errors") }
}

/// A key of a document.
pub(crate) struct Entry<'e, 'a> {
    /// Key path.
    pub path: &'e str,
    /// Place of the key; entries of lists have none.
    pub key: Option<Range<usize>>,
    /// The value and its place.
    pub value: &'e Spanned<DeValue<'a>>,
}

impl Entry<'_, '_> {
    /// Where to point at: the value, or the key of a table that has no text of its own.
    pub(crate) fn place(&self) -> Range<usize> {
        let place = self.value.span();
        self.key.clone().filter(|_| place.is_empty()).unwrap_or(place)
    }
}

/// Calls `visit` with every key.
pub(crate) fn walk<'a>(root: &DeTable<'a>, visit: &mut impl FnMut(Entry<'_, 'a>)) {
    for (key, value) in root {
        walk_value(Entry { path: key.get_ref(), key: Some(key.span()), value }, visit);
    }
}

fn walk_value<'a>(entry: Entry<'_, 'a>, visit: &mut impl FnMut(Entry<'_, 'a>)) {
    let Entry { path, value, .. } = entry;
    visit(entry);
    match value.get_ref() {
        DeValue::Table(table) => {
            for (key, value) in table {
                let path = format!("{path}.{}", key.get_ref());
                walk_value(Entry { path: &path, key: Some(key.span()), value }, visit);
            }
        }
        DeValue::Array(array) => {
            for (index, value) in array.iter().enumerate() {
                walk_value(Entry { path: &format!("{path}[{index}]"), key: None, value }, visit);
            }
        }
        _ => {}
    }
}

/// Puts a value at a key path (`bodies.0.density`), creating tables on the way.
pub(crate) fn set<'a>(root: &mut DeTable<'a>, path: &str, value: Spanned<DeValue<'a>>) -> Result<(), String> {
    let place = value.span();
    let (first, mut rest) = split(path);
    let mut node = slot(root, first, &place);
    while let Some(current) = rest {
        let (key, next) = split(current);
        node = match node.get_mut() {
            DeValue::Table(table) => slot(table, key, &place),
            DeValue::Array(array) => {
                let length = array.len();
                let index = key.parse::<usize>().ok().filter(|index| *index < length);
                let index =
                    index.ok_or_else(|| format!("`{key}` is no entry of a list of {length}; entries count from 0"))?;
                &mut (**array)[index]
            }
            other => return Err(format!("`{key}` lies inside a {}, which has no keys", other.type_str())),
        };
        rest = next;
    }
    *node = value;
    Ok(())
}

fn split(path: &str) -> (&str, Option<&str>) {
    path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)))
}

fn slot<'t, 'a>(table: &'t mut DeTable<'a>, key: &str, place: &Range<usize>) -> &'t mut Spanned<DeValue<'a>> {
    let name = Spanned::new(place.clone(), Cow::Owned(key.to_owned()));
    table.entry(name).or_insert_with(|| Spanned::new(place.clone(), DeValue::Table(DeTable::new())))
}
