//! Promise: a module of `src` imports from lower floors alone, no file grows beyond what can be read, and strangers may call no
//! more than they can learn.
//!
//! | file | what it shows |
//! |---|---|
//! | `floors` | the plan of floors, and where it is broken |
//! | `imports` | which file takes what from which other |
//! | `public` | how much strangers may call |

mod floors;
mod imports;
mod public;
