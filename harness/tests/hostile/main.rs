//! Untrusted input files, and input files at the paths of outputs: the program does not hang, exhaust memory,
//! or destroy an input.

#![cfg(unix)]

mod outputs;
mod programs;
mod readers;
mod results;
mod world;
