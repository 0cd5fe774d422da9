//! Statics at large displacements and with contact, compared with exact solutions.

mod bending;
mod contact_patch;
mod driven;
mod finite_patch;
mod friction;
mod hertz;
mod homogeneous;
mod iterated;
mod kept;
mod locking;
mod manufactured;
mod modal;
mod quadratic;
mod snap;
mod tunnels;
