//! Findings of the records in sentences. A sentence without its numbers is omitted.

mod accuracy;
mod integration;
mod placement;
mod published;
mod stability;
mod transfer;
mod vibration;

pub(crate) use transfer::source;

use records::RunSet;

use crate::claims;
use crate::clouds::Clouds;
use crate::select::{Run, solved};

/// Findings under one heading.
pub(crate) struct Topic {
    pub(crate) title: &'static str,
    pub(crate) sentences: Vec<String>,
}

/// Topics that have sentences.
pub(crate) fn all(set: &RunSet, runs: &[Run], clouds: &[Clouds]) -> Vec<Topic> {
    let solved = solved(runs);
    let topics = [
        Topic { title: "Published claims", sentences: claims::findings(&solved) },
        Topic { title: "Where methods bend and break", sentences: stability::stability(set) },
        Topic { title: "Locking", sentences: accuracy::locking(&solved) },
        Topic { title: "Vibrations", sentences: vibration::vibrations(&solved) },
        Topic { title: "Published case", sentences: published::published(runs) },
        Topic { title: "Node placement", sentences: placement::placement(clouds) },
        Topic { title: "Integration of clouds", sentences: integration::integration(runs) },
        Topic { title: "Transfer", sentences: transfer::transfer(runs) },
        Topic { title: "Patch tests", sentences: accuracy::patch(&solved) },
        Topic { title: "Order of convergence", sentences: accuracy::orders(&solved) },
    ];
    topics.into_iter().filter(|t| !t.sentences.is_empty()).collect()
}
