//! Units of the numbers of a model. Models state none; their numbers belong to a consistent set.

/// A consistent set of units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// Metre, newton, second, kilogram, pascal.
    Metres,
    /// Millimetre, newton, second, tonne, megapascal.
    Millimetres,
}

impl Units {
    /// Unit of length.
    pub fn length(self) -> &'static str {
        match self {
            Units::Metres => "m",
            Units::Millimetres => "mm",
        }
    }

    /// The set in words, for a comment.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Units::Metres => "m, N, s, kg, Pa",
            Units::Millimetres => "mm, N, s, t, MPa",
        }
    }

    pub(crate) fn lengths(self, value: f64) -> String {
        quantity(value, self.length())
    }

    /// A length in metres, as an expression has it.
    pub(crate) fn metres(self, value: f64) -> String {
        let value = if self == Units::Metres { value } else { value * 1e-3 };
        if value < 0.0 { format!("({})", number(value)) } else { number(value) }
    }

    pub(crate) fn forces(self, value: f64) -> String {
        quantity(value, "N")
    }

    pub(crate) fn times(self, value: f64) -> String {
        quantity(value, "s")
    }

    pub(crate) fn rates(self, value: f64) -> String {
        quantity(value, "/s")
    }

    pub(crate) fn pressures(self, value: f64) -> String {
        quantity(value, if self == Units::Metres { "Pa" } else { "MPa" })
    }

    pub(crate) fn slopes(self, value: f64) -> String {
        quantity(value, if self == Units::Metres { "Pa/m" } else { "MPa/mm" })
    }

    pub(crate) fn body_forces(self, value: f64) -> String {
        // 1 N/mm^3 is 1e9 N/m^3.
        quantity(if self == Units::Metres { value } else { value * 1e9 }, "N/m^3")
    }

    /// A force per volume and length in N/m^4, as an expression has it.
    pub(crate) fn body_force_rates(self, value: f64) -> String {
        // 1 N/mm^4 is 1e12 N/m^4.
        number(if self == Units::Metres { value } else { value * 1e12 })
    }

    pub(crate) fn densities(self, value: f64) -> String {
        // 1 t/mm^3 is 1e12 kg/m^3.
        quantity(if self == Units::Metres { value } else { value * 1e12 }, "kg/m^3")
    }
}

/// A quantity as a value of a scene.
fn quantity(value: f64, unit: &str) -> String {
    format!("\"{} {unit}\"", number(value))
}

/// A number in the shortest form that reads back to the same bits.
pub(crate) fn number(value: f64) -> String {
    // Zero has no sign in a scene.
    format!("{:?}", value + 0.0)
}
