//! What does this scene need, and what can be left out?
