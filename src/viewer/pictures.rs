//! The user's folder for pictures, where screenshots and recordings go.

use std::path::{Path, PathBuf};

/// Below the folder for pictures, the folder of this program.
const OWN: &str = "Brisance";

/// Where pictures of the window go: `BRISANCE_PICTURES`, or a folder of its own in the user's for pictures, or `out` where there is none.
pub(super) fn folder() -> PathBuf {
    let named = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let home = named("HOME").or_else(|| named("USERPROFILE"));
    let chosen = || {
        let settings = named("XDG_CONFIG_HOME").or_else(|| Some(home.as_ref()?.join(".config")))?;
        of_text(&std::fs::read_to_string(settings.join("user-dirs.dirs")).ok()?, home.as_deref()?)
    };
    let usual = || Some(home.as_ref()?.join("Pictures")).filter(|folder| folder.is_dir());
    named("BRISANCE_PICTURES")
        .or_else(|| named("XDG_PICTURES_DIR").or_else(chosen).or_else(usual).map(|folder| folder.join(OWN)))
        .unwrap_or_else(|| PathBuf::from("out"))
}

/// The folder for pictures that a desktop's `user-dirs.dirs` names; the home itself means that there is none.
fn of_text(text: &str, home: &Path) -> Option<PathBuf> {
    let value = text.lines().find_map(|line| line.trim().strip_prefix("XDG_PICTURES_DIR="))?.trim().trim_matches('"');
    let path = match value.strip_prefix("$HOME") {
        Some(rest) => home.join(rest.trim_start_matches('/')),
        None => PathBuf::from(value),
    };
    (path.is_absolute() && path != home).then_some(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_desktop_names_its_folder_for_pictures() {
        let home = Path::new(if cfg!(windows) { "C:\\home\\eve" } else { "/home/eve" });
        let read = |text: &str| of_text(text, home);
        let both = "# written by xdg\nXDG_MUSIC_DIR=\"$HOME/Musik\"\nXDG_PICTURES_DIR=\"$HOME/Bilder\"\n";
        assert_eq!(read(both), Some(home.join("Bilder")));
        let other = home.join("elsewhere").display().to_string();
        assert_eq!(read(&format!("XDG_PICTURES_DIR=\"{other}\"")), Some(PathBuf::from(other)));
        assert_eq!(read("XDG_PICTURES_DIR=\"$HOME/\""), None, "the home itself: there is none");
        assert_eq!((read("XDG_PICTURES_DIR=\"Bilder\""), read("")), (None, None));
    }
}
