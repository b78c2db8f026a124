//! Reading scenes: parse, override, fill in defaults, check. All findings are reported at once.

use std::io;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use crate::material::{PRESETS, Units};
use crate::math::greatest_divisor;
use crate::scene::check;
use crate::scene::check::budget;
use crate::scene::file::gas_state;
use crate::scene::file::mended::Mended;
use crate::scene::file::numbers;
use crate::scene::file::source::{self, Source};
use crate::scene::file::species;
use crate::scene::file::variants;
use crate::scene::file::vocabulary;
use crate::scene::finding::Finding;
use crate::scene::geometry::mesh::MeshFolder;
use crate::scene::{Changes, Material, Scene, look};
use crate::{Error, Result, input};

impl Scene {
    /// Reads a scene file and makes changes: a list of keys with values, such as `gas.ambient.density=2`, or [`Changes`] that name variants
    /// as well.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read; [`Error::Scene`] with every mistake, its file, line, key and what is allowed.
    pub fn load(path: impl AsRef<Path>, changes: impl Into<Changes>) -> Result<Scene> {
        let path = path.as_ref();
        let text = input::text(path, input::MOST_SCENE).map_err(|source| unreadable(path, source))?;
        Scene::written(&text, &path.display().to_string(), &changes.into())
    }

    /// Like [`Scene::parse`] for what people wrote: of a length that is read in a moment.
    ///
    /// # Errors
    /// [`Error::Scene`] with every mistake, or that there is too much of it.
    pub(crate) fn written(text: &str, file_name: &str, changes: &Changes) -> Result<Scene> {
        let mut source = Source::new(text, file_name, &changes.set);
        read(&mut source, changes, budget::MOST_VALUES).map_err(|findings| Error::Scene(source.report(&findings)))
    }

    /// Like [`Scene::load`] with the text at hand; `file_name` appears in messages.
    ///
    /// # Errors
    /// [`Error::Scene`] with every mistake.
    pub fn parse(text: &str, file_name: &str, changes: impl Into<Changes>) -> Result<Scene> {
        let changes = changes.into();
        let mut source = Source::new(text, file_name, &changes.set);
        read(&mut source, &changes, u64::MAX).map_err(|findings| Error::Scene(source.report(&findings)))
    }

    /// A scene that a run in a folder wrote down, with keys changed. Files outside of that folder are read only if `outside` says so, from
    /// where the run found them, beside `scene_file`.
    ///
    /// # Errors
    /// [`Error::Scene`] with every mistake, and what to do about a file that lies elsewhere.
    pub fn recorded(text: &str, (folder, scene_file): (&Path, &str), set: &[String], outside: bool) -> Result<Scene> {
        let changes = Changes { outside, ..Changes::from(set) };
        if outside {
            return Scene::parse(text, scene_file, changes);
        }
        let mut source = Source::new(text, &folder.join("scene.toml").display().to_string(), set);
        read(&mut source, &changes, u64::MAX).map_err(|findings| {
            let of_files = |own: &Finding| own.path.ends_with(".mesh.path") || own.path.ends_with("font");
            let hint = "\nnothing outside of the folder of the run is read; --allow-outside reads meshes and fonts where the run \
                        found them";
            Error::Scene(source.report(&findings) + if findings.iter().any(of_files) { hint } else { "" })
        })
    }

    /// Reads a shipped scene by its path below `scenes/`, as the program carries it, and makes changes as [`Scene::load`] does.
    ///
    /// # Errors
    /// [`Error::Scene`] if there is none of that path or a change is wrong.
    pub fn shipped(path: &str, changes: impl Into<Changes>) -> Result<Scene> {
        let found = crate::scene::EMBEDDED.iter().find(|(own, _)| *own == path);
        let (_, text) = found.ok_or_else(|| Error::Scene(format!("no shipped scene scenes/{path}")))?;
        Scene::parse(text, &format!("scenes/{path}"), changes)
    }

    /// The same scene with `cells` cells along its longest axis.
    ///
    /// # Errors
    /// [`Error::Usage`] if the other axes would not get whole numbers of cubic cells, or the result is no valid scene.
    pub fn with_resolution(&self, cells: u32) -> Result<Scene> {
        let longest = self.domain.cells.iter().copied().max().unwrap_or(1);
        let mut scene = self.clone();
        for axis in 0..self.domain.axes() {
            let scaled = u64::from(self.domain.cells[axis]) * u64::from(cells);
            if scaled % u64::from(longest) != 0 {
                let step = (0..self.domain.axes())
                    .map(|d| longest / greatest_divisor(longest, self.domain.cells[d]))
                    .fold(1, least_multiple);
                return Err(Error::Usage(format!(
                    "resolution {cells} does not divide the domain of {:?} cells into cubes; use a multiple of {step}",
                    &self.domain.cells[..self.domain.axes()]
                )));
            }
            scene.domain.cells[axis] = u32::try_from(scaled / u64::from(longest)).unwrap_or(u32::MAX);
        }
        if let Some(first) = budget::findings(&scene).first() {
            return Err(Error::DoesNotFit(format!(
                "resolution {cells}: {}: {}; {}",
                first.path, first.message, first.help
            )));
        }
        let findings = check::findings(&scene);
        match findings.first() {
            None => Ok(scene),
            Some(first) => {
                Err(Error::Usage(format!("resolution {cells}: {}: {}; {}", first.path, first.message, first.help)))
            }
        }
    }

    /// Puts in the defaults that depend on other keys.
    pub(crate) fn resolve(&mut self) {
        for body in &self.bodies {
            let preset = PRESETS.iter().position(|preset| preset.name == body.material);
            if let Some(Ok(material)) = preset.map(|index| Material::of_preset(index, Units::Si, &[])) {
                self.materials.entry(body.material.clone()).or_insert(material);
            }
        }
        let given: Vec<_> =
            self.bodies.iter().map(|body| (self.density_of(body), self.particles_along_axis(body))).collect();
        for (body, (density, along_axis)) in self.bodies.iter_mut().zip(given) {
            (body.density, body.particles_per_cell) = (density, Some(along_axis));
        }
        self.scale_charges();
    }
}

/// A file that holds no text is a wrong scene; one that cannot be read is the disk's affair.
fn unreadable(path: &Path, source: io::Error) -> Error {
    match source.kind() {
        io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput | io::ErrorKind::FileTooLarge => {
            Error::Scene(format!("{}: {source}", path.display()))
        }
        _ => Error::io(path, source),
    }
}

fn least_multiple(a: u32, b: u32) -> u32 {
    a / greatest_divisor(a, b) * b
}

/// The scene of a text with changes, whose keys the source has, or all that is wrong with it.
pub(crate) fn read(
    source: &mut Source,
    changes: &Changes,
    most_values: u64,
) -> std::result::Result<Scene, Vec<Finding>> {
    let text = source.text().to_owned();
    let (root, errors) = DeTable::parse_recoverable(&text);
    if !errors.is_empty() {
        return Err(errors.iter().map(syntax).collect());
    }
    let place = root.span();
    let mut root = root.into_inner();
    if let Some(finding) = budget::values(&root, most_values) {
        return Err(vec![finding]);
    }
    let documents = override_documents(source)?;
    let mut findings = variants::apply_all(&mut root, &changes.variants, &text);
    for (index, (key, texts)) in documents.iter().enumerate() {
        let applied = parse_value(texts).and_then(|value| {
            (key == look::KEY).then(|| look::forget(&mut root));
            source::set(&mut root, key, value)
        });
        if let Err(message) = applied {
            let help = "name an existing key or entry, for example gas.ambient.density=2 or bodies[0].density=3";
            findings.push(Finding {
                span: Some(source.override_place(index)),
                ..Finding::new("", format!("--set: {message}"), help)
            });
        }
    }
    source.index(&root);
    numbers::findings(&root, &mut findings);
    let settled = gas_state::take(&mut root, &mut findings);
    species::take(&mut root, &mut findings);
    let mut root = Spanned::new(place, root);
    let (words, mut mended) = vocabulary::findings(&mut root);
    // keys that took the place of others are found where they stand
    (!words.is_empty()).then(|| source.index(root.get_ref()));
    look::apply(root.get_mut());
    findings.extend(words);
    let Some(mut scene) = readable(source, root, &mut mended, &mut findings) else { return Err(findings) };
    scene.settle(&settled);
    scene.resolve();
    let folder = Path::new(source.name()).parent().unwrap_or(Path::new(""));
    let dimension = scene.domain.dimension;
    let meshes = MeshFolder { folder, outside: changes.outside, dimension };
    let mut shapes = scene.resolve_shapes(meshes);
    shapes.extend(scene.resolve_cameras(meshes));
    let concerning =
        |mended: &Mended, found: Vec<Finding>| found.into_iter().filter(|own| mended.concerns(own)).collect();
    let shapes: Vec<Finding> = concerning(&mended, shapes);
    // nothing is known of a shape without its surface
    shapes.iter().for_each(|finding| mended.unknown(&finding.path));
    findings.extend(shapes);
    findings.extend(concerning(&mended, check::findings(&scene)));
    if findings.is_empty() { Ok(scene) } else { Err(findings) }
}

/// Values that may be read again and again, for all that no reader takes.
const MOST_READ: usize = 1_000_000;

/// The scene of a document. What no reader takes is told and replaced, and the rest is read again.
fn readable(
    source: &Source,
    mut root: Spanned<DeTable<'_>>,
    mended: &mut Mended,
    findings: &mut Vec<Finding>,
) -> Option<Scene> {
    let most = 1 + MOST_READ / (1 + source.value_count());
    for _ in 0..most {
        let error = match Scene::deserialize(Deserializer::from(root.clone())) {
            Ok(scene) => return Some(scene),
            Err(error) => error,
        };
        let own = located(source, &error);
        let path = own.path.clone();
        // the text alone has told some of it before
        let told = findings.iter().any(|finding| finding.path == path && finding.span == own.span);
        if !told && !mended.unreadable && mended.concerns(&own) {
            findings.push(own);
        }
        if !mended.replace(root.get_mut(), &path) {
            break;
        }
    }
    None
}

/// Key and value documents of all overrides.
fn override_documents(source: &Source) -> std::result::Result<Vec<(String, Vec<String>)>, Vec<Finding>> {
    let (good, bad): (Vec<_>, Vec<_>) =
        (0..source.override_count()).map(|index| source.override_document(index)).partition(|d| d.is_ok());
    let bad = bad.into_iter().filter_map(std::result::Result::err).collect::<Vec<_>>();
    if bad.is_empty() { Ok(good.into_iter().flatten().collect()) } else { Err(bad) }
}

/// The value of the first document that is TOML: the value as written, or as a string.
fn parse_value<'a>(texts: &'a [String]) -> std::result::Result<Spanned<DeValue<'a>>, String> {
    let value = texts.iter().find_map(|text| DeTable::parse(text).ok()?.into_inner().remove("v"));
    value.ok_or_else(|| "value is neither TOML nor text".to_owned())
}

fn syntax(error: &toml::de::Error) -> Finding {
    let help = "scenes are TOML, see docs/scenes";
    Finding { span: error.span(), ..Finding::new("", error.message(), help) }
}

fn located(source: &Source, error: &toml::de::Error) -> Finding {
    let path = error.span().map(|span| source.path_at(&span)).unwrap_or_default();
    let help = "docs/scenes lists every key; `brisance schema` prints the schema";
    Finding { span: error.span(), ..Finding::new(path, error.message(), help) }
}
