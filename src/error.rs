//! The one error type. Every message names the thing, the value, what is allowed and what to do next.

use std::path::{Path, PathBuf};

/// Shorthand for results of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Everything that can go wrong, one variant per exit code family.
#[derive(thiserror::Error)]
pub enum Error {
    /// The scene file is wrong; the text holds file, line, key and what is allowed (all findings, not only the first).
    #[error("{0}")]
    Scene(String),
    /// The command line asks for something that does not exist.
    #[error("{0}")]
    Usage(String),
    /// No adapter, or none that matches `--device`.
    #[error("{0}")]
    NoAdapter(String),
    /// The scene needs more memory than the device has, or a larger binding than it allows.
    #[error("{0}")]
    DoesNotFit(String),
    /// A stage met a value it cannot continue from.
    #[error("diverged in step {step}, stage {stage}, {place}: {reason}")]
    Diverged {
        /// Step number, from 1.
        step: u64,
        /// Name of the stage that raised the flag.
        stage: &'static str,
        /// Cell or particle, `cell [3, 4, 0]`, or what else is at fault.
        place: String,
        /// What was seen and what to try.
        reason: String,
    },
    /// A shader does not compile; file and line are those of the source folder.
    #[error("{0}")]
    Shader(String),
    /// The device was lost, or its driver failed.
    #[error("GPU: {0}")]
    Gpu(String),
    /// The graphics library refused what we asked it to do, or a part of ours another part: never the user's fault.
    #[error("a bug in brisance {version}: {0}; please report it with the scene and `brisance devices`", version = env!("CARGO_PKG_VERSION"))]
    Bug(String),
    /// A check of a scene's `[expect]` table or a gate of the verification failed.
    #[error("{0}")]
    Expectation(String),
    /// A file could not be read or written.
    #[error("{path}: {source}{}", advice(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file that a run has left is cut, damaged, foreign, or of a program that this one does not go on from.
    #[error("{0}")]
    Spoilt(String),
    /// A film could not be made; pictures and tables are there.
    #[error("{0}; the pictures are written all the same")]
    Film(String),
    /// The user pressed Ctrl-C; everything written so far is valid.
    #[error("interrupted; all files written so far are complete")]
    Interrupted,
}

/// As it is displayed: what `main` prints of an error, and `unwrap`.
impl std::fmt::Debug for Error {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, formatter)
    }
}

/// What to do about what the system says.
fn advice(source: &std::io::Error) -> &'static str {
    use std::io::ErrorKind::{FileTooLarge, PermissionDenied, QuotaExceeded, ReadOnlyFilesystem, StorageFull};
    match source.kind() {
        _ if source.raw_os_error().is_none() => "",
        StorageFull | QuotaExceeded | FileTooLarge => {
            "; what was written before is whole: make room, or write to another disk with --out"
        }
        ReadOnlyFilesystem | PermissionDenied => "; choose another place, or change who may use this one",
        _ => "",
    }
}

impl Error {
    /// Process exit code: 1 internal, 2 usage, 3 scene, 4 no adapter, 5 does not fit, 6 a spoilt file of a run, 7 diverged,
    /// 8 expectation, 9 disk, 75 device lost, 130 interrupted.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Usage(_) => 2,
            Error::Scene(_) => 3,
            Error::NoAdapter(_) => 4,
            Error::DoesNotFit(_) => 5,
            Error::Spoilt(_) => 6,
            Error::Diverged { .. } => 7,
            Error::Expectation(_) => 8,
            Error::Io { .. } | Error::Film(_) => 9,
            Error::Gpu(_) => 75,
            Error::Interrupted => 130,
            Error::Shader(_) | Error::Bug(_) => 1,
        }
    }

    /// A file of a run that is not what it should be.
    pub(crate) fn spoilt(path: &Path, reason: impl std::fmt::Display) -> Self {
        Error::Spoilt(format!("{}: {reason}", path.display()))
    }

    /// Wraps an I/O error with the file it belongs to.
    pub fn io(path: impl Into<PathBuf>, source: std::io::Error) -> Self {
        Error::Io { path: path.into(), source }
    }
}
