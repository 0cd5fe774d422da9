//! efg
