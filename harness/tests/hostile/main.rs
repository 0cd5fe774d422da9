//! Files from others, and files of the user in the way of outputs: nothing hangs, takes all memory, or
//! destroys an input.

#![cfg(unix)]

mod outputs;
mod programs;
mod readers;
mod results;
mod world;
