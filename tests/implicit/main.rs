//! Implicit dynamics and vibrations compared with exact solutions.

mod dynamics;
mod frequencies;
mod modes;
mod relaxation;
