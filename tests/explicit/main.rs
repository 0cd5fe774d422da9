//! Internal forces, central differences and dynamic relaxation.

mod contact;
mod dynamics;
mod force;
mod relaxation;
