//! A recorded quantity that a claim names.

use catalogue::metric::{self, Address};
use serde::Deserialize;

/// A recorded quantity, by its name.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "String")]
pub(super) struct Named(pub(super) Address);

impl TryFrom<String> for Named {
    type Error = String;

    fn try_from(name: String) -> Result<Named, String> {
        metric::named(&name).map(Named).map_err(|bad| bad.to_string())
    }
}
