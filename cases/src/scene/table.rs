//! Tables of a file whose keys are the fields of a value, declared once: key, meaning, type and default.

use super::units::{Dim, Q};

/// Declares a value and its keys. `as` gives the type of a key that is not written like the value, such as a
/// quantity; `=` gives the value of a key that may be left out. Comments are descriptions in the schema, and
/// attributes of serde are those of the keys.
macro_rules! table {
    (
        $(#[doc = $about:literal])+
        $(#[serde($of_keys:ident)])?
        $visibility:vis struct $Name:ident from $Keys:ident {
            $(
                $(#[doc = $meaning:literal])+
                $(#[serde($attribute:ident)])?
                $field:ident: $Type:ty $(as $Key:ty)? $(= $default:expr)?,
            )+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq)]
        $visibility struct $Name {
            $($(#[doc = $meaning])+ pub $field: $Type,)+
        }

        $(#[doc = $about])+
        #[derive(serde::Deserialize, schemars::JsonSchema)]
        $(#[serde($of_keys)])?
        pub(crate) struct $Keys {
            $($(#[doc = $meaning])+ $(#[serde($attribute)])?
            $field: $crate::scene::table::table!(@key $Type [$($Key)?] [$($default)?]),)+
        }

        impl $crate::scene::table::Key<$Name> for $Keys {
            fn value(self) -> $Name {
                $Name {
                    $($field: $crate::scene::table::table!(@value self.$field, [$($Key)?] [$($default)?]),)+
                }
            }
        }
    };
    (@key $Type:ty [] []) => { $Type };
    (@key $Type:ty [$Key:ty] []) => { $Key };
    (@key $Type:ty [] [$default:expr]) => { Option<$Type> };
    (@key $Type:ty [$Key:ty] [$default:expr]) => { Option<$Key> };
    (@value $key:expr, [] []) => { $key };
    (@value $key:expr, [$Key:ty] []) => { $crate::scene::table::Key::value($key) };
    (@value $key:expr, [] [$default:expr]) => { $key.unwrap_or($default) };
    (@value $key:expr, [$Key:ty] [$default:expr]) => {
        $key.map_or($default, $crate::scene::table::Key::value)
    };
}
pub(crate) use table;

/// A key of a file with its value.
pub(crate) trait Key<V> {
    /// The value, in SI units.
    fn value(self) -> V;
}

impl<D: Dim> Key<f64> for Q<D> {
    fn value(self) -> f64 {
        self.0
    }
}

impl Key<usize> for u32 {
    fn value(self) -> usize {
        self as usize
    }
}

impl<V, K: Key<V>> Key<Option<V>> for Option<K> {
    fn value(self) -> Option<V> {
        self.map(Key::value)
    }
}
