//! Motion in real time and vibrations, against exact solutions.

mod dynamics;
mod frequencies;
mod modes;
mod relaxation;
