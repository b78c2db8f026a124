//! Placeholder: see ARCHITECTURE.
