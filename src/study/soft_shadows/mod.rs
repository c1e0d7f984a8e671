//! How many shadow rays does a soft shadow take, where should they go, and how should their points be drawn?

mod measure;
mod picture;
mod rays;
mod scene;
mod shares;
mod ways;

use super::{Entry, Session};
use crate::base::error::Result;
use crate::record::study::Study;

pub(super) const ENTRY: Entry = Entry {
    name: "soft-shadows",
    question: "How many shadow rays does a soft shadow take, which lights should they go to, and how should their points be drawn?",
    run,
};

fn run(session: &Session<'_>) -> Result<Study> {
    let mut writer = session
        .open([], vec![rays::table(session), rays::laws(), shares::table(session), ways::table(), ways::by_size()])?;
    rays::run(session, &mut writer)?;
    shares::run(session, &mut writer)?;
    ways::run(session, &mut writer)?;
    let options = session.options;
    writer.note(format!(
        "Errors over {} receivers in {} independent runs; all contenders of a table in each run.",
        session.pixels(measure::PIXELS),
        options.repeats
    ))?;
    session.finish(writer)
}
