//! Options of `pick`.

use std::path::PathBuf;

use catalogue::Dimension;
use clap::Args;

use crate::cli::args::{Format, SceneArgs};

/// Arguments of `pick`.
#[derive(Args)]
pub struct PickArgs {
    /// Scene to search; it needs a reference
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Largest accepted error, such as 3%
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub error: f64,
    /// Quantity to be accurate: displacement, force, pressure, stress, energy, peak, probes, frequency, or a
    /// metric that is a relative error
    #[arg(long, value_name = "QUANTITY", default_value = "displacement")]
    pub quantity: String,
    /// Additional quantity with its error, such as force=5% (repeatable). A single number such as a force can
    /// be accurate by chance: the displacement must then be within three times the error, unless given here
    #[arg(long, value_name = "QUANTITY=PERCENT", value_parser = companion)]
    pub also: Vec<(String, f64)>,
    /// Also try the usual methods that suit the scene: tet4, tet4-nodal, tet10, hex8-mean, hex20, efg. This
    /// is the default for a scene without methods
    #[arg(long)]
    pub usual: bool,
    /// Longest estimated time of one run: finer sizes are not tried
    #[arg(long, value_name = "TIME", default_value = "60 s", value_parser = time)]
    pub at_most: f64,
    /// Output format on stdout
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
    /// Also write records, tables and figures of all runs to this folder, replacing earlier results of the
    /// scene
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Parses a percentage or a fraction and returns the fraction. A bare 3 would be 300 %: it is refused.
fn percent(text: &str) -> Result<f64, String> {
    let value = Dimension::None.read_positive(text).map_err(|bad| bad.to_string())?;
    let bare = value > 1.0 && !text.contains('%');
    if bare { Err(format!("is {} %: write {text}% or 0.03", 100.0 * value)) } else { Ok(value) }
}

/// Parses `QUANTITY=PERCENT`.
fn companion(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("is not QUANTITY=PERCENT, such as force=5%")?;
    Ok((name.trim().to_string(), percent(value)?))
}

fn time(text: &str) -> Result<f64, String> {
    Dimension::Time.read_positive(text).map_err(|bad| bad.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_a_percentage_above_zero() {
        assert_eq!((percent("3%"), percent(" 0.5 % "), percent("0.03")), (Ok(0.03), Ok(0.005), Ok(0.03)));
        for bad in ["3", "%", "three%", "0%", "-1%", "nan%", "inf%"] {
            assert!(percent(bad).is_err(), "{bad}");
        }
        assert_eq!(companion("force=5%"), Ok(("force".into(), 0.05)));
        assert!(companion("force").is_err() && companion("force=5").is_err());
        assert!(time("2 min") == Ok(120.0) && time("2").is_err() && time("0 s").is_err());
    }
}
