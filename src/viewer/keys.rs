//! Keys, and what they do: one table for the window, the help overlay and the handbook.

use egui::{Key, Modifiers};

use crate::scene::Field;

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Run or pause; of a run on the disk, show it.
    Play,
    /// Simulate from the state that is shown.
    GoOn,
    /// So many single steps.
    Step(u32),
    /// The last state that is kept up to a time \[s\].
    Rewind(f64),
    /// The state before that is kept.
    Undo,
    /// Run again from where the time line was dragged to last, or from the start.
    Again,
    /// The scene from its start.
    Restart,
    /// Everything in the picture.
    Fit,
    /// Save the picture.
    Screenshot,
    /// Start or stop saving every picture.
    Record,
    /// Show or hide the help.
    Help,
    /// Back: out of help, out of the scene.
    Back,
    /// Parallel or perspective view.
    Orthographic,
    /// Show a field.
    Field(Field),
    /// Simulated time passes faster (2) or slower (1/2).
    Pace(f64),
    /// Come nearer by so many notches.
    Zoom(f64),
    /// Turn (3D) or shift (2D) the view, in shares of the picture's height.
    Turn([f64; 2]),
    /// Show or hide the panel.
    Panel,
    /// Ask for the name of a scene file.
    Open,
    /// End the program.
    Quit,
}

/// What the help shows: key, and what it does.
pub const HELP: [(&str, &str); 19] = [
    ("Space", "run or pause; play a run"),
    ("G", "of a run: go on from the state that is shown"),
    ("Right", "one step; with Shift 16 steps"),
    ("Left", "back to the state before that is kept"),
    ("B", "run again from where the time line was dragged to"),
    ("Up, Down", "twice as fast, half as fast"),
    ("R", "restart the scene"),
    ("1 to 9", "density, pressure, speed, temperature, schlieren, Mach number, vorticity, entropy, owed gas"),
    ("F", "fit everything into the picture"),
    ("O", "parallel or perspective view (3D)"),
    ("A, D, W, X", "turn the view (3D) or shift it (2D)"),
    ("+, -", "nearer, farther"),
    ("S", "save the picture as PNG"),
    ("V", "start or stop recording"),
    ("P", "show or hide the panel"),
    ("H", "show or hide this help"),
    ("Ctrl+O", "open a scene or a mesh"),
    ("Esc", "close this help; back to the gallery"),
    ("Ctrl+Q", "quit"),
];

/// What the help says about the mouse.
pub const MOUSE: [(&str, &str); 10] = [
    ("Left drag", "turn (3D) or shift (2D)"),
    ("Shift+left drag", "on a body: push it, and throw it by letting go; elsewhere: shift"),
    ("Right or middle drag", "shift"),
    ("Wheel", "nearer or farther, towards the pointer"),
    ("Double click", "fit everything into the picture"),
    ("Ctrl+click", "detonate: energy and radius, or kilograms of TNT, stand in the panel; held, the blast grows"),
    ("Click", "on a body: picks it for the panel; on gas: sets a probe; on a probe: takes it away"),
    ("Rest", "position, value in the plane, body"),
    ("Drag on the time line", "back to a state that is kept; from there the scene goes on"),
    ("File dropped on the window", "opens a scene; a mesh becomes the next body"),
];

/// How far a key turns or shifts the view, in shares of the picture's height.
const NUDGE: f64 = 0.05;

/// What a key asks for; nothing for keys without meaning.
pub fn action(key: Key, modifiers: Modifiers) -> Option<Action> {
    if modifiers.command {
        return match key {
            Key::O => Some(Action::Open),
            Key::Q | Key::W => Some(Action::Quit),
            _ => None,
        };
    }
    if modifiers.alt {
        return None;
    }
    let numbers = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];
    if let Some(number) = numbers.iter().position(|number| *number == key) {
        return Field::ALL.get(number).copied().map(Action::Field);
    }
    Some(match key {
        Key::Space => Action::Play,
        Key::G => Action::GoOn,
        Key::ArrowRight => Action::Step(if modifiers.shift { 16 } else { 1 }),
        Key::ArrowLeft => Action::Undo,
        Key::B => Action::Again,
        Key::ArrowUp => Action::Pace(2.0),
        Key::ArrowDown => Action::Pace(0.5),
        Key::R => Action::Restart,
        Key::F | Key::Home => Action::Fit,
        Key::S => Action::Screenshot,
        Key::V => Action::Record,
        Key::H | Key::F1 | Key::Questionmark => Action::Help,
        Key::Escape => Action::Back,
        Key::O => Action::Orthographic,
        Key::P => Action::Panel,
        Key::Plus | Key::Equals => Action::Zoom(1.0),
        Key::Minus => Action::Zoom(-1.0),
        Key::A => Action::Turn([-NUDGE, 0.0]),
        Key::D => Action::Turn([NUDGE, 0.0]),
        Key::W => Action::Turn([0.0, -NUDGE]),
        Key::X => Action::Turn([0.0, NUDGE]),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_do_what_people_expect() {
        let plain = |key| action(key, Modifiers::NONE);
        assert_eq!(plain(Key::Space), Some(Action::Play));
        assert_eq!(plain(Key::G), Some(Action::GoOn));
        assert_eq!(plain(Key::ArrowRight), Some(Action::Step(1)));
        assert_eq!(action(Key::ArrowRight, Modifiers::SHIFT), Some(Action::Step(16)));
        assert_eq!((plain(Key::ArrowLeft), plain(Key::B)), (Some(Action::Undo), Some(Action::Again)));
        assert_eq!(plain(Key::Num1), Some(Action::Field(Field::Density)));
        assert_eq!(plain(Key::Num7), Some(Action::Field(Field::Vorticity)));
        assert_eq!(plain(Key::Num9), Some(Action::Field(Field::Owed)));
        assert_eq!(plain(Key::Num0), None);
        assert_eq!(action(Key::S, Modifiers::COMMAND), None, "Ctrl+S is not a screenshot");
        assert_eq!(action(Key::Q, Modifiers::COMMAND), Some(Action::Quit));
    }

    #[test]
    fn the_handbook_lists_every_key() {
        let handbook = include_str!("../../docs/start/window.md");
        for (key, meaning) in HELP.iter().chain(&MOUSE) {
            let row = format!("| {key} | {meaning} |");
            assert!(handbook.contains(&row), "docs/start/window.md lacks `{row}`");
        }
    }
}
