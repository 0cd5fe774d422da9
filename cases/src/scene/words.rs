//! Words that files choose from, declared once: variant, name in files and meaning.

use schemars::{Schema, json_schema};
use serde::{Deserialize, Deserializer, de::Error as _};
use serde_json::json;

use catalogue::suggest;

/// Declares an enum whose variants are words in files. The name in files follows the variant. The doc comment
/// of a variant is its meaning in the schema and in lists.
macro_rules! words {
    (
        $(#[doc = $about:literal])+
        $visibility:vis enum $Name:ident {
            $($(#[doc = $meaning:literal])+ $Variant:ident = $word:literal,)+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $visibility enum $Name {
            $($(#[doc = $meaning])+ $Variant,)+
        }

        impl $Name {
            /// All variants, in the order of lists.
            $visibility const ALL: &[$Name] = &[$($Name::$Variant),+];

            /// The name in files and tables.
            $visibility const fn name(self) -> &'static str {
                match self {
                    $($Name::$Variant => $word,)+
                }
            }
        }

        impl<'de> serde::Deserialize<'de> for $Name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<$Name, D::Error> {
                let names: Vec<&str> = $Name::ALL.iter().map(|word| word.name()).collect();
                Ok($Name::ALL[$crate::scene::words::read(deserializer, &names)?])
            }
        }

        impl schemars::JsonSchema for $Name {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($Name).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let words = [$(($word, concat!($($meaning),+))),+];
                $crate::scene::words::describe(concat!($($about),+), &words)
            }
        }
    };
}
pub(crate) use words;

/// Reads a word of a file; returns its index in `names`.
pub(crate) fn read<'de, D: Deserializer<'de>>(deserializer: D, names: &[&str]) -> Result<usize, D::Error> {
    let text = String::deserialize(deserializer)?;
    let unknown = || D::Error::custom(format!("'{text}' is not known; {}", suggest(&text, names)));
    names.iter().position(|name| *name == text).ok_or_else(unknown)
}

/// The schema of a choice of words with their meanings, in the form of a catalogue entry's schema.
pub(crate) fn describe(about: &str, words: &[(&str, &str)]) -> Schema {
    let word = |(name, meaning): &(&str, &str)| json!({ "type": "string", "const": name, "description": meaning.trim() });
    json_schema!({ "description": about.trim(), "oneOf": words.iter().map(word).collect::<Vec<_>>() })
}
