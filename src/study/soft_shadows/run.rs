//! Which tables and notes does the study of soft shadows have?

use super::{measure, rays, shares, ways};
use crate::base::error::Result;
use crate::record::study::Study;
use crate::study::entry::Entry;
use crate::study::session::Session;

pub(in crate::study) const ENTRY: Entry = Entry {
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
