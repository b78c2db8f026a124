//! WGSL text: includes resolved once, constants injected, errors reported at the line of the original file.

use std::path::PathBuf;

use wgpu::naga;

use super::kernel::{MAX_GROUPS, OCTET, WORKGROUP};
use super::reflect::Compiled;
use super::sources::SOURCES;
use crate::error::{Error, Result};

/// Where shader files come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Folder {
    /// The table inside the binary.
    Embedded,
    /// A folder with the layout of `shaders/`, read again at each load.
    Disk(PathBuf),
    /// Texts given by the caller (name, text), before the embedded table; for tests and tools.
    Given(Vec<(String, String)>),
}

impl Folder {
    /// The text of one file, by its path below the folder.
    ///
    /// # Errors
    /// [`Error::Shader`] if there is no such file.
    pub fn text(&self, name: &str) -> Result<String> {
        let unknown = |reason: String| Error::Shader(format!("no shader `{name}`{reason}"));
        let embedded = || SOURCES.iter().find(|(file, _)| *file == name).map(|(_, text)| (*text).to_owned());
        match self {
            Folder::Embedded => embedded().ok_or_else(|| unknown("; add it to the list in src/gpu/sources.rs".into())),
            Folder::Disk(path) => {
                let file = path.join(name);
                std::fs::read_to_string(&file).map_err(|error| unknown(format!(": {}: {error}", file.display())))
            }
            Folder::Given(files) => {
                let given = files.iter().find(|(file, _)| file == name).map(|(_, text)| text.clone());
                given.or_else(embedded).ok_or_else(|| unknown(" was given".into()))
            }
        }
    }
}

/// One shader as wgpu gets it, with the way back to its files.
#[derive(Clone, Debug)]
pub struct Shader {
    /// Path below `shaders/`.
    pub name: String,
    /// The flattened text.
    pub text: String,
    /// For each line of the text: index into `files`, line number from 1.
    origins: Vec<(usize, usize)>,
    /// Files that went in, in order; the first is the injected text.
    files: Vec<String>,
}

/// What the injected text is called in error messages.
const INJECTED: &str = "<constants>";
/// What every shader sees after its sizes: the index of a thread.
const HEAD: &str = include_str!("head.wgsl");

impl Shader {
    /// Reads a shader, replaces each `#include "path"` by the file (once per shader) and puts `constants` on top, after the
    /// `const WORKGROUP`, `MAX_GROUPS`, `OCTET` and the functions of `head.wgsl` that all shaders see. The constants may include files too.
    ///
    /// # Errors
    /// [`Error::Shader`] for an unknown file, a malformed directive or a cycle, with the file and line of the include.
    pub fn load(name: &str, constants: &str, folder: &Folder) -> Result<Shader> {
        let injected = format!(
            "const WORKGROUP: u32 = {WORKGROUP}u; const MAX_GROUPS: u32 = {MAX_GROUPS}u; const OCTET: u32 = {OCTET}u;\n{constants}\n{HEAD}"
        );
        let mut joiner = Joiner { folder, files: Vec::new(), open: Vec::new(), head: Vec::new(), body: Vec::new() };
        joiner.join(INJECTED, &injected)?;
        joiner.join(name, &folder.text(name)?)?;
        let Joiner { files, mut head, body, .. } = joiner;
        head.extend(body);
        let mut text = String::new();
        for (line, _) in &head {
            text.push_str(line);
            text.push('\n');
        }
        let origins = head.into_iter().map(|(_, origin)| origin).collect();
        Ok(Shader { name: name.to_owned(), text, origins, files })
    }

    /// The files that went in, without the injected text: itself first, then its includes in order.
    #[must_use]
    pub fn files(&self) -> &[String] {
        &self.files[1..]
    }

    /// Parses and validates for a device without optional features.
    ///
    /// # Errors
    /// [`Error::Shader`] with file, line and column of every place the compiler points to.
    pub fn compile(self) -> Result<Compiled> {
        let module = naga::front::wgsl::parse_str(&self.text).map_err(|error| {
            let labels = error.labels().map(|(span, label)| (span, label.to_owned())).collect::<Vec<_>>();
            let notes = error.notes().map(|note| format!("\n  note: {note}")).collect::<String>();
            self.describe(error.message(), &labels, &notes)
        })?;
        let flags = naga::valid::ValidationFlags::all();
        let uses = naga::valid::Validator::new(flags, naga::valid::Capabilities::default()).validate(&module).map_err(
            |error| {
                let labels = error.spans().cloned().collect::<Vec<_>>();
                self.describe(&with_causes(error.as_inner()), &labels, "")
            },
        )?;
        Ok(Compiled::new(self, module, uses))
    }

    /// File and line, `shaders/solid/p2g.wgsl:12`, of a line of the flattened text (from 1).
    #[must_use]
    pub fn origin(&self, flattened_line: usize) -> String {
        match flattened_line.checked_sub(1).and_then(|index| self.origins.get(index)) {
            Some((0, line)) => format!("{INJECTED}:{line}"),
            Some((file, line)) => format!("shaders/{}:{line}", self.files[*file]),
            None => format!("shaders/{}", self.name),
        }
    }

    /// Puts a compiler's message at its places.
    fn describe(&self, message: &str, labels: &[(naga::Span, String)], notes: &str) -> Error {
        let mut text = String::new();
        for (span, label) in labels.iter().filter(|(span, _)| span.is_defined()) {
            let place = span.location(&self.text);
            let line = self.text.lines().nth(place.line_number as usize - 1).unwrap_or_default();
            let origin = self.origin(place.line_number as usize);
            text.push_str(&format!("\n  {origin}:{}: {label}\n    {}", place.line_position, line.trim()));
        }
        Error::Shader(format!("shaders/{}: {message}{text}{notes}", self.name))
    }
}

/// An error's text with the texts of its causes.
fn with_causes(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text.push_str(&format!(": {error}"));
        cause = error.source();
    }
    text
}

/// Collects the lines of a shader and its includes.
struct Joiner<'a> {
    folder: &'a Folder,
    files: Vec<String>,
    open: Vec<String>,
    /// `enable`, `requires` and `diagnostic` lines: WGSL wants them before everything else.
    head: Vec<(String, (usize, usize))>,
    body: Vec<(String, (usize, usize))>,
}

impl Joiner<'_> {
    /// Appends one file. Its number is given before its includes' so that the injected text is file 0.
    fn join(&mut self, name: &str, text: &str) -> Result<()> {
        let file = self.files.len();
        self.files.push(name.to_owned());
        self.open.push(name.to_owned());
        for (index, line) in text.lines().enumerate() {
            let entry = || (line.to_owned(), (file, index + 1));
            let word = line.trim_start();
            if word.starts_with('#') {
                let included = self.included(word).map_err(|error| match error {
                    Error::Shader(reason) => Error::Shader(format!("{reason}, included from {name}:{}", index + 1)),
                    other => other,
                })?;
                included.map_or(Ok(()), |(path, text)| self.join(path, &text))?;
            } else if ["enable ", "requires ", "diagnostic("].iter().any(|directive| word.starts_with(directive)) {
                self.head.push(entry());
            } else {
                self.body.push(entry());
            }
        }
        self.open.pop();
        Ok(())
    }

    /// Path and text that one `#include "path"` names; nothing if it has been joined before.
    fn included<'d>(&self, directive: &'d str) -> Result<Option<(&'d str, String)>> {
        let Some(path) =
            directive.strip_prefix("#include").and_then(|rest| rest.trim().strip_prefix('"')?.strip_suffix('"'))
        else {
            return Err(Error::Shader(format!(
                "`{directive}` is not a directive; write #include \"shared/name.wgsl\""
            )));
        };
        if let Some(position) = self.open.iter().position(|open| open == path) {
            return Err(Error::Shader(format!("cycle of includes: {} -> {path}", self.open[position..].join(" -> "))));
        }
        if self.files.iter().any(|file| file == path) {
            return Ok(None);
        }
        Ok(Some((path, self.folder.text(path)?)))
    }
}
