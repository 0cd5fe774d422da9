//! Internal forces, central differences and dynamic relaxation.

mod contact;
mod dynamics;
mod force;
mod frames;
mod iterated_frames;
mod pressed_frames;
mod relaxation;
